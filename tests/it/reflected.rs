//! What surfaces reflect of sun and sky, against closed forms, a plain walk of light, laws of physics, and Radiance.

use super::modelled;
use super::program::{run, text};
use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::reflect::skylight::Skylight;
use lightvein::daylight::reflect::{self, Reflected};
use lightvein::daylight::{Exposure, Point, points};
use lightvein::flow::network::Quality;
use lightvein::flow::sequence;
use lightvein::job::{Cancel, Quiet};
use lightvein::light::Status;
use lightvein::model::Model;
use lightvein::model::walls::Answer;
use lightvein::rays::{Rays, Surface};
use lightvein::scene::{Material, Mesh, Scene, Sensor, Site};
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::steps::{Period, Steps};
use lightvein::sky::weather::Weather;
use lightvein::sky::{azimuth_elevation_rad, towards};
use std::collections::HashMap;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;

use glam::Vec3;

/// A scene under construction.
#[derive(Default)]
struct Built(Scene);

impl Built {
    fn material(mut self, reflectance: f32, transmittance: f32) -> Self {
        let name = self.0.materials.len().to_string();
        self.0.materials.push(Material { name, reflectance, transmittance, emission_w_m2_sr: 0.0 });
        self
    }

    fn triangle(&mut self, material: u32, corners_m: [Vec3; 3]) {
        let mesh: &mut Mesh = &mut self.0.mesh;
        let first = mesh.positions_m.len() as u32;
        mesh.positions_m.extend(corners_m);
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.material_of.push(material);
    }

    /// A parallelogram, seen from its front counter-clockwise.
    fn quad(mut self, material: u32, corner_m: [f32; 3], u_m: [f32; 3], v_m: [f32; 3]) -> Self {
        let [a, u, v] = [corner_m, u_m, v_m].map(Vec3::from_array);
        self.triangle(material, [a, a + u, a + u + v]);
        self.triangle(material, [a, a + u + v, a + v]);
        self
    }

    fn sensor(mut self, at_m: [f32; 3], normal: [f32; 3]) -> Self {
        let normal = Some(Vec3::from_array(normal)).filter(|normal| *normal != Vec3::ZERO);
        let id = self.0.sensors.len().to_string();
        self.0.sensors.push(Sensor { id, position_m: Vec3::from_array(at_m), normal });
        self
    }
}

/// A clear year at 42 degrees north.
fn map(model: SkyModel) -> ExposureMap {
    let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
    let outdoors = Outdoors::of(&site, None).unwrap();
    let steps = Outdoors { period: Period { step_min: 120.0, ..Period::YEAR }, ..outdoors }.steps().unwrap();
    let settings = MapSettings { size: [256, 256], model, ..MapSettings::default() };
    ExposureMap::build(&steps, &settings, &Quiet, &Cancel::new()).unwrap()
}

/// The same year without its sun: an even sky.
fn even_sky() -> ExposureMap {
    let map = map(SkyModel::Isotropic);
    let totals = lightvein::sky::steps::Totals { dni_kwh_m2: 0.0, ghi_kwh_m2: map.totals.dhi_kwh_m2, ..map.totals };
    ExposureMap { suns: Vec::new(), direct_kwh_m2: vec![0.0; map.direct_kwh_m2.len()], totals, ..map }
}

const CASTING: Casting = Casting { sun_rays: Some(512), sky_rays: 4096, seed: 1 };

fn daylit(scene: &Scene, voxel_m: f32, map: &ExposureMap, quality: &Quality) -> (Vec<Exposure>, Vec<Reflected>) {
    let rays = Arc::new(Rays::new(scene));
    let model = Model::build(scene, rays.clone(), voxel_m, u64::MAX, &Quiet, &Cancel::new()).unwrap();
    let points = points(&scene.sensors);
    let mut found = cast(&rays, &points, map, 0.0, CASTING, &Quiet, &Cancel::new()).unwrap();
    let light = Skylight::new(map, 0.0);
    let reflected = reflect::by_network(&model, &points, &light, quality, CASTING, &Quiet, &Cancel::new()).unwrap();
    reflect::add(&mut found, &reflected);
    (found, reflected)
}

#[track_caller]
fn near(value: f64, expected: f64, share: f64, what: &str) {
    assert!((value - expected).abs() <= share * expected.abs(), "{what}: {value} against {expected}");
}

/// A sphere of triangles, seen from inside, open above `rim` of its radius; the share of the whole that is wall.
fn bowl(radius_m: f32, rim: f64, reflectance: f32) -> (Built, f64) {
    let mut built = Built::default().material(reflectance, 0.0);
    let (rings, sectors) = (36, 72);
    let at = |ring: usize, sector: usize| {
        // Equal steps of angle from the nadir up to the rim.
        let angle = rim.acos() + (PI - rim.acos()) * (1.0 - ring as f64 / rings as f64);
        let turn = 2.0 * PI * (sector % sectors) as f64 / sectors as f64;
        radius_m * Vec3::new((angle.sin() * turn.cos()) as f32, (angle.sin() * turn.sin()) as f32, angle.cos() as f32)
    };
    for ring in 0..rings {
        for sector in 0..sectors {
            let [a, b, c, d] = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(up, on)| at(ring + up, sector + on));
            built.triangle(0, [a, c, b]);
            built.triangle(0, [a, d, c]);
        }
    }
    (built, (1.0 + rim) / 2.0)
}

/// Inside a sphere every piece of wall sees every other by its area alone, so under an even sky all of it is lit alike:
/// `E0 = pi L f` through an opening of share `f`, and `E = E0 / (1 - rho (1 - f))`.
#[test]
fn a_sphere_with_an_opening_has_its_closed_form() {
    let sky = even_sky();
    for (rim, reflectance) in [(0.6, 0.5), (0.9, 0.5), (0.9, 0.8)] {
        let (built, wall) = bowl(3.0, rim, reflectance);
        let built = built.sensor([0.0, 0.0, -2.98], [0.0, 0.0, 1.0]).sensor([2.98, 0.0, 0.0], [-1.0, 0.0, 0.0]);
        let (found, reflected) = daylit(&built.0, 0.15, &sky, &Quality::MEDIUM);
        let straight = sky.totals.dhi_kwh_m2 * (1.0 - wall);
        let rho = f64::from(reflectance) * wall;
        for (exposure, reflected) in found.iter().zip(&reflected) {
            near(exposure.sky_kwh_m2, straight, 0.04, "straight");
            near(exposure.reflected_kwh_m2, straight * rho / (1.0 - rho), 0.05, "reflected");
            let off = (exposure.reflected_kwh_m2 - straight * rho / (1.0 - rho)).abs();
            assert!(off < 4.0 * reflected.error_kwh_m2 + 0.01 * straight, "its own error: {off} {reflected:?}");
        }
    }
}

fn ground(half_m: f32, reflectance: f32) -> Built {
    let side = 2.0 * half_m;
    Built::default().material(reflectance, 0.0).quad(0, [-half_m, -half_m, 0.0], [side, 0.0, 0.0], [0.0, side, 0.0])
}

#[test]
fn open_ground_sends_nothing_to_itself_and_half_of_it_to_a_wall() {
    let map = map(SkyModel::Perez);
    let built = ground(200.0, 0.4);
    // A post, so that the void has a height.
    let built = built.quad(0, [150.0, 150.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 8.0]);
    let built = built.sensor([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]).sensor([0.0, 0.0, 1.0], [0.0, -1.0, 0.0]);
    let built = built.sensor([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    let (found, reflected) = daylit(&built.0, 1.0, &map, &Quality::MEDIUM);
    let sent = 0.4 * map.totals.ghi_kwh_m2;
    assert!(found[0].reflected_kwh_m2 < 1e-4 * sent, "{:?}", found[0]);
    near(found[1].reflected_kwh_m2, sent / 2.0, 0.02, "a wall");
    near(found[2].reflected_kwh_m2, sent, 0.02, "looking down");
    near(reflected[0].daylight_factor, 1.0, 0.01, "the overcast sky over open ground");
    // (2/3)(pi/4 + 2/3) of the sky over 7 pi / 9, and half of what the ground sends.
    near(reflected[1].daylight_factor, 0.3962 + 0.2, 0.02, "the overcast sky on a wall");
}

/// A room of 6 x 4 x 3 m whose south wall has a window of 2 x 1.2 m, with a pane if `pane`, above ground of its own.
fn room(reflectance: f32, pane: Option<f32>) -> Built {
    let mut built = Built::default().material(reflectance, 0.0).material(0.0, pane.unwrap_or(0.0));
    // Floor, ceiling, west, east, north, seen from inside.
    let [x, y, z] = [[6.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 3.0]];
    for (corner, u, v) in [
        ([0.0, 0.0, 0.0], x, y),
        ([0.0, 0.0, 3.0], y, x),
        ([0.0, 0.0, 0.0], y, z),
        ([6.0, 0.0, 0.0], z, y),
        ([0.0, 4.0, 0.0], x, z),
        // South, around the window.
        ([0.0, 0.0, 0.0], z, [2.0, 0.0, 0.0]),
        ([4.0, 0.0, 0.0], z, [2.0, 0.0, 0.0]),
        ([2.0, 0.0, 0.0], [0.0, 0.0, 1.0], [2.0, 0.0, 0.0]),
        ([2.0, 0.0, 2.2], [0.0, 0.0, 0.8], [2.0, 0.0, 0.0]),
    ] {
        built = built.quad(0, corner, u, v);
    }
    if pane.is_some() {
        built = built.quad(1, [2.0, 0.0, 1.0], [0.0, 0.0, 1.2], [2.0, 0.0, 0.0]);
    }
    built
        .sensor([3.0, 1.0, 0.8], [0.0, 0.0, 1.0])
        .sensor([1.0, 3.5, 0.8], [0.0, 0.0, 1.0])
        .sensor([3.0, 3.0, 2.99], [0.0, 0.0, -1.0])
        .sensor([5.0, 2.0, 1.5], [0.0, 0.0, 0.0])
}

/// Nothing outside sends light back in, so all that comes through the window is weakened alike.
#[test]
fn glazing_weakens_all_that_comes_through_it_by_its_share() {
    let map = map(SkyModel::Perez);
    let (open, _) = daylit(&room(0.5, None).0, 0.1, &map, &Quality::FINE);
    let (glazed, _) = daylit(&room(0.5, Some(0.6)).0, 0.1, &map, &Quality::FINE);
    for (open, glazed) in open.iter().zip(&glazed) {
        assert!(open.reflected_kwh_m2 > 1.0, "{open:?}");
        near(glazed.sky_kwh_m2, 0.6 * open.sky_kwh_m2, 0.06, "sky");
        near(glazed.reflected_kwh_m2, 0.6 * open.reflected_kwh_m2, 0.06, "reflected");
    }
}

#[test]
fn black_walls_reflect_exactly_nothing() {
    let (found, reflected) = daylit(&room(0.0, None).0, 0.1, &map(SkyModel::Perez), &Quality::COARSE);
    assert!(found.iter().all(|exposure| exposure.reflected_kwh_m2 == 0.0));
    assert!(reflected.iter().all(|reflected| reflected.error_kwh_m2 == 0.0 && reflected.daylight_factor < 0.2));
}

#[test]
fn no_light_comes_into_a_sealed_room() {
    let sealed = room(0.8, None).quad(0, [2.0, 0.0, 1.0], [0.0, 0.0, 1.2], [2.0, 0.0, 0.0]);
    let (found, _) = daylit(&sealed.0, 0.1, &map(SkyModel::Perez), &Quality::COARSE);
    assert!(found.iter().all(|exposure| exposure.total_kwh_m2() == 0.0 && exposure.status == Status::Dark), "{found:?}");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (scene, map) = (room(0.5, Some(0.6)).0, map(SkyModel::Perez));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (found, reflected) = pool.install(|| daylit(&scene, 0.1, &map, &Quality::COARSE));
        format!("{found:?} {reflected:?}")
    };
    let one = on(1);
    assert_eq!(one, on(3));
}

/// Sun and sky carried by paths that reflect at every wall, up to `bounces` times; a sun and a direction of the sky at each.
struct Walker<'a> {
    rays: &'a Rays,
    model: &'a Model,
    map: &'a ExposureMap,
    up_to: Vec<f64>,
}

impl<'a> Walker<'a> {
    fn new(model: &'a Model, map: &'a ExposureMap) -> Self {
        let mut sum = 0.0;
        let up_to = map.suns.iter().map(|sun| {
            sum += sun.energy_kwh_m2;
            sum
        });
        Self { rays: &model.rays, model, map, up_to: up_to.collect() }
    }

    fn lands(&self, from_m: Vec3, normal: Vec3, random: [[f64; 2]; 2]) -> f64 {
        let mut sum = 0.0;
        let all = self.up_to.last().copied().unwrap_or(0.0);
        let drawn = self.up_to.partition_point(|&up_to| up_to <= random[0][0] * all);
        if let Some(sun) = self.map.suns.get(drawn) {
            let direction = towards(sun.sun.azimuth_rad, sun.sun.elevation_rad).as_vec3();
            let cosine = f64::from(direction.dot(normal));
            if cosine > 0.0 {
                sum += cosine * all * f64::from(self.rays.from_afar(from_m, direction));
            }
        }
        let direction = sequence::cosine_about(normal, random[1]);
        if direction.z > 0.0 {
            let (azimuth_rad, elevation_rad) = azimuth_elevation_rad(direction.as_dvec3());
            let [column, row] = self.map.texel(azimuth_rad, elevation_rad);
            let energy = f64::from(self.map.diffuse_kwh_m2[row * self.map.size[0] + column]);
            sum += PI * energy / self.map.solid_angle_sr(row) * f64::from(self.rays.from_afar(from_m, direction));
        }
        sum
    }

    /// The reflected part at a point with a normal, and its standard error, kWh/m2.
    fn reflected(&self, point: &Point, paths: u64, bounces: usize, seed: u64) -> (f64, f64) {
        let (mut sum, mut squares) = (0.0, 0.0);
        for path in 0..paths {
            let random = |step: usize| sequence::offset(seed, path << 8 | step as u64);
            let normal = point.normal.unwrap();
            let mut from_m = point.position_m + normal * self.rays.epsilon_m();
            let (mut facing, mut share, mut found, mut step) = (normal, 1.0, 0.0, 0);
            let mut direction = sequence::cosine_about(facing, sequence::square(path as u32, sequence::offset(seed, !0)));
            for bounce in 0..bounces {
                if bounce > 0 {
                    direction = sequence::cosine_about(facing, random(step));
                }
                // Through panes to a wall.
                let hit = loop {
                    let Some(hit) = self.rays.closest(from_m, direction, f32::INFINITY) else { break None };
                    from_m += hit.distance_m * direction;
                    let answer = self.model.walls.answer(hit.surface);
                    if answer.passes <= 0.0 {
                        break Some((hit, answer));
                    }
                    share *= f64::from(answer.passes);
                    from_m -= hit.facing() * self.rays.epsilon_m();
                };
                let Some((hit, Answer { reflects, .. })) = hit else { break };
                assert!(matches!(hit.surface, Surface::Triangle(_)));
                facing = hit.facing();
                from_m += facing * self.rays.epsilon_m();
                share *= f64::from(reflects);
                found += share * self.lands(from_m, facing, [random(step + 1), random(step + 2)]);
                step += 3;
            }
            sum += found;
            squares += found * found;
        }
        let mean = sum / paths as f64;
        (mean, ((squares / paths as f64 - mean * mean) / paths as f64).sqrt())
    }
}

fn rms_factor(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let squares: Vec<f64> = pairs.map(|(found, truth)| (found / truth).log10().powi(2)).collect();
    10_f64.powf((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

/// The network against paths through the same sky, without any weather: sensors in rooms, under arcades, in courts.
#[test]
fn the_network_agrees_with_a_plain_walk_of_light() {
    let map = map(SkyModel::Perez);
    for (name, voxel_m, every, bound) in
        [("outdoor/courtyard", 0.5, 3, 1.08), ("outdoor/arcades", 0.5, 23, 1.25), ("outdoor/office", 0.2, 4, 1.25), ("outdoor/blocks", 1.0, 23, 1.1)]
    {
        let mut scene = modelled::scene(name);
        scene.sensors = match std::env::var("ONLY") {
            Ok(only) => scene.sensors.into_iter().filter(|s| only.split(',').any(|o| o == s.id)).collect(),
            _ => scene.sensors.into_iter().step_by(every).collect(),
        };
        if scene.sensors.is_empty() { continue; }
        let (found, reflected) = daylit(&scene, voxel_m, &map, &Quality::MEDIUM);
        let model = Model::build(&scene, Arc::new(Rays::new(&scene)), voxel_m, u64::MAX, &Quiet, &Cancel::new()).unwrap();
        let walker = Walker::new(&model, &map);
        let truth: Vec<(f64, f64)> =
            points(&scene.sensors).iter().map(|point| walker.reflected(point, 20_000, 24, 5)).collect();
        let told = || found.iter().zip(&truth).filter(|(_, (truth, error))| *truth > 1.0 && *error < 0.05 * truth);
        let pairs = || told().map(|(found, (truth, _))| (found.reflected_kwh_m2, *truth));
        let rms = rms_factor(pairs());
        println!("{name}: rms factor {rms:.4} of what is reflected, {} of {} sensors", told().count(), found.len());
        if std::env::var_os("EACH").is_some() {
            for ((sensor, (truth, error)), (found, reflected)) in
                scene.sensors.iter().zip(&truth).zip(found.iter().zip(&reflected))
            {
                let (value, own) = (found.reflected_kwh_m2, reflected.error_kwh_m2);
                println!("  {}: {value:.2} ({own:.2}) against {truth:.2} ({error:.2}), {:.3}", sensor.id, value / truth);
            }
        }
        assert!(told().count() * 2 > found.len() && rms < bound, "{name}: {rms}");
    }
}
