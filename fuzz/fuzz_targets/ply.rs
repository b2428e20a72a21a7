//! Any bytes as a PLY mesh.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::read::ply::read_ply;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_ply(&Input::alone(bytes, Path::new("fuzz.ply"), &Quiet, &Cancel::new()));
});
