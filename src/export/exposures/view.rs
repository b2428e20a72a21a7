//! What a camera sees as arrays and pictures of numbers: every value of every pixel, not a number where there is none.

use super::has_value;
use crate::daylight::{Exposure, Quantity};
use image::codecs::openexr::OpenExrEncoder;
use image::{ExtendedColorType, ImageEncoder};
use ndarray::Array3;
use ndarray_npy::WriteNpyExt;
use std::io::{self, Cursor, Write};

/// A picture's exposures: those of the pixels behind which there is something.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Pixels behind which there is something, by rows from the top.
    pub pixels: &'a [u32],
    /// Their exposures.
    pub exposures: &'a [Exposure],
}

impl View<'_> {
    /// The exposure of each pixel; `None` for the background.
    pub(super) fn by_pixel(&self) -> Vec<Option<&Exposure>> {
        let mut by_pixel = vec![None; self.size[0] * self.size[1]];
        for (&pixel, exposure) in self.pixels.iter().zip(self.exposures) {
            if let Some(place) = by_pixel.get_mut(pixel as usize) {
                *place = Some(exposure);
            }
        }
        by_pixel
    }

    /// A value of each pixel.
    fn values(&self, quantity: Quantity) -> Vec<f32> {
        let value = |exposure: &Exposure| if has_value(exposure) { quantity.of(exposure) as f32 } else { f32::NAN };
        self.by_pixel().into_iter().map(|exposure| exposure.map_or(f32::NAN, value)).collect()
    }
}

/// Writes a NumPy array `[row, column, value]` of 32-bit floats, row 0 at the top; the values are those of [`Quantity::ALL`] in
/// their order.
///
/// # Errors
/// What the writer says.
pub fn write_npy(out: &mut dyn Write, view: &View) -> io::Result<()> {
    let [columns, rows] = view.size;
    let values = Quantity::ALL.map(|quantity| view.values(quantity));
    let array = Array3::from_shape_fn((rows, columns, values.len()), |(row, column, value)| {
        values.get(value).and_then(|values| values.get(row * columns + column)).copied().unwrap_or(f32::NAN)
    });
    array.write_npy(out).map_err(io::Error::other)
}

/// Writes an OpenEXR picture, kWh/m2: red the sun, green the sky, blue what surfaces reflect.
///
/// # Errors
/// What the writer says.
pub fn write_exr(out: &mut dyn Write, view: &View) -> io::Result<()> {
    let channels = [Quantity::Beam, Quantity::Sky, Quantity::Reflected].map(|quantity| view.values(quantity));
    let pixels = view.size[0] * view.size[1];
    let mut bytes = Vec::with_capacity(12 * pixels);
    for pixel in 0..pixels {
        for channel in &channels {
            bytes.extend(channel.get(pixel).copied().unwrap_or(f32::NAN).to_ne_bytes());
        }
    }
    // The encoder goes back in what it has written.
    let mut file = Cursor::new(Vec::new());
    let [columns, rows] = view.size.map(|pixels| pixels as u32);
    OpenExrEncoder::new(&mut file)
        .write_image(&bytes, columns, rows, ExtendedColorType::Rgb32F)
        .map_err(io::Error::other)?;
    out.write_all(file.get_ref())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Status;
    use ndarray_npy::ReadNpyExt;

    #[test]
    fn arrays_keep_the_order_of_pixels_and_values() {
        let lit = Exposure { beam_kwh_m2: 3.0, svf: 0.5, ..Exposure::none(Status::Ok) };
        let exposures = [lit, Exposure::none(Status::InSolid)];
        let view = View { size: [3, 2], pixels: &[2, 4], exposures: &exposures };
        let mut bytes = Vec::new();
        write_npy(&mut bytes, &view).unwrap();
        let array = Array3::<f32>::read_npy(bytes.as_slice()).unwrap();
        assert_eq!(array.shape(), [2, 3, 6]);
        assert_eq!([array[[0, 2, 0]], array[[0, 2, 1]], array[[0, 2, 4]]], [3.0, 3.0, 0.5]);
        assert!(array[[1, 1, 0]].is_nan() && array[[0, 0, 0]].is_nan());
        let mut bytes = Vec::new();
        write_exr(&mut bytes, &view).unwrap();
        let picture = image::load_from_memory(&bytes).unwrap().to_rgb32f();
        assert_eq!(picture.get_pixel(2, 0).0, [3.0, 0.0, 0.0]);
    }
}
