//! Which node of the skeleton is nearest to a voxel, along the void and not through walls?
//!
//! A multi-source search over the void's voxels in the chamfer metric 3-4-5 (Borgefors 1986: steps over faces, edges and
//! corners, at most 12% off the straight distance). The voxels at each length make a front, kept as bits. A front marks
//! its neighbours three, four and five lengths further on, many at once; a marked voxel that no earlier front held belongs
//! to the front of that length, and takes the lowest node among the neighbours it was reached from. So each voxel has the
//! node of its shortest way, of equally short ways the one to the lower node, however the search is ordered. Labels are
//! kept for bricks with void in them alone.

use crate::space::VoxelIndex;
use crate::voxel::bits::BitGrid;
use crate::voxel::brick;
use glam::IVec3;

/// The length of a step over a face; over an edge and a corner it is one and two more.
const STEP_UNITS: usize = 3;

/// Fronts that are kept: one more than the longest step.
const FRONTS: usize = 6;

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
    /// Voxels whose void has no node get none.
    ///
    /// One thread, about 60 ns a voxel. Memory for the time: 212 bytes a brick with void.
    pub fn new(void: &BitGrid, corners: &[IVec3]) -> Self {
        let slots = Slots::new(void);
        let mut labels = vec![[NO_NODE; 64]; slots.words.len()];
        let mut fronts = Fronts::new(&slots);
        for (node, corner) in corners.iter().enumerate() {
            for octant in 0..8 {
                let below = IVec3::new(octant & 1, octant >> 1 & 1, octant >> 2);
                let Some((brick, bit)) = void.place(VoxelIndex(*corner - below)) else { continue };
                if void.words()[brick] >> bit & 1 == 1 {
                    let slot = slots.of_brick[brick];
                    let label = &mut labels[slot as usize][bit as usize];
                    *label = (node as u32).min(*label);
                    fronts.mark(slot, 0, 1 << bit);
                }
            }
        }
        for length in 0.. {
            if fronts.waiting == 0 {
                break;
            }
            fronts.settle(&slots, length, &mut labels);
            fronts.spread(&slots, length);
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

/// The voxels at the last and the next few lengths; those of length `l` at `l % FRONTS`.
struct Fronts {
    /// The void not reached yet.
    open: Vec<u64>,
    /// Voxels at each of the last lengths.
    held: Vec<[u64; FRONTS]>,
    /// Voxels that can be reached with each of the next lengths.
    marked: Vec<[u64; FRONTS]>,
    /// Slots that hold voxels, and slots with marks.
    holding: [Vec<u32>; FRONTS],
    marking: [Vec<u32>; FRONTS],
    /// Slots with marks, of all lengths together.
    waiting: usize,
}

impl Fronts {
    fn new(slots: &Slots) -> Self {
        let none = vec![[0; FRONTS]; slots.words.len()];
        Self {
            open: slots.words.clone(),
            held: none.clone(),
            marked: none,
            holding: Default::default(),
            marking: Default::default(),
            waiting: 0,
        }
    }

    #[inline(always)]
    fn mark(&mut self, slot: u32, front: usize, bits: u64) {
        let marked = &mut self.marked[slot as usize][front];
        if *marked == 0 && bits != 0 {
            self.marking[front].push(slot);
            self.waiting += 1;
        }
        *marked |= bits;
    }

    /// Makes the front of a length out of its marks, and gives each of its voxels the lowest node it was reached from.
    fn settle(&mut self, slots: &Slots, length: usize, labels: &mut [[u32; 64]]) {
        let front = length % FRONTS;
        let before = [0, 1, 2].map(|longer| (length + FRONTS - STEP_UNITS - longer) % FRONTS);
        for slot in self.holding[front].drain(..) {
            self.held[slot as usize][front] = 0;
        }
        self.waiting -= self.marking[front].len();
        for slot in self.marking[front].drain(..) {
            let here = slot as usize;
            let new = std::mem::take(&mut self.marked[here][front]) & self.open[here];
            if new == 0 {
                continue;
            }
            self.open[here] &= !new;
            self.held[here][front] = new;
            self.holding[front].push(slot);
            for bit in brick::ones(new).map(|bit| bit as usize) {
                let mut lowest = labels[here][bit];
                for (side, moved) in around(bit) {
                    let beside = slots.beside[here][*side as usize] as usize;
                    let Some(held) = self.held.get(beside) else { continue };
                    for (before, moved) in before.iter().zip(moved) {
                        for other in brick::ones(held[*before] & moved) {
                            lowest = lowest.min(labels[beside][other as usize]);
                        }
                    }
                }
                labels[here][bit] = lowest;
            }
        }
    }

    /// Marks what the front of a length reaches.
    fn spread(&mut self, slots: &Slots, length: usize) {
        let after = [0, 1, 2].map(|longer| (length + STEP_UNITS + longer) % FRONTS);
        let holding = std::mem::take(&mut self.holding[length % FRONTS]);
        for &slot in &holding {
            let beside = &slots.beside[slot as usize];
            for bit in brick::ones(self.held[slot as usize][length % FRONTS]) {
                for (side, moved) in around(bit as usize) {
                    let there = beside[*side as usize];
                    let open = self.open.get(there as usize).copied().unwrap_or(0);
                    if open == 0 {
                        continue;
                    }
                    for (after, moved) in after.iter().zip(moved) {
                        self.mark(there, *after, open & moved);
                    }
                }
            }
        }
        self.holding[length % FRONTS] = holding;
    }
}

/// For each bit of a brick: which of the 27 bricks around hold neighbours of it, and which bits of them are one step over
/// a face, an edge, a corner away.
#[inline(always)]
fn around(bit: usize) -> &'static [(u8, [u64; 3])] {
    let (bricks, count) = &AROUND[bit % 64];
    &bricks[..*count]
}

type Bricks = ([(u8, [u64; 3]); 8], usize);

static AROUND: [Bricks; 64] = all_around();

const fn all_around() -> [Bricks; 64] {
    let mut around = [([(0, [0; 3]); 8], 0); 64];
    let mut bit = 0;
    while bit < 64 {
        let mut bricks = [[0_u64; 3]; 27];
        let mut side = 0;
        while side < 27 {
            let [dx, dy, dz] = [side % 3, side / 3 % 3, side / 9];
            let moved = (dx != 1) as usize + (dy != 1) as usize + (dz != 1) as usize;
            if moved > 0 {
                // One brick further along each axis, so that nothing is negative.
                let [x, y, z] = [bit % 4 + dx + 3, bit / 4 % 4 + dy + 3, bit / 16 + dz + 3];
                bricks[x / 4 + 3 * (y / 4) + 9 * (z / 4)][moved - 1] |= 1 << (x % 4 + 4 * (y % 4) + 16 * (z % 4));
            }
            side += 1;
        }
        let (mut next, mut brick) = (0, 0);
        while brick < 27 {
            if bricks[brick][0] | bricks[brick][1] | bricks[brick][2] != 0 {
                around[bit].0[next] = (brick as u8, bricks[brick]);
                next += 1;
            }
            brick += 1;
        }
        around[bit].1 = next;
        bit += 1;
    }
    around
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
