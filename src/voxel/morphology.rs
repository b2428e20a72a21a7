//! Which voxels does a set reach in one step, and which stay when its edge is taken off?
//!
//! Dilation and erosion by the 6 or the 26 neighbours, 64 voxels at a time and in parallel over slabs of bricks. The
//! 26-neighbourhood is a box, so it is done one axis after another. Outside the grid nothing is in the set: erosion takes
//! voxels on the grid's boundary.

use super::bits::BitGrid;
use super::brick::{EDGE, below, from_above, from_below};
use rayon::prelude::*;

/// Which voxels count as neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Neighbours {
    /// Those that share a face.
    Six,
    /// Those that share a face, an edge or a corner.
    All,
}

/// The set and all neighbours of its voxels inside the grid.
pub fn dilate(set: &BitGrid, neighbours: Neighbours) -> BitGrid {
    let mut result = match neighbours {
        Neighbours::Six => sweep(set, |word, [xl, xh, yl, yh, zl, zh]| {
            word | from_below::<0>(word, xl)
                | from_above::<0>(word, xh)
                | from_below::<1>(word, yl)
                | from_above::<1>(word, yh)
                | from_below::<2>(word, zl)
                | from_above::<2>(word, zh)
        }),
        Neighbours::All => {
            let along_x = sweep(set, |w, [l, h, ..]| w | from_below::<0>(w, l) | from_above::<0>(w, h));
            let along_y = sweep(&along_x, |w, [_, _, l, h, ..]| w | from_below::<1>(w, l) | from_above::<1>(w, h));
            sweep(&along_y, |w, [_, _, _, _, l, h]| w | from_below::<2>(w, l) | from_above::<2>(w, h))
        }
    };
    clear_beyond(&mut result);
    result
}

/// The voxels of the set whose neighbours all belong to it; those on the grid's boundary have neighbours that do not.
pub fn erode(set: &BitGrid, neighbours: Neighbours) -> BitGrid {
    match neighbours {
        Neighbours::Six => sweep(set, |word, [xl, xh, yl, yh, zl, zh]| {
            word & from_below::<0>(word, xl)
                & from_above::<0>(word, xh)
                & from_below::<1>(word, yl)
                & from_above::<1>(word, yh)
                & from_below::<2>(word, zl)
                & from_above::<2>(word, zh)
        }),
        Neighbours::All => {
            let along_x = sweep(set, |w, [l, h, ..]| w & from_below::<0>(w, l) & from_above::<0>(w, h));
            let along_y = sweep(&along_x, |w, [_, _, l, h, ..]| w & from_below::<1>(w, l) & from_above::<1>(w, h));
            sweep(&along_y, |w, [_, _, _, _, l, h]| w & from_below::<2>(w, l) & from_above::<2>(w, h))
        }
    }
}

/// A grid whose every word is made of the word there and those below and above it along x, y and z.
fn sweep(set: &BitGrid, make: impl Fn(u64, [u64; 6]) -> u64 + Sync) -> BitGrid {
    let mut result = BitGrid::new(set.size());
    let [across, rows, planes] = set.bricks();
    if set.words().is_empty() {
        return result;
    }
    let nothing = vec![0; across];
    let row_of = |y: Option<usize>, z: Option<usize>| match (y, z) {
        (Some(y), Some(z)) if y < rows && z < planes => &set.words()[across * (y + rows * z)..][..across],
        _ => &nothing[..],
    };
    result.words_mut().par_chunks_mut(across * rows).enumerate().for_each(|(z, plane)| {
        for (y, row) in plane.chunks_mut(across).enumerate() {
            let here = row_of(Some(y), Some(z));
            let (y_low, y_high) = (row_of(y.checked_sub(1), Some(z)), row_of(Some(y + 1), Some(z)));
            let (z_low, z_high) = (row_of(Some(y), z.checked_sub(1)), row_of(Some(y), Some(z + 1)));
            let mut x_low = 0;
            for (x, word) in row.iter_mut().enumerate() {
                let x_high = here.get(x + 1).copied().unwrap_or(0);
                *word = make(here[x], [x_low, x_high, y_low[x], y_high[x], z_low[x], z_high[x]]);
                x_low = here[x];
            }
        }
    });
    result
}

/// Restores the invariant that no voxel beyond the size is set.
fn clear_beyond(grid: &mut BitGrid) {
    let (size, bricks) = (grid.size(), grid.bricks());
    if size.iter().all(|voxels| voxels % EDGE == 0) || grid.words().is_empty() {
        return;
    }
    let [across, rows, _] = bricks;
    grid.words_mut().par_chunks_mut(across * rows).enumerate().for_each(|(z, plane)| {
        for (brick, word) in plane.iter_mut().enumerate() {
            let (x, y) = (brick % across, brick / across);
            if x + 1 == across || y + 1 == rows || z + 1 == bricks[2] {
                *word &= below([size[0] - EDGE * x, size[1] - EDGE * y, size[2] - EDGE * z]);
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::VoxelIndex;
    use glam::IVec3;
    use proptest::prelude::*;

    fn reaches(step: IVec3, neighbours: Neighbours) -> bool {
        match neighbours {
            Neighbours::Six => step.abs().element_sum() <= 1,
            Neighbours::All => true,
        }
    }

    fn any_near(set: &BitGrid, at: IVec3, neighbours: Neighbours, member: bool) -> bool {
        (0..27)
            .map(|i| IVec3::new(i % 3, i / 3 % 3, i / 9) - 1)
            .any(|step| reaches(step, neighbours) && set.get(VoxelIndex(at + step)) == member)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn both_equal_a_look_at_every_neighbour(
            size in prop::array::uniform3(1_usize..11),
            bytes in prop::collection::vec(prop::bool::weighted(0.6), 1000),
        ) {
            let bytes: Vec<u8> = bytes.into_iter().map(u8::from).take(size.iter().product()).collect();
            let set = BitGrid::from_bytes(size, &bytes);
            for neighbours in [Neighbours::Six, Neighbours::All] {
                let (more, less) = (dilate(&set, neighbours), erode(&set, neighbours));
                let mut whole = BitGrid::new(size);
                whole.fill(true);
                for voxel in whole.iter() {
                    prop_assert_eq!(more.get(voxel), any_near(&set, voxel.0, neighbours, true));
                    prop_assert_eq!(less.get(voxel), !any_near(&set, voxel.0, neighbours, false));
                }
                let mut beyond = more.clone();
                beyond.and_not(&whole);
                prop_assert!(beyond.is_empty());
            }
        }
    }
}
