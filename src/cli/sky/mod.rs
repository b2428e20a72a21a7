//! The command `sky`: the sun's path, a picture of the sky, and the exposure map of a period.

pub mod args;
mod cache;
mod report;

use super::run::{say, start_threads, warn};
use super::stages::Stages;
use super::tell;
use super::write::Folder;
use crate::export::exposure::{self, Part};
use crate::export::sky_picture;
use crate::export::sun_path::{self, SunPath};
use crate::job::Cancel;
use crate::scene::Site;
use crate::sky::Sun;
use crate::sky::dome::Haze;
use crate::sky::events;
use crate::sky::map::{ExposureMap, MapSettings};
use crate::sky::picture::{Colours, Picture};
use crate::sky::site::{ClearSky, Outdoors};
use crate::sky::spectrum::{Atmosphere, Band};
use crate::sky::steps::Steps;
use crate::sky::sun::{Air, eccentricity, position};
use crate::sky::weather::{Weather, WeatherFormat};
use anyhow::{Context, Result, bail};
use args::{PictureColours, SkyArgs};
use jiff::civil::Date;
use report::{Found, Report};
use std::io::IsTerminal;
use std::time::Instant;

/// Width and height of the picture of the sky, pixels.
const PICTURE_PX: usize = 768;

/// Runs the command.
///
/// # Errors
/// Bad input, a file that cannot be written, or an interrupt.
pub fn run(args: &SkyArgs, cancel: &Cancel) -> Result<()> {
    let stages = Stages::new(std::io::stderr().is_terminal());
    let mut folder = args.output.as_deref().map(Folder::new).transpose()?;
    start_threads(args.threads.map(usize::from))?;
    let (name, outdoors, mut warnings) = open(args, &stages, cancel)?;

    let begin = Instant::now();
    let steps = outdoors.steps_unless(cancel).with_context(|| name.clone())?;
    let settings = MapSettings {
        size: args.size,
        model: outdoors.model,
        haze: outdoors.haze,
        tolerance: if args.full { None } else { MapSettings::default().tolerance },
    };
    let map = map(args, &steps, &settings, &stages, cancel)?;
    let seconds = begin.elapsed().as_secs_f64();

    warnings.extend(steps.warnings.iter().cloned());
    warn(&warnings);
    outdoors.notes.iter().for_each(|note| tell(format_args!("note: {note}")));
    let day = single_date(args, &outdoors, &steps).map(|date| events::day(&outdoors.place, date)).transpose()?;
    let sun = sun(args, &outdoors)?;
    let found = Found { name: &name, outdoors: &outdoors, steps: &steps, map: &map, day, sun, seconds, warnings };
    let report = Report::new(args, found);
    let json = serde_json::to_string(&report)?;
    if let Some(folder) = &mut folder {
        write_map(folder, &name, &map)?;
        write_sun_path(folder, &name, &outdoors)?;
        if let Some(sun) = sun {
            write_picture(folder, args, &outdoors, sun)?;
        }
        folder.file("sky.json", |out| writeln!(out, "{json}"))?;
        folder.list();
    }
    if args.json { say(&format!("{json}\n")) } else { say(&report.text()) }
}

/// The site that was asked for, with its name, and what was odd about its weather.
fn open(args: &SkyArgs, stages: &Stages, cancel: &Cancel) -> Result<(String, Outdoors, Vec<String>)> {
    let (name, site) = match &args.source {
        None => (String::from("here"), Site::default()),
        Some(path) if WeatherFormat::of(path).is_some() => {
            (String::new(), Site { weather: Some(path.clone()), ..Site::default() })
        }
        Some(path) if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) => {
            let (name, site) = Site::load(path, stages, cancel)?;
            (
                name,
                site.with_context(|| {
                    format!("{}: [site] is missing, which says where on earth it is", path.display())
                })?,
            )
        }
        Some(path) => bail!("{}: neither a scene file (.toml) nor weather (.epw, .wea)", path.display()),
    };
    let site = args.over(site);
    let weather = site.weather.as_deref().map(|path| Weather::load(path, stages, cancel)).transpose()?;
    let name = if name.is_empty() { weather.as_ref().map_or(name, |weather| weather.name.clone()) } else { name };
    let warnings = weather.as_ref().map_or_else(Vec::new, |weather| weather.warnings.clone());

    let mut outdoors = Outdoors::of(&site, weather).with_context(|| name.clone())?;
    outdoors.model = args.site.model.unwrap_or(outdoors.model);
    if args.clear_sky.is_some() && outdoors.weather.is_some() {
        bail!("{name}: --clear-sky is for a sky without weather; here the weather says what sun and sky bring");
    }
    if args.clear_sky == Some(ClearSky::Ineichen) && args.band != Band::Broadband {
        bail!("{name}: --clear-sky ineichen knows all light together; {} light is spectral", args.band);
    }
    outdoors.clear_sky = args.clear_sky.unwrap_or(outdoors.clear_sky);
    outdoors.year = args.date.map_or(outdoors.year, |date| date.year());
    let outdoors = outdoors.in_band(args.band).with_context(|| name.clone())?;
    Ok((name, outdoors, warnings))
}

/// The map: the one kept, or a new one.
fn map(args: &SkyArgs, steps: &Steps, settings: &MapSettings, stages: &Stages, cancel: &Cancel) -> Result<ExposureMap> {
    let Some(folder) = &args.cache else { return Ok(ExposureMap::build(steps, settings, stages, cancel)?) };
    if let Some(map) = cache::kept(folder, steps, settings) {
        return Ok(map);
    }
    let map = ExposureMap::build(steps, settings, stages, cancel)?;
    cache::keep(folder, steps, settings, &map)?;
    Ok(map)
}

/// The date of a period of one day.
fn single_date(args: &SkyArgs, outdoors: &Outdoors, steps: &Steps) -> Option<Date> {
    if outdoors.period.first != outdoors.period.last {
        return None;
    }
    let (month, day) = outdoors.period.first;
    args.date.or_else(|| steps.steps.first().map(|step| step.time.date())).or(Date::new(outdoors.year, month, day).ok())
}

/// Where the sun is seen at the time that was asked for.
fn sun(args: &SkyArgs, outdoors: &Outdoors) -> Result<Option<Sun>> {
    let Some((date, time)) = args.date.zip(args.time) else { return Ok(None) };
    Ok(Some(position(&outdoors.place, date.to_datetime(time), Some(Air::STANDARD))?))
}

/// Where the sun stands in every hour of the year, and its paths as a diagram.
fn write_sun_path(folder: &mut Folder, name: &str, outdoors: &Outdoors) -> Result<()> {
    let path = SunPath::of(&outdoors.place, outdoors.year)?;
    folder.file("sun_path.csv", |out| sun_path::write_csv(out, &path))?;
    folder.file("sun_path.svg", |out| sun_path::write_svg(out, &path, name))
}

/// The clear sky at the time that was asked for.
fn write_picture(folder: &mut Folder, args: &SkyArgs, outdoors: &Outdoors, sun: Sun) -> Result<()> {
    let Some(date) = args.date else { return Ok(()) };
    if outdoors.weather.is_some() {
        tell("note: the picture is of a clear sky; the weather is in the map alone");
    }
    let Haze { turbidity, ground_albedo, .. } = outdoors.haze;
    let atmosphere = Atmosphere { ground_albedo, ..Atmosphere::new(turbidity) };
    let colours = match args.colours {
        PictureColours::Preetham => Colours::Preetham,
        PictureColours::Hosek => Colours::Hosek,
    };
    let picture = Picture::paint(sun, eccentricity(date), &atmosphere, colours, PICTURE_PX);
    folder.file("sky.hdr", |out| sky_picture::write_hdr(out, &picture))?;
    folder.file("sky.exr", |out| sky_picture::write_exr(out, &picture))?;
    folder.file("sky.png", |out| sky_picture::write_png(out, &picture, sky_picture::EXPOSURE))
}

/// The map's files.
fn write_map(folder: &mut Folder, name: &str, map: &ExposureMap) -> Result<()> {
    folder.file("exposure_diffuse.npy", |out| exposure::write_npy(out, map, Part::Diffuse))?;
    folder.file("exposure_direct.npy", |out| exposure::write_npy(out, map, Part::Direct))?;
    folder.file("exposure.exr", |out| exposure::write_exr(out, map))?;
    folder.file("exposure.hdr", |out| exposure::write_hdr(out, map))?;
    folder.file("suns.csv", |out| exposure::write_suns_csv(out, map))?;
    let picture = exposure::picture::draw(map, name)?;
    if !picture.has_text {
        tell("warning: exposure.png has no text: the system has no font");
    }
    folder.file("exposure.png", |out| out.write_all(&picture.bytes))
}
