//! Does the guide help?
//!
//! A few paths of either kind say which has the smaller variance for a ray, sensor by sensor; they are then thrown away, so that
//! what was chosen by them has no bias. A sensor's own few samples say little, least where rare paths carry the light: the fewer
//! they are, the more it follows all sensors together.

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

/// Standard errors that two means differ by chance.
const CHANCE: f64 = 2.0;

/// Another stream of random numbers than that of the paths that count.
const OTHER_SEED: u64 = 0x05ee_d0fa_9110;

/// How the pilot is traced; `None` where it would be too few samples.
pub(super) fn settings(settings: &Settings) -> Option<Settings> {
    let samples = settings.samples / SHARE;
    (samples >= LEAST_SAMPLES).then_some(Settings { samples, seed: settings.seed ^ OTHER_SEED, ..*settings })
}

/// For each sensor whether guided paths are worth more than plain ones.
pub(super) fn helps(plain: &[Sums], guided: &[Sums]) -> Vec<bool> {
    let efforts: Vec<Option<[f64; 2]>> =
        plain.iter().zip(guided).map(|(plain, guided)| efforts(plain, guided)).collect();
    // The mean and not the median: the rare bright paths of a poor way show at few sensors only.
    let lit = || efforts.iter().flatten();
    let of_all = gain(&[0, 1].map(|way| lit().map(|efforts| efforts[way]).sum::<f64>()));
    let alone = |(efforts, sums): (&Option<[f64; 2]>, &Sums)| {
        let own = efforts.as_ref().map_or(0.0, gain).clamp(-MOST_GAIN, MOST_GAIN);
        let weight = if efforts.is_some() { sums.samples / (sums.samples + WORTH_THE_OTHERS) } else { 0.0 };
        weight * own + (1.0 - weight) * of_all >= 0.0
    };
    efforts.iter().zip(guided).map(alone).collect()
}

/// What a given relative error costs by plain and by guided paths, in any unit; `None` where neither found light. A way whose mean
/// is below the other's by more than chance has missed light that comes by paths rarer than one in its samples: it looks quiet,
/// and is as noisy as if it had met one.
fn efforts(plain: &Sums, guided: &Sums) -> Option<[f64; 2]> {
    let mean = (plain.value + guided.value) / (plain.samples + guided.samples);
    let moments = |sums: &Sums| {
        let own = sums.value / sums.samples;
        (own, (sums.squares / sums.samples - own * own).max(0.0))
    };
    let [(plain_mean, plain_variance), (guided_mean, guided_variance)] = [plain, guided].map(moments);
    let by_chance = CHANCE * CHANCE * (plain_variance + guided_variance) / guided.samples;
    let missed = |lacks: f64| (lacks.max(0.0).powi(2) - by_chance).max(0.0) * guided.samples;
    let effort = |sums: &Sums, variance: f64, lacks: f64, cost: f64| {
        (variance + missed(lacks)) / (mean * mean) * sums.rays / sums.samples * cost
    };
    let lacks = guided_mean - plain_mean;
    let efforts =
        || [effort(plain, plain_variance, lacks, 1.0), effort(guided, guided_variance, -lacks, GUIDED_RAY_COST)];
    (mean > 0.0).then(efforts)
}

/// The logarithm of how many times as long plain paths take; 0 where neither costs anything.
fn gain(&[plain, guided]: &[f64; 2]) -> f64 {
    let gain = (plain / guided).ln();
    if gain.is_nan() { 0.0 } else { gain.clamp(-1e3, 1e3) }
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
