//! What facades and roofs receive in a clear year, by latitude and by turbidity: the tables of `docs/daylight-trends.md`.
//!
//!     cargo run --release --example daylight_trends
//!
//! By rays, at the sensors of two scenes: a house alone (the outer faces of `courtyard`) and a piece of town (`blocks`),
//! whose sensors are gathered by where they face. The same figures on every run; about a minute.

use glam::Vec3;
use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::points;
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::{Scene, Site};
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use std::error::Error;
use std::path::Path;

const LATITUDES_DEG: [f64; 4] = [0.0, 30.0, 45.0, 60.0];
const TURBIDITIES: [f64; 4] = [2.0, 3.0, 5.0, 8.0];

/// Turbidity of the table by latitude.
const TURBIDITY: f64 = 3.0;

/// Latitudes of the tables by turbidity: those of the paper's figure 8.
const BY_TURBIDITY_DEG: [f64; 2] = [30.0, 60.0];

/// Enough for a tenth of a percent of a group's mean.
const SKY_RAYS: u32 = 1024;

/// Scene, and how the names of the sensors that count begin.
const SCENES: [(&str, &str, &[&str]); 2] = [
    ("a house alone", "scenes/outdoor/courtyard/courtyard.toml", &["facade", "roof"]),
    ("a piece of town", "scenes/outdoor/blocks/blocks.toml", &["facade", "roof", "ground"]),
];

/// Where a face looks.
const FACES: [&str; 6] = ["north", "east", "south", "west", "roof", "ground"];

fn main() -> Result<(), Box<dyn Error>> {
    for (title, path, prefixes) in SCENES {
        let scene = Scene::load(Path::new(path), &Quiet, &Cancel::new())?;
        let groups = groups(&scene, prefixes);
        let rays = Rays::new(&scene);
        println!("{title}, by latitude at turbidity {TURBIDITY}:\n");
        header("latitude");
        for latitude_deg in LATITUDES_DEG {
            row(&format!("{latitude_deg}\u{b0} N"), means(&scene, &rays, &groups, latitude_deg, TURBIDITY)?);
        }
        for latitude_deg in BY_TURBIDITY_DEG {
            println!("\n{title}, by turbidity at {latitude_deg}\u{b0} N:\n");
            header("turbidity");
            for turbidity in TURBIDITIES {
                row(&format!("{turbidity}"), means(&scene, &rays, &groups, latitude_deg, turbidity)?);
            }
        }
        println!();
    }
    Ok(())
}

/// The sensors that face each way.
fn groups(scene: &Scene, prefixes: &[&str]) -> [Vec<usize>; 6] {
    let mut groups = [const { Vec::new() }; 6];
    for (number, sensor) in scene.sensors.iter().enumerate() {
        if prefixes.iter().any(|prefix| sensor.id.starts_with(prefix)) {
            groups[face(&sensor.id, sensor.normal.unwrap_or(Vec3::Z))].push(number);
        }
    }
    groups
}

/// The number in [`FACES`] of a face by its normal; walls by the nearest quarter.
fn face(id: &str, normal: Vec3) -> usize {
    match normal {
        _ if id.starts_with("ground") => 5,
        normal if normal.z > 0.5 => 4,
        normal if normal.y.abs() >= normal.x.abs() => {
            if normal.y > 0.0 {
                0
            } else {
                2
            }
        }
        normal => {
            if normal.x > 0.0 {
                1
            } else {
                3
            }
        }
    }
}

/// Mean exposure of each group, kWh/m2 over a clear year: all of it, and the sky's part.
fn means(
    scene: &Scene,
    rays: &Rays,
    groups: &[Vec<usize>; 6],
    latitude_deg: f64,
    turbidity: f64,
) -> Result<[Option<[f64; 2]>; 6], Box<dyn Error>> {
    let site = Site {
        latitude_deg: Some(latitude_deg),
        longitude_deg: Some(0.0),
        turbidity: Some(turbidity),
        ..Site::default()
    };
    let outdoors = Outdoors::of(&site, None)?;
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&outdoors.steps()?, &settings, &Quiet, &Cancel::new())?;
    let casting = Casting { sky_rays: SKY_RAYS, ..Casting::default() };
    let found = cast(rays, &points(&scene.sensors), &map, outdoors.north_rad, casting, &Quiet, &Cancel::new())?;
    Ok([0, 1, 2, 3, 4, 5].map(|face| {
        let group = &groups[face];
        let mean = |part: &dyn Fn(usize) -> f64| group.iter().map(|&at| part(at)).sum::<f64>() / group.len() as f64;
        (!group.is_empty()).then(|| [mean(&|at| found[at].total_kwh_m2()), mean(&|at| found[at].sky_kwh_m2)])
    }))
}

fn header(first: &str) {
    println!("| {first} | {} |\n|---|{}", FACES.join(" | "), "---:|".repeat(FACES.len()));
}

fn row(title: &str, means: [Option<[f64; 2]>; 6]) {
    let cells = means.map(|mean| mean.map_or(String::new(), |[total, sky]| format!("{total:.0} ({sky:.0})")));
    println!("| {title} | {} |", cells.join(" | "));
}
