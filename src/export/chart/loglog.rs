//! Marks of series over two logarithmic axes: how fast against how far off, or how dear against how large. SVG.
//!
//! Panels in a grid, each with axes of its own, under one legend. Where the best are asked for, those that no other mark of their
//! panel lies both right of and below are ringed and joined by stairs: the least error that is to be had at a speed.

use super::axes::Axis;
use super::labels::{Labels, Patch};
use super::panel::{HEIGHT, WIDTH};
use super::style::{by_order, draw_mark};
use crate::export::plan::escaped;
use std::io::{self, Write};

/// Room to the left of a panel for its values, to the right, above and below it, and for the legend.
const LEFT: f64 = 74.0;
const RIGHT: f64 = 16.0;
const ABOVE: f64 = 30.0;
const BELOW: f64 = 50.0;
const LEGEND: f64 = 40.0;

/// Room beyond the outermost marks, as a factor of the value.
const MARGIN: f64 = 1.5;

/// Half the size of a mark, and the font size of labels.
const HALF: f64 = 4.5;
const SMALL: f64 = 10.5;

/// Wider than this many decades an axis names these alone.
const MOST_DECADES: f64 = 2.6;

/// A mark of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Whose it is: its colour, its shape and its name in the legend. Marks of a series are joined in their order.
    pub series: String,
    /// What stands beside it where there is room.
    pub label: String,
    /// To the right and up, both above 0.
    pub at: [f64; 2],
    /// Whether it is drawn hollow, and joined to hollow ones alone.
    pub is_hollow: bool,
}

/// A panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// What its axes show, to the right and up, with their units.
    pub axes: [String; 2],
    /// The marks; those that are not finite or not above 0 are left out.
    pub marks: Vec<Mark>,
    /// Whether the best are sought: far right and low.
    pub has_front: bool,
}

impl Panel {
    fn shown(&self) -> Vec<&Mark> {
        let is_shown = |mark: &&Mark| mark.at.iter().all(|value| value.is_finite() && *value > 0.0);
        self.marks.iter().filter(is_shown).collect()
    }
}

/// Which marks no other one lies both right of and below, in their order.
pub fn front(at: &[[f64; 2]]) -> Vec<bool> {
    let beats = |a: [f64; 2], b: [f64; 2]| a[0] >= b[0] && a[1] <= b[1] && a != b;
    at.iter().map(|&this| !at.iter().any(|&other| beats(other, this))).collect()
}

/// Writes panels, so many in a row; `says` stands in the legend behind the names of the series.
///
/// # Errors
/// What the writer says.
pub fn write(out: &mut dyn Write, panels: &[Panel], columns: usize, says: &str) -> io::Result<()> {
    let columns = columns.max(1);
    let mut series: Vec<&str> = Vec::new();
    for mark in panels.iter().flat_map(|panel| &panel.marks) {
        if !series.contains(&mark.series.as_str()) {
            series.push(&mark.series);
        }
    }
    let [cell_wide, cell_high] = [LEFT + WIDTH + RIGHT, ABOVE + HEIGHT + BELOW];
    let (width, height) = (columns as f64 * cell_wide, LEGEND + panels.len().div_ceil(columns) as f64 * cell_high);
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" font-family="DejaVu Sans, Verdana, Arial, sans-serif" font-size="13">"#
    )?;
    writeln!(out, r##"<rect width="100%" height="100%" fill="#ffffff"/>"##)?;
    draw_legend(out, &series, says)?;
    for (number, panel) in panels.iter().enumerate() {
        let corner =
            [(number % columns) as f64 * cell_wide + LEFT, LEGEND + (number / columns) as f64 * cell_high + ABOVE];
        draw_panel(out, panel, &series, corner)?;
    }
    writeln!(out, "</svg>")
}

fn draw_legend(out: &mut dyn Write, series: &[&str], says: &str) -> io::Result<()> {
    let mut left = LEFT;
    for (number, name) in series.iter().enumerate() {
        draw_mark(out, by_order(number), [left + 6.0, 20.0], 5.5, false, false)?;
        writeln!(out, r#"<text x="{:.1}" y="24.5">{}</text>"#, left + 17.0, escaped(name))?;
        left += 40.0 + 7.8 * name.len() as f64;
    }
    writeln!(out, r##"<text x="{left:.1}" y="24.5" font-size="12" fill="#444444">{}</text>"##, escaped(says))
}

fn draw_panel(out: &mut dyn Write, panel: &Panel, series: &[&str], [left, top]: [f64; 2]) -> io::Result<()> {
    let marks = panel.shown();
    let axis = |side: usize, places: [f64; 2]| {
        let ends = ends(marks.iter().map(|mark| mark.at[side]));
        (Axis::new(ends, places), ticks(ends))
    };
    let (x, right_ticks) = axis(0, [left, left + WIDTH]);
    let (y, up_ticks) = axis(1, [top + HEIGHT, top]);
    draw_frame(out, panel, [left, top], [(&x, &right_ticks), (&y, &up_ticks)])?;

    let places: Vec<[f64; 2]> = marks.iter().map(|mark| [x.place(mark.at[0]), y.place(mark.at[1])]).collect();
    let number_of = |mark: &Mark| series.iter().position(|name| *name == mark.series).unwrap_or(0);
    for (number, name) in series.iter().enumerate() {
        for is_hollow in [false, true] {
            let its = marks.iter().zip(&places).filter(|(mark, _)| mark.series == *name && mark.is_hollow == is_hollow);
            let line: Vec<String> = its.map(|(_, [x, y])| format!("{x:.1},{y:.1}")).collect();
            let (colour, line) = (by_order(number).colour, line.join(" "));
            writeln!(out, r#"<polyline points="{line}" fill="none" stroke="{colour}" opacity="0.5"/>"#)?;
        }
    }
    let is_best = if panel.has_front {
        front(&marks.iter().map(|mark| mark.at).collect::<Vec<_>>())
    } else {
        vec![false; marks.len()]
    };
    let best: Vec<[f64; 2]> = places.iter().zip(&is_best).filter(|(_, best)| **best).map(|(place, _)| *place).collect();
    draw_stairs(out, best, [left, top])?;
    for ((mark, place), &is_best) in marks.iter().zip(&places).zip(&is_best) {
        draw_mark(out, by_order(number_of(mark)), *place, HALF, mark.is_hollow, is_best)?;
    }

    let sheet = Patch::between([left + 2.0, top + 1.0], [left + WIDTH - 2.0, top + HEIGHT - 1.0]);
    let mut labels = Labels::new(sheet, places.iter().map(|place| Patch::around(*place, HALF)).collect());
    let mut order: Vec<usize> = (0..marks.len()).collect();
    order.sort_by_key(|&number| !is_best[number]);
    for number in order {
        let (mark, place) = (marks[number], places[number]);
        if let Some([left, base]) = labels.place(&mark.label, SMALL, place, 8.0) {
            let colour = by_order(number_of(mark)).colour;
            let weight = if is_best[number] { "bold" } else { "normal" };
            writeln!(
                out,
                r##"<text x="{left:.1}" y="{base:.1}" font-size="{SMALL}" fill="{colour}" font-weight="{weight}" stroke="#ffffff" stroke-width="3" paint-order="stroke">{}</text>"##,
                escaped(&mark.label)
            )?;
        }
    }
    Ok(())
}

fn draw_frame(
    out: &mut dyn Write,
    panel: &Panel,
    [left, top]: [f64; 2],
    [(x, right_ticks), (y, up_ticks)]: [(&Axis, &[(f64, String)]); 2],
) -> io::Result<()> {
    let [right, bottom] = [left + WIDTH, top + HEIGHT];
    writeln!(out, r#"<text x="{left:.1}" y="{:.1}" font-weight="bold">{}</text>"#, top - 9.0, escaped(&panel.title))?;
    writeln!(out, r##"<g stroke="#e4e4e4">"##)?;
    for (value, _) in right_ticks {
        let at = x.place(*value);
        writeln!(out, r#"<line x1="{at:.1}" y1="{top:.1}" x2="{at:.1}" y2="{bottom:.1}"/>"#)?;
    }
    for (value, _) in up_ticks {
        let at = y.place(*value);
        writeln!(out, r#"<line x1="{left:.1}" y1="{at:.1}" x2="{right:.1}" y2="{at:.1}"/>"#)?;
    }
    writeln!(out, r##"</g><g fill="#444444" font-size="12">"##)?;
    for (value, name) in right_ticks {
        let at = x.place(*value);
        writeln!(out, r#"<text x="{at:.1}" y="{:.1}" text-anchor="middle">{name}</text>"#, bottom + 16.0)?;
    }
    for (value, name) in up_ticks {
        let at = y.place(*value);
        writeln!(out, r#"<text x="{:.1}" y="{:.1}" text-anchor="end">{name}</text>"#, left - 6.0, at + 4.0)?;
    }
    let [middle_x, middle_y] = [(left + right) / 2.0, (top + bottom) / 2.0];
    let [right_name, up_name] = panel.axes.each_ref().map(|name| escaped(name));
    writeln!(out, r#"<text x="{middle_x:.1}" y="{:.1}" text-anchor="middle">{right_name}</text>"#, bottom + 36.0)?;
    writeln!(
        out,
        r#"<text transform="translate({:.1} {middle_y:.1}) rotate(-90)" text-anchor="middle">{up_name}</text></g>"#,
        left - 52.0
    )?;
    writeln!(
        out,
        r##"<rect x="{left:.1}" y="{top:.1}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888888"/>"##
    )
}

/// The least error that is to be had at a speed or above it.
fn draw_stairs(out: &mut dyn Write, mut best: Vec<[f64; 2]>, [left, top]: [f64; 2]) -> io::Result<()> {
    best.sort_by(|a, b| a[0].total_cmp(&b[0]));
    if best.is_empty() {
        return Ok(());
    }
    let steps: String = best.iter().map(|[x, y]| format!(" V{y:.1} H{x:.1}")).collect();
    let start = best[0][1];
    writeln!(
        out,
        r##"<path d="M{left:.1},{start:.1}{steps} V{top:.1}" fill="none" stroke="#777777" stroke-width="1.2"/>"##
    )
}

/// Ends of an axis around these values; a decade where there are none.
fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let wider = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], wider);
    if low > high { [1.0, 10.0] } else { [low / MARGIN, high * MARGIN] }
}

/// Values of an axis that have a line, and their names: decades, on a short axis their halves and fifths too.
fn ticks([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let digits: &[i32] = if (high / low).log10() > MOST_DECADES { &[1] } else { &[1, 2, 5] };
    let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let values = decades.flat_map(|decade| {
        let power = move |digit: i32| format!("{digit}e{decade}").parse::<f64>().unwrap_or(1.0);
        digits.iter().map(move |&digit| power(digit))
    });
    values.filter(|value| (low..=high).contains(value)).map(|value| (value, name(value))).collect()
}

/// A number in few digits.
fn name(value: f64) -> String {
    match value {
        1e6.. => format!("{} M", value / 1e6),
        1e3.. => format!("{} k", value / 1e3),
        _ => format!("{value}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let at = [[1.0, 1.0], [10.0, 2.0], [5.0, 2.0], [10.0, 3.0], [100.0, 9.0], [100.0, 9.0]];
        assert_eq!(front(&at), [true, true, false, false, true, true]);
    }

    #[test]
    fn every_mark_is_drawn_but_those_without_a_logarithm() {
        let mark =
            |series: &str, at: [f64; 2]| Mark { series: series.into(), label: "16".into(), at, is_hollow: false };
        let marks = vec![
            mark("a < b", [10.0, 3.0]),
            mark("a < b", [2e6, 30.0]),
            mark("c", [f64::NAN, 1.0]),
            mark("c", [1.0, 0.0]),
        ];
        let panel = Panel { title: "t".into(), axes: ["x".into(), "y".into()], marks, has_front: true };
        let mut svg = Vec::new();
        write(&mut svg, &[panel.clone(), Panel { marks: Vec::new(), ..panel }], 2, "says").unwrap();
        let svg = String::from_utf8(svg).unwrap();
        // Rings of the best, of which both are.
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(svg.contains("a &lt; b") && svg.contains(">1 M<") && svg.contains(">20<"), "{svg}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn ticks_are_decades_or_parts_of_them() {
        let names = |ends| ticks(ends).into_iter().map(|(_, name)| name).collect::<Vec<_>>();
        assert_eq!(names([0.4, 30.0]), ["0.5", "1", "2", "5", "10", "20"]);
        assert_eq!(names([90.0, 2e6]), ["100", "1 k", "10 k", "100 k", "1 M"]);
    }
}
