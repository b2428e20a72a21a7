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

pub mod errors;
mod settings;
pub mod truth;

pub use settings::{Classes, Filter, MOST_LAYERS, Method, Overlap, RESOLUTIONS, Settings, Split};

use crate::camera::Camera;
use glam::Vec3;

/// A view under a sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From where.
    pub camera: Camera,
    /// Width and height of the picture.
    pub size_px: [u32; 2],
    /// Of length one, in the scene's space.
    pub towards_sun: Vec3,
}

/// What a frame shows at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lit {
    /// Share of the sun that the maps let through, 0 to 1; not asked of surfaces that face away.
    pub share: f32,
    /// Along the gaze, metres.
    pub depth_m: f32,
}
