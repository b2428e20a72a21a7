//! Questions about a model: the estimate that was asked for, all methods beside it, every quality for the chart.

use crate::request::Request;
use crate::results::{Answer, Estimate, Faces, Failed, Results};
use lightvein::flow::network::{self, Quality};
use lightvein::flow::veins::through_edges_w;
use lightvein::flow::{Rung, estimator, ladder};
use lightvein::job::{Cancel, Progress, Quiet};
use lightvein::light::{Field, Settings};
use lightvein::model::{Model, Probe};
use lightvein::scene::{Method, Scene};
use lightvein::study::errors::errors;
use lightvein::trace;
use std::sync::Arc;
use std::time::Instant;

/// The method where neither user nor file names one.
const METHOD: Method = Method::Network;

/// Samples a sensor of the path tracer: some seconds for a handful of sensors.
const SAMPLES: u32 = 256;

/// Shows results so far.
pub type Found<'a> = &'a mut dyn FnMut(&Results);

/// The estimate that was asked for at nodes and sensors; by `backward` first where that is much faster.
///
/// # Errors
/// [`Failed::Cancelled`].
pub fn estimates(
    results: &mut Results,
    scene: &Arc<Scene>,
    model: &Arc<Model>,
    request: &Request,
    progress: &dyn Progress,
    cancel: &Cancel,
    found: Found,
) -> Result<(), Failed> {
    let settings = Settings { seed: request.how.seed, samples: SAMPLES, ..Settings::default() };
    let method = request.how.method.or(scene.model.method).unwrap_or(METHOD);
    let asking = Asking { scene, model, settings, progress, cancel };
    if matches!(method, Method::Network | Method::Trace) {
        let first = asking.estimate(Method::Backward, None)?;
        let keeps_older = results.estimate.as_ref().is_some_and(|older| !older.is_first_pass)
            && results
                .estimate
                .as_ref()
                .is_some_and(|older| older.at_nodes.readings.len() == first.at_nodes.readings.len());
        // While a slider is dragged the older estimate of the same method says more than the first pass of another.
        if !keeps_older {
            results.estimate = Some(Arc::new(Estimate { is_first_pass: true, ..first }));
            results.faces = None;
            found(results);
        }
    }
    let estimate = asking.estimate(method, request.how.quality)?;
    results.warnings.extend(estimate.at_sensors.warnings.iter().cloned());
    results.estimate = Some(Arc::new(estimate));
    results.faces = None;
    if request.wants.faces {
        found(results);
        results.faces = Some(Arc::new(asking.faces(method)?));
    }
    found(results);
    Ok(())
}

/// Every estimator at its default quality.
///
/// # Errors
/// [`Failed::Cancelled`].
pub fn all_methods(
    scene: &Arc<Scene>,
    model: &Arc<Model>,
    request: &Request,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Answer>, Failed> {
    let settings = Settings { seed: request.how.seed, ..Settings::default() };
    let asking = Asking { scene, model, settings, progress, cancel };
    let methods = Method::ALL.into_iter().filter(|&method| estimator(method).is_some());
    let answer = |method| {
        let Estimate { quality, at_nodes, at_sensors, errors, seconds, .. } = asking.estimate(method, None)?;
        let (at_nodes, at_sensors) = (at_nodes.readings, at_sensors.readings);
        Ok(Answer { method, quality, at_sensors, at_nodes, errors, seconds })
    };
    methods.map(answer).collect()
}

/// Samples a sensor of the path tracer on the chart.
const TRACED: [u32; 3] = [16, 64, 256];

/// Every method at every quality, and the path tracer with few samples, at the sensors.
///
/// # Errors
/// Results without a model; [`Failed::Cancelled`].
pub fn every_quality(
    results: &Results,
    seed: u64,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Answer>, Failed> {
    let (Some(scene), Some(model)) = (&results.scene, &results.model) else {
        return Err(Failed::Because(anyhow::anyhow!("there is no model to measure methods on yet")));
    };
    let probes = model.probes_at_sensors(scene);
    let settings = Settings { seed, ..Settings::default() };
    let mut answers = Vec::new();
    let mut keep = |method, quality, seconds, field: Field| {
        let errors = errors(&field.readings, &scene.reference);
        let (at_sensors, at_nodes) = (field.readings, Vec::new());
        answers.push(Answer { method, quality, at_sensors, at_nodes, errors, seconds });
    };
    let rungs: Vec<Rung> = Method::ALL.into_iter().flat_map(ladder).collect();
    progress.begin("qualities", (rungs.len() + TRACED.len()) as u64);
    for rung in rungs {
        let began = Instant::now();
        let field = (rung.estimate)(model, &probes, &settings, &Quiet, cancel)?;
        keep(rung.method, rung.quality, began.elapsed().as_secs_f64(), field);
        progress.advance(1);
    }
    for samples in TRACED {
        let began = Instant::now();
        let settings = Settings { samples, ..settings };
        let traced = trace::trace(scene, &model.rays, &model.sources, &settings, &Quiet, cancel)?;
        keep(Method::Trace, format!("{samples} samples"), began.elapsed().as_secs_f64(), traced.field);
        progress.advance(1);
    }
    progress.end();
    Ok(answers)
}

/// What all questions about one model share.
pub struct Asking<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What was modelled of it.
    pub model: &'a Model,
    /// Seed, samples, bounces.
    pub settings: Settings,
    /// Hears of the stages.
    pub progress: &'a dyn Progress,
    /// Stops the run.
    pub cancel: &'a Cancel,
}

impl Asking<'_> {
    /// The field at nodes and sensors by a method, at a rung of its ladder or its default quality. The seconds are those of
    /// both together where one network serves both.
    fn estimate(&self, method: Method, rung: Option<usize>) -> Result<Estimate, Failed> {
        let Self { scene, model, progress, cancel, settings } = *self;
        let (at_sensors, at_nodes) = (model.probes_at_sensors(scene), model.probes_at_nodes());
        progress.begin(method.name(), 0);
        let began = Instant::now();
        let quality = network_quality(method, rung);
        let rung = rung.and_then(|rung| ladder(method).into_iter().nth(rung));
        let label = rung.as_ref().map_or_else(String::new, |rung| rung.quality.clone());
        let [at_sensors, at_nodes] = match (quality, method) {
            (Some(quality), _) => {
                network::gathered_and_read(&quality, model, [&at_sensors, &at_nodes], &settings, progress, cancel)?
            }
            (None, Method::Trace) => {
                let traced = trace::trace(scene, &model.rays, &model.sources, &settings, progress, cancel)?;
                [traced.field, Field::default()]
            }
            (None, _) => [self.by(method, rung.as_ref(), &at_sensors)?, self.by(method, rung.as_ref(), &at_nodes)?],
        };
        let seconds = began.elapsed().as_secs_f64();
        progress.end();
        Ok(Estimate {
            method,
            quality: label,
            through_edges_w: through_edges_w(&model.skeleton, &at_nodes),
            errors: errors(&at_sensors.readings, &scene.reference),
            at_nodes,
            at_sensors,
            seconds,
            is_first_pass: false,
        })
    }

    /// The field on the faces of the mesh; read off the zones of a network, for faces are many.
    ///
    /// # Errors
    /// [`Failed::Cancelled`].
    pub fn faces(&self, method: Method) -> Result<Faces, Failed> {
        let faces_m = self.model.faces_to_void(self.scene);
        let probes = self.model.probes_at_faces(&faces_m);
        self.progress.begin("faces", 0);
        let field = match method {
            Method::Network | Method::Trace => {
                let read = network::with(Quality::MEDIUM.read());
                read(self.model, &probes, &self.settings, self.progress, self.cancel)?
            }
            _ => self.by(method, None, &probes)?,
        };
        self.progress.end();
        Ok(Faces { faces_m, field })
    }

    fn by(&self, method: Method, rung: Option<&Rung>, probes: &[Probe]) -> Result<Field, Failed> {
        let Self { model, progress, cancel, settings, .. } = *self;
        match (rung, estimator(method)) {
            (Some(rung), _) => Ok((rung.estimate)(model, probes, &settings, progress, cancel)?),
            (None, Some(estimate)) => Ok(estimate(model, probes, &settings, progress, cancel)?),
            (None, None) => Ok(Field::default()),
        }
    }
}

/// The quality of a network on that rung; `None` for other methods.
fn network_quality(method: Method, rung: Option<usize>) -> Option<Quality> {
    let of_rung = rung.and_then(|rung| network::LADDER.get(rung)).map(|(_, quality)| *quality);
    (method == Method::Network).then(|| of_rung.unwrap_or(Quality::MEDIUM))
}
