//! A long corridor with rooms on either side: dark floors, grey walls, bright ceilings, lights of several kinds.

use glam::DVec3;

use crate::boxes::{Plan, floor_wall_ceiling};
use crate::scene::{Light, Material, Scene, Table, Variant, planar, scalar};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

const CEILING_M: f64 = 2.71;
const DOOR_M: f64 = 2.07;

/// Ends of the rooms along the corridor and the middle of each door, on its south and on its north side.
const SOUTH: [(f64, f64, f64); 5] =
    [(0.0, 4.63, 3.71), (4.79, 9.87, 5.63), (10.03, 13.31, 12.47), (13.47, 19.57, 17.83), (19.73, 25.13, 21.07)];
const NORTH: [(f64, f64, f64); 5] =
    [(0.0, 6.11, 1.43), (6.27, 9.41, 8.29), (9.57, 15.73, 14.51), (15.89, 19.03, 16.97), (19.19, 25.13, 24.11)];

fn plan() -> Plan {
    let mut plan = Plan::default()
        .void([0.0, 4.43, 0.0], [25.13, 6.17, CEILING_M])
        // Between neighbours: two doors on the south side, one on the north.
        .void([4.63, 1.07, 0.0], [4.79, 1.99, DOOR_M])
        .void([13.31, 2.23, 0.0], [13.47, 3.17, DOOR_M])
        .void([15.73, 8.91, 0.0], [15.89, 9.83, DOOR_M]);
    for (from, to, door) in SOUTH {
        plan = plan
            .void([from, 0.0, 0.0], [to, 4.27, CEILING_M])
            .void([door - 0.46, 4.27, 0.0], [door + 0.46, 4.43, DOOR_M]);
    }
    for (from, to, door) in NORTH {
        plan = plan
            .void([from, 6.33, 0.0], [to, 11.21, CEILING_M])
            .void([door - 0.43, 6.17, 0.0], [door + 0.43, 6.33, DOOR_M]);
    }
    plan
}

/// The offices.
pub fn offices() -> Result<Scene, String> {
    Ok(Scene {
        name: "offices",
        mesh: plan().mesh(floor_wall_ceiling),
        materials: vec![
            Material { name: "floor", rgb: [0.2, 0.2, 0.2] },
            Material { name: "wall", rgb: [0.5, 0.5, 0.5] },
            Material { name: "ceiling", rgb: [0.8, 0.8, 0.8] },
        ],
        lights: vec![
            Light::Point { position: DVec3::new(2.37, 1.93, 2.03), flux_w: 60.0 },
            Light::Sphere { center: DVec3::new(11.13, 8.07, 1.87), radius: 0.14, flux_w: 30.0 },
            // Panels that shine down: in the corridor and in the last room on the south side.
            Light::Quad {
                corner: DVec3::new(5.87, 5.03, 2.67),
                u: DVec3::new(0.0, 0.6, 0.0),
                v: DVec3::new(1.2, 0.0, 0.0),
                flux_w: 12.0,
            },
            Light::Quad {
                corner: DVec3::new(22.61, 1.67, 2.67),
                u: DVec3::new(0.0, 0.6, 0.0),
                v: DVec3::new(0.6, 0.0, 0.0),
                flux_w: 4.0,
            },
        ],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "s1_* to s5_*, n1_* to n5_*: in the rooms south and north of the corridor, from west to east. Those with a\n\
                    normal are irradiance; *_on lie exactly on their wall, *_off 1 mm off it, *_free in the air.",
            sensors: vec![
                scalar("s1", [1.37, 3.03, 1.23]),
                scalar("s2", [7.61, 1.87, 1.17]),
                scalar("s3", [11.43, 1.31, 1.37]),
                scalar("s4", [17.33, 1.09, 1.03]),
                scalar("s5", [21.07, 2.83, 1.29]),
                scalar("n1", [4.43, 9.67, 1.11]),
                scalar("n2", [7.37, 9.93, 1.33]),
                scalar("n3", [13.63, 9.97, 1.21]),
                scalar("n4_1", [17.21, 8.57, 1.43]),
                scalar("n4_2", [18.37, 10.61, 0.83]),
                scalar("n5_1", [22.71, 8.03, 1.27]),
                scalar("n5_2", [20.03, 10.37, 1.91]),
                scalar("corridor_1", [2.17, 5.57, 1.39]),
                scalar("corridor_2", [10.63, 4.97, 1.19]),
                scalar("corridor_3", [16.11, 5.61, 2.03]),
                scalar("corridor_4", [23.03, 5.09, 1.13]),
                planar("s2_desk_free", [9.11, 3.17, 0.76], UP),
                planar("s3_ceiling_off", [11.97, 2.61, 2.709], DOWN),
                planar("s4_wall_off", [15.17, 0.001, 1.37], [0.0, 1.0, 0.0]),
                planar("n1_floor_on", [3.07, 8.31, 0.0], UP),
                planar("n2_wall_on", [6.27, 8.47, 1.53], [1.0, 0.0, 0.0]),
                planar("n5_floor_off", [21.13, 9.43, 0.001], UP),
                planar("corridor_wall_off", [18.61, 6.169, 1.47], [0.0, -1.0, 0.0]),
            ],
        }],
        variants: vec![Variant {
            name: "offices",
            about: "Ten rooms along a corridor; floors of 0.2, walls of 0.5, ceilings of 0.8; a point, a sphere and two quad lights.",
            reflectance: 0.5,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    })
}
