//! What does a sensor see of the patches?
//!
//! Rays evenly over its sphere (with a normal: half of them by the cosine, half evenly over its hemisphere) and over the
//! necks of its room, together weighed by the sum of their densities. A wall shines by its own reflectance times the light
//! that arrives at its patch; where the sensor sees a patch with many rays, the light that lands straight on it is asked for
//! at the very point, by a shadow ray, for there a patch is large against what the sensor can tell apart; where it sees it
//! with few, its mean is the better answer.

use super::patches::Start;
use super::portals::Portal;
use super::walk::{End, walk};
use super::{Gather, Network};
use crate::flow::direct::{Direct, direct};
use crate::flow::sequence;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Reading, Settings, Status};
use crate::model::Probe;
use glam::Vec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Shadow rays from a sensor to a light that has a body.
const DIRECT_RAYS: u32 = 32;

/// A patch that this many rays meet is large in the sensor's view.
const LARGE_FROM_RAYS: usize = 6;

/// A light that brings less than this share of a patch's irradiance is not asked for at points of it.
const LEAST_SHARE: f64 = 0.02;

/// Most necks that rays are aimed at, those that show largest.
const MOST_NECKS: usize = 8;

/// Offsets of the sensors' sequences start here.
const SENSOR_OFFSETS: u64 = 1 << 43;

/// The field at the probes.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn gather(
    network: &Network,
    rays: &Gather,
    probes: &[Probe],
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Field, Cancelled> {
    progress.begin("gather", probes.len() as u64);
    let answers: Result<Vec<(Reading, Vec<f64>)>, Cancelled> = probes
        .par_iter()
        .enumerate()
        .map(|(number, probe)| {
            cancel.check()?;
            progress.advance(1);
            Ok(at_probe(network, rays, probe, sequence::offset(settings.seed, SENSOR_OFFSETS + number as u64)))
        })
        .collect();
    progress.end();
    Ok(network.field(answers?, settings))
}

/// A ray from a sensor and what it meets.
pub struct Sight {
    /// What it meets.
    pub patch: u32,
    /// Where on it.
    pub at: Start,
    /// The ray's unit direction.
    pub direction: Vec3,
    /// Share that comes through glazing, over pi and the density of rays: radiosity to irradiance.
    pub weight: f64,
    /// Whether it is one of every second ray.
    pub odd: bool,
}

/// What a sensor sees of the patches.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Gathered {
    /// All columns of light together.
    pub all: Direct,
    /// The part of each column in the value, W/m2; of what is reflected again and again where the network has it by column.
    pub columns_w_m2: Vec<f64>,
    /// Standard deviation of the value, by the lines and by the rays, W/m2.
    pub error_w_m2: f64,
}

/// A place of a patch that a sensor sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The patch's number.
    pub patch: u32,
    /// Where on it.
    pub at: Start,
    /// The mean irradiance of the patch by all light, W/m2.
    pub all_w_m2: f64,
}

/// What arrives there, W/m2.
#[derive(Debug)]
pub struct Arriving<'a> {
    /// Straight, by column.
    pub landing_w_m2: &'a mut [f64],
    /// After reflections; by column, or all together where the network has it so.
    pub reflected_w_m2: &'a mut [f64],
}

/// Puts what arrives at the very place in the stead of the patch's means, where that matters.
pub type Sharpen<'a> = dyn Fn(&Place, Arriving) + Sync + 'a;

fn at_probe(network: &Network, rays: &Gather, probe: &Probe, offset: [f64; 2]) -> (Reading, Vec<f64>) {
    let model = network.grounds.model;
    let Ok(node) = probe.place else {
        let row = vec![0.0; model.shining.len()];
        return (Reading::none(probe.place.err().unwrap_or(Status::Unreached)), row);
    };
    let from_m = probe.position_m + probe.normal.unwrap_or(Vec3::ZERO) * model.rays.epsilon_m();
    let (straight, row) = network.straight(probe, DIRECT_RAYS, offset);
    let cell = model.skeleton.graph.node_weight(node).map_or(u32::MAX, |node| node.cell);
    let sights = sights(network, rays, from_m, probe.normal, cell, offset);
    let sharpen = |&Place { at, all_w_m2, .. }: &Place, arriving: Arriving| {
        for (emitter, landing_w_m2) in arriving.landing_w_m2.iter_mut().enumerate() {
            if *landing_w_m2 > LEAST_SHARE * all_w_m2 {
                let lifted_m = at.position_m + at.normal * model.rays.epsilon_m();
                *landing_w_m2 = direct(model, lifted_m, Some(at.normal), emitter, 1, offset).value_w_m2;
            }
        }
    };
    let begin = Gathered { all: straight, columns_w_m2: row, error_w_m2: 0.0 };
    let gathered = gathered(network, &sights, probe.normal, &sharpen, LARGE_FROM_RAYS, begin);
    let Direct { value_w_m2, flux_w_m2 } = gathered.all;
    let status = network.status(node, value_w_m2);
    (Reading { value_w_m2, flux_w_m2, error_w_m2: Some(gathered.error_w_m2), status }, gathered.columns_w_m2)
}

/// What patches send along sights, on top of what a sensor with that normal has to `begin` with; a patch that at least
/// `large_from_rays` of them meet is `sharpen`ed.
pub fn gathered(
    network: &Network,
    sights: &[Sight],
    normal: Option<Vec3>,
    sharpen: &Sharpen,
    large_from_rays: usize,
    begin: Gathered,
) -> Gathered {
    let Gathered { all: Direct { mut value_w_m2, mut flux_w_m2 }, columns_w_m2: mut row, .. } = begin;
    let columns = network.landings.len();
    let mut met: Vec<u32> = sights.iter().map(|sight| sight.patch).collect();
    met.sort_unstable();
    let rays_to =
        |patch: u32| met.partition_point(|&other| other <= patch) - met.partition_point(|&other| other < patch);

    let mut halves = [0.0; 2];
    let mut variants = [0.0; 3];
    let (mut landing_w_m2, mut reflected_w_m2) = (vec![0.0; columns], Vec::with_capacity(columns));
    for sight in sights.iter().filter(|sight| sight.at.answer.reflects > 0.0) {
        let patch = sight.patch as usize;
        let reflects = f64::from(sight.at.answer.reflects);
        let cosine = normal.map_or(1.0, |normal| f64::from(normal.dot(sight.direction).max(0.0)));
        let weight = reflects * sight.weight;
        reflected_w_m2.clear();
        reflected_w_m2.extend(network.reflected_w_m2.iter().map(|column| column[patch]));
        let of_patch_w_m2: f64 = reflected_w_m2.iter().sum();
        let area_m2 = network.grounds.patches.list[patch].area_m2;
        for (landing_w_m2, landing) in landing_w_m2.iter_mut().zip(&network.landings) {
            *landing_w_m2 = landing.flux_w[patch] / area_m2;
        }
        if rays_to(sight.patch) >= large_from_rays {
            let all_w_m2: f64 =
                of_patch_w_m2 + network.landings.iter().map(|landing| landing.flux_w[patch]).sum::<f64>() / area_m2;
            let place = Place { patch: sight.patch, at: sight.at, all_w_m2 };
            let arriving = Arriving { landing_w_m2: &mut landing_w_m2, reflected_w_m2: &mut reflected_w_m2 };
            sharpen(&place, arriving);
        }

        let mut arriving_w_m2 = 0.0;
        for (column, landing_w_m2) in landing_w_m2.iter().enumerate() {
            let reflected_w_m2 = if reflected_w_m2.len() == columns { reflected_w_m2[column] } else { 0.0 };
            row[column] += weight * cosine * (landing_w_m2 + reflected_w_m2);
            arriving_w_m2 += landing_w_m2;
        }
        let radiosity_w_m2 = arriving_w_m2 + reflected_w_m2.iter().sum::<f64>();
        value_w_m2 += weight * cosine * radiosity_w_m2;
        flux_w_m2 += weight * radiosity_w_m2 * sight.direction.as_dvec3();
        halves[usize::from(sight.odd)] += 2.0 * weight * cosine * radiosity_w_m2;
        for (sum, variant) in variants.iter_mut().zip(&network.variants_w_m2) {
            *sum += weight * cosine * (variant[patch] - of_patch_w_m2);
        }
    }
    let noise = 0.5 * (halves[0] - halves[1]);
    let lines = 0.5 * (variants[0] - variants[1]);
    let error_w_m2 = noise.hypot(lines).hypot(0.5 * variants[2]);
    Gathered { all: Direct { value_w_m2, flux_w_m2 }, columns_w_m2: row, error_w_m2 }
}

/// The rays of a sensor in that cell that stands clear of its surface, with what they meet.
pub fn sights(
    network: &Network,
    rays: &Gather,
    from_m: Vec3,
    normal: Option<Vec3>,
    cell: u32,
    offset: [f64; 2],
) -> Vec<Sight> {
    let portals = necks_of(&network.grounds.portals, cell, from_m);
    let count = rays.rays;
    let over_all = (0..count).map(|ray| match normal {
        None => sequence::spiral(ray, count, offset),
        Some(normal) if ray % 2 == 0 => sequence::cosine_about(normal, sequence::square(ray, offset)),
        Some(normal) => {
            let [height, turn] = sequence::square(ray, offset);
            // The cosine's square is uniform about the cosine's own draw.
            sequence::cosine_about(normal, [1.0 - height * height, turn])
        }
    });
    let to_necks = portals.iter().flat_map(|portal| {
        let toward = move |ray| (portal.point_m(ray, rays.neck_rays, offset) - from_m).normalize_or_zero();
        (0..rays.neck_rays).map(toward)
    });
    let density_per_sr = |direction: Vec3| {
        let over_all = match normal {
            None => f64::from(count) / (4.0 * PI),
            Some(normal) => {
                f64::from(count) / 2.0 * (f64::from(normal.dot(direction)).max(0.0) / PI + 1.0 / (2.0 * PI))
            }
        };
        let to_necks = portals.iter().filter_map(|portal| portal.density_per_sr(from_m, direction, rays.neck_rays));
        over_all + to_necks.sum::<f64>()
    };

    let mut sights = Vec::with_capacity(count as usize);
    let seen = |direction: &Vec3| normal.is_none_or(|normal| normal.dot(*direction) > 0.0) && *direction != Vec3::ZERO;
    for (number, direction) in over_all.chain(to_necks).filter(seen).enumerate() {
        let Some(walk) = walk(&network.grounds, from_m, direction) else { continue };
        let mut weight = 1.0 / (PI * density_per_sr(direction));
        let odd = number % 2 == 1;
        for pane in &walk.panes {
            sights.push(Sight { patch: pane.sides[0], at: pane.at, direction, weight, odd });
            weight *= f64::from(pane.at.answer.passes);
        }
        if let End::Patch(patch) = walk.end {
            sights.push(Sight { patch, at: walk.at, direction, weight, odd });
        }
    }
    sights
}

/// The necks of a cell that rays from a point are aimed at: all, or where they are many those that show largest.
pub fn necks_of(portals: &[Portal], cell: u32, from_m: Vec3) -> Vec<&Portal> {
    let mut portals: Vec<&Portal> = portals.iter().filter(|portal| portal.cells.contains(&cell)).collect();
    if portals.len() > MOST_NECKS {
        let shows = |portal: &Portal| portal.area_m2 / f64::from(portal.centre_m.distance_squared(from_m));
        portals.sort_by(|a, b| shows(b).total_cmp(&shows(a)));
        portals.truncate(MOST_NECKS);
    }
    portals
}
