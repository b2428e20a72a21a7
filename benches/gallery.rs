//! From the gallery's mesh to estimates at its sensors, voxels of 0.1 m: `cargo bench --bench gallery`.
//!
//! Prints medians of 15 runs after a warm-up for each stage and each estimator, for one thread and for two, and the peak
//! memory of a run of the program. Loading the mesh is not counted, building the rays is; `to network` is the way from the mesh
//! to the field of `network`. Of the skeleton's time `sections`
//! is a part, and of that `nearest`, which is timed once more by itself, after the rest.

use lightvein::flow::estimator;
use lightvein::job::{Cancel, Progress, Quiet};
use lightvein::light::Settings;
use lightvein::model::{Model, places_of_patches};
use lightvein::rays::Rays;
use lightvein::scene::{Method, Scene};
use lightvein::skeleton::Skeleton;
use lightvein::skeleton::nearest::Nearest;
use lightvein::voxel::voxelise;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Instant;

const RUNS: usize = 15;
const VOXEL_M: f32 = 0.1;

/// The estimators that are timed.
const METHODS: [Method; 4] = [Method::Backward, Method::Forward, Method::Diffusion, Method::Network];

/// Stages before them, from the rays to the sensors' places.
const STAGES: usize = 4;

fn main() -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery/gallery.toml");
    let scene = Scene::load(&path, &Quiet, &Cancel::new())?;
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        println!("{threads} thread(s), medians of {RUNS} runs, ms");
        pool.install(|| time_stages(&scene))?;
    }
    Ok(())
}

fn time_stages(scene: &Scene) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let stages = ["rays", "voxels", "skeleton", "places"];
    let names: Vec<&str> =
        (stages.into_iter().chain(METHODS.map(Method::name))).chain(["to network", "sections", "nearest"]).collect();
    let mut times_ms = vec![Vec::new(); names.len()];
    for run in 0..=RUNS {
        let row = time_once(scene)?;
        // The first run warms caches and the allocator up.
        if run > 0 {
            for (column, ms) in times_ms.iter_mut().zip(row) {
                column.push(ms);
            }
        }
    }
    for (name, mut column) in names.into_iter().zip(times_ms) {
        column.sort_by(f64::total_cmp);
        println!("  {name:10} {:8.2}   ({:.2} to {:.2})", column[RUNS / 2], column[0], column[RUNS - 1]);
    }
    Ok(())
}

/// One run; milliseconds in the order of the names.
fn time_once(scene: &Scene) -> Result<Vec<f64>, Box<dyn std::error::Error + Send + Sync>> {
    let (progress, cancel, settings) = (Quiet, Cancel::new(), Settings::default());
    let began = Instant::now();
    let mut laps_ms = Vec::new();
    let mut lap = || laps_ms.push(began.elapsed().as_secs_f64() * 1e3);

    let rays = Arc::new(Rays::new(scene));
    lap();
    let sources = lightvein::light::Sources::of(scene);
    let voxels = voxelise(scene, &rays, &places_of_patches(scene, &sources), VOXEL_M, u64::MAX, &progress, &cancel)?;
    lap();
    let sections = Stopwatch { stage: "sections", began: Mutex::default(), took_ms: Mutex::default() };
    let skeleton = Skeleton::build(&voxels, &rays, &sections, &cancel)?;
    lap();
    let model = Model::of(scene, rays, sources, voxels, skeleton);
    let probes = model.probes_at_sensors(scene);
    lap();
    for method in METHODS {
        let estimate = estimator(method).ok_or("not an estimator")?;
        std::hint::black_box(estimate(&model, &probes, &settings, &progress, &cancel)?);
        lap();
    }
    let mut before_ms = 0.0;
    let mut row = Vec::new();
    for lap_ms in laps_ms {
        row.push(lap_ms - before_ms);
        before_ms = lap_ms;
    }
    let network_ms = row.last().copied().unwrap_or(0.0);
    row.push(row.iter().take(STAGES).sum::<f64>() + network_ms);
    row.push(*sections.took_ms.lock().map_err(|_| "a stage panicked")?);
    let lattice = model.skeleton.lattice;
    let nodes = model.skeleton.graph.node_weights();
    let corners: Vec<_> = nodes.map(|node| lattice.point_in_grid(node.position_m).round().as_ivec3()).collect();
    let began = Instant::now();
    std::hint::black_box(Nearest::new(&model.voxels.void, &corners));
    row.push(began.elapsed().as_secs_f64() * 1e3);
    Ok(row)
}

/// Times one stage of those reported.
struct Stopwatch {
    stage: &'static str,
    began: Mutex<Option<Instant>>,
    took_ms: Mutex<f64>,
}

impl Progress for Stopwatch {
    fn begin(&self, stage: &str, _total: u64) {
        if let Ok(mut began) = self.began.lock() {
            *began = (stage == self.stage).then(Instant::now);
        }
    }

    fn advance(&self, _units: u64) {}

    fn end(&self) {
        if let (Ok(mut began), Ok(mut took_ms)) = (self.began.lock(), self.took_ms.lock())
            && let Some(began) = began.take()
        {
            *took_ms += began.elapsed().as_secs_f64() * 1e3;
        }
    }
}
