//! Numbers that fill a square, a hemisphere or a sphere more evenly than chance would.
//!
//! The R2 sequence (M. Roberts 2018: steps by the powers of the root of x^3 = x + 1), turned by an offset so that two
//! receivers do not share their gaps (Cranley & Patterson 1976), and a spiral over the sphere. Everything is a pure function
//! of numbers, so any thread gives the same bits.

use glam::Vec3;
use std::f64::consts::{PI, TAU};

/// Inverse powers of the plastic number, the root of x^3 = x + 1.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// Inverse of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// SplitMix64's increment (Steele, Lea & Flood 2014).
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// Point number `index` of the sequence in the unit square, turned by `offset`.
pub fn square(index: u32, offset: [f64; 2]) -> [f64; 2] {
    let along = |axis: usize| (offset[axis] + R2[axis] * (f64::from(index) + 0.5)).fract();
    [along(0), along(1)]
}

/// An offset of its own for each pair of numbers: uniform in the square, without a pattern.
pub fn offset(seed: u64, number: u64) -> [f64; 2] {
    let one = mixed(mixed(seed.wrapping_add(STEP)) ^ number.wrapping_mul(STEP));
    [one, mixed(one.wrapping_add(STEP))].map(|bits| (bits >> 11) as f64 / (1_u64 << 53) as f64)
}

/// A direction about `normal` for a point of the square, by its cosine: density `cos / pi`.
pub fn cosine_about(normal: Vec3, [square, turn]: [f64; 2]) -> Vec3 {
    let (right, up) = normal.any_orthonormal_pair();
    let ring = square.sqrt();
    let (sine, cosine) = (TAU * turn).sin_cos();
    let [x, y, z] = [ring * cosine, ring * sine, (1.0 - square).max(0.0).sqrt()].map(|part| part as f32);
    (x * right + y * up + z * normal).normalize_or(normal)
}

/// A direction for a point of the square, uniform over the sphere: density `1 / (4 pi)`.
pub fn on_sphere([height, turn]: [f64; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * height;
    let ring = (1.0 - z * z).max(0.0).sqrt();
    let (sine, cosine) = (TAU * turn).sin_cos();
    Vec3::new((ring * cosine) as f32, (ring * sine) as f32, z as f32)
}

/// Direction number `index` of `count` that cover the sphere evenly (a golden spiral), turned by `offset`.
pub fn spiral(index: u32, count: u32, offset: [f64; 2]) -> Vec3 {
    let height = (f64::from(index) + offset[0]) / f64::from(count.max(1));
    on_sphere([height, (offset[1] + GOLDEN * f64::from(index)).fract()])
}

/// The solid angle of the whole sphere.
pub const SPHERE_SR: f64 = 4.0 * PI;

fn mixed(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn moments_are_those_of_the_densities() {
        for number in 0..20 {
            let offset = offset(7, number);
            let normal = on_sphere(self::offset(8, number));
            let (mut cosines, mut sum, mut squares) = (0.0, DVec3::ZERO, DVec3::ZERO);
            for index in 0..1024 {
                let direction = cosine_about(normal, square(index, offset));
                assert!((direction.length() - 1.0).abs() < 1e-5 && direction.dot(normal) >= -1e-6);
                cosines += f64::from(direction.dot(normal)) / 1024.0;
                let direction = spiral(index, 1024, offset).as_dvec3();
                sum += direction / 1024.0;
                squares += direction * direction / 1024.0;
            }
            // The mean of cos over cos / pi is 2/3; over the sphere all components square to 1/3.
            assert!((cosines - 2.0 / 3.0).abs() < 2e-3, "{cosines}");
            assert!(sum.length() < 2e-3 && (squares - 1.0 / 3.0).abs().max_element() < 2e-3, "{sum} {squares}");
        }
    }

    #[test]
    fn offsets_differ() {
        let mut all: Vec<[u64; 2]> =
            (0..1000).map(|at| offset(at / 100, at % 100).map(|number| number.to_bits())).collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 1000);
    }
}
