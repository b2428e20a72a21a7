//! How much of a light's flux gets through the passages on its way: the poster's estimate by carried flux.
//!
//! Breadth-first from the light's node along its shortest-path tree: the flux at a node is its parent's times
//! `min(1, (r / r_parent)^2)`, `r` the size of the maximal ball; divided by the square of the distance along the skeleton
//! it gives the irradiance, `B = L0 factor / (pi d^2)`, arriving from the parent. (Chaussard, Biri, Couprie.) The distance is
//! probe to node + path + node to light. A narrow place takes its share for good: nothing comes back by reflection.
//!
//! `r` is read as the opening, the half-width of the largest ball that covers the node: the node's own distance to matter
//! wavers with every voxel of a wall, and each wavering would take its share.

use super::paths::PathTree;
use super::{Arrival, AtProbe, Lit, add_lights, inverse_square};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Settings};
use crate::model::{Model, Probe};
use crate::skeleton::Skeleton;
use glam::DVec3;
use petgraph::graph::NodeIndex;

/// Irradiance at the probes by the forward heuristic, summed over all lights. Casts no rays.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn estimate(
    model: &Model,
    probes: &[Probe],
    _settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Field, Cancelled> {
    add_lights(model, probes, progress, cancel, from_light)
}

/// What one light gives.
fn from_light<'a>(lit: &'a Lit<'a>) -> AtProbe<'a> {
    let share = shares(&lit.model.skeleton, lit.tree);
    Box::new(move |probe, node| {
        let to_node_m = (lit.model.node_m(node) - probe.position_m).as_dvec3();
        let distance_m = to_node_m.length() + lit.tree.distance_m[node.index()] + lit.light.to_node_m;
        Arrival {
            irradiance_w_m2: share[node.index()] * inverse_square(lit.light.flux_w, distance_m, lit.model.nearest_m()),
            towards: towards_light(lit, probe, node),
        }
    })
}

/// The direction in which the tree leads from a node towards the light: to the first ancestor outside the node's own ball,
/// for within it steps of a lattice have no direction worth the name. Where the light's own node lies in that ball, from
/// the probe to the light.
fn towards_light(lit: &Lit, probe: &Probe, node: NodeIndex) -> DVec3 {
    let node_m = lit.model.node_m(node);
    let radius_m = lit.model.skeleton.graph.node_weight(node).map_or(0.0, |node| node.radius_m);
    let ancestors_m = lit.tree.path_from(node).map(|ancestor| lit.model.node_m(ancestor));
    let outside_m = ancestors_m.into_iter().find(|ancestor_m| ancestor_m.distance(node_m) > radius_m);
    let straight_m = outside_m.map_or(lit.light.position_m - probe.position_m, |ancestor_m| ancestor_m - node_m);
    straight_m.as_dvec3().normalize_or_zero()
}

/// The share of the light's flux that is carried to each node, by node; 0 where no path leads.
fn shares(skeleton: &Skeleton, tree: &PathTree) -> Vec<f64> {
    let mut share = vec![0.0; tree.parent.len()];
    for &node in &tree.order {
        let parent = tree.parent[node.index()];
        share[node.index()] = if parent == node {
            1.0
        } else {
            let [ball, parent_ball] = [node, parent].map(|at| f64::from(skeleton.graph[at].opening_voxels));
            share[parent.index()] * (ball / parent_ball).powi(2).min(1.0)
        };
    }
    share
}
