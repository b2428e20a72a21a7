//! How much do sun and sky bring to a sensor, by casting rays at every sun of the period and over the sky?
//!
//! The beam: a shadow ray to each sun, which stands where it is and not where a texel of the map has it; or to some suns, each
//! of which stands for the same share of what all would bring if nothing were in their way ([beams](super::beams)). The
//! sky: directions by the cosine to the normal, evenly spread (R2 sequence), each bringing the map's radiance where nothing
//! is in its way; glazing weakens both. The directions are dealt out to blocks in turn; how far the blocks differ is the
//! sky's standard error, twice too large or so, for together they are spread more evenly than each.
//!
//! Cost: a ray a sun and a ray a direction, some 0.3 us each and thread, so 3 ms a sensor for all suns of a year of hours.
//! Limits: a sensor is held to be inside matter where most of what it sees are backs of surfaces, so meshes must be closed
//! or face outwards.

use super::beams::{Beam, beam_at, in_order};
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
    progress.begin("rays", points.len() as u64);
    let suns = in_order(map, north_rad);
    let sky = Sky { map, north_rad };
    let exposures: Result<Vec<Exposure>, Cancelled> = points
        .par_iter()
        .enumerate()
        .map(|(number, point)| {
            cancel.check()?;
            let exposure = at_point(rays, point, &suns, &sky, casting, number as u64);
            progress.advance(1);
            Ok(exposure)
        })
        .collect();
    progress.end();
    exposures
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

fn at_point(rays: &Rays, point: &Point, suns: &[Beam], sky: &Sky, casting: Casting, number: u64) -> Exposure {
    let from_m = point.position_m + point.normal.unwrap_or(Vec3::ZERO) * rays.epsilon_m();
    if is_inside(rays, from_m) {
        return Exposure::none(Status::InSolid);
    }
    let mut exposure = Exposure::none(Status::Dark);
    let turn = sequence::offset(casting.seed, BEAM_OFFSETS + number)[0];
    let beam = beam_at(rays, from_m, point.normal, suns, casting.sun_rays, turn);
    (exposure.beam_kwh_m2, exposure.sun_h) = (beam.energy_kwh_m2, beam.sun_h);

    // One sequence over the sky, dealt out to the blocks in turn: what the sky brings, and how much of it is seen.
    let each = casting.sky_rays.div_ceil(BLOCKS).max(1);
    let offset = sequence::offset(casting.seed, OFFSETS + number);
    let mut blocks = [[0.0; 2]; BLOCKS as usize];
    for index in 0..each * BLOCKS {
        let square = sequence::square(index, offset);
        let direction = match point.normal {
            Some(normal) => sequence::cosine_about(normal, square),
            None => sequence::on_sphere([square[0] / 2.0, square[1]]),
        };
        if direction.z > 0.0 {
            let passes = f64::from(rays.from_afar(from_m, direction));
            let block = &mut blocks[(index % BLOCKS) as usize];
            block[0] += passes * sky.radiance_kwh_m2_sr(direction.as_dvec3());
            block[1] += passes;
        }
    }
    // By the density of the directions: cos / pi, or 1 / (2 pi) over the upper half.
    let solid_angle = if point.normal.is_some() { PI } else { 2.0 * PI };
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

/// Whether most of what is seen from a point are backs of surfaces.
fn is_inside(rays: &Rays, from_m: Vec3) -> bool {
    let looks =
        (0..LOOKS).filter_map(|look| rays.closest(from_m, sequence::spiral(look, LOOKS, [0.37, 0.71]), f32::INFINITY));
    let (backs, fronts) =
        looks.fold((0, 0), |(backs, fronts), hit| if hit.front { (backs, fronts + 1) } else { (backs + 1, fronts) });
    // A sheet over open ground shows its back to those who stand under it, and the sky beside it.
    backs > fronts && backs * 2 > LOOKS
}
