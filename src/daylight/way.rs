//! By which way is exposure found?
//!
//! From the cheapest to the dearest: the share of the sky that is seen times what an open plane would receive; maps of heights,
//! coarse or fine ([scales]); for a camera's pixels both scales; rays, some or all ([cast](super::cast)). A way
//! that needs maps makes them once ([`Way::prepare`]) and is then asked any number of times.

use super::camera::Buffers;
use super::cast::{Asked, Casting, cast_at, is_inside, stands_at};
use super::scales::pixels::taps::Taps;
use super::scales::pixels::{Combination, Look, Part, PixelSums, Surfaces, TURNS, see};
use super::scales::sight::Overhangs;
use super::scales::sums::SkySums;
use super::scales::zenith::Zenith;
use super::scales::{self, Scan, in_the_open};
use super::{Exposure, Point};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::Status;
use crate::rays::Rays;
use crate::scene::Scene;
use crate::sky::map::ExposureMap;
use rayon::prelude::*;

/// What all ways are asked about.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What rays hit of it.
    pub rays: &'a Rays,
    /// The period's sun and sky.
    pub map: &'a ExposureMap,
    /// Direction of true north, clockwise from the scene's +Y.
    pub north_rad: f64,
    /// Seed of all sequences.
    pub seed: u64,
}

/// How fine maps are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fineness {
    /// Texels along the longer side.
    pub texels: usize,
    /// Directions of the horizon.
    pub directions: usize,
    /// Samples along each.
    pub samples: usize,
    /// What is made of overhangs.
    pub overhangs: Overhangs,
}

/// A way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Way {
    /// What an open plane of the same tilt receives, times the share of its sky that is seen: beam and sky alike.
    Isotropic,
    /// Maps of heights and of the sky.
    Maps(Fineness),
    /// Both scales at the pixels of a camera: maps, and the camera's own buffers; so many directions, and samples of each
    /// scale.
    View {
        /// Directions of the horizon, and of the picture.
        directions: usize,
        /// Samples of each scale along each.
        samples: usize,
    },
    /// Rays.
    Rays(Casting),
}

/// The heights by which the cheapest way sees the sky.
const COARSE: Fineness = Fineness { texels: 512, directions: 16, samples: 16, overhangs: Overhangs::Opening };

/// How far the fine scale of a view reaches, metres: sills, balconies, porches.
pub const FINE_REACH_M: f32 = 3.0;

/// Texels of the heights under a view.
const VIEW_TEXELS: usize = 1024;

/// A point that sees less of the sky than this by maps is looked at by rays for being inside matter.
const DARK_SVF: f64 = 0.02;

impl Way {
    /// The ways for points in general, the cheapest of each kind first.
    pub const fn for_points(seed: u64) -> [Self; 6] {
        [
            Self::Isotropic,
            Self::Maps(Fineness { texels: 1024, directions: 32, samples: 32, overhangs: Overhangs::Opening }),
            Self::Maps(Fineness { texels: 2048, directions: 64, samples: 64, overhangs: Overhangs::Peeled }),
            Self::Rays(Casting { sun_rays: Some(256), sky_rays: 256, seed }),
            Self::Rays(Casting { sun_rays: Some(1024), sky_rays: 1024, seed }),
            Self::Rays(Casting { sun_rays: None, sky_rays: 4096, seed }),
        ]
    }

    /// The ways for the pixels of a camera.
    pub const fn for_pixels(seed: u64) -> [Self; 6] {
        let [.., some, many, all] = Self::for_points(seed);
        let few = Self::Rays(Casting { sun_rays: Some(32), sky_rays: 32, seed });
        let [coarse, fine] = [Self::View { directions: 8, samples: 8 }, Self::View { directions: 16, samples: 16 }];
        [coarse, fine, few, some, many, all]
    }

    /// Its name on the command line and in reports.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Isotropic => "isotropic",
            Self::Maps(_) => "maps",
            Self::View { .. } => "view",
            Self::Rays(_) => "rays",
        }
    }

    /// All it is, in words.
    pub fn words(&self) -> String {
        match self {
            Self::Isotropic => "an open plane's exposure times the share of its sky that is seen".into(),
            Self::Maps(Fineness { texels, directions, samples, overhangs }) => {
                let beneath = match overhangs {
                    Overhangs::Ignored => "as a height field",
                    Overhangs::Opening => "with opening angles",
                    Overhangs::Peeled => "peeled",
                };
                format!("maps of {texels} texels {beneath}, {directions} directions of {samples} samples")
            }
            Self::View { directions, samples } => {
                format!("maps and the camera's buffers, {directions} directions of {samples} + {samples} samples")
            }
            Self::Rays(casting) => {
                let suns = casting.sun_rays.map_or("every sun".into(), |count| format!("{count} suns"));
                format!("rays to {suns} and {} directions of the sky", casting.sky_rays)
            }
        }
    }

    /// About how long it takes for so many points on two threads, seconds: what it makes beforehand, and each point
    /// (`cargo bench --bench scales`, `--bench exposure`). To bring ways in order, not to promise.
    pub fn cost_s(&self, points: usize) -> f64 {
        let points = points as f64;
        match self {
            Self::Isotropic => 0.03 + points * 2e-6,
            Self::Maps(Fineness { texels, directions, samples, overhangs }) => {
                let is_peeled = *overhangs == Overhangs::Peeled;
                let texel_s = if is_peeled { 1e-7 } else { 1e-8 };
                let sample_s = if is_peeled { 8e-9 } else { 4e-9 };
                0.03 + (texels * texels) as f64 * texel_s + points * (directions * samples) as f64 * sample_s
            }
            Self::View { directions, samples } => 0.1 + points * (directions * samples) as f64 * 3e-9,
            Self::Rays(Casting { sun_rays, sky_rays, .. }) => {
                points * (f64::from(sun_rays.unwrap_or(4600) / 2) + f64::from(*sky_rays)) * 2e-7
            }
        }
    }

    /// Makes what the way needs.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn prepare(self, ground: &Ground, cancel: &Cancel) -> Result<Prepared, Cancelled> {
        /// Turns and directions that are told apart in all.
        const SECTORS: usize = 128;
        let maps = |fineness: Fineness| {
            let peeled = fineness.overhangs == Overhangs::Peeled;
            let zenith = Zenith::new(ground.scene, fineness.texels, peeled, cancel)?;
            let turns = (SECTORS / fineness.directions).max(1);
            let sums = SkySums::new(ground.map, ground.north_rad, fineness.directions, turns);
            Ok((zenith, sums))
        };
        let made = match self {
            Self::Isotropic => maps(COARSE).map(|(zenith, sums)| Made::Maps(zenith, sums, COARSE))?,
            Self::Maps(fineness) => maps(fineness).map(|(zenith, sums)| Made::Maps(zenith, sums, fineness))?,
            Self::View { directions, samples } => {
                let look = Look {
                    samples,
                    reach_m: None,
                    opening: true,
                    combination: Combination::Intersected,
                    fine_samples: samples,
                    fine_reach_m: FINE_REACH_M,
                    smooth: true,
                };
                let zenith = Zenith::new(ground.scene, VIEW_TEXELS, false, cancel)?;
                let sums = SkySums::new(ground.map, ground.north_rad, directions, TURNS);
                Made::View(Taps::new(&zenith, &sums, &look), sums, look)
            }
            Self::Rays(_) => Made::Nothing,
        };
        Ok(Prepared { way: self, made })
    }
}

/// A way with what it needs.
#[derive(Debug)]
pub struct Prepared {
    /// The way.
    pub way: Way,
    made: Made,
}

#[derive(Debug)]
enum Made {
    Nothing,
    Maps(Zenith, SkySums, Fineness),
    View(Taps, SkySums, Look),
}

impl Prepared {
    /// What each point receives, in their order. A view is asked with the `buffers` of its camera, all of whose pixels it works
    /// out, whichever are asked for; their numbers are those of the pixels.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn ask(
        &self,
        ground: &Ground,
        asked: Asked,
        buffers: Option<&Buffers>,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Vec<Exposure>, Cancelled> {
        let mut exposures = match (&self.made, self.way, buffers) {
            (Made::Maps(zenith, sums, fineness), ..) => {
                let scan =
                    Scan { samples: fineness.samples, reach_m: None, overhangs: fineness.overhangs, seed: ground.seed };
                scales::expose(zenith, sums, asked, &scan, progress, cancel)?
            }
            (Made::View(taps, sums, look), _, Some(buffers)) => {
                return of_view(taps, sums, look, buffers, asked, progress, cancel);
            }
            (_, way, _) => {
                let casting = if let Way::Rays(casting) = way { casting } else { Casting::default() };
                return cast_at(ground.rays, asked, ground.map, ground.north_rad, casting, progress, cancel);
            }
        };
        if let (Way::Isotropic, Made::Maps(_, sums, _)) = (self.way, &self.made) {
            let points = exposures.par_iter_mut().zip(asked.points);
            points.for_each(|(exposure, point)| *exposure = isotropic(sums, point, exposure));
        }
        if !asked.in_the_open {
            let dark = exposures.par_iter_mut().zip(asked.points).filter(|(exposure, _)| exposure.svf < DARK_SVF);
            dark.filter(|(_, point)| is_inside(ground.rays, stands_at(ground.rays, point)))
                .for_each(|(exposure, _)| *exposure = Exposure::none(Status::InSolid));
        }
        Ok(exposures)
    }
}

/// An open plane's exposure by the share of its sky that is seen.
fn isotropic(sums: &SkySums, point: &Point, seen: &Exposure) -> Exposure {
    let open = in_the_open(sums, point.normal);
    let share = if open.svf > 0.0 { (seen.svf / open.svf).min(1.0) } else { 0.0 };
    Exposure {
        beam_kwh_m2: share * open.beam_kwh_m2,
        sky_kwh_m2: share * open.sky_kwh_m2,
        sun_h: share * open.sun_h,
        error_kwh_m2: 0.0,
        ..*seen
    }
}

/// Pixels by both scales: once for the sky and once for the suns.
fn of_view(
    taps: &Taps,
    sums: &SkySums,
    look: &Look,
    buffers: &Buffers,
    asked: Asked,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Exposure>, Cancelled> {
    progress.begin("view", 2);
    let surfaces = Surfaces::new(buffers);
    let of_part = |part: Part| {
        let Some(sums) = PixelSums::new(sums, part) else { return Ok(Vec::new()) };
        let seen = see(taps, &sums, &surfaces, look, cancel);
        progress.advance(1);
        seen
    };
    let (sky, beam) = (of_part(Part::Sky)?, of_part(Part::Beam)?);
    progress.end();
    let exposure = |at: usize| {
        let pixel = asked.number(at) as usize;
        let [sky, beam] = [&sky, &beam].map(|seen| seen.get(pixel).copied().unwrap_or_default());
        let status = if sky.total_kwh_m2 + beam.total_kwh_m2 > 0.0 { Status::Ok } else { Status::Dark };
        Exposure {
            sky_kwh_m2: f64::from(sky.total_kwh_m2),
            beam_kwh_m2: f64::from(beam.total_kwh_m2),
            svf: f64::from(sky.svf).clamp(0.0, 1.0),
            sun_h: f64::from(beam.sun_h),
            ..Exposure::none(status)
        }
    };
    Ok((0..asked.points.len()).map(exposure).collect())
}
