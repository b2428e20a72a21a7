//! How fast is the exact Euclidean distance, and how fast is `edt` on the same arrays?
//!
//! `cargo bench --bench distance [-- --runs N] [--no-peer]`
//!
//! Two arrays of about 6.6 million voxels: rooms, where distances are up to ten voxels, and one hall with a few specks, where
//! they reach a hundred. Prints medians with one and with two threads, packing of bytes into bits counted. `edt` (Python,
//! C++ inside) is then timed on the same files with as many threads, where `python3` has it (`pip install edt`), and its
//! distances are compared with ours voxel by voxel.

#[allow(dead_code, reason = "each bench uses what it needs")]
mod rooms;

use lightvein::voxel::bits::BitGrid;
use lightvein::voxel::euclid::{Beyond, squared_distances};
use ndarray::Array3;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let after = |flag: &str| args.iter().position(|arg| arg == flag).and_then(|at| args.get(at + 1));
    let runs = after("--runs").and_then(|runs| runs.parse().ok()).unwrap_or(9);
    let folder = std::env::temp_dir().join(format!("lightvein-distance-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();

    for (name, (size, void)) in [("rooms", rooms::array_of_rooms([8, 8, 7], 24, 5)), ("hall", hall([197, 197, 173]))] {
        println!("{name}: {size:?}, {:.2} M voxels", void.len() as f64 / 1e6);
        let solid: Vec<u8> = void.iter().map(|&void| 1 - void).collect();
        let mut seconds = Vec::new();
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut times: Vec<f64> = (0..runs)
                .map(|_| {
                    let start = Instant::now();
                    pool.install(|| squared_distances(&BitGrid::from_bytes(size, &solid), Beyond::Solid));
                    start.elapsed().as_secs_f64()
                })
                .collect();
            times.sort_by(f64::total_cmp);
            let median = times[times.len() / 2];
            println!(
                "  {threads} thread{} {:.1} ms, {:.0} Mvoxel/s",
                if threads == 1 { " " } else { "s" },
                1e3 * median,
                void.len() as f64 / median / 1e6
            );
            seconds.push(median);
        }

        if args.iter().any(|arg| arg == "--no-peer") {
            continue;
        }
        let [x, y, z] = size;
        let squared = squared_distances(&BitGrid::from_bytes(size, &solid), Beyond::Solid);
        let (array, ours) = (folder.join(format!("{name}.npy")), folder.join(format!("{name}-squared.npy")));
        ndarray_npy::write_npy(&array, &Array3::from_shape_vec((z, y, x), void).unwrap()).unwrap();
        ndarray_npy::write_npy(&ours, &Array3::from_shape_vec((z, y, x), squared).unwrap()).unwrap();
        time_peer(&array, &ours, runs, &seconds);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Times `edt` on the same array, with one and with two threads.
fn time_peer(array: &Path, ours: &Path, runs: usize, seconds: &[f64]) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/edt_peer.py");
    let mut python = Command::new("python3");
    python.arg(&script).arg(array).arg(ours).arg(runs.to_string()).args(seconds.iter().map(f64::to_string));
    match python.status() {
        Ok(status) if status.success() => {}
        Ok(status) => println!("  edt skipped: {} ended with {status}", script.display()),
        Err(error) => println!("  edt skipped: python3 does not run: {error}"),
    }
}

/// One void with a solid speck here and there.
fn hall(size: [usize; 3]) -> ([usize; 3], Vec<u8>) {
    let mut void = vec![1; size.iter().product()];
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    for _ in 0..40 {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let speck = (state >> 16) as usize % void.len();
        void[speck] = 0;
    }
    (size, void)
}
