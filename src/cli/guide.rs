//! The command `guide`: everything that a renderer can be seeded with, as files.

use super::args::{Common, Flags};
use super::report::stage_table;
use super::run::{NO_SENSOR, open, prepare, say, warn};
use super::stages::Stages;
use super::table::Table;
use super::write::Folder;
use crate::export::guide::{Guided, files};
use crate::guide::known::QUALITY;
use crate::guide::{Guide, guide};
use crate::job::{Cancel, Progress};
use crate::light::Settings;
use anyhow::Result;
use serde::Serialize;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::Instant;

/// What `guide` takes.
#[derive(Debug, clap::Args)]
pub struct GuideArgs {
    /// A scene file (.toml), or a mesh (.obj .gltf .glb .ply .stl)
    pub scene: PathBuf,
    #[command(flatten)]
    pub flags: Flags,
    /// Folder for the files; made if it is not there
    #[arg(short, long = "output", value_name = "DIR", required = true)]
    pub output: PathBuf,
}

/// `guide --json`.
#[derive(Debug, Serialize)]
struct Report<'a> {
    seconds: f64,
    nodes: usize,
    wall_points: usize,
    necks: usize,
    vpls: usize,
    files: &'a [&'static str],
}

/// Runs the command.
///
/// # Errors
/// Bad input, a file that cannot be written, or an interrupt.
pub fn run(args: GuideArgs, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let common = Common { scene: args.scene, tolerance: None, flags: args.flags, output: None };
    let mut folder = Folder::new(&args.output)?;
    let (mut scene, plan) = open(&common, None, Settings::default(), &stages, cancel)?;

    let began = Instant::now();
    let (model, mut warnings) = prepare(&mut scene, &plan, &stages, cancel)?;
    let seeded = guide(&model, &QUALITY, &plan.settings, &stages, cancel)?;
    let seconds = began.elapsed().as_secs_f64();
    let found = &seeded.guide;
    // A guide needs no sensor, so a scene is not blamed for having none.
    warnings.retain(|warning| warning != NO_SENSOR);
    warnings.extend(found.warnings.iter().cloned());
    warn(&warnings);

    cancel.check()?;
    stages.begin("files", 0);
    let mut names = Vec::new();
    for (name, write) in files(Guided { scene: &scene, model: &model, guide: found }) {
        folder.file(name, write)?;
        names.push(name);
    }
    stages.end();
    folder.list();
    if common.flags.json {
        let report = Report {
            seconds,
            nodes: found.nodes.len(),
            wall_points: found.walls.len(),
            necks: found.necks.len(),
            vpls: found.vpls.len(),
            files: &names,
        };
        return say(&format!("{}\n", serde_json::to_string(&report)?));
    }
    say(&format!(
        "{}: voxels of {} m, seeded in {seconds:.4} s\n\n{}\n{}",
        scene.name,
        model.voxels.lattice.voxel_m,
        counts(found),
        stage_table(&stages.ended())
    ))
}

/// How many there are of each.
fn counts(guide: &Guide) -> Table {
    let Guide { nodes, walls, necks, vpls, probes, cache, samples, .. } = guide;
    let mut table = Table::new(["seeds", "count"]);
    let rows = [
        ("nodes of the skeleton", nodes.len()),
        ("points on walls", walls.len()),
        ("necks", necks.len()),
        ("virtual lights", vpls.len()),
        ("probes", probes.len()),
        ("cache records", cache.len()),
        ("training samples", samples.len()),
    ];
    rows.iter().for_each(|(what, count)| table.row(vec![(*what).to_owned(), count.to_string()]));
    table
}
