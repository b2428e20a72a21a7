//! Four storeys joined by stair holes and a lift shaft, with a light of every kind.

use glam::DVec3;

use crate::boxes::{Plan, floor_wall_ceiling};
use crate::scene::{Light, Material, Scene, Table, Variant, planar, scalar};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

/// Floor and ceiling of each storey.
const STOREYS: [(f64, f64); 4] = [(0.0, 2.68), (2.97, 5.71), (6.01, 8.69), (8.98, 11.72)];

fn plan() -> Plan {
    let mut plan = Plan::default();
    for (floor, ceiling) in STOREYS {
        // The storey, and its door to the lift shaft.
        plan =
            plan.void([0.0, 0.0, floor], [9.13, 6.91, ceiling]).void([9.13, 2.63, floor], [9.42, 3.57, floor + 2.06]);
    }
    plan.void([9.42, 2.31, 0.0], [10.97, 3.89, 11.72])
        // Stair holes through the slabs.
        .void([0.61, 0.47, 2.68], [2.03, 2.91, 2.97])
        .void([6.47, 4.12, 5.71], [8.31, 5.78, 6.01])
        .void([0.72, 3.94, 8.69], [2.41, 6.13, 8.98])
        // The second storey in two rooms with a doorway, a pillar in the third.
        .solid([4.41, 0.0, 2.97], [4.63, 6.91, 5.71])
        .void([4.41, 4.87, 2.97], [4.63, 5.89, 5.03])
        .solid([4.17, 2.93, 6.01], [4.73, 3.49, 8.69])
        // A block that floats in the top storey.
        .solid([5.23, 1.97, 9.83], [6.29, 2.71, 10.41])
}

/// The tower.
pub fn tower() -> Scene {
    Scene {
        name: "tower",
        mesh: plan().mesh(floor_wall_ceiling),
        materials: vec![
            Material { name: "floor", rgb: [0.45, 0.40, 0.35] },
            Material { name: "wall", rgb: [0.6, 0.6, 0.6] },
            Material { name: "ceiling", rgb: [0.75, 0.75, 0.75] },
        ],
        lights: vec![
            Light::Point { position: DVec3::new(6.83, 4.97, 2.09), flux_w: 40.0 },
            Light::Sphere { center: DVec3::new(2.37, 4.71, 4.93), radius: 0.15, flux_w: 25.0 },
            // Shines down: u x v points to -z.
            Light::Quad {
                corner: DVec3::new(6.61, 3.87, 11.67),
                u: DVec3::new(0.0, 1.2, 0.0),
                v: DVec3::new(0.6, 0.0, 0.0),
                flux_w: 60.0,
            },
        ],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "s1_* to s4_*: on the four storeys; lift_*: in the lift shaft; hole_*: in the stair holes. Those with a\n\
                    normal are irradiance; *_on lie exactly on their wall, *_off 1 mm off it.",
            sensors: vec![
                scalar("s1_a", [4.13, 3.37, 1.27]),
                scalar("s1_b", [1.57, 5.71, 0.93]),
                scalar("s1_c", [8.17, 1.09, 1.61]),
                scalar("hole_1", [1.37, 1.73, 2.83]),
                scalar("s2_a", [1.43, 1.87, 4.21]),
                scalar("s2_b", [3.61, 3.07, 3.83]),
                scalar("s2_c", [6.13, 5.37, 4.37]),
                scalar("s2_d", [7.71, 1.63, 4.13]),
                scalar("hole_2", [7.43, 4.97, 5.87]),
                scalar("s3_a", [7.29, 5.21, 7.13]),
                scalar("s3_b", [2.31, 1.49, 7.37]),
                scalar("s3_c", [1.47, 4.83, 7.59]),
                scalar("hole_3", [1.61, 5.11, 8.83]),
                scalar("s4_a", [5.67, 3.43, 10.17]),
                scalar("s4_b", [2.19, 1.27, 10.53]),
                scalar("s4_under_block", [5.83, 2.29, 9.47]),
                scalar("lift_1", [10.27, 3.01, 0.87]),
                scalar("lift_2", [10.13, 3.31, 5.93]),
                scalar("lift_3", [10.41, 2.87, 10.73]),
                planar("s1_floor_on", [4.87, 2.17, 0.0], UP),
                planar("s1_wall_off", [0.001, 4.23, 1.37], [1.0, 0.0, 0.0]),
                planar("s2_floor_off", [3.13, 5.59, 2.971], UP),
                planar("s2_ceiling_on", [7.13, 2.31, 5.71], DOWN),
                planar("s3_floor_on", [2.77, 2.63, 6.01], UP),
                planar("s3_wall_off", [4.83, 6.909, 7.27], [0.0, -1.0, 0.0]),
                planar("s4_floor_off", [6.37, 5.23, 8.981], UP),
                planar("s4_wall_on", [0.0, 1.87, 10.31], [1.0, 0.0, 0.0]),
                planar("lift_wall_off", [10.969, 3.17, 4.19], [-1.0, 0.0, 0.0]),
            ],
        }],
        variants: vec![Variant {
            name: "tower",
            about: "Four storeys joined by stair holes and a lift shaft; a point, a sphere and a quad light.",
            reflectance: 0.5,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    }
}
