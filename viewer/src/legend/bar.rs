//! One measure's bar: histogram, colours, ticks, and two limits to drag.

use super::small;
use super::spread::{Spread, tick_text, ticks};
use crate::colour::Scale;
use crate::measure::Measure;
use egui::{Align2, Color32, CursorIcon, EventFilter, Key, Mesh, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

/// Heights of the histogram, of the bar and of the row of ticks, points.
const HEIGHTS: [f32; 3] = [20.0, 11.0, 13.0];

/// Room at either end for the signs of clipped values, points.
const ENDS: f32 = 11.0;

/// The limits of a range come no closer to each other than this share of the bar.
const CLOSEST: f32 = 0.01;

/// What an arrow key moves a limit by, as a share of the bar.
const KEY_STEP: f32 = 0.01;

/// Ticks stand at least this far apart, points.
const TICKS_APART: f32 = 38.0;

/// Which limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Limit {
    Low,
    High,
}

/// Draws the bar of a measure; the scale as its limits were dragged to, where they were.
pub fn show(ui: &mut Ui, measure: Measure, scale: Scale, spread: &Spread) -> Option<Scale> {
    let size = vec2(ui.available_width(), HEIGHTS.iter().sum());
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, in_words(measure, &scale, spread)));
    let inner = rect.shrink2(vec2(ENDS, 0.0));
    let bar = Rect::from_min_size(inner.min + vec2(0.0, HEIGHTS[0]), vec2(inner.width(), HEIGHTS[1]));
    let whole = Whole { spread, low: spread.low.min(scale.low), high: spread.high.max(scale.high), bar };

    let colour = ui.visuals().weak_text_color();
    whole.paint_histogram(ui, colour.gamma_multiply(0.8));
    whole.paint_colours(ui, &scale);
    whole.paint_ticks(ui, colour);
    // Values beyond the limits keep the colours of the ends.
    let strong = ui.visuals().strong_text_color();
    if spread.ends[0] < scale.low {
        small(ui, pos2(rect.left(), bar.center().y), Align2::LEFT_CENTER, "<", strong);
    }
    if spread.ends[1] > scale.high {
        small(ui, pos2(rect.right(), bar.center().y), Align2::RIGHT_CENTER, ">", strong);
    }

    let low = whole.limit(ui, measure, &scale, Limit::Low);
    let high = whole.limit(ui, measure, &scale, Limit::High);
    match (low, high) {
        (Some(low), _) => Some(Scale { low, ..scale }),
        (_, Some(high)) => Some(Scale { high, ..scale }),
        (None, None) => None,
    }
}

/// What the bar shows, for who does not see it.
fn in_words(measure: Measure, scale: &Scale, spread: &Spread) -> String {
    let [low, high] = [scale.low, scale.high].map(|limit| crate::panels::number(f64::from(limit)));
    let below = if spread.ends[0] < scale.low { ", some below" } else { "" };
    let above = if spread.ends[1] > scale.high { ", some above" } else { "" };
    format!("{} from {low} to {high} {}{below}{above}", measure.title(), measure.unit())
}

/// A bar from the least to the largest value that it has room for.
struct Whole<'a> {
    spread: &'a Spread,
    low: f32,
    high: f32,
    bar: Rect,
}

impl Whole<'_> {
    fn share(&self, value: f32) -> f32 {
        self.spread.share(value, self.low, self.high)
    }

    fn value(&self, share: f32) -> f32 {
        self.spread.value(share, self.low, self.high)
    }

    fn x(&self, value: f32) -> f32 {
        self.bar.left() + self.bar.width() * self.share(value).clamp(0.0, 1.0)
    }

    fn paint_histogram(&self, ui: &Ui, colour: Color32) {
        let Spread { low, high, bins, .. } = self.spread;
        let edge = |bin: usize| self.x(self.spread.value(bin as f32 / bins.len() as f32, *low, *high));
        for (number, share) in bins.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            let height = (share * (HEIGHTS[0] - 2.0)).max(1.0);
            let (left, right) = (edge(number), edge(number + 1));
            let bottom = self.bar.top() - 1.0;
            let rect = Rect::from_min_max(pos2(left, bottom - height), pos2(right.max(left + 1.0), bottom));
            ui.painter().rect_filled(rect, 0.0, colour);
        }
    }

    fn paint_colours(&self, ui: &Ui, scale: &Scale) {
        let strips = self.bar.width().max(1.0) as usize / 2;
        let mut mesh = Mesh::default();
        for strip in 0..strips {
            let share = |strip: usize| strip as f32 / strips as f32;
            let x = |strip: usize| self.bar.left() + self.bar.width() * share(strip);
            let value = self.value(share(strip) + 0.5 / strips as f32);
            let rect = Rect::from_min_max(pos2(x(strip), self.bar.top()), pos2(x(strip + 1), self.bar.bottom()));
            mesh.add_colored_rect(rect, crate::theme::colour(scale.colour(value)));
        }
        ui.painter().add(Shape::mesh(mesh));
    }

    fn paint_ticks(&self, ui: &Ui, colour: Color32) {
        let mut last = f32::NEG_INFINITY;
        for tick in ticks(self.low, self.high, self.spread.logarithmic) {
            let at = pos2(self.x(tick), self.bar.bottom());
            ui.painter().line_segment([at, at + vec2(0.0, 3.0)], Stroke::new(1.0, colour));
            if at.x >= last + TICKS_APART {
                small(ui, at + vec2(0.0, 3.0), Align2::CENTER_TOP, &tick_text(tick), colour);
                last = at.x;
            }
        }
    }

    /// A limit to drag, or to move by the arrow keys; its new value where it moved.
    fn limit(&self, ui: &Ui, measure: Measure, scale: &Scale, limit: Limit) -> Option<f32> {
        let value = match limit {
            Limit::Low => scale.low,
            Limit::High => scale.high,
        };
        let x = self.x(value);
        let rect = Rect::from_x_y_ranges(x - 5.0..=x + 5.0, self.bar.top() - 4.0..=self.bar.bottom() + 4.0);
        let response = ui.interact(rect, ui.scope_id().with(("limit", measure, limit)), Sense::click_and_drag());
        let response = response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
        let name = match limit {
            Limit::Low => format!("Lowest {}", measure.title()),
            Limit::High => format!("Highest {}", measure.title()),
        };
        response.widget_info(|| egui::WidgetInfo::slider(true, f64::from(value), &name));

        let visuals = ui.style().interact(&response);
        let line = rect.shrink2(vec2(4.0, 0.0));
        ui.painter().rect_filled(line.expand(1.0), 1.0, ui.visuals().extreme_bg_color);
        ui.painter().rect_filled(line, 1.0, visuals.fg_stroke.color);
        let is_held = response.dragged() || response.has_focus();
        let response =
            response.on_hover_text(format!("{name}: {} {}", crate::panels::number(f64::from(value)), measure.unit()));

        let mut share = self.share(value);
        let before = share;
        if response.dragged() {
            share += response.drag_delta().x / self.bar.width();
        }
        if is_held {
            let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            let presses = |key| ui.input(|input| input.num_presses(key)) as f32;
            share += KEY_STEP * (presses(Key::ArrowRight) - presses(Key::ArrowLeft));
        }
        let share = match limit {
            Limit::Low => share.clamp(0.0, (self.share(scale.high) - CLOSEST).max(0.0)),
            Limit::High => share.clamp((self.share(scale.low) + CLOSEST).min(1.0), 1.0),
        };
        let is_moved = (response.dragged() || is_held) && share != before;
        is_moved.then(|| self.value(share))
    }
}
