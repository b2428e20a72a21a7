//! Where does the void run?

mod links;
mod matter;
pub mod nearest;
pub mod sections;

use crate::space::{Lattice, VoxelIndex};
use glam::Vec3;
use petgraph::graph::{NodeIndex, UnGraph};

/// The skeleton of a void: a graph of lattice points with the cells (rooms) and necks (doorways) it falls into.
#[derive(Debug, Clone)]
pub struct Skeleton {
    /// Nodes and edges, numbered the same for any thread count.
    pub graph: UnGraph<Node, Edge>,
    /// Rooms: parts of the void between necks.
    pub cells: Vec<Cell>,
    /// Doorways and windows between cells.
    pub necks: Vec<Neck>,
    /// The lattice that [`Skeleton::nearest`] is laid on.
    pub lattice: Lattice,
    /// For each voxel (x fastest, then y, then z) the node nearest along the void, or [`NO_NODE`].
    pub nearest: Vec<u32>,
}

/// What [`Skeleton::nearest`] holds for voxels that are not void, or whose void has no node.
pub const NO_NODE: u32 = u32::MAX;

/// A point of the skeleton.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Where it is, metres.
    pub position_m: Vec3,
    /// Exact Euclidean distance to the nearest matter, metres.
    pub radius_m: f32,
    /// Chessboard distance to matter, voxels.
    pub distance_voxels: u16,
    /// Half-width of the largest chessboard ball that covers it, voxels. `distance_voxels / opening_voxels` is its saliency: 1 at the
    /// centre of a maximal ball.
    pub opening_voxels: u16,
    /// The cell it belongs to.
    pub cell: u32,
}

/// A step of the skeleton.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Its length, metres.
    pub length_m: f32,
    /// True area of the void across its middle, m2.
    pub section_m2: f32,
    /// The neck it crosses.
    pub neck: Option<u32>,
}

/// A room: a part of the void that necks bound.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Its volume, m3.
    pub volume_m3: f32,
    /// Its node with the greatest distance to matter.
    pub centre: NodeIndex,
}

/// A doorway: the narrowest section between two cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Neck {
    /// The two cells it joins, the lower number first.
    pub cells: [u32; 2],
    /// Where it is, metres.
    pub position_m: Vec3,
    /// Unit normal, from the first cell to the second.
    pub normal: Vec3,
    /// Its area, m2.
    pub area_m2: f32,
}

impl Skeleton {
    /// The node nearest to a void voxel along the void; `None` outside the void.
    pub fn nearest_node(&self, voxel: VoxelIndex) -> Option<NodeIndex> {
        let [nx, ny, _] = self.lattice.size;
        self.lattice
            .contains(voxel)
            .then(|| {
                let [x, y, z] = voxel.0.to_array().map(|at| at as usize);
                self.nearest[x + nx * (y + ny * z)]
            })
            .filter(|&node| node != NO_NODE)
            .map(|node| NodeIndex::new(node as usize))
    }
}
