//! A piece of town as a height field: rows of houses about courts, under roofs of every kind.

use glam::DVec2;

use super::dice::Dice;
use super::scatter::scatter;
use super::solids::{FOOT_M, Frame, Roof, Solids};
use super::{Outdoor, scene};

/// A block of houses, the streets along and across.
const BLOCK_M: DVec2 = DVec2::new(58.0, 42.0);
const STREETS_M: DVec2 = DVec2::new(13.0, 16.0);

/// Depth of a house.
const DEPTH_M: [f64; 2] = [10.2, 12.4];

/// How far a house reaches into its neighbour.
const PARTY_M: f64 = 0.1;

/// Where sensors may lie on the ground.
const TOWN_M: [[f64; 2]; 2] = [[-150.0, 150.0], [-140.0, 175.0]];

/// Two quarters whose streets run in different directions, and free-standing houses in the wedge between them.
pub fn blocks() -> Result<Outdoor, String> {
    let mut dice = Dice::new(5);
    let mut solids = Solids::ground(600.0);
    quarter(&mut solids, &mut dice, &Frame::new(-136.0, -126.0, 0.0), [4, 2], None);
    quarter(&mut solids, &mut dice, &Frame::new(-120.0, -4.0, 18.0), [4, 2], Some([1, 1]));
    park(&mut solids, &mut dice);

    let mesh = solids.mesh();
    let mut sensors = scatter(&mesh, &mesh, &mut dice, "ground", 130, |p, normal| {
        let [x, y] = TOWN_M;
        normal.z > 0.9 && p.z == 0.0 && (x[0]..x[1]).contains(&p.x) && (y[0]..y[1]).contains(&p.y)
    })?;
    sensors.extend(scatter(&mesh, &mesh, &mut dice, "roof", 130, |p, normal| normal.z > 0.1 && p.z > 1.0)?);
    sensors.extend(scatter(&mesh, &mesh, &mut dice, "facade", 140, |p, normal| normal.z.abs() < 0.1 && p.z > 0.1)?);
    Ok(Outdoor {
        scene: scene(
            "blocks",
            mesh,
            0.5,
            "130 sensors on the ground, 130 on roofs, 140 on walls, drawn by a seeded generator, evenly by area, 1 cm off.",
            sensors,
        ),
        about: "A piece of town, 300 x 300 m, as a height field: nothing overhangs. Streets in two directions, 18 degrees apart.",
        is_height_field: true,
    })
}

/// Blocks in rows; one of them may be a square with a tower.
fn quarter(solids: &mut Solids, dice: &mut Dice, frame: &Frame, count: [usize; 2], square: Option<[usize; 2]>) {
    for column in 0..count[0] {
        for row in 0..count[1] {
            let corner = (BLOCK_M + STREETS_M) * DVec2::new(column as f64, row as f64);
            let here = frame.part(corner.x, corner.y, 0);
            if square == Some([column, row]) {
                tower(solids, &here);
            } else {
                block(solids, dice, &here);
            }
        }
    }
}

/// Four rows of houses about a court with sheds in it.
fn block(solids: &mut Solids, dice: &mut Dice, frame: &Frame) {
    // The rows across begin within the depth of those along.
    let inner = DEPTH_M[0] - PARTY_M;
    let across_m = BLOCK_M.y - 2.0 * inner;
    let usual_m = dice.between(11.0, 18.0);
    let rows = [
        (frame.part(0.0, 0.0, 0), BLOCK_M.x),
        (frame.part(BLOCK_M.x, inner, 1), across_m),
        (frame.part(BLOCK_M.x, BLOCK_M.y, 2), BLOCK_M.x),
        (frame.part(0.0, BLOCK_M.y - inner, 3), across_m),
    ];
    for (row, length_m) in rows {
        let mut from = 0.0;
        while from < length_m {
            let width = dice.length_m(8.5, 12.5);
            let to = if length_m - from < width + 8.0 { length_m } else { from + width };
            // The last house ends with the row.
            let end = if to < length_m { to + PARTY_M } else { to };
            terraced(solids, dice, &row, [from, end], usual_m);
            from = to;
        }
    }
    for side in [14.5, 30.0] {
        if dice.falls(0.7) {
            let (u, v) = (side + dice.length_m(0.0, 6.0), dice.length_m(14.5, 20.0));
            let (width, depth) = (dice.length_m(4.0, 8.0), dice.length_m(4.0, 8.0));
            let roof = if dice.falls(0.5) { Roof::Shed(0.8) } else { Roof::Flat };
            solids.house(frame, [u, v], [u + width, v + depth], dice.length_m(2.6, 4.2), roof);
        }
    }
}

/// A house in a row, from its street inwards.
fn terraced(solids: &mut Solids, dice: &mut Dice, row: &Frame, [from, to]: [f64; 2], usual_m: f64) {
    let front = dice.length_m(0.0, 0.4);
    let back = dice.length_m(DEPTH_M[0], DEPTH_M[1]);
    let eaves_m = ((usual_m + dice.between(-3.5, 3.5)) * 10.0).round() / 10.0;
    let rise_m = (back - front) / 2.0 * dice.between(0.5, 1.0);
    let roof = match dice.share() {
        x if x < 0.35 => Roof::Flat,
        x if x < 0.5 => Roof::Shed(rise_m * 0.6),
        x if x < 0.85 => Roof::Ridge(rise_m, 0.0),
        _ => Roof::Ridge(rise_m, 2.5),
    };
    solids.house(row, [from, front], [to, back], eaves_m, roof);
    if matches!(roof, Roof::Ridge(..)) && dice.falls(0.5) {
        let u = from + dice.length_m(2.6, 4.0);
        let v = (front + back) / 2.0 + dice.length_m(-1.5, 1.0);
        // From the ground, so that nothing overhangs even where it is hidden.
        solids.block(row, [u, v, -FOOT_M], [u + 0.7, v + 0.9, eaves_m + rise_m + 1.0]);
    }
}

/// A square: a hall with a steep roof, and a tower at its end.
fn tower(solids: &mut Solids, frame: &Frame) {
    solids.house(frame, [16.0, 14.0], [44.0, 28.0], 12.0, Roof::Ridge(9.0, 4.0));
    solids.house(frame, [10.0, 17.5], [17.0, 24.5], 29.0, Roof::Ridge(11.0, 3.3));
}

/// Free-standing houses, some high, some low, each turned its own way.
fn park(solids: &mut Solids, dice: &mut Dice) {
    let places = [
        [-10.0, -8.0],
        [22.0, 0.0],
        [52.0, 2.0],
        [56.0, 32.0],
        [88.0, -4.0],
        [90.0, 28.0],
        [124.0, 0.0],
        [122.0, 42.0],
    ];
    for [x, y] in places {
        let frame = Frame::new(x, y, dice.between(0.0, 90.0));
        let (half_u, half_v) = (dice.length_m(5.0, 9.0), dice.length_m(5.0, 7.0));
        let (eaves_m, roof) = match dice.share() {
            x if x < 0.4 => (dice.length_m(26.0, 42.0), Roof::Flat),
            x if x < 0.7 => (dice.length_m(4.0, 7.0), Roof::Ridge(half_v * 0.8, half_u.min(half_v) - 0.3)),
            _ => (dice.length_m(5.0, 9.0), Roof::Ridge(half_v, 0.0)),
        };
        solids.house(&frame, [-half_u, -half_v], [half_u, half_v], eaves_m, roof);
    }
}
