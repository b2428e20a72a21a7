//! Runs: the latest wish counts, Esc stops, files come out whole, and rest costs nothing.

use super::{App, Window, bring, drag, errors, is_painted, opened, settle, wait};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, ViewportId};
use egui_kittest::kittest::Queryable;
use lightvein_viewer::app::Dialog;
use lightvein_viewer::log::Level;
use lightvein_viewer::panels::scene::asked_lights;
use lightvein_viewer::request::Request;
use lightvein_viewer::state::Running;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

#[test]
fn of_a_slider_that_is_dragged_only_the_latest_value_is_computed_to_the_end() {
    let mut window = opened("gallery");
    bring(&mut window, "Scene");
    let at = window.get_by_role_and_label(Role::SpinButton, "Flux of light 0").rect().center();
    let flux_w = |app: &App| asked_lights(&app.state).first().map(lightvein::scene::Light::flux_w);
    let before_w = flux_w(window.state()).expect("a light");

    // Sixty values, frame after frame, and then the hand lets go.
    drag(&mut window, at, egui::vec2(60.0, 0.0), 60);
    let last_w = flux_w(window.state()).expect("a light");
    assert!(last_w > 1.1 * before_w, "{last_w}");

    // After what had been answered by then come the one under way and the last.
    let mut answered: Vec<Request> = Vec::new();
    while !window.state().is_settled() {
        window.step();
        answered.extend(window.state().state.answered.clone());
        answered.dedup();
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(answered.last(), Some(&window.state().state.request));
    assert!(answered.len() <= 3, "{} answers after the hand let go", answered.len());
    let scene = window.state().state.results.scene.clone().expect("a scene");
    assert_eq!(scene.lights.first().map(lightvein::scene::Light::flux_w), Some(last_w));
    assert_eq!(window.state().state.history.can(), [true, false]);
}

#[test]
fn esc_stops_a_long_run_and_the_old_result_stays() {
    let mut window = opened("gallery");
    let voxel_m = |app: &App| app.state.results.model.as_ref().map(|model| model.voxels.lattice.voxel_m);
    let before_m = voxel_m(window.state());
    bring(&mut window, "Scene");
    window.get_by_role_and_label(Role::SpinButton, "Voxel size").click();
    window.run();
    window.event(Event::Text("0.02".to_owned()));
    window.run();
    window.key_press(Key::Enter);
    wait(
        &mut window,
        "computing",
        |app| matches!(&app.state.running, Running::Stage { seconds, .. } if *seconds > 0.2),
    );
    assert_eq!(window.state().state.request.how.voxel_m, Some(0.02));
    window.get_by_label("Stop");

    window.key_press(Key::Escape);
    wait(&mut window, "stopped", |app| !app.state.is_busy());
    window.run();
    assert_eq!(voxel_m(window.state()), before_m);
    assert!(window.state().state.is_stale() && is_painted(&window, "Stale") && is_painted(&window, "stopped"));
    assert_eq!(errors(&window), "");

    // One step back, and what is shown is what is asked.
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut window);
    assert!(!window.state().state.is_stale() && !is_painted(&window, "Stale"));
    assert_eq!(voxel_m(window.state()), before_m);
}

#[test]
fn an_analysis_and_a_table_are_written_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let (to, ctx) = (folder.path().join("analysis"), egui::Context::default());
    let mut window = opened("two_rooms");
    window.state_mut().chosen(Dialog::Export, to.clone(), &ctx);
    wait(&mut window, "written", |app| app.state.log.text().contains("files written into"));
    assert_eq!(errors(&window), "");
    let files = files(&to);
    let want = [
        "field.csv",
        "field.ply",
        "plan.svg",
        "skeleton.graphml",
        "skeleton.json",
        "skeleton.ply",
        "skeleton.swc",
        "voxels.json",
        "voxels.npy",
    ];
    assert_eq!(files.keys().collect::<Vec<_>>(), want);
    assert!(files["field.csv"].starts_with(b"id,") && files["plan.svg"].trim_ascii_end().ends_with(b"</svg>"));
    let state = &window.state().state;
    let sensors = state.results.scene.as_ref().expect("a scene").sensors.len();
    let lines = |bytes: &[u8]| bytes.split(|byte| *byte == b'\n').filter(|line| !line.is_empty()).count();
    assert_eq!(lines(&files["field.csv"]), 1 + sensors);
    assert!(window.state().is_settled() && !window.state().state.is_stale());

    let table = folder.path().join("table.csv");
    window.state_mut().chosen(Dialog::Table, table.clone(), &ctx);
    window.run_steps(4);
    assert!(is_painted(&window, "table.csv"));
    assert_eq!(lines(&std::fs::read(&table).expect("a table")), 1 + sensors);

    // A place that cannot be written to is told by its name.
    let nowhere = folder.path().join("none").join("table.csv");
    window.state_mut().chosen(Dialog::Table, nowhere.clone(), &ctx);
    window.run();
    assert!(errors(&window).contains(&nowhere.display().to_string()), "{}", errors(&window));
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
    let read = |entry: std::fs::DirEntry| {
        let bytes = std::fs::read(entry.path()).expect("a file");
        (entry.file_name().to_string_lossy().into_owned(), bytes)
    };
    entries.map(read).collect()
}

#[test]
fn at_rest_no_frame_is_asked_for() {
    let mut window = opened("two_rooms");
    let wish = |window: &Window| window.output().viewport_output[&ViewportId::ROOT].repaint_delay;
    for _ in 0..3 {
        window.step();
        assert!(wish(&window) > Duration::from_secs(60), "{:?}: {:?}", wish(&window), window.ctx.repaint_causes());
    }
    // A toast asks for the frame in which it goes.
    window.state_mut().state.log.tell(Level::Note, "", "a word in passing");
    window.run();
    assert!(is_painted(&window, "a word in passing") && wish(&window) > Duration::from_secs(2));
    window.run_steps(20);
    assert!(!is_painted(&window, "a word in passing") && wish(&window) > Duration::from_secs(60));

    // The pointer over the view asks for the frame that shows it, and for no more.
    let at = super::view_rect(&window).center();
    window.event(Event::PointerMoved(at));
    window.run();
    window.run_steps(20);
    assert!(wish(&window) > Duration::from_secs(60), "{:?}: {:?}", wish(&window), window.ctx.repaint_causes());
}
