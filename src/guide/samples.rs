//! What would a guiding library have learnt from a first pass?
//!
//! Samples of incident radiance at the ends of the network's lines, in the form that OpenPGL takes: it fits its own
//! distributions to them before the first frame. A patch of K sights that add up to `D` looks along a sight of weight `w` with
//! density `cosine / pi D / (K w)`: by the cosine where all sights weigh the same. With it the mean of weight times cosine over
//! the patch's samples is the irradiance that the network has measured there.
//!
//! Limits: seen through glazing, radiance is a patch's mean; point lights are met by no line, so only bodies of light appear as emitters.

use super::TrainingSample;
use super::shine::Shine;
use super::sights::{Sight, sights};
use crate::flow::network::Network;
use crate::flow::network::lines::Line;
use crate::flow::network::walk::End;
use crate::light::{Emitter, Shape};
use crate::model::Model;
use crate::rays::Hit;
use crate::scene::Light;
use rayon::prelude::*;
use std::f64::consts::PI;

/// OpenPGL's flag for light straight from an emitter (`PGLSampleData::EDirectLight`).
pub const DIRECT_LIGHT: u32 = 1 << 1;

/// Sights closer to the surface than this, by their cosine, are left out: their density says nothing.
const LEAST_COSINE: f32 = 1e-3;

/// Panes that a sight of an emitter may pass.
const MOST_PANES: usize = 16;

/// A sample for each sight of each line, in the order of the lines; of what shines and of what is dark.
pub fn samples(network: &Network, shine: &Shine, lines: &[Line]) -> Vec<TrainingSample> {
    let radiosity_w_m2 = &shine.means_w_m2();
    let counts = |sight: &Sight| sight.cosine() > LEAST_COSINE;
    let patches = network.grounds.patches.list.len();
    let (mut count, mut seen_m2) = (vec![0_u32; patches], vec![0.0; patches]);
    for sight in lines.iter().flat_map(|line| sights(line, radiosity_w_m2)).filter(counts) {
        count[sight.patch as usize] += 1;
        seen_m2[sight.patch as usize] += sight.weight_m2;
    }
    let model = network.grounds.model;
    let emitting_faces = model.sources.emitters.iter().any(|emitter| matches!(emitter.shape, Shape::Patch { .. }));
    let sample = |sight: Sight, is_clear: bool| {
        let mean_m2 = seen_m2[sight.patch as usize] / f64::from(count[sight.patch as usize]);
        let density_per_sr = f64::from(sight.cosine()) / PI * mean_m2 / sight.weight_m2;
        let may_emit = match sight.far {
            End::Black => true,
            End::Patch(patch) => emitting_faces && network.grounds.patches.list[patch as usize].reflectance <= 0.0,
            End::Outside => false,
        };
        let emitted_w_m2_sr = if may_emit { emitted_w_m2_sr(model, &sight) } else { 0.0 };
        let radiosity_w_m2 = match sight.far {
            End::Patch(patch) if is_clear => shine.at_w_m2(patch, sight.from_m + sight.distance_m * sight.direction),
            _ => sight.radiosity_w_m2,
        };
        let radiance_w_m2_sr = radiosity_w_m2 / PI + emitted_w_m2_sr;
        TrainingSample {
            position_m: sight.from_m,
            direction: sight.direction,
            weight_w_m2: (radiance_w_m2_sr / density_per_sr) as f32,
            density_per_sr: density_per_sr as f32,
            distance_m: sight.distance_m,
            flags: if emitted_w_m2_sr > 0.0 { DIRECT_LIGHT } else { 0 },
        }
    };
    let of_line = |line: &'_ Line| {
        let is_clear = line.panes.is_empty();
        let of_line: Vec<TrainingSample> =
            sights(line, radiosity_w_m2).filter(counts).map(|sight| sample(sight, is_clear)).collect();
        of_line
    };
    lines.par_iter().with_min_len(1024).flat_map_iter(of_line).collect()
}

/// The radiance of the emitter that a sight ends on, as it comes through glazing; 0 where it ends on none.
fn emitted_w_m2_sr(model: &Model, sight: &Sight) -> f64 {
    let lift_m = model.rays.epsilon_m();
    let (mut from_m, mut share) = (sight.from_m + sight.normal * lift_m, 1.0);
    for _ in 0..=MOST_PANES {
        let Some(hit) = model.rays.closest(from_m, sight.direction, f32::INFINITY) else { break };
        if let Some(emitter) = model.sources.emitters.iter().find(|emitter| emitter.owns(hit.surface)) {
            return share * radiance_w_m2_sr(emitter, &hit);
        }
        let passes = f64::from(model.walls.answer(hit.surface).passes);
        if passes <= 0.0 {
            break;
        }
        share *= passes;
        from_m += hit.distance_m * sight.direction - hit.facing() * lift_m;
    }
    0.0
}

/// The radiance that an emitter shows to a ray that hit it; 0 from behind.
fn radiance_w_m2_sr(emitter: &Emitter, hit: &Hit) -> f64 {
    match emitter.shape {
        Shape::Light(_, Light::Sphere { radius_m, .. }) => emitter.flux_w / (2.0 * PI * f64::from(radius_m)).powi(2),
        Shape::Light(_, Light::Quad { u_m, v_m, .. }) if hit.front => {
            emitter.flux_w / (PI * f64::from(u_m.cross(v_m).length()))
        }
        Shape::Patch { radiance_w_m2_sr, .. } if hit.front => radiance_w_m2_sr,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::network::Quality;
    use crate::flow::tests::{FLUX_W, lamp, modelled, two_rooms};
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;
    use glam::Vec3;

    fn seen<R>(light: Light, look: impl FnOnce(&Network, &[Line]) -> R) -> R {
        let (_, model) = modelled(&two_rooms(), vec![light], Vec::new());
        let (network, lines) = Network::new(&model, &Quality::MEDIUM, &Settings::default(), &Quiet, &Cancel::new())
            .expect("nobody stops it");
        look(&network, &lines)
    }

    #[test]
    fn the_mean_of_weight_times_cosine_is_the_irradiance() {
        seen(lamp(Vec3::new(2.0, 0.5, 1.5), FLUX_W), |network, lines| {
            let shine = Shine::new(network);
            let (found, sent) = (samples(network, &shine, lines), shine.means_w_m2());
            let looks: Vec<Sight> = lines.iter().flat_map(|line| sights(line, &sent)).collect();
            let patches = network.grounds.patches.list.len();
            assert_eq!(found.len(), looks.len());
            let (mut means, mut counts) = (vec![0.0; patches], vec![0.0; patches]);
            for (sample, look) in found.iter().zip(&looks) {
                assert!(sample.density_per_sr > 0.0 && sample.weight_w_m2 >= 0.0 && sample.flags == 0);
                means[look.patch as usize] += f64::from(sample.weight_w_m2 * look.cosine());
                counts[look.patch as usize] += 1.0;
            }
            let (mut off, mut more, mut all) = (0.0, 0.0, 0.0);
            for patch in (0..patches).filter(|&patch| counts[patch] > 0.0) {
                let seen_m2 = network.exchange.seen_m2[patch];
                let irradiance_w_m2: f64 = network.reflected_w_m2.iter().map(|column| column[patch]).sum();
                let off_w = (means[patch] / counts[patch] - irradiance_w_m2) * seen_m2;
                off += off_w.abs();
                more += off_w;
                all += irradiance_w_m2 * seen_m2;
            }
            // The network's irradiance is by patches that shine evenly.
            assert!(more.abs() < 0.03 * all, "{more} W too many of {all} W");
            assert!(off < 0.1 * all, "{off} W of {all} W lie elsewhere");
        });
    }

    #[test]
    fn bodies_of_light_are_flagged_and_show_their_radiance() {
        let (flux_w, radius_m) = (FLUX_W, 0.3);
        let ball = Light::Sphere { centre_m: Vec3::new(2.0, 1.0, 1.5), radius_m, flux_w };
        seen(ball, |network, lines| {
            let found = samples(network, &Shine::new(network), lines);
            let straight: Vec<_> = found.iter().filter(|sample| sample.flags == DIRECT_LIGHT).collect();
            assert!(straight.len() > 20, "{}", straight.len());
            let want_w_m2_sr = flux_w / (4.0 * PI * PI * f64::from(radius_m).powi(2));
            for sample in straight {
                let radiance_w_m2_sr = f64::from(sample.weight_w_m2 * sample.density_per_sr);
                assert!(
                    (radiance_w_m2_sr / want_w_m2_sr - 1.0).abs() < 1e-4,
                    "{radiance_w_m2_sr} is not {want_w_m2_sr}"
                );
                let end_m = sample.position_m + sample.distance_m * sample.direction;
                assert!((end_m.distance(Vec3::new(2.0, 1.0, 1.5)) - radius_m).abs() < 1e-3);
            }
        });
    }
}
