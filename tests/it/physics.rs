//! The path tracer on scenes whose light is known in closed form.

use glam::{DVec3, Vec3};
use lightvein::job::{Cancel, Cancelled, Progress, Quiet};
use lightvein::light::{Reading, Settings, Sources, Status};
use lightvein::rays::Rays;
use lightvein::scene::{Light, Material, Mesh, Scene, Sensor};
use lightvein::trace::{Traced, trace};
use std::f64::consts::PI;

fn grey(reflectance: f32) -> Material {
    Material { name: String::new(), reflectance, transmittance: 0.0, emission_w_m2_sr: 0.0 }
}

fn point(position_m: Vec3, flux_w: f64) -> Light {
    Light::Point { position_m, flux_w }
}

fn sensor(position_m: Vec3, normal: Option<Vec3>) -> Sensor {
    Sensor { id: position_m.to_string(), position_m, normal }
}

/// A parallelogram with that material, its front along `u x v`.
fn quad(mesh: &mut Mesh, material: u32, corner: Vec3, u: Vec3, v: Vec3) {
    for corners in [[corner, corner + u, corner + u + v], [corner, corner + u + v, corner + v]] {
        let first = mesh.positions_m.len() as u32;
        mesh.positions_m.extend(corners);
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.material_of.push(material);
    }
}

/// A closed box from the origin to `size`, its faces to the inside.
fn room(size: Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    for (corner, u, v) in [(Vec3::ZERO, x, y), (z, y, x), (Vec3::ZERO, z, x), (y, x, z), (Vec3::ZERO, y, z), (x, z, y)]
    {
        quad(&mut mesh, 0, corner, u, v);
    }
    mesh
}

/// A ball of triangles about the origin, an octahedron with each face cut into `cuts * cuts`.
fn ball(radius_m: f32, cuts: i32) -> Mesh {
    let mut mesh = Mesh::default();
    for face in 0..8 {
        let [a, b, c] =
            [(0, Vec3::X), (1, Vec3::Y), (2, Vec3::Z)].map(|(axis, to)| if face >> axis & 1 == 0 { to } else { -to });
        let at = |i: i32, j: i32| radius_m * (a * (cuts - i - j) as f32 + b * i as f32 + c * j as f32).normalize();
        for (i, j) in (0..cuts).flat_map(|i| (0..cuts - i).map(move |j| (i, j))) {
            let mut faces = vec![[at(i, j), at(i + 1, j), at(i, j + 1)]];
            if i + j + 1 < cuts {
                faces.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
            for corners in faces {
                let first = mesh.positions_m.len() as u32;
                mesh.positions_m.extend(corners);
                mesh.triangles.push([first, first + 1, first + 2]);
                mesh.material_of.push(0);
            }
        }
    }
    mesh
}

fn area_m2(mesh: &Mesh) -> f64 {
    let corners = (0..mesh.triangles.len()).filter_map(|triangle| mesh.corners_m(triangle));
    corners.map(|[a, b, c]| f64::from((b - a).cross(c - a).length()) / 2.0).sum()
}

fn scene_of(mesh: Mesh, reflectance: f32, lights: Vec<Light>, sensors: Vec<Sensor>) -> Scene {
    Scene { mesh, materials: vec![grey(reflectance)], lights, sensors, ..Scene::default() }
}

fn traced(scene: &Scene, settings: &Settings) -> Traced {
    trace(scene, &Rays::new(scene), &Sources::of(scene), settings, &Quiet, &Cancel::new()).expect("nobody cancels")
}

fn readings(scene: &Scene, samples: u32) -> Vec<Reading> {
    traced(scene, &Settings { samples, seed: 1, ..Settings::default() }).field.readings
}

/// What lifting a sensor off its surface changes at most, as a share.
const LIFT: f64 = 1e-4;

/// The reading is the expected one within 3 standard errors, which are at most `tolerance` of it.
#[track_caller]
fn check(reading: &Reading, expected: f64, tolerance: f64) {
    let error = reading.error_w_m2.expect("a standard error");
    let off = (reading.value_w_m2 - expected).abs();
    assert!(3.0 * error <= tolerance * expected, "{reading:?} is too noisy to be checked");
    assert!(off <= 3.0 * error + LIFT * expected, "{reading:?} is not {expected} but {:.1} errors off", off / error);
    assert_eq!(reading.status, Status::Ok);
}

#[test]
fn a_point_light_follows_the_inverse_square() {
    let places = [Vec3::ZERO, Vec3::new(3.0, 0.0, 0.0)];
    let sensors =
        places.map(|place| sensor(place, Some(Vec3::Z))).into_iter().chain(places.map(|place| sensor(place, None)));
    let scene = scene_of(Mesh::default(), 0.0, vec![point(Vec3::Z * 2.0, 100.0)], sensors.collect());
    let intensity = 100.0 / (4.0 * PI);
    let expected = [intensity / 4.0, intensity * 2.0 / 13_f64.powf(1.5), intensity / 4.0, intensity / 13.0];
    for (reading, expected) in readings(&scene, 64).iter().zip(expected) {
        check(reading, expected, 1e-5);
    }
    let towards = readings(&scene, 64)[3].direction();
    assert!(towards.distance(DVec3::new(-3.0, 0.0, 2.0).normalize()) < 1e-6);
}

#[test]
fn a_sphere_light_acts_like_a_point_on_planes_and_by_its_solid_angle_on_points() {
    for radius_m in [0.001, 0.3, 1.5] {
        let light = Light::Sphere { centre_m: Vec3::Z * 2.0, radius_m, flux_w: 100.0 };
        let up = sensor(Vec3::ZERO, Some(Vec3::Z));
        let scene = scene_of(
            Mesh::default(),
            0.0,
            vec![light],
            vec![up, sensor(Vec3::ZERO, None), sensor(Vec3::Z * 2.0, None)],
        );
        let readings = readings(&scene, 4096);
        check(&readings[0], 100.0 / (16.0 * PI), 0.02);
        let radius_m = f64::from(radius_m);
        let radiance = 100.0 / (4.0 * PI * PI * radius_m * radius_m);
        let sine_squared = radius_m * radius_m / 4.0;
        // 1 - cos by the form that keeps its digits for small angles.
        let solid_angle = 2.0 * PI * sine_squared / (1.0 + (1.0 - sine_squared).sqrt());
        check(&readings[1], radiance * solid_angle, 1e-5);
        assert_eq!(readings[2].status, Status::InSolid);
    }
}

#[test]
fn a_rectangle_over_its_corner_has_its_form_factor_as_a_light_and_as_faces() {
    let (width, length, height) = (1.0_f64, 2.0_f64, 1.5_f64);
    let part = |a: f64, b: f64| a / a.hypot(1.0) * (b / a.hypot(1.0)).atan();
    let (x, y) = (width / height, length / height);
    let expected = PI * 10.0 * (part(x, y) + part(y, x)) / (2.0 * PI);

    let (corner, u, v) = (Vec3::Z * 1.5, Vec3::Y * 2.0, Vec3::X);
    let ends = vec![sensor(Vec3::ZERO, Some(Vec3::Z)), sensor(Vec3::Z * 3.0, Some(Vec3::NEG_Z))];
    let light = Light::Quad { corner_m: corner, u_m: u, v_m: v, flux_w: 10.0 * PI * width * length };
    let by_light = scene_of(Mesh::default(), 0.0, vec![light], ends.clone());
    let mut mesh = Mesh::default();
    quad(&mut mesh, 0, corner, u, v);
    let shining = Material { emission_w_m2_sr: 10.0, ..grey(0.0) };
    let by_faces = Scene { materials: vec![shining], ..scene_of(mesh, 0.0, Vec::new(), ends) };
    for scene in [by_light, by_faces] {
        let readings = readings(&scene, 16_384);
        check(&readings[0], expected, 0.02);
        // It shines on one side alone.
        assert_eq!((readings[1].value_w_m2, readings[1].status), (0.0, Status::Dark));
    }
}

#[test]
fn emissive_faces_reflect_nothing_and_let_nothing_through() {
    let mut mesh = Mesh::default();
    quad(&mut mesh, 0, Vec3::new(-1.0, -1.0, 1.0), Vec3::Y * 2.0, Vec3::X * 2.0);
    let sensors = vec![sensor(Vec3::Z * 2.0, Some(Vec3::NEG_Z))];
    let mut scene = scene_of(mesh, 0.9, vec![point(Vec3::Z * 3.0, 100.0), point(Vec3::ZERO, 100.0)], sensors);
    assert_eq!(readings(&scene, 64)[0].status, Status::Ok);
    scene.materials = vec![Material { transmittance: 0.1, emission_w_m2_sr: 10.0, ..grey(0.9) }];
    assert_eq!(readings(&scene, 64)[0].status, Status::Dark);
}

#[test]
fn an_integrating_sphere_adds_the_same_everywhere() {
    let (mesh, flux_w) = (ball(2.0, 32), 50.0);
    let area_m2 = area_m2(&mesh);
    for reflectance in [0.2_f32, 0.8] {
        for light_m in [Vec3::ZERO, Vec3::new(0.9, 0.4, -0.3)] {
            let sensors = [11, 1500, 7000].map(|triangle| {
                let [a, b, c] = mesh.corners_m(triangle).expect("the triangle exists");
                let (centre, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize());
                sensor(centre, Some(if normal.dot(centre) > 0.0 { -normal } else { normal }))
            });
            let scene = scene_of(mesh.clone(), reflectance, vec![point(light_m, flux_w)], sensors.to_vec());
            for (reading, sensor) in readings(&scene, 4096).iter().zip(&sensors) {
                let towards = light_m - sensor.position_m;
                let cosine = f64::from(sensor.normal.expect("a normal").dot(towards.normalize()));
                let direct = flux_w / (4.0 * PI) * cosine / f64::from(towards.length_squared());
                let rho = f64::from(reflectance);
                // 32 cuts leave the ball's flat faces within 0.3% of a sphere.
                check(reading, direct + flux_w * rho / (area_m2 * (1.0 - rho)), 0.1);
            }
        }
    }
}

/// Area mean of the irradiance in a closed grey box by a regular grid of sensors on its walls, and its standard error.
fn box_mean(reflectance: f32, samples: u32) -> (f64, f64, f64) {
    let size = Vec3::new(4.0, 3.0, 2.5);
    let mut sensors = Vec::new();
    let mut weights = Vec::new();
    let steps = 12;
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (side, i, j) in
            (0..2).flat_map(|side| (0..steps * steps).map(move |cell| (side, cell / steps, cell % steps)))
        {
            let mut at = Vec3::ZERO;
            at[u] = size[u] * (i as f32 + 0.5) / steps as f32;
            at[v] = size[v] * (j as f32 + 0.5) / steps as f32;
            at[axis] = side as f32 * size[axis];
            let mut normal = Vec3::ZERO;
            normal[axis] = 1.0 - 2.0 * side as f32;
            sensors.push(sensor(at, Some(normal)));
            weights.push(f64::from(size[u] * size[v]) / f64::from(steps * steps));
        }
    }
    let mesh = room(size);
    let area_m2 = area_m2(&mesh);
    let scene = scene_of(mesh, reflectance, vec![point(Vec3::new(1.9, 1.4, 1.3), 50.0)], sensors);
    let readings = readings(&scene, samples);
    let (mut mean, mut variance) = (0.0, 0.0);
    for (reading, weight) in readings.iter().zip(&weights) {
        mean += reading.value_w_m2 * weight / area_m2;
        variance += (reading.error_w_m2.expect("a standard error") * weight / area_m2).powi(2);
    }
    (mean, variance.sqrt(), 50.0 / (area_m2 * (1.0 - f64::from(reflectance))))
}

#[test]
fn a_closed_grey_box_has_the_mean_of_its_flux_over_what_it_absorbs() {
    for (reflectance, samples) in [(0.0, 4), (0.5, 128), (0.7, 128), (0.99, 256)] {
        let (mean, error, expected) = box_mean(reflectance, samples);
        println!("reflectance {reflectance}: {mean} +- {error}, expected {expected}");
        // The midpoint rule over the direct light is 0.16% off.
        assert!((mean - expected).abs() <= 3.0 * error + 2e-3 * 50.0 / 59.0, "{mean} +- {error} is not {expected}");
        assert!(error <= 0.02 * expected);
    }
}

#[test]
fn bounces_are_counted_and_a_black_room_has_none() {
    let size = Vec3::new(4.0, 3.0, 2.5);
    let sensors = vec![sensor(Vec3::new(1.0, 1.0, 1.0), None)];
    let lit = |reflectance: f32, max_bounces: Option<u32>| {
        let light = point(Vec3::new(3.0, 2.0, 2.0), 50.0);
        let scene = scene_of(room(size), reflectance, vec![light], sensors.clone());
        traced(&scene, &Settings { samples: 16_384, seed: 1, max_bounces, ..Settings::default() }).field.readings[0]
    };
    let direct = 50.0 / (4.0 * PI) / 6.0;
    check(&lit(0.0, None), direct, 1e-5);
    check(&lit(0.9, Some(0)), direct, 1e-5);
    // Each bounce adds its power of the reflectance: B(rho) = a0 + a1 rho + a2 rho^2.
    let at = |reflectance: f32, bounces: u32| lit(reflectance, Some(bounces)).value_w_m2 - direct;
    assert!((at(0.8, 1) / at(0.4, 1) - 2.0).abs() < 1e-3);
    let second = |reflectance: f32| at(reflectance, 2) - at(reflectance, 1);
    assert!((second(0.8) / second(0.4) - 4.0).abs() < 0.4);
    assert!(lit(0.9, None).value_w_m2 > lit(0.9, Some(2)).value_w_m2);
}

#[test]
fn thin_glazing_passes_its_share_straight_on_and_reflects_diffusely() {
    let mut mesh = Mesh::default();
    quad(&mut mesh, 0, Vec3::new(-5.0, -5.0, 1.0), Vec3::X * 10.0, Vec3::Y * 10.0);
    let sensors =
        vec![sensor(Vec3::ZERO, Some(Vec3::Z)), sensor(Vec3::Z * 1.9, Some(Vec3::NEG_Z)), sensor(Vec3::Z * 0.5, None)];
    let scene = scene_of(mesh, 0.3, vec![point(Vec3::Z * 2.0, 100.0)], sensors);
    let glass = Material { transmittance: 0.6, ..grey(0.3) };
    let readings = readings(&Scene { materials: vec![glass], ..scene.clone() }, 16_384);
    let direct = |distance: f64| 100.0 / (4.0 * PI * distance * distance);
    check(&readings[0], 0.6 * direct(2.0), 1e-5);
    check(&readings[2], 0.6 * direct(1.5), 1e-5);
    // Above, as over an opaque wall of the same reflectance.
    let opaque = self::readings(&scene, 16_384);
    let (above, wall) = (&readings[1], &opaque[1]);
    let error = above.error_w_m2.expect("an error").hypot(wall.error_w_m2.expect("an error"));
    assert!((above.value_w_m2 - wall.value_w_m2).abs() <= 3.0 * error && error < 0.02 * wall.value_w_m2);
    assert_eq!(opaque[0].status, Status::Dark);

    // A path that goes through the pane to a lit wall behind it, and one that is reflected there, through the pane back.
    let mut mesh = Mesh::default();
    quad(&mut mesh, 0, Vec3::new(-5.0, -5.0, 0.0), Vec3::X * 10.0, Vec3::Y * 10.0);
    quad(&mut mesh, 1, Vec3::new(-5.0, -5.0, 1.0), Vec3::X * 10.0, Vec3::Y * 10.0);
    let clear = Material { transmittance: 0.5, ..grey(0.0) };
    let up = vec![sensor(Vec3::Z * 2.0, Some(Vec3::NEG_Z))];
    let mut scene = scene_of(mesh, 0.8, vec![point(Vec3::Z * 3.0, 100.0)], up);
    let bare = {
        let mut bare = scene.clone();
        bare.mesh.triangles.truncate(2);
        self::readings(&bare, 65_536)[0]
    };
    scene.materials.push(clear);
    let glazed = self::readings(&scene, 65_536)[0];
    // The plane's light comes twice through the pane; it lies still as seen from above, for a thin pane bends nothing.
    let error = (4.0 * glazed.error_w_m2.expect("an error")).hypot(bare.error_w_m2.expect("an error"));
    assert!((4.0 * glazed.value_w_m2 - bare.value_w_m2).abs() <= 3.0 * error, "{glazed:?} {bare:?}");
    assert!(error < 0.05 * bare.value_w_m2);
}

#[test]
fn many_lights_add_up() {
    let lights: Vec<Light> = (0..60)
        .map(|number| {
            point(Vec3::new(0.37 + (number % 10) as f32, 0.71 + (number / 10) as f32, 2.3), 1.0 + number as f64)
        })
        .collect();
    let scene = |lights: &[Light]| {
        let sensors = vec![sensor(Vec3::new(4.5, 2.2, 0.0), Some(Vec3::Z)), sensor(Vec3::new(8.0, 5.0, 1.1), None)];
        scene_of(room(Vec3::new(10.0, 6.5, 3.0)), 0.5, lights.to_vec(), sensors)
    };
    let together = readings(&scene(&lights), 16_384);
    let (mut sum, mut variance) = ([0.0; 2], [0.0; 2]);
    for light in &lights {
        for (sensor, reading) in readings(&scene(&[*light]), 1024).iter().enumerate() {
            sum[sensor] += reading.value_w_m2;
            variance[sensor] += reading.error_w_m2.expect("an error").powi(2);
        }
    }
    for sensor in 0..2 {
        let error = together[sensor].error_w_m2.expect("an error").hypot(variance[sensor].sqrt());
        let off = (together[sensor].value_w_m2 - sum[sensor]).abs();
        assert!(off <= 3.0 * error && error < 0.02 * sum[sensor], "{off} {error} {}", sum[sensor]);
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let sensors = vec![sensor(Vec3::new(1.0, 1.0, 1.0), None), sensor(Vec3::new(2.0, 0.0, 1.0), Some(Vec3::Y))];
    let lights = vec![
        point(Vec3::new(3.0, 2.0, 2.0), 50.0),
        Light::Sphere { centre_m: Vec3::splat(2.0), radius_m: 0.2, flux_w: 9.0 },
    ];
    let scene = scene_of(room(Vec3::new(4.0, 3.0, 2.5)), 0.6, lights, sensors);
    let settings = Settings { samples: 1000, seed: 7, ..Settings::default() };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| traced(&scene, &settings))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(5));
    assert_ne!(one, traced(&scene, &Settings { seed: 8, ..settings }));
}

/// Raises its flag at the first sign of progress, and counts.
struct StopAtOnce<'a> {
    cancel: &'a Cancel,
    done: std::sync::atomic::AtomicU64,
}

impl Progress for StopAtOnce<'_> {
    fn begin(&self, stage: &str, total: u64) {
        assert_eq!((stage, total), ("trace", 1_000_000 / 128 + 1));
    }
    fn advance(&self, units: u64) {
        self.cancel.cancel();
        self.done.fetch_add(units, std::sync::atomic::Ordering::Relaxed);
    }
    fn end(&self) {}
}

#[test]
fn a_cancelled_trace_stops_within_a_block_a_thread() {
    let sensors = vec![sensor(Vec3::ONE, None)];
    let scene = scene_of(room(Vec3::splat(2.0)), 0.9, vec![point(Vec3::splat(0.5), 50.0)], sensors);
    let cancel = Cancel::new();
    let progress = StopAtOnce { cancel: &cancel, done: Default::default() };
    let settings = Settings { samples: 1_000_000, seed: 1, ..Settings::default() };
    let result = trace(&scene, &Rays::new(&scene), &Sources::of(&scene), &settings, &progress, &cancel);
    assert_eq!(result, Err(Cancelled));
    assert!(progress.done.into_inner() <= rayon::current_num_threads() as u64);
}

#[test]
fn no_lights_and_no_sensors_are_answers_too() {
    let dark = readings(&scene_of(room(Vec3::ONE), 0.5, Vec::new(), vec![sensor(Vec3::splat(0.5), None)]), 16);
    assert_eq!((dark[0].status, dark[0].value_w_m2), (Status::Dark, 0.0));
    assert_eq!(readings(&Scene::default(), 16), Vec::new());

    let on_the_light = scene_of(Mesh::default(), 0.5, vec![point(Vec3::ONE, 1.0)], vec![sensor(Vec3::ONE, None)]);
    let warnings = traced(&on_the_light, &Settings::default()).field.warnings;
    assert!(warnings.iter().any(|warning| warning.contains("point light")), "{warnings:?}");
}
