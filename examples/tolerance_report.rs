//! How often does the truth lie inside the tolerance that `analyse` promised?
//!
//!     cargo run --release --example tolerance_report -- SCENE...
//!
//! Each scene twice, with the voxels of its file and with voxels that are chosen, and at several tolerances. A promise is kept
//! where the `rms_factor` over the referenced sensors is at most the tolerance; scenes that promise nothing are counted apart.

use lightvein::flow::{Rung, ladder};
use lightvein::job::{Cancel, Quiet};
use lightvein::light::Settings;
use lightvein::model::Model;
use lightvein::model::choose::choose_voxel_m;
use lightvein::rays::Rays;
use lightvein::scene::{Method, Scene};
use lightvein::study::errors::{errors, is_good};
use lightvein::study::tolerance::{Chosen, Search};
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

const TOLERANCES: [f64; 4] = [1.1, 1.2, 1.5, 2.0];

/// The most memory for voxels and skeleton, bytes.
const MOST_BYTES: u64 = 4_000_000_000;

fn main() -> Result<(), Box<dyn Error>> {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    println!("| scene | voxels | tolerance | chosen | expected | rms factor | within, of sensors | kept |");
    println!("|---|---|---|---|---|---|---|---|");
    // Promised and kept, sensors within the tolerance and all of them; for each tolerance.
    let mut counts = [[0_usize; 4]; TOLERANCES.len()];
    for path in &paths {
        let scene = Scene::load(Path::new(path), &Quiet, &Cancel::new())?;
        for voxel_m in [scene.model.voxel_m, None] {
            for (tolerance, counts) in TOLERANCES.into_iter().zip(&mut counts) {
                let chosen = choose(&scene, voxel_m, tolerance)?;
                let row = told(&scene, voxel_m.is_some(), &chosen, counts);
                println!("{row}");
            }
        }
    }
    println!();
    for (tolerance, [promised, kept, within, sensors]) in TOLERANCES.into_iter().zip(counts) {
        let share = 100.0 * within as f64 / sensors.max(1) as f64;
        println!("tolerance {tolerance}: {promised} promised, {kept} kept; {share:.0}% of {sensors} sensors within it");
    }
    Ok(())
}

/// As `analyse` chooses.
fn choose(scene: &Scene, voxel_m: Option<f32>, tolerance: f64) -> Result<Chosen, Box<dyn Error>> {
    let (progress, cancel) = (Quiet, Cancel::new());
    let rays = Arc::new(Rays::new(scene));
    let rungs: Vec<Rung> = Method::ALL.into_iter().flat_map(ladder).collect();
    let build = |voxel_m| Model::build(scene, rays.clone(), voxel_m, MOST_BYTES, &progress, &cancel);
    let (model, finer) = match voxel_m {
        Some(voxel_m) => (build(voxel_m)?, None),
        None => {
            let chosen = choose_voxel_m(scene, &rays, MOST_BYTES, &progress, &cancel)?;
            (chosen.model, chosen.finer)
        }
    };
    let search = Search {
        rungs: &rungs,
        tolerance,
        settings: &Settings::default(),
        probes: &|model: &Model| model.probes_at_sensors(scene),
        build: &build,
    };
    search.run(model, finer, String::new(), &progress, &cancel)?.ok_or_else(|| "no method".into())
}

/// The row of one choice; adds to the counts where it promised something.
fn told(scene: &Scene, is_given: bool, chosen: &Chosen, counts: &mut [usize; 4]) -> String {
    let choice = &chosen.choice;
    let errors = errors(&chosen.field.readings, &scene.reference);
    let rms_factor = errors.rms_factor.unwrap_or(f64::NAN);
    let ratios = chosen.field.readings.iter().zip(&scene.reference).filter_map(|(reading, reference)| {
        let reference = reference.as_ref().filter(|reference| is_good(reference))?;
        Some(reading.value_w_m2 / reference.irradiance_w_m2)
    });
    let within = ratios.filter(|ratio| ratio.ln().abs() <= choice.tolerance.ln()).count();
    let is_kept = rms_factor <= choice.tolerance;
    if choice.is_inside() {
        let added = [1, usize::from(is_kept), within, errors.counted];
        counts.iter_mut().zip(added).for_each(|(count, added)| *count += added);
    }
    let kept = match (choice.is_inside(), is_kept) {
        (true, true) => "yes",
        (true, false) => "NO",
        (false, _) => "nothing promised",
    };
    format!(
        "| {} | {} m{} | {} | {} | {} | {rms_factor:.2} | {within} of {} | {kept} |",
        scene.name,
        choice.voxel_m,
        if is_given { "" } else { ", chosen" },
        choice.tolerance,
        choice.method,
        choice.expected_factor.map_or_else(|| "-".to_owned(), |factor| format!("{factor:.2}")),
        errors.counted,
    )
}
