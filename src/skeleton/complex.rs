//! Which points, edges, faces and cubes are left of the void?
//!
//! A cubical complex on the lattice of voxel corners, one bit a cell in eight planes: plane `m` (0 to 7) holds the cells
//! that span the axes whose bits are set in `m`, each at its lowest corner. So 0 are points, 1, 2, 4 edges along x, y, z,
//! 6, 5, 3 the faces across x, y, z, and 7 cubes, the voxels themselves. The closure of a void has every face, edge and
//! point of its cubes; two voxels that touch at a corner are joined there, so the void is 26-connected.
//!
//! Cells are stored in bricks of 4 x 4 x 4 positions, the eight words of a brick side by side in one cache line. Past the
//! last brick of each row, column and plane lies an empty one, and as many before the first brick: so a neighbour is at a
//! fixed offset, and looking for one needs no test for the grid's end.

use crate::space::VoxelIndex;
use crate::voxel::bits::BitGrid;
use crate::voxel::brick::{self, EDGE, from_below};
use glam::IVec3;
use rayon::prelude::*;

/// The cells of one brick by the axes they span.
pub type Cells = [u64; 8];

/// The plane of cubes in [`Cells`].
pub const CUBES: usize = 7;

/// The plane of faces across an axis.
pub const fn across(axis: usize) -> usize {
    CUBES ^ 1 << axis
}

/// A cubical complex.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Complex {
    layout: Layout,
    cells: Vec<Cells>,
}

/// Where the bricks of a complex lie in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Voxels along x, y and z; the lattice has a point more.
    pub size: [usize; 3],
    /// Bricks along x, y and z, an empty one at each end included.
    pub bricks: [usize; 3],
    /// How far the neighbouring brick is along x, y and z.
    pub stride: [usize; 3],
    /// Empty bricks in front of the first one, and behind the last.
    pub guard: usize,
}

impl Layout {
    /// The layout for a void of that many voxels along x, y and z.
    pub fn new(size: [usize; 3]) -> Self {
        let bricks = size.map(|voxels| (voxels + 1).div_ceil(EDGE) + 1);
        let stride = [1, bricks[0], bricks[0] * bricks[1]];
        Self { size, bricks, stride, guard: stride.iter().sum() }
    }

    /// How many bricks there are, those in front and behind included.
    pub fn count(&self) -> usize {
        self.bricks.iter().product::<usize>() + 2 * self.guard
    }

    /// Whether a brick may have cells: neither in front of the first nor behind the last one.
    pub fn holds(&self, brick: usize) -> bool {
        (self.guard..self.count() - self.guard).contains(&brick)
    }

    /// The brick of a lattice point and its bit there; `None` off the lattice.
    #[inline]
    pub fn place(&self, corner: IVec3) -> Option<(usize, u32)> {
        let [x, y, z] = corner.to_array().map(|along| along as usize);
        let on = x <= self.size[0] && y <= self.size[1] && z <= self.size[2];
        on.then(|| {
            let brick = x / EDGE + self.stride[1] * (y / EDGE) + self.stride[2] * (z / EDGE);
            (self.guard + brick, brick::bit(x % EDGE, y % EDGE, z % EDGE))
        })
    }

    /// The lattice point of a bit of a brick, the inverse of [`Layout::place`].
    #[inline]
    pub fn corner(&self, brick: usize, bit: u32) -> IVec3 {
        let at = brick - self.guard;
        let (x, y, z) = (at % self.bricks[0], at / self.bricks[0] % self.bricks[1], at / self.stride[2]);
        let first = IVec3::new(x as i32, y as i32, z as i32) * EDGE as i32;
        first + IVec3::new(bit as i32 & 3, bit as i32 >> 2 & 3, bit as i32 >> 4)
    }
}

impl Complex {
    /// The closure of a void: its voxels with all their faces, edges and points.
    pub fn closure(void: &BitGrid) -> Self {
        let layout = Layout::new(void.size());
        let mut cells = vec![[0; 8]; layout.count()];
        let [across, rows, planes] = void.bricks();
        let slab = layout.stride[2];
        let nothing = vec![0; across];
        let row = |y: usize, z: usize| match y < rows && z < planes {
            true => &void.words()[across * (y + rows * z)..][..across],
            false => &nothing[..],
        };
        let inside = &mut cells[layout.guard..][..layout.bricks.iter().product()];
        inside.par_chunks_mut(slab).take(planes + 1).enumerate().for_each(|(z, slab)| {
            for (y, line) in slab.chunks_mut(layout.bricks[0]).take(rows + 1).enumerate() {
                let (z_low, y_low) = (z.wrapping_sub(1), y.wrapping_sub(1));
                let rows = [row(y, z), row(y_low, z), row(y, z_low), row(y_low, z_low)];
                if rows.iter().all(|row| row.iter().all(|word| *word == 0)) {
                    continue;
                }
                let mut low = [0; 4];
                for (x, cells) in line.iter_mut().take(across + 1).enumerate() {
                    let here = rows.map(|row| row.get(x).copied().unwrap_or(0));
                    if here.iter().chain(&low).any(|word| *word != 0) {
                        *cells = close(here, low);
                    }
                    low = here;
                }
            }
        });
        Self { layout, cells }
    }

    /// Where bricks lie.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The cells of all bricks.
    pub fn cells(&self) -> &[Cells] {
        &self.cells
    }

    /// The cells of all bricks for writing; removing a cell before those it bounds breaks the complex.
    pub fn cells_mut(&mut self) -> &mut [Cells] {
        &mut self.cells
    }

    /// Whether the cell at a corner that spans the axes of `plane` is left.
    pub fn has(&self, corner: IVec3, plane: usize) -> bool {
        self.layout.place(corner).is_some_and(|(brick, bit)| self.cells[brick][plane] >> bit & 1 == 1)
    }

    /// Takes the inside of a cell out, not its boundary.
    pub fn remove(&mut self, corner: IVec3, plane: usize) {
        if let Some((brick, bit)) = self.layout.place(corner) {
            self.cells[brick][plane] &= !(1 << bit);
        }
    }

    /// Takes out the face between two voxels that share it; with anything else nothing happens.
    pub fn remove_face_between(&mut self, a: VoxelIndex, b: VoxelIndex) {
        let step = (a.0 - b.0).abs();
        if let Some(axis) = (0..3).find(|axis| step == IVec3::AXES[*axis]) {
            self.remove(a.0.max(b.0), CUBES ^ 1 << axis);
        }
    }

    /// How many points, edges, faces and cubes there are.
    pub fn count(&self) -> [usize; 4] {
        self.cells.iter().fold([0; 4], |mut count, cells| {
            for (plane, word) in cells.iter().enumerate() {
                count[plane.count_ones() as usize] += word.count_ones() as usize;
            }
            count
        })
    }
}

/// The closure's cells in a brick, from the cubes of the brick and those below it along y, z, and both (`here`), and of
/// their neighbours below along x (`low`).
fn close(here: [u64; 4], low: [u64; 4]) -> Cells {
    // Along each axis a cell that does not span it lies between the cube at its position and the one below.
    let between_x = [0, 1, 2, 3].map(|i| here[i] | from_below::<0>(here[i], low[i]));
    let between_y = |cubes: [u64; 4]| {
        [cubes[0] | from_below::<1>(cubes[0], cubes[1]), cubes[2] | from_below::<1>(cubes[2], cubes[3])]
    };
    let between_z = |here: u64, below: u64| here | from_below::<2>(here, below);
    let (edges_z, across_y) = (between_y(between_x), between_y(here));
    [
        between_z(edges_z[0], edges_z[1]),
        between_z(across_y[0], across_y[1]),
        between_z(between_x[0], between_x[2]),
        between_z(here[0], here[2]),
        edges_z[0],
        across_y[0],
        between_x[0],
        here[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_voxel_has_all_its_faces_edges_and_points() {
        for at in [IVec3::ZERO, IVec3::new(3, 3, 3), IVec3::new(4, 2, 6), IVec3::new(4, 6, 6)] {
            let mut void = BitGrid::new([5, 7, 7]);
            void.set(VoxelIndex(at), true);
            let mut complex = Complex::closure(&void);
            assert_eq!(complex.count(), [8, 12, 6, 1]);
            for cell in 0..27 {
                let step = IVec3::new(cell % 3, cell / 3 % 3, cell / 9);
                let plane = (0..3).filter(|axis| step[*axis] == 2).fold(0, |plane, axis| plane | 1 << axis);
                assert!(complex.has(at + step % 2, plane), "{at} {step}");
            }
            complex.remove_face_between(VoxelIndex(at), VoxelIndex(at + IVec3::Y));
            assert!(!complex.has(at + IVec3::Y, 5));
            assert_eq!(complex.count(), [8, 12, 5, 1]);
        }
    }

    #[test]
    fn a_full_grid_closes_without_holes() {
        for size in [[1, 2, 3], [4, 4, 4], [7, 8, 9], [3, 11, 5]] {
            let mut void = BitGrid::new(size);
            void.fill(true);
            let [x, y, z] = size;
            let complex = Complex::closure(&void);
            assert_eq!(complex.count()[0], (x + 1) * (y + 1) * (z + 1));
            assert_eq!(complex.count()[3], x * y * z);
            let [points, edges, faces, cubes] = complex.count().map(|count| count as i64);
            assert_eq!(points - edges + faces - cubes, 1);
            for (brick, cells) in complex.cells().iter().enumerate() {
                for bit in brick::ones(cells[0]) {
                    let corner = complex.layout().corner(brick, bit);
                    assert_eq!(complex.layout().place(corner), Some((brick, bit)));
                }
            }
        }
    }
}
