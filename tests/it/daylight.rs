//! Exposure by rays against closed forms: open ground, walls, wells, canyons, glazing, sensors in the ground.

use super::program::{run, text};
use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::{Exposure, points};
use lightvein::job::{Cancel, Quiet};
use lightvein::light::Status;
use lightvein::rays::Rays;
use lightvein::scene::{Scene, Site};
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::steps::{Period, Steps};
use lightvein::sky::weather::Weather;
use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

/// A quad by its corners.
type Quad = [[f64; 3]; 4];

/// A scene of quads, each of its own material, sensors as rows of a table.
fn scene(quads: &[(&str, Quad)], more: &str, sensors: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let mut obj = String::new();
    for (number, (material, corners)) in quads.iter().enumerate() {
        corners.iter().for_each(|[x, y, z]| writeln!(obj, "v {x} {y} {z}").unwrap());
        let first = 4 * number + 1;
        writeln!(obj, "usemtl {material}\nf {} {} {} {}", first, first + 1, first + 2, first + 3).unwrap();
    }
    let toml = format!("[geometry]\nmeshes = [\"a.obj\"]\n[sensors]\nfile = \"a.csv\"\n{more}");
    for (name, text) in [("a.obj", &obj), ("a.toml", &toml), ("a.csv", &format!("id,x,y,z,nx,ny,nz\n{sensors}"))] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    Scene::load(&folder.path().join("a.toml"), &Quiet, &Cancel::new()).unwrap()
}

/// A clear year at 42 degrees north.
fn steps() -> Steps {
    let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
    let outdoors = Outdoors::of(&site, None).unwrap();
    Outdoors { period: Period { step_min: 120.0, ..Period::YEAR }, ..outdoors }.steps().unwrap()
}

fn map(model: SkyModel) -> ExposureMap {
    let settings = MapSettings { size: [256, 256], model, ..MapSettings::default() };
    ExposureMap::build(&steps(), &settings, &Quiet, &Cancel::new()).unwrap()
}

fn exposures(scene: &Scene, map: &ExposureMap, north_rad: f64) -> Vec<Exposure> {
    let casting = Casting { sun_rays: None, sky_rays: 16_384, seed: 1 };
    cast(&Rays::new(scene), &points(&scene.sensors), map, north_rad, casting, &Quiet, &Cancel::new()).unwrap()
}

#[track_caller]
fn near(value: f64, expected: f64, bound: f64, what: &str) {
    assert!((value - expected).abs() <= bound, "{what}: {value} against {expected}");
}

/// Four walls around the origin, `half` metres from it, up to `high`.
fn well(half: f64, high: f64) -> Vec<(&'static str, Quad)> {
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    (0..4)
        .map(|side| {
            let ([ax, ay], [bx, by]) = (corners[side], corners[(side + 1) % 4]);
            // Wound to face the middle.
            ("wall", [[bx, by, 0.0], [ax, ay, 0.0], [ax, ay, high], [bx, by, high]])
        })
        .collect()
}

#[test]
fn open_ground_sees_the_whole_sky_and_a_wall_half_of_it() {
    let far = scene(
        &[("far", [[1e3, 1e3, 0.0], [1e3 + 1.0, 1e3, 0.0], [1e3 + 1.0, 1e3 + 1.0, 0.0], [1e3, 1e3 + 1.0, 0.0]])],
        "",
        "up,0,0,1,0,0,1\nsouth,0,0,1,0,-1,0\nall,0,0,1,,,\ndown,0,0,1,0,0,-1\n",
    );
    let map = map(SkyModel::Isotropic);
    let found = exposures(&far, &map, 0.0);
    let totals = map.totals;
    near(found[0].svf, 1.0, 1e-9, "open ground");
    near(found[1].svf, 0.5, 0.002, "wall");
    near(found[2].svf, 1.0, 1e-9, "all around");
    assert_eq!((found[3].svf, found[3].status), (0.0, Status::Dark));
    near(found[0].total_kwh_m2(), totals.ghi_kwh_m2, 0.002 * totals.ghi_kwh_m2, "global");
    near(found[1].sky_kwh_m2, totals.dhi_kwh_m2 / 2.0, 0.005 * totals.dhi_kwh_m2, "half the sky");
    near(found[2].beam_kwh_m2, totals.dni_kwh_m2, 1e-6 * totals.dni_kwh_m2, "the beam from all around");
    // An isotropic sky from all around is twice its horizontal irradiance.
    near(found[2].sky_kwh_m2, 2.0 * totals.dhi_kwh_m2, 0.003 * totals.dhi_kwh_m2, "the sky from all around");
    let up_h: f64 = map.suns.iter().map(|sun| sun.hours).sum();
    near(found[0].sun_h, up_h, 1e-9, "hours of sun");
    let in_front_h: f64 = map.suns.iter().filter(|sun| sun.sun.towards().y < 0.0).map(|sun| sun.hours).sum();
    near(found[1].sun_h, in_front_h, 1e-9, "hours of sun on a wall that faces south");
    assert!(in_front_h < up_h);
}

/// The analytic sky view factors of a well 10 x 10 x 10 m.
#[test]
fn a_well_sees_what_its_closed_form_says() {
    let sensors = "centre,0,0,0,0,0,1\nside,4,0,0,0,0,1\ncorner,4.9,4.9,0,0,0,1\nhalf,0,0,5,0,0,1\n";
    let found = exposures(&scene(&well(5.0, 10.0), "", sensors), &map(SkyModel::Isotropic), 0.0);
    for (exposure, expected) in found.iter().zip([0.239_49, 0.199_60, 0.141_41, 0.554_13]) {
        near(exposure.svf, expected, 0.005, "well");
    }
}

/// Between two endless walls h high and w apart, the middle of the street sees `cos(atan(2 h / w))` of the sky, and the foot
/// of a wall `(1 - sin(atan(h / w))) / 2`.
#[test]
fn a_canyon_sees_what_its_closed_form_says() {
    let (wide, high, long) = (8.0, 12.0, 4000.0);
    let wall = |x: f64| [[x, -long, 0.0], [x, long, 0.0], [x, long, high], [x, -long, high]];
    let canyon = [("wall", wall(-wide / 2.0)), ("wall", wall(wide / 2.0))];
    let found = exposures(
        &scene(&canyon, "", &format!("middle,0,0,0,0,0,1\nfoot,{},0,0.001,1,0,0\n", -wide / 2.0 + 0.001)),
        &map(SkyModel::Isotropic),
        0.0,
    );
    near(found[0].svf, (2.0 * high / wide).atan().cos(), 0.005, "street");
    near(found[1].svf, (1.0 - (high / wide).atan().sin()) / 2.0, 0.005, "foot of the wall");
}

#[test]
fn a_roof_of_glass_weakens_sun_and_sky_alike() {
    let roof = |material| [(material, [[-1e4, -1e4, 3.0], [1e4, -1e4, 3.0], [1e4, 1e4, 3.0], [-1e4, 1e4, 3.0]])];
    let more = "[[materials]]\nname = \"glass\"\ntransmittance = 0.5\n";
    let map = map(SkyModel::Perez);
    let sensors = "up,0,0,0,0,0,1\n";
    let glass = exposures(&scene(&roof("glass"), more, sensors), &map, 0.0)[0];
    near(glass.total_kwh_m2(), map.totals.ghi_kwh_m2 / 2.0, 0.01 * map.totals.ghi_kwh_m2, "half through glass");
    let opaque = exposures(&scene(&roof("slate"), "", sensors), &map, 0.0)[0];
    // Only the slit between the roof's edge, 10 km away, and the horizon is left.
    assert!(opaque.total_kwh_m2() < 1e-3 * map.totals.ghi_kwh_m2, "{opaque:?}");
}

#[test]
fn turning_the_scene_and_its_north_changes_nothing() {
    let map = map(SkyModel::Perez);
    let straight = exposures(&scene(&well(5.0, 4.0), "", "a,3,1,0,0,0,1\nb,0,4.9,2,0,-1,0\n"), &map, 0.0);
    // A quarter turn clockwise: +Y becomes +X.
    let turned =
        exposures(&scene(&well(5.0, 4.0), "", "a,1,-3,0,0,0,1\nb,4.9,0,2,-1,0,0\n"), &map, 90_f64.to_radians());
    for (a, b) in straight.iter().zip(&turned) {
        near(a.beam_kwh_m2, b.beam_kwh_m2, 0.01 * a.beam_kwh_m2, "beam");
        near(a.sky_kwh_m2, b.sky_kwh_m2, 0.01 * a.sky_kwh_m2, "sky");
    }
}

#[test]
fn a_sensor_in_the_ground_is_told_from_one_in_the_dark() {
    let ground = [("ground", [[-500.0, -500.0, 0.0], [500.0, -500.0, 0.0], [500.0, 500.0, 0.0], [-500.0, 500.0, 0.0]])];
    let cube = [([0.0, 0.0], [1.0, 0.0]), ([1.0, 0.0], [1.0, 1.0]), ([1.0, 1.0], [0.0, 1.0]), ([0.0, 1.0], [0.0, 0.0])];
    let mut solid: Vec<(&str, Quad)> = cube
        .iter()
        .map(|([ax, ay], [bx, by])| ("cube", [[*ax, *ay, 0.0], [*bx, *by, 0.0], [*bx, *by, 1.0], [*ax, *ay, 1.0]]))
        .collect();
    solid.push(("cube", [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]]));
    solid.push(("cube", [[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]));
    let map = map(SkyModel::Isotropic);
    let found = exposures(&scene(&solid, "", "in,0.5,0.5,0.5,0,0,1\nunder,0.5,0.5,-0.1,0,0,-1\n"), &map, 0.0);
    assert_eq!((found[0].status, found[1].status), (Status::InSolid, Status::Dark));
    let found = exposures(&scene(&ground, "", "over,0,0,0,0,0,1\n"), &map, 0.0);
    assert_eq!(found[0].status, Status::Ok);
    near(found[0].svf, 1.0, 1e-3, "on the ground");
}

/// RMS of differences over the mean of the truth.
fn off(found: &[f64], truth: &[f64]) -> f64 {
    let square = found.iter().zip(truth).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / truth.len() as f64;
    square.sqrt() / (truth.iter().sum::<f64>() / truth.len() as f64)
}

fn outdoor(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/outdoor/{name}/{name}.toml"));
    Scene::load(&path, &Quiet, &Cancel::new()).unwrap()
}

/// Some suns and some of the sky against all suns and much of the sky, and against what they say of their own error.
#[test]
fn some_suns_stand_for_all() {
    let map = map(SkyModel::Perez);
    for (name, bound) in [("courtyard", 0.012), ("blocks", 0.012), ("arcades", 0.02)] {
        let scene = outdoor(name);
        let rays = Rays::new(&scene);
        let total = |casting: Casting| -> (Vec<f64>, Vec<f64>) {
            let found = cast(&rays, &points(&scene.sensors), &map, 0.0, casting, &Quiet, &Cancel::new()).unwrap();
            found.iter().map(|exposure| (exposure.total_kwh_m2(), exposure.error_kwh_m2)).unzip()
        };
        let (truth, _) = total(Casting::default());
        let (some, errors) = total(Casting { sun_rays: Some(256), sky_rays: 256, seed: 3 });
        let error = off(&some, &truth);
        println!("{name}: {:.3}% of the mean", 100.0 * error);
        assert!(error < bound, "{name}: {error}");
        let within = some
            .iter()
            .zip(&truth)
            .zip(&errors)
            .filter(|((some, truth), error)| (*some - *truth).abs() <= 3.0 * *error + 1.0);
        assert!(within.count() * 100 >= 97 * truth.len(), "{name}: the error that it says is too small");
    }
}

/// Beam and sky of a year in Chicago against Radiance: exact suns, patches of the sky (MF4), 20,000 rays or more.
#[test]
fn rays_agree_with_radiance() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/weather/chicago.epw");
    if !path.exists() {
        println!("skipped: {} is not here", path.display());
        return;
    }
    let weather = Weather::load(&path, &Quiet, &Cancel::new()).unwrap();
    let outdoors = Outdoors::of(&Site::default(), Some(weather)).unwrap();
    let map = ExposureMap::build(&outdoors.steps().unwrap(), &MapSettings::default(), &Quiet, &Cancel::new()).unwrap();
    for (name, bound) in [("courtyard", 0.01), ("blocks", 0.012), ("arcades", 0.012)] {
        let scene = outdoor(name);
        let table = std::fs::read_to_string(
            Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/outdoor/{name}/exposure_chicago.csv")),
        );
        let reference: HashMap<String, f64> = table
            .unwrap()
            .lines()
            .filter(|line| !line.starts_with('#') && !line.starts_with("id,"))
            .map(|line| {
                let fields: Vec<&str> = line.split(',').collect();
                (fields[0].to_owned(), fields[1].parse::<f64>().unwrap() + fields[2].parse::<f64>().unwrap())
            })
            .collect();
        let casting = Casting::default();
        let found =
            cast(&Rays::new(&scene), &points(&scene.sensors), &map, 0.0, casting, &Quiet, &Cancel::new()).unwrap();
        let found: Vec<f64> = found.iter().map(Exposure::total_kwh_m2).collect();
        let truth: Vec<f64> = scene.sensors.iter().map(|sensor| reference[&sensor.id]).collect();
        let error = off(&found, &truth);
        println!("{name}: {:.3}% of the mean", 100.0 * error);
        assert!(error <= bound, "{name}: {error}");
    }
}

#[test]
fn expose_tells_each_sensor_and_writes_its_table() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = "scenes/outdoor/courtyard/courtyard.toml";
    let quick = ["--sun-rays", "64", "--sky-rays", "64", "--step", "120"];
    let arguments = [&["expose", scene, "--json", "-o", out.to_str().unwrap()][..], &quick].concat();
    let output = run(&arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let sensors = told["sensors"].as_array().unwrap();
    assert_eq!(sensors.len(), 38);
    for sensor in sensors {
        for key in ["id", "beam", "sky", "reflected", "total", "svf", "status"] {
            assert!(!sensor[key].is_null(), "{key}");
        }
    }
    let table = std::fs::read_to_string(out.join("exposure.csv")).unwrap();
    assert_eq!(table.lines().count(), 39);
    assert!(table.starts_with("id,x_m,y_m,z_m,nx,ny,nz,beam_kwh_m2,"));

    // Not without a place on earth.
    let output = run(&["expose", "scenes/gallery/gallery.toml"]);
    let stderr = text(&output.stderr);
    assert!(output.status.code() == Some(1) && stderr.contains("latitude_deg is missing"), "{stderr}");
}
