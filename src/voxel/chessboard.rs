//! How far is each void voxel from matter, counted in king's moves?
//!
//! The distance of a void voxel is the number of 3 x 3 x 3 erosions it takes to remove it: 1 beside matter. It equals the
//! radius of the largest cube-shaped ball (edge `2 d - 1` voxels) around the voxel that stays in the void; outside the
//! grid all is matter. The voxels whose ball is inside no larger neighbour's ball, the centres of the distance, are kept
//! too: they span the [opening](super::opening) and tell the middles of rooms.
//!
//! Cost: four sweeps over the bits for each distance that occurs, on all threads.

use super::bits::BitGrid;
use super::brick::{EDGE, from_above, from_below};
use super::levels::{Levels, write};
use crate::job::{Cancel, Cancelled};
use rayon::prelude::*;

/// The chessboard distance of a void, and its centres.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chessboard {
    /// For each void voxel its distance from matter, 1 and up; 0 in matter.
    pub distance: Levels,
    /// For each distance that has centres, the least first, their voxels.
    pub centres: Vec<Centres>,
}

/// The voxels at one distance without a 26-neighbour at a larger one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Centres {
    /// The distance of all of them.
    pub distance: u16,
    /// The bricks that hold any, in ascending order, with their bits there.
    pub bricks: Vec<(u32, u64)>,
}

impl Chessboard {
    /// Measures a void.
    ///
    /// # Errors
    /// [`Cancelled`] when `cancel` was raised.
    pub fn new(void: &BitGrid, cancel: &Cancel) -> Result<Self, Cancelled> {
        let narrowest = void.size().into_iter().min().unwrap_or(0);
        let largest = u16::try_from(narrowest.div_ceil(2)).unwrap_or(u16::MAX);
        let mut distance = Levels::new(void, largest);
        let mut centres = Vec::new();
        let [across, rows, _] = void.bricks();
        let plane = across * rows;
        let slices = distance.slices();

        let mut set = void.words().to_vec();
        let mut flat = vec![0; set.len()];
        let mut inner = vec![0; set.len()];
        let mut cover = vec![0; set.len()];
        for level in 1..=largest {
            if set.iter().all(|word| *word == 0) {
                break;
            }
            cancel.check()?;

            // The next level: the erosion, in each plane of bricks first, then across planes; and at once the first half
            // of its dilation.
            flat.par_chunks_mut(plane).zip(set.par_chunks(plane)).for_each(|(flat, set)| {
                sweep_plane(flat, set, across, |a, b| a & b);
            });
            inner.par_chunks_mut(plane).zip(cover.par_chunks_mut(plane)).enumerate().for_each(|(z, (inner, cover))| {
                sweep_across(inner, &flat, across, z, |a, b| a & b);
                sweep_plane(cover, inner, across, |a, b| a | b);
            });

            // What the erosion took has this distance; where no next level is near, it is a centre.
            let found: Vec<Vec<(u32, u64)>> = distance
                .words_mut()
                .par_chunks_mut(plane * slices)
                .zip(flat.par_chunks_mut(plane))
                .enumerate()
                .map(|(z, (words, dilated))| {
                    sweep_across(dilated, &cover, across, z, |a, b| a | b);
                    let first = z * plane;
                    let mut found = Vec::new();
                    for (brick, (slices, dilated)) in words.chunks_exact_mut(slices).zip(dilated.iter()).enumerate() {
                        let here = set[first + brick];
                        if here == 0 {
                            continue;
                        }
                        write(slices, here & !inner[first + brick], level);
                        let lonely = here & !dilated;
                        if lonely != 0 {
                            found.push(((first + brick) as u32, lonely));
                        }
                    }
                    found
                })
                .collect();
            let bricks = found.concat();
            if !bricks.is_empty() {
                centres.push(Centres { distance: level, bricks });
            }
            std::mem::swap(&mut set, &mut inner);
        }
        Ok(Self { distance, centres })
    }

    /// The largest distance there is; 0 where there is no void.
    pub fn largest(&self) -> u16 {
        self.centres.last().map_or(0, |centres| centres.distance)
    }
}

/// Joins each voxel with its eight neighbours in a plane of bricks; beyond the plane is nothing. `out` is overwritten.
fn sweep_plane(out: &mut [u64], plane: &[u64], across: usize, join: impl Fn(u64, u64) -> u64 + Copy) {
    let nothing = vec![0; across];
    // One word of padding at either end, so that the loop over a row needs no special cases.
    let mut line = vec![0; across + 2];
    let rows = plane.len() / across;
    let row = |y: usize| if y < rows { &plane[y * across..][..across] } else { &nothing };
    for (y, out) in out.chunks_exact_mut(across).enumerate() {
        let (below, here, above) = (row(y.wrapping_sub(1)), row(y), row(y + 1));
        if [below, here, above].into_iter().all(is_empty) {
            out.fill(0);
            continue;
        }
        for ((line, word), (below, above)) in line[1..].iter_mut().zip(here).zip(below.iter().zip(above)) {
            let both = join(from_below::<1>(*word, *below), from_above::<1>(*word, *above));
            *line = join(*word, both);
        }
        let (low, middle, high) = (&line[..across], &line[1..][..across], &line[2..]);
        for ((out, word), (below, above)) in out.iter_mut().zip(middle).zip(low.iter().zip(high)) {
            *out = join(*word, join(from_below::<0>(*word, *below), from_above::<0>(*word, *above)));
        }
    }
}

/// Joins each voxel of plane `z` of bricks with those below and above it; beyond the grid is nothing. `out` is overwritten.
fn sweep_across(out: &mut [u64], words: &[u64], across: usize, z: usize, join: impl Fn(u64, u64) -> u64) {
    let plane = out.len();
    let nothing = vec![0; across];
    for (y, out) in out.chunks_exact_mut(across).enumerate() {
        let row = |z: usize| words.get(z.saturating_mul(plane).saturating_add(y * across)..).unwrap_or(&[]);
        let row = |z: usize| row(z).get(..across).unwrap_or(&nothing);
        let (below, here, above) = (row(z.wrapping_sub(1)), row(z), row(z + 1));
        if [below, here, above].into_iter().all(is_empty) {
            out.fill(0);
            continue;
        }
        for ((out, word), (below, above)) in out.iter_mut().zip(here).zip(below.iter().zip(above)) {
            *out = join(*word, join(from_below::<2>(*word, *below), from_above::<2>(*word, *above)));
        }
    }
}

/// Whether no voxel is set. Most rows are empty once small distances are done.
fn is_empty(row: &[u64]) -> bool {
    row.iter().fold(0, |any, word| any | word) == 0
}

/// Bricks along an axis that a ball of that distance can reach beyond its centre's brick.
pub(super) fn reach_in_bricks(distance: u16) -> usize {
    usize::from(distance.saturating_sub(1)).div_ceil(EDGE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::VoxelIndex;
    use glam::IVec3;
    use proptest::prelude::*;

    /// The voxels of some bricks as a set on a grid.
    fn as_set(like: &BitGrid, bricks: &[(u32, u64)]) -> BitGrid {
        let mut set = BitGrid::new(like.size());
        for (brick, bits) in bricks {
            set.words_mut()[*brick as usize] |= bits;
        }
        set
    }

    fn in_ball(radius: i32) -> impl Iterator<Item = IVec3> {
        let edge = 2 * radius - 1;
        (0..edge.pow(3)).map(move |i| IVec3::new(i % edge, i / edge % edge, i / edge / edge) - (radius - 1))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn distances_and_centres_equal_brute_force(
            size in prop::array::uniform3(1_usize..14),
            share in 0.0..0.12,
            numbers in prop::collection::vec(0.0..1.0, 14 * 14 * 14),
        ) {
            let bytes: Vec<u8> = numbers.iter().map(|number| u8::from(*number >= share)).collect();
            let void = BitGrid::from_bytes(size, &bytes[..size.iter().product()]);
            let board = Chessboard::new(&void, &Cancel::new()).unwrap();
            let mut whole = BitGrid::new(size);
            whole.fill(true);
            let fits = |at: IVec3, radius| in_ball(radius).all(|step| void.get(VoxelIndex(at + step)));
            let mut centres = Vec::new();
            for voxel in whole.iter() {
                let distance = (1..).take_while(|radius| fits(voxel.0, *radius)).count() as u16;
                prop_assert_eq!(board.distance.at(voxel), distance);
                let lonely = in_ball(2).all(|step| board.distance.at(VoxelIndex(voxel.0 + step)) <= distance);
                if distance > 0 && lonely {
                    centres.push((distance, voxel));
                }
            }
            centres.sort_by_key(|(distance, _)| *distance);
            let found: Vec<(u16, VoxelIndex)> = board
                .centres
                .iter()
                .flat_map(|level| as_set(&void, &level.bricks).iter().map(|v| (level.distance, v)).collect::<Vec<_>>())
                .collect();
            prop_assert_eq!(found, centres);
        }
    }

    #[test]
    fn a_raised_flag_stops_it() {
        let cancel = Cancel::new();
        cancel.cancel();
        let mut void = BitGrid::new([9, 9, 9]);
        void.fill(true);
        assert_eq!(Chessboard::new(&void, &cancel), Err(Cancelled));
    }
}
