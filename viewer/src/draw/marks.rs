//! What stands in the scene besides: sensors, lights, what is picked with its ball, its direction and its ways to the lights.

use super::mesh::face;
use super::veins::line;

use crate::measure::Measure;
use crate::outdoors::facade::Facade;
use crate::paint::{Ball, Batch, Corner, Culling, FaceStyle, Stroke, What};
use crate::panels::inspector::WayToLight;
use crate::results::Results;
use crate::state::Picked;
use crate::theme::{BACKWARD, FORWARD};
use glam::Vec3;
use lightvein::light::Reading;
use lightvein::model::Model;
use lightvein::scene::{Light, Scene};
use std::sync::Arc;

/// A lamp's colour.
const LAMP: [u8; 4] = [255, 214, 90, 255];

/// What is picked.
const PICKED: [u8; 4] = [255, 80, 160, 255];

/// A sensor's radius as a share of the scene's longest side.
const SENSOR_OF_SCENE: f32 = 0.004;

/// A normal and a direction are drawn so long, as shares of the scene's longest side.
const NORMAL_OF_SCENE: f32 = 0.015;
const DIRECTION_OF_SCENE: f32 = 0.07;

/// The sensors with their values of a measure, and a line along the normal of each that has one.
pub fn sensors(results: &Results, measure: Measure, longest_m: f32) -> (Vec<Ball>, Vec<Stroke>) {
    let Some(scene) = &results.scene else { return Default::default() };
    let values = measure.at_sensors(results);
    let value = |number: usize| values.get(number).copied().unwrap_or(f32::NAN);
    let balls = scene.sensors.iter().enumerate().map(|(number, sensor)| Ball {
        centre_m: sensor.position_m,
        radius_m: SENSOR_OF_SCENE * longest_m,
        value: value(number),
        colour: [128, 128, 128, 255],
    });
    let normal = |(number, sensor): (usize, &lightvein::scene::Sensor)| {
        let towards_m = sensor.position_m + sensor.normal? * NORMAL_OF_SCENE * longest_m;
        Some(Stroke { value: value(number), ..line(sensor.position_m, towards_m, 2.5, [128, 128, 128, 255]) })
    };
    (balls.collect(), scene.sensors.iter().enumerate().filter_map(normal).collect())
}

/// The lights: points as balls of a size on screen, spheres in their own, quads as they are.
pub fn lights(lights: &[Light], longest_m: f32) -> Vec<Batch> {
    let (mut points, mut spheres, mut quads, mut normals) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let ball = |centre_m, radius_m| Ball { centre_m, radius_m, value: f32::NAN, colour: LAMP };
    for light in lights {
        match *light {
            Light::Point { position_m, .. } => points.push(ball(position_m, 0.008 * longest_m)),
            Light::Sphere { centre_m, radius_m, .. } => spheres.push(ball(centre_m, radius_m)),
            Light::Quad { corner_m, u_m, v_m, .. } => {
                let [a, b, c, d] = [corner_m, corner_m + u_m, corner_m + u_m + v_m, corner_m + v_m];
                quads.extend(face([a, b, c], f32::NAN, LAMP, 3));
                quads.extend(face([a, c, d], f32::NAN, LAMP, 3));
                let (middle_m, normal) = ((a + c) / 2.0, u_m.cross(v_m).normalize_or_zero());
                let tip_m = middle_m + normal * NORMAL_OF_SCENE * longest_m;
                normals.push(Stroke { arrow: true, ..line(middle_m, tip_m, 2.0, LAMP) });
            }
        }
    }
    vec![
        Batch::new(What::Balls { data: Arc::new(points), least_px: 6.0, most_px: 12.0 }),
        Batch::new(What::Balls { data: Arc::new(spheres), least_px: 5.0, most_px: f32::INFINITY }),
        flat(quads, 1.0),
        Batch::new(What::Strokes { data: Arc::new(normals) }),
    ]
}

/// Faces in their own colours, unlit, from both sides.
pub fn flat(data: Vec<Corner>, opacity: f32) -> Batch {
    let what = What::Faces { data: Arc::new(data), style: FaceStyle::Flat, culling: Culling::None };
    Batch { opacity, ..Batch::new(what) }
}

/// A picked face: its normal as an arrow where it was touched.
pub fn facade(facade: &Facade, longest_m: f32) -> Batch {
    let tip_m = facade.at_m + facade.normal * DIRECTION_OF_SCENE * longest_m;
    let arrow = Stroke { arrow: true, ..line(facade.at_m, tip_m, 3.0, PICKED) };
    Batch { on_top: true, ..Batch::new(What::Strokes { data: Arc::new(vec![arrow]) }) }
}

/// Where something that can be picked is, metres.
pub fn position_m(results: &Results, lights: &[Light], picked: Picked) -> Option<Vec3> {
    match picked {
        Picked::Node(node) => Some(results.model.as_ref()?.skeleton.graph.node_weight(node)?.position_m),
        Picked::Sensor(sensor) => Some(results.scene.as_ref()?.sensors.get(sensor)?.position_m),
        Picked::Light(light) => lights.get(light).map(crate::panels::scene::middle_m),
        Picked::Part(part) => {
            let scene = results.scene.as_ref()?;
            let bounds = bounds_of_part(scene, part)?;
            Some((bounds.0 + bounds.1) / 2.0)
        }
    }
}

/// The box around a part, metres.
pub fn bounds_of_part(scene: &Scene, part: usize) -> Option<(Vec3, Vec3)> {
    let corners = scene.corners_of(part);
    corners.fold(None, |bounds: Option<(Vec3, Vec3)>, at_m| {
        Some(bounds.map_or((at_m, at_m), |(low, high)| (low.min(at_m), high.max(at_m))))
    })
}

/// A mark around what is picked or under the pointer, its largest ball, and where its light comes from.
pub fn picked(results: &Results, lights: &[Light], picked: Picked, shows_ball: bool, longest_m: f32) -> Vec<Batch> {
    let Some(at_m) = position_m(results, lights, picked) else { return Vec::new() };
    let mut batches = Vec::new();
    if let (Picked::Part(part), Some(scene)) = (picked, &results.scene) {
        if let Some(bounds) = bounds_of_part(scene, part) {
            batches.push(Batch { on_top: true, ..Batch::new(What::Strokes { data: Arc::new(edges_of_box(bounds)) }) });
        }
        return batches;
    }
    let ball = |radius_m| Ball { centre_m: at_m, radius_m, value: f32::NAN, colour: PICKED };
    let mark = Arc::new(vec![ball(0.006 * longest_m)]);
    batches.push(Batch { on_top: true, ..Batch::new(What::Balls { data: mark, least_px: 6.0, most_px: 11.0 }) });
    if let (true, Picked::Node(node), Some(model)) = (shows_ball, picked, &results.model)
        && let Some(node) = model.skeleton.graph.node_weight(node)
    {
        let data = Arc::new(vec![Ball { colour: [120, 200, 255, 255], ..ball(node.radius_m) }]);
        batches
            .push(Batch { opacity: 0.28, ..Batch::new(What::Balls { data, least_px: 1.0, most_px: f32::INFINITY }) });
    }
    if let Some(reading) = reading(results, picked) {
        let towards = reading.direction().as_vec3();
        if towards != Vec3::ZERO {
            let from_m = at_m + towards * DIRECTION_OF_SCENE * longest_m;
            let arrow = Stroke { arrow: true, ..line(from_m, at_m, 3.0, PICKED) };
            batches.push(Batch { on_top: true, ..Batch::new(What::Strokes { data: Arc::new(vec![arrow]) }) });
        }
    }
    batches
}

fn reading(results: &Results, picked: Picked) -> Option<Reading> {
    let estimate = results.estimate.as_ref()?;
    match picked {
        Picked::Node(node) => estimate.at_nodes.readings.get(node.index()).copied(),
        Picked::Sensor(sensor) => estimate.at_sensors.readings.get(sensor).copied(),
        Picked::Light(_) | Picked::Part(_) => None,
    }
}

/// The ways from what is picked to the lights: forward along the veins from each light, backward straight to the farthest node
/// that is seen and on from there.
pub fn ways(model: &Model, at_m: Vec3, ways: &[WayToLight]) -> Vec<Stroke> {
    let mut strokes = Vec::new();
    for to_light in ways {
        let (Some(way), Some(light)) = (&to_light.way, model.shining.get(to_light.light)) else { continue };
        let veins_m = way.nodes.iter().rev().map(|&node| model.node_m(node));
        let points_m: Vec<Vec3> = std::iter::once(light.position_m).chain(veins_m).chain([at_m]).collect();
        strokes.extend(points_m.windows(2).map(|pair| line(pair[0], pair[1], 4.0, opaque(FORWARD))));

        let mut seen_m = vec![at_m];
        if way.seen_share > 0.0 {
            seen_m.push(light.position_m);
        } else {
            let beyond = way.nodes.iter().skip_while(|&&node| node != way.farthest);
            seen_m.extend(beyond.map(|&node| model.node_m(node)));
            seen_m.push(light.position_m);
        }
        let dashed = |pair: &[Vec3]| Stroke { dashed: true, ..line(pair[0], pair[1], 2.5, opaque(BACKWARD)) };
        strokes.extend(seen_m.windows(2).map(dashed));
    }
    strokes
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

fn edges_of_box((low, high): (Vec3, Vec3)) -> Vec<Stroke> {
    let corner = |bits: usize| Vec3::from_array(std::array::from_fn(|axis| [low, high][bits >> axis & 1][axis]));
    let along =
        |axis: usize| (0..8).filter(move |bits| bits >> axis & 1 == 0).map(move |bits| (bits, bits | 1 << axis));
    (0..3).flat_map(along).map(|(from, to)| line(corner(from), corner(to), 2.0, PICKED)).collect()
}

/// The axes of the gizmo at a point, metres long: x, y, z in red, green, blue, and the letters for who does not tell colours.
pub fn gizmo(at_m: Vec3, length_m: f32) -> Vec<Stroke> {
    let colours = [[235, 80, 70, 255], [90, 190, 80, 255], [80, 130, 240, 255]];
    let axis = |(axis, colour)| Stroke { arrow: true, ..line(at_m, at_m + Vec3::AXES[axis] * length_m, 3.5, colour) };
    colours.into_iter().enumerate().map(axis).collect()
}
