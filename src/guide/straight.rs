//! Which emitters shine straight at a point in the open, and how much?
//!
//! By shadow rays to those emitters alone whose light the network has found on walls of the point's zone: of a hundred lamps of
//! a building few are in view of any point, and a ray to each from every node would cost more than all else.
//!
//! Limits: an emitter that lands on none of a zone's walls is not asked, though a point of it may be in view.

use crate::flow::direct::{Direct, direct};
use crate::flow::network::Network;
use crate::flow::sequence;
use glam::Vec3;

/// Shadow rays to an emitter that has a body.
const RAYS: u32 = 4;

/// Offsets of the shadow rays' sequences start here.
const OFFSETS: u64 = 1 << 49;

/// For each zone the emitters that may be in view, ascending.
pub struct InView {
    of_zones: Vec<Vec<u32>>,
    seed: u64,
}

impl InView {
    /// The emitters of a network's zones. A zone without light on its walls has those of its zones beside, and where these
    /// have none either, all.
    pub fn new(network: &Network, seed: u64) -> Self {
        let zones = &network.grounds.zones;
        let mut own: Vec<Vec<u32>> = vec![Vec::new(); zones.count];
        for (emitter, landing) in network.landings.iter().enumerate() {
            for (patch, &flux_w) in network.grounds.patches.list.iter().zip(&landing.flux_w) {
                if let Some(zone) = own.get_mut(patch.zone as usize).filter(|_| flux_w > 0.0) {
                    zone.push(emitter as u32);
                }
            }
        }
        own.iter_mut().for_each(Vec::dedup);
        let all: Vec<u32> = network.lamps().map(|lamp| lamp.emitter as u32).collect();
        let of_zone = |zone: usize| {
            if !own[zone].is_empty() {
                return own[zone].clone();
            }
            let mut beside: Vec<u32> =
                zones.beside(zone as u32, 1).flat_map(|other| own[other as usize].clone()).collect();
            beside.sort_unstable();
            beside.dedup();
            if beside.is_empty() { all.clone() } else { beside }
        };
        Self { of_zones: (0..zones.count).map(of_zone).collect(), seed }
    }

    /// What comes to a point of that zone from each emitter in view of the zone, with the emitter's number. `number` makes the
    /// point's rays its own.
    pub fn at(&self, network: &Network, zone: u32, point_m: Vec3, number: u64) -> Vec<(usize, Direct)> {
        let offset = sequence::offset(self.seed, OFFSETS + number);
        let asked = self.of_zones.get(zone as usize).map(Vec::as_slice).unwrap_or_default();
        let of = |&emitter: &u32| {
            let emitter = emitter as usize;
            (emitter, direct(network.grounds.model, point_m, None, emitter, RAYS, offset))
        };
        asked.iter().map(of).collect()
    }
}
