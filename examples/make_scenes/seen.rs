//! Which wall does one see from here? To place sensors on walls that slant or curve.

use glam::DVec3;

use crate::scene::{Mesh, Sensor, on_slant};

/// How far sensors stand off their wall.
const OFF_M: f64 = 0.001;

/// How near its triangle's edges a sensor may be, in barycentric coordinates: on an edge two normals would be right.
const EDGE: f64 = 0.02;

/// A sensor 1 mm off the wall that is seen from a point in a direction, facing along the wall's normal.
pub fn seen(mesh: &Mesh, id: &str, from: [f64; 3], towards: [f64; 3]) -> Result<Sensor, String> {
    let (from, towards) = (DVec3::from(from), DVec3::from(towards));
    let hits = mesh.triangle_corners().filter_map(|triangle| hit(triangle, from, towards));
    let (t, normal, least) = hits.min_by(|a, b| a.0.total_cmp(&b.0)).ok_or(format!("{id} sees no wall"))?;
    if normal.dot(towards) >= 0.0 || least < EDGE {
        return Err(format!("{id} sees a wall's back or its edge: barycentric {least:.3}"));
    }
    Ok(on_slant(id.into(), from + towards * t + normal * OFF_M, normal))
}

/// Where a ray meets a triangle: its parameter, the triangle's normal, the least barycentric coordinate.
fn hit([a, b, c]: [DVec3; 3], from: DVec3, towards: DVec3) -> Option<(f64, DVec3, f64)> {
    let doubled = (b - a).cross(c - a);
    let t = (a - from).dot(doubled) / towards.dot(doubled);
    let p = from + towards * t;
    let share = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(doubled) / doubled.length_squared();
    let least = share(a, b).min(share(b, c)).min(share(c, a));
    (t > 0.0 && least >= 0.0).then(|| (t, doubled.normalize(), least))
}
