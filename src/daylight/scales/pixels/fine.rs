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

use super::super::azimuth_rad;
use super::super::sight::between;
use super::{Covered, Look, MOST_DIRECTIONS, Surfaces, TURNS};
use crate::job::{Cancel, Cancelled};
use glam::{Vec2, Vec3A};
use rayon::prelude::*;
use std::f32::consts::TAU;

/// The farthest step, pixels: nearer things are looked at more coarsely.
const FARTHEST_PX: f32 = 48.0;

/// Two places are of one surface where they are no farther apart than this many times what their pixels are.
const JOINED: f32 = 3.0;

/// Things that rise less than this over a pixel's plane, by the sine, are its own surface.
const LEAST_RISE: f32 = 0.02;

/// A step to a pixel.
#[derive(Debug, Clone, Copy)]
struct Step {
    /// Columns to the right.
    across: i32,
    /// Rows down.
    down: i32,
    length_px: f32,
}

/// The steps of all directions of a picture.
#[derive(Debug, Clone)]
pub struct Steps {
    directions: usize,
    /// Those of a direction in a row.
    steps: Vec<Step>,
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
                let [across, down] = [cosine, sine].map(|axis| (at * axis).round() as i32);
                steps.push(Step { across, down, length_px: Vec2::new(across as f32, down as f32).length() });
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
                for &Step { across, down, .. } in steps {
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
        let [from_m, normal] = surfaces.place(pixel);
        let sectors = self.directions as f32 / TAU;
        let turned = turn as f32 / TURNS as f32 - 0.5;
        let most = self.reach_m * self.reach_m;
        let mut covered = [0; MOST_DIRECTIONS];
        for steps in self.steps.chunks(self.samples.max(1)) {
            let (mut before_m, mut before_px) = (Vec3A::ZERO, 0.0);
            for &Step { across, down, length_px } in steps {
                let (x, y) = (column + across, row + down);
                if x < 0 || y < 0 || x >= width as i32 || y >= height as i32 {
                    break;
                }
                let [at_m, _] = surfaces.place(y as usize * width + x as usize);
                let off_m = at_m - from_m;
                let squared = off_m.length_squared();
                // Nothing is hit there, or it is far away.
                if squared.is_nan() || squared >= most {
                    before_m = Vec3A::NAN;
                    continue;
                }
                let rises_m = off_m.dot(normal);
                if off_m.z > 0.0 && rises_m > 0.0 && rises_m * rises_m > LEAST_RISE * LEAST_RISE * squared {
                    let sine = |off_m: Vec3A| off_m.z / (off_m.length_squared() + 1e-12).sqrt();
                    let pixel_m = surfaces.pixel_m * (length_px - before_px).max(1.0);
                    let (this, half) = (sine(off_m), 0.5 * pixel_m / (squared.sqrt() + pixel_m));
                    let is_joined = off_m.distance_squared(before_m) < (JOINED * pixel_m).powi(2);
                    let other = if is_joined { sine(before_m) } else { this };
                    let (low, high) =
                        if is_joined { (this.min(other), this.max(other)) } else { (this - half, this + half) };
                    // Half a sector at most lies before the first one: it belongs to the last.
                    let sector = azimuth_rad(off_m.x, off_m.y) * sectors - turned;
                    let sector = if sector < 0.0 { self.directions - 1 } else { sector as usize % self.directions };
                    covered[sector] |= between(low, high);
                }
                (before_m, before_px) = (off_m, length_px);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_stay_in_the_picture() {
        assert_eq!([columns_within(10, 3), columns_within(10, -4), columns_within(3, 5)], [0..7, 4..10, 0..0]);
        assert!(columns_within(3, -5).is_empty());
    }
}
