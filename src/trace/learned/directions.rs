//! From which directions does light come, as far as samples have shown?
//!
//! A quadtree over the square that the sphere maps to with its areas kept (the height, and the turn about z): squares that
//! hold more than a hundredth of the light are cut in four (Müller, Gross & Novák 2017).

use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// A square with more than this share of the light is cut.
const MOST_SHARE: f64 = 0.01;

/// Cuts of a square, one in the other, at most.
const MOST_DEPTH: u32 = 16;

/// Where a square is not cut any further.
const WHOLE: u32 = u32::MAX;

/// A distribution over directions.
#[derive(Debug, Clone)]
pub(super) struct Directions {
    /// The first covers the whole square.
    cuts: Vec<Cut>,
}

/// A square cut in four, in the order low x low y, high x low y, low x high y, high x high y.
#[derive(Debug, Clone, Copy)]
struct Cut {
    light: [f64; 4],
    /// What each quarter is cut into, or [`WHOLE`].
    parts: [u32; 4],
}

const BLANK: Cut = Cut { light: [0.0; 4], parts: [WHOLE; 4] };

impl Directions {
    /// Nothing known: squares of a 256th of the sphere, without light.
    pub(super) fn blank() -> Self {
        let even = Self { cuts: vec![Cut { light: [1.0; 4], ..BLANK }] };
        even.refined()
    }

    /// All the light that was added.
    pub(super) fn total(&self) -> f64 {
        self.cuts.first().map_or(0.0, |cut| cut.light.iter().sum())
    }

    /// Adds light from the direction at that place of the square.
    pub(super) fn add(&mut self, square: [f32; 2], light: f64) {
        let mut square = square.map(f64::from);
        let mut at = 0;
        while let Some(cut) = self.cuts.get_mut(at as usize) {
            let quarter = quarter_of(&mut square);
            cut.light[quarter] += light;
            at = cut.parts[quarter];
        }
    }

    /// The same light, finer where there is much and coarser where there is little, and nothing in it yet.
    pub(super) fn refined(&self) -> Self {
        let total = self.total();
        let mut refined = Self { cuts: vec![BLANK] };
        // Of what is to be filled: its number, what it was cut into before, the light in its quarters, its depth.
        let mut open = vec![(0_u32, 0_u32, self.cuts.first().map_or([0.0; 4], |cut| cut.light), 1)];
        while let Some((number, before, light, depth)) = open.pop() {
            for (quarter, &its) in light.iter().enumerate() {
                if depth >= MOST_DEPTH || its <= MOST_SHARE * total {
                    continue;
                }
                let part = refined.cuts.len() as u32;
                refined.cuts.push(BLANK);
                if let Some(cut) = refined.cuts.get_mut(number as usize) {
                    cut.parts[quarter] = part;
                }
                let inner = self.cuts.get(before as usize).map_or(WHOLE, |cut| cut.parts[quarter]);
                let inner_light = self.cuts.get(inner as usize).map_or([0.25 * its; 4], |cut| cut.light);
                open.push((part, inner, inner_light, depth + 1));
            }
        }
        refined
    }

    /// A place of the square, drawn by the light; `numbers` are two in [0, 1). There must be light.
    pub(super) fn drawn(&self, numbers: [f64; 2]) -> [f32; 2] {
        let [mut x, mut y] = numbers;
        let (mut corner, mut side, mut at) = ([0.0, 0.0], 1.0, 0);
        while let Some(Cut { light: [a, b, c, d], parts }) = self.cuts.get(at as usize) {
            // The row first, then the quarter in it; what is left of a number is even again.
            let low = (a + b) / (a + b + c + d);
            let is_high = y >= low;
            y = if is_high { (y - low) / (1.0 - low) } else { y / low };
            let [left, right] = if is_high { [c, d] } else { [a, b] };
            let first = left / (left + right);
            let is_right = x >= first;
            x = if is_right { (x - first) / (1.0 - first) } else { x / first };
            side *= 0.5;
            corner = [corner[0] + if is_right { side } else { 0.0 }, corner[1] + if is_high { side } else { 0.0 }];
            at = parts[usize::from(is_right) + 2 * usize::from(is_high)];
        }
        let inside = |corner: f64, number: f64| (corner + side * number.clamp(0.0, 1.0)).min(BELOW_ONE) as f32;
        [inside(corner[0], x), inside(corner[1], y)]
    }

    /// The density of a place of the square, per steradian.
    pub(super) fn density_per_sr(&self, square: [f32; 2]) -> f64 {
        let mut square = square.map(f64::from);
        let (mut density, mut at) = (1.0 / (4.0 * PI), 0);
        while let Some(cut) = self.cuts.get(at as usize) {
            let sum: f64 = cut.light.iter().sum();
            let quarter = quarter_of(&mut square);
            if cut.light[quarter] <= 0.0 {
                return 0.0;
            }
            density *= 4.0 * cut.light[quarter] / sum;
            at = cut.parts[quarter];
        }
        density
    }
}

/// The largest `f32` below 1.
const BELOW_ONE: f64 = 1.0 - 1.0 / (1 << 24) as f64;

/// In which quarter of the square a place lies; it becomes its place in that quarter.
fn quarter_of(square: &mut [f64; 2]) -> usize {
    let is_high = square.map(|at| at >= 0.5);
    for (at, is_high) in square.iter_mut().zip(is_high) {
        *at = 2.0 * *at - if is_high { 1.0 } else { 0.0 };
    }
    usize::from(is_high[0]) + 2 * usize::from(is_high[1])
}

/// The place of a direction in the square.
pub(super) fn square_of(direction: Vec3) -> [f32; 2] {
    let DVec3 { x, y, z } = direction.as_dvec3();
    let turn = y.atan2(x) / (2.0 * PI);
    [0.5 * (z + 1.0), if turn < 0.0 { turn + 1.0 } else { turn }].map(|at| at.clamp(0.0, BELOW_ONE) as f32)
}

/// The direction of a place in the square.
pub(super) fn direction_of([height, turn]: [f32; 2]) -> Vec3 {
    let z = 2.0 * f64::from(height) - 1.0;
    let ring = (1.0 - z * z).max(0.0).sqrt();
    let (sine, cosine) = (2.0 * PI * f64::from(turn)).sin_cos();
    DVec3::new(ring * cosine, ring * sine, z).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::random::Random;

    /// A small square of the sphere a thousand times as bright as the rest, learned in some rounds.
    fn learned() -> Directions {
        let mut random = Random::new(1, 2, 3);
        let mut directions = Directions::blank();
        for _ in 0..4 {
            directions = directions.refined();
            for _ in 0..100_000 {
                let square = random.pair().map(|number| number as f32);
                directions.add(square, if is_bright(square) { 1000.0 } else { 1.0 });
            }
        }
        directions
    }

    fn is_bright([x, y]: [f32; 2]) -> bool {
        (0.25..0.3125).contains(&x) && (0.8125..0.875).contains(&y)
    }

    #[test]
    fn places_and_directions_are_each_others() {
        let mut random = Random::new(4, 5, 6);
        for _ in 0..1000 {
            let square = random.pair().map(|number| number as f32);
            let back = square_of(direction_of(square));
            let ring = (1.0 - (2.0 * square[0] - 1.0).powi(2)).sqrt();
            let turned = (back[1] - square[1]).abs();
            assert!(
                (back[0] - square[0]).abs() < 1e-6 && turned.min(1.0 - turned) * ring < 1e-6,
                "{square:?} {back:?}"
            );
        }
    }

    #[test]
    fn draws_follow_the_density_and_the_density_the_light() {
        let directions = learned();
        let mut random = Random::new(7, 8, 9);
        let count = 40_000;
        let (mut bright, mut area_sr) = (0.0, 0.0);
        for _ in 0..count {
            let square = directions.drawn(random.pair());
            let density_per_sr = directions.density_per_sr(square);
            assert!(density_per_sr > 0.0, "{square:?} was drawn");
            bright += if is_bright(square) { 1.0 } else { 0.0 } / f64::from(count);
            // The mean of one over the density is the area in which there is any.
            area_sr += 1.0 / density_per_sr / f64::from(count);
        }
        let share = 1000.0 / (1000.0 + 255.0);
        assert!((bright - share).abs() < 0.03, "{bright} of {share}");
        assert!((area_sr / (4.0 * PI) - 1.0).abs() < 0.1, "{area_sr} sr");
    }

    #[test]
    fn light_makes_squares_finer_and_its_lack_coarser() {
        let directions = learned();
        assert!(directions.cuts.len() > 20, "{} cuts", directions.cuts.len());
        let mut even = directions.refined();
        let mut random = Random::new(1, 1, 1);
        for _ in 0..100_000 {
            even.add(random.pair().map(|number| number as f32), 1.0);
        }
        // Even light is cut down to squares of 1/256 of it, by 1 + 4 + 16 + 64 cuts.
        assert_eq!(even.refined().cuts.len(), 85);
        assert!((even.total() - 1e5).abs() < 1e-6);
    }
}
