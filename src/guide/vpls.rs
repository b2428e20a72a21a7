//! Which few points shine as all walls do?
//!
//! Instant radiosity (Keller 1997), without its random walks: the network knows what each patch sends out by all reflections.
//! Every room has some lights, in proportion to what its walls send out and a few at least, so that dark rooms are not left to
//! chance. Within a room all are about equal: they stand where equal portions of its flux begin, in the order of its zones
//! (systematic sampling), at the points of the patches.

use super::VirtualLight;
use super::shine::Shine;
use crate::flow::network::Network;
use crate::flow::network::patches::Start;

/// Fewest lights of a room that reflects any light, where there are enough to go round.
const LEAST_IN_ROOM: usize = 8;

/// A point of a wall and what the wall around it sends out.
struct Source<'a> {
    start: &'a Start,
    cell: u32,
    flux_w: f64,
}

/// About `count` lights whose flux adds up to all that the patches send out.
///
/// A room's share is rounded, so there may be a light more or less a room; never more lights than points on walls.
pub fn virtual_lights(network: &Network, shine: &Shine, count: usize) -> Vec<VirtualLight> {
    let sources = sources(network, shine);
    let all_w: f64 = sources.iter().map(|source| source.flux_w).sum();
    // Patches are listed by zone and zones by cell, so a room's points are in a row.
    let rooms: Vec<&[Source]> = sources.chunk_by(|a, b| a.cell == b.cell).collect();
    let least = LEAST_IN_ROOM.min(count / (2 * rooms.len()).max(1)).max(1);
    let rest = count.saturating_sub(least * rooms.len()) as f64;

    let mut lights = Vec::with_capacity(count + rooms.len());
    for room in rooms {
        let room_w: f64 = room.iter().map(|source| source.flux_w).sum();
        if !(room_w > 0.0 && room_w.is_finite()) {
            continue;
        }
        let wanted = least + (rest * room_w / all_w).round() as usize;
        let portion_w = room_w / wanted as f64;
        let (mut up_to_w, mut placed) = (0.0, 0);
        for &Source { start, cell, flux_w } in room {
            up_to_w += flux_w;
            // Portions whose middle falls to this point.
            let begun = ((up_to_w / portion_w + 0.5).floor() as usize).min(wanted);
            if begun > placed {
                let flux_w = (begun - placed) as f64 * portion_w;
                lights.push(VirtualLight { position_m: start.position_m, normal: start.normal, flux_w, cell });
                placed = begun;
            }
        }
    }
    lights
}

/// The points of all patches, a patch's flux shared among its own by how brightly it shines there.
fn sources<'a>(network: &'a Network, shine: &Shine) -> Vec<Source<'a>> {
    let patches = &network.grounds.patches;
    let mut sources = Vec::with_capacity(patches.starts.len());
    for (number, patch) in patches.list.iter().enumerate() {
        let patch_w = shine.mean_w_m2(number as u32) * patch.area_m2;
        let starts = &patches.starts[patch.starts.clone()];
        let shines: Vec<f64> = starts.iter().map(|start| shine.at_w_m2(number as u32, start.position_m)).collect();
        let sum: f64 = shines.iter().sum();
        let cell = network.grounds.zones.cell(patch.zone);
        let part = |shines: f64| if sum > 0.0 { patch_w * shines / sum } else { 0.0 };
        let of_patch = starts.iter().zip(&shines).map(|(start, &shines)| Source { start, cell, flux_w: part(shines) });
        sources.extend(of_patch);
    }
    sources
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::network::Quality;
    use crate::flow::network::patches::Patch;
    use crate::flow::tests::{FLUX_W, lamp, modelled, two_rooms};
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;
    use glam::Vec3;

    #[test]
    fn all_reflected_flux_shines_from_walls_into_rooms_that_it_lights() {
        let (_, model) = modelled(&two_rooms(), vec![lamp(Vec3::new(2.0, 0.5, 1.5), FLUX_W)], Vec::new());
        let (network, _) = Network::new(&model, &Quality::MEDIUM, &Settings::default(), &Quiet, &Cancel::new())
            .expect("nobody stops it");
        // What lands and what comes back, by the network's own sums.
        let sent_w = |patch: usize| {
            let Patch { reflectance, area_m2, .. } = network.grounds.patches.list[patch];
            network.landings[0].reflected_w[patch] + reflectance * area_m2 * network.reflected_w_m2[0][patch]
        };
        let all_w: f64 = (0..network.grounds.patches.list.len()).map(sent_w).sum();
        let shine = Shine::new(&network);
        for count in [1, 100, 1000] {
            let lights = virtual_lights(&network, &shine, count);
            let sum_w: f64 = lights.iter().map(|light| light.flux_w).sum();
            assert!((sum_w / all_w - 1.0).abs() < 1e-9, "{count}: {sum_w} W of {all_w} W");
            assert!(lights.len() <= count + 2 && 2 * lights.len() >= count, "{} for {count}", lights.len());
            let of = |cell: u32| lights.iter().filter(move |light| light.cell == cell);
            assert!(of(0).count() > 0 && of(1).count() > 0, "a room has none of {count}");
            for light in &lights {
                assert!(light.flux_w > 0.0);
                // Beside the wall between, the side says which room it is.
                let is_first = light.position_m.x < 3.85;
                let is_second = light.position_m.x > 4.15;
                let is_elsewhere = is_first && light.cell != 0 || is_second && light.cell != 1;
                assert!(!is_elsewhere, "{light:?}");
                let before_m = light.position_m + 0.05 * light.normal;
                let beyond = before_m.cmplt(Vec3::ZERO).any() || before_m.cmpgt(Vec3::new(8.0, 3.0, 3.0)).any();
                let within = before_m.x > 3.8 && before_m.x < 4.2 && before_m.y < 2.0;
                assert!(!beyond && !within, "{light:?} shines into a wall");
            }
        }
    }
}
