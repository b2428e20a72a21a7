//! What of the sky do things beside a pixel hide that are too small for the map of heights?
//!
//! Horizon-based visibility in the camera's own buffers (Bavoil, Sainz & Dimitrov 2008, as Muñoz-Pandiella et al. use it). From
//! each pixel some steps are taken in some directions of the picture; the places behind the pixels there stand above the
//! pixel's tangent plane or not. Two readings: [`Steps::visible`], the share of the half space that is left, each rise of the horizon
//! weighted by how near it is; and [`Steps::covered`], the elevations of the sky that they cover, each in the direction of the
//! horizon where it truly stands, to be cut out of what the large scale sees.
//!
//! The steps are the same for all pixels, so that the first reading runs over whole rows at a fixed offset.
//!
//! Limits: what the camera does not see hides nothing; the thickness of things is not known, only surfaces that go on from one
//! step to the next are held to be closed between them.

use super::super::sight::between;
use super::{Covered, Look, MOST_DIRECTIONS, Surfaces, TURNS};
use crate::job::{Cancel, Cancelled};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// The farthest step, pixels: nearer things are looked at more coarsely.
const FARTHEST_PX: f32 = 48.0;

/// Two places are of one surface where they are no farther apart than this many times what their pixels are.
const JOINED: f32 = 3.0;

/// The steps of all directions of a picture.
#[derive(Debug, Clone)]
pub struct Steps {
    directions: usize,
    /// Columns and rows to each step, those of a direction in a row.
    steps: Vec<[i32; 2]>,
    samples: usize,
    reach_m: f32,
}

impl Steps {
    /// Steps out to where [`Look::fine_reach_m`] is seen at the picture's median distance.
    pub fn new(surfaces: &Surfaces, directions: usize, look: &Look) -> Self {
        let reach_px = (look.fine_reach_m / surfaces.pixel_m).clamp(look.fine_samples as f32, FARTHEST_PX);
        let mut steps = Vec::new();
        for direction in 0..directions {
            let (sine, cosine) = (TAU * (direction as f32 + 0.5) / directions as f32).sin_cos();
            for sample in 0..look.fine_samples {
                let part = (sample + 1) as f32 / look.fine_samples as f32;
                // Closer together near the pixel, and at least one apart.
                let at = (sample + 1) as f32 + (reach_px - look.fine_samples as f32) * part * part;
                steps.push([cosine, sine].map(|axis| (at * axis).round() as i32));
            }
        }
        Self { directions, steps, samples: look.fine_samples, reach_m: look.fine_reach_m }
    }

    /// The share of the half space before each pixel that is left visible, 0 to 1.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn visible(&self, surfaces: &Surfaces, cancel: &Cancel) -> Result<Vec<f32>, Cancelled> {
        let [width, height] = surfaces.size;
        let mut visible = vec![1.0; width * height];
        visible.par_chunks_mut(width).enumerate().try_for_each(|(row, visible)| {
            cancel.check()?;
            let mut horizon = vec![0.0; width];
            let mut hidden = vec![0.0; width];
            for steps in self.steps.chunks(self.samples.max(1)) {
                horizon.fill(0.0);
                for &[across, down] in steps {
                    let other = row as i64 + i64::from(down);
                    let columns = columns_within(width, across);
                    if (0..height as i64).contains(&other) && !columns.is_empty() {
                        let there = other as usize * width + columns.start.wrapping_add_signed(across as isize);
                        self.raise(
                            surfaces,
                            row * width + columns.start,
                            there,
                            &mut horizon[columns.clone()],
                            &mut hidden[columns],
                        );
                    }
                }
            }
            let share = 1.0 / self.directions as f32;
            visible.iter_mut().zip(&hidden).for_each(|(visible, hidden)| *visible = (1.0 - share * hidden).max(0.0));
            Ok(())
        })?;
        Ok(visible)
    }

    /// Raises the horizons of pixels in a row by the places behind others in a row, and adds what that hides.
    fn raise(&self, surfaces: &Surfaces, here: usize, there: usize, horizon: &mut [f32], hidden: &mut [f32]) {
        let count = horizon.len();
        let [x, y, z] = surfaces.positions_m.each_ref().map(|axis| &axis[here..here + count]);
        let [at_x, at_y, at_z] = surfaces.positions_m.each_ref().map(|axis| &axis[there..there + count]);
        let [n_x, n_y, n_z] = surfaces.normals.each_ref().map(|axis| &axis[here..here + count]);
        let per_reach = (self.reach_m * self.reach_m).recip();
        let hidden = &mut hidden[..count];
        for pixel in 0..count {
            let off = [at_x[pixel] - x[pixel], at_y[pixel] - y[pixel], at_z[pixel] - z[pixel]];
            let squared = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
            let up = off[0] * n_x[pixel] + off[1] * n_y[pixel] + off[2] * n_z[pixel];
            // Not a number where either pixel meets nothing: the larger of that and 0 is 0.
            let sine = up / (squared + 1e-12).sqrt();
            let near = (1.0 - squared * per_reach).max(0.0);
            let rise = if near > 0.0 { (sine - horizon[pixel]).max(0.0) } else { 0.0 };
            hidden[pixel] += rise * near;
            horizon[pixel] += rise;
        }
    }

    /// The elevations that are covered in each direction of the horizon about a pixel that is turned so.
    pub fn covered(&self, surfaces: &Surfaces, pixel: usize, turn: usize) -> Covered {
        let [width, height] = surfaces.size;
        let (column, row) = ((pixel % width) as i32, (pixel / width) as i32);
        let (from_m, normal) = (surfaces.position_m(pixel), surfaces.normal(pixel));
        let sectors = self.directions as f32 / TAU;
        let turned = turn as f32 / TURNS as f32 - 0.5;
        let mut covered = [0; MOST_DIRECTIONS];
        for steps in self.steps.chunks(self.samples.max(1)) {
            let (mut before_m, mut before_sine, mut before_px) = (from_m, 0.0_f32, 0.0);
            for &[across, down] in steps {
                let (x, y) = (column + across, row + down);
                if x < 0 || y < 0 || x >= width as i32 || y >= height as i32 {
                    break;
                }
                let at_m = surfaces.position_m(y as usize * width + x as usize);
                let off_m = at_m - from_m;
                let squared = off_m.length_squared();
                // Nothing is hit there, or it is far away.
                if squared.is_nan() || squared >= self.reach_m * self.reach_m {
                    before_m = Vec3::NAN;
                    continue;
                }
                let px = Vec2::new(across as f32, down as f32).length();
                let sine = off_m.z / (squared + 1e-12).sqrt();
                let pixel_m = surfaces.pixel_m * (px - before_px).max(1.0);
                let joined = at_m.distance_squared(before_m) < (JOINED * pixel_m).powi(2);
                if off_m.dot(normal) > 0.02 * squared.sqrt() && off_m.z > 0.0 {
                    let half = 0.5 * pixel_m / (squared.sqrt() + pixel_m);
                    let (low, high) = if joined {
                        (sine.min(before_sine), sine.max(before_sine))
                    } else {
                        (sine - half, sine + half)
                    };
                    let sector = (azimuth_rad(off_m.x, off_m.y) * sectors - turned).rem_euclid(self.directions as f32);
                    covered[(sector as usize).min(self.directions - 1)] |= between(low, high);
                }
                (before_m, before_sine, before_px) = (at_m, sine, px);
            }
        }
        covered
    }
}

/// The columns from which a step stays in the picture.
fn columns_within(width: usize, across: i32) -> std::ops::Range<usize> {
    let (left, right) = (across.min(0).unsigned_abs() as usize, across.max(0) as usize);
    left.min(width)..width.saturating_sub(right).max(left.min(width))
}

/// The azimuth of a level direction, clockwise from +Y, within a quarter of a degree; a third of the time of the exact one.
fn azimuth_rad(x: f32, y: f32) -> f32 {
    let (a, b) = (x.abs(), y.abs());
    let ratio = a.min(b) / a.max(b).max(f32::MIN_POSITIVE);
    // Rajan et al. 2006, "Efficient approximations for the arctangent function", equation 7.
    let octant = ratio * (FRAC_PI_4 + 0.273 * (1.0 - ratio));
    let quarter = if a > b { FRAC_PI_2 - octant } else { octant };
    let half = if y < 0.0 { PI - quarter } else { quarter };
    if x < 0.0 { TAU - half } else { half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_run_clockwise_from_the_north() {
        for number in 0..720 {
            let exact = number as f32 * TAU / 720.0;
            let found = azimuth_rad(exact.sin() * 3.0, exact.cos() * 3.0);
            let off = (found - exact + PI).rem_euclid(TAU) - PI;
            assert!(off.abs() < 0.25_f32.to_radians(), "{exact} {found}");
        }
    }

    #[test]
    fn steps_stay_in_the_picture() {
        assert_eq!([columns_within(10, 3), columns_within(10, -4), columns_within(3, 5)], [0..7, 4..10, 0..0]);
        assert!(columns_within(3, -5).is_empty());
    }
}
