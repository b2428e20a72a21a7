//! What a method shows, what is true, and where they differ, as pictures.
//!
//! Grey by the sun on surfaces alone (its share times its cosine, over a little light from everywhere), so that nothing but
//! shadows is looked at. A difference has the truth dimmed beneath it: red where a shadow is missing, blue where one is too many.

use super::truth::{Reached, Seen, Truth};
use crate::shadows::Lit;
use glam::Vec3;
use image::{Rgb, Rgba, RgbaImage};

/// Of the brightest grey, where no sun reaches; and how much of that goes by where a surface looks, so that shaded ones are told
/// apart.
const SHADED: f32 = 0.25;
const BY_NORMAL: Vec3 = Vec3::new(0.05, 0.09, 0.07);

/// How far the truth is dimmed beneath a difference.
const DIMMED: f32 = 0.5;

const SKY: Rgb<u8> = Rgb([150, 180, 215]);
const MISSING: Rgb<f32> = Rgb([235.0, 45.0, 35.0]);
const TOO_MANY: Rgb<f32> = Rgb([40.0, 90.0, 240.0]);

/// Which sun the truth is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// Without extent.
    Hard,
    /// Its disc.
    Disc,
}

impl Against {
    fn of(self, reached: Reached) -> f32 {
        match self {
            Self::Hard => reached.hard,
            Self::Disc => reached.disc,
        }
    }
}

/// The truth under a sun.
pub fn of_truth(truth: &Truth, against: Against) -> RgbaImage {
    picture(truth, |_, seen| grey(seen, seen.sun.map_or(0.0, |reached| against.of(reached))))
}

/// What a method shows, on the truth's surfaces.
pub fn of_method(truth: &Truth, lit: &[Option<Lit>]) -> RgbaImage {
    picture(truth, |at, seen| grey(seen, shown(lit, at, seen).unwrap_or(0.0)))
}

/// Where what a method shows differs from the truth under a sun.
pub fn of_difference(truth: &Truth, lit: &[Option<Lit>], against: Against) -> RgbaImage {
    picture(truth, |at, seen| {
        let share = seen.sun.map_or(0.0, |reached| against.of(reached));
        let off = shown(lit, at, seen).map_or(0.0, |shown| shown - share);
        let Rgb(below) = grey(seen, share);
        let Rgb(colour) = if off > 0.0 { MISSING } else { TOO_MANY };
        let mix = |channel: usize| {
            let under = DIMMED * f32::from(below[channel]);
            (under + off.abs() * (colour[channel] - under)) as u8
        };
        Rgb([0, 1, 2].map(mix))
    })
}

/// What is shown at a pixel that faces the sun.
fn shown(lit: &[Option<Lit>], at: usize, seen: &Seen) -> Option<f32> {
    seen.sun?;
    lit.get(at).copied().flatten().map(|lit| lit.share.clamp(0.0, 1.0)).filter(|share| share.is_finite())
}

/// The grey of a surface that gets that share of the sun.
fn grey(seen: &Seen, share: f32) -> Rgb<u8> {
    let shaded = SHADED + BY_NORMAL.dot(seen.normal);
    let light = shaded + (1.0 - shaded) * share * seen.cosine.max(0.0);
    Rgb([(255.0 * light.clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8; 3])
}

fn picture(truth: &Truth, colour: impl Fn(usize, &Seen) -> Rgb<u8>) -> RgbaImage {
    let [wide, high] = truth.size_px;
    RgbaImage::from_fn(wide, high, |x, y| {
        let at = y as usize * wide as usize + x as usize;
        let Rgb([r, g, b]) = truth.pixels.get(at).and_then(Option::as_ref).map_or(SKY, |seen| colour(at, seen));
        Rgba([r, g, b, 255])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth() -> Truth {
        let seen =
            |hard| Some(Seen { depth_m: 1.0, normal: Vec3::Z, cosine: 1.0, sun: Some(Reached { hard, disc: 0.5 }) });
        Truth { size_px: [4, 1], pixels: vec![None, seen(0.0), seen(1.0), seen(1.0)] }
    }

    fn lit(shares: [f32; 4]) -> Vec<Option<Lit>> {
        shares.iter().map(|&share| Some(Lit { share, depth_m: 1.0 })).collect()
    }

    #[test]
    fn the_sky_is_sky_and_light_is_brighter_than_shadow() {
        let image = of_truth(&truth(), Against::Hard);
        assert_eq!(image.get_pixel(0, 0), &Rgba([150, 180, 215, 255]));
        assert_eq!(image.get_pixel(2, 0), &Rgba([255; 4]));
        let level = |against, x| of_truth(&truth(), against).get_pixel(x, 0)[0];
        assert!(level(Against::Hard, 1) < level(Against::Disc, 1) && level(Against::Disc, 2) < 255);
        assert_eq!(of_method(&truth(), &lit([0.0, 0.0, 1.0, 1.0])), image);
    }

    #[test]
    fn red_is_a_missing_shadow_and_blue_one_too_many() {
        let image = of_difference(&truth(), &lit([0.0, 1.0, 0.0, 1.0]), Against::Hard);
        assert_eq!(image.get_pixel(1, 0), &Rgba([235, 45, 35, 255]));
        assert_eq!(image.get_pixel(2, 0), &Rgba([40, 90, 240, 255]));
        let Rgba([r, g, b, _]) = *image.get_pixel(3, 0);
        assert!(r == g && g == b && r < 200, "no difference is grey");
    }
}
