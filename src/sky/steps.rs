//! In which steps is a period taken, where does the sun stand in each, and what do sun and sky bring in it?
//!
//! A step is a part of the day with the sun up. Its sun stands in the middle of its lit part, not of the clock's hour: in the
//! hours of sunrise and sunset the middle of the hour may be night, and a beam from below the horizon would be lost. What a
//! weather file gives as the mean of an hour is the energy of the hour's lit part. No energy is dropped silently:
//! - diffuse light of an hour without sun is twilight, and comes from a sky with the sun on the horizon;
//! - a beam in an hour without sun cannot be; it is left out, summed up in [`Steps::night_beam_kwh_m2`] and warned of.
//!
//! The sun's elevation is the one seen, refraction and all, and never below 0.
//!
//! Limits: within an hour of weather the beam is even; a step longer than an hour has one sun for all of it.

use super::clear::Irradiance;
use super::lit::lit_hours;
use super::sun::{Air, SunError, eccentricity, position};
use super::weather::{Hour, Weather};
use super::{Place, Sun};
use crate::job::Cancel;
use jiff::SignedDuration;
use jiff::civil::{Date, DateTime};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Part of the year, and how finely it is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Period {
    /// First day, month and day of the month.
    pub first: (i8, i8),
    /// Last day, itself included; before the first, the period goes on over the turn of the year.
    pub last: (i8, i8),
    /// Length of a step, minutes; steps count from midnight, and the last of a day ends with it.
    pub step_min: f64,
}

impl Period {
    /// All of a year, hour by hour.
    pub const YEAR: Self = Self { first: (1, 1), last: (12, 31), step_min: 60.0 };

    /// One day.
    pub fn day(date: Date, step_min: f64) -> Self {
        let day = (date.month(), date.day());
        Self { first: day, last: day, step_min }
    }

    /// Whether a date is in it, in any year.
    pub fn holds(&self, date: Date) -> bool {
        let day = (date.month(), date.day());
        let (from, to) = (day >= self.first, day <= self.last);
        if self.first <= self.last { from && to } else { from || to }
    }
}

/// A lit part of a day.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Its middle, local standard time.
    pub time: DateTime,
    /// Its length, hours.
    pub hours: f64,
    /// Where the sun is seen then, on the horizon or above.
    pub sun: Sun,
    /// Direct normal irradiance, the mean of the step, W/m2.
    pub dni_w_m2: f64,
    /// Diffuse horizontal irradiance, the mean of the step, W/m2.
    pub dhi_w_m2: f64,
    /// Square of the sun's mean distance over that of the day.
    pub eccentricity: f64,
}

/// A period in steps, in the order of time.
#[derive(Debug, Clone, Default)]
pub struct Steps {
    /// The steps with the sun up, and those without in which weather has diffuse light.
    pub steps: Vec<Step>,
    /// Beam that the weather has in hours without sun, and that is left out, kWh/m2.
    pub night_beam_kwh_m2: f64,
    /// Diffuse light in hours without sun, which is in the steps, kWh/m2.
    pub twilight_kwh_m2: f64,
    /// The weather's own global horizontal irradiation in the period, kWh/m2; `None` where it has none.
    pub measured_ghi_kwh_m2: Option<f64>,
    /// What a user should hear.
    pub warnings: Vec<String>,
}

/// Irradiation of a period, kWh/m2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    /// On level open ground: `sum (DNI sin elevation + DHI)`.
    pub ghi_kwh_m2: f64,
    /// On a plane that follows the sun, the beam alone.
    pub dni_kwh_m2: f64,
    /// On level open ground, the sky without the sun.
    pub dhi_kwh_m2: f64,
}

impl Steps {
    /// What the steps bring together.
    pub fn totals(&self) -> Totals {
        let mut totals = Totals::default();
        for step in &self.steps {
            let (dni, dhi) = (step.dni_w_m2 * step.hours / 1000.0, step.dhi_w_m2 * step.hours / 1000.0);
            totals.dni_kwh_m2 += dni;
            totals.dhi_kwh_m2 += dhi;
            totals.ghi_kwh_m2 += dni * step.sun.elevation_rad.sin() + dhi;
        }
        totals
    }
}

/// A stretch of a day: its hours since midnight, and what it brings.
#[derive(Debug, Clone, Copy)]
struct Piece {
    date: Date,
    hours: [f64; 2],
    /// The lit part of it, hours.
    lit_h: f64,
    dni_wh_m2: f64,
    dhi_wh_m2: f64,
}

/// The steps of a period at a place under measured weather, its own or a neighbour's; dates are those of its own rows.
/// About 0.2 ms a day of hours.
///
/// # Errors
/// A place or a year beyond what the sun's position is known for, or [`SunError::Cancelled`].
pub fn of_weather(place: &Place, weather: &Weather, period: &Period, cancel: &Cancel) -> Result<Steps, SunError> {
    let hours: Vec<&Hour> = weather.hours.iter().filter(|hour| period.holds(hour.start.date())).collect();
    let light = light_by_date(place, hours.iter().map(|hour| hour.start.date()), cancel)?;

    let mut found = Steps::default();
    let mut pieces = Vec::new();
    for hour in &hours {
        let date = hour.start.date();
        let from = hours_since_midnight(hour.start, date);
        let lit = overlaps(light.get(&date).map_or(&[], Vec::as_slice), [from, from + hour.length_h]);
        let lit_h: f64 = lit.iter().map(|[from, to]| to - from).sum();
        let (dni_wh_m2, dhi_wh_m2) = (hour.dni_w_m2 * hour.length_h, hour.dhi_w_m2 * hour.length_h);
        if lit_h > 0.0 {
            for span in lit.iter().flat_map(|&span| cut(span, period.step_min / 60.0)) {
                let share = (span[1] - span[0]) / lit_h;
                let (dni_wh_m2, dhi_wh_m2) = (dni_wh_m2 * share, dhi_wh_m2 * share);
                pieces.push(Piece { date, hours: span, lit_h: span[1] - span[0], dni_wh_m2, dhi_wh_m2 });
            }
        } else {
            found.night_beam_kwh_m2 += dni_wh_m2 / 1000.0;
            found.twilight_kwh_m2 += dhi_wh_m2 / 1000.0;
            let span = [from, from + hour.length_h];
            pieces.push(Piece { date, hours: span, lit_h: hour.length_h, dni_wh_m2: 0.0, dhi_wh_m2 });
        }
    }
    pieces.retain(|piece| piece.dni_wh_m2 > 0.0 || piece.dhi_wh_m2 > 0.0);
    found.steps = steps(place, &joined(pieces, period.step_min / 60.0), cancel)?;
    found.measured_ghi_kwh_m2 = hours.iter().map(|hour| hour.ghi_w_m2.map(|ghi| ghi * hour.length_h / 1000.0)).sum();
    if found.night_beam_kwh_m2 > 0.0 {
        found.warnings.push(format!(
            "the weather has {:.3} kWh/m2 of direct beam in hours without sun; it is left out",
            found.night_beam_kwh_m2
        ));
    }
    if hours.is_empty() {
        found.warnings.push("the weather has no hours in the period".into());
    } else if found.steps.is_empty() {
        found.warnings.push("the weather has no light in the period: sun and sky bring nothing".into());
    }
    Ok(found)
}

/// The steps of a period of a year under a clear sky, which answers for the sun and the day's eccentricity.
///
/// # Errors
/// A place or a year beyond what the sun's position is known for, or [`SunError::Cancelled`].
pub fn of_clear_sky(
    place: &Place,
    year: i16,
    period: &Period,
    clear: impl Fn(Sun, f64) -> Irradiance + Sync,
    cancel: &Cancel,
) -> Result<Steps, SunError> {
    let first = Date::new(year, 1, 1).map_err(|_| SunError::Calendar)?;
    let days = first.series(jiff::ToSpan::day(1)).take_while(|date| date.year() == year);
    let light = light_by_date(place, days.filter(|&date| period.holds(date)), cancel)?;
    let pieces: Vec<Piece> = light
        .iter()
        .flat_map(|(&date, spans)| spans.iter().map(move |&span| (date, span)))
        .flat_map(|(date, span)| cut(span, period.step_min / 60.0).map(move |hours| (date, hours)))
        .map(|(date, hours)| Piece { date, hours, lit_h: hours[1] - hours[0], dni_wh_m2: 0.0, dhi_wh_m2: 0.0 })
        .collect();

    let mut found = steps(place, &joined(pieces, period.step_min / 60.0), cancel)?;
    found.par_iter_mut().try_for_each(|step| {
        let Irradiance { dni_w_m2, dhi_w_m2 } = clear(step.sun, step.eccentricity);
        (step.dni_w_m2, step.dhi_w_m2) = (dni_w_m2, dhi_w_m2);
        cancel.check()
    })?;
    let mut warnings = Vec::new();
    if found.is_empty() {
        warnings.push("the sun does not rise in the period: sun and sky bring nothing".into());
    }
    Ok(Steps { steps: found, warnings, ..Steps::default() })
}

/// When the sun is up on each date, hours since midnight.
fn light_by_date(
    place: &Place,
    dates: impl Iterator<Item = Date>,
    cancel: &Cancel,
) -> Result<BTreeMap<Date, Vec<[f64; 2]>>, SunError> {
    let dates: std::collections::BTreeSet<Date> = dates.collect();
    let dates: Vec<Date> = dates.into_iter().collect();
    let lit = |date| {
        cancel.check()?;
        Ok((date, lit_hours(place, date)?))
    };
    dates.into_par_iter().map(lit).collect()
}

/// The parts of `spans` inside a stretch.
fn overlaps(spans: &[[f64; 2]], [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let parts = spans.iter().map(|&[start, end]| [start.max(from), end.min(to)]);
    parts.filter(|[start, end]| start < end).collect()
}

/// A stretch cut where steps of so many hours begin.
fn cut([from, to]: [f64; 2], step_h: f64) -> impl Iterator<Item = [f64; 2]> {
    let first = (from / step_h).floor() as usize;
    let last = (to / step_h).ceil() as usize;
    let parts = (first..last).map(move |step| [(step as f64 * step_h).max(from), ((step + 1) as f64 * step_h).min(to)]);
    parts.filter(|[start, end]| start < end)
}

/// Pieces that follow each other in the same step as one.
fn joined(pieces: Vec<Piece>, step_h: f64) -> Vec<Piece> {
    let step = |piece: &Piece| ((piece.hours[0] + piece.hours[1]) / 2.0 / step_h).floor();
    let mut joined: Vec<Piece> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        match joined.last_mut() {
            Some(last)
                if last.date == piece.date
                    && step(last) == step(&piece)
                    && (last.hours[1] - piece.hours[0]).abs() < 1e-9 =>
            {
                last.hours[1] = piece.hours[1];
                last.lit_h += piece.lit_h;
                last.dni_wh_m2 += piece.dni_wh_m2;
                last.dhi_wh_m2 += piece.dhi_wh_m2;
            }
            _ => joined.push(piece),
        }
    }
    joined
}

/// Steps of pieces, each with its sun.
fn steps(place: &Place, pieces: &[Piece], cancel: &Cancel) -> Result<Vec<Step>, SunError> {
    let step = |piece: &Piece| {
        cancel.check()?;
        let middle_h = (piece.hours[0] + piece.hours[1]) / 2.0;
        let since_midnight = SignedDuration::from_nanos((middle_h * 3.6e12).round() as i64);
        let midnight = piece.date.at(0, 0, 0, 0);
        let time = midnight.checked_add(since_midnight).map_err(|_| SunError::Calendar)?;
        let seen = position(place, time, Some(Air::STANDARD))?;
        Ok(Step {
            time,
            hours: piece.lit_h,
            sun: Sun { elevation_rad: seen.elevation_rad.max(0.0), ..seen },
            dni_w_m2: piece.dni_wh_m2 / piece.lit_h,
            dhi_w_m2: piece.dhi_wh_m2 / piece.lit_h,
            eccentricity: eccentricity(piece.date),
        })
    };
    pieces.par_iter().map(step).collect()
}

fn hours_since_midnight(time: DateTime, date: Date) -> f64 {
    time.duration_since(date.at(0, 0, 0, 0)).as_secs_f64() / 3600.0
}
