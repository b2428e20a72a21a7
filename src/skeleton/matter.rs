//! What stands around a point of the void, in voxels and in truth?
//!
//! The voxels tell at once where nothing is; the surfaces tell where something is. A [`Matter`] puts both side by side for
//! the sections and radii of the skeleton.

use crate::rays::Rays;
use crate::space::{Lattice, VoxelIndex};
use crate::voxel::bits::BitGrid;
use crate::voxel::brick;
use crate::voxel::levels::Levels;
use glam::{IVec3, Vec3};

/// Voxels along an edge of a brick.
const BRICK: i32 = brick::EDGE as i32;

/// Voxels and surfaces of one scene.
pub(crate) struct Matter<'a> {
    /// Where the voxels lie.
    pub lattice: Lattice,
    /// The flooded void.
    pub void: &'a BitGrid,
    /// Its chessboard distance.
    pub distance: &'a Levels,
    /// The surfaces.
    pub rays: &'a Rays,
}

/// A ray in units of voxels.
pub(crate) struct VoxelRay {
    from: Vec3,
    direction: Vec3,
    /// Voxels along the ray a voxel along each axis.
    inverse: Vec3,
}

impl VoxelRay {
    /// From a point of the grid along a unit vector.
    pub fn new(from: Vec3, direction: Vec3) -> Self {
        let inverse = Vec3::select(direction.abs().cmplt(Vec3::splat(1e-6)), Vec3::INFINITY, direction.recip());
        Self { from, direction, inverse }
    }

    /// The voxel that it is in.
    #[inline(always)]
    fn voxel(&self, along: f32) -> VoxelIndex {
        let at = self.from + self.direction * along;
        // Rounds down without a call to the C library.
        let whole = at.as_ivec3();
        VoxelIndex(whole - IVec3::select(at.cmplt(whole.as_vec3()), IVec3::ONE, IVec3::ZERO))
    }

    /// Where it leaves the cube of `2 free - 1` voxels around a voxel.
    #[inline(always)]
    fn leave_cube(&self, VoxelIndex(at): VoxelIndex, free: u16, along: f32) -> f32 {
        let (low, high) = (at - (i32::from(free) - 1), at + i32::from(free));
        let ahead = self.direction.cmpgt(Vec3::ZERO);
        let far = Vec3::select(ahead, high.as_vec3(), low.as_vec3()) - self.from;
        // Along an axis that it does not follow it never leaves.
        let out = Vec3::select(self.inverse.cmpeq(Vec3::INFINITY), Vec3::INFINITY, far * self.inverse);
        // Rounding must not hold the ray on the cube's face.
        out.min_element().max(along) + 1e-3
    }
}

impl Matter<'_> {
    /// Where a ray leaves the void, in voxels along it; `start` how far along to begin. At once `start` when it is not in
    /// the void there. The grid's border ends every ray.
    pub fn leave_void(&self, ray: &VoxelRay, start: f32) -> f32 {
        let mut along = start;
        loop {
            let voxel = ray.voxel(along);
            match self.distance.at(voxel) {
                0 => return along,
                free => along = ray.leave_cube(voxel, free, along),
            }
        }
    }

    /// Where a ray comes back into the void, from `start` on, in voxels along it; at most `depth` further.
    pub fn enter_void(&self, ray: &VoxelRay, start: f32, depth: f32) -> f32 {
        let mut along = start;
        while along < start + depth {
            let voxel = ray.voxel(along);
            if self.void.get(voxel) {
                return along;
            }
            along = ray.leave_cube(voxel, 1, along);
        }
        start + depth
    }

    /// Euclidean distance from a lattice corner to the nearest matter, metres.
    ///
    /// The nearest voxel that is not void is found exactly; matter stands half a voxel behind its face on average. A ray
    /// towards it finds the surface itself, and the distance square to that surface is taken where the two agree to a
    /// voxel.
    pub fn radius_m(&self, corner: IVec3) -> f32 {
        let voxel_m = self.lattice.voxel_m;
        let gap = self.gap(corner);
        let rough = gap.length() + 0.5;
        let Some(direction) = gap.try_normalize() else { return rough * voxel_m };
        let hit = self.rays.closest(self.lattice.corner_m(corner), direction, (rough + 1.0) * voxel_m);
        let exact = hit.map(|hit| hit.distance_m * direction.dot(hit.normal).abs() / voxel_m);
        exact.filter(|exact| (exact - rough).abs() < 1.0).unwrap_or(rough) * voxel_m
    }

    /// From a lattice corner straight to the nearest voxel that is not void, in voxels; of equally near ones to the first
    /// in z, then y, then x. Outside the grid nothing is void.
    fn gap(&self, corner: IVec3) -> Vec3 {
        let size = IVec3::from_array(self.void.size().map(|along| along as i32));
        let axes = IVec3::AXES.into_iter();
        let borders = axes.flat_map(|axis| [-axis * corner, axis * (size - corner)]);
        let mut best = borders.min_by_key(|gap| order(*gap)).unwrap_or(IVec3::ZERO);

        // Bricks in growing cubes around the corner, from where there can be matter until the cube is beyond the best.
        let home = (corner - 1) / BRICK;
        let empty = i32::from(self.distance.at_corner(corner)) - 1;
        for ring in empty / BRICK.. {
            if (BRICK * (ring - 1).max(0)).pow(2) > best.length_squared() {
                break;
            }
            for z in (0..=2 * ring).map(outwards) {
                let gap_z = gap_along(BRICK * (home.z + z) - corner.z, BRICK);
                for y in (0..=2 * ring).map(outwards) {
                    let gap_y = gap_along(BRICK * (home.y + y) - corner.y, BRICK);
                    if gap_z * gap_z + gap_y * gap_y > best.length_squared() {
                        continue;
                    }
                    let full = z.abs() == ring || y.abs() == ring;
                    for x in (if full { 0 } else { 2 * ring - 1 }..=2 * ring).map(outwards) {
                        best = self.nearer(best, corner, home + IVec3::new(x, y, z));
                    }
                }
            }
        }
        best.as_vec3()
    }

    /// The best gap so far, or one to a voxel of a brick that is better.
    fn nearer(&self, best: IVec3, corner: IVec3, at: IVec3) -> IVec3 {
        let bricks = IVec3::from_array(self.void.bricks().map(|along| along as i32));
        let low = at * BRICK - corner;
        if at.min_element() < 0 || at.cmpge(bricks).any() || gap_to(low, BRICK).length_squared() > best.length_squared()
        {
            return best;
        }
        let number = (at.x + bricks.x * (at.y + bricks.y * at.z)) as usize;
        let matter = match self.void.words()[number] {
            u64::MAX => return best,
            word => !word & self.void.inside(number),
        };
        let voxels = brick::ones(matter).map(|bit| bit as i32);
        let gaps = voxels.map(|bit| gap_to(low + IVec3::new(bit & 3, bit >> 2 & 3, bit >> 4), 1));
        gaps.chain([best]).min_by_key(|gap| order(*gap)).unwrap_or(best)
    }
}

/// The shorter of two gaps comes first, of equals the lower.
fn order(gap: IVec3) -> (i32, i32, i32, i32) {
    (gap.length_squared(), gap.z, gap.y, gap.x)
}

/// From the origin straight to the cube with that lowest corner and edge.
fn gap_to(low: IVec3, edge: i32) -> IVec3 {
    IVec3::from_array(low.to_array().map(|low| gap_along(low, edge)))
}

/// From the origin to the span from `low` on, along one axis.
fn gap_along(low: i32, edge: i32) -> i32 {
    low.max(0) + (low + edge).min(0)
}

/// 0, -1, 1, -2, 2 and so on, by their places.
fn outwards(place: i32) -> i32 {
    if place % 2 == 0 { place / 2 } else { -(place + 1) / 2 }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::job::Cancel;
    use crate::scene::Scene;
    use crate::voxel::chessboard::Chessboard;
    use proptest::prelude::*;

    /// A void made by hand: voxels of a metre, and no surfaces.
    pub struct Grid {
        pub lattice: Lattice,
        pub void: BitGrid,
        pub board: Chessboard,
        pub rays: Rays,
    }

    impl Grid {
        pub fn new(void: BitGrid) -> Self {
            let board = Chessboard::new(&void, &Cancel::new()).unwrap();
            let lattice = Lattice { origin_m: Vec3::ZERO, voxel_m: 1.0, size: void.size() };
            Self { lattice, void, board, rays: Rays::new(&Scene::default()) }
        }

        pub fn matter(&self) -> Matter<'_> {
            Matter { lattice: self.lattice, void: &self.void, distance: &self.board.distance, rays: &self.rays }
        }
    }

    /// Boxes of void, each from its lowest voxel to beyond its highest.
    pub fn boxes(size: [usize; 3], boxes: &[(IVec3, IVec3)]) -> Grid {
        let mut void = BitGrid::new(size);
        for (low, high) in boxes {
            for z in low.z..high.z {
                for y in low.y..high.y {
                    for x in low.x..high.x {
                        void.set(VoxelIndex::new(x, y, z), true);
                    }
                }
            }
        }
        Grid::new(void)
    }

    fn nearest_plainly(void: &BitGrid, corner: IVec3) -> f32 {
        let [nx, ny, nz] = void.size().map(|along| along as i32);
        let mut best = f32::INFINITY;
        for (x, y, z) in (-1..=nx).flat_map(|x| (-1..=ny).flat_map(move |y| (-1..=nz).map(move |z| (x, y, z)))) {
            if !void.get(VoxelIndex::new(x, y, z)) {
                let low = (IVec3::new(x, y, z) - corner).as_vec3();
                let apart = Vec3::ZERO.clamp(low, low + 1.0);
                best = best.min(apart.length() + 0.5);
            }
        }
        best
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]
        #[test]
        fn the_nearest_matter_is_found(solids in prop::collection::vec((0..20, 0..9, 0..13), 0..12), at in (0..21, 0..10, 0..14)) {
            let mut void = BitGrid::new([20, 9, 13]);
            void.fill(true);
            for (x, y, z) in solids {
                void.set(VoxelIndex::new(x, y, z), false);
            }
            let grid = Grid::new(void);
            let corner = IVec3::new(at.0, at.1, at.2);
            let want = nearest_plainly(&grid.void, corner);
            prop_assert!((grid.matter().radius_m(corner) - want).abs() < 1e-4);
        }
    }

    #[test]
    fn outwards_goes_to_both_sides() {
        assert_eq!((0..5).map(outwards).collect::<Vec<_>>(), [0, -1, 1, -2, 2]);
    }

    #[test]
    fn rays_leave_the_void_where_it_ends() {
        let grid = boxes(
            [20, 8, 8],
            &[(IVec3::new(2, 2, 2), IVec3::new(9, 6, 6)), (IVec3::new(12, 2, 2), IVec3::new(19, 6, 6))],
        );
        let matter = grid.matter();
        let from = Vec3::new(4.0, 4.0, 4.0);
        let ahead = VoxelRay::new(from, Vec3::X);
        let leave = matter.leave_void(&ahead, 0.0);
        assert!((leave - 5.0).abs() < 0.01, "{leave}");
        assert!((matter.enter_void(&ahead, leave, 8.0) - 8.0).abs() < 0.01);
        assert!((matter.enter_void(&ahead, leave, 2.0) - 7.0).abs() < 0.01);
        assert!((matter.leave_void(&VoxelRay::new(from, -Vec3::X), 0.0) - 2.0).abs() < 0.01);
    }
}
