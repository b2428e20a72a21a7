//! How much light is there truly, when one knows beforehand about where it comes from?
//!
//! The path tracer of [`trace`](mod@super::trace) with a guide ([`Guiding`]): the next direction is drawn by one-sample multiple importance
//! sampling (Veach & Guibas 1995) between the surface's cosine and the lobes of the nearest place, the lamp by what it is known
//! to bring there, and roulette ends paths by what they may still bring to the sensor (Vorba & Krivanek 2016).
//!
//! Limits: right whatever the guide says, for every density is that of the mixture; how fast depends on the guide.

mod mixture;
mod path;

use super::random::Random;
use super::{Traced, sampled};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Guiding, Sampler, Settings, Sources};
use crate::rays::Rays;
use crate::scene::{Scene, Sensor};
use mixture::Mixture;
use path::Paths;

/// Traces [`Settings::samples`] guided paths (at least 1) from each sensor: what [`trace`](super::trace()) gives, in less time where light takes
/// ways that the guide knows.
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
    let mixtures: Vec<Mixture> = guiding.places.iter().map(|incident| Mixture::of(incident)).collect();
    let paths = Paths {
        scene,
        rays,
        sampler: &sampler,
        mixtures: &mixtures,
        place_of: guiding.place_of,
        max_bounces: settings.max_bounces.unwrap_or(u32::MAX),
    };
    let sample = |sensor: &Sensor, random: &mut Random| paths.sample(sensor, random);
    sampled(scene, sources, &sample, settings, progress, cancel)
}
