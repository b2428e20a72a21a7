//! How bright is each direction of a clear sky at one wavelength? Hosek and Wilkie's spectral data, 320 to 720 nm by 40.
//!
//! The same formula as in RGB, a channel for each of eleven wavelengths, in W/(m2 sr nm). Linear over turbidity and albedo,
//! quintic (Bernstein) over the cube root of the sun's elevation, as in the authors' own code.

use super::{Channel, TURBIDITY};
use crate::sky::within;
use std::f64::consts::FRAC_PI_2;

/// The wavelengths of the data, nanometres.
pub const WAVELENGTHS_NM: [f64; WAVELENGTHS] =
    [320.0, 360.0, 400.0, 440.0, 480.0, 520.0, 560.0, 600.0, 640.0, 680.0, 720.0];

/// Turbidities 1 to 10.
const TURBIDITIES: usize = 10;
/// Ground albedos 0 and 1.
const ALBEDOS: usize = 2;
/// Control points over the sun's elevation.
const CONTROLS: usize = 6;
const WAVELENGTHS: usize = 11;
const PARAMS: usize = 9;

/// The data (3-clause BSD, `licences/hosek-wilkie.txt`): 8 bytes `HWSPEC01`; the five counts above as u32; then f32, little
/// endian: parameters by turbidity, albedo, control point, wavelength and place, the last fastest; mean radiances by
/// turbidity, albedo, control point, wavelength. `benches/peers/sky_mitsuba.py data` writes it from Mitsuba's copy.
static DATA: &[u8] = include_bytes!("spectral.bin");

/// Bytes before the first number.
const HEAD: usize = 8 + 5 * 4;

/// The state of all wavelengths for one sun, turbidity and ground.
#[derive(Debug, Clone, PartialEq)]
pub struct HosekSpectrum {
    /// One a wavelength of [`WAVELENGTHS_NM`]; radiances in W/(m2 sr nm).
    pub channels: [Channel; WAVELENGTHS],
}

impl HosekSpectrum {
    /// The sky with the sun at `sun_elevation_rad`, clamped to 0 to a quarter turn; `turbidity` clamped to 1 to 10 and
    /// `ground_albedo` to 0 to 1. NaN counts as the lower bound. About 10 us.
    pub fn new(sun_elevation_rad: f64, turbidity: f64, ground_albedo: f64) -> Self {
        Self { channels: channels(sun_elevation_rad, turbidity, ground_albedo, std::array::from_fn(|at| at)) }
    }

    /// Radiance towards a direction at each wavelength, W/(m2 sr nm), by its cosines to the zenith (0 used below the
    /// horizon) and to the sun. Never negative, never NaN.
    pub fn radiance(&self, cos_zenith: f64, cos_gamma: f64) -> [f64; WAVELENGTHS] {
        let cos_gamma = within(cos_gamma, (-1.0, 1.0));
        let gamma_rad = cos_gamma.acos();
        std::array::from_fn(|at| self.channels[at].at(cos_zenith, gamma_rad, cos_gamma))
    }
}

/// The channels of some wavelengths, given by their places in [`WAVELENGTHS_NM`].
pub(super) fn channels<const N: usize>(
    sun_elevation_rad: f64,
    turbidity: f64,
    ground_albedo: f64,
    wavelengths: [usize; N],
) -> [Channel; N] {
    let elevation = within(sun_elevation_rad, (0.0, FRAC_PI_2));
    let turbidity = within(turbidity, TURBIDITY);
    let albedo = within(ground_albedo, (0.0, 1.0));

    let lower = (turbidity as usize).clamp(1, TURBIDITIES - 1) - 1;
    let share = turbidity - 1.0 - lower as f64;
    let over_elevation = bernstein((elevation / FRAC_PI_2).cbrt());

    wavelengths.map(|wavelength| {
        let mut channel = Channel::default();
        for (at_turbidity, by_turbidity) in [(lower, 1.0 - share), (lower + 1, share)] {
            for (at_albedo, by_albedo) in [(0, 1.0 - albedo), (1, albedo)] {
                for (control, by_elevation) in over_elevation.iter().enumerate() {
                    let weight = by_turbidity * by_albedo * by_elevation;
                    let place = ((at_turbidity * ALBEDOS + at_albedo) * CONTROLS + control) * WAVELENGTHS + wavelength;
                    for (param, sum) in channel.params.iter_mut().enumerate() {
                        *sum += weight * number(place * PARAMS + param);
                    }
                    channel.radiance +=
                        weight * number(TURBIDITIES * ALBEDOS * CONTROLS * WAVELENGTHS * PARAMS + place);
                }
            }
        }
        channel
    })
}

/// Bernstein's six polynomials of degree five at `t`.
fn bernstein(t: f64) -> [f64; CONTROLS] {
    let s = 1.0 - t;
    [
        s.powi(5),
        5.0 * s.powi(4) * t,
        10.0 * s.powi(3) * t.powi(2),
        10.0 * s.powi(2) * t.powi(3),
        5.0 * s * t.powi(4),
        t.powi(5),
    ]
}

/// A number of the data by its place after the head.
fn number(place: usize) -> f64 {
    let at = HEAD + 4 * place;
    f64::from(f32::from_le_bytes([DATA[at], DATA[at + 1], DATA[at + 2], DATA[at + 3]]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_data_are_as_their_head_says() {
        assert_eq!(&DATA[..8], b"HWSPEC01");
        let counts: Vec<u32> =
            DATA[8..HEAD].chunks(4).map(|count| u32::from_le_bytes(count.try_into().unwrap())).collect();
        assert_eq!(counts, [TURBIDITIES, ALBEDOS, CONTROLS, WAVELENGTHS, PARAMS].map(|count| count as u32));
        assert_eq!(DATA.len(), HEAD + 4 * TURBIDITIES * ALBEDOS * CONTROLS * WAVELENGTHS * (PARAMS + 1));
        assert!(DATA.len() < 60_000);
    }

    #[test]
    fn the_polynomials_sum_to_one() {
        for t in [0.0, 0.2, 0.5, 1.0] {
            assert!((bernstein(t).iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn whole_turbidities_meet_from_both_sides() {
        for turbidity in 2..=9 {
            let at = f64::from(turbidity);
            let below = HosekSpectrum::new(0.7, at - 1e-9, 0.3).radiance(0.5, 0.8);
            let above = HosekSpectrum::new(0.7, at, 0.3).radiance(0.5, 0.8);
            for (a, b) in below.iter().zip(above) {
                assert!((a - b).abs() < 1e-7 * b, "{turbidity}: {a} {b}");
            }
        }
    }

    proptest! {
        #[test]
        fn no_radiance_is_negative_or_nan(
            elevation in -FRAC_PI_2..FRAC_PI_2, turbidity in 1.0..12.0, albedo in 0.0..=1.0,
            cos_zenith in -1.0..=1.0, cos_gamma in -1.0..=1.0,
        ) {
            for value in HosekSpectrum::new(elevation, turbidity, albedo).radiance(cos_zenith, cos_gamma) {
                prop_assert!(value.is_finite() && value >= 0.0, "{value}");
            }
        }
    }
}
