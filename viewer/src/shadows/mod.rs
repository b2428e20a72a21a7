//! Where does the sun strike, in real time? Shadow maps: plain, percentage-closer, variance, layered variance, cascaded and
//! hybrid, from the same passes and apart by a few [`Settings`].
//!
//! Method: the scene's depth is drawn from the sun into one map or several; where the filter asks for it, the depth's first
//! two moments are made of it, and a point is in the sun by comparison or by Chebyshev's bound. The hybrid map of Kolivand &
//! Sunar ("Real-time outdoor rendering using hybrid shadow maps", 2012) divides what is seen by a logarithm that starts at the
//! first object and gives far layers fewer and shorter numbers.
//!
//! Limits: opaque casters only, glazing casts nothing; a sun without extent (the softness of a filter is no penumbra); at most
//! [`MOST_LAYERS`] layers.

mod casters;
mod maps;
mod plan;
mod settings;
mod studio;
pub mod study;

pub use casters::Casters;
pub use maps::Maps;
pub use plan::{Layer, LightMap, Plan, Seen};
pub use settings::{Class, Classes, Filter, MOST_LAYERS, Method, Overlap, RESOLUTIONS, Settings, Split};
pub use studio::{Lit, Studio};

use crate::camera::Camera;
use glam::Vec3;

/// A view under a sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From where.
    pub camera: Camera,
    /// Pixels.
    pub size_px: [u32; 2],
    /// Direction to the sun, of length one, in scene space.
    pub towards_sun: Vec3,
}

#[cfg(test)]
mod tests;
