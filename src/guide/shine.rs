//! How brightly does a wall shine at a point of it?
//!
//! A patch has one radiosity, but the light that lands on it straight from a lamp may be ten times as much right before the
//! lamp as at the patch's rim, and it is the bright spot that a path has to find. So what lands on a patch is spread over it as it
//! would fall if nothing stood between, in the sum as much as the network has it.
//!
//! Limits: the border of a shadow within a patch is not seen.

use crate::flow::network::Network;
use crate::flow::network::patches::{Patch, Start};
use glam::Vec3;
use rayon::prelude::*;

/// An emitter with less of what lands on a patch than this is taken as even over it.
const LEAST_SHARE: f64 = 0.05;

/// No point of a patch gets more than this times its mean: very near a lamp without a size there is no bound.
const MOST_ABOVE_MEAN: f64 = 30.0;

/// The radiosity of the patches of a network.
pub struct Shine<'a> {
    network: &'a Network<'a>,
    patches: Vec<Lit>,
}

/// What a patch sends out.
struct Lit {
    normal: Vec3,
    /// Evenly over the patch, W/m2.
    even_w_m2: f64,
    /// Emitters whose light is spread over it unevenly: what the patch sends out of it in the mean, W/m2, and what falls onto
    /// its points in the mean if nothing stands between, W/m2.
    uneven: Vec<(usize, f64, f64)>,
}

impl<'a> Shine<'a> {
    /// The radiosity of all patches. Costs a look at each lamp that matters from each start of a patch.
    pub fn new(network: &'a Network<'a>) -> Self {
        let patches = &network.grounds.patches;
        let lit = |(number, patch): (usize, &Patch)| lit(network, number, patch);
        Self { network, patches: patches.list.par_iter().enumerate().map(lit).collect() }
    }

    /// What a patch sends out in the mean, W/m2.
    pub fn mean_w_m2(&self, patch: u32) -> f64 {
        let of = |lit: &Lit| lit.even_w_m2 + lit.uneven.iter().map(|&(_, sent_w_m2, _)| sent_w_m2).sum::<f64>();
        self.patches.get(patch as usize).map_or(0.0, of)
    }

    /// The same for all patches, in their order.
    pub fn means_w_m2(&self) -> Vec<f64> {
        (0..self.patches.len() as u32).map(|patch| self.mean_w_m2(patch)).collect()
    }

    /// What it sends out at that point of it, W/m2.
    pub fn at_w_m2(&self, patch: u32, point_m: Vec3) -> f64 {
        let Some(lit) = self.patches.get(patch as usize) else { return 0.0 };
        let uneven = lit.uneven.iter().map(|&(emitter, sent_w_m2, mean_w_m2)| {
            let falls_w_m2 = unshadowed_w_m2(self.network, emitter, point_m, lit.normal);
            sent_w_m2 * (falls_w_m2 / mean_w_m2).min(MOST_ABOVE_MEAN)
        });
        lit.even_w_m2 + uneven.sum::<f64>()
    }
}

fn lit(network: &Network, number: usize, patch: &Patch) -> Lit {
    let starts = network.grounds.patches.starts.get(patch.starts.clone()).unwrap_or_default();
    let reflected_w_m2: f64 = network.reflected_w_m2.iter().map(|column| column[number]).sum();
    let landed_w: f64 = network.landings.iter().map(|landing| landing.reflected_w[number]).sum();
    let mut lit = Lit {
        normal: starts.first().map_or(Vec3::Z, |start| start.normal),
        even_w_m2: patch.reflectance * reflected_w_m2,
        uneven: Vec::new(),
    };
    for (emitter, landing) in network.landings.iter().enumerate() {
        let sent_w_m2 = landing.reflected_w[number] / patch.area_m2;
        if landing.reflected_w[number] <= LEAST_SHARE * landed_w {
            lit.even_w_m2 += sent_w_m2;
            continue;
        }
        let falls = |start: &Start| unshadowed_w_m2(network, emitter, start.position_m, start.normal);
        let mean_w_m2 = starts.iter().map(falls).sum::<f64>() / starts.len().max(1) as f64;
        match mean_w_m2 > 0.0 {
            true => lit.uneven.push((emitter, sent_w_m2, mean_w_m2)),
            false => lit.even_w_m2 += sent_w_m2,
        }
    }
    lit
}

/// The irradiance that an emitter's middle would bring to a surface if nothing stood between, W/m2.
fn unshadowed_w_m2(network: &Network, emitter: usize, point_m: Vec3, normal: Vec3) -> f64 {
    let light = network.grounds.model.sampler.sample(emitter, point_m, [0.5; 2]);
    light.map_or(0.0, |light| light.irradiance_w_m2 * f64::from(normal.dot(light.direction).max(0.0)))
}
