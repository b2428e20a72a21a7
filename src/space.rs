//! Where is a point: in metres, or in the voxel grid?
//!
//! A [`Lattice`] is the one place that converts between metres (`Vec3`, scene space, Z up, recentred on load) and voxels
//! ([`VoxelIndex`]). Voxel `(i, j, k)` fills the half-open box from `origin_m + voxel_m * (i, j, k)` to one voxel further;
//! its centre is half a voxel in. Corners of voxels are lattice points, numbered like the voxel above and beyond them.

use glam::{DVec3, IVec3, Vec3};

/// A voxel by its integer position in a [`Lattice`]; it may lie outside the grid, where everything is solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct VoxelIndex(pub IVec3);

impl VoxelIndex {
    /// The voxel at `(x, y, z)`.
    pub const fn new(x: i32, y: i32, z: i32) -> Self {
        Self(IVec3::new(x, y, z))
    }
}

/// A regular grid of cubes in scene space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// The lowest corner of voxel `(0, 0, 0)`, metres in scene space.
    pub origin_m: Vec3,
    /// The edge of a voxel, metres.
    pub voxel_m: f32,
    /// How many voxels there are along x, y and z; each at least 1.
    pub size: [usize; 3],
}

impl Lattice {
    /// The lattice around the box from `min_m` to `max_m`, with a voxel to spare on every side.
    ///
    /// It is offset by half a voxel from the box, so that axis-aligned walls on the box (and, for round sizes, inside
    /// it) fall on voxel centres rather than on voxel faces, where rounding would decide which side they take.
    pub fn around(min_m: Vec3, max_m: Vec3, voxel_m: f32) -> Self {
        let size = ((max_m - min_m) / voxel_m).ceil() + 3.0;
        Self { origin_m: min_m - 1.5 * voxel_m, voxel_m, size: size.to_array().map(|cells| (cells as usize).max(1)) }
    }

    /// The same grid moved by so many voxels along each axis (0 or more), with a layer more on every axis along which it
    /// moves: what lay within it still does.
    pub fn shifted(&self, by_voxels: Vec3) -> Self {
        let by_voxels = by_voxels.max(Vec3::ZERO);
        let more = by_voxels.ceil().to_array().map(|layers| layers as usize);
        Self {
            origin_m: self.origin_m - by_voxels * self.voxel_m,
            size: std::array::from_fn(|axis| self.size[axis] + more[axis]),
            ..*self
        }
    }

    /// The voxel that holds `point_m`; outside the grid where the point is.
    pub fn voxel_at(&self, point_m: Vec3) -> VoxelIndex {
        VoxelIndex(self.point_in_grid(point_m).floor().as_ivec3())
    }

    /// The centre of a voxel, metres.
    pub fn centre_m(&self, voxel: VoxelIndex) -> Vec3 {
        self.origin_m + self.voxel_m * (voxel.0.as_vec3() + 0.5)
    }

    /// The lattice point (lowest corner of the voxel of the same numbers), metres.
    pub fn corner_m(&self, corner: IVec3) -> Vec3 {
        self.origin_m + self.voxel_m * corner.as_vec3()
    }

    /// A point in units of voxels, measured from the grid's lowest corner.
    pub fn point_in_grid(&self, point_m: Vec3) -> Vec3 {
        (point_m - self.origin_m) / self.voxel_m
    }

    /// The same as [`Lattice::point_in_grid`] without the rounding of `f32`, for tests that must not lose an overlap.
    pub fn point_in_grid_exact(&self, point_m: Vec3) -> DVec3 {
        (point_m.as_dvec3() - self.origin_m.as_dvec3()) / f64::from(self.voxel_m)
    }

    /// Whether the voxel lies inside the grid.
    pub fn contains(&self, voxel: VoxelIndex) -> bool {
        let at = voxel.0.to_array();
        (0..3).all(|axis| at[axis] >= 0 && (at[axis] as usize) < self.size[axis])
    }

    /// How many voxels the grid has.
    pub fn voxels(&self) -> usize {
        self.size.iter().product()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_voxel_holds_its_centre() {
        let lattice = Lattice::around(Vec3::new(-1.0, 0.0, 2.0), Vec3::new(3.0, 1.0, 2.5), 0.25);
        assert_eq!(lattice.size, [19, 7, 5]);
        for voxel in [VoxelIndex::new(0, 0, 0), VoxelIndex::new(18, 6, 4), VoxelIndex::new(-3, 9, 1)] {
            assert_eq!(lattice.voxel_at(lattice.centre_m(voxel)), voxel);
        }
        assert!(lattice.contains(VoxelIndex::new(18, 6, 4)));
        assert!(!lattice.contains(VoxelIndex::new(19, 6, 4)));
        assert!(!lattice.contains(VoxelIndex::new(-1, 0, 0)));
    }

    #[test]
    fn a_shifted_lattice_keeps_the_box_inside() {
        let lattice = Lattice::around(Vec3::ZERO, Vec3::new(2.0, 1.0, 0.7), 0.25);
        for by_voxels in [Vec3::ZERO, Vec3::new(0.3, 0.9, 0.0), Vec3::ONE] {
            let shifted = lattice.shifted(by_voxels);
            for point_m in [Vec3::ZERO, Vec3::new(2.0, 1.0, 0.7)] {
                let moved = shifted.point_in_grid(point_m) - lattice.point_in_grid(point_m);
                assert!(moved.distance(by_voxels) < 1e-5, "{moved}");
                let VoxelIndex(at) = shifted.voxel_at(point_m);
                let last = IVec3::from_array(shifted.size.map(|cells| cells as i32 - 1));
                assert!(at.cmpgt(IVec3::ZERO).all() && at.cmplt(last).all(), "a voxel to spare: {at}");
            }
        }
    }

    #[test]
    fn walls_of_the_box_lie_on_voxel_centres() {
        let lattice = Lattice::around(Vec3::ZERO, Vec3::splat(2.0), 0.5);
        let wall_in_grid = lattice.point_in_grid(Vec3::ZERO).x;
        assert_eq!(wall_in_grid.fract(), 0.5);
    }
}
