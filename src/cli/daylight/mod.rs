//! The command `daylight`: exposure from sun and sky with what surfaces reflect, outdoors and in rooms, and the illuminance
//! and daylight factor that go with it.

mod report;

use super::args::Flags;
use super::plan::Plan;
use super::run::{most_bytes, say, start_threads, warn};
use super::sky::args::{self, SiteArgs};
use super::stages::Stages;
use super::tell;
use super::write::Folder;
use crate::daylight::cast::{Casting, cast};
use crate::daylight::choose::choose;
use crate::daylight::reflect::choose::by_fitting_network;
use crate::daylight::reflect::heuristics::by_heuristic;
use crate::daylight::reflect::openings::open_cells;
use crate::daylight::reflect::skylight::Skylight;
use crate::daylight::reflect::{self, Reflected, by_nothing};
use crate::daylight::way::{Ground, Way};
use crate::daylight::{self, Exposure, Point};
use crate::export;
use crate::job::Cancel;
use crate::light::Settings;
use crate::model::Model;
use crate::model::choose::choose_voxel_m;
use crate::rays::Rays;
use crate::scene::{Material, Method, Scene};
use crate::sky::efficacy::Efficacies;
use crate::sky::map::{ExposureMap, MapSettings};
use crate::sky::moment::steps_at;
use crate::sky::site::Outdoors;
use crate::sky::steps::Steps;
use crate::voxel::closed;
use anyhow::{Context, Result};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use jiff::civil::{Date, DateTime, Time};
use report::{Found, Modelled, Report, text};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// The methods that carry what is reflected.
const METHODS: [Method; 4] = [Method::Backward, Method::Forward, Method::Diffusion, Method::Network];

/// The tolerance where none is named.
const TOLERANCE: f64 = 1.02;

/// What `daylight` takes.
#[derive(Debug, clap::Args)]
pub struct DaylightArgs {
    /// A scene file (.toml) with sensors and a [site]
    pub scene: PathBuf,
    /// What carries light that was reflected; all but network are previews of rooms alone
    #[arg(long, value_parser = method(), default_value_t = Method::Network)]
    pub method: Method,
    /// A moment of this day instead of a period, YYYY-MM-DD; of weather the same day of its year
    #[arg(long, value_parser = args::date, requires = "time", conflicts_with_all = ["start", "end", "step_min"])]
    pub date: Option<Date>,
    /// The moment, HH:MM in local standard time
    #[arg(long, value_parser = args::time, requires = "date")]
    pub time: Option<Time>,
    #[command(flatten)]
    pub site: SiteArgs,
    /// Factor within which daylight is to be right, above 1: of sun and sky the RMSE, of what is reflected the network's own error,
    /// as shares of the mean; by default what the scene says, else 1.02
    #[arg(long, value_name = "F", value_parser = crate::cli::args::factor)]
    pub tolerance: Option<f64>,
    /// Suns of the period that a sensor looks at, whatever the tolerance
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub sun_rays: Option<u32>,
    /// Directions of the sky at a sensor, whatever the tolerance
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=1 << 24))]
    pub sky_rays: Option<u32>,
    #[command(flatten)]
    pub flags: Flags,
    /// Folder for the files; made if it is not there
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// A method by its name.
fn method() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(METHODS.map(Method::name)).try_map(|name| Method::from_name(&name).ok_or("not a method"))
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
    let outdoors = args.site.outdoors(&mut scene, &args.scene, &stages, cancel)?;
    let plan = Plan::new(&args.flags, None, Some(args.method), Settings::default(), &scene.model);
    let rays = Arc::new(Rays::new(&scene));

    let begin = Instant::now();
    let model = if is_black(&scene) { None } else { Some(modelled(&scene, &plan, &rays, &stages, cancel)?) };
    let prepare_seconds = begin.elapsed().as_secs_f64();
    let (voxel_m, mut notes, warnings) = told(&scene, model.as_ref(), args.method);

    let begin = Instant::now();
    let moment = args.date.zip(args.time).map(|(date, time)| date.to_datetime(time));
    let steps = steps(&outdoors, moment, cancel).with_context(|| scene.name.clone())?;
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&steps, &settings, &stages, cancel)?;
    let points = daylight::points(&scene.sensors);
    let seed = plan.settings.seed;
    let north_rad = outdoors.north_rad;
    let ground = Ground { scene: &scene, rays: &rays, map: &map, north_rad, seed };
    let tolerance = args.tolerance.or(scene.model.tolerance).unwrap_or(TOLERANCE);
    let (casting, mut modelled) = casting(args, &ground, &points, tolerance, &stages, cancel)?;
    let mut exposures = cast(&rays, &points, &map, north_rad, casting, &stages, cancel)?;
    let light = Skylight::new(&map, north_rad);
    let asked =
        Asked { method: args.method, points: &points, exposures: &exposures, light: &light, casting, tolerance };
    let (reflected, networks) = reflected(model, &rays, &asked, &stages, cancel)?;
    if networks.last().is_some_and(|last| last.error > tolerance - 1.0) {
        notes.push(format!("no network is inside the tolerance of {tolerance} by its own error: the finest is taken"));
    }
    modelled.extend(networks);
    reflect::add(&mut exposures, &reflected);
    let seconds = begin.elapsed().as_secs_f64();

    let warnings = [warnings, steps.warnings.clone()].concat();
    warn(&warnings);
    outdoors.notes.iter().chain(&notes).for_each(|note| tell(format_args!("note: {note}")));
    let efficacies = Efficacies::mean(&steps.steps);
    let lit_h = steps.steps.iter().map(|step| step.hours).sum();
    let found = Found { exposures: &exposures, reflected: &reflected, efficacies, lit_h };
    let report = Report {
        scene: &scene.name,
        method: args.method.name(),
        moment: moment.map(|moment| moment.to_string()),
        voxel_m,
        prepare_seconds,
        seconds,
        ghi: map.totals.ghi_kwh_m2,
        dni: map.totals.dni_kwh_m2,
        dhi: map.totals.dhi_kwh_m2,
        lit_h,
        beam_lm_w: efficacies.beam_lm_w,
        sky_lm_w: efficacies.sky_lm_w,
        sensors: found.rows(&scene),
        modelled: &modelled,
        notes: &notes,
        warnings: &warnings,
    };
    let json = serde_json::to_string(&report)?;
    if let Some(folder) = &mut folder {
        folder.file("daylight.csv", |out| export::daylight::write_csv(out, &scene, &exposures, &found.seen()))?;
        folder.file("daylight.json", |out| writeln!(out, "{json}"))?;
        folder.list();
    }
    if args.flags.json { say(&format!("{json}\n")) } else { say(&text(&report)) }
}

/// The rays that are typed, else the fewest inside the tolerance, and what was tried for it.
fn casting(
    args: &DaylightArgs,
    ground: &Ground,
    points: &[Point],
    tolerance: f64,
    stages: &Stages,
    cancel: &Cancel,
) -> Result<(Casting, Vec<Modelled>)> {
    let truth = Casting { seed: ground.seed, ..Casting::default() };
    if args.sun_rays.is_some() || args.sky_rays.is_some() {
        let sky_rays = args.sky_rays.unwrap_or(truth.sky_rays);
        return Ok((Casting { sun_rays: args.sun_rays, sky_rays, ..truth }, Vec::new()));
    }
    let by_rays = Way::for_points(ground.seed).map(|way| if let Way::Rays(_) = way { Some(way) } else { None });
    let ways: Vec<Way> = by_rays.into_iter().flatten().collect();
    let chosen = choose(ground, daylight::cast::Asked::all(points), None, &ways, tolerance, stages, cancel)?;
    let tried = chosen.tried.iter().map(|tried| Modelled { what: tried.way.words(), error: tried.error });
    let casting = if let Way::Rays(casting) = chosen.way.way { casting } else { truth };
    Ok((casting, tried.collect()))
}

/// The steps of the period, or of a moment.
fn steps(outdoors: &Outdoors, moment: Option<DateTime>, cancel: &Cancel) -> Result<Steps> {
    Ok(match moment {
        Some(moment) => steps_at(outdoors, moment, cancel)?,
        None => outdoors.steps_unless(cancel)?,
    })
}

/// Whether no surface of a scene sends anything back.
fn is_black(scene: &Scene) -> bool {
    scene.materials.iter().all(|material: &Material| material.reflects() <= 0.0)
}

fn modelled(scene: &Scene, plan: &Plan, rays: &Arc<Rays>, stages: &Stages, cancel: &Cancel) -> Result<Model> {
    if let Some(voxel_m) = plan.voxel_m {
        return Ok(Model::build(scene, rays.clone(), voxel_m, most_bytes(), stages, cancel)?);
    }
    let chosen = choose_voxel_m(scene, rays, most_bytes(), stages, cancel)?;
    tell(chosen.reason);
    Ok(chosen.model)
}

/// The voxels' size, what was modelled or not and why, and what to be warned of. That the void reaches the box around the mesh
/// is as it should be here, and sensors need no void.
fn told(scene: &Scene, model: Option<&Model>, method: Method) -> (Option<f32>, Vec<String>, Vec<String>) {
    let mut warnings = scene.warnings.clone();
    let mut notes = Vec::new();
    if scene.sensors.is_empty() {
        warnings.push("the scene has no sensor".into());
    }
    let Some(model) = model else {
        notes.push("no surface reflects: there are no voxels and no skeleton, beam and sky alone are by rays".into());
        return (None, notes, warnings);
    };
    let voxel_m = model.voxels.lattice.voxel_m;
    warnings.extend(closed::warning(&model.voxels.closed, scene, voxel_m));
    if !open_cells(model).contains(&true) {
        notes.push("the void of the sensors is sealed: no sky reaches it".into());
    }
    if method != Method::Network {
        warnings.push(format!("{method} is a preview of rooms: what surfaces outdoors reflect is not in it"));
    }
    (Some(voxel_m), notes, warnings)
}

/// What is asked of a model.
struct Asked<'a> {
    method: Method,
    points: &'a [Point],
    exposures: &'a [Exposure],
    light: &'a Skylight<'a>,
    casting: Casting,
    tolerance: f64,
}

fn reflected(
    model: Option<Model>,
    rays: &Rays,
    asked: &Asked,
    stages: &Stages,
    cancel: &Cancel,
) -> Result<(Vec<Reflected>, Vec<Modelled>)> {
    let &Asked { method, points, exposures, light, casting, tolerance } = asked;
    let model = match model {
        None => return Ok((by_nothing(rays, points, light, casting, cancel)?, Vec::new())),
        Some(model) if method == Method::Network => model,
        Some(model) => {
            let found = by_heuristic(method, model, (points, exposures), light, casting, stages, cancel)?;
            return Ok((found, Vec::new()));
        }
    };
    let (found, tried) = by_fitting_network(&model, points, exposures, light, casting, tolerance, stages, cancel)?;
    let tried = tried.into_iter().map(|tried| Modelled { what: tried.name.to_owned(), error: tried.error });
    Ok((found, tried.collect()))
}
