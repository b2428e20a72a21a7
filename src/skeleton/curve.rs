//! What is left of a void once it is thinned: lattice points, and the steps of one voxel between them.

use super::complex::{Cells, Complex};
use crate::voxel::brick;
use crate::voxel::levels::Levels;
use glam::IVec3;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// A void's centre lines: a graph on the lattice of voxel corners.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Curve {
    /// The points, sorted by z, then y, then x; no two alike.
    pub vertices: Vec<Vertex>,
    /// Steps of one voxel between two points, the lower number first, sorted.
    pub edges: Vec<[u32; 2]>,
    /// The chessboard distance of every void voxel, voxels.
    pub distance: Levels,
    /// The opening of every void voxel, voxels.
    pub opening: Levels,
}

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Vertex {
    /// The voxel corner it lies on.
    pub corner: IVec3,
    /// The largest chessboard distance among the eight voxels around it, voxels; at least 1.
    pub distance: u16,
    /// The largest opening among the eight voxels around it, voxels; at least the distance.
    pub opening: u16,
    /// Whether it was held in place as the middle of a room.
    pub anchor: bool,
}

impl Vertex {
    /// Distance over opening: 1 at the centre of a maximal ball, near 0 in a corner of a wide hall.
    pub fn saliency(&self) -> f32 {
        f32::from(self.distance) / f32::from(self.opening.max(1))
    }
}

impl Curve {
    /// The points and edges of a complex that has nothing else; `anchors` are the points that were held.
    pub fn new(complex: &Complex, anchors: &[IVec3], distance: Levels, opening: Levels) -> Self {
        let layout = complex.layout();
        let all = complex.cells().par_iter().enumerate();
        let bricks: Vec<(usize, &Cells)> = all.filter(|(_, cells)| cells[0] != 0).collect();
        let points =
            bricks.iter().flat_map(|&(brick, cells)| brick::ones(cells[0]).map(move |bit| layout.corner(brick, bit)));
        let steps = bricks.iter().flat_map(|&(brick, cells)| {
            (0..3).flat_map(move |axis| {
                let starts = brick::ones(cells[1 << axis]).map(move |bit| layout.corner(brick, bit));
                starts.map(move |corner| [corner, corner + IVec3::AXES[axis]])
            })
        });
        let held: BTreeSet<[i32; 3]> = anchors.iter().map(|corner| corner.to_array()).collect();
        let mut curve = Self { vertices: Vec::new(), edges: Vec::new(), distance, opening };
        curve.vertices = points.map(|corner| curve.vertex(corner, held.contains(&corner.to_array()))).collect();
        curve.vertices.sort_unstable_by_key(|vertex| rank(&vertex.corner));
        let number = |corner: IVec3| curve.vertex_at(corner).unwrap_or_default();
        let mut edges: Vec<[u32; 2]> = steps.map(|[low, high]| [number(low), number(high)]).collect();
        edges.sort_unstable();
        curve.edges = edges;
        curve
    }

    /// The vertex that a corner would be.
    pub(super) fn vertex(&self, corner: IVec3, anchor: bool) -> Vertex {
        Vertex { corner, distance: self.distance.at_corner(corner), opening: self.opening.at_corner(corner), anchor }
    }

    /// Leaves out vertices, and edges at them.
    pub(super) fn retain(&mut self, stays: &[bool]) {
        let mut left = 0;
        let numbers: Vec<Option<u32>> = stays
            .iter()
            .map(|stays| {
                left += u32::from(*stays);
                stays.then(|| left - 1)
            })
            .collect();
        let renumbered = |[a, b]: &[u32; 2]| Some([numbers[*a as usize]?, numbers[*b as usize]?]);
        self.edges = self.edges.iter().filter_map(renumbered).collect();
        let mut stays = stays.iter();
        self.vertices.retain(|_| stays.next().is_some_and(|stays| *stays));
    }

    /// Adds vertices, each with the number of the one it joins; an added one has the number after those before it.
    pub(super) fn extend(&mut self, grown: &[(Vertex, u32)]) {
        let edges = (self.vertices.len() as u32..).zip(grown).map(|(number, (_, from))| [*from, number]);
        self.edges.extend(edges);
        self.vertices.extend(grown.iter().map(|(vertex, _)| *vertex));
        let mut order: Vec<u32> = (0..self.vertices.len() as u32).collect();
        order.sort_unstable_by_key(|number| rank(&self.vertices[*number as usize].corner));
        let mut places = vec![0; order.len()];
        (0_u32..).zip(&order).for_each(|(place, number)| places[*number as usize] = place);
        self.vertices = order.iter().map(|number| self.vertices[*number as usize]).collect();
        for edge in &mut self.edges {
            *edge = edge.map(|number| places[number as usize]);
            edge.sort_unstable();
        }
        self.edges.sort_unstable();
    }

    /// The number of the vertex on a corner, if there is one.
    pub fn vertex_at(&self, corner: IVec3) -> Option<u32> {
        self.vertices.binary_search_by_key(&rank(&corner), |vertex| rank(&vertex.corner)).ok().map(|at| at as u32)
    }

    /// For each vertex the vertices one step away, in ascending order.
    pub fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut near = vec![Vec::new(); self.vertices.len()];
        for [a, b] in &self.edges {
            near[*a as usize].push(*b);
            near[*b as usize].push(*a);
        }
        near.iter_mut().for_each(|near| near.sort_unstable());
        near
    }
}

/// The order of vertices: z, then y, then x.
fn rank(corner: &IVec3) -> (i32, i32, i32) {
    (corner.z, corner.y, corner.x)
}
