//! Sun and sky: the panel, the map and what the view gets of them. Each test also fails on a widget without a name and on a
//! missing glyph, which the harness looks for.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::{Vec2, Vec3};
use lightvein::daylight::Quantity;
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::Scene;
use lightvein_viewer::camera::Camera;
use lightvein_viewer::layers::{Layers, MeshColour};
use lightvein_viewer::measure::Measure;
use lightvein_viewer::outdoors::compute::{Question, compute};
use lightvein_viewer::outdoors::{OutdoorRequest, OutdoorResults, shown};
use lightvein_viewer::panels::{map, outdoors};
use lightvein_viewer::state::{Action, Kept, State};
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// The courtyard under a clear sky, on one day, with everything that there is to know of it.
fn state() -> State {
    static FOUND: OnceLock<(Arc<Scene>, OutdoorResults)> = OnceLock::new();
    let (scene, results) = FOUND.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/outdoor/courtyard/courtyard.toml");
        let mut scene = Scene::load(&path, &Quiet, &Cancel::new()).expect("the scene");
        let site = scene.site.as_mut().expect("its site");
        (site.start, site.end) = (Some((6, 21)), Some((6, 21)));
        let scene = Arc::new(scene);
        let asked = OutdoorRequest { patch_m: Some(4.0), ..OutdoorRequest::default() };
        let results = answered(&scene, &asked, &OutdoorResults::default());
        (scene, results)
    });
    let mut state = State::new(Kept::default(), Layers::default());
    state.results.loaded = Some(Arc::clone(scene));
    state.results.scene = Some(Arc::clone(scene));
    state.results.outdoors = results.clone();
    state.camera = Camera::fitted(scene.mesh.bounds_m().expect("faces"), 4.0 / 3.0);
    state
}

fn answered(scene: &Arc<Scene>, asked: &OutdoorRequest, before: &OutdoorResults) -> OutdoorResults {
    let question = Question { asked, scene, edits: &[], seed: 0 };
    compute(&question, before, &Quiet, &Cancel::new(), &mut |_| ()).expect("an answer")
}

fn panel(state: State) -> Harness<'static, State> {
    let show = |ui: &mut egui::Ui, state: &mut State| {
        shown::tick(state, ui.ctx());
        outdoors::show(ui, state);
    };
    let mut harness = Harness::builder().with_size([400.0, 1600.0]).with_max_steps(20).build_ui_state(show, state);
    harness.run();
    harness
}

#[test]
fn a_scene_with_a_site_is_asked_about_it_once() {
    let mut harness = panel(state());
    assert_eq!(harness.state().request.outdoors, Some(OutdoorRequest::default()));
    assert_eq!(harness.state().history.can(), [false, false], "opening is no step to undo");
    // Sunrise and the totals are there; left out, they are not asked for again.
    harness.get_by_label_contains("Sunrise");
    harness.get_by_label("Global horizontal");
    harness.get_by_label("Leave sun and sky out").click();
    harness.run();
    assert_eq!(harness.state().request.outdoors, None);
    harness.get_by_label("Ask sun and sky");
}

#[test]
fn a_scene_without_a_site_can_be_given_a_place() {
    let mut state = state();
    let scene = Scene { site: None, ..(**state.results.loaded.as_ref().unwrap()).clone() };
    state.results.loaded = Some(Arc::new(scene));
    state.results.outdoors = OutdoorResults::default();
    let mut harness = panel(state);
    assert_eq!(harness.state().request.outdoors, None);
    harness.get_by_label("Give it a place").click();
    harness.run();
    let state = harness.state();
    let site = state.request.outdoors.as_ref().unwrap().site.as_ref().unwrap();
    assert!(site.latitude_deg.is_some() && site.longitude_deg.is_some());
    assert_eq!((state.history.can(), state.layers.mesh_colour), ([true, false], MeshColour::Exposure));
    assert!(state.layers.sun_path);
}

#[test]
fn a_typed_latitude_is_asked_for_and_one_step_to_undo() {
    let mut harness = panel(state());
    harness.get_by_role_and_label(Role::SpinButton, "Latitude").click();
    harness.run();
    harness.get_by_role_and_label(Role::TextInput, "Latitude").type_text("-33.5");
    harness.run();
    harness.key_press(egui::Key::Enter);
    harness.run();
    let state = harness.state_mut();
    let asked = state.request.outdoors.clone().unwrap();
    let site = asked.site.unwrap();
    assert_eq!((site.latitude_deg, site.longitude_deg), (Some(-33.5), Some(-87.92)));
    let before = state.history.undo(&state.request).unwrap();
    assert_eq!(before.outdoors, Some(OutdoorRequest::default()));

    harness.get_by_label("Reset site").click();
    harness.run();
    assert_eq!(harness.state().request.outdoors.as_ref().unwrap().site, None);
}

#[test]
fn the_shown_day_becomes_the_period_and_the_whole_year_again() {
    let mut harness = panel(state());
    let period = |harness: &Harness<'static, State>| {
        let asked = harness.state().request.outdoors.as_ref().unwrap();
        let site = asked.site.as_ref().unwrap();
        (site.start, site.end)
    };
    harness.state_mut().outdoors.date = jiff::civil::date(2025, 3, 20);
    harness.run();
    harness.get_by_label("The shown day").click();
    harness.run();
    assert_eq!(period(&harness), (Some((3, 20)), Some((3, 20))));
    harness.get_by_label("All year").click();
    harness.run();
    assert_eq!(period(&harness), (None, None));
}

#[test]
fn playing_moves_the_clock_and_stopped_it_costs_nothing() {
    let mut harness = panel(state());
    let before_h = harness.state().outdoors.time_h;
    let noon = harness.state().outdoors.now.clone().unwrap();
    let asked = harness.state().request.clone();
    harness.get_by_label("Play").click();
    harness.run_steps(6);
    let state = harness.state();
    assert!(state.outdoors.is_playing && state.layers.sun_path);
    assert!(state.outdoors.time_h > before_h && state.outdoors.time_h < before_h + 2.0, "{}", state.outdoors.time_h);
    let later = state.outdoors.now.clone().unwrap();
    assert!(later.sun.azimuth_rad > noon.sun.azimuth_rad, "the sun goes on to the west");
    assert_eq!(state.request, asked, "nothing is computed for it");
    harness.get_by_label("Stop").click();
    // It comes to rest, or `run` would give up.
    harness.run();
    let at_rest_h = harness.state().outdoors.time_h;
    harness.run();
    assert_eq!(harness.state().outdoors.time_h, at_rest_h);
}

#[test]
fn a_quantity_is_chosen_and_shown_on_faces_or_by_pixel() {
    let mut harness = panel(state());
    harness.get_by_role_and_label(Role::ComboBox, "Quantity").click();
    harness.run();
    harness.get_by_label("Hours of sun").click();
    harness.run();
    assert_eq!(harness.state().layers.quantity, Quantity::SunHours);
    harness.get_by_label("On faces").click();
    harness.run();
    assert!(harness.state().layers.measures().contains(&Measure::SunHours));
    let faces = shown::batches(harness.state_mut());
    assert_eq!(faces.len(), 1);
    assert_eq!(faces, shown::batches(harness.state_mut()), "nothing is made twice");

    harness.get_by_label("Pixel by pixel").click();
    harness.run();
    let state = harness.state_mut();
    assert!(state.layers.per_pixel && shown::batches(state).is_empty());
    let size_px = Vec2::new(40.0, 30.0);
    shown::follow_view(state, size_px);
    let asked = state.request.outdoors.clone().unwrap();
    assert_eq!(asked.view.unwrap().size, [40, 30]);
    let ctx = egui::Context::default();
    assert!(shown::overlay(state, &ctx, size_px).is_none(), "not computed yet");
    let scene = state.results.loaded.clone().unwrap();
    state.results.outdoors = answered(&scene, &OutdoorRequest { on_faces: false, ..asked }, &state.results.outdoors);
    assert_eq!(shown::overlay(state, &ctx, size_px).unwrap().size(), [40, 30]);
    // Seen from elsewhere it does not fit any more.
    state.camera.azimuth_rad += 0.1;
    assert!(shown::overlay(state, &ctx, size_px).is_none());
    state.camera.orthographic = true;
    shown::follow_view(state, size_px);
    assert_eq!(state.request.outdoors.as_ref().unwrap().view, None);
}

#[test]
fn a_weather_file_is_asked_for_and_taken() {
    let mut harness = panel(state());
    harness.get_by_label("Choose").click();
    harness.run();
    assert_eq!(harness.state().actions, [Action::ChooseWeather]);
    outdoors::with_weather(harness.state_mut(), "some/weather.epw".into());
    harness.run();
    harness.get_by_label("weather.epw");
    harness.get_by_label("None").click();
    harness.run();
    assert_eq!(harness.state().request.outdoors.as_ref().unwrap().site.as_ref().unwrap().weather, None);
}

#[test]
fn the_dome_has_its_sun_and_its_names_and_is_kept_while_time_stands() {
    let mut harness = panel(state());
    assert!(shown::labels(harness.state_mut()).is_empty());
    harness.get_by_label("Dome").click();
    harness.run();
    let state = harness.state_mut();
    let names: Vec<String> = shown::labels(state).into_iter().map(|(_, name)| name).collect();
    assert_eq!(names[..4], ["N", "E", "S", "W"]);
    assert!(names.contains(&"12".to_owned()) && names.last() == Some(&"12:00".to_owned()), "{names:?}");
    let (low_m, high_m) = shown::dome_bounds_m(state).unwrap();
    for (at_m, name) in shown::labels(state) {
        let room_m = 0.1 * (high_m - low_m);
        assert!(at_m.cmpge(low_m - room_m).all() && at_m.cmple(high_m + room_m).all(), "{name} at {at_m}");
    }
    let drawn = shown::batches(state);
    assert_eq!(drawn.len(), 3);
    assert_eq!(drawn, shown::batches(state));
    state.outdoors.time_h = 15.0;
    harness.run();
    assert_ne!(drawn, shown::batches(harness.state_mut()));
}

#[test]
fn the_map_is_shown_with_what_is_under_the_pointer() {
    let show = |ui: &mut egui::Ui, state: &mut State| {
        shown::tick(state, ui.ctx());
        map::show(ui, state);
    };
    let mut harness = Harness::builder().with_size([640.0, 420.0]).with_max_steps(20).build_ui_state(show, state());
    harness.run();
    harness.hover_at(egui::pos2(400.0, 200.0));
    harness.run();
    let state = harness.state();
    assert!(state.scales.contains_key(&Measure::MapRadiance));
    let sky = state.results.outdoors.sky.as_ref().unwrap();
    // Where a sun of the period stands the map is far brighter than beside it.
    let sun = sky.map.suns[sky.map.suns.len() / 2].sun;
    let [at_sun, beside] = [0.0, 0.1].map(|aside_rad| sky.radiance_at(sun.azimuth_rad + aside_rad, sun.elevation_rad));
    assert!(at_sun > 10.0 * beside, "{at_sun} {beside}");
    assert_eq!(sky.radiances().len(), 512 * 512);
}

#[test]
fn exposure_is_drawn_where_it_belongs() {
    let mut offscreen = match lightvein_viewer::paint::Offscreen::new() {
        Ok(offscreen) => offscreen,
        Err(error) if std::env::var_os("LIGHTVEIN_NEED_GPU").is_none() => {
            println!("skipped: {error}");
            return;
        }
        Err(error) => panic!("{error}"),
    };
    let mut state = state();
    shown::tick(&mut state, &egui::Context::default());
    state.layers.mesh_colour = MeshColour::Exposure;
    let mut drawn = |state: &mut State| {
        let batches = shown::batches(state);
        let picture = lightvein_viewer::paint::Picture {
            camera: state.camera,
            background: [[0; 3]; 2],
            cuts: Vec::new(),
            batches,
        };
        offscreen.render_picture(&picture, [320, 240]).expect("a picture")
    };
    state.layers.cull_near_walls = false;
    let picture = drawn(&mut state);
    // The open ground away from the block is what the open gets, the top of its scale: yellow in viridis.
    let (_, high_m) = state.results.scene.as_ref().unwrap().mesh.bounds_m().unwrap();
    let ground_m = Vec3::new(0.45 * high_m.x, -0.9 * high_m.y, 0.0);
    let (at, _) = state.camera.project(ground_m, Vec2::new(320.0, 240.0)).unwrap();
    let [r, g, b, _] = picture.get_pixel(at.x as u32, at.y as u32).0;
    assert!(r > 150 && g > 180 && b < 120, "{r} {g} {b} at {at}");
    // The dome's far half stands behind it, its near half does not hide it.
    state.layers.sun_path = true;
    let with_dome = drawn(&mut state);
    assert_eq!(with_dome.get_pixel(at.x as u32, at.y as u32).0, [r, g, b, 255]);
    let sky = with_dome.pixels().zip(picture.pixels()).filter(|(with, without)| with != without).count();
    assert!(sky > 2000, "{sky} pixels of sky");
}
