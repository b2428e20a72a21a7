//! The command `daylight`: exposure from sun and sky with what surfaces reflect, outdoors and in rooms, and the illuminance
//! and daylight factor that go with it.

use super::args::Flags;
use super::plan::Plan;
use super::run::{most_bytes, say, start_threads, warn};
use super::sky::args::SiteArgs;
use super::stages::Stages;
use super::table::Table;
use super::tell;
use super::write::Folder;
use crate::daylight::cast::{Casting, cast};
use crate::daylight::reflect::skylight::Skylight;
use crate::daylight::reflect::{self, Reflected};
use crate::daylight::{self, Exposure};
use crate::export::exposures;
use crate::flow::network::Quality;
use crate::job::Cancel;
use crate::light::Settings;
use crate::model::Model;
use crate::model::choose::choose_voxel_m;
use crate::rays::Rays;
use crate::scene::Scene;
use crate::sky::efficacy::Efficacies;
use crate::sky::map::{ExposureMap, MapSettings};
use crate::sky::site::Outdoors;
use crate::sky::weather::Weather;
use anyhow::{Context, Result};
use serde::Serialize;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// What `daylight` takes.
#[derive(Debug, clap::Args)]
pub struct DaylightArgs {
    /// A scene file (.toml) with sensors and a [site]
    pub scene: PathBuf,
    #[command(flatten)]
    pub site: SiteArgs,
    /// Suns of the period that a sensor looks at; by default every one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub sun_rays: Option<u32>,
    /// Directions of the sky at a sensor
    #[arg(long, value_name = "N", default_value_t = Casting::default().sky_rays, value_parser = clap::value_parser!(u32).range(8..=1 << 24))]
    pub sky_rays: u32,
    #[command(flatten)]
    pub flags: Flags,
    /// Folder for the files; made if it is not there
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// The JSON object.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    method: &'static str,
    voxel_m: Option<f32>,
    prepare_seconds: f64,
    seconds: f64,
    ghi: f64,
    dni: f64,
    dhi: f64,
    lit_h: f64,
    sensors: Vec<Row<'a>>,
    warnings: &'a [String],
}

/// A sensor of it: kWh/m2, hours of sun, lux and percent.
#[derive(Serialize)]
struct Row<'a> {
    id: &'a str,
    beam: f64,
    sky: f64,
    reflected: f64,
    total: f64,
    error: f64,
    reflected_error: f64,
    svf: f64,
    sun_h: f64,
    lux: f64,
    daylight_factor: f64,
    status: &'static str,
}

/// Runs the command.
///
/// # Errors
/// Bad input, a file that cannot be written, or an interrupt.
pub fn run(args: &DaylightArgs, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let mut folder = args.output.as_deref().map(Folder::new).transpose()?;
    start_threads(args.flags.threads.map(usize::from))?;
    let mut scene = Scene::load(&args.scene, &stages, cancel)?;
    let outdoors = outdoors(args, &mut scene, &stages, cancel)?;
    let plan = Plan::new(&args.flags, None, None, Settings::default(), &scene.model);

    let rays = Arc::new(Rays::new(&scene));
    let begin = Instant::now();
    let model = match plan.voxel_m {
        Some(voxel_m) => Model::build(&scene, rays.clone(), voxel_m, most_bytes(), &stages, cancel)?,
        None => {
            let chosen = choose_voxel_m(&scene, &rays, most_bytes(), &stages, cancel)?;
            tell(chosen.reason);
            chosen.model
        }
    };
    let prepare_seconds = begin.elapsed().as_secs_f64();

    let begin = Instant::now();
    let steps = outdoors.steps_unless(cancel).with_context(|| scene.name.clone())?;
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&steps, &settings, &stages, cancel)?;
    let casting = Casting { sun_rays: args.sun_rays, sky_rays: args.sky_rays, seed: plan.settings.seed };
    let points = daylight::points(&scene.sensors);
    let mut found = cast(&rays, &points, &map, outdoors.north_rad, casting, &stages, cancel)?;
    let light = Skylight::new(&map, outdoors.north_rad);
    let reflected = reflect::by_network(&model, &points, &light, &Quality::MEDIUM, casting, &stages, cancel)?;
    reflect::add(&mut found, &reflected);
    let seconds = begin.elapsed().as_secs_f64();
    let lit_h: f64 = steps.steps.iter().map(|step| step.hours).sum();
    let efficacies = Efficacies::mean(&steps.steps);

    let mut warnings = [scene.warnings.as_slice(), &steps.warnings].concat();
    if scene.sensors.is_empty() {
        warnings.push("the scene has no sensor".into());
    }
    warn(&warnings);
    outdoors.notes.iter().for_each(|note| tell(format_args!("note: {note}")));
    for stage in stages.ended() {
        tell(format_args!("{} {} {:.3}", stage.depth, stage.name, stage.seconds));
    }
    let rows = scene.sensors.iter().zip(&found).zip(&reflected).map(|((sensor, exposure), reflected)| {
        row(&sensor.id, exposure, reflected, efficacies, lit_h)
    });
    let report = Report {
        scene: &scene.name,
        method: "network",
        voxel_m: Some(model.voxels.lattice.voxel_m),
        prepare_seconds,
        seconds,
        ghi: map.totals.ghi_kwh_m2,
        dni: map.totals.dni_kwh_m2,
        dhi: map.totals.dhi_kwh_m2,
        lit_h,
        sensors: rows.collect(),
        warnings: &warnings,
    };
    let json = serde_json::to_string(&report)?;
    if let Some(folder) = &mut folder {
        folder.file("exposure.csv", |out| exposures::write_csv(out, &scene, &found))?;
        folder.file("daylight.json", |out| writeln!(out, "{json}"))?;
        folder.list();
    }
    if args.flags.json { say(&format!("{json}\n")) } else { say(&text(&report)) }
}

fn row<'a>(
    id: &'a str,
    exposure: &Exposure,
    reflected: &Reflected,
    efficacies: Efficacies,
    lit_h: f64,
) -> Row<'a> {
    let of_beam = efficacies.beam_lm_w * (exposure.beam_kwh_m2 + reflected.of_beam_kwh_m2);
    let of_sky = efficacies.sky_lm_w * (exposure.sky_kwh_m2 + reflected.of_sky_kwh_m2);
    Row {
        id,
        beam: exposure.beam_kwh_m2,
        sky: exposure.sky_kwh_m2,
        reflected: exposure.reflected_kwh_m2,
        total: exposure.total_kwh_m2(),
        error: exposure.error_kwh_m2,
        reflected_error: reflected.error_kwh_m2,
        svf: exposure.svf,
        sun_h: exposure.sun_h,
        lux: if lit_h > 0.0 { 1000.0 * (of_beam + of_sky) / lit_h } else { 0.0 },
        daylight_factor: 100.0 * reflected.daylight_factor,
        status: exposure.status.name(),
    }
}

/// Where the scene stands, its weather read.
fn outdoors(args: &DaylightArgs, scene: &mut Scene, stages: &Stages, cancel: &Cancel) -> Result<Outdoors> {
    let site = args.site.over(scene.site.take().unwrap_or_default());
    let weather = site.weather.as_deref().map(|path| Weather::load(path, stages, cancel)).transpose()?;
    if let Some(weather) = &weather {
        scene.warnings.extend(weather.warnings.iter().cloned());
    }
    let mut outdoors = Outdoors::of(&site, weather).with_context(|| args.scene.display().to_string())?;
    outdoors.model = args.site.model.unwrap_or(outdoors.model);
    Ok(outdoors)
}

/// The report for a reader.
fn text(report: &Report) -> String {
    let mut table = Table::new([
        "sensor", "beam", "sky", "reflected", "total", "+-", "svf", "sun, h", "lux", "factor, %", "status",
    ]);
    for row in &report.sensors {
        let energies =
            [row.beam, row.sky, row.reflected, row.total, row.error].map(|energy| format!("{energy:.1}"));
        let seen = [format!("{:.3}", row.svf), format!("{:.0}", row.sun_h)];
        let light = [format!("{:.0}", row.lux), format!("{:.2}", row.daylight_factor), row.status.to_owned()];
        table.row(std::iter::once(row.id.to_owned()).chain(energies).chain(seen).chain(light).collect());
    }
    format!(
        "{}: kWh/m2 over the period; global horizontal {:.0}, direct normal {:.0}, diffuse horizontal {:.0}\n\
         by rays and {}: prepared in {:.2} s, estimated in {:.2} s; lux: the mean of {:.0} lit hours\n\n{table}",
        report.scene,
        report.ghi,
        report.dni,
        report.dhi,
        report.method,
        report.prepare_seconds,
        report.seconds,
        report.lit_h
    )
}
