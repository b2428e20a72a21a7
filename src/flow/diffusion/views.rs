//! What does a point see through the necks around it?
//!
//! A room has one potential, but from beside a door one looks into the next room: over the solid angle of the opening the
//! radiance is that of the other side. Radiance of diffuse light is `phi / (4 pi)`, so an opening of solid angle `Omega`
//! changes the scalar irradiance by `(phi_other - phi_own) Omega / (4 pi)`; in the opening itself, where `Omega` is `2 pi`,
//! the two sides meet half way. Solid angles are those of the outline (van Oosterom & Strackee 1983), the net flux through it
//! is Lambert's sum over its edges.
//!
//! Limits: an opening counts whole where its middle is in view, else not at all, and what is seen through it is the mean light
//! beyond.

use crate::model::Model;
use crate::skeleton::Neck;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Corners of the outline that are left out between two that count.
const STRIDE: usize = 4;

/// An opening as a point sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Its solid angle, steradians; above `2 pi` for a point that has passed through.
    pub solid_angle_sr: f64,
    /// The integral of the directions in it, pointing away from the point; its length is at most `pi`.
    pub flux: DVec3,
}

/// What a point on the side of the neck's cell number `side` (0 or 1) sees of it, unless something opaque is before its middle;
/// weakened by glazing.
pub fn view(model: &Model, neck: &Neck, side: usize, point_m: Vec3) -> Option<View> {
    let share = f64::from(model.rays.transmitted(point_m, neck.position_m));
    let corners: Vec<DVec3> =
        neck.outline_m.iter().step_by(STRIDE).map(|corner_m| (*corner_m - point_m).as_dvec3()).collect();
    if share <= 0.0 || corners.len() < 3 {
        return None;
    }
    let centre = (neck.centre_m - point_m).as_dvec3();
    let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
    let solid_angle_sr = edges().map(|(a, b)| triangle_sr(centre, *a, *b)).sum::<f64>().abs();
    let flux: DVec3 = edges().map(|(a, b)| a.angle_between(*b) * a.cross(*b).normalize_or_zero()).sum::<DVec3>() / 2.0;

    let outwards = if side == 0 { neck.normal } else { -neck.normal }.as_dvec3();
    let passed = outwards.dot((neck.position_m - point_m).as_dvec3()) < 0.0;
    let flux = if flux.dot(outwards) < 0.0 { -flux } else { flux };
    let solid_angle_sr = if passed { 4.0 * PI - solid_angle_sr } else { solid_angle_sr };
    Some(View { solid_angle_sr: share * solid_angle_sr, flux: share * flux })
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
