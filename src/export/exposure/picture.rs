//! Exposure maps as a picture with a legend: azimuth across, elevation up, energy by colour on a logarithmic scale that all
//! maps of the picture share.

use super::frame::{Sheet, frame};
use crate::export::png::{Picture, dot, png};
use crate::export::scale::{INFERNO, colour};
use crate::sky::map::ExposureMap;
use resvg::tiny_skia;
use std::io;

/// Decades that the colours span, at least and at most.
const DECADES: [f64; 2] = [1.0, 7.0];

/// Decades that the scale goes on under the dimmest texel.
const BELOW: f64 = 0.3;

/// Pixels of a map that has the picture to itself: wide, as the horizon is four times as long as the way up.
const ALONE: [usize; 2] = [960, 480];

/// A map and what stands above it.
#[derive(Debug, Clone)]
pub struct Panel<'a> {
    /// Its title.
    pub title: String,
    /// The map.
    pub map: &'a ExposureMap,
}

/// Draws the map under a title.
///
/// # Errors
/// What the drawing says.
pub fn draw(map: &ExposureMap, title: &str) -> io::Result<Picture> {
    draw_many(&[Panel { title: title.to_owned(), map }], 1, ALONE)
}

/// Draws maps on one scale, so many in a row, each of so many pixels. From 640 pixels of width on the axes are finer.
///
/// # Errors
/// What the drawing says.
pub fn draw_many(panels: &[Panel], columns: usize, map_px: [usize; 2]) -> io::Result<Picture> {
    let radiances: Vec<Vec<f64>> = panels.iter().map(|panel| radiance(panel.map)).collect();
    let range = Range::of(&radiances);
    let sheet = Sheet::new(panels.len(), columns, map_px);
    png(&frame(&sheet, panels, range), 1.0, |pixels| {
        for (number, (panel, radiance)) in panels.iter().zip(&radiances).enumerate() {
            paint(pixels, &sheet, number, panel.map.size, radiance, range);
        }
    })
}

/// What the colours span, kWh/m2/sr: from the brightest texel to just under the dimmest that has light.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    pub(super) brightest: f64,
    pub(super) decades: f64,
}

impl Range {
    fn of(radiances: &[Vec<f64>]) -> Self {
        let values = || radiances.iter().flatten().copied();
        let brightest = values().fold(0.0, f64::max);
        let dimmest = values().filter(|&value| value > 0.0).fold(brightest, f64::min);
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
fn paint(
    pixels: &mut tiny_skia::Pixmap,
    sheet: &Sheet,
    number: usize,
    [columns, rows]: [usize; 2],
    radiance: &[f64],
    range: Range,
) {
    let [wide, high] = sheet.map_px;
    let [left, top] = sheet.corner(number);
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
            dot(pixels, [x + left, y + top], colour(&INFERNO, range.place(value)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::map::Check;
    use crate::sky::steps::Steps;

    /// Two maps of one texel: the dimmer one is dimmer in the picture too, for they share a scale.
    #[test]
    fn maps_of_a_picture_share_their_colours() {
        let map = |energy| ExposureMap::of_parts(&Steps::default(), [1, 1], vec![energy], vec![0.0], Check::default());
        let (dim, bright) = (map(1.0), map(100.0));
        let panels = [&dim, &bright].map(|map| Panel { title: "a < b".to_owned(), map });
        let picture = draw_many(&panels, 2, [40, 20]).unwrap();
        let picture = image::load_from_memory(&picture.bytes).unwrap().to_rgb8();

        let sheet = Sheet::new(2, 2, [40, 20]);
        let middle = |number| {
            let [left, top] = sheet.corner(number);
            picture.get_pixel(left as u32 + 20, top as u32 + 10).0
        };
        assert_eq!(middle(1), colour(&INFERNO, 1.0));
        assert_eq!(middle(0), colour(&INFERNO, BELOW / (2.0 + BELOW)));
    }
}
