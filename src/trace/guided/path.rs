//! What does one guided path bring to a sensor?
//!
//! The path of the plain tracer, with three draws changed. The next direction comes from the lobes of the place or from the
//! cosine, as far as the place trusts its lobes. A lamp is asked for by what it brings to the place, and not at all most of the
//! time where all lamps bring little of what the sensor gets. And a path goes on with a chance in proportion to what it may
//! still bring, as a share of what the sensor is to get. Where the guide knows no place the draws are the plain tracer's.

use super::mixture::{Mixture, Seen};
use crate::light::Guiding;
use crate::scene::Sensor;
use crate::trace::path::{
    self, Sample, TURNS_BEFORE_ROULETTE, cosine_about, cosine_to, hemisphere_per_sr, towards_hemisphere,
    uniform_on_sphere,
};
use crate::trace::random::Random;
use glam::Vec3;
use std::f64::consts::PI;

/// Share of lamps that are drawn from the guide.
const GUIDED_LAMPS: f64 = 0.75;

/// A lamp is asked for at least with this chance.
const LEAST_ASKED: f64 = 0.1;

/// What lamps bring to a vertex is noise enough when it is this share of what the sensor gets.
const ASKED_SHARE: f64 = 0.25;

/// A path goes on for sure while it may bring this share of what the sensor is to get. Of 1, 1/2 and 1/4 the middle one gave the
/// smallest error in a given time, over five scenes; at 1 lit rooms are worse than by the plain tracer.
const SURE_SHARE: f64 = 0.5;

/// A path goes on at least with this chance, and at most with that, so that it ends.
const LEAST_SURVIVAL: f64 = 0.1;
const MOST_SURVIVAL: f64 = 0.99;

/// From here on a path survives no turn with more than the share of light that goes on there: a guide that expects far too much
/// of a place must not keep paths alive for ever.
const MOST_TURNS: u32 = 24;

/// All that a path needs to know.
pub(super) struct Paths<'a> {
    pub(super) plain: &'a path::Paths<'a>,
    pub(super) mixtures: &'a [Mixture],
    pub(super) guiding: &'a Guiding<'a>,
}

impl Paths<'_> {
    /// One sample of the (scalar) irradiance and the net flux at a sensor.
    pub(super) fn sample(&self, number: usize, random: &mut Random) -> Sample {
        let Some(Sensor { normal, position_m, .. }) = self.plain.scene.sensors.get(number) else {
            return Sample::default();
        };
        let normal = *normal;
        let position_m = *position_m + normal.unwrap_or(Vec3::ZERO) * self.plain.rays.epsilon_m();
        let own = self.guiding.at_sensors.get(number).and_then(|&place| self.mixtures.get(place as usize));
        let mixture = own.or_else(|| self.mixture(position_m, normal));
        let mut sample = Sample { rays: 1, ..Sample::default() };
        if let Some((direction, irradiance_w_m2)) = self.direct(position_m, normal, mixture, random) {
            sample.add(normal, direction, irradiance_w_m2);
        }
        let seen = mixture.map(|mixture| mixture.seen_from(position_m)).filter(|seen| !seen.is_empty());
        let (direction, density_per_sr) = match normal {
            None => drawn(seen, None, random, uniform_on_sphere, |_| 1.0 / (4.0 * PI)),
            Some(normal) => drawn(
                seen,
                Some(normal),
                random,
                |random| towards_hemisphere(normal, random).0,
                |direction| hemisphere_per_sr(normal, direction),
            ),
        };
        // A place in the open knows light from below the sensor's surface as well.
        let cosine = cosine_to(normal, direction);
        if cosine <= 0.0 || density_per_sr <= 0.0 {
            return sample;
        }
        let expected_w_m2 = mixture.map_or(0.0, |mixture| mixture.expected_w_m2(normal));
        let goal = expected_w_m2 * density_per_sr / cosine.max(1e-3);
        let (radiance_w_m2_sr, rays) = self.reflected(position_m, direction, goal, random);
        sample.add(normal, direction, radiance_w_m2_sr / density_per_sr);
        sample.rays += rays;
        sample
    }

    fn mixture(&self, point_m: Vec3, normal: Option<Vec3>) -> Option<&Mixture> {
        (self.guiding.place_of)(point_m, normal).and_then(|place| self.mixtures.get(place as usize))
    }

    /// One sample of the light straight from the emitters: its direction, and the irradiance on a surface that squarely faces
    /// it.
    fn direct(
        &self,
        position_m: Vec3,
        normal: Option<Vec3>,
        mixture: Option<&Mixture>,
        random: &mut Random,
    ) -> Option<(Vec3, f64)> {
        let Some(mixture) = mixture.filter(|mixture| mixture.direct_w_m2 > 0.0) else {
            return self.plain.direct(position_m, normal, random);
        };
        let sampler = self.plain.sampler;
        let emitter = if random.number() < GUIDED_LAMPS {
            mixture.emitter(random.number())
        } else {
            sampler.choose(position_m, normal, random.number())?.0
        };
        let plainly = sampler.chance(emitter, position_m, normal);
        let probability = GUIDED_LAMPS * mixture.chance(emitter) + (1.0 - GUIDED_LAMPS) * plainly;
        let (direction, irradiance_w_m2) = self.plain.straight(emitter, position_m, normal, random)?;
        Some((direction, irradiance_w_m2 / probability))
    }

    /// One sample of the reflected radiance that comes to `position_m` from `direction`, W/m2/sr, where about `goal` is
    /// expected; and the rays it took.
    fn reflected(&self, mut position_m: Vec3, mut direction: Vec3, goal: f64, random: &mut Random) -> (f64, u32) {
        let (mut radiance_w_m2_sr, mut weight) = (0.0, 1.0);
        let (mut bounces, mut turns, mut rays) = (0, 0, 0);
        while bounces < self.plain.max_bounces {
            rays += 1;
            let Some(hit) = self.plain.rays.closest(position_m, direction, f32::INFINITY) else { break };
            let Some((reflectance, transmittance)) = self.plain.shares(hit.surface) else { break };
            let facing = hit.facing();
            let at_m = position_m + hit.distance_m * direction;
            let lift_m = facing * self.plain.rays.epsilon_m();
            let mixture = self.mixture(at_m, Some(facing));
            // What an irradiance here is worth to the sensor, as a share of what that is to get.
            let worth = if goal > 0.0 { weight * reflectance / PI / goal } else { 0.0 };
            let guided = mixture.filter(|_| worth > 0.0);

            // Direct light that the surface reflects towards where the path came from.
            let by_lamps = |mixture: &Mixture| (worth * mixture.direct_w_m2 / ASKED_SHARE).clamp(LEAST_ASKED, 1.0);
            let asked = guided.map_or(1.0, by_lamps);
            if reflectance > 0.0 && (asked >= 1.0 || random.number() < asked) {
                rays += 1;
                let direct = self.direct(at_m + lift_m, Some(facing), mixture, random);
                if let Some((towards, irradiance_w_m2)) = direct {
                    let cosine = f64::from(facing.dot(towards));
                    radiance_w_m2_sr += weight * reflectance / PI * cosine * irradiance_w_m2 / asked;
                }
            }

            // The path goes on by what it may still bring.
            let goes_on = reflectance + transmittance;
            turns += 1;
            weight *= goes_on;
            let survival = match guided.filter(|_| transmittance <= 0.0) {
                Some(mixture) => {
                    let most = if turns > MOST_TURNS { goes_on.min(MOST_SURVIVAL) } else { MOST_SURVIVAL };
                    (worth * mixture.reflected_w_m2 / SURE_SHARE).max(LEAST_SURVIVAL).min(most)
                }
                None if turns > TURNS_BEFORE_ROULETTE => goes_on.min(MOST_SURVIVAL),
                None => 1.0,
            };
            if survival < 1.0 {
                if random.number() >= survival {
                    break;
                }
                weight /= survival;
            }
            if weight <= 0.0 {
                break;
            }

            // Straight on through glazing, or back in a direction of the mixture.
            if random.number() * goes_on < transmittance {
                position_m = at_m - lift_m;
                continue;
            }
            bounces += 1;
            position_m = at_m + lift_m;
            let seen = mixture.map(|mixture| mixture.seen_from(at_m)).filter(|seen| !seen.is_empty());
            let by_cosine = |direction: Vec3| f64::from(facing.dot(direction).max(0.0)) / PI;
            let (next, density_per_sr) =
                drawn(seen, Some(facing), random, |random| cosine_about(facing, random), by_cosine);
            let plain_per_sr = by_cosine(next);
            if plain_per_sr <= 0.0 {
                break;
            }
            weight *= plain_per_sr / density_per_sr;
            direction = next;
        }
        (radiance_w_m2_sr, rays)
    }
}

/// A direction from the guide or from the plain draw, with the density of the mixture.
fn drawn(
    seen: Option<Seen>,
    normal: Option<Vec3>,
    random: &mut Random,
    plain: impl Fn(&mut Random) -> Vec3,
    plain_per_sr: impl Fn(Vec3) -> f64,
) -> (Vec3, f64) {
    let Some(seen) = seen else {
        let direction = plain(random);
        return (direction, plain_per_sr(direction));
    };
    let direction = if random.number() < seen.trust { seen.drawn(normal, random) } else { plain(random) };
    let density_per_sr =
        seen.trust * seen.density_per_sr(direction, normal) + (1.0 - seen.trust) * plain_per_sr(direction);
    (direction, density_per_sr)
}
