//! Which cells of the skeleton lie in the open?
//!
//! Those that reach the box around the mesh, beyond which there is only sky and what lies below it.

use crate::model::Model;
use crate::space::VoxelIndex;
use glam::IVec3;

/// For each cell whether it reaches the box around the mesh. Linear in the voxels of the box's faces.
pub fn open_cells(model: &Model) -> Vec<bool> {
    let mut open = vec![false; model.skeleton.cells.len()];
    let graph = &model.skeleton.graph;
    let size = model.voxels.lattice.size.map(|along| along as i32);
    let mut look = |at: IVec3| {
        let node = model.skeleton.nearest.node(VoxelIndex(at)).and_then(|node| graph.node_weight(node.into()));
        if let Some(open) = node.and_then(|node| open.get_mut(node.cell as usize)) {
            *open = true;
        }
    };
    for axis in 0..3 {
        let (one, other) = ((axis + 1) % 3, (axis + 2) % 3);
        for a in 0..size[one] {
            for b in 0..size[other] {
                for along in [0, size[axis] - 1] {
                    let mut at = IVec3::ZERO;
                    (at[axis], at[one], at[other]) = (along, a, b);
                    look(at);
                }
            }
        }
    }
    open
}

/// Whether a cell is in the open; one that no number names is not.
pub fn is_open(open: &[bool], cell: u32) -> bool {
    open.get(cell as usize).copied().unwrap_or(false)
}
