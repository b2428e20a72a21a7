//! Closed forms, energy, and what must never happen.

use super::*;
use crate::flow::tests::{FLUX_W, field, lamp, model_of, modelled, room, sensor, two_rooms};
use crate::job::Quiet;
use crate::light::Status;
use crate::scene::{Light, Material, Scene, Sensor};
use crate::voxel::test_scenes::{boxed, scene_of};
use glam::Vec3;
use petgraph::graph::NodeIndex;

const LIGHT_M: Vec3 = Vec3::new(1.0, 1.4, 1.5);

/// A scene of these triangles, all of one reflectance, with a lamp.
fn grey(triangles: &[[Vec3; 3]], reflectance: f32) -> Scene {
    let mut scene = Scene { lights: vec![lamp(LIGHT_M, FLUX_W)], ..scene_of(triangles) };
    scene.materials[0].reflectance = reflectance;
    scene
}

/// A gallery of 8 x 2 x 2 m whose middle is crossed by a pane.
fn glazed(transmittance: f32) -> Scene {
    let mut triangles = boxed(Vec3::ZERO, Vec3::new(8.0, 2.0, 2.0));
    triangles.extend(&boxed(Vec3::new(4.0, 0.0, 0.0), Vec3::new(4.0, 2.0, 2.0))[8..10]);
    let mut scene = grey(&triangles, 0.7);
    scene.materials.push(Material { transmittance, reflectance: 0.1, ..scene.materials[0].clone() });
    scene.mesh.material_of[12..].fill(1);
    scene
}

fn circuit(model: &Model) -> Circuit<'_> {
    Circuit::new(model, &Surroundings::of(model))
}

#[test]
fn what_is_absorbed_and_escapes_is_what_was_emitted() {
    let mut coloured = grey(&two_rooms(), 0.9);
    coloured.materials.push(Material { reflectance: 0.2, ..coloured.materials[0].clone() });
    coloured.mesh.material_of[6..12].fill(1);
    let quad = Light::Quad { corner_m: Vec3::new(5.0, 1.0, 2.9), u_m: Vec3::Y, v_m: Vec3::X, flux_w: 30.0 };
    coloured.lights.extend([quad, Light::Sphere { centre_m: Vec3::new(2.0, 2.0, 0.5), radius_m: 0.2, flux_w: 7.0 }]);
    for scene in [grey(&room(), 0.5), grey(&room(), 0.0), grey(&room()[..10], 0.8), glazed(0.7), coloured] {
        let model = model_of(&scene);
        let circuit = circuit(&model);
        for bounces in BOUNCES {
            let landed = photons::landed(&model, bounces, 0, &Cancel::new()).unwrap();
            for (landed, light) in landed.iter().zip(&model.shining) {
                let sources_w = sources_w(&circuit, std::slice::from_ref(landed));
                let spread = circuit.spread(&sources_w);
                let (absorbed_w, escaped_w) = circuit.losses_w(&sources_w, &spread);
                let all_w = absorbed_w + escaped_w + landed.absorbed_w + landed.escaped_w;
                assert!((all_w / light.flux_w - 1.0).abs() < 1e-6, "{all_w} of {}, {bounces} bounces", light.flux_w);
            }
        }
    }
}

#[test]
fn the_walls_of_a_closed_room_receive_flux_over_absorption() {
    for reflectance in [0.5, 0.8, 0.99] {
        let scene = grey(&room(), reflectance);
        let model = model_of(&scene);
        let points = (0..1500_u32).filter_map(|index| {
            let within = crate::flow::sequence::square(index, [0.3, 0.6]);
            model.walls.point_at((f64::from(index) + 0.5) / 1500.0, within)
        });
        let inwards = |point: crate::model::walls::WallPoint| {
            let towards = Vec3::splat(1.5) - point.position_m;
            model.probe(point.position_m, Some(point.normal * point.normal.dot(towards).signum()))
        };
        let probes: Vec<Probe> = points.map(inwards).collect();
        let found = estimate(&model, &probes, &Settings::default(), &Quiet, &Cancel::new()).unwrap();
        let mean = found.readings.iter().map(|reading| reading.value_w_m2).sum::<f64>() / probes.len() as f64;
        let want = FLUX_W / (54.0 * (1.0 - f64::from(reflectance)));
        assert!((mean / want - 1.0).abs() < 0.03, "{mean} for {want}");
    }
}

#[test]
fn along_a_duct_light_falls_as_the_difference_equation_says() {
    let (side_m, reflectance) = (1.0_f64, 0.6_f64);
    let scene = grey(&boxed(LIGHT_M - 0.5, LIGHT_M + Vec3::new(11.5, 0.5, 0.5)), reflectance as f32);
    let model = model_of(&scene);
    let circuit = circuit(&model);
    let along = |node: usize| f64::from(model.node_m(NodeIndex::new(node)).x);
    let mut order: Vec<usize> = (0..circuit.part.len()).collect();
    order.sort_by(|a, b| along(*a).total_cmp(&along(*b)));
    let mut sources_w = vec![0.0; order.len()];
    sources_w[order[0]] = 1.0;
    let potentials = circuit.spread(&sources_w).hops_w_m2;

    // Conductance A lambda g / 3 h against the walls' h P alpha g / (4 rho), lambda = 4 A / P = the side.
    let (step_m, decay_m) = (0.1, side_m * (reflectance / (3.0 * (1.0 - reflectance))).sqrt());
    let loss = f64::powi(step_m / decay_m, 2);
    let root = 1.0 + loss / 2.0 - (loss + loss * loss / 4.0).sqrt();
    let within = |node: &&usize| (4.0..9.0).contains(&along(**node));
    let run: Vec<usize> = order.iter().filter(within).copied().collect();
    let (first, last) = (run[0], run[run.len() - 1]);
    let fall = (potentials[last] / potentials[first]).ln() / (along(last) - along(first)) * step_m;
    assert!((fall / root.ln() - 1.0).abs() < 0.03, "{fall} for {}", root.ln());
}

#[test]
fn a_room_behind_a_small_opening_gets_what_comes_through_it() {
    // Two rooms of 3 m, parted by a sheet with a hole of 0.6 x 0.6 m.
    let mut triangles = boxed(Vec3::ZERO, Vec3::new(6.0, 3.0, 3.0));
    for (low, high) in
        [([0.0, 0.0], [3.0, 1.2]), ([0.0, 1.8], [3.0, 3.0]), ([0.0, 1.2], [1.2, 1.8]), ([1.8, 1.2], [3.0, 1.8])]
    {
        let [a, b, c, d] = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
            .map(|(y, z)| Vec3::new(3.0, y, z));
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    let reflectance = 0.8_f64;
    let mut scene = grey(&triangles, reflectance as f32);
    // Far from the hole's beam: the lit room's lamp does not see these.
    let at = |x: f32| sensor(Vec3::new(x, 0.4, 0.4), None);
    scene.sensors = vec![at(0.4), at(3.5)];
    let model = model_of(&scene);
    let circuit = circuit(&model);
    let landed = photons::landed(&model, 0, 0, &Cancel::new()).unwrap();
    let spread = circuit.spread(&sources_w(&circuit, &landed));
    let node = |x: f32| model.place(Vec3::new(x, 0.4, 0.4), None).unwrap().index();
    let [lit, dark] = [0.4, 5.6].map(|x| spread.potentials_w_m2[node(x)]);
    // The hole is Lambertian: what enters, a M, is what walls and hole take, (alpha S + a) E, M = E / rho beyond, rho E here.
    let (wall_m2, hole_m2, alpha) = (53.64, 0.36, 1.0 - reflectance);
    let want = hole_m2 / (alpha * wall_m2 + hole_m2);
    assert!((dark / lit / want - 1.0).abs() < 0.15, "{} for {want}", dark / lit);
}

#[test]
fn the_extremes_give_numbers_and_say_what_they_are() {
    let sensors = || vec![sensor(Vec3::new(2.0, 2.0, 1.0), None), sensor(Vec3::new(2.0, 2.0, 1.0), Some(Vec3::Z))];
    for (reflectance, says) in [(0.0, "preview"), (0.3, "preview"), (0.99, ""), (1.0, "no steady light")] {
        let scene = Scene { sensors: sensors(), ..grey(&room(), reflectance) };
        let model = model_of(&scene);
        for rung in crate::flow::ladder(crate::scene::Method::Diffusion) {
            let probes = model.probes_at_sensors(&scene);
            let field = (rung.estimate)(&model, &probes, &Settings::default(), &Quiet, &Cancel::new()).unwrap();
            for reading in &field.readings {
                assert!(reading.value_w_m2.is_finite() && reading.value_w_m2 > 0.0, "{reflectance}: {reading:?}");
                assert!(reading.error_w_m2.is_some_and(f64::is_finite) && reading.flux_w_m2.is_finite());
            }
            let plane = field.readings[1];
            assert!((plane.flux_w_m2.z / plane.value_w_m2 - 1.0).abs() < 1e-5, "{plane:?}");
            let told = field.warnings.iter().any(|warning| warning.contains(says) && !says.is_empty());
            assert_eq!(told, !says.is_empty(), "{reflectance}: {:?}", field.warnings);
            if reflectance == 0.0 {
                let direct = FLUX_W
                    / (4.0 * std::f64::consts::PI * f64::from(LIGHT_M.distance_squared(scene.sensors[0].position_m)));
                assert!((field.readings[0].value_w_m2 / direct - 1.0).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn every_sensor_has_its_status() {
    let mut triangles = room();
    triangles.extend(boxed(Vec3::new(5.0, 0.0, 0.0), Vec3::new(7.0, 3.0, 3.0)));
    triangles.extend(boxed(Vec3::new(1.0, 1.0, 0.5), Vec3::new(1.15, 1.15, 2.5)));
    let at = [(2.0, 2.0, 1.0), (6.0, 1.0, 1.0), (1.08, 1.07, 1.5), (20.0, 1.0, 1.0)];
    let sensors: Vec<Sensor> = at.map(|at| sensor(at.into(), None)).into();
    let modelled = modelled(&triangles, vec![lamp(Vec3::new(2.0, 1.0, 1.5), FLUX_W)], sensors);
    let statuses: Vec<Status> = field(&modelled, estimate).readings.iter().map(|reading| reading.status).collect();
    assert_eq!(statuses, [Status::Ok, Status::Unreached, Status::InSolid, Status::Outside]);
    let without = field(&self::modelled(&room(), Vec::new(), vec![sensor(Vec3::ONE, None)]), estimate);
    assert_eq!(without.readings[0].status, Status::Unreached);
}

#[test]
fn shares_of_the_lights_add_up_to_the_whole() {
    let lights = vec![lamp(LIGHT_M, FLUX_W), lamp(Vec3::new(6.0, 1.0, 1.0), 30.0)];
    let sensors = vec![sensor(Vec3::new(6.5, 2.0, 1.0), None), sensor(Vec3::new(0.5, 2.0, 1.0), Some(Vec3::X))];
    let (scene, model) = modelled(&two_rooms(), lights, sensors);
    let probes = model.probes_at_sensors(&scene);
    for bounces in [0, 2] {
        let with = |shares| {
            let settings = Settings { shares, ..Settings::default() };
            carried(bounces, &model, &probes, &settings, &Quiet, &Cancel::new()).unwrap()
        };
        let (apart, together) = (with(true), with(false));
        let shares = apart.shares.unwrap();
        assert!(together.shares.is_none() && shares.emitters == 2);
        for (number, (reading, whole)) in apart.readings.iter().zip(&together.readings).enumerate() {
            let sum: f64 = shares.of(number).iter().sum();
            assert!((sum / reading.value_w_m2 - 1.0).abs() < 1e-12);
            assert!((reading.value_w_m2 / whole.value_w_m2 - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn a_pane_lets_its_share_of_the_diffuse_light_through() {
    let beyond = |transmittance: f32| {
        let scene = Scene { sensors: vec![sensor(Vec3::new(7.5, 0.4, 0.4), None)], ..glazed(transmittance) };
        let model = model_of(&scene);
        field(&(scene, model), estimate).readings[0].value_w_m2
    };
    let found = [0.9, 0.6, 0.3].map(beyond);
    assert!(found[1] < 0.7 * found[0] && found[2] < 0.5 * found[1], "{found:?}");
}
