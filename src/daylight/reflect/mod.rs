//! What do surfaces reflect of sun and sky, outdoors and in rooms?
//!
//! [Sun and sky](skylight) [fall](landing) on the patches of the network of the scene's void
//! ([`flow::network`](crate::flow::network)), out in the street and, through windows and doors, in rooms; the network carries
//! what they reflect, any number of times, through every neck; what leaves through the [open](openings) sides of the box around
//! the mesh is gone. A sensor gathers it by rays over its sphere and through the necks of its room.
//!
//! Limits: those of the network; walls are Lambertian, glazing passes light straight on, openings that the voxels close let
//! nothing reflected through. Ground beyond the mesh is black.

pub mod choose;
pub mod heuristics;
pub mod landing;
pub mod openings;
pub mod skylight;

use super::cast::{Casting, stands_at};
use super::{Exposure, Point};
use crate::flow::network::gather::{Arriving, Gathered, Place, gathered, necks_of, sights};
use crate::flow::network::portals::Portal;
use crate::flow::network::{Gather, Grounds, Network, Quality};
use crate::flow::sequence;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Settings, Status};
use crate::model::Model;
use crate::rays::Rays;
use landing::Falling;
use openings::is_open;
use rayon::prelude::*;
use skylight::{Asked, Asking, COLUMNS, Skylight};

/// Offsets of the sensors' sequences start here.
const SENSOR_OFFSETS: u64 = 1 << 50;

/// What surfaces reflect to a point, and what only rays through necks tell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reflected {
    /// Of the sun's beams, kWh/m2.
    pub of_beam_kwh_m2: f64,
    /// Of the sky's light, kWh/m2.
    pub of_sky_kwh_m2: f64,
    /// Standard error of both together, kWh/m2.
    pub error_kwh_m2: f64,
    /// Under the overcast sky of the CIE, what comes straight and what is reflected, as a share of what that sky brings to
    /// open ground: the daylight factor.
    pub daylight_factor: f64,
    /// What comes straight from the sky, with its standard error, kWh/m2, for a point in a room: by rays through its necks.
    pub sky_through_necks: Option<(f64, f64)>,
}

impl Reflected {
    /// Of sun and sky, kWh/m2.
    pub fn all_kwh_m2(&self) -> f64 {
        self.of_beam_kwh_m2 + self.of_sky_kwh_m2
    }
}

/// What surfaces reflect to each point of the light of sun and sky, by the network of a model. A point needs no void: in a
/// crevice that the voxels close it gathers what it sees.
///
/// Costs the network, some tens of milliseconds to a second, and some ten thousand rays a point.
///
/// # Errors
/// [`Cancelled`].
pub fn by_network(
    model: &Model,
    points: &[Point],
    light: &Skylight,
    quality: &Quality,
    casting: Casting,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Reflected>, Cancelled> {
    let seed = casting.seed;
    let open = openings::open_cells(model);
    let falling = Falling { light, open: &open, seed };
    let settings = Settings { seed, shares: true, ..Settings::default() };
    let land = |grounds: &Grounds| falling.on_patches(grounds, cancel);
    progress.begin("zones", 0);
    let grounds = Grounds::new(model, quality, seed).filled();
    progress.end();
    cancel.check()?;
    let (network, _) = Network::lit_by(grounds, quality, &settings, &land, progress, cancel)?;

    progress.begin("gather", points.len() as u64);
    let rays = quality.gather.unwrap_or(GATHER);
    let at_point = |(number, point): (usize, &Point)| {
        cancel.check()?;
        progress.advance(1);
        Ok(reflected(&network, &falling, rays, point, casting, number))
    };
    let found = points.par_iter().enumerate().map(at_point).collect();
    progress.end();
    found
}

/// Every place that a sensor sees is asked for what lands on it: edges of shadows are sharp, and patches of towns large.
const LARGE_FROM_RAYS: usize = 1;

/// To each neck of its room a point sends this share of its directions of the sky.
const NECK_SHARE: u32 = 2;

/// Rays of a point where the quality is for reading zones.
const GATHER: Gather = Gather { rays: 768, neck_rays: 192 };

fn reflected(
    network: &Network,
    falling: &Falling,
    rays: Gather,
    point: &Point,
    casting: Casting,
    number: usize,
) -> Reflected {
    let offset = sequence::offset(casting.seed, SENSOR_OFFSETS + number as u64);
    let grounds = &network.grounds;
    let model = grounds.model;
    let from_m = stands_at(&model.rays, point);
    let cell = model.place(point.position_m, point.normal).ok();
    let cell = cell.and_then(|node| model.skeleton.graph.node_weight(node)).map_or(u32::MAX, |node| node.cell);
    let in_the_open = is_open(falling.open, cell);
    // From the street windows are dark, and no rays are aimed at them.
    let aimed = if in_the_open { u32::MAX } else { cell };
    let sights = sights(network, &rays, from_m, point.normal, aimed, offset);
    let sharpen = |place: &Place, arriving: Arriving| falling.sharpen(network, place, arriving);
    let begin = Gathered { columns_w_m2: vec![0.0; COLUMNS], ..Gathered::default() };
    let gathered = gathered(network, &sights, point.normal, &sharpen, LARGE_FROM_RAYS, begin);
    let column = |number: usize| gathered.columns_w_m2.get(number).copied().unwrap_or(0.0);

    let necks = if in_the_open { Vec::new() } else { necks_of(&grounds.portals, cell, from_m) };
    let straight = straight(&model.rays, falling.light, point, &necks, casting, number);
    Reflected {
        of_beam_kwh_m2: column(0),
        of_sky_kwh_m2: column(1),
        error_kwh_m2: gathered.error_w_m2,
        daylight_factor: straight.daylight_factor + column(2) / falling.light.overcast_kwh_m2,
        ..straight
    }
}

/// Nothing reflected, for surfaces that are black: what comes straight from the overcast sky alone, so that daylight factors
/// are known.
///
/// # Errors
/// [`Cancelled`].
pub fn by_nothing(
    rays: &Rays,
    points: &[Point],
    light: &Skylight,
    casting: Casting,
    cancel: &Cancel,
) -> Result<Vec<Reflected>, Cancelled> {
    let at_point = |(number, point)| {
        cancel.check()?;
        Ok(straight(rays, light, point, &[], casting, number))
    };
    points.par_iter().enumerate().map(at_point).collect()
}

/// What comes straight from the overcast sky, and through necks from the period's.
fn straight(
    rays: &Rays,
    light: &Skylight,
    point: &Point,
    necks: &[&Portal],
    casting: Casting,
    number: usize,
) -> Reflected {
    let from_m = stands_at(rays, point);
    let offset = sequence::offset(casting.seed, SENSOR_OFFSETS + number as u64);
    let asked = Asked { from_m, normal: point.normal, necks, offset };
    let asking = Asking { suns: 0, sky_rays: casting.sky_rays, neck_rays: casting.sky_rays / NECK_SHARE };
    let [[sky, overcast], [error, _]] = light.skies_at(rays, &asked, asking);
    Reflected {
        daylight_factor: overcast / light.overcast_kwh_m2,
        sky_through_necks: (!necks.is_empty()).then_some((sky, error)),
        ..Reflected::default()
    }
}

/// Adds what is reflected to what comes straight from sun and sky; points inside matter stay without light.
pub fn add(exposures: &mut [Exposure], reflected: &[Reflected]) {
    for (exposure, reflected) in exposures.iter_mut().zip(reflected) {
        if exposure.status == Status::InSolid {
            continue;
        }
        exposure.reflected_kwh_m2 = reflected.all_kwh_m2();
        if let Some((sky_kwh_m2, error_kwh_m2)) = reflected.sky_through_necks {
            exposure.sky_kwh_m2 = sky_kwh_m2;
            exposure.error_kwh_m2 = exposure.error_kwh_m2.hypot(error_kwh_m2);
        }
        exposure.error_kwh_m2 = exposure.error_kwh_m2.hypot(reflected.error_kwh_m2);
        if exposure.total_kwh_m2() > 0.0 {
            exposure.status = Status::Ok;
        }
    }
}
