//! How much light would reach a point if it only had to go round the corner: the poster's upper estimate.
//!
//! From the probe walk the shortest path towards the light; `n_e` is the farthest node on it that the probe still sees.
//! With `d_all` = path length from the light to `n_e` + the straight distance from `n_e` to the probe,
//! `B = L0 / (pi d_all^2)`, arriving from `n_e`. Where the probe sees the light itself, `d_all` is the distance to it.
//! (Chaussard, Biri, Couprie.) It leaves out what walls absorb, hence an upper estimate, and also what many
//! reflections add, hence not a bound in bright rooms.
//!
//! Limits: a light is read as a point that shines evenly all around (a quad: into the half space before it), so that under a
//! quad, which is up to four times as strong along its normal, the value is too low. Glazing weakens light where the light
//! itself is seen, not round a corner.

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
        let straight_share = lit.model.straight_share(probe.position_m, lit.light);
        if straight_share > 0.0 {
            let straight = arrival(lit, probe, 0.0, lit.light.position_m);
            return Arrival { irradiance_w_m2: straight_share * straight.irradiance_w_m2, ..straight };
        }
        let farthest = farthest_seen(lit, probe, node);
        arrival(lit, probe, beyond_m(lit, farthest), lit.model.node_m(farthest))
    })
}

/// The way that this heuristic takes from a probe to a light: what it makes its answer of.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// The nodes of the shortest path, from the probe's own to the light's.
    pub nodes: Vec<NodeIndex>,
    /// The length of the path from probe to light by all its nodes, metres.
    pub path_m: f64,
    /// The node nearest to the light that the probe sees; its own where it sees none.
    pub farthest: NodeIndex,
    /// Whether the probe sees the light itself, and how much of it: 0 to 1.
    pub seen_share: f64,
    /// The distance that the answer is made of, metres: straight to the light where it is seen, else straight to the farthest
    /// node and along the path from there.
    pub d_all_m: f64,
}

/// The way from a probe to the light of `lit`; `None` where the probe has no node or no path leads to the light.
pub fn way(lit: &Lit, probe: &Probe) -> Option<Way> {
    let node = probe.place.ok().filter(|&node| lit.tree.reaches(node))?;
    let farthest = farthest_seen(lit, probe, node);
    let seen_share = lit.model.straight_share(probe.position_m, lit.light);
    let straight_m = |to_m: glam::Vec3| f64::from(to_m.distance(probe.position_m));
    let d_all_m = match seen_share > 0.0 {
        true => straight_m(lit.light.position_m),
        false => beyond_m(lit, farthest) + straight_m(lit.model.node_m(farthest)),
    };
    let path_m = beyond_m(lit, node) + straight_m(lit.model.node_m(node));
    Some(Way { nodes: lit.tree.path_from(node).collect(), path_m, farthest, seen_share, d_all_m })
}

/// The way from a node to the light, metres.
fn beyond_m(lit: &Lit, node: NodeIndex) -> f64 {
    lit.tree.distance_m[node.index()] + lit.light.to_node_m
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::paths::PathTree;
    use crate::flow::tests::{FLUX_W, close, field, lamp, modelled, room, sensor, two_rooms};
    use crate::light::Status;
    use crate::scene::Light;
    use crate::voxel::test_scenes::boxed;
    use glam::{DVec3, Vec3};
    use std::f64::consts::PI;

    const LIGHT_M: Vec3 = Vec3::new(2.0, 1.0, 1.5);

    #[test]
    fn where_the_light_is_seen_it_is_the_inverse_square_and_the_cosine() {
        let at_m = Vec3::new(3.2, 1.0, 0.6);
        let normals = [None, Some(Vec3::Z), Some(Vec3::NEG_X), Some(Vec3::NEG_Z)];
        let sensors = normals.map(|normal| sensor(at_m, normal));
        let field = field(&modelled(&two_rooms(), vec![lamp(LIGHT_M, FLUX_W)], sensors.into()), estimate);
        let direct = FLUX_W / (4.0 * PI * 1.5 * 1.5);
        for (reading, cosine) in field.readings.iter().zip([1.0, 0.6, 0.8]) {
            close(reading.value_w_m2, cosine * direct);
            assert!(reading.direction().distance(DVec3::new(-0.8, 0.0, 0.6)) < 1e-6);
        }
        assert_eq!((field.readings[3].value_w_m2, field.readings[3].status), (0.0, Status::Dark));
    }

    #[test]
    fn the_way_is_what_the_answer_is_made_of() {
        let sensors = [Vec3::new(3.2, 1.0, 0.6), Vec3::new(6.0, 0.7, 1.5)].map(|at_m| sensor(at_m, None));
        let model = modelled(&two_rooms(), vec![lamp(LIGHT_M, FLUX_W)], sensors.into());
        let field = field(&model, estimate);
        let (scene, model) = &model;
        let tree = PathTree::from(&model.skeleton, model.shining[0].place.unwrap());
        let lit = Lit { model, light: &model.shining[0], tree: &tree };
        for ((reading, probe), sees) in field.readings.iter().zip(model.probes_at_sensors(scene)).zip([true, false]) {
            let way = way(&lit, &probe).unwrap();
            close(reading.value_w_m2, FLUX_W / (4.0 * PI * way.d_all_m * way.d_all_m));
            assert_eq!(way.seen_share > 0.0, sees);
            assert!(way.nodes.contains(&way.farthest) && way.path_m >= way.d_all_m - 1e-6, "{way:?}");
            assert_eq!((way.nodes.first().copied(), way.nodes.last()), (probe.place.ok(), Some(&tree.root)));
        }
        let lost = Probe { place: Err(Status::InSolid), ..model.probes_at_sensors(scene)[0] };
        assert_eq!(way(&lit, &lost), None);
    }

    #[test]
    fn round_the_corner_it_is_the_inverse_square_of_the_way() {
        let at_m = Vec3::new(6.0, 0.7, 1.5);
        let model = modelled(&two_rooms(), vec![lamp(LIGHT_M, FLUX_W)], vec![sensor(at_m, None)]);
        let reading = field(&model, estimate).readings[0];
        let way_m = (FLUX_W / (4.0 * PI * reading.value_w_m2)).sqrt();
        // The shortest way there is, round the edges of the door; the veins keep to its middle.
        let [first_m, last_m] = [3.8, 4.2].map(|x| Vec3::new(x, 2.0, 1.5));
        let shortest_m = f64::from(LIGHT_M.distance(first_m) + first_m.distance(last_m) + last_m.distance(at_m));
        assert!((shortest_m..1.3 * shortest_m).contains(&way_m), "{way_m} m, the shortest is {shortest_m} m");
        let to_door = (Vec3::new(4.0, 2.5, 1.5) - at_m).as_dvec3();
        assert!(reading.direction().angle_between(to_door).to_degrees() < 25.0, "{:?}", reading.direction());
    }

    #[test]
    fn glazing_lets_its_share_through() {
        let mut triangles = room();
        let walls = triangles.len();
        let pane = boxed(Vec3::new(1.5, 0.0, 0.0), Vec3::new(1.5, 3.0, 3.0));
        triangles.extend(&pane[8..10]);
        let lights = vec![lamp(Vec3::new(1.0, 1.5, 1.5), FLUX_W)];
        let (mut scene, _) = modelled(&triangles, lights, vec![sensor(Vec3::new(2.5, 1.4, 1.5), None)]);
        let glass = crate::scene::Material { transmittance: 0.5, ..scene.materials[0].clone() };
        scene.materials.push(glass);
        scene.mesh.material_of[walls..].fill(1);
        let model = crate::flow::tests::model_of(&scene);
        close(field(&(scene, model), estimate).readings[0].value_w_m2, 0.5 * FLUX_W / (4.0 * PI * (2.25 + 0.01)));
    }

    #[test]
    fn behind_a_quad_light_comes_only_what_goes_round_it() {
        let quad =
            Light::Quad { corner_m: Vec3::new(1.4, 1.4, 2.2), u_m: Vec3::Y * 0.2, v_m: Vec3::X * 0.2, flux_w: FLUX_W };
        let places = [-0.5, 0.5].map(|z| sensor(Vec3::new(1.5, 1.5, 2.2 + z), None));
        let field = field(&modelled(&room(), vec![quad], places.into()), estimate);
        close(field.readings[0].value_w_m2, FLUX_W / (4.0 * PI * 0.25));
        assert!(field.readings[1].value_w_m2 < 0.5 * field.readings[0].value_w_m2, "{field:?}");
    }

    #[test]
    fn at_the_light_itself_it_is_bounded_by_half_a_voxel() {
        let model = modelled(&room(), vec![lamp(Vec3::splat(1.2), FLUX_W)], vec![sensor(Vec3::splat(1.2), None)]);
        let reading = field(&model, estimate).readings[0];
        close(reading.value_w_m2, FLUX_W / (4.0 * PI * model.1.nearest_m().powi(2)));
        assert_eq!(reading.direction(), DVec3::ZERO);
    }
}
