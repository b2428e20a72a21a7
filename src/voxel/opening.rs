//! How wide is the void at each voxel?
//!
//! The opening of a void voxel is the radius of the largest chessboard ball inside the void that covers the voxel (not:
//! that is centred on it, which is the [distance](super::chessboard)). A voxel in the corner of a hall has distance 1 and
//! the hall's opening. Balls are drawn from the largest down, all of one radius at a time, by dilating their centres along
//! one axis after another; steps grow threefold, so a radius of 40 takes four sweeps an axis.

use super::bits::BitGrid;
use super::brick::{EDGE, layers};
use super::chessboard::{Centres, Chessboard, reach_in_bricks};
use super::levels::{Levels, write};
use crate::job::{Cancel, Cancelled};
use rayon::prelude::*;
use std::ops::Range;

/// For each void voxel its opening, 1 and up; 0 in matter. At least the distance, everywhere.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn opening(void: &BitGrid, board: &Chessboard, cancel: &Cancel) -> Result<Levels, Cancelled> {
    let mut opening = Levels::new(void, board.largest());
    let (slices, bricks) = (opening.slices(), void.bricks());
    let plane = bricks[0] * bricks[1];
    let mut uncovered = void.words().to_vec();
    let (mut balls, mut scratch) = (vec![0; uncovered.len()], vec![0; uncovered.len()]);
    for centres in board.centres.iter().rev() {
        cancel.check()?;
        let within = reached(centres, bricks);
        for (brick, bits) in &centres.bricks {
            balls[*brick as usize] = *bits;
        }
        for axis in 0..3 {
            let mut reach = 0;
            let far = usize::from(centres.distance - 1);
            while reach < far {
                let step = (2 * reach + 1).min(far - reach);
                spread(&mut scratch, &balls, bricks, &within, axis, step);
                std::mem::swap(&mut scratch, &mut balls);
                reach += step;
            }
        }

        // Balls stay inside the void; voxels that no larger ball covered are theirs. The buffers are left empty.
        let numbers = opening.words_mut().par_chunks_mut(plane * slices).zip(uncovered.par_chunks_mut(plane));
        let buffers = balls.par_chunks_mut(plane).zip(scratch.par_chunks_mut(plane));
        numbers.zip(buffers).skip(within[2].start).take(within[2].len()).for_each(
            |((numbers, uncovered), (balls, scratch))| {
                for y in within[1].clone() {
                    let row = bricks[0] * y + within[0].start..bricks[0] * y + within[0].end;
                    for brick in row.clone() {
                        let fresh = balls[brick] & uncovered[brick];
                        if fresh != 0 {
                            write(&mut numbers[brick * slices..][..slices], fresh, centres.distance);
                            uncovered[brick] &= !fresh;
                        }
                    }
                    balls[row.clone()].fill(0);
                    scratch[row].fill(0);
                }
            },
        );
    }
    Ok(opening)
}

/// The bricks along each axis that balls around these centres can touch.
fn reached(centres: &Centres, bricks: [usize; 3]) -> [Range<usize>; 3] {
    let [across, rows, _] = bricks;
    let (mut low, mut high) = (bricks, [0; 3]);
    for (brick, _) in &centres.bricks {
        let brick = *brick as usize;
        for (axis, along) in [brick % across, brick / across % rows, brick / (across * rows)].into_iter().enumerate() {
            low[axis] = low[axis].min(along);
            high[axis] = high[axis].max(along + 1);
        }
    }
    let reach = reach_in_bricks(centres.distance);
    [0, 1, 2].map(|axis| low[axis].saturating_sub(reach)..(high[axis] + reach).min(bricks[axis]))
}

/// Adds to each voxel the ones `step` voxels below and above it along the axis, inside a box of bricks.
fn spread(out: &mut [u64], words: &[u64], bricks: [usize; 3], within: &[Range<usize>; 3], axis: usize, step: usize) {
    let [across, rows, planes] = bricks;
    let (far, part) = (step / EDGE, step % EDGE);
    let shift = part as u32 * [1, 4, 16][axis];
    // The bits that enter from one brick further on come with the rest of a full brick's width; none do where the step
    // is whole bricks, and then the shift does not matter.
    let rest = ([4, 16, 64][axis] - shift).min(63);
    let (up, down) = (layers(axis, part, EDGE), layers(axis, 0, EDGE - part));
    let nothing = vec![0; across];
    let row_at = |y: Option<usize>, z: Option<usize>| match (y, z) {
        (Some(y), Some(z)) if y < rows && z < planes => &words[across * (y + rows * z)..][..across],
        _ => &nothing[..],
    };
    let columns = within[0].clone();
    let planes_out = out.par_chunks_mut(across * rows).enumerate().skip(within[2].start).take(within[2].len());
    planes_out.for_each(|(z, plane)| {
        let mut padded = vec![0; if axis == 0 { across + 2 * (far + 1) } else { 0 }];
        for y in within[1].clone() {
            let here = row_at(Some(y), Some(z));
            let sides = match axis {
                0 => {
                    padded[far + 1..][..across].copy_from_slice(here);
                    [&padded[1..], &padded[..], &padded[2 * far + 1..], &padded[2 * far + 2..]]
                }
                1 => [
                    row_at(y.checked_sub(far), Some(z)),
                    row_at(y.checked_sub(far + 1), Some(z)),
                    row_at(Some(y + far), Some(z)),
                    row_at(Some(y + far + 1), Some(z)),
                ],
                _ => [
                    row_at(Some(y), z.checked_sub(far)),
                    row_at(Some(y), z.checked_sub(far + 1)),
                    row_at(Some(y), Some(z + far)),
                    row_at(Some(y), Some(z + far + 1)),
                ],
            };
            let [below, below_next, above, above_next] = sides.map(|row| &row[..across][columns.clone()]);
            let out = &mut plane[across * y..][columns.clone()];
            for (x, (out, word)) in out.iter_mut().zip(&here[columns.clone()]).enumerate() {
                let from_below = below[x] << shift & up | below_next[x] >> rest & !up;
                let from_above = above[x] >> shift & down | above_next[x] << rest & !down;
                *out = word | from_below | from_above;
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

    fn check(size: [usize; 3], void: &BitGrid) -> Result<(), TestCaseError> {
        let board = Chessboard::new(void, &Cancel::new()).unwrap();
        let opening = opening(void, &board, &Cancel::new()).unwrap();
        let mut want = vec![0; size.iter().product()];
        let index = |at: IVec3| at.x as usize + size[0] * (at.y as usize + size[1] * at.z as usize);
        for voxel in void.iter() {
            let radius = board.distance.at(voxel);
            let edge = 2 * i32::from(radius) - 1;
            for i in 0..edge.pow(3) {
                let step = IVec3::new(i % edge, i / edge % edge, i / edge / edge) - edge / 2;
                let covered = &mut want[index(voxel.0 + step)];
                *covered = radius.max(*covered);
            }
        }
        for (i, want) in want.iter().enumerate() {
            let (x, y, z) = (i % size[0], i / size[0] % size[1], i / size[0] / size[1]);
            prop_assert_eq!(opening.at(VoxelIndex::new(x as i32, y as i32, z as i32)), *want);
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn it_equals_brute_force(
            size in prop::array::uniform3(1_usize..24),
            share in 0.0..0.02,
            seed in any::<u64>(),
        ) {
            let mut state = seed | 1;
            let bytes: Vec<u8> = (0..size.iter().product())
                .map(|_| {
                    state ^= state << 13;
                    state ^= state >> 7;
                    state ^= state << 17;
                    u8::from((state >> 11) as f64 / (1_u64 << 53) as f64 >= share)
                })
                .collect();
            check(size, &BitGrid::from_bytes(size, &bytes))?;
        }
    }

    #[test]
    fn a_hall_is_wide_to_its_corners() {
        for edge in [1, 2, 7, 31, 40] {
            let mut void = BitGrid::new([edge; 3]);
            void.fill(true);
            check([edge; 3], &void).unwrap();
        }
    }
}
