//! How the values of a measure are spread, where its bar begins and ends, and which ticks it has.

use crate::colour::Scale;
use crate::measure::Measure;
use crate::stamp::Stamp;
use crate::state::State;
use egui::Ui;
use std::sync::Arc;

/// Bars of the histogram.
const BINS: usize = 88;

/// A logarithmic bar reaches no farther below the largest value than this factor: what is less is as good as dark.
const DEEPEST: f32 = 1e-6;

/// The values of a measure, counted.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// Where the bar begins: the least value, or the least that its fitted range has.
    pub low: f32,
    /// Where it ends.
    pub high: f32,
    /// Whether equal steps are equal factors.
    pub logarithmic: bool,
    /// How many values are in each part of it, of the fullest part's.
    pub bins: Vec<f32>,
    /// The least and the largest value, for the signs at clipped ends.
    pub ends: [f32; 2],
}

impl Spread {
    /// Counts values; `None` where none can be shown. `fitted` is the scale that fits them.
    pub fn of(values: &[f32], fitted: &Scale) -> Option<Self> {
        let logarithmic = fitted.logarithmic;
        let is_shown = |value: &f32| value.is_finite() && (!logarithmic || *value > 0.0);
        let shown = || values.iter().copied().filter(is_shown);
        let least = shown().reduce(f32::min)?;
        let largest = shown().reduce(f32::max)?;
        let lowest = if logarithmic { least.max(largest * DEEPEST) } else { least };
        let (low, mut high) = (lowest.min(fitted.low), largest.max(fitted.high));
        if high <= low {
            high = if logarithmic { low * 10.0 } else { low + 1.0 };
        }

        let mut spread = Self { low, high, logarithmic, bins: Vec::new(), ends: [least, largest] };
        let mut counts = vec![0_u32; BINS];
        for value in shown() {
            let bin = (spread.share(value, low, high) * BINS as f32) as usize;
            counts[bin.min(BINS - 1)] += 1;
        }
        let fullest = counts.iter().copied().max().unwrap_or(1).max(1) as f32;
        // A square root, so that what is rare is seen too.
        spread.bins = counts.into_iter().map(|count| (count as f32 / fullest).sqrt()).collect();
        Some(spread)
    }

    /// Where a value stands between two others, 0 to 1 and beyond.
    pub fn share(&self, value: f32, low: f32, high: f32) -> f32 {
        let place = |value: f32| if self.logarithmic { value.max(f32::MIN_POSITIVE).ln() } else { value };
        (place(value) - place(low)) / (place(high) - place(low))
    }

    /// The value at a share between two others.
    pub fn value(&self, share: f32, low: f32, high: f32) -> f32 {
        if self.logarithmic { low * (high / low).powf(share) } else { low + (high - low) * share }
    }
}

/// What is kept from frame to frame.
#[derive(Clone)]
struct Kept {
    stamp: Stamp,
    spread: Option<Arc<Spread>>,
}

/// The spread of a measure, counted again when its values change.
pub fn kept(ui: &Ui, state: &State, measure: Measure) -> Option<Arc<Spread>> {
    let key = ui.scope_id().with(("spread", measure));
    let stamp = Stamp::of(&state.results);
    if let Some(kept) = ui.data(|data| data.get_temp::<Kept>(key))
        && kept.stamp.is(&stamp)
    {
        return kept.spread;
    }
    let values = measure.values(&state.results);
    let spread = Spread::of(&values, &measure.fitted(&values, state.map(measure))).map(Arc::new);
    ui.data_mut(|data| data.insert_temp(key, Kept { stamp, spread: spread.clone() }));
    spread
}

/// Ticks between two values: powers of ten, with twos and fives where there are few, or round steps.
pub fn ticks(low: f32, high: f32, logarithmic: bool) -> Vec<f32> {
    if !(low.is_finite() && high > low) {
        return Vec::new();
    }
    let fits = |tick: &f32| (low * 0.999..=high * 1.001).contains(tick) || (*tick >= low && *tick <= high);
    if logarithmic {
        let decades = high.log10() - low.log10();
        let times: &[f32] = if decades < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let every = (decades / 5.0).ceil().max(1.0) as i32;
        let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
        let of_power = |power: i32| times.iter().map(move |times| times * 10_f32.powi(power));
        return powers.filter(|power| power.rem_euclid(every) == 0).flat_map(of_power).filter(fits).collect();
    }
    let rough = f64::from(high - low) / 4.0;
    let power = 10_f64.powf(rough.log10().floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].map(|times| times * power).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    let first = (f64::from(low) / step).ceil() as i64;
    (first..first + 12).map(|number| (number as f64 * step) as f32).filter(fits).collect()
}

/// A tick as it is written, short.
pub fn tick_text(tick: f32) -> String {
    let size = tick.abs();
    if tick == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&size) {
        let text = format!("{tick:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let text = format!("{tick:.1e}");
        text.replace(".0e", "e")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::ColourMap;

    fn scale(low: f32, high: f32, logarithmic: bool) -> Scale {
        Scale { map: ColourMap::Viridis, low, high, logarithmic }
    }

    #[test]
    fn values_are_counted_where_they_stand() {
        let values = [0.0, 1.0, 2.0, 3.0, 4.0, f32::NAN];
        let spread = Spread::of(&values, &scale(0.0, 4.0, false)).expect("values");
        assert_eq!((spread.low, spread.high, spread.ends), (0.0, 4.0, [0.0, 4.0]));
        let full: Vec<usize> = (0..BINS).filter(|&bin| spread.bins[bin] > 0.0).collect();
        assert_eq!(full, [0, BINS / 4, BINS / 2, 3 * BINS / 4, BINS - 1]);
    }

    #[test]
    fn a_logarithmic_bar_leaves_out_zero_and_what_is_as_good_as_dark() {
        let spread = Spread::of(&[0.0, 1e-20, 1.0, 10.0], &scale(1e-3, 10.0, true)).expect("values");
        assert!((spread.low / 1e-5 - 1.0).abs() < 1e-5, "{}", spread.low);
        assert_eq!((spread.high, spread.ends), (10.0, [1e-20, 10.0]));
        assert_eq!(Spread::of(&[0.0, f32::NAN], &scale(1e-3, 10.0, true)), None);
    }

    #[test]
    fn shares_and_values_are_each_others_inverse() {
        for logarithmic in [false, true] {
            let spread = Spread::of(&[0.5, 8.0], &scale(0.5, 8.0, logarithmic)).expect("values");
            for value in [0.5, 1.0, 3.0, 8.0] {
                let share = spread.share(value, spread.low, spread.high);
                assert!((spread.value(share, spread.low, spread.high) - value).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn ticks_are_round() {
        let texts = |low, high, logarithmic| -> Vec<String> {
            ticks(low, high, logarithmic).into_iter().map(tick_text).collect()
        };
        assert_eq!(texts(0.0, 10.0, false), ["0", "5", "10"]);
        assert_eq!(texts(-0.3, 0.45, false), ["-0.2", "0", "0.2", "0.4"]);
        assert_eq!(texts(1e-4, 1.0, true), ["1e-4", "0.001", "0.01", "0.1", "1"]);
        assert_eq!(texts(0.5, 2.0, true), ["0.5", "1", "2"]);
        assert_eq!(texts(1.0, 1.0, true), [""; 0]);
    }
}
