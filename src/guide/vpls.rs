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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::network::Quality;
    use crate::flow::tests::{FLUX_W, lamp, modelled, two_rooms};
    use crate::guide::places::radiosity_w_m2;
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;
    use glam::Vec3;

    #[test]
    fn all_reflected_flux_shines_from_walls_into_rooms_that_it_lights() {
        let (_, model) = modelled(&two_rooms(), vec![lamp(Vec3::new(2.0, 0.5, 1.5), FLUX_W)], Vec::new());
        let (network, _) = Network::new(&model, &Quality::COARSE, &Settings::default(), &Quiet, &Cancel::new())
            .expect("nobody stops it");
        let sent = radiosity_w_m2(&network);
        let all_w: f64 = network.grounds.patches.list.iter().zip(&sent).map(|(patch, sent)| patch.area_m2 * sent).sum();
        for count in [1, 100, 1000] {
            let lights = virtual_lights(&network, &sent, count);
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
                assert!(!(is_first && light.cell != 0) && !(is_second && light.cell != 1), "{light:?}");
                let before_m = light.position_m + 0.05 * light.normal;
                let beyond = before_m.cmplt(Vec3::ZERO).any() || before_m.cmpgt(Vec3::new(8.0, 3.0, 3.0)).any();
                let within = before_m.x > 3.8 && before_m.x < 4.2 && before_m.y < 2.0;
                assert!(!beyond && !within, "{light:?} shines into a wall");
            }
        }
        assert!(virtual_lights(&network, &vec![0.0; sent.len()], 100).is_empty());
    }
}
