//! One panel: the points of one scene for one number of sensors.

use super::axes::{Axis, FACTOR_TICKS, seconds_range, seconds_ticks};
use super::labels::{Labels, Patch};
use super::style::{draw_mark, half_size, style};
use crate::export::plan::escaped;
use crate::scene::Method;
use crate::study::chart::{Point, SceneChart};
use std::io::{self, Write};

/// Size of a panel, in SVG units.
pub const WIDTH: f64 = 400.0;
/// Its height.
pub const HEIGHT: f64 = 330.0;

/// The strip along the upper border where points without a finite error stand.
const LOST: f64 = 30.0;

/// A tick this near to an end of its axis has its name beside it, not under it.
const END_TICK: f64 = 20.0;

/// Font size of labels beside points.
const SMALL: f64 = 11.0;

/// A panel and where it stands.
pub struct Panel<'a> {
    /// All of the scene.
    pub chart: &'a SceneChart,
    /// How many sensors are asked at.
    pub sensors: usize,
    /// Its upper left corner on the sheet.
    pub corner: [f64; 2],
    /// Ends of the axis of factors, which the panels of a scene share.
    pub factors: [f64; 2],
    /// Whether the axis of factors is named here.
    pub is_first: bool,
}

impl Panel<'_> {
    /// Draws the panel.
    ///
    /// # Errors
    /// What the writer says.
    pub fn draw(&self, out: &mut dyn Write) -> io::Result<()> {
        let points: Vec<&Point> = self.chart.panel(self.sensors).filter(|point| point.rms_factor().is_some()).collect();
        let [left, top] = self.corner;
        let times = points.iter().flat_map(|point| [point.seconds, point.total_seconds()]);
        let range = seconds_range(times);
        let x = Axis::new(range, [left, left + WIDTH]);
        let y = Axis::new(self.factors.map(|factor| factor - 1.0), [top + HEIGHT, top + LOST]);

        self.draw_frame(out, &x, &y, range)?;
        let places: Vec<[f64; 2]> =
            points.iter().map(|point| [x.place(point.total_seconds()), self.height(point, &y)]).collect();
        draw_preparations(out, &points, &places, &x)?;
        draw_series(out, &points, &places)?;
        self.draw_front(out, &x, &y)?;
        let own_m = own_voxels(&points);
        for (point, place) in points.iter().zip(&places) {
            draw_mark(out, style(&point.method), *place, half_size(point, own_m), point.is_scaled, point.is_front)?;
        }
        self.draw_labels(out, &points, &places, &y)
    }

    /// The place of a point along the axis of factors; the upper border where its error is off the axis.
    fn height(&self, point: &Point, y: &Axis) -> f64 {
        let factor = point.rms_factor().unwrap_or(f64::INFINITY);
        if is_off(point, y) { self.corner[1] + LOST / 2.0 } else { y.place(factor - 1.0) }
    }

    fn draw_frame(&self, out: &mut dyn Write, x: &Axis, y: &Axis, range: [f64; 2]) -> io::Result<()> {
        let [left, top] = self.corner;
        let [right, bottom] = [left + WIDTH, top + HEIGHT];
        writeln!(
            out,
            r##"<rect x="{left:.1}" y="{top:.1}" width="{WIDTH}" height="{HEIGHT}" fill="#ffffff" stroke="#888888"/>"##
        )?;
        writeln!(out, r##"<rect x="{left:.1}" y="{top:.1}" width="{WIDTH}" height="{LOST}" fill="#f3ece4"/>"##)?;
        writeln!(out, r##"<g stroke="#e4e4e4">"##)?;
        let ticks = seconds_ticks(range);
        for (seconds, _) in &ticks {
            let at = x.place(*seconds);
            writeln!(out, r#"<line x1="{at:.1}" y1="{:.1}" x2="{at:.1}" y2="{bottom:.1}"/>"#, top + LOST)?;
        }
        let factors = FACTOR_TICKS.into_iter().filter(|factor| y.shows(factor - 1.0));
        let factors: Vec<(f64, f64)> = factors.map(|factor| (factor, y.place(factor - 1.0))).collect();
        for (_, at) in &factors {
            writeln!(out, r#"<line x1="{left:.1}" y1="{at:.1}" x2="{right:.1}" y2="{at:.1}"/>"#)?;
        }
        writeln!(out, r##"</g><g fill="#444444" font-size="12">"##)?;
        // Narrow decades are named every second or third; names at the ends stay within the panel.
        let stride = ticks.len().div_ceil(7).max(1);
        for (seconds, name) in ticks.iter().step_by(stride) {
            let at = x.place(*seconds);
            let anchor = match at {
                _ if at < left + END_TICK => "start",
                _ if at > right - END_TICK => "end",
                _ => "middle",
            };
            writeln!(out, r#"<text x="{at:.1}" y="{:.1}" text-anchor="{anchor}">{name}</text>"#, bottom + 16.0)?;
        }
        writeln!(out, "</g>")?;
        if self.is_first {
            writeln!(out, r##"<g fill="#444444" font-size="12" text-anchor="end">"##)?;
            for (factor, at) in &factors {
                writeln!(out, r#"<text x="{:.1}" y="{:.1}">{factor}</text>"#, left - 6.0, at + 4.0)?;
            }
            writeln!(out, r#"<text x="{:.1}" y="{:.1}">lost</text></g>"#, left - 6.0, top + LOST / 2.0 + 4.0)?;
        }
        Ok(())
    }

    /// The front as a staircase: the best error that can be had by each time.
    fn draw_front(&self, out: &mut dyn Write, x: &Axis, y: &Axis) -> io::Result<()> {
        let front = self.chart.front(self.sensors);
        let Some(first) = front.first() else { return Ok(()) };
        let mut stairs = format!("M{:.1},{:.1}", x.place(first.total_seconds()), self.corner[1] + LOST);
        for point in &front {
            stairs += &format!(" H{:.1} V{:.1}", x.place(point.total_seconds()), self.height(point, y));
        }
        stairs += &format!(" H{:.1}", self.corner[0] + WIDTH);
        writeln!(out, r##"<path d="{stairs}" fill="none" stroke="#777777" stroke-width="1.2"/>"##)
    }

    /// Names the points of the front, then counts the lost sensors, then names the path tracers' points, while there is room.
    fn draw_labels(&self, out: &mut dyn Write, points: &[&Point], places: &[[f64; 2]], y: &Axis) -> io::Result<()> {
        let [left, top] = self.corner;
        let sheet = Patch::between([left + 2.0, top + 1.0], [left + WIDTH - 2.0, top + HEIGHT - 1.0]);
        let mut labels = Labels::new(sheet, places.iter().map(|place| Patch::around(*place, 4.5)).collect());
        let importance = |point: &Point| match (point.is_front, is_off(point, y), point.voxel_m) {
            (true, ..) => 0,
            (_, true, _) => 1,
            (.., None) => 2,
            _ => 3,
        };
        let mut order: Vec<usize> = (0..points.len()).filter(|&number| importance(points[number]) < 3).collect();
        order.sort_by_key(|&number| importance(points[number]));
        for number in order {
            let (point, [x, y_at]) = (points[number], places[number]);
            let text = if is_off(point, y) { off_text(point) } else { point_text(point) };
            if let Some([left, base]) = labels.place(&text, SMALL, [x, y_at], 8.0) {
                let colour = style(&point.method).colour;
                let weight = if point.is_front { "bold" } else { "normal" };
                writeln!(
                    out,
                    r##"<text x="{left:.1}" y="{base:.1}" font-size="{SMALL}" fill="{colour}" font-weight="{weight}" stroke="#ffffff" stroke-width="3" paint-order="stroke">{}</text>"##,
                    escaped(&text)
                )?;
            }
        }
        Ok(())
    }
}

/// Whether a point's error is not on the axis.
fn is_off(point: &Point, y: &Axis) -> bool {
    point.rms_factor().is_none_or(|factor| !factor.is_finite() || (factor > 2.0 && !y.shows(factor - 1.0)))
}

/// An arrow, and how many sensors are lost, or the factor.
fn off_text(point: &Point) -> String {
    match point.rms_factor() {
        Some(factor) if factor.is_finite() => format!("\u{2191}{factor:.0}x"),
        _ => format!("\u{2191}{}", point.errors.lost),
    }
}

/// The quality; for a method with one quality its name.
fn point_text(point: &Point) -> String {
    match (point.method.as_str(), point.quality.trim_end_matches(" samples")) {
        (method, "") => method.to_owned(),
        (method, quality) if method == Method::Trace.name() => quality.to_owned(),
        (method, quality) if point.voxel_m.is_some() => format!("{method} {quality}"),
        (_, quality) => quality.to_owned(),
    }
}

/// From the estimate alone to the total, pale: what the preparation adds.
fn draw_preparations(out: &mut dyn Write, points: &[&Point], places: &[[f64; 2]], x: &Axis) -> io::Result<()> {
    writeln!(out, r#"<g stroke-width="2.5" opacity="0.22">"#)?;
    for (point, [right, at]) in points.iter().zip(places).filter(|(point, _)| point.prepare_seconds > 0.0) {
        let [left, colour] = [format!("{:.1}", x.place(point.seconds)), style(&point.method).colour.to_owned()];
        writeln!(out, r#"<line x1="{left}" y1="{at:.1}" x2="{right:.1}" y2="{at:.1}" stroke="{colour}"/>"#)?;
    }
    writeln!(out, "</g>")
}

/// The qualities of one method at one voxel size, joined by a thin line.
fn draw_series(out: &mut dyn Write, points: &[&Point], places: &[[f64; 2]]) -> io::Result<()> {
    let mut start = 0;
    for series in points.chunk_by(|a, b| a.method == b.method && a.voxel_m == b.voxel_m) {
        let line: Vec<String> =
            places[start..start + series.len()].iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let colour = style(&series[0].method).colour;
        writeln!(
            out,
            r#"<polyline points="{}" fill="none" stroke="{colour}" stroke-width="1" opacity="0.5"/>"#,
            line.join(" ")
        )?;
        start += series.len();
    }
    Ok(())
}

/// The middle one of the voxel sizes, which is the scene's own.
fn own_voxels(points: &[&Point]) -> Option<f32> {
    let mut sizes: Vec<f32> = points.iter().filter_map(|point| point.voxel_m).collect();
    sizes.sort_by(f32::total_cmp);
    sizes.dedup();
    sizes.get(sizes.len().saturating_sub(1).div_ceil(2)).copied()
}
