//! How is the diffuse light of a moment spread over the sky, in watts?
//!
//! A [`SkyModel`] gives the shape; the diffuse horizontal irradiance its size: every sky here integrates to it,
//! `int L cos z dw = DHI`, whatever the model. The sun's disc is not in it; its light is the beam's.
//!
//! Limits: Hosek's and Wilkie's sky is a clear one, whatever the weather; Perez's follows the weather's two figures and
//! knows no single clouds. Light of the twilight, with the sun below the horizon, is spread as with the sun on it.

use super::hosek::Channel;
use super::hosek::HosekBand;
use super::perez::Perez;
use super::spectrum::Band;
use super::steps::Step;
use super::term::{Skies, Term};
use crate::job::{Cancel, Cancelled};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// How a sky's light is spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SkyModel {
    /// By direct and diffuse irradiance, any weather (Perez, Seals, Michalsky 1993).
    Perez,
    /// A clear sky by turbidity and ground (Hosek, Wilkie 2012).
    Hosek,
    /// Alike in all directions.
    Isotropic,
}

impl SkyModel {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Perez, Self::Hosek, Self::Isotropic];

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Perez => "perez",
            Self::Hosek => "hosek",
            Self::Isotropic => "isotropic",
        }
    }

    /// The model of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.name() == name)
    }
}

/// What a clear sky depends on besides the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Haze {
    /// Turbidity of the air, 1 (clean) to 10 (thick haze).
    pub turbidity: f64,
    /// Reflectance of the ground round about, 0 to 1.
    pub ground_albedo: f64,
    /// Which light: Hosek's and Wilkie's sky has its own shape in each band, and none in infrared.
    pub band: Band,
}

/// Steps whose skies are scaled at once: some milliseconds.
const CHUNK: usize = 512;

/// The skies of many steps, each scaled to its diffuse irradiance: the sum of a step's terms is its sky, W/m2/sr. Each term
/// comes with the number of its step; a step without diffuse light has none.
///
/// About 7 us a step for Perez, three times that for Hosek, most of it the integral; on all threads.
///
/// # Errors
/// [`Cancelled`].
pub fn skies(model: SkyModel, haze: Haze, steps: &[Step], cancel: &Cancel) -> Result<Vec<(usize, Term)>, Cancelled> {
    let chunks = steps.par_chunks(CHUNK).enumerate().map(|(chunk, steps)| {
        cancel.check()?;
        let terms = scaled(model, haze, steps);
        Ok(terms.into_iter().map(|(number, term)| (chunk * CHUNK + number, term)).collect())
    });
    let chunks: Result<Vec<Vec<_>>, Cancelled> = chunks.collect();
    Ok(chunks?.concat())
}

/// The skies of some steps, by their numbers among these.
fn scaled(model: SkyModel, haze: Haze, steps: &[Step]) -> Vec<(usize, Term)> {
    let lit = steps.iter().enumerate().filter(|(_, step)| step.dhi_w_m2 > 0.0);
    let mut terms: Vec<(usize, Term)> =
        lit.flat_map(|(number, step)| shape(model, haze, step).into_iter().map(move |term| (number, term))).collect();

    // Each step's terms are scaled together. A sky that is black all over, as fits may be at their ends, gives its light
    // evenly.
    let irradiances = horizontal(&terms.iter().map(|(_, term)| *term).collect::<Vec<_>>());
    let mut first = 0;
    for group in terms.chunk_by_mut(|(a, _), (b, _)| a == b) {
        let Some(step) = group.first().and_then(|(number, _)| steps.get(*number)) else { continue };
        let irradiance: f64 = irradiances[first..first + group.len()].iter().sum();
        first += group.len();
        for (_, term) in group.iter_mut() {
            term.weight *= step.dhi_w_m2 / irradiance;
        }
        if irradiance <= 0.0 {
            group.iter_mut().for_each(|(_, term)| *term = Term::BLACK);
            group[0].1 = Term::uniform(step.dhi_w_m2 / PI);
        }
    }
    terms
}

/// The shape of one sky.
fn shape(model: SkyModel, haze: Haze, step: &Step) -> Vec<Term> {
    let towards_sun = step.sun.towards();
    match model {
        SkyModel::Isotropic => vec![Term::uniform(1.0)],
        SkyModel::Perez => {
            let zenith_rad = FRAC_PI_2 - step.sun.elevation_rad;
            let Perez { a, b, c, d, e, .. } = Perez::new(zenith_rad, step.dni_w_m2, step.dhi_w_m2, step.eccentricity);
            let floor = super::perez::LEAST_COS_ZENITH;
            vec![Term { towards_sun, weight: 1.0, a, b, c, d, e, k: 1.0, floor, ..Term::BLACK }]
        }
        SkyModel::Hosek => {
            let Haze { turbidity, ground_albedo, band } = haze;
            // In a band that it does not reach the sky is black, and `skies` gives its light evenly.
            let sky = HosekBand::new(step.sun.elevation_rad, turbidity, ground_albedo, band);
            let channels = sky.map(|sky| sky.channels).unwrap_or_else(|_| vec![Channel::default()]);
            channels.into_iter().map(|channel| of_channel(towards_sun, channel)).collect()
        }
    }
}

fn of_channel(towards_sun: DVec3, channel: Channel) -> Term {
    let [a, b, k, c, d, e, f, i, h] = channel.params;
    let weight = channel.radiance;
    Term { towards_sun, weight, a, b, least: f64::NEG_INFINITY, floor: 0.0, lift: 0.01, k, c, d, e, f, h, i }
}

/// The horizontal irradiance of each term, `int L cos z dw`, within 0.1% of itself, 0.02% rms
/// over suns and irradiances at random; the worst are the sharp aureoles of very clear skies.
///
/// Gauss's rule in elevation, the trapezoid one in azimuth about the sun's, on the half of the sky that the other mirrors.
fn horizontal(terms: &[Term]) -> Vec<f64> {
    const RINGS: usize = 24;
    const SECTORS: usize = 40;
    let facing_north: Vec<Term> = terms
        .iter()
        .map(|term| {
            let towards_sun = DVec3::new(0.0, term.towards_sun.x.hypot(term.towards_sun.y), term.towards_sun.z);
            Term { towards_sun, ..*term }
        })
        .collect();
    let skies = Skies::new(&facing_north);
    let mut sums = skies.no_sums();
    for (place, share) in gauss_legendre(RINGS) {
        let elevation_rad = FRAC_PI_2 * (place + 1.0) / 2.0;
        let (sin, cos) = elevation_rad.sin_cos();
        let ring = share * FRAC_PI_2 / 2.0 * sin * cos;
        let row = skies.row(elevation_rad);
        for sector in 0..=SECTORS {
            let at_end = sector == 0 || sector == SECTORS;
            let sector_rad = TAU / SECTORS as f64 * if at_end { 0.5 } else { 1.0 };
            row.add_each(PI * sector as f64 / SECTORS as f64, ring * sector_rad, &mut sums);
        }
    }
    let mut sums = sums.concat();
    sums.truncate(terms.len());
    sums
}

/// Places in -1 to 1 and weights of Gauss's rule: the zeros of the Legendre polynomial, by Newton from Tricomi's guess.
fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    /// Newton doubles the figures; from the guess, four steps reach the last.
    const STEPS: usize = 6;
    let zero = |number: usize| {
        let mut x = (PI * (number as f64 + 0.75) / (count as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..STEPS {
            let (mut before, mut now) = (1.0, x);
            for degree in 2..=count {
                let degree = degree as f64;
                (before, now) = (now, ((2.0 * degree - 1.0) * x * now - (degree - 1.0) * before) / degree);
            }
            slope = count as f64 * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(zero).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::Sun;
    use crate::sky::towards;

    fn step(elevation_deg: f64, dni_w_m2: f64, dhi_w_m2: f64) -> Step {
        let sun = Sun { azimuth_rad: 2.0, elevation_rad: elevation_deg.to_radians() };
        let time = jiff::civil::date(2024, 6, 21).at(9, 0, 0, 0);
        Step { time, hours: 1.0, sun, dni_w_m2, dhi_w_m2, eccentricity: 1.0 }
    }

    /// The horizontal irradiance of terms by midpoints of many cells of equal cosine-weighted solid angle.
    fn integral(terms: &[Term]) -> f64 {
        const RINGS: usize = 300;
        const SECTORS: usize = 600;
        let rings = (0..RINGS).map(|ring| ((ring as f64 + 0.5) / RINGS as f64).sqrt().acos());
        let cells = rings.flat_map(|elevation| {
            (0..SECTORS).map(move |sector| towards(TAU * (sector as f64 + 0.5) / SECTORS as f64, elevation))
        });
        let sum: f64 = cells.map(|towards| terms.iter().map(|term| term.radiance(towards)).sum::<f64>()).sum();
        PI * sum / (RINGS * SECTORS) as f64
    }

    #[test]
    fn every_sky_integrates_to_its_diffuse_irradiance() {
        let mut worst: f64 = 0.0;
        for elevation_deg in [0.0, 1.0, 10.0, 35.0, 45.0, 80.0, 90.0] {
            for (dni, dhi) in [(0.0, 3.0), (30.0, 120.0), (400.0, 200.0), (900.0, 90.0), (480.0, 25.0)] {
                let step = [step(elevation_deg, dni, dhi)];
                for (model, band) in SkyModel::ALL.into_iter().flat_map(|model| Band::ALL.map(|band| (model, band))) {
                    let haze = Haze { turbidity: 2.0 + dhi / 30.0, ground_albedo: 0.2, band };
                    let terms: Vec<Term> =
                        skies(model, haze, &step, &Cancel::new()).unwrap().into_iter().map(|(_, term)| term).collect();
                    let off = integral(&terms) / dhi - 1.0;
                    worst = worst.max(off.abs());
                    assert!(off.abs() < 1e-3, "{model:?} {band} {elevation_deg} {dni} {dhi}: {off}");
                }
            }
        }
        println!("worst {worst:.2e}");
    }

    #[test]
    fn a_step_without_diffuse_light_has_no_sky() {
        let haze = Haze { turbidity: 3.0, ground_albedo: 0.2, band: Band::Broadband };
        let steps = [step(30.0, 500.0, 0.0), step(30.0, 0.0, 10.0), step(0.0, 0.0, f64::MIN_POSITIVE)];
        for model in SkyModel::ALL {
            let found = skies(model, haze, &steps, &Cancel::new()).unwrap();
            assert!(found.iter().all(|(number, _)| *number > 0), "{model:?}");
            assert!(found.iter().all(|(_, term)| term.weight.is_finite()), "{model:?}");
        }
    }

    #[test]
    fn chunks_number_their_steps_on() {
        let steps: Vec<Step> = (0..2 * CHUNK + 7).map(|number| step(30.0, 0.0, (number % 3) as f64)).collect();
        let haze = Haze { turbidity: 3.0, ground_albedo: 0.2, band: Band::Broadband };
        let terms = skies(SkyModel::Isotropic, haze, &steps, &Cancel::new()).unwrap();
        let lit: Vec<usize> = (0..steps.len()).filter(|number| number % 3 > 0).collect();
        assert_eq!(terms.iter().map(|(number, _)| *number).collect::<Vec<_>>(), lit);
        for (number, term) in terms {
            let level = term.radiance(DVec3::Z) * PI / steps[number].dhi_w_m2;
            assert!((level - 1.0).abs() < 1e-5, "{number}: {level}");
        }
    }

    #[test]
    fn gauss_is_right_for_high_powers() {
        for power in [0, 2, 10, 39] {
            let sum: f64 = gauss_legendre(20).iter().map(|(place, weight)| weight * place.powi(power)).sum();
            let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
            assert!((sum - exact).abs() < 1e-12, "{power}: {sum}");
        }
    }
}
