//! The skeleton of a void: a graph of lattice points with the cells (rooms) and necks (doorways) it falls into.

use super::cells::{self, Widths};
use super::links::Links;
use super::matter::Matter;
use super::nearest::Nearest;
use super::necks::{self, Neck};
use super::sections::{self, Section};
use super::{curve::Curve, filter::Filter, thin_by};
use crate::job::{Cancel, Cancelled, Progress};
use crate::rays::Rays;
use crate::space::{Lattice, VoxelIndex};
use crate::voxel::Voxels;
use crate::voxel::bits::BitGrid;
use crate::voxel::brick;
use glam::{IVec3, Vec3};
use petgraph::graph::{NodeIndex, UnGraph};
use rayon::prelude::*;

/// The skeleton of a void: a graph of lattice points with the cells (rooms) and necks (doorways) it falls into.
#[derive(Debug, Clone)]
pub struct Skeleton {
    /// Nodes and edges, numbered the same for any thread count. Edges are steps of one voxel along an axis.
    pub graph: UnGraph<Node, Edge>,
    /// Rooms: parts of the void between necks, in the order of their lowest nodes.
    pub cells: Vec<Cell>,
    /// Doorways and windows between cells, in the order of the cells.
    pub necks: Vec<Neck>,
    /// The lattice that [`Skeleton::nearest`] is laid on.
    pub lattice: Lattice,
    /// For each void voxel the node nearest along the void.
    pub nearest: Nearest,
}

/// A point of the skeleton.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Where it is, metres; a corner of voxels.
    pub position_m: Vec3,
    /// Euclidean distance to the nearest matter, metres: to the surface itself where one is found within a voxel of where
    /// the voxels say, else to the middle of the nearest voxel that is not void.
    pub radius_m: f32,
    /// Chessboard distance to matter, voxels.
    pub distance_voxels: u16,
    /// Half-width of the largest chessboard ball that covers it, voxels. `distance_voxels / opening_voxels` is its saliency: 1 at the
    /// centre of a maximal ball.
    pub opening_voxels: u16,
    /// The cell it belongs to.
    pub cell: u32,
    /// The volume of void that is nearest to it, m3, measured as [`Cell::volume_m3`] is.
    pub volume_m3: f32,
}

impl Node {
    /// Distance over opening: 1 at the centre of a maximal ball, less off it.
    pub fn saliency(&self) -> f32 {
        f32::from(self.distance_voxels) / f32::from(self.opening_voxels.max(1))
    }
}

/// A step of the skeleton.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Its length along the smoothed curve, metres: a staircase of steps along axes is as long as the slope it stands for.
    pub length_m: f32,
    /// True area of the void across its middle, square to the curve there, as far as it is in sight, m2.
    pub section_m2: f32,
    /// Half-width of the largest chessboard ball that covers it, voxels; less than at both its ends where it crosses a wall of
    /// a single voxel.
    pub opening_voxels: u16,
    /// The neck it crosses.
    pub neck: Option<u32>,
}

/// A room: a part of the void that necks bound.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Its volume, m3: its voxels, and half a voxel for each of their faces towards matter, for walls run on average
    /// through the middle of the voxels that hold them. This is without bias for planes at any angle.
    pub volume_m3: f32,
    /// Its node with the greatest distance to matter.
    pub centre: NodeIndex,
}

/// What must not change when voxels are made smaller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Connected parts.
    pub components: usize,
    /// Independent loops.
    pub loops: usize,
    /// Necks.
    pub necks: usize,
}

/// The farthest that the curve is smoothed to either side to get its direction, steps: about a third of a room.
const SMOOTH_STEPS: u16 = 6;

/// The least, which takes the stairs out of a slanted curve.
const LEAST_SMOOTH_STEPS: u16 = 2;

/// The least share of a step along an axis that counts as length: its share on the diagonal of a cube.
const SHORTEST_STEP: f32 = 0.577_350_3;

impl Skeleton {
    /// Thins the void of a scene and cuts its skeleton into cells: [`Skeleton::build_from`].
    ///
    /// # Errors
    /// [`Cancelled`] when `cancel` was raised.
    pub fn build(voxels: &Voxels, rays: &Rays, progress: &dyn Progress, cancel: &Cancel) -> Result<Self, Cancelled> {
        Self::build_from(voxels.lattice, &voxels.void, &Filter::default(), rays, progress, cancel)
    }

    /// Thins a void and cuts its skeleton into cells. `rays` are those of the scene; without a surface in them all sizes
    /// are the voxels'.
    ///
    /// Stages reported: those of [`super::thin`], `sections` (sections, radii, nearest nodes) and `cells`.
    /// Time of `sections` on one thread: that of [`Nearest::new`], and 15 us an edge in the gallery, 30 us in a real house.
    ///
    /// # Errors
    /// [`Cancelled`] when `cancel` was raised.
    pub fn build_from(
        lattice: Lattice,
        void: &BitGrid,
        filter: &Filter,
        rays: &Rays,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let curve = thin_by(filter, void, progress, cancel)?;
        let matter = Matter { lattice, void, distance: &curve.distance, rays };
        let corners: Vec<IVec3> = curve.vertices.iter().map(|vertex| vertex.corner).collect();
        let links = Links::new(corners.len(), &curve.edges);
        let directions = directions(&curve, &links, &corners);
        let middles_m: Vec<Vec3> = (curve.edges.iter())
            .map(|edge| 0.5 * edge.iter().map(|end| lattice.corner_m(corners[*end as usize])).sum::<Vec3>())
            .collect();

        progress.begin("sections", 0);
        let ((nearest, volumes_m3), (sections_m2, radii_m)) = rayon::join(
            || {
                let nearest = Nearest::new(void, &corners);
                let volumes_m3 = volumes_m3(void, &nearest, corners.len(), lattice.voxel_m);
                (nearest, volumes_m3)
            },
            || {
                let across = middles_m.par_iter().zip(&directions);
                let sections_m2: Vec<f32> = across
                    .map(|(middle_m, direction)| Section::area_m2(&matter, *middle_m, *direction, sections::RAYS))
                    .collect();
                let radii_m: Vec<f32> = corners.par_iter().map(|corner| matter.radius_m(*corner)).collect();
                (sections_m2, radii_m)
            },
        );
        progress.end();
        cancel.check()?;

        progress.begin("cells", 0);
        let widths = Widths {
            links: &links,
            edges: &curve.edges,
            sections_m2: &sections_m2,
            middles_m: &middles_m,
            volumes_m3: &volumes_m3,
            radii_m: &radii_m,
            step_m: lattice.voxel_m,
        };
        let cell_of = cells::cells(&widths);
        let (necks, neck_of) = necks::necks(&matter, &widths, &directions, &cell_of);
        let cells = summed(&cell_of, &volumes_m3, &radii_m);
        progress.end();
        cancel.check()?;

        let mut graph = UnGraph::with_capacity(corners.len(), curve.edges.len());
        for (node, vertex) in curve.vertices.iter().enumerate() {
            graph.add_node(Node {
                position_m: lattice.corner_m(vertex.corner),
                radius_m: radii_m[node],
                distance_voxels: vertex.distance,
                opening_voxels: vertex.opening,
                cell: cell_of[node],
                volume_m3: volumes_m3[node],
            });
        }
        for (edge, [a, b]) in curve.edges.iter().enumerate() {
            let [from, to] = [*a, *b].map(|end| corners[end as usize]);
            let step = (to - from).as_vec3();
            let weight = Edge {
                length_m: lattice.voxel_m * step.dot(directions[edge]).abs().max(SHORTEST_STEP),
                section_m2: sections_m2[edge],
                opening_voxels: curve.opening.at_edge(from.min(to), step.abs().max_position()),
                neck: neck_of[edge],
            };
            graph.add_edge(NodeIndex::new(*a as usize), NodeIndex::new(*b as usize), weight);
        }
        Ok(Self { graph, cells, necks, lattice, nearest })
    }

    /// The node nearest to a void voxel along the void; `None` outside the void.
    pub fn nearest_node(&self, voxel: VoxelIndex) -> Option<NodeIndex> {
        self.nearest.node(voxel).map(|node| NodeIndex::new(node as usize))
    }

    /// How many connected parts, independent loops and necks there are. Linear in the graph.
    pub fn shape(&self) -> Shape {
        let components = petgraph::algo::connected_components(&self.graph);
        let loops = self.graph.edge_count() + components - self.graph.node_count();
        Shape { components, loops, necks: self.necks.len() }
    }
}

/// The unit direction of the curve at each edge, smoothed over about the distance to matter there.
fn directions(curve: &Curve, links: &Links, corners: &[IVec3]) -> Vec<Vec3> {
    let reach = |[a, b]: [u32; 2]| {
        let distance = curve.vertices[a as usize].distance.min(curve.vertices[b as usize].distance);
        usize::from(distance.clamp(LEAST_SMOOTH_STEPS, SMOOTH_STEPS))
    };
    curve.edges.par_iter().map(|edge| links.direction(corners, *edge, reach(*edge))).collect()
}

/// The volume nearest to each node, m3: see [`Cell::volume_m3`].
fn volumes_m3(void: &BitGrid, nearest: &Nearest, nodes: usize, voxel_m: f32) -> Vec<f32> {
    let mut halves = vec![0_u64; nodes];
    for (number, word) in void.words().iter().enumerate() {
        let Some(labels) = nearest.of_brick(number) else { continue };
        let faces = [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)];
        let mut add = |mask: u64, amount: u64| {
            for bit in brick::ones(mask) {
                if let Some(halves) = halves.get_mut(labels[bit as usize] as usize) {
                    *halves += amount;
                }
            }
        };
        add(*word, 2);
        for (axis, up) in faces {
            let mut beside = void.shifted(number, axis, up);
            beside &= *word;
            add(*word & !beside, 1);
        }
    }
    halves.into_iter().map(|halves| (halves as f64 * 0.5 * f64::from(voxel_m).powi(3)) as f32).collect()
}

/// The cells of nodes that each know theirs.
fn summed(cell_of: &[u32], volumes_m3: &[f32], radii_m: &[f32]) -> Vec<Cell> {
    let mut cells: Vec<Cell> = Vec::new();
    for (node, &cell) in cell_of.iter().enumerate() {
        let cell = cell as usize;
        if cell == cells.len() {
            cells.push(Cell { volume_m3: 0.0, centre: NodeIndex::new(node) });
        }
        let cell = &mut cells[cell];
        cell.volume_m3 += volumes_m3[node];
        if radii_m[node] > radii_m[cell.centre.index()] {
            cell.centre = NodeIndex::new(node);
        }
    }
    cells
}
