//! The bar of menus at the top, with the run's progress at its right end.

use super::tiles;
use crate::camera::Standard;
use crate::controls::{Command, Preset, shortcut};
use crate::panels::Pane;
use crate::state::{Action, Running, State};
use egui::{Button, Ui};
use egui_tiles::Tree;

/// Directions in the menu, in its order.
const DIRECTIONS: [Standard; 7] = [
    Standard::Front,
    Standard::Back,
    Standard::Left,
    Standard::Right,
    Standard::Top,
    Standard::Bottom,
    Standard::Oblique,
];

/// Shows the bar.
pub fn show(ui: &mut Ui, state: &mut State, tree: &mut Tree<Pane>) {
    egui::MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file(ui, state));
        ui.menu_button("Edit", |ui| edit(ui, state));
        ui.menu_button("View", |ui| view(ui, state));
        ui.menu_button("Panes", |ui| panes(ui, tree));
        ui.menu_button("Help", |ui| {
            if ui.add(Button::new("Keys and mouse").shortcut_text(shortcut(Command::Help, state.kept.preset))).clicked()
            {
                state.shows_help = true;
            }
        });
        ui.separator();
        ui.weak(state.request.source.name());
        progress(ui, state);
    });
}

fn item(ui: &mut Ui, state: &mut State, name: &str, is_on: bool, action: Action) {
    let keys = command(&action).map(|command| shortcut(command, state.kept.preset));
    let button = keys.map_or_else(|| Button::new(name), |keys| Button::new(name).shortcut_text(keys));
    if ui.add_enabled(is_on, button).clicked() {
        state.ask(action);
    }
}

/// The command whose keys do the same.
fn command(action: &Action) -> Option<Command> {
    match action {
        Action::OpenDialog => Some(Command::Open),
        Action::Reload => Some(Command::Reload),
        Action::Undo => Some(Command::Undo),
        Action::Redo => Some(Command::Redo),
        Action::Fit => Some(Command::Fit),
        Action::Focus => Some(Command::Focus),
        Action::SavePicture => Some(Command::SavePicture),
        Action::Export => Some(Command::Export),
        Action::Quit => Some(Command::Quit),
        _ => None,
    }
}

fn file(ui: &mut Ui, state: &mut State) {
    item(ui, state, "Open …", true, Action::OpenDialog);
    ui.menu_button("Open recent", |ui| {
        if state.kept.recent.is_empty() {
            ui.weak("none yet");
        }
        for path in state.kept.recent.clone() {
            item(ui, state, &path.display().to_string(), true, Action::Open(path));
        }
    });
    item(ui, state, "Reload", true, Action::Reload);
    ui.separator();
    let has_estimate = state.results.estimate.is_some();
    item(ui, state, "Save picture …", true, Action::SavePicture);
    item(ui, state, "Export analysis …", has_estimate, Action::Export);
    item(ui, state, "Save table of sensors …", has_estimate, Action::SaveTable);
    ui.separator();
    item(ui, state, "Quit", true, Action::Quit);
}

fn edit(ui: &mut Ui, state: &mut State) {
    let [can_undo, can_redo] = state.history.can();
    item(ui, state, "Undo", can_undo, Action::Undo);
    item(ui, state, "Redo", can_redo, Action::Redo);
}

fn view(ui: &mut Ui, state: &mut State) {
    item(ui, state, "Fit", true, Action::Fit);
    item(ui, state, "Look at what is picked", state.picked.is_some(), Action::Focus);
    ui.menu_button("Look from", |ui| {
        for standard in DIRECTIONS {
            if ui.button(standard.name()).clicked() {
                state.camera.look_from(standard);
                state.ask(Action::Fit);
            }
        }
    });
    ui.checkbox(&mut state.camera.orthographic, "Parallel projection");
    ui.separator();
    ui.menu_button("Theme", |ui| {
        for (dark, name) in [(None, "As the system"), (Some(true), "Dark"), (Some(false), "Light")] {
            ui.radio_value(&mut state.kept.dark, dark, name);
        }
    });
    ui.menu_button("Controls", |ui| {
        for preset in Preset::ALL {
            ui.radio_value(&mut state.kept.preset, preset, preset.name());
        }
    });
}

fn panes(ui: &mut Ui, tree: &mut Tree<Pane>) {
    for pane in Pane::ALL {
        if ui.button(pane.title()).clicked() {
            tiles::bring(tree, pane);
        }
    }
    ui.separator();
    if ui.button("As they stood at first").clicked() {
        *tree = tiles::first();
    }
}

/// The stage that runs, how far it is, and the button that stops it.
fn progress(ui: &mut Ui, state: &mut State) {
    let Running::Stage { name, share, seconds } = state.running.clone() else { return };
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let stop = ui.add(Button::new("Stop").small()).on_hover_text("Stop the run (Esc); what is shown stays");
        if stop.clicked() {
            state.ask(Action::Cancel);
        }
        let text = format!("{name}  {seconds:.1} s");
        match share {
            Some(share) => {
                ui.add(egui::ProgressBar::new(share).text(text).desired_width(260.0));
            }
            None => {
                ui.label(text);
                ui.spinner();
            }
        }
    });
}
