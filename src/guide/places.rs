//! What light comes to each place, by the lines that have measured the exchange?
//!
//! A line of weight `w` (area times solid angle times cosine, over the number of lines) between walls of radiosity B brings
//! `w B` to either end, so the lines that end on a patch are samples of the light that arrives there; and a line that crosses
//! a zone brings `w l B` to it over its length `l` there. Each sample is turned to where the place itself would see what
//! shines. No ray is traced for this, but for those towards the lights, and at sensors.

use super::fit::{self, Sample};
use super::shine::Shine;
use super::straight::InView;
use crate::flow::direct::direct;
use crate::flow::network::gather;
use crate::flow::network::lines::Line;
use crate::flow::network::walk::End;
use crate::flow::network::{Gather, Network};
use crate::flow::sequence;
use crate::light::Incident;
use crate::model::Probe;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// What is nearer to a place than this share of its distance from where it was seen is not turned to the place.
const NEAREST_SHARE: f32 = 0.25;

/// Patches beside a patch whose lines count for it too, and how much.
const MOST_BESIDE: usize = 6;
const BESIDE_COUNTS: f64 = 0.3;

/// Patches look the same way from this cosine on.
const ALIKE_FROM: f32 = 0.9;

/// Rays of a point that has its own.
const PROBE_RAYS: Gather = Gather { rays: 512, neck_rays: 128 };

/// Shadow rays of such a point to an emitter that has a body.
const PROBE_LIGHT_RAYS: u32 = 4;

/// Offsets of the sequences that pick points on lines and of shadow rays start here.
const POINT_OFFSETS: u64 = 1 << 46;
const SHADOW_OFFSETS: u64 = 1 << 47;
const PROBE_OFFSETS: u64 = 1 << 50;

/// A line seen from a place: where it meets what shines, and how much that brings.
#[derive(Debug, Clone, Copy)]
struct Sight {
    /// Where the line is at the place, metres.
    from_m: Vec3,
    /// Where what shines is, metres.
    to_m: Vec3,
    /// What it sends out there, W/m2.
    sends_w_m2: f64,
    weight: f64,
}

/// What stands at the two ends of each line sends out there, W/m2.
pub fn sent_by_ends(shine: &Shine, lines: &[Line]) -> Vec<[f64; 2]> {
    let sent = |line: &Line| {
        let ends_m = [line.from_m, line.from_m + line.length_m * line.direction];
        std::array::from_fn(|side| match line.ends[side] {
            End::Patch(patch) => shine.at_w_m2(patch, ends_m[side]),
            _ => 0.0,
        })
    };
    lines.par_iter().with_min_len(256).map(sent).collect()
}

/// The light at every patch of the network, at that of its points nearest to its middle. What the patches of the same side
/// beside it see counts too, for they see the same things from a little further on. `ends_w_m2` is what [`sent_by_ends`] gives.
pub fn at_walls(network: &Network, lines: &[Line], ends_w_m2: &[[f64; 2]]) -> Vec<Incident> {
    let grounds = &network.grounds;
    let patches = &grounds.patches;
    let mut sights: Vec<Vec<Sight>> = vec![Vec::new(); patches.list.len()];
    for (line, [first_w_m2, last_w_m2]) in lines.iter().zip(ends_w_m2).filter(|(line, _)| line.panes.is_empty()) {
        let [first, last] = line.ends;
        let end_m = line.from_m + line.length_m * line.direction;
        let ways = [(first, line.from_m, end_m, *last_w_m2), (last, end_m, line.from_m, *first_w_m2)];
        for (here, from_m, to_m, sends_w_m2) in ways {
            if let End::Patch(patch) = here
                && sends_w_m2 > 0.0
            {
                let weight = line.weight_m2 * sends_w_m2;
                sights[patch as usize].push(Sight { from_m, to_m, sends_w_m2, weight });
            }
        }
    }
    let incident = |(number, own): (usize, &Vec<Sight>)| {
        let patch = &patches.list[number];
        let starts = &patches.starts[patch.starts.clone()];
        let middle_m = starts.iter().map(|start| start.position_m).sum::<Vec3>() / starts.len() as f32;
        let apart_m2 = |at_m: Vec3| at_m.distance_squared(middle_m);
        let nearest = starts.iter().min_by(|a, b| apart_m2(a.position_m).total_cmp(&apart_m2(b.position_m)));
        let (position_m, normal) = nearest.map_or((middle_m, Vec3::Z), |start| (start.position_m, start.normal));
        let mut samples = Vec::new();
        turn(own, position_m, Some(normal), 1.0 / patch.area_m2, &mut samples);
        for zone in grounds.zones.beside(patch.zone, 1).take(MOST_BESIDE) {
            let beside = starts.first().and_then(|start| patches.like(zone, normal, start.answer));
            let Some(beside) = beside.map(|beside| beside as usize).filter(|&beside| beside != number) else {
                continue;
            };
            let other = &patches.list[beside];
            let is_alike =
                patches.starts.get(other.starts.start).is_some_and(|start| start.normal.dot(normal) > ALIKE_FROM);
            if other.zone == zone && is_alike {
                turn(&sights[beside], position_m, Some(normal), BESIDE_COUNTS / other.area_m2, &mut samples);
            }
        }
        described(
            samples,
            Incident {
                position_m,
                normal: Some(normal),
                reflected_w_m2: network.reflected_w_m2.iter().map(|column| column[number]).sum::<f64>() as f32,
                direct_w_m2: (network.landings.iter())
                    .map(|landing| (landing.flux_w[number] / patch.area_m2) as f32)
                    .collect(),
                ..Incident::default()
            },
        )
    };
    sights.par_iter().enumerate().map(incident).collect()
}

/// The light at a sensor, or wherever one point is worth rays of its own: over all it sees and to the necks of its room.
/// `number` makes them its own. Without a way through the void to it nothing is known.
pub fn at_probe(network: &Network, shine: &Shine, probe: &Probe, seed: u64, number: u64) -> Incident {
    let model = network.grounds.model;
    let Probe { position_m, normal, place: Ok(node) } = *probe else { return Incident::default() };
    let cell = model.skeleton.graph.node_weight(node).map_or(u32::MAX, |node| node.cell);
    let from_m = position_m + normal.unwrap_or(Vec3::ZERO) * model.rays.epsilon_m();
    let offset = sequence::offset(seed, PROBE_OFFSETS + number);
    let mut samples = Vec::new();
    let mut reflected_w_m2 = 0.0;
    for sight in gather::sights(network, &PROBE_RAYS, from_m, normal, cell, offset) {
        let cosine = normal.map_or(1.0, |normal| f64::from(normal.dot(sight.direction).max(0.0)));
        let density = cosine * shine.at_w_m2(sight.patch, sight.at.position_m);
        let weight = sight.weight * density;
        reflected_w_m2 += weight;
        if weight > 0.0 {
            let distance_m = sight.at.position_m.distance(from_m);
            let (weight, density) = (weight as f32, density as f32);
            samples.push(Sample { direction: sight.direction, weight, density, distance_m });
        }
    }
    let straight = |emitter| direct(model, from_m, normal, emitter, PROBE_LIGHT_RAYS, offset).value_w_m2 as f32;
    let place = Incident {
        position_m: from_m,
        normal,
        reflected_w_m2: reflected_w_m2 as f32,
        direct_w_m2: (0..model.sources.emitters.len()).map(straight).collect(),
        ..Incident::default()
    };
    described(samples, place)
}

/// The light in every zone of the void, at the middle of what its lines show of it; straight from each emitter by one ray from
/// there.
pub fn in_zones(network: &Network, lines: &[Line], ends_w_m2: &[[f64; 2]], seed: u64) -> Vec<Incident> {
    let grounds = &network.grounds;
    let (model, zones) = (grounds.model, &grounds.zones);
    let in_view = InView::new(network, seed);
    // One place a line, anywhere on it, stands for its whole length.
    let place = |(number, line): (usize, &Line)| {
        let along_m = sequence::offset(seed, POINT_OFFSETS + number as u64)[0] as f32 * line.length_m;
        let at_m = line.from_m + along_m * line.direction;
        let node = model.skeleton.nearest.node(model.voxels.lattice.voxel_at(at_m))?;
        Some((zones.at(node, at_m), at_m))
    };
    let places: Vec<Option<(u32, Vec3)>> = lines.par_iter().enumerate().map(place).collect();
    let mut crossed = vec![Crossed::default(); zones.count];
    for ((line, ends_w_m2), place) in lines.iter().zip(ends_w_m2).zip(places) {
        let Some((zone, at_m)) = place.filter(|_| line.panes.is_empty()) else { continue };
        let crossed = &mut crossed[zone as usize];
        let weight_m3 = line.weight_m2 * f64::from(line.length_m);
        crossed.track_m3 += weight_m3;
        crossed.moment += weight_m3 * at_m.as_dvec3();
        let end_m = line.from_m + line.length_m * line.direction;
        for (&sends_w_m2, to_m) in ends_w_m2.iter().zip([line.from_m, end_m]) {
            if sends_w_m2 > 0.0 {
                crossed.sights.push(Sight { from_m: at_m, to_m, sends_w_m2, weight: weight_m3 * sends_w_m2 });
            }
        }
    }

    let incident = |(zone, crossed): (usize, &Crossed)| {
        let track_m3 = crossed.track_m3.max(f64::MIN_POSITIVE);
        let position_m = (crossed.moment / track_m3).as_vec3();
        let mut direct_w_m2 = vec![0.0; model.sources.emitters.len()];
        if crossed.track_m3 > 0.0 {
            let straight = in_view.at(network, zone as u32, position_m, SHADOW_OFFSETS + zone as u64);
            straight.iter().for_each(|(emitter, straight)| direct_w_m2[*emitter] = straight.value_w_m2 as f32);
        }
        let mut samples = Vec::new();
        turn(&crossed.sights, position_m, None, 1.0, &mut samples);
        let reflected_w_m2 = 2.0 * crossed.sights.iter().map(|sight| sight.weight).sum::<f64>() / track_m3;
        let reflected_w_m2 = reflected_w_m2 as f32;
        described(samples, Incident { position_m, reflected_w_m2, direct_w_m2, ..Incident::default() })
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

/// A place with the lobes that samples give it.
fn described(samples: Vec<Sample>, place: Incident) -> Incident {
    let samples = fit::thinned(samples);
    let mut place = Incident { lobes: fit::lobes(&samples), ..place };
    place.trust = fit::trust(&samples, &place);
    place
}

/// What was seen from around a place, as the place sees it.
fn turn(sights: &[Sight], place_m: Vec3, normal: Option<Vec3>, factor: f64, samples: &mut Vec<Sample>) {
    samples.extend(sights.iter().filter_map(|sight| {
        let to_m = sight.to_m - place_m;
        let distance_m = to_m.length();
        // What is much nearer to the place than to where it was seen from would fill its view, and is left to the cosine.
        let direction = (distance_m > NEAREST_SHARE * sight.to_m.distance(sight.from_m)).then(|| to_m / distance_m)?;
        let cosine = normal.map_or(1.0, |normal| normal.dot(direction));
        let density = sight.sends_w_m2 as f32 * cosine;
        (cosine > 0.0).then_some(Sample { direction, weight: (factor * sight.weight) as f32, density, distance_m })
    }));
}
