//! Which voxels of a set hang together?
//!
//! Groups are taken out of a set one after another, flooding brick by brick: a brick is filled from where it was entered
//! by a few shifts of its word, and hands on what touches its sides. Time goes with the bricks of the set, not with the
//! grid.

use super::bits::BitGrid;
use super::brick::{self, from_above, from_below};
use super::morphology::Neighbours;
use crate::space::VoxelIndex;

/// Voxels that hang together: bricks in ascending order, each once, with the group's bits there.
pub type Group = Vec<(u32, u64)>;

/// Takes the next group out of a set, the one of the first voxel left; `None` once the set is empty. `from` is the brick
/// to look on from, and moves up: begin with 0.
pub fn take_next(left: &mut BitGrid, from: &mut usize, neighbours: Neighbours) -> Option<Group> {
    let brick = (*from..left.words().len()).find(|brick| left.words()[*brick] != 0)?;
    *from = brick;
    let seed = left.words()[brick];
    Some(take(left, [(brick, seed & seed.wrapping_neg())], neighbours))
}

/// Takes out of a set all that hangs together with some of its voxels, given as bits of bricks.
pub fn take(left: &mut BitGrid, seeds: impl IntoIterator<Item = (usize, u64)>, neighbours: Neighbours) -> Group {
    let mut group = Group::new();
    let mut fronts: Vec<(usize, u64)> = seeds.into_iter().collect();
    while let Some((brick, seed)) = fronts.pop() {
        let mask = left.words()[brick];
        let flooded = match neighbours {
            Neighbours::Six => brick::flood_six(seed, mask),
            Neighbours::All => brick::flood_all(seed, mask),
        };
        if flooded == 0 {
            continue;
        }
        left.words_mut()[brick] &= !flooded;
        group.push((brick as u32, flooded));
        for_each_beside(left.bricks(), brick, |beside, step| {
            if neighbours == Neighbours::Six && step.iter().filter(|step| **step != 0).count() > 1 {
                return;
            }
            let entered = enter(flooded, step, neighbours) & left.words()[beside];
            if entered != 0 {
                fronts.push((beside, entered));
            }
        });
    }
    merge(group)
}

/// Takes out of a set all that hangs together by shared faces with some of its voxels, and forgets it: faster than
/// [`take`] where that is most of the set.
pub fn remove(left: &mut BitGrid, seeds: Vec<(usize, u64)>) {
    let [across, rows, planes] = left.bricks();
    let strides = [1, across, across * rows];
    let mut fronts = seeds;
    while let Some((brick, seed)) = fronts.pop() {
        let mask = left.words()[brick];
        let flooded = brick::flood_six(seed, mask);
        if flooded == 0 {
            continue;
        }
        left.words_mut()[brick] = mask & !flooded;
        let at = left.brick_at(brick);
        let up = [from_below::<0>(0, flooded), from_below::<1>(0, flooded), from_below::<2>(0, flooded)];
        let down = [from_above::<0>(0, flooded), from_above::<1>(0, flooded), from_above::<2>(0, flooded)];
        for (axis, bricks) in [across, rows, planes].into_iter().enumerate() {
            if at[axis] > 0 && down[axis] & left.words()[brick - strides[axis]] != 0 {
                fronts.push((brick - strides[axis], down[axis]));
            }
            if at[axis] + 1 < bricks && up[axis] & left.words()[brick + strides[axis]] != 0 {
                fronts.push((brick + strides[axis], up[axis]));
            }
        }
    }
}

/// All voxels of other bricks, and of its own, that touch a group: the group itself is left out.
pub fn around(bricks: [usize; 3], group: &[(u32, u64)]) -> Group {
    let mut around = Group::new();
    for (brick, bits) in group {
        around.push((*brick, enter(*bits, [0; 3], Neighbours::All)));
        for_each_beside(bricks, *brick as usize, |beside, step| {
            around.push((beside as u32, enter(*bits, step, Neighbours::All)));
        });
    }
    let mut around = merge(around);
    for (brick, bits) in &mut around {
        if let Ok(place) = group.binary_search_by_key(brick, |(brick, _)| *brick) {
            *bits &= !group[place].1;
        }
    }
    around
}

/// The voxels of a group, in the order of its bricks and bits.
pub fn voxels<'a>(grid: &'a BitGrid, group: &'a [(u32, u64)]) -> impl Iterator<Item = VoxelIndex> + 'a {
    group.iter().flat_map(|(brick, bits)| brick::ones(*bits).map(|bit| grid.voxel(*brick as usize, bit)))
}

/// How many groups a set has.
pub fn count(set: &BitGrid, neighbours: Neighbours) -> usize {
    let (mut left, mut from) = (set.clone(), 0);
    std::iter::from_fn(|| take_next(&mut left, &mut from, neighbours)).count()
}

fn merge(mut group: Group) -> Group {
    group.sort_unstable();
    group.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 |= next.1;
        }
        same
    });
    group
}

/// The bits of the brick one `step` away (each -1, 0 or 1) that touch these.
#[inline]
fn enter(bits: u64, step: [i32; 3], neighbours: Neighbours) -> u64 {
    let along = |bits: u64, step: i32, cross: [u64; 2], sides: [u64; 2]| match step {
        -1 => cross[0],
        1 => cross[1],
        _ if neighbours == Neighbours::Six => bits,
        _ => bits | sides[0] | sides[1],
    };
    let x = along(
        bits,
        step[0],
        [from_above::<0>(0, bits), from_below::<0>(0, bits)],
        [from_above::<0>(bits, 0), from_below::<0>(bits, 0)],
    );
    let y = along(
        x,
        step[1],
        [from_above::<1>(0, x), from_below::<1>(0, x)],
        [from_above::<1>(x, 0), from_below::<1>(x, 0)],
    );
    along(y, step[2], [from_above::<2>(0, y), from_below::<2>(0, y)], [from_above::<2>(y, 0), from_below::<2>(y, 0)])
}

/// The up to 26 bricks beside one, each with the step to it.
fn for_each_beside(bricks: [usize; 3], brick: usize, mut visit: impl FnMut(usize, [i32; 3])) {
    let [across, rows, planes] = bricks.map(|count| count as i32);
    let brick = brick as i32;
    let (x, y, z) = (brick % across, brick / across % rows, brick / (across * rows));
    for dz in -1..=1 {
        for dy in -1..=1 {
            for dx in -1..=1 {
                let (x, y, z) = (x + dx, y + dy, z + dz);
                let inside = (0..across).contains(&x) && (0..rows).contains(&y) && (0..planes).contains(&z);
                if inside && (dx, dy, dz) != (0, 0, 0) {
                    visit((x + across * (y + rows * z)) as usize, [dx, dy, dz]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::IVec3;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn flood(set: &BTreeSet<[i32; 3]>, seed: [i32; 3], six: bool) -> BTreeSet<[i32; 3]> {
        let (mut reached, mut fronts) = (BTreeSet::from([seed]), vec![seed]);
        while let Some(at) = fronts.pop() {
            for i in 0..27 {
                let step = IVec3::new(i % 3, i / 3 % 3, i / 9) - 1;
                let next = (IVec3::from(at) + step).to_array();
                if (!six || step.abs().element_sum() == 1) && set.contains(&next) && reached.insert(next) {
                    fronts.push(next);
                }
            }
        }
        reached
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn groups_equal_a_flood_voxel_by_voxel(
            size in prop::array::uniform3(1_usize..11),
            share in 0.1..0.6,
            numbers in prop::collection::vec(0.0..1.0, 1000),
        ) {
            let bytes: Vec<u8> = numbers.iter().map(|number| u8::from(*number < share)).collect();
            let set = BitGrid::from_bytes(size, &bytes[..size.iter().product()]);
            let members: BTreeSet<_> = set.iter().map(|voxel| voxel.0.to_array()).collect();
            for neighbours in [Neighbours::Six, Neighbours::All] {
                let (mut left, mut from, mut total) = (set.clone(), 0, 0);
                while let Some(group) = take_next(&mut left, &mut from, neighbours) {
                    let found: BTreeSet<_> = voxels(&set, &group).map(|voxel| voxel.0.to_array()).collect();
                    let first = *found.first().unwrap();
                    prop_assert_eq!(&found, &flood(&members, first, neighbours == Neighbours::Six));
                    total += found.len();
                    let near: BTreeSet<_> = found
                        .iter()
                        .flat_map(|at| (0..27).map(move |i| IVec3::from(*at) + IVec3::new(i % 3, i / 3 % 3, i / 9) - 1))
                        .map(|at| at.to_array())
                        .filter(|at| !found.contains(at) && set.place(VoxelIndex(IVec3::from(*at))).is_some())
                        .collect();
                    let around = around(set.bricks(), &group);
                    let around: BTreeSet<_> = voxels(&set, &around)
                        .filter(|voxel| set.place(*voxel).is_some())
                        .map(|voxel| voxel.0.to_array())
                        .collect();
                    prop_assert_eq!(around, near);
                }
                prop_assert_eq!(total, set.count());
            }
        }
    }
}
