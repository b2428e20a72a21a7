//! Is a scene under the sky fit to be written: every solid closed, every sensor in the air above the ground?

use std::collections::BTreeSet;

use glam::DVec3;

use super::{GROUND_M, Outdoor};
use crate::check::{check_closed, winding};
use crate::scene::Mesh;

/// How far a sensor is moved off its face before it is asked for, and a face's middle before and behind it.
const OFF_M: f64 = 0.003;

/// The first thing found wrong with a scene.
pub fn check(outdoor: &Outdoor) -> Result<(), String> {
    let (name, mesh) = (outdoor.scene.name, &outdoor.scene.mesh);
    check_closed(mesh).map_err(|e| format!("{name}: {e}"))?;
    for sensors in outdoor.scene.tables.iter().map(|table| &table.sensors) {
        let mut seen = BTreeSet::new();
        for sensor in sensors {
            let normal = sensor.normal.ok_or(format!("{name}: sensor {} has no normal", sensor.id))?;
            let p = sensor.position + normal * OFF_M;
            if winding(mesh, p).abs() > 0.5 || p.z <= 0.0 {
                return Err(format!("{name}: sensor {} at {p} lies in matter or below the ground", sensor.id));
            }
            if !seen.insert(&sensor.id) {
                return Err(format!("{name}: sensor {} occurs twice", sensor.id));
            }
        }
    }
    check_outward(mesh).map_err(|e| format!("{name}: {e}"))?;
    match (overhang(mesh), outdoor.is_height_field) {
        (Some(p), true) => Err(format!("{name}: something overhangs at {p}")),
        (None, false) => Err(format!("{name}: nothing overhangs")),
        _ => Ok(()),
    }
}

/// Every face above the ground must have more matter behind it than before it: it points out of its solid. Where it is
/// seen, it is one solid's; faces of several that are hidden in another may lie on each other.
fn check_outward(mesh: &Mesh) -> Result<(), String> {
    for (middle, normal) in middles(mesh).filter(|(middle, _)| middle.z >= 0.0) {
        let [behind, before] = [-OFF_M, OFF_M].map(|off| winding(mesh, middle + normal * off).round());
        if behind <= before || (before == 0.0 && behind > 1.0) {
            return Err(format!("the face about {middle} has {behind} solids behind it and {before} before it"));
        }
    }
    Ok(())
}

/// Vertical component of the normal below which a face looks down: gables, rounded to tenths of a millimetre, lean by 4e-5.
const LOOKS_DOWN: f64 = -1e-3;

/// A face that looks down into the air above the ground, if there is one.
fn overhang(mesh: &Mesh) -> Option<DVec3> {
    middles(mesh)
        .filter(|(middle, normal)| normal.z < LOOKS_DOWN && middle.z > -GROUND_M + OFF_M)
        .find(|(middle, normal)| winding(mesh, middle + normal * OFF_M).abs() < 0.5)
        .map(|(middle, _)| middle)
}

/// Middle and normal of every triangle.
fn middles(mesh: &Mesh) -> impl Iterator<Item = (DVec3, DVec3)> {
    mesh.triangle_corners().map(|[a, b, c]| ((a + b + c) / 3.0, (b - a).cross(c - a).normalize()))
}
