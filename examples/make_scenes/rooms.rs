//! The plain scenes: a furnace, two rooms with a doorway, two with a keyhole, a corridor with bends.

use glam::DVec3;

use crate::boxes::{Plan, floor_wall_ceiling};
use crate::scene::{Light, Material, Scene, Sensor, Table, Variant, planar, scalar};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

/// A closed grey box. The area mean of the irradiance of its walls is flux / (area (1 - reflectance)), whatever the
/// light's place. The planar sensors are the two-point Gauss rule in squares of equal size, whose points count alike:
/// their plain mean is the area mean to 0.13%, the rest being the shade near edges (points in the middle of as many
/// squares: 0.7%).
pub fn furnace() -> Scene {
    const SQUARE_M: f64 = 1.025;
    const SQUARES: [usize; 3] = [4, 3, 3];
    let size = SQUARES.map(|n| n as f64 * SQUARE_M);
    let along = |axis: usize| -> Vec<f64> {
        (0..SQUARES[axis])
            .flat_map(|i| [-0.5, 0.5].map(|side| (i as f64 + 0.5 + side / f64::sqrt(3.0)) * SQUARE_M))
            .collect()
    };

    let mut sensors = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (side, far) in [("low", false), ("high", true)] {
            let name = ["x", "y", "z"][axis];
            for (i, &at_u) in along(u).iter().enumerate() {
                for (j, &at_v) in along(v).iter().enumerate() {
                    // Every other sensor stands 1 mm off its wall, as a user's might.
                    let off = if (i + j) % 2 == 1 { 0.001 } else { 0.0 };
                    let mut position = [0.0; 3];
                    position[u] = at_u;
                    position[v] = at_v;
                    position[axis] = if far { size[axis] - off } else { off };
                    let mut normal = [0.0; 3];
                    normal[axis] = if far { -1.0 } else { 1.0 };
                    sensors.push(planar(format!("{name}_{side}_{i}_{j}"), position, normal));
                }
            }
        }
    }
    sensors.push(scalar("air_near", [1.92, 1.13, 1.07]));
    sensors.push(scalar("air_middle", [2.41, 1.37, 1.19]));
    sensors.push(scalar("air_far", [3.59, 2.43, 0.47]));
    sensors.push(scalar("air_corner", [0.23, 2.81, 2.33]));

    Scene {
        name: "furnace",
        mesh: Plan::default().void([0.0; 3], size).mesh(|_| ""),
        materials: vec![],
        lights: vec![Light::Point { position: DVec3::new(1.69, 1.43, 1.61), flux_w: 100.0 }],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "x_low to z_high: the six walls, two-point Gauss rule in squares of 1.025 m, so that the plain mean of\n\
                    these 264 sensors is the area mean to 0.13%; every other one 1 mm off its wall, the rest exactly on it.\n\
                    air_*: scalar sensors.",
            sensors,
        }],
        variants: vec![Variant {
            name: "furnace",
            about: "A closed grey box: mean irradiance of its walls = flux / (area (1 - reflectance)).",
            reflectance: 0.5,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    }
}

/// Two rooms of unlike size, a doorway between them, the light in the first.
pub fn two_rooms() -> Scene {
    let plan = Plan::default()
        .void([0.0, 0.0, 0.0], [4.57, 3.83, 2.71])
        .void([4.57, 1.13, 0.0], [4.79, 2.05, 2.07])
        .void([4.79, -0.41, 0.0], [8.63, 4.02, 2.71]);
    Scene {
        name: "two_rooms",
        mesh: plan.mesh(floor_wall_ceiling),
        materials: vec![
            // Coloured on purpose: its reflectance is the Rec. 709 luminance, 0.325.
            Material { name: "floor", rgb: [0.45, 0.30, 0.20] },
            Material { name: "wall", rgb: [0.6, 0.6, 0.6] },
            Material { name: "ceiling", rgb: [0.8, 0.8, 0.8] },
        ],
        lights: vec![Light::Point { position: DVec3::new(1.63, 2.47, 2.13), flux_w: 60.0 }],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "a_*: the room with the light; b_*: the room behind the doorway; door: in it. Those with a normal are\n\
                    irradiance; *_on lie exactly on their wall, *_off 1 mm off it.",
            sensors: vec![
                scalar("a_1", [0.83, 0.71, 1.21]),
                scalar("a_2", [2.91, 1.37, 0.87]),
                scalar("a_3", [3.77, 3.21, 1.61]),
                scalar("a_4", [0.47, 3.43, 0.39]),
                scalar("door", [4.68, 1.55, 1.09]),
                scalar("b_1", [5.43, 1.03, 1.13]),
                scalar("b_2", [6.71, 0.67, 0.97]),
                scalar("b_3", [5.21, 3.47, 1.37]),
                scalar("b_4", [6.93, 2.89, 1.73]),
                scalar("b_5", [8.19, 3.61, 0.53]),
                scalar("b_6", [8.07, 0.13, 2.23]),
                planar("a_floor_on", [2.13, 1.09, 0.0], UP),
                planar("a_wall_off", [0.001, 1.31, 1.47], [1.0, 0.0, 0.0]),
                planar("a_ceiling_on", [3.31, 0.93, 2.71], DOWN),
                planar("a_desk", [3.07, 2.71, 0.81], UP),
                planar("b_floor_off", [6.37, 1.87, 0.001], UP),
                planar("b_wall_on", [8.63, 1.23, 1.31], [-1.0, 0.0, 0.0]),
                planar("b_back_off", [4.791, 3.13, 1.17], [1.0, 0.0, 0.0]),
                planar("b_ceiling_off", [7.23, 2.41, 2.709], DOWN),
                planar("b_slanted", [6.01, 2.33, 1.27], [-0.6, 0.0, 0.8]),
            ],
        }],
        variants: vec![Variant {
            name: "two_rooms",
            about: "Two rooms and a doorway, the light in the first; reflectances come from the MTL file.",
            reflectance: 0.5,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    }
}

/// Two rooms joined by a hole of 0.4 x 0.4 m alone. The light stands so far to the side of it that the wall's thickness hides
/// it from the whole second room: what comes in has been reflected.
pub fn keyhole() -> Scene {
    let plan = Plan::default()
        .void([0.0, 0.0, 0.0], [3.97, 3.63, 2.59])
        .void([3.97, 1.63, 1.07], [4.17, 2.03, 1.47])
        .void([4.17, -0.37, 0.0], [8.11, 3.87, 2.59]);
    Scene {
        name: "keyhole",
        mesh: plan.mesh(|_| ""),
        materials: vec![],
        lights: vec![Light::Point { position: DVec3::new(3.44, 0.47, 2.17), flux_w: 100.0 }],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "a_*: the room with the light; b_*: the room behind the hole, none of which sees the light. Those with a\n\
                    normal are irradiance; *_on lie exactly on their wall, *_off 1 mm off it.",
            sensors: vec![
                scalar("a_middle", [1.83, 1.91, 1.27]),
                scalar("a_corner", [0.37, 3.29, 0.41]),
                planar("a_floor_on", [1.23, 2.71, 0.0], UP),
                scalar("b_front", [4.73, 1.87, 1.23]),
                scalar("b_middle", [6.29, 2.23, 1.03]),
                scalar("b_corner", [7.79, 3.53, 2.21]),
                scalar("b_beside", [4.43, 3.57, 0.37]),
                planar("b_floor_off", [6.07, 0.83, 0.001], UP),
                planar("b_far_on", [8.11, 1.37, 1.53], [-1.0, 0.0, 0.0]),
                planar("b_back_off", [4.171, 0.61, 1.33], [1.0, 0.0, 0.0]),
            ],
        }],
        variants: vec![Variant {
            name: "keyhole",
            about: "Two rooms and a hole of 0.4 x 0.4 m, the light in the first; none of it falls straight through the hole.",
            reflectance: 0.5,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    }
}

/// A corridor of four legs, lit at one end, blind at the other.
pub fn corridor() -> Scene {
    let height = 2.47;
    let plan = Plan::default()
        .void([0.0, 0.0, 0.0], [5.93, 1.63, height])
        .void([4.31, 1.63, 0.0], [5.93, 5.37, height])
        .void([5.93, 3.74, 0.0], [10.27, 5.37, height])
        .void([8.64, 1.17, 0.0], [10.27, 3.74, height]);
    let mut sensors: Vec<Sensor> = [
        [1.67, 0.61, 1.33],
        [2.71, 1.07, 1.09],
        [3.79, 0.73, 1.21],
        [4.83, 0.97, 1.37],
        [5.27, 1.89, 1.13],
        [4.97, 2.93, 1.27],
        [5.31, 3.91, 1.03],
        [4.93, 4.57, 1.41],
        [6.07, 4.37, 1.17],
        [7.13, 4.73, 1.29],
        [8.21, 4.31, 1.07],
        [9.23, 4.67, 1.23],
        [9.61, 3.59, 1.39],
        [9.31, 2.57, 1.11],
        [9.53, 1.61, 1.31],
    ]
    .into_iter()
    .enumerate()
    .map(|(i, position)| scalar(format!("s{:02}", i + 1), position))
    .collect();
    sensors.extend([
        planar("floor_1_on", [3.11, 0.87, 0.0], UP),
        planar("floor_2_off", [5.17, 2.43, 0.001], UP),
        planar("floor_3_on", [7.61, 4.49, 0.0], UP),
        planar("floor_4_off", [9.37, 2.69, 0.001], UP),
        planar("bend_1_off", [5.929, 0.77, 1.27], [-1.0, 0.0, 0.0]),
        planar("bend_2_on", [5.21, 5.37, 1.33], [0.0, -1.0, 0.0]),
        planar("end_off", [9.41, 1.171, 1.09], [0.0, 1.0, 0.0]),
    ]);
    Scene {
        name: "corridor",
        mesh: plan.mesh(|_| ""),
        materials: vec![],
        lights: vec![Light::Point { position: DVec3::new(0.67, 0.91, 1.87), flux_w: 50.0 }],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "s01 to s15: scalar, along the corridor, off its middle. The rest face along their normal;\n\
                    *_on lie exactly on their wall, *_off 1 mm off it.",
            sensors,
        }],
        variants: vec![Variant {
            name: "corridor",
            about: "A corridor with three bends, a light at one end and a blind wall at the other.",
            reflectance: 0.7,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    }
}
