//! What can be changed: lights, materials, how the estimate is made, parts of the mesh.
//!
//! Bounds are those of the library; what it refuses all the same (voxels too small for the memory, say) it says in the log.

mod how;
mod lights;
mod parts;

pub use lights::{asked as asked_lights, middle_m, moved_by, with_flux};

use super::{decimals, gesture, row, rows, scrolled, section};
use crate::state::{Action, State};
use egui::{Slider, Ui};

/// Most lights, or materials, that are listed at once; the picked one always is.
const LISTED: usize = 64;

/// Shows what can be changed, and changes it while it is dragged.
pub fn show(ui: &mut Ui, state: &mut State) {
    let Some(scene) = state.results.loaded.clone() else {
        return super::nothing(ui, state, "no scene is open");
    };
    scrolled(ui, "scene", |ui| {
        ui.horizontal(|ui| {
            let [undo, redo] = state.history.can();
            if ui.add_enabled(undo, egui::Button::new("Undo")).clicked() {
                state.ask(Action::Undo);
            }
            if ui.add_enabled(redo, egui::Button::new("Redo")).clicked() {
                state.ask(Action::Redo);
            }
            let is_changed = !state.request.edits.is_empty();
            let reset = ui.add_enabled(is_changed, egui::Button::new("Reset scene"));
            if reset.on_hover_text("Lights, reflectances and parts as the file has them").clicked() {
                state.change(ui.scope_id().with("reset").value(), |request| request.edits = Default::default());
            }
        });
        section(ui, "Estimate", true, |ui| how::show(ui, state));
        section(ui, "Lights", true, |ui| lights::show(ui, state, &scene));
        section(ui, "Reflectance", true, |ui| reflectances(ui, state, &scene));
        section(ui, "Parts of the mesh", scene.parts.len() > 1, |ui| parts::show(ui, state, &scene));
    });
}

/// A slider for each material's reflectance.
fn reflectances(ui: &mut Ui, state: &mut State, scene: &lightvein::scene::Scene) {
    if scene.materials.is_empty() {
        ui.weak("the scene has no materials");
    }
    rows(ui, "reflectances", |ui| {
        for (number, material) in scene.materials.iter().enumerate().take(LISTED) {
            row(ui, &material.name, |ui| {
                if material.emits() {
                    ui.weak(format!("gives off {} W/m²/sr", super::number(f64::from(material.emission_w_m2_sr))));
                    return;
                }
                let edited = state.request.edits.reflectances.get(&number).copied();
                let mut reflectance = edited.unwrap_or(material.reflectance);
                let response = ui.add(Slider::new(&mut reflectance, 0.0..=1.0).custom_formatter(decimals(2)));
                let gesture = gesture(&response);
                if response.changed() {
                    state.change(gesture, |request| {
                        request.edits.reflectances.insert(number, reflectance);
                    });
                }
            });
        }
    });
    if scene.materials.len() > LISTED {
        ui.weak(format!("and {} more", scene.materials.len() - LISTED));
    }
}
