//! Which voxels belong to a set, at one bit each?
//!
//! A [`BitGrid`] keeps 64 voxels, a brick of 4 x 4 x 4, in a word, so that neighbours in all three
//! directions share a cache line and most work is done on 64 voxels at a time. Bricks are ordered x fastest, then y, then
//! z. Invariant: bits beyond the size are zero. Whatever lies outside the grid is not in the set.

use super::brick::{self, EDGE};
use crate::space::VoxelIndex;
use glam::IVec3;
use rayon::prelude::*;

/// A set of voxels of a regular grid, one bit each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BitGrid {
    size: [usize; 3],
    bricks: [usize; 3],
    words: Vec<u64>,
}

impl BitGrid {
    /// The empty set on a grid of `size` voxels along x, y and z.
    pub fn new(size: [usize; 3]) -> Self {
        let bricks = size.map(|voxels| voxels.div_ceil(EDGE));
        Self { size, bricks, words: vec![0; bricks.iter().product()] }
    }

    /// The memory a grid of that size takes, bytes; saturates where no machine could hold it.
    pub fn memory_bytes(size: [usize; 3]) -> usize {
        size.iter().fold(size_of::<u64>(), |bytes, voxels| bytes.saturating_mul(voxels.div_ceil(EDGE)))
    }

    /// The voxels whose byte is not zero. `bytes` is a C-contiguous array indexed `[z][y][x]`, x fastest; what is missing
    /// at its end counts as zero. Parallel; about a millisecond for three million voxels.
    pub fn from_bytes(size: [usize; 3], bytes: &[u8]) -> Self {
        let mut grid = Self::new(size);
        let [width, height, _] = size;
        let [across, rows, _] = grid.bricks;
        if grid.words.is_empty() {
            return grid;
        }
        grid.words.par_chunks_mut(across * rows).zip(bytes.par_chunks(width * height * EDGE)).for_each(
            |(words, slab)| {
                for (z, plane) in slab.chunks(width * height).enumerate() {
                    for (y, row) in plane.chunks(width).enumerate() {
                        let words = &mut words[y / EDGE * across..][..across];
                        let shift = brick::bit(0, y % EDGE, z);
                        let (fours, rest) = row.as_chunks::<EDGE>();
                        for (word, four) in words.iter_mut().zip(fours) {
                            *word |= nibble(*four) << shift;
                        }
                        for (x, byte) in rest.iter().enumerate() {
                            words[fours.len()] |= u64::from(*byte != 0) << (shift + x as u32);
                        }
                    }
                }
            },
        );
        grid
    }

    /// Voxels along x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Bricks along x, y and z: the size divided by four, rounded up.
    pub fn bricks(&self) -> [usize; 3] {
        self.bricks
    }

    /// The words of the bricks, x fastest, then y, then z.
    pub fn words(&self) -> &[u64] {
        &self.words
    }

    /// The words of the bricks for writing. The caller keeps bits beyond the size zero; see [`BitGrid::inside`].
    pub fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }

    /// Whether the voxel is in the set; outside the grid none is.
    #[inline]
    pub fn get(&self, voxel: VoxelIndex) -> bool {
        self.place(voxel).is_some_and(|(brick, bit)| self.words[brick] >> bit & 1 == 1)
    }

    /// Puts the voxel into the set or takes it out; outside the grid nothing happens.
    #[inline]
    pub fn set(&mut self, voxel: VoxelIndex, member: bool) {
        if let Some((brick, bit)) = self.place(voxel) {
            self.words[brick] = self.words[brick] & !(1 << bit) | u64::from(member) << bit;
        }
    }

    /// The brick of a voxel (index into [`BitGrid::words`]) and its bit there; `None` outside the grid.
    #[inline]
    pub fn place(&self, VoxelIndex(at): VoxelIndex) -> Option<(usize, u32)> {
        let [x, y, z] = at.to_array().map(|along| along as usize);
        let inside = x < self.size[0] && y < self.size[1] && z < self.size[2];
        inside.then(|| {
            let brick = x / EDGE + self.bricks[0] * (y / EDGE + self.bricks[1] * (z / EDGE));
            (brick, brick::bit(x % EDGE, y % EDGE, z % EDGE))
        })
    }

    /// The voxel of a bit of a brick, the inverse of [`BitGrid::place`].
    #[inline]
    pub fn voxel(&self, brick: usize, bit: u32) -> VoxelIndex {
        let [bx, by, bz] = self.brick_at(brick);
        let first = IVec3::new(bx as i32, by as i32, bz as i32) * EDGE as i32;
        VoxelIndex(first + IVec3::new(bit as i32 & 3, bit as i32 >> 2 & 3, bit as i32 >> 4))
    }

    /// Where a brick lies, in bricks along x, y and z.
    #[inline]
    pub fn brick_at(&self, brick: usize) -> [usize; 3] {
        let [across, rows, _] = self.bricks;
        [brick % across, brick / across % rows, brick / (across * rows)]
    }

    /// The bits of a brick that lie inside the grid.
    pub fn inside(&self, brick: usize) -> u64 {
        let at = self.brick_at(brick);
        brick::below([0, 1, 2].map(|axis| self.size[axis] - EDGE * at[axis]))
    }

    /// The word of a brick beside another, one step up or down an axis; 0 beyond the grid.
    #[inline]
    pub fn beside(&self, brick: usize, axis: usize, up: bool) -> u64 {
        let [across, rows, _] = self.bricks;
        let stride = [1, across, across * rows][axis];
        let along = self.brick_at(brick)[axis];
        match up {
            true if along + 1 < self.bricks[axis] => self.words[brick + stride],
            false if along > 0 => self.words[brick - stride],
            _ => 0,
        }
    }

    /// A brick of the set moved by one voxel: each bit is that of the voxel one step below (`up` false) or above along
    /// the axis. Bits that enter a last, partial brick from outside the grid are zero, those beyond the size undefined.
    #[inline]
    pub fn shifted(&self, brick: usize, axis: usize, up: bool) -> u64 {
        let (word, beside) = (self.words[brick], self.beside(brick, axis, up));
        match (axis, up) {
            (0, false) => brick::from_below::<0>(word, beside),
            (0, true) => brick::from_above::<0>(word, beside),
            (1, false) => brick::from_below::<1>(word, beside),
            (1, true) => brick::from_above::<1>(word, beside),
            (_, false) => brick::from_below::<2>(word, beside),
            (_, true) => brick::from_above::<2>(word, beside),
        }
    }

    /// Puts every voxel into the set, or none.
    pub fn fill(&mut self, member: bool) {
        self.words.fill(0);
        if member {
            self.complement();
        }
    }

    /// How many voxels the set has.
    pub fn count(&self) -> usize {
        self.words.par_iter().with_min_len(4096).map(|word| word.count_ones() as usize).sum()
    }

    /// Whether the set has no voxel.
    pub fn is_empty(&self) -> bool {
        self.words.iter().all(|word| *word == 0)
    }

    /// The voxels of the set, brick by brick, in the order of the bits.
    pub fn iter(&self) -> impl Iterator<Item = VoxelIndex> + '_ {
        let bricks = self.words.iter().enumerate().filter(|(_, word)| **word != 0);
        bricks.flat_map(move |(brick, word)| brick::ones(*word).map(move |bit| self.voxel(brick, bit)))
    }

    /// Turns the set into the voxels of the grid that were not in it.
    pub fn complement(&mut self) {
        let [across, rows, planes] = self.bricks;
        if self.words.is_empty() {
            return;
        }
        let past = self.size;
        self.words.par_chunks_mut(across * rows).enumerate().for_each(|(z, plane)| {
            for (y, row) in plane.chunks_mut(across).enumerate() {
                row.iter_mut().for_each(|word| *word = !*word);
                let partial = y + 1 == rows || z + 1 == planes;
                let from = if partial { 0 } else { across - 1 };
                for (x, word) in row.iter_mut().enumerate().skip(from) {
                    *word &= brick::below([past[0] - EDGE * x, past[1] - EDGE * y, past[2] - EDGE * z]);
                }
            }
        });
    }

    /// Keeps the voxels that `other`, of the same size, holds too.
    pub fn and(&mut self, other: &Self) {
        self.combine(other, |a, b| a & b);
    }

    /// Adds the voxels of `other`, of the same size.
    pub fn or(&mut self, other: &Self) {
        self.combine(other, |a, b| a | b);
    }

    /// Takes out the voxels of `other`, of the same size.
    pub fn and_not(&mut self, other: &Self) {
        self.combine(other, |a, b| a & !b);
    }

    fn combine(&mut self, other: &Self, join: impl Fn(u64, u64) -> u64 + Sync) {
        debug_assert_eq!(self.size, other.size, "sets of different grids");
        let pairs = self.words.par_iter_mut().with_min_len(4096).zip(&other.words);
        pairs.for_each(|(word, other)| *word = join(*word, *other));
    }
}

/// One bit for each byte that is not zero, the first byte lowest.
#[inline(always)]
fn nibble(bytes: [u8; 4]) -> u64 {
    let word = u32::from_le_bytes(bytes);
    let set = (((word & 0x7f7f_7f7f) + 0x7f7f_7f7f) | word) & 0x8080_8080;
    u64::from((set >> 7).wrapping_mul(0x0102_0408) >> 24 & 0xf)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes_of(size: [usize; 3], seed: u64) -> Vec<u8> {
        let mut state = seed | 1;
        let random = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            if state >> 60 < 8 { 0 } else { (state >> 32) as u8 }
        };
        std::iter::repeat_with(random).take(size.iter().product()).collect()
    }

    #[test]
    fn bytes_become_the_same_voxels() {
        for size in [[1, 1, 1], [5, 4, 9], [8, 8, 8], [13, 6, 7], [4, 17, 3]] {
            let bytes = bytes_of(size, 7 + size[0] as u64);
            let mut grid = BitGrid::from_bytes(size, &bytes);
            let want = bytes.iter().filter(|byte| **byte != 0).count();
            assert_eq!(grid.count(), want);
            let mut seen = 0;
            for voxel in grid.iter() {
                let [x, y, z] = voxel.0.to_array().map(|along| along as usize);
                assert_ne!(bytes[x + size[0] * (y + size[1] * z)], 0);
                seen += 1;
            }
            assert_eq!(seen, want);
            grid.complement();
            assert_eq!(grid.count(), bytes.len() - want);
            grid.fill(true);
            assert_eq!(grid.count(), bytes.len());
        }
    }

    #[test]
    fn outside_is_empty_and_cannot_be_set() {
        let mut grid = BitGrid::new([5, 5, 5]);
        grid.set(VoxelIndex::new(5, 0, 0), true);
        grid.set(VoxelIndex::new(-1, 0, 0), true);
        assert!(grid.is_empty());
        grid.set(VoxelIndex::new(4, 4, 4), true);
        assert!(grid.get(VoxelIndex::new(4, 4, 4)));
        assert!(!grid.get(VoxelIndex::new(4, 4, 8)));
        grid.set(VoxelIndex::new(4, 4, 4), false);
        assert!(grid.is_empty());
    }

    #[test]
    fn shifted_bricks_hold_the_neighbours() {
        let size = [9, 6, 10];
        let grid = BitGrid::from_bytes(size, &bytes_of(size, 3));
        for brick in 0..grid.words().len() {
            for (axis, up) in [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)] {
                let shifted = grid.shifted(brick, axis, up);
                for bit in brick::ones(grid.inside(brick)) {
                    let mut at = grid.voxel(brick, bit).0;
                    at[axis] += if up { 1 } else { -1 };
                    assert_eq!(shifted >> bit & 1 == 1, grid.get(VoxelIndex(at)), "{at}");
                }
            }
        }
    }

    #[test]
    fn sets_combine() {
        let size = [7, 7, 7];
        let (a, b) = (BitGrid::from_bytes(size, &bytes_of(size, 5)), BitGrid::from_bytes(size, &bytes_of(size, 11)));
        let (mut both, mut either, mut only) = (a.clone(), a.clone(), a.clone());
        both.and(&b);
        either.or(&b);
        only.and_not(&b);
        assert_eq!(both.count() + either.count(), a.count() + b.count());
        assert_eq!(only.count() + both.count(), a.count());
    }

    #[test]
    fn memory_is_known_before_it_is_taken() {
        assert_eq!(BitGrid::memory_bytes([9, 4, 1]), 24);
        assert_eq!(BitGrid::memory_bytes([usize::MAX, 100, 100]), usize::MAX);
    }
}
