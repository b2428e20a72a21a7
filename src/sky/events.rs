//! When does the sun rise, culminate and set?
//!
//! By SPA, found to a millisecond by the crate `solar-positioning`. The horizon is level and open, refraction the
//! conventional 34' and the sun's radius 16': the upper limb touches the horizon when the centre stands at -0.833 degrees,
//! as almanacs have it. Real refraction moves sunrise by a minute or two, at high latitudes by far more.
//!
//! Two questions that differ: [`day`] is about the course of light around the noon of a date, whose sunrise or sunset may
//! fall on the neighbouring date of the calendar; [`crossings`] lists what happens between one midnight of the clock and the
//! next, which may be a sunset alone, or two of them.

use super::Place;
use super::sun::{SunError, delta_t_s, julian_day, local_time, location};
use jiff::ToSpan;
use jiff::civil::{Date, DateTime};
use solar_positioning::{Horizon, HorizonState, SolarEvents};

/// Elevation of the sun's centre at sunrise and sunset, degrees: refraction and radius, as SPA and almanacs have it.
pub const SUNRISE_ELEVATION_DEG: f64 = -0.833;

/// The course of light around the noon of a date; local standard times, which may fall on the neighbouring dates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Day {
    /// The sun rises and sets.
    Normal {
        /// The upper limb appears.
        sunrise: DateTime,
        /// The sun stands in the meridian.
        transit: DateTime,
        /// The upper limb is gone.
        sunset: DateTime,
    },
    /// It rises and stays up: polar day begins.
    OnlyRises {
        /// The upper limb appears.
        sunrise: DateTime,
        /// The sun stands in the meridian.
        transit: DateTime,
    },
    /// It was up and sets: polar day ends.
    OnlySets {
        /// The sun stands in the meridian.
        transit: DateTime,
        /// The upper limb is gone.
        sunset: DateTime,
    },
    /// Polar day.
    AlwaysUp {
        /// The sun stands in the meridian.
        transit: DateTime,
    },
    /// Polar night.
    AlwaysDown {
        /// The sun stands in the meridian, below the horizon.
        transit: DateTime,
    },
}

impl Day {
    /// When the upper limb appears, if it does.
    pub fn sunrise(&self) -> Option<DateTime> {
        match *self {
            Day::Normal { sunrise, .. } | Day::OnlyRises { sunrise, .. } => Some(sunrise),
            _ => None,
        }
    }

    /// When the upper limb is gone, if it goes.
    pub fn sunset(&self) -> Option<DateTime> {
        match *self {
            Day::Normal { sunset, .. } | Day::OnlySets { sunset, .. } => Some(sunset),
            _ => None,
        }
    }

    /// When the sun stands in the meridian.
    pub fn transit(&self) -> DateTime {
        match *self {
            Day::Normal { transit, .. }
            | Day::OnlyRises { transit, .. }
            | Day::OnlySets { transit, .. }
            | Day::AlwaysUp { transit }
            | Day::AlwaysDown { transit } => transit,
        }
    }
}

/// What happens between two midnights of the clock, in the order of time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Crossings {
    /// Whether the sun is up as the date begins.
    pub is_up_at_start: bool,
    /// Sunrises, at most two.
    pub sunrises: Vec<DateTime>,
    /// Sunsets, at most two.
    pub sunsets: Vec<DateTime>,
}

/// The course of light around the noon of a date: from half a day before the transit nearest to noon of the clock to half a
/// day after it. Where the clock runs far from the sun, transit, sunrise and sunset may be on the dates before and after.
///
/// Of two sunrises in that time (near a pole, about the equinox) it is the first, of sunsets after it the last. Height above the
/// sea is not counted: it neither lowers the horizon nor thins the air. About 0.8 ms: 140 positions.
///
/// # Errors
/// A place or a year outside its bounds.
///
/// ```
/// use jiff::civil::date;
/// use lightvein::sky::{Place, events::{self, Day}};
///
/// let tromso = Place::from_degrees(69.65, 18.96, 1.0);
/// assert!(matches!(events::day(&tromso, date(2024, 6, 21))?, Day::AlwaysUp { .. }));
/// assert!(matches!(events::day(&tromso, date(2024, 12, 21))?, Day::AlwaysDown { .. }));
/// # Ok::<(), lightvein::sky::sun::SunError>(())
/// ```
pub fn day(place: &Place, date: Date) -> Result<Day, SunError> {
    let location = location(place)?;
    let delta_t_s = delta_t_s(date)?;
    let noon = julian_day(place, date.at(12, 0, 0, 0));
    let search = SolarEvents::new();

    // The transit before or at half a day past noon, whichever is nearer; transits are up to 30 s more than a day apart.
    let slack = 0.001;
    let nearest = [noon - 0.5 - slack, noon + 0.5 - slack].into_iter().find_map(|from| {
        search.next_transit_from_julian(from, from + 1.0 + 2.0 * slack, location.longitude, delta_t_s).transpose()
    });
    let transit_julian = nearest.transpose()?.ok_or(SunError::Calendar)?;

    let found = search.for_interval_from_julian(
        transit_julian - 0.5,
        transit_julian + 0.5,
        location,
        delta_t_s,
        Horizon::Custom(SUNRISE_ELEVATION_DEG),
    )?;
    let transit = local_time(place, transit_julian)?;
    let sunrise = found.rises.first().map(|&julian| local_time(place, julian)).transpose()?;
    // A sunset before the sunrise ends the light of the date before.
    let is_of_this_day = |set: &&f64| found.rises.first().is_none_or(|rise| *set > rise);
    let sunset = found.sets.last().filter(is_of_this_day).map(|&julian| local_time(place, julian)).transpose()?;
    Ok(match (sunrise, sunset) {
        (Some(sunrise), Some(sunset)) => Day::Normal { sunrise, transit, sunset },
        (Some(sunrise), None) => Day::OnlyRises { sunrise, transit },
        (None, Some(sunset)) => Day::OnlySets { transit, sunset },
        (None, None) if found.state_at_start == HorizonState::Above => Day::AlwaysUp { transit },
        (None, None) => Day::AlwaysDown { transit },
    })
}

/// All sunrises and sunsets of a date of the calendar, from midnight of the clock up to the next. About 0.7 ms.
///
/// # Errors
/// A place or a year outside its bounds.
pub fn crossings(place: &Place, date: Date) -> Result<Crossings, SunError> {
    let midnight = date.at(0, 0, 0, 0);
    let next = midnight.checked_add(1.day()).map_err(|_| SunError::Calendar)?;
    let found = SolarEvents::new().for_interval_from_julian(
        julian_day(place, midnight),
        julian_day(place, next),
        location(place)?,
        delta_t_s(date)?,
        Horizon::Custom(SUNRISE_ELEVATION_DEG),
    )?;
    let local = |&julian: &f64| local_time(place, julian);
    Ok(Crossings {
        is_up_at_start: found.state_at_start == HorizonState::Above,
        sunrises: found.rises.iter().map(local).collect::<Result<_, _>>()?,
        sunsets: found.sets.iter().map(local).collect::<Result<_, _>>()?,
    })
}
