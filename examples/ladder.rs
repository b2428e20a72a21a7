//! How near does each quality of a method come, and what does it cost?
//!
//! Prints, for each scene and each rung of a method's ladder, rms factor, greatest factor, median angle and milliseconds (the
//! shortest of five runs, given the skeleton), and how often the reference lies within once and twice the method's own error;
//! where LADDER_SENSORS is set, each sensor too (reference, estimate, ratio, angle):
//!
//!     cargo run --release --example ladder -- diffusion scenes/gallery/gallery_r08.toml scenes/tower/tower.toml

use anyhow::{Context, Result};
use lightvein::flow::{Rung, ladder};
use lightvein::job::{Cancel, Quiet};
use lightvein::light::Settings;
use lightvein::model::Model;
use lightvein::model::choose::choose_voxel_m;
use lightvein::rays::Rays;
use lightvein::scene::{Method, Scene};
use lightvein::study::errors::{errors, is_good};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Runs of which the shortest counts.
const RUNS: usize = 5;

fn main() -> Result<()> {
    let mut words = std::env::args().skip(1);
    let name = words.next().context("which method?")?;
    let method = Method::from_name(&name).context("no such method")?;
    println!(
        "{:24} {:20} {:>8} {:>8} {:>6} {:>8} {:>6} {:>6}",
        "scene", "rung", "rms", "max", "angle", "ms", "in 1", "in 2"
    );
    for path in words {
        let scene = Scene::load(Path::new(&path), &Quiet, &Cancel::new())?;
        if scene.reference.is_empty() {
            println!("{:24} skipped: it has no reference", scene.name);
            continue;
        }
        let rays = Arc::new(Rays::new(&scene));
        let model = match scene.model.voxel_m {
            Some(voxel_m) => Model::build(&scene, rays, voxel_m, u64::MAX, &Quiet, &Cancel::new())?,
            None => choose_voxel_m(&scene, &rays, u64::MAX, &Quiet, &Cancel::new())?.model,
        };
        for rung in ladder(method) {
            println!("{:24} {}", scene.name, row(&scene, &model, &rung)?);
        }
    }
    Ok(())
}

fn row(scene: &Scene, model: &Model, rung: &Rung) -> Result<String> {
    let probes = model.probes_at_sensors(scene);
    let run = || {
        let began = Instant::now();
        let field = (rung.estimate)(model, &probes, &Settings::default(), &Quiet, &Cancel::new())?;
        anyhow::Ok((began.elapsed().as_secs_f64() * 1e3, field))
    };
    let mut runs = (0..RUNS).map(|_| run()).collect::<Result<Vec<_>>>()?;
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (ms, field) = &runs[0];
    let found = errors(&field.readings, &scene.reference);
    let pairs = field.readings.iter().zip(&scene.reference);
    let good: Vec<_> = pairs.filter_map(|(reading, known)| Some((reading, known.filter(is_good)?))).collect();
    if std::env::var_os("LADDER_SENSORS").is_some() {
        for ((reading, known), sensor) in field.readings.iter().zip(&scene.reference).zip(&scene.sensors) {
            if let Some(known) = known {
                let angle = lightvein::study::errors::angle_deg(reading, known).unwrap_or(f64::NAN);
                eprintln!(
                    "{:14} {:10.4e} {:10.4e} {:7.3} {:6.1}",
                    sensor.id,
                    known.irradiance_w_m2,
                    reading.value_w_m2,
                    reading.value_w_m2 / known.irradiance_w_m2,
                    angle
                );
            }
        }
    }
    let within = |times: f64| {
        let inside = good.iter().filter(|(reading, known)| {
            let error_w_m2 = reading.error_w_m2.unwrap_or(0.0).hypot(known.stderr_w_m2);
            (reading.value_w_m2 - known.irradiance_w_m2).abs() <= times * error_w_m2
        });
        100.0 * inside.count() as f64 / good.len().max(1) as f64
    };
    Ok(format!(
        "{:20} {:8.3} {:8.3} {:6.1} {ms:8.2} {:5.0}% {:5.0}%",
        rung.label(),
        found.rms_factor.unwrap_or(f64::NAN),
        found.max_factor.unwrap_or(f64::NAN),
        found.median_angle_deg.unwrap_or(f64::NAN),
        within(1.0),
        within(2.0)
    ))
}
