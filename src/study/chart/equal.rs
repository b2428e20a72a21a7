//! How many times longer does the path tracer take for the same error?
//!
//! The path tracer's own series is followed to the error that is asked for: between two of its points the logarithm of time
//! is linear in the logarithm of `rms_factor - 1`, which Monte Carlo noise obeys. Outside its points nothing is extrapolated:
//! then the answer is a bound.

use super::Point;

/// How many times longer something takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// The times.
    pub times: f64,
    /// What is known of it.
    pub bound: Bound,
}

/// How far a figure is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    /// It lies between two measured points.
    Between,
    /// It is at least this: the rival's error there is still greater, or infinite.
    AtLeast,
    /// It is at most this: the rival's cheapest point is better already.
    AtMost,
}

impl Ratio {
    /// The figure with `>` or `<` before a bound, for tables.
    pub fn short(&self) -> String {
        let bound = match self.bound {
            Bound::Between => "",
            Bound::AtLeast => ">",
            Bound::AtMost => "<",
        };
        format!("{bound}{:.1}", self.times)
    }
}

impl std::fmt::Display for Ratio {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let bound = match self.bound {
            Bound::Between => "",
            Bound::AtLeast => "at least ",
            Bound::AtMost => "at most ",
        };
        let decimals = if self.times < 10.0 { 1 } else { 0 };
        write!(out, "{bound}{:.decimals$}", self.times)
    }
}

/// How many times longer than `point` the rival takes for the same error, both with their preparation. `rival` is its
/// series at the same number of sensors, the fastest first; `None` for an empty one or a point without a finite error.
pub fn equal_error(point: &Point, rival: &[&Point]) -> Option<Ratio> {
    let wanted = point.rms_factor().filter(|factor| factor.is_finite())?;
    let ratio = |seconds: f64, bound| Some(Ratio { times: seconds / point.total_seconds(), bound });
    let is_as_good = |rival: &Point| rival.rms_factor().is_some_and(|factor| factor <= wanted);
    let Some(first_good) = rival.iter().position(|rival| is_as_good(rival)) else {
        return ratio(rival.last()?.total_seconds(), Bound::AtLeast);
    };
    let good = rival.get(first_good)?;
    let Some(before) = first_good.checked_sub(1).and_then(|before| rival.get(before)) else {
        return ratio(good.total_seconds(), Bound::AtMost);
    };
    let distance = |factor: f64| (factor - 1.0).max(f64::MIN_POSITIVE).ln();
    let (poor, better) = (before.rms_factor()?, good.rms_factor()?);
    if poor.is_infinite() {
        return ratio(before.total_seconds(), Bound::AtLeast);
    }
    let share = (distance(poor) - distance(wanted)) / (distance(poor) - distance(better));
    let [from, to] = [before, good].map(|rival| rival.total_seconds().ln());
    ratio((from + share * (to - from)).exp(), Bound::Between)
}

#[cfg(test)]
mod tests {
    use super::super::tests::point;
    use super::*;

    #[test]
    fn time_follows_the_square_of_the_error_between_points_and_is_bounded_outside() {
        let trace = [(1.0, f64::INFINITY), (4.0, 1.4), (16.0, 1.2)].map(|(time, error)| point("trace", 7, time, error));
        let trace: Vec<&Point> = trace.iter().collect();
        let asked = |error: f64, trace: &[&Point]| equal_error(&point("network", 7, 0.5, error), trace);
        // Half way in log error: half way in log time.
        let found = asked(1.0 + 0.08_f64.sqrt(), &trace).unwrap();
        assert!((found.times - 16.0).abs() < 1e-9 && found.bound == Bound::Between, "{found:?}");
        assert_eq!(asked(1.5, &trace), Some(Ratio { times: 2.0, bound: Bound::AtLeast }));
        assert_eq!(asked(1.1, &trace), Some(Ratio { times: 32.0, bound: Bound::AtLeast }));
        assert_eq!(asked(1.5, &trace[1..]), Some(Ratio { times: 8.0, bound: Bound::AtMost }));
        assert_eq!(asked(f64::INFINITY, &trace), None);
        assert_eq!(asked(1.1, &[]), None);
    }
}
