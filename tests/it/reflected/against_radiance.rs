//! Against Radiance, over a year of weather.

use super::super::modelled::scene as scene_of;
use super::{CASTING, daylit, modelled, rms_factor};
use lightvein::daylight::cast::cast;
use lightvein::daylight::reflect;
use lightvein::daylight::reflect::heuristics::by_heuristic;
use lightvein::daylight::reflect::skylight::Skylight;
use lightvein::daylight::{Exposure, points};
use lightvein::flow::network::Quality;
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::{Method, Scene, Site};
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::weather::Weather;
use std::collections::HashMap;
use std::path::Path;

/// A year in Chicago against Radiance: all light, 5 bounces there and any number here; deep indoors 14 there.
#[test]
fn daylight_against_radiance() {
    let Some(map) = chicago() else { return };
    for (name, voxel_m, table, bound) in [
        ("courtyard", 0.5, "exposure_chicago", 1.03),
        ("arcades", 0.5, "exposure_chicago", 1.07),
        ("blocks", 1.0, "exposure_chicago", 1.03),
        ("office", 0.2, "exposure_chicago", 1.15),
        ("office", 0.2, "exposure_chicago_14_bounces", 1.08),
    ] {
        let scene = scene_of(&format!("outdoor/{name}"));
        let path = format!("scenes/outdoor/{name}/{table}.csv");
        let reference = reference(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path));
        let (found, reflected) = daylit(&scene, voxel_m, &map, &Quality::MEDIUM);
        let of_all = total_rms(&scene, &found, &reference);
        // The reference's own noise is some 4 kWh/m2.
        let sure = || {
            let all = scene.sensors.iter().zip(found.iter().zip(&reflected));
            let all = all.map(|(sensor, (found, own))| (found.reflected_kwh_m2, reference[&sensor.id][0], own));
            all.filter(|(_, reflected, _)| *reflected > 40.0)
        };
        let of_reflected = rms_factor(sure().map(|(found, reflected, _)| (found, reflected)));
        let within = |times: f64| {
            let within = sure().filter(|(found, reflected, own)| (found - reflected).abs() <= times * own.error_kwh_m2);
            100 * within.count() / sure().count()
        };
        println!(
            "{name} ({table}): rms factor {of_all:.4}, of what is reflected {of_reflected:.4}; \
             own error holds {}% within once, {}% within twice",
            within(1.0),
            within(2.0)
        );
        assert!(of_all <= bound && within(2.0) >= 80, "{name}: {of_all}");
    }
}

/// The previews in the office, whose figures the docs have.
#[test]
fn previews_of_the_office_against_radiance() {
    let Some(map) = chicago() else { return };
    let scene = scene_of("outdoor/office");
    let path = "scenes/outdoor/office/exposure_chicago_14_bounces.csv";
    let reference = reference(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path));
    for (method, bound) in [(Method::Diffusion, 2.0), (Method::Backward, 10.0), (Method::Forward, f64::INFINITY)] {
        let model = modelled(&scene, 0.2);
        let (points, light) = (points(&scene.sensors), Skylight::new(&map, 0.0));
        let mut found = cast(&model.rays, &points, &map, 0.0, CASTING, &Quiet, &Cancel::new()).unwrap();
        let asked = (&points[..], &found[..]);
        let reflected = by_heuristic(method, model, asked, &light, CASTING, &Quiet, &Cancel::new()).unwrap();
        reflect::add(&mut found, &reflected);
        let of_all = total_rms(&scene, &found, &reference);
        println!("office by {method}: rms factor {of_all:.3}");
        assert!(of_all <= bound, "{method}: {of_all}");
    }
}

/// The year of Chicago's weather; `None`, and said, where the file is not here.
fn chicago() -> Option<ExposureMap> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/weather/chicago.epw");
    if !path.exists() {
        println!("skipped: {} is not here", path.display());
        return None;
    }
    let weather = Weather::load(&path, &Quiet, &Cancel::new()).unwrap();
    let outdoors = Outdoors::of(&Site::default(), Some(weather)).unwrap();
    Some(ExposureMap::build(&outdoors.steps().unwrap(), &MapSettings::default(), &Quiet, &Cancel::new()).unwrap())
}

/// Of all light, over sensors that get more than 1 kWh/m2; what is lost counts as a hundredth of a kWh/m2.
fn total_rms(scene: &Scene, found: &[Exposure], reference: &HashMap<String, [f64; 2]>) -> f64 {
    let all = scene.sensors.iter().zip(found).map(|(sensor, found)| (found.total_kwh_m2(), reference[&sensor.id][1]));
    rms_factor(all.filter(|(_, total)| *total > 1.0).map(|(found, total)| (found.max(0.01), total)))
}

/// What a table says is reflected, and all, by sensor.
fn reference(path: &Path) -> HashMap<String, [f64; 2]> {
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#') && !line.starts_with("id,"));
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        (fields[0].to_owned(), [3, 4].map(|field: usize| fields[field].parse().unwrap()))
    };
    rows.map(row).collect()
}
