//! What any field of light obeys, whatever the scene: it is what radiance, which is never negative, integrates to.

use super::cases::{Case, VOXEL_M, both_rooms, grey, room, scene_of, sensor};
use super::{Breaches, Law, Subject, settings};
use glam::{DVec3, Vec3};
use lightvein::light::{Reading, Settings, Status};
use lightvein::scene::{Material, Scene, Sensor};
use std::f64::consts::PI;

/// Rounding of sums and of positions in `f32`.
const ROUNDING: f64 = 1e-4;

/// What readings of one point, each gathered by some hundred rays of its own, may differ by, as a share of the scalar
/// irradiance there.
const GATHERED: f64 = 0.06;

const AXES: [Vec3; 6] = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];

pub const SOUND: Law = Law {
    name: "sound",
    test: |subject, breaches| {
        let mut scene = both_rooms();
        scene.sensors.extend(sensors_round_about());
        let case = Case::of(scene);
        for (at, reading) in subject.field(&case).readings.iter().enumerate() {
            sound(breaches, case.id(at), reading);
            let Some(normal) = case.scene.sensors[at].normal else {
                breaches.unless(reading.status == Status::Ok, || format!("{}: {:?}", case.id(at), reading.status));
                continue;
            };
            // A plane's value is the integral of L w.n, and its flux that of L w, over the same hemisphere.
            let along = reading.flux_w_m2.dot(normal.as_dvec3());
            breaches.unless_within(
                ROUNDING,
                &format!("flux along the normal, {}", case.id(at)),
                along,
                reading.value_w_m2,
            );
        }
    },
};

/// Finite, not negative, and a flux no longer than the mean of its cosines allows.
pub fn sound(breaches: &mut Breaches, id: &str, reading: &Reading) {
    let value = reading.value_w_m2;
    breaches.unless(value.is_finite() && value >= 0.0, || format!("{id}: a value of {value}"));
    breaches.unless(reading.flux_w_m2.is_finite(), || format!("{id}: a flux of {}", reading.flux_w_m2));
    let length = reading.direction().length();
    breaches.unless(length == 0.0 || (length - 1.0).abs() < 1e-9, || format!("{id}: a direction {length} long"));
    let error = reading.error_w_m2.unwrap_or(0.0);
    breaches.unless(error.is_finite() && error >= 0.0, || format!("{id}: an error of {error}"));
    let lit = (value > 0.0) == (reading.status == Status::Ok);
    breaches.unless(lit, || format!("{id}: {value} W/m2 is {:?}", reading.status));
}

/// A scalar sensor and the six planes at each of some points in the open.
fn sensors_round_about() -> Vec<Sensor> {
    let points_m = [
        Vec3::new(1.59375, 2.15625, 0.90625),
        Vec3::new(3.71875, 2.34375, 1.46875),
        Vec3::new(4.90625, 1.53125, 0.71875),
    ];
    let at = |at_m: Vec3| [None].into_iter().chain(AXES.map(Some)).map(move |normal| sensor(at_m, normal));
    points_m.into_iter().flat_map(at).collect()
}

/// The scalar reading of each of those points and its planes by [`AXES`].
fn round_about(subject: &Subject) -> Vec<(String, Reading, Vec<Reading>)> {
    let case = Case::of(Scene { sensors: sensors_round_about(), ..both_rooms() });
    let readings = subject.field(&case).readings;
    let point = |(number, of_point): (usize, &[Reading])| {
        (case.id(number * (1 + AXES.len())).to_owned(), of_point[0], of_point[1..].to_vec())
    };
    readings.chunks(1 + AXES.len()).enumerate().map(point).collect()
}

pub const PLANES: Law = Law {
    name: "planes and points",
    test: |subject, breaches| {
        for (id, scalar, planes) in round_about(subject) {
            let phi = scalar.value_w_m2;
            let all: Vec<&Reading> = planes.iter().chain([&scalar]).collect();
            let slack = GATHERED * phi + subject.noise_w_m2(&all);
            breaches.unless(scalar.flux_w_m2.length() <= phi * (1.0 + ROUNDING), || {
                format!("{id}: a flux of {} from {phi}", scalar.flux_w_m2)
            });
            for (normal, plane) in AXES.iter().zip(&planes) {
                let value = plane.value_w_m2;
                breaches.unless(value <= phi + slack, || format!("{id}: {value} on {normal}, {phi} on the point"));
                let length = plane.flux_w_m2.length();
                breaches.unless(length <= phi + slack, || format!("{id}: a flux {length} long on {normal}, {phi}"));
            }
            // For unit vectors 1 <= |x| + |y| + |z| <= sqrt 3.
            let sum: f64 = planes.iter().map(|plane| plane.value_w_m2).sum();
            let holds = sum >= phi - slack && sum <= 3.0_f64.sqrt() * (phi + slack);
            breaches.unless(holds, || format!("{id}: the six planes sum to {sum}, the point has {phi}"));
        }
    },
};

pub const OPPOSITE: Law = Law {
    name: "opposite planes",
    test: |subject, breaches| {
        for (id, scalar, planes) in round_about(subject) {
            let by_planes = DVec3::new(
                planes[0].value_w_m2 - planes[1].value_w_m2,
                planes[2].value_w_m2 - planes[3].value_w_m2,
                planes[4].value_w_m2 - planes[5].value_w_m2,
            );
            let all: Vec<&Reading> = planes.iter().chain([&scalar]).collect();
            let slack = GATHERED * scalar.value_w_m2 + subject.noise_w_m2(&all);
            let off = by_planes.distance(scalar.flux_w_m2);
            breaches.unless(off <= slack, || {
                format!("{id}: planes give {by_planes}, the flux is {} ({} W/m2)", scalar.flux_w_m2, scalar.value_w_m2)
            });
        }
    },
};

/// Where light comes from faces of one radiance alone, nothing is brighter than these: a wall sends back less than it gets.
pub const BRIGHTEST: Law = Law {
    name: "nothing outshines the light",
    test: |subject, breaches| {
        let radiance = 10.0;
        for (reflectance, least) in [(0.99_f32, 0.92), (0.3, 0.0)] {
            let mut mesh = room(Vec3::splat(2.0));
            // Faces 2 and 3 are the ceiling.
            mesh.material_of[2..4].fill(1);
            let shining = Material { emission_w_m2_sr: radiance as f32, ..grey(0.0) };
            let places = [
                (Vec3::new(0.90625, 0.71875, 0.0), Some(Vec3::Z)),
                (Vec3::new(0.0, 0.78125, 1.34375), Some(Vec3::X)),
                (Vec3::new(1.15625, 1.21875, 1.75), Some(Vec3::Z)),
                (Vec3::new(1.15625, 1.21875, 1.0), None),
                (Vec3::new(0.28125, 0.34375, 1.71875), None),
            ];
            let sensors = places.map(|(at, normal)| sensor(at, normal)).into();
            let scene =
                Scene { materials: vec![grey(reflectance), shining], ..scene_of(mesh, 0.0, Vec::new(), sensors) };
            let case = Case::at(scene, VOXEL_M);
            for (at, reading) in
                subject.field_with(&case, &Settings { samples: 16_384, ..settings() }).readings.iter().enumerate()
            {
                let solid_angle = if case.scene.sensors[at].normal.is_some() { PI } else { 4.0 * PI };
                let share = reading.value_w_m2 / (solid_angle * radiance);
                let noise = subject.noise_w_m2(&[reading]) / (solid_angle * radiance);
                // Nearly white walls fill the room with nearly the light's own radiance: 1 / (1 + 5 x .01) of it.
                let holds = share <= 1.0 + GATHERED / 2.0 + noise && share >= least - noise;
                breaches.unless(holds, || {
                    format!("reflectance {reflectance}, {}: {share} of the light's radiance", case.id(at))
                });
            }
        }
    },
};
