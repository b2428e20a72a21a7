//! What does a WEA file say of sun and sky?
//!
//! The weather tape of Radiance (`gendaymtx`, `epw2wea`): six lines of header, `place`, `latitude`, `longitude` (degrees, west
//! positive), `time_zone` (degrees, west positive), `site_elevation` (m), `weather_data_file_units`, then rows of month, day,
//! hour and two numbers. More numbers in a row (aerosol depth, cloud cover) are left alone.
//!
//! Units 1 are direct normal and diffuse horizontal irradiance. Units 2, direct and diffuse irradiance both on the
//! horizontal, are converted by the sun's height, and where the sun is too low for that told as missing. Units 3 are
//! illuminances, which do not say how much power there is: refused.
//!
//! The hour is the middle of its interval (12.5 for noon to one); intervals are as long as the shortest distance between two
//! rows, an hour at most. A tape may leave hours out, for instance the nights; they count as dark. It knows no year: a common
//! year in the middle between two leap years is taken, or a leap year where there is a 29 February.

use super::missing::named;
use super::{Row, Weather, bounded, date, from_rows, irradiance, month_and_day, place, whole};
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::{Input, Line, Lines, shown, text, without_mark, words};
use jiff::SignedDuration;
use jiff::civil::{Date, DateTime};

/// The year of a tape with and without a leap day. In 2002 the sun stands on each day as in the mean of four years.
const LEAP_YEAR: i16 = 2000;
const COMMON_YEAR: i16 = 2002;

/// Stamps are taken to the nearest half minute: two decimals of an hour hold no more.
const STAMP_S: f64 = 30.0;

/// Longest and shortest interval, seconds.
const LONGEST_S: i64 = 3600;
const SHORTEST_S: i64 = 60;

/// A row as written, with the middle of its interval in seconds of its day.
struct Record {
    line: usize,
    month: i16,
    day: i16,
    middle_s: i64,
    direct: f64,
    diffuse: f64,
}

/// Reads a WEA file.
///
/// # Errors
/// [`SceneError`] with the line: a header with other keys, places, dates, hours and irradiances outside their bounds, numbers
/// that are none, too few fields, rows out of order or twice, no row at all, units of light.
pub fn read_wea(input: &Input) -> Result<Weather, SceneError> {
    let mut stage = input.parse();
    let mut lines = Lines::new(without_mark(input.bytes)).filter(|line| !line.bytes.trim_ascii().is_empty());

    // The header.
    let mut value = |key: &'static str| {
        let line = lines.next().ok_or_else(|| input.error(None, Kind::Missing(format!("the header's {key}"))))?;
        header_value(&line, key).map(|value| (line.number, value)).map_err(|kind| input.error(line.number, kind))
    };
    let (_, name) = value("place")?;
    let mut number = |key, range, bound| {
        let (line, value) = value(key)?;
        bounded(value, key, range, bound).map_err(|kind| input.error(line, kind))
    };
    let latitude_deg = number("latitude", [-90.0, 90.0], "-90 to 90 degrees")?;
    let west_deg = number("longitude", [-180.0, 180.0], "-180 to 180 degrees")?;
    let zone_west_deg = number("time_zone", [-210.0, 180.0], "-210 to 180 degrees, west positive")?;
    let altitude_m = number("site_elevation", [-1000.0, 9999.9], "-1000 to 9999.9 m")?;
    let place = place(latitude_deg, -west_deg, -zone_west_deg / 15.0, altitude_m);
    let place = place.map_err(|kind| input.error(None, kind))?;
    let (number, units) = value("weather_data_file_units")?;
    let horizontal = is_horizontal(units).map_err(|kind| input.error(number, kind))?;

    // The rows, one after the other.
    let mut records: Vec<Record> = Vec::new();
    for line in lines {
        stage.done(line.end)?;
        let record = read_record(&line).map_err(|kind| input.error(line.number, kind))?;
        if records.last().is_some_and(|before| before.when() >= record.when()) {
            let expected = format!("a row after that of line {}", records.last().map_or(0, |before| before.line));
            let found = format!("{}/{} hour {}", record.month, record.day, record.middle_s as f64 / 3600.0);
            return Err(input.error(line.number, Kind::Syntax { expected, found }));
        }
        records.push(record);
    }
    if records.is_empty() {
        return Err(input.error(None, Kind::Missing("a row with weather".into())));
    }
    let rows = placed(input, &records, horizontal)?;

    let warnings = gaps(&rows).into_iter().collect();
    Ok(from_rows(text(name), place, &rows, warnings))
}

/// What follows the key of a header line.
fn header_value<'a>(line: &Line<'a>, key: &str) -> Result<&'a [u8], Kind> {
    let bytes = line.bytes.trim_ascii();
    let wrong = || Kind::Syntax { expected: format!("{key} and its value"), found: shown(bytes) };
    let value = bytes.strip_prefix(key.as_bytes()).ok_or_else(wrong)?;
    if value.first().is_some_and(u8::is_ascii_whitespace) { Ok(value.trim_ascii()) } else { Err(wrong()) }
}

/// Whether the units are those of direct irradiance on the horizontal.
fn is_horizontal(units: &[u8]) -> Result<bool, Kind> {
    match whole(units, "weather_data_file_units", [1.0, 3.0], "1 to 3")? {
        1 => Ok(false),
        2 => Ok(true),
        _ => Err(Kind::Contradiction(
            "weather_data_file_units 3 are illuminances, which do not say how much power there is; 1 and 2 can be read"
                .into(),
        )),
    }
}

/// `month day hour direct diffuse`, and more.
fn read_record(line: &Line) -> Result<Record, Kind> {
    let fields: Vec<&[u8]> = words(line.bytes).collect();
    let [month, day, hour, direct, diffuse, ..] = fields.as_slice() else {
        return Err(Kind::Fields { found: fields.len(), expected: "month day hour direct diffuse".into() });
    };
    let (month, day) = month_and_day(month, day)?;
    date(LEAP_YEAR, month, day)?;
    let hour = bounded(hour, "hour", [0.0, 24.0], "0 to 24")?;
    Ok(Record {
        line: line.number,
        month,
        day,
        middle_s: ((hour * 3600.0 / STAMP_S).round() * STAMP_S) as i64,
        direct: irradiance(direct, "direct irradiance")?,
        diffuse: irradiance(diffuse, "diffuse irradiance")?,
    })
}

impl Record {
    /// What rows are ordered by.
    fn when(&self) -> (i16, i16, i64) {
        (self.month, self.day, self.middle_s)
    }
}

/// The rows in a year, with their intervals.
fn placed(input: &Input, records: &[Record], horizontal: bool) -> Result<Vec<Row>, SceneError> {
    let leap = records.iter().any(|record| (record.month, record.day) == (2, 29));
    let year = if leap { LEAP_YEAR } else { COMMON_YEAR };
    let middle = |record: &Record| -> Result<DateTime, SceneError> {
        let date: Date = date(year, record.month, record.day).map_err(|kind| input.error(record.line, kind))?;
        Ok(date.at(0, 0, 0, 0).saturating_add(SignedDuration::from_secs(record.middle_s)))
    };
    let middles = records.iter().map(middle).collect::<Result<Vec<_>, _>>()?;

    // The shortest distance is the length of all. (Hour 24 of a day and hour 0 of the next are the same
    // moment.)
    let mut length_s = LONGEST_S;
    for (pair, record) in middles.windows(2).zip(records.iter().skip(1)) {
        let [before, next] = pair else { continue };
        let distance_s = next.duration_since(*before).as_secs();
        if distance_s < SHORTEST_S {
            let kind = Kind::Outside {
                what: "time since the row before".into(),
                value: distance_s as f64,
                bound: "60 s or more",
            };
            return Err(input.error(record.line, kind));
        }
        length_s = length_s.min(distance_s);
    }

    let length_s = snapped_s(length_s);

    let row = |(record, middle): (&Record, DateTime)| {
        let Record { line, direct, diffuse, .. } = *record;
        let ghi = horizontal.then_some(direct + diffuse);
        Row {
            line,
            start: middle.saturating_sub(SignedDuration::from_millis(length_s * 500)),
            length_h: length_s as f64 / 3600.0,
            ghi,
            dni: if horizontal { None } else { Some(direct) },
            dhi: Some(diffuse),
        }
    };
    Ok(records.iter().zip(middles).map(row).collect())
}

/// The part of an hour nearest to a length that rounded stamps gave, seconds; the length itself where none is near.
fn snapped_s(length_s: i64) -> i64 {
    let parts_s = [60, 30, 20, 15, 12, 10, 6, 5, 4, 3, 2, 1].map(|minutes| minutes * 60);
    let near = |part_s: &i64| (part_s - length_s).abs() * 20 < *part_s;
    parts_s.into_iter().find(near).unwrap_or(length_s)
}

/// What to say of time between the first and the last row that no row covers.
fn gaps(rows: &[Row]) -> Option<String> {
    let mut lines = Vec::new();
    let mut gap_h = 0.0;
    for pair in rows.windows(2) {
        let [before, next] = pair else { continue };
        let between_h = next.start.duration_since(before.start).as_secs_f64() / 3600.0 - before.length_h;
        // Less comes from rounded stamps.
        if between_h > 0.1 * before.length_h {
            gap_h += between_h;
            lines.push(next.line);
        }
    }
    (!lines.is_empty()).then(|| format!("no row covers {gap_h} h, taken as dark, before {}", named(&lines)))
}
