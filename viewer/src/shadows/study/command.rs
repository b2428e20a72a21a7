//! `lightvein-viewer shadows`: the methods measured on a scene's view under its sun, without a window.
//!
//! Table or JSON go to stdout, what is being done to stderr; files are written at the end, each whole or not at all.

use super::asks::{self, asks};
use super::errors::Judge;
use super::pictures::{self, Against};
use super::truth::{Truth, opaque_corners_m, truth};
use super::{Budget, Findings, Row, chart, measure, report};
use crate::app::write_png;
use crate::args::{Viewpoint, size, viewpoint};
use crate::camera::Camera;
use crate::outdoors::draw::Dome;
use crate::outdoors::sun::SunDay;
use crate::paint::Offscreen;
use crate::shadows::{Method, Studio, View};
use anyhow::{Context, Result, bail};
use glam::Vec3;
use jiff::civil::{Date, DateTime, Time, date};
use lightvein::export::whole_file;
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::Scene;
use lightvein::sky::Sun;
use lightvein::sky::site::Outdoors;
use lightvein::sky::sun::{Air, position};
use lightvein::sky::weather::Weather;
use serde_json::{Value, json};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Measures shadow methods on a view of a scene under its sun: time, memory and errors against rays.
#[derive(Debug, Clone, clap::Args)]
pub struct ShadowArgs {
    /// Scene file (TOML) with a site.
    pub scene: PathBuf,

    /// The day; by default the one that the window opens with.
    #[arg(long, value_name = "YYYY-MM-DD", default_value_t = date(2025, 6, 21))]
    pub date: Date,

    /// The time, local standard time.
    #[arg(long, value_name = "HH:MM", default_value = "12:00")]
    pub time: Time,

    /// Where it is seen from: front, right, top, back, left, bottom, oblique, or the eye and what it looks at, metres, as
    /// `x,y,z:x,y,z`.
    #[arg(long, value_name = "CAMERA", allow_hyphen_values = true, value_parser = viewpoint)]
    pub camera: Option<Viewpoint>,

    /// Size of the view, pixels.
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "640x480")]
    pub size: [u32; 2],

    /// The methods, with commas between: plain, pcf, vsm, lvsm, csm, hsm, hsm-light.
    #[arg(long, value_name = "METHODS", value_delimiter = ',', value_parser = asks::method)]
    pub methods: Vec<Method>,

    /// Texels a side of the maps, with commas between.
    #[arg(long, value_name = "SIDES", value_delimiter = ',', value_parser = asks::resolution)]
    pub resolutions: Vec<u32>,

    /// Layers of the layered methods, with commas between; by default some for each method.
    #[arg(long, value_name = "LAYERS", value_delimiter = ',', value_parser = asks::layers)]
    pub layers: Vec<usize>,

    /// One JSON object on stdout instead of tables.
    #[arg(long)]
    pub json: bool,

    /// Writes table, chart and pictures into this folder.
    #[arg(short = 'o', long = "out", value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What is measured: a view, its sun and what casts.
struct Setting {
    scene: Scene,
    moment: DateTime,
    sun: Sun,
    view: View,
    corners_m: Vec<Vec3>,
}

/// Measures, tells and writes.
///
/// # Errors
/// A scene that cannot be read, has no site or nothing opaque; a sun below the horizon; no graphics adapter; a folder that cannot be
/// written into; [`lightvein::job::Cancelled`].
pub fn run(args: &ShadowArgs, cancel: &Cancel) -> Result<()> {
    if let Some(out) = &args.out {
        check_folder(out)?;
    }
    let setting = Setting::of(args, cancel)?;
    let offscreen = Offscreen::new()?;
    eprintln!("drawn with {}", offscreen.adapter());

    let begun = Instant::now();
    let truth = truth(&setting.corners_m, &setting.view, cancel)?;
    let truth_seconds = begun.elapsed().as_secs_f64();
    eprintln!("the truth by rays took {truth_seconds:.1} s");
    let mut studio = Studio::new(&offscreen, &setting.corners_m);
    let findings = measured(args, &mut studio, &setting, &truth, cancel)?;

    cancel.check()?;
    let mut files = Vec::new();
    if let Some(out) = &args.out {
        files = write(out, &truth, &findings, &offscreen.adapter())?;
    }
    let text = if args.json {
        let told = setting.json(&findings, &offscreen.adapter(), truth_seconds, &files);
        serde_json::to_string_pretty(&told)? + "\n"
    } else {
        setting.words() + "\n\n" + &report::table(&findings)
    };
    // Who closed the pipe early has had enough.
    let _ = std::io::stdout().write_all(text.as_bytes());
    files.iter().for_each(|file| eprintln!("wrote {}", file.display()));
    Ok(())
}

impl Setting {
    fn of(args: &ShadowArgs, cancel: &Cancel) -> Result<Self> {
        let scene = Scene::load(&args.scene, &Quiet, cancel)?;
        scene.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
        let path = args.scene.display();
        let Some(site) = &scene.site else {
            bail!(
                "{path}: there is no [site], so nobody knows where its sun stands; a scene file names latitude_deg and \
                 longitude_deg there"
            );
        };
        let weather = site.weather.as_ref().map(|file| Weather::load(file, &Quiet, cancel)).transpose()?;
        let outdoors = Outdoors::of(site, weather).with_context(|| format!("{path}: [site]"))?;
        let moment = args.date.to_datetime(args.time);
        let sun = position(&outdoors.place, moment, Some(Air::STANDARD))?;
        if sun.elevation_rad <= 0.0 {
            let day = SunDay::of(outdoors.place, args.date)?;
            bail!(
                "the sun is {:.1} degrees below the horizon on {} at {}, and casts no shadows. {}",
                -sun.elevation_rad.to_degrees(),
                args.date,
                args.time.strftime("%H:%M"),
                day.words()
            );
        }
        let corners_m = opaque_corners_m(&scene);
        let bounds_m = scene.mesh.bounds_m().filter(|_| !corners_m.is_empty());
        let bounds_m = bounds_m.with_context(|| format!("{path}: there is nothing opaque to cast a shadow"))?;

        let towards_sun =
            Dome { middle_m: Vec3::ZERO, radius_m: 1.0, north_rad: outdoors.north_rad }.direction(sun.towards());
        let aspect = args.size[0] as f32 / args.size[1] as f32;
        let fitted = || Camera::fitted(bounds_m, aspect);
        let camera = args.camera.map_or_else(fitted, |viewpoint| viewpoint.camera(scene.origin_m, bounds_m, aspect));
        let view = View { camera, size_px: args.size, towards_sun };
        Ok(Self { scene, moment, sun, view, corners_m })
    }

    /// In a line.
    fn words(&self) -> String {
        let [wide, high] = self.view.size_px;
        format!(
            "{}, {}: the sun {:.1} degrees up, {:.1} degrees from true north; {} triangles, {wide} x {high} pixels",
            self.scene.name,
            self.moment.strftime("%Y-%m-%d %H:%M"),
            self.sun.elevation_rad.to_degrees(),
            self.sun.azimuth_rad.to_degrees(),
            self.corners_m.len() / 3
        )
    }

    fn json(&self, findings: &Findings, adapter: &str, truth_seconds: f64, files: &[PathBuf]) -> Value {
        let point = |point_m: Vec3| self.scene.to_user_m(point_m).to_array();
        let camera = &self.view.camera;
        json!({
            "scene": self.scene.name,
            "moment": self.moment.strftime("%Y-%m-%dT%H:%M").to_string(),
            "sun": {
                "azimuth_deg": self.sun.azimuth_rad.to_degrees(),
                "elevation_deg": self.sun.elevation_rad.to_degrees(),
            },
            "view": {
                "eye_m": point(camera.eye_m()),
                "target_m": point(camera.target_m),
                "field_of_view_deg": camera.field_of_view_rad.to_degrees(),
                "size_px": self.view.size_px,
            },
            "triangles": self.corners_m.len() / 3,
            "adapter": adapter,
            "truth_seconds": truth_seconds,
            "rows": report::rows_json(&findings.rows),
            "summary": report::summary_json(&findings.summary),
            "files": files,
        })
    }
}

/// All rows that were asked for.
fn measured(
    args: &ShadowArgs,
    studio: &mut Studio,
    setting: &Setting,
    truth: &Truth,
    cancel: &Cancel,
) -> Result<Findings> {
    let judge = Judge::new(truth);
    if !truth.pixels.iter().flatten().any(|seen| seen.sun.is_some()) {
        eprintln!("warning: nothing in view faces the sun: there are times, but no errors");
    }
    let or_default = |given: &[u32], default: Vec<u32>| if given.is_empty() { default } else { given.to_vec() };
    let default = asks::Extent::default();
    let extent = asks::Extent {
        methods: if args.methods.is_empty() { default.methods } else { args.methods.clone() },
        resolutions: or_default(&args.resolutions, default.resolutions),
        layers: (!args.layers.is_empty()).then(|| args.layers.clone()),
    };
    // On a terminal the line is written anew; elsewhere a line a row.
    let end = if std::io::stderr().is_terminal() { "\x1b[K\r" } else { "\n" };
    let mut hear = |row: &Row, [number, of]: [usize; 2]| {
        eprint!("{number} of {of}: {}: {:.1} ms a frame{end}", row.ask.words(), row.frame_ms);
    };
    let findings = measure(studio, &setting.view, &judge, &asks(&extent), &Budget::default(), cancel, &mut hear)?;
    if end != "\n" {
        eprint!("\x1b[K");
    }
    Ok(findings)
}

/// What would stop the writing at the end shows here: a file where a folder is to be.
fn check_folder(out: &Path) -> Result<()> {
    match out.ancestors().find(|part| part.exists() && !part.is_dir()) {
        Some(there) => bail!("{}: the folder cannot be made: {} is not a folder", out.display(), there.display()),
        None => Ok(()),
    }
}

/// Writes table, chart and pictures; gives their paths.
fn write(out: &Path, truth: &Truth, findings: &Findings, adapter: &str) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(out).with_context(|| format!("{}: the folder cannot be made", out.display()))?;
    let mut files = Vec::new();
    let mut path = |name: &str| {
        files.push(out.join(name));
        out.join(name)
    };
    let of_writer = |path: &Path| format!("{}: cannot be written", path.display());
    let csv = path("shadows.csv");
    whole_file(&csv, |out| report::write_csv(out, &findings.rows)).with_context(|| of_writer(&csv))?;
    let svg = path("shadows.svg");
    whole_file(&svg, |out| chart::write_svg(out, findings, adapter)).with_context(|| of_writer(&svg))?;
    write_png(&path("truth.png"), &pictures::of_truth(truth, Against::Hard))?;
    write_png(&path("truth_disc.png"), &pictures::of_truth(truth, Against::Disc))?;
    for (at, lit) in &findings.best {
        let Some(row) = findings.rows.get(*at) else { continue };
        let name = row.ask.method.name();
        write_png(&path(&format!("{name}.png")), &pictures::of_method(truth, lit))?;
        write_png(&path(&format!("{name}_difference.png")), &pictures::of_difference(truth, lit, Against::Hard))?;
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Args, Command};
    use crate::outdoors::OutdoorState;
    use clap::Parser;
    use jiff::civil::time;

    fn parsed(line: &str) -> Result<ShadowArgs, String> {
        let args = Args::try_parse_from(line.split(' ')).map_err(|error| error.to_string())?;
        match args.command {
            Some(Command::Shadows(args)) => Ok(args),
            None => Err("no command".to_owned()),
        }
    }

    #[test]
    fn without_flags_the_moment_is_the_windows() {
        let args = parsed("viewer shadows scene.toml").unwrap();
        assert_eq!(args.date.to_datetime(args.time), OutdoorState::default().moment());
        assert_eq!((args.size, args.time), ([640, 480], time(12, 0, 0, 0)));
        assert!(args.methods.is_empty() && args.layers.is_empty() && args.out.is_none());
    }

    #[test]
    fn lists_are_parsed_and_bounded() {
        let args = parsed("viewer shadows s.toml --methods vsm,hsm --resolutions 128,256 --layers 2,3 --json -o out");
        let args = args.unwrap();
        assert_eq!(args.methods, [Method::Vsm, Method::Hsm]);
        assert_eq!((args.resolutions, args.layers, args.json), (vec![128, 256], vec![2, 3], true));
        for (line, told) in [
            ("viewer shadows s.toml --methods vms", "is no shadow method"),
            ("viewer shadows s.toml --layers 17", "1 to 16"),
            ("viewer shadows s.toml --resolutions 5000", "16 to 4096"),
            ("viewer shadows s.toml --time 25:00", "--time"),
            ("viewer shadows", "SCENE"),
        ] {
            let error = parsed(line).unwrap_err();
            assert!(error.contains(told), "{line}: {error}");
        }
    }

    #[test]
    fn the_window_is_still_opened_by_a_scene_alone() {
        let args = Args::try_parse_from(["viewer", "scene.toml", "--view-only"]).unwrap();
        assert!(args.command.is_none() && args.scene.is_some());
        assert!(Args::try_parse_from(["viewer", "--view-only", "shadows", "scene.toml"]).is_err());
    }
}
