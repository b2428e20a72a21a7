//! What does a site ask of the sky?
//!
//! A [`Site`] leaves things open: a weather file knows its place, a place its most likely zone, a period without a year may
//! have any. [`Outdoors`] is the site with all of that decided, and says what was decided; its steps are what the exposure
//! map, and whatever else adds up a period, are made of.

use super::clear::{ClearAir, Irradiance, irradiance};
use super::dome::{Haze, SkyModel};
use super::hosek::BandNotReached;
use super::spectrum::{Atmosphere, Band, Spectrum};
use super::steps::{Period, Steps, of_clear_sky, of_weather};
use super::sun::{SOLAR_CONSTANT_W_M2, SunError};
use super::weather::Weather;
use super::{Place, Sun};
use crate::job::Cancel;
use crate::scene::Site;

/// The year of a clear period that names none; not a leap year.
const YEAR: i16 = 2025;

/// The year of one that begins or ends on 29 February.
const LEAP_YEAR: i16 = 2024;

/// Turbidity of a clear sky that names none: a usual clear day.
const TURBIDITY: f64 = 3.0;

/// Reflectance of the ground where none is named: grass, and soil.
const GROUND_ALBEDO: f64 = 0.2;

/// Steps longer than this are told of, minutes: a year's global irradiation under a clear sky at 42 degrees north is 0.1% too
/// high with steps of an hour, 0.7% of two, 1.9% of three and 72% with one step a day.
const LONG_MIN: f64 = 60.0;

/// What the sun and the sky bring when no cloud is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClearSky {
    /// By Linke's turbidity (Ineichen and Perez 2002): broadband, fitted to measurements.
    Ineichen,
    /// By the published transmittances, wavelength by wavelength.
    Spectral,
}

impl ClearSky {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Ineichen, Self::Spectral];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ineichen => "ineichen",
            Self::Spectral => "spectral",
        }
    }

    /// The clear sky of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sky| sky.name() == name)
    }
}

/// A site with what it left open decided.
#[derive(Debug, Clone, PartialEq)]
pub struct Outdoors {
    /// Where it is.
    pub place: Place,
    /// Direction of true north, radians clockwise from the scene's +Y.
    pub north_rad: f64,
    /// What was measured there; without it the sky is clear.
    pub weather: Option<Weather>,
    /// Which part of the year.
    pub period: Period,
    /// The year of a clear sky's suns.
    pub year: i16,
    /// Air and ground.
    pub haze: Haze,
    /// What sun and sky bring without weather.
    pub clear_sky: ClearSky,
    /// How the sky's light is spread: Perez' with weather, Hosek's and Wilkie's without.
    pub model: SkyModel,
    /// What was decided, a sentence each.
    pub notes: Vec<String>,
}

/// What a site does not say and nothing else does, or asks and nothing answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SiteError {
    /// Neither site nor weather has it.
    #[error("{0} is missing: a site needs it, or weather that has it")]
    Missing(&'static str),
    /// Weather is measured in all light together.
    #[error("{0} light is known of a clear sky alone: weather files have all light together")]
    BandOfWeather(Band),
    /// Perez' sky follows irradiances of all light together.
    #[error("{0} light has no sky by Perez, which is fitted to all light together; hosek and isotropic have")]
    BandOfPerez(Band),
    /// A band that no sky reaches.
    #[error(transparent)]
    BandNotReached(#[from] BandNotReached),
}

impl Outdoors {
    /// Decides what a site leaves open. What the site says goes before what the weather has.
    ///
    /// # Errors
    /// Neither has a latitude or a longitude.
    pub fn of(site: &Site, weather: Option<Weather>) -> Result<Self, SiteError> {
        let mut notes = Vec::new();
        let measured = weather.as_ref().map(|weather| weather.place);
        let angle_rad = |said_deg: Option<f64>, measured_rad: Option<f64>, name| {
            said_deg.map(f64::to_radians).or(measured_rad).ok_or(SiteError::Missing(name))
        };
        let latitude_rad = angle_rad(site.latitude_deg, measured.map(|place| place.latitude_rad), "latitude_deg")?;
        let longitude_rad = angle_rad(site.longitude_deg, measured.map(|place| place.longitude_rad), "longitude_deg")?;
        let utc_offset_h = site.utc_offset_h.or(measured.map(|place| place.utc_offset_h)).unwrap_or_else(|| {
            let nearest_h = (longitude_rad.to_degrees() / 15.0).round();
            notes.push(format!("no zone is named; the longitude's is taken, UTC{nearest_h:+}"));
            nearest_h
        });
        let altitude_m = measured.map_or(0.0, |place| place.altitude_m);

        let year_round = Period::YEAR;
        let day = |said: Option<(u8, u8)>, else_day: (i8, i8)| {
            said.map_or(else_day, |(month, day)| (month.cast_signed(), day.cast_signed()))
        };
        let period = Period {
            first: day(site.start, year_round.first),
            last: day(site.end, year_round.last),
            step_min: site.step_min.unwrap_or(year_round.step_min),
        };
        if period.step_min > LONG_MIN {
            notes.push(format!(
                "a step of {} minutes has one sun for all of it; an hour or less is closer",
                period.step_min
            ));
        }
        let is_leap = [period.first, period.last].contains(&(2, 29));
        let year = if is_leap { LEAP_YEAR } else { YEAR };
        if weather.is_none() && site.turbidity.is_none() {
            notes.push(format!("no weather and no turbidity are named; the sky is clear, of turbidity {TURBIDITY}"));
        }
        let haze = Haze {
            turbidity: site.turbidity.unwrap_or(TURBIDITY),
            ground_albedo: site.ground_albedo.unwrap_or(GROUND_ALBEDO),
            band: Band::Broadband,
        };
        Ok(Self {
            place: Place { latitude_rad, longitude_rad, utc_offset_h, altitude_m },
            north_rad: site.north_deg.to_radians(),
            model: if weather.is_some() { SkyModel::Perez } else { SkyModel::Hosek },
            weather,
            period,
            year,
            haze,
            clear_sky: ClearSky::Ineichen,
            notes,
        })
    }

    /// The same of one band of the spectrum; a narrower one than all is of a clear sky by its transmittances.
    ///
    /// # Errors
    /// A band that the weather, the model or Hosek's and Wilkie's data do not have.
    pub fn in_band(self, band: Band) -> Result<Self, SiteError> {
        match (band, &self.weather, self.model) {
            (Band::Broadband, ..) => return Ok(self),
            (Band::Infrared, ..) => return Err(BandNotReached(band).into()),
            (_, Some(_), _) => return Err(SiteError::BandOfWeather(band)),
            (_, _, SkyModel::Perez) => return Err(SiteError::BandOfPerez(band)),
            _ => {}
        }
        Ok(Self { haze: Haze { band, ..self.haze }, clear_sky: ClearSky::Spectral, ..self })
    }

    /// The steps of the period: the weather's, or a clear sky's. A year of hours takes some tens of milliseconds, of minutes
    /// a second or two, and ten under a spectral sky.
    ///
    /// # Errors
    /// A place or a year beyond what the sun's position is known for.
    pub fn steps(&self) -> Result<Steps, SunError> {
        self.steps_unless(&Cancel::new())
    }

    /// [`Outdoors::steps`] of a run that may be stopped.
    ///
    /// # Errors
    /// As there, or [`SunError::Cancelled`].
    pub fn steps_unless(&self, cancel: &Cancel) -> Result<Steps, SunError> {
        if let Some(weather) = &self.weather {
            return of_weather(&self.place, weather, &self.period, cancel);
        }
        let Haze { turbidity, ground_albedo, band } = self.haze;
        let air = ClearAir { linke_turbidity: turbidity, altitude_m: self.place.altitude_m };
        let atmosphere = Atmosphere { ground_albedo, ..Atmosphere::new(turbidity) };
        let clear = |sun: Sun, eccentricity| match self.clear_sky {
            ClearSky::Ineichen => irradiance(sun.elevation_rad, SOLAR_CONSTANT_W_M2 * eccentricity, air),
            ClearSky::Spectral => {
                let spectrum = Spectrum::clear(sun.elevation_rad, eccentricity, &atmosphere);
                Irradiance { dni_w_m2: spectrum.beam_w_m2(band), dhi_w_m2: spectrum.diffuse_w_m2(band) }
            }
        };
        of_clear_sky(&self.place, self.year, &self.period, clear, cancel)
    }
}
