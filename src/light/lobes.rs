//! Where does light come from at a place, in a few numbers that can be drawn from?
//!
//! A [`Lobe`] is a von Mises-Fisher distribution on the sphere, `c exp(kappa (direction . w))`, with a weight and with how far
//! away what shines stands, so that a neighbour of the place can turn it to where it sees the same thing (Ruppert, Herholz &
//! Lensch 2020). `guide` writes lobes, a guided tracer reads them ([`Incident`], [`Guiding`]); neither knows the other.
//!
//! Limits: a lobe is round; a tall door is two or three of them.

use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Most lobes of a place.
pub const MOST_LOBES: usize = 4;

/// A lobe is turned to points no nearer than this share of its distance to what shines, and narrowed up to that share.
const NEAREST_SHARE: f32 = 0.25;
const FARTHEST_SHARE: f32 = 2.0;

/// Below this concentration a lobe is taken for even over the sphere, which it is to a thousandth.
const EVEN_BELOW: f64 = 1e-3;

/// Light from about one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Where it comes from: unit length, pointing away from the place.
    pub direction: Vec3,
    /// Concentration kappa: 0 even over the sphere; half of it comes from within about `1.2 / sqrt(kappa)` radians.
    pub concentration: f32,
    /// Its share of the light that all lobes of the place describe; these add up to 1.
    pub weight: f32,
    /// How far away what shines stands, metres.
    pub distance_m: f32,
}

impl Lobe {
    /// Whether it is taken for even over the sphere.
    pub fn is_even(&self) -> bool {
        f64::from(self.concentration) < EVEN_BELOW
    }

    /// Its density about `towards`, per steradian; over the sphere it integrates to 1.
    pub fn density_per_sr(&self, towards: Vec3) -> f64 {
        let kappa = f64::from(self.concentration);
        if self.is_even() {
            return 1.0 / (4.0 * PI);
        }
        // kappa / (2 pi (e^kappa - e^-kappa)) e^(kappa cosine), by a form that does not overflow; the cosine by the chord, which
        // single precision knows better where the two are close.
        let chord = (self.direction - towards).as_dvec3();
        kappa / (2.0 * PI * -(-2.0 * kappa).exp_m1()) * (-0.5 * kappa * chord.length_squared()).exp()
    }

    /// A direction drawn from it by two numbers in [0, 1) (Jakob 2012).
    pub fn drawn(&self, [height, turn]: [f64; 2]) -> Vec3 {
        let kappa = f64::from(self.concentration);
        let cosine = if self.is_even() {
            1.0 - 2.0 * height
        } else {
            1.0 + (1.0 - height + height * (-2.0 * kappa).exp()).ln() / kappa
        };
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let axis = self.direction.as_dvec3();
        let (right, up) = axis.any_orthonormal_pair();
        let (turn_sine, turn_cosine) = (2.0 * PI * turn).sin_cos();
        let drawn: DVec3 = cosine * axis + sine * (turn_cosine * right + turn_sine * up);
        drawn.as_vec3().normalize()
    }
}

impl Lobe {
    /// The lobe as a point sees it that lies `moved_m` from the place, metres: turned to what shines, and wider the nearer that
    /// is. What is nearer than a quarter of the distance is seen as from there, for a lobe is no map of its surface.
    pub fn seen_after(&self, moved_m: Vec3) -> Self {
        let to_m = self.distance_m * self.direction - moved_m;
        let distance_m = to_m.length();
        let nearer = (distance_m / self.distance_m.max(f32::MIN_POSITIVE)).clamp(NEAREST_SHARE, FARTHEST_SHARE);
        Self {
            direction: to_m.normalize_or(self.direction),
            concentration: self.concentration * nearer * nearer,
            distance_m: nearer * self.distance_m,
            ..*self
        }
    }
}

/// The light that comes to a place, but for what comes straight from emitters in `lobes`, which a renderer asks for itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Incident {
    /// Where, metres.
    pub position_m: Vec3,
    /// The normal of the surface that the place lies on; without one it stands in the open and sees all around.
    pub normal: Option<Vec3>,
    /// Reflected light, at most [`MOST_LOBES`], the heaviest first; by irradiance (radiance times cosine) where there is a
    /// normal, by radiance where there is none. Empty where no reflected light comes.
    pub lobes: Vec<Lobe>,
    /// Share of directions that are best drawn from the lobes rather than from the cosine (in the open: evenly); 0 without lobes.
    pub trust: f32,
    /// What is reflected at least once before it arrives: irradiance on the surface, or scalar irradiance, W/m2.
    pub reflected_w_m2: f32,
    /// What arrives straight from each emitter of [`Sources`](super::Sources), W/m2, as above.
    pub direct_w_m2: Vec<f32>,
}

impl Incident {
    /// What comes to a point near the place: the same light, its lobes turned.
    pub fn seen_from(&self, point_m: Vec3) -> Self {
        let moved_m = point_m - self.position_m;
        let lobes = self.lobes.iter().map(|lobe| lobe.seen_after(moved_m)).collect();
        Self { position_m: point_m, lobes, direct_w_m2: self.direct_w_m2.clone(), ..*self }
    }
}

/// What a guided tracer reads: places and what comes to them, and which of them speaks for a point.
pub struct Guiding<'a> {
    /// The places.
    pub places: Vec<&'a Incident>,
    /// Places that are the sensors' own, by the sensors' numbers; a sensor beyond them asks `place_of`.
    pub at_sensors: Vec<u32>,
    /// The number of the place for a point (metres) on a surface of that normal, or in the open; `None` where none is known.
    pub place_of: &'a (dyn Fn(Vec3, Option<Vec3>) -> Option<u32> + Sync),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lobe(concentration: f32) -> Lobe {
        Lobe { direction: Vec3::new(0.48, -0.6, 0.64), concentration, weight: 1.0, distance_m: 1.0 }
    }

    #[test]
    fn densities_integrate_to_one_and_draws_follow_them() {
        for kappa in [0.0, 1e-2, 1.0, 30.0, 4000.0] {
            let lobe = lobe(kappa);
            // Over heights about the axis: the mean of one over the density of what is drawn is the sphere's area.
            let count = 4000;
            let drawn = (0..count).map(|index| {
                let square = [(f64::from(index) + 0.5) / f64::from(count), (f64::from(index) * 0.618_034).fract()];
                lobe.drawn(square)
            });
            let (mut cosine, mut within) = (0.0, 0.0);
            let half = Lobe { concentration: 0.5 * kappa, ..lobe };
            for direction in drawn {
                cosine += f64::from(direction.dot(lobe.direction)) / f64::from(count);
                within += half.density_per_sr(direction) / lobe.density_per_sr(direction) / f64::from(count);
            }
            let kappa = f64::from(kappa);
            let mean = if kappa < 0.1 { kappa / 3.0 } else { 1.0 / kappa.tanh() - 1.0 / kappa };
            assert!((cosine - mean).abs() < 2e-3, "{kappa}: mean cosine {cosine} for {mean}");
            assert!((within - 1.0).abs() < 0.05, "{kappa}: the other density integrates to {within}");
        }
    }
}
