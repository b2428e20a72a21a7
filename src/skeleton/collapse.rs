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
//! wide and is kept for good (Chaussard, Noël, Biri & Couprie, DGCI 2013, with [`Filter::least_life_layers`] added).
//!
//! Work goes with the bricks that change: a brick whose surroundings did not change in one layer changes in none until
//! they do. The passes of a direction are done together, brick by brick, in the order in which that comes to the same as
//! one pass after another: away from the side that pairs are taken from, upwards along the other two axes (see `peel`).
//! Threads take slabs of bricks each; where two slabs meet, the upper one works out for itself what the lower one will
//! leave. So the result does not depend on threads.

mod border;
mod peel;

use super::complex::{Complex, Layout};
use super::filter::Filter;
use crate::job::{Cancel, Cancelled, Progress};
use crate::voxel::brick::{self, FIRST, LAST};
use crate::voxel::levels::Levels;
use border::Border;
use glam::IVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Fewer bricks than this are not worth sharing with another thread.
const GRAIN: usize = 512;

/// Thins a complex until no free pair is left that may go: no faces, and of its edges and points those that loops, long
/// branches and `anchors` need. `distance` and `opening` are those of the void.
///
/// Cost: for each layer seven visits to each brick whose surroundings changed; 16 words a brick beside the complex.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised; the complex is then in between.
pub fn collapse(
    complex: &mut Complex,
    distance: &Levels,
    opening: &Levels,
    anchors: &[IVec3],
    filter: &Filter,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<(), Cancelled> {
    let layout = *complex.layout();
    let cells = complex.cells_mut();
    let mut border = Border::new(&layout);
    let mut changed = vec![0; layout.count()];
    let mut kept = vec![[0; 4]; layout.count()];
    for (brick, bit) in anchors.iter().filter_map(|corner| layout.place(*corner)) {
        kept[brick][0] |= 1 << bit;
    }
    let all = cells.par_iter().enumerate().filter(|(_, cells)| cells[0] != 0);
    let mut candidates: Vec<u32> = all.map(|(brick, _)| brick as u32).collect();

    // For each layer the edges to be kept for good if they still exist when it begins.
    let mut trials: BTreeMap<u32, Vec<(u32, usize, u64)>> = BTreeMap::new();
    for now in 0.. {
        cancel.check()?;
        for (brick, axis, bit) in trials.remove(&now).unwrap_or_default() {
            kept[brick as usize][1 + axis] |= cells[brick as usize][1 << axis] & bit;
        }
        let news = border.update(&layout, cells, &candidates, |(brick, axis, bit)| {
            let corner = layout.corner(brick as usize, bit);
            let life = opening.at_edge(corner, axis) - distance.at_edge(corner, axis);
            let until = (u32::from(life) + 2 * now).max(now + filter.least_life_layers);
            (until + 1, (brick, axis, 1 << bit))
        });
        let mut active = Vec::with_capacity(candidates.len());
        for news in news {
            active.extend(news.active);
            for (layer, edge) in news.births {
                trials.entry(layer).or_default().push(edge);
            }
        }
        let pass = peel::Pass { layout: &layout, border: border.cells(), near: border.near(), kept: &kept };
        pass.run(cells, &mut changed, &active);
        candidates = spread(&layout, &mut changed, &active);
        progress.advance(1);
        if candidates.is_empty() {
            break;
        }
    }
    Ok(())
}

/// Where slabs of whole planes of bricks may begin, so that each has about as many of the given bricks; the first begins at
/// 0. One for each thread, fewer for little work.
fn slabs(layout: &Layout, bricks: &[u32]) -> Vec<usize> {
    let count = rayon::current_num_threads().min(bricks.len() / GRAIN).max(1);
    let plane = layout.stride[2];
    let begin =
        |slab: usize| layout.guard + (bricks[slab * bricks.len() / count] as usize - layout.guard) / plane * plane;
    let mut begins: Vec<usize> = std::iter::once(0).chain((1..count).map(begin)).collect();
    begins.dedup();
    begins
}

/// The part of some bricks, in ascending order, that lies in a range.
fn part(bricks: &[u32], range: std::ops::Range<usize>) -> &[u32] {
    let place = |brick: usize| bricks.partition_point(|other| (*other as usize) < brick);
    &bricks[place(range.start)..place(range.end)]
}

/// Cuts an array at the beginnings of slabs.
fn cut<'a, T>(mut array: &'a mut [T], begins: &[usize]) -> Vec<&'a mut [T]> {
    let mut parts = Vec::new();
    for pair in begins.windows(2) {
        let (part, rest) = array.split_at_mut(pair[1] - pair[0]);
        parts.push(part);
        array = rest;
    }
    parts.push(array);
    parts
}

/// The bricks that what was taken in and below these may concern in the next layer. Clears what it reads.
fn spread(layout: &Layout, changed: &mut [u64], bricks: &[u32]) -> Vec<u32> {
    let begins = slabs(layout, bricks);
    let parts: Vec<_> = cut(changed, &begins).into_iter().zip(&begins).collect();
    let marks = parts.into_par_iter().map(|(changed, begin)| {
        let mut marks = vec![0_u64; layout.count().div_ceil(64)];
        for brick in part(bricks, *begin..begin + changed.len()).iter().map(|brick| *brick as usize) {
            mark(layout, std::mem::take(&mut changed[brick - begin]), brick, &mut marks);
        }
        marks
    });
    let marks: Vec<Vec<u64>> = marks.collect();
    let mut concerned = Vec::with_capacity(2 * bricks.len());
    for word in 0..layout.count().div_ceil(64) {
        let bits = marks.iter().fold(0, |bits, marks| bits | marks[word]);
        concerned.extend(brick::ones(bits).map(|bit| 64 * word as u32 + bit));
    }
    concerned.retain(|brick| layout.holds(*brick as usize));
    concerned
}

/// Marks the bricks that what was taken in one may concern. What is taken at a place concerns pairs from one place below it
/// to two above, along each axis.
fn mark(layout: &Layout, changed: u64, brick: usize, marks: &mut [u64]) {
    if changed == 0 {
        return;
    }
    let stride = layout.stride;
    for (dz, z) in TOUCHED[2].iter().enumerate().filter(|(_, z)| changed & **z != 0) {
        for (dy, y) in TOUCHED[1].iter().enumerate().filter(|(_, y)| changed & z & **y != 0) {
            for (dx, _) in TOUCHED[0].iter().enumerate().filter(|(_, x)| changed & z & y & **x != 0) {
                let beside = brick + dx + dy * stride[1] + dz * stride[2] - layout.guard;
                marks[beside / 64] |= 1 << (beside % 64);
            }
        }
    }
}

/// For each axis the places of a brick where a change concerns the brick below, itself, and the brick above.
const TOUCHED: [[u64; 3]; 3] = [
    [FIRST[0], !0, LAST[0] | LAST[0] >> 1],
    [FIRST[1], !0, LAST[1] | LAST[1] >> 4],
    [FIRST[2], !0, LAST[2] | LAST[2] >> 16],
];

#[cfg(test)]
mod tests;
