//! Sun and sky: where and when, what is shown of the exposure, and what the period brings.

pub mod light;
mod period;
mod place;
mod time;

pub use place::with_weather;

use super::{choice, gesture, named, row, rows, scrolled, section, told};
use crate::layers::MeshColour;
use crate::outdoors::{OutdoorRequest, QUANTITIES};
use crate::state::State;
use egui::{DragValue, Response, Ui};
use lightvein::daylight::Quantity;
use lightvein::scene::Site;

/// Shortest and longest sides of patches, metres; too many of them the library refuses.
const PATCH_M: std::ops::RangeInclusive<f32> = 0.001..=10_000.0;

/// Where a scene stands that was given a place and no more: Santiago de Compostela, as good as any.
const SOMEWHERE: (f64, f64, f64) = (42.88, -8.54, 0.0);

/// Where exposure is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shown {
    Nowhere,
    OnFaces,
    ByPixel,
}

/// Shows sun and sky, and changes them.
pub fn show(ui: &mut Ui, state: &mut State) {
    let Some(scene) = state.results.loaded.clone() else {
        return super::nothing(ui, state, "no scene is open");
    };
    if state.request.outdoors.is_none() {
        return offer(ui, state, &scene);
    }
    scrolled(ui, "outdoors", |ui| {
        section(ui, "Date and time", true, |ui| time::show(ui, state));
        section(ui, "Light", true, |ui| light::show(ui, &mut state.layers));
        picked(ui, state);
        section(ui, "Exposure", true, |ui| exposure(ui, state));
        section(ui, "Period and air", true, |ui| period::show(ui, state));
        section(ui, "Place", true, |ui| place::show(ui, state));
        notes(ui, state);
        let stop = ui.button("Leave sun and sky out").on_hover_text("Nothing is computed of them any more");
        if stop.clicked() {
            state.change(gesture(&stop), |request| request.outdoors = None);
            (state.layers.sun_path, state.layers.shadows, state.facade) = (false, false, None);
            show_exposure(state, Shown::Nowhere);
        }
    });
}

/// How the sun meets the face that was picked.
fn picked(ui: &mut Ui, state: &State) {
    if state.facade.is_some() {
        section(ui, "Picked face", true, |ui| super::inspector::facade(ui, state));
    }
}

/// Asks whether a scene is to have sun and sky.
fn offer(ui: &mut Ui, state: &mut State, scene: &lightvein::scene::Scene) {
    ui.add_space(8.0);
    let has_site = scene.site.is_some();
    ui.label(match has_site {
        true => "The scene's file says where it stands.",
        false => "The scene's file does not say where it stands.",
    });
    let begin = ui.button(if has_site { "Ask sun and sky" } else { "Give it a place" });
    if begin.clicked() {
        let (latitude_deg, longitude_deg, utc_offset_h) = SOMEWHERE;
        let somewhere = Site {
            latitude_deg: Some(latitude_deg),
            longitude_deg: Some(longitude_deg),
            utc_offset_h: Some(utc_offset_h),
            ..Site::default()
        };
        let asked = OutdoorRequest { site: (!has_site).then_some(somewhere), ..OutdoorRequest::default() };
        state.change(gesture(&begin), |request| request.outdoors = Some(asked));
        state.layers.sun_path = true;
        show_exposure(state, Shown::OnFaces);
    }
}

/// The site that is asked about: the user's, or the file's.
fn site(state: &State) -> Site {
    let asked = state.request.outdoors.as_ref().and_then(|asked| asked.site.clone());
    let of_file = || state.results.loaded.as_ref()?.site.clone();
    asked.or_else(of_file).unwrap_or_default()
}

/// Changes the site where a widget was changed.
fn changed(state: &mut State, response: &Response, change: impl FnOnce(&mut Site)) {
    let gesture = gesture(response);
    if response.changed() || response.clicked() {
        let mut site = site(state);
        change(&mut site);
        change_asked(state, gesture, |asked| asked.site = Some(site));
    }
}

fn change_asked(state: &mut State, gesture: u64, change: impl FnOnce(&mut OutdoorRequest)) {
    state.change(gesture, |request| change(request.outdoors.get_or_insert_default()));
}

fn exposure(ui: &mut Ui, state: &mut State) {
    rows(ui, "exposure", |ui| {
        row(ui, "Quantity", |ui| choice(ui, &mut state.layers.quantity, &QUANTITIES, short));
        row(ui, "Shown", |ui| {
            let mut shown = shown(state);
            let before = shown;
            for (one, name) in
                [(Shown::OnFaces, "On faces"), (Shown::ByPixel, "Pixel by pixel"), (Shown::Nowhere, "Not")]
            {
                ui.radio_value(&mut shown, one, name);
            }
            if shown != before {
                show_exposure(state, shown);
                // Back on the faces they have to be there, or the choice shows nothing.
                if shown == Shown::OnFaces && state.request.outdoors.as_ref().is_some_and(|asked| !asked.on_faces) {
                    change_asked(state, ui.scope_id().with("on faces").value(), |asked| asked.on_faces = true);
                }
            }
        });
        row(ui, "Patches", |ui| patches(ui, state));
        totals(ui, state);
    });
    if state.camera.orthographic && state.layers.per_pixel {
        ui.weak("Pixels are asked in perspective alone: switch the projection (key 5).");
    }
}

fn patches(ui: &mut Ui, state: &mut State) {
    let asked = state.request.outdoors.as_ref().and_then(|asked| asked.patch_m);
    let of_results = state.results.outdoors.faces.as_ref().map(|faces| faces.patch_m);
    let Some(mut patch_m) = asked.or(of_results) else {
        ui.weak("will be chosen");
        return;
    };
    let speed_m = f64::from(patch_m) * 0.01;
    let drag = DragValue::new(&mut patch_m).range(PATCH_M).speed(speed_m).suffix(" m");
    // Halfway through typing `0.5` stands a `0`.
    let response = named(ui.add(drag.max_decimals(3).update_while_editing(false)), "Patches");
    let number = gesture(&response);
    if response.on_hover_text("The longest side of a patch of a face").changed() {
        change_asked(state, number, |asked| asked.patch_m = Some(patch_m));
    }
    if asked.is_some() {
        let reset = ui.button("Reset patches").on_hover_text("Some 20,000 of them");
        if reset.clicked() {
            change_asked(state, gesture(&reset), |asked| asked.patch_m = None);
        }
    } else {
        ui.weak("chosen");
    }
}

/// What the period brings, and how the answer was found.
fn totals(ui: &mut Ui, state: &State) {
    let found = &state.results.outdoors;
    if let Some(sky) = &found.sky {
        let totals = sky.map.totals;
        told(ui, "Global horizontal", energy(totals.ghi_kwh_m2));
        told(ui, "Direct normal", energy(totals.dni_kwh_m2));
        told(ui, "Diffuse horizontal", energy(totals.dhi_kwh_m2));
    }
    if let Some(faces) = &found.faces {
        let pass = if faces.is_first_pass { ", first pass" } else { "" };
        told(ui, "Faces", format!("{} patches of at most {} m{pass}", faces.patches.len(), faces.patch_m));
        if faces.scenery.changed.is_some() {
            told(ui, "Asked again", format!("{} patches, after parts were changed", faces.again));
        }
    }
    if let Some(pixels) = found.pixels.as_ref().filter(|_| state.layers.per_pixel) {
        let [wide, high] = pixels.buffers.camera.size;
        told(ui, "Pixels", format!("{wide} x {high}"));
        ui.label("");
        ui.add(egui::Label::new(egui::RichText::new(pixels.way.way.words()).weak()).wrap());
        ui.end_row();
    }
    if found.seconds > 0.0 {
        told(ui, "Took", format!("{} s", super::number(found.seconds)));
    }
}

fn energy(kwh_m2: f64) -> String {
    format!("{} kWh/m²", super::number(kwh_m2))
}

/// What was decided and what should be known.
fn notes(ui: &mut Ui, state: &State) {
    let found = &state.results.outdoors;
    let of_sky = found.sky.iter().flat_map(|sky| sky.outdoors.notes.iter().chain(&sky.warnings));
    let notes: Vec<&String> = of_sky.chain(&found.notes).chain(&state.outdoors.problem).collect();
    if !notes.is_empty() {
        section(ui, "Notes", true, |ui| {
            for note in notes {
                ui.label(note);
            }
        });
    }
}

fn shown(state: &State) -> Shown {
    match (state.layers.per_pixel, state.layers.mesh_colour) {
        (true, _) => Shown::ByPixel,
        (false, MeshColour::Exposure) => Shown::OnFaces,
        (false, _) => Shown::Nowhere,
    }
}

fn show_exposure(state: &mut State, shown: Shown) {
    state.layers.per_pixel = shown == Shown::ByPixel;
    match (shown, state.layers.mesh_colour) {
        (Shown::OnFaces, _) => state.layers.mesh_colour = MeshColour::Exposure,
        (_, MeshColour::Exposure) => state.layers.mesh_colour = MeshColour::Material,
        _ => {}
    }
}

fn short(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Total => "Sun and sky",
        Quantity::Beam => "Sun",
        Quantity::Sky => "Sky",
        Quantity::Reflected => "Reflected",
        Quantity::Svf => "Sky view factor",
        Quantity::SunHours => "Hours of sun",
    }
}
