//! How long does thinning take, stage by stage, and how long do others take on the same array?
//!
//! `cargo bench --bench skeleton [-- --runs N] [--no-peers] [--write DIR]`
//!
//! Two arrays of rooms joined by doors and shafts, about 6.6 and 12.8 million voxels, half of them void, the same each
//! time. Prints medians over the runs, with one and with two threads. scikit-image, Kimimaro and edt are then timed on the
//! first array, in the same run, where `python3` has them (`pip install scikit-image kimimaro edt`).
//! `--write` keeps the arrays, and the skeletons drawn twice as large, as `.npy` files.

use glam::IVec3;
use lightvein::job::{Cancel, Progress};
use lightvein::skeleton::curve::Curve;
use lightvein::skeleton::{thin, topology};
use lightvein::voxel::bits::BitGrid;
use ndarray::Array3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::time::Instant;

/// Voxels from a room to the next.
const PITCH: usize = 24;

/// Voxels of wall past the last room.
const WALL: usize = 5;

/// The stages that the peers' work is compared with: all of thinning but the ties of floating solids, which they lack.
const COMPARED: [&str; 6] = ["distance", "opening", "complex", "anchors", "collapse", "prune"];

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let after = |flag: &str| args.iter().position(|arg| arg == flag).and_then(|at| args.get(at + 1));
    let runs = after("--runs").and_then(|runs| runs.parse().ok()).unwrap_or(9);
    let written = after("--write").map(PathBuf::from);
    let folder =
        written.clone().unwrap_or_else(|| std::env::temp_dir().join(format!("lightvein-{}", std::process::id())));
    std::fs::create_dir_all(&folder).unwrap();

    for (name, rooms) in [("rooms-6m", [8, 8, 7]), ("rooms-12m", [12, 8, 9])] {
        let (size, bytes) = array_of_rooms(rooms);
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
        let curve = thin(&BitGrid::from_bytes(size, &bytes), &lightvein::job::Quiet, &Cancel::new()).unwrap();
        println!("  {} vertices, {:?}\n", curve.vertices.len(), topology::of_curve(&curve));

        let [x, y, z] = size;
        let path = folder.join(format!("{name}.npy"));
        ndarray_npy::write_npy(&path, &Array3::from_shape_vec((z, y, x), bytes).unwrap()).unwrap();
        if written.is_some() {
            ndarray_npy::write_npy(folder.join(format!("{name}-skeleton.npy")), &drawn(size, &curve)).unwrap();
        }
        if name == "rooms-6m" && !args.iter().any(|arg| arg == "--no-peers") {
            time_peers(&path, seconds);
        }
    }
    if written.is_none() {
        std::fs::remove_dir_all(&folder).unwrap();
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
    let medians: BTreeMap<_, _> =
        stages.times.lock().unwrap().iter().map(|(stage, times)| (*stage, median(times))).collect();
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

/// Rooms of differing sizes on a grid, joined by doors to the side and shafts upwards; 1 is void, `[z][y][x]`.
fn array_of_rooms(rooms: [usize; 3]) -> ([usize; 3], Vec<u8>) {
    let size = rooms.map(|rooms| rooms * PITCH + WALL);
    let mut bytes = vec![0; size.iter().product()];
    let mut carve = |low: [usize; 3], high: [usize; 3]| {
        for z in low[2]..high[2] {
            for y in low[1]..high[1] {
                bytes[low[0] + size[0] * (y + size[1] * z)..][..high[0] - low[0]].fill(1);
            }
        }
    };
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) as usize % below
    };
    for room in 0..rooms.iter().product() {
        let at = [room % rooms[0], room / rooms[0] % rooms[1], room / (rooms[0] * rooms[1])];
        let low = at.map(|along| WALL + PITCH * along);
        let high = low.map(|low| low + 19 + random(2) - random(2));
        carve(low, high);
        // A door at the floor for three in four neighbours to the side, a shaft in the middle for one in three above.
        for axis in 0..3 {
            let joined = if axis == 2 { random(3) == 0 } else { random(4) > 0 };
            if joined && at[axis] + 1 < rooms[axis] {
                let (mut from, mut to) = (low.map(|low| low + 7), low.map(|low| low + 13));
                if axis != 2 {
                    (from[2], to[2]) = (low[2], low[2] + 12);
                }
                (from[axis], to[axis]) = (high[axis], low[axis] + PITCH);
                carve(from, to);
            }
        }
    }
    (size, bytes)
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
    running: Mutex<Option<(&'static str, Instant)>>,
    times: Mutex<BTreeMap<&'static str, Vec<f64>>>,
}

impl Progress for Stages {
    fn begin(&self, stage: &'static str, _total: u64) {
        *self.running.lock().unwrap() = Some((stage, Instant::now()));
    }

    fn advance(&self, _units: u64) {}

    fn end(&self) {
        let (stage, began) = self.running.lock().unwrap().take().unwrap();
        self.times.lock().unwrap().entry(stage).or_default().push(began.elapsed().as_secs_f64());
    }
}
