//! `guide.json`: the emitters, the necks, and what the arrays beside it hold.

use super::arrays::{LAYOUTS, Layout};
use super::{Guided, cell};
use crate::guide::Opening;
use crate::light::{Emitter, Shape};
use crate::scene::Light;
use serde_json::{Map, Value, json};
use std::io::{self, Write};

/// Writes it.
///
/// # Errors
/// What the writer says.
pub fn write(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    let Guided { scene, model, guide } = *guided;
    let emitter = |(id, emitter): (usize, &Emitter)| {
        json!({
            "id": id,
            "kind": kind(emitter),
            "position": scene.to_user_m(emitter.aim().position_m).to_array(),
            "flux_w": emitter.flux_w,
        })
    };
    let neck = |(id, neck): (usize, &Opening)| {
        let outline: Vec<[f64; 3]> = neck.outline_m.iter().map(|&at_m| scene.to_user_m(at_m).to_array()).collect();
        json!({
            "id": id,
            "cells": neck.cells.map(cell),
            "position": scene.to_user_m(neck.position_m).to_array(),
            "normal": neck.normal.to_array(),
            "area": neck.area_m2,
            "outline": outline,
            "flux_w": neck.flux_w,
        })
    };
    let array = |layout: &Layout| {
        let (columns, units): (Vec<&str>, Vec<&str>) = layout.columns.iter().copied().unzip();
        let described = json!({ "columns": columns, "units": units, "type": layout.entries, "axes": layout.axes });
        (layout.file.to_owned(), described)
    };
    let document = json!({
        "scene": scene.name,
        "units": {
            "position": "m",
            "outline": "m",
            "normal": "1",
            "area": "m2",
            "flux_w": "W; of necks from the first cell to the second, and back",
        },
        "voxel_m": model.voxels.lattice.voxel_m,
        "emitters": model.sources.emitters.iter().enumerate().map(emitter).collect::<Vec<Value>>(),
        "cells": model.skeleton.cells.len(),
        "necks": guide.necks.iter().enumerate().map(neck).collect::<Vec<Value>>(),
        "arrays": LAYOUTS.iter().map(array).collect::<Map<String, Value>>(),
    });
    serde_json::to_writer(&mut *out, &document)?;
    writeln!(out)
}

/// What kind of body an emitter has; `faces` are emissive faces of the mesh.
fn kind(emitter: &Emitter) -> &'static str {
    match emitter.shape {
        Shape::Light(_, Light::Point { .. }) => "point",
        Shape::Light(_, Light::Sphere { .. }) => "sphere",
        Shape::Light(_, Light::Quad { .. }) => "quad",
        Shape::Patch { .. } => "faces",
    }
}
