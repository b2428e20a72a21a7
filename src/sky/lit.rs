//! When is the sun up on a date, fast?
//!
//! Between its lowest and its highest stand of a day the sun only rises, and after it only sinks. So one look at each of
//! them, and at the two midnights of the clock, tells how often it crosses the horizon between; each crossing is then found
//! by false position (Illinois). A fifth of what [`crossings`](super::events::crossings) takes, which searches without
//! knowing; the test holds the two to a second of each other.
//!
//! Limits: at the poles themselves the sun has no daily course; there it is up or down for all of a day but those two of
//! the year on which it crosses, and on those from the hour on which it does.

use super::Place;
use super::events::SUNRISE_ELEVATION_DEG;
use super::sun::{SunError, delta_t_s, position_with_delta_t};
use jiff::SignedDuration;
use jiff::civil::Date;

/// A crossing is found to this much, hours: a fifth of a second.
const PRECISE_H: f64 = 5e-5;

/// More steps than a crossing ever takes.
const MOST_STEPS: usize = 60;

/// The stretches of a date, hours since its midnight, on which the sun's upper limb is above the horizon. About 0.1 ms.
///
/// # Errors
/// A place or a year outside its bounds.
pub fn lit_hours(place: &Place, date: Date) -> Result<Vec<[f64; 2]>, SunError> {
    let delta_t_s = delta_t_s(date)?;
    let above = |hour: f64| -> Result<f64, SunError> {
        let since_midnight = SignedDuration::from_nanos((hour * 3.6e12).round() as i64);
        let time = date.at(0, 0, 0, 0).checked_add(since_midnight).map_err(|_| SunError::Calendar)?;
        Ok(position_with_delta_t(place, time, None, delta_t_s)?.elevation_rad - SUNRISE_ELEVATION_DEG.to_radians())
    };

    // The two midnights, and noon and midnight of the sun between them.
    let noon_h = noon_h(place, date);
    let turns = (-2..=2).map(|half| noon_h + 12.0 * f64::from(half)).filter(|hour| (0.0..24.0).contains(hour));
    let mut looks = vec![0.0];
    looks.extend(turns);
    looks.push(24.0);

    let mut spans = Vec::new();
    let (mut from, mut height) = (0.0, above(0.0)?);
    let mut rise = (height > 0.0).then_some(0.0);
    for &to in &looks[1..] {
        let next = above(to)?;
        if (height > 0.0) != (next > 0.0) {
            let crossing = crossing_h(&above, [from, to], [height, next])?;
            match rise.take() {
                Some(rise) => spans.push([rise, crossing]),
                None => rise = Some(crossing),
            }
        }
        (from, height) = (to, next);
    }
    spans.extend(rise.map(|rise| [rise, 24.0]));
    Ok(spans)
}

/// The sun's noon by the clock, hours, within a minute: the mean sun's, and the equation of time (Spencer 1971). Close enough
/// to the top of the sun's course to stand as high as there.
fn noon_h(place: &Place, date: Date) -> f64 {
    let (sin, cos) = super::sun::day_angle_rad(date).sin_cos();
    let (sin2, cos2) = (2.0 * super::sun::day_angle_rad(date)).sin_cos();
    let equation_rad = 0.000_075 + 0.001_868 * cos - 0.032_077 * sin - 0.014_615 * cos2 - 0.040_849 * sin2;
    let hours = 12.0 + place.utc_offset_h - (place.longitude_rad + equation_rad).to_degrees() / 15.0;
    hours.rem_euclid(24.0)
}

/// Where a height changes its sign between two hours.
fn crossing_h(
    above: &impl Fn(f64) -> Result<f64, SunError>,
    [mut from, mut to]: [f64; 2],
    [mut at_from, mut at_to]: [f64; 2],
) -> Result<f64, SunError> {
    for _ in 0..MOST_STEPS {
        let hour = (from * at_to - to * at_from) / (at_to - at_from);
        let height = above(hour)?;
        if (height > 0.0) == (at_to > 0.0) {
            // The end that stays twice counts half, or the other would creep.
            if (hour - to).abs() < PRECISE_H {
                return Ok(hour);
            }
            (to, at_to) = (hour, height);
            at_from /= 2.0;
        } else {
            if (hour - from).abs() < PRECISE_H {
                return Ok(hour);
            }
            (from, at_from) = (hour, height);
            at_to /= 2.0;
        }
    }
    Ok((from + to) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::events::crossings;
    use jiff::ToSpan;
    use jiff::civil::date;

    /// The spans by the slow search.
    fn searched(place: &Place, date: Date) -> Vec<[f64; 2]> {
        let found = crossings(place, date).unwrap();
        let hours = |time: &jiff::civil::DateTime| time.duration_since(date.at(0, 0, 0, 0)).as_secs_f64() / 3600.0;
        let mut rises: Vec<f64> = found.sunrises.iter().map(hours).collect();
        let mut sets: Vec<f64> = found.sunsets.iter().map(hours).collect();
        if found.is_up_at_start {
            rises.insert(0, 0.0);
        }
        if rises.len() > sets.len() {
            sets.push(24.0);
        }
        rises.into_iter().zip(sets).map(|(rise, set)| [rise, set]).collect()
    }

    #[test]
    fn light_is_where_the_slow_search_finds_it() {
        const SECOND_H: f64 = 1.0 / 3600.0;
        for (latitude, longitude, zone) in [
            (0.0, 0.0, 0.0),
            (42.0, -88.0, -6.0),
            (51.5, 0.0, 12.0),
            (69.65, 18.96, 1.0),
            (-77.8, 166.7, 12.0),
            (65.8, 24.1, -3.0),
        ] {
            let place = Place::from_degrees(latitude, longitude, zone);
            for day in (0..366).step_by(3) {
                let date = date(2024, 1, 1).checked_add(day.days()).unwrap();
                let (fast, slow) = (lit_hours(&place, date).unwrap(), searched(&place, date));
                // Light of a few seconds, where the sun only just shows, may be seen by one and not by the other.
                let long = |spans: &[[f64; 2]]| -> Vec<[f64; 2]> {
                    spans.iter().copied().filter(|[from, to]| to - from > 60.0 * SECOND_H).collect()
                };
                let (fast, slow) = (long(&fast), long(&slow));
                assert_eq!(fast.len(), slow.len(), "{latitude} {date}: {fast:?} {slow:?}");
                for (fast, slow) in fast.iter().zip(&slow) {
                    let off = (fast[0] - slow[0]).abs().max((fast[1] - slow[1]).abs());
                    assert!(off < 1.5 * SECOND_H, "{latitude} {date}: {fast:?} {slow:?}");
                }
            }
        }
    }

    #[test]
    fn the_last_day_of_the_years_that_are_known_has_its_light() {
        let place = Place::from_degrees(0.0, 0.0, 0.0);
        let [[from, to]] = lit_hours(&place, date(3000, 12, 31)).unwrap()[..] else { panic!("one stretch") };
        assert!((to - from - 12.1).abs() < 0.1);
    }

    #[test]
    fn at_the_poles_half_a_year_is_lit() {
        for latitude in [90.0, -90.0] {
            let place = Place::from_degrees(latitude, 0.0, 0.0);
            let days = (0..365).map(|day| date(2025, 1, 1).checked_add(day.days()).unwrap());
            let lit: f64 = days.flat_map(|date| lit_hours(&place, date).unwrap()).map(|[from, to]| to - from).sum();
            assert!((lit / 24.0 - 187.0).abs() < 8.0, "{} days", lit / 24.0);
        }
    }
}
