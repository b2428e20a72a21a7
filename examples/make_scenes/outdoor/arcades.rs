//! A street that a map of heights cannot tell: an arcade, balconies, porches, galleries, bridges and a passage.

use super::dice::Dice;
use super::scatter::{is_covered, scatter};
use super::solids::{FOOT_M, Frame, Roof, Solids};
use super::{Outdoor, scene};

/// How far joined solids reach into each other.
const JOINT_M: f64 = 0.1;

/// Height of a storey over the street.
const STOREY_M: f64 = 3.4;

/// Half the length of the street's north side, half the width of the street.
const HALF_LENGTH_M: f64 = 42.0;
const HALF_WIDTH_M: f64 = 7.0;

/// Underside of what lies over the arcade; depth of the arcade; rear of the house.
const ARCADE_TOP_M: f64 = 4.8;
const ARCADE_DEPTH_M: f64 = 4.0;
const REAR_M: f64 = 20.0;

/// Where sensors may lie on the ground, by distance from the middle.
const TOWN_M: f64 = 50.0;

/// The street, and 400 sensors on whatever faces the air.
pub fn arcades() -> Result<Outdoor, String> {
    // Turned, so that no wall follows an axis.
    let street = Frame::new(0.0, -8.0, 11.0);
    let mut decks = Solids::default();
    let mut solids = Solids::ground(200.0);
    north_side(&mut solids, &street);
    galleries(&mut solids, &mut decks, &street);
    south_side(&mut solids, &mut decks, &street);
    bridges(&mut solids, &mut decks, &street);
    solids.append(&decks);

    let (mesh, decks) = (solids.mesh(), decks.mesh());
    let mut dice = Dice::new(7);
    let is_ground =
        |p: glam::DVec3, normal: glam::DVec3| normal.z > 0.9 && p.z == 0.0 && p.truncate().abs().max_element() < TOWN_M;
    let draw = |dice: &mut Dice, prefix, count, fits: &dyn Fn(glam::DVec3, glam::DVec3) -> bool| {
        scatter(&mesh, if prefix == "deck" { &decks } else { &mesh }, dice, prefix, count, fits)
    };
    let mut sensors = draw(&mut dice, "ground", 80, &|p, normal| is_ground(p, normal) && !is_covered(&mesh, p))?;
    sensors.extend(draw(&mut dice, "under", 90, &|p, normal| is_ground(p, normal) && is_covered(&mesh, p))?);
    sensors.extend(draw(&mut dice, "wall", 110, &|p, normal| normal.z.abs() < 0.1 && p.z > 0.1)?);
    sensors.extend(draw(&mut dice, "deck", 50, &|_, normal| normal.z > 0.9)?);
    sensors.extend(draw(&mut dice, "soffit", 30, &|p, normal| normal.z < -0.1 && p.z > 0.1)?);
    sensors.extend(draw(&mut dice, "roof", 40, &|p, normal| normal.z > 0.1 && p.z > 10.0)?);
    Ok(Outdoor {
        scene: scene(
            "arcades",
            mesh,
            0.25,
            "ground_*: 80 on open ground; under_*: 90 on ground with something above; wall_*: 110; deck_*: 50 on balconies,\n\
             galleries and the footbridge; soffit_*: 30 that look down; roof_*: 40 that look up above 10 m, some of them on high\n\
             balconies. Drawn by a seeded generator, evenly by area, 1 cm off.",
            sensors,
        ),
        about: "A street with an arcade, balconies, porches, galleries, two bridges and a passage: no height field.",
        is_height_field: false,
    })
}

/// A house over an arcade with columns and arches, a passage through it to the court behind.
fn north_side(solids: &mut Solids, street: &Frame) {
    const BAYS: usize = 20;
    let [front, back] = [HALF_WIDTH_M, HALF_WIDTH_M + ARCADE_DEPTH_M];
    solids.block(street, [-HALF_LENGTH_M, front, ARCADE_TOP_M], [HALF_LENGTH_M, REAR_M, 15.0]);
    solids.roofed(
        street,
        [-HALF_LENGTH_M - 0.6, front - 0.7, 14.8],
        [HALF_LENGTH_M + 0.6, REAR_M + 0.7, 15.1],
        Roof::Ridge(4.2, 5.0),
    );
    for [from, to] in [[-HALF_LENGTH_M, -2.1], [2.1, HALF_LENGTH_M]] {
        // Within the house above, so that no two walls lie on each other.
        let ends = [from + JOINT_M, to - JOINT_M];
        solids.block(street, [ends[0], back, -FOOT_M], [ends[1], REAR_M - JOINT_M, ARCADE_TOP_M + JOINT_M]);
    }
    let pitch = (2.0 * HALF_LENGTH_M - 1.0) / BAYS as f64;
    let column = |i: usize| -HALF_LENGTH_M + 0.5 + pitch * i as f64;
    for i in 0..=BAYS {
        solids.pillar(street, [column(i), front + 0.4], 0.34, [-FOOT_M, ARCADE_TOP_M + JOINT_M]);
        if i < BAYS {
            let heights = [3.1, 4.5, ARCADE_TOP_M + JOINT_M];
            // Its ends lie within the columns.
            solids.arch(street, [column(i) + JOINT_M, column(i + 1) - JOINT_M], [front + 0.15, front + 0.65], heights);
        }
    }
}

/// Across the court a house that is reached by open galleries, one above the other.
fn galleries(solids: &mut Solids, decks: &mut Solids, street: &Frame) {
    let (front, half) = (36.0, 24.0);
    solids.house(street, [-half, front], [half, front + 10.0], 13.2, Roof::Shed(2.0));
    let edge = front - 2.2;
    for storey in 1..4 {
        let z = STOREY_M * f64::from(storey);
        decks.block(street, [-half, edge, z - 0.25], [half, front + JOINT_M, z]);
        solids.block(street, [-half + 0.05, edge + 0.05, z - 0.1], [half - 0.05, edge + 0.17, z + 1.0]);
    }
    for i in 0..9 {
        let u = -half + 0.4 + f64::from(i) * (2.0 * half - 0.8) / 8.0;
        solids.pillar(street, [u, edge + 0.45], 0.2, [-FOOT_M, 12.6]);
    }
    solids.block(street, [-half - 0.3, edge - 0.3, 12.5], [half + 0.3, front + JOINT_M, 12.8]);
}

/// Three houses with balconies and porches, lanes between them.
fn south_side(solids: &mut Solids, decks: &mut Solids, street: &Frame) {
    // Seen from the houses: u to the west, v towards the street.
    let houses = [
        ([-42.0, -17.0], 5, 17.4, Roof::Flat),
        ([-9.0, 14.0], 5, 17.0, Roof::Ridge(3.5, 0.0)),
        ([22.0, 42.0], 4, 14.2, Roof::Flat),
    ];
    for ([from, to], storeys, eaves_m, roof) in houses {
        let face = -HALF_WIDTH_M;
        solids.house(street, [from, face - 12.0], [to, face], eaves_m, Roof::Flat);
        if let Roof::Ridge(..) = roof {
            solids.roofed(
                street,
                [from - 0.6, face - 12.8, eaves_m - 0.2],
                [to + 0.6, face + 0.8, eaves_m + 0.1],
                roof,
            );
        }
        let columns = ((to - from) / 5.0).floor();
        let pitch = (to - from) / columns;
        for column in 0..columns as usize {
            let middle = from + pitch * (column as f64 + 0.5);
            for storey in 1..storeys {
                // The first bridge lands here.
                let is_taken = (7.0..13.0).contains(&middle) && (2..4).contains(&storey);
                if !is_taken {
                    balcony(solids, decks, street, middle, STOREY_M * f64::from(storey));
                }
            }
            if column % 2 == 0 {
                porch(solids, street, middle + pitch / 2.0);
            }
        }
    }
}

/// A slab with a parapet on three sides.
fn balcony(solids: &mut Solids, decks: &mut Solids, street: &Frame, middle: f64, z: f64) {
    let (half, face) = (1.6, -HALF_WIDTH_M);
    let edge = face + 1.6;
    decks.block(street, [middle - half, face - JOINT_M, z - 0.2], [middle + half, edge, z]);
    solids.block(street, [middle - half + 0.05, edge - 0.17, z - 0.1], [middle + half - 0.05, edge - 0.05, z + 1.0]);
    for side in [middle - half + 0.1, middle + half - 0.22] {
        solids.block(street, [side, face - JOINT_M, z - 0.1], [side + 0.12, edge - 0.1, z + 0.95]);
    }
}

/// A roof on two posts before a door.
fn porch(solids: &mut Solids, street: &Frame, middle: f64) {
    let face = -HALF_WIDTH_M;
    solids.block(street, [middle - 1.3, face - JOINT_M, 2.6], [middle + 1.3, face + 2.3, 2.8]);
    for side in [-1.0, 1.0] {
        solids.pillar(street, [middle + side, face + 2.0], 0.14, [-FOOT_M, 2.7]);
    }
}

/// A closed bridge over the street, and an open footbridge over a lane.
fn bridges(solids: &mut Solids, decks: &mut Solids, street: &Frame) {
    let ends = [-HALF_WIDTH_M - JOINT_M, HALF_WIDTH_M + JOINT_M];
    solids.block(street, [8.0, ends[0], 6.6], [12.0, ends[1], 10.4]);

    let (z, lane) = (2.0 * STOREY_M, [14.0 - JOINT_M, 22.0 + JOINT_M]);
    let (low, high) = (-HALF_WIDTH_M - 7.0, -HALF_WIDTH_M - 4.6);
    decks.block(street, [lane[0], low, z - 0.3], [lane[1], high, z]);
    for side in [low + 0.05, high - 0.17] {
        solids.block(street, [lane[0], side, z - 0.1], [lane[1], side + 0.12, z + 1.1]);
    }
}
