//! What of the direct and diffuse irradiance is missing, and what of it can be found?
//!
//! Of three numbers, all light on the horizontal, direct light towards the sun, diffuse light on the horizontal, one follows
//! from the two others and the sun's height: GHI = DNI sin(elevation) + DHI, with the mean over the interval of what the sun
//! has above the horizon. With the sun too low the division is worth nothing: then, and where two are missing, a number is
//! taken as 0 and told.

use super::{Hour, MOST_W_M2, Row};
use crate::sky::{Place, sun};

/// Least mean sine of the sun's elevation by which direct light is divided out, 3 degrees: below, an error of 5 W/m2 in the
/// two others becomes 100.
const LEAST_UP: f64 = 0.05;

/// Moments of an interval at which the sun is looked up: in an hour five minutes apart.
const MOMENTS: u32 = 12;

/// Lines named in a warning before the rest is only counted.
const LINES_NAMED: usize = 5;

/// The intervals of rows, with what is missing found or taken as 0 and told.
pub(super) fn completed(place: &Place, rows: &[Row], warnings: &mut Vec<String>) -> Vec<Hour> {
    let mut found = [Vec::new(), Vec::new()];
    let mut lost = [Vec::new(), Vec::new()];
    let hours = rows.iter().map(|row| {
        let answers = answers(place, row);
        for (number, (given, answer)) in [row.dni, row.dhi].into_iter().zip(answers).enumerate() {
            let lines = if answer.is_some() { found.get_mut(number) } else { lost.get_mut(number) };
            lines.into_iter().filter(|_| given.is_none()).for_each(|lines| lines.push(row.line));
        }
        let [dni, dhi] = answers.map(Option::unwrap_or_default);
        let Row { line, start, length_h, ghi, .. } = *row;
        Hour { start, length_h, dni_w_m2: dni, dhi_w_m2: dhi, ghi_w_m2: ghi, line }
    });
    let hours = hours.collect();

    let names = ["direct normal", "diffuse horizontal"];
    for (what, ending) in [(found, "found from the others and the sun"), (lost, "taken as 0")] {
        for (name, lines) in names.iter().zip(what).filter(|(_, lines)| !lines.is_empty()) {
            warnings.push(format!("{name} radiation is missing in {}, {ending}", named(&lines)));
        }
    }
    hours
}

/// Direct and diffuse irradiance of a row, as given or as found, W/m2.
fn answers(place: &Place, row: &Row) -> [Option<f64>; 2] {
    match (row.ghi, row.dni, row.dhi) {
        (_, Some(dni), Some(dhi)) => [Some(dni), Some(dhi)],
        (Some(ghi), Some(dni), None) => [Some(dni), mean_up(place, row).map(|up| (ghi - dni * up).max(0.0))],
        (_, None, dhi) => {
            let dni = mean_up(place, row).and_then(|up| match (row.ghi, dhi) {
                // No sun, no direct light, whatever else is known.
                _ if up == 0.0 => Some(0.0),
                (Some(ghi), Some(dhi)) if up >= LEAST_UP => Some(((ghi - dhi) / up).clamp(0.0, MOST_W_M2)),
                _ => None,
            });
            // Without the sun, all light is diffuse.
            [dni, dhi.or(row.ghi.filter(|_| dni.is_some()))]
        }
        (None, dni, None) => [dni, None],
    }
}

/// Mean over a row's interval of the sine of the sun's elevation, 0 where it is down; `None` where the sun is not known.
fn mean_up(place: &Place, row: &Row) -> Option<f64> {
    let Row { line, start, length_h, .. } = *row;
    let hour = Hour { start, length_h, dni_w_m2: 0.0, dhi_w_m2: 0.0, ghi_w_m2: None, line };
    let mut sum = 0.0;
    for moment in 0..MOMENTS {
        let time = hour.at((f64::from(moment) + 0.5) / f64::from(MOMENTS));
        sum += sun::position(place, time, None).ok()?.elevation_rad.sin().max(0.0);
    }
    Some(sum / f64::from(MOMENTS))
}

/// How many rows, and the first of their lines: "3 rows (lines 9, 10, 11)".
pub(super) fn named(lines: &[usize]) -> String {
    let first: Vec<String> = lines.iter().take(LINES_NAMED).map(usize::to_string).collect();
    let more = match lines.len().saturating_sub(LINES_NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let (rows, word) = if lines.len() == 1 { ("row", "line") } else { ("rows", "lines") };
    format!("{} {rows} ({word} {}{more})", lines.len(), first.join(", "))
}
