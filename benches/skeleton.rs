//! How long does thinning take, stage by stage, and how long do others take on the same array?
//!
//! `cargo bench --bench skeleton [-- [--runs N] [--no-peers] | --write DIR]`
//!
//! Arrays of rooms joined by doors and shafts, about 6.6 and 12.8 million voxels, half of them void, the same each time.
//! Prints medians over the runs, with one and with two threads. scikit-image, Kimimaro and edt are timed on the
//! smaller arrays, in the same run, where `python3` has them (`pip install scikit-image kimimaro edt`).
//! With `--write` no time is taken: small voids and their skeletons, drawn twice as large, are written as `.npy` files, for
//! `peers/topology_gudhi.py`.

mod rooms;

use glam::IVec3;
use lightvein::job::{Cancel, Progress, Quiet};
use lightvein::skeleton::curve::Curve;
use lightvein::skeleton::{thin, topology};
use lightvein::voxel::bits::BitGrid;
use ndarray::Array3;
use rooms::{array_of_rooms, random};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;
use std::time::Instant;

/// The arrays: name, rooms along x, y, z, voxels from a room to the next, voxels of wall among them. Rooms of 3.7 m at
/// 0.1 m voxels, or 1.9 m: the smaller they are, the more of the array is surface, and the less a peer that sweeps the
/// whole array loses.
const ARRAYS: [(&str, [usize; 3], usize, usize); 3] =
    [("rooms-6m", [4, 4, 4], 45, 8), ("rooms-12m", [5, 5, 5], 45, 8), ("small-rooms-6m", [8, 8, 7], 24, 5)];

/// The stages that the peers' work is compared with: all of thinning but the ties of floating solids, which they lack.
const COMPARED: [&str; 6] = ["distance", "opening", "complex", "anchors", "collapse", "prune"];

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let after = |flag: &str| args.iter().position(|arg| arg == flag).and_then(|at| args.get(at + 1));
    let runs = after("--runs").and_then(|runs| runs.parse().ok()).unwrap_or(9);
    if let Some(folder) = after("--write") {
        return write_for_check(Path::new(folder));
    }
    let folder = std::env::temp_dir().join(format!("lightvein-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();

    for (name, rooms, pitch, wall) in ARRAYS {
        let (size, bytes) = array_of_rooms(rooms, pitch, wall);
        let void = bytes.iter().filter(|byte| **byte == 1).count();
        println!(
            "{name}: {size:?}, {:.2} M voxels, {:.1}% void",
            bytes.len() as f64 / 1e6,
            100.0 * void as f64 / bytes.len() as f64
        );
        let mut seconds = 0.0;
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            seconds = pool.install(|| time_stages(threads, size, &bytes, runs));
        }
        let curve = thin(&BitGrid::from_bytes(size, &bytes), &Quiet, &Cancel::new()).unwrap();
        println!("  {} vertices, {:?}\n", curve.vertices.len(), topology::of_curve(&curve));

        if name.ends_with("6m") && !args.iter().any(|arg| arg == "--no-peers") {
            let path = folder.join(format!("{name}.npy"));
            ndarray_npy::write_npy(&path, &as_array(size, bytes)).unwrap();
            time_peers(&path, seconds);
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Writes voids of several kinds and their skeletons: rooms, rooms with floating specks, and noise.
fn write_for_check(folder: &Path) {
    std::fs::create_dir_all(folder).unwrap();
    let (size, rooms) = array_of_rooms([2, 2, 2], 22, 4);
    let mut random = random();
    let mut specked = |share: usize, bytes: &[u8]| -> Vec<u8> {
        bytes.iter().map(|byte| u8::from(*byte == 1 && random(1000) >= share)).collect()
    };
    let noise = vec![1; 40 * 40 * 40];
    let volumes = [
        ("rooms", size, rooms.clone()),
        ("rooms-specks", size, specked(2, &rooms)),
        ("rooms-many-specks", size, specked(20, &rooms)),
        ("noise-30", [40; 3], specked(300, &noise)),
        ("noise-60", [40; 3], specked(600, &noise)),
        ("noise-90", [40; 3], specked(900, &noise)),
    ];
    for (name, size, bytes) in volumes {
        let void = BitGrid::from_bytes(size, &bytes);
        let curve = thin(&void, &Quiet, &Cancel::new()).unwrap();
        println!("{name}: void {:?}, skeleton {:?}", topology::of_void(&void), topology::of_curve(&curve));
        ndarray_npy::write_npy(folder.join(format!("{name}.npy")), &as_array(size, bytes)).unwrap();
        ndarray_npy::write_npy(folder.join(format!("{name}-skeleton.npy")), &drawn(size, &curve)).unwrap();
    }
}

/// Runs all stages and prints their medians; gives the seconds that count against the peers.
fn time_stages(threads: usize, size: [usize; 3], bytes: &[u8], runs: usize) -> f64 {
    let stages = Stages::default();
    for _ in 0..runs {
        stages.begin("packing", 0);
        let void = BitGrid::from_bytes(size, bytes);
        stages.end();
        thin(&void, &stages, &Cancel::new()).unwrap();
    }
    let times = stages.times.lock().unwrap();
    let medians: BTreeMap<&str, f64> = times.iter().map(|(stage, times)| (stage.as_str(), median(times))).collect();
    let compared: f64 = COMPARED.iter().map(|stage| medians[stage]).sum();
    let total: f64 = medians.values().sum();
    print!("  {threads} thread{}:", if threads == 1 { " " } else { "s" });
    for stage in ["packing", "ties"].iter().chain(&COMPARED) {
        print!(" {stage} {:.1}", 1e3 * medians[stage]);
    }
    let core = medians["distance"] + medians["opening"] + medians["collapse"];
    println!(
        " ms; compared {:.1}, all {:.1}; distance, opening and collapse alone {:.1}",
        1e3 * compared,
        1e3 * total,
        1e3 * core
    );
    compared
}

/// Times the peers' programs on the same file.
fn time_peers(array: &Path, seconds: f64) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/skeleton_peers.py");
    match Command::new("python3").arg(&script).arg(array).arg(seconds.to_string()).status() {
        Ok(status) if status.success() => println!(),
        Ok(status) => println!("  peers skipped: {} ended with {status}\n", script.display()),
        Err(error) => println!("  peers skipped: python3 does not run: {error}\n"),
    }
}

fn as_array([x, y, z]: [usize; 3], bytes: Vec<u8>) -> Array3<u8> {
    Array3::from_shape_vec((z, y, x), bytes).unwrap()
}

/// A curve as voxels of half the size: a vertex at twice its place, an edge between; `[z][y][x]`.
fn drawn(size: [usize; 3], curve: &Curve) -> Array3<u8> {
    let [x, y, z] = size.map(|voxels| 2 * voxels + 1);
    let mut array = Array3::zeros((z, y, x));
    let mut set = |at: IVec3| array[[at.z as usize, at.y as usize, at.x as usize]] = 1;
    let corner = |vertex: u32| curve.vertices[vertex as usize].corner;
    curve.vertices.iter().for_each(|vertex| set(2 * vertex.corner));
    curve.edges.iter().for_each(|[a, b]| set(corner(*a) + corner(*b)));
    array
}

fn median(times: &[f64]) -> f64 {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Keeps the time of every stage.
#[derive(Default)]
struct Stages {
    running: Mutex<Option<(String, Instant)>>,
    times: Mutex<BTreeMap<String, Vec<f64>>>,
}

impl Progress for Stages {
    fn begin(&self, stage: &str, _total: u64) {
        *self.running.lock().unwrap() = Some((stage.to_owned(), Instant::now()));
    }

    fn advance(&self, _units: u64) {}

    fn end(&self) {
        let (stage, began) = self.running.lock().unwrap().take().unwrap();
        self.times.lock().unwrap().entry(stage).or_default().push(began.elapsed().as_secs_f64());
    }
}
