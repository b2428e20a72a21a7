//! The legend over the view: limits that are dragged, and a range that stays until it is refitted.

use crate::panels::{drag, shown};
use crate::scene::state;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use lightvein_viewer::colour::ColourMap;
use lightvein_viewer::layers::NodeColour;
use lightvein_viewer::legend;
use lightvein_viewer::measure::Measure;
use lightvein_viewer::state::{Picked, State};

fn over_all(ui: &mut egui::Ui, state: &mut State) {
    let rect = ui.max_rect();
    legend::show(ui, state, rect);
}

#[test]
fn limits_are_dragged_and_refitted() {
    let mut harness = shown(over_all, state());
    let fitted = harness.state_mut().scale(Measure::Irradiance);
    assert!(harness.query_by_label_contains(", some below").is_none());
    let place = harness.get_by_role_and_label(Role::Slider, "Lowest Irradiance").rect().center();
    drag(&mut harness, place, egui::vec2(150.0, 0.0));
    let dragged = harness.state_mut().scale(Measure::Irradiance);
    assert!(dragged.low > 2.0 * fitted.low && dragged.high == fitted.high, "{fitted:?} {dragged:?}");

    // What lies below it is told by a sign, and to screen readers in words.
    assert!(harness.query_by_label_contains(", some below").is_some());

    // Other values do not move it.
    let mut estimate = (**harness.state().results.estimate.as_ref().expect("an estimate")).clone();
    estimate.at_nodes.readings.iter_mut().for_each(|reading| reading.value_w_m2 *= 10.0);
    harness.state_mut().results.estimate = Some(std::sync::Arc::new(estimate));
    harness.run();
    assert_eq!(harness.state_mut().scale(Measure::Irradiance), dragged);

    harness.get_by_label("Refit Irradiance").click();
    harness.run();
    assert!(harness.state_mut().scale(Measure::Irradiance).high > 5.0 * fitted.high);
}

#[test]
fn limits_do_not_cross() {
    let mut harness = shown(over_all, state());
    let place = harness.get_by_role_and_label(Role::Slider, "Highest Irradiance").rect().center();
    drag(&mut harness, place, egui::vec2(-400.0, 0.0));
    let scale = harness.state_mut().scale(Measure::Irradiance);
    assert!(scale.low < scale.high && scale.high < 1.3 * scale.low, "{scale:?}");
}

#[test]
fn a_map_is_chosen_and_kept() {
    let mut harness = shown(over_all, state());
    let first = harness.state().layers.measures()[0];
    harness.get_by_label(&format!("Colour map of {}", first.title())).click();
    harness.run();
    harness.get_by_label("Cividis").click();
    harness.run();
    assert_eq!(harness.state_mut().scale(first).map, ColourMap::Cividis);
    harness.state_mut().refit(first);
    assert_eq!(harness.state_mut().scale(first).map, ColourMap::Cividis);
}

#[test]
fn categories_and_paths_have_a_key_by_name() {
    let mut state = state();
    state.layers.node_colour = NodeColour::Cell;
    state.picked = Some(Picked::Sensor(0));
    let harness = shown(over_all, state);
    for label in ["Cell 0", "Cell 1", "forward", "backward", "zero or missing"] {
        harness.get_by_label(label);
    }
}
