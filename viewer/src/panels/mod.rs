//! What stands around the 3D view, one file a panel: functions that show the [`State`] and change it.
//!
//! A panel changes what results depend on through [`State::change`], by the number that [`gesture`] gives: a drag or a typed
//! number is one step to undo. All else it sets at once. Every widget has a name for screen readers: its own text, or that of
//! its row (`row`).

pub mod chart;
pub mod help;
pub mod inspector;
pub mod layers;
pub mod log;
pub mod map;
pub mod outdoors;
pub mod scene;
pub mod sensors;
pub mod stages;

use crate::state::State;
use egui::{Response, RichText, Ui};
use serde::{Deserialize, Serialize};

/// A pane of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Pane {
    /// The 3D view.
    View,
    /// Which layers are on.
    Layers,
    /// What can be changed.
    Scene,
    /// What is picked.
    Inspector,
    /// The table of sensors.
    Sensors,
    /// Speed against accuracy.
    Chart,
    /// Stage times and memory.
    Stages,
    /// What was told.
    Log,
    /// Place, time, sun and sky.
    Outdoors,
    /// The exposure map.
    Map,
}

impl Pane {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::View,
        Self::Layers,
        Self::Scene,
        Self::Inspector,
        Self::Sensors,
        Self::Chart,
        Self::Stages,
        Self::Log,
        Self::Outdoors,
        Self::Map,
    ];

    /// The title of its tab.
    pub const fn title(self) -> &'static str {
        match self {
            Self::View => "View",
            Self::Layers => "Layers",
            Self::Scene => "Scene",
            Self::Inspector => "Inspector",
            Self::Sensors => "Sensors",
            Self::Chart => "Speed and accuracy",
            Self::Stages => "Stages",
            Self::Log => "Log",
            Self::Outdoors => "Sun and sky",
            Self::Map => "Exposure map",
        }
    }
}

/// Width of the labels of rows, and of the number beside a slider, points.
const LABELS: f32 = 110.0;
const NUMBERS: f32 = 76.0;

/// Narrowest and widest slider, points.
const SLIDERS: [f32; 2] = [56.0, 170.0];

/// The number of the gesture that a widget is in: a drag, a click or a typed number has one, and so is one step to undo.
pub fn gesture(response: &Response) -> u64 {
    let ctx = &response.ctx;
    let is_pressed = response.is_pointer_button_down_on() && ctx.input(|input| input.pointer.any_pressed());
    let begins = is_pressed || response.gained_focus() || response.clicked();
    let key = response.id.with("gesture");
    let number = ctx.data_mut(|data| {
        let number = data.get_temp_mut_or_default::<u64>(key);
        *number += u64::from(begins);
        *number
    });
    key.with(number).value()
}

/// A pane's contents, in a scroll area.
fn scrolled(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui)) {
    egui::ScrollArea::vertical().id_salt(name).auto_shrink(false).show(ui, |ui| {
        ui.add_space(4.0);
        contents(ui);
        ui.add_space(8.0);
    });
}

/// A group of a panel, under a heading that folds it.
fn section(ui: &mut Ui, title: &str, is_open: bool, contents: impl FnOnce(&mut Ui)) {
    let header = egui::CollapsingHeader::new(RichText::new(title).strong()).default_open(is_open);
    header.show_unindented(ui, |ui| {
        egui::Frame::new().inner_margin(egui::Margin { left: 6, right: 4, top: 0, bottom: 6 }).show(ui, contents);
    });
}

/// Rows of [`row`] in two columns.
fn rows(ui: &mut Ui, name: impl std::hash::Hash + std::fmt::Debug, contents: impl FnOnce(&mut Ui)) {
    // A slider takes what its label and its number leave.
    ui.spacing_mut().slider_width = (ui.available_width() - LABELS - NUMBERS).clamp(SLIDERS[0], SLIDERS[1]);
    egui::Grid::new(ui.scope_id().with(name))
        .num_columns(2)
        .spacing([10.0, 4.0])
        .min_col_width(74.0)
        .show(ui, contents);
}

/// A row of a grid: a label and what it names.
fn row<R>(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let label = ui.label(name);
    let inner = ui.horizontal(|ui| ui.label_inputs_by(label.id, contents)).inner;
    ui.end_row();
    inner
}

/// Gives a widget a name of its own for screen readers, where its text says too little: `Remove light 2` for `Remove`.
pub fn named(response: Response, name: &str) -> Response {
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name));
    response
}

/// A row of a grid that tells a value, which can be selected and copied.
fn told(ui: &mut Ui, name: &str, value: impl Into<String>) {
    ui.label(RichText::new(name).weak());
    ui.label(value.into());
    ui.end_row();
}

/// A choice among a few by name; whether it changed.
fn choice<T: PartialEq + Copy>(ui: &mut Ui, value: &mut T, all: &[T], name: impl Fn(T) -> &'static str) -> bool {
    let before = *value;
    let salt = ui.next_auto_id();
    egui::ComboBox::from_id_salt(salt).selected_text(name(*value)).show_ui(ui, |ui| {
        for one in all {
            ui.selectable_value(value, *one, name(*one));
        }
    });
    *value != before
}

/// A slider's number with so many decimals. A slider that were told to have them would round the value itself, unasked.
fn decimals(count: usize) -> impl Fn(f64, std::ops::RangeInclusive<usize>) -> String {
    move |value, _| format!("{value:.count$}")
}

/// A number with as many digits as it is worth telling: four, in powers of ten where it is tiny or huge.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{value:.3e}");
    }
    let digits = 3 - size.log10().floor() as i32;
    format!("{value:.*}", digits.max(0) as usize)
}

/// A position in the user's coordinates, metres.
pub fn position(scene: &lightvein::scene::Scene, position_m: glam::Vec3) -> String {
    let [x, y, z] = scene.to_user_m(position_m).to_array();
    format!("{x:.3}, {y:.3}, {z:.3} m")
}

/// A line in a pane that has nothing to show yet.
fn nothing(ui: &mut Ui, state: &State, why: &str) {
    ui.add_space(8.0);
    let text = if state.is_busy() { "computing, one moment" } else { why };
    ui.vertical_centered(|ui| ui.label(RichText::new(text).weak().italics()));
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_four_digits() {
        let cases = [
            (0.0, "0"),
            (1.0, "1.000"),
            (-12.3456, "-12.35"),
            (99_999.0, "99999"),
            (123_456.0, "1.235e5"),
            (0.001_234_56, "0.001235"),
            (0.000_123_456, "1.235e-4"),
            (f64::INFINITY, "inf"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }
}
