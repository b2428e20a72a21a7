//! Which suns of a period does a sensor see, and what do their beams bring?
//!
//! All of them can be asked. Or some: the suns are put in an order in which neighbours stand near each other in the sky, hour
//! after hour of the clock, up through one hour's suns and down through the next's. Along that order what each would bring
//! without anything in its way is summed up, and the sum is cut into equal shares; in each share one sun is asked, and
//! answers for the share (systematic sampling; Cochran, Sampling Techniques, chapter 8). The suns of a share cover some
//! degrees of sky, and see the same thing but for shares that an edge crosses: how often neighbours differ is the error.
//!
//! Limits: the hours of sun are the shares' hours, so a sun just above the plane has no share of its own.

use crate::rays::Rays;
use crate::sky::map::ExposureMap;
use crate::sky::towards;
use glam::Vec3;

/// A sun of the period, in the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// The direction to it.
    pub towards: Vec3,
    /// On a plane that faces it, kWh/m2.
    pub energy_kwh_m2: f64,
    /// How long it shines, hours.
    pub hours: f64,
}

/// What the beams bring to a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Beamed {
    /// kWh/m2.
    pub energy_kwh_m2: f64,
    /// Standard error of that; 0 where every sun was asked.
    pub error_kwh_m2: f64,
    /// Hours in which the sun shines on it.
    pub sun_h: f64,
}

/// The suns of a map in the order in which neighbours are near. `north_rad` is the direction of true north, clockwise from
/// the scene's +Y.
pub fn in_order(map: &ExposureMap, north_rad: f64) -> Vec<Beam> {
    let mut suns: Vec<_> = map.suns.iter().collect();
    suns.sort_by(|a, b| {
        let [hour, other] = [a, b].map(|sun| sun.time.hour());
        let up = a.sun.elevation_rad.total_cmp(&b.sun.elevation_rad);
        hour.cmp(&other).then(if hour % 2 == 0 { up } else { up.reverse() })
    });
    let beam = |sun: &crate::sky::map::SunEnergy| Beam {
        towards: towards(sun.sun.azimuth_rad + north_rad, sun.sun.elevation_rad).as_vec3(),
        energy_kwh_m2: sun.energy_kwh_m2,
        hours: sun.hours,
    };
    suns.into_iter().map(beam).collect()
}

/// What beams bring to a point that stands clear of its surface, on a plane by its normal or from all around: by a ray to
/// every sun, or to `count` of them, the first share's at `turn`, 0 to 1, of its share.
pub fn beam_at(rays: &Rays, at_m: Vec3, normal: Option<Vec3>, suns: &[Beam], count: Option<u32>, turn: f64) -> Beamed {
    let cosine = |sun: &Beam| normal.map_or(1.0, |normal| f64::from(sun.towards.dot(normal)).max(0.0));
    let passes = |sun: &Beam| f64::from(rays.from_afar(at_m, sun.towards));
    let in_front = suns.iter().filter(|sun| cosine(sun) > 0.0);
    let Some(count) = count.filter(|&count| (count as usize) < in_front.clone().count()) else {
        let mut beamed = Beamed::default();
        for sun in in_front {
            let passes = passes(sun);
            beamed.energy_kwh_m2 += passes * cosine(sun) * sun.energy_kwh_m2;
            beamed.sun_h += if passes > 0.0 { sun.hours } else { 0.0 };
        }
        return beamed;
    };

    // Each share's sun is asked as the sum reaches it; the hours gathered since the share began are the share's.
    let all_kwh_m2: f64 = in_front.clone().map(|sun| cosine(sun) * sun.energy_kwh_m2).sum();
    let share_kwh_m2 = all_kwh_m2 / f64::from(count.max(1));
    let (mut sum, mut seen, mut differences, mut beamed) = (0.0, Vec::new(), 0.0, Beamed::default());
    let mut hours = 0.0;
    for sun in in_front {
        sum += cosine(sun) * sun.energy_kwh_m2;
        hours += sun.hours;
        while seen.len() < count as usize && sum >= (seen.len() as f64 + turn) * share_kwh_m2 {
            let passes = passes(sun);
            differences += seen.last().map_or(0.0, |before: &f64| (passes - before).powi(2));
            beamed.energy_kwh_m2 += passes * share_kwh_m2;
            beamed.sun_h += if passes > 0.0 { hours } else { 0.0 };
            hours = 0.0;
            seen.push(passes);
        }
    }
    beamed.error_kwh_m2 = share_kwh_m2 * (differences / 2.0).sqrt();
    beamed
}
