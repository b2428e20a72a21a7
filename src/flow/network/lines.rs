//! How much does each patch see of each other?
//!
//! By lines: from each patch by the cosine, and through each neck evenly and by the cosine, both ways, for what is seen
//! through a small neck would be met by few lines from walls. A line between two walls could have started on either, or in
//! any neck that it crosses; it counts with one over the sum of the densities of all these (the balance heuristic, Veach &
//! Guibas 1995), so `X_ij`, the sum over the lines between patches i and j, is an unbiased estimate of `A_i F_ij`, and
//! symmetric.
//!
//! Glazing lies on a line, not at its end: both its sides see what is before them, and what is beyond sees through it by its
//! transmittance. A line whose end lies in matter or in a crevice that the voxels close says nothing and is left out.

use super::patches::{Patches, Start};
use super::portals::Portal;
use super::walk::{End, Pane, Walk, walk};
use super::{Grounds, Quality};
use crate::flow::sequence;
use glam::Vec3;
use rayon::prelude::*;

/// Lines traced by a thread in a row.
const CHUNK: usize = 256;

/// Offsets of the sequences that place lines in necks start here, those of patches at 0.
const NECK_OFFSETS: u64 = 1 << 40;

/// A line between two ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// What stands at both ends.
    pub ends: [End; 2],
    /// Where it begins, metres; outside, where it leaves the void's surroundings.
    pub from_m: Vec3,
    /// Its unit direction, from the first end to the second.
    pub direction: Vec3,
    /// Unit normals of what stands at both ends, on the line's side; along the line where that is nothing.
    pub normals: [Vec3; 2],
    /// Its length, metres; of one that leaves the scene as far as the scene reaches.
    pub length_m: f32,
    /// Glazing on it, in order.
    pub panes: Vec<Pane>,
    /// One over the density of all ways to draw it, m2.
    pub weight_m2: f64,
    /// One of two halves of all lines, each of which is an exchange of its own.
    pub odd: bool,
}

/// Traces the lines of a network. In the order of their starts, whatever the number of threads.
pub fn lines(grounds: &Grounds, quality: &Quality, seed: u64) -> Vec<Line> {
    let patches = &grounds.patches;
    let from_patch = |patch: usize| {
        let starts = patches.list[patch].starts.clone();
        let offset = sequence::offset(seed, patch as u64);
        starts.enumerate().filter_map(move |(number, start)| {
            let direction =
                sequence::cosine_about(patches.starts[start].normal, sequence::square(number as u32, offset));
            from_wall(grounds, patch as u32, &patches.starts[start], direction, number)
        })
    };
    let in_neck = |number: usize| {
        let (portal, index) = (number / quality.neck_lines as usize, number % quality.neck_lines as usize);
        let portal_of = &grounds.portals[portal];
        let [one, other] = [0, 1].map(|part| sequence::offset(seed, NECK_OFFSETS + 2 * portal as u64 + part));
        let at_m = portal_of.point_m(index as u32, quality.neck_lines, one);
        let direction = sequence::cosine_about(portal_of.normal, sequence::square(index as u32, other));
        through(grounds, at_m, direction, index)
    };
    let mut all: Vec<Line> =
        (0..patches.list.len()).into_par_iter().with_min_len(8).flat_map_iter(from_patch).collect();
    let through_necks: Vec<Line> = (0..grounds.portals.len() * quality.neck_lines as usize)
        .into_par_iter()
        .with_min_len(CHUNK)
        .filter_map(in_neck)
        .collect();
    all.extend(through_necks);
    let neck_lines = f64::from(quality.neck_lines);
    all.par_iter_mut()
        .for_each(|line| line.weight_m2 = 1.0 / density_per_m2(patches, &grounds.portals, neck_lines, line));
    all
}

/// A line from a wall; from a pane it runs to both sides.
fn from_wall(grounds: &Grounds, patch: u32, start: &Start, direction: Vec3, number: usize) -> Option<Line> {
    let lift_m = start.normal * grounds.model.rays.epsilon_m();
    let ahead = walk(grounds, start.position_m + lift_m, direction)?;
    let odd = number % 2 == 1;
    if start.answer.passes <= 0.0 {
        let Walk { end, at, panes, length_m } = ahead;
        let (ends, normals) = ([End::Patch(patch), end], [start.normal, at.normal]);
        return Some(Line { ends, from_m: start.position_m, direction, normals, length_m, panes, weight_m2: 0.0, odd });
    }
    let behind = walk(grounds, start.position_m - lift_m, -direction)?;
    let other = Start { normal: -start.normal, ..*start };
    let sides = [grounds.patch_at(&other, -direction, 0.0)?, patch];
    let pane = Pane { sides, at: Start { normal: -start.normal, ..*start } };
    Some(joined(start.position_m, direction, behind, Some(pane), ahead, odd))
}

/// A line through a point of a neck, to both sides.
fn through(grounds: &Grounds, at_m: Vec3, direction: Vec3, number: usize) -> Option<Line> {
    let [ahead, behind] = [direction, -direction].map(|direction| walk(grounds, at_m, direction));
    Some(joined(at_m, direction, behind?, None, ahead?, number % 2 == 1))
}

fn joined(at_m: Vec3, direction: Vec3, behind: Walk, pane: Option<Pane>, ahead: Walk, odd: bool) -> Line {
    let turned = behind.panes.iter().rev().map(|pane| Pane { sides: [pane.sides[1], pane.sides[0]], ..*pane });
    Line {
        ends: [behind.end, ahead.end],
        from_m: at_m - behind.length_m * direction,
        direction,
        normals: [behind.at.normal, ahead.at.normal],
        length_m: behind.length_m + ahead.length_m,
        panes: turned.chain(pane).chain(ahead.panes.iter().copied()).collect(),
        weight_m2: 0.0,
        odd,
    }
}

/// How densely lines like this one are drawn, per m2: from its ends, from panes on it, in the necks it crosses.
fn density_per_m2(patches: &Patches, portals: &[Portal], neck_lines: f64, line: &Line) -> f64 {
    let of_patch = |patch: u32| patches.list.get(patch as usize).map_or(0.0, |patch| patch.lines_per_m2);
    let of_end = |end: &End| if let End::Patch(patch) = *end { of_patch(patch) } else { 0.0 };
    let at_ends: f64 = line.ends.iter().map(of_end).sum();
    let at_panes: f64 = line.panes.iter().flat_map(|pane| pane.sides).map(of_patch).sum();
    let crossed = portals.iter().filter(|portal| portal.crossing(line.from_m, line.direction, line.length_m).is_some());
    let in_necks: f64 = crossed.map(|portal| neck_lines / portal.area_m2).sum();
    at_ends + at_panes + in_necks
}
