//! Which pieces of wall exchange light?
//!
//! A patch is what one zone sees in one direction: all walls in it whose normals have the same dominant axis and sign, panes
//! and black walls apart. Areas, normals and reflectances are the mesh's own, by points spread evenly over it: a point
//! stands for the same area everywhere. A side of a wall belongs to the void that begins in front of it.
//!
//! Limits: crevices that the voxels close have no zone; what is in them is taken to be where the void ends before them.

use super::zones::Zones;
use super::{MOST_TIMES_LINES, Quality};
use crate::flow::sequence;
use crate::model::Model;
use crate::model::walls::{Answer, WallPoint};
use crate::space::VoxelIndex;
use glam::{IVec3, Quat, Vec3};
use rayon::prelude::*;

/// Orientations of walls that reflect, then of panes, then of black ones.
const KINDS: usize = 18;

/// No patch.
const NONE: u32 = u32::MAX;

/// In front of a wall the void is looked for this far, in voxels, in these steps: conservative voxels stand up to two before
/// a wall.
const STEPS_OUT_VOXELS: [f32; 4] = [0.6, 1.2, 1.8, 2.5];

/// Up to here nothing is looked for between a side that was met and the void before it, in voxels.
const NEAR_OUT_VOXELS: f32 = 1.2;

/// In a corner the void is looked for about a place this far out, in voxels.
const CORNER_OUT_VOXELS: f32 = 1.2;

/// Most voxels of the void beside a corner that are looked at.
const MOST_LOOKS: usize = 4;

/// Back along a ray the void is looked for in steps of half a voxel, this many.
const STEPS_BACK: u32 = 24;

/// Before a crevice the void is looked for this far out, in voxels, in this many directions each.
const CREVICE_VOXELS: [f32; 8] = [1.5, 2.2, 3.2, 4.7, 7.0, 10.0, 15.0, 22.0];
const CREVICE_LOOKS: u32 = 16;

/// A place whose normal has at least this cosine to that of a patch looks where the patch does.
const LEAST_ALIKE: f32 = 0.5;

/// A side on which no point fell is looked for up to this many blocks away.
const BESIDE_BLOCKS: i32 = 2;

/// Points that are tried first, for each zone.
const FIRST_POINTS_A_ZONE: u32 = 4;

/// Fewest and most of them.
const LEAST_POINTS: u32 = 1024;
const MOST_FIRST_POINTS: u32 = 32_768;

/// Points for each line, so that areas come out better than by the lines alone.
const POINTS_A_LINE: f64 = 1.25;

/// Most points that are tried on the mesh.
const MOST_POINTS: f64 = 2e6;

/// One side of walls in one zone.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// The zone it faces.
    pub zone: u32,
    /// Its true area, m2.
    pub area_m2: f64,
    /// Mean reflectance.
    pub reflectance: f64,
    /// Lines that start on it, per m2.
    pub lines_per_m2: f64,
    /// Where they start, in [`Patches::starts`].
    pub starts: std::ops::Range<usize>,
}

/// A point of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// On the wall, metres.
    pub position_m: Vec3,
    /// Unit normal on the patch's side.
    pub normal: Vec3,
    /// How the wall answers light there.
    pub answer: Answer,
}

/// The patches of a model.
#[derive(Debug, Clone)]
pub struct Patches {
    /// All of them, by zone and orientation.
    pub list: Vec<Patch>,
    /// Points of them, those of a patch in a row.
    pub starts: Vec<Start>,
    /// The patch of each zone and kind; a kind that got no point is that of the zone's largest patch.
    of_kind: Vec<u32>,
    /// Whether what lies in crevices that the voxels close belongs to the patches before them.
    has_crevices: bool,
}

impl Patches {
    /// The patches of the zones of a model, with about [`Quality::lines`] starts each. Linear in the starts.
    pub fn new(model: &Model, zones: &Zones, quality: &Quality, seed: u64) -> Self {
        // A few points tell how many patches there are and how much of the mesh faces the void.
        let mut tried = FIRST_POINTS_A_ZONE.saturating_mul(zones.count as u32).clamp(LEAST_POINTS, MOST_FIRST_POINTS);
        let mut found = points(model, zones, tried, seed);
        let mut kinds: Vec<u32> = found.iter().map(|(kind, _)| *kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let few = quality.all_lines / (kinds.len() as u32).max(1);
        let lines = few.clamp(quality.lines, MOST_TIMES_LINES * quality.lines);
        let wanted = POINTS_A_LINE * f64::from(lines) * kinds.len() as f64;
        if (found.len() as f64) < wanted {
            tried = (f64::from(tried) * wanted / found.len() as f64).min(MOST_POINTS).ceil() as u32;
            found = points(model, zones, tried, seed);
        }
        let point_m2 = model.walls.area_m2() / f64::from(tried);

        found.sort_by_key(|(kind, _)| *kind);
        let mut patches = Self {
            list: Vec::new(),
            starts: Vec::new(),
            of_kind: vec![NONE; KINDS * zones.count],
            has_crevices: false,
        };
        for side in found.chunk_by(|a, b| a.0 == b.0) {
            patches.add(side, point_m2, lines);
        }
        patches.fill_kinds();
        patches
    }

    /// A patch of these points, each of which stands for `point_m2`.
    fn add(&mut self, side: &[(u32, Start)], point_m2: f64, lines: u32) {
        let Some(&(kind, _)) = side.first() else { return };
        let count = side.len();
        // Fewer lines for scraps of wall.
        let wanted = (f64::from(lines) * count as f64).sqrt().ceil() as usize;
        let kept = wanted.clamp(1, (lines as usize).max(1));
        let first = self.starts.len();
        self.starts.extend((0..kept).map(|number| side[number * count / kept].1));
        let area_m2 = count as f64 * point_m2;
        let reflectance = side.iter().map(|(_, start)| f64::from(start.answer.reflects)).sum::<f64>() / count as f64;
        if let Some(place) = self.of_kind.get_mut(kind as usize) {
            *place = self.list.len() as u32;
        }
        self.list.push(Patch {
            zone: kind / KINDS as u32,
            area_m2,
            reflectance,
            lines_per_m2: kept as f64 / area_m2,
            starts: first..self.starts.len(),
        });
    }

    fn fill_kinds(&mut self) {
        for kinds in self.of_kind.chunks_mut(KINDS) {
            let area_m2 = |patch: u32| self.list.get(patch as usize).map_or(0.0, |patch| patch.area_m2);
            let largest = kinds
                .iter()
                .copied()
                .filter(|&patch| patch != NONE)
                .max_by(|&a, &b| area_m2(a).total_cmp(&area_m2(b)).then(b.cmp(&a)));
            kinds.iter_mut().filter(|patch| **patch == NONE).for_each(|patch| *patch = largest.unwrap_or(NONE));
        }
    }

    /// Lets every wall of a cell with patches belong to one of them; else rays to it would end nowhere. A side on which no point
    /// fell is taken for its like in a zone beside, a zone without any for the nearest of its cell that has some, and a crevice
    /// that the voxels close for the void before it. Where most of a mesh lies in the open, small places get few points.
    ///
    /// Cost: linear in the zones, and in them times the zones of their cell for groups of zones without any patch.
    pub fn fill_gaps(&mut self, zones: &Zones) {
        let mut own = vec![NONE; self.of_kind.len()];
        for (number, patch) in self.list.iter().enumerate() {
            let start = self.starts.get(patch.starts.start);
            let kind = start.map(|start| kind(patch.zone, start.normal, start.answer));
            if let Some(place) = kind.and_then(|kind| own.get_mut(kind as usize)) {
                *place = number as u32;
            }
        }
        let has_own = |zone: u32| own[KINDS * zone as usize..].iter().take(KINDS).any(|&patch| patch != NONE);
        let beside = |place: usize| {
            let (zone, kind) = ((place / KINDS) as u32, place % KINDS);
            let like = |other: u32| own.get(KINDS * other as usize + kind).copied().filter(|&patch| patch != NONE);
            zones.beside(zone, BESIDE_BLOCKS).find_map(like)
        };
        for place in (0..own.len()).filter(|&place| own[place] == NONE && has_own((place / KINDS) as u32)) {
            if let Some(patch) = beside(place) {
                self.of_kind[place] = patch;
            }
        }
        for (zone, nearest) in zones.nearest_where(has_own).into_iter().enumerate() {
            if let Some(nearest) = nearest.map(|nearest| nearest as usize).filter(|&nearest| nearest != zone) {
                self.of_kind.copy_within(KINDS * nearest..KINDS * (nearest + 1), KINDS * zone);
            }
        }
        self.has_crevices = true;
    }

    /// The patch of a zone that is like a wall of that normal and answer; another of the zone's where it has none.
    pub fn like(&self, zone: u32, normal: Vec3, answer: Answer) -> Option<u32> {
        self.of_kind.get(kind(zone, normal, answer) as usize).copied().filter(|&patch| patch != NONE)
    }

    /// The patch of a point on a wall that reflects, by what void the wall faces there alone: a guess where a wall is thinner
    /// than a voxel. A look at the voxels, no ray.
    pub fn near(&self, model: &Model, zones: &Zones, point_m: Vec3, normal: Vec3) -> Option<u32> {
        let lattice = &model.voxels.lattice;
        let before =
            |out: f32| model.skeleton.nearest.node(lattice.voxel_at(point_m + normal * (out * lattice.voxel_m)));
        let node = STEPS_OUT_VOXELS
            .into_iter()
            .find_map(before)
            .or_else(|| beside_corner(model, point_m, normal).first().map(|&(_, node, _)| node))?;
        let patch = self.like(zones.at(node, point_m), normal, Answer { reflects: 1.0, passes: 0.0 })?;
        let start = self.starts.get(self.list.get(patch as usize)?.starts.start)?;
        (start.normal.dot(normal) > LEAST_ALIKE).then_some(patch)
    }

    /// The patch of a point on a wall, its normal on the side that was hit, by a ray of that length that came
    /// along `direction`. `None` where no zone of ours lies before it.
    pub fn at(&self, model: &Model, zones: &Zones, hit: &Start, direction: Vec3, length_m: f32) -> Option<u32> {
        let node = before_wall(model, hit.position_m, hit.normal, true)
            .or_else(|| back_along(model, hit.position_m, direction, length_m))
            .or_else(|| if self.has_crevices { before_crevice(model, hit) } else { None })?;
        self.like(zones.at(node, hit.position_m), hit.normal, hit.answer)
    }
}

/// Points spread evenly over the mesh, with the zone and kind of each side that faces the void.
fn points(model: &Model, zones: &Zones, count: u32, seed: u64) -> Vec<(u32, Start)> {
    let offset = sequence::offset(seed, u64::MAX);
    let sides = |index: u32| {
        let share = (f64::from(index) + 0.5) / f64::from(count);
        let point = model.walls.point_at(share, sequence::square(index, offset));
        let side = move |normal: Vec3| {
            let WallPoint { triangle, position_m, .. } = point?;
            let answer = model.walls.answers.get(triangle as usize).copied().unwrap_or_default();
            let node = before_wall(model, position_m, normal, false)?;
            Some((kind(zones.at(node, position_m), normal, answer), Start { position_m, normal, answer }))
        };
        let normal = point.map_or(Vec3::Z, |point| point.normal);
        [side(normal), side(-normal)].into_iter().flatten()
    };
    (0..count).into_par_iter().flat_map_iter(sides).collect()
}

/// The node of the void before a wall: straight out, or, in the corners of walls, where conservative voxels fill the
/// corner, the nearest that is in sight. A side that a ray has `met` is known to be open.
fn before_wall(model: &Model, point_m: Vec3, normal: Vec3, met: bool) -> Option<u32> {
    let lattice = &model.voxels.lattice;
    let lifted_m = point_m + normal * model.rays.epsilon_m();
    let node = |at_m: Vec3| model.skeleton.nearest.node(lattice.voxel_at(at_m));
    let straight = STEPS_OUT_VOXELS.into_iter().find_map(|out| {
        let at_m = point_m + normal * (out * lattice.voxel_m);
        Some((node(at_m)?, at_m, met && out <= NEAR_OUT_VOXELS))
    });
    if let Some((node, at_m, is_sure)) = straight {
        // The void behind a thin wall is not before its inner side.
        return (is_sure || model.rays.clear(lifted_m, at_m)).then_some(node);
    }
    let seen = beside_corner(model, point_m, normal).into_iter().take(MOST_LOOKS);
    seen.map(|(_, node, centre_m)| (node, centre_m))
        .find(|(_, centre_m)| model.rays.clear(lifted_m, *centre_m))
        .map(|(node, _)| node)
}

/// The void around a place that lies in a corner of walls: squared distance, node and centre of each voxel in front of the
/// place, the nearest first.
fn beside_corner(model: &Model, point_m: Vec3, normal: Vec3) -> Vec<(f32, u32, Vec3)> {
    let lattice = &model.voxels.lattice;
    let home = lattice.voxel_at(point_m + normal * (CORNER_OUT_VOXELS * lattice.voxel_m)).0;
    let mut beside: Vec<(f32, u32, Vec3)> = Vec::new();
    for step in 0..27 {
        let voxel = VoxelIndex(home + IVec3::new(step % 3, step / 3 % 3, step / 9) - 1);
        let Some(node) = model.skeleton.nearest.node(voxel) else { continue };
        let centre_m = lattice.centre_m(voxel);
        if (centre_m - point_m).dot(normal) > 0.0 {
            beside.push((centre_m.distance_squared(point_m), node, centre_m));
        }
    }
    beside.sort_by(|a, b| a.0.total_cmp(&b.0));
    beside
}

/// The node of the void that a ray of that length left before it came to a point.
fn back_along(model: &Model, point_m: Vec3, direction: Vec3, length_m: f32) -> Option<u32> {
    let lattice = &model.voxels.lattice;
    let step_m = 0.5 * lattice.voxel_m;
    let steps = (1..=STEPS_BACK).map(|step| step as f32 * step_m).take_while(|back_m| *back_m < length_m);
    steps
        .map(|back_m| point_m - back_m * direction)
        .find_map(|at_m| model.skeleton.nearest.node(lattice.voxel_at(at_m)))
}

/// The node of a void before a crevice: nearest of those that lie some way out from a place in it, in front of the place.
fn before_crevice(model: &Model, hit: &Start) -> Option<u32> {
    let lattice = &model.voxels.lattice;
    let turn = Quat::from_rotation_arc(Vec3::Z, hit.normal);
    let around = (0..CREVICE_LOOKS).map(|look| sequence::spiral(look, 2 * CREVICE_LOOKS, [0.5; 2]));
    let ahead: Vec<Vec3> = around.map(|direction| turn * direction).collect();
    CREVICE_VOXELS.into_iter().find_map(|out| {
        let at_m = |direction: &Vec3| hit.position_m + out * lattice.voxel_m * *direction;
        ahead.iter().find_map(|direction| model.skeleton.nearest.node(lattice.voxel_at(at_m(direction))))
    })
}

/// The number of a zone's side.
fn kind(zone: u32, normal: Vec3, answer: Answer) -> u32 {
    let axis = normal.abs().max_position();
    let side = 2 * axis + usize::from(normal[axis] < 0.0);
    let matter = match answer {
        Answer { passes, .. } if passes > 0.0 => 6,
        Answer { reflects, .. } if reflects > 0.0 => 0,
        _ => 12,
    };
    KINDS as u32 * zone + (side + matter) as u32
}
