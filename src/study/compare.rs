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
