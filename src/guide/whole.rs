//! How much light is at a place in all, by whom, and in which room?

use super::Place;
use super::cache::View;
use super::shares::{Shares, of_all};
use super::straight::InView;
use crate::flow::network::Network;
use crate::flow::network::read::Tracks;
use crate::light::Incident;
use petgraph::graph::NodeIndex;
use rayon::prelude::*;

/// A lamp seen along a wall by less than this cosine counts as seen by it, where its irradiance is divided by the cosine.
const LEAST_COSINE: f32 = 0.05;

/// The wall places of all patches, whose light that is, seen by these views.
///
/// Their scalar irradiance is over the hemisphere before the wall; of an emitter's light by the direction of its middle.
pub fn walls(network: &Network, incident: Vec<Incident>, shares: &Shares, views: &[View]) -> Vec<Place> {
    let model = network.grounds.model;
    let place = |(patch, incident): (usize, Incident)| {
        let normal = incident.normal.unwrap_or_default();
        let straight = |(direct_w_m2, shining): (&f32, &crate::model::Shining)| {
            let towards = (shining.position_m - incident.position_m).normalize_or(normal);
            direct_w_m2 / normal.dot(towards).max(LEAST_COSINE)
        };
        let straight_w_m2: f32 = incident.direct_w_m2.iter().zip(&model.shining).map(straight).sum();
        Place {
            scalar_w_m2: views.get(patch).map_or(0.0, |view| view.scalar_w_m2) + straight_w_m2,
            shares: of_all(&incident.direct_w_m2, incident.reflected_w_m2, shares.of(patch as u32)),
            cell: network.grounds.zones.cell(network.grounds.patches.list[patch].zone),
            incident,
        }
    };
    incident.into_par_iter().enumerate().map(place).collect()
}

/// The places at all nodes: lobes as `incident` has them, light as the zones' `tracks` (of one column) and rays to the emitters in
/// view have it there.
pub fn nodes(
    network: &Network,
    incident: Vec<Incident>,
    tracks: &Tracks,
    in_view: &InView,
    shares: &Shares,
) -> Vec<Place> {
    let (grounds, of_zones) = (&network.grounds, shares.of_zones(network));
    let emitters = grounds.model.sources.emitters.len();
    let place = |(node, mut incident): (usize, Incident)| {
        let zone = grounds.zones.at(node as u32, incident.position_m);
        incident.reflected_w_m2 = tracks.reflected(1, zone, incident.position_m).value_w_m2 as f32;
        incident.direct_w_m2 = vec![0.0; emitters];
        for (emitter, straight) in in_view.at(network, zone, incident.position_m, node as u64) {
            incident.direct_w_m2[emitter] = straight.value_w_m2 as f32;
        }
        let row = of_zones.get(zone as usize).map(Vec::as_slice).unwrap_or_default();
        Place {
            scalar_w_m2: incident.reflected_w_m2 + incident.direct_w_m2.iter().sum::<f32>(),
            shares: of_all(&incident.direct_w_m2, incident.reflected_w_m2, row),
            cell: grounds.model.skeleton.graph.node_weight(NodeIndex::new(node)).map_or(u32::MAX, |node| node.cell),
            incident,
        }
    };
    incident.into_par_iter().enumerate().map(place).collect()
}
