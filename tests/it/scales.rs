//! Exposure by maps, at one scale and at two: closed forms, Radiance's sky view factors, rays, and the choice among ways.

use super::program::{run, text};
use glam::Vec3;
use lightvein::daylight::camera::{Buffers, Camera};
use lightvein::daylight::cast::{Asked, Casting, cast};
use lightvein::daylight::choose::{choose, error};
use lightvein::daylight::scales::pixels::taps::Taps;
use lightvein::daylight::scales::pixels::{Combination, Look, Part, PixelSums, Received, Surfaces, TURNS, see};
use lightvein::daylight::scales::sight::Overhangs;
use lightvein::daylight::scales::sums::SkySums;
use lightvein::daylight::scales::zenith::Zenith;
use lightvein::daylight::scales::{Scan, expose};
use lightvein::daylight::way::{Fineness, Ground, Way};
use lightvein::daylight::{Exposure, Point, points};
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::{Mesh, Scene, Site};
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::steps::Period;
use std::collections::HashMap;
use std::path::Path;

/// The sky of a clear year at 42 degrees north.
fn map() -> ExposureMap {
    let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
    let outdoors = Outdoors::of(&site, None).unwrap();
    let steps = Outdoors { period: Period { step_min: 60.0, ..Period::YEAR }, ..outdoors }.steps().unwrap();
    let settings = MapSettings { size: [256, 256], model: SkyModel::Hosek, ..MapSettings::default() };
    ExposureMap::build(&steps, &settings, &Quiet, &Cancel::new()).unwrap()
}

fn outdoor(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/outdoor/{name}/{name}.toml"));
    Scene::load(&path, &Quiet, &Cancel::new()).unwrap()
}

fn by_maps(scene: &Scene, map: &ExposureMap, asked: &[Point], fineness: Fineness) -> Vec<Exposure> {
    let Fineness { texels, directions, samples, overhangs } = fineness;
    let zenith = Zenith::new(scene, texels, overhangs == Overhangs::Peeled, &Cancel::new()).unwrap();
    let sums = SkySums::new(map, 0.0, directions, (128 / directions).max(1));
    let scan = Scan { samples, reach_m: None, overhangs, seed: 0 };
    expose(&zenith, &sums, Asked::all(asked), &scan, &Quiet, &Cancel::new()).unwrap()
}

const FINE: Fineness = Fineness { texels: 2048, directions: 64, samples: 64, overhangs: Overhangs::Peeled };

/// Quads as a scene, each by its corners, counter-clockwise from its front.
fn quads(all: &[[[f32; 3]; 4]]) -> Scene {
    let mut mesh = Mesh::default();
    for corners in all {
        let first = mesh.positions_m.len() as u32;
        mesh.positions_m.extend(corners.map(Vec3::from_array));
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        mesh.material_of.extend([0, 0]);
    }
    Scene { mesh, ..Scene::default() }
}

/// A level rectangle that looks up.
fn level([x0, y0, x1, y1]: [f32; 4], z: f32) -> [[f32; 3]; 4] {
    [[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]]
}

fn at(position_m: [f32; 3], normal: Vec3) -> Point {
    Point { position_m: Vec3::from_array(position_m), normal: Some(normal) }
}

#[test]
fn a_canyon_and_a_wall_have_their_closed_forms() {
    // A street 20 m wide between roofs 10 m high, 2 km long.
    let street = quads(&[
        level([-10.0, -1000.0, 10.0, 1000.0], 0.0),
        level([-60.0, -1000.0, -10.0, 1000.0], 10.0),
        level([10.0, -1000.0, 60.0, 1000.0], 10.0),
    ]);
    let map = map();
    let (h, w) = (10.0_f64, 10.0_f64);
    // Cosine-weighted, of an endless canyon: the sine of the angle up to the edge, to either side.
    let floor = w.hypot(h).recip() * w;
    // A wall sees the sky over the other side: (1 - sin of the angle) / 2.
    let wall = |z: f64| (1.0 - (10.0 - z) / (10.0 - z).hypot(20.0)) / 2.0;
    let asked = [
        (at([0.0, 0.0, 0.0], Vec3::Z), floor),
        (at([-10.0, 3.0, 5.0], Vec3::X), wall(5.0)),
        (at([10.0, 3.0, 0.5], Vec3::NEG_X), wall(0.5)),
        (at([-40.0, 3.0, 10.0], Vec3::Z), 1.0),
    ];
    let points: Vec<Point> = asked.iter().map(|(point, _)| *point).collect();
    for overhangs in [Overhangs::Ignored, Overhangs::Opening, Overhangs::Peeled] {
        let fineness = Fineness { texels: 8192, directions: 128, samples: 256, overhangs };
        for (found, (_, expected)) in by_maps(&street, &map, &points, fineness).iter().zip(&asked) {
            assert!((found.svf - expected).abs() < 0.01, "{overhangs:?}: {} against {expected}", found.svf);
        }
    }
    let open = quads(&[level([-50.0, -50.0, 50.0, 50.0], 0.0)]);
    let asked = [at([0.0, 0.0, 0.0], Vec3::Z), at([0.0, 0.0, 1.0], Vec3::X), at([0.0, 0.0, 1.0], Vec3::NEG_Z)];
    let found = by_maps(&open, &map, &asked, Fineness { directions: 16, samples: 16, ..FINE });
    for (found, expected) in found.iter().zip([1.0, 0.5, 0.0]) {
        assert!((found.svf - expected).abs() < 0.003, "{} against {expected}", found.svf);
    }
    assert!((found[0].beam_kwh_m2 + found[0].sky_kwh_m2 - map.totals.ghi_kwh_m2).abs() < 0.003 * map.totals.ghi_kwh_m2);
}

#[test]
fn the_well_has_its_closed_forms() {
    let scene = outdoor("courtyard");
    let found = by_maps(&scene, &map(), &points(&scene.sensors), FINE);
    let expected =
        [("court_centre", 0.23949), ("court_side", 0.19960), ("court_corner", 0.14141), ("court_half_way_up", 0.55413)];
    for (id, expected) in expected {
        let place = scene.sensors.iter().position(|sensor| sensor.id == id).expect("the sensor");
        assert!((found[place].svf - expected).abs() < 0.02, "{id}: {} against {expected}", found[place].svf);
    }
}

/// Mean absolute error of sky view factors against Radiance's.
fn svf_error(name: &str, fineness: Fineness, map: &ExposureMap) -> f64 {
    let scene = outdoor(name);
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/outdoor/{name}/svf.csv"));
    let table = std::fs::read_to_string(table).unwrap();
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1).filter_map(|line| line.split_once(','));
    let truth: HashMap<&str, f64> = rows.map(|(id, svf)| (id, svf.parse().unwrap())).collect();
    let found = by_maps(&scene, map, &points(&scene.sensors), fineness);
    let errors = scene.sensors.iter().zip(&found).map(|(sensor, found)| (found.svf - truth[sensor.id.as_str()]).abs());
    errors.sum::<f64>() / found.len() as f64
}

/// The paper's figure 4: what the opening angle and the layers gain.
#[test]
fn openings_and_layers_bring_sky_view_factors_near_radiance_s() {
    let map = map();
    let of = |name: &str, overhangs: Overhangs| svf_error(name, Fineness { overhangs, ..FINE }, &map);
    for (name, bound) in [("blocks", 0.02), ("arcades", 0.03)] {
        let [ignored, opening, peeled] =
            [Overhangs::Ignored, Overhangs::Opening, Overhangs::Peeled].map(|overhangs| of(name, overhangs));
        println!("{name}: {ignored:.4} as a height field, {opening:.4} with opening angles, {peeled:.4} peeled");
        assert!(peeled <= bound, "{name}: {peeled}");
        if name == "arcades" {
            assert!(opening < 0.9 * ignored && peeled < 0.2 * opening, "{ignored} {opening} {peeled}");
        }
    }
}

/// A view of a scene from 45 degrees above, and what rays find in some of its pixels.
struct View {
    surfaces: Surfaces,
    checked: Vec<usize>,
    truth: Vec<Exposure>,
}

impl View {
    fn of(scene: &Scene, map: &ExposureMap, from_m: [f32; 3]) -> Self {
        let rays = Rays::new(scene);
        let camera = Camera::new(Vec3::from_array(from_m), Vec3::new(0.0, 0.0, -4.0), 0.8, [320, 240]).unwrap();
        let buffers = Buffers::render(&rays, &camera, &Quiet, &Cancel::new()).unwrap();
        let hit: Vec<usize> = (0..320 * 240).filter(|&pixel| buffers.point(pixel).is_some()).collect();
        let checked: Vec<usize> = (0..150).map(|number| hit[number * 7919 % hit.len()]).collect();
        let points: Vec<Point> = checked.iter().filter_map(|&pixel| buffers.point(pixel)).collect();
        let casting = Casting { sun_rays: Some(512), sky_rays: 1024, seed: 0 };
        let truth = cast(&rays, &points, map, 0.0, casting, &Quiet, &Cancel::new()).unwrap();
        Self { surfaces: Surfaces::new(&buffers), checked, truth }
    }

    fn seen(&self, scene: &Scene, map: &ExposureMap, look: &Look) -> Vec<Received> {
        let sums = SkySums::new(map, 0.0, 16, TURNS);
        let taps = Taps::new(&Zenith::new(scene, 1024, false, &Cancel::new()).unwrap(), &sums, look);
        see(&taps, &PixelSums::new(&sums, Part::All).unwrap(), &self.surfaces, look, &Cancel::new()).unwrap()
    }

    fn svf_error(&self, seen: &[Received]) -> f64 {
        let pairs = self.checked.iter().zip(&self.truth);
        pairs.map(|(&pixel, truth)| (f64::from(seen[pixel].svf) - truth.svf).abs()).sum::<f64>()
            / self.truth.len() as f64
    }
}

fn look(combination: Combination, opening: bool) -> Look {
    Look { samples: 16, reach_m: None, opening, combination, fine_samples: 16, fine_reach_m: 3.0, smooth: false }
}

/// Seen from a window across the street, where the map of heights knows little of what is under balconies and bridges.
#[test]
fn two_scales_of_a_view_are_nearer_to_rays_than_one() {
    let (scene, map) = (outdoor("arcades"), map());
    let view = View::of(&scene, &map, [-18.0, -16.0, 3.0]);
    let error = |combination, opening| view.svf_error(&view.seen(&scene, &map, &look(combination, opening)));
    let height_field = error(Combination::Large, false);
    let [large, weighted, intersected] = [Combination::Large, Combination::Weighted, Combination::Intersected]
        .map(|combination| error(combination, true));
    println!("height field {height_field:.4}, large {large:.4}, weighted {weighted:.4}, intersected {intersected:.4}");
    assert!(large < height_field, "{large} {height_field}");
    assert!(intersected < large && weighted < large, "{large} {weighted} {intersected}");
}

#[test]
fn a_fine_scale_hides_and_never_adds() {
    let (scene, map) = (outdoor("blocks"), map());
    let view = View::of(&scene, &map, [60.0, -90.0, 50.0]);
    let large = view.seen(&scene, &map, &look(Combination::Large, true));
    for combination in [Combination::Weighted, Combination::Intersected] {
        let both = view.seen(&scene, &map, &look(combination, true));
        let most = |of: fn(&Received) -> f32| {
            both.iter().zip(&large).map(|(both, large)| of(both) - of(large)).fold(0.0, f32::max)
        };
        let [svf, total_kwh_m2] = [most(|seen| seen.svf), most(|seen| seen.total_kwh_m2)];
        println!("{combination:?}: at most {svf} and {total_kwh_m2} kWh/m2 more");
        // A sector is wide: its middle may be before the plane of a surface where its edge is behind.
        assert!(svf <= 1e-4 && total_kwh_m2 <= 0.001 * map.totals.ghi_kwh_m2 as f32, "{svf} {total_kwh_m2}");
        assert!(both.iter().zip(&large).any(|(both, large)| both.svf < 0.9 * large.svf), "{combination:?}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (scene, map) = (outdoor("arcades"), map());
    let asked: Vec<Point> = points(&scene.sensors).into_iter().step_by(5).collect();
    let view = View::of(&scene, &map, [-18.0, -16.0, 3.0]);
    let both = Look { smooth: true, ..look(Combination::Intersected, true) };
    let all = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (by_maps(&scene, &map, &asked, FINE), view.seen(&scene, &map, &both)))
    };
    assert!(all(1) == all(3));
}

#[test]
fn the_cheapest_way_inside_the_tolerance_is_taken() {
    let map = map();
    let chosen = |scene: &Scene, asked: &[Point], tolerance: f64| {
        let rays = Rays::new(scene);
        let ground = Ground { scene, rays: &rays, map: &map, north_rad: 0.0, seed: 0 };
        let asked = Asked::all(asked);
        let chosen = choose(&ground, asked, None, &Way::for_points(0), tolerance, &Quiet, &Cancel::new()).unwrap();
        let found = chosen.way.ask(&ground, asked, None, &Quiet, &Cancel::new()).unwrap();
        let truth = Way::Rays(Casting { sun_rays: Some(2048), sky_rays: 2048, seed: 9 });
        let truth = truth.prepare(&ground, &Cancel::new()).unwrap().ask(&ground, asked, None, &Quiet, &Cancel::new());
        (chosen.way.way, error(&found, &truth.unwrap()))
    };
    // Many points on an open field: the share of the sky that is seen says it all.
    let field = quads(&[level([-50.0, -50.0, 50.0, 50.0], 0.0)]);
    let many: Vec<Point> =
        (0..2000).map(|n| at([(n % 50) as f32 - 25.0, (n / 50) as f32 - 20.0, 0.0], Vec3::Z)).collect();
    let (way, off) = chosen(&field, &many, 1.02);
    assert!(way == Way::Isotropic && off < 0.02, "{way:?} {off}");

    let scene = outdoor("blocks");
    let own = points(&scene.sensors);
    for tolerance in [1.02, 1.01, 1.001] {
        let (way, off) = chosen(&scene, &own, tolerance);
        println!("{tolerance}: {}, {:.2}% off", way.words(), 100.0 * off);
        assert!(off < 1.2 * (tolerance - 1.0) + 0.003, "{way:?}: {off}");
    }
    assert_eq!(chosen(&scene, &own[..4], 1.001).0, Way::for_points(0)[5]);
}

#[test]
fn expose_says_which_way_it_took_and_takes_the_one_that_is_named() {
    let scene = "scenes/outdoor/courtyard/courtyard.toml";
    let told = |more: &[&str]| -> serde_json::Value {
        let output = run(&[&["expose", scene, "--json", "--step", "120"], more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let by_tolerance = told(&["--tolerance", "1.05"]);
    assert!(by_tolerance["tried"].as_array().is_some_and(|tried| !tried.is_empty()));
    assert!(by_tolerance["tried"].as_array().unwrap().last().unwrap()["error"].as_f64().unwrap() <= 0.05);
    for method in ["isotropic", "maps", "rays"] {
        let named = told(&["--method", method]);
        assert_eq!(named["method"], method);
        assert!(named["tried"].is_null() && named["sensors"][0]["total"].as_f64().unwrap() > 0.0);
    }
    for wrong in [
        &["--tolerance", "0.9"][..],
        &["--tolerance", "1.1", "--method", "rays"],
        &["--method", "maps", "--sun-rays", "8"],
        &["--method", "light"],
    ] {
        let output = run(&[&["expose", scene], wrong].concat());
        assert!(!output.status.success() && output.stdout.is_empty(), "{wrong:?}");
    }
}
