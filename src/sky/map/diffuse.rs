//! The smooth part of the map, evaluated where it must be and no finer.
//!
//! The sum of a period's skies is known on a coarse grid of azimuths and elevations and doubled level by level. A new point
//! is first predicted by the cubic through its four neighbours; where the level before was predicted within the tolerance,
//! the prediction stays, and elsewhere the sum is evaluated. So points gather about the sun's path and the horizon. This is
//! the interpolating multiresolution of Harten (1996), on Deslauriers and Dubuc's four-point scheme (1989).
//!
//! Limits: a feature narrower than the first level that is evaluated whole, 6 degrees of azimuth, can be missed if no point
//! falls near it; skies have none but the aureole around the sun, which every point of that level sees.

use crate::job::{Cancel, Cancelled};
use crate::sky::term::{Row, Skies};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Columns, and rows but one, of the first grid.
const FIRST: usize = 8;

/// Doublings after which the grid is evaluated as a whole: 32 columns and 33 rows. As no cubic was tried there, the next
/// level is evaluated as a whole too: 5.6 by 1.4 degrees.
const WHOLE: u32 = 2;

/// A sum of skies, sampled.
#[derive(Debug)]
pub struct Samples {
    /// W/m2/sr or what the terms' weights say, row by row from the horizon to the zenith.
    values: Vec<f64>,
    /// Azimuths, the first of them north, all around.
    columns: usize,
    /// Elevations, the first the horizon and the last the zenith.
    rows: usize,
    /// How far cubics were found off in each cell between four points, a share; 0 where the level before was smooth.
    rough: Vec<f32>,
    /// Points that were evaluated rather than predicted.
    pub evaluated: usize,
}

/// Samples the skies for a map of so many columns and rows; predictions stay where they are within `tolerance`, a share.
///
/// # Errors
/// [`Cancelled`].
pub fn sample(skies: &Skies, size: [usize; 2], tolerance: f64, cancel: &Cancel) -> Result<Samples, Cancelled> {
    let doublings = size.map(|texels| texels.div_ceil(FIRST).next_power_of_two().ilog2());
    let levels = doublings[0].max(doublings[1]).max(WHOLE);
    let side = FIRST << WHOLE;
    let mut samples = whole(skies, side, side + 1, cancel)?;
    for _ in WHOLE..levels {
        samples = samples.doubled(skies, tolerance, cancel)?;
    }
    Ok(samples)
}

/// Evaluates a grid of so many columns and rows as a whole; no cubic was tried, so all cells are rough.
fn whole(skies: &Skies, columns: usize, rows: usize, cancel: &Cancel) -> Result<Samples, Cancelled> {
    let values: Result<Vec<Vec<f64>>, Cancelled> = (0..rows)
        .into_par_iter()
        .map(|row| {
            let at_row = skies.row(elevation_rad(row, rows));
            let value = |column| cancel.check().map(|()| at_row.radiance(azimuth_rad(column, columns)));
            (0..columns).map(value).collect()
        })
        .collect();
    let rough = vec![f32::INFINITY; columns * (rows - 1)];
    Ok(Samples { values: values?.concat(), columns, rows, rough, evaluated: columns * rows })
}

impl Samples {
    /// How far off cubics were found about an azimuth and an elevation, radians: a share.
    pub fn off(&self, azimuth_rad: f64, elevation_rad: f64) -> f64 {
        let column = (azimuth_rad.rem_euclid(TAU) / TAU * self.columns as f64) as usize % self.columns;
        let row = (elevation_rad / FRAC_PI_2 * (self.rows - 1) as f64) as usize;
        f64::from(self.rough[row.min(self.rows - 2) * self.columns + column])
    }

    /// The value at an azimuth and an elevation, radians: the cubic through the four nearest columns and rows.
    pub fn at(&self, azimuth_rad: f64, elevation_rad: f64) -> f64 {
        let across = azimuth_rad.rem_euclid(TAU) / TAU * self.columns as f64;
        let up = (elevation_rad / FRAC_PI_2).clamp(0.0, 1.0) * (self.rows - 1) as f64;
        let (column, row) = (across.floor(), up.floor().min((self.rows - 2) as f64));
        let [left, below] = [cubic(across - column), cubic(up - row)];
        let (column, row) = (column as usize, row as usize);
        let along = |row: usize| -> f64 {
            (0..4).map(|step| left[step] * self.value(row, (column + self.columns + step - 1) % self.columns)).sum()
        };
        (0..4).map(|step| below[step] * self.beyond(row as isize + step as isize - 1, along)).sum::<f64>().max(0.0)
    }

    fn value(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    /// A value by row, where the row before the first and the one after the last are on the straight line of the two within.
    fn beyond(&self, row: isize, value: impl Fn(usize) -> f64) -> f64 {
        let last = self.rows as isize - 1;
        match row {
            -1 => 2.0 * value(0) - value(1),
            _ if row > last => 2.0 * value(last as usize) - value(last as usize - 1),
            _ => value(row as usize),
        }
    }

    /// The grid of half the spacing.
    fn doubled(&self, skies: &Skies, tolerance: f64, cancel: &Cancel) -> Result<Self, Cancelled> {
        let (columns, rows) = (2 * self.columns, 2 * self.rows - 1);
        let finer: Result<Vec<FineRow>, Cancelled> =
            (0..rows).into_par_iter().map(|row| self.fine_row(skies, tolerance, row, cancel)).collect();
        let finer = finer?;

        // A cell is as rough as what was found wrong on it and at its corners.
        let rough = (0..rows - 1).flat_map(|row| {
            let rows = [&finer[row].off, &finer[row + 1].off];
            (0..columns).map(move |column| {
                let columns = [column, (column + 1) % columns];
                rows.iter().flat_map(|off| columns.map(|column| off[column])).fold(0.0, f32::max)
            })
        });
        let rough = rough.collect();
        let evaluated = self.evaluated + finer.iter().map(|row| row.evaluated).sum::<usize>();
        let values = finer.into_iter().flat_map(|row| row.values).collect();
        Ok(Self { values, columns, rows, rough, evaluated })
    }

    /// One row of the finer grid: first, in a row between two of this grid, the points below and above one of it; then those
    /// between two columns.
    fn fine_row(&self, skies: &Skies, tolerance: f64, row: usize, cancel: &Cancel) -> Result<FineRow, Cancelled> {
        let (columns, rows) = (2 * self.columns, 2 * self.rows - 1);
        let mut fine = FineRow { values: vec![0.0; columns], off: vec![0.0; columns], evaluated: 0 };
        let mut sums: Option<Row> = None;
        let mut settle = |fine: &mut FineRow, column: usize, predicted: f64| {
            if self.roughness(row, column) <= tolerance as f32 {
                fine.values[column] = predicted.max(0.0);
                return Ok(());
            }
            // One sum of a year in minutes takes a millisecond, a row of them seconds.
            cancel.check()?;
            let sums = sums.get_or_insert_with(|| skies.row(elevation_rad(row, rows)));
            let value = sums.radiance(azimuth_rad(column, columns));
            fine.values[column] = value;
            fine.off[column] = if value > 0.0 { ((predicted - value).abs() / value) as f32 } else { 0.0 };
            fine.evaluated += 1;
            Ok(())
        };

        for column in 0..self.columns {
            if row.is_multiple_of(2) {
                fine.values[2 * column] = self.value(row / 2, column);
                continue;
            }
            let at = |step: isize| self.beyond((row / 2) as isize + step, |row| self.value(row, column));
            let predicted = middle([at(-1), at(0), at(1), at(2)]);
            settle(&mut fine, 2 * column, predicted)?;
        }
        for column in (1..columns).step_by(2) {
            let at = |step: usize| fine.values[(column + columns + step - 3) % columns];
            let predicted = middle([at(0), at(2), at(4), at(6)]);
            settle(&mut fine, column, predicted)?;
        }
        Ok(fine)
    }

    /// How far off cubics were found in the cells of this grid around a point of the finer one.
    fn roughness(&self, fine_row: usize, fine_column: usize) -> f32 {
        let rows = [fine_row.saturating_sub(1) / 2, (fine_row / 2).min(self.rows - 2)];
        let columns = [(fine_column + 2 * self.columns - 1) % (2 * self.columns) / 2, fine_column / 2];
        let cells = rows.into_iter().flat_map(|row| columns.map(|column| self.rough[row * self.columns + column]));
        cells.fold(0.0, f32::max)
    }
}

/// A row of a finer grid.
struct FineRow {
    values: Vec<f64>,
    /// How far the prediction was off, a share; 0 where it was not tried.
    off: Vec<f32>,
    evaluated: usize,
}

fn azimuth_rad(column: usize, columns: usize) -> f64 {
    TAU * column as f64 / columns as f64
}

fn elevation_rad(row: usize, rows: usize) -> f64 {
    FRAC_PI_2 * row as f64 / (rows - 1) as f64
}

/// The cubic through four even points, half-way between the inner two.
fn middle([a, b, c, d]: [f64; 4]) -> f64 {
    (9.0 * (b + c) - a - d) / 16.0
}

/// Weights of four even points at a part of the way between the inner two: Catmull and Rom's cubic, which half-way is
/// [`middle`].
fn cubic(part: f64) -> [f64; 4] {
    let (square, cube) = (part * part, part * part * part);
    [
        -0.5 * cube + square - 0.5 * part,
        1.5 * cube - 2.5 * square + 1.0,
        -1.5 * cube + 2.0 * square + 0.5 * part,
        0.5 * cube - 0.5 * square,
    ]
}
