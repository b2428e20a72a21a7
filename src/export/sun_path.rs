//! The sun's paths over a place, as a diagram of the sky dome and as a table.
//!
//! The diagram is stereographic, as planners use it: seen from above with north up and east to the right, the zenith in the
//! middle, the horizon the outer circle, elevations as rings; angles on the dome are kept. Curves: the paths of the 21st of
//! December to June (the other months nearly repeat them), and each hour of the clock over the year, a figure of eight,
//! dashed in the second half of the year. Hours are local standard time.

use super::plan::escaped;
use crate::sky::sun::{self, Air, SunError};
use crate::sky::{Place, Sun};
use glam::DVec3;
use jiff::SignedDuration;
use jiff::civil::{Date, DateTime};
use std::io::{self, Write};

/// Radius of the horizon, and room around it, in SVG units.
const RADIUS: f64 = 300.0;
const MARGIN: f64 = 46.0;

/// Room to the right for the legend.
const LEGEND: f64 = 150.0;

/// Minutes between the points of a path; 2.5 degrees of the sun's turn.
const STEP_MIN: i64 = 10;

/// Every so many days a point of a figure of eight is drawn.
const DAYS_A_POINT: usize = 3;

/// Months whose 21st has a path, from winter (north of the equator) to summer, and their colours, cold to warm.
const PATHS: [(i8, &str, &str); 7] = [
    (12, "21 Dec", "#2c4b9b"),
    (1, "21 Jan", "#3b7fc4"),
    (2, "21 Feb", "#35a3a3"),
    (3, "21 Mar", "#3f9e4d"),
    (4, "21 Apr", "#c2a510"),
    (5, "21 May", "#e07b1a"),
    (6, "21 Jun", "#c8321e"),
];

/// The sun's paths over a place in a year, by apparent elevations.
#[derive(Debug, Clone)]
pub struct SunPath {
    /// The place.
    pub place: Place,
    /// The year.
    pub year: i16,
    /// Every full hour of the year, local standard time, and where the sun stands then; day or night.
    pub hours: Vec<(DateTime, Sun)>,
    /// The paths of the 21st of seven months, in the order of the legend.
    paths: [Vec<Sun>; PATHS.len()],
}

impl SunPath {
    /// The paths of a year. About 0.1 s.
    ///
    /// # Errors
    /// A place or a year outside its bounds.
    pub fn of(place: &Place, year: i16) -> Result<Self, SunError> {
        let at = |time: DateTime| sun::position(place, time, Some(Air::STANDARD));
        let first = Date::new(year, 1, 1).map_err(|_| SunError::Calendar)?;
        let days = usize::from(first.days_in_year().unsigned_abs());
        let start = first.at(0, 0, 0, 0);
        let later = |from: DateTime, minutes: i64| {
            from.checked_add(SignedDuration::from_mins(minutes)).map_err(|_| SunError::Calendar)
        };
        let hour = |number: usize| {
            let time = later(start, 60 * number as i64)?;
            Ok((time, at(time)?))
        };
        let mut paths: [Vec<Sun>; PATHS.len()] = Default::default();
        for ((month, ..), path) in PATHS.iter().zip(&mut paths) {
            let midnight = Date::new(year, *month, 21).map_err(|_| SunError::Calendar)?.at(0, 0, 0, 0);
            let points = (0..=24 * 60 / STEP_MIN).map(|number| at(later(midnight, number * STEP_MIN)?));
            *path = points.collect::<Result<_, _>>()?;
        }
        Ok(Self { place: *place, year, hours: (0..24 * days).map(hour).collect::<Result<_, SunError>>()?, paths })
    }

    /// The paths of the 21st of seven months, from December to June, which stand for all twelve; each with its name, ten
    /// minutes from point to point, day and night.
    pub fn days(&self) -> impl Iterator<Item = (&'static str, &[Sun])> {
        PATHS.iter().zip(&self.paths).map(|((_, name, _), path)| (*name, path.as_slice()))
    }

    /// The sun at one hour of the clock, every few days of the year: a figure of eight, not closed.
    pub fn at_hour(&self, hour: usize) -> Vec<(DateTime, Sun)> {
        self.hours.iter().skip(hour).step_by(24 * DAYS_A_POINT).copied().collect()
    }
}

/// Writes every hour of the year: `time` (local standard time), `azimuth_deg` (clockwise from true north) and
/// `elevation_deg` (apparent; negative at night).
///
/// # Errors
/// What the writer says.
pub fn write_csv(out: &mut dyn Write, path: &SunPath) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["time", "azimuth_deg", "elevation_deg"])?;
    for (time, sun) in &path.hours {
        let [azimuth_deg, elevation_deg] = [sun.azimuth_rad, sun.elevation_rad].map(f64::to_degrees);
        let clock = time.strftime("%Y-%m-%dT%H:%M").to_string();
        table.write_record([clock, format!("{azimuth_deg:.4}"), format!("{elevation_deg:.4}")])?;
    }
    table.flush()
}

/// Writes the diagram; `name` is that of the place.
///
/// # Errors
/// What the writer says.
pub fn write_svg(out: &mut dyn Write, path: &SunPath, name: &str) -> io::Result<()> {
    let side = 2.0 * (RADIUS + MARGIN);
    let [width, height] = [side + LEGEND, side + 20.0];
    writeln!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" font-family="sans-serif" font-size="11" fill="#222">"##
    )?;
    writeln!(out, r##"<rect width="100%" height="100%" fill="#fff"/>"##)?;
    draw_dome(out)?;
    for hour in 0..24 {
        draw_hour(out, path, hour)?;
    }
    for (points, (_, _, colour)) in path.paths.iter().zip(PATHS) {
        for run in above_horizon(points) {
            draw_line(out, &run, &format!(r#"stroke="{colour}" stroke-width="2""#))?;
        }
    }
    draw_names(out, path)?;
    draw_legend(out, path, name)?;
    writeln!(out, "</svg>")
}

/// Where a direction at or above the horizon lies on the sheet.
fn place(direction: DVec3) -> [f64; 2] {
    let middle = RADIUS + MARGIN;
    let share = RADIUS / (1.0 + direction.z);
    [middle + share * direction.x, middle + 20.0 - share * direction.y]
}

fn place_deg(azimuth_deg: f64, elevation_deg: f64) -> [f64; 2] {
    place(crate::sky::towards(azimuth_deg.to_radians(), elevation_deg.to_radians()))
}

/// Rings of elevation and spokes of azimuth.
fn draw_dome(out: &mut dyn Write) -> io::Result<()> {
    let [x, y] = place(DVec3::Z);
    writeln!(out, r##"<g stroke="#d4d4d4" fill="none">"##)?;
    for elevation in (0..90).step_by(10) {
        let radius = place_deg(90.0, f64::from(elevation))[0] - x;
        let stroke = if elevation == 0 { r##" stroke="#555" stroke-width="1.4""## } else { "" };
        writeln!(out, r#"<circle cx="{x:.1}" cy="{y:.1}" r="{radius:.1}"{stroke}/>"#)?;
    }
    for azimuth in (0..360).step_by(30) {
        let [[x1, y1], [x2, y2]] = [80.0, 0.0].map(|elevation| place_deg(f64::from(azimuth), elevation));
        writeln!(out, r#"<line x1="{x1:.1}" y1="{y1:.1}" x2="{x2:.1}" y2="{y2:.1}"/>"#)?;
    }
    writeln!(out, r##"</g><g text-anchor="middle" fill="#444">"##)?;
    for azimuth in (0..360).step_by(30) {
        let [x_rim, y_rim] = place_deg(f64::from(azimuth), 0.0);
        let [away_x, away_y] = [x_rim - x, y_rim - y].map(|from_middle| from_middle * 20.0 / RADIUS);
        let named = match azimuth {
            0 => "N".to_owned(),
            90 => "E".to_owned(),
            180 => "S".to_owned(),
            270 => "W".to_owned(),
            _ => format!("{azimuth}\u{b0}"),
        };
        let weight = if azimuth % 90 == 0 { r#" font-weight="bold" font-size="14""# } else { "" };
        writeln!(out, r#"<text x="{:.1}" y="{:.1}"{weight}>{named}</text>"#, x_rim + away_x, y_rim + away_y + 4.0)?;
    }
    writeln!(out, "</g>")
}

/// One hour of the clock over the year: the first half of the year whole, the second dashed.
fn draw_hour(out: &mut dyn Write, path: &SunPath, hour: usize) -> io::Result<()> {
    let points = path.at_hour(hour);
    let half = points.partition_point(|(time, _)| time.month() < 7);
    let suns = |part: &[(DateTime, Sun)]| part.iter().map(|(_, sun)| *sun).collect::<Vec<Sun>>();
    let first = suns(&points[..(half + 1).min(points.len())]);
    let second = [suns(&points[half..]), suns(&points[..points.len().min(1)])].concat();
    for (part, dashes) in [(first, "none"), (second, "3 2")] {
        for run in above_horizon(&part) {
            draw_line(out, &run, &format!(r##"stroke="#777" stroke-width="1" stroke-dasharray="{dashes}""##))?;
        }
    }
    Ok(())
}

/// Names of rings, and of hours beside the summer end of their figures of eight.
fn draw_names(out: &mut dyn Write, path: &SunPath) -> io::Result<()> {
    let halo = r##"stroke="#fff" stroke-width="3" paint-order="stroke""##;
    let is_north = path.place.latitude_rad >= 0.0;
    writeln!(out, r##"<g font-size="9" fill="#777" {halo}>"##)?;
    for elevation in (10..90).step_by(10) {
        let [x, y] = place_deg(if is_north { 0.0 } else { 180.0 }, f64::from(elevation));
        writeln!(out, r#"<text x="{:.1}" y="{:.1}">{elevation}{}</text>"#, x + 3.0, y + 3.0, '\u{b0}')?;
    }
    writeln!(out, r##"</g><g font-size="11" text-anchor="middle" font-weight="bold" {halo}>"##)?;
    for hour in 0..24 {
        let points = path.at_hour(hour);
        let seen = points.iter().map(|(_, sun)| sun.towards()).filter(|direction| direction.z > 0.03);
        let towards_summer = |direction: &DVec3| if is_north { direction.y } else { -direction.y };
        if let Some(end) = seen.max_by(|a, b| towards_summer(a).total_cmp(&towards_summer(b))) {
            let [x, y] = place(end);
            writeln!(out, r#"<text x="{x:.1}" y="{:.1}">{hour}</text>"#, if is_north { y - 5.0 } else { y + 13.0 })?;
        }
    }
    writeln!(out, "</g>")
}

fn draw_legend(out: &mut dyn Write, path: &SunPath, name: &str) -> io::Result<()> {
    let SunPath { place, year, .. } = path;
    let [latitude_deg, longitude_deg] = [place.latitude_rad, place.longitude_rad].map(f64::to_degrees);
    let zone = format!("UTC{:+}", place.utc_offset_h);
    writeln!(
        out,
        r#"<text x="14" y="22" font-size="14" font-weight="bold">{}: latitude {latitude_deg:.2}{d}, longitude {longitude_deg:.2}{d}, {zone}, {year}</text>"#,
        escaped(name),
        d = '\u{b0}'
    )?;
    let left = 2.0 * (RADIUS + MARGIN) + 6.0;
    let mut y = 70.0;
    let mut line = |out: &mut dyn Write, look: &str, text: &str| {
        writeln!(out, r#"<line x1="{left:.1}" y1="{y:.1}" x2="{:.1}" y2="{y:.1}" {look}/>"#, left + 24.0)?;
        writeln!(out, r#"<text x="{:.1}" y="{:.1}">{text}</text>"#, left + 30.0, y + 4.0)?;
        y += 18.0;
        io::Result::Ok(())
    };
    for (_, text, colour) in PATHS {
        line(out, &format!(r#"stroke="{colour}" stroke-width="2""#), text)?;
    }
    line(out, r##"stroke="#777""##, "hour, Jan to Jun")?;
    line(out, r##"stroke="#777" stroke-dasharray="3 2""##, "hour, Jul to Dec")?;
    for text in ["hours: local standard", "time; rings: apparent", "elevation; stereographic,", "seen from above"] {
        writeln!(out, r##"<text x="{left:.1}" y="{:.1}" fill="#555">{text}</text>"##, y + 10.0)?;
        y += 15.0;
    }
    Ok(())
}

/// The parts of a track above the horizon as directions (x east, y true north, z up), cut where it crosses.
pub fn above_horizon(track: &[Sun]) -> Vec<Vec<DVec3>> {
    let mut runs: Vec<Vec<DVec3>> = Vec::new();
    let directions: Vec<DVec3> = track.iter().map(Sun::towards).collect();
    for pair in directions.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let crossing = || a.lerp(b, a.z / (a.z - b.z)).with_z(0.0).normalize_or_zero();
        match (a.z >= 0.0, b.z >= 0.0) {
            (true, true) => match runs.last_mut() {
                Some(run) if run.last() == Some(&a) => run.push(b),
                _ => runs.push(vec![a, b]),
            },
            (false, true) => runs.push(vec![crossing(), b]),
            (true, false) => match runs.last_mut() {
                Some(run) if run.last() == Some(&a) => run.push(crossing()),
                _ => runs.push(vec![a, crossing()]),
            },
            (false, false) => {}
        }
    }
    runs
}

fn draw_line(out: &mut dyn Write, directions: &[DVec3], look: &str) -> io::Result<()> {
    let places = directions.iter().map(|&direction| place(direction));
    let line: Vec<String> = places.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    writeln!(out, r#"<polyline points="{}" fill="none" {look}/>"#, line.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::towards;

    #[test]
    fn the_dome_lies_as_a_map_does() {
        let [middle, top] = [RADIUS + MARGIN, MARGIN + 20.0];
        for (azimuth, elevation, want) in [
            (0.0, 0.0, [middle, top]),
            (90.0, 0.0, [middle + RADIUS, top + RADIUS]),
            (123.0, 90.0, [middle, top + RADIUS]),
            (180.0, 45.0, [middle, top + RADIUS + RADIUS * f64::to_radians(22.5).tan()]),
        ] {
            let found = place_deg(azimuth, elevation);
            assert!((0..2).all(|axis| (found[axis] - want[axis]).abs() < 1e-9), "{found:?} {want:?}");
        }
    }

    #[test]
    fn tracks_end_on_the_horizon() {
        let track: Vec<Sun> = (0..=24)
            .map(|hour| {
                let turn = f64::from(hour) * 15.0_f64.to_radians();
                Sun { azimuth_rad: turn, elevation_rad: -0.5 * turn.cos() }
            })
            .collect();
        let runs = above_horizon(&track);
        assert_eq!(runs.len(), 1);
        assert!(runs[0].iter().all(|direction| direction.z >= 0.0 && (direction.length() - 1.0).abs() < 1e-9));
        assert!(runs[0].first().is_some_and(|first| first.z.abs() < 1e-12));
        assert!(above_horizon(&[Sun { azimuth_rad: 0.0, elevation_rad: -0.1 }; 4]).is_empty());
        let up = above_horizon(&[Sun { azimuth_rad: 0.0, elevation_rad: 0.1 }; 4]);
        assert_eq!((up.len(), up[0].len(), up[0][0]), (1, 4, towards(0.0, 0.1)));
    }

    #[test]
    fn a_leap_year_has_8784_rows_and_a_pole_has_a_picture() {
        for latitude_deg in [-90.0, -33.0, 1.5, 90.0] {
            let path = SunPath::of(&Place::from_degrees(latitude_deg, 180.0, 12.0), 2024).unwrap();
            let (mut table, mut picture) = (Vec::new(), Vec::new());
            write_csv(&mut table, &path).unwrap();
            write_svg(&mut picture, &path, "a & b").unwrap();
            let [table, picture] = [table, picture].map(|bytes| String::from_utf8(bytes).unwrap());
            assert_eq!(table.lines().count(), 1 + 8784);
            assert!(table.contains("\n2024-02-29T23:00,"));
            assert!(picture.contains("a &amp; b") && !picture.contains("NaN"));
        }
        assert!(SunPath::of(&Place::from_degrees(0.0, 0.0, 0.0), 4000).is_err());
    }
}
