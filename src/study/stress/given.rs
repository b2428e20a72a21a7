//! How far do the answers at a given scene move when it is disturbed?
//!
//! The undisturbed scene is modelled once and every method asked; each disturbance is modelled afresh, asked, and held
//! against that. One model serves all methods.

use super::asked::{Asked, not_modelled};
use super::disturb::{offset_voxels, turn, turned, turned_back, with_reflectance};
use super::rough::roughened;
use super::{Failure, Row};
use crate::job::Cancelled;
use crate::light::Field;
use crate::model::{Model, ModelError};
use crate::scene::{Reference, Scene};

/// Voxels of the sweep, in the scene's own: a factor of eight.
const VOXEL_SIZES: [f32; 4] = [0.5, 1.0, 2.0, 4.0];

/// Roughness of the walls either way, voxels.
const NOISE_VOXELS: [f32; 2] = [0.5, 1.0];

/// Longest edge of a rough wall's triangles, voxels: bumps that voxels can just show.
const BUMP_VOXELS: f32 = 3.0;

/// Reflectances that all walls are given.
const REFLECTANCES: [f32; 6] = [0.0, 0.3, 0.5, 0.8, 0.95, 1.0];

/// Between white walls light goes on for ever, and a path tracer with it: above this there is no traced truth.
const MOST_TRACED: f32 = 0.97;

/// Sensors at which a disturbed scene is path-traced.
const TRACED_SENSORS: usize = 8;

/// The scene as it is, and the answers that disturbed ones are held against.
struct Undisturbed<'a> {
    asked: Asked<'a>,
    scene: &'a Scene,
    model: &'a Model,
    fields: Vec<Field>,
}

/// Disturbs a scene that was modelled, in all ways of [`Trials::failures`](super::Trials::failures) that can be done to one: rows in their order.
///
/// A disturbance that cannot be modelled (voxels larger than the scene, a grid that does not fit) gives rows without figures
/// and with the error for a warning.
///
/// # Errors
/// [`Cancelled`] when the run was stopped.
pub fn stress_scene(scene: &Scene, model: &Model, asked: Asked) -> Result<Vec<Row>, Cancelled> {
    let before = Undisturbed { asked, scene, model, fields: asked.fields(scene, model, asked.trials.seed)? };
    let mut rows = Vec::new();
    for &failure in &asked.trials.failures {
        let disturb: fn(&Undisturbed) -> Result<Vec<Row>, Cancelled> = match failure {
            Failure::GridShift => shifted,
            Failure::Turn => turned_about,
            Failure::Seed => seeded,
            Failure::VoxelSize => resized,
            Failure::WallNoise => roughly,
            Failure::Reflectance => painted,
            _ => continue,
        };
        asked.progress.begin(failure.name(), 0);
        rows.extend(disturb(&before)?);
        asked.progress.end();
    }
    Ok(rows)
}

fn shifted(before: &Undisturbed) -> Result<Vec<Row>, Cancelled> {
    let Undisturbed { asked, scene, model, .. } = before;
    let mut rows = before.rows(Failure::GridShift, &format!("{} offsets", asked.trials.offsets));
    for index in 0..asked.trials.offsets {
        let lattice = model.voxels.lattice.shifted(offset_voxels(index));
        let moved = Model::build_on(lattice, scene, model.rays.clone(), asked.progress, asked.cancel);
        before.add(&mut rows, scene, &moved, &scene.reference, |field| field)?;
    }
    Ok(rows)
}

fn turned_about(before: &Undisturbed) -> Result<Vec<Row>, Cancelled> {
    let Undisturbed { asked, scene, .. } = before;
    let mut rows = before.rows(Failure::Turn, &format!("{} turns", asked.trials.turns));
    for turn in (0..asked.trials.turns).map(turn) {
        let turned = turned(scene, turn);
        let model = asked.model(&turned, before.voxel_m());
        before.add(&mut rows, &turned, &model, &scene.reference, |field| turned_back(field, turn))?;
    }
    Ok(rows)
}

fn seeded(before: &Undisturbed) -> Result<Vec<Row>, Cancelled> {
    let Undisturbed { asked, scene, model, fields } = before;
    let mut rows = before.rows(Failure::Seed, &format!("{} seeds", asked.trials.seeds));
    for step in 1..=asked.trials.seeds {
        let again = asked.fields(scene, model, asked.trials.seed.wrapping_add(step.into()))?;
        for ((row, field), was) in rows.iter_mut().zip(&again).zip(fields) {
            row.add(field, Some(&was.readings), &scene.reference);
            row.warn(&field.warnings, &was.warnings);
        }
    }
    Ok(rows)
}

fn resized(before: &Undisturbed) -> Result<Vec<Row>, Cancelled> {
    let resized = |times: &f32| {
        let voxel_m = times * before.voxel_m();
        let mut rows = before.rows(Failure::VoxelSize, &format!("voxels x {times}"));
        let model = before.asked.model(before.scene, voxel_m);
        before.add(&mut rows, before.scene, &model, &before.scene.reference, |field| field)?;
        Ok(rows)
    };
    all(VOXEL_SIZES.iter().map(resized))
}

fn roughly(before: &Undisturbed) -> Result<Vec<Row>, Cancelled> {
    let asked = before.asked;
    let rough = |&voxels: &f32| {
        let mut rows = before.rows(Failure::WallNoise, &format!("{voxels} voxel either way"));
        let [amplitude_m, bump_m] = [voxels, BUMP_VOXELS].map(|voxels| voxels * before.voxel_m());
        let scene = roughened(before.scene, amplitude_m, bump_m, asked.trials.seed);
        let model = asked.model(&scene, before.voxel_m());
        let truth =
            model.as_ref().map(|model| asked.traced(&scene, model, asked.trials.samples, TRACED_SENSORS, false));
        before.add(&mut rows, &scene, &model, &truth.unwrap_or(Ok(Vec::new()))?, |field| field)?;
        Ok(rows)
    };
    all(NOISE_VOXELS.iter().map(rough))
}

/// Walls of another reflectance are another scene: the answers are held against its own truth alone.
fn painted(before: &Undisturbed) -> Result<Vec<Row>, Cancelled> {
    let asked = before.asked;
    let painted = |&reflectance: &f32| {
        let mut rows = before.rows(Failure::Reflectance, &reflectance.to_string());
        let scene = with_reflectance(before.scene, reflectance);
        let model = match asked.model(&scene, before.voxel_m()) {
            Ok(model) => model,
            Err(error) => return not_modelled(&mut rows, &error).map(|()| rows),
        };
        let can_trace = reflectance <= MOST_TRACED;
        let sensors = if can_trace { TRACED_SENSORS } else { 0 };
        let truth = asked.traced(&scene, &model, asked.trials.samples, sensors, reflectance == 0.0)?;
        let fields = asked.fields(&scene, &model, asked.trials.seed)?;
        for ((row, field), was) in rows.iter_mut().zip(&fields).zip(&before.fields) {
            row.add(field, None, &truth);
            row.warn(&field.warnings, &was.warnings);
        }
        Ok(rows)
    };
    all(REFLECTANCES.iter().map(painted))
}

/// The rows of all trials one after the other, or the first that was stopped.
fn all(trials: impl Iterator<Item = Result<Vec<Row>, Cancelled>>) -> Result<Vec<Row>, Cancelled> {
    Ok(trials.collect::<Result<Vec<_>, _>>()?.concat())
}

impl Undisturbed<'_> {
    fn voxel_m(&self) -> f32 {
        self.model.voxels.lattice.voxel_m
    }

    /// A row a method, without figures yet.
    fn rows(&self, failure: Failure, case: &str) -> Vec<Row> {
        let names = self.asked.contestants.iter().map(|contestant| &contestant.name);
        names.map(|name| Row::new(self.scene, failure, case, name)).collect()
    }

    /// One disturbed model: what each method says of it goes into its row, as `restored` gives it back.
    fn add(
        &self,
        rows: &mut [Row],
        scene: &Scene,
        model: &Result<Model, ModelError>,
        truth: &[Option<Reference>],
        restored: impl Fn(Field) -> Field,
    ) -> Result<(), Cancelled> {
        let model = match model {
            Ok(model) => model,
            Err(error) => return not_modelled(rows, error),
        };
        let fields = self.asked.fields(scene, model, self.asked.trials.seed)?;
        for ((row, field), was) in rows.iter_mut().zip(fields).zip(&self.fields) {
            let field = restored(field);
            row.add(&field, Some(&was.readings), truth);
            row.warn(&model.voxels.warnings, &self.model.voxels.warnings);
            row.warn(&field.warnings, &was.warnings);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{lamp, modelled, sensor, two_rooms};
    use crate::job::{Cancel, Quiet};
    use crate::scene::Method;
    use crate::study::compare::Contestant;
    use crate::study::stress::Trials;
    use glam::Vec3;

    /// Two rooms of the tests, under these failures, by `backward` and `forward`.
    fn rows(failures: &[Failure]) -> Vec<Row> {
        let sensors = [Vec3::new(1.0, 2.2, 0.9), Vec3::new(6.0, 0.7, 1.5)].map(|at_m| sensor(at_m, None));
        let (scene, model) = modelled(&two_rooms(), vec![lamp(Vec3::new(2.0, 1.0, 1.5), 100.0)], sensors.into());
        let trials =
            Trials { failures: failures.into(), offsets: 3, turns: 2, seeds: 2, samples: 256, ..Trials::default() };
        let contestants = [Method::Backward, Method::Forward].map(Contestant::built_in);
        let (progress, cancel) = (&Quiet, &Cancel::new());
        stress_scene(&scene, &model, Asked { contestants: &contestants, trials: &trials, progress, cancel }).unwrap()
    }

    #[test]
    fn every_disturbance_gives_figures_for_every_method() {
        let rows = rows(&Failure::ALL);
        let of = |failure| rows.iter().filter(|row| row.failure == failure).collect::<Vec<_>>();
        for (failure, cases, answers) in
            [(Failure::GridShift, 1, 6), (Failure::Turn, 1, 4), (Failure::Seed, 1, 4), (Failure::VoxelSize, 4, 2)]
        {
            let rows = of(failure);
            assert_eq!(rows.len(), 2 * cases, "{failure:?}");
            assert!(rows.iter().all(|row| row.moved.count() == answers), "{failure:?}");
            assert!(rows.iter().all(|row| row.moved.max().unwrap() < 3.0), "{rows:?}");
        }
        assert!(of(Failure::Seed).iter().all(|row| row.moved.max() == Some(1.0)), "no random numbers in these");
        let base = of(Failure::VoxelSize).into_iter().filter(|row| row.case == "voxels x 1");
        assert!(base.into_iter().all(|row| row.moved.max() == Some(1.0)));
        assert!(of(Failure::WallNoise).iter().all(|row| row.truth.count() > 0));
        let black = of(Failure::Reflectance)[0];
        assert_eq!((black.case.as_str(), black.truth.phantom), ("0", 1), "backward sees light round a black corner");
        assert_eq!(of(Failure::Tie).len(), 0);
    }

    #[test]
    fn a_shift_by_whole_voxels_changes_nothing() {
        let sensors = vec![sensor(Vec3::new(6.0, 0.7, 1.5), None)];
        let (scene, model) = modelled(&two_rooms(), vec![lamp(Vec3::new(2.0, 1.0, 1.5), 100.0)], sensors);
        let lattice = model.voxels.lattice.shifted(Vec3::ONE);
        let moved = Model::build_on(lattice, &scene, model.rays.clone(), &Quiet, &Cancel::new()).unwrap();
        let trials = Trials::default();
        let contestants = Method::ALL.into_iter().filter(|&method| method != Method::Trace).map(Contestant::built_in);
        let contestants: Vec<Contestant> = contestants.collect();
        let asked = Asked { contestants: &contestants, trials: &trials, progress: &Quiet, cancel: &Cancel::new() };
        assert_eq!(moved.voxels.void.count(), model.voxels.void.count());
        let [before, after] = [&model, &moved].map(|model| asked.fields(&scene, model, 0).unwrap());
        for ((before, after), contestant) in before.iter().zip(&after).zip(&contestants) {
            let [was, is] = [before, after].map(|field| field.readings[0].value_w_m2);
            assert!((is / was - 1.0).abs() < 1e-4, "{}: {is} was {was}", contestant.name);
        }
    }
}
