//! What does the sky give: where the sun stands, how bright each direction of the sky is, what a period brings?
//!
//! Azimuths run clockwise from true north, elevations up from the horizon; directions are unit vectors with x east, y true
//! north, z up. A scene that is turned against true north turns them itself (`north_deg` of its site).
//! Radians inside, degrees in files and on the command line.
//!
//! [`sun`] says where the sun stands, [`events`] when it rises and sets, [`facade`] how it meets a wall, [`clear`] how strong
//! it is when no cloud is there; [`simple_sun`] is the short formula of graphics, for comparison.
//!
//! [`hosek`] is the brightness of a clear sky by direction, in RGB and by band, [`spectrum`] what beam and sky bring by
//! wavelength, [`efficacy`] how much of it the eye sees, [`disc`] how the beam is spread over the sun, [`colour`] the sky's colour,
//! [`harmonics`] what it casts on a surface, [`picture`] a fisheye of it all.

pub mod clear;
pub mod colour;
pub mod disc;
pub mod dome;
pub mod efficacy;
pub mod events;
pub mod facade;
pub mod harmonics;
pub mod hosek;
pub mod lit;
pub mod map;
pub mod moment;
pub mod perez;
pub mod picture;
pub mod simple_sun;
pub mod site;
pub mod spectrum;
pub mod steps;
pub mod sun;
pub mod term;
pub mod weather;

use glam::DVec3;
use std::f64::consts::TAU;

/// A place on earth and its clock: local standard time, without daylight saving.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Latitude, radians, north positive, within a quarter turn.
    pub latitude_rad: f64,
    /// Longitude, radians, east positive, within half a turn.
    pub longitude_rad: f64,
    /// Zone, hours ahead of UTC, -14 to 14.
    pub utc_offset_h: f64,
    /// Height above the sea, metres.
    pub altitude_m: f64,
}

impl Place {
    /// A place by degrees, at the height of the sea.
    pub fn from_degrees(latitude_deg: f64, longitude_deg: f64, utc_offset_h: f64) -> Self {
        Self {
            latitude_rad: latitude_deg.to_radians(),
            longitude_rad: longitude_deg.to_radians(),
            utc_offset_h,
            altitude_m: 0.0,
        }
    }
}

/// Where the sun stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sun {
    /// Clockwise from true north, radians, 0 up to a whole turn.
    pub azimuth_rad: f64,
    /// Above the horizon, radians; negative below it.
    pub elevation_rad: f64,
}

impl Sun {
    /// The direction to the sun: x east, y true north, z up, unit length.
    pub fn towards(&self) -> DVec3 {
        towards(self.azimuth_rad, self.elevation_rad)
    }
}

/// The direction of an azimuth (clockwise from true north) and an elevation, radians: x east, y true north, z up.
pub fn towards(azimuth_rad: f64, elevation_rad: f64) -> DVec3 {
    let (sin_azimuth, cos_azimuth) = azimuth_rad.sin_cos();
    let (sin_elevation, cos_elevation) = elevation_rad.sin_cos();
    DVec3::new(sin_azimuth * cos_elevation, cos_azimuth * cos_elevation, sin_elevation)
}

/// Azimuth (0 up to a whole turn; 0 at zenith and nadir) and elevation of a direction of any length but 0, radians.
pub fn azimuth_elevation_rad(direction: DVec3) -> (f64, f64) {
    let azimuth_rad = direction.x.atan2(direction.y).rem_euclid(TAU);
    let flat = direction.x.hypot(direction.y);
    // A tiny negative angle becomes a whole turn in rounding.
    (if azimuth_rad < TAU { azimuth_rad } else { 0.0 }, direction.z.atan2(flat))
}

/// A number inside bounds; NaN becomes the lower one.
fn within(value: f64, (low, high): (f64, f64)) -> f64 {
    value.max(low).min(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn azimuths_run_clockwise_from_north() {
        assert!(towards(0.0, 0.0).abs_diff_eq(DVec3::Y, 1e-15));
        assert!(towards(FRAC_PI_2, 0.0).abs_diff_eq(DVec3::X, 1e-15));
        assert!(towards(1.0, FRAC_PI_2).abs_diff_eq(DVec3::Z, 1e-15));
        for (azimuth, elevation) in [(0.1, 0.2), (3.0, -1.0), (6.2, 1.5)] {
            let (a, e) = azimuth_elevation_rad(towards(azimuth, elevation) * 7.0);
            assert!((a - azimuth).abs() < 1e-12 && (e - elevation).abs() < 1e-12);
        }
        assert_eq!(azimuth_elevation_rad(DVec3::new(-1e-300, 1.0, 0.0)).0, 0.0);
    }
}
