//! Where does the sun stand, by the short formula that the skies of graphics use?
//!
//! Iqbal's formula of day of the year and decimal hour (An Introduction to Solar Radiation, 1983), as in the appendix of
//! Preetham, Shirley & Smits 1999, with a sign of the printed azimuth put right (as printed it is 36 degrees off at 9 h on
//! 21 June). No refraction, no leap years, no zones in the day's number, no drift. Error against SPA: 0.2 to 0.3 degrees in
//! the mean; at most 1.2 from 2000 to 2029 in zones from UTC-6 on (0.65 to 1 in most years), 1.3 in those farther west, 1.4 by
//! 2050. Sunrise and sunset: minutes, the more the higher the latitude (table in `docs/sky.md`).
//! It is here to be compared with; [`super::sun`] is what the rest of the crate uses.

use super::events::{Day, SUNRISE_ELEVATION_DEG};
use super::sun::{SunError, location};
use super::{Place, Sun};
use jiff::SignedDuration;
use jiff::civil::{Date, DateTime};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Where the sun stands at a local standard time, without refraction. About 0.1 microseconds.
///
/// # Errors
/// A place outside its bounds; any date will do.
pub fn position(place: &Place, time: DateTime) -> Result<Sun, SunError> {
    location(place)?;
    let solar_h = hours_of(time) + solar_less_standard_h(place, time.date());
    let (sin_hour, cos_hour) = (PI * solar_h / 12.0).sin_cos();
    let (sin_latitude, cos_latitude) = place.latitude_rad.sin_cos();
    let (sin_declination, cos_declination) = declination_rad(time.date()).sin_cos();

    // Hours count from midnight, so that the cosine is negative by day.
    let sin_elevation = sin_latitude * sin_declination - cos_latitude * cos_declination * cos_hour;
    let east = cos_declination * sin_hour;
    let north = cos_latitude * sin_declination + sin_latitude * cos_declination * cos_hour;
    let azimuth_rad = east.atan2(north).rem_euclid(TAU);
    Ok(Sun {
        azimuth_rad: if azimuth_rad < TAU { azimuth_rad } else { 0.0 },
        elevation_rad: sin_elevation.clamp(-1.0, 1.0).asin().clamp(-FRAC_PI_2, FRAC_PI_2),
    })
}

/// Sunrise, transit and sunset around the noon of a date, by the same formula: cos H0 = (sin h0 - sin phi sin delta)/
/// (cos phi cos delta), h0 where the upper limb stands on the horizon.
///
/// One declination for the whole day: it rises and sets, or does neither.
///
/// # Errors
/// A place outside its bounds, or a date at an end of the calendar.
pub fn day(place: &Place, date: Date) -> Result<Day, SunError> {
    location(place)?;
    let (sin_latitude, cos_latitude) = place.latitude_rad.sin_cos();
    let (sin_declination, cos_declination) = declination_rad(date).sin_cos();
    let missing = SUNRISE_ELEVATION_DEG.to_radians().sin() - sin_latitude * sin_declination;
    let reach = cos_latitude * cos_declination;

    // The transit nearest to noon of the clock, as for the exact events.
    let shift_h = solar_less_standard_h(place, date);
    let transit_h = 12.0 - (shift_h - 24.0 * (shift_h / 24.0).round());
    let at = |hours: f64| {
        let since = SignedDuration::from_millis((3_600_000.0 * hours).round() as i64);
        date.at(0, 0, 0, 0).checked_add(since).map_err(|_| SunError::Calendar)
    };
    let transit = at(transit_h)?;
    if missing >= reach {
        Ok(Day::AlwaysDown { transit })
    } else if missing <= -reach {
        Ok(Day::AlwaysUp { transit })
    } else {
        let half_h = (missing / reach).clamp(-1.0, 1.0).acos() * 12.0 / PI;
        Ok(Day::Normal { sunrise: at(transit_h - half_h)?, transit, sunset: at(transit_h + half_h)? })
    }
}

/// Declination of the sun on a date, radians.
pub fn declination_rad(date: Date) -> f64 {
    0.4093 * (2.0 * PI * (f64::from(date.day_of_year()) - 81.0) / 368.0).sin()
}

/// What true solar time is ahead of the clock, hours: the equation of time, and the way from the zone's meridian.
fn solar_less_standard_h(place: &Place, date: Date) -> f64 {
    let day = f64::from(date.day_of_year());
    let equation_of_time_h =
        0.170 * (4.0 * PI * (day - 80.0) / 373.0).sin() - 0.129 * (2.0 * PI * (day - 8.0) / 355.0).sin();
    equation_of_time_h + place.longitude_rad.to_degrees() / 15.0 - place.utc_offset_h
}

fn hours_of(time: DateTime) -> f64 {
    time.duration_since(time.date().at(0, 0, 0, 0)).as_secs_f64() / 3600.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use jiff::civil::date;

    /// On a zone's meridian at the equator, near an equinox: up in the east, through the zenith, down in the west.
    #[test]
    fn the_equinox_sun_runs_from_east_to_west() {
        let place = Place::from_degrees(0.0, 0.0, 0.0);
        let at = |hour: i8| position(&place, date(2023, 3, 22).at(hour, 0, 0, 0)).unwrap();
        assert!((at(8).azimuth_rad.to_degrees() - 90.0).abs() < 1.0);
        assert!((at(12).elevation_rad.to_degrees() - 90.0).abs() < 3.0);
        assert!((at(16).azimuth_rad.to_degrees() - 270.0).abs() < 1.0);
        assert!(at(0).elevation_rad < -1.5);
    }

    /// The case in which the printed azimuth is wrong, against SPA.
    #[test]
    fn the_sign_of_the_azimuth_is_right() {
        let place = Place::from_degrees(40.0, 0.0, 0.0);
        let time = date(2023, 6, 21).at(9, 0, 0, 0);
        let exact = super::super::sun::position(&place, time, None).unwrap();
        let simple = position(&place, time).unwrap();
        assert!((exact.azimuth_rad - simple.azimuth_rad).abs().to_degrees() < 0.5);
    }

    #[test]
    fn poles_have_a_day_and_a_night_a_year() {
        for (latitude_deg, summer) in [(90.0, 6), (-90.0, 12)] {
            let place = Place::from_degrees(latitude_deg, 0.0, 0.0);
            let of = |month: i8| day(&place, date(2024, month, 21)).unwrap();
            assert!(matches!(of(summer), Day::AlwaysUp { .. }));
            assert!(matches!(of(18 - summer), Day::AlwaysDown { .. }));
        }
    }
}
