//! What comes from a piece of the sky, between two heights over a sector of the horizon?
//!
//! Muñoz-Pandiella et al. sample the visible band in a mipmapped map. Here the map is summed beforehand: for each sector the
//! energy times its direction, from the zenith down to each row (rows of equal solid angle, by the sine of the elevation). A
//! band is then one difference of two sums, exact along the elevation, and its product with a normal is the irradiation of any
//! plane that the band is in front of. The suns are summed beside it where they stand, not where a texel of the map has them.
//!
//! Sectors are as wide as the directions stand apart, and begin in as many places as points are turned, so that points with
//! different turns share the sums. Limits: within a sector what is in the way stands as high as at its middle.

use crate::sky::map::ExposureMap;
use crate::sky::towards;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Rows from the horizon to the zenith, of equal solid angle: 0.2 degrees at the horizon.
pub const ROWS: usize = 256;

/// What a piece of the sky brings.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Piece {
    /// From the sky, energy times direction in the scene, kWh/m2.
    pub sky_kwh_m2: [f32; 3],
    /// From the suns, the same.
    pub beam_kwh_m2: [f32; 3],
    /// Hours of sun.
    pub sun_h: f32,
    /// The directions themselves, upwards: its solid angle by its cosine to the vertical, sr.
    pub level_sr: f32,
    /// The same by the cosine to the middle of the sector, sr.
    pub upright_sr: f32,
    /// Solid angle, sr.
    pub solid_angle_sr: f32,
    /// What comes from it, without any cosine: from the sky and from the suns, kWh/m2.
    pub all_kwh_m2: [f32; 2],
}

/// The pieces of a map's sky.
#[derive(Debug, Clone)]
pub struct SkySums {
    /// Directions of a point.
    pub directions: usize,
    /// Ways in which points are turned.
    pub turns: usize,
    /// For each sector, the first at the scene's +Y and clockwise, the sums above each row, [`ROWS`] + 1 of them.
    above: Vec<Piece>,
}

impl SkySums {
    /// The sums of a map for points that look in `directions`, turned in `turns` ways: 4 kB a sector, a few milliseconds.
    /// `north_rad` is the direction of true north, clockwise from the scene's +Y.
    pub fn new(map: &ExposureMap, north_rad: f64, directions: usize, turns: usize) -> Self {
        let (directions, turns) = (directions.max(1), turns.max(1));
        // Half sectors of the finest kind: sectors begin and end on their edges.
        let parts = 2 * directions * turns;
        let mut fine = vec![[0.0_f64; PARTS]; parts * ROWS];
        let part_rad = TAU / parts as f64;
        let mut add = |part: usize, row: usize, values: [f64; PARTS]| {
            let cell = &mut fine[part % parts * ROWS + row.min(ROWS - 1)];
            cell.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        };

        // Each texel of the map goes to the parts and rows it overlaps, by the shares of its solid angle.
        let [columns, rows] = map.size;
        for row in 0..rows {
            let edge = |row: usize| (FRAC_PI_2 * row as f64 / rows as f64).sin() * ROWS as f64;
            let over_rows = overlaps(edge(row), edge(row + 1), ROWS);
            for column in 0..columns {
                let energy = map.diffuse_kwh_m2.get(row * columns + column).map_or(0.0, |&energy| f64::from(energy));
                let first = (TAU * column as f64 / columns as f64 + north_rad).rem_euclid(TAU) / part_rad;
                let last = first + parts as f64 / columns as f64;
                for (part, across) in overlaps(first, last, usize::MAX) {
                    let azimuth_rad = (part as f64 + 0.5) * part_rad;
                    for &(fine_row, along) in &over_rows {
                        let sine = (fine_row as f64 + 0.5) / ROWS as f64;
                        let share = energy * across * along;
                        let direction = towards(azimuth_rad, sine.asin()) * share;
                        add(part, fine_row, [direction.x, direction.y, direction.z, 0.0, 0.0, 0.0, 0.0, share, 0.0]);
                    }
                }
            }
        }
        for sun in map.suns.iter().filter(|sun| sun.sun.elevation_rad > 0.0) {
            let azimuth_rad = (sun.sun.azimuth_rad + north_rad).rem_euclid(TAU);
            let energy = sun.energy_kwh_m2;
            let direction = towards(azimuth_rad, sun.sun.elevation_rad) * energy;
            let row = (sun.sun.elevation_rad.sin() * ROWS as f64) as usize;
            let values = [0.0, 0.0, 0.0, direction.x, direction.y, direction.z, sun.hours, 0.0, energy];
            add((azimuth_rad / part_rad) as usize, row, values);
        }

        let sectors = directions * turns;
        let mut above = vec![Piece::default(); sectors * (ROWS + 1)];
        for (sector, column) in above.chunks_exact_mut(ROWS + 1).enumerate() {
            let mut sum = [0.0; PARTS];
            for row in (0..ROWS).rev() {
                // The sector's middle is the edge between two parts.
                for part in 0..2 * turns {
                    let number = (2 * sector + parts + part - turns) % parts;
                    let cell = fine[number * ROWS + row];
                    sum.iter_mut().zip(cell).for_each(|(sum, value)| *sum += value);
                }
                column[row] = piece(&sum, row, directions);
            }
        }
        Self { directions, turns, above }
    }

    /// The azimuth of the middle of a direction's sector, radians clockwise from the scene's +Y.
    pub fn azimuth_rad(&self, direction: usize, turn: usize) -> f64 {
        TAU * self.sector(direction, turn) as f64 / (self.directions * self.turns) as f64
    }

    fn sector(&self, direction: usize, turn: usize) -> usize {
        direction % self.directions * self.turns + turn % self.turns
    }

    /// What comes from above an elevation whose sine is that, in the sector of a direction and turn.
    pub fn above(&self, direction: usize, turn: usize, sine: f32) -> Piece {
        let at = sine.clamp(0.0, 1.0) * ROWS as f32;
        let row = (at as usize).min(ROWS - 1);
        let first = self.sector(direction, turn) * (ROWS + 1) + row;
        match self.above.get(first..first + 2) {
            Some([low, high]) => low.towards(high, at - row as f32),
            _ => Piece::default(),
        }
    }
}

/// Sums that are kept of a part of the sky: of sky and suns three components each, hours, and what comes in all.
const PARTS: usize = 9;

fn piece(sum: &[f64; PARTS], row: usize, directions: usize) -> Piece {
    let width_rad = TAU / directions as f64;
    let sine = row as f64 / ROWS as f64;
    let (elevation_rad, cosine) = (sine.asin(), (1.0 - sine * sine).sqrt());
    let [x, y, z, beam_x, beam_y, beam_z, hours, sky, beam] = sum.map(|part| part as f32);
    // The integrals over the sector above the row of cos z, of the cosine to the sector's middle, and of 1.
    let upright = (FRAC_PI_2 - elevation_rad - sine * cosine) / 2.0 * 2.0 * (width_rad / 2.0).sin();
    Piece {
        sky_kwh_m2: [x, y, z],
        beam_kwh_m2: [beam_x, beam_y, beam_z],
        sun_h: hours,
        level_sr: (width_rad * (1.0 - sine * sine) / 2.0) as f32,
        upright_sr: upright as f32,
        solid_angle_sr: (width_rad * (1.0 - sine)) as f32,
        all_kwh_m2: [sky, beam],
    }
}

/// The numbers of the cells of width 1 that an interval overlaps, with the share of it in each; none beyond `most`.
fn overlaps(from: f64, to: f64, most: usize) -> Vec<(usize, f64)> {
    let width = to - from;
    let (first, last) = (from.floor() as usize, (to.ceil() as usize).min(most));
    let share = |cell: usize| (to.min(cell as f64 + 1.0) - from.max(cell as f64)) / width;
    (first..last).map(|cell| (cell, share(cell))).filter(|(_, share)| *share > 0.0).collect()
}

impl Piece {
    fn zipped(&self, other: &Self, with: impl Fn(f32, f32) -> f32) -> Self {
        let three = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|axis| with(a[axis], b[axis]));
        Self {
            sky_kwh_m2: three(self.sky_kwh_m2, other.sky_kwh_m2),
            beam_kwh_m2: three(self.beam_kwh_m2, other.beam_kwh_m2),
            sun_h: with(self.sun_h, other.sun_h),
            level_sr: with(self.level_sr, other.level_sr),
            upright_sr: with(self.upright_sr, other.upright_sr),
            solid_angle_sr: with(self.solid_angle_sr, other.solid_angle_sr),
            all_kwh_m2: std::array::from_fn(|part| with(self.all_kwh_m2[part], other.all_kwh_m2[part])),
        }
    }

    fn towards(&self, other: &Self, part: f32) -> Self {
        self.zipped(other, |a, b| a + part * (b - a))
    }

    /// What lies in this one and not in that.
    pub fn without(&self, other: &Self) -> Self {
        self.zipped(other, |a, b| a - b)
    }

    /// This one and that.
    pub fn and(&self, other: &Self) -> Self {
        self.zipped(other, |a, b| a + b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use crate::scene::Site;
    use crate::sky::dome::SkyModel;
    use crate::sky::map::MapSettings;
    use crate::sky::site::Outdoors;
    use crate::sky::steps::Period;
    use glam::DVec3;

    fn map() -> ExposureMap {
        let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
        let outdoors = Outdoors::of(&site, None).unwrap();
        let steps = Outdoors { period: Period { step_min: 120.0, ..Period::YEAR }, ..outdoors }.steps().unwrap();
        let settings = MapSettings { size: [128, 96], model: SkyModel::Hosek, ..MapSettings::default() };
        ExposureMap::build(&steps, &settings, &Quiet, &Cancel::new()).unwrap()
    }

    /// Energy times direction of what the map has above an elevation, within half a sector of an azimuth: its texels
    /// by many points each, and its suns.
    fn by_hand(map: &ExposureMap, north_rad: f64, middle_rad: f64, half_rad: f64, sine: f64) -> (DVec3, DVec3) {
        let inside = |azimuth_rad: f64, elevation_rad: f64| {
            let off = (azimuth_rad - middle_rad + 1.5 * TAU).rem_euclid(TAU) - TAU / 2.0;
            off.abs() <= half_rad && elevation_rad.sin() >= sine
        };
        let (mut sky, mut beam) = (DVec3::ZERO, DVec3::ZERO);
        const FINE: usize = 8;
        let [columns, rows] = map.size;
        for row in 0..rows * FINE {
            let edge = |row: usize| (FRAC_PI_2 * row as f64 / (rows * FINE) as f64).sin();
            let (low, high) = (edge(row), edge(row + 1));
            let elevation_rad = ((low + high) / 2.0).asin();
            for column in 0..columns * FINE {
                let azimuth_rad = TAU * (column as f64 + 0.5) / (columns * FINE) as f64 + north_rad;
                if inside(azimuth_rad, elevation_rad) {
                    let radiance = f64::from(map.diffuse_kwh_m2[row / FINE * columns + column / FINE])
                        / map.solid_angle_sr(row / FINE);
                    let solid_angle_sr = TAU / (columns * FINE) as f64 * (high - low);
                    sky += towards(azimuth_rad, elevation_rad) * radiance * solid_angle_sr;
                }
            }
        }
        for sun in &map.suns {
            let azimuth_rad = sun.sun.azimuth_rad + north_rad;
            if inside(azimuth_rad, sun.sun.elevation_rad) {
                beam += towards(azimuth_rad, sun.sun.elevation_rad) * sun.energy_kwh_m2;
            }
        }
        (sky, beam)
    }

    #[test]
    fn pieces_are_what_the_map_has_there() {
        let map = map();
        let all_kwh_m2 = map.totals.dhi_kwh_m2 + map.totals.dni_kwh_m2;
        for (directions, turns, north_rad) in [(8, 4, 0.0), (16, 1, 0.7), (7, 3, -2.0)] {
            let sums = SkySums::new(&map, north_rad, directions, turns);
            for (direction, turn, sine) in [(0, 0, 0.0), (3, 2, 0.25), (6, 1, 0.6), (directions - 1, turns - 1, 0.9)] {
                let found = sums.above(direction, turn, sine);
                let half_rad = TAU / directions as f64 / 2.0;
                let middle_rad = sums.azimuth_rad(direction, turn);
                let (sky, beam) = by_hand(&map, north_rad, middle_rad, half_rad, f64::from(sine));
                let found_sky = DVec3::from(found.sky_kwh_m2.map(f64::from));
                let found_beam = DVec3::from(found.beam_kwh_m2.map(f64::from));
                assert!(found_sky.distance(sky) < 1e-3 * all_kwh_m2, "{found_sky} {sky}");
                assert!(found_beam.distance(beam) < 4e-3 * all_kwh_m2, "{found_beam} {beam}");
            }
        }
    }

    #[test]
    fn all_pieces_together_are_the_period() {
        let map = map();
        for (directions, turns) in [(1, 1), (8, 16), (64, 2)] {
            let sums = SkySums::new(&map, 0.3, directions, turns);
            for turn in 0..turns {
                let all =
                    (0..directions).fold(Piece::default(), |all, direction| all.and(&sums.above(direction, turn, 0.0)));
                let off = |found: f32, expected: f64| (f64::from(found) / expected - 1.0).abs();
                let dhi: f64 = map.texel_totals().dhi_kwh_m2;
                assert!(off(all.sky_kwh_m2[2], dhi) < 1e-3, "{} {dhi}", all.sky_kwh_m2[2]);
                assert!(off(all.all_kwh_m2[1], map.totals.dni_kwh_m2) < 1e-4);
                let hours: f64 = map.suns.iter().map(|sun| sun.hours).sum();
                assert!(off(all.sun_h, hours) < 1e-4);
                assert!(off(all.level_sr, TAU / 2.0) < 1e-4 && off(all.solid_angle_sr, TAU) < 1e-4);
            }
        }
    }

    #[test]
    fn a_quarter_of_the_sky_before_a_wall() {
        // One sector in four, its middle before the wall: int cos^2 el d el = pi / 4, int cos az d az = sqrt 2.
        let sums = SkySums::new(&map(), 0.0, 4, 1);
        let found = sums.above(0, 0, 0.0).upright_sr;
        assert!((f64::from(found) - TAU / 8.0 * 2.0_f64.sqrt()).abs() < 1e-5, "{found}");
        assert_eq!(sums.above(2, 0, 1.0), Piece { level_sr: 0.0, ..Piece::default() });
    }
}
