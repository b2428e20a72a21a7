//! Where is light asked for?
//!
//! Sensors come from CSV (`id,x,y,z` or `id,x,y,z,nx,ny,nz`) or from Radiance `.pts` (`x y z` or `x y z nx ny nz` a
//! line). Positions are in metres, Z up, in the coordinates of the scene file, whatever unit and axis the meshes have.

use super::error::{Kind, SceneError};
use super::input::{FARTHEST_M, Input, Lines, number, shown, text, without_mark, words};
use csv::ByteRecord;
use glam::DVec3;
use std::collections::HashMap;

/// A sensor in double precision: it is recentred with the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct RawSensor {
    /// Its name.
    pub id: String,
    /// Metres.
    pub position_m: DVec3,
    /// Unit length, or `None` for a scalar sensor.
    pub normal: Option<DVec3>,
}

/// Reads sensors from CSV. Lines that begin with `#` are comments; empty normals make scalar sensors; normals are brought
/// to unit length. A header alone gives no sensors.
///
/// # Errors
/// [`SceneError`] with the line: another header, a wrong number of fields, numbers that are none or not finite, half a
/// normal or one without a length, ids that are empty or occur twice.
pub fn read_sensors_csv(input: &Input) -> Result<Vec<RawSensor>, SceneError> {
    let mut sensors = Vec::new();
    let mut first_lines = HashMap::new();
    let headers: [&[&str]; 2] = [&["id", "x", "y", "z"], &["id", "x", "y", "z", "nx", "ny", "nz"]];
    read_table(input, &headers, |line, row| {
        let field = |index: usize| row.get(index).unwrap_or_default();
        let id = unique_id(field(0), line, "sensor", &mut first_lines)?;
        let position_m = DVec3::new(coordinate(field(1), "x")?, coordinate(field(2), "y")?, coordinate(field(3), "z")?);
        let empty = (4..7).filter(|&index| field(index).is_empty()).count();
        let normal = match empty {
            3 => None,
            0 => Some(unit(DVec3::new(
                coordinate(field(4), "nx")?,
                coordinate(field(5), "ny")?,
                coordinate(field(6), "nz")?,
            ))?),
            _ => return Err(Kind::Fields { found: 3 - empty, expected: "0 or 3 for the normal".into() }),
        };
        sensors.push(RawSensor { id, position_m, normal });
        Ok(())
    })?;
    Ok(sensors)
}

/// Reads sensors from Radiance `.pts`; they are called `s0`, `s1` and so on. Lines that begin with `#` are comments.
///
/// # Errors
/// [`SceneError`] with the line: neither 3 nor 6 numbers, numbers not finite, a normal without a length.
pub fn read_pts(input: &Input) -> Result<Vec<RawSensor>, SceneError> {
    let mut sensors = Vec::new();
    let mut stage = input.parse();
    for line in Lines::new(without_mark(input.bytes)) {
        stage.done(line.end)?;
        let failed = |kind| input.error(line.number, kind);
        let fields: Vec<&[u8]> = words(line.bytes).take_while(|word| !word.starts_with(b"#")).collect();
        if fields.is_empty() {
            continue;
        }
        let mut values = [0.0; 6];
        if fields.len() != 3 && fields.len() != 6 {
            return Err(failed(Kind::Fields { found: fields.len(), expected: "x y z or x y z nx ny nz".into() }));
        }
        for (value, (field, what)) in values.iter_mut().zip(fields.iter().zip(["x", "y", "z", "nx", "ny", "nz"])) {
            *value = coordinate(field, what).map_err(failed)?;
        }
        let [x, y, z, nx, ny, nz] = values;
        let normal = if fields.len() == 6 { Some(unit(DVec3::new(nx, ny, nz)).map_err(failed)?) } else { None };
        sensors.push(RawSensor { id: format!("s{}", sensors.len()), position_m: DVec3::new(x, y, z), normal });
    }
    Ok(sensors)
}

/// Calls `each` with the line number and the fields, trimmed, of every row below a header that must be one of `headers`;
/// what `each` fails with is placed in that line.
pub(super) fn read_table(
    input: &Input,
    headers: &[&[&str]],
    mut each: impl FnMut(usize, &ByteRecord) -> Result<(), Kind>,
) -> Result<(), SceneError> {
    let bytes = without_mark(input.bytes);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let expected = || headers.iter().map(|header| header.join(",")).collect::<Vec<_>>().join(" or ");
    let mut columns = None;
    let mut row = ByteRecord::new();
    let mut stage = input.parse();
    let mut lines = LineFinder { bytes, offset: 0, line: 1 };
    loop {
        let start = reader.position().byte() as usize;
        let more = reader.read_byte_record(&mut row);
        let more = more.map_err(|error| {
            let found = error.to_string();
            input.error(lines.first_after(start), Kind::Syntax { expected: "rows of CSV".into(), found })
        })?;
        if !more {
            break;
        }
        stage.done(start)?;
        let line = lines.first_after(start);
        match columns {
            None => {
                let is = |header: &&&[&str]| {
                    header.len() == row.len()
                        && header.iter().zip(&row).all(|(name, field)| field.eq_ignore_ascii_case(name.as_bytes()))
                };
                let Some(header) = headers.iter().find(is) else {
                    let whole: Vec<&[u8]> = row.iter().collect();
                    let kind = Kind::Syntax {
                        expected: format!("the header {}", expected()),
                        found: shown(&whole.join(&b',')),
                    };
                    return Err(input.error(line, kind));
                };
                columns = Some(header.len());
            }
            Some(count) if row.len() != count => {
                return Err(input.error(line, Kind::Fields { found: row.len(), expected: count.to_string() }));
            }
            Some(_) => each(line, &row).map_err(|kind| input.error(line, kind))?,
        }
    }
    match columns {
        Some(_) => Ok(()),
        None => Err(input.error(None, Kind::Missing(format!("the header {}", expected())))),
    }
}

/// Finds the line in which a row begins: the CSV reader counts the comments and blank lines before a row to the row.
struct LineFinder<'a> {
    bytes: &'a [u8],
    offset: usize,
    line: usize,
}

impl LineFinder<'_> {
    /// Number of the first line at or after `start` that is neither blank nor a comment; `start` must not decrease.
    fn first_after(&mut self, start: usize) -> usize {
        let passed = self.bytes.get(self.offset..start).unwrap_or_default();
        self.line += passed.iter().filter(|&&byte| byte == b'\n').count();
        self.offset = start.max(self.offset);
        let rest = self.bytes.get(self.offset..).unwrap_or_default();
        let skipped = Lines::new(rest).take_while(|line| line.bytes.is_empty() || line.bytes.starts_with(b"#")).count();
        self.line + skipped
    }
}

/// A finite number within the bounds of a coordinate.
fn coordinate(field: &[u8], what: &str) -> Result<f64, Kind> {
    let value = finite(field, what)?;
    if value.abs() > FARTHEST_M {
        return Err(Kind::Outside { what: what.to_owned(), value, bound: "-1e8 to 1e8 m" });
    }
    Ok(value)
}

/// A finite number.
pub(super) fn finite(field: &[u8], what: &str) -> Result<f64, Kind> {
    let value =
        number(field).ok_or_else(|| Kind::Syntax { expected: format!("{what}, a number"), found: shown(field) })?;
    if value.is_finite() { Ok(value) } else { Err(Kind::NotFinite { what: what.to_owned(), value }) }
}

/// An id that is not empty and was not there before.
pub(super) fn unique_id(
    field: &[u8],
    line: usize,
    what: &'static str,
    first_lines: &mut HashMap<String, usize>,
) -> Result<String, Kind> {
    let id = text(field);
    if id.is_empty() {
        return Err(Kind::Missing(format!("the {what}'s id")));
    }
    match first_lines.insert(id.clone(), line) {
        Some(first) => Err(Kind::Twice { what, name: id, first }),
        None => Ok(id),
    }
}

/// A direction at unit length.
fn unit(normal: DVec3) -> Result<DVec3, Kind> {
    // Scaled first, so that neither very long nor very short normals lose their direction.
    let scaled = normal / normal.abs().max_element();
    scaled.try_normalize().ok_or(Kind::Flat("the normal has no length"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use std::path::Path;

    fn csv(text: &[u8]) -> Result<Vec<RawSensor>, SceneError> {
        read_sensors_csv(&Input::alone(text, Path::new("s.csv"), &Quiet, &Cancel::new()))
    }

    #[track_caller]
    fn fails(text: &str, want: &str) {
        assert_eq!(csv(text.as_bytes()).expect_err("broken").to_string(), want);
    }

    #[test]
    fn empty_normals_make_scalar_sensors() {
        let text =
            b"\xEF\xBB\xBF# by hand\r\nid,x,y,z,nx,ny,nz\r\n\r\na,1,2,3,0,0,2\r\n# middle\r\n\"B, \xFC\",1,2,3,,,\r\n";
        let sensors = csv(text).unwrap();
        assert_eq!(sensors[0].normal, Some(DVec3::Z));
        assert_eq!((sensors[1].id.as_str(), sensors[1].normal), ("B, \u{fc}", None));
        assert_eq!(csv(b"id,x,y,z\n").unwrap(), []);
    }

    #[test]
    fn errors_name_the_line_of_the_row() {
        let header = "id,x,y,z,nx,ny,nz";
        fails("", "s.csv: the header id,x,y,z or id,x,y,z,nx,ny,nz is missing");
        fails("a,1,2,3\n", "s.csv:1: expected the header id,x,y,z or id,x,y,z,nx,ny,nz, found \"a,1,2,3\"");
        fails(&format!("# one\n{header}\n\n# four\na,1,2\n"), "s.csv:5: 3 fields, expected 7");
        fails(&format!("{header}\na,1,2,3,,,\na,1,2,3,,,\n"), "s.csv:3: sensor \"a\" occurs twice, first in line 2");
        fails(&format!("{header}\na,1,2,inf,,,\n"), "s.csv:2: z inf is not a finite number");
        fails(&format!("{header}\na,1,,3,,,\n"), "s.csv:2: expected y, a number, found nothing");
        fails(&format!("{header}\na,1,2,3,0,0,0\n"), "s.csv:2: the normal has no length");
        fails(&format!("{header}\na,1,2,3,0,,1\n"), "s.csv:2: 2 fields, expected 0 or 3 for the normal");
        fails(&format!("{header}\n,1,2,3,,,\n"), "s.csv:2: the sensor's id is missing");
        fails(
            &format!("{header}\r\n\r\n# c\r\n\r\na,1,2,3,,,x\r\n"),
            "s.csv:5: 1 fields, expected 0 or 3 for the normal",
        );
    }

    #[test]
    fn pts_lines_become_sensors_in_order() {
        let read = |text: &str| read_pts(&Input::alone(text.as_bytes(), Path::new("s.pts"), &Quiet, &Cancel::new()));
        let sensors = read("# points\n2. 0.5 0.8 0 0 1 \n\n1 2 3\n").unwrap();
        assert_eq!(sensors.iter().map(|sensor| sensor.id.as_str()).collect::<Vec<_>>(), ["s0", "s1"]);
        assert_eq!(sensors[0].normal, Some(DVec3::Z));
        assert_eq!(
            read("1 2 3\n1 2\n").unwrap_err().to_string(),
            "s.pts:2: 2 fields, expected x y z or x y z nx ny nz"
        );
    }
}
