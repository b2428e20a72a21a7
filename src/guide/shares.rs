//! How much of the reflected light at a patch comes from each emitter?
//!
//! The balance of the network, solved for all emitters side by side: sweeps over the patches forwards and back (symmetric
//! Gauss-Seidel), each of which takes light on through as many patches as lie in a row. Every step adds what is positive, so a
//! dark room's shares are as good as a bright one's. They are used to pick lights, so a few sweeps do; what all emitters
//! together reflect is known exactly and is not touched.
//!
//! Limits: the last sweeps' remainder is missing, in which the emitters are mixed more evenly.

use crate::flow::network::Network;
use crate::flow::network::balance::MOST_REFLECTANCE;
use rayon::prelude::*;

/// Emitters that are solved side by side: their radiosities at a patch fill one line of the cache.
const SIDE_BY_SIDE: usize = 16;

/// Sweeps forwards and back. At reflectance 0.5 three leave shares within 0.02 of the exact ones.
const SWEEPS: usize = 3;

/// The radiosities of a patch by some emitters.
type Lanes = [f32; SIDE_BY_SIDE];

/// For each patch the share of each emitter in the light that was reflected at least once before it arrives; a row adds up to
/// 1, or is 0 where no such light arrives.
pub struct Shares {
    /// How many emitters there are: the length of a row.
    pub emitters: usize,
    rows: Vec<f32>,
}

impl Shares {
    /// The shares in a network. Cost: the network's pairs times emitters times twice the sweeps, about a nanosecond for four.
    pub fn new(network: &Network) -> Self {
        let neighbours = Neighbours::new(network);
        let emitters = network.landings.len();
        let patches = network.grounds.patches.list.len();
        let blocks: Vec<Vec<Lanes>> = (0..emitters.div_ceil(SIDE_BY_SIDE))
            .into_par_iter()
            .map(|block| neighbours.arriving(&landed(network, block * SIDE_BY_SIDE)))
            .collect();
        let mut rows = vec![0.0; patches * emitters];
        for (patch, row) in rows.chunks_mut(emitters.max(1)).enumerate() {
            for (emitter, share) in row.iter_mut().enumerate() {
                *share = blocks[emitter / SIDE_BY_SIDE][patch][emitter % SIDE_BY_SIDE];
            }
            normalise(row);
        }
        Self { emitters, rows }
    }

    /// The row of a patch.
    pub fn of(&self, patch: u32) -> &[f32] {
        let first = patch as usize * self.emitters;
        self.rows.get(first..first + self.emitters).unwrap_or_default()
    }

    /// For each zone the shares in what arrives on all its walls; a zone without walls has those of the nearest of its cell.
    pub fn of_zones(&self, network: &Network) -> Vec<Vec<f32>> {
        let zones = &network.grounds.zones;
        let mut sums = vec![vec![0.0_f32; self.emitters]; zones.count];
        let mut has = vec![false; zones.count];
        for (number, patch) in network.grounds.patches.list.iter().enumerate() {
            let irradiance_w_m2: f64 = network.reflected_w_m2.iter().map(|column| column[number]).sum();
            let arriving_w = (irradiance_w_m2 * patch.area_m2) as f32;
            has[patch.zone as usize] |= arriving_w > 0.0;
            let row = self.of(number as u32);
            sums[patch.zone as usize].iter_mut().zip(row).for_each(|(sum, share)| *sum += arriving_w * share);
        }
        sums.iter_mut().for_each(|row| normalise(row));
        let nearest = zones.nearest_where(|zone| has[zone as usize]);
        nearest
            .into_iter()
            .enumerate()
            .map(|(zone, other)| sums[other.map_or(zone, |other| other as usize)].clone())
            .collect()
    }
}

/// The shares of all light at a place: what comes straight from each emitter, and their shares in what is reflected.
pub fn of_all(direct_w_m2: &[f32], reflected_w_m2: f32, reflected_shares: &[f32]) -> Vec<f32> {
    let of = |(direct_w_m2, share): (&f32, &f32)| direct_w_m2 + reflected_w_m2 * share;
    let mut row: Vec<f32> = direct_w_m2.iter().zip(reflected_shares).map(of).collect();
    normalise(&mut row);
    row
}

/// Makes a row add up to 1; one that has nothing stays.
fn normalise(row: &mut [f32]) {
    let sum: f64 = row.iter().map(|&part| f64::from(part)).sum();
    if sum > 0.0 && sum.is_finite() {
        row.iter_mut().for_each(|part| *part = (f64::from(*part) / sum) as f32);
    } else {
        row.fill(0.0);
    }
}

/// What each patch reflects of the light that lands straight from some emitters, each as a share of the emitter's whole flux
/// times that of the brightest, so that nothing is lost in single precision.
fn landed(network: &Network, first: usize) -> Vec<Lanes> {
    let flux_w = |landing: &crate::flow::network::landing::Landing| landing.flux_w.iter().sum::<f64>();
    let brightest_w = network.landings.iter().map(flux_w).fold(f64::MIN_POSITIVE, f64::max);
    let landings = &network.landings[first..network.landings.len().min(first + SIDE_BY_SIDE)];
    let mut landed = vec![[0.0; SIDE_BY_SIDE]; network.grounds.patches.list.len()];
    for (lane, landing) in landings.iter().enumerate() {
        for (landed, reflected_w) in landed.iter_mut().zip(&landing.reflected_w) {
            landed[lane] = (reflected_w / brightest_w) as f32;
        }
    }
    landed
}

/// The exchange by patch.
struct Neighbours {
    /// For each patch the first of its entries, and the end of the last patch.
    first: Vec<u32>,
    /// Patches that it sees, and how much of them, m2.
    entries: Vec<(u32, f32)>,
    reflectance: Vec<f32>,
    /// All that it sees, m2; what it sees of itself.
    seen_m2: Vec<f32>,
    own_m2: Vec<f32>,
}

impl Neighbours {
    fn new(network: &Network) -> Self {
        let patches = network.grounds.patches.list.len();
        let apart = || network.exchange.pairs.iter().filter(|(i, j, _)| i != j);
        let mut first = vec![0_u32; patches + 1];
        for &(i, j, _) in apart() {
            first[i as usize + 1] += 1;
            first[j as usize + 1] += 1;
        }
        for patch in 0..patches {
            first[patch + 1] += first[patch];
        }
        let mut next = first.clone();
        let mut entries = vec![(0, 0.0); first[patches] as usize];
        for &(i, j, x_m2) in apart() {
            for (from, to) in [(i, j), (j, i)] {
                entries[next[from as usize] as usize] = (to, x_m2 as f32);
                next[from as usize] += 1;
            }
        }
        let mut own_m2 = vec![0.0; patches];
        network
            .exchange
            .pairs
            .iter()
            .filter(|(i, j, _)| i == j)
            .for_each(|&(i, _, x_m2)| own_m2[i as usize] += x_m2 as f32);
        let reflectance =
            |patch: &crate::flow::network::patches::Patch| patch.reflectance.clamp(0.0, MOST_REFLECTANCE) as f32;
        Self {
            first,
            entries,
            reflectance: network.grounds.patches.list.iter().map(reflectance).collect(),
            seen_m2: network.exchange.seen_m2.iter().map(|&seen_m2| seen_m2 as f32).collect(),
            own_m2,
        }
    }

    /// What arrives at each patch after reflections, for what each reflects of what `landed` straight.
    fn arriving(&self, landed: &[Lanes]) -> Vec<Lanes> {
        let patches = landed.len();
        let mut radiosity = vec![[0.0; SIDE_BY_SIDE]; patches];
        for _ in 0..SWEEPS {
            (0..patches).for_each(|patch| self.balance(patch, landed, &mut radiosity));
            (0..patches).rev().for_each(|patch| self.balance(patch, landed, &mut radiosity));
        }
        let arriving = |patch: usize| {
            let mut sum = self.seen(patch, &radiosity);
            let own = radiosity[patch].map(|radiosity| self.own_m2[patch] * radiosity);
            sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            sum
        };
        (0..patches).map(arriving).collect()
    }

    /// Sets a patch to what its neighbours, as they are, make of it.
    fn balance(&self, patch: usize, landed: &[Lanes], radiosity: &mut [Lanes]) {
        let reflectance = self.reflectance[patch];
        let keeps_m2 = self.seen_m2[patch] - reflectance * self.own_m2[patch];
        if reflectance > 0.0 && keeps_m2 > 0.0 {
            let seen = self.seen(patch, radiosity);
            radiosity[patch] = std::array::from_fn(|lane| (landed[patch][lane] + reflectance * seen[lane]) / keeps_m2);
        }
    }

    /// What the other patches send to a patch.
    fn seen(&self, patch: usize, radiosity: &[Lanes]) -> Lanes {
        let mut sum = [0.0; SIDE_BY_SIDE];
        for &(other, x_m2) in &self.entries[self.first[patch] as usize..self.first[patch + 1] as usize] {
            let other = &radiosity[other as usize];
            sum.iter_mut().zip(other).for_each(|(sum, radiosity)| *sum += x_m2 * radiosity);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::network::Quality;
    use crate::flow::tests::{lamp, modelled, two_rooms};
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;
    use glam::Vec3;

    #[test]
    fn shares_are_near_those_of_the_exact_balance() {
        let lights =
            [([2.0, 0.5, 1.5], 100.0), ([6.0, 1.0, 0.5], 1e-3), ([7.5, 2.5, 2.5], 40.0), ([1.0, 2.0, 1.0], 0.0)];
        let lights = lights.map(|(at, flux_w)| lamp(Vec3::from(at), flux_w)).into();
        let (_, model) = modelled(&two_rooms(), lights, Vec::new());
        let settings = Settings { shares: true, ..Settings::default() };
        let (network, _) =
            Network::new(&model, &Quality::COARSE, &settings, &Quiet, &Cancel::new()).expect("nobody stops it");
        let found = Shares::new(&network);
        for patch in (0..network.grounds.patches.list.len()).filter(|&patch| network.exchange.seen_m2[patch] > 0.0) {
            let exact: Vec<f64> = network.reflected_w_m2.iter().map(|column| column[patch]).collect();
            let sum: f64 = exact.iter().sum();
            let row = found.of(patch as u32);
            assert!((row.iter().sum::<f32>() - 1.0).abs() < 1e-5 || sum == 0.0, "{row:?}");
            for (share, exact) in row.iter().zip(exact) {
                assert!((f64::from(*share) - exact / sum).abs() < 0.02, "{row:?} for {:?}", exact / sum);
            }
        }
        for row in found.of_zones(&network) {
            assert!((row.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{row:?}");
        }
    }
}
