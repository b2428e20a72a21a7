//! What holds of any scene: energy, glazing, darkness, threads.

use super::super::modelled::scene as scene_of;
use super::{daylit, map, modelled, near, room};
use lightvein::daylight::reflect::landing::Falling;
use lightvein::daylight::reflect::openings::open_cells;
use lightvein::daylight::reflect::skylight::Skylight;
use lightvein::flow::network::{Grounds, Network, Quality};
use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Settings, Status};
use lightvein::sky::dome::SkyModel;

/// Nothing outside sends light back in, so all that comes through the window is weakened alike.
#[test]
fn glazing_weakens_all_that_comes_through_it_by_its_share() {
    let map = map(SkyModel::Perez);
    let (open, _) = daylit(&room(0.5, None).0, 0.1, &map, &Quality::FINE);
    let (glazed, _) = daylit(&room(0.5, Some(0.6)).0, 0.1, &map, &Quality::FINE);
    for (open, glazed) in open.iter().zip(&glazed) {
        assert!(open.reflected_kwh_m2 > 1.0, "{open:?}");
        near(glazed.sky_kwh_m2, 0.6 * open.sky_kwh_m2, 0.06, "sky");
        near(glazed.reflected_kwh_m2, 0.6 * open.reflected_kwh_m2, 0.06, "reflected");
    }
}

#[test]
fn black_walls_reflect_exactly_nothing() {
    let (found, reflected) = daylit(&room(0.0, None).0, 0.1, &map(SkyModel::Perez), &Quality::COARSE);
    assert!(found.iter().all(|exposure| exposure.reflected_kwh_m2 == 0.0));
    assert!(reflected.iter().all(|reflected| reflected.error_kwh_m2 == 0.0 && reflected.daylight_factor < 0.2));
}

#[test]
fn no_light_comes_into_a_sealed_room() {
    let sealed = room(0.8, None).quad(0, [2.0, 0.0, 1.0], [0.0, 0.0, 1.2], [2.0, 0.0, 0.0]);
    let (found, _) = daylit(&sealed.0, 0.1, &map(SkyModel::Perez), &Quality::COARSE);
    assert!(
        found.iter().all(|exposure| exposure.total_kwh_m2() == 0.0 && exposure.status == Status::Dark),
        "{found:?}"
    );
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (scene, map) = (room(0.5, Some(0.6)).0, map(SkyModel::Perez));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (found, reflected) = pool.install(|| daylit(&scene, 0.1, &map, &Quality::COARSE));
        format!("{found:?} {reflected:?}")
    };
    let one = on(1);
    assert_eq!(one, on(3));
}

/// Of what lands on the patches, part is absorbed at once, the rest reflected until it is absorbed or leaves.
#[test]
fn what_lands_is_absorbed_or_leaves() {
    let (map, scene) = (map(SkyModel::Perez), scene_of("outdoor/office"));
    let model = modelled(&scene, 0.2);
    let (light, open) = (Skylight::new(&map, 0.0), open_cells(&model));
    let falling = Falling { light: &light, open: &open, seed: 1 };
    let land = |grounds: &Grounds| falling.on_patches(grounds, &Cancel::new());
    let settings = Settings { shares: true, ..Settings::default() };
    let quality = Quality::MEDIUM;
    let grounds = Grounds::new(&model, &quality, 1).filled();
    let (network, _) = Network::lit_by(grounds, &quality, &settings, &land, &Quiet, &Cancel::new()).unwrap();
    for (column, landing) in network.landings.iter().enumerate() {
        let landed: f64 = landing.flux_w.iter().sum();
        let (mut ends, mut reflected) = (0.0, 0.0);
        for (number, patch) in network.grounds.patches.list.iter().enumerate() {
            let [seen_m2, lost_m2] = [network.exchange.seen_m2[number], network.exchange.lost_m2[number]];
            let arrives = network.reflected_w_m2[column][number];
            let sends = landing.reflected_w[number] + patch.reflectance * arrives * seen_m2;
            ends += landing.flux_w[number] - landing.reflected_w[number];
            ends += (1.0 - patch.reflectance) * arrives * seen_m2 + sends * lost_m2 / seen_m2.max(1e-12);
            reflected += landing.reflected_w[number];
        }
        near(ends, landed, 1e-3, "energy");
        assert!(reflected < landed && landed > 0.0);
    }
    // All that lands on the ground and what stands on it is what crosses the scene's outline, no more.
    let horizontal_m2 = 70.0 * 70.0;
    let landed: f64 = network.landings[..2].iter().flat_map(|landing| &landing.flux_w).sum();
    assert!(landed < 1.2 * horizontal_m2 * map.totals.ghi_kwh_m2, "{landed}");
}
