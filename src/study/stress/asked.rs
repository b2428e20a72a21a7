//! What all trials share: who is asked, how much is tried, and the truth beside it.

use super::{Row, Trials};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Reading, Settings, Status};
use crate::model::{Model, ModelError};
use crate::rays::Rays;
use crate::scene::{Reference, Scene};
use crate::study::compare::{Contestant, compare};
use crate::trace::trace;
use std::sync::Arc;

/// What all trials share.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// The methods.
    pub contestants: &'a [Contestant<'a>],
    /// How much is tried.
    pub trials: &'a Trials,
    /// Who hears of it.
    pub progress: &'a dyn Progress,
    /// Who stops it.
    pub cancel: &'a Cancel,
}

impl Asked<'_> {
    /// The model of a scene at that voxel size.
    ///
    /// # Errors
    /// As [`Model::build`].
    pub fn model(&self, scene: &Scene, voxel_m: f32) -> Result<Model, ModelError> {
        let rays = Arc::new(Rays::new(scene));
        Model::build(scene, rays, voxel_m, self.trials.max_bytes, self.progress, self.cancel)
    }

    /// What each method says at the scene's sensors, in the order of the methods.
    ///
    /// # Errors
    /// [`Cancelled`] when the run was stopped.
    pub fn fields(&self, scene: &Scene, model: &Model, seed: u64) -> Result<Vec<Field>, Cancelled> {
        let settings = Settings { seed, samples: self.trials.samples, ..Settings::default() };
        let entries = compare(scene, model, self.contestants, &[], &settings, self.progress, self.cancel)?;
        Ok(entries.into_iter().map(|entry| entry.field).collect())
    }

    /// The path-traced truth with so many samples, at up to `most` of the scene's sensors, evenly from first to last; an
    /// entry a sensor. A sensor inside a light has none, nor one that no sample found light for: that is no proof, unless
    /// `zero_is_true`.
    ///
    /// # Errors
    /// [`Cancelled`] when the run was stopped.
    pub fn traced(
        &self,
        scene: &Scene,
        model: &Model,
        samples: u32,
        most: usize,
        zero_is_true: bool,
    ) -> Result<Vec<Option<Reference>>, Cancelled> {
        let count = scene.sensors.len();
        let chosen: Vec<usize> = (0..count.min(most)).map(|place| place * count / count.min(most)).collect();
        let sensors = chosen.iter().filter_map(|&number| scene.sensors.get(number).cloned()).collect();
        let few = Scene { sensors, ..scene.clone() };
        // Random numbers of its own: a method that traces must not be held against itself.
        let settings = Settings { seed: self.trials.seed.wrapping_add(1000), samples, ..Settings::default() };
        let field = trace(&few, &model.rays, &model.sources, &settings, self.progress, self.cancel)?.field;

        let mut truth = vec![None; count];
        for (&number, reading) in chosen.iter().zip(&field.readings) {
            let is_known = reading.value_w_m2 > 0.0 || zero_is_true;
            truth[number] = (reading.status != Status::InSolid && is_known).then(|| known(reading));
        }
        Ok(truth)
    }
}

fn known(reading: &Reading) -> Reference {
    Reference {
        irradiance_w_m2: reading.value_w_m2,
        stderr_w_m2: reading.error_w_m2.unwrap_or(0.0),
        flux_w_m2: reading.flux_w_m2,
    }
}

/// A trial that could not be modelled: its rows say why. What stops the run stops it here too.
///
/// # Errors
/// [`Cancelled`] when that is why.
pub fn not_modelled(rows: &mut [Row], error: &ModelError) -> Result<(), Cancelled> {
    if error.is_cancelled() {
        return Err(Cancelled);
    }
    rows.iter_mut().for_each(|row| row.warn([&error.to_string()], &[]));
    Ok(())
}
