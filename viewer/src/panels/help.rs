//! The help sheet, made from the one table of controls.

use crate::controls::{self, Preset, Topic};
use crate::state::State;
use egui::{Context, Grid, RichText, Ui, Window};

/// Shows the sheet while it is asked for; a set of controls is chosen here too.
pub fn show(ctx: &Context, state: &mut State) {
    let mut is_open = state.shows_help;
    let window = Window::new("Controls").open(&mut is_open).collapsible(false).resizable(false).vscroll(true);
    window.show(ctx, |ui| sheet(ui, &mut state.kept.preset));
    state.shows_help = is_open;
}

/// The sheet itself.
fn sheet(ui: &mut Ui, preset: &mut Preset) {
    ui.horizontal(|ui| {
        let label = ui.label("Mouse as in");
        ui.label_inputs_by(label.id, |ui| {
            for one in Preset::ALL {
                ui.radio_value(preset, one, one.name());
            }
        });
    });
    ui.separator();
    ui.columns_const(|[left, right]| {
        heading(left, "Mouse");
        rows(left, "mouse", controls::touches(*preset).map(|row| (row.name(), row.does)));
        topic(left, *preset, Topic::View);
        topic(right, *preset, Topic::Layers);
        topic(right, *preset, Topic::Program);
    });
}

fn topic(ui: &mut Ui, preset: Preset, topic: Topic) {
    heading(ui, topic.title());
    let of_topic = controls::keys(preset).filter(|row| row.topic == topic);
    rows(ui, topic.title(), of_topic.map(|row| (row.stroke.name(), row.does)));
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(4.0);
    ui.label(RichText::new(text).strong());
}

/// Rows of a key or a touch and what it does; several in a row that do the same are one.
fn rows(ui: &mut Ui, name: &str, rows: impl Iterator<Item = (String, &'static str)>) {
    let mut joined: Vec<(String, &str)> = Vec::new();
    for (key, does) in rows {
        match joined.last_mut() {
            Some((keys, last)) if *last == does => *keys = format!("{keys}, {key}"),
            _ => joined.push((key, does)),
        }
    }
    Grid::new(name).num_columns(2).spacing([12.0, 2.0]).show(ui, |ui| {
        for (keys, does) in joined {
            ui.label(RichText::new(keys).monospace());
            ui.label(does);
            ui.end_row();
        }
    });
}
