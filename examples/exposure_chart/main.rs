//! How fast and how far off is each way to exposure? The chart and the table of `docs/charts`, for `docs/daylight.md`.
//!
//!     cargo run --release --example exposure_chart -- [SCENE.toml ...] [--weather WEATHER.epw] [--out FOLDER]
//!         [--radiance PATH/radiance_annual.py]
//!
//! Without scenes: `blocks`, `arcades`, and Ingolstadt where its mesh lies beside the project. One run measures all: at the
//! scene's [sensors], points a second, and the error of the exposure and of the sky view factor against rays to every sun
//! and 65,536 directions; at the pixels of a close [view] the same, where there is a fine scale too; and, if the script is
//! named, [radiance] at the sensors, which needs Python with pyradiance and numpy, and a weather file. Medians of five runs;
//! what is made beforehand is timed apart. Some minutes.

mod measure;
mod radiance;
mod sensors;
mod view;

use lightvein::daylight::way::Ground;
use lightvein::export::chart::loglog::{self, Mark, Panel, front};
use lightvein::export::whole_file;
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::weather::Weather;
use measure::Row;
use std::error::Error;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Scenes where none is named.
const SCENES: [&str; 3] =
    ["scenes/outdoor/blocks/blocks.toml", "scenes/outdoor/arcades/arcades.toml", "scenes/real/ingolstadt.toml"];

/// What was asked for.
struct Options {
    scenes: Vec<PathBuf>,
    weather: Option<PathBuf>,
    radiance: Option<PathBuf>,
    out: PathBuf,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    let mut charts = Vec::new();
    for path in &options.scenes {
        match Scene::load(path, &Quiet, &Cancel::new()) {
            Ok(scene) => charts.push((scene.name.clone(), rows(&scene, &options)?)),
            Err(error) => eprintln!("skipped: {error}"),
        }
    }
    let panels = ["sensors", "pixels"].map(|at| charts.iter().map(move |(name, rows)| panel(name, at, rows)));
    let panels: Vec<Panel> = panels.into_iter().flatten().collect();
    let says = "right and down is better; ringed: best at its speed; hollow: smoothed";
    whole_file(&options.out.join("exposure.svg"), |out| loglog::write(out, &panels, charts.len(), says))?;
    whole_file(&options.out.join("exposure.csv"), |out| write_table(out, &charts))?;
    Ok(())
}

fn options() -> Result<Options, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut options = Options { scenes: Vec::new(), weather: None, radiance: None, out: root.join("docs/charts") };
    let mut args = std::env::args_os().skip(1).map(PathBuf::from);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or_else(|| format!("{} needs a path behind it", arg.display()));
        match arg.to_str() {
            Some("--weather") => options.weather = Some(value()?),
            Some("--radiance") => options.radiance = Some(value()?),
            Some("--out") => options.out = value()?,
            Some(flag) if flag.starts_with("--") => return Err(format!("{flag} is not known").into()),
            _ => options.scenes.push(arg),
        }
    }
    if options.radiance.is_some() && options.weather.is_none() {
        return Err("--radiance needs --weather".into());
    }
    if options.scenes.is_empty() {
        options.scenes = SCENES.iter().map(|scene| root.join(scene)).collect();
    }
    Ok(options)
}

/// All that is measured in a scene.
fn rows(scene: &Scene, options: &Options) -> Result<Vec<Row>, Box<dyn Error>> {
    let quiet = (&Quiet, &Cancel::new());
    let weather = options.weather.as_ref().map(|path| Weather::load(path, quiet.0, quiet.1)).transpose()?;
    let outdoors = Outdoors::of(&scene.site.clone().unwrap_or_default(), weather)?;
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&outdoors.steps()?, &settings, quiet.0, quiet.1)?;
    let rays = Rays::new(scene);
    let ground = Ground { scene, rays: &rays, map: &map, north_rad: outdoors.north_rad, seed: 0 };
    println!(
        "\n{}: {} triangles, {} sensors, {} suns, {} threads",
        scene.name,
        scene.mesh.triangles.len(),
        scene.sensors.len(),
        map.suns.len(),
        rayon::current_num_threads()
    );
    let (truth, mut rows) = sensors::rows(&ground)?;
    if let (Some(script), Some(weather)) = (&options.radiance, &options.weather) {
        rows.extend(radiance::rows(scene, script, weather, &truth)?);
    }
    rows.extend(view::rows(&ground)?);
    Ok(rows)
}

fn panel(scene: &str, at: &str, rows: &[Row]) -> Panel {
    let marks = rows.iter().filter(|row| row.at == at).map(|row| Mark {
        series: row.series.to_owned(),
        label: row.quality.clone(),
        at: [row.per_s, 100.0 * row.rmse],
        is_hollow: row.is_smooth,
    });
    let place = if at == "sensors" { "at sensors" } else { "at the pixels of a close view" };
    Panel {
        title: format!("{scene}, {place}"),
        axes: [format!("{at} a second"), "RMSE, % of the mean exposure".to_owned()],
        marks: marks.collect(),
        has_front: true,
    }
}

/// A row a measurement: `made_s` is what was made beforehand, `rmse` a share of the mean, `best` whether it lies on the front.
fn write_table(out: &mut dyn Write, charts: &[(String, Vec<Row>)]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["scene", "at", "way", "quality", "smooth", "made_s", "per_s", "rmse", "svf_mae", "best"])?;
    for (scene, rows) in charts {
        for at in ["sensors", "pixels"] {
            let its: Vec<&Row> = rows.iter().filter(|row| row.at == at).collect();
            let best = front(&its.iter().map(|row| [row.per_s, row.rmse]).collect::<Vec<_>>());
            for (row, best) in its.into_iter().zip(best) {
                table.write_record([
                    scene.clone(),
                    at.to_owned(),
                    row.series.to_owned(),
                    row.quality.clone(),
                    row.is_smooth.to_string(),
                    format!("{:.4}", row.made_s),
                    format!("{:.0}", row.per_s),
                    format!("{:.5}", row.rmse),
                    row.svf.map_or_else(String::new, |svf| format!("{svf:.5}")),
                    best.to_string(),
                ])?;
            }
        }
    }
    table.flush()
}
