//! Which branches say nothing, and how far do dead ends reach?
//!
//! Noise on walls makes branches that stay inside the balls of what they leave: a branch is cut when the ball at its tip
//! overlaps the ball at the junction, by distances as the ball sees them (the largest difference of coordinates; counting
//! steps would make diagonal branches long). Shortest go first, and a junction that has lost its branch is one no more.
//! Thinning also stops short of a dead end's wall by the width of the passage: so each dead end that is left grows straight
//! on for as long as the void stays about as wide.
//! Both only take or add dead ends, so the topology stays.

use super::curve::{Curve, Vertex};
use glam::{IVec3, Vec3};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Cuts branches that stay inside the ball of the junction they leave. Branches end at anchors, and anchors stay unless
/// they lie in a larger ball themselves.
pub fn prune(curve: &mut Curve) {
    let mut near = curve.neighbours();
    let mut stays = vec![true; curve.vertices.len()];
    let tips = |near: &[Vec<u32>]| -> Vec<u32> {
        let is_tip = |vertex: &u32| near[*vertex as usize].len() == 1;
        (0..near.len() as u32).filter(is_tip).collect()
    };

    // A cut can make two branches of a junction one, which may then be cut too, or be cut no more: look again until
    // nothing happens.
    loop {
        let mut branches: BinaryHeap<Reverse<(usize, u32)>> = BinaryHeap::new();
        branches.extend(tips(&near).into_iter().map(|tip| Reverse((branch(curve, &near, tip).len(), tip))));
        let mut cut = false;
        while let Some(Reverse((length, tip))) = branches.pop() {
            let path = branch(curve, &near, tip);
            if path.len() != length {
                branches.push(Reverse((path.len(), tip)));
                continue;
            }
            let [.., last, junction] = path[..] else { continue };
            if is_end(curve, &near, junction) || !overlaps(curve, tip, junction) {
                continue;
            }
            for vertex in &path[..path.len() - 1] {
                stays[*vertex as usize] = false;
                near[*vertex as usize].clear();
            }
            near[junction as usize].retain(|vertex| *vertex != last);
            cut = true;
        }
        if !cut {
            break;
        }
    }

    curve.retain(&stays);
}

/// Grows each dead end straight on, to where the void gets narrower than it was by more than one voxel, or another line
/// runs.
pub fn regrow(curve: &mut Curve) {
    let near = curve.neighbours();
    let mut taken = BTreeSet::new();
    let mut grown: Vec<(Vertex, u32)> = Vec::new();
    for (tip, vertex) in curve.vertices.iter().enumerate() {
        if near[tip].len() != 1 || vertex.anchor {
            continue;
        }
        // The heading: from as far back as the passage is wide.
        let path = branch(curve, &near, tip as u32);
        let back = path[path.len().min(2 * usize::from(vertex.distance) + 1) - 1];
        let ahead = (vertex.corner - curve.vertices[back as usize].corner).as_vec3();
        let (mut at, mut number) = (vertex.corner, tip as u32);
        loop {
            // Of the steps that do not lead back, the one that stays closest to the line.
            let axes = (0..3).filter(|axis| ahead[*axis] != 0.0);
            let candidates = axes.map(|axis| at + IVec3::AXES[axis] * ahead[axis].signum() as i32);
            let open = candidates.filter(|next| is_open(curve, at, *next, vertex.distance));
            let aside = |next: &IVec3| off_line((*next - vertex.corner).as_vec3(), ahead);
            let Some(next) = open.min_by(|a, b| aside(a).total_cmp(&aside(b))) else { break };
            if curve.vertex_at(next).is_some() || !taken.insert(next.to_array()) {
                break;
            }
            grown.push((curve.vertex(next, false), number));
            (at, number) = (next, (curve.vertices.len() + grown.len() - 1) as u32);
        }
    }
    curve.extend(&grown);
}

/// The vertices from a tip to the next junction, anchor or end, all included.
fn branch(curve: &Curve, near: &[Vec<u32>], tip: u32) -> Vec<u32> {
    let mut path = vec![tip];
    let mut before = tip;
    let mut next = near[tip as usize].first().copied();
    while let Some(vertex) = next {
        path.push(vertex);
        let around = &near[vertex as usize];
        next = match around.len() {
            2 if !curve.vertices[vertex as usize].anchor => around.iter().copied().find(|other| *other != before),
            _ => None,
        };
        before = vertex;
    }
    path
}

/// Whether a branch ends in nothing that would be left without it.
fn is_end(curve: &Curve, near: &[Vec<u32>], vertex: u32) -> bool {
    near[vertex as usize].len() < 3 && !curve.vertices[vertex as usize].anchor
}

/// Whether the ball at a tip says nothing beside that at a junction: they overlap or, where an anchor is the tip, it lies
/// in the junction's ball and has no larger one, so that it is a dent in the wall of the same room.
fn overlaps(curve: &Curve, tip: u32, junction: u32) -> bool {
    let (tip, junction) = (&curve.vertices[tip as usize], &curve.vertices[junction as usize]);
    let apart = (tip.corner - junction.corner).abs().max_element();
    let (at_tip, at_junction) = (i32::from(tip.distance), i32::from(junction.distance));
    if tip.anchor { apart <= at_junction && at_tip <= at_junction } else { apart <= at_tip + at_junction }
}

/// Whether a dead end may grow from one lattice point to the next: through void, and where that is wide enough.
fn is_open(curve: &Curve, at: IVec3, next: IVec3, distance: u16) -> bool {
    let axis = (0..3).find(|axis| at[*axis] != next[*axis]).unwrap_or(0);
    curve.distance.at_edge(at.min(next), axis) > 0 && curve.distance.at_corner(next) + 1 >= distance
}

/// The squared distance of a point from a line through the origin.
fn off_line(point: Vec3, along: Vec3) -> f32 {
    point.cross(along).length_squared()
}
