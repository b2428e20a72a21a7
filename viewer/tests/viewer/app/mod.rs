//! The whole program, by mouse and keys as its user has them; only its window is missing.

mod open;
mod parts;
mod picture;
mod run;
mod sunlight;
mod touch;

use egui::accesskit::Role;
use egui::{Event, Pos2, Rect, Shape};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::{Vec2, Vec3};
use lightvein_viewer::app::{App, Start};
use lightvein_viewer::layers::Layers;
use lightvein_viewer::state::Kept;
use lightvein_viewer::view;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The program and the hand on it.
pub type Window = Harness<'static, App>;

/// Longest that anything may take.
const PATIENCE: Duration = Duration::from_secs(120);

/// Voxels that are coarse, so that tests are fast.
const VOXEL_M: f32 = 0.2;

/// A scene of the repository: `outdoor/courtyard` is in `scenes/outdoor/courtyard/courtyard.toml`.
pub fn scene(of: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(of);
    let name = folder.file_name().unwrap_or_default().to_os_string();
    folder.join(name).with_extension("toml")
}

/// The program as it starts, before anything is computed.
fn started(scene: Option<PathBuf>) -> Window {
    // What a test kept of the last one would be no test.
    let start = Start { scene, kept: Kept::default(), layers: Layers::default(), tree: None };
    let build = move |cc: &mut eframe::CreationContext<'_>| {
        let mut app = App::new(&cc.egui_ctx, start);
        app.state.request.how.voxel_m = Some(VOXEL_M);
        app
    };
    Harness::builder().with_size([1280.0, 800.0]).with_max_steps(30).build_eframe(build)
}

/// The program with a scene that is computed and drawn.
fn opened(name: &str) -> Window {
    let mut window = started(Some(scene(name)));
    settle(&mut window);
    assert_eq!(errors(&window), "");
    window
}

/// Runs frame by frame until something holds.
#[track_caller]
fn wait(window: &mut Window, what: &str, holds: impl Fn(&App) -> bool) {
    let begun = Instant::now();
    while !holds(window.state()) {
        let told = window.state().state.log.text();
        assert!(begun.elapsed() < PATIENCE, "not {what} within {PATIENCE:?}; the log:\n{told}");
        window.step();
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Runs until all that was asked is answered and drawn, and has come to rest on the screen.
#[track_caller]
fn settle(window: &mut Window) {
    // What the last event asked for is known after the next frame.
    window.step();
    wait(window, "settled", App::is_settled);
    window.run_steps(4);
}

/// All errors that were told.
fn errors(window: &Window) -> String {
    let entries = &window.state().state.log.entries;
    let errors = entries.iter().filter(|entry| entry.level == lightvein_viewer::log::Level::Error);
    errors.map(|entry| entry.line() + "\n").collect()
}

/// Where the view is on the screen.
fn view_rect(window: &Window) -> Rect {
    window.get_by_label(view::NAME).rect()
}

/// Where a place in the scene is on the screen.
#[track_caller]
fn place(window: &Window, at_m: Vec3) -> Pos2 {
    let rect = view_rect(window);
    let size = Vec2::new(rect.width(), rect.height());
    let (at, _) = window.state().state.camera.project(at_m, size).expect("a place before the camera");
    let at = rect.min + egui::vec2(at.x, at.y);
    assert!(rect.shrink(5.0).contains(at), "{at_m} is seen at {at}, outside the view {rect}");
    at
}

/// Clicks with the left button; so long after the last click that both are no double click.
fn click(window: &mut Window, at: Pos2) {
    window.hover_at(at);
    window.run_steps(4);
    window.drag_at(at);
    window.drop_at(at);
    window.run();
}

/// Drags with the left button, so many steps on the way.
fn drag(window: &mut Window, from: Pos2, by: egui::Vec2, steps: usize) {
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    for step in 1..=steps {
        window.event(Event::PointerMoved(from + by * (step as f32 / steps as f32)));
    }
    window.drop_at(from + by);
    window.step();
}

/// Brings a pane to the front by its tab.
fn bring(window: &mut Window, pane: &str) {
    window.get_by_role_and_label(Role::Button, pane).click();
    window.run();
}

/// Whether a text is painted, be it a widget's or not.
fn is_painted(window: &Window, text: &str) -> bool {
    fn holds(shape: &Shape, text: &str) -> bool {
        match shape {
            Shape::Text(shape) => shape.galley.text().contains(text),
            Shape::Vec(shapes) => shapes.iter().any(|shape| holds(shape, text)),
            _ => false,
        }
    }
    window.output().shapes.iter().any(|clipped| holds(&clipped.shape, text))
}
