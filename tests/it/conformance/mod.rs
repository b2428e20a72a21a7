//! One set of laws of physics, run over every estimator there is, at every rung of its ladder.
//!
//! A [`Law`] is a function that asks a [`Subject`] for fields of small scenes and notes each breach. Whatever
//! [`ladder`](lightvein::flow::ladder) gives falls under all of them by itself; the path tracer runs beside as the control,
//! for a law that the truth breaks is wrong. What a method by design does not obey stands in [`EXCEPTIONS`] with the
//! reason, and must be broken indeed: an exception that is no longer needed fails as a breach does. That the laws have teeth
//! is shown by [`mutants`]: estimators made wrong on purpose, each of which its law must catch.

mod bodies;
mod bounds;
mod cases;
mod closed_forms;
mod coupled_spheres;
mod cylinder;
mod determinism;
mod exceptions;
mod exchange;
mod linearity;
mod mutants;
mod reflectance;
mod statuses;
mod symmetry;
mod truth;
mod tube;

use cases::Case;
use exceptions::exception;
use lightvein::flow::ladder;
use lightvein::job::{Cancel, Cancelled, Progress, Quiet};
use lightvein::light::{Field, Reading, Settings};
use lightvein::scene::Method;
use lightvein::trace::trace;

/// Samples of the control a sensor; a law that needs more says so.
const SAMPLES: u32 = 2048;

/// Answers at the sensors of a case.
type Ask = dyn Fn(&Case, &Settings, &dyn Progress, &Cancel) -> Result<Field, Cancelled> + Sync;

/// What is held to the laws: a rung of an estimator, the path tracer, or a mutant of either.
pub struct Subject {
    /// What it is of; exceptions go by it.
    pub method: Method,
    /// Method and quality, for the reader of a breach.
    pub label: String,
    /// The field it gives.
    pub ask: Box<Ask>,
}

impl Subject {
    /// The field at the sensors of a case, with the control's usual samples.
    pub fn field(&self, case: &Case) -> Field {
        self.field_with(case, &settings())
    }

    /// The same with other settings.
    pub fn field_with(&self, case: &Case, settings: &Settings) -> Field {
        (self.ask)(case, settings, &Quiet, &Cancel::new()).expect("nobody cancels")
    }
}

/// How far a value may move when its random numbers are drawn anew, a factor: what issue 3 allows a shift of the grid. Methods
/// without random numbers get none, and the control what its own standard errors say.
pub fn redrawn_factor(method: Method) -> f64 {
    match method {
        Method::Backward | Method::Forward | Method::Trace => 1.0 + 1e-4,
        Method::Diffusion => 1.3,
        Method::Network => 1.1,
    }
}

/// What laws ask with unless they vary it.
pub fn settings() -> Settings {
    Settings { samples: SAMPLES, ..Settings::default() }
}

/// Every rung of every estimator, then the path tracer.
pub fn subjects() -> Vec<Subject> {
    let rungs = Method::ALL.into_iter().flat_map(ladder).map(|rung| Subject {
        method: rung.method,
        label: rung.label(),
        ask: Box::new(move |case, settings, progress, cancel| {
            (rung.estimate)(&case.model, &case.probes(), settings, progress, cancel)
        }),
    });
    rungs.chain([control()]).collect()
}

/// The path tracer in the shape of an estimator.
pub fn control() -> Subject {
    let ask = |case: &Case, settings: &Settings, progress: &dyn Progress, cancel: &Cancel| {
        let traced = trace(&case.scene, &case.model.rays, &case.model.sources, settings, progress, cancel);
        traced.map(|traced| traced.field)
    };
    Subject { method: Method::Trace, label: "trace".to_owned(), ask: Box::new(ask) }
}

/// A law: its name in [`exceptions`], and what notes its breaches.
#[derive(Clone, Copy)]
pub struct Law {
    /// What must hold, short.
    pub name: &'static str,
    /// Asks the subject and notes each breach.
    pub test: fn(&Subject, &mut Breaches),
}

/// What was found against a law.
#[derive(Debug, Default)]
pub struct Breaches(Vec<String>);

impl Breaches {
    /// Notes a breach unless `holds`.
    pub fn unless(&mut self, holds: bool, breach: impl FnOnce() -> String) {
        if !holds {
            self.0.push(breach());
        }
    }

    /// Notes a breach unless `found` lies within `share` of `expected`.
    pub fn unless_within(&mut self, share: f64, what: &str, found: f64, expected: f64) {
        let holds = (found - expected).abs() <= share * expected.abs();
        self.unless(holds, || format!("{what}: {found:.6e}, not {expected:.6e} within {share}"));
    }

    /// Notes a breach unless both are above 0 and neither more than `factor` times the other; two zeros agree.
    pub fn unless_factor(&mut self, factor: f64, what: &str, found: f64, expected: f64) {
        let ratio = found / expected;
        let holds = (found == 0.0 && expected == 0.0) || (ratio <= factor && ratio >= 1.0 / factor);
        self.unless(holds, || format!("{what}: {found:.6e} against {expected:.6e}, {ratio:.4} is not within {factor}"));
    }

    /// Notes a breach for each reading that is farther from the expected one than a new draw explains, and one where their
    /// mean ratio is farther than half of that.
    pub fn unless_redrawn(&mut self, subject: &Subject, what: &str, found: &[Reading], expected: &[Reading]) {
        let factor = redrawn_factor(subject.method);
        let (mut ratios, mut noise, count) = (0.0, 0.0, found.len() as f64);
        for (at, (found, expected)) in found.iter().zip(expected).enumerate() {
            let noise_w_m2 = subject.noise_w_m2(&[found, expected]);
            ratios += found.value_w_m2 / expected.value_w_m2 / count;
            noise += noise_w_m2 / expected.value_w_m2 / count;
            if (found.value_w_m2 - expected.value_w_m2).abs() > noise_w_m2 {
                let what = format!("{what}, sensor {at}");
                self.unless_factor(factor, &what, found.value_w_m2, expected.value_w_m2);
            }
            self.unless(found.status == expected.status, || format!("{what}, sensor {at}: {:?}", found.status));
        }
        let half = 0.5 * (factor - 1.0) + noise;
        self.unless((ratios - 1.0).abs() <= half, || {
            format!("{what}: {ratios:.4} in the mean, not 1 within {half:.4}")
        });
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// The breaches of a law by a subject.
pub fn breaches(law: &Law, subject: &Subject) -> Breaches {
    let mut breaches = Breaches::default();
    (law.test)(subject, &mut breaches);
    breaches
}

/// Breaches of a subject that are shown.
const MOST_SHOWN: usize = 6;

/// Holds every subject to the law, and every exception from it to its word.
fn check(law: &Law) {
    let mut found = Vec::new();
    let mut excused: Vec<(Method, bool)> = Vec::new();
    for subject in subjects() {
        let Breaches(of_subject) = breaches(law, &subject);
        let Some(reason) = exception(law.name, subject.method, &subject.label) else {
            found.extend(of_subject.iter().take(MOST_SHOWN).map(|breach| format!("{}: {breach}", subject.label)));
            let more = of_subject.len().saturating_sub(MOST_SHOWN);
            found.extend((more > 0).then(|| format!("{}: and {more} more", subject.label)));
            continue;
        };
        println!("{}: excepted from \"{}\", for {reason}; {} breaches", subject.label, law.name, of_subject.len());
        match excused.iter_mut().find(|(method, _)| *method == subject.method) {
            Some((_, breaks)) => *breaks |= !of_subject.is_empty(),
            None => excused.push((subject.method, !of_subject.is_empty())),
        }
    }
    let stale = excused.into_iter().filter(|(_, breaks)| !breaks);
    found.extend(stale.map(|(method, _)| format!("{method}: obeys, so its exception has to go")));
    assert!(found.is_empty(), "{}: {} breaches\n{}", law.name, found.len(), found.join("\n"));
}

/// A test for each law, and the list of all.
macro_rules! laws {
    ($($test:ident: $law:path,)*) => {
        /// All laws.
        pub const LAWS: &[Law] = &[$($law),*];

        $(#[test]
        fn $test() {
            check(&$law);
        })*
    };
}

laws! {
    twice_the_flux_is_twice_the_light: linearity::DOUBLED,
    lights_add: linearity::ADDED,
    shares_sum_to_the_value: linearity::SHARES,
    a_light_without_flux_is_dark: linearity::NO_FLUX,
    a_scene_of_twice_the_size_has_a_quarter: symmetry::SCALED,
    shifted_by_whole_voxels_nothing_changes: symmetry::SHIFTED,
    a_mirrored_scene_has_mirrored_light: symmetry::MIRRORED,
    a_turned_scene_has_turned_light: symmetry::TURNED,
    values_and_directions_are_sound: bounds::SOUND,
    planes_see_no_more_than_points: bounds::PLANES,
    opposite_planes_differ_by_the_flux: bounds::OPPOSITE,
    nothing_outshines_the_light: bounds::BRIGHTEST,
    every_sensor_has_its_status: statuses::STATUSES,
    separate_voids_do_not_meet: statuses::APART,
    no_light_is_an_answer_too: statuses::NO_LIGHT,
    bodies_of_one_flux_light_alike: bodies::ALIKE,
    faces_shine_as_quads_do: bodies::FACES,
    glazing_passes_its_share: bodies::GLAZING,
    lights_by_walls_and_in_matter_do_no_harm: bodies::BY_WALLS,
    a_black_scene_has_direct_light_alone: reflectance::BLACK,
    more_reflectance_is_more_light: reflectance::MONOTONE,
    white_walls_end_and_warn: reflectance::WHITE,
    threads_do_not_matter: determinism::THREADS,
    the_order_of_probes_does_not_matter: determinism::ORDER,
    seeds_change_only_noise: determinism::SEEDS,
    a_raised_flag_stops_at_once: determinism::CANCELLED,
    a_closed_room_has_its_flux_over_what_it_absorbs: closed_forms::FURNACE,
    two_spheres_exchange_by_their_port: closed_forms::SPHERES,
    a_bright_tube_has_its_radiosity: tube::BRIGHT_TUBE,
    a_grey_tube_has_its_radiosity: tube::GREY_TUBE,
    two_rooms_are_as_the_path_tracer_has_them: truth::TRUTH,
    errors_are_owned_up_to: truth::OWN_ERROR,
    who_is_lost_says_so: tube::CANDID,
}

#[test]
fn exceptions_name_laws_that_exist() {
    for (law, method, ..) in exceptions::EXCEPTIONS {
        assert!(LAWS.iter().any(|known| known.name == *law), "{method}: there is no law \"{law}\"");
    }
}
