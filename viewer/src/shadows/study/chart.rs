//! The chart of time against error, as SVG: a panel for each resolution and kind of error, the best of each ringed.

use super::asks::Variant;
use super::summary::By;
use super::{Findings, Row};
use lightvein::export::chart::loglog::{self, Mark, Panel};
use std::io::{self, Write};

/// Errors that have a row of panels.
const SHOWN: [By; 2] = [By::Hard, By::Disc];

/// Writes the chart of what was found on `adapter`.
///
/// # Errors
/// What the writer says.
pub fn write_svg(out: &mut dyn Write, findings: &Findings, adapter: &str) -> io::Result<()> {
    let resolutions = resolutions(&findings.rows);
    let panels: Vec<Panel> = SHOWN
        .into_iter()
        .flat_map(|by| resolutions.iter().map(move |&resolution| panel(&findings.rows, by, resolution)))
        .collect();
    let says = format!("numbers are layers, hollow marks are variants, rings are the best; {adapter}");
    loglog::write(out, &panels, resolutions.len(), &says)
}

/// Those that were asked for.
fn resolutions(rows: &[Row]) -> Vec<u32> {
    let asked = rows.iter().filter(|row| !row.ask.is_by_memory);
    let mut sides: Vec<u32> = asked.map(|row| row.ask.settings.resolution).collect();
    sides.sort_unstable();
    sides.dedup();
    sides
}

fn panel(rows: &[Row], by: By, resolution: u32) -> Panel {
    let its = rows.iter().filter(|row| !row.ask.is_by_memory && row.ask.settings.resolution == resolution);
    let mark = |row: &Row| {
        let is_variant = row.ask.variant != Variant::AsNamed;
        Some(Mark {
            series: row.ask.method.name().to_owned(),
            label: if is_variant { row.ask.variant.name().to_owned() } else { row.ask.settings.layers.to_string() },
            at: [1e3 / row.frame_ms, by.of(row)?],
            is_hollow: is_variant,
        })
    };
    let against = match by {
        By::Disc => "the sun's disc",
        By::Hard | By::Wrong => "a sun without extent",
    };
    Panel {
        title: format!("{resolution} x {resolution}, against {against}"),
        axes: ["frames a second".to_owned(), "mean absolute error".to_owned()],
        marks: its.filter_map(mark).collect(),
        has_front: true,
    }
}

#[cfg(test)]
mod tests {
    use super::super::asks::{Extent, asks};
    use super::super::errors::Errors;
    use super::*;

    #[test]
    fn every_method_has_its_marks_in_every_panel() {
        let errors = Errors { counted: 9, left_out: 0, wrong: 0.1, hard: 0.1, disc: 0.1, bleeding: None, acne: None };
        let row =
            |(at, ask)| Row { ask, layers: 1, bytes: 1, frame_ms: 1.0 + at as f64, frames: 5, errors: Some(errors) };
        let rows: Vec<Row> = asks(&Extent::default()).into_iter().enumerate().map(row).collect();
        let first = panel(&rows, By::Hard, 256);
        assert_eq!(first.marks.len(), rows.iter().filter(|row| row.ask.settings.resolution == 256).count());
        assert_eq!((first.marks[0].at, first.marks[0].label.as_str()), ([1e3, 0.1], "1"));
        let mut svg = Vec::new();
        let findings = Findings { rows, ..Findings::default() };
        write_svg(&mut svg, &findings, "a <card>").unwrap();
        let svg = String::from_utf8(svg).unwrap();
        assert!(svg.contains("1024 x 1024") && svg.contains("hsm-light") && svg.contains("a &lt;card&gt;"));
    }
}
