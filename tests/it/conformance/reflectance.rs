//! What walls send back: nothing, more, all.

use super::bounds::sound;
use super::cases::{Case, LAMPS_M, lit_rooms, point, room, scene_of, sensor};
use super::{Law, settings};
use glam::Vec3;
use lightvein::light::{Settings, Status};
use std::f64::consts::PI;

/// Positions are `f32`, and a sensor on a wall is lifted off it.
const DIRECT: f64 = 2e-4;

/// With the same rays, more reflectance may cost no sensor more than this share by rounding and by a solver's stop.
const FALLEN: f64 = 1e-3;

/// From .2 to .8 the light behind a door must at least double: one reflection alone grows fourfold.
const LEAST_RISE: f64 = 2.0;

pub const BLACK: Law = Law {
    name: "black is direct",
    test: |subject, breaches| {
        let light_m = LAMPS_M[0];
        let case = Case::of(lit_rooms(0.0, vec![point(light_m, 100.0)]));
        for (at, reading) in subject.field(&case).readings.iter().enumerate() {
            let sensor = &case.scene.sensors[at];
            let towards_m = (light_m - sensor.position_m).as_dvec3();
            let cosine = sensor.normal.map_or(1.0, |normal| normal.as_dvec3().dot(towards_m.normalize()).max(0.0));
            // The wall hides the lamp where the straight way crosses it outside the door.
            let across =
                |x: f32| light_m.lerp(sensor.position_m, (x - light_m.x) / (sensor.position_m.x - light_m.x)).y;
            let hidden = sensor.position_m.x > 3.25 && [3.0, 3.25].iter().any(|&x| across(x) < 2.0);
            let expected = if hidden { 0.0 } else { 100.0 / (4.0 * PI) * cosine / towards_m.length_squared() };
            let what = format!("{} at reflectance 0", case.id(at));
            breaches.unless_within(DIRECT, &what, reading.value_w_m2, expected);
            let status = if expected > 0.0 { Status::Ok } else { Status::Dark };
            breaches.unless(reading.status == status, || format!("{what}: {:?}, not {status:?}", reading.status));
            let direction = towards_m.normalize();
            let aims = expected == 0.0 || reading.direction().distance(direction) < 1e-3;
            breaches.unless(aims, || format!("{what}: from {}, not {direction}", reading.direction()));
        }
    },
};

pub const MONOTONE: Law = Law {
    name: "monotone",
    test: |subject, breaches| {
        let reflectances = [0.0_f32, 0.2, 0.5, 0.8, 0.95, 0.99];
        let case = |reflectance: f32| Case::of(lit_rooms(reflectance, vec![point(LAMPS_M[0], 100.0)]));
        let fields: Vec<_> = reflectances.map(|reflectance| subject.field(&case(reflectance)).readings).into();
        for (step, pair) in fields.windows(2).enumerate() {
            for (at, (less, more)) in pair[0].iter().zip(&pair[1]).enumerate() {
                let slack = FALLEN * less.value_w_m2 + subject.noise_w_m2(&[less, more]);
                breaches.unless(more.value_w_m2 >= less.value_w_m2 - slack, || {
                    let (from, to) = (reflectances[step], reflectances[step + 1]);
                    format!("sensor {at} falls from {} to {} from {from} to {to}", less.value_w_m2, more.value_w_m2)
                });
            }
        }
        // Sensors 4 to 6 stand behind the door.
        for (at, (low, high)) in fields[1].iter().zip(&fields[3]).enumerate().skip(4) {
            breaches.unless(high.value_w_m2 >= LEAST_RISE * low.value_w_m2 && high.value_w_m2 > 0.0, || {
                format!("sensor {at} has {} at .2 and {} at .8", low.value_w_m2, high.value_w_m2)
            });
        }
    },
};

pub const WHITE: Law = Law {
    name: "white",
    test: |subject, breaches| {
        let sensors = vec![
            sensor(Vec3::new(1.40625, 1.53125, 0.90625), None),
            sensor(Vec3::new(0.71875, 0.65625, 0.0), Some(Vec3::Z)),
        ];
        let light = point(Vec3::new(1.15625, 0.90625, 1.59375), 100.0);
        let lit = |reflectance: f32| {
            let case = Case::of(scene_of(room(Vec3::new(2.5, 2.0, 2.25)), reflectance, vec![light], sensors.clone()));
            // Few samples: paths of the control are long here.
            subject.field_with(&case, &Settings { samples: 64, ..settings() })
        };
        let (white, nearly) = (lit(1.0), lit(0.9));
        for (at, (white, nearly)) in white.readings.iter().zip(&nearly.readings).enumerate() {
            sound(breaches, &format!("sensor {at} among white walls"), white);
            breaches.unless(white.value_w_m2 >= nearly.value_w_m2, || {
                format!("sensor {at}: {} at reflectance 1, {} at .9", white.value_w_m2, nearly.value_w_m2)
            });
        }
        let told = white.warnings.iter().any(|warning| warning.contains("reflect") || warning.contains("absorb"));
        breaches.unless(told, || format!("no word of the reflectance: {:?}", white.warnings));
        let alarm = nearly.warnings.iter().any(|warning| warning.contains("reflectance 1"));
        breaches.unless(!alarm, || format!("a false alarm at .9: {:?}", nearly.warnings));
    },
};
