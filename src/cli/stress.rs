//! The command `stress`: given scenes disturbed, built-in ones asked; tables, JSON and files of what was found.

use super::args::StressArgs;
use super::plan::Plan;
use super::run::{most_bytes, prepare, say, start_threads, warn};
use super::stages::Stages;
use super::table::Table;
use super::write::Folder;
use crate::export::{stress, strips};
use crate::flow::estimator;
use crate::job::{Cancel, Progress};
use crate::light::Settings;
use crate::scene::{Method, Scene};
use crate::study::compare::Contestant;
use crate::study::stress::asked::Asked;
use crate::study::stress::built_in::stress_built_in;
use crate::study::stress::given::stress_scene;
use crate::study::stress::{Row, Statuses, Trials};
use anyhow::Result;
use serde::Serialize;
use std::io::IsTerminal;

/// Voxels of the built-in scenes where the command line says nothing, metres.
const VOXEL_M: f32 = 0.1;

/// `stress --json`; factors that are infinite have no JSON and become null.
#[derive(Debug, Serialize)]
struct Stress<'a> {
    offsets: u32,
    turns: u32,
    seeds: u32,
    samples: u32,
    seconds: f64,
    rows: Vec<RowOut<'a>>,
}

#[derive(Debug, Serialize)]
struct RowOut<'a> {
    scene: &'a str,
    failure: &'a str,
    case: &'a str,
    method: &'a str,
    moved: Figures,
    worst_sensor: Option<&'a str>,
    worst_trial: Option<usize>,
    truth: Figures,
    statuses: Statuses,
    warnings: &'a [String],
}

#[derive(Debug, Serialize)]
struct Figures {
    answers: usize,
    rms_factor: Option<f64>,
    p95_factor: Option<f64>,
    max_factor: Option<f64>,
    p95_angle_deg: Option<f64>,
    max_angle_deg: Option<f64>,
    lost: usize,
    phantom: usize,
}

/// Runs the command.
///
/// # Errors
/// Bad input, a job that failed, or an interrupt.
pub fn run(args: &StressArgs, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let mut folder = args.output.as_deref().map(Folder::new).transpose()?;
    start_threads(args.flags.threads.map(usize::from))?;
    let trials = Trials {
        failures: args.rows.clone(),
        offsets: args.offsets,
        turns: args.turns,
        seeds: args.seeds,
        samples: args.spp,
        seed: args.flags.seed.unwrap_or(0),
        max_bytes: most_bytes(),
    };
    let contestants: Vec<Contestant> = methods(args).into_iter().map(Contestant::built_in).collect();

    stages.begin("stress", 0);
    let asked = Asked { contestants: &contestants, trials: &trials, progress: &stages, cancel };
    let mut given = Vec::new();
    for path in &args.scenes {
        let mut scene = Scene::load(path, &stages, cancel)?;
        let plan = Plan::new(&args.flags, None, None, Settings::default(), &scene.model);
        let (model, warnings) = prepare(&mut scene, &plan, &stages, cancel)?;
        warn(&warnings);
        given.extend(stress_scene(&scene, &model, asked)?);
    }
    let built_in = stress_built_in(args.flags.voxel.unwrap_or(VOXEL_M), asked)?;
    stages.end();

    let rows = [given.as_slice(), &built_in].concat();
    let seconds = stages.seconds_of("stress");
    let json = serde_json::to_string(&report(&trials, &rows, seconds))?;
    if let Some(folder) = &mut folder {
        folder.file("stress.csv", |out| stress::write_csv(out, &rows))?;
        folder.file("stress.json", |out| writeln!(out, "{json}"))?;
        for (name, rows) in [("stress.svg", &given), ("stress_built_in.svg", &built_in)] {
            if !rows.is_empty() {
                folder.file(name, |out| strips::write(out, rows))?;
            }
        }
        folder.list();
    }
    if args.flags.json { say(&format!("{json}\n")) } else { say(&in_words(&rows, seconds)) }
}

/// The methods asked for; by default every estimator, and not the path tracer.
fn methods(args: &StressArgs) -> Vec<Method> {
    if args.methods.is_empty() {
        return Method::ALL.into_iter().filter(|&method| estimator(method).is_some()).collect();
    }
    let once = args.methods.iter().enumerate().filter(|(at, method)| !args.methods[..*at].contains(method));
    once.map(|(_, &method)| method).collect()
}

fn report<'a>(trials: &Trials, rows: &'a [Row], seconds: f64) -> Stress<'a> {
    let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
    let figures = |spread: &crate::study::stress::Spread| Figures {
        answers: spread.count(),
        rms_factor: finite(spread.rms()),
        p95_factor: finite(spread.p95()),
        max_factor: finite(spread.max()),
        p95_angle_deg: spread.angle_p95_deg(),
        max_angle_deg: spread.angle_max_deg(),
        lost: spread.lost,
        phantom: spread.phantom,
    };
    let row = |row: &'a Row| RowOut {
        scene: &row.scene,
        failure: row.failure.name(),
        case: &row.case,
        method: &row.method,
        moved: figures(&row.moved),
        worst_sensor: row.worst().map(|(sensor, _)| sensor),
        worst_trial: row.worst().map(|(_, trial)| trial),
        truth: figures(&row.truth),
        statuses: row.statuses,
        warnings: &row.warnings,
    };
    let Trials { offsets, turns, seeds, samples, .. } = *trials;
    Stress { offsets, turns, seeds, samples, seconds, rows: rows.iter().map(row).collect() }
}

/// The table, warnings by their numbers, and the warnings under it.
fn in_words(rows: &[Row], seconds: f64) -> String {
    let mut table = Table::new([
        "scene",
        "failure",
        "case",
        "method",
        "moved 95%",
        "max",
        "at",
        "angle 95%",
        "max",
        "truth rms",
        "95%",
        "max",
        "lost",
        "phantom",
        "sensors",
        "warnings",
    ]);
    let mut warnings: Vec<&String> = Vec::new();
    for row in rows {
        let numbers = row.warnings.iter().map(|warning| {
            let known = warnings.iter().position(|known| known == &warning);
            let number = known.unwrap_or_else(|| {
                warnings.push(warning);
                warnings.len() - 1
            });
            format!("[{}]", number + 1)
        });
        let numbers: String = numbers.collect();
        table.row(vec![
            row.scene.clone(),
            row.failure.name().to_owned(),
            row.case.clone(),
            row.method.clone(),
            factor(row.moved.p95()),
            factor(row.moved.max()),
            row.worst().map_or_else(|| "-".to_owned(), |(sensor, trial)| format!("{sensor}, {trial}")),
            degrees(row.moved.angle_p95_deg()),
            degrees(row.moved.angle_max_deg()),
            factor(row.truth.rms()),
            factor(row.truth.p95()),
            factor(row.truth.max()),
            row.truth.lost.to_string(),
            row.truth.phantom.to_string(),
            row.statuses.in_words(),
            numbers,
        ]);
    }
    let listed = warnings.iter().enumerate().map(|(number, warning)| format!("[{}] {warning}\n", number + 1));
    format!("{table}\n{}\n{seconds:.1} s\n", listed.collect::<String>())
}

fn degrees(angle: Option<f64>) -> String {
    angle.map_or_else(|| "-".to_owned(), |angle| format!("{angle:.0} deg"))
}

/// A factor to three digits; a zero beside light has an infinite one.
fn factor(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(value) if value.is_infinite() => "zero".to_owned(),
        Some(value) if value < 10.0 => format!("{value:.3}"),
        Some(value) => format!("{value:.3e}"),
    }
}
