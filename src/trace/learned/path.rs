//! What does one path bring to a sensor, and what does it teach?
//!
//! The path of the plain tracer, but for its directions: half of them are drawn from what is known of the place, half as the
//! plain tracer does, and each is weighed by the density of both (one-sample multiple importance sampling, Veach & Guibas
//! 1995). Lamps and roulette are the plain tracer's. Every turn of a path tells the place where it stands what came from there.

use super::directions::{direction_of, square_of};
use super::places::{Place, Places, Sight};
use crate::scene::Sensor;
use crate::trace::path::{
    MOST_SURVIVAL, Paths, Sample, TURNS_BEFORE_ROULETTE, cosine_about, cosine_to, hemisphere_per_sr,
    towards_hemisphere, uniform_on_sphere,
};
use crate::trace::random::Random;
use glam::Vec3;
use std::f64::consts::PI;

/// A turn of a path that waits for what comes from its direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    place: u32,
    square: [f32; 2],
    /// Cosine over density, steradian.
    worth_sr: f64,
    /// What the path weighed and had found when it went on from here.
    weight: f64,
    found_w_m2_sr: f64,
}

/// A direction that was drawn, its place in the square, and its density.
struct Drawn {
    direction: Vec3,
    square: [f32; 2],
    density_per_sr: f64,
}

/// One sample at the sensor of that number; what it teaches is added to `sights`. `turns` is room to work in.
pub(super) fn sample(
    paths: &Paths,
    places: &Places,
    (number, sensor): (usize, &Sensor),
    random: &mut Random,
    turns: &mut Vec<Turn>,
    sights: &mut Vec<Sight>,
) -> Sample {
    let normal = sensor.normal;
    let position_m = sensor.position_m + normal.unwrap_or(Vec3::ZERO) * paths.rays.epsilon_m();
    let mut sample = Sample { rays: 1, ..Sample::default() };
    if let Some((direction, irradiance_w_m2)) = paths.direct(position_m, normal, random) {
        sample.add(normal, direction, irradiance_w_m2);
    }

    let place = places.of_sensor(number);
    let drawn = match normal {
        None => drawn(places, place, random, uniform_on_sphere, |_| 1.0 / (4.0 * PI)),
        Some(normal) => drawn(
            places,
            place,
            random,
            |random| towards_hemisphere(normal, random).0,
            |towards| hemisphere_per_sr(normal, towards),
        ),
    };
    let Drawn { direction, square, density_per_sr } = drawn;
    let cosine = cosine_to(normal, direction);
    if cosine <= 0.0 {
        return sample;
    }
    turns.clear();
    turns.push(Turn { place, square, worth_sr: cosine / density_per_sr, weight: 1.0, found_w_m2_sr: 0.0 });
    let (radiance_w_m2_sr, rays) = reflected(paths, places, position_m, direction, random, turns);
    sample.add(normal, direction, radiance_w_m2_sr / density_per_sr);
    sample.rays += rays;
    sights.extend(turns.iter().map(|turn| {
        let radiance_w_m2_sr = (radiance_w_m2_sr - turn.found_w_m2_sr).max(0.0) / turn.weight;
        let light_w_m2 = (radiance_w_m2_sr * turn.worth_sr) as f32;
        Sight { place: turn.place, square: turn.square, light_w_m2 }
    }));
    sample
}

/// One sample of the reflected radiance that comes to `position_m` from `direction`, W/m2/sr, and the rays it took.
fn reflected(
    paths: &Paths,
    places: &Places,
    mut position_m: Vec3,
    mut direction: Vec3,
    random: &mut Random,
    path: &mut Vec<Turn>,
) -> (f64, u32) {
    let (mut radiance_w_m2_sr, mut weight) = (0.0, 1.0);
    let (mut bounces, mut turns, mut rays) = (0, 0, 0);
    while bounces < paths.max_bounces {
        rays += 2;
        let Some(hit) = paths.rays.closest(position_m, direction, f32::INFINITY) else { break };
        let Some((reflectance, transmittance)) = paths.shares(hit.surface) else { break };
        let facing = hit.facing();
        let at_m = position_m + hit.distance_m * direction;
        let lift_m = facing * paths.rays.epsilon_m();

        if reflectance > 0.0
            && let Some((towards, irradiance_w_m2)) = paths.direct(at_m + lift_m, Some(facing), random)
        {
            let cosine = f64::from(facing.dot(towards));
            radiance_w_m2_sr += weight * reflectance / PI * cosine * irradiance_w_m2;
        }

        // Roulette as in the plain tracer.
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
        if random.number() * goes_on < transmittance {
            position_m = at_m - lift_m;
            continue;
        }

        bounces += 1;
        position_m = at_m + lift_m;
        let place = places.of_point(at_m, facing);
        let by_cosine = |towards: Vec3| f64::from(facing.dot(towards).max(0.0)) / PI;
        let next = drawn(places, place, random, |random| cosine_about(facing, random), by_cosine);
        let plain_per_sr = by_cosine(next.direction);
        if plain_per_sr <= 0.0 {
            break;
        }
        weight *= plain_per_sr / next.density_per_sr;
        direction = next.direction;
        let worth_sr = PI * plain_per_sr / next.density_per_sr;
        path.push(Turn { place, square: next.square, worth_sr, weight, found_w_m2_sr: radiance_w_m2_sr });
    }
    (radiance_w_m2_sr, rays)
}

/// A direction from what is known of the place or from the plain draw, with the density of the mixture.
fn drawn(
    places: &Places,
    place: u32,
    random: &mut Random,
    plain: impl Fn(&mut Random) -> Vec3,
    plain_per_sr: impl Fn(Vec3) -> f64,
) -> Drawn {
    let Some(Place { known, share, .. }) = places.known(place) else {
        let direction = plain(random);
        return Drawn { direction, square: square_of(direction), density_per_sr: plain_per_sr(direction) };
    };
    let (direction, square) = if random.number() < *share {
        let square = known.drawn(random.pair());
        (direction_of(square), square)
    } else {
        let direction = plain(random);
        (direction, square_of(direction))
    };
    let density_per_sr = share * known.density_per_sr(square) + (1.0 - share) * plain_per_sr(direction);
    Drawn { direction, square, density_per_sr }
}
