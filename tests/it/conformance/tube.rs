//! A round tube that shines at one end, against the exact radiosity of [`cylinder`](super::cylinder).

use super::cases::{Case, grey, quad, scene_of, sensor, triangle};
use super::closed_forms::{Allowed, near};
use super::cylinder::Tube;
use super::{Breaches, Law, Subject, settings};
use glam::{Mat3, Vec3};
use lightvein::light::{Reading, Settings};
use lightvein::scene::{Material, Mesh, Scene};
use std::f64::consts::{PI, TAU};

/// Length of the tube, diameters, and its radius, metres.
const TUBE_LENGTH: f64 = 8.0;
const TUBE_RADIUS_M: f64 = 1.0;

/// Facets about the axis: the polygon is 0.1% narrower than the circle.
const SECTORS: usize = 96;

/// Where the wall of the tube is asked, diameters from the shining end.
const ASKED: [f64; 8] = [0.25, 0.5, 1.0, 2.0, 3.0, 4.5, 6.0, 7.5];

/// A tube along x whose first end shines with a radiance of 1 W/m2/sr and whose other end is black.
fn tube(reflectance: f32) -> Scene {
    let length_m = (2.0 * TUBE_RADIUS_M * TUBE_LENGTH) as f32;
    let around = |sector: usize| {
        let (sine, cosine) = (TAU * (sector % SECTORS) as f64 / SECTORS as f64).sin_cos();
        Vec3::new(0.0, (TUBE_RADIUS_M * cosine) as f32, (TUBE_RADIUS_M * sine) as f32)
    };
    let mut mesh = Mesh::default();
    let rings = 16;
    for sector in 0..SECTORS {
        let [a, b] = [around(sector), around(sector + 1)];
        for ring in 0..rings {
            let (from, step) = (ring as f32 / rings as f32 * length_m, length_m / rings as f32);
            quad(&mut mesh, 0, a + Vec3::X * from, Vec3::X * step, b - a);
        }
        triangle(&mut mesh, 1, [Vec3::ZERO, a, b]);
        triangle(&mut mesh, 2, [Vec3::X * length_m, b + Vec3::X * length_m, a + Vec3::X * length_m]);
    }
    // In the middle of a facet, clear of it, each at another angle.
    let sensors = ASKED.iter().enumerate().map(|(at, &x)| {
        let turn = Mat3::from_rotation_x((TAU * (7.0 * at as f64 + 0.5) / SECTORS as f64) as f32);
        let out = turn * Vec3::Y;
        sensor(Vec3::X * (2.0 * TUBE_RADIUS_M * x) as f32 + out * (0.997 * TUBE_RADIUS_M) as f32, Some(-out))
    });
    let shining = Material { emission_w_m2_sr: 1.0, ..grey(0.0) };
    let materials = vec![grey(reflectance), shining, grey(0.0)];
    Scene { materials, ..scene_of(mesh, 0.0, Vec::new(), sensors.collect()) }
}

pub const BRIGHT_TUBE: Law = Law {
    name: "bright tube",
    test: |subject, breaches| in_tube(subject, breaches, 0.8, &Allowed { control: 1.02, diffusion: 2.0, other: 1.2 }),
};

pub const GREY_TUBE: Law = Law {
    name: "grey tube",
    test: |subject, breaches| in_tube(subject, breaches, 0.5, &Allowed { control: 1.02, diffusion: 2.0, other: 1.3 }),
};

fn in_tube(subject: &Subject, breaches: &mut Breaches, reflectance: f32, allowed: &Allowed) {
    let case = Case::at(tube(reflectance), 0.2);
    let readings = subject.field_with(&case, &Settings { samples: 6144, ..settings() }).readings;
    hold(subject, breaches, &readings, reflectance, allowed.of(subject.method));
}

fn hold(subject: &Subject, breaches: &mut Breaches, readings: &[Reading], reflectance: f32, rms_factor: f64) {
    let exact = Tube::new(TUBE_LENGTH, f64::from(reflectance));
    let truth: Vec<f64> = ASKED.iter().map(|&x| PI * exact.at(x)).collect();
    let place = |at: usize| format!("reflectance {reflectance}, {} diameters", ASKED[at]);
    near(subject, breaches, readings, &truth, rms_factor, place);
}

/// A factor beyond which an answer is no answer.
const USELESS: f64 = 2.0;

/// A method that is lost in dark passages says so.
pub const CANDID: Law = Law {
    name: "candid",
    test: |subject, breaches| {
        for reflectance in [0.5_f32, 0.2] {
            let case = Case::at(tube(reflectance), 0.2);
            let field = subject.field_with(&case, &Settings { samples: 512, ..settings() });
            let mut lost = Breaches::default();
            hold(subject, &mut lost, &field.readings, reflectance, USELESS);
            let warns = field.warnings.iter().any(|warning| warning.contains("reflect"));
            breaches.unless(lost.is_empty() || warns, || {
                format!("silent at reflectance {reflectance}, where {}", lost.0.join("; "))
            });
        }
    },
};
