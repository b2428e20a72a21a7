//! Rooms under roofs of 33 to 42 degrees, no wall along an axis, low doors between them.

use glam::{DVec2, DVec3};

use crate::prisms::{Roof, Rooms};
use crate::scene::{Light, Scene, Table, Variant, planar, scalar};
use crate::seen::seen;

/// How far the plan is turned.
const TURN_DEG: f64 = 17.0;

/// A plane over the plan: its height at the origin and its slopes.
fn plane(at_origin_m: f64, slope: [f64; 2]) -> impl Fn(DVec2) -> f64 {
    move |p| at_origin_m + p.dot(slope.into())
}

/// Under the main roof; the lean-to; the turret; a store off it; the tank room behind the gable and a nook off that.
fn rooms() -> Rooms {
    // Pitched at 42 and 33 degrees.
    let main = |p: DVec2| 1.3 + (p.y * 0.9004).min(2.3 * 0.9004 - (p.y - 2.3) * 0.6494);
    Rooms::default()
        .room(&[[0.0, 0.0], [8.4, 0.0], [8.4, 2.3], [8.4, 5.2], [0.0, 5.2], [0.0, 2.3]], 0.0, main, Roof::Ridge(2, 5))
        .room(
            &[[1.6, 5.42], [6.1, 5.42], [6.1, 8.3], [1.6, 8.3]],
            0.0,
            plane(1.35 - 5.42 * 0.7002, [0.0, 0.7002]),
            Roof::Plane,
        )
        .room(
            &[[8.62, 1.7], [9.7, 0.5], [12.1, 0.4], [13.1, 1.9], [13.0, 4.98], [8.62, 4.98]],
            0.0,
            plane(2.05, [0.0, 0.0]),
            Roof::Peak([10.9, 2.7, 4.1]),
        )
        .room(&[[9.1, 5.2], [12.4, 5.2], [12.1, 7.9], [9.4, 7.6]], 0.0, plane(-4.45, [0.3, 0.62]), Roof::Plane)
        .room(&[[-0.22, -0.4], [-0.22, 3.2], [-3.2, 4.1], [-3.9, 0.3]], 0.0, plane(4.56, [0.8, 0.0]), Roof::Plane)
        .room(&[[-0.5, 3.6], [-0.9, 6.3], [-3.6, 6.0], [-3.3, 4.4]], 0.0, plane(4.31, [0.1, -0.4]), Roof::Plane)
        .door([0, 1], [[3.3, 4.0], [3.3, 6.4]], 0.8, [0.0, 1.15])
        .door([0, 2], [[7.0, 3.1], [10.0, 3.1]], 0.9, [0.0, 1.9])
        .door([2, 3], [[11.2, 4.0], [11.2, 6.0]], 0.7, [0.0, 1.3])
        .door([0, 4], [[1.0, 1.2], [-1.0, 1.2]], 0.7, [0.0, 1.2])
        .door([4, 5], [[-1.9, 2.9], [-1.7, 5.2]], 0.7, [0.0, 1.1])
}

/// The loft.
pub fn loft() -> Result<Scene, String> {
    let mesh = rooms().mesh(false);
    let sensors = vec![
        scalar("main_1", [3.73, 2.87, 1.21]),
        scalar("main_2", [6.31, 1.17, 0.93]),
        scalar("main_ridge", [5.17, 2.41, 2.87]),
        scalar("main_eaves", [7.61, 4.77, 1.03]),
        scalar("lean_1", [2.37, 6.31, 1.07]),
        scalar("lean_2", [5.43, 7.61, 2.23]),
        scalar("turret_1", [10.37, 3.71, 1.31]),
        scalar("turret_2", [12.13, 1.57, 0.87]),
        scalar("turret_peak", [10.81, 2.83, 3.61]),
        scalar("store_1", [11.07, 6.07, 1.13]),
        scalar("store_2", [10.03, 7.17, 2.31]),
        scalar("tank_1", [-1.37, 0.93, 1.17]),
        scalar("tank_2", [-2.71, 3.13, 0.71]),
        scalar("tank_top", [-0.63, 2.71, 3.13]),
        scalar("nook_1", [-1.93, 5.17, 0.83]),
        scalar("nook_2", [-3.07, 5.71, 1.23]),
        planar("main_free", [4.57, 3.61, 1.43], [0.36, 0.48, 0.8]),
        seen(&mesh, "main_roof", [5.3, 1.7, 1.1], [0.13, -0.4, 0.8])?,
        seen(&mesh, "main_floor", [6.7, 3.3, 1.0], [0.07, 0.11, -1.0])?,
        seen(&mesh, "lean_roof", [3.9, 6.9, 1.0], [0.17, 0.21, 1.0])?,
        seen(&mesh, "turret_roof", [11.3, 3.3, 1.4], [0.4, 0.2, 1.0])?,
        seen(&mesh, "store_wall", [10.7, 6.3, 1.2], [1.0, 0.31, 0.12])?,
        seen(&mesh, "tank_roof", [-1.5, 1.7, 1.0], [-0.2, 0.37, 1.0])?,
        seen(&mesh, "nook_wall", [-2.1, 5.3, 0.9], [0.21, 1.0, 0.17])?,
    ];
    let scene = Scene {
        name: "loft",
        mesh,
        materials: vec![],
        lights: vec![
            Light::Point { position: DVec3::new(2.13, 1.87, 2.41), flux_w: 60.0 },
            // Shines down and aslant, towards the turret's far corner.
            Light::Quad {
                corner: DVec3::new(10.7, 2.4, 3.2),
                u: DVec3::new(0.0, 0.5, 0.0),
                v: DVec3::new(0.36, 0.0, 0.15),
                flux_w: 12.0,
            },
        ],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "main_*: under the main roof; lean_*: in the lean-to; turret_*, store_*, tank_*, nook_*: in the rooms\n\
                    behind. Those with a normal are irradiance, 1 mm off their wall, *_free in the air.",
            sensors,
        }],
        variants: vec![Variant {
            name: "loft",
            about: "Six rooms under slanted roofs, no wall along an axis, low doors, bright walls; a point and a quad light.",
            reflectance: 0.85,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    };
    Ok(scene.turned(TURN_DEG))
}
