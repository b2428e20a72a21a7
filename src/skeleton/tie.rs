//! How does matter that floats in the void keep thinning from leaving a closed sheet around it?
//!
//! A void with a floating solid has a cavity, and a cavity can only be kept by a surface. So each floating solid is tied
//! to another, and in the end to the walls: along a path of void voxels from face to face between the two, the insides of
//! its `k` cubes and of the `k + 1` faces it crosses are taken out of the complex, not their edges or points. The open
//! tube joins what is not void, so one cavity goes, the Euler characteristic drops by one, and neither components nor loops
//! change. (Making voxels solid instead can close loops: a string of voxels may touch its own solid twice.)
//!
//! All paths come from one search that grows from all floating solids at once. Paths may share their beginning: together
//! they are a forest, so each tie still takes one face more than cubes.

use super::complex::{CUBES, Complex};
use crate::job::{Cancel, Cancelled};
use crate::space::VoxelIndex;
use crate::voxel::bits::BitGrid;
use crate::voxel::brick;
use crate::voxel::groups;
use crate::voxel::morphology::Neighbours;
use glam::IVec3;
use std::collections::VecDeque;

/// Ties the floating solids of a void to the walls, in its complex; gives how many there are.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised; the complex is then tied in part.
pub fn tie(complex: &mut Complex, void: &BitGrid, cancel: &Cancel) -> Result<usize, Cancelled> {
    let mut floating = floating(void);
    if floating.is_empty() {
        return Ok(0);
    }
    let mut search = Search { void, owners: vec![0; 64 * void.words().len()], joined: vec![WALLS] };
    let mut fronts = VecDeque::new();
    let mut from = 0;
    while let Some(group) = groups::take_next(&mut floating, &mut from, Neighbours::Six) {
        let owner = search.joined.len() as u32;
        search.joined.push(owner);
        for voxel in groups::voxels(void, &group) {
            search.claim(voxel, owner, SOLID);
            fronts.push_back(voxel);
        }
    }

    let solids = search.joined.len() - 1;
    let mut ties = 0;
    let mut steps = 0_u32;
    while let Some(voxel) = fronts.pop_front() {
        steps = steps.wrapping_add(1);
        if steps.is_multiple_of(4096) {
            cancel.check()?;
        }
        let owner = search.owner(voxel).unwrap_or(WALLS);
        // Solids that are tied to the walls wait for others to come to them.
        if search.root(owner) == WALLS {
            continue;
        }
        for (direction, step) in STEPS.into_iter().enumerate() {
            let next = VoxelIndex(voxel.0 + step);
            let met = match search.owner(next) {
                Some(met) => met,
                None if void.get(next) => {
                    search.claim(next, owner, direction as u32 ^ 1);
                    fronts.push_back(next);
                    continue;
                }
                None => WALLS,
            };
            if search.join(owner, met) {
                complex.remove_face_between(voxel, next);
                search.cut_back(complex, voxel);
                search.cut_back(complex, next);
                ties += 1;
                if ties == solids {
                    return Ok(solids);
                }
            }
        }
    }
    Ok(solids)
}

/// The solid voxels that no path from face to face joins to the outside of the grid.
pub fn floating(void: &BitGrid) -> BitGrid {
    let mut solid = void.clone();
    solid.complement();
    let bricks = solid.bricks();
    let size = solid.size();
    let on_boundary = |brick: usize| {
        let at = solid.brick_at(brick);
        (0..3).fold(0, |bits, axis| {
            let first = if at[axis] == 0 { brick::FIRST[axis] } else { 0 };
            let last = size[axis] - 1;
            let high = if at[axis] == last / 4 { brick::layers(axis, last % 4, last % 4 + 1) } else { 0 };
            bits | first | high
        })
    };
    let outer = |brick: &usize| (0..3).any(|axis| [0, bricks[axis] - 1].contains(&solid.brick_at(*brick)[axis]));
    let seeds = (0..solid.words().len()).filter(outer).map(|brick| (brick, on_boundary(brick)));
    let seeds: Vec<_> = seeds.collect();
    groups::remove(&mut solid, seeds);
    solid
}

/// The owner that stands for the walls and all beyond the grid.
const WALLS: u32 = 0;

/// In place of the direction to where a voxel was reached from: it belongs to the solid itself.
const SOLID: u32 = 6;

/// The six steps to a neighbour; opposite ones differ in the lowest bit of their number.
const STEPS: [IVec3; 6] = [IVec3::X, IVec3::NEG_X, IVec3::Y, IVec3::NEG_Y, IVec3::Z, IVec3::NEG_Z];

/// Which voxels were reached from which solid.
struct Search<'a> {
    void: &'a BitGrid,
    /// For each voxel, brick by brick, 0 or eight times its owner and the direction to where it was reached from.
    owners: Vec<u32>,
    /// For each owner another one it is tied to, or itself.
    joined: Vec<u32>,
}

impl Search<'_> {
    fn entry(&self, voxel: VoxelIndex) -> Option<u32> {
        let (brick, bit) = self.void.place(voxel)?;
        Some(self.owners[64 * brick + bit as usize]).filter(|entry| *entry != 0)
    }

    fn owner(&self, voxel: VoxelIndex) -> Option<u32> {
        self.entry(voxel).map(|entry| entry / 8)
    }

    fn claim(&mut self, voxel: VoxelIndex, owner: u32, direction: u32) {
        if let Some((brick, bit)) = self.void.place(voxel) {
            self.owners[64 * brick + bit as usize] = 8 * owner + direction;
        }
    }

    fn root(&mut self, mut owner: u32) -> u32 {
        while self.joined[owner as usize] != owner {
            let next = self.joined[owner as usize];
            self.joined[owner as usize] = self.joined[next as usize];
            owner = next;
        }
        owner
    }

    /// Ties two owners; whether they were not tied before. The walls stay a root.
    fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.joined[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// Takes out the cubes and faces from a voxel back to the solid from which it was reached.
    fn cut_back(&self, complex: &mut Complex, mut voxel: VoxelIndex) {
        while let Some(direction) = self.entry(voxel).map(|entry| entry % 8).filter(|direction| *direction != SOLID) {
            let back = VoxelIndex(voxel.0 + STEPS[direction as usize]);
            complex.remove(voxel.0, CUBES);
            complex.remove_face_between(voxel, back);
            voxel = back;
        }
    }
}
