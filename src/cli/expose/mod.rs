//! The command `expose`: what a scene receives from sun and sky over a period: at its sensors, on its faces, at its
//! vertices, or wherever a camera looks.

pub mod args;
mod places;
mod report;
mod update;

use super::run::{say, start_threads, warn};
use super::stages::Stages;
use super::tell;
use super::write::Folder;
use crate::daylight::cast::Casting;
use crate::daylight::choose::{Chosen, choose};
use crate::daylight::way::{Ground, Way};
use crate::export::exposures::mesh::Colours;
use crate::export::exposures::span;
use crate::job::Cancel;
use crate::rays::Rays;
use crate::scene::Scene;
use crate::sky::map::{ExposureMap, MapSettings};
use crate::sky::site::Outdoors;
use anyhow::{Context, Result};
use args::At;
pub use args::ExposeArgs;
use places::Places;
use report::{Found, Report, Update};
use std::io::IsTerminal;
use std::time::Instant;
use update::{Before, odd, typed};

/// Runs the command.
///
/// # Errors
/// Bad input, a file that cannot be written, or an interrupt.
pub fn run(args: &ExposeArgs, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let mut folder = args.output.as_deref().map(Folder::new).transpose()?;
    start_threads(args.flags.threads.map(usize::from))?;
    let mut scene = Scene::load(&args.scene, &stages, cancel)?;
    let outdoors = args.site.outdoors(&mut scene, &args.scene, &stages, cancel)?;
    let at = places::at(args, &scene)?;
    let camera = places::camera(args, at, &scene)?;
    let edits = args.edits.all();
    let changes = scene.changes(&edits).with_context(|| args.scene.display().to_string())?;

    let begin = Instant::now();
    let steps = outdoors.steps_unless(cancel).with_context(|| scene.name.clone())?;
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&steps, &settings, &stages, cancel)?;
    let seed = args.flags.seed.or(scene.model.seed).unwrap_or(0);
    let way = places::way(args, at, seed)?;
    let begin_rays = Instant::now();
    let rays = Rays::new(&scene);
    let places = Places::of(args, at, camera.as_ref(), &scene, &rays, &stages, cancel)?;
    let north_rad = outdoors.north_rad;
    let ground = Ground { scene: &scene, rays: &rays, map: &map, north_rad, seed };
    let (asked, buffers) = (places.asked(), places.buffers());
    let chosen = match way {
        Some(way) => Chosen { way: way.prepare(&ground, cancel)?, tried: Vec::new() },
        None => {
            let tolerance = places::tolerance(args, at, &scene);
            choose(&ground, asked, buffers, &places::ways(at, seed), tolerance, &stages, cancel)?
        }
    };
    let exposures = chosen.way.ask(&ground, asked, buffers, &stages, cancel)?;
    let [seconds, full_seconds] = [begin, begin_rays].map(|begin| begin.elapsed().as_secs_f64());

    let mut warnings = [scene.warnings.as_slice(), &steps.warnings, &odd(&scene, &changes)].concat();
    let casting = if let Way::Rays(casting) = chosen.way.way { casting } else { Casting::default() };
    let before =
        Before { scene: &scene, rays: &rays, places: &places, exposures: &exposures, map: &map, north_rad, casting };
    let after = (!edits.is_empty()).then(|| before.after(changes, &stages, cancel)).transpose()?;

    if places.points.is_empty() {
        warnings.push(nothing(at).into());
    }
    if args.flags.voxel.is_some() {
        warnings.push("--voxel has no part in exposure by rays".into());
    }
    warn(&warnings);
    outdoors.notes.iter().for_each(|note| tell(format_args!("note: {note}")));

    let colours = Colours { quantity: args.show, span: span(args.show, &exposures) };
    let [mut files, mut files_after] = [Vec::new(), Vec::new()];
    if let Some(folder) = &mut folder {
        let (title, note) = titles(args, &scene, &outdoors, &map);
        files = places.write(folder, "exposure", &scene, &exposures, colours, [&title, &note])?;
        if let Some(after) = &after {
            let title = format!("{title}, after {}", edits.iter().map(typed).collect::<Vec<_>>().join(", "));
            let name = "exposure_after";
            files_after = after.places.write(folder, name, &scene, &after.exposures, colours, [&title, &note])?;
        }
    }
    let found = Found::new(&scene, at, &places, &exposures, &files);
    let update = after.as_ref().map(|after| Update {
        edits: edits.iter().map(typed).collect(),
        parts: after.changed[0],
        triangles: after.changed[1],
        count: after.places.points.len(),
        again: after.again,
        seconds: after.seconds,
        full_seconds,
        found: Found::new(&scene, at, &after.places, &after.exposures, &files_after),
    });
    let report = Report::new(&scene, at, &map, seconds, &chosen, found, &warnings).with(update);
    let json = serde_json::to_string(&report)?;
    if let Some(folder) = &mut folder {
        folder.file("exposure.json", |out| writeln!(out, "{json}"))?;
        folder.list();
    }
    if args.flags.json { say(&format!("{json}\n")) } else { say(&report.text()) }
}

/// Why there is no point.
fn nothing(at: At) -> &'static str {
    match at {
        At::Sensors => "the scene has no sensor",
        At::Faces | At::Vertices => "the scene has no face",
        At::Camera => "the camera sees nothing of the scene",
    }
}

/// What stands above a picture: what it shows of which scene, and of which period.
fn titles(args: &ExposeArgs, scene: &Scene, outdoors: &Outdoors, map: &ExposureMap) -> (String, String) {
    let day = |(month, day): (i8, i8)| format!("{month:02}-{day:02}");
    let totals = map.totals;
    let note = format!(
        "{} to {}; in the open, kWh/m²: global horizontal {:.0}, direct normal {:.0}, diffuse horizontal {:.0}",
        day(outdoors.period.first),
        day(outdoors.period.last),
        totals.ghi_kwh_m2,
        totals.dni_kwh_m2,
        totals.dhi_kwh_m2
    );
    (format!("{}: {}", scene.name, args.show.title()), note)
}
