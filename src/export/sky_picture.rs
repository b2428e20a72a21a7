//! Pictures of the sky: linear as OpenEXR and Radiance HDR, and for the eye as PNG.
//!
//! The linear files hold sRGB's primaries in kcd/m2 with the sun's disc as it is; EXR is transparent outside the sky, HDR
//! black. The PNG is tone-mapped: luminance Y becomes 1 - exp(-Y / white), so that what is as bright as `white` takes 63%; the
//! colour stays, mixed with grey as far as a screen needs it; all in sRGB's code. Its margin names north, east, south and west.

use crate::sky::colour::{luminance, tone_mapped};
use crate::sky::picture::Picture;
use image::codecs::hdr::HdrEncoder;
use image::codecs::openexr::OpenExrEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, Rgb};
use std::io::{self, Cursor, Write};

/// How bright the PNG is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exposure {
    /// The picture's own: `white` is the luminance that this share of the sky's pixels does not exceed, 0 to 1.
    Percentile(f64),
    /// The same for several pictures: `white` in kcd/m2.
    White(f64),
}

/// The brightest fifth of a clear sky is the glow around the sun; the rest keeps its colours.
pub const EXPOSURE: Exposure = Exposure::Percentile(0.8);

/// Writes Radiance HDR.
///
/// # Errors
/// What `out` says.
pub fn write_hdr(out: &mut dyn Write, picture: &Picture) -> io::Result<()> {
    let rgb: Vec<Rgb<f32>> = picture.rgb.iter().map(|rgb| Rgb(rgb.unwrap_or_default())).collect();
    HdrEncoder::new(out).encode(&rgb, picture.size_px, picture.size_px).map_err(io::Error::other)
}

/// Writes OpenEXR, f32, alpha 0 outside the sky.
///
/// # Errors
/// What `out` says.
pub fn write_exr(out: &mut dyn Write, picture: &Picture) -> io::Result<()> {
    let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    let rgba: Vec<u8> =
        picture.rgb.iter().flat_map(|rgb| rgb.map(opaque).unwrap_or_default()).flat_map(f32::to_ne_bytes).collect();
    // The encoder goes back in what it wrote.
    let mut file = Cursor::new(Vec::new());
    let size = side(picture.size_px)?;
    OpenExrEncoder::new(&mut file)
        .write_image(&rgba, size, size, ExtendedColorType::Rgba32F)
        .map_err(io::Error::other)?;
    out.write_all(file.get_ref())
}

/// Writes the tone-mapped PNG with its margin, transparent outside the sky.
///
/// # Errors
/// What `out` says.
pub fn write_png(out: &mut dyn Write, picture: &Picture, exposure: Exposure) -> io::Result<()> {
    let margin_px = margin_px(picture.size_px);
    let size_px = picture.size_px + 2 * margin_px;
    let white = white(picture, exposure);
    let mut rgba = vec![[0u8; 4]; size_px * size_px];

    for (at, rgb) in picture.rgb.iter().enumerate() {
        let place = (at / picture.size_px + margin_px) * size_px + at % picture.size_px + margin_px;
        if let Some(rgb) = rgb {
            let [r, g, b] = tone_mapped(rgb.map(f64::from), white);
            rgba[place] = [r, g, b, u8::MAX];
        }
    }
    for place in letter_pixels(size_px, margin_px) {
        rgba[place] = LETTER_RGBA;
    }

    let size = side(size_px)?;
    PngEncoder::new(out)
        .write_image(rgba.as_flattened(), size, size, ExtendedColorType::Rgba8)
        .map_err(io::Error::other)
}

/// Grey that shows on black and on white.
const LETTER_RGBA: [u8; 4] = [128, 128, 128, u8::MAX];

/// Letters of five by seven dots, a row a number, its highest of five bits on the left.
const NORTH: [u8; 7] = [0b10001, 0b11001, 0b11101, 0b10111, 0b10011, 0b10001, 0b10001];
const EAST: [u8; 7] = [0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111];
const SOUTH: [u8; 7] = [0b01111, 0b10000, 0b10000, 0b01110, 0b00001, 0b00001, 0b11110];
const WEST: [u8; 7] = [0b10001, 0b10001, 0b10001, 0b10101, 0b10101, 0b11011, 0b10001];

/// Room around the sky for the letters.
fn margin_px(size_px: usize) -> usize {
    (size_px / 20).max(9)
}

/// Pixels of the four letters, in the middles of the margins: north up, east left.
fn letter_pixels(size_px: usize, margin_px: usize) -> Vec<usize> {
    let dot_px = margin_px / 9;
    let (near, middle, far) = (margin_px / 2, size_px / 2, size_px - margin_px / 2);
    let letters = [(NORTH, middle, near), (EAST, near, middle), (SOUTH, middle, far), (WEST, far, middle)];

    let mut places = Vec::new();
    for (rows, column, row) in letters {
        let (left, top) = (column - 5 * dot_px / 2, row - 7 * dot_px / 2);
        for at in 0..5 * dot_px * 7 * dot_px {
            let (x, y) = (at % (5 * dot_px), at / (5 * dot_px));
            if rows[y / dot_px] >> (4 - x / dot_px) & 1 == 1 {
                places.push((top + y) * size_px + left + x);
            }
        }
    }
    places
}

/// The luminance that shows at 63%, kcd/m2; 0 for a black sky.
fn white(picture: &Picture, exposure: Exposure) -> f64 {
    match exposure {
        Exposure::White(white) => white,
        Exposure::Percentile(share) => {
            let mut levels: Vec<f64> = picture.rgb.iter().flatten().map(|rgb| luminance(rgb.map(f64::from))).collect();
            levels.sort_unstable_by(f64::total_cmp);
            let at = (share.clamp(0.0, 1.0) * levels.len().saturating_sub(1) as f64).round();
            levels.get(at as usize).copied().unwrap_or(0.0)
        }
    }
}

/// A side as the encoders want it.
fn side(size_px: usize) -> io::Result<u32> {
    u32::try_from(size_px).map_err(|_| io::Error::new(io::ErrorKind::InvalidInput, "the picture is too large"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::Sun;
    use crate::sky::picture::Colours;
    use crate::sky::spectrum::Atmosphere;
    use image::ImageFormat;

    fn sky(elevation_rad: f64) -> Picture {
        let sun = Sun { azimuth_rad: 2.0, elevation_rad };
        Picture::paint(sun, 1.0, &Atmosphere::new(3.0), Colours::Preetham, 48)
    }

    /// What is read again by the crate's decoders: EXR exactly, HDR to its eight bits of mantissa.
    #[test]
    fn linear_files_hold_the_picture() {
        let picture = sky(0.6);
        let (mut exr, mut hdr) = (Vec::new(), Vec::new());
        write_exr(&mut exr, &picture).unwrap();
        write_hdr(&mut hdr, &picture).unwrap();
        let exr = image::load_from_memory_with_format(&exr, ImageFormat::OpenExr).unwrap().to_rgba32f();
        let hdr = image::load_from_memory_with_format(&hdr, ImageFormat::Hdr).unwrap().to_rgb32f();
        for ((rgb, exr), hdr) in picture.rgb.iter().zip(exr.pixels()).zip(hdr.pixels()) {
            let want = rgb.unwrap_or_default();
            assert_eq!(exr.0, [want[0], want[1], want[2], if rgb.is_some() { 1.0 } else { 0.0 }]);
            let largest = want.iter().copied().fold(0.0, f32::max);
            assert!(hdr.0.iter().zip(want).all(|(a, b)| (a - b).abs() <= largest / 100.0), "{:?} {want:?}", hdr.0);
        }
    }

    #[test]
    fn the_png_shows_sky_letters_and_nothing_else() {
        let picture = sky(0.6);
        let mut file = Vec::new();
        write_png(&mut file, &picture, EXPOSURE).unwrap();
        let png = image::load_from_memory_with_format(&file, ImageFormat::Png).unwrap().to_rgba8();
        assert_eq!(png.dimensions(), (48 + 18, 48 + 18));
        let letters = png.pixels().filter(|pixel| pixel.0 == LETTER_RGBA).count();
        let dots = [NORTH, EAST, SOUTH, WEST].iter().flatten().map(|row| row.count_ones()).sum::<u32>();
        assert_eq!(letters as u32, dots);
        let opaque = png.pixels().filter(|pixel| pixel.0[3] > 0).count() - letters;
        assert_eq!(opaque, picture.rgb.iter().flatten().count());
    }

    #[test]
    fn exposure_is_by_percentile_or_given() {
        let picture = sky(0.6);
        let below = |white: f64| {
            let levels = picture.rgb.iter().flatten().map(|rgb| luminance(rgb.map(f64::from)));
            levels.filter(|level| *level <= white).count() as f64 / picture.rgb.iter().flatten().count() as f64
        };
        assert!((below(white(&picture, Exposure::Percentile(0.8))) - 0.8).abs() < 0.01);
        assert_eq!(white(&picture, Exposure::White(7.0)), 7.0);
        // 1 - 1/e is code 208: 255 (1.055 x 0.63212^(1/2.4) - 0.055) = 208.2.
        assert_eq!(tone_mapped([7.0; 3], 7.0), [208; 3]);
    }

    #[test]
    fn bright_colours_fade_to_white_and_keep_their_order() {
        let orange = [3.0, 1.5, 0.2];
        for white in [0.001, 0.1, 1.0, 100.0] {
            let [r, g, b] = tone_mapped(orange, white);
            assert!(r >= g && g >= b, "{white}: {r} {g} {b}");
        }
        assert_eq!(tone_mapped(orange, 0.001), [255; 3]);
        assert_eq!(tone_mapped([0.0; 3], 1.0), [0; 3]);
    }

    #[test]
    fn night_is_black() {
        let mut file = Vec::new();
        write_png(&mut file, &sky(-0.5), EXPOSURE).unwrap();
        let png = image::load_from_memory_with_format(&file, ImageFormat::Png).unwrap().to_rgba8();
        assert!(png.pixels().all(|pixel| pixel.0 == LETTER_RGBA || pixel.0[..3] == [0; 3]));
    }
}
