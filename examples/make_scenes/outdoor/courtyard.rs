//! A block with a well in its middle, whose sky view factors have closed forms.

use super::matter::Matter;
use super::{GROUND_M, Outdoor, scene};
use crate::scene::{Sensor, planar};

/// Sides of the block, of its well and of the ground; height of the block.
const BLOCK_M: f64 = 30.0;
const WELL_M: f64 = 10.0;
const GROUND_SIDE_M: f64 = 200.0;
const HEIGHT_M: f64 = 10.0;

/// How far sensors stand off their wall: the view factor of the well's floor changes by 6e-5 over it.
const OFF_M: f64 = 0.001;

/// How far from the facades sensors lie on the ground.
const DISTANCES_M: [f64; 6] = [0.5, 2.0, 5.0, 10.0, 20.0, 40.0];

/// A block of 30 x 30 x 10 m with a well of 10 x 10 x 10 m.
pub fn courtyard() -> Outdoor {
    let [block, well, ground] = [BLOCK_M, WELL_M, GROUND_SIDE_M].map(|side| side / 2.0);
    let mesh = Matter::default()
        .block([-ground, -ground, -GROUND_M], [ground, ground, 0.0])
        .block([-block, -block, 0.0], [block, block, HEIGHT_M])
        .opening([-well, -well, 0.0], [well, well, HEIGHT_M])
        .mesh();

    let up = [0.0, 0.0, 1.0];
    let mut sensors = vec![
        planar("court_centre", [0.0, 0.0, OFF_M], up),
        planar("court_side", [4.0, 0.0, OFF_M], up),
        planar("court_corner", [4.9, 4.9, OFF_M], up),
        planar("court_half_way_up", [0.0, 0.0, HEIGHT_M / 2.0], up),
    ];
    let sides = [("south", [0.0, -1.0]), ("east", [1.0, 0.0]), ("north", [0.0, 1.0]), ("west", [-1.0, 0.0])];
    let along = |[x, y]: [f64; 2], far: f64, z: f64| [x * far, y * far, z];
    for (side, [x, y]) in sides {
        let inwards = [-x, -y, 0.0];
        sensors.push(planar(format!("court_wall_{side}"), along([x, y], well - OFF_M, HEIGHT_M / 2.0), inwards));
    }
    for (side, [x, y]) in sides {
        sensors.push(planar(format!("facade_{side}"), along([x, y], block + OFF_M, HEIGHT_M / 2.0), [x, y, 0.0]));
    }
    sensors.push(planar("roof", [10.0, 0.0, HEIGHT_M + OFF_M], up));
    sensors.push(planar("roof_edge", [14.5, -14.5, HEIGHT_M + OFF_M], up));
    let on_ground = |(side, towards): (&str, [f64; 2])| -> Vec<Sensor> {
        let near = |far: f64| planar(format!("ground_{side}_{far}"), along(towards, block + far, OFF_M), up);
        DISTANCES_M.map(near).into()
    };
    sensors.extend(sides.into_iter().flat_map(on_ground));

    Outdoor {
        scene: scene(
            "courtyard",
            mesh,
            0.5,
            "court_*: in the well, its walls at half height; facade_*: outside, at half height; ground_*_d: d metres from a facade.\n\
             All 1 mm off what they lie on, but court_half_way_up, which hangs in the air.",
            sensors,
        ),
        about: "A block of 30 x 30 x 10 m with a well of 10 x 10 x 10 m, on 200 x 200 m of ground.\n\
                Sky view factors, analytic: court_centre .23949, court_side .19960, court_corner .14141, court_half_way_up .55413.",
        is_height_field: true,
    }
}
