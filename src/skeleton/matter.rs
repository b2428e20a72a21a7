//! What stands around a point of the void, in voxels and in truth?
//!
//! The voxels tell at once where nothing is; the surfaces tell where something is. A [`Matter`] puts both side by side for
//! the sections and radii of the skeleton.

use crate::rays::Rays;
use crate::space::{Lattice, VoxelIndex};
use crate::voxel::bits::BitGrid;
use crate::voxel::brick::{self, EDGE};
use crate::voxel::levels::Levels;
use glam::{IVec3, Vec3};

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

impl Matter<'_> {
    /// Where a ray leaves the void, in voxels along it; `from` in units of voxels, `start` how far along to begin. At once
    /// `start` when it is not in the void there. The grid's border ends every ray.
    pub fn leave_void(&self, from: Vec3, direction: Vec3, start: f32) -> f32 {
        let mut along = start;
        loop {
            let voxel = voxel_on(from, direction, along);
            match self.distance.at(voxel) {
                0 => return along,
                free => along = self.leave_cube(from, direction, voxel, free, along),
            }
        }
    }

    /// Where a ray comes back into the void, from `start` on, in voxels along it; at most `depth` further.
    pub fn enter_void(&self, from: Vec3, direction: Vec3, start: f32, depth: f32) -> f32 {
        let mut along = start;
        loop {
            let voxel = voxel_on(from, direction, along);
            if along >= start + depth {
                return start + depth;
            }
            if self.distance.at(voxel) > 0 {
                return along;
            }
            along = self.leave_cube(from, direction, voxel, 1, along);
        }
    }

    /// Where a ray leaves the cube of `2 free - 1` voxels around a voxel.
    fn leave_cube(&self, from: Vec3, direction: Vec3, VoxelIndex(at): VoxelIndex, free: u16, along: f32) -> f32 {
        let (low, high) = (at - (i32::from(free) - 1), at + i32::from(free));
        let far = Vec3::select(direction.cmpgt(Vec3::ZERO), high.as_vec3(), low.as_vec3());
        let out = Vec3::select(direction.abs().cmplt(Vec3::splat(1e-6)), Vec3::INFINITY, (far - from) / direction);
        // Rounding must not hold the ray on the cube's face.
        out.min_element().max(along) + 1e-3
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

    /// From a lattice corner straight to the nearest voxel that is not void, in voxels; to the first in the order of
    /// bricks of equally near ones. Outside the grid nothing is void.
    fn gap(&self, corner: IVec3) -> Vec3 {
        let size = IVec3::from_array(self.void.size().map(|along| along as i32));
        let bricks = self.void.bricks();
        let axes = IVec3::AXES.into_iter();
        let borders = axes.flat_map(|axis| [-axis * corner, axis * (size - corner)]);
        let mut best = borders.min_by_key(|gap| gap.length_squared()).unwrap_or(IVec3::ZERO);

        // Bricks in growing cubes around the corner, until the cube is beyond the best.
        let home = (corner - 1) / EDGE as i32;
        for ring in 0.. {
            let nearest = EDGE as i32 * (ring - 1).max(0);
            if nearest * nearest >= best.length_squared() {
                break;
            }
            for at in shell(ring).map(|offset| home + offset) {
                let inside = at.min_element() >= 0 && (0..3).all(|axis| (at[axis] as usize) < bricks[axis]);
                let low = at * EDGE as i32 - corner;
                if !inside || gap_to(low, EDGE as i32).length_squared() >= best.length_squared() {
                    continue;
                }
                let number = at.x as usize + bricks[0] * (at.y as usize + bricks[1] * at.z as usize);
                let matter = !self.void.words()[number] & self.void.inside(number);
                for bit in brick::ones(matter).map(|bit| bit as i32) {
                    let gap = gap_to(low + IVec3::new(bit & 3, bit >> 2 & 3, bit >> 4), 1);
                    if gap.length_squared() < best.length_squared() {
                        best = gap;
                    }
                }
            }
        }
        best.as_vec3()
    }
}

/// From the origin straight to the cube with that lowest corner and edge.
fn gap_to(low: IVec3, edge: i32) -> IVec3 {
    low.max(IVec3::ZERO) + (low + edge).min(IVec3::ZERO)
}

/// The voxel that a ray is in.
fn voxel_on(from: Vec3, direction: Vec3, along: f32) -> VoxelIndex {
    VoxelIndex((from + direction * along).floor().as_ivec3())
}

/// The offsets whose largest coordinate is `ring`.
fn shell(ring: i32) -> impl Iterator<Item = IVec3> {
    let all = -ring..=ring;
    all.clone().flat_map(move |z| {
        let all = all.clone();
        all.clone().flat_map(move |y| {
            let full = z.abs() == ring || y.abs() == ring;
            let step = if full || ring == 0 { 1 } else { 2 * ring as usize };
            (-ring..=ring).step_by(step).map(move |x| IVec3::new(x, y, z))
        })
    })
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
    fn shells_fill_the_cube() {
        assert_eq!((0..4).map(|ring| shell(ring).count()).sum::<usize>(), 7 * 7 * 7);
    }

    #[test]
    fn rays_leave_the_void_where_it_ends() {
        let grid = boxes(
            [20, 8, 8],
            &[(IVec3::new(2, 2, 2), IVec3::new(9, 6, 6)), (IVec3::new(12, 2, 2), IVec3::new(19, 6, 6))],
        );
        let matter = grid.matter();
        let from = Vec3::new(4.0, 4.0, 4.0);
        let leave = matter.leave_void(from, Vec3::X, 0.0);
        assert!((leave - 5.0).abs() < 0.01, "{leave}");
        assert!((matter.enter_void(from, Vec3::X, leave, 8.0) - 8.0).abs() < 0.01);
        assert!((matter.enter_void(from, Vec3::X, leave, 2.0) - 7.0).abs() < 0.01);
        assert!((matter.leave_void(from, -Vec3::X, 0.0) - 2.0).abs() < 0.01);
    }
}
