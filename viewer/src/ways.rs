//! The ways of what is picked to the lights, and which light is nearest to each node along the veins: by the library's paths.

use crate::panels::inspector::WayToLight;
use crate::results::Results;
use crate::state::Picked;
use lightvein::flow::Lit;
use lightvein::flow::backward::way;
use lightvein::flow::paths::PathTree;
use lightvein::model::{Model, Probe};

/// The probe at what is picked; `None` for what has none.
pub fn probe(results: &Results, picked: Picked) -> Option<Probe> {
    let (scene, model) = (results.scene.as_ref()?, results.model.as_ref()?);
    match picked {
        Picked::Node(node) => {
            let position_m = model.skeleton.graph.node_weight(node)?.position_m;
            Some(Probe { position_m, normal: None, place: Ok(node) })
        }
        Picked::Sensor(sensor) => {
            let sensor = scene.sensors.get(sensor)?;
            Some(model.probe(sensor.position_m, sensor.normal))
        }
        Picked::Light(_) | Picked::Part(_) => None,
    }
}

/// The way from what is picked to each light of the model; empty for what has none.
pub fn to_lights(results: &Results, picked: Picked) -> Vec<WayToLight> {
    let (Some(probe), Some(model)) = (probe(results, picked), &results.model) else { return Vec::new() };
    let to_light = |(light, shining)| {
        let lit = |tree: &PathTree| way(&Lit { model, light: shining, tree }, &probe);
        let tree = shining.place.ok().map(|root| PathTree::from(&model.skeleton, root));
        WayToLight { light, way: tree.as_ref().and_then(lit) }
    };
    model.shining.iter().enumerate().map(to_light).collect()
}

/// For each node the light nearest along the veins, by its number in the model; `None` where no light's path leads.
pub fn nearest_lights(model: &Model) -> Vec<Option<usize>> {
    let mut nearest: Vec<Option<(f64, usize)>> = vec![None; model.skeleton.graph.node_count()];
    for (light, shining) in model.shining.iter().enumerate() {
        let Ok(root) = shining.place else { continue };
        let tree = PathTree::from(&model.skeleton, root);
        for (of_node, distance_m) in nearest.iter_mut().zip(&tree.distance_m) {
            let way_m = distance_m + shining.to_node_m;
            if way_m.is_finite() && of_node.is_none_or(|(known_m, _)| way_m < known_m) {
                *of_node = Some((way_m, light));
            }
        }
    }
    nearest.into_iter().map(|nearest| nearest.map(|(_, light)| light)).collect()
}
