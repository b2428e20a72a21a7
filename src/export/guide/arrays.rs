//! Places and samples as NumPy arrays, rows by columns; what the columns are stands here, for the arrays and for `guide.json`.

use super::{Guided, cell};
use crate::guide::{Place, TrainingSample};
use crate::light::{Lobe, MOST_LOBES};
use glam::Vec3;
use ndarray::{Array2, Array3};
use ndarray_npy::WriteNpyExt;
use std::io::{self, Write};

/// A column: its name and its unit.
pub type Column = (&'static str, &'static str);

/// An array: its file, what an entry is, what its axes are, and what stands along the last.
pub struct Layout {
    /// The file.
    pub file: &'static str,
    /// NumPy's name of an entry's type.
    pub entries: &'static str,
    /// The axes; the last are the columns.
    pub axes: &'static [&'static str],
    /// The columns.
    pub columns: &'static [Column],
}

/// All arrays.
pub const LAYOUTS: [Layout; 7] = [
    Layout { file: "walls.npy", entries: "float64", axes: &["wall", "column"], columns: &WALLS },
    Layout { file: "walls_lobes.npy", entries: "float32", axes: &["wall", "lobe", "column"], columns: &LOBES },
    Layout { file: "walls_lights.npy", entries: "float32", axes: &["wall", "emitter", "column"], columns: &LIGHTS },
    Layout { file: "nodes.npy", entries: "float64", axes: &["node", "column"], columns: &NODES },
    Layout { file: "nodes_lobes.npy", entries: "float32", axes: &["node", "lobe", "column"], columns: &LOBES },
    Layout { file: "nodes_lights.npy", entries: "float32", axes: &["node", "emitter", "column"], columns: &LIGHTS },
    Layout { file: "samples.npy", entries: "float32", axes: &["sample", "column"], columns: &SAMPLES },
];

const WALLS: [Column; 13] = [
    ("x", "m"),
    ("y", "m"),
    ("z", "m"),
    ("nx", "1"),
    ("ny", "1"),
    ("nz", "1"),
    ("cell", "number, -1: none"),
    ("scalar", "W/m2"),
    ("reflected", "W/m2"),
    ("irradiance", "W/m2"),
    ("radius", "m"),
    ("reflectance", "1"),
    ("trust", "1"),
];

const NODES: [Column; 8] = [
    ("x", "m"),
    ("y", "m"),
    ("z", "m"),
    ("radius", "m"),
    ("cell", "number, -1: none"),
    ("scalar", "W/m2"),
    ("reflected", "W/m2"),
    ("trust", "1"),
];

const LOBES: [Column; 6] =
    [("dx", "1"), ("dy", "1"), ("dz", "1"), ("concentration", "1"), ("weight", "1"), ("distance", "m")];

const LIGHTS: [Column; 2] = [("direct", "W/m2"), ("share", "1")];

const SAMPLES: [Column; 10] = [
    ("x", "m"),
    ("y", "m"),
    ("z", "m"),
    ("dx", "1"),
    ("dy", "1"),
    ("dz", "1"),
    ("weight", "W/m2"),
    ("pdf", "1/sr"),
    ("distance", "m"),
    ("flags", "bits: 2 straight from an emitter"),
];

/// Writes `walls.npy`.
///
/// # Errors
/// What the writer says.
pub fn write_walls(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    let guide = guided.guide;
    let rows = guide.walls.iter().zip(&guide.cache).zip(&guide.reflectances);
    let rows = rows.map(|((place, record), &reflectance)| {
        let [x, y, z] = guided.scene.to_user_m(record.position_m).to_array();
        let [nx, ny, nz] = record.normal.as_dvec3().to_array();
        let light = [place.scalar_w_m2, record.reflected_w_m2, record.irradiance_w_m2, record.radius_m, reflectance];
        let [scalar, reflected, irradiance, radius, reflectance] = light.map(f64::from);
        let trust = f64::from(place.incident.trust);
        [x, y, z, nx, ny, nz, cell(place.cell) as f64, scalar, reflected, irradiance, radius, reflectance, trust]
    });
    write_rows(out, rows.collect())
}

/// Writes `nodes.npy`.
///
/// # Errors
/// What the writer says.
pub fn write_nodes(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    let nodes = guided.model.skeleton.graph.node_weights();
    let rows = guided.guide.nodes.iter().zip(nodes).map(|(place, node)| {
        let [x, y, z] = guided.scene.to_user_m(node.position_m).to_array();
        let Place { incident, scalar_w_m2, .. } = place;
        let light = [node.radius_m, *scalar_w_m2, incident.reflected_w_m2, incident.trust];
        let [radius, scalar, reflected, trust] = light.map(f64::from);
        [x, y, z, radius, cell(place.cell) as f64, scalar, reflected, trust]
    });
    write_rows(out, rows.collect())
}

/// Writes `samples.npy`.
///
/// # Errors
/// What the writer says.
pub fn write_samples(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    let row = |sample: &TrainingSample| {
        let [x, y, z] = guided.scene.to_user_m(sample.position_m).as_vec3().to_array();
        let [dx, dy, dz] = sample.direction.to_array();
        let TrainingSample { weight_w_m2, density_per_sr, distance_m, flags, .. } = *sample;
        [x, y, z, dx, dy, dz, weight_w_m2, density_per_sr, distance_m, flags as f32]
    };
    write_rows(out, guided.guide.samples.iter().map(row).collect())
}

/// Writes the lobes of places; unused ones have weight 0.
///
/// # Errors
/// What the writer says.
pub fn write_lobes(out: &mut dyn Write, places: &[Place]) -> io::Result<()> {
    let none = Lobe { direction: Vec3::ZERO, concentration: 0.0, weight: 0.0, distance_m: 0.0 };
    let array = Array3::from_shape_fn((places.len(), MOST_LOBES, LOBES.len()), |(place, lobe, column)| {
        let lobes = places.get(place).map(|place| place.incident.lobes.as_slice()).unwrap_or_default();
        let Lobe { direction, concentration, weight, distance_m } = lobes.get(lobe).copied().unwrap_or(none);
        [direction.x, direction.y, direction.z, concentration, weight, distance_m][column]
    });
    array.write_npy(out).map_err(io::Error::other)
}

/// Writes what each emitter brings to places: straight, and its share of all light.
///
/// # Errors
/// What the writer says.
pub fn write_lights(out: &mut dyn Write, places: &[Place], emitters: usize) -> io::Result<()> {
    let array = Array3::from_shape_fn((places.len(), emitters, LIGHTS.len()), |(place, emitter, column)| {
        let part = places.get(place).and_then(|place| match column {
            0 => place.incident.direct_w_m2.get(emitter),
            _ => place.shares.get(emitter),
        });
        part.copied().unwrap_or(0.0)
    });
    array.write_npy(out).map_err(io::Error::other)
}

fn write_rows<T: ndarray_npy::WritableElement, const N: usize>(
    out: &mut dyn Write,
    rows: Vec<[T; N]>,
) -> io::Result<()> {
    Array2::from(rows).write_npy(out).map_err(io::Error::other)
}
