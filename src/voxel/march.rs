//! Which voxels does a segment pass, in order?
//!
//! The walk of Amanatides & Woo (1987): from face to face, always through the nearest. The number of steps along each axis
//! is fixed beforehand, so that rounding can change the order of two steps but never lead past the end. This is the only
//! voxel walk of the library.

use crate::space::{Lattice, VoxelIndex};
use glam::{DVec3, IVec3, Vec3};

/// A walk over the voxels of a segment; see [`march`].
#[derive(Debug, Clone)]
pub struct March {
    next: Option<IVec3>,
    step: IVec3,
    steps_left: IVec3,
    /// Where on the segment (0 to 1) the next face along each axis is crossed, and how far apart such faces are.
    crossing: DVec3,
    between: DVec3,
}

/// The voxels that the segment from `from_m` to `to_m` passes, from the one that holds its start to the one that holds its
/// end, each sharing a face with the one before. They may lie outside the grid. One voxel for a segment without length;
/// where the segment passes exactly through an edge it goes along x first, then y, then z.
pub fn march(lattice: &Lattice, from_m: Vec3, to_m: Vec3) -> March {
    let (start, end) = (lattice.voxel_at(from_m).0, lattice.voxel_at(to_m).0);
    let (from, to) = (lattice.point_in_grid(from_m).as_dvec3(), lattice.point_in_grid(to_m).as_dvec3());
    let step = (end - start).signum();
    let along = to - from;
    let (mut crossing, mut between) = (DVec3::INFINITY, DVec3::INFINITY);
    for axis in 0..3 {
        if step[axis] != 0 {
            let face = f64::from(start[axis]) + if step[axis] > 0 { 1.0 } else { 0.0 };
            crossing[axis] = (face - from[axis]) / along[axis];
            between[axis] = 1.0 / along[axis].abs();
        }
    }
    March { next: Some(start), step, steps_left: (end - start).abs(), crossing, between }
}

impl Iterator for March {
    type Item = VoxelIndex;

    fn next(&mut self) -> Option<VoxelIndex> {
        let here = self.next?;
        let open = (0..3).filter(|&axis| self.steps_left[axis] > 0);
        let axis = open.min_by(|&a, &b| self.crossing[a].total_cmp(&self.crossing[b]));
        self.next = axis.map(|axis| {
            let mut there = here;
            there[axis] += self.step[axis];
            self.steps_left[axis] -= 1;
            self.crossing[axis] += self.between[axis];
            there
        });
        Some(VoxelIndex(here))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lattice() -> Lattice {
        Lattice { origin_m: Vec3::new(-1.0, 2.0, 0.5), voxel_m: 0.25, size: [40, 40, 40] }
    }

    fn point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-4.0..4.0_f32).prop_map(Vec3::from_array)
    }

    proptest! {
        #[test]
        fn each_voxel_is_passed(from in point(), to in point()) {
            let lattice = lattice();
            let voxels: Vec<IVec3> = march(&lattice, from, to).map(|voxel| voxel.0).collect();
            prop_assert_eq!(voxels[0], lattice.voxel_at(from).0);
            prop_assert_eq!(voxels[voxels.len() - 1], lattice.voxel_at(to).0);
            for pair in voxels.windows(2) {
                prop_assert_eq!((pair[1] - pair[0]).abs().element_sum(), 1);
            }
            // The segment meets the box of each voxel, up to rounding.
            let (start, end) = (lattice.point_in_grid(from).as_dvec3(), lattice.point_in_grid(to).as_dvec3());
            for voxel in voxels {
                let (low, high) = (voxel.as_dvec3() - 1e-4, voxel.as_dvec3() + 1.0001);
                let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
                for axis in 0..3 {
                    let along = end[axis] - start[axis];
                    if along == 0.0 {
                        continue;
                    }
                    let (a, b) = ((low[axis] - start[axis]) / along, (high[axis] - start[axis]) / along);
                    enter = enter.max(a.min(b));
                    leave = leave.min(a.max(b));
                }
                prop_assert!(enter <= leave, "{} is off the segment", voxel);
            }
        }
    }

    #[test]
    fn a_point_is_one_voxel() {
        let at = Vec3::new(0.3, 2.2, 0.9);
        assert_eq!(march(&lattice(), at, at).collect::<Vec<_>>(), [lattice().voxel_at(at)]);
    }

    #[test]
    fn an_axis_is_walked_voxel_by_voxel() {
        let lattice = lattice();
        let (from, to) = (lattice.centre_m(VoxelIndex::new(5, 2, 2)), lattice.centre_m(VoxelIndex::new(1, 2, 2)));
        let along_x: Vec<i32> = march(&lattice, from, to).map(|voxel| voxel.0.x).collect();
        assert_eq!(along_x, [5, 4, 3, 2, 1]);
    }
}
