//! How much light for the eye is in a watt of sun or sky?
//!
//! The luminous efficacies of direct and diffuse light of Perez, Ineichen, Seals, Michalsky and Stewart ("Modeling daylight
//! availability and irradiance components from direct and global irradiance", Solar Energy 44(5), 271-289, 1990, table 4,
//! equations 7 and 8): the sky's clearness chooses a row, its brightness, the sun's height and the water in the air do the
//! rest. Clearness and brightness are those of [`Perez`].
//!
//! Limits: the water in the air is taken as 2 cm, which is what a dew point of 11 degrees has; 1 cm more or less is about 3%
//! of the beam and 1 to 5% of the sky. The fit is to measurements at ten places of the northern half of the earth.

use super::perez::Perez;
use super::steps::Step;
use std::f64::consts::FRAC_PI_2;

/// Water in the air above, cm of rain.
const WATER_CM: f64 = 2.0;

/// The sky: `a + b W + c cos Z + d ln(brightness)`.
const DIFFUSE: [[f64; 4]; 8] = [
    [97.24, -0.46, 12.0, -8.91],
    [107.22, 1.15, 0.59, -3.95],
    [104.97, 2.96, -5.53, -8.77],
    [102.39, 5.59, -13.95, -13.9],
    [100.71, 5.94, -22.75, -23.74],
    [106.42, 3.83, -36.15, -28.83],
    [141.88, 1.9, -53.24, -14.03],
    [152.23, 0.35, -45.27, -7.98],
];

/// The beam: `a + b W + c exp(5.73 Z - 5) + d brightness`.
const DIRECT: [[f64; 4]; 8] = [
    [57.2, -4.55, -2.98, 117.12],
    [98.99, -3.46, -1.21, 12.38],
    [109.83, -4.9, -1.71, -8.81],
    [110.34, -5.84, -1.99, -4.56],
    [106.36, -3.97, -1.75, -6.16],
    [107.19, -1.25, -1.51, -26.73],
    [105.75, 0.77, -1.26, -34.44],
    [101.18, 1.58, -1.1, -8.29],
];

/// Luminous efficacies, lm/W.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Efficacies {
    /// Of the beam.
    pub beam_lm_w: f64,
    /// Of the sky.
    pub sky_lm_w: f64,
}

impl Efficacies {
    /// At a step; never below 0.
    pub fn of(step: &Step) -> Self {
        let zenith_rad = FRAC_PI_2 - step.sun.elevation_rad;
        let perez = Perez::new(zenith_rad, step.dni_w_m2, step.dhi_w_m2, step.eccentricity);
        let [a, b, c, d] = DIRECT[perez.bin()];
        let beam = a + b * WATER_CM + c * (5.73 * zenith_rad - 5.0).exp() + d * perez.brightness;
        let [a, b, c, d] = DIFFUSE[perez.bin()];
        let sky = a + b * WATER_CM + c * zenith_rad.cos() + d * perez.brightness.ln();
        Self { beam_lm_w: beam.max(0.0), sky_lm_w: sky.max(0.0) }
    }

    /// The means of steps, each by its energy: what the period's energies are to be multiplied by.
    pub fn mean(steps: &[Step]) -> Self {
        let (mut beam, mut sky) = ([0.0; 2], [0.0; 2]);
        for step in steps {
            let of = Self::of(step);
            let (beam_wh_m2, sky_wh_m2) = (step.dni_w_m2 * step.hours, step.dhi_w_m2 * step.hours);
            beam = [beam[0] + beam_wh_m2 * of.beam_lm_w, beam[1] + beam_wh_m2];
            sky = [sky[0] + sky_wh_m2 * of.sky_lm_w, sky[1] + sky_wh_m2];
        }
        let mean = |[lumens, watts]: [f64; 2]| if watts > 0.0 { lumens / watts } else { 0.0 };
        Self { beam_lm_w: mean(beam), sky_lm_w: mean(sky) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::Sun;

    fn step(elevation_deg: f64, dni_w_m2: f64, dhi_w_m2: f64) -> Step {
        let sun = Sun { azimuth_rad: 3.0, elevation_rad: elevation_deg.to_radians() };
        let time = jiff::civil::date(2024, 3, 21).at(12, 0, 0, 0);
        Step { time, hours: 1.0, sun, dni_w_m2, dhi_w_m2, eccentricity: 1.0 }
    }

    /// By hand from the table: the sun 60 degrees high, 800 and 100 W/m2: row 8, brightness 0.0844.
    #[test]
    fn a_clear_sky_is_bluer_than_its_sun() {
        let found = Efficacies::of(&step(60.0, 800.0, 100.0));
        assert!((found.beam_lm_w - 103.49).abs() < 0.05, "{found:?}");
        assert!((found.sky_lm_w - 133.45).abs() < 0.15, "{found:?}");
    }

    /// Overcast, 30 degrees high, 200 W/m2: row 1, brightness 0.2918: 97.24 - 0.92 + 6 + 10.97.
    #[test]
    fn an_overcast_sky_has_some_113_lumens_a_watt() {
        let found = Efficacies::of(&step(30.0, 0.0, 200.0));
        assert!((found.sky_lm_w - 113.3).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn a_mean_is_by_energy_and_of_nothing_is_nothing() {
        let steps = [step(60.0, 800.0, 100.0), step(30.0, 0.0, 200.0)];
        let mean = Efficacies::mean(&steps);
        assert_eq!(mean.beam_lm_w, Efficacies::of(&steps[0]).beam_lm_w);
        let [one, other] = [0, 1].map(|step| Efficacies::of(&steps[step]).sky_lm_w);
        assert!((mean.sky_lm_w - (one + 2.0 * other) / 3.0).abs() < 1e-9);
        assert_eq!(Efficacies::mean(&[]), Efficacies { beam_lm_w: 0.0, sky_lm_w: 0.0 });
    }
}
