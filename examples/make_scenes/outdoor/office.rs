//! A room that a window lights, a corridor that the room's door lights, and what is seen from the window.

use super::matter::Matter;
use super::{GROUND_M, Outdoor, scene};
use crate::scene::{Sensor, planar};

const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Height of the indoor floor above the ground, and of a work plane above the floor.
const FLOOR_M: f64 = 0.23;
const WORK_PLANE_M: f64 = 0.8;

/// The room, its south wall's outside, the corridor: x along the facade, y into the house.
const ROOM_M: [[f64; 2]; 2] = [[0.0, 5.23], [0.0, 7.17]];
const FACADE_M: f64 = -0.31;
const CORRIDOR_M: [[f64; 2]; 2] = [[-4.07, 11.13], [7.39, 9.22]];

/// An office behind a window with a light shelf, a corridor behind its door, a house across the street.
pub fn office() -> Outdoor {
    let [room_x, room_y] = ROOM_M;
    let [corridor_x, corridor_y] = CORRIDOR_M;
    let window = [0.57, 4.66];
    let mesh = Matter::default()
        .block([-20.0, -28.0, -GROUND_M], [27.0, 17.0, 0.0])
        .block([-4.41, FACADE_M, 0.0], [11.47, 9.57, 7.21])
        // Across the street.
        .block([-6.13, -22.0, 0.0], [8.89, -13.97, 8.53])
        .opening([room_x[0], room_y[0], FLOOR_M], [room_x[1], room_y[1], 3.04])
        .opening([corridor_x[0], corridor_y[0], FLOOR_M], [corridor_x[1], corridor_y[1], 2.83])
        // Window and door.
        .opening([window[0], FACADE_M, 1.09], [window[1], room_y[0], 2.84])
        .opening([3.63, room_y[1], FLOOR_M], [4.62, corridor_y[0], 2.36])
        // The light shelf, out of the window and into the room.
        .block([window[0], FACADE_M - 0.46, 2.17], [window[1], room_y[0] + 0.63, 2.28])
        .mesh();

    Outdoor {
        scene: scene(
            "office",
            mesh,
            0.1,
            "room_*: the work plane, 0.8 m above the floor, ever deeper (1 to 8), in three rows (west, middle, east); door: in it;\n\
             corridor_*: the work plane, by metres east of the door; wall_*, ceiling_*, floor_*, shelf: 1 mm off; the rest outdoors.",
            sensors(),
        ),
        about: "A room with a window and a light shelf, to the south; a corridor behind its door; a house across the street.",
        is_height_field: false,
    }
}

/// Indoors from the window to the ends of the corridor, then outdoors.
fn sensors() -> Vec<Sensor> {
    let work_m = FLOOR_M + WORK_PLANE_M;
    let mut sensors = Vec::new();
    for (row, x) in [("west", 0.91), ("middle", 2.63), ("east", 4.37)] {
        for (step, y) in [0.43, 1.13, 1.97, 2.83, 3.77, 4.73, 5.71, 6.73].into_iter().enumerate() {
            sensors.push(planar(format!("room_{row}_{}", step + 1), [x, y, work_m], UP));
        }
    }
    let door_x = 4.13;
    sensors.push(planar("door", [door_x, 7.28, work_m], UP));
    for east in [-7.7, -6.1, -4.6, -3.3, -2.1, -1.2, -0.4, 0.4, 1.2, 2.1, 3.3, 4.6, 6.1] {
        sensors.push(planar(format!("corridor_{east}"), [door_x + east, 8.33, work_m], UP));
    }
    let off = 0.001;
    sensors.extend([
        planar("wall_west", [off, 3.17, 1.63], [1.0, 0.0, 0.0]),
        planar("wall_east", [ROOM_M[0][1] - off, 4.39, 1.37], [-1.0, 0.0, 0.0]),
        planar("wall_back", [1.79, ROOM_M[1][1] - off, 1.71], [0.0, -1.0, 0.0]),
        planar("wall_corridor", [4.07, CORRIDOR_M[1][1] - off, 1.57], [0.0, -1.0, 0.0]),
        planar("ceiling_front", [2.59, 0.97, 3.04 - off], [0.0, 0.0, -1.0]),
        planar("ceiling_back", [2.59, 5.83, 3.04 - off], [0.0, 0.0, -1.0]),
        planar("floor_front", [2.71, 1.61, FLOOR_M + off], UP),
        planar("floor_back", [1.33, 6.37, FLOOR_M + off], UP),
        planar("shelf_outside", [2.71, -0.53, 2.28 + off], UP),
        planar("shelf_inside", [2.71, 0.31, 2.28 + off], UP),
        planar("facade_south", [-1.93, FACADE_M - off, 1.79], [0.0, -1.0, 0.0]),
        planar("facade_upper", [2.61, FACADE_M - off, 5.47], [0.0, -1.0, 0.0]),
        planar("ground_near", [2.61, -1.57, off], UP),
        planar("ground_middle", [2.61, -7.13, off], UP),
        planar("ground_far", [-13.7, -9.17, off], UP),
        planar("opposite_north", [1.87, -13.97 + off, 3.31], [0.0, 1.0, 0.0]),
        planar("roof", [3.53, 4.87, 7.21 + off], UP),
    ]);
    sensors
}
