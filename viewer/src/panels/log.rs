//! The log: all that was told since the start.

use crate::log::{Entry, Level};
use crate::state::State;
use egui::{Color32, RichText, ScrollArea, Ui};

/// Shows the log, newest last; an entry, or all, can be copied.
pub fn show(ui: &mut Ui, state: &mut State) {
    ui.horizontal(|ui| {
        let is_empty = state.log.entries.is_empty();
        if ui.add_enabled(!is_empty, egui::Button::new("Copy all")).clicked() {
            ui.copy_text(state.log.text());
        }
        if ui.add_enabled(!is_empty, egui::Button::new("Clear")).clicked() {
            state.log = Default::default();
        }
    });
    if state.log.entries.is_empty() {
        ui.weak("nothing was told yet");
    }
    ScrollArea::vertical().id_salt("log").auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
        for (number, entry) in state.log.entries.iter().enumerate() {
            ui.push_id(number, |ui| one(ui, number, entry));
        }
    });
}

fn one(ui: &mut Ui, number: usize, entry: &Entry) {
    let (word, colour) = level(entry.level, ui);
    ui.horizontal_top(|ui| {
        let copy = super::named(ui.small_button("Copy"), &format!("Copy entry {}", number + 1));
        if copy.clicked() {
            ui.copy_text(entry.line());
        }
        ui.label(RichText::new(word).color(colour).strong());
        let line = entry.line();
        // The word stands before it already.
        let text = line.split_once(": ").map_or(line.as_str(), |(_, text)| text);
        ui.add(egui::Label::new(text).wrap());
    });
}

fn level(level: Level, ui: &Ui) -> (&'static str, Color32) {
    match level {
        Level::Error => ("Error", ui.visuals().error_fg_color),
        Level::Warning => ("Warning", ui.visuals().warn_fg_color),
        Level::Note => ("Note", ui.visuals().weak_text_color()),
    }
}
