//! What the program finds in real scenes, as the table of docs/real-scenes.md.
//!
//! `cargo run --release --example real_scenes -- scenes/real/*.toml`
//!
//! The meshes lie beside the project; without them there is nothing to see, and it says so.

use lightvein::job::{Cancel, Quiet};
use lightvein::model::Model;
use lightvein::model::choose::choose_voxel_m;
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "| scene | triangles | lights | voxel m | grid | void m3 | voids | nodes | components | loops | cells | necks | seconds |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut remarks = Vec::new();
    for path in std::env::args_os().skip(1) {
        let path = Path::new(&path);
        match Scene::load(path, &Quiet, &Cancel::new()) {
            Ok(scene) if scene.lights.is_empty() && scene.site.is_some() => {
                eprintln!("skipped: {} lies under the sky and has no lights", scene.name);
            }
            Ok(scene) => remarks.extend(row(&scene)?),
            Err(error) => eprintln!("skipped: {error}"),
        }
    }
    println!();
    for remark in remarks {
        println!("- {remark}");
    }
    Ok(())
}

/// Prints the row of a scene; gives what there is to remark on it.
fn row(scene: &Scene) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let began = Instant::now();
    let rays = Arc::new(Rays::new(scene));
    let (model, reason) = match scene.model.voxel_m {
        Some(voxel_m) => (Model::build(scene, rays, voxel_m, u64::MAX, &Quiet, &Cancel::new())?, None),
        None => {
            let chosen = choose_voxel_m(scene, &rays, u64::MAX, &Quiet, &Cancel::new())?;
            (chosen.model, Some(chosen.reason))
        }
    };
    let seconds = began.elapsed().as_secs_f64();

    let lattice = &model.voxels.lattice;
    let [nx, ny, nz] = lattice.size;
    let void_m3: f32 = model.skeleton.cells.iter().map(|cell| cell.volume_m3).sum();
    let shape = model.skeleton.shape();
    println!(
        "| {} | {} | {} | {} | {nx} x {ny} x {nz} | {void_m3:.1} | {} | {} | {} | {} | {} | {} | {seconds:.2} |",
        scene.name,
        scene.mesh.triangles.len(),
        model.sources.emitters.len(),
        lattice.voxel_m,
        model.voxels.voids.len(),
        model.skeleton.graph.node_count(),
        shape.components,
        shape.loops,
        model.skeleton.cells.len(),
        shape.necks,
    );
    let all = reason.into_iter().chain(scene.warnings.iter().cloned()).chain(model.voxels.warnings.iter().cloned());
    Ok(all.map(|remark| format!("`{}`: {remark}", scene.name)).collect())
}
