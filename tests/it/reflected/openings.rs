//! Necks as places to aim at, and as lamps.

use super::super::modelled::scene as scene_of;
use super::{CASTING, daylit, even_sky, map, modelled, near, room};
use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::points;
use lightvein::daylight::reflect;
use lightvein::daylight::reflect::heuristics::{by_heuristic, openings};
use lightvein::daylight::reflect::skylight::Skylight;
use lightvein::flow::network::Quality;
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::Method;
use lightvein::sky::dome::SkyModel;

/// Through a window the few rays that are aimed find the sky that many rays by the cosine find.
#[test]
fn rays_through_necks_find_the_sky_that_many_rays_find() {
    let map = map(SkyModel::Perez);
    let mut scene = scene_of("outdoor/office");
    scene.sensors.retain(|sensor| sensor.id.starts_with("room_"));
    let model = modelled(&scene, 0.2);
    let (points, light) = (points(&scene.sensors), Skylight::new(&map, 0.0));
    let few = Casting { sun_rays: Some(1), sky_rays: 512, seed: 3 };
    let many = Casting { sun_rays: Some(1), sky_rays: 200_000, seed: 4 };
    let truth = cast(&model.rays, &points, &map, 0.0, many, &Quiet, &Cancel::new()).unwrap();
    let quality = Quality::COARSE;
    let found = reflect::by_network(&model, &points, &light, &quality, few, &Quiet, &Cancel::new()).unwrap();
    let plain = cast(&model.rays, &points, &map, 0.0, few, &Quiet, &Cancel::new()).unwrap();
    let (mut aimed_off, mut plain_off, mut within) = (0.0, 0.0, 0);
    for ((truth, found), plain) in truth.iter().zip(&found).zip(&plain) {
        let (sky, error) = found.sky_through_necks.expect("a room with a window");
        within += usize::from((sky - truth.sky_kwh_m2).abs() <= 3.0 * error + 0.05);
        println!("{:.3} aimed, {:.3} by the cosine, {:.3} by many", sky, plain.sky_kwh_m2, truth.sky_kwh_m2);
        let off = |sky: f64| (sky / truth.sky_kwh_m2.max(0.1) - 1.0).powi(2);
        aimed_off += off(sky.max(0.1));
        plain_off += off(plain.sky_kwh_m2.max(0.1));
    }
    let [aimed_off, plain_off] = [aimed_off, plain_off].map(|sum: f64| (sum / truth.len() as f64).sqrt());
    println!("aimed off by a share of {aimed_off:.3}, by the cosine alone {plain_off:.3}");
    assert!(aimed_off < 0.5 * plain_off && within + 2 >= truth.len(), "{aimed_off} {plain_off} {within}");
}

/// A window of 2.4 m2 in a wall, under an even sky above nothing: half the sky falls on the wall.
#[test]
fn an_opening_passes_what_falls_on_it_and_diffusion_carries_it() {
    let sky = even_sky();
    for (pane, passes) in [(None, 1.0), (Some(0.6), 0.6)] {
        // Black ground before the room, and a post that gives the open a height.
        let built = room(0.8, pane).material(0.0, 0.0);
        let built = built.quad(2, [-5.0, -12.0, 0.0], [16.0, 0.0, 0.0], [0.0, 12.0, 0.0]);
        let built = built.quad(2, [10.0, -12.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 6.0]);
        let built = built.sensor([3.0, -3.0, 1.0], [0.0, 0.0, 1.0]);
        let model = modelled(&built.0, 0.1);
        let light = Skylight::new(&sky, 0.0);
        let found = openings(&model, &light, 1);
        assert_eq!(found.len(), 1);
        assert!(found[0].inwards.y > 0.95 && found[0].flux_kwh[0] == 0.0, "{found:?}");
        near(found[0].flux_kwh[1], passes * 2.4 * sky.totals.dhi_kwh_m2 / 2.0, 0.06, "flux");
        let overcast = found[0].flux_kwh[2] / light.overcast_kwh_m2;
        near(overcast, passes * 2.4 * 0.3962, 0.06, "flux of the overcast sky");

        let points = points(&built.0.sensors);
        let straight = cast(&model.rays, &points, &sky, 0.0, CASTING, &Quiet, &Cancel::new()).unwrap();
        let asked = (&points[..], &straight[..]);
        let carried = by_heuristic(Method::Diffusion, model, asked, &light, CASTING, &Quiet, &Cancel::new()).unwrap();
        let (gathered, _) = daylit(&built.0, 0.1, &sky, &Quality::MEDIUM);
        // The second sensor is deep in the room, the last in the open.
        let factor = carried[1].all_kwh_m2() / gathered[1].reflected_kwh_m2;
        assert!((0.4..2.5).contains(&factor), "{factor}");
        assert_eq!(carried[4].all_kwh_m2(), 0.0);
    }
}
