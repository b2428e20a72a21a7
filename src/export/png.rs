//! An SVG as a PNG, by resvg with the fonts of the system.

use resvg::{tiny_skia, usvg};
use std::io;

/// Families that have all our signs, the first that is there serving for `sans-serif`.
const FAMILIES: [&str; 6] = ["DejaVu Sans", "Liberation Sans", "Noto Sans", "Arial", "Verdana", "Helvetica"];

/// A picture as it is written to a file.
pub struct Picture {
    /// The PNG.
    pub bytes: Vec<u8>,
    /// Whether the system had a font to write with; without one the picture has no text.
    pub has_text: bool,
}

/// Draws an SVG, given as text, `scale` pixels a unit, on white and on what `under` paints on that.
///
/// # Errors
/// What resvg says to text that is no SVG, or to a size that cannot be drawn.
pub fn png(svg: &str, scale: f32, under: impl FnOnce(&mut tiny_skia::Pixmap)) -> io::Result<Picture> {
    let mut options = usvg::Options::default();
    let fonts = options.fontdb_mut();
    fonts.load_system_fonts();
    let is_there = |family: &&&str| fonts.faces().any(|face| face.families.iter().any(|(name, _)| name == **family));
    if let Some(family) = FAMILIES.iter().find(is_there) {
        fonts.set_sans_serif_family(*family);
    }
    let has_text = !options.fontdb.is_empty();

    let tree = usvg::Tree::from_str(svg, &options).map_err(io::Error::other)?;
    let size = tree.size();
    let [width, height] = [size.width(), size.height()].map(|side| (side * scale).ceil() as u32);
    let too_large = || io::Error::other(format!("a picture of {width} x {height} pixels cannot be drawn"));
    let mut sheet = tiny_skia::Pixmap::new(width, height).ok_or_else(too_large)?;
    sheet.fill(tiny_skia::Color::WHITE);
    under(&mut sheet);
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut sheet.as_mut());
    let bytes = sheet.encode_png().map_err(io::Error::other)?;
    Ok(Picture { bytes, has_text })
}

/// Colours one pixel, column and row from the upper left corner; nothing beyond the sheet.
pub fn dot(sheet: &mut tiny_skia::Pixmap, [x, y]: [usize; 2], [red, green, blue]: [u8; 3]) {
    let width = sheet.width() as usize;
    let colour = tiny_skia::PremultipliedColorU8::from_rgba(red, green, blue, u8::MAX);
    if let (Some(pixel), Some(colour)) = (sheet.pixels_mut().get_mut(y * width + x).filter(|_| x < width), colour) {
        *pixel = colour;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_svg_becomes_a_png_of_its_size() {
        let svg =
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20"><rect width="9" height="9"/></svg>"##;
        let picture = png(svg, 1.5, |_| ()).unwrap();
        assert_eq!(&picture.bytes[1..4], b"PNG");
        assert_eq!(&picture.bytes[16..24], &[0, 0, 0, 60, 0, 0, 0, 30]);
        assert!(png("no picture", 1.0, |_| ()).is_err());
    }
}
