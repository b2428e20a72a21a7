//! An exposure map as a picture with a legend: azimuth across, elevation up, energy by colour on a logarithmic scale.

use crate::export::plan::escaped;
use crate::export::png::{Picture, png};
use crate::sky::map::ExposureMap;
use resvg::tiny_skia;
use std::fmt::Write;
use std::io;

/// Points of the perceptually even scale "inferno" (van der Walt & Smith), dark to bright.
const SCALE: [[f64; 3]; 8] = [
    [8.0, 6.0, 30.0],
    [59.0, 15.0, 112.0],
    [112.0, 25.0, 110.0],
    [164.0, 44.0, 96.0],
    [212.0, 72.0, 66.0],
    [245.0, 125.0, 21.0],
    [250.0, 193.0, 39.0],
    [252.0, 255.0, 164.0],
];

/// Decades that the colours span, at least and at most.
const DECADES: [f64; 2] = [1.0, 7.0];

/// Decades that the scale goes on under the dimmest texel.
const BELOW: f64 = 0.3;

/// Pixels of the map in the picture: wide, as the horizon is four times as long as the way up.
const MAP: [f32; 2] = [960.0, 480.0];

/// Room left, above, right and below it.
const MARGINS: [f32; 4] = [64.0, 56.0, 120.0, 56.0];

/// Draws the map under a title.
///
/// # Errors
/// What the drawing says.
pub fn draw(map: &ExposureMap, title: &str) -> io::Result<Picture> {
    let radiance = radiance(map);
    let range = Range::of(&radiance);
    png(&frame(map, title, range), 1.0, |sheet| paint(sheet, map, &radiance, range))
}

/// What the colours span, kWh/m2/sr: from the brightest texel to just under the dimmest that has light.
#[derive(Debug, Clone, Copy)]
struct Range {
    brightest: f64,
    decades: f64,
}

impl Range {
    fn of(radiance: &[f64]) -> Self {
        let brightest = radiance.iter().copied().fold(0.0, f64::max);
        let dimmest = radiance.iter().copied().filter(|&value| value > 0.0).fold(brightest, f64::min);
        let decades = if brightest > 0.0 { (brightest / dimmest).log10() + BELOW } else { 0.0 };
        Self { brightest, decades: decades.clamp(DECADES[0], DECADES[1]) }
    }

    /// From 0, at the dark end, to 1.
    fn place(self, value: f64) -> f64 {
        if value > 0.0 { (1.0 + (value / self.brightest).log10() / self.decades).clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// Sky and beams together in each texel, kWh/m2/sr.
fn radiance(map: &ExposureMap) -> Vec<f64> {
    let columns = map.size[0];
    let energies = map.diffuse_kwh_m2.iter().zip(&map.direct_kwh_m2).enumerate();
    energies.map(|(at, (diffuse, direct))| f64::from(diffuse + direct) / map.solid_angle_sr(at / columns)).collect()
}

/// Each pixel of the map's place takes the brightest texel that it covers, so that single suns stay in sight.
fn paint(sheet: &mut tiny_skia::Pixmap, map: &ExposureMap, radiance: &[f64], range: Range) {
    let [columns, rows] = map.size;
    let [wide, high] = MAP.map(|side| side as usize);
    let sheet_width = sheet.width() as usize;
    let covered = |pixel: usize, pixels: usize, texels: usize| {
        let from = pixel * texels / pixels;
        from..((pixel + 1) * texels).div_ceil(pixels).clamp(from + 1, texels)
    };
    for y in 0..high {
        let within = covered(high - 1 - y, high, rows);
        for x in 0..wide {
            let texels =
                within.clone().flat_map(|row| covered(x, wide, columns).map(move |column| row * columns + column));
            let value = texels.map(|texel| radiance[texel]).fold(0.0, f64::max);
            let [red, green, blue] = colour(range.place(value));
            let at = (y + MARGINS[1] as usize) * sheet_width + x + MARGINS[0] as usize;
            if let (Some(pixel), Some(colour)) =
                (sheet.pixels_mut().get_mut(at), tiny_skia::PremultipliedColorU8::from_rgba(red, green, blue, 255))
            {
                *pixel = colour;
            }
        }
    }
}

fn colour(part: f64) -> [u8; 3] {
    let place = part * (SCALE.len() - 1) as f64;
    let first = (place as usize).min(SCALE.len() - 2);
    let along = place - first as f64;
    std::array::from_fn(|band| (SCALE[first][band] * (1.0 - along) + SCALE[first + 1][band] * along).round() as u8)
}

/// Title, axes and legend as SVG.
fn frame(map: &ExposureMap, title: &str, range: Range) -> String {
    let [left, top, right, bottom] = MARGINS;
    let [width, height] = [left + MAP[0] + right, top + MAP[1] + bottom];
    let mut svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="14">"#
    );
    // Writing to a string cannot fail.
    let mut put = |line: std::fmt::Arguments| _ = svg.write_fmt(line);
    let totals = map.totals;
    // A day has too few for whole ones.
    let places = if totals.ghi_kwh_m2 < 100.0 { 2 } else { 0 };
    let title = escaped(title);
    put(format_args!(r#"<text x="{left}" y="22" font-size="17">{title}</text>"#));
    put(format_args!(
        r##"<text x="{left}" y="43" fill="#555">kWh/m²: global horizontal {:.places$}, direct normal {:.places$}, diffuse horizontal {:.places$}</text>"##,
        totals.ghi_kwh_m2, totals.dni_kwh_m2, totals.dhi_kwh_m2
    ));
    put(format_args!(
        r##"<rect x="{left}" y="{top}" width="{}" height="{}" fill="none" stroke="#444"/>"##,
        MAP[0], MAP[1]
    ));

    let directions = ["N 0°", "45°", "E 90°", "135°", "S 180°", "225°", "W 270°", "315°", "N 360°"];
    for (number, direction) in directions.iter().enumerate() {
        let x = left + MAP[0] * number as f32 / 8.0;
        let base = top + MAP[1];
        put(format_args!(r##"<path d="M{x} {base}v6" stroke="#444"/>"##));
        put(format_args!(r#"<text x="{x}" y="{}" text-anchor="middle">{direction}</text>"#, base + 22.0));
    }
    put(format_args!(
        r##"<text x="{}" y="{}" text-anchor="middle" fill="#555">azimuth, clockwise from true north</text>"##,
        left + MAP[0] / 2.0,
        top + MAP[1] + 44.0
    ));
    for degrees in (0..=90).step_by(15) {
        let y = top + MAP[1] * (1.0 - degrees as f32 / 90.0);
        put(format_args!(r##"<path d="M{left} {y}h-6" stroke="#444"/>"##));
        put(format_args!(r#"<text x="{}" y="{}" text-anchor="end">{degrees}°</text>"#, left - 9.0, y + 5.0));
    }
    let middle = top + MAP[1] / 2.0;
    put(format_args!(
        r##"<text transform="translate(16 {middle}) rotate(-90)" text-anchor="middle" fill="#555">elevation</text>"##
    ));

    // The colours in small steps, and a mark at each whole decade.
    const STEPS: usize = 64;
    let bar = left + MAP[0] + 22.0;
    for step in 0..STEPS {
        let part = (step as f64 + 0.5) / STEPS as f64;
        let [red, green, blue] = colour(part);
        let high = MAP[1] / STEPS as f32;
        let y = top + MAP[1] - high * (step + 1) as f32;
        put(format_args!(
            r#"<rect x="{bar}" y="{y}" width="16" height="{}" fill="rgb({red},{green},{blue})"/>"#,
            high + 0.5
        ));
    }
    let Range { brightest, decades: span } = range;
    let lowest = brightest.log10() - span;
    let decades = (lowest.ceil() as i32..=brightest.log10().floor() as i32).filter(|_| brightest > 0.0);
    for decade in decades {
        let y = top + MAP[1] * (1.0 - ((f64::from(decade) - lowest) / span) as f32);
        put(format_args!(r##"<path d="M{} {y}h5" stroke="#444"/>"##, bar + 16.0));
        let value = 10_f64.powi(decade);
        put(format_args!(r#"<text x="{}" y="{}">{value}</text>"#, bar + 24.0, y + 5.0));
    }
    put(format_args!(r##"<text x="{}" y="{}" fill="#555">kWh/m²/sr</text>"##, bar - 8.0, top - 12.0));
    svg + "</svg>"
}
