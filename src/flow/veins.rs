//! How much light flows through each edge of the skeleton, and which way?
//!
//! Across a section the net flux is the integral of the vector irradiance over it (Gershun's light field); a field at the nodes
//! knows that vector (its direction points to where the light comes from), so the flux through an edge is the mean of its two
//! ends, along the edge, times the edge's section. It is net: where as much comes from both sides nothing flows, however bright.
//!
//! Limits: the vector is taken as even over the section, which it is not close to a light; the heuristics know one direction
//! a light and put all of the scalar irradiance into it.

use crate::light::Field;
use crate::skeleton::Skeleton;

/// The net flux through each edge from its first node to its second, W, in the order of the edges: positive where light flows
/// that way. Zero where the field has no reading for a node.
pub fn through_edges_w(skeleton: &Skeleton, at_nodes: &Field) -> Vec<f64> {
    let graph = &skeleton.graph;
    let through = |edge| {
        let (a, b) = graph.edge_endpoints(edge)?;
        let along = (graph[b].position_m - graph[a].position_m).as_dvec3().normalize_or_zero();
        let [from_a, from_b] = [a, b].map(|node| at_nodes.readings.get(node.index()).map(|reading| reading.flux_w_m2));
        let comes_from_w_m2 = (from_a? + from_b?) / 2.0;
        Some(-comes_from_w_m2.dot(along) * f64::from(graph[edge].section_m2))
    };
    graph.edge_indices().map(|edge| through(edge).unwrap_or(0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{FLUX_W, lamp, modelled};
    use crate::flow::{backward, network};
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;
    use crate::voxel::test_scenes::boxed;
    use glam::Vec3;

    /// A corridor of 12 x 1 x 1 m with a lamp near one end: light flows away from it all along.
    #[test]
    fn light_flows_away_from_the_lamp_and_gets_less() {
        let light_m = Vec3::new(1.0, 0.5, 0.5);
        let corridor = boxed(Vec3::ZERO, Vec3::new(12.0, 1.0, 1.0));
        let (_, model) = modelled(&corridor, vec![lamp(light_m, FLUX_W)], Vec::new());
        let probes = model.probes_at_nodes();
        let ask = |estimate: &crate::flow::Estimator| {
            let field = estimate(&model, &probes, &Settings::default(), &Quiet, &Cancel::new()).unwrap();
            through_edges_w(&model.skeleton, &field)
        };
        let graph = &model.skeleton.graph;
        for through_w in [ask(&backward::estimate), ask(&network::estimate)] {
            let mut along: Vec<(f32, f64)> = graph
                .edge_indices()
                .filter_map(|edge| {
                    let (a, b) = graph.edge_endpoints(edge)?;
                    let step_m = graph[b].position_m - graph[a].position_m;
                    let towards_far = if step_m.x > 0.0 { 1.0 } else { -1.0 };
                    let x_m = (graph[a].position_m.x + graph[b].position_m.x) / 2.0;
                    ((3.0..10.0).contains(&x_m) && step_m.x != 0.0)
                        .then(|| (x_m, towards_far * through_w[edge.index()]))
                })
                .collect();
            along.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(along.len() > 20 && along.iter().all(|(_, flux_w)| (0.0..FLUX_W).contains(flux_w)), "{along:?}");
            assert!(along[0].1 > 2.0 * along[along.len() - 1].1, "{along:?}");
        }
    }

    #[test]
    fn without_readings_nothing_flows() {
        let (_, model) = modelled(&boxed(Vec3::ZERO, Vec3::new(4.0, 1.0, 1.0)), Vec::new(), Vec::new());
        let through_w = through_edges_w(&model.skeleton, &Field::default());
        assert_eq!(through_w, vec![0.0; model.skeleton.graph.edge_count()]);
    }
}
