//! What does a voxel reach through the void?
//!
//! Floods over 26 neighbours, a brick of 64 voxels at a time: a brick that gains voxels is filled up inside by shifts and
//! ANDs, and what overflows its faces, edges and corners goes to the 26 bricks around it. Each brick is seen a few times,
//! so a flood costs some hundred nanoseconds for each brick that it reaches. A void leaks when it reaches the outermost layer
//! of the grid, where the box of the grid then bounds it.

use super::bits::BitGrid;
use super::brick::{self, EDGE, FIRST, flood_all, from_above, from_below};
use crate::space::VoxelIndex;

/// What a flood reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reached {
    /// A voxel of it.
    pub from: VoxelIndex,
    /// How many voxels.
    pub voxels: usize,
    /// Whether it touches the outermost layer of the grid.
    pub leaks: bool,
}

/// Floods into the same grid, one component after another.
#[derive(Debug, Clone)]
pub struct Flood {
    free: BitGrid,
    void: BitGrid,
    /// Bricks that gained voxels, and for each brick of the grid the voxels that it gained and that are not void yet.
    waiting: Vec<u32>,
    gained: Vec<u64>,
}

impl Flood {
    /// Nothing flooded yet; everything that is not in `solid` can be.
    pub fn new(solid: &BitGrid) -> Self {
        let mut free = solid.clone();
        free.complement();
        let gained = vec![0; free.words().len()];
        Self { void: BitGrid::new(free.size()), free, waiting: Vec::new(), gained }
    }

    /// Bytes it takes for each voxel of the grid, besides the grids that it hands back.
    pub const BYTES_A_VOXEL: f64 = 2.0 / 8.0 + 4.0 / 64.0;

    /// All voxels flooded so far.
    pub fn void(&self) -> &BitGrid {
        &self.void
    }

    /// All voxels flooded, when it is done.
    pub fn into_void(self) -> BitGrid {
        self.void
    }

    /// Floods all that 26-connected steps through free voxels join to `from`; `None`, and nothing happens, where `from` is
    /// solid, outside the grid, or flooded already.
    pub fn flood(&mut self, from: VoxelIndex) -> Option<Reached> {
        if !self.free.get(from) || self.void.get(from) {
            return None;
        }
        let (brick, bit) = self.free.place(from)?;
        let (mut voxels, mut leaks) = (0, false);
        self.pour(brick, 1 << bit);
        while let Some(brick) = self.waiting.pop().map(|brick| brick as usize) {
            let filled = flood_all(self.gained[brick], self.free.words()[brick]);
            self.gained[brick] = 0;
            self.void.words_mut()[brick] |= filled;
            voxels += filled.count_ones() as usize;
            let at = self.free.brick_at(brick);
            leaks |= filled & self.shell(at) != 0;
            self.overflow(at, filled);
        }
        Some(Reached { from, voxels, leaks })
    }

    /// The voxels of a brick that lie in the outermost layer of the grid.
    fn shell(&self, at: [usize; 3]) -> u64 {
        let (size, bricks) = (self.free.size(), self.free.bricks());
        (0..3).fold(0, |shell, axis| {
            let low = if at[axis] == 0 { FIRST[axis] } else { 0 };
            let end = size[axis] - EDGE * at[axis];
            let high = if at[axis] + 1 == bricks[axis] { brick::layers(axis, end - 1, end) } else { 0 };
            shell | low | high
        })
    }

    /// Pours voxels into a brick; it waits to be filled when some are free and new.
    fn pour(&mut self, brick: usize, voxels: u64) {
        let new = voxels & self.free.words()[brick] & !self.void.words()[brick];
        if new != 0 {
            if self.gained[brick] == 0 {
                self.waiting.push(brick as u32);
            }
            self.gained[brick] |= new;
        }
    }

    /// Pours what the voxels of a brick touch in the 26 bricks around it.
    fn overflow(&mut self, at: [usize; 3], voxels: u64) {
        let [across, rows, planes] = self.free.bricks();
        let spread_z = [from_above::<2>(0, voxels), spread::<2>(voxels), from_below::<2>(0, voxels)];
        for (dz, &in_z) in spread_z.iter().enumerate() {
            let z = at[2] + dz;
            if in_z == 0 || z < 1 || z > planes {
                continue;
            }
            let spread_y = [from_above::<1>(0, in_z), spread::<1>(in_z), from_below::<1>(0, in_z)];
            for (dy, &in_y) in spread_y.iter().enumerate() {
                let y = at[1] + dy;
                if in_y == 0 || y < 1 || y > rows {
                    continue;
                }
                let spread_x = [from_above::<0>(0, in_y), spread::<0>(in_y), from_below::<0>(0, in_y)];
                for (dx, &in_x) in spread_x.iter().enumerate() {
                    let x = at[0] + dx;
                    let itself = (dx, dy, dz) == (1, 1, 1);
                    if in_x != 0 && !itself && x >= 1 && x <= across {
                        self.pour(x - 1 + across * (y - 1 + rows * (z - 1)), in_x);
                    }
                }
            }
        }
    }
}

/// The voxels of a brick and their neighbours along an axis, inside the brick.
#[inline(always)]
fn spread<const AXIS: usize>(voxels: u64) -> u64 {
    voxels | from_below::<AXIS>(voxels, 0) | from_above::<AXIS>(voxels, 0)
}

/// Every void of the grid: the 26-connected components of what is not solid, in the order of their first brick.
pub fn voids(solid: &BitGrid) -> Vec<Reached> {
    let mut flood = Flood::new(solid);
    let mut found = Vec::new();
    for brick in 0..solid.words().len() {
        loop {
            let left = flood.free.words()[brick] & !flood.void.words()[brick];
            if left == 0 {
                break;
            }
            found.extend(flood.flood(solid.voxel(brick, left.trailing_zeros())));
        }
    }
    found
}

/// The largest void that does not reach the box of the grid; the outside where everything does; `None` where all is solid.
/// The first of equals.
pub fn largest_void(solid: &BitGrid) -> Option<Reached> {
    voids(solid).into_iter().rev().max_by_key(|void| (!void.leaks, void.voxels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::IVec3;
    use proptest::prelude::*;

    fn by_steps(solid: &BitGrid, from: VoxelIndex) -> BitGrid {
        let mut reached = BitGrid::new(solid.size());
        let mut waiting = vec![from.0];
        while let Some(at) = waiting.pop() {
            let [x, y, z] = solid.size().map(|along| along as i32);
            let inside = at.cmpge(IVec3::ZERO).all() && at.cmplt(IVec3::new(x, y, z)).all();
            if inside && !solid.get(VoxelIndex(at)) && !reached.get(VoxelIndex(at)) {
                reached.set(VoxelIndex(at), true);
                waiting.extend((0..27).map(|i| at + IVec3::new(i % 3, i / 3 % 3, i / 9) - 1));
            }
        }
        reached
    }

    fn random_grid() -> impl Strategy<Value = BitGrid> {
        let bytes = (0.5..0.97_f64).prop_flat_map(|share| prop::collection::vec(prop::bool::weighted(share), 2744));
        (prop::array::uniform3(1_usize..15), bytes).prop_map(|(size, bytes)| {
            let bytes: Vec<u8> = bytes.into_iter().map(u8::from).take(size.iter().product()).collect();
            BitGrid::from_bytes(size, &bytes)
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]
        #[test]
        fn a_flood_equals_a_search_voxel_by_voxel(solid in random_grid()) {
            let mut whole = BitGrid::new(solid.size());
            whole.fill(true);
            let mut flood = Flood::new(&solid);
            let mut want_void = BitGrid::new(solid.size());
            for from in whole.iter() {
                let reached = flood.flood(from);
                prop_assert_eq!(reached.is_some(), !solid.get(from) && !want_void.get(from));
                if let Some(reached) = reached {
                    let want = by_steps(&solid, from);
                    prop_assert_eq!(reached.voxels, want.count());
                    let on_shell = |at: IVec3| (0..3).any(|axis| at[axis] == 0 || at[axis] as usize + 1 == solid.size()[axis]);
                    prop_assert_eq!(reached.leaks, want.iter().any(|voxel| on_shell(voxel.0)));
                    want_void.or(&want);
                    prop_assert_eq!(flood.void(), &want_void);
                }
            }
            let all = voids(&solid);
            prop_assert_eq!(all.iter().map(|void| void.voxels).sum::<usize>() + solid.count(), whole.count());
            if let Some(largest) = largest_void(&solid) {
                prop_assert!(all.iter().all(|v| (!v.leaks, v.voxels) <= (!largest.leaks, largest.voxels)));
            }
        }
    }

    #[test]
    fn the_largest_void_is_an_enclosed_one() {
        let mut solid = BitGrid::new([20, 20, 20]);
        solid.fill(true);
        let carve = |low: i32, high: i32, solid: &mut BitGrid| {
            for at in (0..8000).map(|i| IVec3::new(i % 20, i / 20 % 20, i / 400)) {
                if at.cmpge(IVec3::splat(low)).all() && at.cmple(IVec3::splat(high)).all() {
                    solid.set(VoxelIndex(at), false);
                }
            }
        };
        assert_eq!(largest_void(&solid), None);
        carve(13, 19, &mut solid);
        assert!(largest_void(&solid).is_some_and(|void| void.leaks && void.voxels == 343));
        carve(2, 4, &mut solid);
        carve(6, 9, &mut solid);
        assert_eq!(largest_void(&solid).map(|void| (void.leaks, void.voxels)), Some((false, 64)));
    }
}
