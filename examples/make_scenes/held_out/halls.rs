//! Proportions unlike the other scenes': a wide low hall with pillars beside a narrow shaft of four storeys' height.

use glam::DVec3;

use crate::boxes::Plan;
use crate::scene::{Light, Scene, Table, Variant, planar, scalar};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

fn plan() -> Plan {
    let mut plan = Plan::default()
        // The hall; the shaft, with a wide gate from the hall; a room at the shaft's head.
        .void([0.0, 0.0, 0.0], [24.03, 16.07, 2.83])
        .void([24.31, 11.13, 0.0], [27.33, 14.17, 11.03])
        .void([24.03, 11.61, 0.0], [24.31, 13.43, 2.27])
        .void([18.13, 10.07, 8.03], [24.03, 15.11, 10.43])
        .void([24.03, 12.17, 8.03], [24.31, 13.01, 10.09])
        // A lobby behind a narrow door in the hall's far corner, and a store behind that.
        .void([-4.87, 0.57, 0.0], [-0.29, 3.61, 2.41])
        .void([-0.29, 1.31, 0.0], [0.0, 2.03, 1.97])
        .void([-4.31, 3.87, 0.0], [-1.13, 8.19, 2.41])
        .void([-3.47, 3.61, 0.0], [-2.61, 3.87, 1.97]);
    for x in [4.57, 9.39, 14.21, 19.03] {
        for y in [4.93, 10.61] {
            plan = plan.solid([x, y, 0.0], [x + 0.61, y + 0.61, 2.83]);
        }
    }
    plan
}

/// The halls.
pub fn halls() -> Result<Scene, String> {
    Ok(Scene {
        name: "halls",
        mesh: plan().mesh(|_| ""),
        materials: vec![],
        lights: vec![
            Light::Sphere { center: DVec3::new(16.67, 6.73, 2.19), radius: 0.12, flux_w: 150.0 },
            Light::Point { position: DVec3::new(25.37, 12.31, 4.43), flux_w: 8.0 },
        ],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "hall_*, shaft_*, head_* (the room at the shaft's head), lobby_*, store_*. Those with a normal are irradiance;\n\
                    *_on lie exactly on their wall, *_off 1 mm off it, *_free in the air.",
            sensors: vec![
                scalar("hall_near", [14.77, 8.13, 1.31]),
                scalar("hall_middle", [11.63, 4.07, 1.57]),
                scalar("hall_behind_pillar", [3.67, 11.41, 1.23]),
                scalar("hall_far", [1.43, 13.87, 0.91]),
                scalar("hall_corner", [22.91, 1.19, 2.31]),
                scalar("hall_by_door", [0.67, 2.47, 1.37]),
                scalar("shaft_low", [26.03, 13.19, 1.07]),
                scalar("shaft_middle", [25.21, 12.83, 6.61]),
                scalar("shaft_high", [26.17, 12.07, 9.13]),
                scalar("shaft_top", [25.67, 13.37, 10.71]),
                scalar("head_near", [22.91, 12.31, 9.07]),
                scalar("head_far", [19.13, 14.03, 8.81]),
                scalar("lobby_near", [-1.31, 2.21, 1.17]),
                scalar("lobby_far", [-4.03, 1.43, 1.61]),
                scalar("store_near", [-2.87, 4.71, 1.13]),
                scalar("store_far", [-3.73, 7.33, 1.43]),
                planar("hall_floor_on", [7.43, 8.21, 0.0], UP),
                planar("hall_ceiling_off", [12.17, 12.91, 2.829], DOWN),
                planar("hall_wall_off", [0.001, 9.37, 1.41], [1.0, 0.0, 0.0]),
                planar("hall_free", [19.87, 13.33, 1.67], [-0.6, -0.64, 0.48]),
                planar("shaft_wall_off", [27.329, 12.43, 8.31], [-1.0, 0.0, 0.0]),
                planar("head_floor_off", [20.81, 11.39, 8.031], UP),
                planar("lobby_wall_on", [-2.17, 0.57, 1.29], [0.0, 1.0, 0.0]),
                planar("store_floor_off", [-1.97, 6.13, 0.001], UP),
            ],
        }],
        variants: vec![Variant {
            name: "halls",
            about: "A hall 24 x 16 x 2.8 m with eight pillars, a shaft 3 x 3 x 11 m with a room at its head, a lobby and a store.",
            reflectance: 0.5,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    })
}
