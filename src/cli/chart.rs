//! `chart`: speed against accuracy, over one or more scenes.

use super::args::Many;
use super::peer;
use super::run::{most_bytes, say, start_threads, warn};
use super::stages::{Stages, processor_seconds};
use super::tell;
use super::write::Folder;
use crate::export::chart::{write_csv, write_svg};
use crate::export::png::png;
use crate::job::{Cancel, Progress};
use crate::light::Settings;
use crate::model::choose::choose_voxel_m;
use crate::rays::Rays;
use crate::scene::Scene;
use crate::study::chart::equal::{Bound, Ratio};
use crate::study::chart::measure::{Measurement, compare_points};
use crate::study::chart::verdict::verdict;
use crate::study::chart::{Point, SceneChart};
use crate::study::errors::is_good;
use anyhow::{Result, bail};
use serde::Serialize;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Pixels of the PNG a unit of the SVG.
const PIXELS_A_UNIT: f32 = 1.5;

/// How runs are timed.
pub struct Timing {
    /// Seconds that one run of an estimate may take.
    pub budget: f64,
    /// The same for the path tracer.
    pub trace_budget: f64,
    /// Whether processor time is counted, not wall time.
    pub processor_time: bool,
}

impl Timing {
    /// What is counted, for axes and texts.
    fn name(&self) -> String {
        match (self.processor_time, rayon::current_num_threads()) {
            (true, threads) => format!("processor time, {threads} thread{}", if threads == 1 { "" } else { "s" }),
            (false, threads) => format!("time on {threads} thread{}", if threads == 1 { "" } else { "s" }),
        }
    }
}

/// Runs the command.
///
/// # Errors
/// Bad input, a scene without a reference, or an interrupt.
pub fn run(many: &Many, timing: &Timing, peers: &[PathBuf], cancel: &Cancel) -> Result<()> {
    let mut folder = Folder::new(&many.output)?;
    if timing.processor_time && processor_seconds().is_none() {
        bail!("--processor-time: this system does not tell the processor time of threads");
    }
    let peers = peer::read_all(peers)?;
    start_threads(many.flags.threads.map(usize::from))?;
    let measured = many.scenes.iter().map(|path| measure(path, many, timing, cancel));
    let mut charts = measured.collect::<Result<Vec<SceneChart>>>()?;
    for chart in &mut charts {
        chart.points.extend(peers.points_of(&chart.scene));
        compare_points(&mut chart.points);
    }

    let mut svg = Vec::new();
    write_svg(&mut svg, &charts)?;
    let picture = png(&String::from_utf8_lossy(&svg), PIXELS_A_UNIT, |_| ())?;
    if !picture.has_text {
        tell("warning: chart.png has no text: this system has no font; chart.svg has all of it");
    }
    let text = charts.iter().map(verdict).collect::<Vec<_>>().join("\n");
    let json = serde_json::to_string(&Charted::new(timing.budget, &charts))?;
    folder.file("chart.svg", |out| out.write_all(&svg))?;
    folder.file("chart.png", |out| out.write_all(&picture.bytes))?;
    folder.file("chart.csv", |out| write_csv(out, &charts))?;
    folder.file("chart.txt", |out| out.write_all(text.as_bytes()))?;
    folder.list();
    say(&if many.flags.json { format!("{json}\n") } else { text })
}

/// All points of one scene.
fn measure(path: &Path, many: &Many, timing: &Timing, cancel: &Cancel) -> Result<SceneChart> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    stages.begin("load", 0);
    let scene = Scene::load(path, &stages, cancel)?;
    stages.end();
    if !scene.reference.iter().flatten().any(is_good) {
        bail!("{}: a chart needs a reference; `lightvein trace` makes one", path.display());
    }
    warn(&scene.warnings);
    stages.begin("rays", 0);
    let rays = Arc::new(Rays::new(&scene));
    stages.end();

    let voxel_m = match many.flags.voxel.or(scene.model.voxel_m) {
        Some(voxel_m) => voxel_m,
        None => {
            let chosen = choose_voxel_m(&scene, &rays, most_bytes(), &stages, cancel)?;
            tell(format_args!("{}: {}", scene.name, chosen.reason));
            chosen.model.voxels.lattice.voxel_m
        }
    };
    let began = Instant::now();
    let wall = || began.elapsed().as_secs_f64();
    let measurement = Measurement {
        scene: &scene,
        rays: &rays,
        voxel_m,
        budget_seconds: timing.budget,
        trace_budget_seconds: timing.trace_budget,
        max_bytes: most_bytes(),
        settings: Settings { seed: many.flags.seed.or(scene.model.seed).unwrap_or(0), ..Settings::default() },
        clock: if timing.processor_time { &|| processor_seconds().unwrap_or(f64::NAN) } else { &wall },
    };
    let chart = measurement.run(&stages, cancel)?;
    let [load_seconds, rays_seconds] = ["load", "rays"].map(|stage| stages.seconds_of(stage));
    Ok(SceneChart { load_seconds, rays_seconds, timed_by: timing.name(), ..chart })
}

/// `chart --json`.
#[derive(Debug, Serialize)]
struct Charted<'a> {
    budget_seconds: f64,
    scenes: Vec<SceneRow<'a>>,
}

#[derive(Debug, Serialize)]
struct SceneRow<'a> {
    scene: &'a str,
    referenced: usize,
    load_seconds: f64,
    rays_seconds: f64,
    points: Vec<PointRow<'a>>,
    notes: &'a [String],
}

#[derive(Debug, Serialize)]
struct PointRow<'a> {
    method: &'a str,
    quality: &'a str,
    voxel_m: Option<f32>,
    sensors: usize,
    prepare_seconds: f64,
    seconds: f64,
    scaled: bool,
    rms_factor: Option<f64>,
    max_factor: Option<f64>,
    median_angle_deg: Option<f64>,
    lost: usize,
    pareto: bool,
    equal_error: Option<EqualRow>,
}

#[derive(Debug, Serialize)]
struct EqualRow {
    times: f64,
    bound: &'static str,
}

impl<'a> Charted<'a> {
    /// The outcome of `chart`; infinite factors have no JSON and become null.
    fn new(budget_seconds: f64, charts: &'a [SceneChart]) -> Self {
        let scene = |chart: &'a SceneChart| SceneRow {
            scene: &chart.scene,
            referenced: chart.referenced,
            load_seconds: chart.load_seconds,
            rays_seconds: chart.rays_seconds,
            points: chart.points.iter().map(PointRow::of).collect(),
            notes: &chart.notes,
        };
        Self { budget_seconds, scenes: charts.iter().map(scene).collect() }
    }
}

impl<'a> PointRow<'a> {
    fn of(point: &'a Point) -> Self {
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        let equal = |ratio: Ratio| EqualRow {
            times: ratio.times,
            bound: match ratio.bound {
                Bound::Between => "between",
                Bound::AtLeast => "at_least",
                Bound::AtMost => "at_most",
            },
        };
        Self {
            method: &point.method,
            quality: &point.quality,
            voxel_m: point.voxel_m,
            sensors: point.sensors,
            prepare_seconds: point.prepare_seconds,
            seconds: point.seconds,
            scaled: point.is_scaled,
            rms_factor: finite(point.rms_factor()),
            max_factor: finite(point.errors.max_factor),
            median_angle_deg: point.errors.median_angle_deg,
            lost: point.errors.lost,
            pareto: point.is_front,
            equal_error: point.equal_error.map(equal),
        }
    }
}
