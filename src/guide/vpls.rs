//! Which few points shine as all walls do?
//!
//! Instant radiosity (Keller 1997), without its random walks: the network knows what each patch sends out by all reflections.
//! Every room has some lights, in proportion to what its walls send out and a few at least, so that dark rooms are not left to
//! chance. Within a room all are about equal: they stand where equal portions of its flux begin, in the order of its zones
//! (systematic sampling), at the points of the patches.

use super::VirtualLight;
use crate::flow::network::Network;
use crate::flow::network::patches::Patch;

/// Fewest lights of a room that reflects any light, where there are enough to go round.
const LEAST_IN_ROOM: usize = 8;

/// About `count` lights whose flux adds up to all that the patches send out. `radiosity_w_m2` is the patches' own.
///
/// A room's share is rounded, so there may be a light more or less a room; never more lights than points on walls.
pub fn virtual_lights(network: &Network, radiosity_w_m2: &[f64], count: usize) -> Vec<VirtualLight> {
    let (patches, zones) = (&network.grounds.patches, &network.grounds.zones);
    let sent_w: Vec<f64> = patches.list.iter().zip(radiosity_w_m2).map(|(patch, sent)| sent * patch.area_m2).collect();
    let all_w: f64 = sent_w.iter().sum();
    let numbers: Vec<usize> = (0..patches.list.len()).collect();
    let cell = |&patch: &usize| zones.cell(patches.list[patch].zone);
    // Patches are listed by zone and zones by cell, so a room's are in a row.
    let rooms: Vec<&[usize]> = numbers.chunk_by(|a, b| cell(a) == cell(b)).collect();
    let least = LEAST_IN_ROOM.min(count / (2 * rooms.len()).max(1)).max(1);
    let rest = count.saturating_sub(least * rooms.len()) as f64;

    let mut lights = Vec::with_capacity(count + rooms.len());
    for room in rooms {
        let room_w: f64 = room.iter().map(|&patch| sent_w[patch]).sum();
        if !(room_w > 0.0 && room_w.is_finite()) {
            continue;
        }
        let wanted = least + (rest * room_w / all_w).round() as usize;
        let portion_w = room_w / wanted as f64;
        let (mut up_to_w, mut placed) = (0.0, 0);
        for &number in room {
            up_to_w += sent_w[number];
            // Portions whose middle falls to this patch.
            let begun = ((up_to_w / portion_w + 0.5).floor() as usize).min(wanted);
            let here = begun.saturating_sub(placed);
            placed = placed.max(begun);
            lights.extend(on_patch(network, &patches.list[number], here, portion_w));
        }
    }
    lights
}

/// So many portions of flux on a patch, joined where it has fewer points.
fn on_patch<'a>(
    network: &'a Network,
    patch: &'a Patch,
    portions: usize,
    portion_w: f64,
) -> impl Iterator<Item = VirtualLight> + 'a {
    let starts = &network.grounds.patches.starts[patch.starts.clone()];
    let count = portions.min(starts.len());
    let flux_w = portion_w * portions as f64 / count.max(1) as f64;
    let cell = network.grounds.zones.cell(patch.zone);
    (0..count).map(move |number| {
        let start = starts[(2 * number + 1) * starts.len() / (2 * count)];
        VirtualLight { position_m: start.position_m, normal: start.normal, flux_w, cell }
    })
}
