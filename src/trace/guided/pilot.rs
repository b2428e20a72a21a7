//! Does the guide help?
//!
//! A few paths of either kind say which has the smaller variance for a ray, sensor by sensor; they are then thrown away, so that
//! what was chosen by them has no bias. Few samples say little where rare paths carry the light: there a sensor follows the
//! others.

use crate::light::Settings;
use crate::trace::Sums;

/// Paths of either kind for each that counts.
const SHARE: u32 = 32;

/// Fewer samples than this say nothing.
const LEAST_SAMPLES: u32 = 16;

/// So many samples, none of which is more than this share of the sum, speak for their sensor alone.
const SOUND_SAMPLES: f64 = 128.0;
const SOUND_SHARE: f64 = 0.1;

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
    let mostly = known.get(known.len() / 2).is_none_or(|&gain| gain >= 1.0);
    let alone = |(gain, (plain, guided)): (&f64, (&Sums, &Sums))| match (is_sound(plain), is_sound(guided)) {
        (true, true) => *gain >= 1.0,
        // Light that only guided paths find is rare among plain ones.
        (false, true) => true,
        (true, false) => false,
        (false, false) => mostly,
    };
    gains.iter().zip(plain.iter().zip(guided)).map(alone).collect()
}

/// How many times as many plain rays give the same error; not finite where either found no light.
fn gain(plain: &Sums, guided: &Sums) -> f64 {
    let noise = |sums: &Sums| {
        let mean = sums.value / sums.samples;
        (sums.squares / sums.samples - mean * mean).max(0.0) * sums.rays
    };
    if plain.value > 0.0 && guided.value > 0.0 { noise(plain) / noise(guided) } else { f64::NAN }
}

fn is_sound(sums: &Sums) -> bool {
    sums.samples >= SOUND_SAMPLES && sums.value > 0.0 && sums.top_share() <= SOUND_SHARE
}
