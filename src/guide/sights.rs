//! What does each patch see along the lines?
//!
//! A line between two walls is a sight of either; glazing on it sees both ways too. The weights of a patch's sights add up to
//! all that it sees ([`Exchange::seen_m2`](crate::flow::network::exchange::Exchange::seen_m2)), so that the mean of any
//! quantity over its hemisphere by the cosine is the mean over its sights by their weight.

use crate::flow::network::lines::Line;
use crate::flow::network::read::seen_from;
use crate::flow::network::walk::End;
use glam::Vec3;

/// What a point of a patch sees in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// The patch.
    pub patch: u32,
    /// The point on it, metres.
    pub from_m: Vec3,
    /// Its unit normal there.
    pub normal: Vec3,
    /// Where it looks, unit length.
    pub direction: Vec3,
    /// How far it sees, through glazing, metres.
    pub distance_m: f32,
    /// What stands there.
    pub far: End,
    /// Pi times the radiance that walls and panes send back, W/m2.
    pub radiosity_w_m2: f64,
    /// Area times solid angle times cosine that it stands for, over pi, m2.
    pub weight_m2: f64,
}

impl Sight {
    /// The cosine between normal and direction, 0 at least.
    pub fn cosine(&self) -> f32 {
        self.normal.dot(self.direction).max(0.0)
    }
}

/// The sights of a line: of its ends and of the two sides of each pane on it, where these are patches.
pub fn sights<'a>(line: &'a Line, radiosity_w_m2: &'a [f64]) -> impl Iterator<Item = Sight> + 'a {
    let panes = line.panes.len();
    let ahead = |patch: u32, at_m: f32, normal: Vec3, panes_before: usize| Sight {
        patch,
        from_m: line.from_m + at_m * line.direction,
        normal,
        direction: line.direction,
        distance_m: line.length_m - at_m,
        far: line.ends[1],
        radiosity_w_m2: seen_from(line, panes_before, radiosity_w_m2)[1],
        weight_m2: line.weight_m2,
    };
    let behind = |patch: u32, at_m: f32, normal: Vec3, panes_before: usize| Sight {
        patch,
        from_m: line.from_m + at_m * line.direction,
        normal,
        direction: -line.direction,
        distance_m: at_m,
        far: line.ends[0],
        radiosity_w_m2: seen_from(line, panes_before, radiosity_w_m2)[0],
        weight_m2: line.weight_m2,
    };
    let of_patch = |end: End| if let End::Patch(patch) = end { Some(patch) } else { None };

    let first = of_patch(line.ends[0]).map(|patch| ahead(patch, 0.0, line.normals[0], 0));
    let last = of_patch(line.ends[1]).map(|patch| behind(patch, line.length_m, line.normals[1], panes));
    let between = line.panes.iter().enumerate().flat_map(move |(number, pane)| {
        let at_m = (pane.at.position_m - line.from_m).dot(line.direction);
        // The side that faces what comes after it.
        let onwards = pane.at.normal * pane.at.normal.dot(line.direction).signum();
        [behind(pane.sides[0], at_m, -onwards, number), ahead(pane.sides[1], at_m, onwards, number + 1)]
    });
    first.into_iter().chain(between).chain(last)
}
