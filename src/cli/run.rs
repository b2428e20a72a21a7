//! The commands, each a list of steps.

use super::args::{Args, Command, Common};
use super::chart;
use super::daylight;
use super::expose;
use super::guide;
use super::plan::Plan;
use super::report::{self, Analysis, Comparison};
use super::sky;
use super::stages::{Stages, available_bytes};
use super::stress;
use super::write::{self, Analysed, Folder};
use super::{tell, tolerance};
use crate::export;
use crate::flow::{Estimator, estimator, ladder, network};
use crate::job::{Cancel, Progress};
use crate::light::{Settings, Sources};
use crate::model::Model;
use crate::model::bare::light_bare_mesh;
use crate::model::choose::choose_voxel_m;
use crate::rays::Rays;
use crate::scene::{Method, Reference, Scene};
use crate::study::compare::{Contestant, Entry, compare};
use crate::study::errors::errors;
use crate::trace;
use anyhow::{Context, Result};
use std::io::{IsTerminal, Write};
use std::sync::Arc;

/// Runs one command to its end.
///
/// # Errors
/// Bad input, a job that failed, or an interrupt.
pub fn run(args: Args, cancel: &Cancel) -> Result<()> {
    match args.command {
        Command::Analyse { common, method } => run_analyse(&common, method, cancel),
        Command::Compare { common, methods, spp } => run_compare(&common, &methods, spp, cancel),
        Command::Chart { many, budget, trace_budget, processor_time, peer } => {
            let trace_budget = trace_budget.unwrap_or(budget);
            let timing = chart::Timing { budget, trace_budget, processor_time };
            chart::run(&many, &timing, &peer, cancel)
        }
        Command::Trace { common, spp, bounces } => run_trace(&common, spp, bounces, cancel),
        Command::Guide(args) => guide::run(args, cancel),
        Command::Stress(args) => stress::run(&args, cancel),
        Command::Sky(args) => sky::run(&args, cancel),
        Command::Expose(args) => expose::run(&args, cancel),
        Command::Daylight(args) => daylight::run(&args, cancel),
    }
}

fn run_analyse(common: &Common, method: Option<Method>, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let mut folder = common.output.as_deref().map(Folder::new).transpose()?;
    let (mut scene, plan) = open(common, method, Settings::default(), &stages, cancel)?;
    let tolerance::Analysed { model, method, name, estimate, field, choice, warnings } = match plan.method {
        Some(method) if plan.tolerance.is_none() || ladder(method).is_empty() => {
            as_asked(&mut scene, method, &plan, &stages, cancel)?
        }
        _ => tolerance::analysed(&mut scene, &plan, &stages, cancel)?,
    };
    warn(&warnings);

    if let Some(folder) = &mut folder {
        // Nodes and faces are many: there a network is read at its zones.
        let read = network::with(network::Quality::MEDIUM.read());
        let elsewhere = if method == Method::Network { Some(&*read) } else { estimate.as_deref() };
        let analysed = Analysed {
            scene: &scene,
            model: &model,
            at_sensors: &field,
            estimate: elsewhere,
            settings: &plan.settings,
        };
        write::analysis(folder, &analysed, &stages, cancel)?;
    }
    let ended = stages.ended();
    let analysis = Analysis::new(&scene, &model, method.name(), &field, choice.as_ref(), &ended, &warnings);
    let json = serde_json::to_string(&analysis)?;
    if let Some(folder) = &mut folder {
        folder.file("report.json", |out| writeln!(out, "{json}"))?;
        folder.list();
    }
    if common.flags.json {
        return say(&format!("{json}\n"));
    }
    let mut text = analysis.summary();
    text += &choice.map_or_else(String::new, |choice| choice.lines().join("\n") + "\n");
    text += &format!("\n{}", report::sensor_table(&scene, method.name(), &field));
    let entry = Entry { name, errors: errors(&field.readings, &scene.reference), field };
    if entry.errors.counted > 0 {
        text +=
            &format!("\n{}", report::error_table(std::slice::from_ref(&entry), |entry| stages.seconds_of(&entry.name)));
    }
    text += &format!("\n{}", report::stage_table(&ended));
    say(&text)
}

/// The method that was asked for, at its default quality.
fn as_asked(
    scene: &mut Scene,
    method: Method,
    plan: &Plan,
    stages: &Stages,
    cancel: &Cancel,
) -> Result<tolerance::Analysed> {
    let (model, mut warnings) = prepare(scene, plan, stages, cancel)?;
    let entry = compare_one(scene, &model, method, &plan.settings, stages, cancel)?;
    warnings.extend(entry.field.warnings.iter().cloned());
    let estimate = estimator(method).map(|estimate| -> Box<Estimator> { Box::new(estimate) });
    Ok(tolerance::Analysed { model, method, name: entry.name, estimate, field: entry.field, choice: None, warnings })
}

fn run_compare(common: &Common, methods: &[Method], spp: Option<u32>, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let mut folder = common.output.as_deref().map(Folder::new).transpose()?;
    let settings = Settings { samples: spp.unwrap_or(Settings::default().samples), ..Settings::default() };
    let (mut scene, plan) = open(common, None, settings, &stages, cancel)?;
    let (model, mut warnings) = prepare(&mut scene, &plan, &stages, cancel)?;
    let reference = match spp {
        Some(_) if scene.reference.is_empty() => traced_reference(&scene, &model, &plan.settings, &stages, cancel)?,
        _ => scene.reference.clone(),
    };
    // A method named twice would run once more for the same answer.
    let once = methods.iter().enumerate().filter(|(at, method)| !methods[..*at].contains(method));
    let contestants: Vec<Contestant> = once.map(|(_, &method)| Contestant::built_in(method)).collect();
    let entries = compare(&scene, &model, &contestants, &reference, &plan.settings, &stages, cancel)?;
    warnings.extend(entries.iter().flat_map(|entry| entry.field.warnings.iter().cloned()));
    warn(&warnings);

    let seconds = |entry: &Entry| stages.seconds_of(&entry.name);
    let prepare_seconds = stages.seconds_of("voxels") + stages.seconds_of("skeleton");
    let comparison = Comparison::new(&scene, &model, &entries, &reference, prepare_seconds, seconds);
    let json = serde_json::to_string(&comparison)?;
    if let Some(folder) = &mut folder {
        folder.file("compare.json", |out| writeln!(out, "{json}"))?;
        folder.list();
    }
    if common.flags.json {
        return say(&format!("{json}\n"));
    }
    say(&format!(
        "{}: voxels of {} m, voxels and skeleton in {prepare_seconds:.4} s\n\n{}\n{}",
        scene.name,
        model.voxels.lattice.voxel_m,
        report::comparison_table(&scene, &entries, &reference),
        report::error_table(&entries, seconds),
    ))
}

fn run_trace(common: &Common, spp: u32, bounces: Option<u32>, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let mut folder = common.output.as_deref().map(Folder::new).transpose()?;
    let settings = Settings { samples: spp, max_bounces: bounces, ..Settings::default() };
    let (mut scene, plan) = open(common, None, settings, &stages, cancel)?;
    let (rays, sources, warnings) = if scene.bare {
        // Its light and its sensors are found by its cells.
        let (model, warnings) = prepare(&mut scene, &plan, &stages, cancel)?;
        (model.rays, model.sources, warnings)
    } else {
        let sources = Sources::of(&scene);
        let missing = missing(&scene, &sources);
        (Arc::new(Rays::new(&scene)), sources, [scene.warnings.clone(), missing].concat())
    };
    warn(&warnings);
    let field = trace::trace(&scene, &rays, &sources, &plan.settings, &stages, cancel)?.field;
    warn(&field.warnings);

    let bounces = bounces.map_or_else(|| "any number of".to_owned(), |bounces| bounces.to_string());
    let origin = format!(
        "{}: W/m2 by lightvein {} trace, {spp} samples a sensor, {bounces} bounces, seed {}",
        scene.name.replace(['\n', '\r'], " "),
        env!("CARGO_PKG_VERSION"),
        plan.settings.seed
    );
    let mut table = Vec::new();
    export::reference::write_reference(&mut table, &origin, &scene.sensors, &field)?;
    match &mut folder {
        Some(folder) => {
            folder.file("reference.csv", |out| out.write_all(&table))?;
            folder.list();
            Ok(())
        }
        None => say(&String::from_utf8_lossy(&table)),
    }
}

/// Loads the scene, makes the plan, and sets the number of threads.
///
/// # Errors
/// A scene that cannot be read, threads that cannot be started, or an interrupt.
pub fn open(
    common: &Common,
    method: Option<Method>,
    settings: Settings,
    stages: &Stages,
    cancel: &Cancel,
) -> Result<(Scene, Plan)> {
    stages.begin("load", 0);
    // On threads of its own: those of the whole run may be named in the file, and can be set but once.
    let loading = rayon::ThreadPoolBuilder::new().num_threads(common.flags.threads.unwrap_or(0).into()).build()?;
    let scene = loading.install(|| Scene::load(&common.scene, stages, cancel))?;
    drop(loading);
    stages.end();
    let plan = Plan::new(&common.flags, common.tolerance, method, settings, &scene.model);
    start_threads(plan.threads)?;
    Ok((scene, plan))
}

/// Starts so many threads for all that follows; `None` leaves it to be one a core.
///
/// # Errors
/// They were started already, or the system gives none.
pub fn start_threads(threads: Option<usize>) -> Result<()> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().context("the threads cannot be started")
}

/// Share of the memory at hand that voxels and skeleton may take; the rest is for rays, fields and the system.
const MEMORY_SHARE: f64 = 0.8;

/// The most memory that voxels and skeleton may take, bytes.
pub fn most_bytes() -> u64 {
    available_bytes().map_or(u64::MAX, |bytes| (bytes as f64 * MEMORY_SHARE) as u64)
}

/// Voxels and skeleton, at the size asked for or one that is chosen; a bare mesh gets its light. Gives all warnings so far.
///
/// # Errors
/// A grid that does not fit, or an interrupt.
pub fn prepare(scene: &mut Scene, plan: &Plan, stages: &Stages, cancel: &Cancel) -> Result<(Model, Vec<String>)> {
    let max_bytes = most_bytes();
    stages.begin("rays", 0);
    let rays = Arc::new(Rays::new(scene));
    stages.end();

    let model = match plan.voxel_m {
        Some(voxel_m) => Model::build(scene, rays, voxel_m, max_bytes, stages, cancel)?,
        None => {
            let chosen = choose_voxel_m(scene, &rays, max_bytes, stages, cancel)?;
            tell(chosen.reason);
            chosen.model
        }
    };
    let model = if scene.bare { light_bare_mesh(scene, model) } else { model };

    let warnings = warnings_of(scene, &model);
    Ok((model, warnings))
}

/// What loading and modelling warn of.
pub fn warnings_of(scene: &Scene, model: &Model) -> Vec<String> {
    let voxels = model.voxels.warnings.iter().cloned();
    scene.warnings.iter().cloned().chain(voxels).chain(missing(scene, &model.sources)).collect()
}

/// Said of a scene without sensors.
pub const NO_SENSOR: &str = "the scene has no sensor";

/// What a run can do without but its user hardly meant to leave out, a sentence each.
fn missing(scene: &Scene, sources: &Sources) -> Vec<String> {
    let missing = [(sources.emitters.is_empty(), "the scene has no light"), (scene.sensors.is_empty(), NO_SENSOR)];
    missing.iter().filter(|(is_missing, _)| *is_missing).map(|(_, says)| (*says).to_owned()).collect()
}

/// One method at the sensors, with the scene's reference.
fn compare_one(
    scene: &Scene,
    model: &Model,
    method: Method,
    settings: &Settings,
    stages: &Stages,
    cancel: &Cancel,
) -> Result<Entry> {
    let contestants = [Contestant::built_in(method)];
    let entries = compare(scene, model, &contestants, &scene.reference, settings, stages, cancel)?;
    entries.into_iter().next().context("no method ran")
}

/// A reference by our own path tracer, for a scene that has none.
fn traced_reference(
    scene: &Scene,
    model: &Model,
    settings: &Settings,
    stages: &Stages,
    cancel: &Cancel,
) -> Result<Vec<Option<Reference>>> {
    stages.begin("reference", 0);
    // Its own random numbers: `trace` as a method must not be held against itself.
    let settings = Settings { seed: settings.seed.wrapping_add(1), ..*settings };
    let field = trace::trace(scene, &model.rays, &model.sources, &settings, stages, cancel)?.field;
    stages.end();
    let row = |reading: &crate::light::Reading| Reference {
        irradiance_w_m2: reading.value_w_m2,
        stderr_w_m2: reading.error_w_m2.unwrap_or(0.0),
        flux_w_m2: reading.flux_w_m2,
    };
    Ok(field.readings.iter().map(|reading| Some(row(reading))).collect())
}

/// Warnings on stderr, a line each.
pub fn warn(warnings: &[String]) {
    for warning in warnings {
        tell(format_args!("warning: {warning}"));
    }
}

/// Text on stdout.
///
/// # Errors
/// What the writer says.
pub fn say(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}
