//! Which method is how far from the reference: every method at the scene's sensors, one after the other.
//!
//! The path tracer runs beside the estimators as one of them. A user's own heuristic is a [`Contestant`] like the others.
//! Each runs as one stage of its own name, so that whoever owns the `Progress` can time it.

use super::errors::{Errors, errors};
use crate::flow::{Estimator, estimator};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Settings};
use crate::model::{Model, Probe};
use crate::scene::{Method, Reference, Scene};
use crate::trace;

/// A method under comparison.
pub struct Contestant<'a> {
    /// Its name in the table and its stage.
    pub name: String,
    /// What it is.
    pub run: Run<'a>,
}

/// How a contestant answers.
pub enum Run<'a> {
    /// By an estimator on the skeleton.
    Estimate(&'a Estimator<'a>),
    /// By path tracing.
    Trace,
}

impl Contestant<'static> {
    /// A built-in method.
    pub fn built_in(method: Method) -> Self {
        Self { name: method.name().to_owned(), run: estimator(method).map_or(Run::Trace, Run::Estimate) }
    }
}

/// What one contestant answered.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The contestant's name.
    pub name: String,
    /// Its readings, in the order of the sensors.
    pub field: Field,
    /// Its errors against the reference.
    pub errors: Errors,
}

/// Runs all contestants at the scene's sensors, in their order. `reference` has an entry for each sensor, or none at all.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
///
/// ```
/// use lightvein::job::{Cancel, Quiet};
/// use lightvein::model::Model;
/// use lightvein::rays::Rays;
/// use lightvein::scene::{Method, Scene};
/// use lightvein::study::compare::{Contestant, compare};
/// use std::{path::Path, sync::Arc};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two_rooms/two_rooms.toml");
/// let scene = Scene::load(&path, &Quiet, &Cancel::new())?;
/// let model = Model::build(&scene, Arc::new(Rays::new(&scene)), 0.1, 1 << 30, &Quiet, &Cancel::new())?;
/// let methods = [Method::Backward, Method::Forward].map(Contestant::built_in);
/// for entry in compare(&scene, &model, &methods, &scene.reference, &Default::default(), &Quiet, &Cancel::new())? {
///     println!("{}: off by a factor of {:?}", entry.name, entry.errors.rms_factor);
/// }
/// # Ok(())
/// # }
/// ```
pub fn compare(
    scene: &Scene,
    model: &Model,
    contestants: &[Contestant],
    reference: &[Option<Reference>],
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Entry>, Cancelled> {
    let probes = model.probes_at_sensors(scene);
    let answer = |contestant: &Contestant| {
        progress.begin(&contestant.name, 0);
        let mut field = run(scene, model, &probes, contestant, settings, progress, cancel)?;
        progress.end();
        for warning in &mut field.warnings {
            *warning = format!("{}: {warning}", contestant.name);
        }
        let errors = errors(&field.readings, reference);
        Ok(Entry { name: contestant.name.clone(), field, errors })
    };
    contestants.iter().map(answer).collect()
}

fn run(
    scene: &Scene,
    model: &Model,
    probes: &[Probe],
    contestant: &Contestant,
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Field, Cancelled> {
    match contestant.run {
        Run::Estimate(estimate) => estimate(model, probes, settings, progress, cancel),
        Run::Trace => Ok(trace::trace(scene, &model.rays, &model.sources, settings, progress, cancel)?.field),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{FLUX_W, lamp, modelled, room, sensor};
    use crate::flow::{Arrival, add_lights, backward};
    use crate::job::Quiet;
    use glam::{DVec3, Vec3};

    #[test]
    fn a_heuristic_of_ones_own_runs_beside_the_built_in_ones_in_the_order_asked_for() {
        let sensors = vec![sensor(Vec3::new(1.0, 1.0, 0.7), None)];
        let (scene, model) = modelled(&room(), vec![lamp(Vec3::splat(1.5), FLUX_W)], sensors);
        let own: &Estimator = &|model, probes, _, progress, cancel| {
            let mut field = add_lights(model, probes, progress, cancel, |_| {
                Box::new(|_, _| Arrival { irradiance_w_m2: 2.0, towards: DVec3::Z })
            })?;
            field.warnings.push("a guess".to_owned());
            Ok(field)
        };
        let contestants = [
            Contestant { name: "two".to_owned(), run: Run::Estimate(own) },
            Contestant::built_in(Method::Trace),
            Contestant::built_in(Method::Backward),
        ];
        let reference = [Some(Reference { irradiance_w_m2: 1.0, stderr_w_m2: 0.0, flux_w_m2: DVec3::Y })];
        let settings = Settings { samples: 64, ..Settings::default() };
        let entries = compare(&scene, &model, &contestants, &reference, &settings, &Quiet, &Cancel::new()).unwrap();

        assert_eq!(entries.iter().map(|entry| entry.name.as_str()).collect::<Vec<_>>(), ["two", "trace", "backward"]);
        assert_eq!(entries[0].field.readings[0].value_w_m2, 2.0);
        assert_eq!(entries[0].field.warnings, ["two: a guess"]);
        assert!((entries[0].errors.rms_factor.unwrap() - 2.0).abs() < 1e-12);
        assert!((entries[0].errors.median_angle_deg.unwrap() - 90.0).abs() < 1e-9);
        let traced = trace::trace(&scene, &model.rays, &model.sources, &settings, &Quiet, &Cancel::new()).unwrap();
        assert_eq!(entries[1].field.readings, traced.field.readings);
        let probes = model.probes_at_sensors(&scene);
        let estimated = backward::estimate(&model, &probes, &settings, &Quiet, &Cancel::new()).unwrap();
        assert_eq!(entries[2].field, estimated);
    }
}
