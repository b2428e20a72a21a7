//! Any bytes as references in CSV.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::reference::read_reference_csv;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_reference_csv(&Input::alone(bytes, Path::new("fuzz.csv"), &Quiet, &Cancel::new()));
});
