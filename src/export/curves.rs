//! Curves over plain, linear axes: panels in a grid that share one legend. SVG.
//!
//! The charts of estimators are logarithmic and know their points ([`super::chart`]); these know nothing of what they show.

use super::plan::escaped;
use super::strips::COLOURS;
use std::io::{self, Write};

/// Size of a panel's drawing, room to the left and below for its axes and above for its title, in SVG units.
const WIDTH: f64 = 360.0;
const HEIGHT: f64 = 220.0;
const LEFT: f64 = 62.0;
const BELOW: f64 = 46.0;
const ABOVE: f64 = 34.0;
const RIGHT: f64 = 14.0;

/// Height of the legend, and the room a name has in it.
const LEGEND: f64 = 30.0;
const NAME: f64 = 130.0;

/// Dashes of curves in their order, so that they can be told apart without colours too.
const DASHES: [&str; 6] = ["none", "7 3", "2 2", "9 3 2 3", "4 4", "12 4"];

/// First days of the months in a year of 365 days, and their names.
const MONTHS: [(f64, &str); 12] = [
    (1.0, "Jan"),
    (32.0, "Feb"),
    (60.0, "Mar"),
    (91.0, "Apr"),
    (121.0, "May"),
    (152.0, "Jun"),
    (182.0, "Jul"),
    (213.0, "Aug"),
    (244.0, "Sep"),
    (274.0, "Oct"),
    (305.0, "Nov"),
    (335.0, "Dec"),
];

/// An axis: what it shows, with its unit, from where to where, and what is named on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it shows and its unit.
    pub name: String,
    /// Its ends.
    pub ends: [f64; 2],
    /// Values that have a line, and their names.
    pub ticks: Vec<(f64, String)>,
}

impl Axis {
    /// An axis with a tick every so much, from the first end on.
    pub fn every(name: &str, ends: [f64; 2], step: f64) -> Self {
        let count = ((ends[1] - ends[0]) / step + 1e-9).floor() as usize;
        let tick = |number: usize| {
            let value = ends[0] + number as f64 * step;
            (value, format!("{value}"))
        };
        Self { name: name.to_owned(), ends, ticks: (0..=count).map(tick).collect() }
    }

    /// The days of a year, 1 to 366, by their months.
    pub fn days_of_the_year() -> Self {
        let ticks = MONTHS.map(|(day, name)| (day, name.to_owned())).to_vec();
        Self { name: "day of the year".to_owned(), ends: [1.0, 366.0], ticks }
    }

    /// Where a value lies along the axis, 0 to 1; nothing off it.
    fn share(&self, value: f64) -> Option<f64> {
        let share = (value - self.ends[0]) / (self.ends[1] - self.ends[0]);
        (0.0..=1.0).contains(&share).then_some(share)
    }
}

/// A curve and its name. Points that are not finite, or lie off the axes, are gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// Its points, x and y, in their order.
    pub points: Vec<[f64; 2]>,
}

/// Curves over two axes. Panels of a figure have their curves in the same order: the legend is that of the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Writes panels as an SVG, so many in a row.
///
/// # Errors
/// What the writer says.
pub fn write(out: &mut dyn Write, panels: &[Panel], columns: usize) -> io::Result<()> {
    let columns = columns.max(1);
    let [cell_wide, cell_high] = [LEFT + WIDTH + RIGHT, ABOVE + HEIGHT + BELOW];
    let rows = panels.len().div_ceil(columns);
    let [width, height] = [columns as f64 * cell_wide, rows as f64 * cell_high + LEGEND];
    writeln!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" font-family="sans-serif" font-size="11" fill="#222">"##
    )?;
    writeln!(out, r##"<rect width="100%" height="100%" fill="#fff"/>"##)?;
    for (number, panel) in panels.iter().enumerate() {
        let [column, row] = [number % columns, number / columns];
        let corner = [column as f64 * cell_wide + LEFT, row as f64 * cell_high + ABOVE];
        draw_axes(out, panel, corner)?;
        for (number, curve) in panel.curves.iter().enumerate() {
            draw_curve(out, panel, corner, curve, number)?;
        }
    }
    if let Some(first) = panels.first() {
        draw_legend(out, &first.curves, height - LEGEND / 2.0)?;
    }
    writeln!(out, "</svg>")
}

fn draw_axes(out: &mut dyn Write, panel: &Panel, [left, top]: [f64; 2]) -> io::Result<()> {
    let [right, bottom] = [left + WIDTH, top + HEIGHT];
    writeln!(
        out,
        r#"<text x="{left:.1}" y="{:.1}" font-weight="bold" font-size="12">{}</text>"#,
        top - 10.0,
        escaped(&panel.title)
    )?;
    writeln!(out, r##"<g stroke="#e2e2e2">"##)?;
    let shown = |axis: &Axis| -> Vec<(f64, f64, String)> {
        axis.ticks.iter().filter_map(|(value, name)| Some((axis.share(*value)?, *value, name.clone()))).collect()
    };
    let [along_x, along_y] = [shown(&panel.x), shown(&panel.y)];
    for (share, ..) in &along_x {
        let x = left + share * WIDTH;
        writeln!(out, r#"<line x1="{x:.1}" y1="{top:.1}" x2="{x:.1}" y2="{bottom:.1}"/>"#)?;
    }
    for (share, value, _) in &along_y {
        let y = bottom - share * HEIGHT;
        let stroke = if *value == 0.0 { r##" stroke="#aaa""## } else { "" };
        writeln!(out, r#"<line x1="{left:.1}" y1="{y:.1}" x2="{right:.1}" y2="{y:.1}"{stroke}/>"#)?;
    }
    writeln!(out, r#"</g><g font-size="10">"#)?;
    for (share, _, name) in &along_x {
        let x = left + share * WIDTH;
        writeln!(out, r#"<text x="{x:.1}" y="{:.1}" text-anchor="middle">{}</text>"#, bottom + 14.0, escaped(name))?;
    }
    for (share, _, name) in &along_y {
        let y = bottom - share * HEIGHT + 3.5;
        writeln!(out, r#"<text x="{:.1}" y="{y:.1}" text-anchor="end">{}</text>"#, left - 6.0, escaped(name))?;
    }
    let [middle_x, middle_y] = [(left + right) / 2.0, (top + bottom) / 2.0];
    writeln!(out, "</g>")?;
    writeln!(
        out,
        r#"<text x="{middle_x:.1}" y="{:.1}" text-anchor="middle">{}</text>"#,
        bottom + 31.0,
        escaped(&panel.x.name)
    )?;
    writeln!(
        out,
        r#"<text x="0" y="0" text-anchor="middle" transform="translate({:.1},{middle_y:.1}) rotate(-90)">{}</text>"#,
        left - 42.0,
        escaped(&panel.y.name)
    )?;
    writeln!(out, r##"<rect x="{left:.1}" y="{top:.1}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>"##)
}

fn draw_curve(
    out: &mut dyn Write,
    panel: &Panel,
    [left, top]: [f64; 2],
    curve: &Curve,
    number: usize,
) -> io::Result<()> {
    let place = |[x, y]: [f64; 2]| {
        let [along, up] = [panel.x.share(x)?, panel.y.share(y)?];
        Some([left + along * WIDTH, top + (1.0 - up) * HEIGHT])
    };
    let places: Vec<Option<[f64; 2]>> = curve.points.iter().map(|&point| place(point)).collect();
    for run in places.split(|place| place.is_none()).filter(|run| run.len() > 1) {
        let line: Vec<String> = run.iter().flatten().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        writeln!(out, r#"<polyline points="{}" {}/>"#, line.join(" "), look(number))?;
    }
    Ok(())
}

fn draw_legend(out: &mut dyn Write, curves: &[Curve], y: f64) -> io::Result<()> {
    for (number, curve) in curves.iter().enumerate() {
        let x = LEFT + number as f64 * NAME;
        writeln!(out, r#"<line x1="{x:.1}" y1="{y:.1}" x2="{:.1}" y2="{y:.1}" {}/>"#, x + 26.0, look(number))?;
        writeln!(out, r#"<text x="{:.1}" y="{:.1}">{}</text>"#, x + 32.0, y + 4.0, escaped(&curve.name))?;
    }
    Ok(())
}

fn look(number: usize) -> String {
    let [colour, dashes] = [COLOURS[number % COLOURS.len()], DASHES[number % DASHES.len()]];
    format!(r#"fill="none" stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dashes}" stroke-linejoin="round""#)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_part_a_curve_and_nothing_leaves_its_panel() {
        let points = vec![[0.0, 0.0], [1.0, 5.0], [2.0, f64::NAN], [3.0, 5.0], [4.0, 50.0], [5.0, 1.0], [6.0, 2.0]];
        let panel = Panel {
            title: "a < b".to_owned(),
            x: Axis::every("x (h)", [0.0, 10.0], 5.0),
            y: Axis::every("y (m)", [0.0, 10.0], 2.5),
            curves: vec![Curve { name: "one".to_owned(), points }],
        };
        assert_eq!(panel.y.ticks.iter().map(|(_, name)| &**name).collect::<Vec<_>>(), ["0", "2.5", "5", "7.5", "10"]);
        let mut out = Vec::new();
        write(&mut out, &[panel], 2).unwrap();
        let text = String::from_utf8(out).unwrap();
        // The point between two gaps is no line.
        assert_eq!(text.matches("<polyline").count(), 2);
        assert!(text.contains("a &lt; b") && text.contains("y (m)") && !text.contains("NaN"));
    }
}
