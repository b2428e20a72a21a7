//! Small meshes for the tests of voxels and of what is made of them.

use crate::scene::{Material, Mesh, Scene};
use glam::{Quat, Vec3};

/// The twelve triangles of a box.
pub fn boxed(low: Vec3, high: Vec3) -> Vec<[Vec3; 3]> {
    let corner = |i: usize| Vec3::new([low.x, high.x][i & 1], [low.y, high.y][i >> 1 & 1], [low.z, high.z][i >> 2]);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.map(|triangle| triangle.map(corner)).collect()
}

/// Triangles turned about the origin, then shifted.
pub fn moved(triangles: &[[Vec3; 3]], turn: Quat, shift: Vec3) -> Vec<[Vec3; 3]> {
    triangles.iter().map(|triangle| triangle.map(|corner| turn * corner + shift)).collect()
}

/// A scene of these triangles with one grey material.
pub fn scene_of(triangles: &[[Vec3; 3]]) -> Scene {
    let count = triangles.len() as u32;
    let mesh = Mesh {
        positions_m: triangles.iter().flatten().copied().collect(),
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        material_of: vec![0; triangles.len()],
    };
    let grey = Material { name: "grey".into(), reflectance: 0.5, transmittance: 0.0, emission_w_m2_sr: 0.0 };
    Scene { mesh, materials: vec![grey], ..Scene::default() }
}
