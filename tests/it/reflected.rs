//! What surfaces reflect of sun and sky, against closed forms, a plain walk of light, laws of physics, and Radiance.

use super::modelled::scene as scene_of;
use super::program::{run, text};
use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::reflect::heuristics::{by_heuristic, openings};
use lightvein::daylight::reflect::landing::Falling;
use lightvein::daylight::reflect::openings::open_cells;
use lightvein::daylight::reflect::skylight::Skylight;
use lightvein::daylight::reflect::{self, Reflected};
use lightvein::daylight::{Exposure, Point, points};
use lightvein::flow::network::{Grounds, Network, Quality};
use lightvein::flow::sequence;
use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Settings, Status};
use lightvein::model::Model;
use lightvein::model::walls::Answer;
use lightvein::rays::{Rays, Surface};
use lightvein::scene::{Material, Mesh, Method, Scene, Sensor, Site};
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::steps::{Period, Totals};
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
    let totals = Totals { dni_kwh_m2: 0.0, ghi_kwh_m2: map.totals.dhi_kwh_m2, ..map.totals };
    ExposureMap { suns: Vec::new(), direct_kwh_m2: vec![0.0; map.direct_kwh_m2.len()], totals, ..map }
}

const CASTING: Casting = Casting { sun_rays: Some(512), sky_rays: 4096, seed: 1 };

fn daylit(scene: &Scene, voxel_m: f32, map: &ExposureMap, quality: &Quality) -> (Vec<Exposure>, Vec<Reflected>) {
    let model = modelled(scene, voxel_m);
    let (rays, points) = (model.rays.clone(), points(&scene.sensors));
    let mut found = cast(&rays, &points, map, 0.0, CASTING, &Quiet, &Cancel::new()).unwrap();
    let light = Skylight::new(map, 0.0);
    let reflected = reflect::by_network(&model, &points, &light, quality, CASTING, &Quiet, &Cancel::new()).unwrap();
    reflect::add(&mut found, &reflected);
    (found, reflected)
}

fn modelled(scene: &Scene, voxel_m: f32) -> Model {
    let rays = Arc::new(Rays::new(scene));
    Model::build(scene, rays, voxel_m, u64::MAX, &Quiet, &Cancel::new()).unwrap()
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
    assert!(
        found.iter().all(|exposure| exposure.total_kwh_m2() == 0.0 && exposure.status == Status::Dark),
        "{found:?}"
    );
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
            let mut direction =
                sequence::cosine_about(facing, sequence::square(path as u32, sequence::offset(seed, !0)));
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
    let scenes =
        [("courtyard", 0.5, 3, 1.06), ("arcades", 0.5, 23, 1.12), ("office", 0.2, 4, 1.08), ("blocks", 1.0, 29, 1.08)];
    for (name, voxel_m, every, bound) in scenes {
        let mut scene = scene_of(&format!("outdoor/{name}"));
        scene.sensors = scene.sensors.into_iter().step_by(every).collect();
        let (found, _) = daylit(&scene, voxel_m, &map, &Quality::MEDIUM);
        let model = modelled(&scene, voxel_m);
        let walker = Walker::new(&model, &map);
        let truth: Vec<(f64, f64)> =
            points(&scene.sensors).iter().map(|point| walker.reflected(point, 20_000, 24, 5)).collect();
        let sure = found.iter().zip(&truth).filter(|(_, (truth, error))| *truth > 1.0 && *error < 0.05 * truth);
        let pairs: Vec<(f64, f64)> = sure.map(|(found, (truth, _))| (found.reflected_kwh_m2, *truth)).collect();
        let rms = rms_factor(pairs.iter().copied());
        println!("{name}: rms factor {rms:.4} of what is reflected, {} of {} sensors", pairs.len(), found.len());
        assert!(pairs.len() * 2 > found.len() && rms < bound, "{name}: {rms}");
    }
}

/// Of what lands on the patches, part is absorbed at once, the rest reflected until it is absorbed or leaves.
#[test]
fn what_lands_is_absorbed_or_leaves() {
    let (map, scene) = (map(SkyModel::Perez), scene_of("outdoor/office"));
    let model = modelled(&scene, 0.2);
    let (light, open) = (Skylight::new(&map, 0.0), open_cells(&model));
    let falling = Falling { light: &light, open: &open, seed: 1 };
    let land = |grounds: &Grounds| falling.on_patches(grounds, &Cancel::new());
    let settings = Settings { shares: true, ..Settings::default() };
    let quality = Quality::MEDIUM;
    let grounds = Grounds::new(&model, &quality, 1).filled();
    let (network, _) = Network::lit_by(grounds, &quality, &settings, &land, &Quiet, &Cancel::new()).unwrap();
    for (column, landing) in network.landings.iter().enumerate() {
        let landed: f64 = landing.flux_w.iter().sum();
        let (mut ends, mut reflected) = (0.0, 0.0);
        for (number, patch) in network.grounds.patches.list.iter().enumerate() {
            let [seen_m2, lost_m2] = [network.exchange.seen_m2[number], network.exchange.lost_m2[number]];
            let arrives = network.reflected_w_m2[column][number];
            let sends = landing.reflected_w[number] + patch.reflectance * arrives * seen_m2;
            ends += landing.flux_w[number] - landing.reflected_w[number];
            ends += (1.0 - patch.reflectance) * arrives * seen_m2 + sends * lost_m2 / seen_m2.max(1e-12);
            reflected += landing.reflected_w[number];
        }
        near(ends, landed, 1e-3, "energy");
        assert!(reflected < landed && landed > 0.0);
    }
    // All that lands on the ground and what stands on it is what crosses the scene's outline, no more.
    let horizontal_m2 = 70.0 * 70.0;
    let landed: f64 = network.landings[..2].iter().flat_map(|landing| &landing.flux_w).sum();
    assert!(landed < 1.2 * horizontal_m2 * map.totals.ghi_kwh_m2, "{landed}");
}

/// Through a window the few rays that are aimed find the sky that many rays by the cosine find.
#[test]
fn rays_through_necks_find_the_sky_that_many_rays_find() {
    let map = map(SkyModel::Perez);
    let mut scene = scene_of("outdoor/office");
    scene.sensors.retain(|sensor| sensor.id.starts_with("room_"));
    let model = modelled(&scene, 0.2);
    let (points, light) = (points(&scene.sensors), Skylight::new(&map, 0.0));
    let few = Casting { sun_rays: Some(1), sky_rays: 512, seed: 3 };
    let many = Casting { sun_rays: Some(1), sky_rays: 200_000, seed: 4 };
    let truth = cast(&model.rays, &points, &map, 0.0, many, &Quiet, &Cancel::new()).unwrap();
    let quality = Quality::COARSE;
    let found = reflect::by_network(&model, &points, &light, &quality, few, &Quiet, &Cancel::new()).unwrap();
    let plain = cast(&model.rays, &points, &map, 0.0, few, &Quiet, &Cancel::new()).unwrap();
    let (mut aimed_off, mut plain_off, mut within) = (0.0, 0.0, 0);
    for ((truth, found), plain) in truth.iter().zip(&found).zip(&plain) {
        let (sky, error) = found.sky_through_necks.expect("a room with a window");
        within += usize::from((sky - truth.sky_kwh_m2).abs() <= 3.0 * error + 0.05);
        println!("{:.3} aimed, {:.3} by the cosine, {:.3} by many", sky, plain.sky_kwh_m2, truth.sky_kwh_m2);
        let off = |sky: f64| (sky / truth.sky_kwh_m2.max(0.1) - 1.0).powi(2);
        aimed_off += off(sky.max(0.1));
        plain_off += off(plain.sky_kwh_m2.max(0.1));
    }
    let [aimed_off, plain_off] = [aimed_off, plain_off].map(|sum: f64| (sum / truth.len() as f64).sqrt());
    println!("aimed off by a share of {aimed_off:.3}, by the cosine alone {plain_off:.3}");
    assert!(aimed_off < 0.5 * plain_off && within + 2 >= truth.len(), "{aimed_off} {plain_off} {within}");
}

/// A window of 2.4 m2 in a wall, under an even sky above nothing: half the sky falls on the wall.
#[test]
fn an_opening_passes_what_falls_on_it_and_diffusion_carries_it() {
    let sky = even_sky();
    for (pane, passes) in [(None, 1.0), (Some(0.6), 0.6)] {
        // Black ground before the room, and a post that gives the open a height.
        let built = room(0.8, pane).material(0.0, 0.0);
        let built = built.quad(2, [-5.0, -12.0, 0.0], [16.0, 0.0, 0.0], [0.0, 12.0, 0.0]);
        let built = built.quad(2, [10.0, -12.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 6.0]);
        let built = built.sensor([3.0, -3.0, 1.0], [0.0, 0.0, 1.0]);
        let model = modelled(&built.0, 0.1);
        let light = Skylight::new(&sky, 0.0);
        let found = openings(&model, &light, 1);
        assert_eq!(found.len(), 1);
        assert!(found[0].inwards.y > 0.95 && found[0].flux_kwh[0] == 0.0, "{found:?}");
        near(found[0].flux_kwh[1], passes * 2.4 * sky.totals.dhi_kwh_m2 / 2.0, 0.06, "flux");
        let overcast = found[0].flux_kwh[2] / light.overcast_kwh_m2;
        near(overcast, passes * 2.4 * 0.3962, 0.06, "flux of the overcast sky");

        let points = points(&built.0.sensors);
        let straight = cast(&model.rays, &points, &sky, 0.0, CASTING, &Quiet, &Cancel::new()).unwrap();
        let asked = (&points[..], &straight[..]);
        let carried = by_heuristic(Method::Diffusion, model, asked, &light, CASTING, &Quiet, &Cancel::new()).unwrap();
        let (gathered, _) = daylit(&built.0, 0.1, &sky, &Quality::MEDIUM);
        // The second sensor is deep in the room, the last in the open.
        let factor = carried[1].all_kwh_m2() / gathered[1].reflected_kwh_m2;
        assert!((0.4..2.5).contains(&factor), "{factor}");
        assert_eq!(carried[4].all_kwh_m2(), 0.0);
    }
}

/// A year in Chicago against Radiance: all light, 5 bounces there and any number here; deep indoors 14 there.
#[test]
fn daylight_against_radiance() {
    let Some(map) = chicago() else { return };
    for (name, voxel_m, table, bound) in [
        ("courtyard", 0.5, "exposure_chicago", 1.03),
        ("arcades", 0.5, "exposure_chicago", 1.07),
        ("blocks", 1.0, "exposure_chicago", 1.03),
        ("office", 0.2, "exposure_chicago", 1.15),
        ("office", 0.2, "exposure_chicago_14_bounces", 1.08),
    ] {
        let scene = scene_of(&format!("outdoor/{name}"));
        let path = format!("scenes/outdoor/{name}/{table}.csv");
        let reference = reference(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path));
        let (found, reflected) = daylit(&scene, voxel_m, &map, &Quality::MEDIUM);
        let of_all = total_rms(&scene, &found, &reference);
        // The reference's own noise is some 4 kWh/m2.
        let sure = || {
            let all = scene.sensors.iter().zip(found.iter().zip(&reflected));
            let all = all.map(|(sensor, (found, own))| (found.reflected_kwh_m2, reference[&sensor.id][0], own));
            all.filter(|(_, reflected, _)| *reflected > 40.0)
        };
        let of_reflected = rms_factor(sure().map(|(found, reflected, _)| (found, reflected)));
        let within = |times: f64| {
            let within = sure().filter(|(found, reflected, own)| (found - reflected).abs() <= times * own.error_kwh_m2);
            100 * within.count() / sure().count()
        };
        println!(
            "{name} ({table}): rms factor {of_all:.4}, of what is reflected {of_reflected:.4}; \
             own error holds {}% within once, {}% within twice",
            within(1.0),
            within(2.0)
        );
        assert!(of_all <= bound && within(2.0) >= 80, "{name}: {of_all}");
    }
}

/// The previews in the office, whose figures the docs have.
#[test]
fn previews_of_the_office_against_radiance() {
    let Some(map) = chicago() else { return };
    let scene = scene_of("outdoor/office");
    let path = "scenes/outdoor/office/exposure_chicago_14_bounces.csv";
    let reference = reference(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path));
    for (method, bound) in [(Method::Diffusion, 2.0), (Method::Backward, 10.0), (Method::Forward, f64::INFINITY)] {
        let model = modelled(&scene, 0.2);
        let (points, light) = (points(&scene.sensors), Skylight::new(&map, 0.0));
        let mut found = cast(&model.rays, &points, &map, 0.0, CASTING, &Quiet, &Cancel::new()).unwrap();
        let asked = (&points[..], &found[..]);
        let reflected = by_heuristic(method, model, asked, &light, CASTING, &Quiet, &Cancel::new()).unwrap();
        reflect::add(&mut found, &reflected);
        let of_all = total_rms(&scene, &found, &reference);
        println!("office by {method}: rms factor {of_all:.3}");
        assert!(of_all <= bound, "{method}: {of_all}");
    }
}

/// The year of Chicago's weather; `None`, and said, where the file is not here.
fn chicago() -> Option<ExposureMap> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/weather/chicago.epw");
    if !path.exists() {
        println!("skipped: {} is not here", path.display());
        return None;
    }
    let weather = Weather::load(&path, &Quiet, &Cancel::new()).unwrap();
    let outdoors = Outdoors::of(&Site::default(), Some(weather)).unwrap();
    Some(ExposureMap::build(&outdoors.steps().unwrap(), &MapSettings::default(), &Quiet, &Cancel::new()).unwrap())
}

/// Of all light, over sensors that get more than 1 kWh/m2; what is lost counts as a hundredth of a kWh/m2.
fn total_rms(scene: &Scene, found: &[Exposure], reference: &HashMap<String, [f64; 2]>) -> f64 {
    let all = scene.sensors.iter().zip(found).map(|(sensor, found)| (found.total_kwh_m2(), reference[&sensor.id][1]));
    rms_factor(all.filter(|(_, total)| *total > 1.0).map(|(found, total)| (found.max(0.01), total)))
}

/// What a table says is reflected, and all, by sensor.
fn reference(path: &Path) -> HashMap<String, [f64; 2]> {
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#') && !line.starts_with("id,"));
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        (fields[0].to_owned(), [3, 4].map(|field: usize| fields[field].parse().unwrap()))
    };
    rows.map(row).collect()
}

#[test]
fn the_command_tells_each_sensor_and_what_was_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = "scenes/outdoor/office/office.toml";
    let quick = ["--voxel", "0.2", "--sun-rays", "64", "--sky-rays", "64", "--step", "120"];
    let arguments = [&["daylight", scene, "--json", "-o", out.to_str().unwrap()][..], &quick].concat();
    let output = run(&arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(!text(&output.stderr).contains("leaks"), "{}", text(&output.stderr));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for key in ["scene", "seconds", "prepare_seconds", "method", "ghi", "lit_h"] {
        assert!(!told[key].is_null(), "{key}");
    }
    let sensors = told["sensors"].as_array().unwrap();
    assert_eq!(sensors.len(), 55);
    for key in ["id", "beam", "sky", "reflected", "total", "svf", "status", "error", "sun_h", "lux", "daylight_factor"]
    {
        assert!(sensors.iter().all(|sensor| !sensor[key].is_null()), "{key}");
    }
    let of = |id: &str, key: &str| sensors.iter().find(|row| row["id"] == id).unwrap()[key].as_f64().unwrap();
    assert!(of("room_middle_8", "reflected") > 5.0 && of("roof", "reflected") < 5.0);
    near(of("roof", "daylight_factor"), 100.0, 0.02, "on the roof");
    let table = std::fs::read_to_string(out.join("daylight.csv")).unwrap();
    assert!(table.lines().count() == 56 && table.starts_with("id,x_m,"), "{table}");

    // A moment, by a preview; at night there is nothing.
    let at = |time: &str, method: &str| {
        let arguments =
            ["daylight", scene, "--voxel", "0.2", "--sky-rays", "64", "--date", "2025-06-21", "--time", time];
        let output = run(&[&arguments[..], &["--method", method]].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        (text(&output.stdout), text(&output.stderr))
    };
    let (noon, warned) = at("12:00", "diffusion");
    assert!(noon.contains("kW/m2 at 2025-06-21 12:00") && warned.contains("preview"), "{noon}{warned}");
    assert!(at("00:30", "network").0.contains("dark"));
    let output = run(&["daylight", scene, "--date", "2025-06-21"]);
    assert_eq!(output.status.code(), Some(2));
}
