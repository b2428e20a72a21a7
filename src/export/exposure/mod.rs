//! An exposure map as files: arrays, pictures with all their range, the suns as a table, what it adds up to.
//!
//! In arrays row 0 lies on the horizon; in pictures the zenith is at the top. Columns run clockwise from true north.

#[cfg(feature = "cli")]
mod frame;
#[cfg(feature = "cli")]
pub mod picture;

use crate::sky::map::ExposureMap;
use image::codecs::hdr::HdrEncoder;
use image::codecs::openexr::OpenExrEncoder;
use image::{ExtendedColorType, ImageEncoder, Rgb};
use ndarray::ArrayView2;
use ndarray_npy::WriteNpyExt;
use std::io::{self, Cursor, Write};

/// Which part of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The sky without the sun.
    Diffuse,
    /// The sun's beams.
    Direct,
}

impl Part {
    /// The energies of this part, kWh/m2 a texel.
    pub fn energies(self, map: &ExposureMap) -> &[f32] {
        match self {
            Self::Diffuse => &map.diffuse_kwh_m2,
            Self::Direct => &map.direct_kwh_m2,
        }
    }
}

/// Writes a part as a NumPy array `[row, column]` of 32-bit floats, kWh/m2 a texel.
///
/// # Errors
/// What the writer says.
pub fn write_npy(out: &mut dyn Write, map: &ExposureMap, part: Part) -> io::Result<()> {
    let [columns, rows] = map.size;
    let energies = ArrayView2::from_shape((rows, columns), part.energies(map)).map_err(io::Error::other)?;
    energies.write_npy(out).map_err(io::Error::other)
}

/// Writes an OpenEXR picture, kWh/m2/sr (a texel's energy over its solid angle): red the beams, green the sky, blue 0.
///
/// # Errors
/// What the writer says.
pub fn write_exr(out: &mut dyn Write, map: &ExposureMap) -> io::Result<()> {
    let pixels = from_the_zenith(map, |direct, diffuse| [direct, diffuse, 0.0]);
    let bytes: Vec<u8> = pixels.into_iter().flatten().flat_map(f32::to_ne_bytes).collect();
    let [columns, rows] = map.size.map(|texels| texels as u32);
    // The encoder goes back in what it has written.
    let mut file = Cursor::new(Vec::new());
    OpenExrEncoder::new(&mut file)
        .write_image(&bytes, columns, rows, ExtendedColorType::Rgb32F)
        .map_err(io::Error::other)?;
    out.write_all(file.get_ref())
}

/// Writes a Radiance HDR picture of sky and beams together, kWh/m2/sr, grey; steps of 0.4% as that format has them.
///
/// # Errors
/// What the writer says.
pub fn write_hdr(out: &mut dyn Write, map: &ExposureMap) -> io::Result<()> {
    let pixels = from_the_zenith(map, |direct, diffuse| Rgb([direct + diffuse; 3]));
    HdrEncoder::new(out).encode(&pixels, map.size[0], map.size[1]).map_err(io::Error::other)
}

/// Pixels of beams and sky, kWh/m2/sr, the zenith first.
fn from_the_zenith<P>(map: &ExposureMap, pixel: impl Fn(f32, f32) -> P) -> Vec<P> {
    let columns = map.size[0];
    let rows = (0..map.size[1]).rev();
    let texels = rows.flat_map(|row| {
        let solid_angle_sr = map.solid_angle_sr(row) as f32;
        (0..columns).map(move |column| (row * columns + column, solid_angle_sr))
    });
    texels
        .map(|(texel, solid_angle_sr)| {
            pixel(map.direct_kwh_m2[texel] / solid_angle_sr, map.diffuse_kwh_m2[texel] / solid_angle_sr)
        })
        .collect()
}

/// Writes the suns that have a beam as CSV: local standard time, degrees clockwise from true north and above the horizon,
/// kWh/m2 on a plane that faces the sun.
///
/// # Errors
/// What the writer says.
pub fn write_suns_csv(out: &mut dyn Write, map: &ExposureMap) -> io::Result<()> {
    writeln!(out, "time,azimuth_deg,elevation_deg,beam_kwh_m2")?;
    for sun in &map.suns {
        let [azimuth, elevation] = [sun.sun.azimuth_rad, sun.sun.elevation_rad].map(f64::to_degrees);
        let clock = sun.time.strftime("%Y-%m-%dT%H:%M:%S");
        writeln!(out, "{clock},{azimuth:.4},{elevation:.4},{:.6}", sun.energy_kwh_m2)?;
    }
    Ok(())
}
