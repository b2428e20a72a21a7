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
use lightvein_viewer::layers::{Layers, MeshColour, Shadow};
use lightvein_viewer::measure::Measure;
use lightvein_viewer::outdoors::compute::{Question, compute};
use lightvein_viewer::outdoors::{OutdoorRequest, OutdoorResults, draw, follow_view, seen_by, shown};
use lightvein_viewer::paint::{Batch, Culling, FaceStyle, Picture, Tint, What};
use lightvein_viewer::panels::{map, outdoors};
use lightvein_viewer::shadows::Method;
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
    harness.get_by_role_and_label(Role::SpinButton, "Latitude").type_text("-33.5");
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
    assert_eq!(harness.state().layers.mesh_colour, MeshColour::Exposure);

    harness.get_by_label("Pixel by pixel").click();
    harness.run();
    let state = harness.state_mut();
    assert!(state.layers.per_pixel && state.layers.mesh_colour == MeshColour::Material);
    let size_px = Vec2::new(40.0, 30.0);
    follow_view(state, size_px);
    let asked = state.request.outdoors.clone().unwrap();
    assert_eq!(asked.view, seen_by(&state.camera, size_px));
    assert_eq!(state.history.can(), [false, false], "looking is no step to undo");
    let scene = state.results.loaded.clone().unwrap();
    let found = answered(&scene, &OutdoorRequest { on_faces: false, ..asked }, &state.results.outdoors);
    let pixels = found.pixels.unwrap();
    let scale = state.scale(Measure::SunHours);
    let picture = draw::picture(&pixels, Quantity::SunHours, &scale);
    assert_eq!((picture.size, Some(pixels.view)), ([40, 30], seen_by(&state.camera, size_px)));
    assert_eq!(picture.pixels[0], egui::Color32::TRANSPARENT, "nothing but sky in the corner");
    let seen = picture.pixels.iter().filter(|pixel| **pixel != egui::Color32::TRANSPARENT).count();
    assert_eq!(seen, pixels.exposures.len());
    state.camera.orthographic = true;
    follow_view(state, size_px);
    assert_eq!(state.request.outdoors.as_ref().unwrap().view, None);
}

#[test]
fn a_shadow_method_is_chosen_with_its_size_and_its_layers() {
    let mut harness = panel(state());
    assert!(harness.query_by_label("Shadow method").is_none());
    harness.get_by_role_and_label(Role::CheckBox, "Sunlight and shadows").click();
    harness.run();
    assert!(harness.state().layers.shadows && harness.state().layers.shadow == Shadow::by(Method::Hsm));
    harness.get_by_role_and_label(Role::Slider, "Shadow layers");
    harness.get_by_role_and_label(Role::ComboBox, "Shadow method").click();
    harness.run();
    harness.get_by_label("Variance shadow map").click();
    harness.run();
    assert!(harness.query_by_label("Shadow layers").is_none(), "it has one");
    harness.get_by_role_and_label(Role::ComboBox, "Map size").click();
    harness.run();
    harness.get_by_label("512").click();
    harness.run();
    let wanted = Shadow { resolution: 512, ..Shadow::by(Method::Vsm) };
    assert_eq!((harness.state().layers.shadow, wanted.settings()), (wanted, Method::Vsm.settings(512, 1)));
    assert_eq!(harness.state().history.can(), [false, false], "a look is no step to undo");
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

/// The dome about the state's scene at its moment.
fn dome(state: &State) -> (draw::Dome, draw::Drawn) {
    let sky = state.results.outdoors.sky.as_ref().unwrap();
    let bounds = state.results.scene.as_ref().unwrap().mesh.bounds_m().unwrap();
    let dome = draw::Dome::about(bounds, sky.outdoors.north_rad);
    let (day, now) = (state.outdoors.day.as_ref().unwrap(), state.outdoors.now.as_ref().unwrap());
    (dome, draw::dome(&dome, day, now, &sky.sun_path))
}

#[test]
fn the_dome_has_its_sun_and_its_names() {
    let mut harness = panel(state());
    harness.get_by_label("Dome").click();
    harness.run();
    assert!(harness.state().layers.sun_path);
    let (about, drawn) = dome(harness.state());
    let names: Vec<&str> = drawn.labels.iter().map(|(_, name)| name.as_str()).collect();
    assert_eq!(names[..4], ["N", "E", "S", "W"]);
    assert!(names.contains(&"12") && names.last() == Some(&"12:00"), "{names:?}");
    for (at_m, name) in &drawn.labels {
        let away = at_m.distance(about.middle_m) / about.radius_m;
        assert!((1.0..1.15).contains(&away), "{name} at {at_m}");
    }
    // By noon the sun stands in the south; by north turned to the east it does so in the west.
    let What::Balls { data, .. } = &drawn.batches[2].what else { panic!("{:?}", drawn.batches[2].what) };
    let sun_m = data.last().unwrap().centre_m - about.middle_m;
    assert!(sun_m.y < 0.0 && sun_m.x.abs() < 0.1 * about.radius_m, "{sun_m}");
    let turned = draw::Dome { north_rad: std::f64::consts::FRAC_PI_2, ..about };
    assert!(turned.direction(glam::DVec3::NEG_Y).abs_diff_eq(Vec3::NEG_X, 1e-6));
}

#[test]
fn the_sun_is_found_again_when_the_shown_moment_changes_and_not_before() {
    let mut harness = panel(state());
    let shown = |harness: &Harness<'static, State>| {
        let outdoors = &harness.state().outdoors;
        (outdoors.day.clone().unwrap(), outdoors.now.clone().unwrap())
    };
    let (day, now) = shown(&harness);
    harness.run();
    assert!(Arc::ptr_eq(&now, &shown(&harness).1));
    harness.state_mut().outdoors.time_h = 15.0;
    harness.run();
    assert!(Arc::ptr_eq(&day, &shown(&harness).0) && shown(&harness).1.sun.azimuth_rad > now.sun.azimuth_rad);
    harness.state_mut().outdoors.date = jiff::civil::date(2025, 12, 21);
    harness.run();
    let (winter, _) = shown(&harness);
    assert!(winter.events.sunset().unwrap().time() < day.events.sunset().unwrap().time());
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
    let faces = state.results.outdoors.faces.clone().unwrap();
    let corners = Arc::new(draw::corners(&faces, Quantity::Total, None));
    let tint = Tint::Scaled(state.scale(Measure::Exposure));
    let what = What::Faces { data: corners, style: FaceStyle::Flat, culling: Culling::None };
    let exposed = Batch { tint, ..Batch::new(what) };
    let mut drawn = |batches: Vec<Batch>| {
        let picture =
            Picture { camera: state.camera, background: [[0; 3]; 2], sunlight: None, cuts: Vec::new(), batches };
        offscreen.render_picture(&picture, [320, 240]).expect("a picture")
    };
    let picture = drawn(vec![exposed.clone()]);
    // The open ground away from the block is what the open gets, the top of its scale: yellow in viridis.
    let (_, high_m) = state.results.scene.as_ref().unwrap().mesh.bounds_m().unwrap();
    let ground_m = Vec3::new(0.45 * high_m.x, -0.9 * high_m.y, 0.0);
    let (at, _) = state.camera.project(ground_m, Vec2::new(320.0, 240.0)).unwrap();
    let [r, g, b, _] = picture.get_pixel(at.x as u32, at.y as u32).0;
    assert!(r > 150 && g > 180 && b < 120, "{r} {g} {b} at {at}");
    // The dome's far half stands behind it, its near half does not hide it.
    let with_dome = drawn([vec![exposed], dome(&state).1.batches].concat());
    assert_eq!(with_dome.get_pixel(at.x as u32, at.y as u32).0, [r, g, b, 255]);
    let sky = with_dome.pixels().zip(picture.pixels()).filter(|(with, without)| with != without).count();
    assert!(sky > 2000, "{sky} pixels of sky");
}
