//! What do neighbours of a pixel say that lie on its surface?
//!
//! Pixels of a tile look in different directions; their mean has looked in all of them. Averaged are those that face the same way
//! and lie in each other's plane, first along rows and then along columns, as far as a tile reaches.

use super::{Seen, Surfaces, TILE};
use rayon::prelude::*;

/// Least cosine between the normals of pixels that are averaged: 18 degrees.
const SAME_NORMAL: f32 = 0.95;

/// How far a place may lie off another's plane, in widths of a pixel.
const SAME_PLANE_PX: f32 = 1.0;

/// The means over a tile about each pixel, of what lies on its surface.
pub fn smoothed(seen: Seen, surfaces: &Surfaces) -> Seen {
    let along_rows = averaged(&seen, surfaces, 1);
    averaged(&along_rows, surfaces, surfaces.size[0])
}

/// The means over [`TILE`] pixels that lie `stride` apart.
fn averaged(seen: &Seen, surfaces: &Surfaces, stride: usize) -> Seen {
    let [width, height] = surfaces.size;
    let off_m = SAME_PLANE_PX * surfaces.pixel_m;
    let mut mean = Seen { total_kwh_m2: vec![0.0; width * height], svf: vec![0.0; width * height] };
    let rows = mean.total_kwh_m2.par_chunks_mut(width).zip(mean.svf.par_chunks_mut(width)).enumerate();
    rows.for_each(|(row, (totals, svfs))| {
        for (column, (total, svf)) in totals.iter_mut().zip(svfs).enumerate() {
            let pixel = row * width + column;
            let (at_m, normal) = (surfaces.position_m(pixel), surfaces.normal(pixel));
            let (place, side) = if stride == 1 { (column, width) } else { (row, height) };
            let (mut sum, mut count) = ([0.0; 2], 0.0_f32);
            // One more on one side than on the other: a whole tile.
            for other in place.saturating_sub(TILE / 2 - 1)..(place + TILE / 2 + 1).min(side) {
                let other = pixel + other * stride - place * stride;
                let plane_m = (surfaces.position_m(other) - at_m).dot(normal).abs();
                if plane_m <= off_m && normal.dot(surfaces.normal(other)) >= SAME_NORMAL {
                    sum = [sum[0] + seen.total_kwh_m2[other], sum[1] + seen.svf[other]];
                    count += 1.0;
                }
            }
            (*total, *svf) = (sum[0] / count.max(1.0), sum[1] / count.max(1.0));
        }
    });
    mean
}
