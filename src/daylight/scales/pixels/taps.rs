//! How high stands what is around a pixel, by fixed steps in the map's rows?

use super::super::sight::Rings;
use super::super::sums::SkySums;
use super::super::zenith::{NOTHING_M, Zenith};
use super::{Look, TURNS};
use glam::{Vec2, Vec3};

/// Ways in which the samples of a direction are placed in their rings.
pub const JITTERS: usize = super::TILE;

/// Most levels of the map that taps are read from.
const MOST_LEVELS: usize = 8;

/// A step to a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tap {
    /// Texels from the point's, in memory.
    offset: i32,
    /// One over its distance, 1/m.
    per_m: f32,
}

/// Heights whose rows are longer than the map by as far as taps go: a step beyond a side meets nothing.
#[derive(Debug, Clone)]
struct Padded {
    stride: i32,
    heights_m: Vec<f32>,
}

/// The steps of all directions and turns.
#[derive(Debug, Clone)]
pub struct Taps {
    corner_m: Vec2,
    texel_m: f32,
    highest_m: f32,
    levels: Vec<Padded>,
    /// For each sector and jitter where its taps begin in each level, [`MOST_LEVELS`] + 1 numbers.
    first: Vec<[u32; MOST_LEVELS + 1]>,
    taps: Vec<Tap>,
}

/// A pixel's place on the map.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    base: [i32; MOST_LEVELS],
    height_m: f32,
    covered: bool,
}

impl Taps {
    /// The taps of a map for all sectors of `sums`, which has [`TURNS`] turns. Some 20 ms for 1024 x 1024 texels.
    pub fn new(zenith: &Zenith, sums: &SkySums, look: &Look) -> Self {
        let farthest_m = zenith.farthest_m();
        let reach_m = look.reach_m.unwrap_or(farthest_m).min(farthest_m);
        let levels: Vec<Padded> = zenith
            .levels
            .iter()
            .take(MOST_LEVELS)
            .enumerate()
            .map(|(number, level)| {
                // Steps end with their ring, which may reach a texel farther.
                let texel_m = zenith.texel_m * (1 << number) as f32;
                let pad = (reach_m * 1.5 / texel_m) as usize + 2;
                let row =
                    |row: &[f32]| row.iter().copied().chain(std::iter::repeat_n(NOTHING_M, pad)).collect::<Vec<_>>();
                let heights_m = level.top_m.chunks(level.size[0].max(1)).flat_map(row).collect();
                Padded { stride: (level.size[0] + pad) as i32, heights_m }
            })
            .collect();

        let mut all = Self {
            corner_m: zenith.corner_m,
            texel_m: zenith.texel_m,
            highest_m: zenith.highest_m,
            levels,
            first: Vec::new(),
            taps: Vec::new(),
        };
        for direction in 0..sums.directions {
            for turn in 0..TURNS {
                let (sine, cosine) = (sums.azimuth_rad(direction, turn) as f32).sin_cos();
                let along = Vec2::new(sine, cosine) / zenith.texel_m;
                for jitter in 0..JITTERS {
                    // Directions of a pixel do not look at the same distances.
                    let part = ((jitter as f32 + 0.5) / JITTERS as f32 + 0.618 * direction as f32).fract();
                    all.add(&Rings::new(zenith, look.samples, reach_m, part), along);
                }
            }
        }
        all
    }

    fn add(&mut self, rings: &Rings, along: Vec2) {
        let mut first = [0; MOST_LEVELS + 1];
        for (number, level) in self.levels.iter().enumerate() {
            first[number] = self.taps.len() as u32;
            for (_, at_m) in rings.places().filter(|(level, _)| (*level).min(self.levels.len() - 1) == number) {
                let at = along * at_m / (1 << number) as f32;
                let [x, y] = [at.x, at.y].map(|at| at.round() as i32);
                self.taps.push(Tap { offset: y * level.stride + x, per_m: at_m.recip() });
            }
        }
        first[self.levels.len()..].fill(self.taps.len() as u32);
        self.first.push(first);
    }

    /// Where a pixel lies: half a texel before its surface, so that the map's texels do not take its own wall for another.
    #[inline]
    pub fn place(&self, position_m: Vec3, normal: Vec3, opening: bool) -> Place {
        let at = (position_m.truncate() - self.corner_m) / self.texel_m + 0.75 * normal.truncate();
        let [x, y] = [at.x, at.y].map(|at| at.max(0.0) as i32);
        let mut base = [0; MOST_LEVELS];
        for (number, (base, level)) in base.iter_mut().zip(&self.levels).enumerate() {
            *base = (y >> number) * level.stride + (x >> number);
        }
        let top_m = self.levels.first().and_then(|level| level.heights_m.get(base[0] as usize));
        let covered = opening && top_m.is_some_and(|top_m| *top_m > position_m.z + self.texel_m);
        Place { base, height_m: position_m.z, covered }
    }

    /// Between which slopes the sky is seen in a sector, its taps placed by a jitter: `sector * JITTERS + jitter`.
    #[inline]
    pub fn horizon(&self, place: &Place, pattern: usize) -> [f32; 2] {
        let Some(first) = self.first.get(pattern) else { return [f32::NEG_INFINITY, f32::INFINITY] };
        if place.covered {
            return self.beneath(place, first);
        }
        let mut low = f32::NEG_INFINITY;
        let highest_m = self.highest_m - place.height_m;
        for (number, level) in self.levels.iter().enumerate() {
            let Some(taps) = self.taps.get(first[number] as usize..first[number + 1] as usize) else { break };
            // Nothing that is left can rise above the horizon.
            if taps.first().is_some_and(|tap| highest_m * tap.per_m < low) {
                break;
            }
            for tap in taps {
                let height_m = level.heights_m.get((place.base[number] + tap.offset) as usize).copied();
                low = low.max((height_m.unwrap_or(NOTHING_M) - place.height_m) * tap.per_m);
            }
        }
        [low, f32::INFINITY]
    }

    /// The same beneath a cover, whose edge is the opening angle.
    fn beneath(&self, place: &Place, first: &[u32; MOST_LEVELS + 1]) -> [f32; 2] {
        let (mut low, mut high, mut covered) = (f32::NEG_INFINITY, f32::INFINITY, true);
        for (number, level) in self.levels.iter().enumerate() {
            let Some(taps) = self.taps.get(first[number] as usize..first[number + 1] as usize) else { break };
            for tap in taps {
                let height_m = level.heights_m.get((place.base[number] + tap.offset) as usize).copied();
                let slope = (height_m.unwrap_or(NOTHING_M) - place.height_m) * tap.per_m;
                match covered {
                    true if slope > 0.0 => high = slope,
                    true => covered = false,
                    false => low = low.max(slope),
                }
            }
        }
        if covered { [f32::INFINITY, f32::NEG_INFINITY] } else { [low, high] }
    }
}
