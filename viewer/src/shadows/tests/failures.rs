//! The failure cases as a picture, which `docs/shadows.md` shows: a row a case, at its worst on the left, mended on the right, what
//! rays say in between.

use super::super::{Filter, Lit, Method, Settings, Studio};
use super::scenes::Town;
use crate::paint::test_adapter::offscreen;
use glam::Vec3;
use image::{GrayImage, Luma, imageops};
use std::path::Path;

/// Where the picture is.
const PICTURE: &str = "../docs/viewer/shadow_failures.png";
/// Grey of what is not seen or faces away.
const NOTHING: u8 = 60;
/// Between pictures, pixels.
const GAP: u32 = 4;

/// A scene, what fails in it, and what does not.
fn cases() -> Vec<(Town, Settings, Settings)> {
    let plain = Method::Plain.settings(512, 1);
    let mut low = Town::block_on_ground();
    low.view.towards_sun = Vec3::new(-2.0_f32.to_radians().cos(), 0.0, 2.0_f32.to_radians().sin());
    let acne = Settings { lift_texels: 0.0, follows_planes: false, ..plain };
    let panning = Settings { lift_texels: 40.0, ..plain };
    vec![
        (Town::three_occluders(), Method::Vsm.settings(128, 1), Method::Lvsm.settings(128, 12)),
        (Town::block_on_ground(), acne, plain),
        (Town::block_on_ground(), panning, plain),
        (Town::long_wall(), plain, Method::Hsm.settings(512, 4)),
        (Town::arcade(), Method::Vsm.settings(512, 1), Method::Hsm.settings(512, 4)),
        (low, Settings { filter: Filter::Variance, ..plain }, Method::Hsm.settings(512, 4)),
    ]
}

#[test]
fn failures_look_as_the_documents_show_them() {
    let Some(offscreen) = offscreen() else { return };
    let cases = cases();
    let [width, height] = cases[0].0.view.size_px;
    let mut sheet =
        GrayImage::from_pixel(3 * (width + GAP) - GAP, cases.len() as u32 * (height + GAP) - GAP, Luma([255]));
    for (row, (town, worst, mended)) in cases.iter().enumerate() {
        let mut studio = Studio::new(&offscreen, &town.corners_m());
        let mut shown = |settings| {
            studio.frame(&town.view, settings).unwrap();
            studio.lit().unwrap().into_iter().map(|lit: Option<Lit>| lit.map(|lit| lit.share)).collect::<Vec<_>>()
        };
        let truth = town.truth();
        let by_rays = truth.iter().map(|lit| lit.map(|lit| f32::from(u8::from(lit)))).collect();
        for (column, shares) in [shown(worst), by_rays, shown(mended)].into_iter().enumerate() {
            let shares: &Vec<Option<f32>> = &shares;
            let picture = GrayImage::from_fn(width, height, |x, y| {
                let at = (y * width + x) as usize;
                let share = shares[at].filter(|_| truth[at].is_some());
                Luma([share.map_or(NOTHING, |share| 90 + (share * 165.0) as u8)])
            });
            imageops::replace(
                &mut sheet,
                &picture,
                i64::from(column as u32 * (width + GAP)),
                i64::from(row as u32 * (height + GAP)),
            );
        }
    }

    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(PICTURE);
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        sheet.save(&path).unwrap();
    }
    let known = image::open(&path).unwrap().to_luma8();
    assert_eq!(known.dimensions(), sheet.dimensions());
    let off =
        known.pixels().zip(sheet.pixels()).map(|(known, now)| u64::from(known.0[0].abs_diff(now.0[0]))).sum::<u64>();
    let mean = off as f64 / f64::from(sheet.width() * sheet.height());
    assert!(mean < 1.0, "{mean} levels off {PICTURE}; UPDATE_SNAPSHOTS=1 renews it");
}
