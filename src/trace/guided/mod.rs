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
    let guided = path::Paths { plain: &plain, mixtures: &mixtures, guiding };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::Quiet;
    use crate::light::{Incident, Lobe};
    use crate::scene::{Light, Sensor};
    use crate::trace::trace;
    use crate::voxel::test_scenes::{boxed, scene_of};
    use glam::{DVec3, Vec3};

    const RUNS: u64 = 64;

    /// The net flux at each sensor and its standard error, by runs that a pilot is too long for.
    fn fluxes(run: impl Fn(&Settings) -> Traced) -> Vec<(DVec3, DVec3)> {
        let runs: Vec<Traced> =
            (0..RUNS).map(|seed| run(&Settings { samples: 480, seed, ..Settings::default() })).collect();
        let count = RUNS as f64;
        let of_sensor = |sensor: usize| {
            let fluxes = || runs.iter().map(|run| run.field.readings[sensor].flux_w_m2);
            let mean = fluxes().sum::<DVec3>() / count;
            let squares = fluxes().map(|flux| (flux - mean) * (flux - mean)).sum::<DVec3>();
            (mean, (squares / (count * (count - 1.0))).powf(0.5))
        };
        (0..runs[0].field.readings.len()).map(of_sensor).collect()
    }

    /// A surface sees one side alone, also where a place in the open speaks for it, whose lobes come from below as well.
    #[test]
    fn what_a_place_in_the_open_knows_from_below_is_no_flux_of_a_surface() {
        let sensor = |position_m: Vec3, normal: Vec3| Sensor { id: String::new(), position_m, normal: Some(normal) };
        let mut scene = scene_of(&boxed(Vec3::ZERO, Vec3::new(4.0, 3.0, 2.5)));
        scene.lights = vec![Light::Point { position_m: Vec3::new(1.3, 1.1, 1.4), flux_w: 100.0 }];
        scene.sensors =
            vec![sensor(Vec3::new(2.9, 1.7, 0.0), Vec3::Z), sensor(Vec3::new(3.1, 2.2, 0.8), Vec3::new(0.6, 0.0, 0.8))];
        let lobe = |direction: Vec3| Lobe { direction, concentration: 2.0, weight: 0.5, distance_m: 2.0 };
        let open = Incident {
            position_m: Vec3::new(3.0, 2.0, 0.5),
            lobes: vec![lobe(Vec3::NEG_Z), lobe(Vec3::X)],
            trust: 0.5,
            reflected_w_m2: 4.0,
            direct_w_m2: vec![4.0],
            ..Incident::default()
        };
        let (rays, sources, cancel) = (Rays::new(&scene), Sources::of(&scene), Cancel::new());
        let guiding = Guiding { places: vec![&open], at_sensors: Vec::new(), place_of: &|_, _| Some(0) };
        let plain = fluxes(|settings| trace(&scene, &rays, &sources, settings, &Quiet, &cancel).unwrap());
        let guided =
            fluxes(|settings| trace_guided(&scene, &rays, &sources, &guiding, settings, &Quiet, &cancel).unwrap());
        for ((plain, error), (guided, other)) in plain.into_iter().zip(guided) {
            let off = (guided - plain) / (error * error + other * other).powf(0.5);
            assert!(other.max_element() < 0.05 * plain.length(), "too rough to tell: {other}");
            assert!(off.abs().max_element() < 4.0, "flux {guided} for {plain}, {off} standard errors");
        }
    }
}
