//! What does a surface receive from sun and sky over a period?
//!
//! [`Exposure`] is the answer at a sensor: the beam of the sun, the light of the sky, how much of the sky is seen. [`cast`]
//! finds it by rays, to every sun or to some, and to as many directions of the sky as are asked for: with all of them the
//! truth that faster ways are held to. What surfaces reflect, and with it what comes into rooms round corners, is found by
//! [`reflect`] through the skeleton; without it `reflected` is 0.

pub mod beams;
pub mod camera;
pub mod cast;
pub mod choose;
pub mod dynamic;
mod quantity;
pub mod reflect;
pub mod scales;
pub mod surface;
pub mod way;

pub use quantity::Quantity;

use crate::light::Status;
use crate::scene::Sensor;
use glam::Vec3;

/// Where exposure is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Where it is, on its surface, metres.
    pub position_m: Vec3,
    /// Unit normal of the side that is asked for; `None` for light from all around, unweighted.
    pub normal: Option<Vec3>,
}

impl From<&Sensor> for Point {
    fn from(sensor: &Sensor) -> Self {
        Self { position_m: sensor.position_m, normal: sensor.normal }
    }
}

/// The sensors of a scene as points, in their order.
pub fn points(sensors: &[Sensor]) -> Vec<Point> {
    sensors.iter().map(Point::from).collect()
}

/// What a point receives over a period. With a normal: on that side of a plane, weighted by the cosine; without one: from all
/// around, unweighted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// From the sun, kWh/m2.
    pub beam_kwh_m2: f64,
    /// From the sky, kWh/m2.
    pub sky_kwh_m2: f64,
    /// From surfaces, kWh/m2.
    pub reflected_kwh_m2: f64,
    /// Standard error of sun and sky together, kWh/m2.
    pub error_kwh_m2: f64,
    /// Sky view factor, 0 to 1: the visible part of the sky, by the cosine to the normal (open ground 1, a wall 0.5);
    /// without a normal by solid angle.
    pub svf: f64,
    /// Hours in which the sun shines on it.
    pub sun_h: f64,
    /// Whether it has a value, sees nothing, or lies inside something.
    pub status: Status,
}

impl Exposure {
    /// Nothing, for a reason.
    pub fn none(status: Status) -> Self {
        Self {
            beam_kwh_m2: 0.0,
            sky_kwh_m2: 0.0,
            reflected_kwh_m2: 0.0,
            error_kwh_m2: 0.0,
            svf: 0.0,
            sun_h: 0.0,
            status,
        }
    }

    /// All parts together, kWh/m2.
    pub fn total_kwh_m2(&self) -> f64 {
        self.beam_kwh_m2 + self.sky_kwh_m2 + self.reflected_kwh_m2
    }
}
