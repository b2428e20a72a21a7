//! What does a point see through the necks around it?
//!
//! A room has one potential, but from beside a door one looks into the next room: over the solid angle of the opening the
//! radiance is that of the other side. Radiance of diffuse light is `phi / (4 pi)`, so an opening of solid angle `Omega`
//! changes the scalar irradiance by `(phi_other - phi_own) Omega / (4 pi)`; in the opening itself, where `Omega` is `2 pi`,
//! the two sides meet half way. Solid angles are those of the outline (van Oosterom & Strackee 1983), the net flux through it
//! is Lambert's sum over its edges.
//!
//! Limits: a quarter of an opening counts whole or not at all, by one look into its middle, and what is seen through it is
//! the mean light beyond.

use crate::model::Model;
use crate::skeleton::Neck;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Parts of an opening that are looked at each by itself.
const PARTS: usize = 4;

/// Corners of the outline of a part, both ends included.
const CORNERS: usize = 5;

/// How far from the centre towards the outline the look goes: half of a triangle lies within 0.7 of its height.
const INWARDS: f32 = 0.7;

/// A point beyond the plane of an opening stands in it if the opening fills this much of its view; else it is somewhere in a
/// room that bends around, and sees the opening from behind.
const LEAST_PASSED_SR: f64 = PI;

/// An opening as a point sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Its solid angle, steradians; above `2 pi` for a point that has passed through.
    pub solid_angle_sr: f64,
    /// The integral of the directions in it, pointing away from the point; its length is at most `pi`.
    pub flux: DVec3,
}

/// What a point on the side of the neck's cell number `side` (0 or 1) sees of it past opaque things, weakened by glazing;
/// `None` where it sees nothing. Costs `PARTS` rays.
pub fn view(model: &Model, neck: &Neck, side: usize, point_m: Vec3) -> Option<View> {
    let corners = neck.outline_m.len();
    if corners < PARTS * (CORNERS - 1) {
        return None;
    }
    let corner_m = |at: usize| neck.outline_m[at % corners];
    let centre = (neck.centre_m - point_m).as_dvec3();
    let outwards = if side == 0 { neck.normal } else { -neck.normal }.as_dvec3();
    let (mut solid_angle_sr, mut flux) = (0.0, DVec3::ZERO);
    for part in 0..PARTS {
        let at = |number: usize| part * corners / PARTS + number * corners / (PARTS * (CORNERS - 1));
        let inwards_m = neck.centre_m.lerp(corner_m(at(CORNERS / 2)), INWARDS);
        let share = f64::from(model.rays.transmitted(point_m, inwards_m));
        if share <= 0.0 {
            continue;
        }
        let around: [DVec3; CORNERS] = std::array::from_fn(|number| (corner_m(at(number)) - point_m).as_dvec3());
        for (a, b) in around.iter().zip(&around[1..]) {
            solid_angle_sr += share * triangle_sr(centre, *a, *b);
            flux += share * 0.5 * [(centre, *a), (*a, *b), (*b, centre)].map(|(a, b)| turn(a, b)).iter().sum::<DVec3>();
        }
    }
    let passed = outwards.dot((neck.position_m - point_m).as_dvec3()) < 0.0;
    if solid_angle_sr == 0.0 || passed && solid_angle_sr.abs() < LEAST_PASSED_SR {
        return None;
    }
    let flux = if flux.dot(outwards) < 0.0 { -flux } else { flux };
    let solid_angle_sr = solid_angle_sr.abs();
    Some(View { solid_angle_sr: if passed { 4.0 * PI - solid_angle_sr } else { solid_angle_sr }, flux })
}

/// The angle between two directions, along the axis of the turn from one to the other.
fn turn(a: DVec3, b: DVec3) -> DVec3 {
    let cross = a.cross(b);
    cross.length().atan2(a.dot(b)) * cross.normalize_or_zero()
}

/// The solid angle of a triangle seen from the origin, signed by its turn.
fn triangle_sr(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let [la, lb, lc] = [a, b, c].map(DVec3::length);
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * a.dot(b.cross(c)).atan2(below)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_octant_is_an_eighth_of_the_sphere() {
        let octant_sr = triangle_sr(DVec3::X * 2.0, DVec3::Y, DVec3::Z * 5.0);
        assert!((octant_sr - PI / 2.0).abs() < 1e-12, "{octant_sr}");
        assert!((triangle_sr(DVec3::Y, DVec3::X, DVec3::Z) + PI / 2.0).abs() < 1e-12);
    }
}
