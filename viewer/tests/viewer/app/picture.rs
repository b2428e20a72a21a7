//! The window saved as a picture, by the renderer that eframe's own tests have.

use super::{App, Harness, errors, is_painted, scene, settle, wait};
use crate::shot::can_draw;
use clap::Parser;
use lightvein_viewer::app::Dialog;
use lightvein_viewer::args::Args;

#[test]
fn the_window_is_saved_as_it_is_seen() {
    if !can_draw() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let two_rooms = scene("two_rooms").display().to_string();
    let typed = ["lightvein-viewer", &two_rooms, "--voxel", "0.2", "--pick", "sensor:door", "--theme", "light"];
    let args = Args::try_parse_from(typed).expect("arguments");
    let builder = Harness::<App>::builder().with_size([900.0, 600.0]).with_max_steps(60).wgpu();
    let mut window = builder.build_eframe(|cc| App::of_window(cc, args));
    settle(&mut window);
    settle(&mut window);
    assert_eq!(errors(&window), "");

    // What was typed holds as soon as the scene is there.
    assert!(window.state().state.picked.is_some() && window.state().state.kept.dark == Some(false));
    assert_eq!(window.state().state.request.how.voxel_m, Some(0.2));

    let (to, ctx) = (folder.path().join("window.png"), window.ctx.clone());
    window.state_mut().chosen(Dialog::Picture, to.clone(), &ctx);
    wait(&mut window, "written", |app| app.state.log.text().contains("window.png"));
    assert!(is_painted(&window, "Inspector"));
    let saved = image::open(&to).expect("a picture").to_rgba8();
    assert_eq!(saved.dimensions(), (900, 600));

    // The pane with the scene is not of one colour: there are walls, veins and sky in it.
    let rect = super::view_rect(&window);
    let (low, high) = (rect.min + egui::vec2(5.0, 5.0), rect.max - egui::vec2(5.0, 5.0));
    let mut colours = std::collections::BTreeSet::new();
    for y in low.y as u32..high.y as u32 {
        colours.extend((low.x as u32..high.x as u32).map(|x| saved.get_pixel(x, y).0));
    }
    assert!(colours.len() > 1000, "{} colours", colours.len());
}
