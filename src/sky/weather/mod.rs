//! What did the sun and the sky give, hour by hour?
//!
//! Weather files are EPW ([`epw`], EnergyPlus) or WEA ([`wea`], Radiance). Both become [`Weather`]: a place and intervals with
//! the mean direct normal and diffuse horizontal irradiance of each. Intervals, not stamps, because the two formats stamp
//! differently: an EPW row bears the end of its hour, a WEA row the middle.
//!
//! Nothing is dropped silently: what is missing and cannot be found from what is there is taken as 0 and named in
//! [`Weather::warnings`], by lines. Direct irradiance while the sun is down is kept; who knows where the sun stands judges it.
//!
//! Bounds: an irradiance is 0 to 1500 W/m2, a tenth above the sun's outside the atmosphere at its nearest (1410 W/m2), since
//! clouds can add to the sun; zones are -12 to 14 h; sites lie -1000 to 9999.9 m high (the bounds of EPW).

pub mod epw;
mod missing;
#[cfg(test)]
mod tests;
pub mod wea;

use super::Place;
use crate::job::{Cancel, Progress};
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::{Input, number, read_file, shown};
use jiff::SignedDuration;
use jiff::civil::DateTime;
use std::path::Path;

/// Endings of the weather formats that can be read.
pub const FORMATS: &str = "epw, wea";

/// Most irradiance that is accepted, W/m2.
const MOST_W_M2: f64 = 1500.0;

/// Hours between a place's zone and the one its longitude asks for beyond which a sign is likely to be wrong: no country
/// keeps a zone further off.
const FARTHEST_ZONE_H: f64 = 3.5;

/// The weather of one place over a period.
#[derive(Debug, Clone, PartialEq)]
pub struct Weather {
    /// What the file calls the place.
    pub name: String,
    /// Where it is, and its zone: all times are its standard time.
    pub place: Place,
    /// The intervals with data, as the file orders them: they do not overlap within a year, but the months of a typical year
    /// bear the years they were measured in.
    pub hours: Vec<Hour>,
    /// What was missing, mended or odd, a sentence each, without the file's name.
    pub warnings: Vec<String>,
}

/// One interval of weather, mostly an hour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hour {
    /// When it begins: local standard time, in the row's own year.
    pub start: DateTime,
    /// How long it is, hours.
    pub length_h: f64,
    /// Mean direct irradiance on a plane that faces the sun, W/m2.
    pub dni_w_m2: f64,
    /// Mean diffuse irradiance on the horizontal, W/m2.
    pub dhi_w_m2: f64,
    /// Mean of the whole irradiance on the horizontal as the file gives it, W/m2: to hold the two others to. `None` where it
    /// is missing, and in WEA always.
    pub ghi_w_m2: Option<f64>,
    /// Its line in the file, from 1.
    pub line: usize,
}

/// What a period brings on a square metre, kWh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sums {
    /// All light on the horizontal, by the file's own numbers; intervals without one count as 0, a file without any has none.
    pub ghi_kwh_m2: Option<f64>,
    /// Direct light on a plane that faces the sun.
    pub dni_kwh_m2: f64,
    /// Diffuse light on the horizontal.
    pub dhi_kwh_m2: f64,
}

/// Which reader an ending asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeatherFormat {
    /// EnergyPlus weather.
    Epw,
    /// Radiance weather tape.
    Wea,
}

impl WeatherFormat {
    /// The format of a file by its ending, in capitals or not; `None` for others.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "epw" => Some(Self::Epw),
            "wea" => Some(Self::Wea),
            _ => None,
        }
    }
}

impl Weather {
    /// Reads the file at a path, EPW or WEA by its ending.
    ///
    /// # Errors
    /// A file that cannot be read, another ending, and all of [`epw::read_epw`] and [`wea::read_wea`].
    pub fn load(path: &Path, progress: &dyn Progress, cancel: &Cancel) -> Result<Self, SceneError> {
        let bytes = read_file(path, progress, cancel)?;
        Self::read(&Input::alone(&bytes, path, progress, cancel))
    }

    /// Reads bytes, EPW or WEA by the ending of their path.
    ///
    /// # Errors
    /// As [`Weather::load`].
    pub fn read(input: &Input) -> Result<Self, SceneError> {
        match WeatherFormat::of(input.path) {
            Some(WeatherFormat::Epw) => epw::read_epw(input),
            Some(WeatherFormat::Wea) => wea::read_wea(input),
            None => {
                let file = input.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                Err(input.error(None, Kind::UnknownFormat { file, known: FORMATS }))
            }
        }
    }

    /// What all intervals together bring.
    pub fn sums(&self) -> Sums {
        let sum = |of: fn(&Hour) -> f64| self.hours.iter().map(|hour| of(hour) * hour.length_h).sum::<f64>() / 1000.0;
        let any_ghi = self.hours.iter().any(|hour| hour.ghi_w_m2.is_some());
        Sums {
            ghi_kwh_m2: any_ghi.then(|| sum(|hour| hour.ghi_w_m2.unwrap_or(0.0))),
            dni_kwh_m2: sum(|hour| hour.dni_w_m2),
            dhi_kwh_m2: sum(|hour| hour.dhi_w_m2),
        }
    }
}

impl Hour {
    /// The moment a share of the interval, 0 to 1, after its start, to the nearest second.
    pub fn at(&self, share: f64) -> DateTime {
        let passed = SignedDuration::from_secs((self.length_h * 3600.0 * share).round() as i64);
        self.start.saturating_add(passed)
    }

    /// The middle of the interval.
    pub fn middle(&self) -> DateTime {
        self.at(0.5)
    }

    /// The end of the interval, the start of the next.
    pub fn end(&self) -> DateTime {
        self.at(1.0)
    }
}

/// What stands in a row before what is missing in it is dealt with: irradiances, W/m2.
#[derive(Debug, Clone, Copy)]
struct Row {
    line: usize,
    start: DateTime,
    length_h: f64,
    ghi: Option<f64>,
    dni: Option<f64>,
    dhi: Option<f64>,
}

/// The weather of rows.
fn from_rows(name: String, place: Place, rows: &[Row], mut warnings: Vec<String>) -> Weather {
    let name = name.chars().filter(|letter| !letter.is_control()).collect();
    warnings.extend(zone_warning(&place));
    let hours = missing::completed(&place, rows, &mut warnings);
    Weather { name, place, hours, warnings }
}

/// A place from the fields of a header: degrees north and east, hours ahead of UTC, metres.
fn place(latitude_deg: f64, longitude_deg: f64, utc_offset_h: f64, altitude_m: f64) -> Result<Place, Kind> {
    Ok(Place {
        altitude_m: within(altitude_m, "elevation", [-1000.0, 9999.9], "-1000 to 9999.9 m")?,
        ..Place::from_degrees(
            within(latitude_deg, "latitude", [-90.0, 90.0], "-90 to 90 degrees")?,
            within(longitude_deg, "longitude", [-180.0, 180.0], "-180 to 180 degrees")?,
            within(utc_offset_h, "time zone", [-12.0, 14.0], "-12 to 14 h ahead of UTC")?,
        )
    })
}

/// What to say of a zone that does not fit the longitude; the commonest mistake in headers is a wrong sign.
fn zone_warning(place: &Place) -> Option<String> {
    let solar_h = place.longitude_rad.to_degrees() / 15.0;
    let apart_h = (place.utc_offset_h - solar_h + 12.0).rem_euclid(24.0) - 12.0;
    let text = || {
        let (longitude, zone) = (place.longitude_rad.to_degrees(), place.utc_offset_h);
        format!("the zone {zone} h is {apart_h:.1} h off the longitude {longitude:.2} degrees east: is a sign wrong?")
    };
    (apart_h.abs() > FARTHEST_ZONE_H).then(text)
}

/// The mean irradiance over a row, W/m2.
fn irradiance(field: &[u8], what: &str) -> Result<f64, Kind> {
    bounded(field, what, [0.0, MOST_W_M2], "0 to 1500 W/m2")
}

/// A number within bounds.
fn bounded(field: &[u8], what: &str, range: [f64; 2], bound: &'static str) -> Result<f64, Kind> {
    within(decimal(field, what)?, what, range, bound)
}

/// A whole number within bounds.
fn whole(field: &[u8], what: &str, range: [f64; 2], bound: &'static str) -> Result<i16, Kind> {
    let value = bounded(field, what, range, bound)?;
    if value.fract() != 0.0 {
        return Err(Kind::Syntax { expected: format!("{what}, a whole number"), found: shown(field) });
    }
    Ok(value as i16)
}

/// A finite number.
fn decimal(field: &[u8], what: &str) -> Result<f64, Kind> {
    let wrong = || Kind::Syntax { expected: format!("{what}, a number"), found: shown(field) };
    let value = number(field).ok_or_else(wrong)?;
    if value.is_finite() { Ok(value) } else { Err(Kind::NotFinite { what: what.to_owned(), value }) }
}

/// A value that must lie within bounds.
fn within(value: f64, what: &str, [low, high]: [f64; 2], bound: &'static str) -> Result<f64, Kind> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(Kind::Outside { what: what.to_owned(), value, bound }) }
}

/// A date that exists.
fn date(year: i16, month: i16, day: i16) -> Result<jiff::civil::Date, Kind> {
    let found = jiff::civil::Date::new(year, month as i8, day as i8);
    found.map_err(|_| Kind::Contradiction(format!("there is no {year:04}-{month:02}-{day:02}")))
}

/// A month and a day of it.
fn month_and_day(month: &[u8], day: &[u8]) -> Result<(i16, i16), Kind> {
    Ok((whole(month, "month", [1.0, 12.0], "1 to 12")?, whole(day, "day", [1.0, 31.0], "1 to 31")?))
}
