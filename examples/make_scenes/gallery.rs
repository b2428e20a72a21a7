//! The poster's kind of scene: a storey of rooms and corridors, one point light, seven points from lit to dark.
//!
//! Its sensors, light and reflectances were fixed before any estimate was seen.

use glam::DVec3;

use crate::boxes::Plan;
use crate::scene::{Light, Scene, Sensor, Table, Variant, scalar};

/// How many sensors the chart's table holds.
const SPREAD: usize = 200;

/// How far the spread sensors keep from walls: two voxels of 0.1 m, so that they measure the room and not a voxel.
const CLEARANCE_M: f64 = 0.2;

/// Where the one light is, and how far the spread sensors keep from it: nearer, one sensor would outshine all others.
const LIGHT: DVec3 = DVec3::new(1.83, 1.37, 2.21);
const LIGHT_CLEARANCE_M: f64 = 0.7;

/// Hall, side room and store below the corridor, three rooms and an alcove above it, all with doors to the corridor
/// but the alcove; doors between neighbours close several rings.
fn plan() -> Plan {
    let (height, door) = (3.03, 2.13);
    Plan::default()
        // Hall, side room, store; corridor.
        .void([0.0, 0.0, 0.0], [6.43, 5.31, height])
        .void([6.67, 0.0, 0.0], [12.21, 5.31, height])
        .void([12.47, 0.0, 0.0], [19.94, 5.31, height])
        .void([0.0, 5.56, 0.0], [19.94, 7.13, height])
        // Three rooms above the corridor, and an alcove behind the last.
        .void([0.0, 7.37, 0.0], [7.18, 14.92, height])
        .void([7.41, 7.37, 0.0], [13.06, 14.92, height])
        .void([13.31, 7.37, 0.0], [19.94, 11.02, height])
        .void([13.31, 11.27, 0.0], [19.94, 14.92, height])
        // Hall to side room to store, and each of them to the corridor.
        .void([6.43, 2.07, 0.0], [6.67, 3.29, door])
        .void([12.21, 0.97, 0.0], [12.47, 2.02, door])
        .void([1.31, 5.31, 0.0], [2.44, 5.56, door])
        .void([8.31, 5.31, 0.0], [9.43, 5.56, door])
        .void([17.09, 5.31, 0.0], [18.07, 5.56, door])
        // Corridor to the rooms above, the last by a wide opening; between the first two; the last to its alcove.
        .void([4.23, 7.13, 0.0], [5.31, 7.37, door])
        .void([8.67, 7.13, 0.0], [9.73, 7.37, door])
        .void([15.61, 7.13, 0.0], [18.83, 7.37, 2.61])
        .void([7.18, 12.61, 0.0], [7.41, 13.57, door])
        .void([15.23, 11.02, 0.0], [18.41, 11.27, 2.61])
        // A pillar in the first room.
        .solid([2.73, 10.57, 0.0], [3.29, 11.09, height])
}

/// The first `count` points of the R3 sequence (M. Roberts 2018, powers of the root of x^4 = x + 1) that lie clear in
/// the void.
fn spread(plan: &Plan, count: usize) -> Vec<Sensor> {
    const RATIOS: DVec3 = DVec3::new(0.819_172_513_396_164, 0.671_043_606_703_789, 0.549_700_477_901_970);
    let (low, high) = plan.bounds();
    (1..)
        .map(|i| low + (high - low) * (RATIOS * f64::from(i) + 0.5).fract())
        .filter(|p| plan.is_clear(*p, CLEARANCE_M) && p.distance(LIGHT) > LIGHT_CLEARANCE_M)
        .take(count)
        .enumerate()
        .map(|(i, p)| scalar(format!("p{:03}", i + 1), p.to_array()))
        .collect()
}

/// The gallery at three reflectances, and its 200 sensors for charts.
pub fn gallery() -> Scene {
    let plan = plan();
    let variant =
        |name, about, reflectance, sensors, reference| Variant { name, about, reflectance, sensors, reference };
    Scene {
        name: "gallery",
        mesh: plan.mesh(|_| ""),
        materials: vec![],
        lights: vec![Light::Point { position: LIGHT, flux_w: 100.0 }],
        voxel_m: 0.1,
        tables: vec![
            Table {
                file: "sensors.csv",
                about: "A sees the light, C its beam through a door; B to G lie ever deeper: corridor, side room, store, a room above.",
                sensors: vec![
                    scalar("A", [3.67, 2.29, 1.31]),
                    scalar("B", [2.17, 6.43, 1.23]),
                    scalar("C", [9.23, 3.51, 1.27]),
                    scalar("D", [8.87, 1.13, 1.33]),
                    scalar("E", [6.31, 6.47, 1.29]),
                    scalar("F", [14.21, 2.59, 1.21]),
                    scalar("G", [3.17, 9.41, 1.37]),
                ],
            },
            Table {
                file: "sensors_200.csv",
                about: "200 sensors spread over the void, at least 0.2 m from any wall and 0.7 m from the light.",
                sensors: spread(&plan, SPREAD),
            },
        ],
        variants: vec![
            variant(
                "gallery",
                "Rooms and corridors, one point light, seven scalar sensors from lit to dark.",
                0.5,
                "sensors.csv",
                "reference.csv",
            ),
            variant("gallery_r02", "The gallery with dark walls.", 0.2, "sensors.csv", "reference_r02.csv"),
            variant("gallery_r08", "The gallery with bright walls.", 0.8, "sensors.csv", "reference_r08.csv"),
            variant(
                "gallery_200",
                "The gallery with 200 sensors, for charts of speed against accuracy.",
                0.5,
                "sensors_200.csv",
                "reference_200.csv",
            ),
        ],
    }
}
