//! What light comes to each place, by the lines that have measured the exchange?
//!
//! A line of weight `w` (area times solid angle times cosine, over the number of lines) between walls of radiosity B brings
//! `w B` to either end, so the lines that end on a patch are samples of the light that arrives there; and a line that crosses
//! a zone brings `w l B` to it over its length `l` there. Each sample is turned to where the place itself would see what
//! shines. No ray is traced for this but those towards the lights from nodes.

use super::fit::{self, Sample};
use crate::flow::direct::direct;
use crate::flow::network::Network;
use crate::flow::network::lines::Line;
use crate::flow::network::walk::End;
use crate::flow::sequence;
use crate::light::Incident;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// What is nearer than this, in edges of a zone, stays where it was seen: turned about a place so near it would leap.
const LEAST_TURNED_ZONES: f32 = 0.25;

/// Offsets of the sequences that pick points on lines and of shadow rays start here.
const POINT_OFFSETS: u64 = 1 << 46;
const SHADOW_OFFSETS: u64 = 1 << 47;

/// A line seen from a place: where it meets what shines, and how much that brings.
#[derive(Debug, Clone, Copy)]
struct Sight {
    /// Where the line is at the place, metres.
    from_m: Vec3,
    direction: Vec3,
    distance_m: f32,
    weight: f64,
}

/// The light at every patch of the network, at that of its points nearest to its middle.
pub fn at_walls(network: &Network, lines: &[Line]) -> Vec<Incident> {
    let patches = &network.grounds.patches;
    let radiosity_w_m2 = radiosity_w_m2(network);
    let of_patch = |end: End| if let End::Patch(patch) = end { Some(patch as usize) } else { None };
    let shines = |end: End| of_patch(end).map_or(0.0, |patch| radiosity_w_m2[patch]);

    let mut sights: Vec<Vec<Sight>> = vec![Vec::new(); patches.list.len()];
    for line in lines.iter().filter(|line| line.panes.is_empty()) {
        let [first, last] = line.ends;
        let end_m = line.from_m + line.length_m * line.direction;
        let ways = [(first, last, line.from_m, line.direction), (last, first, end_m, -line.direction)];
        for (here, there, from_m, direction) in ways {
            let weight = line.weight_m2 * shines(there);
            if let Some(patch) = of_patch(here).filter(|_| weight > 0.0) {
                sights[patch].push(Sight { from_m, direction, distance_m: line.length_m, weight });
            }
        }
    }
    let incident = |(number, sights): (usize, &Vec<Sight>)| {
        let patch = &patches.list[number];
        let starts = &patches.starts[patch.starts.clone()];
        let middle_m = starts.iter().map(|start| start.position_m).sum::<Vec3>() / starts.len() as f32;
        let apart_m2 = |at_m: Vec3| at_m.distance_squared(middle_m);
        let nearest = starts.iter().min_by(|a, b| apart_m2(a.position_m).total_cmp(&apart_m2(b.position_m)));
        let (position_m, normal) = nearest.map_or((middle_m, Vec3::Z), |start| (start.position_m, start.normal));
        let reach_m = (patch.area_m2 as f32).sqrt();
        Incident {
            position_m,
            normal: Some(normal),
            lobes: fit::lobes(&turned(sights, position_m, reach_m)),
            reflected_w_m2: network.reflected_w_m2.iter().map(|column| column[number]).sum::<f64>() as f32,
            direct_w_m2: (network.landings.iter())
                .map(|landing| (landing.flux_w[number] / patch.area_m2) as f32)
                .collect(),
        }
    };
    sights.par_iter().enumerate().map(incident).collect()
}

/// The light in every zone of the void, at the middle of what its lines show of it; straight from each emitter by one ray from
/// there.
pub fn in_zones(network: &Network, lines: &[Line], seed: u64) -> Vec<Incident> {
    let grounds = &network.grounds;
    let (model, zones) = (grounds.model, &grounds.zones);
    let radiosity_w_m2 = radiosity_w_m2(network);
    let shines = |end: End| if let End::Patch(patch) = end { radiosity_w_m2[patch as usize] } else { 0.0 };

    // One place a line, anywhere on it, stands for its whole length.
    let place = |(number, line): (usize, &Line)| {
        let along_m = sequence::offset(seed, POINT_OFFSETS + number as u64)[0] as f32 * line.length_m;
        let at_m = line.from_m + along_m * line.direction;
        let node = model.skeleton.nearest.node(model.voxels.lattice.voxel_at(at_m))?;
        Some((zones.at(node, at_m), at_m, along_m))
    };
    let places: Vec<Option<(u32, Vec3, f32)>> = lines.par_iter().enumerate().map(place).collect();
    let mut crossed = vec![Crossed::default(); zones.count];
    for (line, place) in lines.iter().zip(places) {
        let Some((zone, at_m, along_m)) = place.filter(|_| line.panes.is_empty()) else { continue };
        let crossed = &mut crossed[zone as usize];
        let weight_m3 = line.weight_m2 * f64::from(line.length_m);
        crossed.track_m3 += weight_m3;
        crossed.moment += weight_m3 * at_m.as_dvec3();
        let ways = [(line.ends[0], -1.0, along_m), (line.ends[1], 1.0, line.length_m - along_m)];
        for (end, sign, distance_m) in ways {
            let weight = weight_m3 * shines(end);
            if weight > 0.0 {
                crossed.sights.push(Sight { from_m: at_m, direction: sign * line.direction, distance_m, weight });
            }
        }
    }

    let incident = |(zone, crossed): (usize, &Crossed)| {
        let track_m3 = crossed.track_m3.max(f64::MIN_POSITIVE);
        let position_m = (crossed.moment / track_m3).as_vec3();
        let straight = |emitter: usize| {
            let offset = sequence::offset(seed, SHADOW_OFFSETS + zone as u64);
            direct(model, position_m, None, emitter, 1, offset).value_w_m2 as f32
        };
        let is_seen = crossed.track_m3 > 0.0;
        Incident {
            position_m,
            normal: None,
            lobes: fit::lobes(&turned(&crossed.sights, position_m, (0.5 * track_m3).cbrt() as f32)),
            reflected_w_m2: (2.0 * crossed.sights.iter().map(|sight| sight.weight).sum::<f64>() / track_m3) as f32,
            direct_w_m2: (0..model.sources.emitters.len())
                .map(|emitter| if is_seen { straight(emitter) } else { 0.0 })
                .collect(),
        }
    };
    crossed.par_iter().enumerate().map(incident).collect()
}

/// The light at every node of the skeleton: that of its zone, turned to where the node sees it.
pub fn at_nodes(network: &Network, in_zones: &[Incident]) -> Vec<Incident> {
    let grounds = &network.grounds;
    let at_node = |node: petgraph::graph::NodeIndex| {
        let position_m = grounds.model.node_m(node);
        let zone = grounds.zones.at(node.index() as u32, position_m);
        in_zones.get(zone as usize).map_or_else(Incident::default, |incident| incident.seen_from(position_m))
    };
    grounds.model.skeleton.graph.node_indices().map(at_node).collect()
}

/// What the lines show of a zone.
#[derive(Debug, Clone, Default)]
struct Crossed {
    /// Sum of weight times length, m3.
    track_m3: f64,
    /// The same times where the lines were looked at.
    moment: DVec3,
    sights: Vec<Sight>,
}

/// What each patch sends out by all reflections, W/m2.
fn radiosity_w_m2(network: &Network) -> Vec<f64> {
    let of = |(number, patch): (usize, &crate::flow::network::patches::Patch)| {
        let landed_w: f64 = network.landings.iter().map(|landing| landing.reflected_w[number]).sum();
        let reflected_w_m2: f64 = network.reflected_w_m2.iter().map(|column| column[number]).sum();
        landed_w / patch.area_m2 + patch.reflectance * reflected_w_m2
    };
    network.grounds.patches.list.iter().enumerate().map(of).collect()
}

/// What was seen from around a place as the place sees it.
fn turned(sights: &[Sight], place_m: Vec3, zone_m: f32) -> Vec<Sample> {
    let turned = |sight: &Sight| {
        let to_m = sight.from_m + sight.distance_m * sight.direction - place_m;
        let distance_m = to_m.length();
        let (direction, distance_m) = match distance_m > LEAST_TURNED_ZONES * zone_m {
            true => (to_m / distance_m, distance_m),
            false => (sight.direction, sight.distance_m),
        };
        Sample { direction, weight: (sight.weight / PI) as f32, distance_m }
    };
    sights.iter().map(turned).collect()
}
