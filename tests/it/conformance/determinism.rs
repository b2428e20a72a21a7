//! The same question has the same answer.

use super::cases::{Case, LAMPS_M, both_rooms, lit_rooms, point};
use super::{Law, settings};
use lightvein::job::{Cancel, Cancelled, Progress, Quiet};
use lightvein::light::{Field, Reading, Settings};
use lightvein::scene::Scene;

/// All numbers of a field as bits.
fn bits(field: &Field) -> Vec<[u64; 5]> {
    let numbers = field.readings.iter().map(|reading| {
        let flux = reading.flux_w_m2;
        [reading.value_w_m2, flux.x, flux.y, flux.z, reading.error_w_m2.unwrap_or(-1.0)]
    });
    let mut bits: Vec<_> = numbers.map(|numbers| numbers.map(f64::to_bits)).collect();
    let shares = field.shares.iter().flat_map(|shares| &shares.values_w_m2);
    bits.extend(shares.map(|share| [share.to_bits(), 0, 0, 0, 0]));
    bits
}

pub const THREADS: Law = Law {
    name: "threads",
    test: |subject, breaches| {
        let case = Case::of(both_rooms());
        let settings = Settings { shares: true, ..settings() };
        let first = subject.field_with(&case, &settings);
        for threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            for run in ["once", "again"] {
                let field = pool.install(|| subject.field_with(&case, &settings));
                let same = bits(&field) == bits(&first) && field.warnings == first.warnings;
                breaches.unless(same, || format!("other bits with {threads} threads, {run}"));
            }
        }
    },
};

/// A sensor's own rays may be drawn by its number.
pub const ORDER: Law = Law {
    name: "order",
    test: |subject, breaches| {
        let scene = both_rooms();
        let readings = subject.field(&Case::of(scene.clone())).readings;
        let mut compare = |what: &str, order: Vec<usize>| {
            let sensors = order.iter().map(|&at| scene.sensors[at].clone()).collect();
            let found = subject.field(&Case::of(Scene { sensors, ..scene.clone() })).readings;
            let expected: Vec<Reading> = order.iter().map(|&at| readings[at]).collect();
            breaches.unless_redrawn(subject, what, &found, &expected);
        };
        let all = 0..readings.len();
        compare("asked backwards", all.clone().rev().collect());
        compare("every second alone", all.clone().step_by(2).collect());
        compare("each twice", all.flat_map(|at| [at, at]).collect());
    },
};

pub const SEEDS: Law = Law {
    name: "seeds",
    test: |subject, breaches| {
        let case = Case::of(lit_rooms(0.7, vec![point(LAMPS_M[0], 100.0)]));
        let seeded = |seed: u64| subject.field_with(&case, &Settings { seed, ..settings() }).readings;
        let first = seeded(0);
        for seed in [1, 2, 0x9e37_79b9_7f4a_7c15] {
            breaches.unless_redrawn(subject, &format!("seed {seed}"), &seeded(seed), &first);
        }
    },
};

/// Raises the flag when the first stage begins.
struct Raise<'a>(&'a Cancel);

impl Progress for Raise<'_> {
    fn begin(&self, _stage: &str, _total: u64) {
        self.0.cancel();
    }
    fn advance(&self, _units: u64) {}
    fn end(&self) {}
}

pub const CANCELLED: Law = Law {
    name: "cancelled",
    test: |subject, breaches| {
        let case = Case::of(both_rooms());
        let raised = Cancel::new();
        raised.cancel();
        let stopped = (subject.ask)(&case, &settings(), &Quiet, &raised);
        breaches.unless(stopped == Err(Cancelled), || "a flag raised before is not seen".to_owned());

        let cancel = Cancel::new();
        let stopped = (subject.ask)(&case, &settings(), &Raise(&cancel), &cancel);
        breaches.unless(cancel.is_cancelled(), || "no stage is reported".to_owned());
        breaches.unless(stopped == Err(Cancelled), || "a flag raised as a stage begins is not seen".to_owned());
    },
};
