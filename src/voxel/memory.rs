//! Will a grid fit into memory, and which one would?
//!
//! Everything the voxels and the skeleton take is computed from the size of the lattice before any of it is taken. What
//! grows with the surface is estimated from the mesh's area. The figures are upper estimates; they err on the large side
//! by up to half where the void is a small part of the box.

use super::bits::BitGrid;
use super::flood::Flood;
use super::surface::SurfaceVoxels;
use crate::space::Lattice;
use glam::Vec3;

/// Longest side of a grid, voxels. A squared distance across its diagonal still fits into 32 bits.
pub const MOST_VOXELS_ALONG: usize = 32_768;

/// Most voxels of a grid: voxels and surface voxels are numbered in 32 bits.
pub const MOST_VOXELS: usize = u32::MAX as usize;

/// Surface voxels for each square of a voxel's edge of mesh area. A wall along the axes touches one layer and a tilted one
/// up to three; edges touch more.
const SURFACE_VOXELS_A_SQUARE: f64 = 3.0;

/// What the skeleton takes for each voxel of the grid at most, bytes: eight bit-planes of cells, as many of border and
/// anchors (2), distance and opening (2 + 2), the squared Euclidean distance (4) and the nearest node (4).
const SKELETON_BYTES_A_VOXEL: f64 = 14.0;

/// Bytes that a run takes at its peak, besides the mesh and its BVH.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Memory {
    /// Grids of voxels, and the flood at work.
    pub voxels_bytes: f64,
    /// What is kept for each surface voxel.
    pub surface_bytes: f64,
    /// The skeleton of the void.
    pub skeleton_bytes: f64,
}

impl Memory {
    /// What voxels and skeleton take on this lattice for a mesh of that area (m2).
    pub fn of(lattice: &Lattice, mesh_area_m2: f64) -> Self {
        let voxels: f64 = lattice.size.iter().map(|&along| along as f64).product();
        let squares = mesh_area_m2 / f64::from(lattice.voxel_m).powi(2);
        Self {
            voxels_bytes: 2.0 * BitGrid::memory_bytes(lattice.size) as f64 + Flood::BYTES_A_VOXEL * voxels,
            surface_bytes: (SURFACE_VOXELS_A_SQUARE * squares).min(voxels) * SurfaceVoxels::BYTES_EACH as f64,
            skeleton_bytes: SKELETON_BYTES_A_VOXEL * voxels,
        }
    }

    /// All of it, bytes.
    pub fn total_bytes(&self) -> f64 {
        self.voxels_bytes + self.surface_bytes + self.skeleton_bytes
    }
}

/// Whether the grid can be numbered and its memory stays within `most_bytes`.
pub fn fits(lattice: &Lattice, mesh_area_m2: f64, most_bytes: u64) -> bool {
    let voxels: f64 = lattice.size.iter().map(|&along| along as f64).product();
    let numbered = voxels <= MOST_VOXELS as f64 && lattice.size.iter().all(|&along| along <= MOST_VOXELS_ALONG);
    numbered && Memory::of(lattice, mesh_area_m2).total_bytes() <= most_bytes as f64
}

/// So many bytes, in GB.
pub fn in_words(bytes: f64) -> String {
    let gigabytes = bytes / 1e9;
    if gigabytes < 1e6 { format!("{gigabytes:.1} GB") } else { format!("{gigabytes:.0e} GB") }
}

/// The smallest voxel (m) of two significant digits, above one that does not fit, with which the box from `low_m` to
/// `high_m` fits; infinite where none does.
pub fn smallest_voxel_m(low_m: Vec3, high_m: Vec3, mesh_area_m2: f64, most_bytes: u64, too_small_m: f32) -> f32 {
    let fits = |voxel_m: f32| fits(&Lattice::around(low_m, high_m, voxel_m), mesh_area_m2, most_bytes);

    // Double until it fits, then halve the interval far beyond two digits.
    let (mut low, mut high) = (too_small_m, too_small_m);
    while !fits(high) {
        if !high.is_finite() || high > 1e30 {
            return f32::INFINITY;
        }
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if fits(middle) { high = middle } else { low = middle }
    }

    // Round up, and further where the grid's rounding to whole voxels is in the way.
    let digit = 10_f64.powf(f64::from(high).log10().floor() - 1.0);
    let first = (f64::from(high) / digit - 1e-6).ceil();
    let rounded = (0..100).map(|step| ((first + f64::from(step)) * digit) as f32);
    rounded.into_iter().find(|&voxel_m| fits(voxel_m)).unwrap_or(f32::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_voxel_named_fits_and_a_smaller_one_does_not() {
        let (low, high, area_m2) = (Vec3::ZERO, Vec3::new(31.0, 17.0, 4.3), 900.0);
        for most_bytes in [1_000_000, 50_000_000, 3_000_000_000] {
            let too_small_m = 0.001;
            assert!(!fits(&Lattice::around(low, high, too_small_m), area_m2, most_bytes));
            let voxel_m = smallest_voxel_m(low, high, area_m2, most_bytes, too_small_m);
            assert!(fits(&Lattice::around(low, high, voxel_m), area_m2, most_bytes), "{voxel_m}");
            assert!(!fits(&Lattice::around(low, high, 0.89 * voxel_m), area_m2, most_bytes), "{voxel_m}");
            let written = format!("{voxel_m}");
            let digits = written.trim_start_matches(['0', '.']).trim_end_matches('0').len();
            assert!(digits <= 3, "{written}");
        }
    }

    #[test]
    fn nothing_fits_into_nothing() {
        assert!(smallest_voxel_m(Vec3::ZERO, Vec3::ONE, 6.0, 10, 0.1).is_infinite());
    }

    #[test]
    fn numbers_are_bounded_too() {
        let long = Lattice { origin_m: Vec3::ZERO, voxel_m: 0.1, size: [40_000, 1, 1] };
        assert!(!fits(&long, 0.0, u64::MAX));
        let huge = Lattice { origin_m: Vec3::ZERO, voxel_m: 0.1, size: [usize::MAX; 3] };
        assert!(!fits(&huge, 0.0, u64::MAX));
    }
}
