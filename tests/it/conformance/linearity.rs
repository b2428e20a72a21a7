//! Light is linear in its sources.

use super::cases::{Case, LAMPS_M, lit_rooms, point};
use super::{Law, Subject, redrawn_factor, settings};
use lightvein::light::{Reading, Settings, Status};

/// Flux times two is value and flux times two: the same numbers but for the rounding of sums. A solver may stop elsewhere
/// by no more than this.
const ROUNDING: f64 = 1e-6;

pub const DOUBLED: Law = Law {
    name: "doubled flux",
    test: |subject, breaches| {
        let lit = |times: f64| {
            let case = Case::of(lit_rooms(0.7, vec![point(LAMPS_M[0], 50.0 * times), point(LAMPS_M[1], 3.0 * times)]));
            (subject.field(&case), case)
        };
        let (once, case) = lit(1.0);
        for times in [2.0, 1e6] {
            let (more, _) = lit(times);
            for (at, (once, more)) in once.readings.iter().zip(&more.readings).enumerate() {
                let what = format!("flux times {times}, {}", case.id(at));
                breaches.unless(once.value_w_m2 > 0.0, || format!("{what}: dark"));
                breaches.unless_within(ROUNDING, &what, more.value_w_m2, times * once.value_w_m2);
                let apart = more.flux_w_m2.distance(times * once.flux_w_m2);
                let holds = apart <= ROUNDING * times * once.value_w_m2;
                breaches.unless(holds, || format!("{what}: flux {} of {}", more.flux_w_m2, once.flux_w_m2));
            }
        }
    },
};

/// Rays may be dealt out among lights by their flux, so two lights together are drawn with others than each alone.
pub const ADDED: Law = Law {
    name: "lights add",
    test: |subject, breaches| {
        let lit = |lights: &[(usize, f64)]| {
            let lights = lights.iter().map(|&(lamp, flux_w)| point(LAMPS_M[lamp], flux_w)).collect();
            subject.field(&Case::of(lit_rooms(0.7, lights))).readings
        };
        let together = lit(&[(0, 60.0), (1, 25.0)]);
        for (how, first, second) in [
            ("beside a dead lamp", lit(&[(0, 60.0), (1, 0.0)]), lit(&[(0, 0.0), (1, 25.0)])),
            ("alone", lit(&[(0, 60.0)]), lit(&[(1, 25.0)])),
        ] {
            let sums: Vec<Reading> = first.iter().zip(&second).map(|(a, b)| added(a, b)).collect();
            breaches.unless_redrawn(subject, &format!("together against each {how}"), &together, &sums);
            for (at, (together, sum)) in together.iter().zip(&sums).enumerate() {
                let off = together.flux_w_m2.distance(sum.flux_w_m2);
                let share = 2.0 * (redrawn_factor(subject.method) - 1.0);
                let slack = share * sum.value_w_m2 + 2.0 * subject.noise_w_m2(&[together, sum]);
                breaches.unless(off <= slack, || {
                    format!("sensor {at}: the flux of each {how} does not add up, {off} of {}", sum.value_w_m2)
                });
            }
        }
    },
};

/// Two readings of one sensor by two lights, as one.
fn added(a: &Reading, b: &Reading) -> Reading {
    Reading {
        value_w_m2: a.value_w_m2 + b.value_w_m2,
        flux_w_m2: a.flux_w_m2 + b.flux_w_m2,
        error_w_m2: a.error_w_m2.zip(b.error_w_m2).map(|(a, b)| a.hypot(b)),
        status: if a.status == Status::Ok { a.status } else { b.status },
    }
}

pub const SHARES: Law = Law {
    name: "shares sum to the value",
    test: |subject, breaches| {
        // The second light is weak, so that a share lost in rounding would show.
        let scene = || lit_rooms(0.7, vec![point(LAMPS_M[0], 100.0), point(LAMPS_M[1], 1e-3)]);
        let case = Case::of(scene());
        let asked = Settings { shares: true, ..settings() };
        let field = subject.field_with(&case, &asked);
        let without = subject.field(&case);
        breaches.unless(without.shares.is_none(), || "shares that nobody asked for".to_owned());
        let Some(shares) = field.shares else {
            breaches.unless(false, || "no shares".to_owned());
            return;
        };
        let weak = subject.field(&Case::of(lit_rooms(0.7, vec![point(LAMPS_M[0], 0.0), point(LAMPS_M[1], 1e-3)])));
        breaches.unless(shares.emitters == 2, || format!("{} emitters of 2", shares.emitters));
        for (at, reading) in field.readings.iter().enumerate() {
            let row = shares.of(at);
            let sum: f64 = row.iter().sum();
            breaches.unless_within(ROUNDING, &format!("sum at {}", case.id(at)), sum, reading.value_w_m2);
            breaches.unless_within(
                ROUNDING,
                &format!("value when shares are asked for, {}", case.id(at)),
                reading.value_w_m2,
                without.readings[at].value_w_m2,
            );
            breaches.unless(row.len() == 2 && row.iter().all(|&share| share >= 0.0), || format!("shares {row:?}"));
            let expected = weak.readings[at].value_w_m2;
            let share = row.get(1).copied().unwrap_or(f64::NAN);
            let factor = redrawn_factor(subject.method);
            breaches.unless_factor(factor, &format!("weak light at {}", case.id(at)), share, expected);
        }
    },
};

pub const NO_FLUX: Law = Law {
    name: "no flux",
    test: |subject, breaches| {
        let case = Case::of(lit_rooms(0.7, vec![point(LAMPS_M[0], 0.0), point(LAMPS_M[1], 0.0)]));
        for (at, reading) in subject.field(&case).readings.iter().enumerate() {
            let dark = reading.value_w_m2 == 0.0 && reading.flux_w_m2.length() == 0.0 && reading.status == Status::Dark;
            breaches.unless(dark, || format!("{}: {reading:?}", case.id(at)));
        }
        // Beside a light that shines, one that does not changes nothing.
        let beside = Case::of(lit_rooms(0.7, vec![point(LAMPS_M[0], 50.0), point(LAMPS_M[1], 0.0)]));
        let alone = Case::of(lit_rooms(0.7, vec![point(LAMPS_M[0], 50.0)]));
        let (beside, alone) = (subject.field(&beside).readings, subject.field(&alone).readings);
        breaches.unless_redrawn(subject, "beside a dead lamp", &beside, &alone);
    },
};

impl Subject {
    /// Four standard errors of the control, whose readings say how noisy they are; estimators get none, for their error
    /// estimate is their own word.
    pub fn noise_w_m2(&self, readings: &[&Reading]) -> f64 {
        let control = self.method == lightvein::scene::Method::Trace;
        let errors = readings.iter().filter_map(|reading| reading.error_w_m2).map(|error| error * error);
        if control { 4.0 * errors.sum::<f64>().sqrt() } else { 0.0 }
    }
}
