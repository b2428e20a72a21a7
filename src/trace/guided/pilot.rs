//! Does the guide help?
//!
//! A few paths of either kind say which has the smaller variance for a ray, sensor by sensor; they are then thrown away, so that
//! what was chosen by them has no bias. A sensor's own few samples say little, least where rare paths carry the light: the fewer
//! they are, the more it follows the median of all sensors.

use crate::light::Settings;
use crate::trace::Sums;

/// Paths of either kind for each that counts.
const SHARE: u32 = 32;

/// Fewer samples than this say nothing.
const LEAST_SAMPLES: u32 = 16;

/// So many samples of a sensor weigh as much as what the other sensors say.
const WORTH_THE_OTHERS: f64 = 1000.0;

/// No sensor gains or loses by more than this, as a logarithm: a factor of ten.
const MOST_GAIN: f64 = std::f64::consts::LN_10;

/// A guided ray costs this many times a plain one: its place is looked up and its lobes are weighed. Measured 1.2 (`quake_dm4`)
/// to 2.0 (`corridor`, whose few triangles make rays cheap).
const GUIDED_RAY_COST: f64 = 1.5;

/// Another stream of random numbers than that of the paths that count.
const OTHER_SEED: u64 = 0x05ee_d0fa_9110;

/// How the pilot is traced; `None` where it would be too few samples.
pub(super) fn settings(settings: &Settings) -> Option<Settings> {
    let samples = settings.samples / SHARE;
    (samples >= LEAST_SAMPLES).then_some(Settings { samples, seed: settings.seed ^ OTHER_SEED, ..*settings })
}

/// For each sensor whether guided paths are worth more than plain ones.
pub(super) fn helps(plain: &[Sums], guided: &[Sums]) -> Vec<bool> {
    let gains: Vec<f64> = plain.iter().zip(guided).map(|(plain, guided)| gain(plain, guided)).collect();
    let mut known: Vec<f64> = gains.iter().copied().filter(|gain| gain.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    let of_all = known.get(known.len() / 2).copied().unwrap_or(0.0);
    let alone = |(gain, sums): (&f64, &Sums)| {
        let weight = if gain.is_finite() { sums.samples / (sums.samples + WORTH_THE_OTHERS) } else { 0.0 };
        let own = if gain.is_finite() { gain.clamp(-MOST_GAIN, MOST_GAIN) } else { 0.0 };
        weight * own + (1.0 - weight) * of_all >= 0.0
    };
    gains.iter().zip(guided).map(alone).collect()
}

/// The logarithm of how many times as long plain paths take for the same error; not finite where either found no light.
fn gain(plain: &Sums, guided: &Sums) -> f64 {
    let noise = |sums: &Sums| {
        let mean = sums.value / sums.samples;
        (sums.squares / sums.samples - mean * mean).max(0.0) * sums.rays
    };
    if plain.value > 0.0 && guided.value > 0.0 {
        (noise(plain) / noise(guided) / GUIDED_RAY_COST).ln()
    } else {
        f64::NAN
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sums(samples: f64, mean: f64, variance: f64) -> Sums {
        let squares = samples * (variance + mean * mean);
        Sums { samples, value: samples * mean, squares, rays: 10.0 * samples, ..Sums::default() }
    }

    #[test]
    fn few_samples_follow_the_others_and_many_speak_for_themselves() {
        let all = |samples: f64, variances: [f64; 5]| -> Vec<Sums> {
            variances.iter().map(|&variance| sums(samples, 1.0, variance)).collect()
        };
        let plain = [1.0; 5];
        let mostly_good = [0.2, 0.2, 0.2, 0.2, 2.0];
        assert_eq!(helps(&all(30.0, plain), &all(30.0, mostly_good)), [true; 5]);
        assert_eq!(helps(&all(9000.0, plain), &all(9000.0, mostly_good)), [true, true, true, true, false]);
        assert_eq!(helps(&all(30.0, plain), &all(30.0, [3.0; 5])), [false; 5]);
        // Dark sensors follow the others; where all are dark nothing speaks against the guide.
        let dark = [Sums::default(), sums(30.0, 1.0, 4.0)];
        assert_eq!(helps(&dark, &[Sums::default(), sums(30.0, 1.0, 9.0)]), [false; 2]);
        assert_eq!(helps(&dark[..1], &dark[..1]), [true]);
    }
}
