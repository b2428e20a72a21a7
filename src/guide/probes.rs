//! Where should light probes stand, and what do they see?
//!
//! Nodes of the skeleton, those farthest from matter first, and after them the middles of zones, each where no probe of its room
//! stands within three quarters of the width of the passage there (a greedy cover). Every room has one; every point of the void
//! has one within about a width. What a probe sees are scalar irradiance and net flux, which are its spherical harmonics of orders 0
//! and 1 (Ramamoorthi & Hanrahan 2001): of reflected light as the lines through its zone bring it, and straight from emitters.

use super::LightProbe;
use super::straight::InView;
use crate::flow::direct::Direct;
use crate::flow::network::Network;
use crate::flow::network::read::Tracks;
use crate::flow::sequence;
use crate::model::Model;
use glam::{DVec3, Vec3};
use petgraph::graph::NodeIndex;
use rayon::prelude::*;
use std::f64::consts::PI;

/// How far a probe speaks for the void around it, in half-widths of the passage: rooms as high as wide have one to a few.
const REACH: f32 = 1.5;

/// Directions, besides those of the axes, in which the nearest wall is looked for from the middle of a zone.
const LOOKS: u32 = 64;

/// A place where a probe may stand.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    position_m: Vec3,
    node: NodeIndex,
    cell: u32,
    /// How far it speaks for the void around it, metres.
    reach_m: f32,
    /// Distance to the nearest wall, metres, where it is known.
    radius_m: Option<f32>,
}

/// Probes for all rooms, room by room, in a field whose reflected part `tracks` have in one column.
pub fn probes(network: &Network, tracks: &Tracks, in_view: &InView) -> Vec<LightProbe> {
    let model = network.grounds.model;
    let probe = |(number, candidate): (usize, Candidate)| {
        let Candidate { position_m, node, cell, radius_m, .. } = candidate;
        let zone = network.grounds.zones.at(node.index() as u32, position_m);
        let Direct { mut value_w_m2, mut flux_w_m2 } = tracks.reflected(1, zone, position_m);
        // Numbers of their own, after those of the nodes.
        let number = (model.skeleton.graph.node_count() + number) as u64;
        for (_, straight) in in_view.at(network, zone, position_m, number) {
            value_w_m2 += straight.value_w_m2;
            flux_w_m2 += straight.flux_w_m2;
        }
        let radius_m = radius_m.unwrap_or_else(|| nearest_wall_m(model, position_m));
        LightProbe { position_m, radius_m, cell, sh_w_m2_sr: harmonics(value_w_m2, flux_w_m2) }
    };
    cover(model, candidates(network)).into_par_iter().enumerate().map(probe).collect()
}

/// Spherical harmonics (0,0), (1,-1), (1,0), (1,1) of a radiance with that scalar irradiance and net flux, W/m2/sr: projections
/// on 1, y, z and x, whose norms over the sphere are 4 pi and 4 pi / 3.
fn harmonics(scalar_w_m2: f64, flux_w_m2: DVec3) -> [f32; 4] {
    let (zeroth, first) = ((0.25 / PI).sqrt(), (0.75 / PI).sqrt());
    [zeroth * scalar_w_m2, first * flux_w_m2.y, first * flux_w_m2.z, first * flux_w_m2.x].map(|part| part as f32)
}

/// All nodes, the most open first, then the middles of zones that lie in the void.
fn candidates(network: &Network) -> Vec<Candidate> {
    let model = network.grounds.model;
    let (graph, lattice) = (&model.skeleton.graph, &model.voxels.lattice);
    let reach_m = |node: NodeIndex| REACH * f32::from(graph[node].opening_voxels.max(1)) * lattice.voxel_m;
    let at_node = |node: NodeIndex| Candidate {
        position_m: graph[node].position_m,
        node,
        cell: graph[node].cell,
        reach_m: reach_m(node),
        radius_m: Some(graph[node].radius_m),
    };
    let mut nodes: Vec<NodeIndex> = graph.node_indices().collect();
    nodes.sort_by(|&a, &b| graph[b].radius_m.total_cmp(&graph[a].radius_m).then(a.cmp(&b)));
    let at_middle = |(zone, position_m): (u32, Vec3)| {
        let node = model.skeleton.nearest_node(lattice.voxel_at(position_m))?;
        let cell = graph[node].cell;
        let is_its_own = network.grounds.zones.cell(zone) == cell;
        is_its_own.then(|| Candidate { position_m, node, cell, reach_m: reach_m(node), radius_m: None })
    };
    nodes.into_iter().map(at_node).chain(network.grounds.zones.middles_m().filter_map(at_middle)).collect()
}

/// Those of the candidates, in their order, that none before speaks for; by room.
fn cover(model: &Model, candidates: Vec<Candidate>) -> Vec<Candidate> {
    let mut chosen: Vec<Vec<Candidate>> = vec![Vec::new(); model.skeleton.cells.len()];
    for candidate in candidates {
        let Some(room) = chosen.get_mut(candidate.cell as usize) else { continue };
        let is_near = |other: &Candidate| other.position_m.distance(candidate.position_m) < other.reach_m;
        if !room.iter().any(is_near) {
            room.push(candidate);
        }
    }
    chosen.concat()
}

/// The distance to the nearest wall as rays find it, metres; 0 where there is none.
fn nearest_wall_m(model: &Model, from_m: Vec3) -> f32 {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let around = (0..LOOKS).map(|look| sequence::spiral(look, LOOKS, [0.5; 2]));
    let found_m = axes.chain(around).filter_map(|look| model.rays.closest(from_m, look, f32::INFINITY));
    found_m.map(|hit| hit.distance_m).reduce(f32::min).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::network::Quality;
    use crate::flow::tests::{FLUX_W, lamp, modelled, two_rooms};
    use crate::guide::shine::Shine;
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;

    #[test]
    fn harmonics_of_even_and_of_narrow_light_are_the_closed_forms() {
        let radiance_w_m2_sr = 2.0;
        let even = harmonics(4.0 * PI * radiance_w_m2_sr, DVec3::ZERO);
        assert!((f64::from(even[0]) - radiance_w_m2_sr * (4.0 * PI).sqrt()).abs() < 1e-5 && even[1..] == [0.0; 3]);
        // A beam of 1 W/m2 from one direction has the harmonics' own values there.
        let towards = DVec3::new(0.48, -0.6, 0.64);
        let beam = harmonics(1.0, towards).map(f64::from);
        let want = [0.282_095, 0.488_603 * towards.y, 0.488_603 * towards.z, 0.488_603 * towards.x];
        assert!(beam.iter().zip(want).all(|(found, want)| (found - want).abs() < 1e-6), "{beam:?} is not {want:?}");
    }

    #[test]
    fn every_room_has_probes_and_every_node_one_near() {
        let (_, model) = modelled(&two_rooms(), vec![lamp(Vec3::new(2.0, 0.5, 1.5), FLUX_W)], Vec::new());
        let (network, lines) = Network::new(&model, &Quality::COARSE, &Settings::default(), &Quiet, &Cancel::new())
            .expect("nobody stops it");
        let tracks = Tracks::new(&network.grounds, &lines, &[Shine::new(&network).means_w_m2()], 1, 0);
        let found = probes(&network, &tracks, &InView::new(&network, 0));
        let graph = &model.skeleton.graph;
        // Both rooms are 3 m high and no wider than 4 m, the door 1 m.
        for node in graph.node_weights() {
            let near =
                |probe: &LightProbe| probe.cell == node.cell && probe.position_m.distance(node.position_m) <= 2.25;
            assert!(found.iter().any(near), "{} has no probe near", node.position_m);
        }
        assert!(found.len() < 40, "{}", found.len());
        assert!(found.len() < graph.node_count() && (0..2).all(|cell| found.iter().any(|probe| probe.cell == cell)));
        for probe in &found {
            let [even, ..] = probe.sh_w_m2_sr;
            let bent = DVec3::from_array([1, 2, 3].map(|part| f64::from(probe.sh_w_m2_sr[part]))).length();
            // The net flux is no more than the scalar irradiance.
            assert!(even > 0.0 && bent <= 3.0_f64.sqrt() * f64::from(even) && probe.radius_m > 0.0, "{probe:?}");
        }
    }
}
