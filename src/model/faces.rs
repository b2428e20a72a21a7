//! Where is a mesh asked for its light: its faces, cut small enough to show a gradient, on the side that sees the void.

use super::{Model, Probe};
use crate::scene::Scene;
use glam::Vec3;

/// Faces are cut until no edge is longer than this many voxels; below it the estimators have nothing more to tell.
const LONGEST_EDGE_VOXELS: f32 = 8.0;

/// Faces times lights are held to about this many, some seconds of work; the edges of faces may then be longer.
const MOST_QUESTIONS: f32 = 200_000.0;

impl Model {
    /// The mesh as small triangles whose front sees the void, three corners each, metres. Faces that no void touches are
    /// left out; one that the void touches on both sides keeps its own front.
    pub fn faces_to_void(&self, scene: &Scene) -> Vec<[Vec3; 3]> {
        let triangles_m = || (0..scene.mesh.triangles.len()).filter_map(|triangle| scene.mesh.corners_m(triangle));
        let area_m2: f32 = triangles_m().map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum();
        // Two right triangles fill a square of the longest edge's half: at least area / edge^2 * 4 faces come of it.
        let most_faces = MOST_QUESTIONS / self.shining.len().max(1) as f32;
        let bound_m = (4.0 * area_m2 / most_faces).sqrt();
        let longest_m = (LONGEST_EDGE_VOXELS * self.voxels.lattice.voxel_m).max(bound_m);

        let mut small_m = Vec::new();
        for triangle_m in triangles_m() {
            cut(triangle_m, longest_m, &mut small_m);
        }
        small_m.into_iter().filter_map(|face_m| self.turned_to_void(face_m)).collect()
    }

    /// The faces as planar probes at their centres, in their order.
    pub fn probes_at_faces(&self, faces_m: &[[Vec3; 3]]) -> Vec<Probe> {
        faces_m.iter().map(|face_m| self.probe(centre_m(face_m), Some(front(face_m)))).collect()
    }

    fn turned_to_void(&self, face_m: [Vec3; 3]) -> Option<[Vec3; 3]> {
        let [a, b, c] = face_m;
        let sees_void = |side: &[Vec3; 3]| self.place(centre_m(side), Some(front(side))).is_ok();
        [face_m, [a, c, b]].into_iter().find(sees_void)
    }
}

/// Halves a triangle at its longest edge until that is short enough. Neighbours halve a shared edge at the same point, so no
/// cracks open.
fn cut(triangle_m: [Vec3; 3], longest_m: f32, into: &mut Vec<[Vec3; 3]>) {
    let mut left = vec![triangle_m];
    while let Some([a, b, c]) = left.pop() {
        let edges = [(a.distance(b), [a, b, c]), (b.distance(c), [b, c, a]), (c.distance(a), [c, a, b])];
        let (edge_m, [from, to, apex]) =
            edges.into_iter().fold(edges[0], |long, edge| if edge.0 > long.0 { edge } else { long });
        if edge_m <= longest_m {
            into.push([a, b, c]);
        } else {
            let middle = (from + to) / 2.0;
            left.push([from, middle, apex]);
            left.push([middle, to, apex]);
        }
    }
}

fn centre_m(face_m: &[Vec3; 3]) -> Vec3 {
    face_m.iter().sum::<Vec3>() / 3.0
}

fn front(face_m: &[Vec3; 3]) -> Vec3 {
    let [a, b, c] = *face_m;
    (b - a).cross(c - a).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use crate::rays::Rays;
    use crate::scene::Light;
    use crate::voxel::test_scenes::{boxed, scene_of};
    use std::sync::Arc;

    #[test]
    fn the_walls_of_a_room_are_asked_on_the_inside() {
        let mut scene = scene_of(&boxed(Vec3::ZERO, Vec3::splat(2.0)));
        scene.lights.push(Light::Point { position_m: Vec3::splat(1.0), flux_w: 1.0 });
        // A plate outside, which no void touches.
        let first = scene.mesh.positions_m.len() as u32;
        scene.mesh.positions_m.extend([Vec3::X * 4.0, Vec3::X * 5.0, Vec3::new(4.0, 1.0, 0.0)]);
        scene.mesh.triangles.push([first, first + 1, first + 2]);
        scene.mesh.material_of.push(0);
        let rays = Arc::new(Rays::new(&scene));
        let model = Model::build(&scene, rays, 0.1, u64::MAX, &Quiet, &Cancel::new()).unwrap();

        let faces_m = model.faces_to_void(&scene);
        let area_m2: f32 = faces_m.iter().map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum();
        assert!((area_m2 - 24.0).abs() < 1e-3, "{area_m2}");
        for probe in model.probes_at_faces(&faces_m) {
            assert!(probe.place.is_ok());
            assert!(probe.normal.unwrap().dot(Vec3::splat(1.0) - probe.position_m) > 0.9, "{probe:?}");
        }
    }

    #[test]
    fn cutting_keeps_the_area_and_bounds_the_edges() {
        let mut small = Vec::new();
        cut([Vec3::ZERO, Vec3::new(10.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 1.0)], 0.7, &mut small);
        let area = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).length() / 2.0;
        let whole = area([Vec3::ZERO, Vec3::new(10.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 1.0)]);
        let sum: f32 = small.iter().map(|&face| area(face)).sum();
        assert!((sum - whole).abs() < 1e-3 * whole);
        let longest =
            small.iter().flat_map(|&[a, b, c]| [a.distance(b), b.distance(c), c.distance(a)]).fold(0.0, f32::max);
        assert!(longest <= 0.7);
    }
}
