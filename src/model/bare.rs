//! What is a mesh without a scene file lit by?

use super::Model;
use crate::scene::{Light, Scene, Sensor};
use petgraph::graph::NodeIndex;

/// Flux of the light that is put into a bare mesh, W: a bright household lamp.
const BARE_FLUX_W: f64 = 100.0;

/// Puts a light in the middle of the largest cell of a mesh that came without any, and a scalar sensor at the middle of
/// every cell; says so in the scene's warnings.
pub fn light_bare_mesh(scene: &mut Scene, model: Model) -> Model {
    let cells = &model.skeleton.cells;
    let largest = cells.iter().enumerate().max_by(|(_, a), (_, b)| a.volume_m3.total_cmp(&b.volume_m3));
    let Some((number, largest)) = largest else {
        scene.warnings.push("the mesh encloses no void that a light could stand in".to_owned());
        return model;
    };
    let position_m = model.node_m(largest.centre);
    scene.lights = vec![Light::Point { position_m, flux_w: BARE_FLUX_W }];
    let sensor = |(cell, centre): (usize, NodeIndex)| Sensor {
        id: format!("cell {cell}"),
        position_m: model.node_m(centre),
        normal: None,
    };
    scene.sensors = cells.iter().map(|cell| cell.centre).enumerate().map(sensor).collect();
    scene.warnings.push(format!(
        "a bare mesh: a light of {BARE_FLUX_W} W stands at {:.3} in the middle of its largest cell ({number}), and a sensor \
         in the middle of each",
        scene.to_user_m(position_m)
    ));
    model.relit(scene)
}
