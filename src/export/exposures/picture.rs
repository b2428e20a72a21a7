//! What a camera sees as a picture: each pixel in the colour of its value, a legend with its unit beside it.

use super::mesh::Colours;
use super::view::View;
use crate::daylight::Quantity;
use crate::export::legend;
use crate::export::plan::escaped;
use crate::export::png::{Picture, dot, png};
use std::fmt::Write;
use std::io;

/// Room about the picture, and right of it for the legend.
const MARGIN: usize = 20;
const ABOVE: usize = 66;
const LEGEND: usize = 110;

/// Pixels of small pictures are drawn as squares until the picture is about so wide; the text needs that room.
const NARROWEST: usize = 560;

/// Where there is nothing: a pale sky, which no value has as its colour.
const BACKGROUND: [u8; 3] = [214, 226, 238];

/// Draws the picture under a title and a line about how it was made.
///
/// # Errors
/// What the drawing says.
pub fn draw(view: &View, colours: Colours, title: &str, note: &str) -> io::Result<Picture> {
    let [columns, rows] = view.size;
    let zoom = (NARROWEST / columns.max(1)).max(1);
    let [wide, high] = [columns * zoom, rows * zoom];
    let [right, bottom] = [MARGIN + wide, ABOVE + high];
    let [width, height] = [right.max(MARGIN + NARROWEST) + LEGEND, bottom.max(ABOVE + 120) + MARGIN];
    let mut svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="14">"#
    );
    // Writing to a string cannot fail.
    let mut put = |line: std::fmt::Arguments| _ = svg.write_fmt(line);
    put(format_args!(r#"<text x="{MARGIN}" y="28" font-size="17">{}</text>"#, escaped(title)));
    put(format_args!(r##"<text x="{MARGIN}" y="50" font-size="13" fill="#555">{}</text>"##, escaped(note)));
    let span = colours.span;
    let places = if span.step < 1.0 { (-span.step.log10()).ceil() as usize } else { 0 };
    let mark = |value: f64| (span.part(value), format!("{value:.places$}"));
    let marks: Vec<(f64, String)> = span.marks().into_iter().map(mark).collect();
    let unit = if colours.quantity == Quantity::Svf { "" } else { colours.quantity.unit() };
    legend::bar(&mut put, right + MARGIN, [ABOVE, bottom.max(ABOVE + 120)], &marks, unit);
    svg.push_str("</svg>");

    png(&svg, 1.0, |sheet| {
        for (pixel, exposure) in view.by_pixel().into_iter().enumerate() {
            let colour = exposure.map_or(BACKGROUND, |exposure| colours.of(exposure));
            let [left, top] = [MARGIN + pixel % columns * zoom, ABOVE + pixel / columns * zoom];
            for (x, y) in (0..zoom * zoom).map(|at| (at % zoom, at / zoom)) {
                dot(sheet, [left + x, top + y], colour);
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::Exposure;
    use crate::export::scale::{INFERNO, Span, colour};
    use crate::light::Status;

    #[test]
    fn pixels_have_the_colours_of_their_values() {
        let lit = |beam_kwh_m2| Exposure { beam_kwh_m2, ..Exposure::none(Status::Ok) };
        let exposures = [lit(100.0), lit(0.0), Exposure::none(Status::InSolid)];
        let view = View { size: [2, 2], pixels: &[0, 1, 3], exposures: &exposures };
        let colours = Colours { quantity: Quantity::Beam, span: Span::up_to(100.0) };
        let picture = draw(&view, colours, "a < b", "").unwrap();
        let picture = image::load_from_memory(&picture.bytes).unwrap().to_rgb8();
        let zoom = NARROWEST / 2;
        let at = |column: usize, row: usize| {
            let [x, y] = [MARGIN + column * zoom + zoom / 2, ABOVE + row * zoom + zoom / 2];
            picture.get_pixel(x as u32, y as u32).0
        };
        assert_eq!([at(0, 0), at(1, 0)], [colour(&INFERNO, 1.0), colour(&INFERNO, 0.0)]);
        assert_eq!([at(0, 1), at(1, 1)], [BACKGROUND, super::super::mesh::NO_VALUE]);
    }
}
