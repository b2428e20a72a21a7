//! The exposure map: how much comes from each direction over the period, azimuth by elevation, and where the suns stand.

use super::{nothing, number};
use crate::measure::Measure;
use crate::outdoors::shown::map_picture;
use crate::outdoors::sky::Sky;
use crate::state::State;
use egui::{Color32, Ui, vec2};
use egui_plot::{GridInput, GridMark, HoverPosition, Plot, PlotImage, PlotPoint, PlotPoints, Points};
use lightvein::sky::Sun;

/// Suns that are drawn at most: every sun of a year of hours.
const MOST_SUNS: usize = 5000;

const SUN: Color32 = Color32::from_rgb(213, 94, 0);
const NOW: Color32 = Color32::from_rgb(230, 159, 0);

/// Shows the map.
pub fn show(ui: &mut Ui, state: &mut State) {
    let Some(sky) = state.results.outdoors.sky.clone() else {
        return nothing(ui, state, "no place is known: give the scene one under \"Sun and sky\"");
    };
    let Some(picture) = map_picture(state, ui.ctx()) else { return };
    let totals = sky.map.totals;
    ui.horizontal_wrapped(|ui| {
        ui.label(format!("{}, {}", Measure::MapRadiance.title(), Measure::MapRadiance.unit()));
        ui.weak(format!("global horizontal {} kWh/m²", number(totals.ghi_kwh_m2)));
    });
    bar(ui, state);

    let name = if sky.map.suns.len() > MOST_SUNS { "" } else { "Suns" };
    let few = sky.map.suns.len().div_ceil(MOST_SUNS).max(1);
    let suns: Vec<[f64; 2]> = sky.map.suns.iter().step_by(few).map(|energy| place(&energy.sun)).collect();
    let now = state.outdoors.now.as_ref().map(|now| now.sun).filter(|sun| sun.elevation_rad > 0.0);
    let plot = Plot::new("exposure map")
        .default_x_bounds(0.0, 360.0)
        .default_y_bounds(0.0, 90.0)
        .x_axis_label("azimuth, degrees clockwise from north")
        .y_axis_label("elevation, degrees")
        .x_axis_formatter(|mark, _| quarter(mark.value))
        .x_grid_spacer(|input| marks(&input, [15.0, 45.0, 90.0]))
        .y_grid_spacer(|input| marks(&input, [5.0, 15.0, 30.0]))
        .allow_boxed_zoom(false)
        .show_grid(false)
        .label_formatter(|hover| Some(told_at(&sky, hover)));
    plot.show(ui, |plot| {
        let centre = PlotPoint::new(180.0, 45.0);
        plot.image(PlotImage::new("", picture.id(), centre, vec2(360.0, 90.0)).allow_hover(false));
        plot.points(Points::new(name, PlotPoints::from(suns)).radius(1.2).color(SUN).allow_hover(false));
        if let Some(sun) = now {
            let at = PlotPoints::from(vec![place(&sun)]);
            plot.points(Points::new("Now", at).radius(6.0).color(NOW).allow_hover(false));
        }
    });
}

/// The colours and their ends.
fn bar(ui: &mut Ui, state: &mut State) {
    const SHARES: usize = 64;
    let scale = state.scale(Measure::MapRadiance);
    ui.horizontal(|ui| {
        ui.label(number(f64::from(scale.low)));
        let (rect, response) = ui.allocate_exact_size(vec2(160.0, 12.0), egui::Sense::hover());
        let wide = rect.width() / SHARES as f32;
        for share in 0..SHARES {
            let [r, g, b] = scale.map.rgb((share as f32 + 0.5) / SHARES as f32);
            let left = rect.left() + wide * share as f32;
            let part = egui::Rect::from_min_size(egui::pos2(left, rect.top()), vec2(wide + 0.5, rect.height()));
            ui.painter().rect_filled(part, 0.0, Color32::from_rgb(r, g, b));
        }
        response.on_hover_text("Logarithmic; beyond the ends the colours stay, nothing is grey");
        ui.label(number(f64::from(scale.high)));
        if ui.button("Refit map").clicked() {
            state.refit(Measure::MapRadiance);
        }
    });
}

fn place(sun: &Sun) -> [f64; 2] {
    [sun.azimuth_rad.to_degrees(), sun.elevation_rad.to_degrees()]
}

/// Azimuth, elevation and value under the pointer.
fn told_at(sky: &Sky, hover: &HoverPosition<'_>) -> String {
    let (HoverPosition::NearDataPoint { position, .. } | HoverPosition::Elsewhere { position }) = hover;
    let (azimuth_deg, elevation_deg) = (position.x, position.y);
    if !(0.0..=360.0).contains(&azimuth_deg) || !(0.0..=90.0).contains(&elevation_deg) {
        return String::new();
    }
    let value = sky.radiance_at(azimuth_deg.to_radians(), elevation_deg.to_radians());
    let value = number(f64::from(value));
    format!("azimuth {azimuth_deg:.1}°, elevation {elevation_deg:.1}°\n{value} {}", Measure::MapRadiance.unit())
}

/// The quarters by their names.
fn quarter(azimuth_deg: f64) -> String {
    match azimuth_deg.round() as i64 {
        0 | 360 => "N".to_owned(),
        90 => "E".to_owned(),
        180 => "S".to_owned(),
        270 => "W".to_owned(),
        other => other.to_string(),
    }
}

/// Marks at multiples of whole angles, the finest first.
fn marks(input: &GridInput, steps: [f64; 3]) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let multiples = steps.iter().flat_map(|&step| {
        let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
        (first..=last).map(move |number| GridMark { value: number as f64 * step, step_size: step })
    });
    multiples.collect()
}
