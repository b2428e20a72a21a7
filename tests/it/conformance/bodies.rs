//! Lights of every body, and glazing on their way.

use super::Law;
use super::bounds::sound;
use super::cases::{Case, LAMPS_M, grey, lit_rooms, point, quad, room, scene_of, sensor};
use glam::Vec3;
use lightvein::scene::{Light, Material, Scene};
use std::f64::consts::PI;

/// Direct light through a pane, by the same sums.
const DIRECT: f64 = 1e-4;

const FLUX_W: f64 = 50.0;

/// A small body is a point from afar.
pub const ALIKE: Law = Law {
    name: "bodies alike",
    test: |subject, breaches| {
        let lit = |light: Light| subject.field(&Case::of(lit_rooms(0.7, vec![light]))).readings;
        let expected = lit(point(LAMPS_M[0], FLUX_W));
        for radius_m in [0.001, 0.05] {
            let readings = lit(Light::Sphere { centre_m: LAMPS_M[0], radius_m, flux_w: FLUX_W });
            breaches.unless_redrawn(subject, &format!("a ball of {radius_m} m for a point"), &readings, &expected);
        }
    },
};

/// One light told in two ways, drawn in two ways.
pub const FACES: Law = Law {
    name: "faces as quads",
    test: |subject, breaches| {
        // So near to the ceiling that its faces, which are solid, fill no voxels of their own.
        let (corner, u, v) = (Vec3::new(0.71875, 0.78125, 2.46875), Vec3::Y * 0.75, Vec3::X * 0.75);
        let by_light = lit_rooms(0.7, vec![Light::Quad { corner_m: corner, u_m: u, v_m: v, flux_w: FLUX_W }]);
        let mut by_faces = lit_rooms(0.7, Vec::new());
        quad(&mut by_faces.mesh, 1, corner, u, v);
        let radiance = FLUX_W / (PI * f64::from(u.cross(v).length()));
        by_faces.materials.push(Material { emission_w_m2_sr: radiance as f32, ..grey(0.0) });
        let expected = subject.field(&Case::of(by_light)).readings;
        breaches.unless_redrawn(subject, "faces for a quad", &subject.field(&Case::of(by_faces)).readings, &expected);
    },
};

pub const GLAZING: Law = Law {
    name: "glazing",
    test: |subject, breaches| {
        // A black room that a pane parts: what lies behind it gets its share of the direct light, and no more.
        let glazed = |transmittance: Option<f32>| {
            let mut mesh = room(Vec3::new(4.0, 2.5, 2.5));
            if transmittance.is_some() {
                quad(&mut mesh, 1, Vec3::X * 2.0625, Vec3::Y * 2.5, Vec3::Z * 2.5);
            }
            let pane = Material { transmittance: transmittance.unwrap_or(0.0), ..grey(0.0) };
            let places = [
                ([3.09375, 1.53125, 1.03125], None),
                ([3.09375, 1.53125, 0.0], Some(Vec3::Z)),
                ([1.40625, 1.84375, 0.90625], None),
            ];
            let sensors = places.map(|(at, normal)| sensor(at.into(), normal)).into();
            let lights = vec![point(Vec3::new(0.84375, 1.15625, 1.59375), FLUX_W)];
            let scene = Scene { materials: vec![grey(0.0), pane], ..scene_of(mesh, 0.0, lights, sensors) };
            subject.field(&Case::of(scene)).readings
        };
        let bare = glazed(None);
        for transmittance in [0.5_f32, 0.9] {
            for (at, (behind, bare)) in glazed(Some(transmittance)).iter().zip(&bare).enumerate() {
                let share = if at < 2 { f64::from(transmittance) } else { 1.0 };
                let off = (behind.value_w_m2 - share * bare.value_w_m2).abs();
                breaches.unless(off <= DIRECT * bare.value_w_m2, || {
                    format!("sensor {at} with a pane of {transmittance}: {behind:?}, {} without", bare.value_w_m2)
                });
            }
        }
    },
};

pub const BY_WALLS: Law = Law {
    name: "lights by walls",
    test: |subject, breaches| {
        let usual = subject.field(&Case::of(lit_rooms(0.7, vec![point(LAMPS_M[0], FLUX_W)]))).readings;
        let brightest = usual.iter().map(|reading| reading.value_w_m2).fold(0.0, f64::max);
        for (what, light) in [
            ("1 mm off a wall", point(Vec3::new(0.001, 1.03125, 1.28125), FLUX_W)),
            ("1 cm off a corner", point(Vec3::new(0.01, 0.01, 2.49), FLUX_W)),
            ("in the wall's middle", point(Vec3::new(3.125, 0.53125, 1.28125), FLUX_W)),
            (
                "a ball half in a wall",
                Light::Sphere { centre_m: Vec3::new(0.0, 1.03125, 1.28125), radius_m: 0.125, flux_w: FLUX_W },
            ),
            ("outside", point(Vec3::new(30.0, 1.0, 1.0), FLUX_W)),
        ] {
            let case = Case::of(lit_rooms(0.7, vec![light]));
            for (at, reading) in subject.field(&case).readings.iter().enumerate() {
                sound(breaches, &format!("{what}, {}", case.id(at)), reading);
                // Nothing of this is nearer to a sensor than the usual lamp by more than a factor of a few.
                let holds = reading.value_w_m2 <= 20.0 * brightest;
                breaches.unless(holds, || format!("{what}, {}: {} W/m2", case.id(at), reading.value_w_m2));
            }
        }
    },
};
