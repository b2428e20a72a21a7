//! What became of a sensor is said, never a silent zero; and voids that do not meet do not light each other.

use super::Law;
use super::bounds::sound;
use super::cases::{Case, boxed, point, room, scene_of, sensor};
use glam::Vec3;
use lightvein::light::Status;
use lightvein::scene::{Light, Mesh, Scene};

/// Two rooms without a door between them, and a post too thin to have a void in it in the first.
fn apart() -> Mesh {
    let mut mesh = room(Vec3::new(3.0, 2.5, 2.25));
    boxed(&mut mesh, 0, Vec3::new(4.0, 0.0, 0.0), Vec3::new(6.5, 2.5, 2.25), false);
    boxed(&mut mesh, 0, Vec3::new(1.0, 1.0, 0.5), Vec3::new(1.125, 1.125, 2.0), true);
    mesh
}

const LAMP_M: Vec3 = Vec3::new(2.21875, 0.78125, 1.53125);

pub const STATUSES: Law = Law {
    name: "statuses",
    test: |subject, breaches| {
        let asked = [
            ([2.03125, 1.96875, 0.90625], None, Status::Ok),
            ([2.03125, 1.96875, 0.90625], Some(Vec3::NEG_Y), Status::Ok),
            ([5.03125, 1.03125, 0.90625], None, Status::Unreached),
            ([5.03125, 1.03125, 0.0], Some(Vec3::Z), Status::Unreached),
            ([1.0625, 1.0625, 1.25], None, Status::InSolid),
            ([1.0625, 1.0625, 1.25], Some(Vec3::X), Status::InSolid),
            ([20.0, 1.0, 1.0], None, Status::Outside),
            ([20.0, 1.0, 1.0], Some(Vec3::NEG_X), Status::Outside),
            ([2.40625, 1.40625, 0.0], Some(Vec3::Z), Status::Ok),
        ];
        let sensors = asked.map(|(at, normal, _)| sensor(at.into(), normal)).into();
        let case = Case::of(scene_of(apart(), 0.6, vec![point(LAMP_M, 40.0)], sensors));
        let readings = subject.field(&case).readings;
        breaches.unless(readings.len() == asked.len(), || format!("{} readings", readings.len()));
        for ((at, reading), (.., status)) in readings.iter().enumerate().zip(&asked) {
            breaches
                .unless(reading.status == *status, || format!("{}: {:?}, not {status:?}", case.id(at), reading.status));
            sound(breaches, case.id(at), reading);
        }
        let nobody = Scene { sensors: Vec::new(), ..case.scene.clone() };
        let none = subject.field(&Case::of(nobody)).readings.len();
        breaches.unless(none == 0, || format!("{none} readings of no sensors"));
    },
};

pub const APART: Law = Law {
    name: "separate voids",
    test: |subject, breaches| {
        let places = [[2.03125, 1.96875, 0.90625], [5.53125, 1.96875, 0.84375]];
        let sensors = || places.map(|at| sensor(at.into(), None)).into();
        let other_m = Vec3::new(4.78125, 0.71875, 1.53125);
        let lit = |first_w: f64, second_w: f64| {
            let lights = vec![point(LAMP_M, first_w), point(other_m, second_w)];
            subject.field(&Case::of(scene_of(apart(), 0.8, lights, sensors()))).readings
        };
        let (both, first, second) = (lit(40.0, 0.01), lit(40.0, 0.0), lit(0.0, 0.01));
        breaches.unless_redrawn(subject, "bright void", &both[..1], &first[..1]);
        breaches.unless_redrawn(subject, "dim void", &both[1..], &second[1..]);
        for (what, reading) in [("first", &second[0]), ("second", &first[1])] {
            breaches.unless(reading.value_w_m2 == 0.0, || format!("{what} void is lit through matter: {reading:?}"));
        }
    },
};

pub const NO_LIGHT: Law = Law {
    name: "no light",
    test: |subject, breaches| {
        let sensors = || vec![sensor(Vec3::new(2.03125, 1.96875, 0.90625), None)];
        let unlit =
            |lights: Vec<Light>| subject.field(&Case::of(scene_of(apart(), 0.6, lights, sensors()))).readings[0];
        let none = unlit(Vec::new());
        let dark = none.value_w_m2 == 0.0 && none.flux_w_m2.length() == 0.0 && none.status == Status::Unreached;
        breaches.unless(dark, || format!("without lights {none:?}"));
        let elsewhere = unlit(vec![point(Vec3::new(5.03125, 1.03125, 1.0), 50.0)]);
        let dark = elsewhere.value_w_m2 == 0.0 && elsewhere.status == Status::Unreached;
        breaches.unless(dark, || format!("lit from another void: {elsewhere:?}"));
    },
};
