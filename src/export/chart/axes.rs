//! The two axes of a panel: seconds, logarithmic; and `rms_factor`, logarithmic in its distance from 1.
//!
//! On a plain logarithmic axis of the factor everything from 1.01 to 1.2 would be one line. The logarithm of `factor - 1` is
//! the same for large factors, and shows small errors by their decades too; Monte Carlo noise falls along a straight line.

/// A logarithmic axis: where a value stands on the sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Natural logarithms of the ends.
    low: f64,
    high: f64,
    /// Places of the ends on the sheet.
    from: f64,
    to: f64,
}

impl Axis {
    /// An axis from `low` to `high`, both above 0, that lies from `from` to `to` on the sheet.
    pub fn new([low, high]: [f64; 2], [from, to]: [f64; 2]) -> Self {
        Self { low: low.ln(), high: high.ln(), from, to }
    }

    /// The place of a value above 0; what lies beyond an end stands at that end.
    pub fn place(&self, value: f64) -> f64 {
        let share = ((value.ln() - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.from + share * (self.to - self.from)
    }

    /// Whether a value lies on the axis.
    pub fn shows(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value.ln())
    }
}

/// Room beyond the outermost points, as a factor of the value.
const MARGIN: f64 = 1.6;

/// Ends of an axis of seconds around these values; a decade where there are none.
pub fn seconds_range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = ends(values.filter(|value| *value > 0.0));
    if low > high { [0.1, 1.0] } else { [low / MARGIN, high * MARGIN] }
}

/// Factors that the axis can end at, the least first.
const FACTOR_ENDS: [f64; 10] = [1.005, 1.01, 1.02, 1.05, 1.1, 2.0, 5.0, 10.0, 30.0, 100.0];

/// Ends of an axis of factors around these, above 1; at least from 1.1 to 5. What lies beyond the last end is drawn at the border.
pub fn factor_range(factors: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = ends(factors.filter(|factor| factor.is_finite()));
    let below = FACTOR_ENDS.into_iter().rev().find(|&end| end <= low.min(1.1)).unwrap_or(FACTOR_ENDS[0]);
    let above = FACTOR_ENDS.into_iter().find(|&end| end >= high.max(5.0)).unwrap_or(FACTOR_ENDS[9]);
    [below, above]
}

fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

/// The decades within a range of seconds, with their names.
pub fn seconds_ticks([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let decades = low.log10().ceil() as i32..=high.log10().floor() as i32;
    decades.map(|decade| (10_f64.powi(decade), seconds_name(decade))).collect()
}

fn seconds_name(decade: i32) -> String {
    let number = |power: i32| if power >= 0 { "1".to_owned() + &"0".repeat(power as usize) } else { String::new() };
    match decade {
        ..=-7 => format!("1e{decade} s"),
        -6..=-4 => format!("{} \u{b5}s", number(decade + 6)),
        -3..=-2 => format!("{} ms", number(decade + 3)),
        -1 => "0.1 s".to_owned(),
        0..=3 => format!("{} s", number(decade)),
        _ => format!("1e{decade} s"),
    }
}

/// Factors that have a line and a name, where the range shows them.
pub const FACTOR_TICKS: [f64; 13] = [1.005, 1.01, 1.02, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_goes_from_end_to_end_and_no_further() {
        let axis = Axis::new([0.01, 100.0], [10.0, 50.0]);
        for (value, want) in [(0.01, 10.0), (1.0, 30.0), (100.0, 50.0), (1e9, 50.0), (f64::INFINITY, 50.0)] {
            assert!((axis.place(value) - want).abs() < 1e-9, "{value}");
        }
        assert!(axis.shows(1.0) && !axis.shows(f64::INFINITY) && !axis.shows(1e-9));
    }

    #[test]
    fn ranges_hold_their_values_and_ticks_name_decades() {
        assert_eq!(factor_range([1.07, 54.0, f64::INFINITY].into_iter()), [1.05, 100.0]);
        assert_eq!(factor_range([].into_iter()), [1.1, 5.0]);
        let [low, high] = seconds_range([0.002, 30.0].into_iter());
        assert!(low < 0.002 && high > 30.0);
        let names: Vec<String> = seconds_ticks([1e-5, 20_000.0]).into_iter().map(|(_, name)| name).collect();
        assert_eq!(names, ["10 µs", "100 µs", "1 ms", "10 ms", "0.1 s", "1 s", "10 s", "100 s", "1000 s", "1e4 s"]);
    }
}
