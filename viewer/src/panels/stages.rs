//! Where the time went and how large everything is.

use super::inspector::seconds_text;
use super::{rows, scrolled, section, told};
use crate::results::Stage;
use crate::state::State;
use egui::{Align2, FontId, Rect, RichText, Sense, Ui, pos2, vec2};

/// Indent of a stage within another, points.
const INDENT: f32 = 14.0;

/// Width of the column of names, points.
const NAMES: f32 = 170.0;

/// Width of the columns of time and of memory, points.
const NUMBERS: f32 = 66.0;

/// Shows the stages of the last run, what was modelled, and what a reader should know of it.
pub fn show(ui: &mut Ui, state: &mut State) {
    if state.results.stages.is_empty() && state.results.model.is_none() {
        return super::nothing(ui, state, "nothing was computed yet");
    }
    scrolled(ui, "stages", |ui| {
        section(ui, "Time and memory", true, |ui| stages(ui, &state.results.stages));
        section(ui, "What was modelled", true, |ui| model(ui, state));
        if !state.results.warnings.is_empty() {
            section(ui, &format!("Warnings ({})", state.results.warnings.len()), true, |ui| {
                for warning in &state.results.warnings {
                    ui.label(warning);
                }
            });
        }
    });
}

fn stages(ui: &mut Ui, stages: &[Stage]) {
    let whole: f64 = stages.iter().filter(|stage| stage.depth == 0).map(|stage| stage.seconds).sum();
    for stage in stages {
        bar(ui, stage, if whole > 0.0 { (stage.seconds / whole) as f32 } else { 0.0 });
    }
    if whole > 0.0 {
        ui.label(RichText::new(format!("{} in all", seconds_text(whole))).strong());
    }
}

/// A stage as a row: name, bar, time, memory.
fn bar(ui: &mut Ui, stage: &Stage, share: f32) {
    let memory = stage.peak_memory_mb.map_or(String::new(), |megabytes| format!("{megabytes:.0} MB"));
    let height = ui.text_style_height(&egui::TextStyle::Body) + 2.0;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let time = seconds_text(stage.seconds);
    response
        .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, format!("{} {time} {memory}", stage.name)));

    let painter = ui.painter_at(rect);
    let visuals = ui.visuals();
    let font = FontId::proportional(egui::TextStyle::Body.resolve(ui.style()).size);
    let left = rect.left() + INDENT * stage.depth as f32;
    let text = |at: f32, align: Align2, text: &str, colour| {
        painter.text(pos2(at, rect.center().y), align, text, font.clone(), colour);
    };
    text(left, Align2::LEFT_CENTER, &stage.name, visuals.text_color());
    text(rect.right(), Align2::RIGHT_CENTER, &memory, visuals.weak_text_color());
    text(rect.right() - NUMBERS, Align2::RIGHT_CENTER, &time, visuals.text_color());

    let room = Rect::from_min_max(
        pos2(rect.left() + NAMES, rect.top() + 3.0),
        pos2((rect.right() - 2.0 * NUMBERS).max(rect.left() + NAMES), rect.bottom() - 3.0),
    );
    let filled = room.with_max_x(room.left() + (room.width() * share).max(1.0));
    painter.rect_filled(room, 2.0, visuals.extreme_bg_color);
    let strength = 1.0 / (1.0 + stage.depth as f32);
    painter.rect_filled(filled, 2.0, visuals.selection.bg_fill.gamma_multiply(0.4 + 0.6 * strength));
}

fn model(ui: &mut Ui, state: &State) {
    let Some(model) = &state.results.model else {
        ui.weak("nothing yet");
        return;
    };
    rows(ui, "model", |ui| {
        let lattice = &model.voxels.lattice;
        let [x, y, z] = lattice.size;
        told(ui, "Voxel", format!("{} m", lattice.voxel_m));
        told(ui, "Grid", format!("{x} x {y} x {z}, {:.2} million voxels", lattice.voxels() as f64 / 1e6));
        let shape = model.skeleton.shape();
        told(ui, "Nodes", model.skeleton.graph.node_count().to_string());
        told(ui, "Edges", model.skeleton.graph.edge_count().to_string());
        told(ui, "Components", shape.components.to_string());
        told(ui, "Loops", shape.loops.to_string());
        told(ui, "Cells", model.skeleton.cells.len().to_string());
        told(ui, "Necks", shape.necks.to_string());
        told(ui, "Lights", model.shining.len().to_string());
        if let Some(scene) = &state.results.scene {
            told(ui, "Triangles", scene.mesh.triangles.len().to_string());
            told(ui, "Sensors", scene.sensors.len().to_string());
        }
    });
}
