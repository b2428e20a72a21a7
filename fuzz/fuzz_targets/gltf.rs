//! Any bytes as a glTF file, text or binary.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::read::gltf::read_gltf;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_gltf(&Input::alone(bytes, Path::new("fuzz.gltf"), &Quiet, &Cancel::new()));
});
