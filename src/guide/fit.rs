//! Which few lobes describe light from many directions?
//!
//! A mixture of von Mises-Fisher distributions by expectation and maximisation (Banerjee et al. 2005), its concentrations held
//! back where few samples speak (a prior, as in Vorba et al. 2014). A lobe's distance is the harmonic mean of its samples', for
//! near things turn more when a place moves.
//!
//! Limits: a local optimum from a start that is always the same, the samples farthest from those before.

use crate::light::{Incident, Lobe, MOST_LOBES};
use glam::{DVec3, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Light that comes from a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Where it comes from, unit length.
    pub direction: Vec3,
    /// How much it is: what it adds to the irradiance.
    pub weight: f32,
    /// How much comes per steradian (radiance, times the cosine on a surface), in any unit: what its density should follow.
    pub density: f32,
    /// How far away what shines stands, metres.
    pub distance_m: f32,
}

/// Samples that are enough for a place: more would sharpen what four round lobes blur.
const ENOUGH_SAMPLES: usize = 128;

/// Steps of expectation and maximisation; later ones move lobes by less than their width.
const STEPS: usize = 6;

/// Concentration that the lobes start with: half of the light within 35 degrees.
const FIRST_CONCENTRATION: f64 = 8.0;

/// Samples that the prior is worth, and the mean cosine that it speaks for.
const PRIOR_SAMPLES: f64 = 0.5;
const PRIOR_COSINE: f64 = 0.5;

/// No lobe is narrower: half of the light within 2 degrees.
const MOST_CONCENTRATION: f64 = 1000.0;

/// Shares that are tried: never all, for lobes leave out what they do not know.
const TRUSTS: [f64; 8] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8];

/// Densities below the exponential of this, per steradian, are taken for nothing.
const LEAST_LOGARITHM: f32 = -14.0;

/// A lobe with less than this share is given up.
const LEAST_SHARE: f64 = 0.01;

/// At most so many samples as are enough for a few lobes, all of the same weight and in the same sum, drawn evenly along the sum
/// of weights; as they are where they are few.
pub fn thinned(samples: Vec<Sample>) -> Vec<Sample> {
    if samples.len() <= ENOUGH_SAMPLES {
        return samples;
    }
    let sum: f64 = samples.iter().map(|sample| f64::from(sample.weight)).sum();
    let share = sum / ENOUGH_SAMPLES as f64;
    let (mut up_to, mut next) = (0.0, 0.5 * share);
    let mut kept = Vec::with_capacity(ENOUGH_SAMPLES);
    for sample in &samples {
        up_to += f64::from(sample.weight);
        while next < up_to && kept.len() < ENOUGH_SAMPLES {
            kept.push(Sample { weight: share as f32, ..*sample });
            next += share;
        }
    }
    kept
}

/// At most [`MOST_LOBES`] lobes for some samples, the heaviest first; none where no sample has weight. Linear in the samples.
pub fn lobes(samples: &[Sample]) -> Vec<Lobe> {
    let sum: f64 = samples.iter().map(|sample| f64::from(sample.weight)).sum();
    if !(sum > 0.0 && sum.is_finite()) {
        return Vec::new();
    }
    let mut mixture = first(samples, sum);
    let mut shares = vec![[0.0; MOST_LOBES]; samples.len()];
    for _ in 0..STEPS {
        expect(samples, &mixture, &mut shares);
        maximise(samples, sum, &shares, &mut mixture);
    }
    mixture.retain(|lobe| f64::from(lobe.weight) >= LEAST_SHARE);
    let kept: f32 = mixture.iter().map(|lobe| lobe.weight).sum();
    mixture.iter_mut().for_each(|lobe| lobe.weight /= kept);
    mixture.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    mixture
}

/// The share of directions that is best drawn from the lobes and not from the cosine about the normal (or evenly): that with the
/// least second moment of `density / drawn density`, by the samples that the lobes were fitted to.
pub fn trust(samples: &[Sample], incident: &Incident) -> f32 {
    if incident.lobes.is_empty() {
        return 0.0;
    }
    let heights = heights(&incident.lobes);
    let mut moments = [0.0_f64; TRUSTS.len()];
    for sample in samples {
        let towards = sample.direction;
        // On a surface, what is drawn below it is mirrored up.
        let by_lobes = match incident.normal {
            Some(normal) => {
                density(&incident.lobes, &heights, towards)
                    + density(&incident.lobes, &heights, towards - 2.0 * normal.dot(towards) * normal)
            }
            None => density(&incident.lobes, &heights, towards),
        };
        let plainly = incident.normal.map_or(0.25, |normal| normal.dot(towards).max(0.0)) * FRAC_1_PI;
        let amount = f64::from(sample.weight) * f64::from(sample.density);
        for (moment, trust) in moments.iter_mut().zip(TRUSTS) {
            let trust = trust as f32;
            *moment += amount / f64::from((trust * by_lobes + (1.0 - trust) * plainly).max(f32::MIN_POSITIVE));
        }
    }
    let best = (0..TRUSTS.len()).min_by(|&a, &b| moments[a].total_cmp(&moments[b]));
    best.map_or(0.0, |best| TRUSTS[best] as f32)
}

/// Lobes about the sample with most weight and those that are heaviest away from the ones before.
fn first(samples: &[Sample], sum: f64) -> Vec<Lobe> {
    let mut lobes: Vec<Lobe> = Vec::with_capacity(MOST_LOBES);
    let mut away = vec![1.0_f32; samples.len()];
    while lobes.len() < MOST_LOBES {
        let promise = |(sample, away): (&Sample, &f32)| sample.weight * away;
        let best = samples.iter().zip(&away).enumerate().max_by(|a, b| promise(a.1).total_cmp(&promise(b.1)));
        let Some((_, (sample, away_now))) = best else { break };
        if f64::from(sample.weight * away_now) < 1e-6 * sum {
            break;
        }
        let direction = sample.direction;
        lobes.push(Lobe { direction, concentration: FIRST_CONCENTRATION as f32, weight: 1.0, distance_m: 1.0 });
        for (sample, away) in samples.iter().zip(&mut away) {
            *away = away.min(1.0 - sample.direction.dot(direction));
        }
    }
    let share = 1.0 / lobes.len() as f32;
    lobes.iter_mut().for_each(|lobe| lobe.weight = share);
    lobes
}

/// The logarithm of each lobe's share times its density where that is greatest.
fn heights(lobes: &[Lobe]) -> [f32; MOST_LOBES] {
    let mut heights = [f32::NEG_INFINITY; MOST_LOBES];
    for (height, lobe) in heights.iter_mut().zip(lobes) {
        *height = (f64::from(lobe.weight) * lobe.density_per_sr(lobe.direction)).ln() as f32;
    }
    heights
}

/// The density of some lobes together, per steradian; what is below a millionth per steradian is not counted.
fn density(lobes: &[Lobe], heights: &[f32; MOST_LOBES], towards: Vec3) -> f32 {
    let of = |(lobe, height): (&Lobe, &f32)| {
        let logarithm = height + lobe.concentration * (lobe.direction.dot(towards) - 1.0);
        if logarithm > LEAST_LOGARITHM { logarithm.exp() } else { 0.0 }
    };
    lobes.iter().zip(heights).map(of).sum()
}

/// The share of each lobe in each sample. In logarithms less the greatest, for narrow lobes underflow far from their middle; in
/// single precision, for this is most of what a guide costs.
fn expect(samples: &[Sample], lobes: &[Lobe], shares: &mut [[f64; MOST_LOBES]]) {
    let heights = heights(lobes);
    for (sample, shares) in samples.iter().zip(shares) {
        let mut parts = heights;
        for (part, lobe) in parts.iter_mut().zip(lobes) {
            *part += lobe.concentration * (lobe.direction.dot(sample.direction) - 1.0);
        }
        let highest = parts.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let parts = parts.map(|part| if part > f32::NEG_INFINITY { (part - highest).exp() } else { 0.0 });
        let sum: f32 = parts.iter().sum();
        *shares = parts.map(|part| if sum > 0.0 { f64::from(part / sum) } else { 0.0 });
    }
}

/// The lobes that suit those shares best.
fn maximise(samples: &[Sample], sum: f64, shares: &[[f64; MOST_LOBES]], lobes: &mut [Lobe]) {
    for (number, lobe) in lobes.iter_mut().enumerate() {
        let (mut weight, mut squares, mut mean, mut nearness) = (0.0, 0.0, DVec3::ZERO, 0.0);
        for (sample, shares) in samples.iter().zip(shares) {
            let part = f64::from(sample.weight) * shares[number];
            weight += part;
            squares += part * part;
            mean += part * sample.direction.as_dvec3();
            nearness += part / f64::from(sample.distance_m.max(f32::MIN_POSITIVE));
        }
        if weight <= 0.0 {
            lobe.weight = 0.0;
            continue;
        }
        // As many samples of equal weight would say as much.
        let count = weight * weight / squares;
        let cosine = (mean.length() / weight * count + PRIOR_COSINE * PRIOR_SAMPLES) / (count + PRIOR_SAMPLES);
        let concentration = cosine * (3.0 - cosine * cosine) / (1.0 - cosine * cosine).max(1e-9);
        *lobe = Lobe {
            direction: mean.normalize_or(lobe.direction.as_dvec3()).as_vec3(),
            concentration: concentration.min(MOST_CONCENTRATION) as f32,
            weight: (weight / sum) as f32,
            distance_m: (weight / nearness) as f32,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_drawn_from_lobes_gives_them_back() {
        let lobe = |direction: Vec3, concentration, weight, distance_m| Lobe {
            direction: direction.normalize(),
            concentration,
            weight,
            distance_m,
        };
        let known = [lobe(Vec3::new(1.0, 0.2, 0.0), 200.0, 0.6, 3.0), lobe(Vec3::new(-0.3, 0.1, 1.0), 20.0, 0.4, 7.0)];
        let samples: Vec<Sample> = (0..2000)
            .map(|index| {
                let lobe = known[usize::from(index % 10 >= 6)];
                let square = [(f64::from(index) * 0.754_878).fract(), (f64::from(index) * 0.569_840).fract()];
                Sample { direction: lobe.drawn(square), weight: 2.0, density: 1.0, distance_m: lobe.distance_m }
            })
            .collect();
        let found = lobes(&samples);
        assert!((found.iter().map(|lobe| lobe.weight).sum::<f32>() - 1.0).abs() < 1e-5);
        assert!(found.windows(2).all(|pair| pair[0].weight >= pair[1].weight));
        // Two lobes may share one of the known ones: together they have its weight, direction and distance.
        for known in known {
            let near = || found.iter().filter(|lobe| lobe.direction.dot(known.direction) > 0.8);
            let weight: f32 = near().map(|lobe| lobe.weight).sum();
            let mean: Vec3 = near().map(|lobe| lobe.direction * lobe.weight).sum();
            assert!((weight - known.weight).abs() < 0.03, "{found:?}");
            assert!(mean.normalize().dot(known.direction) > 0.999, "{found:?}");
            assert!(near().all(|lobe| (lobe.distance_m / known.distance_m - 1.0).abs() < 0.02), "{found:?}");
        }
    }

    #[test]
    fn without_light_there_is_no_lobe_and_one_sample_is_one() {
        assert_eq!(lobes(&[]), []);
        let sample = Sample { direction: Vec3::X, weight: 0.0, density: 1.0, distance_m: 1.0 };
        assert_eq!(lobes(&[sample]), []);
        let found = lobes(&[Sample { weight: 3.0, ..sample }]);
        assert_eq!(found.len(), 1);
        assert!(found[0].direction.distance(Vec3::X) < 1e-6 && (found[0].weight - 1.0).abs() < 1e-6);
    }
}
