//! How the estimate is made: voxels, method, quality, filter, seed.

use crate::panels::{choice, gesture, named, row, rows};
use crate::request::How;
use crate::state::State;
use egui::{DragValue, Ui};
use lightvein::flow::{self, Rung};
use lightvein::scene::Method;
use lightvein::skeleton::Filter;

/// Edges of voxels that a scene file may name, metres; what does not fit the memory the library refuses.
const VOXEL_M: std::ops::RangeInclusive<f32> = 1e-6..=1e6;

/// Seeds that a number field holds exactly.
const MOST_SEED: u64 = 1 << 53;

/// Shows how the estimate is made, and changes it.
pub fn show(ui: &mut Ui, state: &mut State) {
    rows(ui, "how", |ui| {
        row(ui, "Method", |ui| method(ui, state));
        row(ui, "Quality", |ui| quality(ui, state));
        row(ui, "Voxel size", |ui| voxel(ui, state));
        row(ui, "Seed", |ui| {
            let mut seed = state.request.how.seed;
            let response = ui.add(DragValue::new(&mut seed).range(0..=MOST_SEED).speed(0.1));
            changed(state, &response, |how| how.seed = seed);
        });
    });
    ui.collapsing("What the skeleton keeps", |ui| filter(ui, state));

    let mut wants_all = state.request.wants.all_methods;
    let response = ui.checkbox(&mut wants_all, "Compare all methods");
    let gesture = gesture(&response);
    if response.on_hover_text("Estimate by every method, for the inspector, the table and the chart").changed() {
        state.change(gesture, |request| request.wants.all_methods = wants_all);
    }
}

fn changed(state: &mut State, response: &egui::Response, change: impl FnOnce(&mut How)) {
    let gesture = gesture(response);
    if response.changed() {
        state.change(gesture, |request| change(&mut request.how));
    }
}

/// The method that is asked for: the user's, the file's, or `network`.
fn asked(state: &State) -> Method {
    let of_file = state.results.loaded.as_ref().and_then(|scene| scene.model.method);
    state.request.how.method.or(of_file).unwrap_or(Method::Network)
}

fn method(ui: &mut Ui, state: &mut State) {
    let mut method = asked(state);
    let id = ui.scope_id().with("method").value();
    if choice(ui, &mut method, &Method::ALL, Method::name) {
        state.change(id ^ method as u64, |request| {
            request.how.method = Some(method);
            request.how.quality = None;
        });
    }
}

fn quality(ui: &mut Ui, state: &mut State) {
    let ladder: Vec<String> = flow::ladder(asked(state)).into_iter().map(|rung: Rung| rung.quality).collect();
    if ladder.len() < 2 {
        ui.weak("one");
        return;
    }
    let mut quality = state.request.how.quality;
    let name = |quality: Option<usize>| quality.and_then(|rung| ladder.get(rung)).map_or("default", String::as_str);
    let id = ui.scope_id().with("quality");
    egui::ComboBox::from_id_salt(id).selected_text(name(quality)).show_ui(ui, |ui| {
        for rung in std::iter::once(None).chain((0..ladder.len()).map(Some)) {
            ui.selectable_value(&mut quality, rung, name(rung));
        }
    });
    if quality != state.request.how.quality {
        state.change(id.with(quality).value(), |request| request.how.quality = quality);
    }
}

fn voxel(ui: &mut Ui, state: &mut State) {
    let of_file = state.results.loaded.as_ref().and_then(|scene| scene.model.voxel_m);
    let of_model = state.results.model.as_ref().map(|model| model.voxels.lattice.voxel_m);
    let asked = state.request.how.voxel_m;
    let Some(mut voxel_m) = asked.or(of_file).or(of_model) else {
        ui.weak("will be chosen");
        return;
    };
    let speed = f64::from(voxel_m) * 0.005;
    let drag = DragValue::new(&mut voxel_m).range(VOXEL_M).speed(speed).suffix(" m");
    // Halfway through typing `0.05` stands a `0`.
    let response = named(ui.add(drag.max_decimals(6).update_while_editing(false)), "Voxel size");
    changed(state, &response, |how| how.voxel_m = Some(voxel_m));
    match (asked, of_file) {
        (Some(_), _) => {
            let reset = named(ui.button("Reset"), "Reset voxel size")
                .on_hover_text("As the scene file has it, or chosen by the library");
            if reset.clicked() {
                state.change(gesture(&reset), |request| request.how.voxel_m = None);
            }
        }
        (None, Some(_)) => drop(ui.weak("of the file")),
        (None, None) => drop(ui.weak("chosen")),
    }
}

fn filter(ui: &mut Ui, state: &mut State) {
    let mut filter = state.request.how.filter;
    rows(ui, "filter", |ui| {
        row(ui, "Least life", |ui| {
            let drag = DragValue::new(&mut filter.least_life_layers).range(0..=Filter::MOST_LAYERS);
            let response = named(ui.add(drag.suffix(" layers").speed(0.05)), "Least life");
            let response = response.on_hover_text("Above 6, side branches go, the shortest first");
            changed(state, &response, |how| how.filter = filter);
        });
    });
    let mut switch = |on: fn(&mut Filter) -> &mut bool, name: &str, says: &str| {
        let response = ui.checkbox(on(&mut filter), name).on_hover_text(says);
        changed(state, &response, |how| how.filter = filter);
    };
    switch(
        |filter| &mut filter.keeps_middles,
        "Keep middles of rooms",
        "Without, a curve ends at a dead-end room's mouth",
    );
    switch(
        |filter| &mut filter.cuts_branches,
        "Cut branches",
        "Those inside the ball of what they leave: noise on walls",
    );
    switch(|filter| &mut filter.grows_ends, "Grow dead ends", "On to their walls, which thinning stops short of");
    let reset = ui.add_enabled(filter != Filter::default(), egui::Button::new("Reset filter"));
    if reset.clicked() {
        state.change(gesture(&reset), |request| request.how.filter = Filter::default());
    }
}
