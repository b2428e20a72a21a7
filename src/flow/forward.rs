//! How much of a light's flux gets through the passages on its way: the poster's estimate by carried flux.
//!
//! Breadth-first from the light's node along its shortest-path tree: the flux at a node is its parent's times
//! `min(1, (r / r_parent)^2)`, `r` the size of the maximal ball; divided by the square of the distance along the skeleton
//! it gives the irradiance, `B = L0 factor / (pi d^2)`, arriving from the parent. (Chaussard, Biri, Couprie.) The distance is
//! probe to node + path + node to light. A narrow place takes its share for good: nothing comes back by reflection.
//!
//! `r` is read as the opening, the half-width of the largest ball that covers the node: the node's own distance to matter
//! wavers with every voxel of a wall, and each wavering would take its share. The edge that leads to the node counts with
//! it: through a wall of a single voxel the edge alone is in the door.
//!
//! Limits: lights are read as points that shine evenly all around; glazing takes no share.

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
            let [ball, parent_ball] = [node, parent].map(|at| skeleton.graph[at].opening_voxels);
            let way = skeleton.graph.find_edge(parent, node).map_or(ball, |edge| skeleton.graph[edge].opening_voxels);
            let narrowing = f64::from(ball.min(way)) / f64::from(parent_ball);
            share[parent.index()] * narrowing.powi(2).min(1.0)
        };
    }
    share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::inverse_square;
    use crate::flow::tests::{FLUX_W, close, field, lamp, modelled, room, sensor, two_rooms, veins};
    use crate::voxel::test_scenes::boxed;
    use glam::Vec3;

    #[test]
    fn a_neck_takes_its_share_for_good() {
        // A chain through a neck of half the width, into a room, and to a dead end of a quarter.
        let skeleton = veins(&[4, 4, 2, 8, 1], &[(0, 1, 1.0), (1, 2, 1.0), (2, 3, 1.0), (3, 4, 1.0)]);
        let tree = PathTree::from(&skeleton, NodeIndex::new(0));
        assert_eq!(shares(&skeleton, &tree), [1.0, 1.0, 0.25, 0.25, 0.25 / 64.0]);
        let apart = veins(&[4, 4], &[]);
        assert_eq!(shares(&apart, &PathTree::from(&apart, NodeIndex::new(0))), [1.0, 0.0]);
    }

    #[test]
    fn a_door_in_a_wall_without_thickness_takes_its_share() {
        // Two rooms of 3 m; the wall between them is a sheet with a door of 1 x 1 m in its middle.
        let mut triangles = boxed(Vec3::ZERO, Vec3::new(6.0, 3.0, 3.0));
        let sheet = |low: [f32; 2], high: [f32; 2]| {
            let at = |y: f32, z: f32| Vec3::new(3.0, y, z);
            let [a, b, c, d] = [at(low[0], low[1]), at(high[0], low[1]), at(high[0], high[1]), at(low[0], high[1])];
            [[a, b, c], [a, c, d]]
        };
        let parts =
            [([0.0, 0.0], [3.0, 1.0]), ([0.0, 2.0], [3.0, 3.0]), ([0.0, 1.0], [1.0, 2.0]), ([2.0, 1.0], [3.0, 2.0])];
        triangles.extend(parts.into_iter().flat_map(|(low, high)| sheet(low, high)));
        let model = modelled(&triangles, vec![lamp(Vec3::new(1.0, 1.4, 1.5), FLUX_W)], Vec::new());
        let skeleton = &model.1.skeleton;
        let tree = PathTree::from(skeleton, model.1.shining[0].place.unwrap());
        let farthest = *tree.order.last().unwrap();
        let share = shares(skeleton, &tree)[farthest.index()];
        assert!((0.05..0.16).contains(&share), "a ninth, to the voxel: {share}");
    }

    #[test]
    fn in_one_room_it_is_the_inverse_square_of_the_way_by_the_middle() {
        let (light_m, at_m) = (Vec3::new(1.0, 1.5, 1.0), Vec3::new(2.5, 2.0, 1.2));
        let model = modelled(&room(), vec![lamp(light_m, FLUX_W)], vec![sensor(at_m, None)]);
        let node_m = model.1.node_m(NodeIndex::new(0));
        assert!(model.1.skeleton.graph.node_count() == 1 && node_m.distance(Vec3::splat(1.5)) < 0.1);
        let reading = field(&model, estimate).readings[0];
        let way_m = f64::from(at_m.distance(node_m)) + f64::from(node_m.distance(light_m));
        close(reading.value_w_m2, inverse_square(FLUX_W, way_m, 0.0));
        assert!(reading.direction().distance((light_m - at_m).as_dvec3().normalize()) < 1e-6);
    }

    #[test]
    fn behind_a_door_it_is_less_than_the_way_alone_would_leave() {
        let at_m = Vec3::new(6.5, 0.7, 1.5);
        let model = modelled(&two_rooms(), vec![lamp(Vec3::new(2.0, 1.0, 1.5), FLUX_W)], vec![sensor(at_m, None)]);
        let reading = field(&model, estimate).readings[0];
        let (light, place) = (&model.1.shining[0], model.1.probes_at_sensors(&model.0)[0].place.unwrap());
        let tree = PathTree::from(&model.1.skeleton, light.place.unwrap());
        let way_m = f64::from(model.1.node_m(place).distance(at_m)) + tree.distance_m[place.index()] + light.to_node_m;
        let share = reading.value_w_m2 / inverse_square(FLUX_W, way_m, 0.0);
        // The door is 1 m wide, the rooms are 3 m: a ninth, to the voxel.
        assert!((0.06..0.16).contains(&share), "{share}");
    }
}
