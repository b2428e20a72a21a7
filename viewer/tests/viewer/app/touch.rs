//! The view by hand: picking, dragging, turning; and what the panes make of it.

use super::{Window, bring, click, drag, is_painted, opened, place, settle, view_rect};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase};
use egui_kittest::kittest::Queryable;
use glam::Vec3;
use lightvein::scene::Method;
use lightvein_viewer::panels::scene::{asked_lights, middle_m};
use lightvein_viewer::state::{Picked, State};
use petgraph::graph::NodeIndex;

fn light_m(state: &State) -> Vec3 {
    asked_lights(state).first().map(middle_m).expect("a light")
}

fn readings(window: &Window) -> Vec<f64> {
    let estimate = window.state().state.results.estimate.as_ref().expect("an estimate");
    estimate.at_sensors.readings.iter().map(|reading| reading.value_w_m2).collect()
}

/// The node that is farthest on the screen from all else that can be picked.
fn lonely_node(window: &Window) -> (NodeIndex, Vec3) {
    let state = &window.state().state;
    let (scene, model) =
        (state.results.scene.as_ref().expect("a scene"), state.results.model.as_ref().expect("a model"));
    let graph = &model.skeleton.graph;
    let others = |of: NodeIndex| {
        let nodes = graph.node_indices().filter(move |&node| node != of).map(|node| graph[node].position_m);
        nodes.chain(scene.sensors.iter().map(|sensor| sensor.position_m)).chain([light_m(state)])
    };
    let alone = |node: NodeIndex| {
        let at = place(window, graph[node].position_m);
        others(node).map(|other_m| place(window, other_m).distance(at)).fold(f32::INFINITY, f32::min)
    };
    let node = graph.node_indices().max_by(|&a, &b| alone(a).total_cmp(&alone(b))).expect("a node");
    (node, graph[node].position_m)
}

#[test]
fn what_is_clicked_is_picked_and_the_inspector_has_its_numbers() {
    let mut window = opened("two_rooms");
    window.get_by_label_contains("Click a node, a sensor, a light or a part");
    let scene = window.state().state.results.scene.clone().expect("a scene");

    // A sensor, its answer by every method, and its way to the light.
    let at = place(&window, scene.sensors[0].position_m);
    click(&mut window, at);
    assert_eq!(window.state().state.picked, Some(Picked::Sensor(0)));
    window.get_by_label(&format!("Sensor {}", scene.sensors[0].id));
    window.get_by_label("d_all of backward");
    let way = window.state().state.ways[0].way.clone().expect("a way to the light");
    window.get_by_label(&format!("{:.3} m, {} nodes", way.path_m, way.nodes.len()));
    assert!(way.path_m > 0.0 && !is_painted(&window, "no light is on"));

    // A node.
    let (node, at_m) = lonely_node(&window);
    let at = place(&window, at_m);
    click(&mut window, at);
    assert_eq!(window.state().state.picked, Some(Picked::Node(node)));
    window.get_by_label(&format!("Node {}", node.index()));

    // The light, which has no way to itself.
    let at = place(&window, light_m(&window.state().state));
    click(&mut window, at);
    assert_eq!(window.state().state.picked, Some(Picked::Light(0)));
    window.get_by_label("Light 0");
    assert!(window.state().state.ways.is_empty());

    // Esc lets go.
    window.key_press(Key::Escape);
    window.run();
    assert_eq!(window.state().state.picked, None);
}

#[test]
fn a_row_of_the_table_picks_its_sensor_with_its_ways() {
    let mut window = opened("two_rooms");
    let id = window.state().state.results.scene.as_ref().expect("a scene").sensors[1].id.clone();
    let at = window.get_by_role_and_label(Role::Label, &id).rect().center();
    click(&mut window, at);
    assert_eq!(window.state().state.picked, Some(Picked::Sensor(1)));
    window.get_by_label(&format!("Sensor {id}"));
    assert_eq!(window.state().state.ways.len(), 1, "one light, one way");
    assert!(!is_painted(&window, "no light is on"));
}

#[test]
fn a_light_is_dragged_and_the_results_follow_and_come_back() {
    let mut window = opened("two_rooms");
    let (before, at_m) = (readings(&window), light_m(&window.state().state));
    let at = place(&window, at_m);
    drag(&mut window, at, egui::vec2(-30.0, 12.0), 6);
    settle(&mut window);

    // It hangs where the pointer let go of it.
    let moved_m = light_m(&window.state().state);
    assert!(place(&window, moved_m).distance(at + egui::vec2(-30.0, 12.0)) < 1.5);
    assert!(moved_m.distance(at_m) > 0.1, "{moved_m}");
    assert!(!window.state().state.is_stale());
    let after = readings(&window);
    assert!(before.iter().zip(&after).all(|(before, after)| before != after), "{before:?} {after:?}");

    // One drag is one step, and the step leads back to the very same numbers.
    assert_eq!(window.state().state.history.can(), [true, false]);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut window);
    assert_eq!(window.state().state.history.can(), [false, true]);
    assert_eq!((light_m(&window.state().state), readings(&window)), (at_m, before));
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    settle(&mut window);
    assert_eq!((light_m(&window.state().state), readings(&window)), (moved_m, after));
}

#[test]
fn an_arrow_of_the_gizmo_moves_along_its_axis_alone() {
    let mut window = opened("two_rooms");
    let at_m = light_m(&window.state().state);
    let at = place(&window, at_m);
    click(&mut window, at);
    let (foot_m, length_m) = window.state().state.gizmo.expect("arrows on what is picked");
    assert_eq!(foot_m, at_m);
    let (from, to) =
        (place(&window, foot_m + Vec3::X * 0.8 * length_m), place(&window, foot_m + Vec3::X * 1.3 * length_m));
    drag(&mut window, from, to - from, 4);
    settle(&mut window);
    let by_m = light_m(&window.state().state) - at_m;
    assert!((by_m.x - 0.5 * length_m).abs() < 0.1 * length_m, "{by_m} along an arrow of {length_m} m");
    assert!(by_m.y == 0.0 && by_m.z == 0.0, "{by_m}");
}

#[test]
fn the_mouse_turns_and_zooms_the_camera_and_asks_for_nothing() {
    let mut window = opened("two_rooms");
    let first = window.state().state.camera;
    let corner = view_rect(&window).right_top() + egui::vec2(-40.0, 60.0);
    drag(&mut window, corner, egui::vec2(-60.0, 0.0), 3);
    window.run();
    let turned = window.state().state.camera;
    assert!(turned.azimuth_rad != first.azimuth_rad && turned.distance_m == first.distance_m);

    window.hover_at(view_rect(&window).center());
    let delta = egui::vec2(0.0, 50.0);
    let (unit, phase, modifiers) = (MouseWheelUnit::Point, TouchPhase::Move, Modifiers::NONE);
    window.event(Event::MouseWheel { source: MouseWheelSource::Unknown, unit, delta, phase, modifiers });
    window.run();
    let nearer = window.state().state.camera;
    assert!(nearer.distance_m < 0.95 * turned.distance_m, "{} m, {} m", nearer.distance_m, turned.distance_m);

    window.key_press(Key::Num7);
    window.run();
    assert!((window.state().state.camera.elevation_rad.to_degrees() - 90.0).abs() < 1.0);
    assert!(window.state().is_settled() && !window.state().state.history.can()[0]);
}

#[test]
fn layers_are_switched_by_key_and_by_name() {
    let mut window = opened("two_rooms");
    assert!(window.state().state.layers.nodes);
    window.key_press(Key::N);
    window.run();
    assert!(!window.state().state.layers.nodes);
    window.key_press(Key::V);
    settle(&mut window);
    assert!(window.state().state.layers.voxels && window.query_by_label("Which voxels").is_some());
    window.get_by_role_and_label(Role::CheckBox, "Nodes").click();
    window.run();
    assert!(window.state().state.layers.nodes);

    // An enclosed scene begins cut below its ceiling, and its chip shows it whole.
    assert!(window.state().state.layers.cut);
    window.get_by_label("Cut: show the whole mesh").click();
    window.run();
    assert!(!window.state().state.layers.cut);
}

#[test]
fn another_method_is_chosen_in_the_scene_pane() {
    let mut window = opened("two_rooms");
    let by = |window: &Window| window.state().state.results.estimate.as_ref().map(|estimate| estimate.method);
    assert_eq!(by(&window), Some(Method::Network));
    bring(&mut window, "Scene");
    window.get_by_role_and_label(Role::ComboBox, "Method").click();
    window.run();
    // Not the one in the table, which stands lower.
    let choices = window.get_all_by_role_and_label(Role::Button, "diffusion");
    let top = |node: &egui_kittest::Node| node.rect().top();
    choices.min_by(|a, b| top(a).total_cmp(&top(b))).expect("a choice").click();
    settle(&mut window);
    assert_eq!(by(&window), Some(Method::Diffusion));
    // The line at the foot says by which method.
    window.get_by_label_contains("diffusion in ");
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut window);
    assert_eq!(by(&window), Some(Method::Network));
}

#[test]
fn the_help_sheet_opens_by_its_key_and_closes_by_esc() {
    let mut window = opened("two_rooms");
    window.key_press_modifiers(Modifiers::SHIFT, Key::Questionmark);
    window.run();
    window.get_by_label("look from the front (south)");
    window.key_press(Key::Escape);
    window.run();
    assert!(window.query_by_label("look from the front (south)").is_none());
}

#[test]
fn esc_closes_an_open_list_and_lets_go_of_what_is_picked_only_then() {
    let mut window = opened("two_rooms");
    let at = place(&window, light_m(&window.state().state));
    click(&mut window, at);
    bring(&mut window, "Scene");
    window.get_by_role_and_label(Role::ComboBox, "Method").click();
    window.run();
    let choices = |window: &Window| window.query_all_by_role_and_label(Role::Button, "diffusion").count();
    let open = choices(&window);
    window.key_press(Key::Escape);
    window.run();
    assert_eq!(choices(&window), open - 1, "the list is closed");
    assert_eq!(window.state().state.picked, Some(Picked::Light(0)));
    window.key_press(Key::Escape);
    window.run();
    assert_eq!(window.state().state.picked, None);
}
