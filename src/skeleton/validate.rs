//! Is a skeleton what it promises to be?

use super::{Skeleton, topology};
use crate::voxel::bits::BitGrid;
use glam::IVec3;
use petgraph::graph::NodeIndex;
use petgraph::visit::EdgeRef;

impl Skeleton {
    /// Checks every invariant against the void it was made of; linear in the voxels.
    ///
    /// # Errors
    /// The first that is broken, by name.
    pub fn validate(&self, void: &BitGrid) -> Result<(), &'static str> {
        let corners: Vec<IVec3> = (self.graph.node_weights())
            .map(|node| self.lattice.point_in_grid(node.position_m).round().as_ivec3())
            .collect();
        let in_void = |corner: &IVec3| {
            (0..8).any(|i| void.get(crate::space::VoxelIndex(*corner - IVec3::new(i & 1, i >> 1 & 1, i >> 2))))
        };
        ensure(void.size() == self.lattice.size, "the lattice is the void's")?;
        ensure(corners.iter().all(in_void), "every node lies in the void or on its border")?;

        let apart = |a: NodeIndex, b: NodeIndex| (corners[a.index()] - corners[b.index()]).abs().element_sum();
        let edges = || self.graph.edge_references();
        ensure(edges().all(|edge| apart(edge.source(), edge.target()) == 1), "every edge is a step of one voxel")?;
        let positive = |length: f32| length > 0.0 && length.is_finite();
        ensure(self.graph.node_weights().all(|node| positive(node.radius_m)), "every radius is positive")?;
        ensure(
            self.graph.node_weights().all(|node| (1..=node.opening_voxels).contains(&node.distance_voxels)),
            "every distance is at least 1 and at most the opening",
        )?;
        ensure(
            edges().all(|edge| positive(edge.weight().length_m) && positive(edge.weight().section_m2)),
            "every length and section is positive",
        )?;

        self.validate_cells()?;
        self.validate_necks()?;
        self.validate_nearest(void)?;

        let (want, shape) = (topology::of_void(void), self.shape());
        ensure(shape.components as i64 == want.components, "there are as many components as the void has")?;
        ensure(shape.loops as i64 == want.loops, "there are as many loops as the void has")
    }

    fn validate_cells(&self) -> Result<(), &'static str> {
        let mut nodes = vec![0_usize; self.cells.len()];
        for node in self.graph.node_weights() {
            let Some(nodes) = nodes.get_mut(node.cell as usize) else { return Err("every node is in a cell") };
            *nodes += 1;
        }
        ensure(nodes.iter().all(|nodes| *nodes > 0), "every cell has a node")?;
        let at_centre = |cell: usize| self.graph.node_weight(self.cells[cell].centre);
        let centred = |cell: usize| at_centre(cell).is_some_and(|node| node.cell as usize == cell);
        ensure((0..self.cells.len()).all(centred), "every cell's centre is in it")?;
        ensure(
            self.cells.iter().all(|cell| cell.volume_m3 > 0.0 && cell.volume_m3.is_finite()),
            "every volume is positive",
        )
    }

    fn validate_necks(&self) -> Result<(), &'static str> {
        let mut crossed = vec![false; self.necks.len()];
        for edge in self.graph.edge_references() {
            let [a, b] = [edge.source(), edge.target()].map(|end| self.graph[end].cell);
            match edge.weight().neck {
                None => ensure(a == b, "an edge between two cells crosses a neck")?,
                Some(neck) => {
                    let Some(joined) = self.necks.get(neck as usize) else {
                        return Err("every neck of an edge exists");
                    };
                    ensure(joined.cells == [a.min(b), a.max(b)], "a neck joins the cells of its edges")?;
                    crossed[neck as usize] = true;
                }
            }
        }
        ensure(crossed.iter().all(|crossed| *crossed), "every neck is crossed by an edge")?;
        ensure(self.necks.iter().all(|neck| neck.cells[0] < neck.cells[1]), "every neck joins two different cells")?;
        ensure(
            self.necks.iter().all(|neck| neck.area_m2 > 0.0 && neck.area_m2.is_finite()),
            "every neck's area is positive",
        )?;
        ensure(self.necks.iter().all(|neck| neck.normal.is_normalized()), "every neck's normal is a unit vector")
    }

    fn validate_nearest(&self, void: &BitGrid) -> Result<(), &'static str> {
        let known = |node: NodeIndex| node.index() < self.graph.node_count();
        ensure(
            void.iter().all(|voxel| self.nearest_node(voxel).is_some_and(known)),
            "every void voxel has a nearest node",
        )
    }
}

fn ensure(holds: bool, name: &'static str) -> Result<(), &'static str> {
    if holds { Ok(()) } else { Err(name) }
}
