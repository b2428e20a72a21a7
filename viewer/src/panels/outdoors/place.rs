//! Where the scene stands, and which way is north.

use super::{change_asked, changed, gesture, site};
use crate::panels::{named, row, rows};
use crate::state::State;
use egui::{Button, DragValue, Ui};
use std::path::PathBuf;

/// Shows the place, and changes it.
pub fn show(ui: &mut Ui, state: &mut State) {
    let now = site(state);
    let decided = state.results.outdoors.sky.as_ref().map(|sky| sky.outdoors.place);
    rows(ui, "place", |ui| {
        row(ui, "Latitude", |ui| {
            let of_weather = decided.map(|place| place.latitude_rad.to_degrees());
            let mut latitude_deg = now.latitude_deg.or(of_weather).unwrap_or(0.0);
            let drag = DragValue::new(&mut latitude_deg).range(-90.0..=90.0).speed(0.1).max_decimals(4);
            let response = named(ui.add(drag.suffix("°")), "Latitude");
            changed(state, &response, |site| site.latitude_deg = Some(latitude_deg));
        });
        row(ui, "Longitude", |ui| {
            let of_weather = decided.map(|place| place.longitude_rad.to_degrees());
            let mut longitude_deg = now.longitude_deg.or(of_weather).unwrap_or(0.0);
            let drag = DragValue::new(&mut longitude_deg).range(-180.0..=180.0).speed(0.1).max_decimals(4);
            let response = named(ui.add(drag.suffix("°")), "Longitude");
            changed(state, &response, |site| site.longitude_deg = Some(longitude_deg));
        });
        row(ui, "Zone", |ui| {
            let mut ahead_h = now.utc_offset_h.or(decided.map(|place| place.utc_offset_h)).unwrap_or(0.0);
            let drag = DragValue::new(&mut ahead_h).range(-14.0..=14.0).speed(0.02).max_decimals(2);
            let ahead = |hours: f64, _| format!("{:+}", (hours * 100.0).round() / 100.0);
            let response = named(ui.add(drag.prefix("UTC").suffix(" h").custom_formatter(ahead)), "Zone");
            let response = response.on_hover_text("Standard time, without daylight saving");
            changed(state, &response, |site| site.utc_offset_h = Some(ahead_h));
        });
        row(ui, "North", |ui| {
            let mut north_deg = now.north_deg;
            let drag = DragValue::new(&mut north_deg).range(-360.0..=360.0).speed(0.5).max_decimals(1).suffix("°");
            let response = named(ui.add(drag), "North").on_hover_text("Direction of true north, clockwise from +Y");
            changed(state, &response, |site| site.north_deg = north_deg);
        });
    });
    let has_own = state.request.outdoors.as_ref().is_some_and(|asked| asked.site.is_some());
    let has_file = state.results.loaded.as_ref().is_some_and(|scene| scene.site.is_some());
    if has_file {
        let reset = ui.add_enabled(has_own, Button::new("Reset site"));
        let reset = reset.on_hover_text("Place, period and air as the file has them");
        if reset.clicked() {
            change_asked(state, gesture(&reset), |asked| asked.site = None);
        }
    }
    if let Some(weather) = state.results.outdoors.sky.as_ref().and_then(|sky| sky.outdoors.weather.as_ref()) {
        ui.weak(format!("The weather is of {}.", weather.name));
    }
}

/// Asks about the scene under a weather file; where the scene has no place it is that of the weather.
pub fn with_weather(state: &mut State, path: PathBuf) {
    let mut site = site(state);
    if state.results.loaded.as_ref().is_some_and(|scene| scene.site.is_none()) {
        // A place that was only made up gives way to the weather's.
        (site.latitude_deg, site.longitude_deg, site.utc_offset_h) = (None, None, None);
    }
    site.weather = Some(path);
    let number = egui::Id::unique("weather").with(&site.weather).value();
    change_asked(state, number, |asked| asked.site = Some(site));
}
