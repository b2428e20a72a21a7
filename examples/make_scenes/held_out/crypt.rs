//! Six-sided vaults in a ring and a tail that leads away from it, dark walls, no wall along an axis.

use glam::{DVec2, DVec3};

use crate::prisms::{Roof, Rooms};
use crate::scene::{Light, Scene, Table, Variant, planar, scalar};
use crate::seen::seen;

/// How far the plan is turned.
const TURN_DEG: f64 = 23.0;

/// From a vault's middle to its walls, and from one vault's middle to the next one's.
const APOTHEM_M: f64 = 2.2;
const SPACING_M: f64 = 4.75;

const DOOR_WIDTH_M: f64 = 0.8;
const DOOR_M: [f64; 2] = [0.0, 1.95];

/// The way that many sixths of a turn from x.
fn way(sixths: i32) -> DVec2 {
    DVec2::from_angle(f64::from(sixths) * std::f64::consts::FRAC_PI_3)
}

/// The vaults' middles: six in a ring about a pier, two more on a bent line away from the fifth.
fn middles() -> [DVec2; 8] {
    let on = |i: i32| way(i) * SPACING_M;
    [on(0), on(1), on(2), on(3), on(4), on(5), on(4) * 2.0, on(4) * 2.0 + on(3)]
}

fn rooms() -> Rooms {
    let middles = middles();
    let mut rooms = Rooms::default();
    for (i, middle) in middles.iter().enumerate() {
        let corner = |k: i32| (*middle + (way(k) + way(k + 1)) * (APOTHEM_M / 1.5)).to_array();
        // Eaves and peaks differ from vault to vault.
        let (eaves_m, peak_m) = (2.5 + 0.15 * (i % 3) as f64, 3.3 + 0.25 * (i % 4) as f64);
        rooms = rooms.room(&[0, 1, 2, 3, 4, 5].map(corner), 0.0, |_| eaves_m, Roof::Peak([middle.x, middle.y, peak_m]));
    }
    // Each door off the middle of its wall, to one side and the other, so that no line of sight runs through two rooms.
    let doors =
        [(0, 1, 0.6), (1, 2, -0.5), (2, 3, 0.6), (3, 4, 0.55), (4, 5, -0.6), (5, 0, 0.5), (4, 6, -0.6), (6, 7, 0.5)];
    for (a, b, aside_m) in doors {
        let aside = (middles[b] - middles[a]).normalize().perp() * aside_m;
        let line = [middles[a] + aside, middles[b] + aside].map(|p| p.to_array());
        rooms = rooms.door([a, b], line, DOOR_WIDTH_M, DOOR_M);
    }
    rooms
}

/// The crypt.
pub fn crypt() -> Result<Scene, String> {
    let mesh = rooms().mesh(false);
    let middles = middles();
    let at = |vault: usize, x: f64, y: f64, z: f64| [middles[vault].x + x, middles[vault].y + y, z];
    let sensors = vec![
        scalar("v0_1", at(0, 0.93, -1.07, 1.31)),
        scalar("v0_2", at(0, -1.17, 0.41, 2.03)),
        scalar("v1_1", at(1, 0.37, -0.83, 1.17)),
        scalar("v1_2", at(1, -0.71, 0.97, 1.73)),
        scalar("v2_1", at(2, 0.61, 0.43, 1.27)),
        scalar("v2_2", at(2, -0.87, -0.59, 0.83)),
        scalar("v3_1", at(3, 0.53, 0.71, 1.41)),
        scalar("v3_2", at(3, 0.31, -0.97, 1.09)),
        scalar("v4_1", at(4, -0.43, 0.67, 1.33)),
        scalar("v4_2", at(4, 0.89, -0.37, 1.87)),
        scalar("v5_1", at(5, 0.27, 0.91, 1.21)),
        scalar("v5_2", at(5, -0.97, -0.61, 0.97)),
        scalar("v6_1", at(6, 0.67, 0.47, 1.37)),
        scalar("v6_2", at(6, -0.73, -0.31, 1.13)),
        planar("v0_free", at(0, 1.13, 0.87, 1.57), [-0.8, -0.36, 0.48]),
        seen(&mesh, "v0_vault", at(0, 0.4, -0.9, 1.2), [0.2, -0.17, 1.0])?,
        seen(&mesh, "v1_wall", at(1, 0.3, 0.4, 1.3), [0.81, 0.2, 0.21])?,
        seen(&mesh, "v2_floor", at(2, 0.4, -0.5, 1.0), [0.13, 0.31, -1.0])?,
        seen(&mesh, "v3_wall", at(3, 0.3, 0.2, 1.2), [0.41, 0.9, 0.13])?,
        seen(&mesh, "v4_vault", at(4, -0.3, 0.5, 1.1), [-0.35, -0.3, 1.0])?,
        seen(&mesh, "v5_wall", at(5, 0.2, -0.3, 1.1), [0.9, -0.33, 0.07])?,
        seen(&mesh, "v6_floor", at(6, 0.3, 0.2, 1.1), [0.07, -0.21, -1.0])?,
    ];
    let light = middles[0] + DVec2::new(0.37, 0.53);
    let scene = Scene {
        name: "crypt",
        mesh,
        materials: vec![],
        lights: vec![Light::Point { position: DVec3::new(light.x, light.y, 2.17), flux_w: 100.0 }],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "v0_* to v6_*: in the vaults, the light in v0, v1 to v5 about the pier, v6 behind v4. Those with a\n\
                    normal are irradiance, 1 mm off their wall, *_free in the air.",
            sensors,
        }],
        variants: vec![Variant {
            name: "crypt",
            about: "Eight six-sided vaults, six of them about a pier, narrow doors, dark walls, one light.",
            reflectance: 0.3,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    };
    Ok(scene.turned(TURN_DEG))
}
