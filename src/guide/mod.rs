//! What is a renderer seeded with?
//!
//! All that Lightvein knows of the light in a scene, in the forms that renderers take: lobes of incident light at nodes and on
//! walls (guided path tracing), necks as polygons with their flux (portals), virtual point lights (Keller 1997), probes with
//! spherical harmonics of first order (Ramamoorthi & Hanrahan 2001), records of an irradiance cache (Ward, Rubinstein & Clear
//! 1988), and samples that train a guiding library (OpenPGL). Everything comes from one [`Network`](crate::flow::network): its
//! lines have measured the exchange of light, and say from where it comes.
//!
//! Limits: those of the network. What the voxels close has no place of its own.

pub mod fit;
pub mod places;
pub mod shine;

use crate::light::Incident;
use glam::Vec3;

/// What a renderer is seeded with. Positions are the scene's own, metres.
#[derive(Debug, Clone, Default)]
pub struct Guide {
    /// The light at each node of the skeleton, in their order.
    pub nodes: Vec<Place>,
    /// The light on walls: every zone of the void has a point on each side it sees.
    pub walls: Vec<Place>,
    /// The doorways and windows, those of the skeleton in their order.
    pub necks: Vec<Opening>,
    /// Virtual point lights.
    pub vpls: Vec<VirtualLight>,
    /// Where light probes stand.
    pub probes: Vec<LightProbe>,
    /// Records of an irradiance cache, one for each of [`Guide::walls`].
    pub cache: Vec<CacheRecord>,
    /// What trains a guiding library.
    pub samples: Vec<TrainingSample>,
    /// What a reader should know, a sentence each.
    pub warnings: Vec<String>,
}

/// A place and the light that comes to it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Place {
    /// Lobes, and irradiance by part.
    pub incident: Incident,
    /// Scalar irradiance by all light, W/m2.
    pub scalar_w_m2: f32,
    /// The share of each emitter of [`Sources`](crate::light::Sources) in it, all reflections counted; they add up to 1, or
    /// are all 0 where there is no light.
    pub shares: Vec<f32>,
    /// The cell (room) it lies in; `u32::MAX` where it lies in none.
    pub cell: u32,
}

/// A neck as a surface that light flows through.
#[derive(Debug, Clone, PartialEq)]
pub struct Opening {
    /// The cells it joins.
    pub cells: [u32; 2],
    /// Its middle, metres.
    pub position_m: Vec3,
    /// Unit normal, from the first cell to the second.
    pub normal: Vec3,
    /// Its area, m2.
    pub area_m2: f32,
    /// Its border in order, metres.
    pub outline_m: Vec<Vec3>,
    /// What flows through it from the first cell to the second, and back, W.
    pub flux_w: [f64; 2],
}

/// A point on a wall that shines as the wall around it does: Lambertian, on the side of its normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VirtualLight {
    /// Where, metres.
    pub position_m: Vec3,
    /// Unit normal of the side it shines on.
    pub normal: Vec3,
    /// The flux it sends out, W.
    pub flux_w: f64,
    /// The cell it shines into.
    pub cell: u32,
}

/// A place for a light probe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightProbe {
    /// Where, metres.
    pub position_m: Vec3,
    /// Distance to the nearest wall, metres.
    pub radius_m: f32,
    /// The cell it stands in.
    pub cell: u32,
    /// Incident radiance in real spherical harmonics of orders 0 and 1: (0,0), (1,-1), (1,0), (1,1), which follow 1, y, z, x;
    /// orthonormal, without the Condon-Shortley phase, W/m2/sr.
    pub sh_w_m2_sr: [f32; 4],
}

/// A record of an irradiance cache.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CacheRecord {
    /// Where, metres.
    pub position_m: Vec3,
    /// Unit normal of the surface.
    pub normal: Vec3,
    /// Irradiance by reflected light, W/m2: what a renderer that samples its lights caches.
    pub reflected_w_m2: f32,
    /// Irradiance by all light, W/m2.
    pub irradiance_w_m2: f32,
    /// Harmonic mean distance to what the point sees, metres: Ward's validity radius.
    pub radius_m: f32,
}

/// A sample of incident radiance, as guiding libraries train on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrainingSample {
    /// Where, metres, on a surface.
    pub position_m: Vec3,
    /// Unit direction that the light comes from.
    pub direction: Vec3,
    /// Radiance over density, W/m2.
    pub weight_w_m2: f32,
    /// Density of the direction, per steradian.
    pub density_per_sr: f32,
    /// Distance to what shines, metres.
    pub distance_m: f32,
    /// Bit 0: what shines is an emitter itself (else a wall that reflects).
    pub flags: u32,
}
