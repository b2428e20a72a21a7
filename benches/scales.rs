//! Exposure by maps against exposure by rays: how fast, and how far off?
//!
//!     cargo bench --bench scales [-- WEATHER]
//!
//! The outdoor scenes under a clear year, or a weather file that is named. For some numbers of directions and samples, and each
//! way to see beneath overhangs: the time of 10,000 sensors (the scene's own, again and again), RMSE of the exposure as a share
//! of the mean, and mean absolute error of the sky view factor, against every sun and 65,536 directions by rays. Medians of five
//! runs; what is made beforehand is timed apart.

use lightvein::daylight::cast::{Asked, Casting, cast};
use lightvein::daylight::scales::sight::Overhangs;
use lightvein::daylight::scales::sums::SkySums;
use lightvein::daylight::scales::zenith::Zenith;
use lightvein::daylight::scales::{Scan, expose};
use lightvein::daylight::{Exposure, Point, points};
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::weather::Weather;
use std::path::Path;
use std::time::Instant;

const RUNS: usize = 5;
const POINTS: usize = 10_000;

fn main() {
    let weather = std::env::args().skip(1).find(|arg| !arg.starts_with("--"));
    let weather = weather.map(|path| Weather::load(Path::new(&path), &Quiet, &Cancel::new()).unwrap());
    println!("{} threads, {RUNS} runs, {POINTS} points", rayon::current_num_threads());
    for name in ["outdoor/courtyard/courtyard", "outdoor/blocks/blocks", "outdoor/arcades/arcades", "real/ingolstadt"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
        let scene = match Scene::load(&path, &Quiet, &Cancel::new()) {
            Ok(scene) => scene,
            Err(error) => {
                println!("\nskipped: {error}");
                continue;
            }
        };
        let outdoors = Outdoors::of(&scene.site.clone().unwrap_or_default(), weather.clone()).unwrap();
        let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
        let map = ExposureMap::build(&outdoors.steps().unwrap(), &settings, &Quiet, &Cancel::new()).unwrap();
        let rays = Rays::new(&scene);
        let own = points(&scene.sensors);
        let many: Vec<Point> = own.iter().cycle().take(POINTS).copied().collect();
        let casting = Casting { sky_rays: 65_536, ..Casting::default() };
        let truth = cast(&rays, &own, &map, outdoors.north_rad, casting, &Quiet, &Cancel::new()).unwrap();
        println!("\n{name}: {} triangles, {} sensors", scene.mesh.triangles.len(), own.len());
        println!(
            "  {:>9} {:>6} {:>10} {:>7} {:>9} {:>8} {:>10} {:>8} {:>8}",
            "overhangs", "texels", "directions", "samples", "map, ms", "sums, ms", "points/s", "RMSE", "svf MAE"
        );
        for (texels, directions, samples) in
            [(512, 8, 8), (512, 16, 16), (1024, 32, 32), (1024, 64, 64), (2048, 64, 96), (2048, 128, 128)]
        {
            for overhangs in [Overhangs::Ignored, Overhangs::Opening, Overhangs::Peeled] {
                let peeled = overhangs == Overhangs::Peeled;
                let (map_s, zenith) = timed(|| Zenith::new(&scene, texels, peeled, &Cancel::new()).unwrap());
                let turns = (128 / directions).max(1);
                let (sums_s, sums) = timed(|| SkySums::new(&map, outdoors.north_rad, directions, turns));
                let scan = Scan { samples, reach_m: None, overhangs, seed: 0 };
                let at = |points: &[Point]| {
                    expose(&zenith, &sums, Asked::all(points), &scan, &Quiet, &Cancel::new()).unwrap()
                };
                let mut seconds: Vec<f64> = (0..RUNS).map(|_| timed(|| at(&many)).0).collect();
                seconds.sort_by(f64::total_cmp);
                let [rmse, svf] = off(&at(&own), &truth);
                println!(
                    "  {:>9} {texels:>6} {directions:>10} {samples:>7} {:>9.1} {:>8.1} {:>10.0} {:>7.2}% {svf:>8.4}",
                    format!("{overhangs:?}").to_lowercase(),
                    1e3 * map_s,
                    1e3 * sums_s,
                    POINTS as f64 / seconds[RUNS / 2],
                    100.0 * rmse,
                );
            }
        }
    }
}

/// RMSE of the totals over their mean, and mean absolute error of the sky view factors.
fn off(found: &[Exposure], truth: &[Exposure]) -> [f64; 2] {
    let count = truth.len() as f64;
    let pairs = || found.iter().zip(truth);
    let square: f64 = pairs().map(|(a, b)| (a.total_kwh_m2() - b.total_kwh_m2()).powi(2)).sum();
    let mean = truth.iter().map(Exposure::total_kwh_m2).sum::<f64>() / count;
    [(square / count).sqrt() / mean, pairs().map(|(a, b)| (a.svf - b.svf).abs()).sum::<f64>() / count]
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let begin = Instant::now();
    let made = work();
    (begin.elapsed().as_secs_f64(), made)
}
