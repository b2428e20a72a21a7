//! Which sides of the mesh's triangles border the void: what the view needs to look into rooms through the backs of their walls.

use glam::Vec3;
use lightvein::scene::Mesh;
use lightvein::space::VoxelIndex;
use lightvein::voxel::Voxels;
use rayon::prelude::*;

/// How far off a face the void is looked for, voxels: voxels that a face touches are solid, so that up to two layers of them may
/// lie before it.
const STEPS_VOXELS: [f32; 3] = [0.75, 1.5, 2.25];

/// A triangle is asked at points no further apart than this many voxels, so that a floor under several rooms is seen by each.
const APART_VOXELS: f32 = 4.0;

/// Most rows of points in a triangle.
const MOST_ROWS: usize = 12;

/// The void that a viewer looks into.
pub struct Inside<'a> {
    voxels: &'a Voxels,
    /// By column the height of its topmost solid voxel, where only the void under a roof counts.
    roofs: Option<Vec<i32>>,
}

impl<'a> Inside<'a> {
    /// The whole void where that is enclosed, or where the scene has no roof; else, of a house whose doors let the void out, the
    /// void with matter above it. `stand_m` are its lights and sensors, whose places say which.
    pub fn of(voxels: &'a Voxels, stand_m: impl Iterator<Item = Vec3>) -> Self {
        let is_enclosed = !voxels.voids.is_empty() && voxels.voids.iter().all(|void| !void.leaks);
        let inside = Self { voxels, roofs: Some(roofs(voxels)) };
        let under: Vec<bool> = stand_m.map(|at_m| inside.is_void_at(at_m)).collect();
        let roofed = under.iter().filter(|is_under| **is_under).count();
        if is_enclosed || 2 * roofed < under.len().max(1) { Self { voxels, roofs: None } } else { inside }
    }

    /// Whether the scene is one that is lived in from inside: enclosed, or under a roof.
    pub fn is_indoors(&self) -> bool {
        let is_enclosed = !self.voxels.voids.is_empty() && self.voxels.voids.iter().all(|void| !void.leaks);
        is_enclosed || self.roofs.is_some()
    }

    fn is_void_at(&self, point_m: Vec3) -> bool {
        let voxel = self.voxels.lattice.voxel_at(point_m);
        self.voxels.lattice.contains(voxel) && self.voxels.void.get(voxel) && self.is_roofed(voxel)
    }

    fn is_roofed(&self, VoxelIndex(at): VoxelIndex) -> bool {
        let Some(roofs) = &self.roofs else { return true };
        let column = at.x as usize + self.voxels.lattice.size[0] * at.y as usize;
        roofs.get(column).is_some_and(|roof| at.z < *roof)
    }
}

/// By column, x fastest, the height of its topmost solid voxel; -1 without one.
fn roofs(voxels: &Voxels) -> Vec<i32> {
    let [wide, deep, _] = voxels.lattice.size;
    let mut roofs = vec![-1; wide * deep];
    for VoxelIndex(at) in voxels.solid.iter() {
        if let Some(roof) = roofs.get_mut(at.x as usize + wide * at.y as usize) {
            *roof = at.z.max(*roof);
        }
    }
    roofs
}

/// For each triangle bit 0 where the void borders its front, bit 1 where it borders its back.
pub fn of(mesh: &Mesh, inside: &Inside) -> Vec<u8> {
    let sides = |triangle| mesh.corners_m(triangle).map_or(0, |corners_m| sides_of(corners_m, inside));
    (0..mesh.triangles.len()).into_par_iter().map(sides).collect()
}

fn sides_of([a, b, c]: [Vec3; 3], inside: &Inside) -> u8 {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let voxel_m = inside.voxels.lattice.voxel_m;
    let longest_m = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let rows = ((longest_m / (APART_VOXELS * voxel_m)).ceil() as usize).clamp(1, MOST_ROWS);
    let mut sides = 0;
    for row in 0..rows {
        for column in 0..rows - row {
            let [u, v] = [row, column].map(|at| (at as f32 + 1.0 / 3.0) / rows as f32);
            let at_m = a + u * (b - a) + v * (c - a);
            for (bit, outwards) in [(1, normal), (2, -normal)] {
                let mut before = STEPS_VOXELS.iter().map(|step| at_m + outwards * (step * voxel_m));
                let borders = before.any(|point_m| inside.is_void_at(point_m));
                sides |= if borders { bit } else { 0 };
            }
        }
        if sides == 3 {
            break;
        }
    }
    sides
}
