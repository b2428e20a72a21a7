//! Is a scene fit to be written: mesh closed, every light and sensor in the void, every name once?

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::scene::{Mesh, Scene};

/// How far a planar sensor is moved off its wall before it is asked for: more than the 1 mm at which some stand off.
const OFF_WALL_M: f64 = 0.003;

/// The first thing found wrong with a scene.
pub fn check(scene: &Scene) -> Result<(), String> {
    let name = scene.name;
    check_closed(&scene.mesh).map_err(|e| format!("{name}: {e}"))?;
    for light in &scene.lights {
        let p = light.place();
        if !is_inside(&scene.mesh, p) {
            return Err(format!("{name}: a light at {p} lies outside the void"));
        }
    }
    for table in &scene.tables {
        let mut seen = BTreeSet::new();
        for sensor in &table.sensors {
            let p = sensor.position + sensor.normal.unwrap_or_default() * OFF_WALL_M;
            if !is_inside(&scene.mesh, p) {
                return Err(format!("{name}: sensor {} at {p} lies outside the void", sensor.id));
            }
            if !seen.insert(&sensor.id) {
                return Err(format!("{name}: sensor {} occurs twice", sensor.id));
            }
        }
    }
    Ok(())
}

/// Scalar sensors two voxels or more from any wall, so that they measure the room and not a voxel.
pub fn check_clear(scene: &Scene) -> Result<(), String> {
    let clearance_m = 2.0 * scene.voxel_m;
    for sensor in scene.tables.iter().flat_map(|t| &t.sensors).filter(|s| s.normal.is_none()) {
        let distance_m = scene.mesh.triangle_corners().map(|t| distance(t, sensor.position)).fold(f64::MAX, f64::min);
        if distance_m < clearance_m {
            let (name, id) = (scene.name, &sensor.id);
            return Err(format!("{name}: sensor {id} is {distance_m:.3} m from a wall, under {clearance_m} m"));
        }
    }
    Ok(())
}

/// From a point to a triangle: to its plane where the foot lies inside, else to its nearest edge.
pub fn distance([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let doubled = (b - a).cross(c - a);
    let edges = [(a, b), (b, c), (c, a)];
    if edges.iter().all(|(q, r)| (r - q).cross(p - q).dot(doubled) >= 0.0) {
        return (p - a).dot(doubled.normalize()).abs();
    }
    let to_edge = |(q, r): &(DVec3, DVec3)| {
        let t = ((p - q).dot(r - q) / (r - q).length_squared()).clamp(0.0, 1.0);
        p.distance(q.lerp(*r, t))
    };
    edges.iter().map(to_edge).fold(f64::MAX, f64::min)
}

/// Every edge must be walked once in each direction.
pub fn check_closed(mesh: &Mesh) -> Result<(), String> {
    let mut walks = BTreeMap::new();
    for polygon in mesh.polygons() {
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            *walks.entry((a, b)).or_insert(0) += 1;
        }
    }
    for (&(a, b), &count) in &walks {
        if count != 1 || walks.get(&(b, a)) != Some(&1) {
            let (p, q) = (mesh.vertices[a], mesh.vertices[b]);
            return Err(format!("the mesh is not a closed surface at the edge {p} to {q}"));
        }
    }
    Ok(())
}

/// Whether the mesh winds about a point of its void. Normals that point the wrong way fail here too.
fn is_inside(mesh: &Mesh, p: DVec3) -> bool {
    // Normals into the void make the winding negative.
    (winding(mesh, p) + 1.0).abs() < 0.5
}

/// How often the mesh winds about a point: its solid angles over 4 pi (van Oosterom and Strackee 1983). 0 outside, and
/// for a point in solids whose normals point out of them the number of those solids.
pub fn winding(mesh: &Mesh, p: DVec3) -> f64 {
    let mut half_angle = 0.0;
    for corners in mesh.triangle_corners() {
        let [a, b, c] = corners.map(|corner| corner - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let volume = a.dot(b.cross(c));
        half_angle += volume.atan2(la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    half_angle / (2.0 * std::f64::consts::PI)
}
