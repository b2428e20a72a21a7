//! What is measured, and how.

use lightvein::daylight::Exposure;
use lightvein::daylight::cast::Casting;
use std::time::Instant;

const RUNS: usize = 5;

/// How long a run should take, so that neither its start nor a moment's disturbance counts.
const RUN_S: f64 = 0.3;

/// What all are held to: every sun, and so many directions that the sky's part is right within 0.1%.
pub const TRUTH: Casting = Casting { sun_rays: None, sky_rays: 65_536, seed: 1 };

/// One measurement.
pub struct Row {
    /// `sensors` or `pixels`.
    pub at: &'static str,
    /// Which way.
    pub series: &'static str,
    /// How fine it was.
    pub quality: String,
    /// Whether neighbouring pixels were averaged.
    pub is_smooth: bool,
    /// What it made beforehand, seconds.
    pub made_s: f64,
    /// Points a second.
    pub per_s: f64,
    /// Of the exposure, a share of the mean.
    pub rmse: f64,
    /// Mean absolute error of the sky view factor, if it was asked for.
    pub svf: Option<f64>,
}

impl Row {
    /// Tells it on the terminal.
    pub fn said(self) -> Self {
        let smooth = if self.is_smooth { "smooth" } else { "" };
        println!(
            "  {:>7} {:>14} {:>12} {smooth:>6} made {:>8.4} s {:>9.0} 1/s, RMSE {:>6.2}%, svf MAE {}",
            self.at,
            self.series,
            self.quality,
            self.made_s,
            self.per_s,
            100.0 * self.rmse,
            self.svf.map_or_else(|| "-".to_owned(), |svf| format!("{svf:.4}"))
        );
        self
    }
}

/// How long something takes, seconds, and what it makes.
pub fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let begin = Instant::now();
    let made = work();
    (begin.elapsed().as_secs_f64(), made)
}

/// The median time of some runs, seconds.
pub fn median_s(runs: usize, work: impl Fn()) -> f64 {
    let mut seconds: Vec<f64> = (0..runs).map(|_| timed(&work).0).collect();
    seconds.sort_by(f64::total_cmp);
    seconds[runs / 2]
}

/// Points a second: `work` is done at as many as fill a run, at least `least` and at most `most`.
pub fn per_second([least, most]: [usize; 2], work: impl Fn(usize)) -> f64 {
    let (first_s, ()) = timed(|| work(least));
    let count = ((RUN_S / first_s * least as f64) as usize).clamp(least, most);
    count as f64 / median_s(RUNS, || work(count))
}

/// RMSE of the totals over their mean.
pub fn rmse(found_kwh_m2: &[f64], truth: &[Exposure]) -> f64 {
    let count = truth.len() as f64;
    let square: f64 = found_kwh_m2.iter().zip(truth).map(|(found, truth)| (found - truth.total_kwh_m2()).powi(2)).sum();
    (square / count).sqrt() / (truth.iter().map(Exposure::total_kwh_m2).sum::<f64>() / count)
}

/// Mean absolute error of the sky view factors.
pub fn svf_error(found: &[f64], truth: &[Exposure]) -> f64 {
    found.iter().zip(truth).map(|(found, truth)| (found - truth.svf).abs()).sum::<f64>() / truth.len() as f64
}
