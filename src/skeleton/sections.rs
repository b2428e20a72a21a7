//! How wide is the void across its skeleton?
//!
//! A section is cut by a plane through a point of the skeleton, across the way the curve runs there. Its border is felt by
//! a fan of rays in the plane: each walks the voxels to the first one that is not void (by leaps: the chessboard distance
//! says how far nothing stands), and from there takes the true surface, for conservative voxels make every passage about a
//! voxel too narrow. Where no surface crosses the ray in that voxel, as when a plane runs beside a wall without
//! thickness, the wall is taken to stand half a voxel in, which is right on average.
//!
//! The fan sees what is in sight from its point; parts of the section behind a corner are not in it. Flat rooms are why
//! the ball's own area is no section: it is the height's, not the room's.

use super::matter::{Matter, VoxelRay};
use glam::Vec3;
use std::f32::consts::TAU;

/// Rays of a fan across an edge: a square's area comes out to 1%.
pub const RAYS: usize = 32;

/// Beyond the first voxel that is not void, a wall is looked for no further than this many voxels: a ray that meets a wall
/// at 5 degrees runs six voxels from the voxels of the wall to the wall itself.
const DEPTH_VOXELS: f32 = 8.0;

/// A wall this little behind where the void begins again still stands before it.
const ROUNDING_VOXELS: f32 = 1e-3;

/// The void across one point, in a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// The point it was felt from, metres.
    pub centre_m: Vec3,
    /// Unit normal of the plane.
    pub normal: Vec3,
    /// Its area, m2.
    pub area_m2: f32,
    /// How far the void reaches in each direction of the fan, metres.
    reaches_m: Vec<f32>,
}

impl Section {
    /// Feels the section across `normal` at `centre_m` with `rays` rays.
    pub fn new(matter: &Matter, centre_m: Vec3, normal: Vec3, rays: usize) -> Self {
        let fan = directions(normal, rays);
        let reaches_m: Vec<f32> = fan.map(|direction| reach_m(matter, centre_m, direction)).collect();
        let area_m2 = reaches_m.iter().map(|reach| reach * reach).sum::<f32>() * TAU / (2 * rays) as f32;
        Self { centre_m, normal, area_m2, reaches_m }
    }

    /// Its area alone, without keeping the reaches.
    pub fn area_m2(matter: &Matter, centre_m: Vec3, normal: Vec3, rays: usize) -> f32 {
        let squares = directions(normal, rays).map(|direction| reach_m(matter, centre_m, direction).powi(2));
        squares.sum::<f32>() * TAU / (2 * rays) as f32
    }

    /// The middle of the area, metres.
    pub fn middle_m(&self) -> Vec3 {
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for (direction, reach) in directions(self.normal, self.reaches_m.len()).zip(&self.reaches_m) {
            sum += direction * reach.powi(3) * (2.0 / 3.0);
            weight += reach * reach;
        }
        self.centre_m + if weight > 0.0 { sum / weight } else { Vec3::ZERO }
    }

    /// Its border, a point for each ray of the fan, metres.
    pub fn outline_m(&self) -> Vec<Vec3> {
        let rays = directions(self.normal, self.reaches_m.len()).zip(&self.reaches_m);
        rays.map(|(direction, reach_m)| self.centre_m + direction * *reach_m).collect()
    }

    /// Whether a point, moved straight onto the plane, falls into the section.
    pub fn covers(&self, point_m: Vec3) -> bool {
        let to = point_m - self.centre_m;
        let in_plane = to - self.normal * to.dot(self.normal);
        let nearest = directions(self.normal, self.reaches_m.len())
            .zip(&self.reaches_m)
            .max_by(|a, b| a.0.dot(in_plane).total_cmp(&b.0.dot(in_plane)));
        nearest.is_none_or(|(_, reach)| in_plane.length() <= *reach)
    }
}

/// Unit vectors across `normal`, evenly all round.
fn directions(normal: Vec3, rays: usize) -> impl Iterator<Item = Vec3> {
    let (u, v) = normal.any_orthonormal_pair();
    (0..rays).map(move |ray| {
        let (sin, cos) = ((ray as f32 + 0.5) * TAU / rays as f32).sin_cos();
        u * cos + v * sin
    })
}

/// How far the void reaches from a point of it in a direction, metres.
fn reach_m(matter: &Matter, from_m: Vec3, direction: Vec3) -> f32 {
    let voxel_m = matter.lattice.voxel_m;
    let ray = VoxelRay::new(matter.lattice.point_in_grid(from_m), direction);
    let enter = matter.leave_void(&ray, 1e-3);

    // A little before the voxel, so that a surface on its very face is met.
    let start = (enter - 0.05).max(0.0);
    let most = DEPTH_VOXELS + enter - start;
    let hit = matter.rays.closest(from_m + direction * (start * voxel_m), direction, most * voxel_m);
    let wall = hit.map(|hit| start + hit.distance_m / voxel_m);

    // Where the ray comes back into the void first, it has passed beside the wall.
    let end = matter.enter_void(&ray, enter, wall.map_or(DEPTH_VOXELS, |wall| wall - enter));
    let reach = wall.filter(|wall| *wall <= end + ROUNDING_VOXELS).unwrap_or(enter + 0.5 * (end - enter).min(1.0));
    reach * voxel_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::matter::tests::{Grid, boxes};
    use glam::IVec3;

    #[test]
    fn a_section_is_that_of_the_room() {
        let grid: Grid = boxes([30, 30, 30], &[(IVec3::new(3, 4, 5), IVec3::new(25, 24, 17))]);
        let matter = grid.matter();
        let centre_m = Vec3::new(12.0, 14.0, 11.0);
        // Half a voxel is given back on each side: 21 x 13, not 20 x 12.
        for (normal, want) in [(Vec3::X, 21.0 * 13.0), (Vec3::Y, 23.0 * 13.0), (Vec3::Z, 23.0 * 21.0)] {
            let section = Section::new(&matter, centre_m, normal, 64);
            assert!((section.area_m2 / want - 1.0).abs() < 0.03, "{} for {want}", section.area_m2);
            assert!(section.covers(centre_m + 3.0 * normal));
            assert!(!section.covers(centre_m + 30.0 * normal.any_orthonormal_vector()));
        }
        let off = Section::new(&matter, Vec3::new(8.0, 8.0, 8.0), Vec3::Y, 256);
        assert!((off.middle_m() - Vec3::new(14.0, 8.0, 11.0)).length() < 0.4, "{}", off.middle_m());
    }
}
