//! What lies around each node along the curve: void and wall, pooled over about one width.
//!
//! A node's own voxels are a slice of void a voxel thick, with a wall of its own or none; a mean free path takes a piece of
//! passage. It is pooled within `WIDTHS` of the passage's width to either side, and not through a neck: what is beyond a
//! door belongs to another room.

use super::surroundings::Surroundings;
use crate::skeleton::Skeleton;
use crate::skeleton::links::Links;
use rayon::prelude::*;
use std::collections::VecDeque;

/// How far along the curve is pooled to either side, in widths (twice the opening) of the void there.
const WIDTHS: f64 = 0.5;

/// The mean free path of a ball over its radius, for void without a wall in reach.
const BALL: f64 = 4.0 / 3.0;

/// The nodes of a skeleton and how far around each is pooled.
#[derive(Debug)]
pub struct Curve<'a> {
    /// The skeleton.
    pub skeleton: &'a Skeleton,
    /// The ends of its edges.
    pub ends: Vec<[u32; 2]>,
    /// The edges at each node.
    pub links: Links,
    /// By node: how far is pooled, metres.
    pub reach_m: Vec<f64>,
}

/// What lies within reach of a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pool {
    /// Void, m3.
    pub volume_m3: f64,
    /// Wall, m2.
    pub wall_m2: f64,
    /// The mean way between two walls, metres.
    pub free_path_m: f64,
    /// The mean reflectance of the walls; 0 where there is none.
    pub reflectance: f64,
}

/// Nodes that were reached, and which.
#[derive(Debug, Clone, Default)]
pub struct Reached {
    /// In the order they were reached, nearest first.
    pub nodes: Vec<u32>,
    is_in: Vec<bool>,
    open: VecDeque<(u32, f64)>,
}

impl Reached {
    /// Whether a node was reached.
    pub fn holds(&self, node: u32) -> bool {
        self.is_in.get(node as usize).is_some_and(|is_in| *is_in)
    }

    /// Collects the nodes within `reach_m` of one along the curve, itself first, not through necks; forgets those before.
    pub fn collect(&mut self, curve: &Curve, node: u32, reach_m: f64) {
        self.is_in.resize(curve.links.nodes(), false);
        self.nodes.drain(..).for_each(|node| self.is_in[node as usize] = false);
        self.is_in[node as usize] = true;
        self.open.push_back((node, 0.0));
        while let Some((here, along_m)) = self.open.pop_front() {
            self.nodes.push(here);
            for link in curve.links.of(here) {
                let edge = &curve.skeleton.graph.raw_edges()[link.edge as usize].weight;
                let next_m = along_m + f64::from(edge.length_m);
                if edge.neck.is_none() && next_m <= reach_m && !self.is_in[link.node as usize] {
                    self.is_in[link.node as usize] = true;
                    self.open.push_back((link.node, next_m));
                }
            }
        }
    }
}

impl<'a> Curve<'a> {
    /// The curve of a skeleton.
    pub fn new(skeleton: &'a Skeleton) -> Self {
        let edges = skeleton.graph.raw_edges().iter();
        let ends: Vec<[u32; 2]> =
            edges.map(|edge| [edge.source(), edge.target()].map(|end| end.index() as u32)).collect();
        let links = Links::new(skeleton.graph.node_count(), &ends);
        let voxel_m = f64::from(skeleton.lattice.voxel_m);
        let widths_m = skeleton.graph.node_weights().map(|node| 2.0 * voxel_m * f64::from(node.opening_voxels));
        let reach_m = widths_m.map(|width_m| WIDTHS * width_m).collect();
        Self { skeleton, ends, links, reach_m }
    }

    /// Works on the nodes within reach of each node, in the order of the nodes.
    pub fn around_each<T: Send>(&self, work: impl Fn(u32, &Reached) -> T + Sync) -> Vec<T> {
        let reach = |reached: &mut Reached, node: usize| {
            reached.collect(self, node as u32, self.reach_m[node]);
            work(node as u32, reached)
        };
        (0..self.reach_m.len()).into_par_iter().map_init(Reached::default, reach).collect()
    }

    /// What lies within reach of each node.
    pub fn pools(&self, around: &Surroundings) -> Vec<Pool> {
        self.around_each(|node, reached| {
            let sum = |by_node: &[f64]| -> f64 { reached.nodes.iter().map(|&near| by_node[near as usize]).sum() };
            let (volume_m3, wall_m2) = (sum(&around.volume_m3), sum(&around.wall_m2));
            let has_wall = wall_m2 > 0.0;
            let free_path_m = if has_wall { 4.0 * volume_m3 / wall_m2 } else { BALL * self.reach_m[node as usize] };
            let reflectance = if has_wall { (sum(&around.reflecting_m2) / wall_m2).clamp(0.0, 1.0) } else { 0.0 };
            Pool { volume_m3, wall_m2, free_path_m, reflectance }
        })
    }

    /// The connected part of each node, numbered by their lowest nodes.
    pub fn parts(&self) -> Vec<u32> {
        let mut part = vec![u32::MAX; self.links.nodes()];
        let mut count = 0;
        for node in 0..self.links.nodes() as u32 {
            if part[node as usize] != u32::MAX {
                continue;
            }
            part[node as usize] = count;
            let mut open = vec![node];
            while let Some(here) = open.pop() {
                for link in self.links.of(here) {
                    if part[link.node as usize] == u32::MAX {
                        part[link.node as usize] = count;
                        open.push(link.node);
                    }
                }
            }
            count += 1;
        }
        part
    }
}
