//! What does a year's exposure map cost, how far is it from the full sum, and what does Radiance take for its mean sky?
//!
//!     cargo bench --bench sky [-- [WEATHER] [--runs N] [--no-peers]]
//!
//! The year of `scenes/weather`, or a weather file that is named, under Perez' sky, and clear years under all three. For
//! each: the steps of the period, the map of 512 x 512 to its tolerance, the same texels all evaluated, medians of runs in
//! turn; and the largest error of the one against the other in the texels that hold 99.9% of the energy. Then, on the same
//! weather file and in the same run, Radiance's `gendaymtx` at some subdivisions of its sky, where `python3` has it
//! (`pip install pyradiance`).

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::Site;
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings, least_counted};
use lightvein::sky::site::Outdoors;
use lightvein::sky::weather::Weather;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Runs whose median counts.
const RUNS: usize = 5;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|arg| arg != "--bench").collect();
    let runs =
        args.iter().position(|arg| arg == "--runs").and_then(|at| args.get(at + 1)?.parse().ok()).unwrap_or(RUNS);
    let named = args.first().filter(|arg| !arg.starts_with("--")).map(PathBuf::from);
    let path =
        named.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/weather/clear_and_cloudy.wea"));

    let begin = Instant::now();
    let weather = Weather::load(&path, &Quiet, &Cancel::new()).unwrap();
    println!("{}: read in {:.1} ms", path.display(), 1e3 * begin.elapsed().as_secs_f64());
    println!("{} threads, {runs} runs, 512 x 512\n", rayon::current_num_threads());
    println!(
        "{:28} {:>6} {:>9} {:>9} {:>9} {:>9} {:>10} {:>9} {:>9}",
        "year", "steps", "steps ms", "map ms", "full ms", "full/map", "directions", "rms", "largest"
    );
    let measured = Outdoors::of(&Site::default(), Some(weather)).unwrap();
    let seconds = time("weather, perez", &measured, runs);
    for (name, model) in [
        ("clear, perez", SkyModel::Perez),
        ("clear, hosek", SkyModel::Hosek),
        ("clear, isotropic", SkyModel::Isotropic),
    ] {
        let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
        time(name, &Outdoors { model, ..Outdoors::of(&site, None).unwrap() }, runs);
    }
    if !args.iter().any(|arg| arg == "--no-peers") {
        time_peers(&path, seconds);
    }
}

/// Times one year, prints its row, and gives the seconds of steps and map.
fn time(name: &str, outdoors: &Outdoors, runs: usize) -> f64 {
    let steps = outdoors.steps().unwrap();
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let all = MapSettings { tolerance: None, ..settings };
    let build = |settings: &MapSettings| ExposureMap::build(&steps, settings, &Quiet, &Cancel::new()).unwrap();

    let (mut steps_s, mut map_s, mut full_s) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..runs {
        steps_s.push(seconds(|| drop(outdoors.steps())));
        map_s.push(seconds(|| drop(build(&settings))));
        full_s.push(seconds(|| drop(build(&all))));
    }
    let [steps_s, map_s, full_s] = [steps_s, map_s, full_s].map(median);

    let (map, full) = (build(&settings), build(&all));
    let least = least_counted(&full.diffuse_kwh_m2);
    let counted = map.diffuse_kwh_m2.iter().zip(&full.diffuse_kwh_m2).filter(|(_, full)| **full >= least);
    let errors: Vec<f64> = counted.map(|(some, full)| f64::from(*some) / f64::from(*full) - 1.0).collect();
    let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
    let largest = errors.iter().map(|error| error.abs()).fold(0.0, f64::max);
    println!(
        "{name:28} {:>6} {:>9.1} {:>9.1} {:>9.1} {:>9.1} {:>10} {:>8.4}% {:>8.4}%",
        steps.steps.len(),
        1e3 * steps_s,
        1e3 * map_s,
        1e3 * full_s,
        full_s / map_s,
        map.check.evaluated,
        100.0 * rms,
        100.0 * largest
    );
    steps_s + map_s
}

/// Times Radiance on the same file.
fn time_peers(path: &Path, seconds: f64) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/sky_speed.py");
    match Command::new("python3").arg(&script).arg(path).arg(seconds.to_string()).status() {
        Ok(status) if status.success() => {}
        Ok(status) => println!("  peers skipped: {} ended with {status}\n", script.display()),
        Err(error) => println!("  peers skipped: python3 does not run: {error}\n"),
    }
}

fn seconds(work: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    work();
    begin.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
