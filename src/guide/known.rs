//! What does a guided tracer need to know, and no more?
//!
//! The light on the walls and in the zones of the void, and which of these places speaks for a point. Everything else of a
//! [`Guide`](super::Guide) is for other renderers, and costs as much again.

use super::{places, shine::Shine, staged};
use crate::flow::network::lines::Line;
use crate::flow::network::{Grounds, Network, Quality};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Guiding, Incident, Settings};
use crate::model::{Model, Probe};
use glam::Vec3;
use rayon::prelude::*;

/// The network that a guide is made from: places half as far apart again as where irradiance is read guide as well, to within a
/// fifth, for half the cost.
pub const QUALITY: Quality = Quality { spacing: 0.55, lines: 16, ..Quality::MEDIUM };

/// The light in a model, by place.
pub struct Known<'a> {
    /// What measured it.
    pub network: Network<'a>,
    /// On walls: one place for each patch of the network, in their order.
    pub walls: Vec<Incident>,
    /// In the open: one place for each zone, in their order.
    pub zones: Vec<Incident>,
}

/// The light in a model at all places; `settings` gives the seed. Costs a network of that quality and half as much again.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn known<'a>(
    model: &'a Model,
    quality: &Quality,
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Known<'a>, Cancelled> {
    Ok(known_by_lines(model, quality, settings, progress, cancel)?.0)
}

/// The same, and the lines that showed it.
pub(super) fn known_by_lines<'a>(
    model: &'a Model,
    quality: &Quality,
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<(Known<'a>, Vec<Line>), Cancelled> {
    // The part of each emitter comes by a cheaper way.
    let settings = &Settings { shares: false, ..*settings };
    let (mut network, lines) = Network::new(model, quality, settings, progress, cancel)?;
    // A path may come to any wall, also where no point fell.
    let Grounds { zones, patches, .. } = &mut network.grounds;
    patches.fill_gaps(zones);
    let (walls, zones) = staged("lobes", progress, cancel, || {
        let ends_w_m2 = places::sent_by_ends(&Shine::new(&network), &lines);
        let walls = || places::at_walls(&network, &lines, &ends_w_m2);
        rayon::join(walls, || places::in_zones(&network, &lines, &ends_w_m2, settings.seed))
    })?;
    Ok((Known { network, walls, zones }, lines))
}

impl Known<'_> {
    /// Which place speaks for a point (metres), walls counted before zones: with the normal of the surface it lies on that of a
    /// wall that looks the same way, where there is one, else that of the zone it lies in. `None` where no void of ours is.
    ///
    /// Costs a few look-ups among the voxels, no ray.
    pub fn place_of(&self, point_m: Vec3, normal: Option<Vec3>) -> Option<u32> {
        let Grounds { model, zones, patches, .. } = &self.network.grounds;
        let on_wall = normal.and_then(|normal| patches.near(model, zones, point_m, normal));
        on_wall.or_else(|| {
            let node = model.skeleton.nearest.node(model.voxels.lattice.voxel_at(point_m))?;
            Some(self.walls.len() as u32 + zones.at(node, point_m))
        })
    }

    /// What comes to some points that are worth some hundred rays each, sensors or pixels; 0.3 ms a point on one thread.
    ///
    /// # Errors
    /// [`Cancelled`] when `cancel` was raised.
    pub fn at_probes(&self, probes: &[Probe], seed: u64, cancel: &Cancel) -> Result<Vec<Incident>, Cancelled> {
        let shine = Shine::new(&self.network);
        let at_probe = |(number, probe): (usize, &Probe)| {
            cancel.check()?;
            Ok(places::at_probe(&self.network, &shine, probe, seed, number as u64))
        };
        probes.par_iter().enumerate().map(at_probe).collect()
    }

    /// What a guided tracer reads; `at_sensors` is what [`Known::at_probes`] gives for the scene's sensors, `place_of` is
    /// [`Known::place_of`].
    pub fn guiding<'b>(
        &'b self,
        at_sensors: &'b [Incident],
        place_of: &'b (dyn Fn(Vec3, Option<Vec3>) -> Option<u32> + Sync),
    ) -> Guiding<'b> {
        let shared = (self.walls.len() + self.zones.len()) as u32;
        Guiding {
            places: self.walls.iter().chain(&self.zones).chain(at_sensors).collect(),
            at_sensors: (shared..shared + at_sensors.len() as u32).collect(),
            place_of,
        }
    }
}
