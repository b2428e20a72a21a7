//! How long does a run take for how many sensors: measured where a budget allows it, else scaled and marked as such.

/// The caller's clock: seconds since any moment. The library has none of its own.
pub type Clock<'a> = dyn Fn() -> f64 + 'a;

/// A run shorter than this is timed three times and the median taken, seconds: longer ones are steady enough.
const SHORT_SECONDS: f64 = 0.5;

/// A step to more sensors goes at most this far beyond what was measured, since a line through two nearby runs is poor.
const FARTHEST_STEP: f64 = 100.0;

/// A number of sensors is worth a further run only when it is this many times the last.
const LEAST_STEP: f64 = 2.0;

/// The time of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timed {
    /// How long it takes.
    pub seconds: f64,
    /// Whether it was scaled from runs at fewer sensors.
    pub is_scaled: bool,
}

/// Times a run by the clock: the median of three when it is short, else its first. Gives its last answer too.
///
/// # Errors
/// What the run says.
pub fn median_of_three<T, E>(clock: &Clock, mut run: impl FnMut() -> Result<T, E>) -> Result<(f64, T), E> {
    let mut once = || {
        let began = clock();
        let answer = run()?;
        Ok((clock() - began, answer))
    };
    let (first, answer) = once()?;
    if first >= SHORT_SECONDS {
        return Ok((first, answer));
    }
    let (second, _) = once()?;
    let (third, answer) = once()?;
    let median = first.max(second).min(first.min(second).max(third));
    Ok((median, answer))
}

/// Seconds for each number of sensors, which ascend; `seconds_for` runs for one. The first is always run. No run is begun
/// that by the runs before it would exceed `budget_seconds`; instead the most sensors that fit are run, and the rest
/// follows the straight line through the last two runs (through the origin where there is one).
///
/// # Errors
/// What a run says.
pub fn times<E>(
    counts: &[usize],
    budget_seconds: f64,
    mut seconds_for: impl FnMut(usize) -> Result<f64, E>,
) -> Result<Vec<Timed>, E> {
    let mut line = Line::default();
    let mut timed = Vec::new();
    for &count in counts {
        let found = loop {
            let next = line.reach(count, budget_seconds);
            let is_worth_it = next == count || next as f64 >= LEAST_STEP * line.last.0;
            if !is_worth_it {
                break Timed { seconds: line.at(count), is_scaled: true };
            }
            let seconds = seconds_for(next)?;
            line.add(next, seconds);
            if next == count {
                break Timed { seconds, is_scaled: false };
            }
        };
        timed.push(found);
    }
    Ok(timed)
}

/// The straight line through the last two runs: sensors and seconds. Before any run both are the origin.
#[derive(Debug, Default)]
struct Line {
    first: (f64, f64),
    last: (f64, f64),
}

impl Line {
    fn add(&mut self, count: usize, seconds: f64) {
        self.first = self.last;
        self.last = (count as f64, seconds);
    }

    /// Seconds a sensor; a later run that happened to be faster counts as equal.
    fn slope(&self) -> f64 {
        let rise = (self.last.1 - self.first.1) / (self.last.0 - self.first.0).max(1.0);
        rise.max(0.0)
    }

    fn at(&self, count: usize) -> f64 {
        self.last.1 + self.slope() * (count as f64 - self.last.0)
    }

    /// The most sensors, at most `count`, that fit in the budget; everything before the first run.
    fn reach(&self, count: usize, budget_seconds: f64) -> usize {
        if self.last.0 == 0.0 {
            return count;
        }
        let fitting = self.last.0 + (budget_seconds - self.last.1) / self.slope().max(f64::MIN_POSITIVE);
        count.min(fitting.min(FARTHEST_STEP * self.last.0).max(0.0) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::{Cell, RefCell};
    use std::convert::Infallible;

    /// The times found, and at how many sensors it was run, for a run of `fixed + each * sensors` seconds.
    fn found(fixed: f64, each: f64, budget: f64) -> (Vec<Timed>, Vec<usize>) {
        let runs = RefCell::new(Vec::new());
        let seconds_for = |count: usize| {
            runs.borrow_mut().push(count);
            Ok::<f64, Infallible>(fixed + each * count as f64)
        };
        let Ok(timed) = times(&[7, 1_000, 100_000], budget, seconds_for);
        (timed, runs.into_inner())
    }

    #[test]
    fn what_fits_the_budget_is_measured() {
        let (timed, runs) = found(0.01, 1e-5, 20.0);
        assert!(timed.iter().all(|timed| !timed.is_scaled));
        assert_eq!(runs.last(), Some(&100_000));
    }

    #[test]
    fn what_does_not_fit_is_scaled_along_its_line_and_marked() {
        for (fixed, each) in [(0.0, 1e-3), (2.0, 1e-3), (0.05, 5.0)] {
            let (timed, runs) = found(fixed, each, 20.0);
            let last = timed.last().unwrap();
            assert!(last.is_scaled);
            assert!((last.seconds / (fixed + each * 100_000.0) - 1.0).abs() < 0.02, "{fixed} {each}: {last:?}");
            assert!(runs[1..].iter().all(|&count| fixed + each * count as f64 <= 20.001), "{runs:?}");
        }
    }

    #[test]
    fn the_median_of_short_runs_and_one_long_run() {
        for (durations, want, runs_wanted) in
            [([0.3, 0.1, 0.2], 0.2, 3), ([0.1, 0.3, 0.2], 0.2, 3), ([0.1, 0.2, 0.3], 0.2, 3), ([2.0, 0.1, 0.1], 2.0, 1)]
        {
            let (now, runs) = (Cell::new(0.0), Cell::new(0));
            let clock = || now.get();
            let Ok((seconds, ())) = median_of_three(&clock, || {
                now.set(now.get() + durations[runs.get()]);
                runs.set(runs.get() + 1);
                Ok::<(), Infallible>(())
            });
            assert!((seconds - want).abs() < 1e-12, "{durations:?}: {seconds}");
            assert_eq!(runs.get(), runs_wanted);
        }
    }
}
