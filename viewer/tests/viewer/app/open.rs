//! Scenes come in by every door, and what cannot be read leaves the one before as it was.

use super::{App, Window, bring, errors, is_painted, opened, scene, settle, started, wait};
use egui_kittest::kittest::Queryable;
use lightvein_viewer::app::Dialog;
use lightvein_viewer::log::Log;
use lightvein_viewer::request::Source;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file in the hand of who drags it over the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn name(app: &App) -> &str {
    app.state.results.scene.as_ref().map_or("", |scene| &scene.name)
}

fn shows(window: &mut Window, scene: &str) {
    settle(window);
    assert_eq!(errors(window), "");
    assert_eq!(name(window.state()), scene);
    assert!(!window.state().state.is_stale() && !is_painted(window, "Stale"));
    // The line at the foot says what is open.
    window.get_by_label_contains(&format!("{scene}: "));
    let results = &window.state().state.results;
    assert!(results.model.is_some() && results.estimate.as_ref().is_some_and(|estimate| !estimate.is_first_pass));
}

#[test]
fn a_scene_greets_and_others_are_dropped_chosen_and_remembered() {
    let mut window = started(None);
    shows(&mut window, "welcome");

    window.input_mut().dropped_files.push(Arc::new(Dropped(scene("two_rooms"))));
    window.step();
    shows(&mut window, "two_rooms");

    let ctx = window.ctx.clone();
    window.state_mut().chosen(Dialog::Open, scene("corridor"), &ctx);
    shows(&mut window, "corridor");

    // The menu has both, the latest first.
    let recent = window.state().state.kept.recent.clone();
    assert_eq!(recent, [scene("corridor"), scene("two_rooms")]);
    window.get_by_label("File").click();
    window.run();
    window.get_by_label("Open recent").click();
    window.run();
    window.get_by_label(&recent[1].display().to_string()).click();
    shows(&mut window, "two_rooms");
    assert_eq!(window.state().state.kept.recent, [scene("two_rooms"), scene("corridor")]);
}

#[test]
fn a_mesh_without_a_scene_file_is_a_scene() {
    let mut window = started(Some(scene("two_rooms").with_extension("obj")));
    shows(&mut window, "two_rooms");
}

#[test]
fn what_cannot_be_read_is_told_and_the_last_good_scene_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let written = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("a file");
        path
    };
    let cases = [
        (folder.path().join("nowhere.toml"), "nowhere.toml"),
        (written("broken.toml", "name = \"broken\"\n[geometry\n"), "broken.toml:2"),
        (
            written("bright.toml", "[geometry]\nmeshes = [\"a.obj\"]\nreflectance = 1.4\n"),
            "bright.toml:3: reflectance 1.4",
        ),
        (written("torn.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n"), "torn.obj:3"),
        (written("picture.xyz", "1 2 3\n"), "picture.xyz"),
    ];
    let mut window = opened("two_rooms");
    let before = window.state().state.results.model.clone().expect("a model");
    for (path, told) in cases {
        window.state_mut().open(Source::File(path));
        settle(&mut window);
        let errors = errors(&window);
        assert!(errors.contains(told), "{told:?} is not in {errors:?}");
        assert_eq!(errors.lines().count(), 1, "{errors}");
        assert!(is_painted(&window, told), "{told:?} is no toast");

        // Shown is what was shown, and that it is not what was asked.
        assert_eq!(name(window.state()), "two_rooms");
        assert!(Arc::ptr_eq(&before, window.state().state.results.model.as_ref().expect("a model")));
        assert!(is_painted(&window, "Stale"));

        // The log has it too, to be copied.
        bring(&mut window, "Log");
        assert!(
            window.query_all_by_label_contains(told).any(|node| node.rect().top() > 500.0),
            "{told:?} is not in the log"
        );
        window.get_by_label("Copy all").click();
        window.step();
        let copied = window.output().platform_output.commands.iter().any(|command| match command {
            egui::OutputCommand::CopyText(text) => text.contains(told),
            _ => false,
        });
        assert!(copied, "{told}");
        window.run();
        window.get_by_label("Clear").click();
        window.run();
    }

    // And it can be gone on with.
    window.state_mut().open(Source::File(scene("two_rooms")));
    shows(&mut window, "two_rooms");
}

#[test]
fn who_starts_with_a_scene_that_is_not_there_is_told_what_to_do() {
    let mut window = started(Some(scene("nowhere")));
    settle(&mut window);
    assert!(errors(&window).contains("nowhere.toml"), "{}", errors(&window));
    assert!(is_painted(&window, "no scene is open: File, Open, or drop a file here"));
    // There is nothing that could be of another request, or cut.
    assert!(!is_painted(&window, "Stale") && window.query_by_label("Cut: show the whole mesh").is_none());

    window.state_mut().state.log = Log::default();
    window.state_mut().open(Source::File(scene("two_rooms")));
    shows(&mut window, "two_rooms");
    assert!(!is_painted(&window, "no scene is open"));
}

#[test]
fn another_scene_while_one_is_computed_is_the_one_that_is_shown() {
    let mut window = started(Some(scene("gallery")));
    window.state_mut().state.request.how.voxel_m = Some(0.03);
    wait(&mut window, "computing", |app| app.state.is_busy());
    window.state_mut().open(Source::File(scene("two_rooms")));
    shows(&mut window, "two_rooms");
}
