//! What does one light path bring to a sensor?
//!
//! A path starts at the sensor. At the sensor and at every reflection one emitter is asked for its direct light (next-event
//! estimation); what the path itself hits is never counted as emission, so nothing is counted twice. Light that passes
//! straight through glazing on its way from an emitter is weakened on the shadow ray.

use super::random::Random;
use crate::light::Sampler;
use crate::rays::{Rays, Surface};
use crate::scene::{Scene, Sensor};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Turns at surfaces before roulette begins. From then on a path survives each with the share of light that goes on there, so
/// that its weight stays. Of 0, 1, 2, 3, 8, 16 and 24 turns, 3 gave the dark rooms of the gallery (reflectance 0.5) the
/// smallest error in a given time; bright scenes like it a little later.
pub(super) const TURNS_BEFORE_ROULETTE: u32 = 4;

/// Highest chance to survive roulette. In a scene that absorbs less than 1% at a surface, paths still end after 100 turns
/// or so, at the cost of noise; without it they would never end where the reflectance is 1.
pub(super) const MOST_SURVIVAL: f64 = 0.99;

/// All that a path needs to know.
pub(super) struct Paths<'a> {
    pub(super) scene: &'a Scene,
    pub(super) rays: &'a Rays,
    pub(super) sampler: &'a Sampler,
    /// Most reflections.
    pub(super) max_bounces: u32,
}

/// What one path brings; its mean over paths is the reading.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sample {
    pub(super) value_w_m2: f64,
    pub(super) flux_w_m2: DVec3,
    /// Rays that it took, those towards lamps counted.
    pub(super) rays: u32,
}

impl Sample {
    /// Adds what comes from `direction`, as the irradiance on a surface that squarely faces it; the sensor takes it by the cosine to
    /// its normal.
    pub(super) fn add(&mut self, normal: Option<Vec3>, direction: Vec3, irradiance_w_m2: f64) {
        self.value_w_m2 += cosine_to(normal, direction) * irradiance_w_m2;
        self.flux_w_m2 += irradiance_w_m2 * direction.as_dvec3();
    }
}

impl Paths<'_> {
    /// One sample of the (scalar) irradiance and the net flux at a sensor. A planar sensor is lifted off the surface
    /// that it lies on by [`Rays::epsilon_m`].
    pub(super) fn sample(&self, sensor: &Sensor, random: &mut Random) -> Sample {
        let normal = sensor.normal;
        let position_m = sensor.position_m + normal.unwrap_or(Vec3::ZERO) * self.rays.epsilon_m();
        let mut sample = Sample { rays: 1, ..Sample::default() };
        if let Some((direction, irradiance_w_m2)) = self.direct(position_m, normal, random) {
            sample.add(normal, direction, irradiance_w_m2);
        }
        let (direction, density_per_sr) = match normal {
            None => (uniform_on_sphere(random), 1.0 / (4.0 * PI)),
            Some(normal) => towards_hemisphere(normal, random),
        };
        let (radiance_w_m2_sr, rays) = self.reflected(position_m, direction, random);
        sample.add(normal, direction, radiance_w_m2_sr / density_per_sr);
        sample.rays += rays;
        sample
    }

    /// One sample of the light straight from the emitters: its direction, and the irradiance on a surface that squarely
    /// faces it. `None` for no light.
    pub(super) fn direct(&self, position_m: Vec3, normal: Option<Vec3>, random: &mut Random) -> Option<(Vec3, f64)> {
        let (emitter, probability) = self.sampler.choose(position_m, normal, random.number())?;
        let (direction, irradiance_w_m2) = self.straight(emitter, position_m, normal, random)?;
        Some((direction, irradiance_w_m2 / probability))
    }

    /// The same from one emitter alone.
    pub(super) fn straight(
        &self,
        emitter: usize,
        position_m: Vec3,
        normal: Option<Vec3>,
        random: &mut Random,
    ) -> Option<(Vec3, f64)> {
        let light = self.sampler.sample(emitter, position_m, random.pair())?;
        if normal.is_some_and(|normal| normal.dot(light.direction) <= 0.0) {
            return None;
        }
        // The ends stand clear of their surfaces already; pulling them in further could skip a wall in a corner.
        let share = self.rays.transmitted_past(position_m, light.end_m, |_| false);
        (share > 0.0).then(|| (light.direction, f64::from(share) * light.irradiance_w_m2))
    }

    /// One sample of the reflected radiance that comes to `position_m` from `direction`, W/m2/sr, and the rays it took.
    fn reflected(&self, mut position_m: Vec3, mut direction: Vec3, random: &mut Random) -> (f64, u32) {
        let (mut radiance_w_m2_sr, mut weight) = (0.0, 1.0);
        let (mut bounces, mut turns, mut rays) = (0, 0, 0);
        while bounces < self.max_bounces {
            rays += 2;
            let Some(hit) = self.rays.closest(position_m, direction, f32::INFINITY) else { break };
            let Some((reflectance, transmittance)) = self.shares(hit.surface) else { break };
            let facing = hit.facing();
            let at_m = position_m + hit.distance_m * direction;
            let lift_m = facing * self.rays.epsilon_m();

            // Direct light that the surface reflects towards where the path came from.
            if reflectance > 0.0
                && let Some((towards, irradiance_w_m2)) = self.direct(at_m + lift_m, Some(facing), random)
            {
                let cosine = f64::from(facing.dot(towards));
                radiance_w_m2_sr += weight * reflectance / PI * cosine * irradiance_w_m2;
            }

            // The path goes on by the two shares together, and ends by roulette once it is long.
            let goes_on = reflectance + transmittance;
            turns += 1;
            weight *= goes_on;
            if turns > TURNS_BEFORE_ROULETTE {
                let survival = goes_on.min(MOST_SURVIVAL);
                if random.number() >= survival {
                    break;
                }
                weight /= survival;
            }
            if weight <= 0.0 {
                break;
            }

            // Straight on through glazing, or back in a direction drawn by its cosine.
            if random.number() * goes_on < transmittance {
                position_m = at_m - lift_m;
            } else {
                bounces += 1;
                position_m = at_m + lift_m;
                direction = cosine_about(facing, random);
            }
        }
        (radiance_w_m2_sr, rays)
    }

    /// Reflectance and transmittance of what was hit; `None` for lights and emissive faces, which are black.
    pub(super) fn shares(&self, surface: Surface) -> Option<(f64, f64)> {
        let Surface::Triangle(triangle) = surface else { return None };
        let material = self.scene.material(triangle as usize).filter(|material| !material.emits())?;
        Some((f64::from(material.reflects()), f64::from(material.passes())))
    }
}

/// How squarely a sensor faces `direction`: 0 from behind, 1 from all around where it has no normal.
pub(super) fn cosine_to(normal: Option<Vec3>, direction: Vec3) -> f64 {
    normal.map_or(1.0, |normal| f64::from(normal.dot(direction).max(0.0)))
}

pub(super) fn uniform_on_sphere(random: &mut Random) -> Vec3 {
    let [height, turn] = random.pair();
    let z = 1.0 - 2.0 * height;
    let ring = (1.0 - z * z).max(0.0).sqrt();
    let (sine, cosine) = (2.0 * PI * turn).sin_cos();
    DVec3::new(ring * cosine, ring * sine, z).as_vec3()
}

/// By the cosine about `normal`: density `cos / pi`.
pub(super) fn cosine_about(normal: Vec3, random: &mut Random) -> Vec3 {
    let [square, turn] = random.pair();
    about(normal, (1.0 - square).sqrt(), turn)
}

/// Half of the draws by the cosine and half uniform over the hemisphere, with the density of the mixture. By the cosine
/// alone, the part of the net flux along the surface would have no finite variance.
pub(super) fn towards_hemisphere(normal: Vec3, random: &mut Random) -> (Vec3, f64) {
    let by_cosine = random.number() < 0.5;
    let [height, turn] = random.pair();
    let cosine = if by_cosine { (1.0 - height).sqrt() } else { 1.0 - height };
    (about(normal, cosine, turn), 0.5 * cosine / PI + 0.5 / (2.0 * PI))
}

/// The density of [`towards_hemisphere`], per steradian; none below the surface.
pub(super) fn hemisphere_per_sr(normal: Vec3, direction: Vec3) -> f64 {
    let cosine = f64::from(normal.dot(direction));
    if cosine > 0.0 { 0.5 * cosine / PI + 0.5 / (2.0 * PI) } else { 0.0 }
}

/// The unit vector at that cosine from `axis`, turned about it by that share of a turn.
fn about(axis: Vec3, cosine: f64, turn: f64) -> Vec3 {
    let axis = axis.as_dvec3();
    let (right, up) = axis.any_orthonormal_pair();
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (turn_sine, turn_cosine) = (2.0 * PI * turn).sin_cos();
    (cosine * axis + sine * (turn_cosine * right + turn_sine * up)).as_vec3()
}
