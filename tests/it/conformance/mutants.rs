//! Have the laws teeth? Estimators made wrong on purpose, and the law that must catch each.

use super::cases::Case;
use super::{
    Law, Subject, bodies, bounds, breaches, closed_forms, control, determinism, linearity, reflectance, statuses,
    subjects, symmetry, truth, tube,
};
use lightvein::job::{Cancel, Progress, Quiet};
use lightvein::light::{Field, Reading, Settings, Status};
use lightvein::scene::Method;

/// What a mutant does to a sound field.
type Spoil = fn(&mut Field, &Case, &Settings);

/// What is spoilt, how, and the law that must catch it.
type Mutant = (&'static str, Method, Law, Spoil);

fn each(field: &mut Field, spoil: impl Fn(usize, &mut Reading)) {
    field.readings.iter_mut().enumerate().for_each(|(at, reading)| spoil(at, reading));
}

fn times(reading: &mut Reading, factor: f64) {
    reading.value_w_m2 *= factor;
    reading.flux_w_m2 *= factor;
}

const MUTANTS: &[Mutant] = &[
    ("a constant glow", Method::Backward, linearity::DOUBLED, |field, _, _| each(field, |_, it| it.value_w_m2 += 1e-4)),
    ("a glow without light", Method::Backward, linearity::NO_FLUX, |field, _, _| {
        each(field, |_, it| it.value_w_m2 += 1e-9)
    }),
    ("a dead lamp is no status", Method::Backward, linearity::NO_FLUX, |field, _, _| {
        each(field, |_, it| it.status = Status::Ok);
    }),
    ("the strongest light alone", Method::Backward, linearity::ADDED, |field, case, _| {
        let fluxes = || case.model.sources.emitters.iter().map(|emitter| emitter.flux_w);
        let share = fluxes().fold(0.0, f64::max) / fluxes().sum::<f64>();
        each(field, |_, it| times(it, share));
    }),
    ("a size in metres", Method::Backward, symmetry::SCALED, |field, case, _| {
        let voxel_m = f64::from(case.model.voxels.lattice.voxel_m);
        each(field, |_, it| times(it, 1.0 + 1e-6 * voxel_m));
    }),
    ("a place in the world", Method::Backward, symmetry::SHIFTED, |field, case, _| {
        each(field, |at, it| times(it, 1.0 + 0.01 * f64::from(case.scene.sensors[at].position_m.x)));
    }),
    ("a glow from +x", Method::Backward, symmetry::MIRRORED, |field, _, _| {
        each(field, |_, it| it.flux_w_m2.x += 0.5 * it.value_w_m2);
    }),
    ("a glow from +x", Method::Backward, symmetry::TURNED, |field, _, _| {
        each(field, |_, it| it.flux_w_m2.x += 0.5 * it.value_w_m2);
    }),
    ("not a number", Method::Backward, bounds::SOUND, |field, _, _| each(field, |_, it| it.value_w_m2 = f64::NAN)),
    ("less than nothing", Method::Backward, bounds::SOUND, |field, _, _| each(field, |_, it| times(it, -1.0))),
    ("a plane's flux of the whole sphere", Method::Backward, bounds::SOUND, |field, _, _| {
        each(field, |_, it| it.flux_w_m2 *= 0.5);
    }),
    ("a flux longer than its light", Method::Backward, bounds::PLANES, |field, _, _| {
        each(field, |_, it| it.flux_w_m2 *= 1.1);
    }),
    ("points as a quarter", Method::Backward, bounds::PLANES, |field, case, _| {
        each(field, |at, it| times(it, if case.scene.sensors[at].normal.is_none() { 0.25 } else { 1.0 }));
    }),
    ("planes that see behind", Method::Backward, bounds::OPPOSITE, |field, case, _| {
        let points: Vec<Option<Reading>> = field
            .readings
            .iter()
            .zip(&case.scene.sensors)
            .map(|(it, sensor)| sensor.normal.is_none().then_some(*it))
            .collect();
        let mut last = None;
        for ((it, sensor), point) in field.readings.iter_mut().zip(&case.scene.sensors).zip(points) {
            last = point.or(last);
            if let (Some(normal), Some(point)) = (sensor.normal, last) {
                it.value_w_m2 = point.flux_w_m2.dot(normal.as_dvec3()).abs();
            }
        }
    }),
    ("more than the light has", Method::Trace, bounds::BRIGHTEST, |field, _, _| each(field, |_, it| times(it, 1.15))),
    ("a silent zero", Method::Backward, statuses::STATUSES, |field, _, _| each(field, |_, it| it.status = Status::Ok)),
    ("light through walls", Method::Backward, statuses::APART, |field, _, _| {
        let mean = field.readings.iter().map(|it| it.value_w_m2).sum::<f64>() / field.readings.len().max(1) as f64;
        each(field, |_, it| it.value_w_m2 += 0.01 * mean);
    }),
    ("dark without lights", Method::Backward, statuses::NO_LIGHT, |field, _, _| {
        each(field, |_, it| it.status = Status::Dark)
    }),
    ("bodies without their flux", Method::Backward, bodies::ALIKE, |field, case, _| {
        let point = matches!(case.scene.lights[0], lightvein::scene::Light::Point { .. });
        each(field, |_, it| times(it, if point { 1.0 } else { 0.9 }));
    }),
    ("faces that shine on both sides", Method::Backward, bodies::FACES, |field, case, _| {
        let by_faces = case.scene.lights.is_empty();
        each(field, |_, it| times(it, if by_faces { 0.5 } else { 1.0 }));
    }),
    ("glass as air", Method::Trace, bodies::GLAZING, |field, case, _| {
        let pane = f64::from(case.scene.materials[1].transmittance);
        each(field, |at, it| times(it, if pane > 0.0 && at < 2 { 1.0 / pane } else { 1.0 }));
    }),
    ("a fire by the wall", Method::Backward, bodies::BY_WALLS, |field, case, _| {
        let at_wall = case.model.shining[0].position_m.min_element() < 0.02;
        each(field, |_, it| times(it, if at_wall { 1e6 } else { 1.0 }));
    }),
    ("half the direct light", Method::Trace, reflectance::BLACK, |field, _, _| each(field, |_, it| times(it, 0.5))),
    ("reflectance is not asked", Method::Backward, reflectance::MONOTONE, |_, _, _| {}),
    ("white is dark", Method::Trace, reflectance::MONOTONE, |field, case, _| {
        let white = case.scene.materials[0].reflectance > 0.9;
        each(field, |_, it| times(it, if white { 0.05 } else { 1.0 }));
    }),
    ("white without a word", Method::Trace, reflectance::WHITE, |_, _, _| {}),
    ("threads in the sum", Method::Backward, determinism::THREADS, |field, _, _| {
        let threads = rayon::current_num_threads() as f64;
        each(field, |_, it| times(it, 1.0 + 1e-15 * threads));
    }),
    ("the number of the probe", Method::Backward, determinism::ORDER, |field, _, _| {
        each(field, |at, it| times(it, 1.0 + 0.1 * at as f64));
    }),
    ("a seed that biases", Method::Backward, determinism::SEEDS, |field, _, settings| {
        each(field, |_, it| times(it, if settings.seed == 2 { 1.2 } else { 1.0 }));
    }),
    ("5% of the light lost", Method::Trace, closed_forms::FURNACE, |field, _, _| each(field, |_, it| times(it, 0.95))),
    ("a wider port", Method::Trace, closed_forms::SPHERES, |field, _, _| {
        let half = field.readings.len() / 2;
        each(field, |at, it| times(it, if at < half { 1.0 } else { 1.15 }));
    }),
    ("a tube that falls too fast", Method::Trace, tube::GREY_TUBE, |field, case, _| {
        each(field, |at, it| times(it, (-0.05 * f64::from(case.scene.sensors[at].position_m.x)).exp()));
    }),
    ("a door half as wide", Method::Trace, truth::TRUTH, |field, _, _| {
        each(field, |at, it| times(it, if at < 4 { 1.0 } else { 0.75 }));
    }),
    ("sure of itself", Method::Trace, truth::OWN_ERROR, |field, _, _| each(field, |_, it| it.value_w_m2 *= 1.4)),
    ("lost and silent", Method::Trace, tube::CANDID, |field, case, _| {
        each(field, |at, it| times(it, (-0.5 * f64::from(case.scene.sensors[at].position_m.x)).exp()));
    }),
    ("a tube that falls too slowly", Method::Trace, tube::BRIGHT_TUBE, |field, case, _| {
        each(field, |at, it| times(it, (0.03 * f64::from(case.scene.sensors[at].position_m.x)).exp()));
    }),
];

/// The first subject of a method.
fn sound_one(method: Method) -> Subject {
    if method == Method::Trace {
        return control();
    }
    subjects().into_iter().find(|subject| subject.method == method).expect("the method has a rung")
}

#[test]
fn every_mutant_is_caught() {
    let mut missed = Vec::new();
    for &(what, method, law, spoil) in MUTANTS {
        let Subject { ask, label, .. } = sound_one(method);
        let spoilt = move |case: &Case, settings: &Settings, progress: &dyn Progress, cancel: &Cancel| {
            let mut field = ask(case, settings, progress, cancel)?;
            spoil(&mut field, case, settings);
            Ok(field)
        };
        let mutant = Subject { method, label, ask: Box::new(spoilt) };
        if breaches(&law, &mutant).is_empty() {
            missed.push(format!("\"{what}\" obeys \"{}\"", law.name));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn a_subject_that_cannot_be_stopped_is_caught() {
    let Subject { ask, .. } = sound_one(Method::Backward);
    let deaf = move |case: &Case, settings: &Settings, _: &dyn Progress, _: &Cancel| {
        ask(case, settings, &Quiet, &Cancel::new())
    };
    let mutant = Subject { method: Method::Backward, label: "deaf".to_owned(), ask: Box::new(deaf) };
    assert!(!breaches(&determinism::CANCELLED, &mutant).is_empty());
}
