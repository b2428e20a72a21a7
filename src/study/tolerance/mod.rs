//! What is the coarsest model and the cheapest method that answer within a factor?
//!
//! Two qualities are compared, then two voxel sizes, each the next finer one, until they agree. An answer is expected to be off
//! by twice what it differs from the finer one, and by the finer one's own error estimate on top ([`expected`]): both are root
//! mean squares of logarithms over the lit sensors, as `rms_factor` is. A method without an error estimate of its own vouches
//! for nothing and is never chosen.
//!
//! Limits: what two neighbours in quality or size both miss is not seen (an opening that both close, a bias that both have);
//! `examples/tolerance_report.rs` counts how often the truth lies inside what was promised.

mod choose;

pub use choose::{Chosen, Quality, Search};

use crate::light::Reading;

/// Sensors below this share of the brightest are not asked to agree: they are light of many reflections that no user sees.
pub const LEAST_SHARE: f64 = 1e-6;

/// What was chosen, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The factor that was asked for.
    pub tolerance: f64,
    /// The edge of a voxel, metres.
    pub voxel_m: f32,
    /// Method and quality: `network medium`.
    pub method: String,
    /// The factor by which the answer is expected to be off; `None` where no method could tell.
    pub expected_factor: Option<f64>,
    /// What was modelled, a sentence each.
    pub modelled: Vec<String>,
    /// What was not, and why.
    pub skipped: Vec<Skipped>,
}

/// Something that was not modelled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Skipped {
    /// What it is: `voxels of 0.05 m`, `backward`.
    pub what: String,
    /// Why it was skipped.
    pub why: String,
}

impl Choice {
    /// Whether the answer is expected to be inside the tolerance.
    pub fn is_inside(&self) -> bool {
        self.expected_factor.is_some_and(|factor| factor <= self.tolerance)
    }

    /// The choice for a person, a line each.
    pub fn lines(&self) -> Vec<String> {
        let expected = match self.expected_factor {
            Some(factor) if factor.is_finite() => format!("expected to be right within a factor of {factor:.2}"),
            _ => "nothing tells how far it is off".to_owned(),
        };
        let verdict = if self.is_inside() { "inside" } else { "NOT inside" };
        let mut lines = vec![format!(
            "chosen: {}, voxels of {} m; {expected}, {verdict} the tolerance of {}",
            self.method, self.voxel_m, self.tolerance
        )];
        lines.extend(self.modelled.iter().map(|what| format!("modelled: {what}")));
        lines.extend(self.skipped.iter().map(|Skipped { what, why }| format!("skipped: {what}: {why}")));
        lines
    }
}

/// The factor by which readings are off by their own estimate; `None` where a lit one has none, or
/// without readings; 1 where none is lit.
pub fn own_factor(readings: &[Reading]) -> Option<f64> {
    let least = LEAST_SHARE * brightest(readings);
    let lit = readings.iter().filter(|reading| reading.value_w_m2 > least);
    let logs: Option<Vec<f64>> =
        lit.map(|reading| reading.error_w_m2.map(|error| (error / reading.value_w_m2).ln_1p())).collect();
    logs.filter(|_| !readings.is_empty()).map(|logs| root_mean_square(&logs).exp())
}

/// The factor between two answers at the same sensors; infinite where only one of them has light.
pub fn agreement(a: &[Reading], b: &[Reading]) -> f64 {
    let least = LEAST_SHARE * brightest(a).max(brightest(b));
    let pairs = a.iter().zip(b).map(|(a, b)| [a.value_w_m2, b.value_w_m2]);
    let logs: Vec<f64> =
        pairs.filter(|pair| pair.iter().any(|&value| value > least)).map(|[a, b]| (a / b).ln()).collect();
    root_mean_square(&logs).exp()
}

/// What remains after a step to the next finer quality or voxel size is as much again as the step: so it is where halving
/// the step halves the error (Richardson 1911, first order). Voxels, bounces and zones are no better than that.
const STEPS_LEFT: f64 = 2.0;

/// The factor by which an answer is expected to be off that differs by `agreement` from the next finer one, whose own error
/// is `own`.
pub fn expected(agreement: f64, own: f64) -> f64 {
    (STEPS_LEFT * agreement.ln()).hypot(own.ln()).exp()
}

fn brightest(readings: &[Reading]) -> f64 {
    readings.iter().map(|reading| reading.value_w_m2).fold(0.0, f64::max)
}

fn root_mean_square(logs: &[f64]) -> f64 {
    let squares: f64 = logs.iter().map(|log| log * log).sum();
    (squares / (logs.len() as f64).max(1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Status;
    use glam::DVec3;

    pub(super) fn reading(value_w_m2: f64, error_w_m2: Option<f64>) -> Reading {
        Reading { value_w_m2, flux_w_m2: DVec3::ZERO, error_w_m2, status: Status::Ok }
    }

    #[test]
    fn factors_are_root_mean_squares_of_logarithms() {
        let a = [reading(1.0, Some(1.0)), reading(4.0, Some(0.0))];
        let b = [reading(2.0, Some(0.0)), reading(4.0, None)];
        let want = (0.5 * 2_f64.ln().powi(2)).sqrt().exp();
        assert!((agreement(&a, &b) - want).abs() < 1e-12 && (own_factor(&a).unwrap() - want).abs() < 1e-12);
        assert_eq!(own_factor(&b), None);
        assert!((expected(2.0, 1.0) - 4.0).abs() < 1e-12 && expected(2.0, 1.5) > 4.0);
    }

    #[test]
    fn light_that_only_one_finds_is_no_agreement_and_what_nobody_sees_counts_nowhere() {
        let lit = [reading(1.0, Some(0.0)), reading(1e-3, Some(0.0)), reading(1e-9, None)];
        let lost = [reading(1.0, Some(0.0)), reading(0.0, Some(0.0)), reading(2e-9, None)];
        assert_eq!(agreement(&lit, &lost), f64::INFINITY);
        assert_eq!(agreement(&lost, &lit), f64::INFINITY);
        assert_eq!(own_factor(&lit), Some(1.0));
        assert_eq!((agreement(&lit, &lit), agreement(&[], &[]), own_factor(&[])), (1.0, 1.0, None));
    }
}
