//! What lies under the pointer: the node, sensor or light nearest to it on the screen, else the part of the mesh.

use crate::camera::Camera;
use crate::layers::Layers;
use crate::panels::scene::middle_m;
use crate::results::Results;
use crate::state::Picked;
use glam::{Vec2, Vec3};
use lightvein::scene::Light;

/// Nothing farther from the pointer than this is picked.
const REACH_PX: f32 = 12.0;

/// Sensors and lights win over nodes that are nearer by less than this: they are few and nodes are many.
const HEAD_START_PX: f32 = 4.0;

/// What lies under the pointer among the layers that are on; of two as near on the screen the one nearer to the eye.
pub fn pick(
    results: &Results,
    lights: &[Light],
    layers: &Layers,
    camera: &Camera,
    pointer_px: Vec2,
    size_px: Vec2,
) -> Option<Picked> {
    let mut best: Option<(f32, f32, Picked)> = None;
    let mut offer = |at_m: Vec3, head_start_px: f32, picked: Picked| {
        let Some((at_px, depth)) = camera.project(at_m, size_px) else { return };
        let off_px = at_px.distance(pointer_px);
        if off_px > REACH_PX {
            return;
        }
        let off_px = (off_px - head_start_px).max(0.0);
        // Depth is 1 at the eye and 0 far away.
        let wins = best.is_none_or(|(best_px, best_depth, _)| {
            off_px < best_px - 0.5 || ((off_px - best_px).abs() <= 0.5 && depth > best_depth)
        });
        if wins {
            best = Some((off_px, depth, picked));
        }
    };
    if layers.lights {
        for (number, light) in lights.iter().enumerate() {
            offer(middle_m(light), HEAD_START_PX, Picked::Light(number));
        }
    }
    if let (true, Some(scene)) = (layers.sensors, &results.scene) {
        for (number, sensor) in scene.sensors.iter().enumerate() {
            offer(sensor.position_m, HEAD_START_PX, Picked::Sensor(number));
        }
    }
    if let (true, Some(model)) = (layers.nodes, &results.model) {
        for node in model.skeleton.graph.node_indices() {
            offer(model.skeleton.graph[node].position_m, 0.0, Picked::Node(node));
        }
    }
    best.map(|(_, _, picked)| picked)
}

/// Where the pointer's ray meets the mesh where it is not cut away, metres, and the triangle; `None` where it meets nothing.
pub fn surface(
    results: &Results,
    camera: &Camera,
    pointer_px: Vec2,
    size_px: Vec2,
    hidden: impl Fn(Vec3, usize, Vec3) -> bool,
) -> Option<(Vec3, usize)> {
    let scene = results.scene.as_ref()?;
    let (origin_m, direction) = camera.ray(pointer_px, size_px);
    let mut nearest: Option<(f32, usize)> = None;
    // Few clicks: a look at each triangle is quick enough, and knows what is cut away.
    for triangle in 0..scene.mesh.triangles.len() {
        let Some(corners_m) = scene.mesh.corners_m(triangle) else { continue };
        let Some(along_m) = meets(origin_m, direction, corners_m) else { continue };
        if nearest.is_none_or(|(nearest_m, _)| along_m < nearest_m)
            && !hidden(origin_m + direction * along_m, triangle, direction)
        {
            nearest = Some((along_m, triangle));
        }
    }
    nearest.map(|(along_m, triangle)| (origin_m + direction * along_m, triangle))
}

/// How far along a ray it meets a triangle (Möller and Trumbore 1997).
fn meets(origin_m: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant.abs() < f32::MIN_POSITIVE {
        return None;
    }
    let from_a = origin_m - a;
    let u = from_a.dot(across) / determinant;
    let along_ab = from_a.cross(ab);
    let v = direction.dot(along_ab) / determinant;
    let along_m = ac.dot(along_ab) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && along_m > 0.0).then_some(along_m)
}

/// The part that a triangle belongs to.
pub fn part_of(results: &Results, triangle: usize) -> Option<usize> {
    let scene = results.scene.as_ref()?;
    let holds = |part: &lightvein::scene::parts::Part| {
        part.triangles.iter().any(|range| (range.start as usize..range.end as usize).contains(&triangle))
    };
    scene.parts.iter().position(holds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightvein::scene::{Scene, Sensor};
    use std::sync::Arc;

    #[test]
    fn the_nearest_on_the_screen_is_picked_and_lights_win_over_what_is_as_near() {
        let sensor = |x: f32| Sensor { id: x.to_string(), position_m: Vec3::new(x, 0.0, 0.0), normal: None };
        let scene = Scene { sensors: vec![sensor(0.0), sensor(1.0)], ..Scene::default() };
        let results = Results { scene: Some(Arc::new(scene)), ..Results::default() };
        let camera = Camera::fitted((Vec3::NEG_ONE, Vec3::ONE), 1.0);
        let size_px = Vec2::splat(400.0);
        let lights = [Light::Point { position_m: Vec3::new(1.0, 0.0, 0.0), flux_w: 1.0 }];
        let at = |at_m: Vec3, layers: &Layers| {
            let pointer_px = camera.project(at_m, size_px).unwrap().0 + Vec2::new(2.0, 0.0);
            pick(&results, &lights, layers, &camera, pointer_px, size_px)
        };
        let layers = Layers::default();
        assert_eq!(at(Vec3::ZERO, &layers), Some(Picked::Sensor(0)));
        assert_eq!(at(Vec3::X, &layers), Some(Picked::Light(0)));
        assert_eq!(at(Vec3::X, &Layers { lights: false, ..layers.clone() }), Some(Picked::Sensor(1)));
        assert_eq!(at(Vec3::new(0.5, 0.0, 0.5), &layers), None);
        assert_eq!(at(Vec3::ZERO, &Layers { sensors: false, ..layers }), None);
    }

    #[test]
    fn a_ray_meets_the_first_triangle_that_is_not_hidden() {
        let mut scene = Scene::default();
        for z in [0.0, 1.0_f32] {
            let first = scene.mesh.positions_m.len() as u32;
            scene.mesh.positions_m.extend([[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| Vec3::new(x, y, z)));
            scene.mesh.triangles.push([first, first + 1, first + 2]);
            scene.mesh.material_of.push(0);
        }
        let results = Results { scene: Some(Arc::new(scene)), ..Results::default() };
        let mut camera = Camera::fitted((Vec3::NEG_ONE, Vec3::ONE), 1.0);
        camera.look_from(crate::camera::Standard::Top);
        let size_px = Vec2::splat(200.0);
        let hit = |hidden: &dyn Fn(Vec3) -> bool| {
            surface(&results, &camera, size_px / 2.0, size_px, |at_m, _, _| hidden(at_m))
                .map(|(at_m, triangle)| (at_m.z.round(), triangle))
        };
        assert_eq!(hit(&|_| false), Some((1.0, 1)));
        assert_eq!(hit(&|at_m| at_m.z > 0.5), Some((0.0, 0)));
        assert_eq!(hit(&|_| true), None);
    }
}
