//! Two real cities under a year's weather against Radiance. Meshes and weather lie beside the project; where they are absent
//! only the tables are looked at.

use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::points;
use lightvein::job::{Cancel, Quiet};
use lightvein::light::Status;
use lightvein::rays::Rays;
use lightvein::scene::{Scene, Site};
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::weather::Weather;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

const CITIES: [&str; 2] = ["ingolstadt", "den_haag"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The rows of a table beside the scenes, by id.
fn table(name: &str) -> HashMap<String, Vec<f64>> {
    let text = std::fs::read_to_string(root().join("scenes/real").join(name)).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let numbers = |row: &str| {
        let (id, numbers) = row.split_once(',').unwrap();
        (id.to_owned(), numbers.split(',').map(|number| number.parse().unwrap()).collect())
    };
    rows.map(numbers).collect()
}

/// Four hundred sensors, each with a row in both of Radiance's tables, which do not contradict each other.
#[test]
fn tables_of_cities_are_whole() {
    for city in CITIES {
        let sensors = table(&format!("{city}_sensors.csv"));
        let (exposure, svf) = (table(&format!("{city}_exposure_chicago.csv")), table(&format!("{city}_svf.csv")));
        assert_eq!((sensors.len(), exposure.len(), svf.len()), (400, 400, 400), "{city}");
        for (id, at) in &sensors {
            let normal = glam::DVec3::from_slice(&at[3..6]);
            assert!((normal.length() - 1.0).abs() < 1e-5, "{city}: {id}");
            let [beam, sky, reflected, total] = exposure[id][..] else { panic!("{city}: {id}") };
            assert!((beam + sky - total).abs() < 1e-4 * total + 1e-3 && reflected == 0.0, "{city}: {id}");
            // A plane sees no more of the sky than its tilt lets it; Chicago's sky brings 660 kWh/m2 on open ground.
            assert!(svf[id][0] <= 0.5 * (1.0 + normal.z) + 0.005, "{city}: {id}");
            assert!(sky < 1.35 * 660.0 * svf[id][0] + 5.0, "{city}: {id}: {sky} {}", svf[id][0]);
        }
    }
}

/// Rays against Radiance: exact suns, 2,320 patches of sky and 20,000 rays a sensor.
#[test]
fn rays_agree_with_radiance_in_cities() {
    let data = root().join("../shared/data");
    let weather: PathBuf = data.join("weather/chicago.epw");
    if !weather.exists() || !data.join("city").is_dir() {
        println!("skipped: {} is not here", data.display());
        return;
    }
    let weather = Weather::load(&weather, &Quiet, &Cancel::new()).unwrap();
    let outdoors = Outdoors::of(&Site::default(), Some(weather)).unwrap();
    let map = ExposureMap::build(&outdoors.steps().unwrap(), &MapSettings::default(), &Quiet, &Cancel::new()).unwrap();
    for city in CITIES {
        let path = root().join(format!("scenes/real/{city}.toml"));
        let scene = Scene::load(&path, &Quiet, &Cancel::new()).unwrap();
        let (exposure, svf) = (table(&format!("{city}_exposure_chicago.csv")), table(&format!("{city}_svf.csv")));
        let rays = Rays::new(&scene);
        let at = points(&scene.sensors);
        let found = cast(&rays, &at, &map, 0.0, Casting::default(), &Quiet, &Cancel::new()).unwrap();
        let count = found.len() as f64;
        let (mut mean, mut square, mut svf_off) = (0.0, 0.0, 0.0);
        for (sensor, found) in scene.sensors.iter().zip(&found) {
            let total = exposure[&sensor.id][3];
            let off = found.total_kwh_m2() - total;
            let svf = found.svf - svf[&sensor.id][0];
            assert_eq!(found.status, Status::Ok, "{city}: {}", sensor.id);
            assert!(off.abs() < 0.03 * total + 5.0 && svf.abs() < 0.006, "{city}: {}: {off} {svf}", sensor.id);
            mean += total / count;
            square += off * off / count;
            svf_off += svf.abs() / count;
        }
        let rmse = square.sqrt() / mean;
        println!(
            "{city}: RMSE {:.2}% of the mean of {mean:.0} kWh/m2, svf off by {svf_off:.4} in the mean",
            100.0 * rmse
        );
        assert!(rmse <= 0.012 && svf_off <= 0.002, "{city}: {rmse} {svf_off}");
    }
}
