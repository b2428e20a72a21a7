//! Any bytes as Radiance sensors.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::sensors::read_pts;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_pts(&Input::alone(bytes, Path::new("fuzz.pts"), &Quiet, &Cancel::new()));
});
