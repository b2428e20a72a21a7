//! The program as it is run: pictures by `--screenshot`, what it says of what cannot be done, and how it ends.

use crate::app::scene;
use lightvein_viewer::paint::Offscreen;
use std::path::Path;
use std::process::{Command, Output};

/// The built program.
fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_lightvein-viewer"))
}

/// Whether pictures can be taken here; says why not, or panics where they must.
pub fn can_draw() -> bool {
    match Offscreen::new() {
        Ok(_) => true,
        Err(error) if std::env::var_os("LIGHTVEIN_NEED_GPU").is_some() => panic!("{error}"),
        Err(error) => {
            println!("skipped: {error}");
            false
        }
    }
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_picture_of_the_asked_size_is_written() {
    if !can_draw() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("two rooms.png");
    let mut program = program();
    program.arg(scene("two_rooms")).arg("--screenshot").arg(&to).args(["--size", "640x400", "--voxel", "0.2"]);
    program.args(["--layer", "-mesh,voxels=distance", "--camera", "top", "--pick", "node:0", "--method", "diffusion"]);
    let output = program.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().expect("the program");
    assert!(output.status.success(), "{}", words(&output));
    assert!(words(&output).contains("two rooms.png"), "{}", words(&output));
    let image = image::open(&to).expect("a picture").to_rgba8();
    assert_eq!(image.dimensions(), (640, 400));
    // Not one colour all over.
    let first = image.get_pixel(0, 0);
    assert!(image.pixels().filter(|pixel| *pixel != first).count() > 10_000);
}

#[test]
fn what_is_wrong_is_told_in_a_line_and_no_file_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("none.png");
    let two_rooms = scene("two_rooms");
    let cases: [(&Path, &[&str], &str); 11] = [
        (&two_rooms, &["--layer", "nods"], "\"nods\" is no layer"),
        (&two_rooms, &["--camera", "above"], "\"above\" is no camera"),
        (&two_rooms, &["--size", "10x10"], "\"10x10\" is not a size"),
        (&two_rooms, &["--voxel", "-1"], "\"-1\" is not a positive length"),
        (&two_rooms, &["--method", "guess"], "\"guess\" is no method"),
        (Path::new("nowhere.toml"), &[], "nowhere.toml"),
        (&two_rooms, &["--voxel", "0.2", "--pick", "sensor:nobody"], "no sensor has that id"),
        (&two_rooms, &["--voxel", "0.2", "--pick", "node:999999"], "nodes, numbered from 0"),
        (&two_rooms, &["--voxel", "0.2", "--pick", "wall:1,2"], "a point is meant"),
        (&two_rooms, &["--voxel", "0.2", "--pick", "wall:1,1,1"], "the scene has no sun"),
        (&two_rooms, &["--voxel", "0.2", "--pick", "door"], "sensor:ID, node:N, light:N or wall:X,Y,Z is meant"),
    ];
    for (place, (scene, args, told)) in cases.into_iter().enumerate() {
        // What is typed is looked at before there is anything to draw with.
        if place == 5 && !can_draw() {
            return;
        }
        let output = program().arg(scene).arg("--screenshot").arg(&to).args(args).output().expect("the program");
        let (code, words) = (output.status.code(), words(&output));
        assert!(matches!(code, Some(1 | 2)), "{args:?}: {code:?}: {words}");
        // The driver may have something to say as well.
        let lines = words.lines().filter(|line| line.starts_with("error: ") && line.contains(told));
        assert_eq!(lines.count(), 1, "{args:?}: {told:?} is not in {words:?}");
        assert!(!to.exists(), "{args:?}");
        assert!(!words.contains("panicked"), "{words}");
    }
}

#[test]
fn a_picture_that_cannot_be_written_is_an_error() {
    if !can_draw() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("none").join("picture.png");
    let mut program = program();
    program.arg(scene("two_rooms")).arg("--screenshot").arg(&to).args(["--size", "64x64", "--voxel", "0.2"]);
    let output = program.output().expect("the program");
    assert_eq!(output.status.code(), Some(1));
    assert!(words(&output).contains("picture.png: cannot be written"), "{}", words(&output));
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_display_the_window_names_the_ways_without_one() {
    let mut program = program();
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        program.env_remove(name);
    }
    let output = program.output().expect("the program");
    let words = words(&output);
    assert_eq!(output.status.code(), Some(1), "{words}");
    assert!(words.contains("--screenshot FILE") && words.contains("lightvein analyse"), "{words}");
    assert!(!words.contains("panicked"), "{words}");
}
