//! What does an EPW file say of sun and sky?
//!
//! The format of EnergyPlus ("Auxiliary Programs", EnergyPlus Weather File (EPW) Data Dictionary): a header, of which LOCATION
//! and DATA PERIODS are read, then a row of 32 to 35 fields for each hour or part of one. Of a row the date, the hour, the
//! minute and the three irradiances are read; all else may be anything.
//!
//! A row's irradiances are means over the interval that ends with its hour (1 to 24) and minute. With one record an hour the
//! interval is the whole hour, whatever the minute says: 0, 60 and 30 all occur. With more, the k-th row of an hour is its
//! k-th part, and the numbers are taken as mean power too, as EnergyPlus takes them, though the format's unit is Wh/m2; a
//! warning says so. 9999 and an empty field stand for missing numbers.
//!
//! Rows must be whole days one after the other as DATA PERIODS announces them, 29 February being free to be there or not. A
//! date keeps its row's own year: the months of a typical year come from different ones.

use super::{Row, Weather, date, decimal, from_rows, irradiance, month_and_day, place, whole};
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::{Input, Line, Lines, shown, text, without_mark};
use crate::sky::Place;
use jiff::SignedDuration;
use jiff::civil::{Date, DateTime};
use std::borrow::Cow;
use std::ops::RangeInclusive;

/// Fields of a row: the last three came later than the format.
const ROW_FIELDS: RangeInclusive<usize> = 32..=35;

/// Places in a row.
const GHI: usize = 13;
const DNI: usize = 14;
const DHI: usize = 15;

/// What stands for a missing irradiance: 9999, also with decimals.
const MISSING: std::ops::Range<f64> = 9999.0..10_000.0;

/// Minutes of an hour.
const HOUR_MIN: i16 = 60;

/// The two lines of the header that count.
struct Header {
    name: String,
    place: Place,
    records_per_hour: i16,
    periods: Vec<Period>,
}

/// A stretch of days with data, both ends within.
struct Period {
    first: Day,
    last: Day,
}

/// A day of the calendar, of a year or of any.
#[derive(Clone, Copy)]
struct Day {
    month: i16,
    day: i16,
    year: Option<i16>,
}

/// When a row is: its day, its hour from 0 to 23, and the part of that hour, from 0.
#[derive(Clone, Copy, PartialEq)]
struct Stamp {
    date: Date,
    hour: i16,
    part: i16,
}

/// Reads an EPW file.
///
/// # Errors
/// [`SceneError`] with the line: a header without LOCATION or DATA PERIODS, a place, a date, an hour or an irradiance outside
/// its bounds, numbers that are none, a wrong number of fields, rows out of order, twice or missing.
pub fn read_epw(input: &Input) -> Result<Weather, SceneError> {
    let mut stage = input.parse();
    let mut lines = Lines::new(without_mark(input.bytes));
    let header = read_header(input, &mut lines)?;

    // Each row must follow the one before.
    let mut rows = Vec::new();
    let mut order = Order { header: &header, period: 0, before: None };
    for line in lines.filter(|line| !line.bytes.trim_ascii().is_empty()) {
        stage.done(line.end)?;
        let row = read_row(&line, &header, &mut order).map_err(|kind| input.error(line.number, kind))?;
        rows.push(row);
    }
    order.end().map_err(|kind| input.error(None, kind))?;

    let warning = format!(
        "with {} records an hour, irradiances are taken as mean power over each, W/m2, as EnergyPlus takes them",
        header.records_per_hour
    );
    let warnings = if header.records_per_hour > 1 { vec![warning] } else { Vec::new() };
    Ok(from_rows(header.name, header.place, &rows, warnings))
}

/// Reads lines up to DATA PERIODS.
fn read_header(input: &Input, lines: &mut Lines) -> Result<Header, SceneError> {
    let Some(first) = lines.next() else {
        return Err(input.error(None, Kind::Missing("the header with LOCATION".into())));
    };
    let (name, place) = read_location(first.bytes).map_err(|kind| input.error(first.number, kind))?;
    let Some(line) = lines.find(|line| is_called(line.bytes, b"DATA PERIODS")) else {
        return Err(input.error(None, Kind::Missing("the header's DATA PERIODS".into())));
    };
    let (records_per_hour, periods) = read_periods(line.bytes).map_err(|kind| input.error(line.number, kind))?;
    Ok(Header { name, place, records_per_hour, periods })
}

/// Whether a line's first field is a name, in capitals or not.
fn is_called(line: &[u8], name: &[u8]) -> bool {
    let (start, rest) = line.split_at(name.len().min(line.len()));
    start.eq_ignore_ascii_case(name) && matches!(rest.first(), Some(b',') | None)
}

/// `LOCATION,city,state,country,source,WMO,latitude,longitude,zone,elevation`
fn read_location(line: &[u8]) -> Result<(String, Place), Kind> {
    if !is_called(line, b"LOCATION") {
        return Err(Kind::Syntax { expected: "LOCATION, an EPW header".into(), found: shown(line) });
    }
    let fields = fields(line);
    if fields.len() != 10 {
        return Err(Kind::Fields { found: fields.len(), expected: "10 of LOCATION".into() });
    }
    let field = |index: usize| fields.get(index).map(Cow::as_ref).unwrap_or_default();
    let number = |index, what| decimal(field(index), what);
    let place =
        place(number(6, "latitude")?, number(7, "longitude")?, number(8, "time zone")?, number(9, "elevation")?)?;
    let names = (1..4).map(|index| text(field(index))).filter(|name| !name.is_empty());
    Ok((names.collect::<Vec<_>>().join(", "), place))
}

/// `DATA PERIODS,periods,records an hour`, then for each period `name,weekday,first day,last day`
fn read_periods(line: &[u8]) -> Result<(i16, Vec<Period>), Kind> {
    let fields = fields(line);
    let field = |index: usize| fields.get(index).map(Cow::as_ref).unwrap_or_default();
    let count = whole(field(1), "number of data periods", [1.0, 366.0], "1 to 366")?;
    let records_per_hour = whole(field(2), "records per hour", [1.0, 60.0], "1 to 60")?;
    if HOUR_MIN % records_per_hour != 0 {
        let found = records_per_hour.to_string();
        return Err(Kind::Syntax { expected: "records per hour, a number that divides 60".into(), found });
    }
    let (count, expected) = (usize::from(count.unsigned_abs()), 3 + 4 * usize::from(count.unsigned_abs()));
    if fields.len() < expected {
        return Err(Kind::Fields { found: fields.len(), expected: format!("{expected} of DATA PERIODS") });
    }
    let period = |number: usize| {
        let at = 5 + 4 * number;
        Ok(Period { first: read_day(field(at))?, last: read_day(field(at + 1))? })
    };
    Ok((records_per_hour, (0..count).map(period).collect::<Result<_, Kind>>()?))
}

/// `month/day` or `month/day/year`, blanks allowed.
fn read_day(field: &[u8]) -> Result<Day, Kind> {
    let parts: Vec<&[u8]> = field.split(|&byte| byte == b'/').map(<[u8]>::trim_ascii).collect();
    let (month, day, year) = match parts.as_slice() {
        [month, day] => (month, day, None),
        [month, day, year] => (month, day, Some(read_year(year)?)),
        _ => return Err(Kind::Syntax { expected: "month/day of a data period".into(), found: shown(field) }),
    };
    let (month, day) = month_and_day(month, day)?;
    // Any year will do for a day without one, but it must be a leap year.
    date(year.unwrap_or(2000), month, day)?;
    Ok(Day { month, day, year })
}

/// Years for which the sun's position is known.
fn read_year(field: &[u8]) -> Result<i16, Kind> {
    whole(field, "year", [1.0, 3000.0], "1 to 3000")
}

/// A row, which must come in order.
fn read_row(line: &Line, header: &Header, order: &mut Order) -> Result<Row, Kind> {
    let fields = fields(line.bytes);
    if !ROW_FIELDS.contains(&fields.len()) {
        let expected = format!("{} to {}", ROW_FIELDS.start(), ROW_FIELDS.end());
        return Err(Kind::Fields { found: fields.len(), expected });
    }
    let field = |index: usize| fields.get(index).map(Cow::as_ref).unwrap_or_default();

    // When.
    let year = read_year(field(0))?;
    let (month, day) = month_and_day(field(1), field(2))?;
    let date = date(year, month, day)?;
    let hour = whole(field(3), "hour", [1.0, 24.0], "1 to 24")? - 1;
    let minute = whole(field(4), "minute", [0.0, 60.0], "0 to 60")?;
    let length_min = HOUR_MIN / header.records_per_hour;
    let part = order.part(date, hour);
    if header.records_per_hour > 1 && ![part * length_min, (part + 1) * length_min].contains(&minute) {
        let expected = format!("minute {}, the end of part {} of its hour", (part + 1) * length_min, part + 1);
        return Err(Kind::Syntax { expected, found: minute.to_string() });
    }
    order.next(Stamp { date, hour, part })?;

    // How much.
    let read = |index: usize, what: &str| {
        let field = field(index);
        let missing = field.is_empty() || MISSING.contains(&decimal(field, what)?);
        if missing { Ok(None) } else { irradiance(field, what).map(Some) }
    };
    Ok(Row {
        line: line.number,
        start: start(date, hour, part * length_min),
        length_h: f64::from(length_min) / f64::from(HOUR_MIN),
        ghi: read(GHI, "global horizontal radiation")?,
        dni: read(DNI, "direct normal radiation")?,
        dhi: read(DHI, "diffuse horizontal radiation")?,
    })
}

/// A moment of a day.
fn start(date: Date, hour: i16, minute: i16) -> DateTime {
    let passed = SignedDuration::from_mins(i64::from(hour) * i64::from(HOUR_MIN) + i64::from(minute));
    date.at(0, 0, 0, 0).saturating_add(passed)
}

/// Whether each row follows the one before, through the periods of the header.
struct Order<'a> {
    header: &'a Header,
    /// Periods that are over.
    period: usize,
    /// The row before, `None` where a period begins.
    before: Option<Stamp>,
}

impl Order<'_> {
    /// Which part of its hour a row is: the one after the row before, if that was in the same hour.
    fn part(&self, date: Date, hour: i16) -> i16 {
        let same = |before: &Stamp| before.date == date && before.hour == hour;
        self.before.filter(same).map_or(0, |before| before.part + 1)
    }

    /// Takes the next row.
    fn next(&mut self, row: Stamp) -> Result<(), Kind> {
        let Some(period) = self.header.periods.get(self.period) else {
            let found = shown_stamp(row, false);
            return Err(Kind::Syntax { expected: "no row after the last day of DATA PERIODS".into(), found });
        };
        let last_hour = row.hour == 23 && row.part + 1 == self.header.records_per_hour;
        let follows = match self.before {
            None => row.hour == 0 && row.part == 0 && period.first.is(row.date),
            Some(before) if before.date == row.date => {
                let next_part = row.hour == before.hour && row.part < self.header.records_per_hour;
                next_part || (row.hour == before.hour + 1 && before.part + 1 == self.header.records_per_hour)
            }
            Some(before) => {
                let ended = before.hour == 23 && before.part + 1 == self.header.records_per_hour;
                ended && row.hour == 0 && is_next_day(before.date, row.date)
            }
        };
        if !follows {
            return Err(Kind::Syntax {
                expected: self.expected(period),
                found: shown_stamp(row, period.first.year.is_some()),
            });
        }
        if last_hour && period.last.is(row.date) {
            self.period += 1;
            self.before = None;
        } else {
            self.before = Some(row);
        }
        Ok(())
    }

    /// Whether all periods are over.
    fn end(&self) -> Result<(), Kind> {
        match self.header.periods.get(self.period) {
            None => Ok(()),
            Some(period) => {
                Err(Kind::Missing(format!("{} of the data up to {}", self.expected(period), period.last.shown())))
            }
        }
    }

    /// The row that must come next.
    fn expected(&self, period: &Period) -> String {
        match self.before {
            None => format!("the row of {} hour 1", period.first.shown()),
            Some(before) if before.part + 1 < self.header.records_per_hour => format!(
                "part {} of {}/{} hour {}",
                before.part + 2,
                before.date.month(),
                before.date.day(),
                before.hour + 1
            ),
            Some(before) if before.hour < 23 => {
                format!("the row of {}/{} hour {}", before.date.month(), before.date.day(), before.hour + 2)
            }
            Some(before) => {
                let next = before.date.tomorrow().unwrap_or(before.date);
                format!("the row of {}/{} hour 1", next.month(), next.day())
            }
        }
    }
}

impl Day {
    /// Whether a date is this day.
    fn is(&self, date: Date) -> bool {
        let year = self.year.is_none_or(|year| year == date.year());
        year && self.month == i16::from(date.month()) && self.day == i16::from(date.day())
    }

    /// As the file writes it.
    fn shown(&self) -> String {
        let year = self.year.map_or(String::new(), |year| format!("/{year}"));
        format!("{}/{}{year}", self.month, self.day)
    }
}

/// Whether a day of the calendar follows another, whatever their years; 29 February may be left out, in a leap year too.
fn is_next_day(before: Date, next: Date) -> bool {
    let day = |date: Date| (date.month(), date.day());
    let follows = before.tomorrow().is_ok_and(|tomorrow| day(tomorrow) == day(next));
    let about_leap_day = day(before) == (2, 28) && (day(next) == (2, 29) || day(next) == (3, 1));
    follows || about_leap_day
}

/// A row's time as the file writes it.
fn shown_stamp(stamp: Stamp, with_year: bool) -> String {
    let Stamp { date, hour, .. } = stamp;
    let year = with_year.then(|| date.year());
    let day = Day { month: date.month().into(), day: date.day().into(), year };
    format!("{} hour {}", day.shown(), hour + 1)
}

/// The fields of a line, between commas that are not in quotes; without the blanks around them and without their quotes.
fn fields(line: &[u8]) -> Vec<Cow<'_, [u8]>> {
    let mut quoted = false;
    let split = line.split(|&byte| {
        quoted ^= byte == b'"';
        byte == b',' && !quoted
    });
    split
        .map(|field| match field.trim_ascii() {
            field if field.contains(&b'"') => field.iter().copied().filter(|&byte| byte != b'"').collect(),
            field => Cow::Borrowed(field),
        })
        .collect()
}
