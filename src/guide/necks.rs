//! What flows through the doorways and windows?
//!
//! Reflected light by the lines of the network that cross: these sample area times solid angle times cosine, so what one end
//! sends through is its radiosity times the line's weight, and the weights of all that cross add up to the neck's area. The
//! mean over them times the area is the flux, exact where light is even whatever the lines. Light straight from emitters by
//! shadow rays from points spread over the neck.
//!
//! Limits: where most lines through a neck end in crevices that the voxels close, the others speak for them.

use super::Opening;
use crate::flow::direct::direct;
use crate::flow::network::Network;
use crate::flow::network::lines::Line;
use crate::flow::network::portals::Portal;
use crate::flow::network::read::seen_from;
use crate::flow::sequence;
use crate::skeleton::Neck;
use rayon::prelude::*;

/// Shadow rays from a neck, shared by the lights; and the least and most points that they start from.
const SHADOW_RAYS: usize = 1024;
const LEAST_POINTS: u32 = 8;
const MOST_POINTS: u32 = 64;

/// Offsets of the sequences that place points in necks start here.
const POINT_OFFSETS: u64 = 1 << 48;

/// The necks of the skeleton in their order, with the flux through each; one without an area has none. `radiosity_w_m2` is the
/// patches' own.
pub fn openings(network: &Network, lines: &[Line], radiosity_w_m2: &[f64], seed: u64) -> Vec<Opening> {
    let necks = &network.grounds.model.skeleton.necks;
    let opening = |(number, neck): (usize, &Neck)| {
        let portal = Portal::new(neck);
        let flux_w = portal.as_ref().map_or([0.0; 2], |portal| {
            let reflected_w = reflected_w(portal, lines, radiosity_w_m2);
            let straight_w = straight_w(network, portal, sequence::offset(seed, POINT_OFFSETS + number as u64));
            [0, 1].map(|way| reflected_w[way] + straight_w[way])
        });
        Opening {
            cells: neck.cells,
            position_m: neck.position_m,
            normal: neck.normal,
            area_m2: portal.map_or(neck.area_m2, |portal| portal.area_m2 as f32),
            outline_m: neck.outline_m.clone(),
            flux_w,
        }
    };
    necks.par_iter().enumerate().map(opening).collect()
}

/// What walls send through, along the normal and against it, W.
fn reflected_w(portal: &Portal, lines: &[Line], radiosity_w_m2: &[f64]) -> [f64; 2] {
    let (mut sums_w, mut weight_m2) = ([0.0; 2], 0.0);
    for line in lines {
        let Some(crossing) = portal.crossing(line.from_m, line.direction, line.length_m) else { continue };
        let before = |at_m: f32| at_m < crossing.distance_m;
        let panes_before =
            line.panes.iter().filter(|pane| before((pane.at.position_m - line.from_m).dot(line.direction)));
        let [behind, ahead] = seen_from(line, panes_before.count(), radiosity_w_m2);
        let along = line.direction.dot(portal.normal) > 0.0;
        let [forwards, back] = if along { [behind, ahead] } else { [ahead, behind] };
        sums_w[0] += line.weight_m2 * forwards;
        sums_w[1] += line.weight_m2 * back;
        weight_m2 += line.weight_m2;
    }
    sums_w.map(|sum_w| if weight_m2 > 0.0 { portal.area_m2 * sum_w / weight_m2 } else { 0.0 })
}

/// What emitters send straight through, along the normal and against it, W.
fn straight_w(network: &Network, portal: &Portal, offset: [f64; 2]) -> [f64; 2] {
    let model = network.grounds.model;
    let lamps: Vec<usize> = network.lamps().map(|lamp| lamp.emitter).collect();
    let points = ((SHADOW_RAYS / lamps.len().max(1)) as u32).clamp(LEAST_POINTS, MOST_POINTS);
    let mut sums_w_m2 = [0.0; 2];
    for point in 0..points {
        let at_m = portal.point_m(point, points, offset);
        let turned = sequence::square(point, [offset[1], offset[0]]);
        for &lamp in &lamps {
            // What flows along the normal lands on the side that looks back.
            for (sum_w_m2, normal) in sums_w_m2.iter_mut().zip([-portal.normal, portal.normal]) {
                *sum_w_m2 += direct(model, at_m, Some(normal), lamp, 1, turned).value_w_m2;
            }
        }
    }
    sums_w_m2.map(|sum_w_m2| portal.area_m2 * sum_w_m2 / f64::from(points))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::network::Quality;
    use crate::flow::tests::{FLUX_W, lamp, modelled, two_rooms};
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;
    use glam::Vec3;
    use std::f64::consts::PI;

    /// The one neck of two rooms with a lamp of that flux in the first, whose patches have that radiosity by their cell.
    fn neck(flux_w: f64, radiosity_w_m2: [f64; 2]) -> Opening {
        let (_, model) = modelled(&two_rooms(), vec![lamp(Vec3::new(2.0, 2.5, 1.5), flux_w)], Vec::new());
        let quality = Quality::MEDIUM;
        let (network, lines) =
            Network::new(&model, &quality, &Settings::default(), &Quiet, &Cancel::new()).expect("nobody stops it");
        let zones = &network.grounds.zones;
        let patches = &network.grounds.patches.list;
        let radiosity_w_m2: Vec<f64> =
            patches.iter().map(|patch| radiosity_w_m2[zones.cell(patch.zone) as usize]).collect();
        let mut found = openings(&network, &lines, &radiosity_w_m2, 0);
        assert_eq!((found.len(), found[0].cells), (1, [0, 1]));
        found.remove(0)
    }

    #[test]
    fn even_radiance_flows_both_ways_by_the_area() {
        let radiance_w_m2_sr = 3.0;
        let door = neck(0.0, [PI * radiance_w_m2_sr; 2]);
        assert!((door.area_m2 / 3.0 - 1.0).abs() < 0.05, "{}", door.area_m2);
        for flux_w in door.flux_w {
            let want_w = PI * radiance_w_m2_sr * f64::from(door.area_m2);
            assert!((flux_w / want_w - 1.0).abs() < 1e-5, "{flux_w} is not {want_w}");
        }
    }

    #[test]
    fn light_flows_from_the_room_that_has_it() {
        let door = neck(0.0, [5.0, 0.0]);
        let all_w = 5.0 * f64::from(door.area_m2);
        // The reveals of the door belong to either room, and light from one to the other may cross the neck both ways.
        assert!(door.flux_w[0] > 0.8 * all_w && door.flux_w[1] < 0.2 * all_w, "{:?} of {all_w}", door.flux_w);
    }

    #[test]
    fn a_lamp_sends_through_what_its_solid_angle_says() {
        let door = neck(FLUX_W, [0.0; 2]);
        // A rectangle of 1 x 3 m squarely before the lamp.
        let (a, b, d) = (0.5_f64, 1.5_f64, f64::from(door.position_m.x) - 2.0);
        let angle_sr = 4.0 * (a * b / ((a * a + d * d) * (b * b + d * d)).sqrt()).asin();
        let want_w = FLUX_W * angle_sr / (4.0 * PI);
        assert!((door.flux_w[0] / want_w - 1.0).abs() < 0.05, "{} is not {want_w}", door.flux_w[0]);
        assert_eq!(door.flux_w[1], 0.0);
    }
}
