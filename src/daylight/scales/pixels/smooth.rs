//! What do neighbours of a pixel say that lie on its surface?
//!
//! Pixels of a tile look in different directions; their mean has looked in all of them. Averaged are those that face the same way
//! and lie in each other's plane, first along rows and then along columns, as far as a tile reaches.

use super::{Received, Surfaces, TILE};
use rayon::prelude::*;

/// Least cosine between the normals of pixels that are averaged: 18 degrees.
const SAME_NORMAL: f32 = 0.95;

/// How far a place may lie off another's plane, in widths of a pixel.
const SAME_PLANE_PX: f32 = 1.0;

/// The means over a tile about each pixel, of what lies on its surface.
pub fn smoothed(seen: &[Received], surfaces: &Surfaces) -> Vec<Received> {
    averaged(&averaged(seen, surfaces, 1), surfaces, surfaces.size[0])
}

/// The means over [`TILE`] pixels that lie `stride` apart.
fn averaged(seen: &[Received], surfaces: &Surfaces, stride: usize) -> Vec<Received> {
    let [width, height] = surfaces.size;
    let off_m = SAME_PLANE_PX * surfaces.pixel_m;
    let mut means = vec![Received::default(); width * height];
    means.par_chunks_mut(width.max(1)).enumerate().for_each(|(row, means)| {
        for (column, mean) in means.iter_mut().enumerate() {
            let pixel = row * width + column;
            let [at_m, normal] = surfaces.place(pixel);
            let (place, side) = if stride == 1 { (column, width) } else { (row, height) };
            let (mut sum, mut count) = (Received::default(), 0.0_f32);
            // One more on one side than on the other: a whole tile.
            for other in place.saturating_sub(TILE / 2 - 1)..(place + TILE / 2 + 1).min(side) {
                let other = pixel + other * stride - place * stride;
                let [other_m, other_normal] = surfaces.place(other);
                if (other_m - at_m).dot(normal).abs() <= off_m && normal.dot(other_normal) >= SAME_NORMAL {
                    sum = sum.and(seen[other]);
                    count += 1.0;
                }
            }
            *mean = sum.times(count.max(1.0).recip());
        }
    });
    means
}
