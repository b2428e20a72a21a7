//! Into which parts does the void fall that light is about the same in?
//!
//! Zones are a finer partition of the skeleton's cells that never crosses a neck. Along the skeleton: nodes gather about
//! seeds that are set one after the other where the way to all others is longest, a way counted in widths of the passage
//! (`ds / 2w`, w the opening), then moved to the middle of what they gathered (Lloyd). Across it: what a seed gathered is cut
//! by planes into blocks of about the same share of a width, for in a wide room the skeleton is a single line.
//!
//! A voxel belongs to the zone of the node nearest to it along the void, so no zone reaches through a wall; a block of a
//! passage that bends sharply within one width may come in two pieces.

use crate::model::Model;
use glam::{IVec3, Vec3};
use petgraph::graph::NodeIndex;
use petgraph::visit::EdgeRef;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Times that seeds are moved to the middle of their group. Two even out most; more changed no estimate.
const LLOYD_STEPS: usize = 2;

/// Most blocks along an axis of a group: bounds what a hall of any size can cost.
const MOST_BLOCKS: f32 = 24.0;

/// The zones of a model.
#[derive(Debug, Clone)]
pub struct Zones {
    /// How many there are.
    pub count: usize,
    /// The group of each node.
    group_of: Vec<u32>,
    groups: Vec<Group>,
}

/// What a seed gathered: a stretch of passage or a part of a room.
#[derive(Debug, Clone, Copy)]
struct Group {
    /// The number of its first zone.
    first: u32,
    /// The cell it is a part of.
    cell: u32,
    /// The lowest corner of the box around its voxels, metres.
    low_m: Vec3,
    /// The edges of its blocks, metres.
    block_m: Vec3,
    /// How many blocks along each axis.
    blocks: IVec3,
}

impl Group {
    /// Its zones with their middles, metres.
    fn zones(&self) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        let middle_m = |number| self.low_m + (self.block(number).as_vec3() + 0.5) * self.block_m;
        (0..self.blocks.element_product()).map(move |number| (self.first + number as u32, middle_m(number)))
    }

    /// The place of its block of that number.
    fn block(&self, number: i32) -> IVec3 {
        let row = number / self.blocks.x;
        IVec3::new(number % self.blocks.x, row % self.blocks.y, row / self.blocks.y)
    }
}

impl Zones {
    /// Parts the void of a model into zones about `spacing` widths long and wide.
    ///
    /// Linear in the voxels, and in nodes times the zones of their cell.
    pub fn new(model: &Model, spacing: f32) -> Self {
        let (group_of, widths_m, cells) = gather(model, spacing);
        let boxes = boxes(model, &group_of, widths_m.len());
        let lattice = &model.voxels.lattice;
        let mut count = 0;
        let groups = boxes.iter().zip(widths_m.iter().zip(&cells)).map(|(&(low, high), (&width_m, &cell))| {
            // A group whose nodes are nearest to no voxel has an empty box.
            let (low, high) = if low.cmplt(high).all() { (low, high) } else { (IVec3::ZERO, IVec3::ONE) };
            let size_m = (high - low).as_vec3() * lattice.voxel_m;
            let blocks = (size_m / (spacing * width_m)).round().clamp(Vec3::ONE, Vec3::splat(MOST_BLOCKS));
            let group = Group {
                first: count,
                cell,
                low_m: lattice.corner_m(low),
                block_m: (size_m / blocks).max(Vec3::splat(lattice.voxel_m)),
                blocks: blocks.as_ivec3(),
            };
            count += group.blocks.element_product() as u32;
            group
        });
        let groups = groups.collect();
        Self { count: count as usize, group_of, groups }
    }

    /// The zone of a point that is nearest to that node. Points beyond the group's box belong to its outer blocks.
    pub fn at(&self, node: u32, point_m: Vec3) -> u32 {
        let Some(group) = self.group_of.get(node as usize).and_then(|&group| self.groups.get(group as usize)) else {
            return 0;
        };
        let block = ((point_m - group.low_m) / group.block_m).floor().as_ivec3();
        let block = block.clamp(IVec3::ZERO, group.blocks - 1);
        group.first + (block.x + group.blocks.x * (block.y + group.blocks.y * block.z)) as u32
    }

    /// The cell that a zone is a part of; `u32::MAX` for a number beyond the last.
    pub fn cell(&self, zone: u32) -> u32 {
        let group = self.groups.partition_point(|group| group.first <= zone).checked_sub(1);
        let within = |group: &&Group| zone < group.first + group.blocks.element_product() as u32;
        group.and_then(|group| self.groups.get(group)).filter(within).map_or(u32::MAX, |group| group.cell)
    }

    /// All zones with the middles of their blocks, metres, which need not lie in the void.
    pub fn middles_m(&self) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        self.groups.iter().flat_map(Group::zones)
    }

    /// The groups as ranges of zones, each with its cell.
    pub fn groups(&self) -> impl Iterator<Item = (std::ops::Range<u32>, u32)> {
        self.groups.iter().map(|group| {
            let count = group.blocks.element_product() as u32;
            (group.first..group.first + count, group.cell)
        })
    }

    /// The other zones of a zone's group up to so many blocks away, the nearest first.
    pub fn beside(&self, zone: u32, blocks: i32) -> impl Iterator<Item = u32> {
        let group = self.groups.partition_point(|group| group.first <= zone).checked_sub(1);
        let mut beside = Vec::new();
        if let Some(group) = group.and_then(|group| self.groups.get(group)) {
            let place = group.block((zone - group.first) as i32);
            let low = (place - blocks).max(IVec3::ZERO);
            let high = (place + blocks).min(group.blocks - 1);
            for z in low.z..=high.z {
                for y in low.y..=high.y {
                    for x in low.x..=high.x {
                        let at = IVec3::new(x, y, z);
                        let apart_m2 = ((at - place).as_vec3() * group.block_m).length_squared();
                        beside.push((apart_m2, group.first + (x + group.blocks.x * (y + group.blocks.y * z)) as u32));
                    }
                }
            }
        }
        beside.sort_by(|a, b| a.0.total_cmp(&b.0));
        beside.into_iter().map(|(_, other)| other).filter(move |&other| other != zone)
    }

    /// For each zone the nearest one of its cell for which `has` holds, itself if it does; `None` where the cell has none.
    pub fn nearest_where(&self, has: impl Fn(u32) -> bool + Sync) -> Vec<Option<u32>> {
        let held: Vec<(u32, u32, Vec3)> = (self.groups.iter())
            .flat_map(|group| group.zones().map(move |(zone, middle_m)| (group.cell, zone, middle_m)))
            .filter(|&(_, zone, _)| has(zone))
            .collect();
        let nearest = |group: &Group| -> Vec<Option<u32>> {
            // Within the group if it has any; a block beside is nearer along the void than one as near in another group.
            let own: Vec<(u32, Vec3)> = group.zones().filter(|&(zone, _)| has(zone)).collect();
            let of_cell = held.iter().filter(|(cell, ..)| *cell == group.cell).map(|&(_, zone, at_m)| (zone, at_m));
            let among = if own.is_empty() { of_cell.collect() } else { own };
            let to = |middle_m: Vec3| {
                let apart = |(_, at_m): &&(u32, Vec3)| at_m.distance_squared(middle_m);
                among.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).map(|&(zone, _)| zone)
            };
            group.zones().map(|(zone, middle_m)| if has(zone) { Some(zone) } else { to(middle_m) }).collect()
        };
        self.groups.par_iter().flat_map_iter(nearest).collect()
    }

    /// The shortest edge of the zones about a node, metres; 0 for a number beyond the skeleton.
    pub fn edge_m(&self, node: u32) -> f32 {
        let group = self.group_of.get(node as usize).and_then(|&group| self.groups.get(group as usize));
        group.map_or(0.0, |group| group.block_m.min_element())
    }
}

/// The group of each node, the width and cell of each group.
fn gather(model: &Model, spacing: f32) -> (Vec<u32>, Vec<f32>, Vec<u32>) {
    let graph = &model.skeleton.graph;
    let mut nodes_of_cell = vec![Vec::new(); model.skeleton.cells.len()];
    for node in graph.node_indices() {
        if let Some(nodes) = nodes_of_cell.get_mut(graph[node].cell as usize) {
            nodes.push(node);
        }
    }
    let gathered: Vec<(Vec<u32>, u32)> =
        nodes_of_cell.par_iter().map(|nodes| gathered_in_cell(model, nodes, spacing)).collect();

    let voxel_m = model.voxels.lattice.voxel_m;
    let mut group_of = vec![0; graph.node_count()];
    let (mut widths_m, mut cells) = (Vec::new(), Vec::new());
    for (cell, (nodes, (groups, count))) in nodes_of_cell.iter().zip(&gathered).enumerate() {
        let first = widths_m.len();
        widths_m.resize(first + *count as usize, 0.0_f32);
        cells.resize(first + *count as usize, cell as u32);
        for (node, group) in nodes.iter().zip(groups) {
            let group = first + *group as usize;
            group_of[node.index()] = group as u32;
            widths_m[group] = widths_m[group].max(2.0 * f32::from(graph[*node].opening_voxels) * voxel_m);
        }
    }
    (group_of, widths_m, cells)
}

/// The group of each node of one cell, and how many groups there are.
fn gathered_in_cell(model: &Model, nodes: &[NodeIndex], spacing: f32) -> (Vec<u32>, u32) {
    let mut search = Search::new(model, nodes);
    let mut seeds = Vec::new();
    // The farthest node becomes a seed until none is farther than that; those out of reach come first.
    while let Some((seed, far)) = search.farthest() {
        if far <= spacing {
            break;
        }
        search.reach(seed, seeds.len() as u32);
        seeds.push(seed);
    }
    for _ in 0..LLOYD_STEPS {
        seeds = search.middles(nodes, model, seeds.len());
        search = Search::new(model, nodes);
        seeds.iter().enumerate().for_each(|(group, &seed)| search.reach(seed, group as u32));
    }
    (search.group, seeds.len() as u32)
}

/// The shortest ways within a cell from seeds to nodes, by the places of nodes in the cell's list.
struct Search {
    /// Length of the way to the nearest seed, in widths.
    widths: Vec<f32>,
    group: Vec<u32>,
    /// For each node its neighbours in the cell and the widths between.
    links: Vec<Vec<(u32, f32)>>,
}

impl Search {
    fn new(model: &Model, nodes: &[NodeIndex]) -> Self {
        let graph = &model.skeleton.graph;
        let voxel_m = model.voxels.lattice.voxel_m;
        // Nodes of a cell are listed in ascending order.
        let place = |node: NodeIndex| nodes.binary_search(&node).ok();
        let links = nodes.iter().map(|&node| {
            let within = graph.edges(node).filter(|edge| edge.weight().neck.is_none());
            let link = |edge: petgraph::graph::EdgeReference<'_, crate::skeleton::Edge>| {
                let other = if edge.source() == node { edge.target() } else { edge.source() };
                let width_m = 2.0 * f32::from(edge.weight().opening_voxels.max(1)) * voxel_m;
                place(other).map(|other| (other as u32, edge.weight().length_m / width_m))
            };
            within.filter_map(link).collect()
        });
        let links = links.collect();
        Self { widths: vec![f32::INFINITY; nodes.len()], group: vec![0; nodes.len()], links }
    }

    /// The node with the longest way, of equals the first, and that way.
    fn farthest(&self) -> Option<(u32, f32)> {
        let far = |best: Option<(u32, f32)>, (node, &way): (usize, &f32)| match best {
            Some((_, longest)) if longest >= way => best,
            _ => Some((node as u32, way)),
        };
        self.widths.iter().enumerate().fold(None, far)
    }

    /// Lets a seed take all that it is nearest to.
    fn reach(&mut self, seed: u32, group: u32) {
        let mut open = BinaryHeap::from([(Reverse(0), seed)]);
        self.widths[seed as usize] = 0.0;
        self.group[seed as usize] = group;
        while let Some((Reverse(way), node)) = open.pop() {
            if f32::from_bits(way) > self.widths[node as usize] {
                continue;
            }
            for &(next, length) in &self.links[node as usize] {
                let longer = self.widths[node as usize] + length;
                if longer < self.widths[next as usize] {
                    self.widths[next as usize] = longer;
                    self.group[next as usize] = group;
                    // Positive numbers order as their bits do.
                    open.push((Reverse(longer.to_bits()), next));
                }
            }
        }
    }

    /// For each group its node nearest to the mean position of all its nodes.
    fn middles(&self, nodes: &[NodeIndex], model: &Model, groups: usize) -> Vec<u32> {
        let mut sums = vec![(Vec3::ZERO, 0.0_f32); groups];
        for (node, &group) in nodes.iter().zip(&self.group) {
            let (sum, count) = &mut sums[group as usize];
            *sum += model.node_m(*node);
            *count += 1.0;
        }
        let mut best = vec![(f32::INFINITY, 0_u32); groups];
        for (place, (node, &group)) in nodes.iter().zip(&self.group).enumerate() {
            let (sum, count) = sums[group as usize];
            let apart = model.node_m(*node).distance_squared(sum / count);
            if apart < best[group as usize].0 {
                best[group as usize] = (apart, place as u32);
            }
        }
        best.into_iter().map(|(_, place)| place).collect()
    }
}

/// For each group the box around its voxels: the lowest corner, and the one beyond the highest voxel.
fn boxes(model: &Model, group_of: &[u32], groups: usize) -> Vec<(IVec3, IVec3)> {
    let void = &model.voxels.void;
    let [across, rows, planes] = void.bricks();
    let none = || vec![(IVec3::MAX, IVec3::MIN); groups];
    let around = |mut boxes: Vec<(IVec3, IVec3)>, plane: usize| {
        for brick in plane * across * rows..(plane + 1) * across * rows {
            let Some(labels) = model.skeleton.nearest.of_brick(brick) else { continue };
            let corner = 4 * IVec3::new((brick % across) as i32, (brick / across % rows) as i32, plane as i32);
            for (bit, &node) in labels.iter().enumerate() {
                let Some(&group) = group_of.get(node as usize) else { continue };
                let voxel = corner + IVec3::new(bit as i32 & 3, bit as i32 >> 2 & 3, bit as i32 >> 4);
                let (low, high) = &mut boxes[group as usize];
                *low = low.min(voxel);
                *high = high.max(voxel + 1);
            }
        }
        boxes
    };
    let merged = |mut one: Vec<(IVec3, IVec3)>, other: Vec<(IVec3, IVec3)>| {
        for (box_, (low, high)) in one.iter_mut().zip(other) {
            *box_ = (box_.0.min(low), box_.1.max(high));
        }
        one
    };
    (0..planes).into_par_iter().fold(none, around).reduce(none, merged)
}
