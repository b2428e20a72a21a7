//! The table of sensors, on screen and as text.

use crate::panels::shown;
use crate::scene::state;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightvein::scene::Sensor;
use lightvein_viewer::panels::sensors;
use lightvein_viewer::state::{Picked, State};
use std::sync::Arc;

/// The names of the sensors from the top of the table down.
fn rows(harness: &Harness<'static, State>) -> Vec<String> {
    let scene = harness.state().results.scene.clone().expect("a scene");
    let place = |id: &str| harness.query_by_label(id).map(|node| node.rect().top());
    let mut rows: Vec<(f32, String)> =
        scene.sensors.iter().filter_map(|sensor| Some((place(&sensor.id)?, sensor.id.clone()))).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|(_, id)| id).collect()
}

#[test]
fn a_click_on_a_heading_sorts_and_one_on_a_row_picks() {
    let state = state();
    let scene = state.results.scene.clone().expect("a scene");
    let estimate = state.results.estimate.clone().expect("an estimate");
    let mut by_value: Vec<usize> = (0..scene.sensors.len()).collect();
    by_value.sort_by(|a, b| {
        let value = |at: &usize| estimate.at_sensors.readings[*at].value_w_m2;
        value(a).total_cmp(&value(b))
    });

    let mut harness = shown(sensors::show, state);
    assert_eq!(rows(&harness)[0], scene.sensors[0].id);
    for ends in [[0, by_value.len() - 1], [by_value.len() - 1, 0]] {
        harness.get_by_role_and_label(Role::Button, heading(&harness)).click();
        harness.run();
        let rows = rows(&harness);
        assert_eq!(rows[0], scene.sensors[by_value[ends[0]]].id, "{rows:?}");
    }
    harness.get_by_label(&scene.sensors[by_value[0]].id).click();
    harness.run();
    assert_eq!(harness.state().picked, Some(Picked::Sensor(by_value[0])));
}

/// The heading of the estimate, with a sign behind it once it is sorted.
fn heading(harness: &Harness<'static, State>) -> &'static str {
    ["W/m²", "W/m² ⏶", "W/m² ⏷"].into_iter().find(|text| harness.query_by_label(text).is_some()).expect("a heading")
}

#[test]
fn of_a_hundred_thousand_sensors_those_are_drawn_that_are_seen() {
    let mut state = state();
    let mut scene = (**state.results.scene.as_ref().expect("a scene")).clone();
    let first = scene.sensors[0].clone();
    scene.sensors = (0..100_000).map(|number| Sensor { id: format!("s{number}"), ..first.clone() }).collect();
    state.results.scene = Some(Arc::new(scene));
    let mut harness = shown(sensors::show, state);
    let drawn = |harness: &Harness<'static, State>| harness.query_all_by_label_contains("s").count();
    assert!((10..1000).contains(&drawn(&harness)), "{}", drawn(&harness));
    harness.get_by_label("No. ⏶").click();
    harness.run();
    harness.get_by_label("s99999");
    assert!((10..1000).contains(&drawn(&harness)), "{}", drawn(&harness));
}

#[test]
fn the_file_has_a_row_a_sensor_in_the_users_coordinates() {
    let state = state();
    let scene = state.results.scene.clone().expect("a scene");
    let text = sensors::csv(&state);
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), scene.sensors.len() + 1);
    let header = ["number", "id", "x_m", "y_m", "z_m", "irradiance_w_m2", "reference_w_m2", "ratio"];
    assert_eq!(lines[0][..8], header);
    assert_eq!(lines[0].last(), Some(&"status"));
    assert!(lines.iter().all(|line| line.len() == lines[0].len()));
    let at_m = scene.to_user_m(scene.sensors[0].position_m).to_array().map(|along| along.to_string());
    assert_eq!(lines[1][1..5], [scene.sensors[0].id.as_str(), &at_m[0], &at_m[1], &at_m[2]]);
    let number = |column: usize| lines[1][column].parse::<f64>().expect("a number");
    assert!((number(5) / number(6) / number(7) - 1.0).abs() < 1e-12);
}
