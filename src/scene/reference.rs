//! Which values are trusted at the sensors?
//!
//! CSV with the header `id,irradiance,stderr` or `id,irradiance,stderr,fx,fy,fz`, W/m2; lines that begin with `#` say how
//! it was made. Rows are matched to sensors by id.

use super::error::{Kind, SceneError};
use super::input::Input;
use super::sensors::{finite, read_table, unique_id};
use super::{Reference, Sensor};
use glam::DVec3;
use std::collections::HashMap;

/// Reads references, ids in the order of the file. An empty `fx,fy,fz` is not known and becomes zero.
///
/// # Errors
/// [`SceneError`] with the line: another header, a wrong number of fields, numbers that are none, not finite or, for
/// irradiance and its standard error, negative; ids that are empty or occur twice.
pub fn read_reference_csv(input: &Input) -> Result<Vec<(String, Reference)>, SceneError> {
    let mut rows = Vec::new();
    let mut first_lines = HashMap::new();
    let short: &[&str] = &["id", "irradiance", "stderr"];
    let long: &[&str] = &["id", "irradiance", "stderr", "fx", "fy", "fz"];
    read_table(input, &[short, long], |line, row| {
        let field = |index: usize| row.get(index).unwrap_or_default();
        let id = unique_id(field(0), line, "sensor", &mut first_lines)?;
        let positive = |index: usize, what: &str| {
            let value = finite(field(index), what)?;
            let what = what.to_owned();
            if value < 0.0 { Err(Kind::Outside { what, value, bound: "0 and above" }) } else { Ok(value) }
        };
        let flux_w_m2 = match (3..6).filter(|&index| !field(index).is_empty()).count() {
            0 => DVec3::ZERO,
            3 => DVec3::new(finite(field(3), "fx")?, finite(field(4), "fy")?, finite(field(5), "fz")?),
            found => return Err(Kind::Fields { found, expected: "0 or 3 for fx,fy,fz".into() }),
        };
        let reference =
            Reference { irradiance_w_m2: positive(1, "irradiance")?, stderr_w_m2: positive(2, "stderr")?, flux_w_m2 };
        rows.push((id, reference));
        Ok(())
    })?;
    Ok(rows)
}

/// The reference of each sensor, and how many rows name no sensor.
pub fn match_sensors(rows: Vec<(String, Reference)>, sensors: &[Sensor]) -> (Vec<Option<Reference>>, usize) {
    let mut by_id: HashMap<String, Reference> = rows.into_iter().collect();
    let matched = sensors.iter().map(|sensor| by_id.remove(&sensor.id)).collect();
    (matched, by_id.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use std::path::Path;

    #[test]
    fn rows_find_their_sensors() {
        let text = b"# by an oracle\nid,irradiance,stderr,fx,fy,fz\nb,2,0.1,,,\nghost,1,0,0,0,1\n";
        let rows = read_reference_csv(&Input::alone(text, Path::new("r.csv"), &Quiet, &Cancel::new())).unwrap();
        let sensor = |id: &str| Sensor { id: id.to_owned(), position_m: glam::Vec3::ZERO, normal: None };
        let (matched, unknown) = match_sensors(rows, &[sensor("a"), sensor("b")]);
        assert_eq!(unknown, 1);
        assert_eq!(matched[0], None);
        assert_eq!(matched[1].unwrap().irradiance_w_m2, 2.0);
    }

    #[test]
    fn errors_name_the_line() {
        let fails = |text: &str, want: &str| {
            let cancel = Cancel::new();
            let input = Input::alone(text.as_bytes(), Path::new("r.csv"), &Quiet, &cancel);
            assert_eq!(read_reference_csv(&input).unwrap_err().to_string(), want);
        };
        fails("id,irradiance,stderr\na,-1,0\n", "r.csv:2: irradiance -1.0 is outside 0 and above");
        fails("id,irradiance,stderr\na,1,nan\n", "r.csv:2: stderr NaN is not a finite number");
    }
}
