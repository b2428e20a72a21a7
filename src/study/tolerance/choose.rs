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
                skipped.push(sky(&model));
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

/// Why no light comes from the sky.
fn sky(model: &Model) -> Skipped {
    let is_open = model.voxels.voids.iter().any(|part| part.leaks);
    let why =
        if is_open { "the void is open to it, but no method here takes light from it" } else { "the void is sealed" };
    Skipped { what: "sky".to_owned(), why: why.to_owned() }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{FLUX_W, lamp, model_of, modelled, room, sensor};
    use crate::job::Quiet;
    use crate::light::{Reading, Status};
    use crate::scene::Method;
    use glam::{DVec3, Vec3};
    use std::cell::RefCell;
    use std::sync::Arc;

    /// A quality that answers `value` times (1 + `per_metre` x voxel edge), off by `error` of it by its own estimate.
    fn rung(quality: &str, value: f64, error: Option<f64>, per_metre: f64) -> Rung {
        let estimate = move |model: &Model, probes: &[Probe], _: &Settings, _: &dyn Progress, _: &Cancel| {
            let value_w_m2 = value * (1.0 + per_metre * f64::from(model.voxels.lattice.voxel_m));
            let error_w_m2 = error.map(|error| error * value_w_m2);
            let reading = Reading { value_w_m2, flux_w_m2: DVec3::ZERO, error_w_m2, status: Status::Ok };
            Ok(Field { readings: vec![reading; probes.len()], ..Field::default() })
        };
        Rung { method: Method::Forward, quality: quality.to_owned(), estimate: Box::new(estimate) }
    }

    /// What is chosen, at which voxel edge, the factor expected, and the voxel edges that had to be made for it.
    fn chosen(rungs: &[Rung], tolerance: f64, has_finer: bool) -> (String, f32, Option<f64>, Vec<f32>) {
        let lights = vec![lamp(Vec3::splat(1.5), FLUX_W)];
        let (scene, model) = modelled(&room(), lights, vec![sensor(Vec3::splat(1.0), None)]);
        let made = RefCell::new(Vec::new());
        let rays = Arc::clone(&model.rays);
        let build = |voxel_m: f32| {
            made.borrow_mut().push(voxel_m);
            Model::build(&scene, rays.clone(), voxel_m, u64::MAX, &Quiet, &Cancel::new())
        };
        let finer = has_finer.then(|| {
            Model::build(&scene, rays.clone(), model.voxels.lattice.voxel_m / 2.0, u64::MAX, &Quiet, &Cancel::new())
                .unwrap()
        });
        let settings = Settings::default();
        let probes = |model: &Model| model.probes_at_sensors(&scene);
        let search = Search { rungs, tolerance, settings: &settings, probes: &probes, build: &build };
        let model = model_of(&scene);
        let found = search.run(model, finer, "asked".to_owned(), &Quiet, &Cancel::new()).unwrap().unwrap();
        let choice = found.choice;
        assert_eq!(choice.method, rungs[found.rung].label());
        assert_eq!(choice.voxel_m, found.model.voxels.lattice.voxel_m);
        (choice.method, choice.voxel_m, choice.expected_factor, made.into_inner())
    }

    #[test]
    fn the_cheapest_quality_that_agrees_with_the_next_is_chosen() {
        let rungs = || {
            vec![
                rung("silent", 1.0, None, 0.0),
                rung("rough", 2.0, Some(0.1), 0.0),
                rung("fair", 1.1, Some(0.1), 0.0),
                rung("fine", 1.0, Some(0.02), 0.0),
            ]
        };
        for (tolerance, want) in [(1.01, "fine"), (1.05, "fine"), (1.3, "fair"), (1.5, "fair"), (4.0, "rough")] {
            let (method, _, expected, made) = chosen(&rungs(), tolerance, false);
            assert_eq!(method, format!("forward {want}"), "{tolerance}");
            assert_eq!(
                expected.is_some_and(|factor| factor <= tolerance),
                tolerance > 1.01,
                "{tolerance}: {expected:?}"
            );
            assert!(made.is_empty());
        }
        let (method, _, expected, _) = chosen(&rungs()[..1], 2.0, false);
        assert_eq!((method.as_str(), expected), ("forward silent", None));
    }

    #[test]
    fn voxels_are_halved_until_answers_agree_and_no_further() {
        // 0.1 m: 2, 0.05 m: 1.5, 0.025 m: 1.25.
        let rungs = [rung("only", 1.0, Some(0.01), 10.0)];
        for (tolerance, want_m, made_wanted) in
            [(2.0, 0.1, vec![]), (1.5, 0.05, vec![0.025]), (1.01, 0.025, vec![0.025, 0.0125])]
        {
            let (_, voxel_m, expected, made) = chosen(&rungs, tolerance, true);
            assert_eq!((voxel_m, made), (want_m, made_wanted), "{tolerance}");
            assert_eq!(expected.is_some_and(|factor| factor <= tolerance), tolerance > 1.01);
        }
    }
}
