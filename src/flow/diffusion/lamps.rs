//! How much of the light that rays carried does a point get from the places it set out from?
//!
//! Each place where carried light leaves a wall is a small lamp (instant radiosity, Keller 1997). Of the thousands of them a
//! point looks at some hundred, drawn in proportion to what they would give it in plain view and to how likely a view is: rays
//! into a room come from the room itself, less often from the next one, seldom from further. Each drawn lamp stands for those
//! passed over, so the sum is right in the mean; the draws are evenly spaced along the lamps, which lie in the order of an
//! even sequence.

use crate::flow::direct::Direct;
use crate::model::{Model, Probe};
use glam::Vec3;
use std::f64::consts::PI;

/// Lamps a point looks at: 256 draws leave about 6%.
const DRAWS: u32 = 256;

/// How likely a lamp in a room next door, and in any other, is in view, beside one in the same room. Right figures make less
/// noise, wrong ones no error.
const NEXT_DOOR: f64 = 0.2;
const ELSEWHERE: f64 = 0.03;

/// A place of a wall that sends light out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// Where it is, metres, lifted off the wall.
    pub position_m: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// What it sends out, by the cosine, W.
    pub flux_w: f64,
    /// The square of the radius of the disc it stands for, m2: nearer than that it is no point.
    pub radius_squared_m2: f64,
    /// The cell it lies in.
    pub cell: u32,
}

impl Lamp {
    /// What it would give to a point in plain view of it, on a surface that squarely faces it, W/m2.
    pub fn irradiance_w_m2(&self, point_m: Vec3) -> f64 {
        let towards = (point_m - self.position_m).as_dvec3();
        let squared = towards.length_squared();
        let cosine = self.normal.as_dvec3().dot(towards) / squared.sqrt().max(f64::MIN_POSITIVE);
        self.flux_w * cosine.max(0.0) / (PI * squared.max(self.radius_squared_m2)).max(f64::MIN_POSITIVE)
    }
}

/// What the lamps give to a probe in `cell`, whose necks lead to the cells `next`: as light straight from them, with
/// its standard error if the draws were by chance, W/m2. `turn` in [0, 1)
/// places the draws. Costs some nanoseconds a lamp and at most `DRAWS` rays.
pub fn gathered(
    model: &Model,
    probe: &Probe,
    at_m: Vec3,
    lamps: &[Lamp],
    cell: u32,
    next: &[u32],
    turn: f64,
) -> (Direct, f64) {
    let (mut sum, mut squares) = (Direct::default(), 0.0);
    let towards = |lamp: &Lamp| (lamp.position_m - at_m).normalize_or_zero();
    let cosine = |lamp: &Lamp| probe.normal.map_or(1.0, |normal| f64::from(normal.dot(towards(lamp)).max(0.0)));
    let chance = |lamp: &Lamp| match lamp.cell {
        same if same == cell => 1.0,
        other if next.contains(&other) => NEXT_DOOR,
        _ => ELSEWHERE,
    };

    let mut up_to = 0.0;
    let weights = lamps.iter().map(|lamp| {
        up_to += lamp.irradiance_w_m2(at_m) * cosine(lamp) * chance(lamp);
        up_to
    });
    let weights: Vec<f64> = weights.collect();
    let step = up_to / f64::from(DRAWS);
    if step.is_nan() || step <= 0.0 {
        return (sum, 0.0);
    }
    let mut drawn = 0.0;
    for (lamp, up_to) in lamps.iter().zip(weights) {
        // How many of the draws, at turn, turn + 1 and so on, fall to this lamp.
        let draws = (up_to / step - turn).ceil().max(0.0) - drawn;
        if draws < 1.0 {
            continue;
        }
        drawn += draws;
        let given_w_m2 = draws * step / chance(lamp) * f64::from(model.rays.transmitted(lamp.position_m, at_m));
        squares += draws * (given_w_m2 / draws).powi(2);
        sum.value_w_m2 += given_w_m2;
        sum.flux_w_m2 += given_w_m2 / cosine(lamp) * towards(lamp).as_dvec3();
    }
    (sum, squares.sqrt())
}
