//! Which node of the skeleton is nearest to a voxel, along the void and not through walls?
//!
//! A multi-source search over the void's voxels in the chamfer metric 3-4-5 (Borgefors 1986: steps over faces, edges and
//! corners, at most 12% off the straight distance), with Dial's bucket queue: weights are small, so six buckets in a ring
//! do. Each voxel takes the node of its shortest way, of equally short ways the one to the lower node; the result is
//! therefore the same however the search is ordered. Labels are kept for bricks with void in them alone.

use crate::space::VoxelIndex;
use crate::voxel::bits::BitGrid;
use crate::voxel::brick;
use glam::IVec3;

/// The length of a step over a face; a straight voxel is this many units.
pub const STEP_UNITS: u16 = 3;

/// Neighbours of a voxel, those over faces first, then edges, then corners.
const NEIGHBOURS: usize = 26;

/// Buckets of the queue: one more than the longest step.
const BUCKETS: usize = 6;

/// No brick there, or one without void.
const NO_SLOT: u32 = u32::MAX;

/// A voxel that no node reaches.
const NO_NODE: u32 = u32::MAX;

/// For each void voxel a node; four bytes for each voxel of the bricks that hold any void.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Nearest {
    bricks: [usize; 3],
    slot_of_brick: Vec<u32>,
    labels: Vec<[u32; 64]>,
}

impl Nearest {
    /// Finds the nearest node for each voxel of `void`. `corners` are the nodes, in the order of their numbers, at corners
    /// of voxels (corner `(i, j, k)` is the lowest corner of that voxel); each stands in the void voxels around it.
    /// Voxels whose void has no node get none, as do those more than 20,000 voxels away from one.
    ///
    /// One thread, about 40 ms a million voxels.
    pub fn new(void: &BitGrid, corners: &[IVec3]) -> Self {
        let slots = Slots::new(void);
        let mut distance: Vec<[u16; 64]> = slots.words.iter().map(|word| open(*word)).collect();
        let mut labels = vec![[NO_NODE; 64]; slots.words.len()];
        let mut buckets: [Vec<u32>; BUCKETS] = Default::default();

        for (node, corner) in corners.iter().enumerate() {
            for octant in 0..8 {
                let below = IVec3::new(octant & 1, octant >> 1 & 1, octant >> 2);
                let Some((brick, bit)) = void.place(VoxelIndex(*corner - below)) else { continue };
                let slot = slots.of_brick[brick] as usize;
                if void.words()[brick] >> bit & 1 == 1 && labels[slot][bit as usize] == NO_NODE {
                    distance[slot][bit as usize] = 0;
                    labels[slot][bit as usize] = node as u32;
                    buckets[0].push(slot as u32 * 64 + bit);
                }
            }
        }

        let mut reached: u16 = 0;
        let mut waiting: usize = buckets[0].len();
        while waiting > 0 && reached < u16::MAX - BUCKETS as u16 {
            let mut bucket = std::mem::take(&mut buckets[reached as usize % BUCKETS]);
            waiting -= bucket.len();
            for voxel in bucket.drain(..) {
                let (slot, bit) = (voxel as usize / 64, voxel as usize % 64);
                if distance[slot][bit] != reached {
                    continue;
                }
                let label = labels[slot][bit];
                let beside = &slots.beside[slot];
                for (step, &(side, there)) in STEPS[bit].iter().enumerate() {
                    let slot = beside[side as usize] as usize;
                    let Some(far) = distance.get_mut(slot) else { continue };
                    let there = there as usize;
                    let length = reached + WEIGHTS[step];
                    if length < far[there] {
                        far[there] = length;
                        labels[slot][there] = label;
                        buckets[length as usize % BUCKETS].push((slot * 64 + there) as u32);
                        waiting += 1;
                    } else if length == far[there] && label < labels[slot][there] {
                        labels[slot][there] = label;
                    }
                }
            }
            buckets[reached as usize % BUCKETS] = bucket;
            reached += 1;
        }
        Self { bricks: void.bricks(), slot_of_brick: slots.of_brick, labels }
    }

    /// The number of the node nearest to a voxel; `None` outside the void, and where the void has no node.
    pub fn node(&self, VoxelIndex(at): VoxelIndex) -> Option<u32> {
        let [across, rows, planes] = self.bricks;
        let [x, y, z] = at.to_array().map(|along| along as usize);
        if at.min_element() < 0 || x / 4 >= across || y / 4 >= rows || z / 4 >= planes {
            return None;
        }
        let slot = *self.slot_of_brick.get(x / 4 + across * (y / 4 + rows * (z / 4)))?;
        let label = self.labels.get(slot as usize)?[brick::bit(x % 4, y % 4, z % 4) as usize];
        (label != NO_NODE).then_some(label)
    }

    /// The 64 labels of a brick in the order of its bits, `u32::MAX` for voxels without a node; `None` for bricks without
    /// void.
    pub fn of_brick(&self, brick: usize) -> Option<&[u32; 64]> {
        self.labels.get(*self.slot_of_brick.get(brick)? as usize)
    }
}

/// Bricks with void in them, numbered.
struct Slots {
    of_brick: Vec<u32>,
    words: Vec<u64>,
    /// The slots of the 27 bricks around each, itself in the middle.
    beside: Vec<[u32; 27]>,
}

impl Slots {
    fn new(void: &BitGrid) -> Self {
        let [across, rows, planes] = void.bricks();
        let mut of_brick = vec![NO_SLOT; void.words().len()];
        let mut words = Vec::new();
        for (brick, word) in void.words().iter().enumerate().filter(|(_, word)| **word != 0) {
            of_brick[brick] = words.len() as u32;
            words.push(*word);
        }
        let mut beside = Vec::with_capacity(words.len());
        for brick in (0..of_brick.len()).filter(|brick| of_brick[*brick] != NO_SLOT) {
            let at = void.brick_at(brick).map(|along| along as isize);
            let mut around = [NO_SLOT; 27];
            for (side, slot) in around.iter_mut().enumerate() {
                let [x, y, z] = [0, 1, 2].map(|axis| at[axis] + (side / [1, 3, 9][axis] % 3) as isize - 1);
                let inside =
                    [(x, across), (y, rows), (z, planes)].iter().all(|&(at, end)| at >= 0 && at < end as isize);
                if inside {
                    *slot = of_brick[x as usize + across * (y as usize + rows * z as usize)];
                }
            }
            beside.push(around);
        }
        Self { of_brick, words, beside }
    }
}

/// Distances before the search: none for void voxels, 0 for all others, so that no way leads there.
fn open(word: u64) -> [u16; 64] {
    std::array::from_fn(|bit| if word >> bit & 1 == 1 { u16::MAX } else { 0 })
}

/// The lengths of the 26 steps.
const WEIGHTS: [u16; NEIGHBOURS] = steps().1;

/// For each bit of a brick and each step: which of the 27 bricks around it leads to, and the bit there.
const STEPS: [[(u8, u8); NEIGHBOURS]; 64] = steps().0;

const fn steps() -> ([[(u8, u8); NEIGHBOURS]; 64], [u16; NEIGHBOURS]) {
    let mut steps = [[(0, 0); NEIGHBOURS]; 64];
    let mut weights = [0; NEIGHBOURS];
    let mut bit = 0;
    while bit < 64 {
        let mut step = 0;
        let mut moved = 1;
        while moved <= 3 {
            let mut side = 0;
            while side < 27 {
                let [dx, dy, dz] = [side % 3, side / 3 % 3, side / 9];
                if (dx != 1) as usize + (dy != 1) as usize + (dz != 1) as usize == moved {
                    // One brick further along each axis, so that nothing is negative.
                    let [x, y, z] = [bit % 4 + dx + 3, bit / 4 % 4 + dy + 3, bit / 16 + dz + 3];
                    let brick = x / 4 + 3 * (y / 4) + 9 * (z / 4);
                    steps[bit][step] = (brick as u8, (x % 4 + 4 * (y % 4) + 16 * (z % 4)) as u8);
                    weights[step] = STEP_UNITS + moved as u16 - 1;
                    step += 1;
                }
                side += 1;
            }
            moved += 1;
        }
        bit += 1;
    }
    (steps, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Bellman-Ford over all voxels: the plainest statement of what is asked.
    fn plain(void: &BitGrid, corners: &[IVec3]) -> Vec<(VoxelIndex, Option<u32>)> {
        let voxels: Vec<VoxelIndex> = void.iter().collect();
        let mut best: Vec<(u32, u32)> = voxels.iter().map(|_| (u32::MAX, u32::MAX)).collect();
        for (at, best) in voxels.iter().zip(&mut best) {
            for (node, corner) in corners.iter().enumerate() {
                let apart = *corner - at.0;
                if apart.min_element() >= 0 && apart.max_element() <= 1 {
                    *best = (*best).min((0, node as u32));
                }
            }
        }
        for _ in 0..voxels.len() {
            let before = best.clone();
            for (at, best) in voxels.iter().zip(&mut best) {
                for (other, (length, node)) in voxels.iter().zip(&before) {
                    let apart = (other.0 - at.0).abs();
                    if *length < u32::MAX && apart.max_element() == 1 {
                        *best = (*best).min((length + 2 + apart.element_sum() as u32, *node));
                    }
                }
            }
            if before == best {
                break;
            }
        }
        voxels.into_iter().zip(best.into_iter().map(|(length, node)| (length < u32::MAX).then_some(node))).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]
        #[test]
        fn equals_the_plain_search(
            bytes in prop::collection::vec(0u8..3, 7 * 6 * 5),
            corners in prop::collection::vec((0..8, 0..7, 0..6), 1..6),
        ) {
            let void = BitGrid::from_bytes([7, 6, 5], &bytes);
            let corners: Vec<IVec3> = corners.into_iter().map(|(x, y, z)| IVec3::new(x, y, z)).collect();
            let nearest = Nearest::new(&void, &corners);
            for (voxel, want) in plain(&void, &corners) {
                prop_assert_eq!(nearest.node(voxel), want);
            }
        }
    }

    #[test]
    fn nothing_is_near_outside_the_void() {
        let mut void = BitGrid::new([9, 3, 3]);
        for x in [0, 1, 2, 6, 7] {
            void.set(VoxelIndex::new(x, 1, 1), true);
        }
        let nearest = Nearest::new(&void, &[IVec3::new(1, 1, 1)]);
        assert_eq!(nearest.node(VoxelIndex::new(2, 1, 1)), Some(0));
        for outside in [VoxelIndex::new(6, 1, 1), VoxelIndex::new(0, 0, 0), VoxelIndex::new(-1, 1, 1)] {
            assert_eq!(nearest.node(outside), None);
        }
        assert_eq!(nearest.node(VoxelIndex::new(90, 1, 1)), None);
    }
}
