//! How would the walls be if they were rough?
//!
//! Vertices at one place become one, edges longer than asked for are halved until none is (both faces of an edge see the same
//! edge, so no gap opens), and each vertex moves along its normal by a number of its own. A mesh that is closed stays
//! closed. Limits: where an edge meets the middle of another (a T-junction) the mesh was not closed and gapes; a sheet with
//! two faces has no normal and stays smooth; walls thinner than twice the noise may pass through each other.

use crate::flow::sequence;
use crate::scene::{Mesh, Scene};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// Rounds of halving; each at least halves the longest edge, so that this is more than any mesh needs.
const MOST_ROUNDS: usize = 24;

/// No mesh is cut finer than this many triangles.
const MOST_TRIANGLES: usize = 4_000_000;

/// The scene with its mesh cut into triangles with edges up to `longest_m`, and each vertex moved by up to `amplitude_m`
/// either way, evenly. The same seed gives the same numbers, whatever the amplitude.
pub fn roughened(scene: &Scene, amplitude_m: f32, longest_m: f32, seed: u64) -> Scene {
    let mut mesh = refined(&welded(&scene.mesh), longest_m);
    let normals = normals(&mesh);
    for (number, (position_m, normal)) in mesh.positions_m.iter_mut().zip(normals).enumerate() {
        let [share, _] = sequence::offset(seed, number as u64);
        *position_m += amplitude_m * (2.0 * share - 1.0) as f32 * normal;
    }
    Scene { mesh, reference: Vec::new(), ..scene.clone() }
}

/// The mesh with one vertex at each place.
fn welded(mesh: &Mesh) -> Mesh {
    let mut number_at = HashMap::new();
    let mut positions_m: Vec<Vec3> = Vec::new();
    let mut number_of = |position_m: &Vec3| {
        // Zero has two signs and one place.
        let place = (*position_m + Vec3::ZERO).to_array().map(f32::to_bits);
        *number_at.entry(place).or_insert_with(|| {
            positions_m.push(*position_m);
            positions_m.len() as u32 - 1
        })
    };
    let numbers: Vec<u32> = mesh.positions_m.iter().map(&mut number_of).collect();
    let corner = |old: u32| numbers.get(old as usize).copied().unwrap_or(u32::MAX);
    let triangles = mesh.triangles.iter().map(|triangle| triangle.map(corner)).collect();
    Mesh { positions_m, triangles, material_of: mesh.material_of.clone() }
}

/// The mesh with all edges longer than that halved, again and again.
fn refined(mesh: &Mesh, longest_m: f32) -> Mesh {
    let mut mesh = mesh.clone();
    for _ in 0..MOST_ROUNDS {
        let halved = halved_once(&mesh, longest_m);
        let is_done = halved.triangles.len() == mesh.triangles.len() || halved.triangles.len() > MOST_TRIANGLES;
        if is_done {
            break;
        }
        mesh = halved;
    }
    mesh
}

fn halved_once(mesh: &Mesh, longest_m: f32) -> Mesh {
    let mut positions_m = mesh.positions_m.clone();
    let mut middle_of: HashMap<[u32; 2], Option<u32>> = HashMap::new();
    let mut halved = Mesh::default();
    for (number, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        let mut middle = |from: u32, to: u32| {
            *middle_of.entry([from.min(to), from.max(to)]).or_insert_with(|| {
                let ends = [from, to].map(|end| mesh.positions_m.get(end as usize).copied());
                let [Some(from_m), Some(to_m)] = ends else { return None };
                (from_m.distance(to_m) > longest_m).then(|| {
                    positions_m.push(0.5 * (from_m + to_m));
                    positions_m.len() as u32 - 1
                })
            })
        };
        let parts = parts([a, b, c], [middle(a, b), middle(b, c), middle(c, a)]);
        let material = mesh.material_of.get(number).copied().unwrap_or_default();
        halved.material_of.extend(parts.iter().map(|_| material));
        halved.triangles.extend(parts);
    }
    Mesh { positions_m, ..halved }
}

/// A triangle cut at the middles of its edges `ab`, `bc` and `ca` that have one.
fn parts([a, b, c]: [u32; 3], middles: [Option<u32>; 3]) -> Vec<[u32; 3]> {
    match middles {
        [None, None, None] => vec![[a, b, c]],
        [Some(ab), None, None] => vec![[a, ab, c], [ab, b, c]],
        [Some(ab), Some(bc), None] => vec![[a, ab, c], [ab, b, bc], [ab, bc, c]],
        [Some(ab), Some(bc), Some(ca)] => vec![[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]],
        // The same three, begun at another corner.
        [ab, bc, ca] => parts([b, c, a], [bc, ca, ab]),
    }
}

/// The unit normal of each vertex, by the areas of its faces; zero where they cancel.
fn normals(mesh: &Mesh) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; mesh.positions_m.len()];
    for (number, triangle) in mesh.triangles.iter().enumerate() {
        let Some([a, b, c]) = mesh.corners_m(number) else { continue };
        let twice_area = (b - a).cross(c - a).as_dvec3();
        for &corner in triangle {
            if let Some(sum) = sums.get_mut(corner as usize) {
                *sum += twice_area;
            }
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::voxel::test_scenes::{boxed, scene_of};

    #[test]
    fn a_rough_box_is_closed_and_no_farther_off_than_asked() {
        let scene = scene_of(&boxed(Vec3::ZERO, Vec3::new(3.0, 2.0, 1.0)));
        let rough = roughened(&scene, 0.05, 0.3, 7);
        assert!(rough.mesh.triangles.len() > 400);
        // Each directed edge has its opposite: closed, and turned the same way all over.
        let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
        for &[a, b, c] in &rough.mesh.triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *edges.entry([from, to]).or_default() += 1;
                let edge_m = rough.mesh.positions_m[from as usize].distance(rough.mesh.positions_m[to as usize]);
                assert!(edge_m < 0.3 + 2.0 * 0.05, "{edge_m}");
            }
        }
        assert!(edges.iter().all(|(&[from, to], &count)| count == 1 && edges.get(&[to, from]) == Some(&1)));
        let (low, high) = rough.mesh.bounds_m().unwrap();
        let off_m = (low.abs()).max((high - Vec3::new(3.0, 2.0, 1.0)).abs()).max_element();
        assert!((0.02..=0.0501).contains(&off_m), "{off_m}");
    }

    #[test]
    fn without_noise_it_is_the_same_surface() {
        let scene = scene_of(&boxed(Vec3::ZERO, Vec3::ONE));
        let area_m2 = |scene: &Scene| crate::model::walls::Walls::of(scene).area_m2();
        assert!((area_m2(&roughened(&scene, 0.0, 0.2, 1)) - area_m2(&scene)).abs() < 1e-5);
    }
}
