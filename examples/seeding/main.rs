//! Does a guide from the skeleton help a path tracer? Error in equal time and by equal samples, for `docs/seeding.md`.
//!
//!     cargo run --release --example seeding -- [SCENE.toml ...] [-o FOLDER] [--seconds 60] [--measure 20] [--truth 60]
//!         [--learn 60] [--busy] [--wrong]
//!
//! Contestants: `plain` (next-event estimation and roulette alone), `guided` (by lobes from the network; voxels, skeleton and
//! guide count into its time), `coarse` (the same with fewer and larger places) and `learned` (an SD-tree trained while it renders; learning counts into its time). Without scenes:
//! those of [`SCENES`]; a scene that cannot be read is skipped and named. How errors are taken is told in `measure`. Writes
//! `seeding.csv`, a row a sensor, budget and contestant, and `seeding.svg`. About five minutes a scene, on a
//! quiet machine; on another `--busy` counts the processors' time. `--wrong` lets guides compete that say nothing or lie; what it
//! took to make them is in their time, to be left out.

mod contestants;
mod measure;
mod report;

use lightvein::export::chart::loglog;
use lightvein::export::whole_file;
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::Scene;
use measure::{Clock, Effort};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Scenes where none is named: light through openings, then scenes that need no guide and must not suffer by one.
const SCENES: [&str; 10] = [
    "scenes/gallery/gallery.toml",
    "scenes/tower/tower.toml",
    "scenes/corridor/corridor.toml",
    "scenes/cave/cave.toml",
    "scenes/keyhole/keyhole.toml",
    "scenes/real/quake_dm4.toml",
    "scenes/real/cabin.toml",
    "scenes/two_rooms/two_rooms.toml",
    "scenes/furnace/furnace.toml",
    "scenes/real/cornell_original.toml",
];

/// Panels of the chart in a row.
const COLUMNS: usize = 3;

/// What was asked for.
struct Options {
    scenes: Vec<PathBuf>,
    out: PathBuf,
    effort: Effort,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    let mut findings = Vec::new();
    for path in &options.scenes {
        match Scene::load(path, &Quiet, &Cancel::new()) {
            Ok(scene) => {
                let found = measure::scene(&scene, &options.effort)?;
                report::print(&found);
                findings.push(found);
            }
            Err(error) => eprintln!("skipped: {error}"),
        }
    }
    report::print_summary(&findings);
    std::fs::create_dir_all(&options.out)?;
    let panels: Vec<loglog::Panel> = findings.iter().map(report::panel).collect();
    let says = "down is better; median over sensors; preparation and learning are in the time";
    whole_file(&options.out.join("seeding.svg"), |out| loglog::write(out, &panels, COLUMNS, says))?;
    whole_file(&options.out.join("seeding.csv"), |out| report::write_table(out, &findings))?;
    Ok(())
}

fn options() -> Result<Options, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let effort = Effort {
        clock: Clock::Wall,
        longest_s: 60.0,
        measure_s: 20.0,
        truth_s: 60.0,
        learn_s: 60.0,
        with_wrong: false,
    };
    let mut options = Options { scenes: Vec::new(), out: root.join("docs/charts"), effort };
    let mut args = std::env::args_os().skip(1).map(PathBuf::from);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or_else(|| format!("{} needs a value behind it", arg.display()));
        match arg.to_str() {
            Some("-o") => options.out = value()?,
            Some("--seconds") => options.effort.longest_s = seconds(&value()?)?,
            Some("--measure") => options.effort.measure_s = seconds(&value()?)?,
            Some("--truth") => options.effort.truth_s = seconds(&value()?)?,
            Some("--learn") => options.effort.learn_s = seconds(&value()?)?,
            Some("--wrong") => options.effort.with_wrong = true,
            Some("--busy") => options.effort.clock = Clock::Processors,
            Some(flag) if flag.starts_with('-') => return Err(format!("{flag} is not known").into()),
            _ => options.scenes.push(arg),
        }
    }
    if options.scenes.is_empty() {
        options.scenes = SCENES.iter().map(|scene| root.join(scene)).collect();
    }
    Ok(options)
}

fn seconds(word: &Path) -> Result<f64, String> {
    let asked =
        word.to_str().and_then(|word| word.parse::<f64>().ok()).filter(|seconds| (1.0..=3600.0).contains(seconds));
    asked.ok_or_else(|| format!("{} is no number of seconds from 1 to 3600", word.display()))
}
