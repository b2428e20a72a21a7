//! The two scales, and rays, at the pixels of a close view.

use crate::measure::{Row, TRUTH, median_s, per_second, rmse, svf_error, timed};
use lightvein::daylight::camera::{Buffers, Camera, DEFAULT_FOV_RAD};
use lightvein::daylight::cast::{Asked, Casting, cast_at};
use lightvein::daylight::scales::pixels::taps::Taps;
use lightvein::daylight::scales::pixels::{Combination, Look, Part, PixelSums, Surfaces, TURNS, see};
use lightvein::daylight::scales::sums::SkySums;
use lightvein::daylight::scales::zenith::Zenith;
use lightvein::daylight::way::{FINE_REACH_M, Ground};
use lightvein::daylight::{Exposure, Point};
use lightvein::job::{Cancel, Quiet};
use std::error::Error;

const SIZE: [usize; 2] = [800, 600];
const RUNS: usize = 5;

/// Pixels at which errors are found.
const CHECKED: usize = 400;

/// How much nearer the camera stands than where it sees the whole scene.
const NEARER: f32 = 0.65;

/// Texels of the heights.
const TEXELS: usize = 512;

/// Suns and directions a pixel.
const RAYS: [[u32; 2]; 3] = [[16, 32], [64, 64], [256, 256]];

/// Directions, and samples of each scale.
const SCALES: [[usize; 2]; 2] = [[8, 8], [16, 16]];

/// Names, whether with opening angles, and how the scales are combined.
const COMBINATIONS: [(&str, bool, Combination); 4] = [
    ("height field", false, Combination::Large),
    ("opening angles", true, Combination::Large),
    ("weighted", true, Combination::Weighted),
    ("intersected", true, Combination::Intersected),
];

/// A picture and some of its pixels with their truth.
struct View {
    surfaces: Surfaces,
    hit: Vec<usize>,
    checked: Vec<usize>,
    truth: Vec<Exposure>,
}

/// What each way is worth at the pixels.
pub fn rows(ground: &Ground) -> Result<Vec<Row>, Box<dyn Error>> {
    let quiet = (&Quiet, &Cancel::new());
    let (low_m, high_m) = ground.scene.mesh.bounds_m().ok_or("a scene without triangles has no view")?;
    let far = Camera::around(low_m, high_m, DEFAULT_FOV_RAD, SIZE)?;
    let towards_m = (low_m + high_m) / 2.0;
    let camera = Camera::new(far.from_m + NEARER * (towards_m - far.from_m), towards_m, DEFAULT_FOV_RAD, SIZE)?;
    let (buffers_s, buffers) = timed(|| Buffers::render(ground.rays, &camera, quiet.0, quiet.1));
    let buffers = buffers?;
    let (surfaces_s, surfaces) = timed(|| Surfaces::new(&buffers));
    println!("  buffers {:.0} ms, places {:.0} ms", 1e3 * buffers_s, 1e3 * surfaces_s);

    let hit: Vec<usize> = (0..camera.pixels()).filter(|&pixel| buffers.point(pixel).is_some()).collect();
    let checked: Vec<usize> = (0..CHECKED).map(|number| hit[number * 7919 % hit.len()]).collect();
    let truth = by_rays(ground, &buffers, &checked, TRUTH)?;
    let view = View { surfaces, hit, checked, truth };
    let mut rows = Vec::new();
    for is_smooth in [false, true] {
        for (series, opening, combination) in COMBINATIONS {
            for [directions, samples] in SCALES {
                let look = Look {
                    samples,
                    reach_m: None,
                    opening,
                    combination,
                    fine_samples: samples,
                    fine_reach_m: FINE_REACH_M,
                    smooth: is_smooth,
                };
                rows.push(by_scales(ground, &view, series, directions, &look)?);
            }
        }
    }
    // Whole rows of the picture, so that neighbours are asked one after the other.
    let some: Vec<usize> = view.hit.iter().copied().filter(|pixel| (pixel / SIZE[0]).is_multiple_of(8)).collect();
    for [suns, sky] in RAYS {
        let casting = Casting { sun_rays: Some(suns), sky_rays: sky, seed: 0 };
        let found = by_rays(ground, &buffers, &view.checked, casting)?;
        let least = some.len().min(2000);
        let per_s = per_second([least, some.len()], |count| drop(by_rays(ground, &buffers, &some[..count], casting)));
        let found = found.iter().map(|exposure| (exposure.total_kwh_m2(), exposure.svf));
        rows.push(row(&view, "rays", format!("{suns} + {sky}"), false, [0.0, per_s], found));
    }
    Ok(rows)
}

fn by_rays(
    ground: &Ground,
    buffers: &Buffers,
    pixels: &[usize],
    casting: Casting,
) -> Result<Vec<Exposure>, Box<dyn Error>> {
    let points: Vec<Point> = pixels.iter().filter_map(|&pixel| buffers.point(pixel)).collect();
    let numbers: Vec<u32> = pixels.iter().map(|&pixel| pixel as u32).collect();
    let asked = Asked { points: &points, numbers: Some(&numbers), in_the_open: true };
    Ok(cast_at(ground.rays, asked, ground.map, ground.north_rad, casting, &Quiet, &Cancel::new())?)
}

fn by_scales(
    ground: &Ground,
    view: &View,
    series: &'static str,
    directions: usize,
    look: &Look,
) -> Result<Row, Box<dyn Error>> {
    let cancel = Cancel::new();
    let make = || {
        let zenith = Zenith::new(ground.scene, TEXELS, false, &cancel).ok()?;
        let sums = SkySums::new(ground.map, ground.north_rad, directions, TURNS);
        Some((Taps::new(&zenith, &sums, look), PixelSums::new(&sums, Part::All)?))
    };
    let (taps, sums) = make().ok_or("too many directions for pixels")?;
    let seen = see(&taps, &sums, &view.surfaces, look, &cancel)?;
    // All pixels of the picture are worked out; those that show something count.
    let frame_s = median_s(RUNS, || drop(see(&taps, &sums, &view.surfaces, look, &cancel)));
    let made_s = median_s(3, || drop(make()));
    let has_fine = look.combination != Combination::Large;
    let samples = if has_fine { format!("({0}+{0})", look.samples) } else { look.samples.to_string() };
    let found = view.checked.iter().map(|&pixel| &seen[pixel]);
    let found = found.map(|seen| (f64::from(seen.total_kwh_m2), f64::from(seen.svf)));
    let times = [made_s, view.hit.len() as f64 / frame_s];
    Ok(row(view, series, format!("{directions} x {samples}"), look.smooth, times, found))
}

fn row(
    view: &View,
    series: &'static str,
    quality: String,
    is_smooth: bool,
    [made_s, per_s]: [f64; 2],
    found: impl Iterator<Item = (f64, f64)>,
) -> Row {
    let (totals, svf): (Vec<f64>, Vec<f64>) = found.unzip();
    let (rmse, svf) = (rmse(&totals, &view.truth), Some(svf_error(&svf, &view.truth)));
    Row { at: "pixels", series, quality, is_smooth, made_s, per_s, rmse, svf }.said()
}
