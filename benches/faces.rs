//! Does exposure cost more where a city has more faces?
//!
//!     cargo bench --bench faces [-- MOST_THOUSANDS] [FOLDER]
//!
//! A made city of 300 x 300 m with 7,000 to 770,000 faces (or up to about so many thousands): always the same 144 houses, of 8 to
//! 26 m, and on their walls and roofs ever smaller boxes, so that what is seen of the sky hardly changes. 10,000 points, the
//! same in all of them, half a metre before walls, over roofs and over the ground. For each: the time that is needed before
//! the first point (the rays' tree; the zenith's depth map), points a second by rays (256 suns, 256 directions) and by maps
//! (16 directions of 16 samples, peeled), and the mean sky view factor of both. Medians of three runs, clear year at 42
//! degrees north. Into a folder that is named go the chart and the table of all that, `faces.svg` and `faces.csv`.

use glam::Vec3;
use lightvein::daylight::cast::{Asked, Casting, cast};
use lightvein::daylight::scales::sight::Overhangs;
use lightvein::daylight::scales::sums::SkySums;
use lightvein::daylight::scales::zenith::Zenith;
use lightvein::daylight::scales::{Scan, expose};
use lightvein::daylight::{Exposure, Point};
use lightvein::export::chart::loglog::{self, Mark, Panel};
use lightvein::export::whole_file;
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::{Mesh, Scene, Site};
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::Instant;

const RUNS: usize = 3;
const POINTS: usize = 10_000;
const FACES: [usize; 6] = [4_000, 16_000, 50_000, 100_000, 250_000, 800_000];

/// Houses a side, the square that each stands in, and what of it is street, metres.
const HOUSES: usize = 12;
const PLOT_M: f32 = 25.0;
const STREET_M: f32 = 9.0;

/// Ground beyond them. With 50 m a plot would be 64 texels of the map, and all walls would miss their texels' middles alike.
const GROUND_M: f32 = 46.3;

/// How far the points stand off; relief sticks out less.
const OFF_M: f32 = 0.5;

/// Depth of the relief: that share of a cell's side, and no more than so much.
const RELIEF_SHARE: f32 = 0.2;
const RELIEF_M: f32 = 0.3;

/// What is measured of a city.
struct Row {
    faces: usize,
    tree_s: f64,
    rays_s: f64,
    rays_svf: f64,
    depths_s: f64,
    maps_s: f64,
    maps_svf: f64,
}

fn main() {
    let (counts, others): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).filter(|arg| !arg.starts_with("--")).partition(|arg| arg.parse::<usize>().is_ok());
    let most = counts.first().and_then(|count| count.parse::<usize>().ok()).map_or(usize::MAX, |most| 1000 * most);
    let rows = rows(most);
    if let Some(folder) = others.first().map(PathBuf::from) {
        whole_file(&folder.join("faces.svg"), |out| draw(out, &rows)).unwrap();
        whole_file(&folder.join("faces.csv"), |out| write_table(out, &rows)).unwrap();
    }
}

/// Measures the cities of up to so many faces, and tells them.
fn rows(most: usize) -> Vec<Row> {
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
    let cities = FACES.into_iter().filter(|&faces| faces <= most);
    let row = |faces: usize| {
        let scene = Scene { mesh: city(faces), ..Scene::default() };
        let (tree_s, rays) = median(|| Rays::new(&scene));
        let casting = Casting { sun_rays: Some(256), sky_rays: 256, seed: 0 };
        let (rays_s, by_rays) = median(|| cast(&rays, &points, &map, 0.0, casting, &Quiet, &Cancel::new()).unwrap());
        let (depths_s, zenith) = median(|| Zenith::new(&scene, 1024, true, &Cancel::new()).unwrap());
        let scan = Scan { samples: 16, reach_m: None, overhangs: Overhangs::Peeled, seed: 0 };
        let (maps_s, by_maps) =
            median(|| expose(&zenith, &sums, Asked::all(&points), &scan, &Quiet, &Cancel::new()).unwrap());
        let faces = scene.mesh.triangles.len();
        let [rays_svf, maps_svf] = [&by_rays, &by_maps].map(|found| mean_svf(found));
        println!(
            "{faces:>8} {:>9.1} {:>10.0} {rays_svf:>7.4} {:>11.1} {:>10.0} {maps_svf:>7.4}",
            1e3 * tree_s,
            POINTS as f64 / rays_s,
            1e3 * depths_s,
            POINTS as f64 / maps_s,
        );
        Row { faces, tree_s, rays_s, rays_svf, depths_s, maps_s, maps_svf }
    };
    cities.map(row).collect()
}

/// Cost of a point, and of what is made beforehand, against faces.
fn draw(out: &mut dyn Write, rows: &[Row]) -> io::Result<()> {
    let marks = |series: &str, cost: fn(&Row) -> f64| {
        let mark = |row: &Row| Mark {
            series: series.to_owned(),
            label: String::new(),
            at: [row.faces as f64, cost(row)],
            is_hollow: false,
        };
        rows.iter().map(mark).collect::<Vec<_>>()
    };
    let panel = |title: &str, unit: &str, marks: [Vec<Mark>; 2]| Panel {
        title: title.to_owned(),
        axes: ["faces".to_owned(), unit.to_owned()],
        marks: marks.concat(),
        has_front: false,
    };
    let [rays, maps] = ["rays (256 suns + 256 directions; tree)", "maps (layers, 16 x 16; depths of 1024 texels)"];
    let each =
        [marks(rays, |row| 1e6 * row.rays_s / POINTS as f64), marks(maps, |row| 1e6 * row.maps_s / POINTS as f64)];
    let once = [marks(rays, |row| 1e3 * row.tree_s), marks(maps, |row| 1e3 * row.depths_s)];
    let panels = [panel("a point", "microseconds a point", each), panel("made beforehand, once", "milliseconds", once)];
    loglog::write(out, &panels, 2, "10,000 points in a made city, the same in all; lower is better")
}

/// A row a city; points a second, seconds beforehand, mean sky view factors.
fn write_table(out: &mut dyn Write, rows: &[Row]) -> io::Result<()> {
    writeln!(out, "faces,tree_s,rays_per_s,rays_svf,depths_s,maps_per_s,maps_svf")?;
    for Row { faces, tree_s, rays_s, rays_svf, depths_s, maps_s, maps_svf } in rows {
        let [rays_per_s, maps_per_s] = [rays_s, maps_s].map(|seconds| POINTS as f64 / seconds);
        writeln!(out, "{faces},{tree_s:.4},{rays_per_s:.0},{rays_svf:.4},{depths_s:.4},{maps_per_s:.0},{maps_svf:.4}")?;
    }
    Ok(())
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
    let half_m = HOUSES as f32 * PLOT_M / 2.0 + GROUND_M;
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
