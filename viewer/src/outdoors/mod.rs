//! Sun and sky: what is asked of them, what they give, and what of it is shown.
//!
//! [`compute`] answers an [`OutdoorRequest`] on the worker's thread, [`sun`] says where the sun stands at the shown moment, and
//! [`draw`] makes pictures of both. All figures are the library's: `lightvein::sky` and `lightvein::daylight`.

pub mod compute;
pub mod draw;
pub mod sky;
pub mod sun;

use crate::measure::Measure;
use crate::state::State;
use glam::Vec2;
use jiff::civil::{Date, DateTime, date};
use lightvein::daylight::Exposure;
use lightvein::daylight::Quantity;
use lightvein::daylight::camera::{Buffers, Camera};
use lightvein::daylight::surface::Patch;
use lightvein::daylight::way::Prepared;
use lightvein::light::Status;
use lightvein::scene::Site;
use sky::{Scenery, Sky};
use std::sync::Arc;

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

/// Sun and sky as the panels show them.
#[derive(Debug, Clone)]
pub struct OutdoorState {
    /// The day that is shown.
    pub date: Date,
    /// The time that is shown, hours since midnight, local standard time.
    pub time_h: f64,
    /// Whether the shown time runs.
    pub is_playing: bool,
    /// How fast it runs, hours a second.
    pub hours_a_second: f64,
    /// Whether it goes on to the next day at midnight, instead of beginning the same one again.
    pub runs_on: bool,
}

impl Default for OutdoorState {
    fn default() -> Self {
        Self { date: date(2025, 6, 21), time_h: 12.0, is_playing: false, hours_a_second: 2.0, runs_on: false }
    }
}

impl OutdoorState {
    /// The shown moment.
    pub fn moment(&self) -> DateTime {
        let seconds = (self.time_h.clamp(0.0, 24.0) * 3600.0).round().min(86_399.0) as i64;
        let midnight = self.date.at(0, 0, 0, 0);
        midnight.checked_add(jiff::SignedDuration::from_secs(seconds)).unwrap_or(midnight)
    }

    /// Lets so many seconds of the viewer's own time go by.
    pub fn play(&mut self, seconds: f64) {
        if !self.is_playing {
            return;
        }
        let later_h = self.time_h + seconds * self.hours_a_second;
        if self.runs_on && later_h >= 24.0 {
            self.date = self.date.tomorrow().unwrap_or(self.date);
        }
        self.time_h = later_h.rem_euclid(24.0);
    }
}

/// Asks for the pixels of the view as it is now, or no more; to be called when the camera has come to rest. A view is looked at
/// and not changed by hand, so it is no step to undo.
pub fn follow_view(state: &mut State, size_px: Vec2) {
    let wanted = state.layers.per_pixel.then(|| seen_by(&state.camera, size_px)).flatten();
    if let Some(asked) = &mut state.request.outdoors
        && asked.view != wanted
    {
        asked.view = wanted;
    }
}

/// The camera of the view as the library has it; `None` for a parallel projection, which it does not know.
pub fn seen_by(camera: &crate::camera::Camera, size_px: Vec2) -> Option<Camera> {
    let size = [size_px.x.round() as usize, size_px.y.round() as usize];
    let is_picture = size.iter().all(|side| (1..=10_000).contains(side));
    (is_picture && !camera.orthographic).then(|| Camera {
        from_m: camera.eye_m(),
        forward: camera.forward(),
        right: camera.right(),
        up: camera.up(),
        fov_rad: f64::from(camera.field_of_view_rad),
        size,
    })
}
