//! Any bytes as a Wavefront OBJ mesh.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::read::obj::read_obj;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_obj(&Input::alone(bytes, Path::new("fuzz.obj"), &Quiet, &Cancel::new()));
});
