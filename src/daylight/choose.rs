//! Which way is good enough?
//!
//! Some of the points are asked by many rays. Then the ways are tried at these points in the order of what they cost for all of
//! them, and the first whose error, RMSE as a share of the mean, is inside the tolerance is taken. What a scene does not need
//! is not modelled: an open field ends at the first way, a street of arcades at rays.
//!
//! Limits: what the points that are asked do not show is not known; with [`SAMPLES`] of them an error of 1% is known to a tenth
//! of itself, unless it is made by one point in hundreds.

use super::Exposure;
use super::camera::Buffers;
use super::cast::{Asked, Casting};
use super::way::{Ground, Prepared, Way};
use crate::job::{Cancel, Cancelled, Progress, Quiet};

/// Points at which ways are compared.
pub const SAMPLES: usize = 96;

/// Rays by which they are judged: these are within 0.2% of all suns and of many directions.
const JUDGE: Casting = Casting { sun_rays: Some(2048), sky_rays: 2048, seed: 0 };

/// Tolerance of what is read, where nobody says another.
pub const SENSOR_TOLERANCE: f64 = 1.02;

/// Tolerance of what is looked at and not read.
pub const PICTURE_TOLERANCE: f64 = 1.1;

/// Tolerances below this are not judged: the dearest way is taken.
pub const LEAST_TOLERANCE: f64 = 1.004;

/// What a way has shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// The way.
    pub way: Way,
    /// Its RMSE at the points that were compared, a share of their mean.
    pub error: f64,
}

/// The way that was chosen.
#[derive(Debug)]
pub struct Chosen {
    /// It, ready to be asked.
    pub way: Prepared,
    /// All that were tried, itself last unless none was good enough to be tried.
    pub tried: Vec<Tried>,
}

/// Chooses among ways for points: the cheapest inside `tolerance`, a factor above 1; the last of `ways` if none is.
///
/// # Errors
/// [`Cancelled`].
pub fn choose(
    ground: &Ground,
    asked: Asked,
    buffers: Option<&Buffers>,
    ways: &[Way],
    tolerance: f64,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Chosen, Cancelled> {
    let dearest = ways.last().copied().unwrap_or(Way::Rays(Casting::default()));
    let count = asked.points.len();
    let mut tried = Vec::new();
    if tolerance < LEAST_TOLERANCE || count == 0 {
        return Ok(Chosen { way: dearest.prepare(ground, cancel)?, tried });
    }
    progress.begin("choosing", 0);
    let places: Vec<usize> = (0..count.min(SAMPLES)).map(|sample| sample * count / count.min(SAMPLES)).collect();
    let points: Vec<_> = places.iter().filter_map(|&place| asked.points.get(place).copied()).collect();
    let numbers: Vec<u32> = places.iter().map(|&place| asked.number(place) as u32).collect();
    let some = Asked { points: &points, numbers: Some(&numbers), in_the_open: asked.in_the_open };
    let judge = Way::Rays(Casting { seed: ground.seed ^ 1, ..JUDGE }).prepare(ground, cancel)?;
    let truth = judge.ask(ground, some, None, &Quiet, cancel)?;

    let mut by_cost = ways.to_vec();
    by_cost.sort_by(|a, b| a.cost_s(count).total_cmp(&b.cost_s(count)));
    for way in by_cost {
        let prepared = way.prepare(ground, cancel)?;
        let found = prepared.ask(ground, some, buffers, &Quiet, cancel)?;
        let error = error(&found, &truth);
        tried.push(Tried { way, error });
        if error <= tolerance - 1.0 {
            progress.end();
            return Ok(Chosen { way: prepared, tried });
        }
    }
    progress.end();
    Ok(Chosen { way: dearest.prepare(ground, cancel)?, tried })
}

/// RMSE of exposures, a share of the mean of the truth; 0 where all is dark.
pub fn error(found: &[Exposure], truth: &[Exposure]) -> f64 {
    let pairs = found.iter().zip(truth);
    let square: f64 = pairs.map(|(a, b)| (a.total_kwh_m2() - b.total_kwh_m2()).powi(2)).sum();
    let count = truth.len().max(1) as f64;
    let mean = truth.iter().map(Exposure::total_kwh_m2).sum::<f64>() / count;
    if square > 0.0 { (square / count).sqrt() / mean.max(f64::MIN_POSITIVE) } else { 0.0 }
}
