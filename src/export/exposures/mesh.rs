//! Exposure on a mesh as PLY, binary little-endian: colours at the vertices, and every value beside them, which MeshLab and
//! CloudCompare show as scalar fields (`quality` is what the colours show).

use super::{Span, has_value};
use crate::daylight::surface::{Corners, Patch};
use crate::daylight::{Exposure, Quantity};
use crate::export::scale::{INFERNO, colour};
use crate::scene::Scene;
use glam::Vec3;
use std::io::{self, Write};

/// Colour of what has no value.
pub(super) const NO_VALUE: [u8; 3] = [128, 128, 128];

/// What the colours of a mesh show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colours {
    /// Which value.
    pub quantity: Quantity,
    /// From the dark end to the bright one.
    pub span: Span,
}

impl Colours {
    /// The colour of an exposure; grey where there is no value.
    pub(super) fn of(&self, exposure: &Exposure) -> [u8; 3] {
        if has_value(exposure) { colour(&INFERNO, self.span.part(self.quantity.of(exposure))) } else { NO_VALUE }
    }
}

/// Writes patches, three vertices each, all three with the patch's values.
///
/// # Errors
/// What the writer says.
pub fn write_patches(
    out: &mut dyn Write,
    scene: &Scene,
    patches: &[Patch],
    exposures: &[Exposure],
    colours: Colours,
) -> io::Result<()> {
    let count = patches.len().min(exposures.len());
    head(out, 3 * count, count, colours)?;
    for (patch, exposure) in patches.iter().zip(exposures) {
        for corner_m in patch.corners_m {
            vertex(out, scene, corner_m, exposure, colours)?;
        }
    }
    (0..count as u32).try_for_each(|face| triangle(out, [3 * face, 3 * face + 1, 3 * face + 2]))
}

/// Writes a mesh by its vertices, one for each surface that meets there.
///
/// # Errors
/// What the writer says.
pub fn write_corners(
    out: &mut dyn Write,
    scene: &Scene,
    corners: &Corners,
    exposures: &[Exposure],
    colours: Colours,
) -> io::Result<()> {
    let count = corners.positions_m.len().min(exposures.len());
    head(out, count, corners.triangles.len(), colours)?;
    for (position_m, exposure) in corners.positions_m.iter().zip(exposures) {
        vertex(out, scene, *position_m, exposure, colours)?;
    }
    corners.triangles.iter().try_for_each(|corners| triangle(out, *corners))
}

fn head(out: &mut dyn Write, vertices: usize, faces: usize, colours: Colours) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    writeln!(out, "comment positions in m; exposure over the period in kWh/m2 on the side of the face's normal")?;
    writeln!(out, "comment svf is a share, sun_h are hours; not a number where there is no value (inside matter)")?;
    let Colours { quantity, span } = colours;
    writeln!(out, "comment colours and quality show {} from 0 to {}", quantity.with_unit(), span.top)?;
    writeln!(out, "element vertex {vertices}")?;
    ["x", "y", "z"].iter().try_for_each(|axis| writeln!(out, "property double {axis}"))?;
    ["red", "green", "blue"].iter().try_for_each(|channel| writeln!(out, "property uchar {channel}"))?;
    Quantity::ALL.iter().try_for_each(|quantity| writeln!(out, "property float {}", quantity.with_unit()))?;
    writeln!(out, "property float quality\nelement face {faces}")?;
    writeln!(out, "property list uchar int vertex_indices\nend_header")
}

fn vertex(out: &mut dyn Write, scene: &Scene, at_m: Vec3, exposure: &Exposure, colours: Colours) -> io::Result<()> {
    scene.to_user_m(at_m).to_array().iter().try_for_each(|metres| out.write_all(&metres.to_le_bytes()))?;
    out.write_all(&colours.of(exposure))?;
    let values = Quantity::ALL.into_iter().chain([colours.quantity]).map(|quantity| quantity.of(exposure));
    let value = |value: f64| if has_value(exposure) { value as f32 } else { f32::NAN };
    values.map(value).try_for_each(|value| out.write_all(&value.to_le_bytes()))
}

fn triangle(out: &mut dyn Write, corners: [u32; 3]) -> io::Result<()> {
    out.write_all(&[3])?;
    corners.iter().try_for_each(|corner| out.write_all(&corner.to_le_bytes()))
}
