//! How bright is each direction of a sky whose direct and diffuse irradiance were measured?
//!
//! The all-weather model of Perez, Seals and Michalsky ("All-weather model for sky luminance distribution", Solar Energy
//! 50(3), 235-245, 1993; erratum 51(5), 423): direct and diffuse irradiance give the sky's clearness and brightness; the
//! clearness chooses one of eight rows of coefficients; brightness and the sun's zenith angle make of them five parameters,
//! `a` to `e`, of one formula: how the sky changes towards the horizon, times how it brightens around the sun.
//!
//! The result is relative: whoever uses it scales it so that the sky gives the diffuse horizontal irradiance
//! ([`skies`](super::dome::skies) does). The sun's own disc is not in it.
//!
//! With Radiance's sun, and scaled by its sum over patches, the mean sky of a year is that of its `gendaymtx` within 0.002%
//! (RMS over the patches, `tests/it/weather.rs`).
//!
//! Limits: the model was fitted to luminances of one site, Berkeley, with the sun up to 80 degrees high; it knows nothing
//! of single clouds. Within a row brightness is kept to what skies are, as Radiance's `gendaymtx` does; between two rows
//! the sky jumps.

use super::clear::kasten_air_mass;
use super::within;
use std::f64::consts::{FRAC_PI_2, PI};

/// Irradiance of the sun outside the atmosphere at mean distance, W/m2, as the model was fitted with.
const SOLAR_CONSTANT_W_M2: f64 = 1367.0;

/// What clearness is kept to: no sky is cloudier than overcast, and none clearer than the last row's.
const CLEARNESS: (f64, f64) = (1.0, 11.9);

/// What brightness is kept to: the skies that were fitted. Beyond, the formula's exponentials run away.
const BRIGHTNESS: (f64, f64) = (0.01, 0.6);

/// Between these two clearnesses (1.065 is the end of the first row)...
const DIM: (f64, f64) = (1.065, 2.8);

/// ... no sky is taken as darker than this: the rows there leave what was measured and turn negative.
const DIMMEST: f64 = 0.2;

/// The sun is kept this far from the zenith: nearer, the brightening around it is beyond what was fitted.
const LEAST_ZENITH_RAD: f64 = 3.0 * PI / 180.0;

/// The least cosine of a direction's zenith angle: 0.6 degrees above the horizon, where the formula would divide by 0.
pub const LEAST_COS_ZENITH: f64 = 0.01;

/// One row of the table: for each parameter the four numbers of its dependence on brightness and the sun's zenith angle.
struct Bin {
    clearness_from: f64,
    a: [f64; 4],
    b: [f64; 4],
    c: [f64; 4],
    d: [f64; 4],
    e: [f64; 4],
}

/// Table 1 of the paper, with the erratum.
const BINS: [Bin; 8] = [
    Bin {
        clearness_from: 1.0,
        a: [1.3525, -0.2576, -0.269, -1.4366],
        b: [-0.767, 0.0007, 1.2734, -0.1233],
        c: [2.8, 0.6004, 1.2375, 1.0],
        d: [1.8734, 0.6297, 0.9738, 0.2809],
        e: [0.0356, -0.1246, -0.5718, 0.9938],
    },
    Bin {
        clearness_from: 1.065,
        a: [-1.2219, -0.773, 1.4148, 1.1016],
        b: [-0.2054, 0.0367, -3.9128, 0.9156],
        c: [6.975, 0.1774, 6.4477, -0.1239],
        d: [-1.5798, -0.5081, -1.7812, 0.108],
        e: [0.2624, 0.0672, -0.219, -0.4285],
    },
    Bin {
        clearness_from: 1.23,
        a: [-1.1, -0.2515, 0.8952, 0.0156],
        b: [0.2782, -0.1812, -4.5, 1.1766],
        c: [24.7219, -13.0812, -37.7, 34.8438],
        d: [-5.0, 1.5218, 3.9229, -2.6204],
        e: [-0.0156, 0.1597, 0.4199, -0.5562],
    },
    Bin {
        clearness_from: 1.5,
        a: [-0.5484, -0.6654, -0.2672, 0.7117],
        b: [0.7234, -0.6219, -5.6812, 2.6297],
        c: [33.3389, -18.3, -62.25, 52.0781],
        d: [-3.5, 0.0016, 1.1477, 0.1062],
        e: [0.4659, -0.3296, -0.0876, -0.0329],
    },
    Bin {
        clearness_from: 1.95,
        a: [-0.6, -0.3566, -2.5, 2.325],
        b: [0.2937, 0.0496, -5.6812, 1.8415],
        c: [21.0, -4.7656, -21.5906, 7.2492],
        d: [-3.5, -0.1554, 1.4062, 0.3988],
        e: [0.0032, 0.0766, -0.0656, -0.1294],
    },
    Bin {
        clearness_from: 2.8,
        a: [-1.0156, -0.367, 1.0078, 1.4051],
        b: [0.2875, -0.5328, -3.85, 3.375],
        c: [14.0, -0.9999, -7.1406, 7.5469],
        d: [-3.4, -0.1078, -1.075, 1.5702],
        e: [-0.0672, 0.4016, 0.3017, -0.4844],
    },
    Bin {
        clearness_from: 4.5,
        a: [-1.0, 0.0211, 0.5025, -0.5119],
        b: [-0.3, 0.1922, 0.7023, -1.6317],
        c: [19.0, -5.0, 1.2438, -1.9094],
        d: [-4.0, 0.025, 0.3844, 0.2656],
        e: [1.0468, -0.3788, -2.4517, 1.4656],
    },
    Bin {
        clearness_from: 6.2,
        a: [-1.05, 0.0289, 0.426, 0.359],
        b: [-0.325, 0.1156, 0.7781, 0.0025],
        c: [31.0625, -14.5, -46.1148, 55.375],
        d: [-7.2312, 0.405, 13.35, 0.6234],
        e: [1.5, -0.6426, 1.8564, 0.5636],
    },
];

/// The relative radiance of one sky.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perez {
    /// How the horizon differs from the zenith: below 0 it is darker.
    pub a: f64,
    /// How fast that fades above the horizon.
    pub b: f64,
    /// How bright the region around the sun is.
    pub c: f64,
    /// How wide that region is.
    pub d: f64,
    /// How much light is scattered back, away from the sun.
    pub e: f64,
    /// The sky's clearness, 1 (overcast) to 11.9: the model's epsilon.
    pub clearness: f64,
    /// The sky's brightness, 0.01 to 0.6: the model's Delta, before the rows of half clear skies raise it.
    pub brightness: f64,
}

impl Perez {
    /// The sky with the sun at a zenith angle, under direct normal and diffuse horizontal irradiance; `eccentricity` is
    /// the square of the sun's mean distance over today's.
    ///
    /// All input is safe: a sun below the horizon is taken as on it, negative irradiance as none, and without any diffuse
    /// irradiance the sky is clear where there is sun and overcast where there is none.
    pub fn new(sun_zenith_rad: f64, dni_w_m2: f64, dhi_w_m2: f64, eccentricity: f64) -> Self {
        let zenith = within(sun_zenith_rad, (LEAST_ZENITH_RAD, FRAC_PI_2));
        let (dni, dhi) = (dni_w_m2.max(0.0), dhi_w_m2.max(0.0));

        // How clear and how bright.
        let steep = 1.041 * zenith.powi(3);
        let ratio = if dni > 0.0 { dni / dhi } else { 0.0 };
        let clearness = within((1.0 + ratio + steep) / (1.0 + steep), CLEARNESS);
        let brightness = within(dhi * kasten_air_mass(zenith) / (SOLAR_CONSTANT_W_M2 * eccentricity), BRIGHTNESS);

        // The five parameters.
        let dim = clearness > DIM.0 && clearness < DIM.1;
        let delta = if dim { brightness.max(DIMMEST) } else { brightness };
        let parameter = |[p1, p2, p3, p4]: [f64; 4]| p1 + p2 * zenith + delta * (p3 + p4 * zenith);
        let (number, bin) = bin(clearness);
        let (c, d) = if number == 0 {
            let ([c1, c2, c3, c4], [d1, d2, d3, d4]) = (bin.c, bin.d);
            let c = (delta * (c1 + c2 * zenith)).powf(c3).exp() - c4;
            (c, -(delta * (d1 + d2 * zenith)).exp() + d3 + delta * d4)
        } else {
            (parameter(bin.c), parameter(bin.d))
        };
        // Above 0 the horizon would be e^(b / 0.01) times as bright as the zenith: no measured sky is, and light that no weather
        // has (a strong beam from the horizon) must not end in a line there.
        let b = parameter(bin.b).min(0.0);
        Self { a: parameter(bin.a), b, c, d, e: parameter(bin.e), clearness, brightness }
    }

    /// The row of the table that clearness chooses, 0 (overcast) to 7 (clear).
    pub fn bin(&self) -> usize {
        bin(self.clearness).0
    }

    /// The radiance of a direction by the cosines of its angles to the zenith and to the sun, in a unit of this sky's own.
    /// Never negative, never NaN; below the horizon as on it.
    pub fn relative(&self, cos_zenith: f64, cos_gamma: f64) -> f64 {
        let cos_zenith = within(cos_zenith, (LEAST_COS_ZENITH, 1.0));
        let cos_gamma = within(cos_gamma, (-1.0, 1.0));
        let gradation = 1.0 + self.a * (self.b / cos_zenith).exp();
        let indicatrix = 1.0 + self.c * (self.d * cos_gamma.acos()).exp() + self.e * cos_gamma * cos_gamma;
        // Each by itself: two that are negative must not make light.
        gradation.max(0.0) * indicatrix.max(0.0)
    }
}

/// The number and the row of a clearness.
fn bin(clearness: f64) -> (usize, &'static Bin) {
    let [first, others @ ..] = &BINS;
    let begun = others.iter().enumerate().rfind(|(_, bin)| clearness >= bin.clearness_from);
    begun.map_or((0, first), |(before, bin)| (before + 1, bin))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn clearness_chooses_the_row() {
        let bins = [1.0, 1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2].map(|clearness| bin(clearness).0);
        assert_eq!(bins, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!([1.0649, 1.2299, 6.1999, 11.9].map(|clearness| bin(clearness).0), [0, 1, 6, 7]);
    }

    #[test]
    fn no_diffuse_irradiance_is_a_clear_or_a_dark_sky() {
        assert_eq!(Perez::new(1.0, 800.0, 0.0, 1.0).bin(), 7);
        assert_eq!(Perez::new(1.0, 0.0, 0.0, 1.0).bin(), 0);
        assert_eq!(Perez::new(1.0, -5.0, -5.0, 1.0), Perez::new(1.0, 0.0, 0.0, 1.0));
        assert_eq!(Perez::new(2.5, 0.0, 50.0, 1.0), Perez::new(FRAC_PI_2, 0.0, 50.0, 1.0));
    }

    proptest! {
        #[test]
        fn no_sky_is_negative_or_none(
            zenith in -1.0..4.0_f64, dni in -10.0..1500.0_f64, dhi in prop_oneof![Just(0.0), -1.0..1000.0_f64],
            eccentricity in prop_oneof![Just(0.0), Just(f64::NAN), 0.96..1.04_f64], up in -0.2..1.1_f64, gamma in -1.1..1.1_f64,
        ) {
            let sky = Perez::new(zenith, dni, dhi, eccentricity);
            let radiance = sky.relative(up, gamma);
            prop_assert!(radiance >= 0.0 && radiance.is_finite(), "{sky:?} {radiance}");
        }
    }

    #[test]
    fn anything_at_all_gives_a_number() {
        let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e308, 1e-308, 0.5];
        for (zenith, dni) in odd.into_iter().flat_map(|a| odd.map(|b| (a, b))) {
            for (dhi, cos) in odd.into_iter().flat_map(|a| odd.map(|b| (a, b))) {
                let sky = Perez::new(zenith, dni, dhi, 1.0);
                assert!(
                    sky.relative(cos, cos) >= 0.0 && sky.relative(cos, 0.3).is_finite(),
                    "{zenith} {dni} {dhi} {cos}"
                );
            }
        }
    }
}
