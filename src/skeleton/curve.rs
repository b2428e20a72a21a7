//! What is left of a void once it is thinned: lattice points, and the steps of one voxel between them.

use super::complex::Complex;
use crate::voxel::brick;
use crate::voxel::levels::Levels;
use glam::IVec3;

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
        let bricks = || complex.cells().iter().enumerate().filter(|(_, cells)| cells[0] != 0);
        let points =
            bricks().flat_map(|(brick, cells)| brick::ones(cells[0]).map(move |bit| layout.corner(brick, bit)));
        let steps = bricks().flat_map(|(brick, cells)| {
            (0..3).flat_map(move |axis| {
                let starts = brick::ones(cells[1 << axis]).map(move |bit| layout.corner(brick, bit));
                starts.map(move |corner| [corner, corner + IVec3::AXES[axis]])
            })
        });
        let mut curve = Self { vertices: Vec::new(), edges: Vec::new(), distance, opening };
        curve.rebuild(points.collect(), steps.collect(), |corner| anchors.contains(&corner));
        curve
    }

    /// Replaces all vertices and edges, given by their corners in any order, each once.
    pub(super) fn rebuild(
        &mut self,
        mut points: Vec<IVec3>,
        steps: Vec<[IVec3; 2]>,
        is_anchor: impl Fn(IVec3) -> bool,
    ) {
        points.sort_unstable_by_key(rank);
        let number = |corner: &IVec3| points.binary_search_by_key(&rank(corner), rank).map_or(0, |at| at as u32);
        let mut edges: Vec<[u32; 2]> =
            steps.iter().map(|[a, b]| [number(a), number(b)]).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        self.edges = edges;
        self.vertices = points
            .into_iter()
            .map(|corner| Vertex {
                corner,
                distance: self.distance.at_corner(corner),
                opening: self.opening.at_corner(corner),
                anchor: is_anchor(corner),
            })
            .collect();
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
