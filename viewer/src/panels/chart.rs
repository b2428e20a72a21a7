//! Speed against accuracy: every method that was run, by its time and its error.
//!
//! Both axes are logarithmic. A method that no other beats in both is on the front (Pareto), which is drawn as a line.

use super::inspector::seconds_text;
use crate::results::Answer;
use crate::state::{Action, State};
use crate::theme;
use egui::{Align2, Color32, RichText, Ui};
use egui_plot::{GridInput, GridMark, Line, LineStyle, MarkerShape, Plot, PlotPoint, PlotPoints, Points, Text};
use lightvein::scene::Method;
use std::sync::Arc;

/// Shows the chart; without a reference it says so.
pub fn show(ui: &mut Ui, state: &mut State) {
    let answers = match state.results.rungs.is_empty() {
        true => Arc::clone(&state.results.answers),
        false => Arc::clone(&state.results.rungs),
    };
    let points = points(&answers);
    if points.is_empty() {
        let has_reference = state.results.scene.as_ref().is_some_and(|scene| !scene.reference.is_empty());
        let why = match (state.results.answers.is_empty(), has_reference) {
            (true, _) => "No method was compared yet: switch on \"Compare all methods\" in the scene panel.",
            (false, false) => "The scene has no reference to measure errors by. Times are in the inspector.",
            (false, true) => "No sensor has a reference that is known well enough to measure errors by.",
        };
        return super::nothing(ui, state, why);
    }
    ui.label(
        RichText::new("Error as a factor (root mean square) against the time for all sensors: down is more accurate, left is faster; the line joins those that no other beats in both.")
            .weak(),
    );

    ui.horizontal(|ui| {
        key(ui, &points);
        let why = "Runs every method at every quality, and the path tracer with a few samples, once";
        if ui.button("Measure all qualities").on_hover_text(why).clicked() {
            state.ask(Action::Measure);
        }
    });
    let off = off_chart(&answers);
    if !off.is_empty() {
        ui.label(
            RichText::new(format!("Not on the chart, because they call lit sensors dark: {}", off.join(", "))).weak(),
        );
    }

    let front = front(&points);
    let weak = ui.visuals().weak_text_color();
    let strong = ui.visuals().strong_text_color();
    let mut plot = Plot::new("chart")
        .x_grid_spacer(decades)
        .y_grid_spacer(decades)
        .show_grid([true, true])
        .grid_color(ui.visuals().weak_text_color().gamma_multiply(0.4));
    plot = plot.x_axis_formatter(|mark, _| seconds_text(10_f64.powf(mark.value)));
    plot = plot.y_axis_formatter(|mark, _| factor_text(10_f64.powf(mark.value)));
    plot = plot.set_margin_fraction(egui::vec2(0.15, 0.15)).allow_scroll(false).include_y(0.0);
    plot.show(ui, |plot| {
        let along: Vec<[f64; 2]> = front.iter().map(|&at| points[at].place()).collect();
        plot.line(Line::new("front", along).color(weak).style(LineStyle::dashed_dense()).width(1.5));
        for method in Method::ALL {
            let of: Vec<[f64; 2]> = points.iter().filter(|point| point.method == method).map(Point::place).collect();
            if !of.is_empty() {
                let (shape, colour) = mark(method);
                let marks = Points::new(method.name(), PlotPoints::from(of));
                plot.points(marks.shape(shape).color(colour).radius(6.0).filled(true));
            }
        }
        for (number, point) in points.iter().enumerate() {
            let [x, y] = point.place();
            let colour = if front.contains(&number) { strong } else { weak };
            let label = RichText::new(format!("  {}", point.label)).size(11.0);
            plot.text(
                Text::new(format!("label {number}"), PlotPoint::new(x, y), label)
                    .anchor(Align2::LEFT_CENTER)
                    .color(colour)
                    .name(""),
            );
        }
    });
}

/// Which sign and colour a method has.
fn key(ui: &mut Ui, points: &[Point]) {
    ui.horizontal_wrapped(|ui| {
        for method in Method::ALL.into_iter().filter(|method| points.iter().any(|point| point.method == *method)) {
            let (shape, colour) = mark(method);
            let (rect, _) = ui.allocate_exact_size(egui::Vec2::splat(13.0), egui::Sense::hover());
            paint_mark(ui, rect.center(), shape, colour);
            ui.label(method.name());
            ui.add_space(8.0);
        }
    });
}

/// A mark as the plot draws it.
fn paint_mark(ui: &Ui, at: egui::Pos2, shape: MarkerShape, colour: Color32) {
    let corners = |angles: &[f32]| -> Vec<egui::Pos2> {
        angles.iter().map(|turns| at + 6.0 * egui::Vec2::angled(turns * std::f32::consts::TAU)).collect()
    };
    let filled = |angles: &[f32]| egui::Shape::convex_polygon(corners(angles), colour, egui::Stroke::NONE);
    let painter = ui.painter();
    match shape {
        MarkerShape::Square => drop(painter.add(filled(&[0.125, 0.375, 0.625, 0.875]))),
        MarkerShape::Diamond => drop(painter.add(filled(&[0.0, 0.25, 0.5, 0.75]))),
        MarkerShape::Up => drop(painter.add(filled(&[0.75, 0.083, 0.417]))),
        MarkerShape::Asterisk => {
            for end in corners(&[0.75, 0.083, 0.417]) {
                painter.line_segment([at - (end - at), end], egui::Stroke::new(2.0, colour));
            }
        }
        _ => drop(painter.circle_filled(at, 6.0, colour)),
    }
}

/// The methods that call a lit sensor dark, and so are off by no factor.
fn off_chart(answers: &[Answer]) -> Vec<String> {
    let is_off = |answer: &&Answer| answer.errors.rms_factor.is_some_and(f64::is_infinite);
    answers.iter().filter(is_off).map(Answer::label).collect()
}

/// A method on the chart.
#[derive(Debug, Clone, PartialEq)]
struct Point {
    method: Method,
    label: String,
    seconds: f64,
    rms_factor: f64,
}

impl Point {
    /// Where it stands: logarithms to the base of ten.
    fn place(&self) -> [f64; 2] {
        [self.seconds.log10(), self.rms_factor.log10()]
    }
}

/// The methods that have an error and a time.
fn points(answers: &[Answer]) -> Vec<Point> {
    let point = |answer: &Answer| {
        let rms_factor = answer.errors.rms_factor.filter(|factor| factor.is_finite())?;
        let (method, label, seconds) = (answer.method, answer.label(), answer.seconds.max(1e-6));
        Some(Point { method, label, seconds, rms_factor })
    };
    answers.iter().filter_map(point).collect()
}

/// The numbers of the points that no other beats in both, the fastest first.
fn front(points: &[Point]) -> Vec<usize> {
    let mut by_time: Vec<usize> = (0..points.len()).collect();
    by_time.sort_by(|&a, &b| {
        let key = |at: usize| (points[at].seconds, points[at].rms_factor);
        let ((a_s, a_factor), (b_s, b_factor)) = (key(a), key(b));
        a_s.total_cmp(&b_s).then(a_factor.total_cmp(&b_factor))
    });
    let mut least = f64::INFINITY;
    by_time.retain(|&at| {
        let is_better = points[at].rms_factor < least;
        least = least.min(points[at].rms_factor);
        is_better
    });
    by_time
}

/// Shape and colour of a method's marks: never colour alone.
fn mark(method: Method) -> (MarkerShape, Color32) {
    let (shape, colour) = match method {
        Method::Backward => (MarkerShape::Square, theme::BACKWARD),
        Method::Forward => (MarkerShape::Circle, theme::FORWARD),
        Method::Diffusion => (MarkerShape::Diamond, theme::category(2)),
        Method::Network => (MarkerShape::Up, theme::category(6)),
        Method::Trace => (MarkerShape::Asterisk, theme::category(1)),
    };
    (shape, theme::colour(colour))
}

/// How far apart the closest grid lines are, as logarithms.
const NEAR: f64 = 0.12;

/// Grid lines at 1, 2 and 5 times each power of ten, the powers the strongest; others between where there is room.
fn decades(input: GridInput) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    // A view of many decades, or none, comes of zooming far out.
    if !(high - low).is_finite() || high - low > 40.0 {
        return Vec::new();
    }
    let powers = low.floor() as i32..=high.ceil() as i32;
    let of_power = |power: i32| {
        let at = |times: f64, step_size: f64| GridMark { value: f64::from(power) + times.log10(), step_size };
        [at(1.0, 1.0), at(1.5, NEAR), at(2.0, 0.3), at(3.0, NEAR), at(5.0, 0.3)]
    };
    let step = input.base_step_size;
    let is_shown = |mark: &GridMark| mark.step_size >= step && (low..=high).contains(&mark.value);
    powers.flat_map(of_power).filter(is_shown).collect()
}

/// An error as the axis has it: `1.2x`.
fn factor_text(factor: f64) -> String {
    if factor < 10.0 { format!("{factor:.1}x") } else { format!("{factor:.0}x") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64, rms_factor: f64) -> Point {
        Point { method: Method::Forward, label: String::new(), seconds, rms_factor }
    }

    #[test]
    fn the_front_is_what_no_other_beats_in_both() {
        let points = [at(1.0, 1.1), at(0.1, 2.0), at(0.2, 2.5), at(0.1, 3.0), at(2.0, 1.1), at(3.0, 1.05)];
        assert_eq!(front(&points), [1, 0, 5]);
    }

    #[test]
    fn grid_lines_stand_at_one_two_and_five() {
        let marks = decades(GridInput { bounds: (-1.2, 0.4), base_step_size: 0.2 });
        let values: Vec<f64> = marks.iter().map(|mark| 10_f64.powf(mark.value)).collect();
        for value in [0.1, 0.2, 0.5, 1.0, 2.0] {
            assert!(values.iter().any(|other| (other / value - 1.0).abs() < 1e-9), "{value} of {values:?}");
        }
        assert!(decades(GridInput { bounds: (-1e9, 1e9), base_step_size: 1.0 }).is_empty());
    }
}
