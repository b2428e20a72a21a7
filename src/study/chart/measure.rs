//! Runs every method at every quality: its errors at the scene's referenced sensors, its seconds for so many sensors.
//!
//! Sensors are the scene's own first, then points spread evenly over the void. Finding a sensor's place on the skeleton is
//! part of answering it and is timed with the estimate. The path tracer runs at the scene's own sensors alone: its time is
//! proportional to their number, so that the others are scaled and marked as such.

use super::equal::equal_error;
use super::timing::{Clock, Timed, median_of_three, times};
use super::{Point, SENSORS, SceneChart, mark_fronts};
use crate::flow::{Rung, ladder};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Settings, Sources};
use crate::model::{Model, ModelError};
use crate::rays::Rays;
use crate::scene::{Method, Scene};
use crate::study::errors::{Errors, errors, is_good};
use crate::trace;
use crate::voxel::VoxelError;
use glam::Vec3;
use rayon::prelude::*;
use std::sync::Arc;

/// The path tracer's samples a sensor; each is four times the one before, which halves its error.
const SAMPLES: [u32; 10] = [4, 16, 64, 256, 1024, 4096, 16_384, 65_536, 262_144, 1_048_576];

/// Voxel sizes beside the scene's own, as multiples of it.
const VOXEL_SIZES: [f32; 3] = [2.0, 1.0, 0.5];

/// Voxels half as large are eight times as many, and take about as many times longer.
const HALVING_COSTS: f64 = 8.0;

/// What is to be measured, and how.
pub struct Measurement<'a> {
    /// The scene, with a reference.
    pub scene: &'a Scene,
    /// Its rays.
    pub rays: &'a Arc<Rays>,
    /// The scene's own voxel size, metres; it is measured at twice and half of it too.
    pub voxel_m: f32,
    /// No run of an estimate is begun that would exceed so many seconds.
    pub budget_seconds: f64,
    /// The same for a run of the path tracer.
    pub trace_budget_seconds: f64,
    /// The most memory that voxels and skeleton may take.
    pub max_bytes: u64,
    /// The seed; all else is set by the qualities.
    pub settings: Settings,
    /// Tells the time.
    pub clock: &'a Clock<'a>,
}

impl Measurement<'_> {
    /// All points of the scene, with the fronts marked. A voxel size that does not fit the memory, the mesh or the budget is
    /// left out, and noted.
    ///
    /// # Errors
    /// [`ModelError::Cancelled`]; [`ModelError::Voxel`] where the scene's own voxel size fails.
    pub fn run(&self, progress: &dyn Progress, cancel: &Cancel) -> Result<SceneChart, ModelError> {
        let referenced = self.scene.reference.iter().flatten().filter(|reference| is_good(reference)).count();
        let mut chart = SceneChart { scene: self.scene.name.clone(), referenced, ..SceneChart::default() };

        let mut coarser_seconds = 0.0;
        for multiple in VOXEL_SIZES {
            let voxel_m = self.voxel_m * multiple;
            if HALVING_COSTS * coarser_seconds > self.budget_seconds {
                chart.notes.push(format!("voxels of {voxel_m} m are left out: to make them would exceed the budget"));
                continue;
            }
            match self.model(voxel_m, progress, cancel) {
                Ok((prepare_seconds, model)) => {
                    coarser_seconds = prepare_seconds;
                    self.estimates(&model, prepare_seconds, &mut chart.points, progress, cancel)?;
                }
                Err(ModelError::Voxel(error @ (VoxelError::TooLarge { .. } | VoxelError::TooCoarse { .. })))
                    if multiple != 1.0 =>
                {
                    chart.notes.push(format!("voxels of {voxel_m} m are left out: {error}"));
                }
                Err(error) => return Err(error),
            }
        }
        self.traces(&mut chart, progress, cancel)?;
        compare_points(&mut chart.points);
        Ok(chart)
    }

    /// Voxels and skeleton, and the seconds they take.
    fn model(&self, voxel_m: f32, progress: &dyn Progress, cancel: &Cancel) -> Result<(f64, Model), ModelError> {
        let build = || Model::build(self.scene, self.rays.clone(), voxel_m, self.max_bytes, progress, cancel);
        median_of_three(self.clock, build)
    }

    /// Every estimator at every quality on one model.
    fn estimates(
        &self,
        model: &Model,
        prepare_seconds: f64,
        points: &mut Vec<Point>,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        let probes = model.probes_at_sensors(self.scene);
        let positions = self.sensors(model);
        for rung in Method::ALL.into_iter().flat_map(ladder) {
            let Rung { method, quality, estimate } = &rung;
            progress.begin(&rung.label(), 0);
            let field = estimate(model, &probes, &self.settings, progress, cancel)?;
            let errors = errors(&field.readings, &self.scene.reference);
            let seconds_for = |count: usize| {
                let answer = || {
                    let asked = positions.get(..count).unwrap_or(&positions).par_iter();
                    let probes: Vec<_> = asked.map(|&(at_m, normal)| model.probe(at_m, normal)).collect();
                    estimate(model, &probes, &self.settings, progress, cancel)
                };
                median_of_three(self.clock, answer).map(|(seconds, _)| seconds)
            };
            let timed = times(&SENSORS, self.budget_seconds, seconds_for)?;
            progress.end();
            points.extend(SENSORS.into_iter().zip(timed).map(|(sensors, Timed { seconds, is_scaled })| Point {
                method: method.name().to_owned(),
                quality: quality.clone(),
                voxel_m: Some(model.voxels.lattice.voxel_m),
                sensors,
                prepare_seconds,
                seconds,
                is_scaled,
                errors,
                is_front: false,
                equal_error: None,
            }));
        }
        Ok(())
    }

    /// As many sensors as are ever asked at: the scene's own first, then centres of voxels spread evenly over the void.
    fn sensors(&self, model: &Model) -> Vec<(Vec3, Option<Vec3>)> {
        let own = self.scene.sensors.iter().map(|sensor| (sensor.position_m, sensor.normal));
        let void: Vec<_> = model.voxels.void.iter().collect();
        // Multiples of the golden ratio: any number of first ones is spread evenly.
        let share = |number: usize| (number as f64 * 0.618_033_988_749_894_9).fract();
        let spread = (0..).map_while(|number| void.get((share(number) * void.len() as f64) as usize));
        let most = SENSORS.into_iter().max().unwrap_or(0);
        own.chain(spread.map(|&voxel| (model.voxels.lattice.centre_m(voxel), None))).take(most).collect()
    }

    /// The path tracer with more and more samples, as far as the budget goes.
    fn traces(&self, chart: &mut SceneChart, progress: &dyn Progress, cancel: &Cancel) -> Result<(), Cancelled> {
        let own = self.scene.sensors.len().max(1);
        let sources = Sources::of(self.scene);
        let mut seconds_a_sample = 0.0;
        for samples in SAMPLES {
            if seconds_a_sample * f64::from(samples) > self.trace_budget_seconds {
                chart
                    .notes
                    .push(format!("the path tracer ends before {samples} samples, which would exceed its budget"));
                break;
            }
            progress.begin(&format!("trace {samples} samples"), 0);
            let settings = Settings { samples, ..self.settings };
            let run = || trace::trace(self.scene, self.rays, &sources, &settings, progress, cancel);
            let (seconds, traced) = median_of_three(self.clock, run)?;
            progress.end();
            seconds_a_sample = seconds / f64::from(samples);
            let errors = errors(&traced.field.readings, &self.scene.reference);
            chart.points.extend(proportional("trace", &format!("{samples} samples"), own, seconds, errors));
        }
        Ok(())
    }
}

/// The points of a path tracer: its time is proportional to the number of sensors, and it needs no preparation.
/// `seconds` is what it took at `own` sensors.
pub fn proportional(
    method: &str,
    quality: &str,
    own: usize,
    seconds: f64,
    errors: Errors,
) -> impl Iterator<Item = Point> {
    let (method, quality) = (method.to_owned(), quality.to_owned());
    SENSORS.into_iter().map(move |sensors| Point {
        method: method.clone(),
        quality: quality.clone(),
        voxel_m: None,
        sensors,
        prepare_seconds: 0.0,
        seconds: seconds * sensors as f64 / own as f64,
        is_scaled: sensors != own,
        errors,
        is_front: false,
        equal_error: None,
    })
}

/// Marks the fronts and holds every estimator against the path tracer at equal error; once all points are there.
pub fn compare_points(points: &mut [Point]) {
    mark_fronts(points);
    let traced: Vec<Point> = points.iter().filter(|point| point.method == Method::Trace.name()).cloned().collect();
    for point in points.iter_mut().filter(|point| point.voxel_m.is_some()) {
        let rival: Vec<&Point> = traced.iter().filter(|rival| rival.sensors == point.sensors).collect();
        point.equal_error = equal_error(point, &rival);
    }
}
