//! What each method says of what is picked, beside the reference.

use super::{reading, reference};
use crate::panels::number;
use crate::results::Answer;
use crate::state::{Picked, State};
use egui::{RichText, Ui};
use lightvein::light::{Reading, Status};
use lightvein::study::errors::angle_deg;

/// Shows all answers as a table.
pub fn show(ui: &mut Ui, state: &State, picked: Picked) {
    let reference = reference(state, picked);
    let answers = state.results.answers.iter();
    let of_answer = |answer: &Answer| {
        let reading = match picked {
            Picked::Node(node) => answer.at_nodes.get(node.index()).copied(),
            Picked::Sensor(sensor) => answer.at_sensors.get(sensor).copied(),
            Picked::Light(_) | Picked::Part(_) => None,
        };
        Some((answer.label(), reading?, answer.seconds))
    };
    let mut rows: Vec<(String, Reading, f64)> = answers.filter_map(of_answer).collect();
    if let (true, Some(reading), Some(estimate)) = (rows.is_empty(), reading(state, picked), &state.results.estimate) {
        rows.push((format!("{} {}", estimate.method, estimate.quality), reading, estimate.seconds));
    }

    egui::Grid::new("methods").num_columns(5).striped(true).spacing([12.0, 4.0]).show(ui, |ui| {
        for heading in ["Method", "W/m²", "Ratio", "Angle", "Time"] {
            ui.label(RichText::new(heading).weak());
        }
        ui.end_row();
        for (label, reading, seconds) in &rows {
            ui.label(label);
            match reading.status {
                Status::Ok | Status::Dark => ui.label(number(reading.value_w_m2)),
                status => ui.weak(status.name().replace('_', " ")),
            };
            let known_w_m2 = reference.map(|reference| reference.irradiance_w_m2).filter(|known| *known > 0.0);
            ui.label(known_w_m2.map_or("-".to_owned(), |known| number(reading.value_w_m2 / known)));
            let angle_deg = reference.and_then(|reference| angle_deg(reading, &reference));
            ui.label(angle_deg.map_or("-".to_owned(), |angle| format!("{angle:.0}°")));
            ui.label(seconds_text(*seconds));
            ui.end_row();
        }
        if let Some(reference) = reference {
            ui.strong("reference");
            ui.strong(number(reference.irradiance_w_m2));
            ui.label("1");
            ui.label("");
            ui.label("");
            ui.end_row();
        }
    });
    if reference.is_none() {
        let why = match picked {
            Picked::Node(_) => "Nodes have no reference; sensors may.",
            _ => "This sensor has no reference.",
        };
        ui.weak(why);
    }
}

/// A time, in the unit that fits.
pub fn seconds_text(seconds: f64) -> String {
    match seconds {
        _ if seconds < 1e-3 => format!("{:.0} µs", seconds * 1e6),
        _ if seconds < 1.0 => format!("{:.1} ms", seconds * 1e3),
        _ => format!("{seconds:.2} s"),
    }
}
