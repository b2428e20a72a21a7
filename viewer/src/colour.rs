//! Which colour a value has: colour maps, scales and the ranges that a layer starts with.
//!
//! Viridis (default) and cividis read right in grey and with any colour vision (van der Walt, Smith & Firing 2015;
//! Nuñez, Anderton & Renslow 2018); turbo (Mikhailov 2019) shows more steps and is for who wants them; the diverging
//! map is ColorBrewer's red-yellow-blue, safe for colour-blind eyes, for ratios about one. What has no value is of a
//! grey that no map comes near.

use serde::{Deserialize, Serialize};

/// Colour of what has no value, sRGB. Lighter than the middle, where cividis is all but grey.
pub const GREY: [u8; 3] = [164, 164, 164];
/// Share of the values below the top of a default range: a few outliers must not flatten the rest.
const PERCENTILE: f64 = 0.995;
/// Decades that a default range of flux spans.
const FLUX_DECADES: i32 = 4;
/// Least factor to either side of one that a default range of ratios spans.
const LEAST_RATIO: f32 = 1.1;

/// The closed set of maps from a share of a range to a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ColourMap {
    /// Dark blue to yellow: the default.
    #[default]
    Viridis,
    /// Blue to yellow, the same to any colour vision.
    Cividis,
    /// The rainbow made even.
    Turbo,
    /// Blue below, pale yellow at the middle, red above: for ratios and differences.
    Diverging,
}

impl ColourMap {
    /// All of them, as menus list them and as `paint` numbers them.
    pub const ALL: [ColourMap; 4] = [ColourMap::Viridis, ColourMap::Cividis, ColourMap::Turbo, ColourMap::Diverging];

    /// As menus call it.
    pub fn name(self) -> &'static str {
        match self {
            ColourMap::Viridis => "Viridis",
            ColourMap::Cividis => "Cividis",
            ColourMap::Turbo => "Turbo",
            ColourMap::Diverging => "Diverging",
        }
    }

    /// The colour (sRGB) of a share from 0 to 1; clipped at the ends, grey for NaN.
    pub fn rgb(self, share: f32) -> [u8; 3] {
        if share.is_nan() {
            return GREY;
        }
        let share = f64::from(share.clamp(0.0, 1.0));
        let colour = match self {
            ColourMap::Viridis => colorous::VIRIDIS.eval_continuous(share),
            ColourMap::Cividis => colorous::CIVIDIS.eval_continuous(share),
            ColourMap::Turbo => colorous::TURBO.eval_continuous(share),
            // Red is more, as on a thermometer.
            ColourMap::Diverging => colorous::RED_YELLOW_BLUE.eval_continuous(1.0 - share),
        };
        colour.into_array()
    }
}

/// From values to colours.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    /// Which colours.
    pub map: ColourMap,
    /// The value of the map's first colour.
    pub low: f32,
    /// The value of the map's last colour.
    pub high: f32,
    /// Equal steps of colour are equal factors; both ends must then be above zero.
    pub logarithmic: bool,
}

impl Scale {
    /// Where a value stands between `low` (0) and `high` (1); outside of 0 to 1 beyond the ends, half in a range without
    /// extent. None for NaN, and for zero or less when logarithmic: such values are grey.
    pub fn share(&self, value: f32) -> Option<f32> {
        let [low, per_step, at_low] = self.straight();
        let place = if self.logarithmic { value.log2() } else { value };
        let missing = value.is_nan() || (self.logarithmic && value <= 0.0);
        (!missing).then_some((place - low) * per_step + at_low).filter(|share| !share.is_nan())
    }

    /// The value's colour, sRGB: clipped at the ends, grey where it has none.
    pub fn colour(&self, value: f32) -> [u8; 3] {
        self.share(value).map_or(GREY, |share| self.map.rgb(share))
    }

    /// The value that has a share: the inverse of [`Scale::share`], for ticks and limits.
    pub fn value(&self, share: f32) -> f32 {
        if self.logarithmic {
            (self.low.log2() + (self.high.log2() - self.low.log2()) * share).exp2()
        } else {
            self.low + (self.high - self.low) * share
        }
    }

    /// The scale as a straight line `(place - a) * b + c`, `place` being the value or its logarithm to the base of two.
    pub(crate) fn straight(&self) -> [f32; 3] {
        let place = |value: f32| if self.logarithmic { value.log2() } else { value };
        let (low, high) = (place(self.low), place(self.high));
        if high > low { [low, 1.0 / (high - low), 0.0] } else { [low, 0.0, 0.5] }
    }
}

/// The range that a layer of flux (or irradiance, fluence) starts with, for a logarithmic scale: 4 decades below the
/// 99.5th percentile of the values above zero. (1e-4, 1) when there is none.
pub fn flux_range(values: impl IntoIterator<Item = f32>) -> (f32, f32) {
    let lit = values.into_iter().filter(|value| *value > 0.0);
    let high = percentile(lit).unwrap_or(1.0);
    (high / 10_f32.powi(FLUX_DECADES), high)
}

/// The range that a linear layer starts with: from the least value to the 99.5th percentile. (0, 1) when there is none.
pub fn linear_range(values: impl IntoIterator<Item = f32>) -> (f32, f32) {
    let values: Vec<f32> = values.into_iter().filter(|value| value.is_finite()).collect();
    let low = values.iter().copied().reduce(f32::min);
    low.zip(percentile(values)).unwrap_or((0.0, 1.0))
}

/// The range that a layer of ratios starts with, for a logarithmic diverging scale: as far below one as above, to the
/// 99.5th percentile of the farther-off ratios, at least 1/1.1 to 1.1.
pub fn ratio_range(values: impl IntoIterator<Item = f32>) -> (f32, f32) {
    let off = values.into_iter().filter(|value| *value > 0.0).map(|value| value.max(1.0 / value));
    let factor = percentile(off).unwrap_or(LEAST_RATIO).max(LEAST_RATIO);
    (1.0 / factor, factor)
}

/// The 99.5th percentile (nearest rank) of the finite values.
fn percentile(values: impl IntoIterator<Item = f32>) -> Option<f32> {
    let mut values: Vec<f32> = values.into_iter().filter(|value| value.is_finite()).collect();
    let rank = ((values.len() as f64 * PERCENTILE).ceil() as usize).checked_sub(1)?;
    Some(*values.select_nth_unstable_by(rank, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_begin_and_end_as_published() {
        // The ends of matplotlib's viridis: #440154 and #fde725.
        assert_eq!(ColourMap::Viridis.rgb(0.0), [0x44, 0x01, 0x54]);
        assert_eq!(ColourMap::Viridis.rgb(1.0), [0xfd, 0xe7, 0x25]);
        assert_eq!(ColourMap::Viridis.rgb(7.0), ColourMap::Viridis.rgb(1.0));
        let [cold, hot] = [0.0, 1.0].map(|share| ColourMap::Diverging.rgb(share));
        assert!(cold[2] > cold[0] && hot[0] > hot[2], "blue below, red above: {cold:?}, {hot:?}");
        for map in ColourMap::ALL {
            assert_eq!(map.rgb(f32::NAN), GREY);
        }
    }

    #[test]
    fn viridis_and_cividis_brighten_all_the_way() {
        // Luma of Rec. 709 on the encoded values: grows wherever lightness does.
        let luma = |[red, green, blue]: [u8; 3]| {
            0.2126 * f32::from(red) + 0.7152 * f32::from(green) + 0.0722 * f32::from(blue)
        };
        for map in [ColourMap::Viridis, ColourMap::Cividis] {
            let lumas: Vec<f32> = (0..=32).map(|step| luma(map.rgb(step as f32 / 32.0))).collect();
            assert!(lumas.windows(2).all(|pair| pair[0] < pair[1]), "{map:?}: {lumas:?}");
        }
    }

    #[test]
    fn no_map_comes_near_the_grey_of_missing_values() {
        for map in ColourMap::ALL {
            for step in 0..=256 {
                let colour = map.rgb(step as f32 / 256.0);
                let apart = colour.iter().zip(GREY).map(|(a, b)| a.abs_diff(b)).max().unwrap();
                assert!(apart >= 40, "{map:?} has {colour:?}");
            }
        }
    }

    #[test]
    fn shares_are_linear_or_by_factors() {
        let mut scale = Scale { map: ColourMap::Viridis, low: 1.0, high: 100.0, logarithmic: true };
        for (value, share) in [(1.0, 0.0), (10.0, 0.5), (100.0, 1.0), (1000.0, 1.5)] {
            assert!((scale.share(value).unwrap() - share).abs() < 1e-6);
            assert!((scale.value(share) / value - 1.0).abs() < 1e-5);
        }
        scale.logarithmic = false;
        assert!((scale.share(50.5).unwrap() - 0.5).abs() < 1e-6);
        assert_eq!(scale.value(0.5), 50.5);
    }

    #[test]
    fn missing_values_are_grey_and_zero_is_when_logarithmic() {
        let logarithmic = Scale { map: ColourMap::Turbo, low: 0.1, high: 10.0, logarithmic: true };
        let linear = Scale { logarithmic: false, low: 0.0, ..logarithmic };
        assert_eq!([f32::NAN, 0.0, -1.0].map(|value| logarithmic.colour(value)), [GREY; 3]);
        assert_eq!(linear.colour(f32::NAN), GREY);
        assert_eq!(linear.colour(0.0), ColourMap::Turbo.rgb(0.0));
        assert_eq!(linear.colour(f32::INFINITY), ColourMap::Turbo.rgb(1.0));
    }

    #[test]
    fn a_range_without_extent_shows_the_middle() {
        let scale = Scale { map: ColourMap::Cividis, low: 3.0, high: 3.0, logarithmic: false };
        assert_eq!(scale.colour(3.0), ColourMap::Cividis.rgb(0.5));
    }

    #[test]
    fn default_ranges_leave_outliers_out() {
        // 1 to 1000, and one value far off: the 996th of 1001 is the 99.5th percentile by nearest rank.
        let values = || (1..=1000).map(|value| value as f32).chain([1e9, f32::NAN, f32::INFINITY]);
        assert_eq!(linear_range(values()), (1.0, 996.0));
        assert_eq!(flux_range(values().chain([0.0, -5.0])), (996.0 / 1e4, 996.0));
        assert_eq!(ratio_range([0.25, 1.0, 2.0]), (0.25, 4.0));

        assert_eq!(linear_range([f32::NAN]), (0.0, 1.0));
        assert_eq!(flux_range([0.0]), (1e-4, 1.0));
        assert_eq!(ratio_range([1.0]), (1.0 / 1.1, 1.1));
    }
}
