//! The findings of a study as a table for people, as CSV and as JSON.

use super::summary::{By, Layers, MOST_TIMES_VSM, Summary};
use super::{Findings, Row};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Bytes of a megabyte.
const MB: f64 = 1e6;

/// The table, and what the rows say of the paper's claims.
pub fn table(findings: &Findings) -> String {
    let mut text = format!(
        "{:<28}{:>6}{:>7}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n",
        "method", "side", "layers", "MB", "ms", "wrong", "hard", "disc", "bleeds", "acne"
    );
    for row in &findings.rows {
        line(&mut text, row);
    }
    text.push('\n');
    claims(&mut text, findings);
    text
}

fn line(text: &mut String, row: &Row) {
    let share = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4}"));
    let errors = row.errors.as_ref();
    let wrong = errors.map_or_else(|| "-".to_owned(), |errors| format!("{:.2}%", 100.0 * errors.wrong));
    let _ = writeln!(
        text,
        "{:<28}{:>6}{:>7}{:>9.2}{:>9.2}{wrong:>9}{:>9}{:>9}{:>9}{:>9}{}",
        row.ask.name(),
        row.ask.settings.resolution,
        row.ask.settings.layers,
        row.bytes as f64 / MB,
        row.frame_ms,
        share(errors.map(|errors| errors.hard)),
        share(errors.map(|errors| errors.disc)),
        share(errors.and_then(|errors| errors.bleeding)),
        share(errors.and_then(|errors| errors.acne)),
        if row.ask.is_by_memory { "  by memory" } else { "" },
    );
}

fn claims(text: &mut String, findings: &Findings) {
    let Summary { layers, memory, time } = &findings.summary;
    if !layers.is_empty() {
        text.push_str(
            "layers that a hybrid map needs for the error of LVSM with so many (claimed: 0.8 of them, rounded up)\n",
        );
    }
    let mut rest = &layers[..];
    while let Some(first) = rest.first() {
        let is_alike =
            |other: &Layers| (other.by, other.method, other.resolution) == (first.by, first.method, first.resolution);
        let (group, others) = rest.split_at(rest.iter().take_while(|other| is_alike(other)).count());
        rest = others;
        let needed = |layers: &Layers| layers.needed.map_or_else(|| "more".to_owned(), |needed| needed.to_string());
        let each: Vec<String> = group.iter().map(|layers| format!("{} for {}", needed(layers), layers.lvsm)).collect();
        let holds = group.iter().filter(|layers| layers.holds()).count();
        let _ = writeln!(
            text,
            "  {:<6}{:<10}{:>5}: {}; holds {holds} of {}",
            first.by.name(),
            first.method.name(),
            first.resolution,
            each.join(", "),
            group.len()
        );
    }

    if !memory.is_empty() {
        text.push_str("error of a hybrid map, and of what takes as much memory\n");
    }
    for found in memory {
        let (Some(hybrid), Some(other)) = (findings.rows.get(found.hybrid), findings.rows.get(found.other)) else {
            continue;
        };
        let [its, others] = found.errors;
        let _ = writeln!(
            text,
            "  {:<6}{} ({:.1} MB) {its:.4}; {} ({:.1} MB) {others:.4}: {}",
            found.by.name(),
            hybrid.ask.words(),
            hybrid.bytes as f64 / MB,
            other.ask.words(),
            other.bytes as f64 / MB,
            if found.holds() { "less" } else { "not less" }
        );
    }

    let slowest = time.iter().max_by(|a, b| a.ratio.total_cmp(&b.ratio));
    if let Some((found, row)) = slowest.and_then(|found| Some((found, findings.rows.get(found.row)?))) {
        let within = time.iter().filter(|found| found.holds()).count();
        let _ = writeln!(
            text,
            "time over VSM's times layers: at most {:.2} ({}); {within} of {} rows within {MOST_TIMES_VSM}",
            found.ratio,
            row.ask.words(),
            time.len()
        );
    }
}

/// Columns of the CSV.
const COLUMNS: [&str; 16] = [
    "method",
    "variant",
    "resolution",
    "layers",
    "layers_used",
    "by_memory",
    "bytes",
    "frame_ms",
    "frames",
    "counted_px",
    "wrong",
    "hard",
    "disc",
    "bleeding",
    "acne",
    "left_out_px",
];

/// Writes a row each; errors are shares from 0 to 1, empty where there is none.
///
/// # Errors
/// What the writer says.
pub fn write_csv(out: &mut dyn Write, rows: &[Row]) -> io::Result<()> {
    writeln!(out, "{}", COLUMNS.join(","))?;
    for row in rows {
        let errors = row.errors.as_ref();
        let share = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.6}"));
        let count = |value: Option<usize>| value.map_or_else(String::new, |value| value.to_string());
        let cells: [String; COLUMNS.len()] = [
            row.ask.method.name().to_owned(),
            row.ask.variant.name().to_owned(),
            row.ask.settings.resolution.to_string(),
            row.ask.settings.layers.to_string(),
            row.layers.to_string(),
            row.ask.is_by_memory.to_string(),
            row.bytes.to_string(),
            format!("{:.4}", row.frame_ms),
            row.frames.to_string(),
            count(errors.map(|errors| errors.counted)),
            share(errors.map(|errors| errors.wrong)),
            share(errors.map(|errors| errors.hard)),
            share(errors.map(|errors| errors.disc)),
            share(errors.and_then(|errors| errors.bleeding)),
            share(errors.and_then(|errors| errors.acne)),
            count(errors.map(|errors| errors.left_out)),
        ];
        writeln!(out, "{}", cells.join(","))?;
    }
    Ok(())
}

/// The rows as JSON.
pub fn rows_json(rows: &[Row]) -> Value {
    let row = |row: &Row| {
        json!({
            "method": row.ask.method.name(),
            "variant": row.ask.variant.name(),
            "resolution": row.ask.settings.resolution,
            "layers": row.ask.settings.layers,
            "layers_used": row.layers,
            "by_memory": row.ask.is_by_memory,
            "bytes": row.bytes,
            "frame_ms": row.frame_ms,
            "frames": row.frames,
            "errors": row.errors.map(|errors| json!({
                "counted_px": errors.counted,
                "left_out_px": errors.left_out,
                "wrong": errors.wrong,
                "hard": errors.hard,
                "disc": errors.disc,
                "bleeding": errors.bleeding,
                "acne": errors.acne,
            })),
        })
    };
    rows.iter().map(row).collect()
}

/// What they say of the paper's claims, as JSON; rows by their numbers from 0.
pub fn summary_json(summary: &Summary) -> Value {
    let layers = summary.layers.iter().map(|found| {
        json!({
            "by": found.by.name(),
            "resolution": found.resolution,
            "method": found.method.name(),
            "lvsm_layers": found.lvsm,
            "lvsm_error": found.error,
            "layers": found.needed,
            "ratio": found.ratio(),
            "holds": found.holds(),
        })
    });
    let memory = summary.memory.iter().map(|found| {
        json!({
            "by": found.by.name(),
            "row": found.hybrid,
            "against_row": found.other,
            "errors": found.errors,
            "holds": found.holds(),
        })
    });
    let time = summary.time.iter().map(|found| json!({"row": found.row, "ratio": found.ratio, "holds": found.holds()}));
    json!({
        "errors": By::ALL.map(By::name),
        "layers": layers.collect::<Vec<_>>(),
        "memory": memory.collect::<Vec<_>>(),
        "time": time.collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::asks::{Extent, asks};
    use super::super::errors::Errors;
    use super::super::summary::summary;
    use super::*;

    fn findings() -> Findings {
        let errors =
            Errors { counted: 9, left_out: 1, wrong: 0.25, hard: 0.5, disc: 0.125, bleeding: None, acne: Some(0.0) };
        let row = |(at, ask): (usize, _)| Row {
            ask,
            layers: 1,
            bytes: 2_000_000,
            frame_ms: 1.5,
            frames: 5,
            errors: (at > 0).then_some(errors),
        };
        let rows: Vec<Row> = asks(&Extent::default()).into_iter().enumerate().map(row).collect();
        Findings { summary: summary(&rows), rows, best: Vec::new() }
    }

    #[test]
    fn the_table_has_a_line_a_row_and_the_claims() {
        let findings = findings();
        let text = table(&findings);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[1].starts_with("plain") && lines[1].ends_with('-'), "{}", lines[1]);
        let numbers: Vec<&str> = lines[2].split_whitespace().collect();
        assert_eq!(numbers, ["plain", "512", "1", "2.00", "1.50", "25.00%", "0.5000", "0.1250", "-", "0.0000"]);
        assert_eq!(lines[findings.rows.len() + 1], "");
        // All errors are the same: two layers suffice for any number, and nothing is less.
        assert!(text.contains("hsm        1024: 2 for 2, 2 for 4, 2 for 8, 2 for 15; holds 4 of 4"), "{text}");
        assert!(text.contains("not less") && !text.contains(": less"));
        assert!(text.contains("time over VSM's times layers: at most 1.00"), "{text}");
        assert!(text.lines().all(|line| line.chars().count() < 150));
    }

    #[test]
    fn csv_and_json_have_the_same_rows() {
        let findings = findings();
        let mut csv = Vec::new();
        write_csv(&mut csv, &findings.rows).unwrap();
        let csv = String::from_utf8(csv).unwrap();
        assert!(csv.lines().all(|line| line.split(',').count() == COLUMNS.len()));
        assert_eq!(csv.lines().count(), findings.rows.len() + 1);
        assert!(csv.contains("hsm,one class,1024,4,1,false,2000000,1.5000,5,9,0.250000,0.500000,0.125000,,0.000000,1"));
        let rows = rows_json(&findings.rows);
        assert_eq!(rows.as_array().unwrap().len(), findings.rows.len());
        assert!(rows[0]["errors"].is_null() && rows[1]["errors"]["wrong"] == 0.25);
        let summary = summary_json(&findings.summary);
        assert_eq!(summary["layers"].as_array().unwrap().len(), findings.summary.layers.len());
        assert_eq!(summary["layers"][0]["layers"], 2);
    }
}
