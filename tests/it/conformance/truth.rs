//! Two rooms and the door between them, against the path tracer with many samples.

use super::cases::{Case, LAMPS_M, lit_rooms, point};
use super::closed_forms::{Allowed, near};
use super::{Law, control, settings};
use lightvein::light::Settings;
use std::sync::OnceLock;

/// Reflectances of the rooms, and what the issue allows against references there; `diffusion` is no result below .7.
const ALLOWED: [(f32, Allowed); 3] = [
    (0.7, Allowed { control: 1.02, diffusion: 2.0, other: 1.2 }),
    (0.5, Allowed { control: 1.02, diffusion: f64::INFINITY, other: 1.3 }),
    (0.3, Allowed { control: 1.02, diffusion: f64::INFINITY, other: 1.5 }),
];

/// The rooms at each of the reflectances, with the true values, W/m2; traced once for all subjects.
fn traced() -> &'static [(Case, Vec<f64>)] {
    static TRACED: OnceLock<Vec<(Case, Vec<f64>)>> = OnceLock::new();
    TRACED.get_or_init(|| {
        let many = Settings { samples: 40_000, seed: 1, ..settings() };
        let truth = |reflectance: f32| {
            let case = Case::of(lit_rooms(reflectance, vec![point(LAMPS_M[0], 100.0)]));
            let readings = control().field_with(&case, &many).readings;
            (case, readings.iter().map(|reading| reading.value_w_m2).collect())
        };
        ALLOWED.iter().map(|(reflectance, _)| truth(*reflectance)).collect()
    })
}

/// As near to the truth as the issue wants it.
pub const TRUTH: Law = Law {
    name: "truth",
    test: |subject, breaches| {
        for ((case, truth), (reflectance, allowed)) in traced().iter().zip(&ALLOWED) {
            let readings = subject.field(case).readings;
            let place = |at: usize| format!("reflectance {reflectance}, {}", case.id(at));
            near(subject, breaches, &readings, truth, allowed.of(subject.method), place);
        }
    },
};

/// A value may be farther from the truth than this many of its own errors and this share, for the truth has noise too.
const ERRORS: f64 = 3.0;
const SHARE: f64 = 0.05;

/// Not more of the readings than this may be.
const BEYOND: f64 = 0.2;

/// The error that a method gives for each value is one: values lie within a few of it.
pub const OWN_ERROR: Law = Law {
    name: "own error",
    test: |subject, breaches| {
        let (mut all, mut beyond) = (0, Vec::new());
        for ((case, truth), (reflectance, _)) in traced().iter().zip(&ALLOWED) {
            for (at, (reading, truth)) in subject.field(case).readings.iter().zip(truth).enumerate() {
                all += 1;
                let error = reading.error_w_m2.unwrap_or(f64::NAN);
                breaches.unless(error >= 0.0, || format!("reflectance {reflectance}, {}: no error", case.id(at)));
                let off = reading.value_w_m2 - truth;
                if off.abs() > ERRORS * error + SHARE * truth {
                    beyond.push(format!("{reflectance} {}: {:+.3} +- {:.3}", case.id(at), off / truth, error / truth));
                }
            }
        }
        breaches.unless(beyond.len() as f64 <= BEYOND * f64::from(all), || {
            format!("{} of {all} beyond {ERRORS} own errors: {}", beyond.len(), beyond.join(", "))
        });
    },
};
