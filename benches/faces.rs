//! Does exposure cost more where a city has more faces?
//!
//!     cargo bench --bench faces [-- MOST_THOUSANDS]
//!
//! A made city of 300 x 300 m with 7,000 to 770,000 faces (or up to about so many thousands): always the same 144 houses, of 8 to
//! 26 m, and on their walls and roofs ever smaller boxes, so that what is seen of the sky hardly changes. 10,000 points, the
//! same in all of them, half a metre before walls, over roofs and over the ground. For each: the time that is needed before
//! the first point (the rays' tree; the zenith's depth map), points a second by rays (256 suns, 256 directions) and by maps
//! (16 directions of 16 samples, peeled), and the mean sky view factor of both. Medians of three runs, clear year at 42
//! degrees north.

use glam::Vec3;
use lightvein::daylight::cast::{Asked, Casting, cast};
use lightvein::daylight::scales::sight::Overhangs;
use lightvein::daylight::scales::sums::SkySums;
use lightvein::daylight::scales::zenith::Zenith;
use lightvein::daylight::scales::{Scan, expose};
use lightvein::daylight::{Exposure, Point};
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::{Mesh, Scene, Site};
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use std::time::Instant;

const RUNS: usize = 3;
const POINTS: usize = 10_000;
const FACES: [usize; 6] = [4_000, 16_000, 50_000, 100_000, 250_000, 800_000];

/// Houses a side, the square that each stands in, and what of it is street, metres.
const HOUSES: usize = 12;
const PLOT_M: f32 = 25.0;
const STREET_M: f32 = 9.0;

/// How far the points stand off; relief sticks out less.
const OFF_M: f32 = 0.5;

/// Depth of the relief: that share of a cell's side, and no more than so much.
const RELIEF_SHARE: f32 = 0.2;
const RELIEF_M: f32 = 0.3;

fn main() {
    let most =
        std::env::args().skip(1).find_map(|arg| arg.parse::<usize>().ok()).map_or(usize::MAX, |most| 1000 * most);
    let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(0.0), turbidity: Some(3.0), ..Site::default() };
    let outdoors = Outdoors::of(&site, None).unwrap();
    let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&outdoors.steps().unwrap(), &settings, &Quiet, &Cancel::new()).unwrap();
    let (sums_s, sums) = timed(|| SkySums::new(&map, 0.0, 16, 8));
    let points = points();
    println!(
        "{} threads, {RUNS} runs, {POINTS} points; the sky's sums {:.0} ms",
        rayon::current_num_threads(),
        1e3 * sums_s
    );
    println!(
        "{:>8} {:>9} {:>10} {:>7} {:>11} {:>10} {:>7}",
        "faces", "tree, ms", "rays, 1/s", "svf", "depths, ms", "maps, 1/s", "svf"
    );
    for faces in FACES.into_iter().filter(|&faces| faces <= most) {
        let scene = Scene { mesh: city(faces), ..Scene::default() };
        let (tree_s, rays) = median(|| Rays::new(&scene));
        let casting = Casting { sun_rays: Some(256), sky_rays: 256, seed: 0 };
        let (rays_s, by_rays) = median(|| cast(&rays, &points, &map, 0.0, casting, &Quiet, &Cancel::new()).unwrap());
        let (depths_s, zenith) = median(|| Zenith::new(&scene, 1024, true, &Cancel::new()).unwrap());
        let scan = Scan { samples: 16, reach_m: None, overhangs: Overhangs::Peeled, seed: 0 };
        let (maps_s, by_maps) =
            median(|| expose(&zenith, &sums, Asked::all(&points), &scan, &Quiet, &Cancel::new()).unwrap());
        println!(
            "{:>8} {:>9.1} {:>10.0} {:>7.4} {:>11.1} {:>10.0} {:>7.4}",
            scene.mesh.triangles.len(),
            1e3 * tree_s,
            POINTS as f64 / rays_s,
            mean_svf(&by_rays),
            1e3 * depths_s,
            POINTS as f64 / maps_s,
            mean_svf(&by_maps)
        );
    }
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let begin = Instant::now();
    let made = work();
    (begin.elapsed().as_secs_f64(), made)
}

/// The median time of the runs, and what the last one made.
fn median<T>(work: impl Fn() -> T) -> (f64, T) {
    let mut runs: Vec<(f64, T)> = (0..RUNS).map(|_| timed(&work)).collect();
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    runs.swap_remove(RUNS / 2)
}

fn mean_svf(found: &[Exposure]) -> f64 {
    found.iter().map(|exposure| exposure.svf).sum::<f64>() / found.len() as f64
}

/// A rectangle in space that looks along `across x up`: its lower left corner and its sides, metres.
#[derive(Clone, Copy)]
struct Side {
    corner_m: Vec3,
    across_m: Vec3,
    up_m: Vec3,
}

impl Side {
    fn normal(&self) -> Vec3 {
        self.across_m.cross(self.up_m).normalize()
    }

    fn area_m2(&self) -> f32 {
        self.across_m.length() * self.up_m.length()
    }

    /// A point of it by shares of its sides, lifted.
    fn at(&self, across: f32, up: f32, off_m: f32) -> Vec3 {
        self.corner_m + across * self.across_m + up * self.up_m + off_m * self.normal()
    }
}

/// The four walls of each house and its roof.
fn sides() -> Vec<Side> {
    let half_m = HOUSES as f32 * PLOT_M / 2.0;
    let mut sides = Vec::new();
    for house in 0..HOUSES * HOUSES {
        let [x, y] = [house % HOUSES, house / HOUSES].map(|at| at as f32 * PLOT_M - half_m + STREET_M / 2.0);
        let (wide_m, high_m) = (PLOT_M - STREET_M, 8.0 + 18.0 * dice(house, 0));
        let corner = |right: f32, back: f32, z: f32| Vec3::new(x + right * wide_m, y + back * wide_m, z);
        let (east, north, up) = (Vec3::X * wide_m, Vec3::Y * wide_m, Vec3::Z * high_m);
        sides.extend([
            Side { corner_m: corner(0.0, 0.0, 0.0), across_m: east, up_m: up },
            Side { corner_m: corner(1.0, 0.0, 0.0), across_m: north, up_m: up },
            Side { corner_m: corner(1.0, 1.0, 0.0), across_m: -east, up_m: up },
            Side { corner_m: corner(0.0, 1.0, 0.0), across_m: -north, up_m: up },
            Side { corner_m: corner(0.0, 0.0, high_m), across_m: east, up_m: north },
        ]);
    }
    sides
}

/// The city, of about so many triangles.
fn city(faces: usize) -> Mesh {
    let sides = sides();
    let area_m2: f32 = sides.iter().map(Side::area_m2).sum();
    let half_m = HOUSES as f32 * PLOT_M / 2.0 + 50.0;
    let ground = Side {
        corner_m: Vec3::new(-half_m, -half_m, 0.0),
        across_m: Vec3::X * 2.0 * half_m,
        up_m: Vec3::Y * 2.0 * half_m,
    };
    let mut mesh = Mesh::default();
    push(&mut mesh, &ground);
    sides.iter().for_each(|side| push(&mut mesh, side));

    // Boxes without a back, ten triangles each, in the middle of the cells of a grid on every side.
    let boxes = faces.saturating_sub(mesh.triangles.len()) as f32 / 10.0;
    for side in &sides {
        let cell_m = (area_m2 / boxes.max(1.0)).sqrt();
        let [columns, rows] = [side.across_m, side.up_m].map(|along| (along.length() / cell_m).round() as usize);
        let relief_m = (RELIEF_SHARE * cell_m).min(RELIEF_M);
        for cell in 0..columns * rows {
            relief(&mut mesh, side, [columns, rows], cell, relief_m);
        }
    }
    mesh
}

/// A box that sticks out of a cell, half as wide and high as that.
fn relief(mesh: &mut Mesh, side: &Side, [columns, rows]: [usize; 2], cell: usize, relief_m: f32) {
    let [left, low] =
        [(cell % columns, columns), (cell / columns, rows)].map(|(at, of)| (at as f32 + 0.25) / of as f32);
    let (wide, high) = (0.5 * side.across_m / columns as f32, 0.5 * side.up_m / rows as f32);
    let (foot, out) = (side.at(left, low, 0.0), relief_m * side.normal());
    let front = Side { corner_m: foot + out, across_m: wide, up_m: high };
    push(mesh, &front);
    // Below, above, and on both sides.
    push(mesh, &Side { corner_m: foot, across_m: wide, up_m: out });
    push(mesh, &Side { corner_m: foot + high + out, across_m: wide, up_m: -out });
    push(mesh, &Side { corner_m: foot + out, across_m: high, up_m: -out });
    push(mesh, &Side { corner_m: foot + wide, across_m: high, up_m: out });
}

fn push(mesh: &mut Mesh, side: &Side) {
    let first = mesh.positions_m.len() as u32;
    mesh.positions_m
        .extend([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(across, up)| side.at(across, up, 0.0)));
    mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    mesh.material_of.extend([0, 0]);
}

/// Points before walls and over roofs by the side's number, every third one over the ground before it.
fn points() -> Vec<Point> {
    let sides = sides();
    let point = |number: usize| {
        let side = &sides[number * 7 % sides.len()];
        let [across, up] = [1, 2].map(|roll| 0.02 + 0.96 * dice(number, roll));
        let normal = side.normal();
        if number.is_multiple_of(3) && normal.z < 0.5 {
            let foot_m = side.at(across, 0.0, 0.2 + (STREET_M - 0.4) * up);
            return Point { position_m: foot_m + OFF_M * Vec3::Z, normal: Some(Vec3::Z) };
        }
        Point { position_m: side.at(across, up, OFF_M), normal: Some(normal) }
    };
    (0..POINTS).map(point).collect()
}

/// A number from 0 to 1 for a thing, without a pattern (SplitMix64's mixing, Steele, Lea & Flood 2014).
fn dice(thing: usize, roll: u64) -> f32 {
    let mut bits = (thing as u64 * 8 + roll).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 40) as f32 / (1 << 24) as f32
}
