//! Path-traced samples a second on the gallery, and the time that each of its sensors needs for a standard error of 1%.
//! Run with `cargo bench --bench trace`; `benches/peers/trace_peer.py` runs Mitsuba on the same sensors beside it.

use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Settings, Sources};
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::trace::trace;
use std::path::Path;
use std::time::Instant;

const SAMPLES: u32 = 65_536;

fn main() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery/gallery.toml");
    let (progress, cancel) = (Quiet, Cancel::new());
    let scene = Scene::load(&file, &progress, &cancel).unwrap_or_else(|error| panic!("{error}"));
    let (rays, sources) = (Rays::new(&scene), Sources::of(&scene));
    let settings = Settings { samples: SAMPLES, seed: 1, ..Settings::default() };
    let started = Instant::now();
    let traced = trace(&scene, &rays, &sources, &settings, &progress, &cancel).expect("nobody cancels");
    let seconds = started.elapsed().as_secs_f64();

    let sensors = scene.sensors.len() as f64;
    let rate = sensors * f64::from(SAMPLES) / seconds;
    println!("{sensors} sensors, {SAMPLES} samples each: {seconds:.2} s, {rate:.3e} sensor-samples/s");
    for (sensor, (reading, top_share)) in scene.sensors.iter().zip(traced.field.readings.iter().zip(&traced.top_share))
    {
        let share = reading.error_w_m2.unwrap_or(f64::NAN) / reading.value_w_m2;
        let for_1_percent = seconds / sensors * (share / 0.01).powi(2);
        let id = &sensor.id;
        println!(
            "{id}: {:.4e} W/m2 +- {:.2}%, largest sample {:.2}%, {for_1_percent:.3} s for 1%",
            reading.value_w_m2,
            100.0 * share,
            100.0 * top_share
        );
    }
}
