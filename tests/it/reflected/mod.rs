//! What surfaces reflect of sun and sky: what the tests below share.

/// Against Radiance, over a year of weather.
mod against_radiance;
/// Scenes whose light has a closed form.
mod closed_forms;
/// The command.
mod command;
/// What holds of any scene: energy, glazing, darkness, threads.
mod laws;
/// Necks as places to aim at, and as lamps.
mod openings;
/// A plain walk of light as the truth.
mod walk;

use glam::Vec3;
use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::reflect::skylight::Skylight;
use lightvein::daylight::reflect::{self, Reflected};
use lightvein::daylight::{Exposure, points};
use lightvein::flow::network::Quality;
use lightvein::job::{Cancel, Quiet};
use lightvein::model::Model;
use lightvein::rays::Rays;
use lightvein::scene::{Material, Mesh, Scene, Sensor, Site};
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::steps::{Period, Totals};
use std::sync::Arc;

/// A scene under construction.
#[derive(Default)]
pub struct Built(pub Scene);

impl Built {
    pub fn material(mut self, reflectance: f32, transmittance: f32) -> Self {
        let name = self.0.materials.len().to_string();
        self.0.materials.push(Material { name, reflectance, transmittance, emission_w_m2_sr: 0.0 });
        self
    }

    pub fn triangle(&mut self, material: u32, corners_m: [Vec3; 3]) {
        let mesh: &mut Mesh = &mut self.0.mesh;
        let first = mesh.positions_m.len() as u32;
        mesh.positions_m.extend(corners_m);
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.material_of.push(material);
    }

    /// A parallelogram, seen from its front counter-clockwise.
    pub fn quad(mut self, material: u32, corner_m: [f32; 3], u_m: [f32; 3], v_m: [f32; 3]) -> Self {
        let [a, u, v] = [corner_m, u_m, v_m].map(Vec3::from_array);
        self.triangle(material, [a, a + u, a + u + v]);
        self.triangle(material, [a, a + u + v, a + v]);
        self
    }

    pub fn sensor(mut self, at_m: [f32; 3], normal: [f32; 3]) -> Self {
        let normal = Some(Vec3::from_array(normal)).filter(|normal| *normal != Vec3::ZERO);
        let id = self.0.sensors.len().to_string();
        self.0.sensors.push(Sensor { id, position_m: Vec3::from_array(at_m), normal });
        self
    }
}

/// A clear year at 42 degrees north.
pub fn map(model: SkyModel) -> ExposureMap {
    let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
    let outdoors = Outdoors::of(&site, None).unwrap();
    let steps = Outdoors { period: Period { step_min: 120.0, ..Period::YEAR }, ..outdoors }.steps().unwrap();
    let settings = MapSettings { size: [256, 256], model, ..MapSettings::default() };
    ExposureMap::build(&steps, &settings, &Quiet, &Cancel::new()).unwrap()
}

/// The same year without its sun: an even sky.
pub fn even_sky() -> ExposureMap {
    let map = map(SkyModel::Isotropic);
    let totals = Totals { dni_kwh_m2: 0.0, ghi_kwh_m2: map.totals.dhi_kwh_m2, ..map.totals };
    ExposureMap { suns: Vec::new(), direct_kwh_m2: vec![0.0; map.direct_kwh_m2.len()], totals, ..map }
}

pub const CASTING: Casting = Casting { sun_rays: Some(512), sky_rays: 4096, seed: 1 };

pub fn daylit(scene: &Scene, voxel_m: f32, map: &ExposureMap, quality: &Quality) -> (Vec<Exposure>, Vec<Reflected>) {
    let model = modelled(scene, voxel_m);
    let (rays, points) = (model.rays.clone(), points(&scene.sensors));
    let mut found = cast(&rays, &points, map, 0.0, CASTING, &Quiet, &Cancel::new()).unwrap();
    let light = Skylight::new(map, 0.0);
    let reflected = reflect::by_network(&model, &points, &light, quality, CASTING, &Quiet, &Cancel::new()).unwrap();
    reflect::add(&mut found, &reflected);
    (found, reflected)
}

pub fn modelled(scene: &Scene, voxel_m: f32) -> Model {
    let rays = Arc::new(Rays::new(scene));
    Model::build(scene, rays, voxel_m, u64::MAX, &Quiet, &Cancel::new()).unwrap()
}

#[track_caller]
pub fn near(value: f64, expected: f64, share: f64, what: &str) {
    assert!((value - expected).abs() <= share * expected.abs(), "{what}: {value} against {expected}");
}

/// A room of 6 x 4 x 3 m whose south wall has a window of 2 x 1.2 m, with a pane if `pane`, above ground of its own.
pub fn room(reflectance: f32, pane: Option<f32>) -> Built {
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

pub fn rms_factor(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let squares: Vec<f64> = pairs.map(|(found, truth)| (found / truth).log10().powi(2)).collect();
    10_f64.powf((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}
