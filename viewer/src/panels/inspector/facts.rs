//! The numbers of what is picked, with their units.

use super::{reading, reference};
use crate::measure::Measure;
use crate::panels::{number, position, rows, told};
use crate::state::{Picked, State};
use egui::Ui;
use lightvein::daylight::Quantity;
use lightvein::light::Reading;
use lightvein::scene::{Light, Reference};
use petgraph::graph::NodeIndex;

/// A node of the skeleton.
pub fn node(ui: &mut Ui, state: &State, index: NodeIndex) {
    let (Some(scene), Some(model)) = (&state.results.scene, &state.results.model) else { return };
    let Some(node) = model.skeleton.graph.node_weight(index) else { return };
    ui.heading(format!("Node {}", index.index()));
    rows(ui, "node", |ui| {
        told(ui, "Position", position(scene, node.position_m));
        told(ui, "Ball radius", format!("{:.3} m", node.radius_m));
        told(ui, "Saliency", format!("{:.3}", node.saliency()));
        let cell_m3 = model.skeleton.cells.get(node.cell as usize).map(|cell| cell.volume_m3);
        let cell = cell_m3.map_or(String::new(), |volume_m3| format!(" of {volume_m3:.2} m³"));
        told(ui, "Cell", format!("{}{cell}", node.cell));
        told(ui, "Void nearest to it", format!("{} m³", number(f64::from(node.volume_m3))));
        told(ui, "Edges", model.skeleton.graph.edges(index).count().to_string());
        if let Some(reading) = reading(state, Picked::Node(index)) {
            answer(ui, &reading, "Scalar irradiance", None);
        }
    });
}

/// A sensor.
pub fn sensor(ui: &mut Ui, state: &State, index: usize) {
    let Some(scene) = &state.results.scene else { return };
    let Some(sensor) = scene.sensors.get(index) else { return };
    ui.heading(format!("Sensor {}", sensor.id));
    rows(ui, "sensor", |ui| {
        told(ui, "Position", position(scene, sensor.position_m));
        match sensor.normal {
            Some(normal) => told(ui, "Normal", format!("{:.3}, {:.3}, {:.3}", normal.x, normal.y, normal.z)),
            None => told(ui, "Normal", "none: light from all sides counts"),
        }
        if let Some(reading) = reading(state, Picked::Sensor(index)) {
            let quantity = if sensor.normal.is_some() { "Irradiance" } else { "Scalar irradiance" };
            answer(ui, &reading, quantity, reference(state, Picked::Sensor(index)));
        }
        let exposures = state.results.outdoors.sensors.as_ref().map(|sensors| &sensors.exposures);
        if let Some(exposure) = exposures.and_then(|exposures| exposures.get(index)) {
            for quantity in Quantity::ALL {
                let measure = Measure::of(quantity);
                told(ui, measure.title(), format!("{} {}", number(quantity.of(exposure)), measure.unit()));
            }
        }
    });
}

fn answer(ui: &mut Ui, reading: &Reading, quantity: &str, reference: Option<Reference>) {
    told(ui, quantity, format!("{} W/m²", number(reading.value_w_m2)));
    if let Some(error_w_m2) = reading.error_w_m2 {
        told(ui, "Its own error estimate", format!("{} W/m²", number(error_w_m2)));
    }
    told(ui, "Status", reading.status.name().replace('_', " "));
    let direction = reading.direction();
    if direction != glam::DVec3::ZERO {
        told(ui, "Comes from", format!("{:.3}, {:.3}, {:.3}", direction.x, direction.y, direction.z));
    }
    if let Some(Reference { irradiance_w_m2, stderr_w_m2, .. }) = reference {
        let [value, error] = [irradiance_w_m2, stderr_w_m2].map(number);
        told(ui, "Reference", format!("{value} W/m²"));
        told(ui, "Its standard error", format!("{error} W/m²"));
        if irradiance_w_m2 > 0.0 {
            told(ui, "Estimate / reference", number(reading.value_w_m2 / irradiance_w_m2));
        }
    }
}

/// A light of the scene.
pub fn light(ui: &mut Ui, state: &State, index: usize) {
    let Some(scene) = &state.results.scene else { return };
    let lights = crate::panels::scene::asked_lights(state);
    let Some(light) = lights.get(index) else { return };
    ui.heading(format!("Light {index}"));
    rows(ui, "light", |ui| {
        told(ui, "Position", position(scene, crate::panels::scene::middle_m(light)));
        told(ui, "Flux", format!("{} W", number(light.flux_w())));
        match *light {
            Light::Point { .. } => told(ui, "Kind", "point, alike in all directions"),
            Light::Sphere { radius_m, .. } => told(ui, "Kind", format!("sphere of {radius_m} m radius")),
            Light::Quad { u_m, v_m, .. } => {
                told(ui, "Kind", format!("quad of {:.3} x {:.3} m", u_m.length(), v_m.length()));
                let normal = u_m.cross(v_m).normalize_or_zero();
                told(ui, "Shines along", format!("{:.3}, {:.3}, {:.3}", normal.x, normal.y, normal.z));
            }
        }
        let shining = state.results.model.as_ref().and_then(|model| model.shining.get(index));
        match shining.map(|shining| shining.place) {
            Some(Ok(node)) => told(ui, "Enters the skeleton", format!("at node {}", node.index())),
            Some(Err(status)) => {
                told(ui, "Enters the skeleton", format!("nowhere: {}", status.name().replace('_', " ")))
            }
            None => {}
        }
    });
}

/// A part of the mesh.
pub fn part(ui: &mut Ui, state: &State, index: usize) {
    let Some(scene) = &state.results.loaded else { return };
    let Some(part) = scene.parts.get(index) else { return };
    ui.heading(&part.name);
    rows(ui, "part", |ui| {
        let triangles: usize = part.triangles.iter().map(|range| range.len()).sum();
        told(ui, "Triangles", triangles.to_string());
        for (_, edit) in state.request.edits.parts.iter().filter(|(name, _)| *name == part.name) {
            use lightvein::scene::parts::Edit;
            match edit {
                Edit::Scale(by) => told(ui, "Scaled", format!("{by} times")),
                Edit::Move(by_m) => told(ui, "Moved", format!("{:.3}, {:.3}, {:.3} m", by_m.x, by_m.y, by_m.z)),
                Edit::Hide => told(ui, "Hidden", "yes"),
            }
        }
    });
}

/// The face that was touched: how it stands, and how the sun meets it at the shown moment.
pub fn facade(ui: &mut Ui, state: &State) {
    let (Some(facade), Some(scene)) = (&state.facade, &state.results.scene) else { return };
    let (Some(now), Some(sky)) = (&state.outdoors.now, &state.results.outdoors.sky) else { return };
    rows(ui, "facade", |ui| {
        told(ui, "Touched at", position(scene, facade.at_m));
        for (name, value) in facade.rows(now.sun, sky.outdoors.north_rad) {
            told(ui, name, value);
        }
        told(ui, "At", now.moment.strftime("%-d %b, %H:%M").to_string());
    });
}
