//! How much light would reach a point if it only had to go round the corner: the poster's upper estimate.
//!
//! From the probe walk the shortest path towards the light; `n_e` is the farthest node on it that the probe still sees.
//! With `d_all` = path length from the light to `n_e` + the straight distance from `n_e` to the probe,
//! `B = L0 / (pi d_all^2)`, arriving from `n_e`. Where the probe sees the light itself, `d_all` is the distance to it.
//! (Chaussard, Biri, Couprie.) It leaves out what walls absorb, hence an upper estimate, and also what many
//! reflections add, hence not a bound in bright rooms.

use super::{Arrival, AtProbe, Lit, add_lights, inverse_square};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Settings};
use crate::model::{Model, Probe};
use petgraph::graph::NodeIndex;

/// Irradiance at the probes by the backward heuristic, summed over all lights.
///
/// Costs at most a ray for each node of the path from a probe to a light.
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
    Box::new(move |probe, node| {
        let model = lit.model;
        let straight_share = model.straight_share(probe.position_m, lit.light);
        if straight_share > 0.0 {
            let straight = arrival(lit, probe, 0.0, lit.light.position_m);
            return Arrival { irradiance_w_m2: straight_share * straight.irradiance_w_m2, ..straight };
        }
        let farthest = farthest_seen(lit, probe, node);
        let end_m = model.node_m(farthest);
        let along_m = lit.tree.distance_m[farthest.index()] + lit.light.to_node_m;
        arrival(lit, probe, along_m, end_m)
    })
}

/// The node nearest to the light, along the path from the probe's own `node`, that the probe sees; `node` where it sees none.
///
/// Looks from the light's end in strides of half a ball, for what is seen of a ball is seen of its middle, and then node by
/// node: a glimpse of the path shorter than that may be missed.
fn farthest_seen(lit: &Lit, probe: &Probe, node: NodeIndex) -> NodeIndex {
    let path: Vec<NodeIndex> = lit.tree.path_from(node).collect();
    let sees = |at: usize| lit.model.rays.clear(probe.position_m, lit.model.node_m(path[at]));
    let stride = |at: usize| {
        let ball = lit.model.skeleton.graph.node_weight(path[at]).map_or(0, |node| node.opening_voxels);
        usize::from(ball / 2).max(1)
    };

    let last = path.len() - 1;
    let from_light = std::iter::successors(Some(last), |&at| at.checked_sub(stride(at)));
    let Some(seen) = from_light.into_iter().find(|&at| sees(at)) else { return node };
    let beyond = (seen + 1..=last).take_while(|&at| sees(at)).last();
    path[beyond.unwrap_or(seen)]
}

/// The light that comes by `end_m`, `along_m` of its way behind it.
fn arrival(lit: &Lit, probe: &Probe, along_m: f64, end_m: glam::Vec3) -> Arrival {
    let straight_m = (end_m - probe.position_m).as_dvec3();
    let d_all_m = along_m + straight_m.length();
    Arrival {
        irradiance_w_m2: inverse_square(lit.light.flux_w, d_all_m, lit.model.nearest_m()),
        towards: straight_m.normalize_or_zero(),
    }
}
