//! The command `expose`: what the sensors of a scene receive from sun and sky over a period, by rays.

use super::args::Flags;
use super::run::{say, start_threads, warn};
use super::sky::args::SiteArgs;
use super::stages::Stages;
use super::table::Table;
use super::tell;
use super::write::Folder;
use crate::daylight::cast::{Casting, cast};
use crate::daylight::{self, Exposure};
use crate::export::exposures;
use crate::job::Cancel;
use crate::rays::Rays;
use crate::scene::Scene;
use crate::sky::map::{ExposureMap, MapSettings};
use crate::sky::site::Outdoors;
use crate::sky::weather::Weather;
use anyhow::{Context, Result};
use serde::Serialize;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::Instant;

/// What `expose` takes.
#[derive(Debug, clap::Args)]
pub struct ExposeArgs {
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
    seconds: f64,
    method: &'static str,
    ghi: f64,
    dni: f64,
    dhi: f64,
    sensors: Vec<Row<'a>>,
    warnings: &'a [String],
}

/// A sensor of it: kWh/m2, and hours of sun.
#[derive(Serialize)]
struct Row<'a> {
    id: &'a str,
    beam: f64,
    sky: f64,
    reflected: f64,
    total: f64,
    error: f64,
    svf: f64,
    sun_h: f64,
    status: &'static str,
}

impl<'a> Row<'a> {
    fn new(id: &'a str, exposure: &Exposure) -> Self {
        Self {
            id,
            beam: exposure.beam_kwh_m2,
            sky: exposure.sky_kwh_m2,
            reflected: exposure.reflected_kwh_m2,
            total: exposure.total_kwh_m2(),
            error: exposure.error_kwh_m2,
            svf: exposure.svf,
            sun_h: exposure.sun_h,
            status: exposure.status.name(),
        }
    }
}

/// Runs the command.
///
/// # Errors
/// Bad input, a file that cannot be written, or an interrupt.
pub fn run(args: &ExposeArgs, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let mut folder = args.output.as_deref().map(Folder::new).transpose()?;
    start_threads(args.flags.threads.map(usize::from))?;
    let mut scene = Scene::load(&args.scene, &stages, cancel)?;
    let outdoors = outdoors(args, &mut scene, &stages, cancel)?;

    let begin = Instant::now();
    let steps = outdoors.steps_unless(cancel).with_context(|| scene.name.clone())?;
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&steps, &settings, &stages, cancel)?;
    let casting = Casting {
        sun_rays: args.sun_rays,
        sky_rays: args.sky_rays,
        seed: args.flags.seed.or(scene.model.seed).unwrap_or(0),
    };
    let rays = Rays::new(&scene);
    let found = cast(&rays, &daylight::points(&scene.sensors), &map, outdoors.north_rad, casting, &stages, cancel)?;
    let seconds = begin.elapsed().as_secs_f64();

    let mut warnings = [scene.warnings.as_slice(), &steps.warnings].concat();
    if scene.sensors.is_empty() {
        warnings.push("the scene has no sensor".into());
    }
    if args.flags.voxel.is_some() {
        warnings.push("--voxel has no part in exposure by rays".into());
    }
    warn(&warnings);
    outdoors.notes.iter().for_each(|note| tell(format_args!("note: {note}")));
    let rows: Vec<Row> = scene.sensors.iter().zip(&found).map(|(sensor, found)| Row::new(&sensor.id, found)).collect();
    let report = Report {
        scene: &scene.name,
        seconds,
        method: "rays",
        ghi: map.totals.ghi_kwh_m2,
        dni: map.totals.dni_kwh_m2,
        dhi: map.totals.dhi_kwh_m2,
        sensors: rows,
        warnings: &warnings,
    };
    let json = serde_json::to_string(&report)?;
    if let Some(folder) = &mut folder {
        folder.file("exposure.csv", |out| exposures::write_csv(out, &scene, &found))?;
        folder.file("exposure.json", |out| writeln!(out, "{json}"))?;
        folder.list();
    }
    if args.flags.json { say(&format!("{json}\n")) } else { say(&text(&report)) }
}

/// Where the scene stands, its weather read.
fn outdoors(args: &ExposeArgs, scene: &mut Scene, stages: &Stages, cancel: &Cancel) -> Result<Outdoors> {
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
    let mut table = Table::new(["sensor", "beam", "sky", "total", "+-", "svf", "sun, h", "status"]);
    for row in &report.sensors {
        let energies = [row.beam, row.sky, row.total, row.error].map(|energy| format!("{energy:.1}"));
        let seen = [format!("{:.3}", row.svf), format!("{:.0}", row.sun_h), row.status.to_owned()];
        table.row(std::iter::once(row.id.to_owned()).chain(energies).chain(seen).collect());
    }
    format!(
        "{}: kWh/m2 over the period; global horizontal {:.0}, direct normal {:.0}, diffuse horizontal {:.0}\n\
         by rays in {:.2} s; what surfaces reflect is not in it\n\n{table}",
        report.scene, report.ghi, report.dni, report.dhi, report.seconds
    )
}
