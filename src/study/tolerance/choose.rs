//! The search for the coarsest voxels and the cheapest quality that are good enough.

use super::{Choice, Skipped, agreement, expected, own_factor};
use crate::flow::Rung;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Settings};
use crate::model::choose::MOST_VOXELS;
use crate::model::{Model, ModelError, Probe};
use crate::voxel::VoxelError;

/// Halvings of the voxels for the sake of the answers, after those for the sake of passages: each takes eight times as long,
/// and answers that still differ then differ for another reason.
const MOST_HALVINGS: usize = 2;

/// What a search found.
pub struct Chosen {
    /// The model.
    pub model: Model,
    /// The number of the rung.
    pub rung: usize,
    /// Its answers at the probes.
    pub field: Field,
    /// What was chosen, and why.
    pub choice: Choice,
}

/// What is searched through, and how.
pub struct Search<'a> {
    /// The qualities of all methods, ascending in cost.
    pub rungs: &'a [Rung],
    /// The factor within which the answer is to be right.
    pub tolerance: f64,
    /// The settings of each estimate.
    pub settings: &'a Settings,
    /// Where a model is asked.
    pub probes: &'a dyn Fn(&Model) -> Vec<Probe>,
    /// Makes a model with voxels of that edge.
    pub build: &'a dyn Fn(f32) -> Result<Model, ModelError>,
}

impl Search<'_> {
    /// Chooses voxels and quality: `model` is the coarsest that may do, made for that `reason`; `finer` the one of voxels
    /// half as large, where there is one. Each model is made once. `None` without a rung.
    ///
    /// # Errors
    /// As [`Model::build`]; a finer model that does not fit ends the search.
    pub fn run(
        &self,
        mut model: Model,
        mut finer: Option<Model>,
        reason: String,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Option<Chosen>, ModelError> {
        let Self { rungs, tolerance, settings, probes, build } = *self;
        let mut modelled = vec![reason];
        let mut halvings = 0;
        loop {
            let Some(quality) = self.quality(&model, progress, cancel)? else {
                return Ok(None);
            };
            let voxel_m = model.voxels.lattice.voxel_m;
            let mut skipped = quality.skipped;
            let mut expected_factor = quality.expected_factor;
            let mut next = None;
            match finer.take() {
                None => modelled.push(format!("voxels of {voxel_m} m alone: no other size to hold them against")),
                Some(fine) => {
                    let estimate = &rungs[quality.rung].estimate;
                    progress.begin("on finer voxels", 0);
                    let field = estimate(&fine, &probes(&fine), settings, progress, cancel)?;
                    progress.end();
                    let differs = agreement(&quality.field.readings, &field.readings);
                    let fine_m = fine.voxels.lattice.voxel_m;
                    expected_factor = expected_factor.map(|factor| expected(differs, factor));
                    let is_good = expected_factor.is_some_and(|factor| factor <= tolerance);
                    if is_good || halvings == MOST_HALVINGS {
                        let why = format!("answers differ by a factor of {differs:.2} from those of {voxel_m} m");
                        skipped.push(Skipped { what: format!("voxels of {fine_m} m"), why });
                    } else {
                        modelled.push(format!(
                            "voxels of {fine_m} m: those of {voxel_m} m differ by a factor of {differs:.2}"
                        ));
                        next = Some(fine);
                    }
                }
            }
            let Some(fine) = next else {
                modelled.extend(quality.modelled);
                let method = rungs[quality.rung].label();
                let choice = Choice { tolerance, voxel_m, method, expected_factor, modelled, skipped };
                return Ok(Some(Chosen { model, rung: quality.rung, field: quality.field, choice }));
            };
            halvings += 1;
            finer = half_as_large(&fine, build)?;
            model = fine;
        }
    }

    /// The cheapest rung that agrees with the next dearer one, within what that one's own error leaves; the dearest where none
    /// does. `None` without a rung.
    ///
    /// # Errors
    /// [`Cancelled`] when `cancel` was raised.
    pub fn quality(
        &self,
        model: &Model,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Option<Quality>, Cancelled> {
        let Self { rungs, tolerance, settings, .. } = *self;
        let probes = (self.probes)(model);
        let mut skipped = Vec::new();
        // The last one that could tell its error, and that error.
        let mut before: Option<(usize, Field, f64)> = None;
        let mut voiceless: Option<(usize, Field)> = None;
        for (number, rung) in rungs.iter().enumerate() {
            progress.begin(&rung.label(), 0);
            let field = (rung.estimate)(model, &probes, settings, progress, cancel)?;
            progress.end();
            let Some(own) = own_factor(&field.readings) else {
                skipped.push(Skipped { what: rung.label(), why: "has no error estimate of its own".to_owned() });
                voiceless = Some((number, field));
                continue;
            };
            if let Some((cheaper, cheaper_field, cheaper_own)) = before.take() {
                let differs = agreement(&cheaper_field.readings, &field.readings);
                let factor = expected(differs, own);
                let label = rungs[cheaper].label();
                if factor <= tolerance && cheaper_own <= tolerance {
                    let why = format!("not needed, {label} differs from it by a factor of {differs:.2}");
                    skipped.push(Skipped { what: rung.label(), why });
                    let dearer = rungs.iter().skip(number + 1);
                    skipped.extend(dearer.map(|rung| Skipped { what: rung.label(), why: "not needed".to_owned() }));
                    let modelled = vec![format!("{label}: held against {}", rung.label())];
                    let (field, expected_factor) = (cheaper_field, Some(factor));
                    return Ok(Some(Quality { rung: cheaper, field, expected_factor, modelled, skipped }));
                }
                let why = format!(
                    "off by a factor of {cheaper_own:.2} by its own estimate, {differs:.2} from {}",
                    rung.label()
                );
                skipped.push(Skipped { what: label, why });
            }
            before = Some((number, field, own));
        }
        let dearest = before.map(|(rung, field, own)| {
            let modelled = vec![format!("{}: the finest there is, its error by its own estimate", rungs[rung].label())];
            Quality { rung, field, expected_factor: Some(own), modelled, skipped: skipped.clone() }
        });
        Ok(dearest.or_else(|| {
            let (rung, field) = voiceless?;
            // It was noted as skipped, and is all there is.
            skipped.pop();
            let modelled = vec![format!("{}: has no error estimate of its own", rungs[rung].label())];
            Some(Quality { rung, field, expected_factor: None, modelled, skipped })
        }))
    }
}

/// The model of voxels half as large; `None` where it would not fit.
fn half_as_large(model: &Model, build: &dyn Fn(f32) -> Result<Model, ModelError>) -> Result<Option<Model>, ModelError> {
    if 8 * model.voxels.lattice.voxels() > MOST_VOXELS {
        return Ok(None);
    }
    match build(model.voxels.lattice.voxel_m / 2.0) {
        Err(ModelError::Voxel(VoxelError::TooLarge { .. })) => Ok(None),
        built => built.map(Some),
    }
}

/// A quality that was found.
pub struct Quality {
    /// The number of the rung.
    pub rung: usize,
    /// Its answers.
    pub field: Field,
    /// The factor by which they are expected to be off.
    pub expected_factor: Option<f64>,
    /// What was run, and what it told.
    pub modelled: Vec<String>,
    /// What was not chosen, and why.
    pub skipped: Vec<Skipped>,
}
