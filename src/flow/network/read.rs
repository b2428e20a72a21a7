//! How much light is at a point, without a ray more than for its direct light?
//!
//! The lines that measured the exchange have crossed the zones. A line between radiosities `B_i` and `B_j` brings radiance
//! `B_i / pi` and `B_j / pi` to every point on it, so a zone's scalar irradiance is four times their mean over the lengths
//! of lines in it, and its net flux the same with their directions (the track-length estimator of transport theory). A sum
//! of `2 w l` over the volume is 4 for a closed void, whatever the lines.
//!
//! A point between the middles of zones gets a mean of those that see it through no wall. On a wall of ours it is the patch
//! that knows. With the diffuse field's two numbers a planar sensor in the open reads `phi / 4 + f . n / 2`.
//!
//! Limits: beside a neck much narrower than the room the field turns within one zone; there sensors are to be gathered.

use super::Network;
use super::lines::Line;
use super::walk::End;
use crate::flow::direct::Direct;
use crate::flow::sequence;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Reading, Settings};
use crate::model::Probe;
use glam::{DVec3, Vec3};
use petgraph::graph::NodeIndex;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Lines are looked at in steps of this share of a zone, each of which costs a look at the voxels.
const STEP_SHARE: f32 = 0.5;

/// Offsets of the steps' sequences start here.
const STEP_OFFSETS: u64 = 1 << 44;

/// A zone's middle has a say in points up to this many zones away.
const REACH_ZONES: f32 = 1.6;

/// A sensor this near to a wall, in voxels, lies on it.
const ON_WALL_VOXELS: f32 = 0.25;

/// A wall of this cosine to a sensor's normal is parallel to it.
const PARALLEL_FROM: f32 = 0.9;

/// Shadow rays from a probe to a light that has a body.
const DIRECT_RAYS: u32 = 8;

/// Offsets of the probes' sequences start here.
const PROBE_OFFSETS: u64 = 1 << 45;

/// The diffuse field in the zones.
#[derive(Debug, Clone, Default)]
pub struct Tracks {
    /// Sum over the lines of weight times length, `w l`, m3: twice the zone's volume.
    pub track_m3: Vec<f64>,
    /// The middle of each zone, as the lines have it, metres.
    middles_m: Vec<Vec3>,
    /// For each column the scalar irradiance of the zones, W/m2.
    scalar_w_m2: Vec<Vec<f64>>,
    /// The net flux of all columns together, W/m2.
    flux_w_m2: Vec<DVec3>,
    /// Zones that see each other without another between, ascending.
    beside: Vec<Vec<u32>>,
    /// The edge of each zone, metres.
    edge_m: Vec<f32>,
}

/// A stretch of a line in one zone.
struct Stretch {
    zone: u32,
    length_m: f32,
    at_m: Vec3,
    /// Panes of the line before it.
    panes_before: usize,
}

impl Tracks {
    /// What the lines of a network bring to its zones: for each column of `radiosity_w_m2` its scalar irradiance. The first
    /// `summed` columns make up the net flux.
    pub fn new(
        network: &super::Grounds,
        lines: &[Line],
        radiosity_w_m2: &[Vec<f64>],
        summed: usize,
        seed: u64,
    ) -> Self {
        let zones = network.zones.count;
        let columns = radiosity_w_m2.len();
        let stretches: Vec<Vec<Stretch>> = lines
            .par_iter()
            .enumerate()
            .with_min_len(256)
            .map(|(number, line)| along(network, line, sequence::offset(seed, STEP_OFFSETS + number as u64)[0] as f32))
            .collect();

        let mut tracks = Self {
            track_m3: vec![0.0; zones],
            middles_m: vec![Vec3::ZERO; zones],
            scalar_w_m2: vec![vec![0.0; zones]; columns],
            flux_w_m2: vec![DVec3::ZERO; zones],
            beside: vec![Vec::new(); zones],
            edge_m: vec![0.0; zones],
        };
        let mut middles = vec![DVec3::ZERO; zones];
        for (line, stretches) in lines.iter().zip(&stretches) {
            for (number, stretch) in stretches.iter().enumerate() {
                let zone = stretch.zone as usize;
                let track_m3 = line.weight_m2 * f64::from(stretch.length_m);
                tracks.track_m3[zone] += track_m3;
                middles[zone] += track_m3 * stretch.at_m.as_dvec3();
                for (column, radiosity_w_m2) in radiosity_w_m2.iter().enumerate() {
                    let [behind, ahead] = seen_from(line, stretch.panes_before, radiosity_w_m2);
                    tracks.scalar_w_m2[column][zone] += track_m3 * (behind + ahead);
                    if column < summed {
                        tracks.flux_w_m2[zone] += track_m3 * (ahead - behind) * line.direction.as_dvec3();
                    }
                }
                let next = stretches.get(number + 1).map(|next| next.zone).filter(|&next| next != stretch.zone);
                if let Some(next) = next {
                    tracks.beside[zone].push(next);
                    tracks.beside[next as usize].push(stretch.zone);
                }
            }
        }
        for zone in 0..zones {
            let track_m3 = tracks.track_m3[zone].max(f64::MIN_POSITIVE);
            tracks.middles_m[zone] = (middles[zone] / track_m3).as_vec3();
            tracks.scalar_w_m2.iter_mut().for_each(|column| column[zone] *= 2.0 / track_m3);
            tracks.flux_w_m2[zone] *= 2.0 / track_m3;
            tracks.edge_m[zone] = (0.5 * track_m3).cbrt() as f32;
            tracks.beside[zone].sort_unstable();
            tracks.beside[zone].dedup();
        }
        tracks
    }

    /// Reflected light at a point of a zone: the scalar irradiance and the net flux of the first `columns` columns together, W/m2.
    pub fn reflected(&self, columns: usize, zone: u32, point_m: Vec3) -> Direct {
        let around = self.around(zone, point_m);
        let value_w_m2 = self.scalar_w_m2(0..columns, &around);
        // The mean of the fluxes' shares of the scalar irradiance, so that it follows the geometric mean.
        let share = |zone: usize| {
            let scalar_w_m2: f64 = self.scalar_w_m2[..columns].iter().map(|column| column[zone]).sum();
            if scalar_w_m2 > 0.0 { self.flux_w_m2[zone] / scalar_w_m2 } else { DVec3::ZERO }
        };
        let flux_w_m2 = value_w_m2 * around.iter().map(|&(zone, part)| part * share(zone)).sum::<DVec3>();
        Direct { value_w_m2, flux_w_m2 }
    }

    /// The zones that have a say at a point of a zone, with shares that add up to 1.
    fn around(&self, zone: u32, point_m: Vec3) -> Vec<(usize, f64)> {
        let own = zone as usize;
        let Some(beside) = self.beside.get(own) else { return Vec::new() };
        let mut shares = BTreeMap::new();
        for other in beside.iter().map(|&other| other as usize).chain([own]) {
            let reach_m = REACH_ZONES * 0.5 * (self.edge_m[own] + self.edge_m[other]);
            let nearness = 1.0 - self.middles_m[other].distance(point_m) / reach_m;
            if self.track_m3[other] > 0.0 && (nearness > 0.0 || other == own) {
                shares.insert(other, f64::from(nearness.max(0.05)).powi(2));
            }
        }
        let sum: f64 = shares.values().sum();
        shares.into_iter().map(|(zone, share)| (zone, share / sum)).collect()
    }

    /// The scalar irradiance of some columns together at a place, as a geometric mean: light falls off by factors.
    fn scalar_w_m2(&self, columns: std::ops::Range<usize>, around: &[(usize, f64)]) -> f64 {
        let of_zone = |zone: usize| self.scalar_w_m2[columns.clone()].iter().map(|column| column[zone]).sum::<f64>();
        let values = || around.iter().map(|&(zone, share)| (of_zone(zone), share));
        if values().any(|(value, _)| value <= 0.0) {
            return values().map(|(value, share)| value * share).sum();
        }
        values().map(|(value, share)| value.ln() * share).sum::<f64>().exp()
    }
}

/// The radiosities that a stretch of a line sees behind and ahead of it, weakened by glazing between, and that of the panes.
pub fn seen_from(line: &Line, panes_before: usize, radiosity_w_m2: &[f64]) -> [f64; 2] {
    let of = |patch: u32| radiosity_w_m2.get(patch as usize).copied().unwrap_or(0.0);
    let of_end = |end: End| if let End::Patch(patch) = end { of(patch) } else { 0.0 };
    let (before, after) = line.panes.split_at(panes_before.min(line.panes.len()));
    let through = |seen: f64, pane: &super::walk::Pane, side: usize| {
        seen * f64::from(pane.at.answer.passes) + of(pane.sides[side])
    };
    let behind = before.iter().fold(of_end(line.ends[0]), |seen, pane| through(seen, pane, 1));
    let ahead = after.iter().rev().fold(of_end(line.ends[1]), |seen, pane| through(seen, pane, 0));
    [behind, ahead]
}

/// The zones along a line, in steps that begin at a random place.
fn along(grounds: &super::Grounds, line: &Line, offset: f32) -> Vec<Stretch> {
    let lattice = &grounds.model.voxels.lattice;
    let zone = |at_m: Vec3| {
        let node = grounds.model.skeleton.nearest.node(lattice.voxel_at(at_m))?;
        Some((grounds.zones.at(node, at_m), STEP_SHARE * grounds.zones.edge_m(node)))
    };
    let mut stretches = Vec::new();
    // The step is that of the zone just left, so that a line's steps suit where it is; its first is a voxel.
    let mut step_m = lattice.voxel_m;
    let mut start_m = 0.0;
    while start_m < line.length_m {
        let length_m = step_m.min(line.length_m - start_m);
        let at_m = line.from_m + (start_m + offset * length_m) * line.direction;
        if let Some((zone, next_m)) = zone(at_m) {
            let panes_before = line
                .panes
                .iter()
                .filter(|pane| (pane.at.position_m - line.from_m).dot(line.direction) < start_m + offset * length_m);
            stretches.push(Stretch { zone, length_m, at_m, panes_before: panes_before.count() });
            step_m = next_m.max(lattice.voxel_m);
        } else {
            step_m = lattice.voxel_m;
        }
        start_m += length_m;
    }
    stretches
}

/// The field at the probes, read off the zones.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn read(
    network: &Network,
    tracks: &Tracks,
    probes: &[Probe],
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Field, Cancelled> {
    progress.begin("read", probes.len() as u64);
    let answers: Result<Vec<(Reading, Vec<f64>)>, Cancelled> = probes
        .par_iter()
        .enumerate()
        .with_min_len(64)
        .map(|(number, probe)| {
            cancel.check()?;
            let offset = sequence::offset(settings.seed, PROBE_OFFSETS + number as u64);
            Ok(match probe.place {
                Ok(node) => at_probe(network, tracks, probe, node, offset),
                Err(status) => (Reading::none(status), vec![0.0; network.grounds.model.shining.len()]),
            })
        })
        .collect();
    progress.advance(probes.len() as u64);
    progress.end();
    Ok(network.field(answers?, settings))
}

fn at_probe(
    network: &Network,
    tracks: &Tracks,
    probe: &Probe,
    node: NodeIndex,
    offset: [f64; 2],
) -> (Reading, Vec<f64>) {
    let grounds = &network.grounds;
    let (Direct { mut value_w_m2, mut flux_w_m2 }, mut row) = network.straight(probe, DIRECT_RAYS, offset);
    let zone = grounds.zones.at(node.index() as u32, probe.position_m);
    let around = tracks.around(zone, probe.position_m);
    let columns = network.reflected_w_m2.len();
    let Direct { value_w_m2: all_w_m2, flux_w_m2: diffuse_w_m2 } = tracks.reflected(columns, zone, probe.position_m);

    // What the diffuse field is worth to this probe, as a factor on the scalar irradiance.
    let on_wall = probe.normal.and_then(|normal| on_wall_w_m2(network, &around, probe.position_m, normal));
    let (worth, hemisphere_w_m2) = match probe.normal {
        None => (1.0, diffuse_w_m2),
        Some(normal) => {
            let normal = normal.as_dvec3();
            let planar_w_m2 = match on_wall {
                Some(irradiance_w_m2) => irradiance_w_m2,
                None => (all_w_m2 / 4.0 + diffuse_w_m2.dot(normal) / 2.0).max(0.0),
            };
            // The flux over the hemisphere: its normal part is the irradiance, across it half of the whole.
            let across_w_m2 = 0.5 * (diffuse_w_m2 - diffuse_w_m2.dot(normal) * normal);
            (if all_w_m2 > 0.0 { planar_w_m2 / all_w_m2 } else { 0.0 }, planar_w_m2 * normal + across_w_m2)
        }
    };
    value_w_m2 += worth * all_w_m2;
    flux_w_m2 += hemisphere_w_m2;
    if columns == row.len() {
        // What the mean makes of all together, each column has its part of by the plain mean.
        let plain =
            |column: usize| around.iter().map(|&(zone, part)| part * tracks.scalar_w_m2[column][zone]).sum::<f64>();
        let sum: f64 = (0..columns).map(plain).sum();
        let factor = if sum > 0.0 { worth * all_w_m2 / sum } else { 0.0 };
        row.iter_mut().enumerate().for_each(|(column, part)| *part += factor * plain(column));
    }
    let [odd, even, coarse] =
        [0, 1, 2].map(|variant| tracks.scalar_w_m2(columns + variant..columns + variant + 1, &around));
    let spread =
        around.iter().map(|&(zone, _)| tracks.scalar_w_m2[..columns].iter().map(|column| column[zone]).sum::<f64>());
    let spread = spread.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    // Between zones that differ, a point may be a quarter of their difference off.
    let between = if spread.1 > spread.0 { 0.25 * (spread.1 - spread.0) } else { 0.0 };
    let error = worth * (0.5 * (odd - even)).hypot(0.5 * (coarse - all_w_m2)).hypot(between);
    let status = network.status(node, value_w_m2);
    (Reading { value_w_m2, flux_w_m2, error_w_m2: Some(error), status }, row)
}

/// The irradiance by reflected light on the wall that a sensor lies on, W/m2, as the mean of that of walls like it in the
/// zones around; `None` for a sensor in the open.
fn on_wall_w_m2(network: &Network, around: &[(usize, f64)], position_m: Vec3, normal: Vec3) -> Option<f64> {
    let grounds = &network.grounds;
    let rays = &grounds.model.rays;
    let reach_m = ON_WALL_VOXELS * grounds.model.voxels.lattice.voxel_m;
    let hit = rays.closest(position_m + normal * rays.epsilon_m(), -normal, reach_m)?;
    if hit.facing().dot(normal) < PARALLEL_FROM {
        return None;
    }
    let answer = grounds.model.walls.answer(hit.surface);
    let (mut sum_w_m2, mut sum) = (0.0, 0.0);
    for &(zone, share) in around {
        let Some(number) = grounds.patches.like(zone as u32, hit.facing(), answer) else { continue };
        let Some(patch) = grounds.patches.list.get(number as usize) else { continue };
        let start = grounds.patches.starts.get(patch.starts.start);
        if start.is_some_and(|start| start.normal.dot(normal) > PARALLEL_FROM) {
            sum_w_m2 += share * network.reflected_w_m2.iter().map(|column| column[number as usize]).sum::<f64>();
            sum += share;
        }
    }
    (sum > 0.0).then(|| sum_w_m2 / sum)
}
