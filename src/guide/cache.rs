//! What does an irradiance cache start with?
//!
//! At every wall place the irradiance that the network knows, and Ward's validity radius: the harmonic mean distance to what
//! the point sees, by the cosine (Ward, Rubinstein & Clear 1988). What the place's patch sees stands for what the place sees, its
//! distance taken from the place: near a corner the mean over the patch itself would have no bound. In a cube that is within 15%
//! of what the place sees itself.

use super::sights::sights;
use super::{CacheRecord, Place};
use crate::flow::network::Network;
use crate::flow::network::lines::Line;
use crate::light::Incident;

/// Cosines below this count as this where one is divided by them: a sight along a wall would outweigh all others.
const LEAST_COSINE: f32 = 0.05;

/// What a patch sees, by its sights.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct View {
    /// Harmonic mean distance to what it sees, metres.
    pub radius_m: f32,
    /// Scalar irradiance by reflected light, over the hemisphere before it, W/m2.
    pub scalar_w_m2: f32,
}

/// The view of each wall place, one a patch; `radiosity_w_m2` is the patches' own. A place without a sight has the root of its
/// patch's area for a radius.
pub fn views(network: &Network, places: &[Incident], lines: &[Line], radiosity_w_m2: &[f64]) -> Vec<View> {
    // Sums of weight, weight over distance, weight over cosine, and radiosity by weight over cosine.
    let mut sums = vec![[0.0_f64; 4]; network.grounds.patches.list.len()];
    for sight in lines.iter().flat_map(|line| sights(line, radiosity_w_m2)) {
        let patch = sight.patch as usize;
        let (Some(sum), Some(place)) = (sums.get_mut(patch), places.get(patch)) else { continue };
        let by_angle_m2 = sight.weight_m2 / f64::from(sight.cosine().max(LEAST_COSINE));
        let seen_m = sight.from_m + sight.distance_m * sight.direction;
        let distance_m = f64::from(seen_m.distance(place.position_m).max(network.grounds.model.rays.epsilon_m()));
        let parts = [sight.weight_m2, sight.weight_m2 / distance_m, by_angle_m2, by_angle_m2 * sight.radiosity_w_m2];
        sum.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
    }
    let view =
        |(patch, [weight, over_distance, over_cosine, shining]): (&crate::flow::network::patches::Patch, [f64; 4])| {
            match weight > 0.0 {
                // Even radiance L is a scalar irradiance of 2 pi L, and pi L is the radiosity.
                true => View {
                    radius_m: (weight / over_distance) as f32,
                    scalar_w_m2: (2.0 * shining / over_cosine) as f32,
                },
                false => View { radius_m: patch.area_m2.sqrt() as f32, scalar_w_m2: 0.0 },
            }
        };
    network.grounds.patches.list.iter().zip(sums).map(view).collect()
}

/// A record for each wall place, whose patches have these views.
pub fn records(walls: &[Place], views: &[View]) -> Vec<CacheRecord> {
    let record = |(place, view): (&Place, &View)| {
        let incident = &place.incident;
        CacheRecord {
            position_m: incident.position_m,
            normal: incident.normal.unwrap_or_default(),
            reflected_w_m2: incident.reflected_w_m2,
            irradiance_w_m2: incident.reflected_w_m2 + incident.direct_w_m2.iter().sum::<f32>(),
            radius_m: view.radius_m,
        }
    };
    walls.iter().zip(views).map(record).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::network::Quality;
    use crate::flow::sequence;
    use crate::flow::tests::{FLUX_W, lamp, modelled, room};
    use crate::guide::places::{at_walls, sent_by_ends};
    use crate::guide::shine::Shine;
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;
    use glam::Vec3;
    use std::f32::consts::PI;

    #[test]
    fn views_of_a_cube_are_what_quadrature_gives_and_even_light_is_even() {
        let (_, model) = modelled(&room(), vec![lamp(Vec3::new(1.0, 0.5, 1.5), FLUX_W)], Vec::new());
        let (network, lines) = Network::new(&model, &Quality::FINE, &Settings::default(), &Quiet, &Cancel::new())
            .expect("nobody stops it");
        let places = at_walls(&network, &lines, &sent_by_ends(&Shine::new(&network), &lines));
        let views = views(&network, &places, &lines, &vec![f64::from(PI); places.len()]);
        for (number, (place, view)) in places.iter().zip(&views).enumerate() {
            assert!((view.scalar_w_m2 / (2.0 * PI) - 1.0).abs() < 1e-5, "{view:?}");
            // The same by even directions to the walls of the box.
            let normal = place.normal.expect("on a wall");
            let offset = sequence::offset(9, number as u64);
            let over_m = |index: u32| {
                let towards = sequence::cosine_about(normal, sequence::square(index, offset));
                let ahead_m = |axis: usize| {
                    let wall_m = if towards[axis] > 0.0 { 3.0 } else { 0.0 };
                    (wall_m - place.position_m[axis]) / towards[axis]
                };
                1.0 / ahead_m(0).min(ahead_m(1)).min(ahead_m(2))
            };
            let want_m = 1024.0 / (0..1024).map(over_m).sum::<f32>();
            // Sights from all over the patch are nearer to the walls beside it than its middle is.
            assert!((view.radius_m / want_m - 1.0).abs() < 0.15, "{} m is not {want_m} m", view.radius_m);
        }
    }
}
