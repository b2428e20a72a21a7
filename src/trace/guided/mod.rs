//! How much light is there truly, when one knows beforehand about where it comes from?
//!
//! The path tracer of [`trace`](super::trace()) with a guide ([`Guiding`]): the next direction is drawn by one-sample multiple
//! importance sampling (Veach & Guibas 1995) between the surface's cosine and the lobes of the nearest place, the lamp by what
//! it is known to bring there, and roulette ends paths by what they may still bring to the sensor (Vorba & Krivanek 2016).
//!
//! Right whatever the guide says, for every density is that of the mixture; how fast depends on the guide. So a few paths are
//! traced both ways first, and where the guide does not help the plain tracer goes on alone (`pilot`).

mod mixture;
mod path;
mod pilot;

use super::random::Random;
use super::{Traced, path as plain_path, sampled, traced};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Guiding, Sampler, Settings, Sources};
use crate::rays::Rays;
use crate::scene::Scene;
use mixture::Mixture;

/// Traces [`Settings::samples`] paths (at least 1) from each sensor, guided where that helps: the answer of
/// [`trace`](super::trace()), in less time where light takes ways that the guide knows. From 512 samples on, a sixteenth as many
/// more find out where. The stages are "pilot" and "trace".
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn trace_guided(
    scene: &Scene,
    rays: &Rays,
    sources: &Sources,
    guiding: &Guiding,
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Traced, Cancelled> {
    let sampler = Sampler::new(scene, sources, rays.epsilon_m());
    let max_bounces = settings.max_bounces.unwrap_or(u32::MAX);
    let plain = plain_path::Paths { scene, rays, sampler: &sampler, max_bounces };
    let mixtures: Vec<Mixture> = guiding.places.iter().map(|incident| Mixture::of(incident)).collect();
    let guided = path::Paths { scene, rays, sampler: &sampler, mixtures: &mixtures, guiding, max_bounces };
    let plainly = |sensor: usize, random: &mut Random| plain.sample(&scene.sensors[sensor], random);
    let by_guide = |sensor: usize, random: &mut Random| guided.sample(sensor, random);

    let helps = match pilot::settings(settings) {
        _ if mixtures.is_empty() => vec![false; scene.sensors.len()],
        None => vec![true; scene.sensors.len()],
        Some(few) => {
            let without = sampled("pilot", scene, &plainly, &few, progress, cancel)?;
            let with = sampled("pilot", scene, &by_guide, &few, progress, cancel)?;
            pilot::helps(&without, &with)
        }
    };
    let sample = |sensor: usize, random: &mut Random| match helps.get(sensor) {
        Some(true) => by_guide(sensor, random),
        _ => plainly(sensor, random),
    };
    let sums = sampled("trace", scene, &sample, settings, progress, cancel)?;
    Ok(traced(scene, sources, &sums))
}
