//! How bright is a sky in one direction, and how bright are thousands of skies together?
//!
//! Perez's and Hosek's skies are sums of terms of one form, a factor of the height above the horizon times one of the angle
//! to the sun. A [`Term`] is that form as plain data; [`Term::radiance`] is the formula, [`Skies`] the same for many terms at
//! once: laid out by parameter, eight at a time, in single precision with polynomials in place of `exp` and `acos`, which the
//! compiler turns into vector code on any target. The test below holds the sum to the formula within 1e-5 of a sky's
//! brightness half-way up.
//!
//! Papers: Perez, Seals, Michalsky 1993; Hosek, Wilkie 2012; polynomial of the arc cosine: Abramowitz & Stegun 4.4.46.

use glam::DVec3;
use std::f32::consts::{FRAC_PI_2, LN_2, LOG2_E, PI};

/// Least denominator of the glow: a published `h` of 1 would make it infinite in the sun's very middle.
const LEAST_SPREAD: f64 = 1e-4;

/// One sky, or one colour channel of it, as the product that Perez and Hosek write:
///
/// `weight max(least, 1 + a exp(b / (max(cos z, floor) + lift))) (k + c exp(d g) + e cos^2 g + f chi(h, g) + i sqrt(cos z))`
///
/// with `z` the angle from the zenith, `g` the angle from the sun, and
/// `chi(h, g) = (1 + cos^2 g) / (1 + h^2 - 2 h cos g)^(3/2)`; below 0 it is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// The direction to the sun, unit length.
    pub towards_sun: DVec3,
    /// Brightness of the whole.
    pub weight: f64,
    /// Brightening towards the horizon, and its gradient there.
    pub a: f64,
    /// See `a`.
    pub b: f64,
    /// What that factor is kept above, so that it and the next, both negative, make no light: 0, or `-inf` where the model
    /// means them to.
    pub least: f64,
    /// Least cosine of the angle from the zenith that is told apart.
    pub floor: f64,
    /// What is added to that cosine.
    pub lift: f64,
    /// What is there without the sun.
    pub k: f64,
    /// Strength of the ring around the sun, and how fast it falls.
    pub c: f64,
    /// See `c`.
    pub d: f64,
    /// Backscattering.
    pub e: f64,
    /// Strength and narrowness (0 to 1) of the glow close to the sun.
    pub f: f64,
    /// See `f`.
    pub h: f64,
    /// Brightening of the zenith.
    pub i: f64,
}

impl Term {
    /// The same brightness in every direction.
    pub fn uniform(weight: f64) -> Self {
        Self { weight, k: 1.0, ..Self::BLACK }
    }

    /// A sky without light.
    pub const BLACK: Self = Self {
        towards_sun: DVec3::Z,
        weight: 0.0,
        a: 0.0,
        b: 0.0,
        least: 0.0,
        floor: 0.01,
        lift: 0.0,
        k: 0.0,
        c: 0.0,
        d: 0.0,
        e: 0.0,
        f: 0.0,
        h: 0.0,
        i: 0.0,
    };

    /// The brightness in a direction (unit length, z up), in units of the weight.
    pub fn radiance(&self, direction: DVec3) -> f64 {
        let cos_zenith = direction.z.max(0.0);
        let cos_sun = direction.dot(self.towards_sun).clamp(-1.0, 1.0);
        let horizon = (1.0 + self.a * (self.b / (cos_zenith.max(self.floor) + self.lift)).exp()).max(self.least);
        let spread = (1.0 + self.h * self.h - 2.0 * self.h * cos_sun).max(LEAST_SPREAD);
        let glow = (1.0 + cos_sun * cos_sun) / (spread * spread.sqrt());
        let around_sun = self.k
            + self.c * (self.d * cos_sun.acos()).exp()
            + self.e * cos_sun * cos_sun
            + self.f * glow
            + self.i * cos_zenith.sqrt();
        (self.weight * horizon * around_sun).max(0.0)
    }
}

/// Terms worked on at once: two vectors of the baseline target, one of wider ones.
pub const LANES: usize = 8;
type Lanes = [f32; LANES];

/// Many terms, for their sum in many directions.
///
/// Its rows are for one height above the horizon each: [`Skies::row`] works out all that does not depend on the azimuth, and
/// [`Row::radiance`] is then a pass over the terms, 2 to 4 ns each.
#[derive(Debug, Clone)]
pub struct Skies {
    /// The terms' parameters, one vector each, padded with black skies to whole lanes.
    blocks: Vec<Block>,
    /// Whether any term has a glow; Perez's have none, and are spared its root and division.
    has_glow: bool,
}

/// The parameters of [`LANES`] terms.
#[derive(Debug, Clone, Copy)]
struct Block {
    sun: [Lanes; 3],
    weight: Lanes,
    a: Lanes,
    b: Lanes,
    least: Lanes,
    floor: Lanes,
    lift: Lanes,
    k: Lanes,
    c: Lanes,
    d: Lanes,
    e: Lanes,
    f: Lanes,
    h: Lanes,
    i: Lanes,
}

/// What the skies have at one height above the horizon.
#[derive(Debug)]
pub struct Row<'a> {
    skies: &'a Skies,
    /// Factor of the height, and what the height adds beside the sun's angle: per block.
    factors: Vec<(Lanes, Lanes)>,
    cos_elevation: f64,
    sin_elevation: f64,
}

impl Skies {
    /// Lays the terms out for summing.
    pub fn new(terms: &[Term]) -> Self {
        let blocks = terms.chunks(LANES).map(Block::of).collect();
        Self { blocks, has_glow: terms.iter().any(|term| term.f != 0.0) }
    }

    /// A sum of 0 for each term, in their order, padded to whole lanes.
    pub fn no_sums(&self) -> Vec<[f64; LANES]> {
        vec![[0.0; LANES]; self.blocks.len()]
    }

    /// All that does not depend on the azimuth, at an elevation, radians from 0 to a quarter turn.
    pub fn row(&self, elevation_rad: f64) -> Row<'_> {
        let (sin_elevation, cos_elevation) = elevation_rad.max(0.0).sin_cos();
        let cos_zenith = sin_elevation as f32;
        let root = cos_zenith.sqrt();
        let factors = self.blocks.iter().map(|block| block.at_height(cos_zenith, root)).collect();
        Row { skies: self, factors, cos_elevation, sin_elevation }
    }
}

impl Row<'_> {
    /// The sum of all skies towards an azimuth, radians clockwise from true north.
    pub fn radiance(&self, azimuth_rad: f64) -> f64 {
        let direction = self.direction(azimuth_rad);
        if self.skies.has_glow { self.sum::<true>(direction) } else { self.sum::<false>(direction) }
    }

    /// Adds `share` of each sky towards an azimuth to that sky's own sum of [`Skies::no_sums`].
    pub fn add_each(&self, azimuth_rad: f64, share: f64, sums: &mut [[f64; LANES]]) {
        let direction = self.direction(azimuth_rad);
        for ((block, factor), sum) in self.skies.blocks.iter().zip(&self.factors).zip(sums) {
            let radiance = block.radiance::<true>(direction, factor);
            (0..LANES).for_each(|lane| sum[lane] += share * f64::from(radiance[lane]));
        }
    }

    fn direction(&self, azimuth_rad: f64) -> [f32; 3] {
        let (sin_azimuth, cos_azimuth) = azimuth_rad.sin_cos();
        let direction = [sin_azimuth * self.cos_elevation, cos_azimuth * self.cos_elevation, self.sin_elevation];
        direction.map(|along| along as f32)
    }

    fn sum<const GLOW: bool>(&self, direction: [f32; 3]) -> f64 {
        // Sums of single precision stay short; what they add up to is of double.
        const RUN: usize = 64;
        let blocks = self.skies.blocks.chunks(RUN).zip(self.factors.chunks(RUN));
        let runs = blocks.map(|(blocks, factors)| {
            let mut sum = [0.0; LANES];
            for (block, factor) in blocks.iter().zip(factors) {
                let radiance = block.radiance::<GLOW>(direction, factor);
                sum = each(|lane| sum[lane] + radiance[lane]);
            }
            sum.iter().map(|&lane| f64::from(lane)).sum::<f64>()
        });
        runs.sum()
    }
}

impl Block {
    fn of(terms: &[Term]) -> Self {
        let term = |lane: usize| terms.get(lane).copied().unwrap_or(Term::BLACK);
        let all = |part: fn(&Term) -> f64| each(|lane| part(&term(lane)) as f32);
        Self {
            sun: [all(|term| term.towards_sun.x), all(|term| term.towards_sun.y), all(|term| term.towards_sun.z)],
            weight: all(|term| term.weight),
            a: all(|term| term.a),
            b: all(|term| term.b),
            least: all(|term| term.least),
            floor: all(|term| term.floor),
            lift: all(|term| term.lift),
            k: all(|term| term.k),
            c: all(|term| term.c),
            d: all(|term| term.d),
            e: all(|term| term.e),
            f: all(|term| term.f),
            h: all(|term| term.h),
            i: all(|term| term.i),
        }
    }

    /// The factor of the height, weight and all, and what the height adds to the factor of the sun.
    fn at_height(&self, cos_zenith: f32, root: f32) -> (Lanes, Lanes) {
        let factor = each(|lane| {
            let height = larger(cos_zenith, self.floor[lane]) + self.lift[lane];
            self.weight[lane] * larger(1.0 + self.a[lane] * exp(self.b[lane] / height), self.least[lane])
        });
        (factor, each(|lane| self.k[lane] + self.i[lane] * root))
    }

    #[inline(always)]
    fn radiance<const GLOW: bool>(&self, [x, y, z]: [f32; 3], (factor, base): &(Lanes, Lanes)) -> Lanes {
        let cos_sun: Lanes = each(|lane| {
            let cos = self.sun[0][lane] * x + self.sun[1][lane] * y + self.sun[2][lane] * z;
            smaller(larger(cos, -1.0), 1.0)
        });
        let mut around_sun: Lanes = each(|lane| {
            let cos = cos_sun[lane];
            base[lane] + self.c[lane] * exp(self.d[lane] * acos(cos)) + self.e[lane] * cos * cos
        });
        if GLOW {
            around_sun = each(|lane| {
                let (cos, h) = (cos_sun[lane], self.h[lane]);
                let spread = larger(1.0 + h * h - 2.0 * h * cos, LEAST_SPREAD as f32);
                around_sun[lane] + self.f[lane] * (1.0 + cos * cos) / (spread * spread.sqrt())
            });
        }
        each(|lane| larger(factor[lane] * around_sun[lane], 0.0))
    }
}

#[inline(always)]
fn each(of_lane: impl FnMut(usize) -> f32) -> Lanes {
    std::array::from_fn(of_lane)
}

/// The larger of two numbers, as one instruction: `f32::max` asks about NaN first.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `e^x` without a branch: within 6e-7 of itself for `x` from -5 to 5, 6e-6 over all from -87 to 88, and beyond as there.
#[inline(always)]
fn exp(x: f32) -> f32 {
    /// 1.5 x 2^23: adding it leaves the nearest integer in the lowest bits.
    const TO_INTEGER: f32 = 12_582_912.0;
    let x = smaller(larger(x, -87.0), 88.0) * LOG2_E;
    let shifted = x + TO_INTEGER;
    let part = x - (shifted - TO_INTEGER);

    // 2^part from -1/2 to 1/2: the Taylor polynomial of degree 6 is within 2e-7 there.
    let powers = [0.000_154_035_3, 0.001_333_355_8, 0.009_618_129, 0.055_504_11, 0.240_226_5, LN_2, 1.0];
    let power = powers.into_iter().fold(0.0, |sum: f32, power: f32| sum * part + power);
    f32::from_bits(power.to_bits().wrapping_add(shifted.to_bits() << 23))
}

/// The arc cosine within 5e-7, without a branch (Abramowitz & Stegun 4.4.46; half of that is the rounding of pi).
#[inline(always)]
fn acos(x: f32) -> f32 {
    let powers = [
        -0.001_262_491_1,
        0.006_670_09,
        -0.017_088_126,
        0.030_891_88,
        -0.050_174_303,
        0.088_978_99,
        -0.214_598_8,
        FRAC_PI_2,
    ];
    let size = x.abs();
    let series = powers.into_iter().fold(0.0, |sum: f32, power: f32| sum * size + power);
    let angle = larger(1.0 - size, 0.0).sqrt() * series;
    if x < 0.0 { PI - angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::towards;

    /// A sky of Perez's form and one of Hosek's, with numbers as they occur.
    fn terms() -> Vec<Term> {
        let sun = |step: u32| towards(f64::from(step) * 0.37, 0.02 + f64::from(step % 14) * 0.1);
        let perez = |step: u32| {
            let x = f64::from(step % 9);
            let of_perez = Term { k: 1.0, a: -1.0 + 0.2 * x, b: -0.6 + 0.05 * x, ..Term::BLACK };
            Term { towards_sun: sun(step), weight: 1.0 + x, c: 3.0 * x, d: -3.0 + 0.1 * x, e: 0.05 * x, ..of_perez }
        };
        let hosek = |step: u32| {
            let of_hosek = Term {
                least: f64::NEG_INFINITY,
                floor: 0.0,
                lift: 0.01,
                k: -0.4,
                i: 0.6,
                f: 0.08,
                h: 0.6,
                ..perez(step)
            };
            Term { d: -5.0, c: 2.0, ..of_hosek }
        };
        (0..101).map(perez).chain((0..50).map(hosek)).collect()
    }

    #[test]
    fn the_sum_of_skies_is_the_formula() {
        let terms = terms();
        for some in [&terms[..], &terms[..101], &terms[120..121], &terms[..0]] {
            let skies = Skies::new(some);
            // At the horizon some of these skies are nearly black: what is left there has fewer figures.
            let half_way_up: f64 = some.iter().map(|term| term.radiance(towards(0.3, 0.8))).sum();
            for elevation in [0.0, 0.003, 0.1, 0.7, 1.5, std::f64::consts::FRAC_PI_2] {
                let row = skies.row(elevation);
                for step in 0..200 {
                    let azimuth = f64::from(step) * 0.037 - 0.5;
                    let direction = towards(azimuth, elevation);
                    let exact: f64 = some.iter().map(|term| term.radiance(direction)).sum();
                    let sum = row.radiance(azimuth);
                    assert!(
                        (sum - exact).abs() <= 1e-5 * exact.max(half_way_up),
                        "{sum} against {exact} at {elevation} {azimuth}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_polynomials_are_as_close_as_they_say() {
        for step in -8_700..=8_700 {
            let x = step as f32 * 0.01;
            let exact = f64::from(x).exp();
            assert!((f64::from(exp(x)) - exact).abs() <= 1e-5 * exact, "exp {x}");
            let x = step as f32 / 8_700.0;
            assert!((f64::from(acos(x)) - f64::from(x).acos()).abs() < 5e-7, "acos {x}");
        }
        assert!(exp(f32::NEG_INFINITY) < 1e-37 && exp(1e30).is_finite());
    }

    #[test]
    fn a_uniform_sky_is_alike_everywhere_and_a_black_one_dark() {
        for direction in [DVec3::Z, DVec3::X, towards(2.0, 0.4)] {
            assert_eq!(Term::uniform(2.5).radiance(direction), 2.5);
            assert_eq!(Term::BLACK.radiance(direction), 0.0);
        }
    }
}
