//! What a stress test found as CSV: a line for each scene, failure, case and method.

use crate::study::stress::{Row, Statuses};
use std::io::{self, Write};

const HEADER: [&str; 25] = [
    "scene",
    "failure",
    "case",
    "method",
    "moves",
    "moved_p95",
    "moved_max",
    "moved_angle_p95_deg",
    "moved_angle_max_deg",
    "worst_sensor",
    "worst_trial",
    "vanished",
    "truths",
    "truth_rms",
    "truth_p95",
    "truth_max",
    "truth_angle_p95_deg",
    "lost",
    "phantom",
    "ok",
    "dark",
    "in_solid",
    "unreached",
    "outside",
    "warnings",
];

/// Writes the rows: `moved_*` are factors between disturbed and undisturbed answers, `truth_*` between answers and the truth
/// (`moves` and `truths` say of how many; an infinite one is `inf`), `worst_*` are where the most moved, `vanished` the answers that are zero on one side of a
/// move alone, `lost` zeros where there is light, `phantom` light where there is none, then sensors by status.
///
/// # Errors
/// What the writer says.
pub fn write_csv(out: &mut dyn Write, rows: &[Row]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(HEADER)?;
    let figure = |value: Option<f64>| value.map(|value| format!("{value:.4}")).unwrap_or_default();
    for row in rows {
        let Row { moved, truth, statuses, .. } = row;
        let Statuses { ok, dark, in_solid, unreached, outside } = *statuses;
        let words = [row.scene.clone(), row.failure.name().to_owned(), row.case.clone(), row.method.clone()];
        let moves = [
            moved.count().to_string(),
            figure(moved.p95()),
            figure(moved.max()),
            figure(moved.angle_p95_deg()),
            figure(moved.angle_max_deg()),
            row.worst().map(|(sensor, _)| sensor.to_owned()).unwrap_or_default(),
            row.worst().map(|(_, trial)| trial.to_string()).unwrap_or_default(),
            (moved.lost + moved.phantom).to_string(),
        ];
        let truths = [
            truth.count().to_string(),
            figure(truth.rms()),
            figure(truth.p95()),
            figure(truth.max()),
            figure(truth.angle_p95_deg()),
            truth.lost.to_string(),
            truth.phantom.to_string(),
        ];
        let counts = [ok, dark, in_solid, unreached, outside].map(|count| count.to_string());
        let warnings = [row.warnings.join(" | ")];
        table.write_record(words.iter().chain(&moves).chain(&truths).chain(&counts).chain(&warnings))?;
    }
    table.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::study::stress::Failure;

    #[test]
    fn a_row_has_a_field_for_each_name() {
        let mut row =
            Row::new(&Scene { name: "a, b".into(), ..Scene::default() }, Failure::Turn, "8 turns", "backward");
        row.moved.factors = vec![1.0, 2.0];
        let mut out = Vec::new();
        write_csv(&mut out, &[row]).expect("a vector takes all");
        let text = String::from_utf8(out).expect("text");
        let last = text.lines().last().expect("a row");
        assert_eq!(last, "\"a, b\",turn,8 turns,backward,2,2.0000,2.0000,,,,,0,0,,,,,0,0,0,0,0,0,0,");
    }
}
