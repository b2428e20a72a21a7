//! A long street, 75 x 450 m, for shadows that are near and far in one view: the example of Kolivand & Sunar, "Real-time
//! outdoor rendering using hybrid shadow maps" (2012).
//!
//! Seen from [`EYE_M`] straight along the street with 40 degrees from the lower edge to the upper one, the nearest that is in
//! view lies 10 m away along the gaze and the farthest 380 m: a stele and, at the picture's lower edge, the ground; a house
//! across the street's end.

use super::dice::Dice;
use super::scatter::scatter;
use super::solids::{FOOT_M, Frame, Roof, Solids};
use super::{GROUND_M, Outdoor, scene};

/// Half the sides of the ground.
const HALF_M: [f64; 2] = [37.5, 225.0];

/// Where the street is seen from: as high as the ground comes into view at 10 m, 10 m tan 20 degrees.
const EYE_M: [f64; 3] = [0.0, -165.0, 3.64];

/// Along the street, of what is nearest and of what is farthest in view.
const NEAREST_M: f64 = EYE_M[1] + 10.0;
const FARTHEST_M: f64 = EYE_M[1] + 380.0;

/// Half the width between the houses, and where lamps and trees stand.
const HALF_WIDTH_M: f64 = 10.0;
const KERB_M: f64 = 6.5;

/// How far joined solids reach into each other.
const JOINT_M: f64 = 0.1;

const STOREY_M: f64 = 3.2;

/// From one lamp to the next; none stands less than 10 m before the eye.
const LAMPS_M: f64 = 28.0;
const FIRST_LAMP_M: f64 = -207.0;

/// The street, and 100 sensors.
pub fn street() -> Result<Outdoor, String> {
    let mut dice = Dice::new(8);
    let mut solids = Solids::default();
    let plan = Frame::new(0.0, 0.0, 0.0);
    solids.block(&plan, [-HALF_M[0], -HALF_M[1], -GROUND_M], [HALF_M[0], HALF_M[1], 0.0]);
    // The house across the end is the highest, so that nothing behind its front is seen over it.
    solids.block(&plan, [-HALF_M[0], FARTHEST_M, -FOOT_M], [HALF_M[0], HALF_M[1], 28.0]);
    solids.block(&plan, [2.0, NEAREST_M, -FOOT_M], [2.9, NEAREST_M + 0.3, 2.4]);

    // From each side the houses' fronts lie to the left, and u runs along them.
    let west = Frame::new(0.0, 0.0, 90.0);
    let east = Frame::new(0.0, 0.0, -90.0);
    row(&mut solids, &mut dice, &west, [-HALF_M[1], FARTHEST_M + JOINT_M]);
    row(&mut solids, &mut dice, &east, [-FARTHEST_M - JOINT_M, HALF_M[1]]);
    for number in 0..15 {
        let along_m = FIRST_LAMP_M + LAMPS_M * f64::from(number);
        lamp(&mut solids, &west, along_m);
        lamp(&mut solids, &east, -along_m - LAMPS_M / 2.0);
        if number > 1 && number % 2 == 0 {
            tree(&mut solids, &mut dice, &west, along_m + 9.0);
            tree(&mut solids, &mut dice, &east, -along_m - 5.0);
        }
    }
    across(&mut solids, &plan);

    let mesh = solids.mesh();
    let mut sensors = scatter(&mesh, &mesh, &mut dice, "ground", 40, |p, normal| {
        normal.z > 0.9 && p.z == 0.0 && p.x.abs() < HALF_WIDTH_M
    })?;
    sensors.extend(scatter(&mesh, &mesh, &mut dice, "facade", 40, |p, normal| {
        normal.z.abs() < 0.1 && p.z > 0.1 && p.x.abs() < HALF_WIDTH_M + 2.0 && p.y.abs() < HALF_M[1] - 1.0
    })?);
    sensors.extend(scatter(&mesh, &mesh, &mut dice, "roof", 20, |p, normal| normal.z > 0.1 && p.z > 6.0)?);
    Ok(Outdoor {
        scene: scene(
            "street",
            mesh,
            0.5,
            "40 sensors on the street, 40 on what faces it, 20 on roofs, drawn by a seeded generator, evenly by area, 1 cm off.",
            sensors,
        ),
        about: "A street in a strip of 75 x 450 m: houses in rows, lanes, balconies, an arch, trees, lamps, wires. No height field.\n\
                Along --camera 0,-165,3.64:0,215,3.64 the nearest in view, ground and all, is 10 m away and the farthest 380 m.",
        is_height_field: false,
    })
}

/// A row of houses with lanes between some of them, and yards behind.
fn row(solids: &mut Solids, dice: &mut Dice, frame: &Frame, [from_m, to_m]: [f64; 2]) {
    let mut at_m = from_m;
    while at_m < to_m {
        let length_m = dice.length_m(10.0, 24.0);
        // No splinter of a house at the end.
        let end_m = if to_m - (at_m + length_m) < 12.0 { to_m } else { at_m + length_m };
        house(solids, dice, frame, [at_m, end_m + JOINT_M.min(to_m - end_m)]);
        at_m = if dice.falls(0.2) { end_m + dice.length_m(3.0, 5.0) } else { end_m };
    }
}

/// A house with balconies or on columns, and with a wing in its yard.
fn house(solids: &mut Solids, dice: &mut Dice, frame: &Frame, [from_m, to_m]: [f64; 2]) {
    let storeys = dice.between(2.0, 6.99).floor();
    let eaves_m = 1.0 + storeys * STOREY_M + dice.length_m(0.0, 0.9);
    // No two neighbours' fronts lie in one plane.
    let front_m = HALF_WIDTH_M + dice.between(0.0, 1.2);
    let back_m = front_m + dice.length_m(10.0, 13.0);
    let roof = match dice.between(0.0, 3.0) {
        kind if kind < 1.0 => Roof::Flat,
        kind if kind < 2.4 => Roof::Ridge(dice.length_m(2.5, 4.0), 0.0),
        _ => Roof::Shed(dice.length_m(1.0, 2.5)),
    };
    let has_columns = dice.falls(0.15) && to_m - from_m > 12.0;
    if has_columns {
        let over_m = 4.2;
        solids.roofed(frame, [from_m, front_m, over_m], [to_m, back_m, eaves_m], roof);
        // Its ends lie within the house above, and in no plane of a neighbour.
        let inside = [from_m + 0.06, to_m - 0.03];
        solids.block(frame, [inside[0], front_m + 3.0, -FOOT_M], [inside[1], back_m - 0.04, over_m + JOINT_M]);
        let bays = ((to_m - from_m) / 4.0).floor();
        for column in 0..=bays as usize {
            let along_m = from_m + 0.5 + (to_m - from_m - 1.0) * column as f64 / bays;
            solids.pillar(frame, [along_m, front_m + 0.5], 0.28, [-FOOT_M, over_m + JOINT_M]);
        }
    } else {
        solids.house(frame, [from_m, front_m], [to_m, back_m], eaves_m, roof);
    }
    if dice.falls(0.45) {
        for storey in 1..storeys as usize {
            balcony(solids, frame, (from_m + to_m) / 2.0, front_m, 1.0 + STOREY_M * storey as f64);
        }
    }
    if dice.falls(0.6) {
        let wing_m = [from_m + 0.3, from_m + 0.3 + dice.length_m(4.0, 7.0)];
        let deep_m = dice.length_m(4.0, 36.0 - back_m);
        solids.block(
            frame,
            [wing_m[0], back_m - JOINT_M, -FOOT_M],
            [wing_m[1], back_m + deep_m, dice.length_m(3.0, 7.0)],
        );
    }
}

/// A slab with a railing: a bar on five balusters.
fn balcony(solids: &mut Solids, frame: &Frame, middle_m: f64, front_m: f64, z_m: f64) {
    let [half_m, edge_m] = [1.5, front_m - 1.3];
    solids.block(frame, [middle_m - half_m, edge_m, z_m - 0.2], [middle_m + half_m, front_m + JOINT_M, z_m]);
    solids.block(frame, [middle_m - half_m, edge_m + 0.04, z_m + 0.95], [middle_m + half_m, edge_m + 0.1, z_m + 1.0]);
    for number in 0..5 {
        let along_m = middle_m - half_m + 0.1 + (2.0 * half_m - 0.24) * f64::from(number) / 4.0;
        let foot = [along_m, edge_m + 0.05, z_m - 0.05];
        solids.block(frame, foot, [along_m + 0.04, edge_m + 0.09, z_m + 0.97]);
    }
}

/// A post with an arm over the street and a lantern at its end.
fn lamp(solids: &mut Solids, frame: &Frame, along_m: f64) {
    solids.pillar(frame, [along_m, KERB_M], 0.08, [-FOOT_M, 6.6]);
    solids.block(frame, [along_m - 0.03, KERB_M - 1.8, 6.48], [along_m + 0.03, KERB_M, 6.54]);
    solids.block(frame, [along_m - 0.15, KERB_M - 2.1, 6.4], [along_m + 0.15, KERB_M - 1.5, 6.5]);
}

/// A trunk with a crown of two pieces.
fn tree(solids: &mut Solids, dice: &mut Dice, frame: &Frame, along_m: f64) {
    let [foot_m, crown_m] = [dice.length_m(2.2, 3.0), dice.length_m(4.0, 5.5)];
    let middle = [along_m, KERB_M + 0.4];
    solids.pillar(frame, middle, 0.17, [-FOOT_M, foot_m + 0.5]);
    solids.pillar(frame, middle, 1.7, [foot_m, crown_m + 0.3]);
    solids.pillar(frame, middle, 1.1, [crown_m, crown_m + 2.0]);
}

/// What spans the street: an arch on two piers, and wires.
fn across(solids: &mut Solids, plan: &Frame) {
    let [near_m, far_m, width_m] = [60.0, 62.5, HALF_WIDTH_M - 2.0];
    for side in [-1.0, 1.0] {
        let piers = [side * width_m, side * (HALF_WIDTH_M + 2.0)];
        let [u0, u1] = [piers[0].min(piers[1]), piers[0].max(piers[1])];
        solids.block(plan, [u0, near_m, -FOOT_M], [u1, far_m, 13.0]);
    }
    let span_m = width_m + JOINT_M;
    solids.arch(plan, [-span_m, span_m], [near_m + 0.2, far_m - 0.2], [5.0, 9.0, 12.6]);
    for along_m in [-135.0, -95.0, -55.0, -15.0, 25.0, 100.0, 140.0, 180.0] {
        let reach_m = HALF_WIDTH_M + 1.5;
        solids.block(plan, [-reach_m, along_m, 7.0], [reach_m, along_m + 0.03, 7.03]);
    }
}
