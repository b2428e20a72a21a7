//! Which sides of the mesh's triangles border the void: what the view needs to look into rooms through the backs of their walls.

use glam::Vec3;
use lightvein::scene::Mesh;
use lightvein::voxel::Voxels;
use rayon::prelude::*;

/// How far off a face the void is looked for, voxels: voxels that a face touches are solid, so that up to two layers of them may
/// lie before it.
const STEPS_VOXELS: [f32; 3] = [0.75, 1.5, 2.25];

/// A triangle is asked at points no further apart than this many voxels, so that a floor under several rooms is seen by each.
const APART_VOXELS: f32 = 4.0;

/// Most rows of points in a triangle.
const MOST_ROWS: usize = 12;

/// For each triangle bit 0 where the void borders its front, bit 1 where it borders its back.
pub fn of(mesh: &Mesh, voxels: &Voxels) -> Vec<u8> {
    let sides = |triangle| mesh.corners_m(triangle).map_or(0, |corners_m| sides_of(corners_m, voxels));
    (0..mesh.triangles.len()).into_par_iter().map(sides).collect()
}

fn sides_of([a, b, c]: [Vec3; 3], voxels: &Voxels) -> u8 {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let voxel_m = voxels.lattice.voxel_m;
    let longest_m = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let rows = ((longest_m / (APART_VOXELS * voxel_m)).ceil() as usize).clamp(1, MOST_ROWS);
    let mut sides = 0;
    for row in 0..rows {
        for column in 0..rows - row {
            let [u, v] = [row, column].map(|at| (at as f32 + 1.0 / 3.0) / rows as f32);
            let at_m = a + u * (b - a) + v * (c - a);
            for (bit, outwards) in [(1, normal), (2, -normal)] {
                let mut before = STEPS_VOXELS.iter().map(|step| at_m + outwards * (step * voxel_m));
                let borders = before.any(|point_m| {
                    let voxel = voxels.lattice.voxel_at(point_m);
                    voxels.lattice.contains(voxel) && voxels.void.get(voxel)
                });
                sides |= if borders { bit } else { 0 };
            }
        }
        if sides == 3 {
            break;
        }
    }
    sides
}
