//! Scenes whose light has a closed form.

use super::{Built, daylit, even_sky, map, near};
use glam::Vec3;
use lightvein::flow::network::Quality;
use lightvein::sky::dome::SkyModel;
use std::f64::consts::PI;

/// A sphere of triangles, seen from inside, open above `rim` of its radius; the share of the whole that is wall.
fn bowl(radius_m: f32, rim: f64, reflectance: f32) -> (Built, f64) {
    let mut built = Built::default().material(reflectance, 0.0);
    let (rings, sectors) = (36, 72);
    let at = |ring: usize, sector: usize| {
        // Equal steps of angle from the nadir up to the rim.
        let angle = rim.acos() + (PI - rim.acos()) * (1.0 - ring as f64 / rings as f64);
        let turn = 2.0 * PI * (sector % sectors) as f64 / sectors as f64;
        radius_m * Vec3::new((angle.sin() * turn.cos()) as f32, (angle.sin() * turn.sin()) as f32, angle.cos() as f32)
    };
    for ring in 0..rings {
        for sector in 0..sectors {
            let [a, b, c, d] = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(up, on)| at(ring + up, sector + on));
            built.triangle(0, [a, c, b]);
            built.triangle(0, [a, d, c]);
        }
    }
    (built, (1.0 + rim) / 2.0)
}

/// Inside a sphere every piece of wall sees every other by its area alone, so under an even sky all of it is lit alike:
/// `E0 = pi L f` through an opening of share `f`, and `E = E0 / (1 - rho (1 - f))`.
#[test]
fn a_sphere_with_an_opening_has_its_closed_form() {
    let sky = even_sky();
    for (rim, reflectance) in [(0.6, 0.5), (0.9, 0.5), (0.9, 0.8)] {
        let (built, wall) = bowl(3.0, rim, reflectance);
        let built = built.sensor([0.0, 0.0, -2.98], [0.0, 0.0, 1.0]).sensor([2.98, 0.0, 0.0], [-1.0, 0.0, 0.0]);
        let (found, reflected) = daylit(&built.0, 0.15, &sky, &Quality::MEDIUM);
        let straight = sky.totals.dhi_kwh_m2 * (1.0 - wall);
        let rho = f64::from(reflectance) * wall;
        for (exposure, reflected) in found.iter().zip(&reflected) {
            near(exposure.sky_kwh_m2, straight, 0.04, "straight");
            near(exposure.reflected_kwh_m2, straight * rho / (1.0 - rho), 0.05, "reflected");
            let off = (exposure.reflected_kwh_m2 - straight * rho / (1.0 - rho)).abs();
            assert!(off < 4.0 * reflected.error_kwh_m2 + 0.01 * straight, "its own error: {off} {reflected:?}");
        }
    }
}

fn ground(half_m: f32, reflectance: f32) -> Built {
    let side = 2.0 * half_m;
    Built::default().material(reflectance, 0.0).quad(0, [-half_m, -half_m, 0.0], [side, 0.0, 0.0], [0.0, side, 0.0])
}

#[test]
fn open_ground_sends_nothing_to_itself_and_half_of_it_to_a_wall() {
    let map = map(SkyModel::Perez);
    let built = ground(200.0, 0.4);
    // A post, so that the void has a height.
    let built = built.quad(0, [150.0, 150.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 8.0]);
    let built = built.sensor([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]).sensor([0.0, 0.0, 1.0], [0.0, -1.0, 0.0]);
    let built = built.sensor([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    let (found, reflected) = daylit(&built.0, 1.0, &map, &Quality::MEDIUM);
    let sent = 0.4 * map.totals.ghi_kwh_m2;
    assert!(found[0].reflected_kwh_m2 < 1e-4 * sent, "{:?}", found[0]);
    near(found[1].reflected_kwh_m2, sent / 2.0, 0.02, "a wall");
    near(found[2].reflected_kwh_m2, sent, 0.02, "looking down");
    near(reflected[0].daylight_factor, 1.0, 0.01, "the overcast sky over open ground");
    // (2/3)(pi/4 + 2/3) of the sky over 7 pi / 9, and half of what the ground sends.
    near(reflected[1].daylight_factor, 0.3962 + 0.2, 0.02, "the overcast sky on a wall");
}
