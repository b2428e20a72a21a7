//! How far off a surface must a ray start, so that it does not hit what it starts on?
//!
//! Rounding moves corners, points and hits by some steps of `f32` at the scene's largest coordinate. In shares of that
//! coordinate (planes of any tilt, scenes of 0.4 to 40 km, a million rays): hits lie up to 4e-7 off their surface, and a ray
//! that starts 2e-7 off its own does not hit it. A small scene can afford many times that. A city cannot: 1e-5 of 5 km are
//! 5 cm, which lift a sensor through a balcony's railing.

use super::Rays;
use glam::Vec3;

/// Share of the largest coordinate that points on surfaces are kept off them: 84 steps of `f32`.
const SHARE: f32 = 1e-5;

/// The same in scenes so large that details suffer: five times what hits have been seen to be off.
const LEAST_SHARE: f32 = 2e-6;

/// Details suffer from here on, metres.
const LARGE_M: f32 = 2e-3;

/// Share of the largest coordinate that rays need to leave a flat surface: 4 steps of `f32`, more than twice what it took.
const LEAVING_SHARE: f32 = 5e-7;

/// The epsilon of a scene by its largest coordinate: 0.1 mm at 10 m, 2 mm from 200 m to 1 km, 1 cm at 5 km.
pub(super) fn epsilon_m(largest_m: f32) -> f32 {
    (SHARE * largest_m).min(LARGE_M.max(LEAST_SHARE * largest_m))
}

/// How far off a surface rays start at least, where the surface has been measured from near by.
pub(super) fn leaving_m(largest_m: f32) -> f32 {
    LEAVING_SHARE * largest_m
}

impl Rays {
    /// How far to lift a point off its surface, along the normal, before a ray starts there, metres: 1e-5 of the scene's
    /// largest coordinate up to 2 mm, at least 2e-6 of it. It also bounds the error of a hit's position.
    pub fn epsilon_m(&self) -> f32 {
        self.epsilon_m
    }

    /// Where rays start for a point on a surface, or a millimetre off it as sensors are put. A surface within the epsilon is
    /// left by a fraction of that, for it is measured from near by; a point that stands off by as much already stays where it
    /// is, for in narrow places each millimetre counts. Costs one ray. Without a normal no side is known, and the point stays.
    pub fn off_surface(&self, point_m: Vec3, normal: Option<Vec3>) -> Vec3 {
        let Some(normal) = normal else { return point_m };
        // Seen from above, so that a surface which rounding has put just above the point is met too.
        let above_m = point_m + self.epsilon_m * normal;
        match self.closest(above_m, -normal, 2.0 * self.epsilon_m) {
            Some(surface) if surface.distance_m < self.epsilon_m + self.leaving_m => {
                above_m + (self.leaving_m - surface.distance_m) * normal
            }
            _ => point_m,
        }
    }
}
