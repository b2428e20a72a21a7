//! Any bytes as the material file of an OBJ mesh.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::read::mtl::read_mtl;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_mtl(&Input::alone(bytes, Path::new("fuzz.mtl"), &Quiet, &Cancel::new()));
});
