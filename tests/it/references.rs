//! The path tracer against Mitsuba 3 on every scene that has a reference.

use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Settings, Sources, Status};
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::trace::{Traced, trace};
use std::path::{Path, PathBuf};

/// Samples a scene, shared by its sensors, and the most for each: few sensors then lean on single samples, and all scenes
/// together take some seconds. The seed was set once, at 1.
const SAMPLES: usize = 600_000;
const MOST_SAMPLES: usize = 16_384;

/// The same for the test set, whose sensors are darker, so that few samples of theirs are more skewed.
const SAMPLES_IN_TEST_SET: usize = 800_000;
const MOST_SAMPLES_IN_TEST_SET: usize = 32_768;

/// Most samples for each sensor of a real scene, whose sensors are less dark and whose rays cost more.
const MOST_SAMPLES_IN_REAL_SCENES: usize = 4096;

/// Samples that the references were made with, at least.
const REFERENCE_SAMPLES: f64 = 65_536.0;

/// Sensors whose largest sample is above this share of the sum have no standard error worth the name.
const LARGEST_TRUSTED_SHARE: f64 = 0.05;

/// Above this share of the reading, samples are so few and so skewed that deviations are not normal either.
const LARGEST_TRUSTED_ERROR: f64 = 0.1;

/// The scene files in the folders under `root` that `wanted` holds for, sorted.
fn scene_files(root: &str, wanted: impl Fn(&Path) -> bool) -> Vec<PathBuf> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(root);
    let folders = std::fs::read_dir(root).expect("the folder of scenes").map(|entry| entry.expect("an entry").path());
    let folders = folders.filter(|folder| folder.is_dir() && wanted(folder));
    let files = folders.flat_map(|folder| std::fs::read_dir(folder).expect("a scene's folder"));
    let files = files.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> =
        files.filter(|file| file.extension().is_some_and(|extension| extension == "toml")).collect();
    files.sort();
    files
}

/// How many combined standard errors lie between the traced values and the references of a scene, sensor by sensor, and
/// how many sensors cannot be judged so.
fn deviations(scene: &Scene, traced: &Traced, samples: u32) -> (Vec<f64>, usize) {
    let mut deviations = Vec::new();
    let mut untrusted = 0;
    for (sensor, reading) in traced.field.readings.iter().enumerate() {
        let id = &scene.sensors[sensor].id;
        let Some(reference) = scene.reference[sensor] else { continue };
        let error = reading.error_w_m2.expect("a traced reading has a standard error");
        let uncertain = reference.stderr_w_m2 > LARGEST_TRUSTED_ERROR * reference.irradiance_w_m2;
        let noisy = uncertain || error > LARGEST_TRUSTED_ERROR * reading.value_w_m2 || reading.status == Status::Dark;
        if noisy || traced.top_share[sensor] > LARGEST_TRUSTED_SHARE {
            untrusted += 1;
            continue;
        }
        let deviation = (reading.value_w_m2 - reference.irradiance_w_m2)
            / error.hypot(reference.stderr_w_m2).max(f64::MIN_POSITIVE);
        println!(
            "{} {id}: {:.4e} against {:.4e}, {deviation:+.2}",
            scene.name, reading.value_w_m2, reference.irradiance_w_m2
        );
        deviations.push(deviation);

        // A sample's flux is no longer than its value, which bounds the standard error of each component.
        if scene.sensors[sensor].normal.is_none() && reference.flux_w_m2.length() > 0.0 {
            let off = (reading.flux_w_m2 - reference.flux_w_m2).abs().max_element();
            let ours = error.powi(2) + reading.value_w_m2.powi(2) / f64::from(samples);
            let theirs = reference.stderr_w_m2.powi(2) + reference.irradiance_w_m2.powi(2) / REFERENCE_SAMPLES;
            assert!(off <= 4.5 * (ours + theirs).sqrt(), "{} {id}: flux off by {off:.3e} W/m2", scene.name);
        }
    }
    (deviations, untrusted)
}

/// Traces the scenes and holds them to their references: at least `least` sensors within 3 standard errors, as far as chance
/// allows. Of independent normal deviations 0.27% lie beyond 3, so 1% (and at least one sensor) may, none beyond 4.5 (1
/// in 150,000); and together they show no bias and no wrong error estimate.
fn check(files: &[PathBuf], samples: usize, most_samples: usize, least: usize) {
    let (progress, cancel) = (Quiet, Cancel::new());
    let (mut all, mut untrusted) = (Vec::new(), 0);
    for file in files {
        let scene = Scene::load(file, &progress, &cancel).unwrap_or_else(|error| panic!("{error}"));
        if scene.reference.is_empty() {
            println!("{}: skipped, it names no reference", file.display());
            continue;
        }
        let (rays, sources) = (Rays::new(&scene), Sources::of(&scene));
        let samples = (samples / scene.sensors.len()).min(most_samples) as u32;
        let settings = Settings { samples, seed: 1, ..Settings::default() };
        let traced = trace(&scene, &rays, &sources, &settings, &progress, &cancel).expect("nobody cancels");
        let (deviations, leaning) = deviations(&scene, &traced, samples);
        all.extend(deviations);
        untrusted += leaning;
    }
    assert!(all.len() >= least, "only {} sensors could be judged, {untrusted} were too dark", all.len());

    let count = all.len() as f64;
    let beyond = |bound: f64| all.iter().filter(|deviation| deviation.abs() > bound).count();
    let bias = all.iter().sum::<f64>() / count.sqrt();
    let spread = all.iter().map(|deviation| deviation * deviation).sum::<f64>() / count;
    println!("{count} sensors, {} beyond 3, bias {bias:+.2}, mean square {spread:.2}", beyond(3.0));
    assert_eq!(beyond(4.5), 0);
    assert!(beyond(3.0) <= (all.len() / 100).max(1), "{} of {count} sensors lie beyond 3 standard errors", beyond(3.0));
    assert!(bias.abs() < 3.5, "the deviations have a bias of {bias:.2} standard errors");
    assert!((0.6..1.5).contains(&spread), "the mean square deviation is {spread:.2} instead of 1");
}

#[test]
fn the_path_tracer_agrees_with_mitsuba() {
    check(&scene_files("scenes", |folder| !folder.ends_with("real")), SAMPLES, MOST_SAMPLES, 400);
}

#[test]
fn the_path_tracer_agrees_with_mitsuba_on_the_test_set() {
    check(&scene_files("scenes/held_out", |_| true), SAMPLES_IN_TEST_SET, MOST_SAMPLES_IN_TEST_SET, 80);
}

#[test]
fn the_path_tracer_agrees_with_mitsuba_on_real_scenes() {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if !data.is_dir() {
        println!("skipped: ../shared/data is absent");
        return;
    }
    check(&scene_files("scenes", |folder| folder.ends_with("real")), SAMPLES, MOST_SAMPLES_IN_REAL_SCENES, 80);
}
