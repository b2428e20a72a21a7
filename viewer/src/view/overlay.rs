//! What stands over the picture: chips, names, the tip at the pointer, exposure pixel by pixel, and the legends.

use super::Frame;
use crate::draw::marks::position_m;
use crate::measure::{Measure, shown};
use crate::outdoors::shown as outdoors;
use crate::panels::{number, scene::asked_lights};
use crate::state::{Picked, State};
use egui::{Align2, Color32, FontId, Pos2, Rect, RichText, Ui, vec2};
use glam::Vec3;

/// Names of sensors beyond this many would cover the picture.
const MOST_NAMES: usize = 200;

/// What stands over one frame.
pub struct Over<'a> {
    /// Where the pane is.
    pub frame: &'a Frame,
    /// Names in the scene.
    pub labels: &'a [(Vec3, String)],
    /// What could not be drawn.
    pub notes: &'a [String],
}

/// Shows all of it.
pub fn show(ui: &mut Ui, state: &mut State, over: &Over) {
    let painter = ui.painter_at(over.frame.rect);
    if let Some(texture) = outdoors::overlay(state, ui.ctx(), over.frame.size_px) {
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        painter.image(texture.id(), over.frame.rect, whole, Color32::WHITE);
    }
    for (at_m, name) in over.labels {
        name_at(&painter, state, over.frame, *at_m, name);
    }
    if let Some((at_m, length_m)) = state.gizmo {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            name_at(&painter, state, over.frame, at_m + Vec3::AXES[axis] * 1.18 * length_m, name);
        }
    }
    if state.layers.sensors && state.layers.sensor_values {
        sensor_names(&painter, state, over.frame);
    }
    chips(ui, state, over);
    tip(ui, state);
    crate::legend::show(ui, state, over.frame.rect);
}

/// Chips in the upper left corner: what the picture leaves out, and whether it is of now.
fn chips(ui: &mut Ui, state: &mut State, over: &Over) {
    if state.results.scene.is_none() {
        let text =
            if state.is_busy() { "opening the scene" } else { "no scene is open: File, Open, or drop a file here" };
        outlined(&ui.painter_at(over.frame.rect), over.frame.rect.center(), Align2::CENTER_CENTER, text, 16.0);
        return;
    }
    let at = over.frame.rect.min + vec2(10.0, 10.0);
    let area = Rect::from_min_size(at, vec2(over.frame.rect.width() - 20.0, 26.0));
    let mut chips =
        ui.new_child(egui::UiBuilder::new().max_rect(area).layout(egui::Layout::left_to_right(egui::Align::Min)));
    let chip = |ui: &mut Ui, text: &str, colour: Color32, why: &str| {
        let frame = egui::Frame::new().fill(colour).corner_radius(9).inner_margin(egui::Margin::symmetric(8, 3));
        frame
            .show(ui, |ui| ui.label(RichText::new(text).color(Color32::BLACK).small().strong()))
            .response
            .on_hover_text(why)
    };
    let has_results = state.results.estimate.is_some() || state.results.outdoors.sky.is_some();
    if has_results && state.is_stale() {
        chip(
            &mut chips,
            "Stale",
            Color32::from_rgb(240, 180, 60),
            "Shown is the result of an older request; the new one is on its way, or was stopped.",
        );
    }
    if state.results.estimate.as_ref().is_some_and(|estimate| estimate.is_first_pass) {
        chip(
            &mut chips,
            "First pass",
            Color32::from_rgb(150, 200, 240),
            "A fast first estimate by backward; the method that was asked for follows.",
        );
    }
    if state.layers.cut && state.layers.mesh {
        let why = "The mesh is cut below the ceiling; skeleton and sensors are not. Click to show all.";
        let response = chip(&mut chips, "Cut", Color32::from_rgb(200, 200, 200), why).interact(egui::Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Cut: show the whole mesh"));
        if response.clicked() {
            state.layers.cut = false;
        }
    }
    if state.layers.section.is_some() {
        chip(&mut chips, "Section", Color32::from_rgb(200, 200, 200), "The mesh is cut by the free plane.");
    }
    for note in over.notes {
        chip(&mut chips, note, Color32::from_rgb(240, 200, 160), "Too much for one picture.");
    }
}

/// A name beside a place in the scene.
fn name_at(painter: &egui::Painter, state: &State, frame: &Frame, at_m: Vec3, name: &str) {
    let Some((at_px, _)) = state.camera.project(at_m, frame.size_px) else { return };
    let at = frame.to_point(at_px);
    if frame.rect.contains(at) {
        outlined(painter, at, Align2::CENTER_CENTER, name, 13.0);
    }
}

/// The sensors' names with their values.
fn sensor_names(painter: &egui::Painter, state: &State, frame: &Frame) {
    let Some(scene) = &state.results.scene else { return };
    let measure = state.layers.sensor_measure();
    let values = measure.at_sensors(&state.results);
    let readings = state.results.estimate.as_ref().map_or(&[][..], |estimate| &estimate.at_sensors.readings);
    for (place, sensor) in scene.sensors.iter().enumerate().take(MOST_NAMES) {
        let value = match values.get(place) {
            Some(value) if value.is_finite() => format!("{} {}", number(f64::from(*value)), measure.unit()),
            _ => readings.get(place).map_or("", |reading| reading.status.name()).replace('_', " "),
        };
        let Some((at_px, _)) = state.camera.project(sensor.position_m, frame.size_px) else { continue };
        let at = frame.to_point(at_px) + vec2(9.0, -9.0);
        if frame.rect.contains(at) {
            outlined(painter, at, Align2::LEFT_CENTER, &format!("{}  {value}", sensor.id), 12.5);
        }
    }
}

/// Text that reads on any ground.
fn outlined(painter: &egui::Painter, at: Pos2, align: Align2, text: &str, size: f32) {
    let is_dark = painter.ctx().theme() == egui::Theme::Dark;
    let (ink, ground) = if is_dark {
        (Color32::WHITE, Color32::from_black_alpha(200))
    } else {
        (Color32::BLACK, Color32::from_white_alpha(220))
    };
    let font = FontId::proportional(size);
    for (x, y) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (-0.7, -0.7), (0.7, 0.7), (0.7, -0.7), (-0.7, 0.7)]
    {
        painter.text(at + vec2(x, y), align, text, font.clone(), ground);
    }
    painter.text(at, align, text, font, ink);
}

/// What is under the pointer, in a tip.
fn tip(ui: &Ui, state: &State) {
    let Some(hovered) = state.hovered else { return };
    let Some(text) = words(state, hovered) else { return };
    egui::Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), ui.scope_id().with("tip"), egui::PopupAnchor::Pointer)
        .gap(14.0)
        .show(|ui| ui.label(text));
}

/// What something is, and its value, in a line or two.
pub fn words(state: &State, picked: Picked) -> Option<String> {
    let results = &state.results;
    let estimate = results.estimate.as_deref();
    let value = |reading: Option<&lightvein::light::Reading>| {
        reading.map_or_else(String::new, |reading| match shown(reading) {
            value if value.is_finite() => format!("\n{} W/m²", number(f64::from(value))),
            _ => format!("\n{}", reading.status.name().replace('_', " ")),
        })
    };
    let lights = asked_lights(state);
    position_m(results, &lights, picked)?;
    Some(match picked {
        Picked::Node(node) => {
            let reading = estimate.and_then(|estimate| estimate.at_nodes.readings.get(node.index()));
            let cell = results.model.as_ref()?.skeleton.graph[node].cell;
            format!("node {}, cell {cell}{}", node.index(), value(reading))
        }
        Picked::Sensor(sensor) => {
            let reading = estimate.and_then(|estimate| estimate.at_sensors.readings.get(sensor));
            let exposure = Measure::of(state.layers.quantity);
            let exposed = exposure
                .at_sensors(results)
                .get(sensor)
                .filter(|value| value.is_finite())
                .map(|value| format!("\n{}: {} {}", exposure.title(), number(f64::from(*value)), exposure.unit()));
            let id = &results.scene.as_ref()?.sensors.get(sensor)?.id;
            format!("sensor {id}{}{}", value(reading), exposed.unwrap_or_default())
        }
        Picked::Light(light) => format!("light {light}\n{} W", number(lights.get(light)?.flux_w())),
        Picked::Part(part) => results.scene.as_ref()?.parts.get(part)?.name.clone(),
    })
}
