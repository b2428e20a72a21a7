//! The SVG as a PNG, by resvg with the fonts of the system.

use resvg::{tiny_skia, usvg};
use std::io;

/// Pixels a unit of the SVG.
const SCALE: f32 = 1.5;

/// A picture as it is written to a file.
pub struct Picture {
    /// The PNG.
    pub bytes: Vec<u8>,
    /// Whether the system had a font to write with; without one the picture has no text.
    pub has_text: bool,
}

/// Draws an SVG, given as text, on white.
///
/// # Errors
/// What resvg says to text that is no SVG, or to a size that cannot be drawn.
pub fn png(svg: &str) -> io::Result<Picture> {
    let mut options = usvg::Options::default();
    options.fontdb_mut().load_system_fonts();
    let has_text = !options.fontdb.is_empty();
    let tree = usvg::Tree::from_str(svg, &options).map_err(io::Error::other)?;
    let size = tree.size();
    let [width, height] = [size.width(), size.height()].map(|side| (side * SCALE).ceil() as u32);
    let too_large = || io::Error::other(format!("a picture of {width} x {height} pixels cannot be drawn"));
    let mut sheet = tiny_skia::Pixmap::new(width, height).ok_or_else(too_large)?;
    sheet.fill(tiny_skia::Color::WHITE);
    resvg::render(&tree, tiny_skia::Transform::from_scale(SCALE, SCALE), &mut sheet.as_mut());
    let bytes = sheet.encode_png().map_err(io::Error::other)?;
    Ok(Picture { bytes, has_text })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_svg_becomes_a_png_of_its_size() {
        let svg =
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20"><rect width="9" height="9"/></svg>"##;
        let picture = png(svg).unwrap();
        assert_eq!(&picture.bytes[1..4], b"PNG");
        assert_eq!(&picture.bytes[16..24], &[0, 0, 0, 60, 0, 0, 0, 30]);
        assert!(png("no picture").is_err());
    }
}
