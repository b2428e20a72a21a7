//! How is a complex thinned to curves without changing its topology?
//!
//! A free pair is a cell and the one face of it that bounds no other cell. Taking both out at once changes neither
//! components nor loops nor cavities. Free pairs that lie in the same direction, of the same kind, can all go together, so
//! a layer is peeled off in 24 passes: 6 directions, and in each the cubes, then the faces, then the edges (ParDirCollapse,
//! Chaussard & Couprie 2009). A layer takes only cells of the border as it was when the layer began.
//!
//! Surfaces all go; curves that mean something stay. An edge is born in the layer that takes its last face. There the void
//! was `d` wide around it (its distance) and as wide as `w` beside it (its opening): the ball of `w` goes on for `w - d`
//! layers. An edge that outlives its birth `t` by that much and `t` more belongs to a branch longer than the void is
//! wide and is kept for good (Chaussard, Noël, Biri & Couprie, DGCI 2013, with [`LEAST_LIFE`] added).
//!
//! Work goes with the bricks that change: a brick whose surroundings did not change in one layer changes in none until
//! they do. In a pass each brick reads what the last pass left in it and beside it and writes itself alone, so the result
//! does not depend on order or threads.

use super::complex::{CUBES, Cells, Complex, Layout};
use crate::job::{Cancel, Cancelled, Progress};
use crate::voxel::brick::{self, FIRST, LAST, from_above, from_below};
use crate::voxel::levels::Levels;
use glam::IVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Layers that an edge must outlive its birth by, at least: a curve of a few cells in a void too small to say otherwise
/// is noise. Any value from 0 (the published rule) to 6 gives nearly the same.
const LEAST_LIFE: u32 = 3;

/// Bricks in a piece of work too small to be shared among threads.
const GRAIN: usize = 512;

/// Thins a complex until no free pair is left that may go: no faces, and of its edges and points those that loops, long
/// branches and `anchors` need. `distance` and `opening` are those of the void.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised; the complex is then in between.
pub fn collapse(
    complex: &mut Complex,
    distance: &Levels,
    opening: &Levels,
    anchors: &[IVec3],
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<(), Cancelled> {
    let layout = *complex.layout();
    let mut work = Collapse::new(layout, anchors);
    let cells = complex.cells_mut();
    let all = (0..cells.len()).filter(|brick| cells[*brick][0] != 0);
    let mut candidates: Vec<u32> = all.map(|brick| brick as u32).collect();
    let life = |brick: usize, bit: u32, axis: usize| {
        let corner = layout.corner(brick, bit);
        u32::from(opening.at_edge(corner, axis) - distance.at_edge(corner, axis))
    };

    // For each layer the edges to be kept for good if they still exist when it begins.
    let mut trials: BTreeMap<u32, Vec<Edge>> = BTreeMap::new();
    for now in 0.. {
        cancel.check()?;
        for (edge, life) in work.births(cells, &candidates, life) {
            let until = (life + 2 * now).max(now + LEAST_LIFE);
            trials.entry(until + 1).or_default().push(edge);
        }
        for edge in trials.remove(&now).unwrap_or_default() {
            let brick = edge.brick as usize;
            work.kept[brick][1 + edge.axis as usize] |= cells[brick][1 << edge.axis] & 1 << edge.bit;
        }
        let active = work.border(cells, &candidates);
        for axis in 0..3 {
            for side in [Side::Low, Side::High] {
                match axis {
                    0 => work.peel::<0, 1, 2>(cells, &active, side),
                    1 => work.peel::<1, 2, 0>(cells, &active, side),
                    _ => work.peel::<2, 0, 1>(cells, &active, side),
                }
            }
        }
        candidates = work.spread(&active);
        progress.advance(1);
        if candidates.is_empty() {
            break;
        }
    }
    Ok(())
}

/// From which side a free pair is taken: whether the bounding cell lies at the low or the high end of the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Low,
    High,
}

#[derive(Debug, Clone, Copy)]
struct Edge {
    brick: u32,
    bit: u8,
    axis: u8,
}

/// What a collapse knows of each brick beside its cells.
struct Collapse {
    layout: Layout,
    /// Cubes of the border.
    cubes: Vec<u64>,
    /// Faces of the border, across x, y, z.
    faces: Vec<[u64; 3]>,
    /// Edges of the border, along x, y, z.
    edges: Vec<[u64; 3]>,
    /// Points and edges along x, y, z that stay.
    kept: Vec<[u64; 4]>,
    /// Edges along x, y, z that were born.
    born: Vec<[u64; 3]>,
    /// The smaller cells of the pairs that the current direction takes: faces taken with cubes, edges with faces (of two
    /// kinds), points with edges. Zero in bricks that are not active.
    gone_cubes: Vec<u64>,
    gone_faces: Vec<[u64; 2]>,
    gone_edges: Vec<u64>,
    /// Where a cell of the current layer was taken.
    changed: Vec<u64>,
}

/// Calls `make` with the number of each of the bricks and its places in two arrays. All are in ascending order, so each
/// half of the list owns a part of the arrays, and halves are done side by side.
fn for_each_brick_of_two<T: Send, U: Send>(
    bricks: &[u32],
    first: &mut [T],
    second: &mut [U],
    make: impl Fn(usize, &mut T, &mut U) + Copy + Send + Sync,
) {
    fn part<T: Send, U: Send>(
        bricks: &[u32],
        from: usize,
        first: &mut [T],
        second: &mut [U],
        make: impl Fn(usize, &mut T, &mut U) + Copy + Send + Sync,
    ) {
        if bricks.len() <= GRAIN {
            for brick in bricks.iter().map(|brick| *brick as usize) {
                make(brick, &mut first[brick - from], &mut second[brick - from]);
            }
            return;
        }
        let (low, high) = bricks.split_at(bricks.len() / 2);
        let middle = high[0] as usize;
        let (first_low, first_high) = first.split_at_mut(middle - from);
        let (second_low, second_high) = second.split_at_mut(middle - from);
        rayon::join(
            || part(low, from, first_low, second_low, make),
            || part(high, middle, first_high, second_high, make),
        );
    }
    part(bricks, 0, first, second, make);
}

/// The same with one array.
fn for_each_brick<T: Send>(bricks: &[u32], out: &mut [T], make: impl Fn(usize, &mut T) + Copy + Send + Sync) {
    let mut nothing = vec![(); out.len()];
    for_each_brick_of_two(bricks, out, &mut nothing, |brick, out, ()| make(brick, out));
}

/// The plane of faces across an axis.
const fn across(axis: usize) -> usize {
    CUBES ^ 1 << axis
}

impl Collapse {
    fn new(layout: Layout, anchors: &[IVec3]) -> Self {
        let bricks = layout.len();
        let mut kept = vec![[0; 4]; bricks];
        for (brick, bit) in anchors.iter().filter_map(|corner| layout.place(*corner)) {
            kept[brick][0] |= 1 << bit;
        }
        Self {
            layout,
            cubes: vec![0; bricks],
            faces: vec![[0; 3]; bricks],
            edges: vec![[0; 3]; bricks],
            kept,
            born: vec![[0; 3]; bricks],
            gone_cubes: vec![0; bricks],
            gone_faces: vec![[0; 2]; bricks],
            gone_edges: vec![0; bricks],
            changed: vec![0; bricks],
        }
    }

    /// The edges of some bricks that have lost their last face since the last call, each with its `life`.
    fn births(
        &mut self,
        cells: &[Cells],
        bricks: &[u32],
        life: impl Fn(usize, u32, usize) -> u32 + Sync,
    ) -> Vec<(Edge, u32)> {
        let (born, stride) = (&self.born, self.layout.stride);
        let found: Vec<Vec<(Edge, u32)>> = bricks
            .par_chunks(GRAIN)
            .map(|bricks| {
                let mut found = Vec::new();
                for brick in bricks.iter().map(|brick| *brick as usize) {
                    for (axis, edges) in bare_edges(cells, brick, stride).into_iter().enumerate() {
                        for bit in brick::ones(edges & !born[brick][axis]) {
                            let edge = Edge { brick: brick as u32, bit: bit as u8, axis: axis as u8 };
                            found.push((edge, life(brick, bit, axis)));
                        }
                    }
                }
                found
            })
            .collect();
        let found = found.concat();
        for (edge, _) in &found {
            self.born[edge.brick as usize][edge.axis as usize] |= 1 << edge.bit;
        }
        found
    }

    /// Finds the border in the candidates, and which of them have any of it in them or below: nothing can be taken
    /// elsewhere.
    fn border(&mut self, cells: &[Cells], candidates: &[u32]) -> Vec<u32> {
        let stride = self.layout.stride;
        // Cubes that lack one of their six neighbours.
        for_each_brick(candidates, &mut self.cubes, |brick, border| {
            let cubes = |brick: usize| cells[brick][CUBES];
            let here = cubes(brick);
            *border = here
                & !(from_below::<0>(here, cubes(brick - stride[0]))
                    & from_above::<0>(here, cubes(brick + stride[0]))
                    & from_below::<1>(here, cubes(brick - stride[1]))
                    & from_above::<1>(here, cubes(brick + stride[1]))
                    & from_below::<2>(here, cubes(brick - stride[2]))
                    & from_above::<2>(here, cubes(brick + stride[2])));
        });

        // Their faces, and faces that have an edge to themselves.
        let cubes = &self.cubes;
        for_each_brick(candidates, &mut self.faces, |brick, border| {
            let near = |axis: usize| cubes[brick - stride[axis]];
            let free = free_faces(cells, brick, stride);
            *border = [
                (cubes[brick] | from_below::<0>(cubes[brick], near(0))) | free[0],
                (cubes[brick] | from_below::<1>(cubes[brick], near(1))) | free[1],
                (cubes[brick] | from_below::<2>(cubes[brick], near(2))) | free[2],
            ];
        });

        // Their edges, and edges that have a point to themselves.
        let faces = &self.faces;
        for_each_brick(candidates, &mut self.edges, |brick, border| {
            let [x, y, z] = faces[brick];
            let near = |axis: usize, across: usize| faces[brick - stride[axis]][across];
            let free = free_edges(cells, brick, stride);
            *border = [
                y | from_below::<2>(y, near(2, 1)) | z | from_below::<1>(z, near(1, 2)) | free[0],
                z | from_below::<0>(z, near(0, 2)) | x | from_below::<2>(x, near(2, 0)) | free[1],
                x | from_below::<1>(x, near(1, 0)) | y | from_below::<0>(y, near(0, 1)) | free[2],
            ];
        });
        let any = |brick: usize| {
            let (faces, edges) = (self.faces[brick], self.edges[brick]);
            self.cubes[brick] | faces[0] | faces[1] | faces[2] | edges[0] | edges[1] | edges[2] != 0
        };
        let active = |brick: &&u32| {
            let brick = **brick as usize;
            any(brick) || stride.iter().any(|stride| any(brick - stride))
        };
        candidates.iter().filter(active).copied().collect()
    }

    /// Takes the free pairs along axis `A`; `B` and `C` are the other two.
    fn peel<const A: usize, const B: usize, const C: usize>(
        &mut self,
        cells: &mut [Cells],
        bricks: &[u32],
        side: Side,
    ) {
        let stride = self.layout.stride;
        let (along_a, along_b, along_c) = (stride[A], stride[B], stride[C]);
        // Cells that have no cell of their kind before them on the side they are taken from, at the place of the cell
        // that bounds them there; and a mask of such cells moved to that place.
        let exposed = |here: u64, below: u64| {
            let low = from_below::<A>(here, below);
            if side == Side::Low { here & !low } else { low & !here }
        };
        let moved = |here: u64, below: u64| if side == Side::Low { here } else { from_below::<A>(here, below) };

        let layout = self.layout;
        let Self { cubes, faces, edges, kept, gone_cubes, gone_faces, gone_edges, changed, .. } = self;
        let state: &[Cells] = cells;

        // Cubes, each with its face across the axis.
        for_each_brick(bricks, gone_cubes, |brick, gone| {
            let (here, below) = (&state[brick], &state[brick - along_a]);
            let free = here[across(A)] & exposed(here[CUBES], below[CUBES]);
            *gone = if free == 0 { 0 } else { free & moved(cubes[brick], cubes[brick - along_a]) };
        });

        // Faces, each with its edge across the axis. That edge may have two more faces: those just treated.
        let left = |brick: usize| state[brick][across(A)] & !gone_cubes[brick];
        for_each_brick(bricks, gone_faces, |brick, gone| {
            let (here, below) = (&state[brick], &state[brick - along_a]);
            let free = [
                here[1 << B] & exposed(here[across(C)], below[across(C)]),
                here[1 << C] & exposed(here[across(B)], below[across(B)]),
            ];
            *gone = [0; 2];
            if free != [0; 2] {
                let faces_a = left(brick);
                let border = [faces[brick], faces[brick - along_a]];
                gone[0] = free[0]
                    & !(faces_a | from_below::<C>(faces_a, left(brick - along_c)))
                    & moved(border[0][C], border[1][C]);
                gone[1] = free[1]
                    & !(faces_a | from_below::<B>(faces_a, left(brick - along_b)))
                    & moved(border[0][B], border[1][B]);
            }
        });

        // Edges, each with its point. That point may have four more edges: those just treated.
        let left_b = |brick: usize| state[brick][1 << B] & !gone_faces[brick][0];
        let left_c = |brick: usize| state[brick][1 << C] & !gone_faces[brick][1];
        for_each_brick(bricks, gone_edges, |brick, gone| {
            let (here, below) = (&state[brick], &state[brick - along_a]);
            let free = here[0] & exposed(here[1 << A], below[1 << A]);
            *gone = 0;
            if free != 0 {
                let (edges_b, edges_c) = (left_b(brick), left_c(brick));
                *gone = free
                    & !(edges_b | from_below::<B>(edges_b, left_b(brick - along_b)))
                    & !(edges_c | from_below::<C>(edges_c, left_c(brick - along_c)))
                    & moved(edges[brick][A], edges[brick - along_a][A])
                    & !moved(kept[brick][1 + A], kept[brick - along_a][1 + A])
                    & !kept[brick][0];
            }
        });

        // All go at once; the larger cells of pairs at their high end lie one place lower.
        let gone = |brick: usize| {
            let faces = gone_faces[brick];
            [gone_cubes[brick], faces[0], faces[1], gone_edges[brick]]
        };
        for_each_brick_of_two(bricks, cells, changed, |brick, cells, changed| {
            let small = gone(brick);
            let large = match side {
                Side::Low => small,
                Side::High => {
                    let above = gone(brick + along_a);
                    [0, 1, 2, 3].map(|kind| from_above::<A>(small[kind], above[kind]))
                }
            };
            let any = small[0] | small[1] | small[2] | small[3] | large[0] | large[1] | large[2] | large[3];
            if any != 0 {
                *changed |= any;
                cells[CUBES] &= !large[0];
                cells[across(A)] &= !small[0];
                cells[across(C)] &= !large[1];
                cells[1 << B] &= !small[1];
                cells[across(B)] &= !large[2];
                cells[1 << C] &= !small[2];
                cells[1 << A] &= !large[3];
                cells[0] &= !small[3];
            }
        });
        debug_assert!(
            bricks.iter().all(|brick| layout.holds(*brick as usize)),
            "a brick outside the lattice is active"
        );
    }

    /// The bricks that what was taken in these may concern in the next layer, and an end to this layer.
    fn spread(&mut self, bricks: &[u32]) -> Vec<u32> {
        let stride = self.layout.stride;
        let mut marks = vec![0_u64; self.layout.len().div_ceil(64)];
        for brick in bricks.iter().map(|brick| *brick as usize) {
            self.gone_cubes[brick] = 0;
            self.gone_faces[brick] = [0; 2];
            self.gone_edges[brick] = 0;
            let changed = std::mem::take(&mut self.changed[brick]);
            if changed == 0 {
                continue;
            }
            // What is taken at a place concerns pairs from one place below it to two above, along each axis.
            for (dz, z) in TOUCHED[2].iter().enumerate() {
                let changed = changed & z;
                if changed == 0 {
                    continue;
                }
                for (dy, y) in TOUCHED[1].iter().enumerate() {
                    for (dx, x) in TOUCHED[0].iter().enumerate() {
                        if changed & y & x != 0 {
                            let beside = brick + dx + dy * stride[1] + dz * stride[2] - self.layout.guard;
                            marks[beside / 64] |= 1 << (beside % 64);
                        }
                    }
                }
            }
        }
        let marked = marks.iter().enumerate();
        let bricks = marked.flat_map(|(word, bits)| brick::ones(*bits).map(move |bit| 64 * word as u32 + bit));
        bricks.filter(|brick| self.layout.holds(*brick as usize)).collect()
    }
}

/// For each axis the places of a brick where a change concerns the brick below, itself, and the brick above.
const TOUCHED: [[u64; 3]; 3] = [
    [FIRST[0], !0, LAST[0] | LAST[0] >> 1],
    [FIRST[1], !0, LAST[1] | LAST[1] >> 4],
    [FIRST[2], !0, LAST[2] | LAST[2] >> 16],
];

/// The edges along x, y, z of a brick without a face.
fn bare_edges(cells: &[Cells], brick: usize, stride: [usize; 3]) -> [u64; 3] {
    let (here, near) = (&cells[brick], stride.map(|stride| &cells[brick - stride]));
    [
        here[1] & !(here[3] | here[5] | from_below::<1>(here[3], near[1][3]) | from_below::<2>(here[5], near[2][5])),
        here[2] & !(here[6] | here[3] | from_below::<2>(here[6], near[2][6]) | from_below::<0>(here[3], near[0][3])),
        here[4] & !(here[5] | here[6] | from_below::<0>(here[5], near[0][5]) | from_below::<1>(here[6], near[1][6])),
    ]
}

/// The faces across x, y, z of a brick that have an edge to themselves.
fn free_faces(cells: &[Cells], brick: usize, stride: [usize; 3]) -> [u64; 3] {
    let (cubes, near) = (cells[brick][CUBES], stride.map(|stride| cells[brick - stride][CUBES]));
    // A face with a cube shares each of its edges with another face of the cube.
    let bare = [
        cells[brick][across(0)] & !cubes & !from_below::<0>(cubes, near[0]),
        cells[brick][across(1)] & !cubes & !from_below::<1>(cubes, near[1]),
        cells[brick][across(2)] & !cubes & !from_below::<2>(cubes, near[2]),
    ];
    [
        if bare[0] == 0 { 0 } else { bare[0] & with_own_edge::<0, 1, 2>(cells, brick, stride) },
        if bare[1] == 0 { 0 } else { bare[1] & with_own_edge::<1, 2, 0>(cells, brick, stride) },
        if bare[2] == 0 { 0 } else { bare[2] & with_own_edge::<2, 0, 1>(cells, brick, stride) },
    ]
}

/// Where a face across axis `N` would have an edge that bounds nothing else; `A` and `B` are the axes it spans.
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

/// The edges along x, y, z of a brick that have a point to themselves.
fn free_edges(cells: &[Cells], brick: usize, stride: [usize; 3]) -> [u64; 3] {
    let bare = bare_edges(cells, brick, stride);
    [
        if bare[0] == 0 { 0 } else { bare[0] & with_own_point::<0, 1, 2>(cells, brick, stride) },
        if bare[1] == 0 { 0 } else { bare[1] & with_own_point::<1, 2, 0>(cells, brick, stride) },
        if bare[2] == 0 { 0 } else { bare[2] & with_own_point::<2, 0, 1>(cells, brick, stride) },
    ]
}

/// Where an edge along axis `A` would have a point that bounds nothing else.
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

#[cfg(test)]
mod tests;
