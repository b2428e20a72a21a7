//! What do sun and sky bring to each patch of a network?
//!
//! The points at which lines start on a patch are asked, each for some suns and some of the sky, more in rooms, where few of
//! either show. At a place that a sensor sees large, the same is asked at that place.

use super::openings::is_open;
use super::skylight::{Asked, Asking, COLUMNS, Skylight};
use crate::flow::network::gather::{Arriving, Place, necks_of};
use crate::flow::network::landing::Landing;
use crate::flow::network::patches::{Patch, Start};
use crate::flow::network::walk::{End, walk};
use crate::flow::network::{Grounds, Network};
use crate::flow::sequence;
use crate::job::{Cancel, Cancelled};
use rayon::prelude::*;

/// Suns of all points of patches in the open together: where these are few, each asks more, for a room whose window opens onto
/// the box around the mesh is in the open too.
const ALL_SUNS: u32 = 1_000_000;
const SUNS_A_POINT: (u32, u32) = (8, 64);

/// At a point of a patch in a room.
const INDOORS: Asking = Asking { suns: 64, sky_rays: 8, neck_rays: 8 };

/// At a place that a ray of a sensor meets.
const AT_PLACE_OUTDOORS: Asking = Asking { suns: 4, sky_rays: 4, neck_rays: 0 };
const AT_PLACE_INDOORS: Asking = Asking { suns: 16, sky_rays: 4, neck_rays: 2 };

/// At the place that the next ray meets.
const AT_NEXT_PLACE: Asking = Asking { suns: 2, sky_rays: 2, neck_rays: 0 };

/// Light of less than this share of all at a patch is not asked for at places of it.
const LEAST_SHARE: f64 = 0.02;

/// Offsets of the sequences at patches start here, and at places, apart from those of the estimators.
const PATCH_OFFSETS: u64 = 1 << 48;
const PLACE_OFFSETS: u64 = 1 << 49;

/// The light of a period on a scene that was modelled.
pub struct Falling<'a> {
    /// Sun and skies.
    pub light: &'a Skylight<'a>,
    /// For each cell whether it is in the open.
    pub open: &'a [bool],
    /// Seed of the sequences.
    pub seed: u64,
}

impl Falling<'_> {
    /// What lands on each patch, kWh: beam, sky, overcast sky. What leaves the scene is not counted.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn on_patches(&self, grounds: &Grounds, cancel: &Cancel) -> Result<Vec<Landing>, Cancelled> {
        let points = u32::try_from(grounds.patches.starts.len()).unwrap_or(u32::MAX).max(1);
        let suns = (ALL_SUNS / points).clamp(SUNS_A_POINT.0, SUNS_A_POINT.1);
        let outdoors = Asking { suns, sky_rays: suns, neck_rays: 0 };
        let on_patch = |(number, patch): (usize, &Patch)| {
            cancel.check()?;
            let starts = &grounds.patches.starts[patch.starts.clone()];
            let offset = sequence::offset(self.seed, PATCH_OFFSETS + number as u64);
            let (mut lands_kwh_m2, mut leaves_kwh_m2) = ([0.0; COLUMNS], [0.0; COLUMNS]);
            for (point, start) in starts.iter().enumerate() {
                let brought = self.at(grounds, patch, start, outdoors, INDOORS, sequence::square(point as u32, offset));
                for (column, brought_kwh_m2) in brought.into_iter().enumerate() {
                    lands_kwh_m2[column] += brought_kwh_m2;
                    leaves_kwh_m2[column] += brought_kwh_m2 * f64::from(start.answer.reflects);
                }
            }
            let each_m2 = patch.area_m2 / starts.len().max(1) as f64;
            Ok([lands_kwh_m2, leaves_kwh_m2].map(|columns| columns.map(|sum| sum * each_m2)))
        };
        let rows: Vec<[[f64; COLUMNS]; 2]> =
            grounds.patches.list.par_iter().enumerate().map(on_patch).collect::<Result<_, Cancelled>>()?;
        let column = |part: usize, column: usize| rows.iter().map(|row| row[part][column]).collect();
        let landing = |number| Landing { flux_w: column(0, number), reflected_w: column(1, number), lost_w: 0.0 };
        Ok((0..COLUMNS).map(landing).collect())
    }

    /// What arrives at a place of a patch in the stead of the patch's means, as
    /// [`Sharpen`](crate::flow::network::gather::Sharpen) has it: what lands straight, and in the open, where a patch is as
    /// large as a street is wide and a balcony is not, what is reflected by the patch that one more ray meets.
    pub fn sharpen(&self, network: &Network, place: &Place, arriving: Arriving) {
        let grounds = &network.grounds;
        let Place { at, all_w_m2: all_kwh_m2, .. } = *place;
        let Some(patch) = grounds.patches.list.get(place.patch as usize) else { return };
        // A number of its own for each place.
        let bits = at.position_m.to_array().map(|along| u64::from(along.to_bits()));
        let number = PLACE_OFFSETS ^ bits[0] ^ bits[1] << 16 ^ bits[2] << 31;
        let offset = sequence::offset(self.seed, number);
        if arriving.landing_w_m2.iter().any(|landing| *landing > LEAST_SHARE * all_kwh_m2) {
            let brought = self.at(grounds, patch, &at, AT_PLACE_OUTDOORS, AT_PLACE_INDOORS, offset);
            arriving.landing_w_m2.copy_from_slice(&brought);
        }
        if is_open(self.open, grounds.zones.cell(patch.zone)) {
            arriving.reflected_w_m2.copy_from_slice(&self.sent_to(network, &at, [offset[1], offset[0]]));
        }
    }

    fn at(
        &self,
        grounds: &Grounds,
        patch: &Patch,
        start: &Start,
        outdoors: Asking,
        indoors: Asking,
        offset: [f64; 2],
    ) -> [f64; COLUMNS] {
        let rays = &grounds.model.rays;
        let from_m = start.position_m + start.normal * rays.epsilon_m();
        let cell = grounds.zones.cell(patch.zone);
        let asked = Asked { from_m, normal: Some(start.normal), necks: &[], offset };
        if is_open(self.open, cell) {
            return self.light.at_point(rays, &asked, outdoors);
        }
        let necks = necks_of(&grounds.portals, cell, from_m);
        self.light.at_point(rays, &Asked { necks: &necks, ..asked }, indoors)
    }

    /// What the places send that one ray from a place meets, kWh/m2: the place's irradiance by reflected light.
    fn sent_to(&self, network: &Network, at: &Start, random: [f64; 2]) -> [f64; COLUMNS] {
        let grounds = &network.grounds;
        let direction = sequence::cosine_about(at.normal, random);
        let from_m = at.position_m + at.normal * grounds.model.rays.epsilon_m();
        let mut sums = [0.0; COLUMNS];
        let Some(walk) = walk(grounds, from_m, direction) else { return sums };
        let mut share = 1.0;
        let mut add = |number: u32, at: &Start| {
            let patch = &grounds.patches.list[number as usize];
            let offset = sequence::square(1, random);
            let lands_kwh_m2 = self.at(grounds, patch, at, AT_NEXT_PLACE, AT_NEXT_PLACE, offset);
            for (column, sum) in sums.iter_mut().enumerate() {
                let arrives_kwh_m2 = lands_kwh_m2[column] + network.reflected_w_m2[column][number as usize];
                *sum += share * f64::from(at.answer.reflects) * arrives_kwh_m2;
            }
            share *= f64::from(at.answer.passes);
        };
        walk.panes.iter().for_each(|pane| add(pane.sides[0], &pane.at));
        if let End::Patch(patch) = walk.end {
            add(patch, &walk.at);
        }
        sums
    }
}
