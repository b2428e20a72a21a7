//! What flows through the doorways and windows?
//!
//! Reflected light by the lines of the network that cross: these sample area times solid angle times cosine, so what one end
//! sends through is its radiosity times the line's weight, and the weights of all that cross add up to the neck's area. The
//! mean over them times the area is the flux, exact where light is even whatever the lines. Light straight from emitters by
//! shadow rays from points spread over the neck.
//!
//! Limits: where most lines through a neck end in crevices that the voxels close, the others speak for them.

use super::Opening;
use crate::flow::direct::direct;
use crate::flow::network::Network;
use crate::flow::network::lines::Line;
use crate::flow::network::portals::Portal;
use crate::flow::network::read::seen_from;
use crate::flow::sequence;
use crate::skeleton::Neck;
use rayon::prelude::*;

/// Shadow rays from a neck, shared by the lights; and the least and most points that they start from.
const SHADOW_RAYS: usize = 1024;
const LEAST_POINTS: u32 = 8;
const MOST_POINTS: u32 = 64;

/// Offsets of the sequences that place points in necks start here.
const POINT_OFFSETS: u64 = 1 << 48;

/// The necks of the skeleton in their order, with the flux through each; one without an area has none. `radiosity_w_m2` is the
/// patches' own.
pub fn openings(network: &Network, lines: &[Line], radiosity_w_m2: &[f64], seed: u64) -> Vec<Opening> {
    let necks = &network.grounds.model.skeleton.necks;
    let opening = |(number, neck): (usize, &Neck)| {
        let portal = Portal::new(neck);
        let flux_w = portal.as_ref().map_or([0.0; 2], |portal| {
            let reflected_w = reflected_w(portal, lines, radiosity_w_m2);
            let straight_w = straight_w(network, portal, sequence::offset(seed, POINT_OFFSETS + number as u64));
            [0, 1].map(|way| reflected_w[way] + straight_w[way])
        });
        Opening {
            cells: neck.cells,
            position_m: neck.position_m,
            normal: neck.normal,
            area_m2: portal.map_or(neck.area_m2, |portal| portal.area_m2 as f32),
            outline_m: neck.outline_m.clone(),
            flux_w,
        }
    };
    necks.par_iter().enumerate().map(opening).collect()
}

/// What walls send through, along the normal and against it, W.
fn reflected_w(portal: &Portal, lines: &[Line], radiosity_w_m2: &[f64]) -> [f64; 2] {
    let (mut sums_w, mut weight_m2) = ([0.0; 2], 0.0);
    for line in lines {
        let Some(crossing) = portal.crossing(line.from_m, line.direction, line.length_m) else { continue };
        let before = |at_m: f32| at_m < crossing.distance_m;
        let panes_before = line.panes.iter().filter(|pane| before((pane.at.position_m - line.from_m).dot(line.direction)));
        let [behind, ahead] = seen_from(line, panes_before.count(), radiosity_w_m2);
        let along = line.direction.dot(portal.normal) > 0.0;
        let [forwards, back] = if along { [behind, ahead] } else { [ahead, behind] };
        sums_w[0] += line.weight_m2 * forwards;
        sums_w[1] += line.weight_m2 * back;
        weight_m2 += line.weight_m2;
    }
    sums_w.map(|sum_w| if weight_m2 > 0.0 { portal.area_m2 * sum_w / weight_m2 } else { 0.0 })
}

/// What emitters send straight through, along the normal and against it, W.
fn straight_w(network: &Network, portal: &Portal, offset: [f64; 2]) -> [f64; 2] {
    let model = network.grounds.model;
    let lamps: Vec<usize> = network.lamps().map(|lamp| lamp.emitter).collect();
    let points = ((SHADOW_RAYS / lamps.len().max(1)) as u32).clamp(LEAST_POINTS, MOST_POINTS);
    let mut sums_w_m2 = [0.0; 2];
    for point in 0..points {
        let at_m = portal.point_m(point, points, offset);
        let turned = sequence::square(point, [offset[1], offset[0]]);
        for &lamp in &lamps {
            // What flows along the normal lands on the side that looks back.
            for (sum_w_m2, normal) in sums_w_m2.iter_mut().zip([-portal.normal, portal.normal]) {
                *sum_w_m2 += direct(model, at_m, Some(normal), lamp, 1, turned).value_w_m2;
            }
        }
    }
    sums_w_m2.map(|sum_w_m2| portal.area_m2 * sum_w_m2 / f64::from(points))
}
