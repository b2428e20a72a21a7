//! The voxels as a NumPy array, with a JSON file beside it that says what and where they are (an `.npy` has no room for it).

use crate::scene::Scene;
use crate::space::VoxelIndex;
use crate::voxel::Voxels;
use ndarray::Array3;
use ndarray_npy::WriteNpyExt;
use serde_json::json;
use std::io::{self, Write};

/// What a byte of the array means: matter, void that light or sensors reach, and what is neither.
const SOLID: u8 = 1;
const VOID: u8 = 2;
const NEITHER: u8 = 0;

/// Writes an array of bytes, indexed `[x, y, z]`.
///
/// # Errors
/// What the writer says.
pub fn write_npy(out: &mut dyn Write, voxels: &Voxels) -> io::Result<()> {
    let [nx, ny, nz] = voxels.lattice.size;
    let kinds = Array3::from_shape_fn((nx, ny, nz), |(x, y, z)| {
        let voxel = VoxelIndex::new(x as i32, y as i32, z as i32);
        match (voxels.solid.get(voxel), voxels.void.get(voxel)) {
            (true, _) => SOLID,
            (false, true) => VOID,
            (false, false) => NEITHER,
        }
    });
    kinds.write_npy(out).map_err(io::Error::other)
}

/// Writes what the array means: values, axes, units, origin and voxel size.
///
/// # Errors
/// What the writer says.
pub fn write_legend(out: &mut dyn Write, scene: &Scene, voxels: &Voxels) -> io::Result<()> {
    let legend = json!({
        "array": "voxels.npy, bytes, indexed [x, y, z]",
        "values": { "0": "neither solid nor reached", "1": "solid", "2": "void" },
        "units": "m",
        "origin_m": scene.to_user_m(voxels.lattice.origin_m).to_array(),
        "voxel_m": voxels.lattice.voxel_m,
    });
    serde_json::to_writer_pretty(&mut *out, &legend)?;
    writeln!(out)
}
