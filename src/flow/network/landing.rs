//! Where does light land straight from its sources?
//!
//! Two ways to draw the same light are weighed against each other by the balance heuristic (Veach & Guibas 1995): photons
//! from the lights, which find the bright spots close to them, and shadow rays from the patches, which find what is far. What
//! a light's photons carry onto walls is exact in the sum, all its flux less what escapes, and the two together are held to
//! it.

use super::patches::{Patch, Start};
use super::walk::{End, walk};
use super::{Grounds, Quality};
use crate::flow::sequence;
use crate::model::Shining;
use rayon::prelude::*;

/// Fewest photons of an emitter.
const LEAST_PHOTONS: u32 = 64;

/// Offsets of the photons' sequences start here, apart from those of lines.
const PHOTON_OFFSETS: u64 = 1 << 41;

/// Offsets of the shadow rays' sequences start here.
const SHADOW_OFFSETS: u64 = 1 << 42;

/// Inverse powers of the root of x^5 = x + 1: the sequence R4 (M. Roberts 2018).
const R4: [f64; 4] = [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_037_808_6, 0.538_596_957_982_275_9];

/// Light that lands straight from one emitter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Landing {
    /// What lands on each patch, W.
    pub flux_w: Vec<f64>,
    /// What of it each patch reflects, W.
    pub reflected_w: Vec<f64>,
    /// What leaves the scene, falls on the bodies of lights or into crevices, W.
    pub lost_w: f64,
}

/// A portion of light on a patch.
struct Portion {
    patch: u32,
    flux_w: f64,
    reflects: f32,
    /// Share that goes on from there.
    passes: f32,
}

/// What all lights together promise each patch: the sum of their flux over squared distance, W/m2.
pub fn promised(grounds: &Grounds) -> Vec<f64> {
    let lamps = &grounds.model.shining;
    let of_patch = |patch: &Patch| lamps.iter().map(|shining| promise(grounds, patch, shining)).sum();
    grounds.patches.list.par_iter().map(of_patch).collect()
}

/// Where the light of one emitter lands; `promised` as [`promised`] gives it.
pub fn landing(grounds: &Grounds, quality: &Quality, shining: &Shining, promised: &[f64], seed: u64) -> Landing {
    let patches = grounds.patches.list.len();
    let mut landing = Landing { flux_w: vec![0.0; patches], reflected_w: vec![0.0; patches], lost_w: 0.0 };
    if shining.place.is_err() || shining.flux_w <= 0.0 {
        return landing;
    }
    let lamps = grounds.model.shining.len();
    let shine = grounds.model.shining.iter().filter(|shining| shining.flux_w > 0.0).count() as u32;
    let photons = (quality.photons / shine.max(1)).max(LEAST_PHOTONS);
    let shadows = |number: usize| {
        let patch = &grounds.patches.list[number];
        let most = f64::from((patch.starts.len() as u32).min(quality.shadow_rays));
        (most * (2.0 * promise(grounds, patch, shining) / promised[number]).min(1.0)).round() as u32
    };
    let shadows_per_m2 = |patch: usize| f64::from(shadows(patch)) / grounds.patches.list[patch].area_m2;
    // The density of both ways together, per m2, where the unshadowed irradiance is that.
    let share = f64::from(photons) / shining.flux_w;
    let density_per_m2 = |patch: usize, irradiance_w_m2: f64| share * irradiance_w_m2 + shadows_per_m2(patch);

    let offset = [0, 1].map(|part| sequence::offset(seed, PHOTON_OFFSETS + 2 * shining.emitter as u64 + part));
    let offset = [offset[0][0], offset[0][1], offset[1][0], offset[1][1]];
    let flights: Vec<(Vec<Portion>, f64)> = (0..photons)
        .into_par_iter()
        .with_min_len(64)
        .map(|photon| flight(grounds, shining.emitter, photon, offset, &density_per_m2))
        .collect();
    let seen: Vec<Vec<Portion>> = (0..patches)
        .into_par_iter()
        .with_min_len(16)
        .map(|patch| {
            let offset = sequence::offset(seed, SHADOW_OFFSETS + (patch * lamps + shining.emitter) as u64);
            let starts = &grounds.patches.starts[grounds.patches.list[patch].starts.clone()];
            let count = shadows(patch);
            let shadow = |ray: u32| {
                let start = &starts[ray as usize * starts.len() / count as usize];
                let random = sequence::square(ray, offset);
                let (irradiance_w_m2, share) = straight(grounds, shining.emitter, start, random)?;
                let flux_w = share * irradiance_w_m2 / density_per_m2(patch, irradiance_w_m2);
                Some(Portion {
                    patch: patch as u32,
                    flux_w,
                    reflects: start.answer.reflects,
                    passes: start.answer.passes,
                })
            };
            (0..count).filter_map(shadow).collect()
        })
        .collect();

    let mut stopped_w = 0.0;
    for portion in flights.iter().flat_map(|(portions, _)| portions).chain(seen.iter().flatten()) {
        landing.flux_w[portion.patch as usize] += portion.flux_w;
        landing.reflected_w[portion.patch as usize] += portion.flux_w * f64::from(portion.reflects);
        stopped_w += portion.flux_w * f64::from(1.0 - portion.passes);
    }
    landing.lost_w = flights.iter().map(|(_, lost)| lost).sum::<f64>() * shining.flux_w / f64::from(photons);
    if stopped_w > 0.0 {
        let exact = (shining.flux_w - landing.lost_w).max(0.0) / stopped_w;
        landing.flux_w.iter_mut().chain(&mut landing.reflected_w).for_each(|flux_w| *flux_w *= exact);
    }
    landing
}

/// What a light may bring to a patch, whatever lies between: its flux over the squared distance, W/m2. Each patch shares its
/// shadow rays among the lights by this; a light that gets none is left to its photons.
fn promise(grounds: &Grounds, patch: &Patch, shining: &Shining) -> f64 {
    let Some(start) = grounds.patches.starts.get(patch.starts.start) else { return 0.0 };
    let squared_m2 = f64::from(start.position_m.distance_squared(shining.position_m));
    shining.flux_w / squared_m2.max(patch.area_m2).max(f64::MIN_POSITIVE)
}

/// What one photon leaves on the patches it meets, and the share of it that is lost.
fn flight(
    grounds: &Grounds,
    emitter: usize,
    photon: u32,
    offset: [f64; 4],
    density_per_m2: &impl Fn(usize, f64) -> f64,
) -> (Vec<Portion>, f64) {
    let random = std::array::from_fn(|axis| (offset[axis] + R4[axis] * (f64::from(photon) + 0.5)).fract());
    let sampler = &grounds.model.sampler;
    let Some(leaves) = sampler.emit(emitter, random) else { return (Vec::new(), 1.0) };
    let Some(walk) = walk(grounds, leaves.origin_m, leaves.direction) else { return (Vec::new(), 1.0) };
    let mut share = 1.0;
    let mut portion = |patch: u32, at: &Start| {
        let cosine = f64::from(-at.normal.dot(leaves.direction)).max(0.0);
        let irradiance_w_m2 = cosine * sampler.irradiance_of(emitter, &leaves, at.position_m);
        let flux_w = share * irradiance_w_m2 / density_per_m2(patch as usize, irradiance_w_m2);
        share *= f64::from(at.answer.passes);
        Portion { patch, flux_w, reflects: at.answer.reflects, passes: at.answer.passes }
    };
    let mut portions: Vec<Portion> = walk.panes.iter().map(|pane| portion(pane.sides[0], &pane.at)).collect();
    match walk.end {
        End::Patch(patch) => {
            portions.push(portion(patch, &walk.at));
            (portions, 0.0)
        }
        End::Black | End::Outside => (portions, share),
    }
}

/// The irradiance that a drawn part of an emitter would bring to a place if nothing were between, W/m2, and the share that
/// comes through. `None` where it does not shine on the place.
fn straight(grounds: &Grounds, emitter: usize, at: &Start, random: [f64; 2]) -> Option<(f64, f64)> {
    let rays = &grounds.model.rays;
    let position_m = at.position_m + at.normal * rays.epsilon_m();
    let light = grounds.model.sampler.sample(emitter, position_m, random)?;
    let cosine = f64::from(at.normal.dot(light.direction));
    if cosine <= 0.0 {
        return None;
    }
    let share = rays.transmitted_past(position_m, light.end_m, |_| false);
    (share > 0.0).then(|| (cosine * light.irradiance_w_m2, f64::from(share)))
}
