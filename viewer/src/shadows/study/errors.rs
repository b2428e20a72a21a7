//! How far off are the maps? Their shares of the sun against the truth by rays, pixel by pixel.
//!
//! A pixel counts where both see something, it faces the sun, and both see it at the same depth within 1%: along silhouettes a
//! ray through the pixel's middle and the card's rasteriser may see different things, which is no fault of a shadow.
//! Light bleeding and acne are read well inside shadow and light, three pixels from any edge, where the sun's extent explains no
//! error. Texels that are wider than that still do: what a plain map shows there is theirs, and what others show above it
//! is bleeding.

use super::truth::{Reached, Truth};
use crate::shadows::Lit;

/// Depths that differ by less, as a share, are of one surface.
const SAME_DEPTH: f32 = 0.01;

/// A share of the sun that is further off than this says the opposite of the truth.
const WRONG: f64 = 0.5;

/// How far off a method is over a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Pixels that count.
    pub counted: usize,
    /// Pixels that face the sun and do not count, because the picture shows something else there.
    pub left_out: usize,
    /// Share of the counted pixels whose share of the sun is more than 0.5 off a sun without extent.
    pub wrong: f64,
    /// Mean absolute error against a sun without extent.
    pub hard: f64,
    /// Mean absolute error against the sun's disc.
    pub disc: f64,
    /// Light bleeding: the mean share of the sun well inside shadows; `None` where the view has no such pixel.
    pub bleeding: Option<f64>,
    /// Acne: the mean share that is missing as deep in the light.
    pub acne: Option<f64>,
}

/// Tells errors by one truth.
#[derive(Clone, Debug)]
pub struct Judge<'a> {
    truth: &'a Truth,
    /// Pixels well inside shadows, and as deep in the light.
    inside: [Vec<bool>; 2],
}

impl<'a> Judge<'a> {
    /// By this truth.
    pub fn new(truth: &'a Truth) -> Self {
        Self { truth, inside: truth.inside() }
    }

    /// The errors of what a method shows, in the order of the truth's pixels; `None` where no pixel counts.
    pub fn errors(&self, lit: &[Option<Lit>]) -> Option<Errors> {
        errors(self.truth, &self.inside, lit)
    }
}

fn errors(truth: &Truth, [in_shadow, in_light]: &[Vec<bool>; 2], lit: &[Option<Lit>]) -> Option<Errors> {
    let mut sums = Sums::default();
    let asked = truth.pixels.iter().enumerate().filter_map(|(at, seen)| {
        let seen = (*seen)?;
        Some((at, seen.depth_m, seen.sun?))
    });
    for (at, depth_m, sun) in asked {
        let shown = lit.get(at).copied().flatten();
        let Some(shown) = shown.filter(|shown| (shown.depth_m - depth_m).abs() <= SAME_DEPTH * depth_m) else {
            sums.left_out += 1;
            continue;
        };
        sums.add(sun, share(shown, sun));
        let is = |mask: &[bool]| mask.get(at).copied().unwrap_or(false);
        if is(in_shadow) {
            sums.bleeding.add(share(shown, sun));
        }
        if is(in_light) {
            sums.acne.add(1.0 - share(shown, sun));
        }
    }
    sums.means()
}

/// What is shown, 0 to 1; what is no number is as wrong as can be.
fn share(shown: Lit, sun: Reached) -> f64 {
    if shown.share.is_finite() { f64::from(shown.share.clamp(0.0, 1.0)) } else { f64::from(1.0 - sun.hard) }
}

#[derive(Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn value(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

#[derive(Default)]
struct Sums {
    left_out: usize,
    wrong: Mean,
    hard: Mean,
    disc: Mean,
    bleeding: Mean,
    acne: Mean,
}

impl Sums {
    fn add(&mut self, sun: Reached, share: f64) {
        let off = (share - f64::from(sun.hard)).abs();
        self.wrong.add(if off > WRONG { 1.0 } else { 0.0 });
        self.hard.add(off);
        self.disc.add((share - f64::from(sun.disc)).abs());
    }

    fn means(&self) -> Option<Errors> {
        Some(Errors {
            counted: self.wrong.count,
            left_out: self.left_out,
            wrong: self.wrong.value()?,
            hard: self.hard.value()?,
            disc: self.disc.value()?,
            bleeding: self.bleeding.value(),
            acne: self.acne.value(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::truth::Seen;
    use super::*;
    use glam::Vec3;

    const SIZE_PX: [u32; 2] = [20, 10];

    /// The left half in shadow, the right half in the sun, all 10 m away.
    fn halves() -> Truth {
        let pixel = |at: usize| {
            let share = if at % 20 < 10 { 0.0 } else { 1.0 };
            Some(Seen { depth_m: 10.0, normal: Vec3::Z, cosine: 1.0, sun: Some(Reached { hard: share, disc: share }) })
        };
        Truth { size_px: SIZE_PX, pixels: (0..200).map(pixel).collect() }
    }

    fn shown(share: impl Fn(usize) -> f32) -> Vec<Option<Lit>> {
        (0..200).map(|at| Some(Lit { share: share(at % 20), depth_m: 10.05 })).collect()
    }

    #[test]
    fn the_truth_has_no_error() {
        let found = Judge::new(&halves()).errors(&shown(|x| if x < 10 { 0.0 } else { 1.0 })).unwrap();
        let want = Errors {
            counted: 200,
            left_out: 0,
            wrong: 0.0,
            hard: 0.0,
            disc: 0.0,
            bleeding: Some(0.0),
            acne: Some(0.0),
        };
        assert_eq!(found, want);
    }

    #[test]
    fn a_shifted_edge_is_neither_bleeding_nor_acne() {
        // Two of twenty columns are lit that should not be.
        let found = Judge::new(&halves()).errors(&shown(|x| if x < 8 { 0.0 } else { 1.0 })).unwrap();
        assert!((found.wrong - 0.1).abs() < 1e-12 && (found.hard - 0.1).abs() < 1e-12, "{found:?}");
        assert_eq!((found.bleeding, found.acne), (Some(0.0), Some(0.0)));
    }

    #[test]
    fn bleeding_and_acne_are_apart() {
        // Well inside are columns 3 to 6 and 13 to 16; a third of the light there, and a quarter missing here.
        let found = Judge::new(&halves()).errors(&shown(|x| if x < 10 { 1.0 / 3.0 } else { 0.75 })).unwrap();
        assert!((found.bleeding.unwrap() - 1.0 / 3.0).abs() < 1e-7 && (found.acne.unwrap() - 0.25).abs() < 1e-7);
        assert!((found.hard - (1.0 / 3.0 + 0.25) / 2.0).abs() < 1e-7 && found.wrong == 0.0);
    }

    #[test]
    fn the_disc_is_measured_for_itself() {
        let mut truth = halves();
        for seen in truth.pixels.iter_mut().flatten() {
            seen.sun = seen.sun.map(|sun| Reached { disc: 0.5, ..sun });
        }
        let found = Judge::new(&truth).errors(&shown(|_| 0.5)).unwrap();
        assert_eq!((found.disc, found.hard, found.wrong), (0.0, 0.5, 0.0));
        assert_eq!((found.bleeding, found.acne), (None, None), "half a shadow is not inside one");
    }

    #[test]
    fn what_the_picture_does_not_show_is_left_out() {
        let mut lit = shown(|x| if x < 10 { 0.0 } else { 1.0 });
        lit[0] = None;
        lit[1] = Some(Lit { share: 1.0, depth_m: 12.0 });
        let mut truth = halves();
        truth.pixels[2] = None;
        truth.pixels[3] = Some(Seen { depth_m: 10.0, normal: Vec3::Z, cosine: -1.0, sun: None });
        let found = Judge::new(&truth).errors(&lit).unwrap();
        assert_eq!((found.counted, found.left_out, found.wrong), (196, 2, 0.0));
        assert_eq!(Judge::new(&truth).errors(&[]), None);
    }

    #[test]
    fn what_is_no_number_is_wrong() {
        let found = Judge::new(&halves()).errors(&shown(|_| f32::NAN)).unwrap();
        assert_eq!((found.wrong, found.hard, found.bleeding), (1.0, 1.0, Some(1.0)));
    }
}
