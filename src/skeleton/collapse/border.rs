//! Which cells may go in a layer?
//!
//! The border of a complex: cubes that lack one of their six neighbours, with their faces and edges; faces that have an
//! edge to themselves, with their edges; edges that have a point to themselves. It is found anew for the bricks that
//! changes may concern, and stays as it is while a layer is taken off.

use super::{cut, part, slabs};
use crate::skeleton::complex::{CUBES, Cells, Layout, across};
use crate::voxel::brick::{self, from_above, from_below};
use rayon::prelude::*;

/// The border, and which edges have lost their last face so far.
pub struct Border {
    /// The cells of the border by the axes they span; there are no points.
    cells: Vec<Cells>,
    /// Edges along x, y, z without a face.
    born: Vec<[u64; 3]>,
    /// See [`Border::near`].
    near: Vec<u8>,
}

/// An edge: its brick, its axis and its bit.
pub type Edge = (u32, usize, u32);

/// What finding the border anew brought to light, of one slab.
pub struct News<T> {
    /// What the caller made of the edges that have lost their last face since the last call.
    pub births: Vec<T>,
    /// Those of the candidates that have any border in or below them: nothing can be taken elsewhere.
    pub active: Vec<u32>,
}

impl Border {
    /// None so far.
    pub fn new(layout: &Layout) -> Self {
        Self { cells: vec![[0; 8]; layout.count()], born: vec![[0; 3]; layout.count()], near: vec![0; layout.count()] }
    }

    /// The cells of the border, by brick and the axes they span.
    pub fn cells(&self) -> &[Cells] {
        &self.cells
    }

    /// Finds the border in the candidates anew; gives what is new, slab after slab, with `birth` of each edge born.
    pub fn update<T: Send>(
        &mut self,
        layout: &Layout,
        cells: &[Cells],
        candidates: &[u32],
        birth: impl Fn(Edge) -> T + Sync,
    ) -> Vec<News<T>> {
        let begins = slabs(layout, candidates);
        let plane = layout.stride[2];
        // The border of a brick builds on that of the bricks below it: on that of the plane below for one lattice layer,
        // and there on nothing lower. So a slab begins a plane early, on a copy.
        let copies: Vec<Vec<Cells>> =
            begins.iter().map(|begin| self.cells[begin.saturating_sub(plane)..*begin].to_vec()).collect();
        let others = cut(&mut self.born, &begins).into_iter().zip(cut(&mut self.near, &begins));
        let own = cut(&mut self.cells, &begins).into_iter().zip(others);
        let mut parts: Vec<_> = own.zip(copies).zip(&begins).collect();
        let news = parts.par_iter_mut().map(|(((own, (born, near)), copy), begin)| {
            let (begin, early) = (**begin, **begin - copy.len());
            for brick in part(candidates, early..begin).iter().map(|brick| *brick as usize) {
                let bare = bare_edges(cells, brick, layout.stride);
                let lower =
                    |axis: usize| copy.get((brick - layout.stride[axis]).wrapping_sub(early)).unwrap_or(&[0; 8]);
                let found = border_of(cells, brick, layout.stride, [lower(0), lower(1), lower(2)], bare);
                copy[brick - early] = found;
            }
            let mut news = News { births: Vec::new(), active: Vec::new() };
            for brick in part(candidates, begin..begin + own.len()).iter().map(|brick| *brick as usize) {
                let bare = bare_edges(cells, brick, layout.stride);
                let below = |axis: usize| brick - layout.stride[axis];
                let lower = |axis: usize| {
                    let below = below(axis);
                    if below >= begin { &own[below - begin] } else { &copy[below - early] }
                };
                let found = border_of(cells, brick, layout.stride, [lower(0), lower(1), lower(2)], bare);
                own[brick - begin] = found;
                let in_lower = |axis: usize| match below(axis) {
                    below if below >= begin => near[below - begin] & HERE != 0,
                    below => !is_empty(&copy[below - early]),
                };
                let here = if is_empty(&found) { 0 } else { HERE };
                let around = here | u8::from(in_lower(0)) | u8::from(in_lower(1)) << 1 | u8::from(in_lower(2)) << 2;
                near[brick - begin] = around;
                if around != 0 {
                    news.active.push(brick as u32);
                }
                if bare[0] | bare[1] | bare[2] == 0 {
                    continue;
                }
                for (axis, born) in born[brick - begin].iter_mut().enumerate() {
                    news.births.extend(brick::ones(bare[axis] & !*born).map(|bit| birth((brick as u32, axis, bit))));
                    *born |= bare[axis];
                }
            }
            news
        });
        news.collect()
    }

    /// For each active brick whether there is border in it ([`HERE`]), and in the bricks below it along x, y, z (bits 0,
    /// 1, 2).
    pub fn near(&self) -> &[u8] {
        &self.near
    }
}

/// There is border in the brick itself.
pub const HERE: u8 = 8;

/// Whether a brick has no cells.
#[inline(always)]
fn is_empty(cells: &Cells) -> bool {
    cells.iter().fold(0, |any, word| any | word) == 0
}

/// The border in a brick; `lower` is that in the bricks below it along x, y, z, `bare` its edges without a face.
#[inline(always)]
fn border_of(cells: &[Cells], brick: usize, stride: [usize; 3], lower: [&Cells; 3], bare: [u64; 3]) -> Cells {
    let here = cells[brick][CUBES];
    let near = |brick: usize| cells[brick][CUBES];
    let cubes = here
        & !(from_below::<0>(here, near(brick - stride[0]))
            & from_above::<0>(here, near(brick + stride[0]))
            & from_below::<1>(here, near(brick - stride[1]))
            & from_above::<1>(here, near(brick + stride[1]))
            & from_below::<2>(here, near(brick - stride[2]))
            & from_above::<2>(here, near(brick + stride[2])));
    let free = free_faces(cells, brick, stride);
    let x = cubes | from_below::<0>(cubes, lower[0][CUBES]) | free[0];
    let y = cubes | from_below::<1>(cubes, lower[1][CUBES]) | free[1];
    let z = cubes | from_below::<2>(cubes, lower[2][CUBES]) | free[2];
    let free = free_edges(cells, brick, stride, bare);
    let along_x = y | from_below::<2>(y, lower[2][across(1)]) | z | from_below::<1>(z, lower[1][across(2)]) | free[0];
    let along_y = z | from_below::<0>(z, lower[0][across(2)]) | x | from_below::<2>(x, lower[2][across(0)]) | free[1];
    let along_z = x | from_below::<1>(x, lower[1][across(0)]) | y | from_below::<0>(y, lower[0][across(1)]) | free[2];
    [0, along_x, along_y, z, along_z, y, x, cubes]
}

/// The edges along x, y, z of a brick without a face.
#[inline(always)]
fn bare_edges(cells: &[Cells], brick: usize, stride: [usize; 3]) -> [u64; 3] {
    let here = &cells[brick];
    // Most bricks have no edge without a face in them alone; then those beside need no look.
    let alone = [here[1] & !(here[3] | here[5]), here[2] & !(here[6] | here[3]), here[4] & !(here[5] | here[6])];
    if alone[0] | alone[1] | alone[2] == 0 {
        return alone;
    }
    let (x, y, z) = (&cells[brick - stride[0]], &cells[brick - stride[1]], &cells[brick - stride[2]]);
    [
        alone[0] & !(from_below::<1>(here[3], y[3]) | from_below::<2>(here[5], z[5])),
        alone[1] & !(from_below::<2>(here[6], z[6]) | from_below::<0>(here[3], x[3])),
        alone[2] & !(from_below::<0>(here[5], x[5]) | from_below::<1>(here[6], y[6])),
    ]
}

/// The faces across x, y, z of a brick that have an edge to themselves.
#[inline(always)]
fn free_faces(cells: &[Cells], brick: usize, stride: [usize; 3]) -> [u64; 3] {
    let cubes = cells[brick][CUBES];
    let near = |axis: usize| cells[brick - stride[axis]][CUBES];
    // A face with a cube shares each of its edges with another face of the cube.
    let bare = [
        cells[brick][across(0)] & !cubes & !from_below::<0>(cubes, near(0)),
        cells[brick][across(1)] & !cubes & !from_below::<1>(cubes, near(1)),
        cells[brick][across(2)] & !cubes & !from_below::<2>(cubes, near(2)),
    ];
    [
        if bare[0] == 0 { 0 } else { bare[0] & with_own_edge::<0, 1, 2>(cells, brick, stride) },
        if bare[1] == 0 { 0 } else { bare[1] & with_own_edge::<1, 2, 0>(cells, brick, stride) },
        if bare[2] == 0 { 0 } else { bare[2] & with_own_edge::<2, 0, 1>(cells, brick, stride) },
    ]
}

/// Where a face across axis `N` would have an edge that bounds nothing else; `A` and `B` are the axes it spans.
#[inline(never)]
fn with_own_edge<const N: usize, const A: usize, const B: usize>(
    cells: &[Cells],
    brick: usize,
    stride: [usize; 3],
) -> u64 {
    // The other faces of an edge along A: those beside this face along B, and the two across B.
    let faces = |brick: usize| cells[brick][across(N)];
    let pair = |brick: usize, plane: usize| {
        let here = cells[brick][plane];
        here | from_below::<N>(here, cells[brick - stride[N]][plane])
    };
    let (here, across_b, across_a) = (faces(brick), pair(brick, across(B)), pair(brick, across(A)));
    let (up_a, up_b) = (brick + stride[A], brick + stride[B]);
    let shared = [
        from_below::<B>(here, faces(brick - stride[B])) | across_b,
        from_above::<B>(here, faces(up_b)) | from_above::<B>(across_b, pair(up_b, across(B))),
        from_below::<A>(here, faces(brick - stride[A])) | across_a,
        from_above::<A>(here, faces(up_a)) | from_above::<A>(across_a, pair(up_a, across(A))),
    ];
    !(shared[0] & shared[1] & shared[2] & shared[3])
}

/// The edges along x, y, z of a brick that have a point to themselves, from those without a face.
#[inline(always)]
fn free_edges(cells: &[Cells], brick: usize, stride: [usize; 3], bare: [u64; 3]) -> [u64; 3] {
    [
        if bare[0] == 0 { 0 } else { bare[0] & with_own_point::<0, 1, 2>(cells, brick, stride) },
        if bare[1] == 0 { 0 } else { bare[1] & with_own_point::<1, 2, 0>(cells, brick, stride) },
        if bare[2] == 0 { 0 } else { bare[2] & with_own_point::<2, 0, 1>(cells, brick, stride) },
    ]
}

/// Where an edge along axis `A` would have a point that bounds nothing else.
#[inline(never)]
fn with_own_point<const A: usize, const B: usize, const C: usize>(
    cells: &[Cells],
    brick: usize,
    stride: [usize; 3],
) -> u64 {
    let edges = |brick: usize| cells[brick][1 << A];
    let beside = |brick: usize| {
        let (b, c) = (cells[brick][1 << B], cells[brick][1 << C]);
        b | from_below::<B>(b, cells[brick - stride[B]][1 << B])
            | c
            | from_below::<C>(c, cells[brick - stride[C]][1 << C])
    };
    let (here, around, up) = (edges(brick), beside(brick), brick + stride[A]);
    let low = from_below::<A>(here, edges(brick - stride[A])) | around;
    let high = from_above::<A>(here, edges(up)) | from_above::<A>(around, beside(up));
    !(low & high)
}
