//! A picture of a stress test: for each failure and case a strip of dots a method, one dot an answer, along an axis of
//! factors, logarithmic in what they have above 1. Left: how far answers move; right: how far they are from the truth. The scenes of a case lie in one strip.

use crate::study::stress::{Failure, Row, Spread};
use std::io::{self, Write};

/// Widths of the text at the left, of each of the two panels, and between them, in SVG units.
const TEXT: f64 = 262.0;
const PANEL: f64 = 400.0;
const GAP: f64 = 40.0;

/// Height of a strip, room above a case and above a failure, height of the head.
const STRIP: f64 = 9.0;
const ABOVE_CASE: f64 = 5.0;
const ABOVE_FAILURE: f64 = 9.0;
const HEAD: f64 = 54.0;

/// The axis begins this far above 1; what is nearer to 1 stands there too.
const LEAST_ABOVE: f64 = 0.01;

/// The axis ends here; what is infinite stands beyond it.
const MOST_FACTOR: f64 = 1000.0;

/// Dots a strip: of more answers this many evenly from least to greatest are drawn.
const MOST_DOTS: usize = 40;

/// Colours of methods in their order: told apart by those who see no red or green (Okabe & Ito 2008).
pub(super) const COLOURS: [&str; 6] = ["#d55e00", "#e69f00", "#0072b2", "#009e73", "#cc79a7", "#555555"];

/// One strip: a case of a failure, by one method, over all its scenes.
struct Strip<'a> {
    failure: Failure,
    case: &'a str,
    method: usize,
    moved: Vec<f64>,
    truth: Vec<f64>,
}

/// Writes the picture.
///
/// # Errors
/// What the writer says.
pub fn write(out: &mut dyn Write, rows: &[Row]) -> io::Result<()> {
    let mut methods: Vec<&str> = Vec::new();
    rows.iter().for_each(|row| {
        if !methods.contains(&&*row.method) {
            methods.push(&row.method);
        }
    });
    let strips = strips(rows, &methods);
    let tops = tops(&strips);
    let height = tops.last().copied().unwrap_or(HEAD) + 2.0 * STRIP + 10.0;
    let width = TEXT + 2.0 * PANEL + 2.0 * GAP;
    writeln!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" font-family="sans-serif" font-size="11" fill="#222">"##
    )?;
    writeln!(out, r##"<rect width="100%" height="100%" fill="#fff"/>"##)?;
    draw_head(out, &methods, height)?;
    for (number, (strip, &top)) in strips.iter().zip(&tops).enumerate() {
        let before = number.checked_sub(1).and_then(|before| strips.get(before));
        draw_names(out, strip, before, top)?;
        draw_dots(out, &strip.moved, TEXT, top, colour(strip.method))?;
        draw_dots(out, &strip.truth, TEXT + PANEL + GAP, top, colour(strip.method))?;
    }
    writeln!(out, "</svg>")
}

/// Rows of one failure, case and method joined, in the order in which they first stand, methods within cases.
fn strips<'a>(rows: &'a [Row], methods: &[&str]) -> Vec<Strip<'a>> {
    let mut strips: Vec<Strip> = Vec::new();
    for row in rows {
        let method = methods.iter().position(|&name| name == row.method).unwrap_or(0);
        let is_its =
            |strip: &&mut Strip| strip.failure == row.failure && strip.case == row.case && strip.method == method;
        let [moved, truth] = [&row.moved, &row.truth].map(|Spread { factors, .. }| factors);
        match strips.iter_mut().find(is_its) {
            Some(strip) => {
                strip.moved.extend(moved);
                strip.truth.extend(truth);
            }
            None => strips.push(Strip {
                failure: row.failure,
                case: &row.case,
                method,
                moved: moved.clone(),
                truth: truth.clone(),
            }),
        }
    }
    strips.sort_by_key(|strip| strip.failure as usize);
    for strip in &mut strips {
        strip.moved.sort_by(f64::total_cmp);
        strip.truth.sort_by(f64::total_cmp);
    }
    strips
}

/// The top of each strip.
fn tops(strips: &[Strip]) -> Vec<f64> {
    let mut top = HEAD;
    let mut before: Option<&Strip> = None;
    let next = strips.iter().map(|strip| {
        top += match before {
            Some(before) if before.failure != strip.failure => STRIP + ABOVE_FAILURE,
            Some(before) if before.case != strip.case => STRIP + ABOVE_CASE,
            Some(_) => STRIP,
            None => 0.0,
        };
        before = Some(strip);
        top
    });
    next.collect()
}

fn draw_head(out: &mut dyn Write, methods: &[&str], height: f64) -> io::Result<()> {
    let titles = ["by which factor answers move", "by which factor answers are off the truth"];
    for (panel, title) in titles.into_iter().enumerate() {
        let left = TEXT + panel as f64 * (PANEL + GAP);
        writeln!(out, r#"<text x="{left:.1}" y="16" font-weight="bold">{title}</text>"#)?;
        for factor in [1.0, 1.03, 1.1, 1.3, 2.0, 4.0, 10.0, 100.0, MOST_FACTOR, f64::INFINITY] {
            let x = left + along(factor);
            let name = if factor.is_finite() { factor.to_string() } else { "zero".to_owned() };
            let (from, to) = (HEAD - 14.0, height - 8.0);
            writeln!(out, r##"<line x1="{x:.1}" y1="{from:.1}" x2="{x:.1}" y2="{to:.1}" stroke="#ddd"/>"##)?;
            writeln!(
                out,
                r#"<text x="{x:.1}" y="{:.1}" font-size="9" text-anchor="middle">{name}</text>"#,
                from - 3.0
            )?;
        }
    }
    for (number, method) in methods.iter().enumerate() {
        let y = 14.0 + 11.0 * number as f64;
        writeln!(out, r#"<circle cx="14" cy="{:.1}" r="4" fill="{}"/>"#, y - 4.0, colour(number))?;
        writeln!(out, r#"<text x="22" y="{y:.1}">{method}</text>"#)?;
    }
    writeln!(out, r#"<text x="110" y="14" font-size="9">a dot an answer,</text>"#)?;
    writeln!(out, r#"<text x="110" y="25" font-size="9">a bar: 95% lie left of it</text>"#)
}

/// The names of failure and case beside the first strip that is of them.
fn draw_names(out: &mut dyn Write, strip: &Strip, before: Option<&Strip>, top: f64) -> io::Result<()> {
    let y = top + STRIP;
    let is_new_failure = before.is_none_or(|before| before.failure != strip.failure);
    if is_new_failure {
        writeln!(
            out,
            r##"<line x1="6" y1="{0:.1}" x2="{1:.1}" y2="{0:.1}" stroke="#999"/>"##,
            top - 4.0,
            TEXT + 2.0 * PANEL + 1.5 * GAP
        )?;
        writeln!(out, r#"<text x="6" y="{y:.1}" font-weight="bold" font-size="10">{}</text>"#, strip.failure.name())?;
    }
    if is_new_failure || before.is_none_or(|before| before.case != strip.case) {
        writeln!(out, r#"<text x="98" y="{y:.1}" font-size="9">{}</text>"#, strip.case)?;
    }
    Ok(())
}

fn draw_dots(out: &mut dyn Write, factors: &[f64], left: f64, top: f64, colour: &str) -> io::Result<()> {
    let y = top + 0.5 * STRIP;
    let shown = factors.len().min(MOST_DOTS);
    writeln!(out, r#"<g fill="{colour}" fill-opacity="0.45">"#)?;
    for place in 0..shown {
        // Both ends are drawn.
        let number = if shown > 1 { place * (factors.len() - 1) / (shown - 1) } else { 0 };
        let x = left + along(factors[number]);
        writeln!(out, r#"<circle cx="{x:.1}" cy="{y:.1}" r="2.2"/>"#)?;
    }
    writeln!(out, "</g>")?;
    let p95 = Spread { factors: factors.to_vec(), ..Spread::default() }.p95();
    if let Some(x) = p95.map(|factor| left + along(factor)) {
        let (from, to) = (top + 0.5, top + STRIP - 0.5);
        writeln!(
            out,
            r#"<line x1="{x:.1}" y1="{from:.1}" x2="{x:.1}" y2="{to:.1}" stroke="{colour}" stroke-width="2"/>"#
        )?;
    }
    Ok(())
}

/// Where a factor stands along its panel: by the logarithm of what it has above 1.
fn along(factor: f64) -> f64 {
    if factor.is_infinite() {
        return PANEL;
    }
    let above = |factor: f64| ((factor - 1.0).max(LEAST_ABOVE) / LEAST_ABOVE).log10();
    0.94 * PANEL * (above(factor) / above(MOST_FACTOR)).min(1.0)
}

fn colour(method: usize) -> &'static str {
    COLOURS[method % COLOURS.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn scenes_share_a_strip_and_every_dot_is_on_the_sheet() {
        let row = |scene: &str, method: &str, factors: &[f64]| {
            let mut row = Row::new(&Scene { name: scene.into(), ..Scene::default() }, Failure::Turn, "8 turns", method);
            row.moved.factors = factors.to_vec();
            row
        };
        let rows =
            [row("a", "backward", &[1.0, 2.0]), row("a", "forward", &[f64::INFINITY]), row("b", "backward", &[1e9])];
        let mut out = Vec::new();
        write(&mut out, &rows).expect("a vector takes all");
        let text = String::from_utf8(out).expect("text");
        // Two dots of the legend, four answers.
        assert_eq!(text.matches("<circle").count(), 2 + 4);
        assert_eq!(text.matches("8 turns").count(), 1);
        assert!(!text.contains("NaN") && !text.contains("inf\""));
        assert_eq!((along(1.0), along(f64::INFINITY)), (0.0, PANEL));
    }
}
