//! How far off is a contestant after so many seconds, all its preparation included?
//!
//! Samples of `plain` and `guided` are independent, so many short runs (slices) of other seeds, taken in turns so that a
//! disturbance of the machine meets all alike, say it best: the mean square of their deviations from the truth, times the
//! seconds of a slice, over the seconds that the budget leaves after the preparation (median of three). What learns runs
//! the whole budget, as often as [`Effort`] allows; where that is under [`FEWEST_RUNS`] times, the square of its own
//! standard error stands for the deviation, which by so few runs is a matter of luck.
//!
//! The truth: long runs of other seeds of all that do not learn, pooled by weights that all sensors share, so that no
//! sensor's luck picks its weight. An independent program's reference, where the scene has one, is too rough for errors of
//! a minute (0.2 to 2%); it checks the truth instead ([`Finding::off_reference`]).
//!
//! Limits: a truth that no contestant found. Sensors with a sample over 5% of all that a contestant took in its slices are
//! marked: its error there is not to be trusted, and is more likely too low than too high.

use crate::contestants::{Contestant, Run, Stage, contestants};
use lightvein::scene::Scene;
use lightvein::trace::Traced;
use std::error::Error;
use std::time::Instant;

/// Ticks of a second in which Linux counts a process's time.
const TICKS: f64 = 100.0;

/// Budgets, seconds.
pub const BUDGETS_S: [f64; 3] = [1.0, 10.0, 60.0];

/// How long a slice shall be, seconds.
const SLICE_S: f64 = 0.5;

/// How often preparation is timed.
const PREPARATIONS: usize = 3;

/// Runs below which deviations say less than a run's own standard error, and the most that are made.
const FEWEST_RUNS: usize = 8;
const MOST_RUNS: usize = 16;

/// A sample above this share of all makes an error worthless.
const LARGEST_TRUSTED_SHARE: f64 = 0.05;

/// First seeds of what is measured and of the truth.
const SEED: u64 = 1;
const TRUTH_SEED: u64 = 1 << 32;

/// By what time goes.
#[derive(Clone, Copy)]
pub enum Clock {
    Wall,
    /// The processors' time over the number of threads: for a machine that others use too. What one thread does alone counts
    /// too little.
    Processors,
}

/// How long to measure, seconds, and by which clock.
pub struct Effort {
    pub clock: Clock,
    /// The longest budget.
    pub longest_s: f64,
    /// For each contestant's slices.
    pub measure_s: f64,
    /// For each contestant's part in the truth.
    pub truth_s: f64,
    /// The longest budget of what learns, which runs it in full.
    pub learn_s: f64,
    /// Whether plain competes with wrong guides instead.
    pub with_wrong: bool,
}

/// What a contestant is at each sensor.
pub struct Outcome {
    pub name: &'static str,
    pub prepare_s: f64,
    /// For each budget and sensor, the mean square deviation over the squared truth; infinite where nothing is left of the
    /// budget, not a number at dark sensors.
    pub squares: Vec<Vec<f64>>,
    /// The mean square deviation of a single sample over the squared truth at each sensor, and its time, seconds: none for
    /// what learns.
    pub sample: Option<(Vec<f64>, f64)>,
    /// Whether a sensor's error is worthless.
    pub is_doubtful: Vec<bool>,
}

/// What was found in a scene.
pub struct Finding {
    pub scene: String,
    pub sensors: Vec<String>,
    pub truth_w_m2: Vec<f64>,
    /// The truth's standard error over the truth.
    pub truth_error: Vec<f64>,
    /// How many sensors have a reference, and how many of these lie beyond three standard errors of it.
    pub off_reference: [usize; 2],
    pub budgets_s: Vec<f64>,
    pub outcomes: Vec<Outcome>,
}

/// Short runs of one contestant.
struct Slices {
    samples: u32,
    seconds: f64,
    runs: Vec<Traced>,
}

/// One that is ready to answer.
struct Ready<'a> {
    name: &'static str,
    prepare_s: f64,
    learns: bool,
    run: Run<'a>,
}

/// Measures all contestants in a scene.
pub fn scene(scene: &Scene, effort: &Effort) -> Result<Finding, Box<dyn Error>> {
    let stage = Stage::of(scene);
    let ready: Vec<Ready> = contestants(&stage, effort.with_wrong)
        .iter()
        .map(|one| prepared(one, effort.clock))
        .collect::<Result<_, _>>()?;
    let independent: Vec<&Ready> = ready.iter().filter(|one| !one.learns).collect();

    let (truth_w_m2, truth_error) = truth(&slices(&independent, TRUTH_SEED, effort.truth_s, effort.clock));
    let mut measured = slices(&independent, SEED, effort.measure_s, effort.clock).into_iter().peekable();
    let budgets_s: Vec<f64> = BUDGETS_S.into_iter().filter(|&budget_s| budget_s <= effort.longest_s).collect();
    let outcomes = ready.iter().map(|one| match measured.next_if(|_| !one.learns) {
        Some(slices) => outcome_of_slices(one, &slices, &truth_w_m2, &budgets_s),
        None => outcome_of_learning(one, &truth_w_m2, &budgets_s, effort.learn_s, effort.clock),
    });
    let outcomes = outcomes.collect();

    let referred = scene.reference.iter().zip(truth_w_m2.iter().zip(&truth_error));
    let deviations = referred.filter_map(|(known, (&truth_w_m2, &error))| {
        let known = known.filter(|_| truth_w_m2 > 0.0)?;
        Some((known.irradiance_w_m2 - truth_w_m2).abs() / known.stderr_w_m2.hypot(error * truth_w_m2))
    });
    let deviations: Vec<f64> = deviations.collect();
    let off_reference = [deviations.len(), deviations.iter().filter(|&&deviation| deviation > 3.0).count()];
    let sensors = scene.sensors.iter().map(|sensor| sensor.id.clone()).collect();
    Ok(Finding { scene: scene.name.clone(), sensors, truth_w_m2, truth_error, off_reference, budgets_s, outcomes })
}

fn prepared<'a>(contestant: &Contestant<'a>, clock: Clock) -> Result<Ready<'a>, Box<dyn Error>> {
    let mut seconds = Vec::new();
    let mut last = None;
    for _ in 0..PREPARATIONS {
        let (took_s, run) = clock.timed(|| (contestant.prepare)());
        seconds.push(took_s);
        last = Some(run?);
    }
    let run = last.ok_or("nothing was prepared")?;
    let (name, learns) = (contestant.name, contestant.learns);
    Ok(Ready { name, prepare_s: median(&seconds), learns, run })
}

/// Slices of each for so many seconds, in turns.
fn slices(of: &[&Ready], first_seed: u64, seconds: f64, clock: Clock) -> Vec<Slices> {
    let begin =
        |one: &&Ready| Slices { samples: samples_within(&one.run, SLICE_S, clock), seconds: 0.0, runs: Vec::new() };
    let mut all: Vec<Slices> = of.iter().map(begin).collect();
    let rounds = (seconds / SLICE_S).ceil().max(2.0) as u64;
    for round in 0..rounds {
        for (one, slices) in of.iter().zip(&mut all) {
            let (took_s, traced) = clock.timed(|| (one.run)(first_seed + round, slices.samples));
            slices.seconds += took_s;
            slices.runs.push(traced);
        }
    }
    all
}

/// How many samples a sensor take about so long.
fn samples_within(run: &Run, seconds: f64, clock: Clock) -> u32 {
    let mut samples = 16_u32;
    loop {
        let (took_s, _) = clock.timed(|| run(0, samples));
        if took_s > 0.2 * seconds || samples > 1 << 28 {
            return ((f64::from(samples) * seconds / took_s) as u32).max(1);
        }
        samples *= 4;
    }
}

/// Mean and its relative standard error at each sensor.
fn truth(all: &[Slices]) -> (Vec<f64>, Vec<f64>) {
    let sensors = all.first().and_then(|slices| slices.runs.first()).map_or(0, |run| run.field.readings.len());
    let moments: Vec<Vec<[f64; 2]>> =
        all.iter().map(|slices| (0..sensors).map(|at| moments(slices, at)).collect()).collect();
    let weight = |of: &Vec<[f64; 2]>| {
        let lit = of.iter().filter(|[mean, _]| *mean > 0.0);
        1.0 / median(&lit.map(|[mean, variance]| variance / (mean * mean)).collect::<Vec<_>>()).max(1e-300)
    };
    let weights: Vec<f64> = moments.iter().map(weight).collect();
    let total: f64 = weights.iter().sum();
    let pooled = (0..sensors).map(|at| {
        let parts = weights.iter().zip(&moments).map(|(weight, of)| (weight / total, of[at]));
        let [mean, variance] = parts.fold([0.0; 2], |[mean, variance], (share, [its_mean, its_variance])| {
            [mean + share * its_mean, variance + share * share * its_variance]
        });
        (mean, if mean > 0.0 { variance.sqrt() / mean } else { 0.0 })
    });
    pooled.unzip()
}

/// The mean of slices at a sensor, and the variance of that mean.
fn moments(slices: &Slices, sensor: usize) -> [f64; 2] {
    let values: Vec<f64> = slices.runs.iter().map(|run| run.field.readings[sensor].value_w_m2).collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    [mean, squares / (count - 1.0) / count]
}

fn outcome_of_slices(one: &Ready, slices: &Slices, truth_w_m2: &[f64], budgets_s: &[f64]) -> Outcome {
    let count = slices.runs.len() as f64;
    let slice_s = slices.seconds / count;
    let square = |(sensor, &truth_w_m2): (usize, &f64)| mean_square(&slices.runs, sensor, truth_w_m2);
    let squares: Vec<f64> = truth_w_m2.iter().enumerate().map(square).collect();
    let by_budget = budgets_s.iter().map(|budget_s| {
        let left_s = budget_s - one.prepare_s;
        let times = if left_s > 0.0 { slice_s / left_s } else { f64::INFINITY };
        squares.iter().map(|square| square * times).collect()
    });

    // The largest sample of all slices over the sum of all.
    let share = |sensor: usize| {
        let value = |run: &Traced| run.field.readings[sensor].value_w_m2;
        let largest = slices.runs.iter().map(|run| run.top_share[sensor] * value(run)).fold(0.0, f64::max);
        largest / slices.runs.iter().map(value).sum::<f64>()
    };
    Outcome {
        name: one.name,
        prepare_s: one.prepare_s,
        squares: by_budget.collect(),
        sample: {
            let sensors = truth_w_m2.len().max(1) as f64;
            let samples = f64::from(slices.samples);
            Some((squares.iter().map(|square| square * samples).collect(), slice_s / samples / sensors))
        },
        is_doubtful: (0..truth_w_m2.len()).map(|sensor| share(sensor) > LARGEST_TRUSTED_SHARE).collect(),
    }
}

fn outcome_of_learning(one: &Ready, truth_w_m2: &[f64], budgets_s: &[f64], longest_s: f64, clock: Clock) -> Outcome {
    let mut samples = samples_within(&one.run, SLICE_S, clock);
    let mut per_sample_s = SLICE_S / f64::from(samples);
    let (mut squares, mut is_doubtful) = (Vec::new(), vec![false; truth_w_m2.len()]);
    let mut seed = SEED;
    for &budget_s in budgets_s {
        if budget_s > longest_s {
            squares.push(vec![f64::NAN; truth_w_m2.len()]);
            continue;
        }
        // As often as the shortest budget asks for in all.
        let count = ((MOST_RUNS as f64 / budget_s) as usize).max(1);
        let mut runs = Vec::new();
        let mut took_s = 0.0;
        for _ in 0..count {
            samples = ((budget_s - one.prepare_s).max(0.0) / per_sample_s).max(1.0) as u32;
            let (run_s, traced) = clock.timed(|| (one.run)(seed, samples));
            per_sample_s = run_s / f64::from(samples);
            took_s += run_s;
            runs.push(traced);
            seed += 1;
        }
        let times = took_s / count as f64 / budget_s;
        let square = |(sensor, &truth_w_m2): (usize, &f64)| {
            times
                * if count < FEWEST_RUNS {
                    own_square(&runs, sensor, truth_w_m2)
                } else {
                    mean_square(&runs, sensor, truth_w_m2)
                }
        };
        squares.push(truth_w_m2.iter().enumerate().map(square).collect());
        for (sensor, is_doubtful) in is_doubtful.iter_mut().enumerate() {
            *is_doubtful = runs.iter().any(|run| run.top_share[sensor] > LARGEST_TRUSTED_SHARE);
        }
    }
    Outcome { name: one.name, prepare_s: one.prepare_s, squares, sample: None, is_doubtful }
}

/// The mean square deviation of runs from the truth, over its square.
fn mean_square(runs: &[Traced], sensor: usize, truth_w_m2: f64) -> f64 {
    let deviations = runs.iter().map(|run| run.field.readings[sensor].value_w_m2 / truth_w_m2 - 1.0);
    deviations.map(|deviation| deviation * deviation).sum::<f64>() / runs.len() as f64
}

/// The mean square of their own standard errors, over the squared truth.
fn own_square(runs: &[Traced], sensor: usize, truth_w_m2: f64) -> f64 {
    let errors = runs.iter().map(|run| run.field.readings[sensor].error_w_m2.unwrap_or(f64::NAN) / truth_w_m2);
    errors.map(|error| error * error).sum::<f64>() / runs.len() as f64
}

impl Clock {
    /// How long something takes, seconds, and what it makes.
    fn timed<T>(self, work: impl FnOnce() -> T) -> (f64, T) {
        let (begin, begin_s) = (Instant::now(), processors_s());
        let made = work();
        let wall_s = begin.elapsed().as_secs_f64();
        match (self, begin_s, processors_s()) {
            (Self::Processors, Some(begin_s), Some(end_s)) => {
                ((end_s - begin_s).max(0.5 / TICKS) / rayon::current_num_threads() as f64, made)
            }
            _ => (wall_s, made),
        }
    }
}

/// What this process took of all processors, seconds; `None` where the system does not tell.
fn processors_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit(')').next()?.split_whitespace().collect();
    let ticks = |at: usize| fields.get(at)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / TICKS)
}

/// The middle of the values that are numbers; not a number where there are none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        count if count % 2 == 1 => sorted[middle],
        _ => 0.5 * (sorted[middle - 1] + sorted[middle]),
    }
}
