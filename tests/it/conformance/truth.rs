//! Two rooms and the door between them, against the path tracer with many samples.

use super::cases::{Case, LAMPS_M, lit_rooms, point};
use super::closed_forms::{Allowed, near};
use super::{Law, control, settings};
use lightvein::light::Settings;
use std::sync::OnceLock;

/// The bounds of issue 3 for references; `diffusion` is no result below .7.
pub const TRUTH: Law = Law {
    name: "truth",
    test: |subject, breaches| {
        let allowed = [
            (0.7, Allowed { control: 1.02, diffusion: 2.0, other: 1.2 }),
            (0.5, Allowed { control: 1.02, diffusion: f64::INFINITY, other: 1.3 }),
            (0.3, Allowed { control: 1.02, diffusion: f64::INFINITY, other: 1.5 }),
        ];
        static TRACED: OnceLock<Vec<(Case, Vec<f64>)>> = OnceLock::new();
        let traced = TRACED.get_or_init(|| {
            let many = Settings { samples: 40_000, seed: 1, ..settings() };
            let rooms = |reflectance: f32| Case::of(lit_rooms(reflectance, vec![point(LAMPS_M[0], 100.0)]));
            let truth = |case: Case| {
                let readings = control().field_with(&case, &many).readings;
                (case, readings.iter().map(|reading| reading.value_w_m2).collect())
            };
            allowed.iter().map(|(reflectance, _)| truth(rooms(*reflectance))).collect()
        });
        for ((case, truth), (reflectance, allowed)) in traced.iter().zip(&allowed) {
            let readings = subject.field(case).readings;
            let place = |at: usize| format!("reflectance {reflectance}, {}", case.id(at));
            near(subject, breaches, &readings, truth, allowed.of(subject.method), place);
        }
    },
};
