//! What does a point receive, by maps made beforehand and not by rays?
//!
//! Muñoz-Pandiella et al. 2017, "Real-time solar exposure simulation in complex cities": what stands how high is a depth map
//! from the [zenith]; along some directions of the horizon a point [sees](sight) the sky between certain heights; what comes
//! from there is known from the [sums] of the exposure map. Nothing is traced.
//!
//! Where it differs from the paper: peeled depths with all their bands beside the opening angle; bands summed exactly and
//! not sampled; weights by the cosine.

pub mod pixels;
pub mod sight;
pub mod sums;
pub mod zenith;

use super::cast::Asked;
use super::{Exposure, Point};
use crate::flow::sequence;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::Status;
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use sight::{Overhangs, Rings, bands, sine_of_slope};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};
use sums::{Piece, SkySums};
use zenith::Zenith;

/// Offsets of the points' turns start here, apart from those of rays.
const OFFSETS: u64 = 1 << 48;

/// Steeper than this a surface is a wall: its directions are turned so that its plane parts two of them.
const WALL_NORMAL_Z: f32 = 0.5;

/// How a point looks around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scan {
    /// Samples along each direction.
    pub samples: usize,
    /// How far they go, metres; `None` for as far as the map.
    pub reach_m: Option<f32>,
    /// What is made of things that stand over it.
    pub overhangs: Overhangs,
    /// Seed of the points' turns.
    pub seed: u64,
}

/// A point on the map.
#[derive(Debug, Clone, Copy)]
pub struct Seer {
    /// Metres.
    position_m: Vec3,
    /// In texels from the map's corner.
    at: Vec2,
    /// Of its surface.
    normal: Option<Vec3>,
    /// Whether something stands over it.
    covered: bool,
}

impl Seer {
    fn new(zenith: &Zenith, point: &Point) -> Self {
        let at = zenith.at(point.position_m.truncate());
        let texel = |level: &zenith::Level| Some(level.top_m[level.texel(at.x.floor() as i32, at.y.floor() as i32)?]);
        let top_m = zenith.levels.first().and_then(texel).unwrap_or(zenith::NOTHING_M);
        // A roof's height changes within a texel.
        let covered = top_m > point.position_m.z + zenith.texel_m;
        Self { position_m: point.position_m, at, normal: point.normal, covered }
    }
}

/// What each point receives, in their order: by [`SkySums::directions`] directions. Half of the difference between the even
/// and the odd directions is told as the error.
///
/// Some 30 us a point and thread for 64 directions of 64 samples (`cargo bench --bench scales`).
///
/// # Errors
/// [`Cancelled`].
pub fn expose(
    zenith: &Zenith,
    sums: &SkySums,
    asked: Asked,
    scan: &Scan,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Exposure>, Cancelled> {
    /// Points between looks at whether to stop.
    const CHUNK: usize = 256;
    progress.begin("maps", asked.points.len() as u64);
    let farthest_m = zenith.farthest_m();
    let reach_m = scan.reach_m.unwrap_or(farthest_m).min(farthest_m);
    let rings: Vec<Rings> = (0..sums.turns)
        .map(|turn| Rings::new(zenith, scan.samples, reach_m, (turn as f32 + 0.5) / sums.turns as f32))
        .collect();
    let chunks: Result<Vec<Vec<Exposure>>, Cancelled> = asked
        .points
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, some)| {
            cancel.check()?;
            let exposure = |(index, point): (usize, &Point)| {
                let [random, _] = sequence::offset(scan.seed, OFFSETS + asked.number(chunk * CHUNK + index));
                at_point(zenith, sums, &rings, scan.overhangs, point, random as f32)
            };
            let exposures = some.iter().enumerate().map(exposure).collect();
            progress.advance(some.len() as u64);
            Ok(exposures)
        })
        .collect();
    progress.end();
    Ok(chunks?.concat())
}

/// What a plane in the open receives, with nothing in its way.
pub fn in_the_open(sums: &SkySums, normal: Option<Vec3>) -> Exposure {
    let mut received = Received::default();
    for direction in 0..sums.directions {
        let turn = turn_of(sums.directions, sums.turns, normal.unwrap_or(Vec3::Z), 0.0);
        let (sine, cosine) = (sums.azimuth_rad(direction, turn) as f32).sin_cos();
        let along = Vec2::new(sine, cosine);
        if let Some([from, to]) = before_plane(normal, along) {
            let above = |slope: f32| sums.above(direction, turn, sine_of_slope(slope));
            received.add(&above(from.max(0.0)).without(&above(to)), normal, along);
        }
    }
    received.exposure()
}

fn at_point(
    zenith: &Zenith,
    sums: &SkySums,
    rings: &[Rings],
    overhangs: Overhangs,
    point: &Point,
    random: f32,
) -> Exposure {
    let seer = Seer::new(zenith, point);
    let turn = turn_of(sums.directions, sums.turns, point.normal.unwrap_or(Vec3::Z), random);
    let turned = rings.get((random * rings.len() as f32) as usize).or(rings.first());
    let Some(rings) = turned else { return Exposure::none(Status::Dark) };

    let mut halves = [Received::default(); 2];
    for direction in 0..sums.directions {
        let (sine, cosine) = (sums.azimuth_rad(direction, turn) as f32).sin_cos();
        let along = Vec2::new(sine, cosine);
        let Some(plane) = before_plane(point.normal, along) else { continue };
        let mut visible = Piece::default();
        bands(zenith, rings, overhangs, &seer, along, plane, |band| {
            let above = |sine: f32| sums.above(direction, turn, sine);
            visible = visible.and(&above(band.low).without(&above(band.high)));
        });
        halves[direction % 2].add(&visible, point.normal, along);
    }
    let [even, odd] = halves;
    let error_kwh_m2 = f64::from((even.kwh_m2() - odd.kwh_m2()).abs() / 2.0);
    Exposure { error_kwh_m2, ..even.and(&odd).exposure() }
}

/// How a point is turned: a wall so that its plane lies between two directions, anything else by a number from 0 to 1.
fn turn_of(directions: usize, turns: usize, normal: Vec3, random: f32) -> usize {
    let turn = if normal.z.abs() < WALL_NORMAL_Z {
        let edge = (azimuth_rad(normal.x, normal.y) + 0.5 * PI) * directions as f32 / TAU + 0.5;
        (edge - (edge as usize) as f32) * turns as f32 + 0.5
    } else {
        random * turns as f32
    };
    turn as usize % turns
}

/// Between which slopes the sky lies before a plane, along a direction; `None` where it lies behind it.
fn before_plane(normal: Option<Vec3>, along: Vec2) -> Option<[f32; 2]> {
    /// Closer to upright than this a plane is a wall.
    const UPRIGHT: f32 = 1e-5;
    let Some(normal) = normal else { return Some([f32::NEG_INFINITY, f32::INFINITY]) };
    let across = normal.truncate().dot(along);
    if normal.z > UPRIGHT {
        Some([-across / normal.z, f32::INFINITY])
    } else {
        let high = if normal.z < -UPRIGHT { across / -normal.z } else { f32::INFINITY };
        (across > 0.0).then_some([f32::NEG_INFINITY, high])
    }
}

/// What has come so far.
#[derive(Debug, Clone, Copy, Default)]
struct Received {
    sky_kwh_m2: f32,
    beam_kwh_m2: f32,
    svf: f32,
    sun_h: f32,
}

impl Received {
    fn add(&mut self, piece: &Piece, normal: Option<Vec3>, along: Vec2) {
        self.sun_h += piece.sun_h;
        let Some(normal) = normal else {
            let [sky, beam] = piece.all_kwh_m2;
            self.sky_kwh_m2 += sky;
            self.beam_kwh_m2 += beam;
            self.svf += piece.solid_angle_sr / TAU;
            return;
        };
        let by_normal = |vector: [f32; 3]| normal.dot(Vec3::from_array(vector)).max(0.0);
        self.sky_kwh_m2 += by_normal(piece.sky_kwh_m2);
        self.beam_kwh_m2 += by_normal(piece.beam_kwh_m2);
        let across = normal.truncate().dot(along);
        self.svf += (normal.z * piece.level_sr + across * piece.upright_sr).max(0.0) / PI;
    }

    fn and(&self, other: &Self) -> Self {
        Self {
            sky_kwh_m2: self.sky_kwh_m2 + other.sky_kwh_m2,
            beam_kwh_m2: self.beam_kwh_m2 + other.beam_kwh_m2,
            svf: self.svf + other.svf,
            sun_h: self.sun_h + other.sun_h,
        }
    }

    fn exposure(&self) -> Exposure {
        let status = if self.kwh_m2() > 0.0 { Status::Ok } else { Status::Dark };
        Exposure {
            beam_kwh_m2: f64::from(self.beam_kwh_m2),
            sky_kwh_m2: f64::from(self.sky_kwh_m2),
            svf: f64::from(self.svf).clamp(0.0, 1.0),
            sun_h: f64::from(self.sun_h),
            ..Exposure::none(status)
        }
    }

    fn kwh_m2(&self) -> f32 {
        self.sky_kwh_m2 + self.beam_kwh_m2
    }
}

/// The azimuth of a level direction, clockwise from +Y, within a quarter of a degree; a third of the time of the exact one.
fn azimuth_rad(x: f32, y: f32) -> f32 {
    let (a, b) = (x.abs(), y.abs());
    let ratio = a.min(b) / a.max(b).max(f32::MIN_POSITIVE);
    // Rajan et al. 2006, "Efficient approximations for the arctangent function", equation 7.
    let octant = ratio * (FRAC_PI_4 + 0.273 * (1.0 - ratio));
    let quarter = if a > b { FRAC_PI_2 - octant } else { octant };
    let half = if y < 0.0 { PI - quarter } else { quarter };
    if x < 0.0 { TAU - half } else { half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_run_clockwise_from_the_north() {
        for number in 0..720 {
            let exact = number as f32 * TAU / 720.0;
            let found = azimuth_rad(exact.sin() * 3.0, exact.cos() * 3.0);
            let off = (found - exact + PI).rem_euclid(TAU) - PI;
            assert!(off.abs() < 0.25_f32.to_radians(), "{exact} {found}");
        }
    }
}
