//! From which directions shall a path go on, and which lamp shall it ask?

use crate::light::{Incident, Lobe, MOST_LOBES};
use crate::trace::random::Random;
use glam::Vec3;

/// No lobe is narrower. A direction in single precision is off by a hundred-thousandth of this one's width, so that its density is
/// known to some ten-thousandths.
const MOST_CONCENTRATION: f32 = 1e4;

/// However much a place trusts its lobes, some paths go by the cosine, for lobes leave out what they do not know.
const MOST_TRUST: f64 = 0.95;

/// A place's lobes, ready to be drawn from.
#[derive(Debug, Clone)]
pub(super) struct Mixture {
    position_m: Vec3,
    /// Whether it stands in the open, and so knows light from all around.
    is_open: bool,
    lobes: Vec<Lobe>,
    trust: f64,
    /// Light reflected at least once before it arrives, W/m2.
    pub(super) reflected_w_m2: f64,
    /// Straight from all emitters, W/m2.
    pub(super) direct_w_m2: f64,
    /// The share of each emitter and all before it in what comes straight.
    shares_up_to: Vec<f64>,
}

/// Lobes as a point sees them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Share of directions to draw from here.
    pub(super) trust: f64,
    is_open: bool,
    lobes: [Lobe; MOST_LOBES],
    /// The share of each lobe times its density where that is greatest, per steradian.
    factors: [f64; MOST_LOBES],
    count: usize,
}

impl Mixture {
    /// A place ready to be drawn from. What is no number, below 0 or without a direction is left out, shares are made to add up
    /// to 1: a broken guide may be slow but not wrong.
    pub(super) fn of(incident: &Incident) -> Self {
        let amount = |number: f32| if number.is_finite() { f64::from(number.max(0.0)) } else { 0.0 };
        let sound = |lobe: &&Lobe| {
            let numbers = [lobe.concentration, lobe.weight, lobe.distance_m];
            lobe.direction.is_normalized() && numbers.iter().all(|number| number.is_finite() && *number >= 0.0)
        };
        let mut lobes: Vec<Lobe> = incident.lobes.iter().filter(sound).take(MOST_LOBES).copied().collect();
        let weight: f32 = lobes.iter().map(|lobe| lobe.weight).sum();
        if weight.is_finite() && weight > 0.0 && incident.position_m.is_finite() {
            lobes.iter_mut().for_each(|lobe| lobe.weight /= weight);
        } else {
            lobes.clear();
        }
        let direct_w_m2: f64 = incident.direct_w_m2.iter().map(|&part| amount(part)).sum();
        let mut up_to = 0.0;
        let shares = incident.direct_w_m2.iter().map(|&part| {
            up_to += amount(part) / direct_w_m2.max(f64::MIN_POSITIVE);
            up_to
        });
        Self {
            position_m: incident.position_m,
            is_open: incident.normal.is_none(),
            trust: amount(incident.trust).min(MOST_TRUST),
            lobes,
            reflected_w_m2: amount(incident.reflected_w_m2),
            direct_w_m2,
            shares_up_to: shares.collect(),
        }
    }

    /// The lobes as they are seen from a point near the place.
    pub(super) fn seen_from(&self, point_m: Vec3) -> Seen {
        let none = Lobe { direction: Vec3::Z, concentration: 0.0, weight: 0.0, distance_m: 1.0 };
        let mut seen = Seen {
            trust: self.trust,
            is_open: self.is_open,
            lobes: [none; MOST_LOBES],
            factors: [0.0; MOST_LOBES],
            count: self.lobes.len(),
        };
        let moved_m = point_m - self.position_m;
        for (number, lobe) in self.lobes.iter().enumerate() {
            let lobe = lobe.seen_after(moved_m);
            let concentration = if lobe.is_even() { 0.0 } else { lobe.concentration.min(MOST_CONCENTRATION) };
            let lobe = Lobe { concentration, ..lobe };
            seen.factors[number] = f64::from(lobe.weight) * lobe.density_per_sr(lobe.direction);
            seen.lobes[number] = lobe;
        }
        seen
    }

    /// The reflected light that a surface there gets, or a point in the open, W/m2.
    pub(super) fn expected_w_m2(&self, normal: Option<Vec3>) -> f64 {
        // A surface in the open gets a quarter of the scalar irradiance, if light comes evenly.
        if self.is_open && normal.is_some() { 0.25 * self.reflected_w_m2 } else { self.reflected_w_m2 }
    }

    /// The emitter that this number in [0, 1) picks by what each brings.
    pub(super) fn emitter(&self, random: f64) -> usize {
        self.shares_up_to.partition_point(|&up_to| up_to <= random).min(self.shares_up_to.len().saturating_sub(1))
    }

    /// The chance of that emitter.
    pub(super) fn chance(&self, emitter: usize) -> f64 {
        let up_to = |number: usize| self.shares_up_to.get(number).copied().unwrap_or(0.0);
        up_to(emitter) - emitter.checked_sub(1).map_or(0.0, up_to)
    }
}

impl Seen {
    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// A direction drawn from the lobes; with a normal, what points below the surface is turned up by reflection in it.
    pub(super) fn drawn(&self, normal: Option<Vec3>, random: &mut Random) -> Vec3 {
        let mut left = random.number() as f32;
        let mut number = 0;
        while number + 1 < self.count && left >= self.lobes[number].weight {
            left -= self.lobes[number].weight;
            number += 1;
        }
        let direction = self.lobes[number].drawn(random.pair());
        match normal {
            Some(normal) if !self.is_open && normal.dot(direction) < 0.0 => {
                direction - 2.0 * normal.dot(direction) * normal
            }
            _ => direction,
        }
    }

    /// Its density, per steradian.
    pub(super) fn density_per_sr(&self, direction: Vec3, normal: Option<Vec3>) -> f64 {
        let above = self.all_around_per_sr(direction);
        match normal {
            Some(normal) if !self.is_open => {
                above + self.all_around_per_sr(direction - 2.0 * normal.dot(direction) * normal)
            }
            _ => above,
        }
    }

    fn all_around_per_sr(&self, direction: Vec3) -> f64 {
        let lobes = self.lobes.iter().zip(&self.factors).take(self.count);
        let density = |(lobe, factor): (&Lobe, &f64)| {
            let exponent = -0.5 * lobe.concentration * (lobe.direction - direction).length_squared();
            if exponent < -30.0 { 0.0 } else { factor * f64::from(exponent.exp()) }
        };
        lobes.map(density).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// About 60 degrees off the wall's normal, so that a wide lobe reaches below it.
    const AXIS: Vec3 = Vec3::new(0.64, -0.6, 0.48);

    fn lone(concentration: f32, normal: Option<Vec3>) -> Seen {
        let lobe = Lobe { direction: AXIS, concentration, weight: 3.0, distance_m: 1.0 };
        let incident = Incident { lobes: vec![lobe], normal, trust: 0.5, ..Incident::default() };
        Mixture::of(&incident).seen_from(Vec3::ZERO)
    }

    /// The closed form about the axis, mirrored in the wall where there is one.
    fn expected_per_sr(kappa: f64, normal: Option<Vec3>, towards: Vec3) -> f64 {
        let peak_per_sr = if kappa > 0.0 { kappa / (2.0 * PI * (1.0 - (-2.0 * kappa).exp())) } else { 0.25 / PI };
        let about = |towards: Vec3| {
            let squared = (AXIS - towards).as_dvec3().length_squared();
            peak_per_sr * (-0.5 * kappa * squared).exp()
        };
        about(towards) + normal.map_or(0.0, |normal| about(towards - 2.0 * normal.dot(towards) * normal))
    }

    #[test]
    fn densities_integrate_to_one() {
        // Rings about the axis, the denser the nearer to it.
        let (rings, turns) = (2000, 16);
        let (right, up) = AXIS.as_dvec3().any_orthonormal_pair();
        for concentration in [0.0, 5e-4, 1e-3, 1.0, 1e4] {
            let seen = lone(concentration, None);
            let mut integral = 0.0;
            for ring in 0..rings {
                let share = (f64::from(ring) + 0.5) / f64::from(rings);
                let (depth, width) = (2.0 * share.powi(6), 12.0 * share.powi(5) / f64::from(rings));
                let sine = (depth * (2.0 - depth)).sqrt();
                for turn in 0..turns {
                    let (turn_sine, turn_cosine) = (2.0 * PI * f64::from(turn) / f64::from(turns)).sin_cos();
                    let towards = (1.0 - depth) * AXIS.as_dvec3() + sine * (turn_cosine * right + turn_sine * up);
                    integral +=
                        2.0 * PI * width / f64::from(turns) * seen.density_per_sr(towards.as_vec3().normalize(), None);
                }
            }
            assert!((integral - 1.0).abs() < 2e-4, "{concentration}: {integral}");
        }
    }

    #[test]
    fn draws_follow_the_density() {
        let count = 40_000;
        for normal in [None, Some(Vec3::Z)] {
            for concentration in [0.0, 1e-3, 1.0, 1e4] {
                let (seen, kappa) = (lone(concentration, normal), f64::from(concentration));
                let mut random = Random::new(7, 0, 0);
                let mut sum = 0.0;
                for _ in 0..count {
                    let towards = seen.drawn(normal, &mut random);
                    assert!(normal.is_none_or(|normal| normal.dot(towards) >= 0.0), "{towards} is below");
                    let density_per_sr = seen.density_per_sr(towards, normal);
                    let off = density_per_sr / expected_per_sr(kappa, normal, towards) - 1.0;
                    assert!(off.abs() < 1e-4, "{concentration}: off by {off} at {towards}");
                    sum += expected_per_sr(2.0 * kappa + 1.0, normal, towards) / density_per_sr;
                }
                // Each draw brings at most some two or three, so that five standard errors are 0.02.
                let integral = sum / f64::from(count);
                assert!((integral - 1.0).abs() < 0.02, "{concentration}: a narrower lobe integrates to {integral}");
            }
        }
    }

    #[test]
    fn what_is_drawn_evenly_is_weighed_evenly() {
        for direction in [AXIS, -AXIS] {
            let density_per_sr = lone(5e-4, None).density_per_sr(direction, None);
            assert!((density_per_sr * 4.0 * PI - 1.0).abs() < 1e-7, "{density_per_sr}");
        }
    }
}
