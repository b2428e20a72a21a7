//! Exposure of every pixel of a view: frames a second, and how far from rays?
//!
//!     cargo bench --bench view [-- WEATHER]
//!
//! A far and a close view of 800 x 600 pixels of the cities beside the project, or of the outdoor scenes where these are not
//! there. For 8 x (8 + 8) and 16 x (16 + 16) directions and samples, and each combination of the scales: medians of five
//! frames; sky view factor (mean absolute error) and exposure (RMSE as a share of the mean) against 1,024 suns and 4,096
//! directions by rays in 400 pixels. The buffers and what is made beforehand are timed apart.

use lightvein::daylight::camera::{Buffers, Camera, DEFAULT_FOV_RAD};
use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::scales::pixels::taps::Taps;
use lightvein::daylight::scales::pixels::{Combination, Look, Part, PixelSums, Surfaces, TURNS, see};
use lightvein::daylight::scales::sums::SkySums;
use lightvein::daylight::scales::zenith::Zenith;
use lightvein::daylight::{Exposure, Point};
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::weather::Weather;
use std::path::Path;
use std::time::Instant;

const RUNS: usize = 5;
const SIZE: [usize; 2] = [800, 600];
const CHECKED: usize = 400;

fn main() {
    let weather = std::env::args().skip(1).find(|arg| !arg.starts_with("--"));
    let weather = weather.map(|path| Weather::load(Path::new(&path), &Quiet, &Cancel::new()).unwrap());
    println!("{} threads, {RUNS} runs, {} x {} pixels", rayon::current_num_threads(), SIZE[0], SIZE[1]);
    for name in ["real/ingolstadt", "real/den_haag", "outdoor/blocks/blocks", "outdoor/arcades/arcades"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
        match Scene::load(&path, &Quiet, &Cancel::new()) {
            Ok(scene) => of_scene(name, &scene, weather.clone()),
            Err(error) => println!("\nskipped: {error}"),
        }
    }
}

fn of_scene(name: &str, scene: &Scene, weather: Option<Weather>) {
    let quiet = (&Quiet, &Cancel::new());
    let outdoors = Outdoors::of(&scene.site.clone().unwrap_or_default(), weather).unwrap();
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&outdoors.steps().unwrap(), &settings, quiet.0, quiet.1).unwrap();
    let (tree_s, rays) = timed(|| Rays::new(scene));
    let (low_m, high_m) = scene.mesh.bounds_m().unwrap();
    let far = Camera::around(low_m, high_m, DEFAULT_FOV_RAD, SIZE).unwrap();
    // Twice as near, at the same place.
    let towards_m = (low_m + high_m) / 2.0;
    let close = Camera::new(far.from_m + 0.65 * (towards_m - far.from_m), towards_m, DEFAULT_FOV_RAD, SIZE).unwrap();
    println!("\n{name}: {} triangles; tree {:.0} ms", scene.mesh.triangles.len(), 1e3 * tree_s);
    for (view, camera) in [("far", far), ("close", close)] {
        let (buffers_s, buffers) = timed(|| Buffers::render(&rays, &camera, quiet.0, quiet.1).unwrap());
        let (surfaces_s, surfaces) = timed(|| Surfaces::new(&buffers));
        let hit: Vec<usize> = (0..SIZE[0] * SIZE[1]).filter(|&pixel| buffers.point(pixel).is_some()).collect();
        let checked: Vec<usize> = (0..CHECKED).map(|number| hit[number * 7919 % hit.len()]).collect();
        let points: Vec<Point> = checked.iter().filter_map(|&pixel| buffers.point(pixel)).collect();
        let casting = Casting { sun_rays: Some(1024), ..Casting::default() };
        let truth = cast(&rays, &points, &map, outdoors.north_rad, casting, quiet.0, quiet.1).unwrap();
        println!(
            " {view}: {:.0}% of the pixels; buffers {:.0} ms, places {:.0} ms",
            100.0 * hit.len() as f64 / (SIZE[0] * SIZE[1]) as f64,
            1e3 * buffers_s,
            1e3 * surfaces_s
        );
        println!(
            "  {:>14} {:>11} {:>6} {:>9} {:>9} {:>9} {:>8}",
            "scales", "combination", "smooth", "made, ms", "frames/s", "svf MAE", "RMSE"
        );
        for (directions, samples) in [(8, 8), (16, 16)] {
            for (combination, opening, smooth) in [
                (Combination::Large, false, false),
                (Combination::Large, true, false),
                (Combination::Large, true, true),
                (Combination::Weighted, true, false),
                (Combination::Weighted, true, true),
                (Combination::Intersected, true, false),
                (Combination::Intersected, true, true),
            ] {
                let look = Look {
                    samples,
                    reach_m: None,
                    opening,
                    combination,
                    fine_samples: samples,
                    fine_reach_m: 3.0,
                    smooth,
                };
                let (made_s, (taps, sums)) = timed(|| {
                    let zenith = Zenith::new(scene, 512, false, quiet.1).unwrap();
                    let sums = SkySums::new(&map, outdoors.north_rad, directions, TURNS);
                    (Taps::new(&zenith, &sums, &look), PixelSums::new(&sums, Part::All).unwrap())
                });
                let frame = || see(&taps, &sums, &surfaces, &look, quiet.1).unwrap();
                let mut seconds: Vec<f64> = (0..RUNS).map(|_| timed(frame).0).collect();
                seconds.sort_by(f64::total_cmp);
                let seen = frame();
                let count = truth.len() as f64;
                let pairs = || checked.iter().zip(&truth);
                let svf: f64 = pairs().map(|(&pixel, truth)| (f64::from(seen[pixel].svf) - truth.svf).abs()).sum();
                let square: f64 = pairs()
                    .map(|(&pixel, truth)| (f64::from(seen[pixel].total_kwh_m2) - truth.total_kwh_m2()).powi(2))
                    .sum();
                let mean = truth.iter().map(Exposure::total_kwh_m2).sum::<f64>() / count;
                println!(
                    "  {:>14} {:>11} {:>6} {:>9.0} {:>9.1} {:>9.4} {:>7.1}%",
                    format!("{directions} x ({samples}+{samples})"),
                    format!("{combination:?}{}", if opening { "" } else { "*" }).to_lowercase(),
                    smooth,
                    1e3 * made_s,
                    1.0 / seconds[RUNS / 2],
                    svf / count,
                    100.0 * (square / count).sqrt() / mean
                );
            }
        }
    }
    println!(" * without opening angles");
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let begin = Instant::now();
    let made = work();
    (begin.elapsed().as_secs_f64(), made)
}
