//! Pictures of the program, compared with those that were looked at when they were made. `UPDATE_SNAPSHOTS=1` makes them anew.

use crate::app::scene;
use clap::Parser;
use egui_kittest::{SnapshotOptions, image_snapshot_options};
use image::{Rgba, RgbaImage};
use lightvein_viewer::args::Args;
use lightvein_viewer::paint::Offscreen;
use lightvein_viewer::shot::picture;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, OnceLock};

/// Four levels of grey, as the comparison counts: 0.5053 times the square of the difference in luma.
const FOUR_LEVELS: f32 = 0.5053 * 4.0 * 4.0;

/// Pixels at edges that another release of the driver may cover otherwise: 1 in 20,000.
const MOST_OFF: usize = 20;

/// Height of the line at the foot, which has the milliseconds that a method took, pixels.
const FOOT_PX: u32 = 30;

/// One picture at a time: a software adapter takes all cores for each. None (and why) where there is no adapter.
fn one_at_a_time() -> Option<MutexGuard<'static, ()>> {
    static DRAWN: Mutex<()> = Mutex::new(());
    static CAN: OnceLock<Option<String>> = OnceLock::new();
    match CAN.get_or_init(|| Offscreen::new().err().map(|error| error.to_string())) {
        None => Some(DRAWN.lock().unwrap_or_else(|poisoned| poisoned.into_inner())),
        Some(why) if std::env::var_os("LIGHTVEIN_NEED_GPU").is_some() => panic!("{why}"),
        Some(why) => {
            println!("skipped: {why}");
            None
        }
    }
}

/// Compares the picture of a scene, or of the one that greets: a window shows where its scene lies, which differs by machine.
fn compare(name: &str, of: Option<&str>, args: &[&str]) {
    let Some(_one) = one_at_a_time() else { return };
    let scene = of.map(|of| scene(of).display().to_string());
    let args = ["lightvein-viewer"].into_iter().chain(scene.as_deref()).chain(args.iter().copied());
    let args = Args::try_parse_from(args).expect("arguments");
    let mut offscreen = Offscreen::new().expect("an adapter");
    let mut image = picture(&args, &mut offscreen).expect("a picture");
    if !args.view_only {
        blank_foot(&mut image);
    }
    let snapshots = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots");
    let options = SnapshotOptions::new().threshold(FOUR_LEVELS).max_failed_pixels(MOST_OFF).output_path(snapshots);
    image_snapshot_options(&image, name, &options);
}

fn blank_foot(image: &mut RgbaImage) {
    let (width, height) = image.dimensions();
    for y in height.saturating_sub(FOOT_PX)..height {
        (0..width).for_each(|x| image.put_pixel(x, y, Rgba([0, 0, 0, 255])));
    }
}

#[test]
fn veins_of_light_through_two_rooms() {
    let args = ["--view-only", "--size", "800x500", "--theme", "dark", "--layer", "values,cells"];
    compare("two_rooms", Some("two_rooms"), &args);
}

#[test]
fn a_slice_of_distances() {
    let layers = "-mesh,-nodes,-edges,voxels=distance,slice=z";
    let args = ["--view-only", "--size", "800x500", "--theme", "dark", "--camera", "top", "--layer", layers];
    compare("distances", Some("two_rooms"), &args);
}

#[test]
fn a_picked_node_with_its_ball_and_its_way_to_the_light() {
    let args = ["--view-only", "--size", "800x500", "--theme", "light", "--pick", "node:40", "--layer", "nodes=radius"];
    compare("picked", Some("two_rooms"), &args);
}

#[test]
fn a_courtyard_under_sun_and_sky() {
    let args = ["--view-only", "--size", "800x500", "--theme", "dark", "--date", "2026-06-21", "--time", "15:00"];
    compare("courtyard", Some("outdoor/courtyard"), &args);
}

#[test]
fn the_whole_window_in_light() {
    compare("window", None, &["--size", "1280x800", "--theme", "light", "--pick", "light:0"]);
}
