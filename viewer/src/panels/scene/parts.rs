//! Parts of the mesh: hide, move, scale.

use crate::panels::{gesture, named, row, rows};
use crate::state::{Picked, State};
use egui::{DragValue, Slider, Ui};
use glam::DVec3;
use lightvein::scene::Scene;
use lightvein::scene::parts::{Edit, FARTHEST_MOVE_M, SCALES};

/// Height of the list, points: some ten rows.
const LIST_HEIGHT: f32 = 200.0;

/// What is done to one part.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Done {
    scale: f64,
    move_m: DVec3,
    is_hidden: bool,
}

impl Done {
    fn of(edits: &[(String, Edit)], name: &str) -> Self {
        let mut done = Self { scale: 1.0, move_m: DVec3::ZERO, is_hidden: false };
        for (_, edit) in edits.iter().filter(|(of, _)| of == name) {
            match *edit {
                Edit::Scale(by) => done.scale = by,
                Edit::Move(by_m) => done.move_m = by_m,
                Edit::Hide => done.is_hidden = true,
            }
        }
        done
    }

    /// Puts these edits of a part in the place of those that there are.
    fn put(self, edits: &mut Vec<(String, Edit)>, name: &str) {
        edits.retain(|(of, _)| of != name);
        let scale = (self.scale != 1.0).then_some(Edit::Scale(self.scale));
        let shift = (self.move_m != DVec3::ZERO).then_some(Edit::Move(self.move_m));
        let hide = self.is_hidden.then_some(Edit::Hide);
        edits.extend([scale, shift, hide].into_iter().flatten().map(|edit| (name.to_owned(), edit)));
    }
}

/// Shows the parts, and hides, moves and scales them.
pub fn show(ui: &mut Ui, state: &mut State, scene: &Scene) {
    let height = ui.spacing().interact_size.y;
    egui::ScrollArea::vertical().id_salt("parts").max_height(LIST_HEIGHT).auto_shrink([false, true]).show_rows(
        ui,
        height,
        scene.parts.len(),
        |ui, listed| {
            for number in listed {
                let Some(part) = scene.parts.get(number) else { continue };
                ui.horizontal(|ui| {
                    let done = Done::of(&state.request.edits.parts, &part.name);
                    let mut is_shown = !done.is_hidden;
                    let shown = ui.name_inputs(format!("Show {}", part.name), |ui| ui.checkbox(&mut is_shown, ""));
                    changed(state, &shown, &part.name, Done { is_hidden: !is_shown, ..done });
                    let is_picked = state.picked == Some(Picked::Part(number));
                    if ui.selectable_label(is_picked, &part.name).clicked() {
                        state.pick((!is_picked).then_some(Picked::Part(number)));
                    }
                });
            }
        },
    );

    let Some(Picked::Part(number)) = state.picked else {
        ui.weak("Pick a part to move or scale it.");
        return;
    };
    let Some(part) = scene.parts.get(number) else { return };
    let done = Done::of(&state.request.edits.parts, &part.name);
    rows(ui, "part", |ui| {
        row(ui, "Move by", |ui| {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let mut move_m = done.move_m;
                let drag = DragValue::new(&mut move_m[axis]).range(-FARTHEST_MOVE_M..=FARTHEST_MOVE_M).speed(0.05);
                let drag = drag.max_decimals(3).prefix(format!("{name} ")).suffix(" m");
                let response = named(ui.add(drag), &format!("Move part along {name}"));
                changed(state, &response, &part.name, Done { move_m, ..done });
            }
        });
        row(ui, "Scale part", |ui| {
            let mut scale = done.scale;
            let response = ui.add(Slider::new(&mut scale, SCALES[0]..=SCALES[1]).logarithmic(true).suffix(" x"));
            changed(state, &response, &part.name, Done { scale, ..done });
        });
    });
    if part.keeps_for_others > 0 {
        ui.weak(format!("It keeps {} faces that other parts have in the same place.", part.keeps_for_others));
    }
    let reset = ui.button("Reset part");
    if reset.clicked() {
        let name = part.name.clone();
        state.change(gesture(&reset), |request| request.edits.parts.retain(|(of, _)| *of != name));
    }
}

fn changed(state: &mut State, response: &egui::Response, name: &str, done: Done) {
    let gesture = gesture(response);
    if response.changed() {
        state.change(gesture, |request| done.put(&mut request.edits.parts, name));
    }
}
