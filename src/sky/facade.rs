//! From where does the sun strike a facade: its horizontal and vertical shadow angle?
//!
//! The horizontal shadow angle (HSA) is how far the sun stands to the side of the facade's normal, seen from above; the
//! vertical one (VSA) how high it stands in the section at right angles to the facade. With these two a fin and an
//! overhang are sized: a fin of depth d shades d tan |HSA| beside it, an overhang of depth d shades d tan VSA below it.

use super::Sun;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// How the sun stands to an upright facade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShadowAngles {
    /// The sun is in front.
    Front {
        /// To the side of the normal, radians, clockwise from above positive, within a quarter turn.
        horizontal_rad: f64,
        /// Above the horizon in the section at right angles to the facade, radians, 0 to a quarter turn.
        vertical_rad: f64,
    },
    /// The sun is up and behind the facade.
    Behind {
        /// To the side of the normal, radians, beyond a quarter turn and up to a half.
        horizontal_rad: f64,
    },
    /// The sun is at or below the horizon.
    Down,
}

/// The shadow angles of a facade whose normal points to `facade_azimuth_rad`, clockwise from true north.
pub fn shadow_angles(sun: Sun, facade_azimuth_rad: f64) -> ShadowAngles {
    if sun.elevation_rad <= 0.0 {
        return ShadowAngles::Down;
    }
    let turned = (sun.azimuth_rad - facade_azimuth_rad).rem_euclid(TAU);
    let horizontal_rad = if turned > PI { turned - TAU } else { turned };
    if horizontal_rad.abs() > FRAC_PI_2 {
        return ShadowAngles::Behind { horizontal_rad };
    }
    let (sin_elevation, cos_elevation) = sun.elevation_rad.sin_cos();
    // At a right angle the cosine is a rounding error of either sign.
    let ahead = (cos_elevation * horizontal_rad.cos()).max(0.0);
    ShadowAngles::Front { horizontal_rad, vertical_rad: sin_elevation.atan2(ahead) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::towards;

    fn angles(azimuth_deg: f64, elevation_deg: f64, facade_deg: f64) -> ShadowAngles {
        let [azimuth_rad, elevation_rad] = [azimuth_deg, elevation_deg].map(f64::to_radians);
        shadow_angles(Sun { azimuth_rad, elevation_rad }, facade_deg.to_radians())
    }

    /// The overhang's edge and the fin's edge by the ray itself.
    #[test]
    fn shadows_of_an_overhang_and_a_fin_fall_where_rays_say() {
        for (azimuth, elevation, facade) in [(200.0, 30.0, 180.0), (10.0, 50.0, 350.0), (300.0, 80.0, 230.0)] {
            let ShadowAngles::Front { horizontal_rad, vertical_rad } = angles(azimuth, elevation, facade) else {
                panic!("in front");
            };
            let ray = towards(f64::to_radians(azimuth), f64::to_radians(elevation));
            let normal = towards(f64::to_radians(facade), 0.0);
            let right = towards(f64::to_radians(facade + 90.0), 0.0);
            assert!((ray.z / ray.dot(normal) - vertical_rad.tan()).abs() < 1e-9);
            assert!((ray.dot(right) / ray.dot(normal) - horizontal_rad.tan()).abs() < 1e-9);
        }
    }

    #[test]
    fn the_sun_may_be_behind_or_down() {
        assert_eq!(angles(180.0, 0.0, 180.0), ShadowAngles::Down);
        assert_eq!(angles(180.0, -20.0, 180.0), ShadowAngles::Down);
        assert!(matches!(angles(0.0, 20.0, 180.0), ShadowAngles::Behind { .. }));
        let ShadowAngles::Behind { horizontal_rad } = angles(350.0, 20.0, 95.0) else { panic!("behind") };
        assert!((horizontal_rad.to_degrees() + 105.0).abs() < 1e-9);
        // Along the facade, and overhead.
        for found in [angles(90.0, 20.0, 180.0), angles(123.0, 90.0, 180.0)] {
            let ShadowAngles::Front { vertical_rad, .. } = found else { panic!("in front") };
            assert!((vertical_rad - FRAC_PI_2).abs() < 1e-9);
        }
    }
}
