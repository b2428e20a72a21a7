//! What stands about painted exposure maps: titles, axes and the legend of the colours, as SVG.

use super::picture::{Panel, Range};
use crate::export::legend;
use crate::export::plan::escaped;
use std::fmt::{Arguments, Write};

/// Room left of, above and below each map, and right of all for the legend.
const LEFT: usize = 64;
const ABOVE: usize = 56;
const BELOW: usize = 56;
const LEGEND: usize = 120;

/// Width from which a map has room for finer axes and longer words.
const WIDE_PX: usize = 640;

/// Where the maps of a picture lie, pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sheet {
    /// Width and height of each map.
    pub(super) map_px: [usize; 2],
    /// Maps in a row.
    columns: usize,
    rows: usize,
}

impl Sheet {
    pub(super) fn new(maps: usize, columns: usize, map_px: [usize; 2]) -> Self {
        let columns = columns.clamp(1, maps.max(1));
        Self { map_px, columns, rows: maps.div_ceil(columns).max(1) }
    }

    /// The upper left corner of a map.
    pub(super) fn corner(&self, number: usize) -> [usize; 2] {
        let [wide, high] = self.map_px;
        let [column, row] = [number % self.columns, number / self.columns];
        [LEFT + column * (LEFT + wide), ABOVE + row * (ABOVE + high + BELOW)]
    }

    /// The lower right corner of the last place for a map.
    fn end(&self) -> [usize; 2] {
        let [left, top] = self.corner(self.columns * self.rows - 1);
        [left + self.map_px[0], top + self.map_px[1]]
    }

    fn is_wide(&self) -> bool {
        self.map_px[0] >= WIDE_PX
    }
}

/// Titles, axes and legend of all panels as SVG.
pub(super) fn frame(sheet: &Sheet, panels: &[Panel], range: Range) -> String {
    let [right, bottom] = sheet.end();
    let [width, height] = [right + LEGEND, bottom + BELOW];
    let mut svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="14">"#
    );
    // Writing to a string cannot fail.
    let mut put = |line: Arguments| _ = svg.write_fmt(line);
    for (number, panel) in panels.iter().enumerate() {
        titles(&mut put, sheet, number, panel);
        axes(&mut put, sheet, number);
    }
    let [along, up] = [(LEFT + right) / 2, (ABOVE + bottom) / 2];
    put(format_args!(
        r##"<text x="{along}" y="{}" text-anchor="middle" fill="#555">azimuth, clockwise from true north</text>"##,
        bottom + 44
    ));
    put(format_args!(
        r##"<text transform="translate(16 {up}) rotate(-90)" text-anchor="middle" fill="#555">elevation</text>"##
    ));
    decades(&mut put, right + 22, [ABOVE, bottom], range);
    svg + "</svg>"
}

/// The title of a map and what its period brings.
fn titles(put: &mut dyn FnMut(Arguments), sheet: &Sheet, number: usize, panel: &Panel) {
    let [left, top] = sheet.corner(number);
    let (totals, title) = (panel.map.totals, escaped(&panel.title));
    // A day has too few for whole ones.
    let places = if totals.ghi_kwh_m2 < 100.0 { 2 } else { 0 };
    let totals = [totals.ghi_kwh_m2, totals.dni_kwh_m2, totals.dhi_kwh_m2].map(|total| format!("{total:.places$}"));
    let [ghi, dni, dhi] = totals;
    let (large, small, totals) = if sheet.is_wide() {
        (17, 14, format!("kWh/m²: global horizontal {ghi}, direct normal {dni}, diffuse horizontal {dhi}"))
    } else {
        (15, 12, format!("GHI {ghi}, DNI {dni}, DHI {dhi} kWh/m²"))
    };
    put(format_args!(r#"<text x="{left}" y="{}" font-size="{large}">{title}</text>"#, top - 34));
    put(format_args!(r##"<text x="{left}" y="{}" font-size="{small}" fill="#555">{totals}</text>"##, top - 13));
}

/// The edge of a map, and marks along it.
fn axes(put: &mut dyn FnMut(Arguments), sheet: &Sheet, number: usize) {
    let [left, top] = sheet.corner(number);
    let [wide, high] = sheet.map_px;
    let base = top + high;
    put(format_args!(r##"<rect x="{left}" y="{top}" width="{wide}" height="{high}" fill="none" stroke="#444"/>"##));

    let directions: &[&str] = if sheet.is_wide() {
        &["N 0°", "45°", "E 90°", "135°", "S 180°", "225°", "W 270°", "315°", "N 360°"]
    } else {
        &["N", "E", "S", "W", "N"]
    };
    for (number, direction) in directions.iter().enumerate() {
        let x = left as f32 + wide as f32 * number as f32 / (directions.len() - 1) as f32;
        put(format_args!(r##"<path d="M{x} {base}v6" stroke="#444"/>"##));
        put(format_args!(r#"<text x="{x}" y="{}" text-anchor="middle">{direction}</text>"#, base + 22));
    }
    for degrees in (0..=90).step_by(if sheet.is_wide() { 15 } else { 30 }) {
        let y = top as f32 + high as f32 * (1.0 - degrees as f32 / 90.0);
        put(format_args!(r##"<path d="M{left} {y}h-6" stroke="#444"/>"##));
        put(format_args!(r#"<text x="{}" y="{}" text-anchor="end">{degrees}°</text>"#, left - 9, y + 5.0));
    }
}

/// The colours, and a mark at each whole decade.
fn decades(put: &mut dyn FnMut(Arguments), bar: usize, span: [usize; 2], range: Range) {
    let Range { brightest, decades } = range;
    let lowest = brightest.log10() - decades;
    let marks = (lowest.ceil() as i32..=brightest.log10().floor() as i32).filter(|_| brightest > 0.0);
    let mark = |decade: i32| ((f64::from(decade) - lowest) / decades, 10_f64.powi(decade).to_string());
    legend::bar(put, bar, span, &marks.map(mark).collect::<Vec<_>>(), "kWh/m²/sr");
}
