//! Sun and sky: what is asked of them, what they give, and what of it is shown.
//!
//! [`compute`] answers an [`OutdoorRequest`] on the worker's thread, [`sun`] says where the sun stands at the shown moment, [`light`]
//! what it and the sky cast, [`facade`] how it meets a picked face; [`draw`] makes pictures, [`shown`] keeps what is on the screen. All figures are the library's: `lightvein::sky` and `lightvein::daylight`.

pub mod compute;
pub mod draw;
pub mod facade;
pub mod light;
pub mod shown;
pub mod sky;
pub mod sun;
#[cfg(test)]
mod tests;

use crate::measure::Measure;
use lightvein::daylight::Exposure;
use lightvein::daylight::Quantity;
use lightvein::daylight::camera::{Buffers, Camera};
use lightvein::daylight::surface::Patch;
use lightvein::daylight::way::Prepared;
use lightvein::light::Status;
use lightvein::scene::Site;
pub use shown::{OutdoorState, follow_view, seen_by, tick};
use sky::{Scenery, Sky};
use std::sync::Arc;

/// What can be shown; what surfaces reflect is not asked here.
pub const QUANTITIES: [Quantity; 5] =
    [Quantity::Total, Quantity::Beam, Quantity::Sky, Quantity::Svf, Quantity::SunHours];

/// What is asked of sun and sky.
#[derive(Debug, Clone, PartialEq)]
pub struct OutdoorRequest {
    /// Place, air, weather and period; `None` as the scene's file has them.
    pub site: Option<Site>,
    /// Whether exposure is wanted on the faces of the mesh.
    pub on_faces: bool,
    /// Longest side of a patch of a face, metres; `None` such that there are some 20,000.
    pub patch_m: Option<f32>,
    /// The view at whose pixels exposure is wanted.
    pub view: Option<Camera>,
}

impl Default for OutdoorRequest {
    fn default() -> Self {
        Self { site: None, on_faces: true, patch_m: None, view: None }
    }
}

/// What they give. Every part knows what it was made from, and is made again when that has changed.
#[derive(Debug, Clone, Default)]
pub struct OutdoorResults {
    /// The decided site, its sun paths and the exposure map of its period.
    pub sky: Option<Arc<Sky>>,
    /// The mesh, with the user's changes of its parts.
    pub scenery: Option<Arc<Scenery>>,
    /// Exposure on the faces of the mesh as its file has it: what later changes begin from.
    pub unchanged_faces: Option<Arc<FaceExposure>>,
    /// Exposure on the faces as they are now.
    pub faces: Option<Arc<FaceExposure>>,
    /// Exposure at the scene's sensors.
    pub sensors: Option<Arc<SensorExposure>>,
    /// Exposure at the pixels of a view.
    pub pixels: Option<Arc<PixelExposure>>,
    /// What could not be done, and how it was done instead, a sentence each.
    pub notes: Vec<String>,
    /// How long the last run took, seconds.
    pub seconds: f64,
}

/// Exposure on faces.
#[derive(Debug, Clone)]
pub struct FaceExposure {
    /// Parts of faces.
    pub patches: Vec<Patch>,
    /// The number of each patch in the unchanged mesh, ascending.
    pub numbers: Vec<u32>,
    /// What each receives on the side of its normal.
    pub exposures: Vec<Exposure>,
    /// Their longest side, metres.
    pub patch_m: f32,
    /// How many of them were asked again after parts were changed; all where nothing was known.
    pub again: usize,
    /// Whether a better answer is on its way.
    pub is_first_pass: bool,
    /// Under which sky.
    pub sky: Arc<Sky>,
    /// Of which mesh.
    pub scenery: Arc<Scenery>,
}

/// Exposure at sensors.
#[derive(Debug, Clone)]
pub struct SensorExposure {
    /// In the order of the scene's sensors.
    pub exposures: Vec<Exposure>,
    /// Under which sky.
    pub sky: Arc<Sky>,
    /// Among which mesh.
    pub scenery: Arc<Scenery>,
}

/// Exposure at the pixels of a view.
#[derive(Debug, Clone)]
pub struct PixelExposure {
    /// What the camera sees; its size may be a part of the view's.
    pub buffers: Buffers,
    /// Pixels with something behind them, rows from the top.
    pub numbers: Vec<u32>,
    /// What is behind each of them receives.
    pub exposures: Vec<Exposure>,
    /// By which way.
    pub way: Arc<Prepared>,
    /// The view that was asked for.
    pub view: Camera,
    /// Whether a better answer is on its way.
    pub is_first_pass: bool,
    /// Under which sky.
    pub sky: Arc<Sky>,
    /// Of which mesh.
    pub scenery: Arc<Scenery>,
}

impl OutdoorResults {
    /// All values of a measure; empty where there are none.
    pub fn values(&self, measure: Measure) -> Vec<f32> {
        if measure == Measure::MapRadiance {
            return self.sky.as_ref().map_or_else(Vec::new, |sky| sky.radiances());
        }
        let Some(quantity) = Quantity::ALL.into_iter().find(|&quantity| Measure::of(quantity) == measure) else {
            return Vec::new();
        };
        let at_faces = self.faces.iter().map(|faces| faces.exposures.as_slice());
        let at_sensors = self.sensors.iter().map(|sensors| sensors.exposures.as_slice());
        let at_pixels = self.pixels.iter().map(|pixels| pixels.exposures.as_slice());
        at_faces.chain(at_sensors).chain(at_pixels).flat_map(|exposures| values_of(exposures, quantity)).collect()
    }
}

/// A quantity of exposures as it is coloured: NaN where there is no value.
pub fn values_of(exposures: &[Exposure], quantity: Quantity) -> impl Iterator<Item = f32> {
    exposures.iter().map(move |exposure| match exposure.status {
        Status::Ok | Status::Dark => quantity.of(exposure) as f32,
        Status::InSolid | Status::Unreached | Status::Outside => f32::NAN,
    })
}
