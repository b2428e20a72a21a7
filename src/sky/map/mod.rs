//! How much light comes from each direction over a period?
//!
//! The exposure map of Muñoz-Pandiella et al. ("Real-time solar exposure simulation in complex cities", 2017): the hemisphere
//! as a picture, azimuth by elevation; each texel holds the energy that comes through it in the period, radiance times time
//! times its solid angle, kWh/m2 on a plane that faces it. No cosine is in it: who asks for a surface multiplies by
//! the cosine to its normal. The smooth part from the sky and the beams from the sun are kept apart; the suns are kept as
//! positions with energies besides, for who wants sharp beams.
//!
//! The smooth part is evaluated where it must be ([`diffuse`]), and compared with the full sum at a few hundred texels.
//!
//! Limits: a splat smears a beam over its texel, 0.7 by 0.2 degrees at 512 x 512; with steps of an hour the suns of a day
//! stand 15 degrees apart, and only a period of many days fills the band between.

pub mod diffuse;
pub mod levels;
#[cfg(test)]
mod tests;

use super::disc::Disc;
use super::dome::{Haze, SkyModel, skies};
use super::spectrum::Band;
use super::steps::{Steps, Totals};
use super::term::{Skies, Term};
use super::{Sun, towards};
use crate::job::{Cancel, Cancelled, Progress};
use diffuse::{Samples, sample};
use glam::DVec3;
use jiff::civil::DateTime;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Parts of the sun's disc that are splatted by themselves.
const PARTS_OF_DISC: u32 = 32;

/// Texels at which the smooth part is compared with the full sum: some milliseconds for a year.
const CHECKED: u32 = 400;

/// Share of the energy in the texels that the comparison counts; what is left lies in the darkest.
pub const COUNTED_ENERGY: f64 = 0.999;

/// How a map is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapSettings {
    /// Texels along the azimuth and along the elevation, 1 to 8192 each.
    pub size: [usize; 2],
    /// How the sky's light is spread.
    pub model: SkyModel,
    /// For the models of clear skies.
    pub haze: Haze,
    /// Share by which an interpolated texel may be off; `None` evaluates the full sum in every texel.
    pub tolerance: Option<f64>,
}

impl Default for MapSettings {
    /// 512 x 512, Perez' sky, interpolated within 0.1% where it is tried.
    fn default() -> Self {
        let haze = Haze { turbidity: 3.0, ground_albedo: 0.2, band: Band::Broadband };
        Self { size: [512, 512], model: SkyModel::Perez, haze, tolerance: Some(0.001) }
    }
}

/// The sun of a step and what its beam brings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunEnergy {
    /// The step's middle, local standard time.
    pub time: DateTime,
    /// Where the sun is seen.
    pub sun: Sun,
    /// Energy of the beam on a plane that faces it, kWh/m2.
    pub energy_kwh_m2: f64,
    /// How long it shines, hours.
    pub hours: f64,
}

/// What comes from each direction over a period.
///
/// Texels are stored row by row; row 0 lies on the horizon, column 0 begins at true north, and columns go clockwise.
#[derive(Debug, Clone)]
pub struct ExposureMap {
    /// Columns (azimuth) and rows (elevation).
    pub size: [usize; 2],
    /// Energy from the sky through each texel, kWh/m2.
    pub diffuse_kwh_m2: Vec<f32>,
    /// Energy of the sun's beams through each texel, kWh/m2.
    pub direct_kwh_m2: Vec<f32>,
    /// The suns that have a beam.
    pub suns: Vec<SunEnergy>,
    /// What the period brings, summed before any texel.
    pub totals: Totals,
    /// How far the smooth part is from the full sum.
    pub check: Check,
}

/// The smooth part against the full sum.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Check {
    /// Directions in which the full sum was evaluated to make the map.
    pub evaluated: usize,
    /// Texels compared.
    pub texels: usize,
    /// Root of the mean squared error, a share, over compared texels that count.
    pub rms: f64,
    /// Largest error, a share.
    pub largest: f64,
}

impl ExposureMap {
    /// The map of a period.
    ///
    /// A year of hours at 512 x 512 takes a tenth of a second on two threads, half a second for Hosek's and Wilkie's sky, most
    /// of it sums of 4,600 skies in some thousand directions (`cargo bench --bench sky`).
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn build(
        steps: &Steps,
        settings: &MapSettings,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        progress.begin("exposure map", 0);
        let terms: Vec<Term> = skies(settings.model, settings.haze, &steps.steps, cancel)?
            .into_iter()
            .filter_map(|(step, term)| {
                let hours = steps.steps.get(step)?.hours;
                Some(Term { weight: term.weight * hours / 1000.0, ..term })
            })
            .collect();
        let sum = Skies::new(&terms);
        let size = settings.size.map(|texels| texels.clamp(1, 8192));
        let mut map = Self::of_parts(steps, size, Vec::new(), vec![0.0; size[0] * size[1]], Check::default());
        map.fill_diffuse(&sum, settings.tolerance, cancel)?;
        map.splat_suns(cancel)?;
        progress.end();
        Ok(map)
    }

    /// The map of a period whose texels are known already: those of an earlier map of the same period and settings.
    pub fn of_parts(
        steps: &Steps,
        size: [usize; 2],
        diffuse_kwh_m2: Vec<f32>,
        direct_kwh_m2: Vec<f32>,
        check: Check,
    ) -> Self {
        Self { size, diffuse_kwh_m2, direct_kwh_m2, suns: suns(steps), totals: steps.totals(), check }
    }

    /// Azimuth and elevation of the middle of a texel, radians.
    pub fn middle_rad(&self, column: usize, row: usize) -> (f64, f64) {
        let [columns, rows] = self.size.map(|texels| texels as f64);
        (TAU * (column as f64 + 0.5) / columns, FRAC_PI_2 * (row as f64 + 0.5) / rows)
    }

    /// The direction of the middle of a texel: x east, y true north, z up.
    pub fn towards(&self, column: usize, row: usize) -> DVec3 {
        let (azimuth_rad, elevation_rad) = self.middle_rad(column, row);
        towards(azimuth_rad, elevation_rad)
    }

    /// The solid angle of a texel in a row, steradians.
    pub fn solid_angle_sr(&self, row: usize) -> f64 {
        let [columns, rows] = self.size.map(|texels| texels as f64);
        let edge = |row: usize| (FRAC_PI_2 * row as f64 / rows).sin();
        TAU / columns * (edge(row + 1) - edge(row))
    }

    /// The column and row of the texel at an azimuth and an elevation, radians; below the horizon the lowest row.
    pub fn texel(&self, azimuth_rad: f64, elevation_rad: f64) -> [usize; 2] {
        let [columns, rows] = self.size;
        let across = azimuth_rad.rem_euclid(TAU) / TAU * columns as f64;
        let up = elevation_rad / FRAC_PI_2 * rows as f64;
        [(across as usize).min(columns - 1), (up.max(0.0) as usize).min(rows - 1)]
    }

    /// What the texels add up to: the same figures as [`ExposureMap::totals`], but for what the texels' size takes.
    pub fn texel_totals(&self) -> Totals {
        let mut totals = Totals::default();
        for row in 0..self.size[1] {
            let sin_elevation = self.middle_rad(0, row).1.sin();
            let texels = row * self.size[0]..(row + 1) * self.size[0];
            let sum = |energies: &[f32]| energies[texels.clone()].iter().map(|&energy| f64::from(energy)).sum::<f64>();
            let (dni, dhi) = (sum(&self.direct_kwh_m2), sum(&self.diffuse_kwh_m2) * sin_elevation);
            totals.dni_kwh_m2 += dni;
            totals.dhi_kwh_m2 += dhi;
            totals.ghi_kwh_m2 += dni * sin_elevation + dhi;
        }
        totals
    }

    fn fill_diffuse(&mut self, sum: &Skies, tolerance: Option<f64>, cancel: &Cancel) -> Result<(), Cancelled> {
        let [columns, rows] = self.size;
        let samples = tolerance.map(|tolerance| sample(sum, self.size, tolerance, cancel)).transpose()?;
        let is_smooth = |samples: &Samples, (azimuth_rad, elevation_rad)| {
            tolerance.is_some_and(|tolerance| samples.off(azimuth_rad, elevation_rad) <= tolerance)
        };
        let rows: Result<Vec<(Vec<f32>, usize)>, Cancelled> = (0..rows)
            .into_par_iter()
            .map(|row| {
                let solid_angle_sr = self.solid_angle_sr(row);
                let (mut sums, mut evaluated) = (None, 0);
                let texel = |column: usize| {
                    cancel.check()?;
                    let (azimuth_rad, elevation_rad) = self.middle_rad(column, row);
                    let smooth = samples.as_ref().filter(|samples| is_smooth(samples, (azimuth_rad, elevation_rad)));
                    let radiance = smooth.map(|samples| samples.at(azimuth_rad, elevation_rad)).unwrap_or_else(|| {
                        evaluated += 1;
                        sums.get_or_insert_with(|| sum.row(elevation_rad)).radiance(azimuth_rad)
                    });
                    Ok((radiance * solid_angle_sr) as f32)
                };
                let energies = (0..columns).map(texel).collect::<Result<_, Cancelled>>()?;
                Ok((energies, evaluated))
            })
            .collect();
        let rows = rows?;
        let evaluated = rows.iter().map(|(_, evaluated)| evaluated).sum::<usize>();
        self.diffuse_kwh_m2 = rows.into_iter().flat_map(|(energies, _)| energies).collect();
        self.check = match samples {
            None => Check { evaluated, ..Check::default() },
            Some(samples) => Check { evaluated: samples.evaluated + evaluated, ..self.checked(sum) },
        };
        Ok(())
    }

    /// Compares some texels, spread over the map as evenly as by Roberts' additive sequence, with the full sum.
    fn checked(&self, sum: &Skies) -> Check {
        /// Powers of the inverse of the plastic number.
        const STRIDES: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
        let least = least_counted(&self.diffuse_kwh_m2);
        let errors: Vec<f64> = (0..CHECKED)
            .into_par_iter()
            .filter_map(|number| {
                let place =
                    |axis: usize| ((f64::from(number) * STRIDES[axis]).fract() * self.size[axis] as f64) as usize;
                let (column, row) = (place(0), place(1));
                let energy = *self.diffuse_kwh_m2.get(row * self.size[0] + column)?;
                let (azimuth_rad, elevation_rad) = self.middle_rad(column, row);
                let full = sum.row(elevation_rad).radiance(azimuth_rad) * self.solid_angle_sr(row);
                (energy >= least && full > 0.0).then(|| (f64::from(energy) / full - 1.0).abs())
            })
            .collect();
        let mean = errors.iter().map(|error| error * error).sum::<f64>() / errors.len().max(1) as f64;
        let largest = errors.iter().copied().fold(0.0, f64::max);
        Check { evaluated: 0, texels: errors.len(), rms: mean.sqrt(), largest }
    }

    /// Each beam over the sun's disc; what of a disc lies under the horizon goes to the row on it.
    fn splat_suns(&mut self, cancel: &Cancel) -> Result<(), Cancelled> {
        let disc_rad = Disc::new(1.0).angular_radius_rad;
        for SunEnergy { sun, energy_kwh_m2, .. } in self.suns.clone() {
            cancel.check()?;
            let middle = sun.towards();
            let (right, up) = middle.any_orthonormal_pair();
            for part in 0..PARTS_OF_DISC {
                // Vogel's spiral: equal areas, evenly spread.
                let radius = disc_rad * ((f64::from(part) + 0.5) / f64::from(PARTS_OF_DISC)).sqrt();
                let (sin, cos) = (f64::from(part) * PI * (3.0 - 5.0_f64.sqrt())).sin_cos();
                let (azimuth_rad, elevation_rad) =
                    super::azimuth_elevation_rad(middle + radius * (cos * right + sin * up));
                let [column, row] = self.texel(azimuth_rad, elevation_rad);
                self.direct_kwh_m2[row * self.size[0] + column] += (energy_kwh_m2 / f64::from(PARTS_OF_DISC)) as f32;
            }
        }
        Ok(())
    }
}

/// The suns of the steps that have a beam.
fn suns(steps: &Steps) -> Vec<SunEnergy> {
    let beams = steps.steps.iter().filter(|step| step.dni_w_m2 > 0.0);
    beams
        .map(|step| SunEnergy {
            time: step.time,
            sun: step.sun,
            energy_kwh_m2: step.dni_w_m2 * step.hours / 1000.0,
            hours: step.hours,
        })
        .collect()
}

/// The energy of the dimmest texel among the brightest that hold [`COUNTED_ENERGY`] of all. By halves, as one finds a
/// median, in time that grows with the texels and no faster.
pub fn least_counted(energies: &[f32]) -> f32 {
    let sum = |energies: &[f32]| energies.iter().map(|&energy| f64::from(energy)).sum::<f64>();
    let mut wanted = COUNTED_ENERGY * sum(energies);
    let mut all = energies.to_vec();
    let mut rest = all.as_mut_slice();
    let mut least = 0.0;
    while !rest.is_empty() {
        let (brighter, middle, dimmer) = rest.select_nth_unstable_by(rest.len() / 2, |a, b| b.total_cmp(a));
        let (held, of_middle) = (sum(brighter), f64::from(*middle));
        if held >= wanted {
            rest = brighter;
        } else {
            // All that is brighter counts, and the middle too.
            least = *middle;
            wanted -= held + of_middle;
            rest = if wanted > 0.0 { dimmer } else { &mut [] };
        }
    }
    least
}
