//! Small scenes with known light for the tests of the estimators, and what all of them share.

use super::*;
use crate::job::Quiet;
use crate::rays::Rays;
use crate::scene::{Light, Scene, Sensor};
use crate::skeleton::{Edge, Node, Skeleton};
use crate::voxel::test_scenes::{boxed, scene_of};
use glam::{DVec3, Vec3};
use petgraph::graph::UnGraph;
use std::sync::Arc;

pub const FLUX_W: f64 = 100.0;

/// Voxels of all scenes here, metres.
const VOXEL_M: f32 = 0.1;

/// A scene and its model.
pub type Modelled = (Scene, Model);

/// A room of 3 x 3 x 3 m.
pub fn room() -> Vec<[Vec3; 3]> {
    boxed(Vec3::ZERO, Vec3::splat(3.0))
}

/// A room of 8 x 3 x 3 m, parted by a wall from x = 3.8 to 4.2; the door in it goes from y = 2 to 3, floor to ceiling.
pub fn two_rooms() -> Vec<[Vec3; 3]> {
    let mut triangles = boxed(Vec3::ZERO, Vec3::new(8.0, 3.0, 3.0));
    triangles.extend(boxed(Vec3::new(3.8, 0.0, 0.0), Vec3::new(4.2, 2.0, 3.0)));
    triangles
}

pub fn lamp(position_m: Vec3, flux_w: f64) -> Light {
    Light::Point { position_m, flux_w }
}

pub fn sensor(position_m: Vec3, normal: Option<Vec3>) -> Sensor {
    Sensor { id: position_m.to_string(), position_m, normal }
}

pub fn model_of(scene: &Scene) -> Model {
    Model::build(scene, Arc::new(Rays::new(scene)), VOXEL_M, u64::MAX, &Quiet, &Cancel::new()).unwrap()
}

pub fn modelled(triangles: &[[Vec3; 3]], lights: Vec<Light>, sensors: Vec<Sensor>) -> Modelled {
    let scene = Scene { lights, sensors, ..scene_of(triangles) };
    let model = model_of(&scene);
    (scene, model)
}

/// The field of an estimator at the scene's sensors.
pub fn field(
    (scene, model): &Modelled,
    estimate: impl Fn(&Model, &[Probe], &Settings, &dyn Progress, &Cancel) -> Result<Field, Cancelled>,
) -> Field {
    let probes = model.probes_at_sensors(scene);
    estimate(model, &probes, &Settings::default(), &Quiet, &Cancel::new()).unwrap()
}

/// The same to the rounding of positions in `f32`.
#[track_caller]
pub fn close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} is not {expected}");
}

/// A skeleton of nodes with these openings (voxels), joined by edges of these lengths (metres).
pub fn veins(openings: &[u16], edges: &[(u32, u32, f32)]) -> Skeleton {
    let node = |&opening_voxels: &u16| Node {
        position_m: Vec3::ZERO,
        radius_m: 1.0,
        distance_voxels: 1,
        opening_voxels,
        cell: 0,
        volume_m3: 1.0,
    };
    let mut graph = UnGraph::default();
    openings.iter().for_each(|opening| _ = graph.add_node(node(opening)));
    for &(a, b, length_m) in edges {
        graph.add_edge(a.into(), b.into(), Edge { length_m, section_m2: 1.0, opening_voxels: u16::MAX, neck: None });
    }
    let (_, model) = modelled(&boxed(Vec3::ZERO, Vec3::ONE), Vec::new(), Vec::new());
    Skeleton { graph, ..(*model.skeleton).clone() }
}

/// What a heuristic of the tests gives: one W/m2 from above, wherever the light's tree reaches.
fn one_from_above<'a>(_lit: &'a Lit<'a>) -> AtProbe<'a> {
    Box::new(|_, _| Arrival { irradiance_w_m2: 1.0, towards: DVec3::Z })
}

#[test]
fn every_sensor_has_its_status() {
    let mut triangles = room();
    // A room that no light reaches, and a post too thin to have a void in it.
    triangles.extend(boxed(Vec3::new(5.0, 0.0, 0.0), Vec3::new(7.0, 3.0, 3.0)));
    triangles.extend(boxed(Vec3::new(1.0, 1.0, 0.5), Vec3::new(1.15, 1.15, 2.5)));
    let scalar = [(2.0, 2.0, 1.0), (6.0, 1.0, 1.0), (1.08, 1.07, 1.5), (20.0, 1.0, 1.0)];
    let mut sensors: Vec<Sensor> = scalar.map(|at| sensor(at.into(), None)).into();
    sensors.push(sensor(Vec3::new(2.0, 2.0, 1.0), Some(Vec3::NEG_Z)));
    let modelled = modelled(&triangles, vec![lamp(Vec3::new(2.0, 1.0, 1.5), FLUX_W)], sensors);
    let want = [Status::Ok, Status::Unreached, Status::InSolid, Status::Outside, Status::Dark];
    let own = |model: &Model, probes: &[Probe], _: &Settings, progress: &dyn Progress, cancel: &Cancel| {
        add_lights(model, probes, progress, cancel, one_from_above)
    };
    for field in [field(&modelled, own), field(&modelled, backward::estimate)] {
        let statuses: Vec<Status> = field.readings.iter().map(|reading| reading.status).collect();
        assert_eq!(statuses, want);
        assert!(field.warnings[0].starts_with("1 sensor(s) face away"), "{:?}", field.warnings);
        for reading in &field.readings[1..] {
            assert_eq!((reading.value_w_m2, reading.flux_w_m2), (0.0, DVec3::ZERO));
        }
    }
}

#[test]
fn lights_add_and_one_without_flux_is_a_true_zero() {
    let at = || vec![sensor(Vec3::new(1.5, 1.5, 0.5), Some(Vec3::Z))];
    let lights = [lamp(Vec3::new(1.0, 1.5, 2.0), FLUX_W), lamp(Vec3::new(2.5, 1.5, 1.0), 30.0)];
    for estimate in [backward::estimate, forward::estimate] {
        let one_by_one: f64 = lights
            .iter()
            .map(|&light| field(&modelled(&room(), vec![light], at()), estimate).readings[0].value_w_m2)
            .sum();
        let together = field(&modelled(&room(), lights.into(), at()), estimate).readings[0];
        close(together.value_w_m2, one_by_one);
        let without = field(&modelled(&room(), vec![lamp(Vec3::splat(1.5), 0.0)], at()), estimate).readings[0];
        assert_eq!((without.value_w_m2, without.status), (0.0, Status::Dark));
        let none = field(&modelled(&room(), Vec::new(), at()), estimate).readings[0];
        assert_eq!(none.status, Status::Unreached);
    }
}

#[test]
fn what_is_no_irradiance_is_refused_and_told() {
    let modelled = modelled(&room(), vec![lamp(Vec3::splat(1.5), FLUX_W)], vec![sensor(Vec3::splat(1.0), None)]);
    for wrong in [f64::NAN, f64::INFINITY, -1.0] {
        let own = |model: &Model, probes: &[Probe], _: &Settings, progress: &dyn Progress, cancel: &Cancel| {
            add_lights(model, probes, progress, cancel, |_| {
                Box::new(move |_, _| Arrival { irradiance_w_m2: wrong, towards: DVec3::Z })
            })
        };
        let field = field(&modelled, own);
        assert_eq!((field.readings[0].value_w_m2, field.readings[0].status), (0.0, Status::Dark));
        assert!(field.warnings[0].starts_with("1 arrivals"), "{:?}", field.warnings);
    }
}
