//! Any bytes as weather in WEA.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::sky::weather::wea::read_wea;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_wea(&Input::alone(bytes, Path::new("fuzz.wea"), &Quiet, &Cancel::new()));
});
