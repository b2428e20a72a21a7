//! How is one direction's share of a layer taken off?
//!
//! In principle by three passes over the whole complex: cubes with faces across the axis, faces with edges, edges with
//! points, each reading what the last left. They become one visit to each brick, in place, because
//! - a pass reads the larger cells of a pair only in a brick and the one below it along the axis: taking pairs at their low
//!   end, bricks are visited downwards along the axis, so that the one below still is as it was; taking them at their high
//!   end, upwards, and what a visit takes from the brick below (its last layer) no other visit reads;
//! - a pass reads what the pass before took in a brick and the bricks below it along the other two axes: there bricks are
//!   visited upwards, and later passes do not touch those cells.

use super::border::HERE;
use super::{cut, part, slabs};
use crate::skeleton::complex::{CUBES, Cells, Layout, across};
use crate::voxel::brick::{from_above, from_below};
use rayon::prelude::*;

/// From which side a free pair is taken: whether the bounding cell lies at the low or the high end of the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Low,
    High,
}

/// What stays the same while a layer is taken off.
pub struct Pass<'a> {
    pub layout: &'a Layout,
    /// The cells that may go.
    pub border: &'a [Cells],
    /// Where there are any: see [`Border::near`](super::border::Border::near).
    pub near: &'a [u8],
    /// Points, and edges along x, y, z, that may not.
    pub kept: &'a [[u64; 4]],
}

/// A run of planes of bricks that one thread works on, over a copy of what lies below.
struct Slab<'a> {
    first: usize,
    cells: &'a mut [Cells],
    changed: &'a mut [u64],
    below: Below,
}

#[derive(Default)]
struct Below {
    first: usize,
    cells: Vec<Cells>,
    changed: Vec<u64>,
}

impl Slab<'_> {
    #[inline(always)]
    fn at(&self, brick: usize) -> &Cells {
        if brick >= self.first { &self.cells[brick - self.first] } else { &self.below.cells[brick - self.below.first] }
    }

    #[inline(always)]
    fn at_mut(&mut self, brick: usize) -> (&mut Cells, &mut u64) {
        if brick >= self.first {
            (&mut self.cells[brick - self.first], &mut self.changed[brick - self.first])
        } else {
            (&mut self.below.cells[brick - self.below.first], &mut self.below.changed[brick - self.below.first])
        }
    }
}

impl Below {
    /// A copy of bricks, nothing changed in them yet.
    fn copy(cells: &[Cells], range: std::ops::Range<usize>) -> Self {
        Self { first: range.start, cells: cells[range.clone()].to_vec(), changed: vec![0; range.len()] }
    }
}

/// Planes of bricks below a slab that its first plane depends on through the four directions along x and y. In each of
/// these, edges and points build on faces at most one lattice layer lower, and nothing on what is higher: four layers,
/// which is one brick.
const DEPTH: usize = 1;

impl Pass<'_> {
    /// Takes the free pairs of all six directions in some bricks, given in ascending order; adds to `changed` where.
    pub fn run(&self, cells: &mut [Cells], changed: &mut [u64], bricks: &[u32]) {
        self.sideways(cells, changed, bricks);
        self.upright(cells, changed, bricks, Side::Low);
        self.upright(cells, changed, bricks, Side::High);
    }

    /// The four directions along x and y. Each goes through the planes upwards, a plane behind the one before it: so all
    /// work on planes that are still in the cache, and none sees what a later one did.
    fn sideways(&self, cells: &mut [Cells], changed: &mut [u64], bricks: &[u32]) {
        let begins = slabs(self.layout, bricks);
        let plane = self.layout.stride[2];
        let depth = |begin: usize, planes: usize| begin.saturating_sub(planes * plane);
        let copies: Vec<Below> =
            begins.iter().map(|begin| Below::copy(cells, depth(*begin, DEPTH + 1)..*begin)).collect();
        let own = cut(cells, &begins).into_iter().zip(cut(changed, &begins));
        let parts: Vec<_> = own.zip(copies).zip(&begins).collect();
        parts.into_par_iter().for_each(|(((cells, changed), below), begin)| {
            let bricks = part(bricks, depth(*begin, DEPTH)..begin + cells.len());
            let mut slab = Slab { first: *begin, cells, changed, below };
            let planes: Vec<_> = self.groups(bricks, plane).collect();
            for step in 0..planes.len() + 3 {
                let behind = |by: usize| step.checked_sub(by).and_then(|at| planes.get(at)).copied().unwrap_or(&[]);
                self.plane::<0, 1, 2>(&mut slab, behind(0), Side::Low);
                self.plane::<0, 1, 2>(&mut slab, behind(1), Side::High);
                self.plane::<1, 2, 0>(&mut slab, behind(2), Side::Low);
                self.plane::<1, 2, 0>(&mut slab, behind(3), Side::High);
            }
        });
    }

    /// Visits the bricks of one plane in the order a direction along x or y asks for.
    fn plane<const A: usize, const B: usize, const C: usize>(&self, slab: &mut Slab, bricks: &[u32], side: Side) {
        let row = self.layout.stride[1];
        let mut visit = |brick: &u32| self.visit::<A, B, C>(slab, *brick as usize, side);
        match (side, A) {
            (Side::High, _) => bricks.iter().for_each(visit),
            (Side::Low, 0) => self.groups(bricks, row).for_each(|row| row.iter().rev().for_each(&mut visit)),
            (Side::Low, _) => {
                let rows: Vec<_> = self.groups(bricks, row).collect();
                rows.into_iter().rev().for_each(|row| row.iter().for_each(&mut visit));
            }
        }
    }

    /// The directions along z, one at a time.
    fn upright(&self, cells: &mut [Cells], changed: &mut [u64], bricks: &[u32], side: Side) {
        let begins = slabs(self.layout, bricks);
        let plane = self.layout.stride[2];
        let copies: Vec<Below> =
            begins.iter().map(|begin| Below::copy(cells, begin.saturating_sub(plane)..*begin)).collect();
        let own = cut(cells, &begins).into_iter().zip(cut(changed, &begins));
        let parts: Vec<_> = own.zip(copies).zip(&begins).collect();
        let taken: Vec<Below> = parts
            .into_par_iter()
            .map(|(((cells, changed), below), begin)| {
                let bricks = part(bricks, *begin..begin + cells.len());
                let mut slab = Slab { first: *begin, cells, changed, below };
                let visit = |brick: &u32| self.visit::<2, 0, 1>(&mut slab, *brick as usize, side);
                match side {
                    Side::High => bricks.iter().for_each(visit),
                    Side::Low => {
                        let planes: Vec<_> = self.groups(bricks, plane).collect();
                        planes.into_iter().rev().flatten().for_each(visit);
                    }
                }
                slab.below
            })
            .collect();

        // What slabs took from the plane below them.
        for below in taken {
            for (at, (left, marks)) in
                below.cells.iter().zip(&below.changed).enumerate().filter(|(_, (_, marks))| **marks != 0)
            {
                cells[below.first + at].iter_mut().zip(left).for_each(|(cells, left)| *cells &= left);
                changed[below.first + at] |= marks;
            }
        }
    }

    /// Cuts a list of bricks where rows, or planes, of that many bricks end.
    fn groups<'b>(&self, mut bricks: &'b [u32], length: usize) -> impl Iterator<Item = &'b [u32]> + use<'b> {
        let guard = self.layout.guard;
        std::iter::from_fn(move || {
            let first = *bricks.first()? as usize;
            let end = guard + ((first - guard) / length + 1) * length;
            let count = bricks.iter().take_while(|brick| (**brick as usize) < end).count();
            let (group, rest) = bricks.split_at(count);
            bricks = rest;
            Some(group)
        })
    }

    /// Takes the free pairs along axis `A` whose smaller cell lies in a brick; `B` and `C` are the other two axes.
    #[inline(always)]
    fn visit<const A: usize, const B: usize, const C: usize>(&self, slab: &mut Slab, brick: usize, side: Side) {
        let stride = self.layout.stride;
        let below = brick - stride[A];
        let near = if side == Side::Low { HERE } else { HERE | 1 << A };
        if self.near[brick] & near == 0 {
            return;
        }
        // Larger cells without another of their kind on the side they are taken from, at the place of the smaller cell
        // that bounds them there.
        let exposed = |here: &Cells, below: &Cells, plane: usize| {
            let low = from_below::<A>(here[plane], below[plane]);
            here[plane & !(1 << A)] & if side == Side::Low { here[plane] & !low } else { low & !here[plane] }
        };
        let (here, lower) = (slab.at(brick), slab.at(below));
        let free = [
            exposed(here, lower, CUBES),
            exposed(here, lower, across(C)),
            exposed(here, lower, across(B)),
            exposed(here, lower, 1 << A),
        ];
        if free[0] | free[1] | free[2] | free[3] == 0 {
            return;
        }
        let here = *here;
        let beside = [slab.at(brick - stride[B]), slab.at(brick - stride[C])];
        let allowed = |plane: usize| match side {
            Side::Low => self.border[brick][plane],
            Side::High => from_below::<A>(self.border[brick][plane], self.border[below][plane]),
        };
        let kept = match side {
            Side::Low => self.kept[brick][1 + A],
            Side::High => from_below::<A>(self.kept[brick][1 + A], self.kept[below][1 + A]),
        };

        // Cubes, each with its face across the axis; faces, each with an edge that may have two more faces, those just
        // treated; edges, each with a point that may have four more edges, those just treated.
        let faces = free[0] & allowed(CUBES);
        let left = here[across(A)] & !faces;
        let edges = [
            free[1] & allowed(across(C)) & !(left | from_below::<C>(left, beside[1][across(A)])),
            free[2] & allowed(across(B)) & !(left | from_below::<B>(left, beside[0][across(A)])),
        ];
        let (left_b, left_c) = (here[1 << B] & !edges[0], here[1 << C] & !edges[1]);
        let points = free[3]
            & allowed(1 << A)
            & !(kept | self.kept[brick][0])
            & !(left_b | from_below::<B>(left_b, beside[0][1 << B]))
            & !(left_c | from_below::<C>(left_c, beside[1][1 << C]));
        let any = faces | edges[0] | edges[1] | points;
        if any == 0 {
            return;
        }

        let take_large = |cells: &mut Cells, place: fn(u64) -> u64| {
            cells[CUBES] &= !place(faces);
            cells[across(C)] &= !place(edges[0]);
            cells[across(B)] &= !place(edges[1]);
            cells[1 << A] &= !place(points);
        };
        let (cells, changed) = slab.at_mut(brick);
        cells[across(A)] &= !faces;
        cells[1 << B] &= !edges[0];
        cells[1 << C] &= !edges[1];
        cells[0] &= !points;
        *changed |= any;
        match side {
            Side::Low => take_large(cells, |taken| taken),
            Side::High => {
                take_large(cells, |taken| from_above::<A>(taken, 0));
                *changed |= from_above::<A>(any, 0);
                let entered = from_above::<A>(0, any);
                if entered != 0 {
                    let (cells, changed) = slab.at_mut(below);
                    take_large(cells, |taken| from_above::<A>(0, taken));
                    *changed |= entered;
                }
            }
        }
    }
}
