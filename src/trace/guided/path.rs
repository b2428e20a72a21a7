//! What does one guided path bring to a sensor?
//!
//! The path of the plain tracer, with three draws changed. The next direction comes from the lobes of the place or from the
//! cosine, half and half. A lamp is asked for by what it brings to the place, and not at all most of the time where all
//! lamps bring little of what the sensor gets. And a path goes on with the chance that what it may still bring bears to what
//! the sensor is to get. Where the guide knows no place the draws are those of the plain tracer.

use super::mixture::{Mixture, Seen};
use crate::light::Sampler;
use crate::rays::{Rays, Surface};
use crate::scene::{Scene, Sensor};
use crate::trace::path::{Sample, cosine_about, towards_hemisphere, uniform_on_sphere};
use crate::trace::random::Random;
use glam::Vec3;
use std::f64::consts::PI;

/// Turns before roulette where the guide says nothing, as in the plain tracer.
const TURNS_BEFORE_ROULETTE: u32 = 4;

/// All that a path needs to know.
pub(super) struct Paths<'a> {
    pub(super) scene: &'a Scene,
    pub(super) rays: &'a Rays,
    pub(super) sampler: &'a Sampler,
    pub(super) mixtures: &'a [Mixture],
    pub(super) place_of: &'a (dyn Fn(Vec3, Option<Vec3>) -> Option<u32> + Sync),
    /// Most reflections.
    pub(super) max_bounces: u32,
}

thread_local! { static LOG: std::cell::RefCell<String> = const { std::cell::RefCell::new(String::new()) }; }
fn log(t: impl FnOnce() -> String) {
    if env("LOGAT", 0.0) > 0.0 {
        LOG.with_borrow_mut(|l| l.push_str(&t()));
    }
}

impl Paths<'_> {
    /// One sample of the (scalar) irradiance and the net flux at a sensor.
    pub(super) fn sample(&self, sensor: &Sensor, random: &mut Random) -> Sample {
        let normal = sensor.normal;
        LOG.with_borrow_mut(|l| l.clear());
        let position_m = sensor.position_m + normal.unwrap_or(Vec3::ZERO) * self.rays.epsilon_m();
        let mixture = self.mixture(position_m, normal);
        let mut sample = Sample::default();
        let mut add = |direction: Vec3, irradiance_w_m2: f64| {
            let cosine = normal.map_or(1.0, |normal| f64::from(normal.dot(direction).max(0.0)));
            sample.value_w_m2 += cosine * irradiance_w_m2;
            sample.flux_w_m2 += irradiance_w_m2 * direction.as_dvec3();
        };
        if let Some((direction, irradiance_w_m2)) = self.direct(position_m, normal, mixture, 1.0, random) {
            add(direction, irradiance_w_m2);
        }
        let seen = mixture.map(|mixture| mixture.seen_from(position_m)).filter(|seen| !seen.is_empty());
        let (direction, density_per_sr) = match normal {
            None => drawn(seen, None, random, |random| uniform_on_sphere(random), |_| 1.0 / (4.0 * PI)),
            Some(normal) => drawn(
                seen,
                Some(normal),
                random,
                |random| towards_hemisphere(normal, random).0,
                |direction| 0.5 * f64::from(normal.dot(direction).max(0.0)) / PI + 0.5 / (2.0 * PI),
            ),
        };
        let cosine = normal.map_or(1.0, |normal| f64::from(normal.dot(direction).max(0.0)));
        if density_per_sr > 0.0 {
            let expected_w_m2 = mixture.map_or(0.0, |mixture| mixture.expected_w_m2(normal));
            let goal = expected_w_m2 * density_per_sr / cosine.max(1e-3);
            log(|| format!("start dir {direction:.2} density {density_per_sr:.3} expected {expected_w_m2:.4}\n"));
            let radiance_w_m2_sr = self.reflected(position_m, direction, goal, random);
            if env("LOGAT", 0.0) > 0.0 && cosine * radiance_w_m2_sr / density_per_sr > env("LOGAT", 0.0) * expected_w_m2
            {
                LOG.with_borrow(|l| {
                    eprintln!(
                        "{} {:.1} x expected\n{l}",
                        sensor.id,
                        cosine * radiance_w_m2_sr / density_per_sr / expected_w_m2
                    )
                });
            }
            add(direction, radiance_w_m2_sr / density_per_sr);
        }
        sample
    }

    fn mixture(&self, point_m: Vec3, normal: Option<Vec3>) -> Option<&Mixture> {
        (self.place_of)(point_m, normal).and_then(|place| self.mixtures.get(place as usize))
    }

    /// One sample of the light straight from the emitters, taken with the chance `asked`: its direction, and the irradiance on
    /// a surface that squarely faces it.
    fn direct(
        &self,
        position_m: Vec3,
        normal: Option<Vec3>,
        mixture: Option<&Mixture>,
        asked: f64,
        random: &mut Random,
    ) -> Option<(Vec3, f64)> {
        if asked < 1.0 && random.number() >= asked {
            return None;
        }
        let known = mixture.filter(|mixture| mixture.direct_w_m2 > 0.0);
        let (emitter, probability) = match known {
            None => self.sampler.choose(position_m, normal, random.number())?,
            Some(mixture) => {
                let emitter = if random.number() < env("GUIDED_LAMPS", 0.75) {
                    mixture.emitter(random.number())
                } else {
                    self.sampler.choose(position_m, normal, random.number())?.0
                };
                let plain = self.sampler.chance(emitter, position_m, normal);
                (
                    emitter,
                    env("GUIDED_LAMPS", 0.75) * mixture.chance(emitter) + (1.0 - env("GUIDED_LAMPS", 0.75)) * plain,
                )
            }
        };
        let light = self.sampler.sample(emitter, position_m, random.pair())?;
        if normal.is_some_and(|normal| normal.dot(light.direction) <= 0.0) {
            return None;
        }
        let share = self.rays.transmitted_past(position_m, light.end_m, |_| false);
        (share > 0.0).then(|| (light.direction, f64::from(share) * light.irradiance_w_m2 / (probability * asked)))
    }

    /// One sample of the reflected radiance that comes to `position_m` from `direction`, W/m2/sr; about `goal` is expected.
    fn reflected(&self, mut position_m: Vec3, mut direction: Vec3, goal: f64, random: &mut Random) -> f64 {
        let (mut radiance_w_m2_sr, mut weight) = (0.0, 1.0);
        let (mut bounces, mut turns) = (0, 0);
        while bounces < self.max_bounces {
            let Some(hit) = self.rays.closest(position_m, direction, f32::INFINITY) else { break };
            let Some((reflectance, transmittance)) = self.shares(hit.surface) else { break };
            let facing = hit.facing();
            let at_m = position_m + hit.distance_m * direction;
            let lift_m = facing * self.rays.epsilon_m();
            let mixture = self.mixture(at_m, Some(facing));
            // What an irradiance here is worth to the sensor, as a share of what that is to get.
            let worth = if goal > 0.0 { weight * reflectance / PI / goal } else { 0.0 };
            let guided = mixture.filter(|_| worth > 0.0);

            if reflectance > 0.0 {
                let asked = guided.map_or(1.0, |mixture| {
                    (worth * mixture.direct_w_m2 / env("ASKED_SHARE", 0.25)).clamp(env("LEAST_ASKED", 0.1), 1.0)
                });
                if let Some((towards, irradiance_w_m2)) =
                    self.direct(at_m + lift_m, Some(facing), mixture, asked, random)
                {
                    let cosine = f64::from(facing.dot(towards));
                    log(|| {
                        format!(
                            "   NEE at {at_m:.2} asked {asked:.2} E {:.4} place direct {:.4} contributes {:.2}\n",
                            cosine * irradiance_w_m2 * asked,
                            mixture.map_or(-1.0, |m| m.direct_w_m2),
                            worth * cosine * irradiance_w_m2
                        )
                    });
                    radiance_w_m2_sr += weight * reflectance / PI * cosine * irradiance_w_m2;
                }
            }

            let goes_on = reflectance + transmittance;
            turns += 1;
            weight *= goes_on;
            let survival = match guided.filter(|_| transmittance <= 0.0) {
                Some(mixture) => (env("SURV_SCALE", 1.0) * (worth * mixture.reflected_w_m2).powf(env("SURV_POW", 1.0)))
                    .clamp(env("LEAST_SURVIVAL", 0.1), env("MOST_SURVIVAL", 0.99)),
                None if turns > TURNS_BEFORE_ROULETTE => goes_on.min(env("MOST_SURVIVAL", 0.99)),
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
            log(|| {
                format!(
                    "  at {at_m:.2} n {facing:.1} survival {survival:.2} exp {:.2} next {next:.2} plain {plain_per_sr:.3} mix {density_per_sr:.3} factor {:.2}\n",
                    mixture.map_or(-1.0, |m| worth * m.reflected_w_m2),
                    plain_per_sr / density_per_sr
                )
            });
            weight *= plain_per_sr / density_per_sr;
            direction = next;
        }
        radiance_w_m2_sr
    }

    /// Reflectance and transmittance of what was hit; `None` for lights and emissive faces, which are black.
    fn shares(&self, surface: Surface) -> Option<(f64, f64)> {
        let Surface::Triangle(triangle) = surface else { return None };
        let material = self.scene.material(triangle as usize).filter(|material| !material.emits())?;
        Some((f64::from(material.reflects()), f64::from(material.passes())))
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
    let direction = if random.number() < env("GUIDED_SHARE", 0.5) { seen.drawn(normal, random) } else { plain(random) };
    let density_per_sr = env("GUIDED_SHARE", 0.5) * seen.density_per_sr(direction, normal)
        + (1.0 - env("GUIDED_SHARE", 0.5)) * plain_per_sr(direction);
    (direction, density_per_sr)
}

fn env(name: &'static str, or: f64) -> f64 {
    use std::sync::OnceLock;
    static V: OnceLock<std::collections::HashMap<String, f64>> = OnceLock::new();
    let v = V.get_or_init(|| std::env::vars().filter_map(|(k, v)| Some((k, v.parse().ok()?))).collect());
    v.get(name).copied().unwrap_or(or)
}
