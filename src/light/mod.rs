//! How much light arrives, and from where: the question every estimator is asked and the answer it gives.
//!
//! [`Sources`] are what shines, [`Settings`] what the caller chooses, a [`Field`] is the answer at the scene's sensors in
//! their order. Estimators (`flow`) and truth (`trace`) share these and never import each other. What a scene's sources
//! are, and where each stands, is in `sources`; how to draw a direction towards one, in `sampling`; what guides a tracer, in
//! `lobes`.

mod lobes;
mod sampling;
mod sources;

pub use lobes::{Guiding, Incident, Lobe, MOST_LOBES};
pub use sampling::{Emission, LightSample, Sampler};
pub use sources::Aim;

use crate::scene::Light;
use glam::{DVec3, Vec3};

/// Everything that shines in a scene: its lights, then one entry for each connected patch of emissive mesh faces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sources {
    /// In the scene's order, patches last.
    pub emitters: Vec<Emitter>,
}

/// One thing that shines.
#[derive(Debug, Clone, PartialEq)]
pub struct Emitter {
    /// Its body.
    pub shape: Shape,
    /// Its total flux, W.
    pub flux_w: f64,
}

/// The body of an emitter.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// The light of that number in [`Scene::lights`](crate::scene::Scene::lights).
    Light(usize, Light),
    /// Mesh triangles that give off `radiance_w_m2_sr` on their front side.
    Patch {
        /// Numbers of the triangles, ascending.
        triangles: Vec<u32>,
        /// Their radiance, W/m2/sr.
        radiance_w_m2_sr: f64,
        /// Their area, m2.
        area_m2: f64,
        /// Their area-weighted centre, metres.
        centroid_m: Vec3,
        /// Their area-weighted mean front normal, unit length (zero for a closed body).
        normal: Vec3,
    },
}

/// What a caller chooses for an estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Samples a sensor, for the path tracer.
    pub samples: u32,
    /// Most reflections a path may have; `None` for no bound, where Russian roulette ends it.
    pub max_bounces: Option<u32>,
    /// Whether the part of each emitter is asked for too ([`Field::shares`]).
    pub shares: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { seed: 0, samples: 1024, max_bounces: None, shares: false }
    }
}

/// What became of a sensor; never a silent zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// It has a value.
    Ok,
    /// No light reaches it: a true zero.
    Dark,
    /// It lies inside matter, and faces no void that could stand for it.
    InSolid,
    /// No path through the void joins it to any light.
    Unreached,
    /// It lies outside the modelled domain.
    Outside,
}

impl Status {
    /// Its name in tables and files.
    pub const fn name(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Dark => "dark",
            Status::InSolid => "in_solid",
            Status::Unreached => "unreached",
            Status::Outside => "outside",
        }
    }
}

/// The answer at one sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Irradiance (sensor with a normal) or scalar irradiance (without), W/m2.
    pub value_w_m2: f64,
    /// Integral of L(w) w dw, w pointing away from the sensor (with a normal: over its hemisphere), W/m2.
    pub flux_w_m2: DVec3,
    /// The method's own estimate of the error of the value, one standard deviation, W/m2; `None` where it has none.
    pub error_w_m2: Option<f64>,
    /// What became of the sensor.
    pub status: Status,
}

impl Reading {
    /// A reading without light, for the reason that `status` gives.
    pub const fn none(status: Status) -> Self {
        Self { value_w_m2: 0.0, flux_w_m2: DVec3::ZERO, error_w_m2: None, status }
    }

    /// Where most light comes from: the net flux at unit length, zero where there is none.
    pub fn direction(&self) -> DVec3 {
        self.flux_w_m2.normalize_or_zero()
    }
}

/// Readings at the scene's sensors, in their order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Field {
    /// One a sensor.
    pub readings: Vec<Reading>,
    /// What a reader of the field should know, a sentence each.
    pub warnings: Vec<String>,
    /// The part of each emitter in each reading, where [`Settings::shares`] asked for it and the method can tell.
    pub shares: Option<Shares>,
}

/// What each emitter gives to each reading.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shares {
    /// How many emitters there are: the length of a row.
    pub emitters: usize,
    /// A row a reading: what each emitter of [`Sources::emitters`] adds to its value, W/m2.
    pub values_w_m2: Vec<f64>,
}

impl Shares {
    /// The row of a reading; empty for a number beyond the last.
    pub fn of(&self, reading: usize) -> &[f64] {
        let first = reading * self.emitters;
        self.values_w_m2.get(first..first + self.emitters).unwrap_or_default()
    }
}

impl Light {
    /// Its total flux, W.
    pub fn flux_w(&self) -> f64 {
        match *self {
            Light::Point { flux_w, .. } | Light::Sphere { flux_w, .. } | Light::Quad { flux_w, .. } => flux_w,
        }
    }
}
