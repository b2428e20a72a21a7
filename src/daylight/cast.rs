//! How much do sun and sky bring to a sensor, by casting rays at every sun of the period and over the sky?
//!
//! The beam: a shadow ray to each sun, which stands where it is and not where a texel of the map has it; or to some suns, each
//! of which stands for the same share of what all would bring if nothing were in their way ([beams](super::beams)). The
//! sky: directions by the cosine to the normal, evenly spread (R2 sequence), each bringing the map's radiance where nothing
//! is in its way; glazing weakens both. The directions are dealt out to blocks in turn; how far the blocks differ is the
//! sky's standard error, twice too large or so, for together they are spread more evenly than each.
//!
//! Cost: a ray a sun and a ray a direction, some 0.3 us each and thread, so 3 ms a sensor for all suns of a year of hours.
//! Limits: a sensor is held to be inside matter where most of what it sees are backs of surfaces, or no sky and more backs
//! than fronts, so meshes must be closed or face outwards.

use super::beams::{Suns, beam_at};
use super::{Exposure, Point};
use crate::flow::sequence;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::Status;
use crate::rays::Rays;
use crate::sky::azimuth_elevation_rad;
use crate::sky::map::ExposureMap;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Blocks that the directions are dealt out to.
const BLOCKS: u32 = 8;

/// Directions in which a sensor looks for the backs of surfaces.
const LOOKS: u32 = 32;

/// Offsets of the sensors' sequences start here, apart from those of the estimators.
const OFFSETS: u64 = 1 << 46;
const BEAM_OFFSETS: u64 = 1 << 47;

/// How a sensor is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Casting {
    /// Suns that are looked at; `None` for every one.
    pub sun_rays: Option<u32>,
    /// Directions of the sky; rounded up to whole blocks.
    pub sky_rays: u32,
    /// Seed of the sequences' offsets.
    pub seed: u64,
}

impl Default for Casting {
    /// The truth: every sun and 4096 directions, which leave the sky's part within some 0.3%.
    fn default() -> Self {
        Self { sun_rays: None, sky_rays: 4096, seed: 0 }
    }
}

impl Casting {
    /// Fewer rays for the faces or vertices of a mesh, which are many and are looked at together.
    pub const fn of_faces(seed: u64) -> Self {
        Self { sun_rays: Some(64), sky_rays: 128, seed }
    }

    /// Few rays for the pixels of a picture.
    pub const fn of_pixels(seed: u64) -> Self {
        Self { sun_rays: Some(16), sky_rays: 32, seed }
    }
}

/// Points to be asked.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// Where.
    pub points: &'a [Point],
    /// A number for each, by which its sequences are turned; `None` for its place in the list. A point that keeps its number
    /// gets the same bits, whoever is asked beside it.
    pub numbers: Option<&'a [u32]>,
    /// Whether all are known to stand in the open, as what a camera sees does: none is looked at for being inside matter.
    pub in_the_open: bool,
}

impl<'a> Asked<'a> {
    /// Points that may lie anywhere, numbered by their place in the list.
    pub fn all(points: &'a [Point]) -> Self {
        Self { points, numbers: None, in_the_open: false }
    }

    /// The number of the point at a place in the list.
    pub fn number(&self, at: usize) -> u64 {
        self.numbers.and_then(|numbers| numbers.get(at)).map_or(at as u64, |&number| u64::from(number))
    }
}

/// What each point receives of a map's sun and sky, in their order. `north_rad` is the direction of true north, clockwise
/// from the scene's +Y.
///
/// # Errors
/// [`Cancelled`].
pub fn cast(
    rays: &Rays,
    points: &[Point],
    map: &ExposureMap,
    north_rad: f64,
    casting: Casting,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Exposure>, Cancelled> {
    cast_at(rays, Asked::all(points), map, north_rad, casting, progress, cancel)
}

/// As [`cast`], for points with numbers of their own, or known to stand in the open.
///
/// # Errors
/// [`Cancelled`].
pub fn cast_at(
    rays: &Rays,
    asked: Asked,
    map: &ExposureMap,
    north_rad: f64,
    casting: Casting,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Exposure>, Cancelled> {
    progress.begin("rays", asked.points.len() as u64);
    let suns = Suns::new(map, north_rad);
    let sky = Sky { map, north_rad };
    let exposures: Result<Vec<Exposure>, Cancelled> = asked
        .points
        .par_iter()
        .enumerate()
        .map(|(at, point)| {
            cancel.check()?;
            let from_m = stands_at(rays, point);
            let exposure = if !asked.in_the_open && is_inside(rays, from_m) {
                Exposure::none(Status::InSolid)
            } else {
                at_point(rays, from_m, point.normal, &suns, &sky, casting, asked.number(at))
            };
            progress.advance(1);
            Ok(exposure)
        })
        .collect();
    progress.end();
    exposures
}

/// Where the rays of a point begin, metres: just off its surface.
pub(super) fn stands_at(rays: &Rays, point: &Point) -> Vec3 {
    rays.off_surface(point.position_m, point.normal)
}

/// The sky of a map, by directions of the scene.
pub(super) struct Sky<'a> {
    /// The period's energies.
    pub(super) map: &'a ExposureMap,
    /// Direction of true north, clockwise from the scene's +Y.
    pub(super) north_rad: f64,
}

impl Sky<'_> {
    /// The period's energy from a direction, kWh/m2/sr; 0 from below the horizon.
    pub(super) fn radiance_kwh_m2_sr(&self, direction: DVec3) -> f64 {
        if direction.z <= 0.0 {
            return 0.0;
        }
        let (azimuth_rad, elevation_rad) = azimuth_elevation_rad(direction);
        let [column, row] = self.map.texel(azimuth_rad - self.north_rad, elevation_rad);
        let energy = self.map.diffuse_kwh_m2.get(row * self.map.size[0] + column);
        energy.map_or(0.0, |&energy| f64::from(energy) / self.map.solid_angle_sr(row))
    }
}

fn at_point(
    rays: &Rays,
    from_m: Vec3,
    normal: Option<Vec3>,
    suns: &Suns,
    sky: &Sky,
    casting: Casting,
    number: u64,
) -> Exposure {
    let mut exposure = Exposure::none(Status::Dark);
    let turn = sequence::offset(casting.seed, BEAM_OFFSETS + number)[0];
    let beam = beam_at(rays, from_m, normal, suns, casting.sun_rays, turn);
    (exposure.beam_kwh_m2, exposure.sun_h) = (beam.energy_kwh_m2, beam.sun_h);

    // One sequence over the sky, dealt out to the blocks in turn: what the sky brings, and how much of it is seen.
    let each = casting.sky_rays.div_ceil(BLOCKS).max(1);
    let mut blocks = [[0.0; 2]; BLOCKS as usize];
    for (index, direction) in sky_directions(normal, casting, number).enumerate() {
        if direction.z > 0.0 {
            let passes = f64::from(rays.from_afar(from_m, direction));
            let block = &mut blocks[index % BLOCKS as usize];
            block[0] += passes * sky.radiance_kwh_m2_sr(direction.as_dvec3());
            block[1] += passes;
        }
    }
    // By the density of the directions: cos / pi, or 1 / (2 pi) over the upper half.
    let solid_angle = if normal.is_some() { PI } else { 2.0 * PI };
    let blocks = blocks.map(|[energy, seen]| [solid_angle * energy / f64::from(each), seen / f64::from(each)]);
    let mean = |part: usize| blocks.iter().map(|block| block[part]).sum::<f64>() / f64::from(BLOCKS);
    (exposure.sky_kwh_m2, exposure.svf) = (mean(0), mean(1));
    let spread: f64 = blocks.iter().map(|block| (block[0] - exposure.sky_kwh_m2).powi(2)).sum();
    let of_sky = (spread / f64::from(BLOCKS * (BLOCKS - 1))).sqrt();
    exposure.error_kwh_m2 = of_sky.hypot(beam.error_kwh_m2);
    if exposure.total_kwh_m2() > 0.0 {
        exposure.status = Status::Ok;
    }
    exposure
}

/// The directions in which a point of that number looks for the sky; those below the horizon are not asked.
pub(super) fn sky_directions(normal: Option<Vec3>, casting: Casting, number: u64) -> impl Iterator<Item = Vec3> {
    let offset = sequence::offset(casting.seed, OFFSETS + number);
    (0..casting.sky_rays.div_ceil(BLOCKS).max(1) * BLOCKS).map(move |index| {
        let square = sequence::square(index, offset);
        match normal {
            Some(normal) => sequence::cosine_about(normal, square),
            None => sequence::on_sphere([square[0] / 2.0, square[1]]),
        }
    })
}

/// The directions in which a point looks for the backs of surfaces: the same for all.
pub(super) fn looks() -> impl Iterator<Item = Vec3> {
    (0..LOOKS).map(|look| sequence::spiral(look, LOOKS, [0.37, 0.71]))
}

/// What is seen in a direction by who asks whether he is inside matter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    /// The sky, or glazing before it.
    Sky,
    /// The front of a surface.
    Front,
    /// The back of one.
    Back,
    /// Nothing, below the horizon.
    Nothing,
}

/// What is seen in a direction.
pub(super) fn look(rays: &Rays, from_m: Vec3, direction: Vec3) -> Look {
    if direction.z > 0.0 && rays.from_afar(from_m, direction) > 0.0 {
        return Look::Sky;
    }
    match rays.closest(from_m, direction, f32::INFINITY) {
        Some(hit) if hit.front => Look::Front,
        Some(_) => Look::Back,
        None => Look::Nothing,
    }
}

/// Whether a point is inside matter: most of what is seen from it are backs of surfaces; or, under the ground as a sheet, no
/// sky is seen and more backs than fronts. Glazing before the sky counts as sky.
pub(super) fn is_inside(rays: &Rays, from_m: Vec3) -> bool {
    let mut counts = [0; 4];
    looks().for_each(|direction| counts[look(rays, from_m, direction) as usize] += 1);
    let [sky, fronts, backs, _] = counts;
    // A sheet over open ground shows its back to those who stand under it, and the sky beside it.
    backs > fronts && (backs * 2 > LOOKS || sky == 0)
}
