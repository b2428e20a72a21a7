//! How many sensors a second do rays serve, and how far are they from all suns and much of the sky?
//!
//!     cargo bench --bench exposure [-- WEATHER]
//!
//! The outdoor scenes under a clear year, or a weather file that is named. For some numbers of suns and directions: the time
//! of 10,000 sensors (the scene's own, again and again, with other offsets each), and the RMSE of one run over the scene's
//! sensors against every sun and 65,536 directions, as a share of their mean. Medians of five runs; the tree of the scene and
//! the map of the year are timed apart.

use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::points;
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::{Scene, Sensor};
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::weather::Weather;
use std::path::Path;
use std::time::Instant;

const RUNS: usize = 5;
const SENSORS: usize = 10_000;

fn main() {
    let weather = std::env::args().skip(1).find(|arg| !arg.starts_with("--"));
    let weather = weather.map(|path| Weather::load(Path::new(&path), &Quiet, &Cancel::new()).unwrap());
    println!("{} threads, {RUNS} runs, {SENSORS} sensors", rayon::current_num_threads());
    for name in ["courtyard", "blocks", "arcades", "office"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/outdoor/{name}/{name}.toml"));
        let scene = Scene::load(&path, &Quiet, &Cancel::new()).unwrap();
        let outdoors = Outdoors::of(&scene.site.clone().unwrap_or_default(), weather.clone()).unwrap();
        let (map_s, map) = timed(|| {
            let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
            ExposureMap::build(&outdoors.steps().unwrap(), &settings, &Quiet, &Cancel::new()).unwrap()
        });
        let (tree_s, rays) = timed(|| Rays::new(&scene));
        println!(
            "\n{name}: {} triangles, {} sensors, {} suns; tree {:.1} ms, map {:.1} ms",
            scene.mesh.triangles.len(),
            scene.sensors.len(),
            map.suns.len(),
            1e3 * tree_s,
            1e3 * map_s
        );
        let many: Vec<Sensor> = scene.sensors.iter().cycle().take(SENSORS).cloned().collect();
        let totals = |sensors: &[Sensor], casting| -> Vec<f64> {
            let found =
                cast(&rays, &points(sensors), &map, outdoors.north_rad, casting, &Quiet, &Cancel::new()).unwrap();
            found.iter().map(|exposure| exposure.total_kwh_m2()).collect()
        };
        let truth = totals(&scene.sensors, Casting { sky_rays: 65_536, ..Casting::default() });
        println!("  {:>6} {:>6} {:>12} {:>8}", "suns", "sky", "sensors/s", "RMSE");
        for (suns, sky) in [(64, 64), (128, 128), (256, 256), (512, 512), (1024, 1024)] {
            let casting = Casting { sun_rays: Some(suns), sky_rays: sky, seed: 0 };
            let mut seconds: Vec<f64> = (0..RUNS).map(|_| timed(|| totals(&many, casting)).0).collect();
            seconds.sort_by(f64::total_cmp);
            let some = totals(&scene.sensors, casting);
            let square = some.iter().zip(&truth).map(|(some, all)| (some - all).powi(2)).sum::<f64>();
            let rmse = square.sqrt() * (truth.len() as f64).sqrt() / truth.iter().sum::<f64>();
            println!("  {suns:>6} {sky:>6} {:>12.0} {:>7.2}%", SENSORS as f64 / seconds[RUNS / 2], 100.0 * rmse);
        }
    }
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let begin = Instant::now();
    let made = work();
    (begin.elapsed().as_secs_f64(), made)
}
