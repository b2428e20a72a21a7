//! Which small whole number does each voxel carry?
//!
//! [`Levels`] keep one number a voxel as bit slices: for each brick one word of lowest bits, one of next bits and so on,
//! side by side. A distance up to 63 takes six bits a voxel, and 64 voxels are written at a time.

use super::bits::BitGrid;
use crate::space::VoxelIndex;
use glam::IVec3;

/// A whole number for each voxel of a grid, 0 to [`Levels::limit`]; 0 outside the grid.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Levels {
    slices: usize,
    size: [usize; 3],
    bricks: [usize; 3],
    words: Vec<u64>,
}

impl Levels {
    /// Zero everywhere on the grid of `like`, with room for numbers up to at least `largest`.
    pub fn new(like: &BitGrid, largest: u16) -> Self {
        let slices = (u16::BITS - largest.leading_zeros()).max(1) as usize;
        Self { slices, size: like.size(), bricks: like.bricks(), words: vec![0; slices * like.words().len()] }
    }

    /// The largest number that fits.
    pub fn limit(&self) -> u16 {
        ((1_u32 << self.slices) - 1) as u16
    }

    /// Voxels along x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Words a brick, its lowest bits first: the layout of [`Levels::words_mut`].
    pub fn slices(&self) -> usize {
        self.slices
    }

    /// The words of all bricks, [`Levels::slices`] each, in the order of a [`BitGrid`]'s.
    pub fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }

    /// The number of a voxel; 0 outside the grid.
    #[inline]
    pub fn at(&self, VoxelIndex(at): VoxelIndex) -> u16 {
        let [x, y, z] = at.to_array().map(|along| along as usize);
        if x >= self.size[0] || y >= self.size[1] || z >= self.size[2] {
            return 0;
        }
        let brick = x / 4 + self.bricks[0] * (y / 4 + self.bricks[1] * (z / 4));
        let bit = super::brick::bit(x % 4, y % 4, z % 4);
        let slices = &self.words[brick * self.slices..][..self.slices];
        slices.iter().enumerate().fold(0, |level, (slice, word)| level | ((word >> bit & 1) as u16) << slice)
    }

    /// The largest number among the eight voxels that share a lattice point (their lowest one has the point's numbers
    /// less one).
    pub fn at_corner(&self, corner: IVec3) -> u16 {
        let around = (0..8).map(|i| corner - IVec3::new(i & 1, i >> 1 & 1, i >> 2));
        around.map(|voxel| self.at(VoxelIndex(voxel))).max().unwrap_or(0)
    }

    /// The largest number among the four voxels around the lattice edge that leaves `corner` upwards along an axis.
    pub fn at_edge(&self, corner: IVec3, axis: usize) -> u16 {
        let (u, v) = (IVec3::AXES[(axis + 1) % 3], IVec3::AXES[(axis + 2) % 3]);
        let around = [corner, corner - u, corner - v, corner - u - v];
        around.into_iter().map(|voxel| self.at(VoxelIndex(voxel))).max().unwrap_or(0)
    }
}

/// Writes a number to the voxels of a mask that carry 0 so far; `slices` are the words of their brick.
#[inline(always)]
pub fn write(slices: &mut [u64], mask: u64, level: u16) {
    for (slice, word) in slices.iter_mut().enumerate() {
        if level >> slice & 1 == 1 {
            *word |= mask;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back() {
        let grid = BitGrid::new([6, 5, 4]);
        let mut levels = Levels::new(&grid, 9);
        assert_eq!(levels.limit(), 15);
        let (brick, bit) = grid.place(VoxelIndex::new(5, 4, 3)).unwrap();
        let slices = levels.slices();
        write(&mut levels.words_mut()[brick * slices..][..slices], 1 << bit, 9);
        assert_eq!(levels.at(VoxelIndex::new(5, 4, 3)), 9);
        assert_eq!(levels.at(VoxelIndex::new(5, 3, 3)), 0);
        assert_eq!(levels.at(VoxelIndex::new(6, 4, 3)), 0);
        assert_eq!(levels.at_corner(IVec3::new(6, 5, 4)), 9);
        assert_eq!(levels.at_corner(IVec3::new(5, 4, 4)), 9);
        assert_eq!(levels.at_corner(IVec3::new(4, 4, 4)), 0);
        assert_eq!(levels.at_edge(IVec3::new(5, 5, 4), 0), 9);
        assert_eq!(levels.at_edge(IVec3::new(6, 5, 4), 0), 0);
    }
}
