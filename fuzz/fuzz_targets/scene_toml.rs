//! Any bytes as a scene file.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::file::read_scene_file;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_scene_file(&Input::alone(bytes, Path::new("fuzz.toml"), &Quiet, &Cancel::new()));
});
