//! What is picked: its numbers, its way to each light, and what each method says of it.

mod facts;
mod methods;

pub use facts::facade;
pub use methods::seconds_text;

use super::section;
use crate::state::{Picked, State};
use egui::Ui;
use lightvein::flow::backward::Way;
use lightvein::light::Reading;
use lightvein::scene::Reference;

/// The way from what is picked to one light.
#[derive(Debug, Clone, PartialEq)]
pub struct WayToLight {
    /// The light's number in the model's `shining`.
    pub light: usize,
    /// The way; `None` where no path through the void leads there.
    pub way: Option<Way>,
}

/// Most lights whose ways are listed.
const LISTED: usize = 50;

/// Shows what is picked.
pub fn show(ui: &mut Ui, state: &mut State) {
    if state.picked.is_none() && state.facade.is_none() {
        return super::nothing(
            ui,
            state,
            "Click a node, a sensor, a light or a part in the view; outdoors a wall, for the sun on it.",
        );
    }
    egui::ScrollArea::both().id_salt("inspector").auto_shrink(false).show(ui, |ui| {
        ui.add_space(4.0);
        match state.picked {
            Some(Picked::Node(node)) => facts::node(ui, state, node),
            Some(Picked::Sensor(sensor)) => facts::sensor(ui, state, sensor),
            Some(Picked::Light(light)) => facts::light(ui, state, light),
            Some(Picked::Part(part)) => facts::part(ui, state, part),
            None => {}
        }
        if state.facade.is_some() {
            ui.heading("Face");
            facade(ui, state);
        }
        let Some(picked) = state.picked else { return };
        if matches!(picked, Picked::Node(_) | Picked::Sensor(_)) {
            if state.results.estimate.is_some() {
                section(ui, "Methods", true, |ui| methods::show(ui, state, picked));
            }
            if state.results.model.is_some() {
                section(ui, "Ways to the lights", true, |ui| ways(ui, state));
            }
        }
    });
}

/// The reading of the current estimate at what is picked.
fn reading(state: &State, picked: Picked) -> Option<Reading> {
    let estimate = state.results.estimate.as_ref()?;
    match picked {
        Picked::Node(node) => estimate.at_nodes.readings.get(node.index()).copied(),
        Picked::Sensor(sensor) => estimate.at_sensors.readings.get(sensor).copied(),
        Picked::Light(_) | Picked::Part(_) => None,
    }
}

/// What is known of what is picked.
fn reference(state: &State, picked: Picked) -> Option<Reference> {
    let Picked::Sensor(sensor) = picked else { return None };
    state.results.scene.as_ref()?.reference.get(sensor).copied().flatten()
}

/// What a light of the model is called.
fn light_name(state: &State, shining: usize) -> String {
    use lightvein::light::Shape;
    let sources = state.results.model.as_ref().map(|model| &model.sources);
    match sources.and_then(|sources| sources.emitters.get(shining)).map(|emitter| &emitter.shape) {
        Some(Shape::Light(number, _)) => format!("Light {number}"),
        Some(Shape::Patch { triangles, .. }) => format!("Shining faces ({})", triangles.len()),
        None => format!("Light {shining}"),
    }
}

fn ways(ui: &mut Ui, state: &State) {
    let (Some(scene), Some(model)) = (&state.results.scene, &state.results.model) else { return };
    if state.ways.is_empty() {
        ui.weak("no light is on");
    }
    for to_light in state.ways.iter().take(LISTED) {
        ui.strong(light_name(state, to_light.light));
        super::rows(ui, ("way", to_light.light), |ui| {
            let Some(way) = &to_light.way else {
                return super::told(ui, "Path", "none leads there through the void");
            };
            let seen = match way.seen_share {
                share if share >= 1.0 => "yes".to_owned(),
                share if share > 0.0 => format!("{:.0} %, through glazing", 100.0 * share),
                _ => "no".to_owned(),
            };
            super::told(ui, "Seen from here", seen);
            super::told(ui, "Path length", format!("{:.3} m, {} nodes", way.path_m, way.nodes.len()));
            let farthest_m = super::position(scene, model.node_m(way.farthest));
            super::told(ui, "Farthest visible", format!("node {} at {farthest_m}", way.farthest.index()));
            super::told(ui, "d_all of backward", format!("{:.3} m", way.d_all_m));
        });
    }
    if state.ways.len() > LISTED {
        ui.weak(format!("and {} more", state.ways.len() - LISTED));
    }
}
