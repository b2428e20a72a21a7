//! Any bytes as weather in EPW.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::sky::weather::epw::read_epw;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_epw(&Input::alone(bytes, Path::new("fuzz.epw"), &Quiet, &Cancel::new()));
});
