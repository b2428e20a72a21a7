//! The help sheet, made from the one table of controls.

use crate::controls::{self, Preset, Topic};
use crate::state::State;
use egui::{Context, Grid, RichText, Ui, Window};

/// Shows the sheet while it is asked for; a set of controls is chosen here too.
pub fn show(ctx: &Context, state: &mut State) {
    let mut is_open = state.shows_help;
    let height = (ctx.content_rect().height() - 80.0).max(200.0);
    let window = Window::new("Controls").open(&mut is_open).collapsible(false).resizable(false).vscroll(true);
    let window = window.max_height(height).default_height(height).anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]);
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
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| {
            heading(ui, "Mouse");
            rows(ui, "mouse", controls::touches(*preset).map(|row| (row.name(), row.does)));
            topic(ui, *preset, Topic::View);
        });
        ui.add_space(24.0);
        ui.vertical(|ui| {
            topic(ui, *preset, Topic::Layers);
            topic(ui, *preset, Topic::Program);
        });
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

/// Rows of a key or a touch and what it does.
fn rows(ui: &mut Ui, name: &str, rows: impl Iterator<Item = (String, &'static str)>) {
    Grid::new(name).num_columns(2).spacing([12.0, 2.0]).striped(true).show(ui, |ui| {
        for (keys, does) in rows {
            ui.label(RichText::new(keys).monospace());
            ui.label(does);
            ui.end_row();
        }
    });
}
