//! Any bytes as an STL mesh.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::read::stl::read_stl;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_stl(&Input::alone(bytes, Path::new("fuzz.stl"), &Quiet, &Cancel::new()));
});
