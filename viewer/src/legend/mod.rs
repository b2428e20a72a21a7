//! The legend over the view, always on: for each measure that is shown its colours, unit, ticks, and how its values are spread.
//!
//! Limits are dragged at the bar; values beyond them keep the colours of its ends, which `<` and `>` then tell. The range stays
//! as it is when values change, until it is refitted.

mod bar;
mod spread;

use crate::colour::{ColourMap, GREY};
use crate::layers::NodeColour;
use crate::measure::Measure;
use crate::panels::named;
use crate::state::{Picked, State};
use crate::theme;
use egui::{Align, Align2, Color32, Layout, Rect, RichText, Sense, Stroke, Ui, UiBuilder, pos2, vec2};

/// Width of the legend, points.
const WIDTH: f32 = 264.0;

/// Distance from the edge of the view, points.
const MARGIN: f32 = 10.0;

/// Most categories that the key lists.
const LISTED: usize = 7;

/// Its height before it was shown once, points.
const FIRST_HEIGHT: f32 = 150.0;

/// Draws the legend into the lower left corner of the view, `rect`: what is seen from above and from the south-east, as scenes are
/// at first, leaves that free.
pub fn show(ui: &mut Ui, state: &mut State, rect: Rect) {
    let measures = state.layers.measures();
    let categories = categories(state);
    let has_paths = state.layers.paths && matches!(state.picked, Some(Picked::Node(_) | Picked::Sensor(_)));
    if state.results.scene.is_none() || (measures.is_empty() && categories.is_empty() && !has_paths) {
        return;
    }

    let width = WIDTH.min(rect.width() - 2.0 * MARGIN - 16.0);
    let key = ui.scope_id().with("legend height");
    let height = ui.data(|data| data.get_temp(key)).unwrap_or(FIRST_HEIGHT);
    let left_top = pos2(rect.left() + MARGIN, (rect.bottom() - height - MARGIN).max(rect.top() + MARGIN));
    let room = Rect::from_min_max(left_top, rect.max - vec2(MARGIN, MARGIN));
    // It senses the pointer, so that what is clicked on it is not clicked in the view below.
    let builder = UiBuilder::new().max_rect(room).id_salt("legend").sense(Sense::click_and_drag());
    let mut child = ui.new_child(builder);
    let fill = child.visuals().window_fill.gamma_multiply(0.93);
    let shown = egui::Frame::popup(child.style()).fill(fill).shadow(egui::Shadow::NONE).show(&mut child, |ui| {
        ui.set_width(width);
        ui.spacing_mut().item_spacing = vec2(6.0, 3.0);
        for measure in &measures {
            ui.push_id(*measure, |ui| one(ui, state, *measure));
        }
        if !categories.is_empty() {
            key_of_categories(ui, &categories);
        }
        if has_paths {
            key_of_paths(ui);
        }
        if !measures.is_empty() {
            ui.horizontal(|ui| {
                swatch(ui, theme::colour(GREY));
                ui.label(RichText::new("zero or missing").small());
            });
        }
    });
    let is_height = shown.response.rect.height();
    if (is_height - height).abs() > 0.5 {
        ui.data_mut(|data| data.insert_temp(key, is_height));
        ui.ctx().request_discard("the legend has another height");
    }
}

/// The legend of one measure.
fn one(ui: &mut Ui, state: &mut State, measure: Measure) {
    let scale = state.scale(measure);
    let title = match measure.unit() {
        "" => measure.title().to_owned(),
        unit => format!("{}, {unit}", measure.title()),
    };
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let refit = named(ui.small_button("Refit"), &format!("Refit {}", measure.title()));
            if refit.on_hover_text("Fit the range to the values that are there now").clicked() {
                state.refit(measure);
            }
            let button = egui::Button::new("Map").small();
            let (menu, _) = egui::containers::menu::MenuButton::from_button(button).ui(ui, |ui| {
                for map in ColourMap::ALL {
                    if ui.radio(scale.map == map, map.name()).clicked() {
                        state.kept.maps.insert(measure, map);
                        state.scales.entry(measure).or_insert(scale).map = map;
                        ui.close();
                    }
                }
            });
            named(menu, &format!("Colour map of {}", measure.title()));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(egui::Label::new(RichText::new(title).strong()).truncate());
            });
        });
    });

    let spread = spread::kept(ui, state, measure);
    match spread {
        None => drop(ui.weak("no values yet")),
        Some(spread) => {
            let scale = state.scale(measure);
            if let Some(dragged) = bar::show(ui, measure, scale, &spread) {
                state.scales.insert(measure, dragged);
            }
        }
    }
}

/// Names and colours of what is shown by colour but has no order.
fn categories(state: &State) -> Vec<(String, [u8; 3])> {
    let Some(model) = &state.results.model else { return Vec::new() };
    let of_nodes = Some(state.layers.node_colour).filter(|_| state.layers.nodes);
    let mut all = Vec::new();
    if state.layers.cells || of_nodes == Some(NodeColour::Cell) {
        let cells = model.skeleton.cells.len();
        all.extend((0..cells.min(LISTED)).map(|cell| (format!("Cell {cell}"), theme::category(cell))));
        if cells > LISTED {
            all.push((format!("and {} more", cells - LISTED), GREY));
        }
    }
    if of_nodes == Some(NodeColour::Light) {
        let lights = model.shining.len();
        all.extend((0..lights.min(LISTED)).map(|light| (format!("Light {light}"), theme::category(light))));
        if lights > LISTED {
            all.push((format!("and {} more", lights - LISTED), GREY));
        }
    }
    all
}

fn key_of_categories(ui: &mut Ui, categories: &[(String, [u8; 3])]) {
    ui.horizontal_wrapped(|ui| {
        for (name, colour) in categories {
            ui.horizontal(|ui| {
                swatch(ui, theme::colour(*colour));
                ui.label(RichText::new(name).small());
            });
        }
    });
}

/// Forward and backward are told apart by their line too.
fn key_of_paths(ui: &mut Ui) {
    ui.horizontal(|ui| {
        for (name, colour, is_dashed) in [("forward", theme::FORWARD, false), ("backward", theme::BACKWARD, true)] {
            let (rect, _) = ui.allocate_exact_size(vec2(28.0, 12.0), Sense::hover());
            let line = [rect.left_center(), rect.right_center()];
            let stroke = Stroke::new(2.5, theme::colour(colour));
            if is_dashed {
                ui.painter().extend(egui::Shape::dashed_line(&line, stroke, 6.0, 4.0));
            } else {
                ui.painter().line_segment(line, stroke);
            }
            ui.label(RichText::new(name).small());
            ui.add_space(8.0);
        }
    });
}

fn swatch(ui: &mut Ui, colour: Color32) {
    let (rect, _) = ui.allocate_exact_size(vec2(11.0, 11.0), Sense::hover());
    ui.painter().rect_filled(rect, 2.0, colour);
}

/// A text in the legend's small font.
fn small(ui: &Ui, at: egui::Pos2, align: Align2, text: &str, colour: Color32) -> Rect {
    ui.painter().text(at, align, text, egui::TextStyle::Small.resolve(ui.style()), colour)
}
