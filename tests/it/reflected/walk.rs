//! A plain walk of light as the truth.

use super::super::modelled::scene as scene_of;
use super::{daylit, map, modelled, rms_factor};
use glam::Vec3;
use lightvein::daylight::{Point, points};
use lightvein::flow::network::Quality;
use lightvein::flow::sequence;
use lightvein::model::Model;
use lightvein::model::walls::Answer;
use lightvein::rays::{Rays, Surface};
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::ExposureMap;
use lightvein::sky::{azimuth_elevation_rad, towards};
use std::f64::consts::PI;

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
