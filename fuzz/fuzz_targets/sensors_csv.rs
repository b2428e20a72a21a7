//! Any bytes as sensors in CSV.
#![no_main]

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::input::Input;
use lightvein::scene::sensors::read_sensors_csv;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_sensors_csv(&Input::alone(bytes, Path::new("fuzz.csv"), &Quiet, &Cancel::new()));
});
