//! The lights: where each is, in the user's coordinates, and how strong.

use super::LISTED;
use crate::panels::{gesture, named, row, rows};
use crate::state::{Picked, State};
use egui::{Button, DragValue, Response, Ui};
use glam::{DVec3, Vec3};
use lightvein::scene::input::FARTHEST_M;
use lightvein::scene::{Light, Scene};
use std::borrow::Cow;

/// Flux of a light that is added, W: a bright household lamp.
const ADDED_FLUX_W: f64 = 100.0;

/// Most flux that can be dragged to, W: a stadium's; a scene file may have more.
const MOST_FLUX_W: f64 = 1e9;

/// The lights as they are asked for: the user's, or the file's. A bare mesh has the one that the library gave it.
pub fn asked(state: &State) -> Cow<'_, [Light]> {
    if let Some(lights) = &state.request.edits.lights {
        return Cow::Borrowed(lights);
    }
    let loaded = state.results.loaded.as_ref().filter(|scene| !scene.bare);
    let scene = loaded.or(state.results.scene.as_ref());
    Cow::Borrowed(scene.map_or(&[], |scene| &scene.lights))
}

/// Shows the lights, and changes them.
pub fn show(ui: &mut Ui, state: &mut State, scene: &Scene) {
    let lights = asked(state).into_owned();
    let is_listed = |number: &usize| *number < LISTED || state.picked == Some(Picked::Light(*number));
    let listed: Vec<usize> = (0..lights.len()).filter(is_listed).collect();
    for number in listed {
        ui.push_id(("light", number), |ui| one(ui, state, scene, &lights, number));
    }
    if lights.len() > LISTED {
        ui.weak(format!("and {} more: pick one in the view", lights.len() - LISTED));
    }
    ui.horizontal(|ui| {
        let add = ui.button("Add a light").on_hover_text("A point light of 100 W, in the middle of what is looked at");
        if add.clicked() {
            let added = Light::Point { position_m: state.camera.target_m, flux_w: ADDED_FLUX_W };
            state.pick(Some(Picked::Light(lights.len())));
            let lights = lights.iter().copied().chain([added]).collect();
            state.change(gesture(&add), |request| request.edits.lights = Some(lights));
        }
        let is_edited = state.request.edits.lights.is_some();
        let reset = ui.add_enabled(is_edited, Button::new("Reset lights"));
        if reset.on_hover_text("As the file has them").clicked() {
            state.change(ui.scope_id().with("reset").value(), |request| request.edits.lights = None);
        }
    });
}

fn one(ui: &mut Ui, state: &mut State, scene: &Scene, lights: &[Light], number: usize) {
    let Some(light) = lights.get(number).copied() else { return };
    let kind = match light {
        Light::Point { .. } => "point".to_owned(),
        Light::Sphere { radius_m, .. } => format!("sphere, radius {radius_m} m"),
        Light::Quad { u_m, v_m, .. } => format!("quad, {:.2} x {:.2} m", u_m.length(), v_m.length()),
    };
    ui.horizontal(|ui| {
        let is_picked = state.picked == Some(Picked::Light(number));
        if ui.selectable_label(is_picked, format!("Light {number}: {kind}")).clicked() {
            state.pick((!is_picked).then_some(Picked::Light(number)));
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let remove = named(ui.small_button("Remove"), &format!("Remove light {number}"));
            if remove.clicked() {
                let mut left = lights.to_vec();
                left.remove(number);
                state.pick(None);
                state.change(gesture(&remove), |request| request.edits.lights = Some(left));
            }
        });
    });
    rows(ui, "light", |ui| {
        row(ui, "Flux", |ui| {
            let mut flux_w = light.flux_w();
            let drag = DragValue::new(&mut flux_w).range(0.0..=MOST_FLUX_W.max(light.flux_w())).suffix(" W");
            let response = ui.add(drag.speed((light.flux_w() * 0.01).max(0.1)).max_decimals(3));
            let response = named(response, &format!("Flux of light {number}"));
            changed(state, &response, lights, number, with_flux(light, flux_w));
        });
        row(ui, "Position", |ui| {
            let from_m = middle_m(&light);
            let at_m = scene.to_user_m(from_m).to_array();
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let mut along_m = at_m[axis];
                let drag = DragValue::new(&mut along_m).range(-FARTHEST_M..=FARTHEST_M).speed(0.02).max_decimals(3);
                let response = ui.add(drag.prefix(format!("{name} ")).suffix(" m"));
                let response = named(response, &format!("{name} of light {number}"));
                let mut moved = DVec3::from_array(at_m);
                moved[axis] = along_m;
                let to_m = (moved - scene.origin_m).as_vec3();
                changed(state, &response, lights, number, moved_by(light, to_m - from_m));
            }
        });
    });
}

/// Puts a changed light in the place of the one of that number.
fn changed(state: &mut State, response: &Response, lights: &[Light], number: usize, light: Light) {
    let gesture = gesture(response);
    if response.changed() {
        let mut lights = lights.to_vec();
        if let Some(place) = lights.get_mut(number) {
            *place = light;
        }
        state.change(gesture, |request| request.edits.lights = Some(lights));
    }
}

/// The middle of a light, metres.
pub fn middle_m(light: &Light) -> Vec3 {
    match *light {
        Light::Point { position_m, .. } => position_m,
        Light::Sphere { centre_m, .. } => centre_m,
        Light::Quad { corner_m, u_m, v_m, .. } => corner_m + 0.5 * (u_m + v_m),
    }
}

/// A light moved by so many metres.
pub fn moved_by(light: Light, by_m: Vec3) -> Light {
    match light {
        Light::Point { position_m, flux_w } => Light::Point { position_m: position_m + by_m, flux_w },
        Light::Sphere { centre_m, radius_m, flux_w } => Light::Sphere { centre_m: centre_m + by_m, radius_m, flux_w },
        Light::Quad { corner_m, u_m, v_m, flux_w } => Light::Quad { corner_m: corner_m + by_m, u_m, v_m, flux_w },
    }
}

/// A light with another flux, W.
pub fn with_flux(light: Light, flux_w: f64) -> Light {
    match light {
        Light::Point { position_m, .. } => Light::Point { position_m, flux_w },
        Light::Sphere { centre_m, radius_m, .. } => Light::Sphere { centre_m, radius_m, flux_w },
        Light::Quad { corner_m, u_m, v_m, .. } => Light::Quad { corner_m, u_m, v_m, flux_w },
    }
}
