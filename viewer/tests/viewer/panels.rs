//! Panels: what they show, and what they change. Each test also fails on a widget without a name and on a missing glyph, which
//! the harness looks for.

use crate::scene::state;
use egui::accesskit::Role;
use egui::{Event, Pos2, Ui, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightvein::scene::parts::Edit;
use lightvein::scene::{Light, Method};
use lightvein_viewer::layers::{MeshStyle, NodeColour};
use lightvein_viewer::log::Level;
use lightvein_viewer::panels::{self, scene::asked_lights};
use lightvein_viewer::request::Edits;
use lightvein_viewer::state::{Picked, State};
use lightvein_viewer::theme;

/// A panel, tall enough that nothing is scrolled away.
pub fn shown(show: fn(&mut Ui, &mut State), state: State) -> Harness<'static, State> {
    let show = move |ui: &mut Ui, state: &mut State| {
        theme::apply(ui.ctx(), &state.kept);
        show(ui, state);
    };
    let mut harness = Harness::builder().with_size([420.0, 1600.0]).with_max_steps(20).build_ui_state(show, state);
    harness.run();
    harness
}

/// Drags from one place to another in a few steps.
pub fn drag(harness: &mut Harness<'static, State>, from: Pos2, by: Vec2) {
    harness.hover_at(from);
    harness.run();
    harness.drag_at(from);
    harness.run();
    for step in 1..=5 {
        harness.event(Event::PointerMoved(from + by * (step as f32 / 5.0)));
        harness.run();
    }
    harness.drop_at(from + by);
    harness.run();
}

fn first_flux_w(state: &State) -> f64 {
    asked_lights(state).first().map(Light::flux_w).expect("a light")
}

#[test]
fn switches_switch_layers_and_their_options_come_and_go() {
    let mut harness = shown(panels::layers::show, state());
    assert!(!harness.state().layers.voxels && harness.query_by_label("Which voxels").is_none());
    harness.get_by_role_and_label(Role::CheckBox, "Voxels").click();
    harness.run();
    assert!(harness.state().layers.voxels && harness.query_by_label("Which voxels").is_some());

    harness.get_by_role_and_label(Role::CheckBox, "Section plane").click();
    harness.run();
    assert!(harness.state().layers.section.is_some());
    harness.get_by_role_and_label(Role::CheckBox, "Section plane").click();
    harness.run();
    assert_eq!(harness.state().layers.section, None);
    assert!(!harness.state().history.can()[0], "layers are no step to undo");
}

#[test]
fn styles_and_colours_are_chosen_by_name() {
    let mut harness = shown(panels::layers::show, state());
    harness.get_by_role_and_label(Role::ComboBox, "Mesh style").click();
    harness.run();
    harness.get_by_label("Wireframe").click();
    harness.run();
    harness.get_by_role_and_label(Role::ComboBox, "Node colour").click();
    harness.run();
    harness.get_by_label("Cell").click();
    harness.run();
    let layers = &harness.state().layers;
    assert_eq!((layers.mesh_style, layers.node_colour), (MeshStyle::Wireframe, NodeColour::Cell));
}

#[test]
fn a_dragged_flux_is_asked_for_at_once_and_is_one_step_to_undo() {
    let mut harness = shown(panels::scene::show, state());
    assert_eq!(first_flux_w(harness.state()), 60.0);
    let place = harness.get_by_role_and_label(Role::SpinButton, "Flux of light 0").rect().center();
    drag(&mut harness, place, egui::vec2(60.0, 0.0));
    let once_w = first_flux_w(harness.state());
    assert!(once_w > 61.0 && harness.state().is_stale(), "{once_w}");
    drag(&mut harness, place, egui::vec2(60.0, 0.0));
    let twice_w = first_flux_w(harness.state());
    assert!(twice_w > once_w + 1.0);

    // Two drags, two steps.
    for want_w in [once_w, 60.0] {
        let state = harness.state_mut();
        state.request = state.history.undo(&state.request).expect("a step");
        assert_eq!(first_flux_w(state), want_w);
    }
    assert_eq!(Some(&harness.state().request), harness.state().answered.as_ref());
    assert!(!harness.state().history.can()[0]);
}

#[test]
fn a_position_is_typed_in_the_users_coordinates() {
    let mut harness = shown(panels::scene::show, state());
    harness.get_by_label("z of light 0").click();
    harness.run();
    // The whole number is selected when its field opens.
    harness.get_by_label("z of light 0").type_text("1.25");
    harness.run();
    harness.key_press(egui::Key::Enter);
    harness.run();
    let state = harness.state();
    let scene = state.results.loaded.as_ref().expect("a scene");
    let lights = asked_lights(state);
    let at_m = scene.to_user_m(panels::scene::middle_m(&lights[0]));
    assert!((at_m - glam::dvec3(1.63, 2.47, 1.25)).length() < 1e-5, "{at_m}");
    assert_eq!(state.history.can(), [true, false]);

    // However many signs were typed, it is one step.
    let state = harness.state_mut();
    state.request = state.history.undo(&state.request).expect("a step");
    assert!(!state.is_stale() && !state.history.can()[0]);
}

#[test]
fn lights_are_added_and_removed() {
    let mut harness = shown(panels::scene::show, state());
    harness.get_by_label("Add a light").click();
    harness.run();
    assert_eq!((asked_lights(harness.state()).len(), harness.state().picked), (2, Some(Picked::Light(1))));
    harness.get_by_label("Remove light 0").click();
    harness.run();
    assert_eq!(first_flux_w(harness.state()), 100.0);
    harness.get_by_label("Reset lights").click();
    harness.run();
    assert_eq!(first_flux_w(harness.state()), 60.0);
    assert_eq!(harness.state().request.edits, Edits::default());
}

#[test]
fn another_method_is_asked_for_at_its_default_quality() {
    let mut state = state();
    state.request.how.quality = Some(1);
    let mut harness = shown(panels::scene::show, state);
    harness.get_by_role_and_label(Role::ComboBox, "Method").click();
    harness.run();
    harness.get_by_label("forward").click();
    harness.run();
    let how = harness.state().request.how;
    assert_eq!((how.method, how.quality), (Some(Method::Forward), None));
}

#[test]
fn filter_and_voxel_size_go_back_to_what_the_library_has() {
    let mut harness = shown(panels::scene::show, state());
    harness.get_by_label("What the skeleton keeps").click();
    harness.run();
    harness.get_by_label("Cut branches").click();
    harness.run();
    assert!(!harness.state().request.how.filter.cuts_branches);
    harness.get_by_label("Reset filter").click();
    harness.run();
    assert_eq!(harness.state().request.how.filter, lightvein::skeleton::Filter::default());
    harness.get_by_label("Reset voxel size").click();
    harness.run();
    assert_eq!(harness.state().request.how.voxel_m, None);
}

#[test]
fn a_part_is_hidden_moved_and_given_back() {
    let mut state = state();
    // The scene's mesh as two parts, whatever its file says.
    let mut scene = (**state.results.loaded.as_ref().expect("a scene")).clone();
    let end = scene.mesh.triangles.len() as u32;
    let part = |name: &str, triangles| lightvein::scene::parts::Part {
        name: name.to_owned(),
        triangles: vec![triangles],
        keeps_for_others: 0,
    };
    scene.parts = vec![part("walls", 0..end / 2), part("rest", end / 2..end)];
    state.results.loaded = Some(std::sync::Arc::new(scene));

    let mut harness = shown(panels::scene::show, state);
    harness.get_by_label("Show rest").click();
    harness.run();
    assert_eq!(harness.state().request.edits.parts, [("rest".to_owned(), Edit::Hide)]);
    harness.get_by_label("Show rest").click();
    harness.run();
    assert!(harness.state().request.edits.parts.is_empty());

    harness.get_by_label("walls").click();
    harness.run();
    let place = harness.get_by_label("Move part along y").rect().center();
    drag(&mut harness, place, egui::vec2(40.0, 0.0));
    let parts = harness.state().request.edits.parts.clone();
    assert!(matches!(parts.as_slice(), [(name, Edit::Move(by_m))] if name == "walls" && by_m.y > 0.5), "{parts:?}");
    harness.get_by_label("Reset part").click();
    harness.run();
    assert!(harness.state().request.edits.parts.is_empty());
}

#[test]
fn the_inspector_tells_what_is_picked_with_every_method_beside_the_reference() {
    let mut state = state();
    state.picked = Some(Picked::Sensor(0));
    let id = state.results.scene.as_ref().expect("a scene").sensors[0].id.clone();
    let answers: Vec<String> = state.results.answers.iter().map(|answer| answer.label()).collect();
    assert!(answers.len() >= 4, "{answers:?}");
    let mut harness = shown(panels::inspector::show, state);
    harness.get_by_label(&format!("Sensor {id}"));
    for label in answers.iter().map(String::as_str).chain(["reference", "Estimate / reference"]) {
        assert!(harness.query_all_by_label(label).next().is_some(), "{label}");
    }

    let centre = harness.state().results.model.as_ref().expect("a model").skeleton.cells[0].centre;
    let model = harness.state().results.model.clone().expect("a model");
    harness.state_mut().picked = Some(Picked::Node(centre));
    harness.run();
    harness.get_by_label(&format!("Node {}", centre.index()));
    let radius = format!("{:.3} m", model.skeleton.graph[centre].radius_m);
    assert!(harness.query_all_by_label(&radius).next().is_some(), "{radius}");
    for picked in [Picked::Light(0), Picked::Part(0)] {
        harness.state_mut().picked = Some(picked);
        harness.run();
    }
}

#[test]
fn the_log_tells_by_words_and_is_cleared() {
    let mut state = state();
    state.log.tell(Level::Error, "a.toml", "a.toml:3: no such key");
    state.log.tell(Level::Warning, "", "mind the gap");
    let mut harness = shown(panels::log::show, state);
    harness.get_by_label("Error");
    harness.get_by_label("a.toml:3: no such key");
    harness.get_by_label("Warning");
    harness.get_by_label("Clear").click();
    harness.run();
    assert!(harness.state().log.entries.is_empty());
}

#[test]
fn all_that_is_copied_from_the_log_is_its_text() {
    let mut state = state();
    state.log.tell(Level::Error, "a.toml", "a.toml:3: no such key");
    let mut harness = shown(panels::log::show, state);
    harness.get_by_label("Copy all").click();
    harness.step();
    let copied = |command: &egui::OutputCommand| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    };
    let copied: Vec<String> = harness.output().platform_output.commands.iter().filter_map(copied).collect();
    assert_eq!(copied, ["error: a.toml:3: no such key\n"]);
}

#[test]
fn stages_and_chart_show_what_was_measured_and_say_why_where_nothing_was() {
    let state = state();
    let first = state.results.stages.first().map(|stage| stage.name.clone()).expect("a stage");
    let harness = shown(panels::stages::show, state);
    assert!(harness.query_all_by_label_contains(&first).next().is_some(), "{first}");

    shown(panels::chart::show, self::state());
    let mut without = self::state();
    let mut scene = (**without.results.scene.as_ref().expect("a scene")).clone();
    scene.reference = Vec::new();
    without.results.scene = Some(std::sync::Arc::new(scene));
    let mut answers = (*without.results.answers).clone();
    answers.iter_mut().for_each(|answer| answer.errors.rms_factor = None);
    without.results.answers = std::sync::Arc::new(answers);
    let harness = shown(panels::chart::show, without);
    harness.get_by_label_contains("no reference");
}

#[test]
fn panels_without_a_scene_say_so() {
    let bare = || State::new(Default::default(), Default::default());
    let all = [
        panels::scene::show,
        panels::inspector::show,
        panels::sensors::show,
        panels::chart::show,
        panels::stages::show,
        panels::log::show,
        panels::layers::show,
    ];
    for show in all {
        shown(show, bare());
    }
}
