//! Where does the sun stand, for a place and a time?
//!
//! NREL's Solar Position Algorithm (Reda & Andreas 2004, Solar Energy 76(5); within 0.0003 degrees of the ephemeris from
//! year -2000 to 6000), by the crate `solar-positioning`. Years are limited to -500 to 3000, where the slowing of the earth's
//! turn (delta T) is estimated. Refraction is that of SPA: a mean atmosphere of the given pressure and temperature, and none
//! once the upper limb is below the horizon; near the horizon real air moves the sun by a few tenths of a degree either way.

use super::{Place, Sun};
use crate::job::Cancelled;
use jiff::civil::{Date, DateTime, date};
use solar_positioning::{Location, RefractionCorrection, SolarPositions, delta_t, time::JulianDate};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Solar constant at the mean distance of the earth, W/m2 (Kopp & Lean 2011).
pub const SOLAR_CONSTANT_W_M2: f64 = 1361.0;

/// Years for which delta T is estimated.
pub(super) const YEARS: [f64; 2] = [-500.0, 3000.0];

/// An angle this much beyond its bound is rounding, radians; a thousandth of a millimetre on the ground.
const ROUNDING_RAD: f64 = 1e-12;

/// Noon of 1 January 2000, and its Julian day.
const EPOCH: DateTime = date(2000, 1, 1).at(12, 0, 0, 0);
const EPOCH_JULIAN_DAY: f64 = 2_451_545.0;

const SECONDS_PER_DAY: f64 = 86_400.0;

/// The air that bends the sun's rays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// At the place itself, hPa; above 0, at most 2000.
    pub pressure_hpa: f64,
    /// Degrees Celsius; above -273, at most 100.
    pub temperature_c: f64,
}

impl Air {
    /// The air of SPA's and most almanacs' refraction.
    pub const STANDARD: Air = Air { pressure_hpa: 1010.0, temperature_c: 10.0 };
}

/// Why the sun's place was not found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SunError {
    /// An input is out of its bounds.
    #[error("{what} {value} is outside {low} to {high}")]
    Outside {
        /// Which, with its unit.
        what: &'static str,
        /// What it is.
        value: f64,
        /// The least that is allowed.
        low: f64,
        /// The greatest that is allowed.
        high: f64,
    },
    /// What the algorithm itself says.
    #[error(transparent)]
    Algorithm(#[from] solar_positioning::Error),
    /// A time fell off the calendar.
    #[error("a date outside year -9999 to 9999")]
    Calendar,
    /// Whoever asked for many positions wants them no more.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Where the sun stands at a local standard time, seen from the ground (topocentric), by SPA.
///
/// With `air` the elevation is the apparent one, raised by refraction down to where the upper limb sets (-0.833 degrees);
/// without it, the geometric one. At the poles, where every direction is south or north, azimuths follow the longitude.
/// About 6 microseconds a call, no allocation.
///
/// # Errors
/// A place, an air or a year outside its bounds.
///
/// ```
/// use jiff::civil::date;
/// use lightvein::sky::{Place, sun};
///
/// // Johor Bahru, noon of the March equinox: almost overhead.
/// let place = Place::from_degrees(1.47, 103.75, 8.0);
/// let sun = sun::position(&place, date(2024, 3, 20).at(13, 12, 0, 0), Some(sun::Air::STANDARD))?;
/// assert!((sun.elevation_rad.to_degrees() - 88.5).abs() < 0.2);
/// # Ok::<(), sun::SunError>(())
/// ```
pub fn position(place: &Place, time: DateTime, air: Option<Air>) -> Result<Sun, SunError> {
    position_with_delta_t(place, time, air, delta_t_s(time.date())?)
}

/// [`position`] with delta T (terrestrial less universal time, seconds) given: for tables that were made with one.
///
/// # Errors
/// As [`position`].
pub fn position_with_delta_t(place: &Place, time: DateTime, air: Option<Air>, delta_t_s: f64) -> Result<Sun, SunError> {
    let location = location(place)?;
    let refraction = air.map(refraction).transpose()?;
    let julian = JulianDate::new(julian_day(place, time), delta_t_s)?;
    let found = SolarPositions::new().at_from_julian(julian, location, place.altitude_m, refraction)?;
    let azimuth_rad = found.azimuth().to_radians().rem_euclid(TAU);
    Ok(Sun {
        // A tiny negative angle becomes a whole turn in rounding.
        azimuth_rad: if azimuth_rad < TAU { azimuth_rad } else { 0.0 },
        elevation_rad: found.elevation_angle().to_radians().clamp(-FRAC_PI_2, FRAC_PI_2),
    })
}

/// Terrestrial less universal time, seconds, as estimated for a month (Espenak & Meeus, with newer fits from 2015).
///
/// # Errors
/// A year outside -500 to 3000.
pub fn delta_t_s(date: Date) -> Result<f64, SunError> {
    within("year", f64::from(date.year()), YEARS)?;
    let year = f64::from(date.year()) + (f64::from(date.month()) - 0.5) / 12.0;
    // The estimate ends where year 3000 begins.
    Ok(delta_t::estimate(year.min(YEARS[1]))?)
}

/// The angle of a date along the year, radians (Spencer 1971): 2 pi (J - 1)/365, J the day of the year from 1 on.
pub fn day_angle_rad(date: Date) -> f64 {
    2.0 * PI * (f64::from(date.day_of_year()) - 1.0) / 365.0
}

/// Square of mean over actual distance of the sun, E0 (Spencer 1971; within 0.0001): the beam outside the air is this times
/// the solar constant.
pub fn eccentricity(date: Date) -> f64 {
    let (sin, cos) = day_angle_rad(date).sin_cos();
    let (sin2, cos2) = (2.0 * day_angle_rad(date)).sin_cos();
    1.000_11 + 0.034_221 * cos + 0.001_28 * sin + 0.000_719 * cos2 + 0.000_077 * sin2
}

/// The beam outside the air on a date, W/m2.
pub fn extraterrestrial_w_m2(date: Date) -> f64 {
    SOLAR_CONSTANT_W_M2 * eccentricity(date)
}

/// The place as the crate has it, all bounds checked.
pub(super) fn location(place: &Place) -> Result<Location, SunError> {
    let degrees = |what, angle_rad: f64, most_rad: f64| {
        let is_rounding = angle_rad.abs() > most_rad && angle_rad.abs() <= most_rad + ROUNDING_RAD;
        let angle_rad = if is_rounding { most_rad.copysign(angle_rad) } else { angle_rad };
        within(what, angle_rad.to_degrees(), [-most_rad.to_degrees(), most_rad.to_degrees()])
    };
    within("zone (hours ahead of UTC)", place.utc_offset_h, [-14.0, 14.0])?;
    // From below the Dead Sea to the top of what weather reaches.
    within("altitude (m)", place.altitude_m, [-1000.0, 20_000.0])?;
    Ok(Location {
        latitude: degrees("latitude (degrees)", place.latitude_rad, FRAC_PI_2)?,
        longitude: degrees("longitude (degrees)", place.longitude_rad, PI)?,
    })
}

/// The Julian day of a local time at a place, universal time.
pub(super) fn julian_day(place: &Place, time: DateTime) -> f64 {
    let seconds = time.duration_since(EPOCH).as_secs_f64() - 3600.0 * place.utc_offset_h;
    EPOCH_JULIAN_DAY + seconds / SECONDS_PER_DAY
}

/// The local time at a place of a Julian day, to a millisecond.
pub(super) fn local_time(place: &Place, julian_day: f64) -> Result<DateTime, SunError> {
    let seconds = (julian_day - EPOCH_JULIAN_DAY) * SECONDS_PER_DAY + 3600.0 * place.utc_offset_h;
    let since = jiff::SignedDuration::from_millis((1000.0 * seconds).round() as i64);
    EPOCH.checked_add(since).map_err(|_| SunError::Calendar)
}

fn refraction(air: Air) -> Result<RefractionCorrection, SunError> {
    within("pressure (hPa)", air.pressure_hpa, [f64::MIN_POSITIVE, 2000.0])?;
    within("temperature (degrees Celsius)", air.temperature_c, [-272.0, 100.0])?;
    Ok(RefractionCorrection::new(air.pressure_hpa, air.temperature_c)?)
}

fn within(what: &'static str, value: f64, [low, high]: [f64; 2]) -> Result<f64, SunError> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(SunError::Outside { what, value, low, high }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The worked example of Reda & Andreas, with its own delta T of 67 s.
    #[test]
    fn spa_meets_its_published_example() {
        let mut place = Place::from_degrees(39.742_476, -105.178_6, -7.0);
        place.altitude_m = 1830.14;
        let air = Air { pressure_hpa: 820.0, temperature_c: 11.0 };
        let sun = position_with_delta_t(&place, date(2003, 10, 17).at(12, 30, 30, 0), Some(air), 67.0).unwrap();
        assert!((90.0 - sun.elevation_rad.to_degrees() - 50.111_62).abs() < 6e-6);
        assert!((sun.azimuth_rad.to_degrees() - 194.340_24).abs() < 6e-6);
    }

    #[test]
    fn the_earth_is_nearest_in_january() {
        assert!((eccentricity(date(2023, 1, 3)) - 1.035).abs() < 2e-4);
        assert!((eccentricity(date(2023, 7, 4)) - 0.9666).abs() < 2e-4);
        let mean =
            (0..365).map(|day| eccentricity(date(2023, 1, 1) + jiff::Span::new().days(day))).sum::<f64>() / 365.0;
        // A year's mean of 1/r2 is 1/sqrt(1 - e2), e = 0.0167.
        assert!((mean - 1.00014).abs() < 1e-4, "{mean}");
    }

    #[test]
    fn what_is_out_of_bounds_is_told_with_its_bound() {
        let noon = date(2024, 2, 29).at(12, 0, 0, 0);
        let says =
            |place: Place, air: Option<Air>, time: DateTime| position(&place, time, air).unwrap_err().to_string();
        let sound = Place::from_degrees(50.0, 8.0, 1.0);
        let beyond = Place::from_degrees(90.5, 8.0, 1.0);
        assert!(says(beyond, None, noon).starts_with("latitude (degrees) 90.5"), "{}", says(beyond, None, noon));
        assert!(says(Place { longitude_rad: f64::NAN, ..sound }, None, noon).contains("outside -180 to 180"));
        assert_eq!(
            says(Place { utc_offset_h: 15.0, ..sound }, None, noon),
            "zone (hours ahead of UTC) 15 is outside -14 to 14"
        );
        assert!(says(Place { altitude_m: f64::INFINITY, ..sound }, None, noon).starts_with("altitude"));
        assert!(says(sound, Some(Air { pressure_hpa: 0.0, ..Air::STANDARD }), noon).starts_with("pressure"));
        assert!(says(sound, Some(Air { temperature_c: -300.0, ..Air::STANDARD }), noon).starts_with("temperature"));
        assert_eq!(says(sound, None, date(3001, 1, 1).at(0, 0, 0, 0)), "year 3001 is outside -500 to 3000");
        assert!(position(&sound, date(3000, 12, 31).at(23, 59, 59, 0), None).is_ok());
        assert!(position(&sound, date(-500, 1, 1).at(0, 0, 0, 0), None).is_ok());
    }

    #[test]
    fn local_times_and_julian_days_are_inverse() {
        let place = Place::from_degrees(0.0, 0.0, -9.5);
        for time in [date(1900, 2, 28).at(23, 59, 59, 0), date(2024, 2, 29).at(0, 0, 0, 0), EPOCH] {
            assert_eq!(local_time(&place, julian_day(&place, time)).unwrap(), time);
        }
    }
}
