//! Where on the faces of a scene do sensors lie that chance puts there?

use glam::DVec3;

use super::dice::Dice;
use crate::check::{distance, winding};
use crate::scene::{Mesh, Sensor, on_slant};

/// How far sensors stand off their face.
const OFF_M: f64 = 0.01;

/// How much nearer than that another face may be, for rounding.
const SLACK_M: f64 = 0.0005;

/// How many points are tried for each sensor.
const TRIES: usize = 2000;

/// Sensors on the faces of `part` for which `fits` holds (a point of the face, its normal), as likely everywhere by
/// area, 1 cm off, in the air of `whole` and no nearer to any other face. Their ids are the prefix and a number.
pub fn scatter(
    whole: &Mesh,
    part: &Mesh,
    dice: &mut Dice,
    prefix: &str,
    count: usize,
    fits: impl Fn(DVec3, DVec3) -> bool,
) -> Result<Vec<Sensor>, String> {
    let mut reach = 0.0;
    let faces: Vec<(f64, [DVec3; 3], DVec3)> = part
        .triangle_corners()
        .map(|[a, b, c]| {
            let doubled = (b - a).cross(c - a);
            reach += doubled.length();
            (reach, [a, b, c], doubled.normalize())
        })
        .collect();
    let mut sensors = Vec::new();
    for _ in 0..TRIES * count {
        let [which, s, t] = [reach * dice.share(), dice.share(), dice.share()];
        let (_, [a, b, c], normal) = faces[faces.partition_point(|face| face.0 <= which)];
        // The half of the parallelogram beyond the triangle is turned back onto it.
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        let p = a + (b - a) * s + (c - a) * t;
        if !fits(p, normal) || !is_free(whole, p + normal * OFF_M) {
            continue;
        }
        sensors.push(on_slant(format!("{prefix}_{:03}", sensors.len() + 1), p + normal * OFF_M, normal));
        if sensors.len() == count {
            return Ok(sensors);
        }
    }
    Err(format!("{prefix}: only {} of {count} sensors found a place", sensors.len()))
}

/// Whether a point is in the air, and off every face.
fn is_free(mesh: &Mesh, p: DVec3) -> bool {
    winding(mesh, p).abs() < 0.5 && mesh.triangle_corners().all(|t| distance(t, p) > OFF_M - SLACK_M)
}

/// Whether something lies straight above a point, more than a centimetre.
pub fn is_covered(mesh: &Mesh, p: DVec3) -> bool {
    mesh.triangle_corners().any(|[a, b, c]| {
        let doubled = (b - a).cross(c - a);
        let side = |q: DVec3, r: DVec3| (r - q).truncate().perp_dot((p - q).truncate()) * doubled.z;
        let is_over = doubled.z != 0.0 && side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0;
        // The height of the triangle's plane over the point.
        is_over && (a - p).dot(doubled) / doubled.z > OFF_M
    })
}
