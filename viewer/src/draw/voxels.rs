//! Voxels as the squares between those that are shown and those that are not: matter, void, void by its distance to matter, cells.

use crate::layers::{Slice, VoxelShow};
use crate::paint::Cube;
use crate::theme::category;
use glam::IVec3;
use lightvein::model::Model;
use lightvein::space::VoxelIndex;
use lightvein::voxel::bits::BitGrid;
use lightvein::voxel::euclid::{Beyond, squared_distances};
use std::sync::Arc;

/// Squares beyond this are left out: a graphics card without memory of its own would stall on more.
pub const MOST_FACES: usize = 1_500_000;

/// What is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Show {
    /// The voxel layer.
    Voxels(VoxelShow),
    /// The void by its cells.
    Cells,
}

/// Squares, and how many were left out.
#[derive(Debug, Clone, Default)]
pub struct Squares {
    /// The squares.
    pub cubes: Arc<Vec<Cube>>,
    /// How many there would be besides.
    pub left_out: usize,
}

/// The squares around the voxels that are shown, within a slice where one is asked for.
pub fn squares(model: &Model, show: Show, slice: Option<Slice>) -> Squares {
    let voxels = &model.voxels;
    let grid: &BitGrid = match show {
        Show::Voxels(VoxelShow::Solid) => &voxels.solid,
        Show::Voxels(VoxelShow::Void | VoxelShow::Distance) | Show::Cells => &voxels.void,
    };
    let lattice = &voxels.lattice;
    let plane = slice.map(|Slice { axis, share }| {
        let axis = axis.min(2);
        (axis, ((share * lattice.size[axis] as f32) as i32).clamp(0, lattice.size[axis] as i32 - 1))
    });
    let is_shown =
        |VoxelIndex(at): VoxelIndex| plane.is_none_or(|(axis, place)| at[axis] == place) && grid.get(VoxelIndex(at));
    let distances =
        (show == Show::Voxels(VoxelShow::Distance)).then(|| squared_distances(&voxels.solid, Beyond::Solid));
    let cell = |voxel| {
        let node = model.skeleton.nearest_node(voxel)?;
        Some(model.skeleton.graph[node].cell)
    };
    let [wide, deep, _] = lattice.size;
    let mut cubes = Vec::new();
    let mut left_out = 0;
    for voxel in grid.iter().filter(|&voxel| is_shown(voxel)) {
        let own_cell = if show == Show::Cells { cell(voxel) } else { None };
        for face in 0..6 {
            let step = IVec3::AXES[face as usize / 2] * if face % 2 == 0 { 1 } else { -1 };
            let beside = VoxelIndex(voxel.0 + step);
            let is_inner = is_shown(beside) && (show != Show::Cells || cell(beside) == own_cell);
            if is_inner {
                continue;
            }
            if cubes.len() >= MOST_FACES {
                left_out += 1;
                continue;
            }
            let [x, y, z] = voxel.0.to_array().map(|along| along as usize);
            let value = distances
                .as_ref()
                .and_then(|all| all.get(x + wide * (y + deep * z)))
                .map_or(f32::NAN, |squared| (*squared as f32).sqrt() * lattice.voxel_m);
            let [r, g, b] = match show {
                Show::Voxels(VoxelShow::Solid) => [176, 170, 160],
                Show::Voxels(_) => [120, 160, 200],
                Show::Cells => own_cell.map_or([128; 3], |cell| category(cell as usize)),
            };
            cubes.push(Cube { centre_m: lattice.centre_m(voxel), face, value, colour: [r, g, b, 255] });
        }
    }
    Squares { cubes: Arc::new(cubes), left_out }
}
