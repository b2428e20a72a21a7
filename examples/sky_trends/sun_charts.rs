//! Pictures of the sun: its paths, how it meets a facade, how far off the simple formula's sunrise is.

use jiff::SignedDuration;
use jiff::civil::{Date, DateTime, date};
use lightvein::export::curves::{self, Axis, Curve, Panel};
use lightvein::export::{sun_path, sun_path::SunPath, whole_file};
use lightvein::sky::facade::{ShadowAngles, shadow_angles};
use lightvein::sky::sun::{self, Air, SunError};
use lightvein::sky::{Place, events, simple_sun};
use std::error::Error;
use std::path::Path;

/// The year of the paper whose table is compared with.
pub const YEAR: i16 = 2012;

/// Places by name, latitude, longitude and zone: the paper's, and one where the sun keeps to the south.
const PLACES: [(&str, [f64; 3]); 2] = [("Johor Bahru", [1.47, 103.75, 8.0]), ("Chicago", [41.98, -87.92, -6.0])];

/// The facade of the charts, degrees clockwise from north: south.
const FACADE_DEG: f64 = 180.0;

const FACADE_DAYS: [(i8, &str); 4] = [(3, "21 March"), (6, "21 June"), (9, "21 September"), (12, "21 December")];
const FACADE_HOURS: [i8; 5] = [8, 10, 12, 14, 16];

/// Latitudes at whose meridian of Greenwich the sunrise is compared.
const LATITUDES_DEG: [f64; 4] = [25.0, 45.0, 55.0, 63.0];

pub fn johor_bahru() -> Place {
    place(PLACES[0].1)
}

fn place([latitude_deg, longitude_deg, utc_offset_h]: [f64; 3]) -> Place {
    Place::from_degrees(latitude_deg, longitude_deg, utc_offset_h)
}

/// Writes all of them into a folder.
pub fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    for (name, at) in PLACES {
        let path = SunPath::of(&place(at), YEAR)?;
        let file = format!("sun_path_{}.svg", name.to_lowercase().replace(' ', "_"));
        whole_file(&folder.join(file), |out| sun_path::write_svg(out, &path, name))?;
    }
    let [by_hour, by_day] = [at_both_places(facade_by_hour)?, at_both_places(facade_by_day)?];
    whole_file(&folder.join("facade_by_hour.svg"), |out| curves::write(out, &by_hour, 2))?;
    whole_file(&folder.join("facade_by_day.svg"), |out| curves::write(out, &by_day, 2))?;
    let panels = sunrise_errors()?;
    whole_file(&folder.join("sunrise_error.svg"), |out| curves::write(out, &panels, 2))?;
    Ok(())
}

fn at_both_places(panels: fn(&str, Place) -> Result<Vec<Panel>, SunError>) -> Result<Vec<Panel>, SunError> {
    let panels = PLACES.iter().map(|(name, at)| panels(name, place(*at)));
    Ok(panels.collect::<Result<Vec<_>, _>>()?.concat())
}

/// Shadow angles along an axis.
struct Shadows {
    name: String,
    /// A place along the axis, and HSA and VSA, degrees.
    points: Vec<(f64, [f64; 2])>,
}

/// HSA and VSA, degrees; not numbers where the sun is down or behind.
fn angles_deg(place: &Place, time: DateTime) -> Result<[f64; 2], SunError> {
    let sun = sun::position(place, time, Some(Air::STANDARD))?;
    Ok(match shadow_angles(sun, FACADE_DEG.to_radians()) {
        ShadowAngles::Front { horizontal_rad, vertical_rad } => [horizontal_rad, vertical_rad].map(f64::to_degrees),
        ShadowAngles::Behind { .. } | ShadowAngles::Down => [f64::NAN; 2],
    })
}

/// Two panels: HSA and VSA.
fn two_panels(name: &str, x: Axis, curves: &[Shadows]) -> Vec<Panel> {
    let panel = |number: usize, title: &str, y: Axis| Panel {
        title: format!("{name}, south facade: {title}"),
        x: x.clone(),
        y,
        curves: curves
            .iter()
            .map(|Shadows { name, points }| Curve {
                name: name.clone(),
                points: points.iter().map(|(x, angles)| [*x, angles[number]]).collect(),
            })
            .collect(),
    };
    vec![
        panel(0, "horizontal shadow angle", Axis::every("HSA (degrees, west positive)", [-90.0, 90.0], 30.0)),
        panel(1, "vertical shadow angle", Axis::every("VSA (degrees)", [0.0, 90.0], 15.0)),
    ]
}

fn facade_by_hour(name: &str, place: Place) -> Result<Vec<Panel>, SunError> {
    let curve = |(month, name): (i8, &str)| {
        let midnight = date(YEAR, month, 21).at(0, 0, 0, 0);
        let point = |step: i64| {
            let time = midnight + SignedDuration::from_mins(5 * step);
            Ok((step as f64 / 12.0, angles_deg(&place, time)?))
        };
        let points = (4 * 12..=21 * 12).map(point).collect::<Result<_, SunError>>()?;
        Ok(Shadows { name: name.to_owned(), points })
    };
    let curves = FACADE_DAYS.into_iter().map(curve).collect::<Result<Vec<_>, SunError>>()?;
    Ok(two_panels(name, Axis::every("hour of the day (local standard time)", [4.0, 21.0], 1.0), &curves))
}

fn facade_by_day(name: &str, place: Place) -> Result<Vec<Panel>, SunError> {
    let curve = |hour: i8| {
        let point = |day: Date| Ok((f64::from(day.day_of_year()), angles_deg(&place, day.at(hour, 0, 0, 0))?));
        let points = days().step_by(2).map(point).collect::<Result<_, SunError>>()?;
        Ok(Shadows { name: format!("{hour} h"), points })
    };
    let curves = FACADE_HOURS.into_iter().map(curve).collect::<Result<Vec<_>, SunError>>()?;
    Ok(two_panels(name, Axis::days_of_the_year(), &curves))
}

/// All days of the year.
pub fn days() -> impl Iterator<Item = Date> {
    let first = date(YEAR, 1, 1);
    (0..i64::from(first.days_in_year())).map(move |day| first + SignedDuration::from_hours(24 * day))
}

/// Minutes by which the simple formula is late, for sunrise and sunset; not numbers where either has none.
pub fn late_min(place: &Place, day: Date) -> Result<[f64; 2], SunError> {
    let [exact, simple] = [events::day(place, day)?, simple_sun::day(place, day)?];
    let late = |simple: Option<DateTime>, exact: Option<DateTime>| {
        let both = simple.zip(exact);
        both.map_or(f64::NAN, |(simple, exact)| simple.duration_since(exact).as_secs_f64() / 60.0)
    };
    Ok([late(simple.sunrise(), exact.sunrise()), late(simple.sunset(), exact.sunset())])
}

fn sunrise_errors() -> Result<Vec<Panel>, SunError> {
    let johor = ("1.5\u{b0} N (Johor)".to_owned(), johor_bahru());
    let others = LATITUDES_DEG.map(|latitude| (format!("{latitude}\u{b0} N"), place([latitude, 0.0, 0.0])));
    let mut curves = [Vec::new(), Vec::new()];
    for (name, place) in std::iter::once(johor).chain(others) {
        let late = days().step_by(2).map(|day| Ok((f64::from(day.day_of_year()), late_min(&place, day)?)));
        let late: Vec<(f64, [f64; 2])> = late.collect::<Result<_, SunError>>()?;
        for (event, curves) in curves.iter_mut().enumerate() {
            let points = late.iter().map(|(day, late_min)| [*day, late_min[event]]).collect();
            curves.push(Curve { name: name.clone(), points });
        }
    }
    let panel = |(title, curves): (&str, Vec<Curve>)| Panel {
        title: format!("{title} by the simple formula, {YEAR}"),
        x: Axis::days_of_the_year(),
        y: Axis::every("minutes later than SPA", [-6.0, 6.0], 2.0),
        curves,
    };
    Ok(["Sunrise", "Sunset"].into_iter().zip(curves).map(panel).collect())
}
