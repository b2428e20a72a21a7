//! Rays a second: closest hits and clear views between random points among 100,000 triangles, incoherent, one thread and
//! all. Run with `cargo bench --bench rays`.

use glam::Vec3;
use lightvein::rays::Rays;
use lightvein::scene::{Material, Mesh, Scene};
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;

const RAYS: u32 = 1_000_000;

fn main() {
    let scene = columns(58);
    let started = Instant::now();
    let rays = Rays::new(&scene);
    println!("{} triangles built in {:.3} s", scene.mesh.triangles.len(), started.elapsed().as_secs_f64());

    for threads in [1, rayon::current_num_threads()] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let closest = pool.install(|| {
            seconds(|ray| {
                let (from, to) = ends(ray);
                black_box(rays.closest(from, (to - from).normalize_or(Vec3::X), f32::INFINITY));
            })
        });
        let clear = pool.install(|| {
            seconds(|ray| {
                let (from, to) = ends(ray);
                black_box(rays.clear(from, to));
            })
        });
        let rate = |seconds: f64| f64::from(RAYS) / seconds / 1e6;
        println!("{threads} threads: closest {:.2} Mrays/s, clear {:.2} Mrays/s", rate(closest), rate(clear));
    }
}

fn seconds(work: impl Fn(u32) + Sync + Send) -> f64 {
    let started = Instant::now();
    (0..RAYS).into_par_iter().with_min_len(4096).for_each(work);
    started.elapsed().as_secs_f64()
}

/// Two points in the hall, the same for every run.
fn ends(ray: u32) -> (Vec3, Vec3) {
    let number = |at: u64| (mixed(6 * u64::from(ray) + at) >> 40) as f32 / (1 << 24) as f32;
    let point =
        |first: u64| Vec3::new(number(first), number(first + 1), number(first + 2)) * Vec3::new(58.0, 58.0, 4.0);
    (point(0), point(3))
}

/// SplitMix64's output function.
fn mixed(at: u64) -> u64 {
    let mut bits = at.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// A closed hall with a turned column of 15 sides in every square metre: 30 triangles each.
fn columns(side: u32) -> Scene {
    let mut mesh = Mesh::default();
    let size = Vec3::new(side as f32, side as f32, 4.0);
    let mut wall = |a: Vec3, u: Vec3, v: Vec3| {
        for corners in [[a, a + u, a + u + v], [a, a + u + v, a + v]] {
            let first = mesh.positions_m.len() as u32;
            mesh.positions_m.extend(corners);
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.material_of.push(0);
        }
    };
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    for (a, u, v) in [(Vec3::ZERO, x, y), (z, x, y), (Vec3::ZERO, x, z), (y, x, z), (Vec3::ZERO, y, z), (x, y, z)] {
        wall(a, u, v);
    }
    for column in 0..side * side {
        let centre = Vec3::new((column % side) as f32 + 0.5, (column / side) as f32 + 0.5, 0.0);
        let rim = |step: u32| {
            let angle = (step as f32 / 15.0 + column as f32 * 0.37) * std::f32::consts::TAU;
            centre + 0.12 * Vec3::new(angle.cos(), angle.sin(), 0.0)
        };
        for step in 0..15 {
            wall(rim(step), rim((step + 1) % 15) - rim(step), z);
        }
    }
    let material = Material { name: String::new(), reflectance: 0.5, transmittance: 0.0, emission_w_m2_sr: 0.0 };
    Scene { mesh, materials: vec![material], ..Scene::default() }
}
