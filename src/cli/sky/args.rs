//! What can be typed after `sky`.

use crate::cli::stages::Stages;
use crate::job::Cancel;
use crate::scene::{Scene, Site};
use crate::sky::dome::SkyModel;
use crate::sky::site::{ClearSky, Outdoors};
use crate::sky::spectrum::Band;
use crate::sky::weather::Weather;
use anyhow::{Context, Result};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use jiff::civil::{Date, Time};
use std::path::{Path, PathBuf};

/// What `sky` takes.
#[derive(Debug, clap::Args)]
pub struct SkyArgs {
    /// A scene file (.toml) with a [site], or a weather file (.epw .wea); not needed where --latitude and --longitude are given
    #[arg(value_name = "SCENE|EPW", required_unless_present_all = ["latitude", "longitude"])]
    pub source: Option<PathBuf>,
    /// One day instead of a period, YYYY-MM-DD; of a weather file the same day of its year
    #[arg(long, value_parser = date, conflicts_with_all = ["start", "end"])]
    pub date: Option<Date>,
    /// A time of that day, HH:MM in local standard time: where the sun stands, and with -o a picture of the sky
    #[arg(long, value_parser = time, requires = "date")]
    pub time: Option<Time>,
    /// Azimuth of a facade's normal, degrees clockwise from true north: its shadow angles at --time
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg, requires = "time", allow_negative_numbers = true)]
    pub facade: Option<f64>,
    #[command(flatten)]
    pub site: SiteArgs,
    /// Columns and rows of the exposure map
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "512x512")]
    pub size: [usize; 2],
    /// What a clear sky brings, without weather: ineichen by Linke's turbidity; spectral by the published transmittances
    #[arg(long, value_parser = clear_sky())]
    pub clear_sky: Option<ClearSky>,
    /// Which light; narrower bands are of a clear sky by its transmittances, and infrared is beyond the data
    #[arg(long, value_parser = band(), default_value = "broadband")]
    pub band: Band,
    /// Whose colours the picture of the sky has
    #[arg(long, value_enum, default_value = "preetham", requires = "time")]
    pub colours: PictureColours,
    /// Evaluate the sky's part in every texel, not to a tolerance of 0.1%
    #[arg(long)]
    pub full: bool,
    /// Keep the map in this folder, and take it from there when the same is asked again
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Threads to work on; by default one a core. The figures do not depend on it
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// One JSON object on stdout instead of text
    #[arg(long)]
    pub json: bool,
    /// Folder for the files; made if it is not there
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Whose colours the picture of the sky has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum PictureColours {
    /// Preetham's: knows twilight.
    Preetham,
    /// Hosek's and Wilkie's: the better light, black at night.
    Hosek,
}

/// Place, air and period; what is given goes before what the scene or the weather says.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct SiteArgs {
    /// Weather file (.epw .wea)
    #[arg(long, value_name = "FILE")]
    pub weather: Option<PathBuf>,
    /// Latitude, degrees, north positive
    #[arg(long, value_name = "DEG", value_parser = |text: &str| within(text, -90.0, 90.0), allow_negative_numbers = true)]
    pub latitude: Option<f64>,
    /// Longitude, degrees, east positive
    #[arg(long, value_name = "DEG", value_parser = |text: &str| within(text, -180.0, 180.0), allow_negative_numbers = true)]
    pub longitude: Option<f64>,
    /// Zone, hours ahead of UTC
    #[arg(long, value_name = "HOURS", value_parser = |text: &str| within(text, -14.0, 14.0), allow_negative_numbers = true)]
    pub utc_offset: Option<f64>,
    /// Turbidity of a clear sky, 1 (clean air) to 10 (thick haze)
    #[arg(long, value_parser = |text: &str| within(text, 1.0, 10.0))]
    pub turbidity: Option<f64>,
    /// Reflectance of the ground round about, 0 to 1
    #[arg(long, value_parser = |text: &str| within(text, 0.0, 1.0))]
    pub albedo: Option<f64>,
    /// First day of the period, MM-DD
    #[arg(long, value_name = "MM-DD", value_parser = day)]
    pub start: Option<(u8, u8)>,
    /// Last day of the period, MM-DD; before the first it is of the next year
    #[arg(long, value_name = "MM-DD", value_parser = day)]
    pub end: Option<(u8, u8)>,
    /// Step, minutes
    #[arg(long = "step", value_name = "MIN", value_parser = step_min)]
    pub step_min: Option<f64>,
    /// How the sky's light is spread; by default perez with weather, hosek without
    #[arg(long, value_parser = model())]
    pub model: Option<SkyModel>,
}

impl SiteArgs {
    /// A site with what was typed written over it.
    pub fn over(&self, site: Site) -> Site {
        Site {
            latitude_deg: self.latitude.or(site.latitude_deg),
            longitude_deg: self.longitude.or(site.longitude_deg),
            utc_offset_h: self.utc_offset.or(site.utc_offset_h),
            turbidity: self.turbidity.or(site.turbidity),
            ground_albedo: self.albedo.or(site.ground_albedo),
            weather: self.weather.clone().or(site.weather),
            start: self.start.or(site.start),
            end: self.end.or(site.end),
            step_min: self.step_min.or(site.step_min),
            ..site
        }
    }
}

impl SiteArgs {
    /// Where a scene stands, its weather read; what the weather warns of goes to the scene's warnings.
    ///
    /// # Errors
    /// Broken weather, or a place that neither the scene nor the weather nor the command line names.
    pub fn outdoors(&self, scene: &mut Scene, path: &Path, stages: &Stages, cancel: &Cancel) -> Result<Outdoors> {
        let site = self.over(scene.site.take().unwrap_or_default());
        let weather = site.weather.as_deref().map(|path| Weather::load(path, stages, cancel)).transpose()?;
        if let Some(weather) = &weather {
            scene.warnings.extend(weather.warnings.iter().cloned());
        }
        let mut outdoors = Outdoors::of(&site, weather).with_context(|| path.display().to_string())?;
        outdoors.model = self.model.unwrap_or(outdoors.model);
        Ok(outdoors)
    }
}

impl SkyArgs {
    /// A site with what was typed written over it.
    pub fn over(&self, site: Site) -> Site {
        let site = self.site.over(site);
        // A day of the calendar is a month and a day of one, whatever the year.
        let day = self.date.map(|date| (date.month().cast_unsigned(), date.day().cast_unsigned()));
        Site { start: day.or(site.start), end: day.or(site.end), ..site }
    }
}

fn within(text: &str, low: f64, high: f64) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (low..=high).contains(&value) { Ok(value) } else { Err(format!("{text} is outside {low} to {high}")) }
}

fn azimuth_deg(text: &str) -> Result<f64, String> {
    within(text, -360.0, 360.0)
}

fn step_min(text: &str) -> Result<f64, String> {
    within(text, 1.0, 1440.0)
}

/// A day YYYY-MM-DD.
pub fn date(text: &str) -> Result<Date, String> {
    let date: Date = text.parse().map_err(|_| "not a day YYYY-MM-DD of the calendar".to_owned())?;
    if (1..=3000).contains(&date.year()) { Ok(date) } else { Err("the year is outside 1 to 3000".to_owned()) }
}

/// A time HH:MM.
pub fn time(text: &str) -> Result<Time, String> {
    Time::strptime("%H:%M", text).map_err(|_| "not a time HH:MM, 00:00 to 23:59".to_owned())
}

fn day(text: &str) -> Result<(u8, u8), String> {
    // In a leap year every day MM-DD is one.
    let date: Date = format!("2024-{text}").parse().map_err(|_| "not a day MM-DD of the calendar".to_owned())?;
    Ok((date.month().cast_unsigned(), date.day().cast_unsigned()))
}

fn size(text: &str) -> Result<[usize; 2], String> {
    const BOUND: &str = "a size is WIDTHxHEIGHT, each 1 to 8192";
    let (width, height) = text.split_once('x').ok_or(BOUND)?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=8192).contains(side)).ok_or(BOUND);
    Ok([side(width)?, side(height)?])
}

/// A sky model by its name.
fn model() -> impl TypedValueParser<Value = SkyModel> {
    PossibleValuesParser::new(SkyModel::ALL.map(SkyModel::name))
        .try_map(|name| SkyModel::from_name(&name).ok_or("not a model"))
}

/// A clear sky by its name.
fn clear_sky() -> impl TypedValueParser<Value = ClearSky> {
    PossibleValuesParser::new(ClearSky::ALL.map(ClearSky::name))
        .try_map(|name| ClearSky::from_name(&name).ok_or("not a clear sky"))
}

/// A band by its name.
fn band() -> impl TypedValueParser<Value = Band> {
    PossibleValuesParser::new(Band::ALL.map(Band::name)).try_map(|name| Band::from_name(&name).ok_or("not a band"))
}
