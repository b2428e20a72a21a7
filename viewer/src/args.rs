//! What is typed on the command line.

use crate::camera::{Camera, Standard};
use crate::controls::Layer;
use crate::layers::{Layers, MeshColour, MeshStyle, NodeColour, Shadow, Slice, VoxelShow};
use crate::outdoors::QUANTITIES;
use crate::shadows;
use crate::shadows::study::command::ShadowArgs;
use clap::{Parser, Subcommand};
use glam::{DVec3, Vec3};
use jiff::civil::{Date, Time};
use lightvein::daylight::Quantity;
use lightvein::scene::Method;
use std::path::PathBuf;

/// Shows what Lightvein finds in a scene: voxels, skeleton, flux, sun and exposure.
#[derive(Debug, Clone, Parser)]
#[command(version, about, args_conflicts_with_subcommands = true)]
pub struct Args {
    /// What is done instead of showing a scene.
    #[command(subcommand)]
    pub command: Option<Command>,

    /// Scene file (TOML) or mesh (OBJ, glTF, PLY, STL); without one a scene of its own greets.
    pub scene: Option<PathBuf>,

    /// Write a picture to this PNG and end, without a window or a display.
    #[arg(long, value_name = "FILE")]
    pub screenshot: Option<PathBuf>,

    /// Size of the picture or the window, pixels.
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1600x1000")]
    pub size: [u32; 2],

    /// A layer to switch on, or off with a minus before it (`-mesh`), or how one looks (`nodes=flux`, `mesh=exposure`,
    /// `voxels=distance`, `exposure=svf`, `shadows=hsm`); may be given several times, or with commas between.
    #[arg(long = "layer", value_name = "LAYER", value_delimiter = ',', allow_hyphen_values = true, value_parser = layer)]
    pub layers: Vec<Look>,

    /// Where the picture is taken from: front, right, top, back, left, bottom, oblique, or the eye and what it looks at, metres, as
    /// `x,y,z:x,y,z`.
    #[arg(long, value_name = "CAMERA", allow_hyphen_values = true, value_parser = viewpoint)]
    pub camera: Option<Viewpoint>,

    /// Just the view, without panels.
    #[arg(long)]
    pub view_only: bool,

    /// What is picked: `sensor:ID`, `node:N`, `light:N`, or `wall:X,Y,Z`, the face that the camera sees towards that point, metres.
    #[arg(long, value_name = "WHAT")]
    pub pick: Option<String>,

    /// Edge of a voxel, metres.
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = positive)]
    pub voxel: Option<f32>,

    /// The method of the estimate.
    #[arg(long, value_name = "METHOD", value_parser = method)]
    pub method: Option<Method>,

    /// The day that sun and sky show.
    #[arg(long, value_name = "YYYY-MM-DD")]
    pub date: Option<Date>,

    /// The time that sun and sky show, local standard time.
    #[arg(long, value_name = "HH:MM")]
    pub time: Option<Time>,

    /// The theme: dark or light; as the system has it without.
    #[arg(long, value_name = "THEME", value_parser = theme)]
    pub theme: Option<Theme>,
}

/// What the program does without a window, besides pictures of it.
#[derive(Debug, Clone, Subcommand)]
pub enum Command {
    /// Measures shadow methods on a view of a scene under its sun.
    Shadows(ShadowArgs),
}

/// A theme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Theme {
    /// Light on dark.
    Dark,
    /// Dark on light.
    Light,
}

/// One wish about the layers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Look {
    /// A layer on or off.
    Switch(Layer, bool),
    /// The sky's dome on or off.
    SunPath(bool),
    /// Names and values beside sensors.
    Values(bool),
    /// Sensors by their ratio.
    Ratios(bool),
    /// Exposure pixel by pixel.
    PerPixel(bool),
    /// What colours the mesh.
    Mesh(MeshColour),
    /// How the mesh is drawn.
    Style(MeshStyle),
    /// What colours the nodes.
    Nodes(NodeColour),
    /// Which voxels are shown.
    Voxels(VoxelShow),
    /// Just the slice of voxels through the middle across that axis: 0, 1, 2 for x, y, z.
    Slice(usize),
    /// Which quantity of the exposure is shown.
    Exposure(Quantity),
    /// Sunlight with shadows by a method.
    Shadows(shadows::Method),
}

/// Where a picture is taken from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viewpoint {
    /// A direction that has a name; the whole scene is in the picture.
    Standard(Standard),
    /// The eye and what it looks at, in the user's coordinates, metres.
    Between(DVec3, DVec3),
}

impl Look {
    /// Does as wished.
    pub fn apply(self, layers: &mut Layers) {
        match self {
            Self::Switch(layer, is_on) => layer.set(layers, is_on),
            Self::SunPath(is_on) => layers.sun_path = is_on,
            Self::Values(is_on) => layers.sensor_values = is_on,
            Self::Ratios(is_on) => layers.sensor_ratios = is_on,
            Self::PerPixel(is_on) => layers.per_pixel = is_on,
            Self::Mesh(colour) => (layers.mesh, layers.mesh_colour) = (true, colour),
            Self::Style(style) => (layers.mesh, layers.mesh_style) = (true, style),
            Self::Nodes(colour) => (layers.nodes, layers.node_colour) = (true, colour),
            Self::Voxels(show) => (layers.voxels, layers.voxel_show) = (true, show),
            Self::Slice(axis) => (layers.voxels, layers.voxel_slice) = (true, Some(Slice { axis, share: 0.5 })),
            Self::Exposure(quantity) => layers.quantity = quantity,
            Self::Shadows(method) => {
                layers.light_by_sun(true);
                layers.shadow = Shadow::by(method);
            }
        }
    }
}

impl Viewpoint {
    /// The camera at that point; `origin_m` is what the scene's own coordinates lie off the user's, metres.
    pub fn camera(self, origin_m: DVec3, bounds_m: (Vec3, Vec3), aspect: f32) -> Camera {
        let mut camera = Camera::fitted(bounds_m, aspect);
        match self {
            Self::Standard(standard) => {
                camera.look_from(standard);
                camera.fit(bounds_m, aspect);
            }
            Self::Between(from_m, to_m) => {
                let [from_m, to_m] = [from_m, to_m].map(|at_m| (at_m - origin_m).as_vec3());
                let back = from_m - to_m;
                camera.target_m = to_m;
                camera.distance_m = back.length().max(1e-3);
                camera.elevation_rad = (back.z / camera.distance_m).clamp(-1.0, 1.0).asin();
                camera.azimuth_rad = back.y.atan2(back.x);
            }
        }
        camera
    }
}

/// Width and height, pixels.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once(['x', 'X']).and_then(|(wide, high)| Some([wide.parse().ok()?, high.parse().ok()?]));
    let is_picture = |size: &[u32; 2]| size.iter().all(|side| (64..=8192).contains(side));
    parsed
        .filter(is_picture)
        .ok_or_else(|| format!("{text:?} is not a size: two numbers from 64 to 8192, such as 1600x1000"))
}

fn positive(text: &str) -> Result<f32, String> {
    let value: Option<f32> = text.parse().ok();
    value
        .filter(|value| *value > 0.0 && value.is_finite())
        .ok_or_else(|| format!("{text:?} is not a positive length in metres"))
}

fn method(text: &str) -> Result<Method, String> {
    let names = Method::ALL.map(Method::name).join(", ");
    Method::from_name(text).ok_or_else(|| format!("{text:?} is no method; there are {names}"))
}

fn theme(text: &str) -> Result<Theme, String> {
    match text {
        "dark" => Ok(Theme::Dark),
        "light" => Ok(Theme::Light),
        _ => Err(format!("{text:?} is no theme; there are dark and light")),
    }
}

/// Layers by their names on the command line.
const LAYERS: [(&str, Layer); 13] = [
    ("mesh", Layer::Mesh),
    ("voxels", Layer::Voxels),
    ("nodes", Layer::Nodes),
    ("edges", Layer::Edges),
    ("arrows", Layer::Arrows),
    ("cells", Layer::Cells),
    ("necks", Layer::Necks),
    ("sensors", Layer::Sensors),
    ("lights", Layer::Lights),
    ("ball", Layer::Ball),
    ("paths", Layer::Paths),
    ("cut", Layer::Cut),
    ("shadows", Layer::Shadows),
];

fn layer(text: &str) -> Result<Look, String> {
    let (name, is_on) = text.strip_prefix('-').map_or((text, true), |name| (name, false));
    if let Some((_, layer)) = LAYERS.iter().find(|(of, _)| *of == name) {
        return Ok(Look::Switch(*layer, is_on));
    }
    let look = match name {
        "sun" => Look::SunPath(is_on),
        "values" => Look::Values(is_on),
        "ratios" => Look::Ratios(is_on),
        "pixels" => Look::PerPixel(is_on),
        "mesh=material" => Look::Mesh(MeshColour::Material),
        "mesh=irradiance" => Look::Mesh(MeshColour::Irradiance),
        "mesh=exposure" => Look::Mesh(MeshColour::Exposure),
        "mesh=shaded" => Look::Style(MeshStyle::Shaded),
        "mesh=wireframe" => Look::Style(MeshStyle::Wireframe),
        "mesh=transparent" => Look::Style(MeshStyle::Transparent),
        "nodes=irradiance" => Look::Nodes(NodeColour::Irradiance),
        "nodes=flux" => Look::Nodes(NodeColour::Flux),
        "nodes=radius" => Look::Nodes(NodeColour::Radius),
        "nodes=cell" => Look::Nodes(NodeColour::Cell),
        "nodes=light" => Look::Nodes(NodeColour::Light),
        "voxels=solid" => Look::Voxels(VoxelShow::Solid),
        "voxels=void" => Look::Voxels(VoxelShow::Void),
        "voxels=distance" => Look::Voxels(VoxelShow::Distance),
        "slice=x" => Look::Slice(0),
        "slice=y" => Look::Slice(1),
        "slice=z" => Look::Slice(2),
        name => return exposure(name).or_else(|| shadows(name)).ok_or_else(|| unknown(text)),
    };
    Ok(look)
}

fn exposure(name: &str) -> Option<Look> {
    let name = name.strip_prefix("exposure=")?;
    QUANTITIES.into_iter().find(|quantity| quantity.name() == name).map(Look::Exposure)
}

fn shadows(name: &str) -> Option<Look> {
    shadows::Method::from_name(name.strip_prefix("shadows=")?).map(Look::Shadows)
}

fn unknown(text: &str) -> String {
    let layers = LAYERS.map(|(name, _)| name).join(", ");
    let quantities = QUANTITIES.map(Quantity::name).join(", ");
    let methods = shadows::Method::ALL.map(shadows::Method::name).join(", ");
    format!(
        "{text:?} is no layer; there are {layers}, sun, values, ratios, pixels; mesh=material, irradiance, exposure, shaded, \
         wireframe or transparent; nodes=irradiance, flux, radius, cell or light; voxels=solid, void or distance; \
         slice=x, y or z; exposure={quantities}; shadows={methods}"
    )
}

/// A point as `x,y,z`.
pub(crate) fn point(text: &str) -> Option<DVec3> {
    let numbers: Vec<f64> = text.split(',').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?;
    <[f64; 3]>::try_from(numbers).ok().map(DVec3::from_array).filter(|at_m| at_m.is_finite())
}

/// A direction by its name, or eye and target.
pub(crate) fn viewpoint(text: &str) -> Result<Viewpoint, String> {
    let all = [
        ("front", Standard::Front),
        ("right", Standard::Right),
        ("top", Standard::Top),
        ("back", Standard::Back),
        ("left", Standard::Left),
        ("bottom", Standard::Bottom),
        ("oblique", Standard::Oblique),
    ];
    if let Some((_, standard)) = all.iter().find(|(name, _)| *name == text) {
        return Ok(Viewpoint::Standard(*standard));
    }
    let between = text.split_once(':').and_then(|(from, to)| Some((point(from)?, point(to)?)));
    match between {
        Some((from_m, to_m)) if from_m == to_m => Err(format!("{text:?}: the eye lies in what it looks at")),
        Some((from_m, to_m)) => Ok(Viewpoint::Between(from_m, to_m)),
        None => Err(format!(
            "{text:?} is no camera: front, right, top, back, left, bottom, oblique, or two points as x,y,z:x,y,z"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_named_switched_and_coloured() {
        let mut layers = Layers::default();
        for name in ["-mesh", "cells", "nodes=flux", "exposure=svf", "values", "voxels=distance"] {
            layer(name).unwrap().apply(&mut layers);
        }
        assert!(!layers.mesh && layers.cells && layers.sensor_values && layers.voxels);
        assert_eq!((layers.node_colour, layers.quantity), (NodeColour::Flux, Quantity::Svf));
        layer("shadows=vsm").unwrap().apply(&mut layers);
        assert!(layers.mesh && layers.shadows && layers.shadow.method == shadows::Method::Vsm);
        layer("-shadows").unwrap().apply(&mut layers);
        assert!(layers.mesh && !layers.shadows && layer("shadows=soft").is_err());
        let error = layer("nods").unwrap_err();
        assert!(error.contains("\"nods\" is no layer") && error.contains("nodes, edges"), "{error}");
        assert!(layer("exposure=heat").is_err() && layer("-nodes=flux").is_ok());
    }

    #[test]
    fn cameras_are_names_or_two_points() {
        assert_eq!(viewpoint("top"), Ok(Viewpoint::Standard(Standard::Top)));
        let Ok(between @ Viewpoint::Between(..)) = viewpoint("110,-5,3:100,5,2") else { panic!() };
        let camera = between.camera(DVec3::new(100.0, 0.0, 0.0), (Vec3::ZERO, Vec3::ONE), 1.0);
        assert!(camera.eye_m().distance(Vec3::new(10.0, -5.0, 3.0)) < 1e-4, "{}", camera.eye_m());
        assert!(camera.target_m.distance(Vec3::new(0.0, 5.0, 2.0)) < 1e-6);
        for wrong in ["above", "1,2:3,4,5", "1,2,3:1,2,3", "1,2,nan:0,0,0"] {
            assert!(viewpoint(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn sizes_are_bounded() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        for wrong in ["640", "10x10", "9000x100", "axb"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
