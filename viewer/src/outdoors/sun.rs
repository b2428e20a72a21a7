//! The sun at the shown moment: where it stands, its day's path, when it rises and sets, and the colours of the sky around it.
//!
//! The colours are Preetham's, Shirley's and Smits' of a clear sky (Perez' form, [`lightvein::sky::colour`]), whatever the
//! weather: they show where the light comes from and how the day goes, not what was measured.

use super::light;
use crate::paint::SkyLight;
use jiff::SignedDuration;
use jiff::civil::{Date, DateTime};
use lightvein::sky::colour::{Preetham, luminance, tone_mapped};
use lightvein::sky::events::{self, Day};
use lightvein::sky::site::Outdoors;
use lightvein::sky::sun::{Air, SunError, position};
use lightvein::sky::{Place, Sun};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Minutes between the points of a day's path; 2.5 degrees of the sun's turn.
const STEP_MIN: i64 = 10;

/// Columns and rows of the dome: 5 degrees a side.
pub const DOME: [usize; 2] = [72, 18];

/// The dome is tone-mapped like the sky's pictures: this share of it is darker than what shows at 63% ...
const WHITE_SHARE: f64 = 0.8;

/// ... unless the sky is dimmer than this, kcd/m2, some minutes before sunrise: twilight and night are to look dark.
pub(super) const LEAST_WHITE: f64 = 0.7;

/// What depends on the date.
#[derive(Debug, Clone, PartialEq)]
pub struct SunDay {
    /// Where.
    pub place: Place,
    /// On which date.
    pub date: Date,
    /// When the sun rises, culminates and sets, if it does; local standard time.
    pub events: Day,
    /// Where the sun stands from midnight to midnight, every ten minutes.
    pub path: Vec<Sun>,
    /// Where it stands at each full hour.
    pub hours: Vec<Sun>,
}

impl SunDay {
    /// The sun's day at a place. About 2 ms.
    ///
    /// # Errors
    /// A place or a year out of bounds.
    pub fn of(place: Place, date: Date) -> Result<Self, SunError> {
        let midnight = date.at(0, 0, 0, 0);
        let after = |minutes: i64| {
            let time = midnight.checked_add(SignedDuration::from_mins(minutes)).map_err(|_| SunError::Calendar)?;
            position(&place, time, Some(Air::STANDARD))
        };
        Ok(Self {
            place,
            date,
            events: events::day(&place, date)?,
            path: (0..=24 * 60 / STEP_MIN).map(|step| after(step * STEP_MIN)).collect::<Result<_, _>>()?,
            hours: (0..24).map(|hour| after(60 * hour)).collect::<Result<_, _>>()?,
        })
    }

    /// Sunrise and sunset in words.
    pub fn words(&self) -> String {
        let clock = |time: DateTime| {
            let days = time.date().since(self.date).map_or(0, |span| span.get_days());
            let aside = match days {
                0 => String::new(),
                days => format!(" ({days:+} day)"),
            };
            format!("{}{aside}", time.strftime("%H:%M"))
        };
        match self.events {
            Day::Normal { sunrise, sunset, .. } => format!("Sunrise {}, sunset {}", clock(sunrise), clock(sunset)),
            Day::OnlyRises { sunrise, .. } => format!("Sunrise {}; polar day begins, no sunset", clock(sunrise)),
            Day::OnlySets { sunset, .. } => format!("Sunset {}; polar day ends, no sunrise", clock(sunset)),
            Day::AlwaysUp { .. } => "Polar day: the sun does not set".to_owned(),
            Day::AlwaysDown { .. } => "Polar night: the sun does not rise".to_owned(),
        }
    }
}

/// The sun and the sky at a moment.
#[derive(Debug, Clone, PartialEq)]
pub struct SunNow {
    /// The moment, local standard time.
    pub moment: DateTime,
    /// Where the sun is seen.
    pub sun: Sun,
    /// What both cast, in the scene.
    pub light: SkyLight,
    /// Colours of the sky, sRGB, at the corners of the dome's cells: [`DOME`] columns clockwise from true north in each of its
    /// rows from the horizon up, and a last row at the zenith.
    pub colours: Vec<[u8; 3]>,
}

impl SunNow {
    /// The sun and the sky of a site at a moment. About a millisecond.
    ///
    /// # Errors
    /// A place or a year out of bounds.
    pub fn of(outdoors: &Outdoors, moment: DateTime) -> Result<Self, SunError> {
        let sun = position(&outdoors.place, moment, Some(Air::STANDARD))?;
        let sky = Preetham::new(sun.elevation_rad, outdoors.haze.turbidity);
        let towards_sun = sun.towards();
        let [columns, rows] = DOME;
        let rgb: Vec<[f64; 3]> = (0..columns * (rows + 1))
            .map(|corner| {
                let view = dome_corner(corner % columns, corner / columns);
                sky.rgb(view.z, view.dot(towards_sun))
            })
            .collect();
        let white = white(&rgb);
        let light = light::of(outdoors, moment, sun, &sky, white);
        Ok(Self { moment, sun, light, colours: rgb.into_iter().map(|rgb| tone_mapped(rgb, white)).collect() })
    }
}

/// The direction of a corner of the dome's cells: x east, y true north, z up.
pub fn dome_corner(column: usize, row: usize) -> glam::DVec3 {
    let [columns, rows] = DOME.map(|cells| cells as f64);
    lightvein::sky::towards(TAU * column as f64 / columns, FRAC_PI_2 * row as f64 / rows)
}

/// The luminance that shows at 63%, kcd/m2.
fn white(rgb: &[[f64; 3]]) -> f64 {
    let mut levels: Vec<f64> = rgb.iter().map(|rgb| luminance(*rgb)).collect();
    let at = (WHITE_SHARE * levels.len().saturating_sub(1) as f64).round() as usize;
    levels.sort_unstable_by(f64::total_cmp);
    levels.get(at).copied().unwrap_or(0.0).max(LEAST_WHITE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jiff::civil::date;
    use lightvein::scene::Site;

    fn outdoors(latitude_deg: f64) -> Outdoors {
        let site = Site {
            latitude_deg: Some(latitude_deg),
            longitude_deg: Some(0.0),
            utc_offset_h: Some(0.0),
            ..Site::default()
        };
        Outdoors::of(&site, None).unwrap()
    }

    fn level(colours: &[[u8; 3]]) -> f64 {
        colours.iter().flatten().map(|&code| f64::from(code)).sum::<f64>() / (3 * colours.len()) as f64
    }

    /// The worked example of Reda & Andreas (2004): zenith angle 50.11162 degrees, azimuth 194.34024, without its air and
    /// height, which move it by less than 0.02 degrees.
    #[test]
    fn the_sun_stands_where_its_algorithm_was_published_to_have_it() {
        let mut outdoors = outdoors(0.0);
        outdoors.place = Place::from_degrees(39.742_476, -105.178_6, -7.0);
        let now = SunNow::of(&outdoors, date(2003, 10, 17).at(12, 30, 30, 0)).unwrap();
        assert!((90.0 - now.sun.elevation_rad.to_degrees() - 50.1116).abs() < 0.02, "{:?}", now.sun);
        assert!((now.sun.azimuth_rad.to_degrees() - 194.3402).abs() < 0.001, "{:?}", now.sun);
    }

    /// The US Naval Observatory's table: Brasilia on 15 January 2020, sunrise 08:52 and sunset 21:50, universal time.
    #[test]
    fn a_day_has_its_almanacs_sunrise_and_sunset() {
        let day = SunDay::of(Place::from_degrees(-15.8, -47.85, -3.0), date(2020, 1, 15)).unwrap();
        let minutes = |time: Option<DateTime>| {
            let time = time.unwrap().time();
            i32::from(time.hour()) * 60 + i32::from(time.minute())
        };
        assert!((minutes(day.events.sunrise()) - (5 * 60 + 52)).abs() <= 1, "{:?}", day.events);
        assert!((minutes(day.events.sunset()) - (18 * 60 + 50)).abs() <= 1, "{:?}", day.events);
        assert_eq!((day.path.len(), day.hours.len()), (145, 24));
        assert_eq!(day.path[72], day.hours[12]);
        assert!(day.words().starts_with("Sunrise 05:5"), "{}", day.words());
    }

    #[test]
    fn polar_days_and_nights_are_told_in_words() {
        let tromso = Place::from_degrees(69.65, 18.96, 1.0);
        let words = |month| SunDay::of(tromso, date(2024, month, 21)).unwrap().words();
        assert_eq!(words(6), "Polar day: the sun does not set");
        assert_eq!(words(12), "Polar night: the sun does not rise");
    }

    #[test]
    fn the_sky_is_blue_at_noon_brightest_at_the_sun_and_dark_at_night() {
        let outdoors = outdoors(45.0);
        let at = |hour| SunNow::of(&outdoors, date(2025, 6, 21).at(hour, 0, 0, 0)).unwrap();
        let noon = at(12);
        assert_eq!(noon.colours.len(), 72 * 19);
        // The north half way up: blue; the sun stands in the south at 68 degrees.
        let [r, _, b] = noon.colours[72 * 9];
        assert!(b > r, "{r} {b}");
        let brightness = |column: usize, row: usize| noon.colours[72 * row + column].map(u32::from).iter().sum::<u32>();
        assert!(brightness(36, 14) > brightness(0, 14));
        let levels = [12, 20, 21, 0].map(|hour| level(&at(hour).colours));
        assert!(levels.windows(2).all(|pair| pair[1] < pair[0]) && levels[3] < 1.0, "{levels:?}");
    }
}
