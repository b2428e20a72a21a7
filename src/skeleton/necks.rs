//! Where are the doorways, and how large are they?
//!
//! Every edge between two cells crosses a neck. Edges between the same two cells whose sections lie in one another cross
//! the same one: a wide opening is crossed by several strands. A neck's plane is that of its narrowest section, turned
//! until its area is least, because the curve seldom runs square through a door.

use super::cells::Widths;
use super::matter::Matter;
use super::sections::Section;
use glam::Vec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A doorway: the narrowest section between two cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Neck {
    /// The two cells it joins, the lower number first.
    pub cells: [u32; 2],
    /// The middle of its section, metres.
    pub position_m: Vec3,
    /// Unit normal, from the first cell to the second.
    pub normal: Vec3,
    /// Its area, m2.
    pub area_m2: f32,
    /// The point its border was felt from, in its plane, metres; every point of the border is in sight of it.
    pub centre_m: Vec3,
    /// Its border, in its plane, around the centre, metres.
    pub outline_m: Vec<Vec3>,
}

/// Rays across a neck: a 0.9 x 2.1 m door comes out to 1%.
const RAYS: usize = 64;

/// Rays while its plane is turned; the fan's noise must stay under the gain that is looked for.
const TURN_RAYS: usize = 64;

/// Turns that are tried one after the other, radians; each to eight sides.
const TURNS_RAD: [f32; 5] = [0.35, 0.35, 0.17, 0.17, 0.09];

/// A turn must make the section less than this share of what it was; less is the fan's own noise.
const TURN_GAIN: f32 = 0.99;

/// Two sections further apart than this share of the narrower one's width are two necks in a row, not one.
const SAME_WITHIN: f32 = 0.7;

/// The necks between cells, and for each edge the neck it crosses. `directions` are those of the edges. The necks are in
/// the order of their cells, then of their first edge.
pub(super) fn necks(
    matter: &Matter,
    widths: &Widths,
    directions: &[Vec3],
    cell_of: &[u32],
) -> (Vec<Neck>, Vec<Option<u32>>) {
    let mut between: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for (edge, ends) in widths.edges.iter().enumerate() {
        let [a, b] = ends.map(|end| cell_of[end as usize]);
        if a != b {
            between.entry([a.min(b), a.max(b)]).or_default().push(edge as u32);
        }
    }
    let between: Vec<([u32; 2], Vec<u32>)> = between.into_iter().collect();
    let found: Vec<Vec<(Neck, Vec<u32>)>> = between
        .par_iter()
        .map(|(cells, edges)| {
            let groups = grouped(matter, widths, directions, edges);
            groups.into_iter().map(|edges| (neck(matter, widths, directions, cell_of, *cells, &edges), edges)).collect()
        })
        .collect();

    let mut neck_of = vec![None; widths.edges.len()];
    let mut necks = Vec::new();
    for (neck, edges) in found.into_iter().flatten() {
        for edge in edges {
            neck_of[edge as usize] = Some(necks.len() as u32);
        }
        necks.push(neck);
    }
    (necks, neck_of)
}

/// The edges between two cells, those through one opening together, the narrowest first in each.
fn grouped(matter: &Matter, widths: &Widths, directions: &[Vec3], edges: &[u32]) -> Vec<Vec<u32>> {
    if let [_] = edges {
        return vec![edges.to_vec()];
    }
    let mut narrowest: Vec<u32> = edges.to_vec();
    narrowest.sort_by(|a, b| {
        let [a_m2, b_m2] = [a, b].map(|edge| widths.sections_m2[*edge as usize]);
        a_m2.total_cmp(&b_m2).then(a.cmp(b))
    });
    let mut groups: Vec<(Section, Vec<u32>)> = Vec::new();
    for edge in narrowest {
        let middle_m = widths.middles_m[edge as usize];
        let same = groups.iter_mut().find(|(section, _)| {
            let apart_m = (middle_m - section.centre_m).dot(section.normal).abs();
            apart_m < SAME_WITHIN * section.area_m2.sqrt() && section.covers(middle_m)
        });
        match same {
            Some((_, edges)) => edges.push(edge),
            None => {
                let section = Section::new(matter, middle_m, directions[edge as usize], RAYS);
                groups.push((section, vec![edge]));
            }
        }
    }
    groups.sort_by_key(|(_, edges)| edges.iter().min().copied());
    groups.into_iter().map(|(_, edges)| edges).collect()
}

/// The neck that some edges cross, the first of them at its narrowest.
fn neck(
    matter: &Matter,
    widths: &Widths,
    directions: &[Vec3],
    cell_of: &[u32],
    cells: [u32; 2],
    edges: &[u32],
) -> Neck {
    let edge = edges[0] as usize;
    let centre_m = widths.middles_m[edge];
    let forwards = cell_of[widths.edges[edge][0] as usize] == cells[0];
    let along = if forwards { directions[edge] } else { -directions[edge] };
    let normal = turned(matter, centre_m, along);
    let section = Section::new(matter, centre_m, normal, RAYS);
    Neck {
        cells,
        position_m: section.middle_m(),
        normal,
        area_m2: section.area_m2,
        centre_m,
        outline_m: section.outline_m(),
    }
}

/// The normal near `normal` across which the section is least.
fn turned(matter: &Matter, centre_m: Vec3, mut normal: Vec3) -> Vec3 {
    let area = |normal: Vec3| Section::area_m2(matter, centre_m, normal, TURN_RAYS);
    let mut least_m2 = area(normal);
    for turn in TURNS_RAD {
        let (u, v) = normal.any_orthonormal_pair();
        for side in [u, -u, v, -v, u + v, u - v, v - u, -u - v].map(Vec3::normalize) {
            let turned = (normal + side * turn.tan()).normalize();
            let turned_m2 = area(turned);
            if turned_m2 < TURN_GAIN * least_m2 {
                (normal, least_m2) = (turned, turned_m2);
            }
        }
    }
    normal
}
