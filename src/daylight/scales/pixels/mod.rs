//! What does every pixel of a view receive, at two scales, many times a second?
//!
//! The large scale is what a point sees of the map of heights, as for any point ([`super::expose`]), but by taps: for each of a
//! few turns the places to look at are fixed steps in the map's own rows, told as offsets of memory, so that a tap is a load,
//! a product and a comparison. Neighbours are turned differently, four by four, and may be averaged with those that lie on
//! the same surface ([`smooth`]). The fine scale is horizon-based visibility in the camera's own buffers ([`fine`]): what the map's
//! texels are too coarse for, balconies, sills, porches.
//!
//! The two are combined as in the paper, by weighting, or by what it names as better, by intersecting what is visible.
//!
//! Limits: [`super::sight`]'s opening angle is here by taps too; peeled depths are not, their bands take too long.

pub mod fine;
pub mod smooth;
pub mod taps;

use super::sight::{each_open, sine_of_slope};
use super::sums::SkySums;
use super::{before_plane, turn_of};
use crate::daylight::camera::Buffers;
use crate::job::{Cancel, Cancelled};
use glam::{Vec2, Vec3, Vec3A, Vec4};
use rayon::prelude::*;
use std::f32::consts::PI;
use taps::{JITTERS, Taps};

/// Neighbours that are turned differently, each way.
pub const TILE: usize = 4;

/// Most directions of a pixel.
pub const MOST_DIRECTIONS: usize = 32;

/// How the two scales are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Combination {
    /// The large scale alone.
    Large,
    /// Exposure by the large scale, weighted by the fine visibility.
    Weighted,
    /// The sky that is visible at both scales.
    Intersected,
}

/// How a view is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Samples of the large scale along each direction; how many directions, [`SkySums`] says.
    pub samples: usize,
    /// How far they go, metres; `None` for as far as the map.
    pub reach_m: Option<f32>,
    /// Whether the sky is seen beneath overhangs up to the opening angle.
    pub opening: bool,
    /// How the scales are combined.
    pub combination: Combination,
    /// Samples of the fine scale along each direction.
    pub fine_samples: usize,
    /// How far the fine scale reaches, metres.
    pub fine_reach_m: f32,
    /// Whether neighbours on one surface are averaged.
    pub smooth: bool,
}

/// What a pixel receives; nothing where nothing is hit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Received {
    /// From what was asked for, kWh/m2.
    pub total_kwh_m2: f32,
    /// Sky view factor.
    pub svf: f32,
    /// Hours of sun.
    pub sun_h: f32,
}

impl Received {
    fn and(self, other: Self) -> Self {
        Self {
            total_kwh_m2: self.total_kwh_m2 + other.total_kwh_m2,
            svf: self.svf + other.svf,
            sun_h: self.sun_h + other.sun_h,
        }
    }

    fn times(self, share: f32) -> Self {
        Self { total_kwh_m2: share * self.total_kwh_m2, svf: share * self.svf, sun_h: share * self.sun_h }
    }
}

/// A view's surfaces in the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Surfaces {
    /// Width and height of the view, pixels.
    pub size: [usize; 2],
    /// Places, metres; not a number where nothing is hit.
    pub positions_m: [Vec<f32>; 3],
    /// Unit normals that face the camera.
    pub normals: [Vec<f32>; 3],
    /// Places and normals once more, each in one piece: for what looks at pixels here and there.
    places: Vec<[Vec3A; 2]>,
    /// How wide a pixel is at the picture's median depth, metres.
    pub pixel_m: f32,
}

impl Surfaces {
    /// The places and normals of a camera's buffers.
    pub fn new(buffers: &Buffers) -> Self {
        let count = buffers.depth_m.len();
        let points: Vec<(Vec3, Vec3)> = (0..count)
            .into_par_iter()
            .map(|pixel| match buffers.point(pixel) {
                Some(point) => (point.position_m, point.normal.unwrap_or(Vec3::ZERO)),
                None => (Vec3::NAN, Vec3::ZERO),
            })
            .collect();
        let part = |axis: usize, of: fn(&(Vec3, Vec3)) -> Vec3| points.iter().map(|point| of(point)[axis]).collect();
        let mut depths_m: Vec<f32> = buffers.depth_m.iter().copied().filter(|depth_m| depth_m.is_finite()).collect();
        let middle = depths_m.len() / 2;
        let median_m =
            if depths_m.is_empty() { 1.0 } else { *depths_m.select_nth_unstable_by(middle, f32::total_cmp).1 };
        Self {
            size: buffers.camera.size,
            pixel_m: median_m / buffers.camera.focal_px(),
            positions_m: std::array::from_fn(|axis| part(axis, |point| point.0)),
            normals: std::array::from_fn(|axis| part(axis, |point| point.1)),
            places: points.iter().map(|&(at_m, normal)| [at_m.into(), normal.into()]).collect(),
        }
    }

    /// The place and the normal of a pixel.
    #[inline]
    fn place(&self, pixel: usize) -> [Vec3A; 2] {
        self.places.get(pixel).copied().unwrap_or([Vec3A::NAN, Vec3A::ZERO])
    }
}

/// What of the light is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    /// From the sky.
    Sky,
    /// From the suns.
    Beam,
    /// From both.
    All,
}

/// The sums of a sky as pixels read them.
#[derive(Debug, Clone)]
pub struct PixelSums {
    directions: usize,
    /// For each sector, turns of a direction in a row, above each row the energy times direction, kWh/m2, and the hours of sun.
    above: Vec<Vec4>,
    /// The cosine-weighted solid angle above each row for a level plane and for an upright one that faces it, sr.
    level_upright_sr: Vec<[f32; 2]>,
    /// Unit vectors of each sector's middle.
    along: Vec<Vec2>,
}

/// Rows of the sums that pixels read, between which they interpolate: few enough for the sums of all sectors to stay near the
/// processor.
const ROWS: usize = 64;

/// How many ways pixels are turned.
pub const TURNS: usize = TILE * TILE;

impl PixelSums {
    /// From sums that have [`TURNS`] turns and at most [`MOST_DIRECTIONS`] directions; `None` for others.
    pub fn new(sums: &SkySums, part: Part) -> Option<Self> {
        if sums.turns != TURNS || sums.directions > MOST_DIRECTIONS {
            return None;
        }
        let sectors = || (0..sums.directions).flat_map(|direction| (0..TURNS).map(move |turn| (direction, turn)));
        let at = |row: usize| row as f32 / ROWS as f32;
        let above = sectors().flat_map(|(direction, turn)| {
            (0..=ROWS).map(move |row| {
                let piece = sums.above(direction, turn, at(row));
                let [x, y, z] = match part {
                    Part::Sky => piece.sky_kwh_m2,
                    Part::Beam => piece.beam_kwh_m2,
                    Part::All => std::array::from_fn(|axis| piece.sky_kwh_m2[axis] + piece.beam_kwh_m2[axis]),
                };
                Vec4::new(x, y, z, piece.sun_h)
            })
        });
        let of_plane = |row: usize| {
            let piece = sums.above(0, 0, at(row));
            [piece.level_sr, piece.upright_sr]
        };
        let along = |(direction, turn)| {
            let (sine, cosine) = (sums.azimuth_rad(direction, turn) as f32).sin_cos();
            Vec2::new(sine, cosine)
        };
        Some(Self {
            directions: sums.directions,
            above: above.collect(),
            level_upright_sr: (0..=ROWS).map(of_plane).collect(),
            along: sectors().map(along).collect(),
        })
    }

    /// Energy times direction with the hours of sun, and the solid angles of a level and an upright plane, between two sines of
    /// elevation.
    #[inline]
    fn between(&self, sector: usize, low: f32, high: f32) -> (Vec4, [f32; 2]) {
        let (energy, plane) = self.above(sector, low);
        if high >= 1.0 {
            return (energy, plane);
        }
        let (other, other_plane) = self.above(sector, high);
        (energy - other, [plane[0] - other_plane[0], plane[1] - other_plane[1]])
    }

    #[inline]
    fn above(&self, sector: usize, sine: f32) -> (Vec4, [f32; 2]) {
        let at = sine.clamp(0.0, 1.0) * ROWS as f32;
        let row = (at as usize).min(ROWS - 1);
        let part = at - row as f32;
        let first = sector * (ROWS + 1) + row;
        let (Some([a, b]), Some([c, d])) = (self.above.get(first..first + 2), self.level_upright_sr.get(row..row + 2))
        else {
            return (Vec4::ZERO, [0.0; 2]);
        };
        (*a + part * (*b - *a), [c[0] + part * (d[0] - c[0]), c[1] + part * (d[1] - c[1])])
    }
}

/// What each pixel receives, rows from the top. The same bits for any number of threads.
///
/// # Errors
/// [`Cancelled`].
pub fn see(
    taps: &Taps,
    sums: &PixelSums,
    surfaces: &Surfaces,
    look: &Look,
    cancel: &Cancel,
) -> Result<Vec<Received>, Cancelled> {
    /// Rows between looks at whether to stop.
    const ROWS_AT_ONCE: usize = 8;
    let [width, height] = surfaces.size;
    let mut seen = vec![Received::default(); width * height];
    let steps = fine::Steps::new(surfaces, sums.directions, look);
    let chunk = ROWS_AT_ONCE * width.max(1);
    seen.par_chunks_mut(chunk).enumerate().try_for_each(|(number, some)| {
        cancel.check()?;
        for (off, received) in some.iter_mut().enumerate() {
            let pixel = number * chunk + off;
            if surfaces.positions_m[0][pixel].is_nan() {
                continue;
            }
            *received = match look.combination {
                Combination::Intersected => {
                    at_pixel(taps, sums, surfaces, pixel, look, |turn| Some(steps.covered(surfaces, pixel, turn)))
                }
                _ => at_pixel(taps, sums, surfaces, pixel, look, |_| None),
            };
        }
        Ok(())
    })?;
    if look.combination == Combination::Weighted {
        let visible = steps.visible(surfaces, cancel)?;
        seen.iter_mut().zip(&visible).for_each(|(received, visible)| *received = received.times(*visible));
    }
    if look.smooth { Ok(smooth::smoothed(&seen, surfaces)) } else { Ok(seen) }
}

/// The elevations that the fine scale covers in each direction, evenly by their sine.
pub type Covered = [u64; MOST_DIRECTIONS];

/// What one pixel receives; `covered` is asked for how the pixel is turned.
#[inline]
fn at_pixel(
    taps: &Taps,
    sums: &PixelSums,
    surfaces: &Surfaces,
    pixel: usize,
    look: &Look,
    covered: impl FnOnce(usize) -> Option<Covered>,
) -> Received {
    let (column, row) = (pixel % surfaces.size[0], pixel / surfaces.size[0]);
    let tile = column % TILE + TILE * (row % TILE);
    let [position_m, normal] = surfaces.place(pixel).map(Vec3::from);
    let turn = turn_of(sums.directions, TURNS, normal, SPREAD[tile] as f32 / TURNS as f32);
    let place = taps.place(position_m, normal, look.opening);
    let covered = covered(turn);
    let mut received = Received::default();
    for direction in 0..sums.directions {
        let sector = direction * TURNS + turn;
        let along = sums.along.get(sector).copied().unwrap_or(Vec2::X);
        let Some([from, to]) = before_plane(Some(normal), along) else { continue };
        let [low, high] = taps.horizon(&place, sector * JITTERS + tile / TILE);
        let (low, high) = (sine_of_slope(low.max(from).max(0.0)), sine_of_slope(high.min(to)));
        if low >= high {
            continue;
        }
        let (mut energy, mut plane_sr) = (Vec4::ZERO, [0.0; 2]);
        let mut add = |low: f32, high: f32| {
            let (more, [level_sr, upright_sr]) = sums.between(sector, low, high);
            energy += more;
            plane_sr = [plane_sr[0] + level_sr, plane_sr[1] + upright_sr];
        };
        match &covered {
            None => add(low, high),
            Some(covered) => each_open(!covered[direction], low, high, |band| add(band.low, band.high)),
        }
        let across = normal.truncate().dot(along);
        received.total_kwh_m2 += normal.dot(energy.truncate()).max(0.0);
        received.svf += (normal.z * plane_sr[0] + across * plane_sr[1]).max(0.0) / PI;
        received.sun_h += energy.w;
    }
    received
}

/// The turns of the pixels of a tile: neighbours far from each other (Bayer's order).
const SPREAD: [u8; TURNS] = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];
