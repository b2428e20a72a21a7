//! Which suns of a period does a sensor see, and what do their beams bring?
//!
//! All of them can be asked. Or some: the suns are put in an order in which neighbours stand near each other in the sky, hour
//! after hour of the clock, up through one hour's suns and down through the next's. Along that order what each would bring
//! without anything in its way is summed up, and the sum is cut into equal shares; in each share one sun is asked, and
//! answers for the share (systematic sampling; Cochran, Sampling Techniques, chapter 8). The suns of a share cover some
//! degrees of sky, and see the same thing but for shares that an edge crosses: how often neighbours differ is the error.
//!
//! Neighbours are kept in groups. What a group brings to a plane is summed up eight suns at a time, groups behind the plane are
//! passed over by the cone they lie in, and suns are looked through one by one only in groups where a share ends.
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

/// Suns in a group: a few hours of a few weeks, some degrees of sky.
const GROUP: usize = 32;

/// Suns whose sums run side by side, as the compiler turns into vectors.
const LANES: usize = 8;

/// A cone of directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Its unit axis.
    pub axis: Vec3,
    /// Cosine of its half angle; below -1 it holds all directions.
    pub cosine: f32,
}

impl Cone {
    /// Whether two cones may have a direction in common. The slack is far above the rounding of `f32`.
    pub fn meets(&self, other: &Self) -> bool {
        let sine = |cosine: f32| (1.0 - cosine * cosine).max(0.0).sqrt();
        let both = self.cosine * other.cosine - sine(self.cosine) * sine(other.cosine);
        let is_wide = self.cosine < 0.0 || other.cosine < 0.0;
        is_wide || self.axis.dot(other.axis) >= both - 1e-4
    }

    /// Whether all of it is behind a plane.
    fn is_behind(&self, normal: Vec3) -> bool {
        self.cosine > 0.0 && self.axis.dot(normal) < -(1.0 - self.cosine * self.cosine).max(0.0).sqrt() - 1e-4
    }
}

/// The suns of a period in their order, in groups of neighbours.
#[derive(Debug, Clone)]
pub struct Suns {
    beams: Vec<Beam>,
    groups: Vec<Group>,
}

/// One part of a group's suns, in rows as wide as are summed side by side.
type Rows = [[f32; LANES]; GROUP / LANES];

/// Neighbours, laid out by part; those that fill the last group bring nothing and count nothing.
#[derive(Debug, Clone)]
struct Group {
    cone: Cone,
    towards: [Rows; 3],
    energy_kwh_m2: Rows,
    hours: Rows,
    suns: Rows,
}

/// What a group would bring with nothing in its way.
#[derive(Debug, Clone, Copy, Default)]
struct Brings {
    energy_kwh_m2: f64,
    hours: f64,
    suns: u32,
}

impl Suns {
    /// The suns of a map. `north_rad` is the direction of true north, clockwise from the scene's +Y.
    pub fn new(map: &ExposureMap, north_rad: f64) -> Self {
        let beams = in_order(map, north_rad);
        let groups = beams.chunks(GROUP).map(Group::new).collect();
        Self { beams, groups }
    }

    /// Whether a sun is in a cone and passes a test.
    pub fn any_in(&self, cone: &Cone, is: impl Fn(Vec3) -> bool) -> bool {
        let groups = self.groups.iter().zip(self.beams.chunks(GROUP)).filter(|(group, _)| group.cone.meets(cone));
        groups.flat_map(|(_, beams)| beams).any(|sun| sun.towards.dot(cone.axis) >= cone.cosine && is(sun.towards))
    }

    /// The suns before a plane, or all.
    fn in_front(&self, normal: Option<Vec3>) -> impl Iterator<Item = (&Beam, f64)> {
        let groups = self.groups.iter().zip(self.beams.chunks(GROUP));
        let groups = groups.filter(move |(group, _)| normal.is_none_or(|normal| !group.cone.is_behind(normal)));
        let suns = groups.flat_map(|(_, beams)| beams);
        suns.map(move |sun| (sun, cosine(sun, normal))).filter(|&(_, cosine)| cosine > 0.0)
    }
}

fn cosine(sun: &Beam, normal: Option<Vec3>) -> f64 {
    normal.map_or(1.0, |normal| f64::from(sun.towards.dot(normal)).max(0.0))
}

impl Group {
    fn new(beams: &[Beam]) -> Self {
        let axis = beams.iter().map(|sun| sun.towards).sum::<Vec3>().normalize_or(Vec3::Z);
        let cosine = beams.iter().map(|sun| sun.towards.dot(axis)).fold(1.0, f32::min) - 1e-5;
        let each = |part: fn(&Beam) -> f32| {
            let mut rows = [[0.0; LANES]; GROUP / LANES];
            rows.as_flattened_mut().iter_mut().zip(beams).for_each(|(place, sun)| *place = part(sun));
            rows
        };
        Self {
            cone: Cone { axis, cosine },
            towards: [each(|sun| sun.towards.x), each(|sun| sun.towards.y), each(|sun| sun.towards.z)],
            energy_kwh_m2: each(|sun| sun.energy_kwh_m2 as f32),
            hours: each(|sun| sun.hours as f32),
            suns: each(|_| 1.0),
        }
    }

    fn brings(&self, normal: Option<Vec3>) -> Brings {
        if normal.is_some_and(|normal| self.cone.is_behind(normal)) {
            return Brings::default();
        }
        // Without a normal every sun counts by 1: the cosine of no direction, and 1.
        let ([nx, ny, nz], at_least) = normal.map_or(([0.0; 3], 1.0), |normal| (normal.to_array(), 0.0));
        let (mut energy, mut hours, mut suns) = ([0.0_f32; LANES], [0.0_f32; LANES], [0.0_f32; LANES]);
        for row in 0..GROUP / LANES {
            let [x, y, z] = self.towards.each_ref().map(|part| &part[row]);
            let (of_energy, of_hours, of_suns) = (&self.energy_kwh_m2[row], &self.hours[row], &self.suns[row]);
            for lane in 0..LANES {
                let cosine = x[lane] * nx + y[lane] * ny + z[lane] * nz;
                let cosine = if cosine > at_least { cosine } else { at_least };
                let is_in_front = if cosine > 0.0 { 1.0 } else { 0.0 };
                energy[lane] += cosine * of_energy[lane];
                hours[lane] += is_in_front * of_hours[lane];
                suns[lane] += is_in_front * of_suns[lane];
            }
        }
        let sum = |lanes: [f32; LANES]| lanes.into_iter().map(f64::from).sum::<f64>();
        Brings { energy_kwh_m2: sum(energy), hours: sum(hours), suns: sum(suns) as u32 }
    }
}

/// What beams bring to a point that stands clear of its surface, on a plane by its normal or from all around: by a ray to
/// every sun, or to `count` of them, the first share's at `turn`, 0 to 1, of its share.
pub fn beam_at(rays: &Rays, at_m: Vec3, normal: Option<Vec3>, suns: &Suns, count: Option<u32>, turn: f64) -> Beamed {
    let passes = |sun: &Beam| f64::from(rays.from_afar(at_m, sun.towards));
    let every = || {
        let mut beamed = Beamed::default();
        for (sun, cosine) in suns.in_front(normal) {
            let passes = passes(sun);
            beamed.energy_kwh_m2 += passes * cosine * sun.energy_kwh_m2;
            beamed.sun_h += if passes > 0.0 { sun.hours } else { 0.0 };
        }
        beamed
    };
    let Some(count) = count else { return every() };
    let groups: Vec<Brings> = suns.groups.iter().map(|group| group.brings(normal)).collect();
    if groups.iter().map(|group| group.suns).sum::<u32>() <= count {
        return every();
    }

    // Each share's sun is asked as the sum reaches it; the hours gathered since the share began are the share's.
    let share_kwh_m2 = groups.iter().map(|group| group.energy_kwh_m2).sum::<f64>() / f64::from(count.max(1));
    let (mut before_kwh_m2, mut hours) = (0.0, 0.0);
    let (mut seen, mut differences, mut beamed) = (Vec::with_capacity(count as usize), 0.0, Beamed::default());
    for (brings, group) in groups.iter().zip(suns.beams.chunks(GROUP)) {
        let end_kwh_m2 = before_kwh_m2 + brings.energy_kwh_m2;
        if seen.len() == count as usize || end_kwh_m2 < (seen.len() as f64 + turn) * share_kwh_m2 {
            (before_kwh_m2, hours) = (end_kwh_m2, hours + brings.hours);
            continue;
        }
        let mut sum_kwh_m2 = before_kwh_m2;
        for (sun, cosine) in group.iter().map(|sun| (sun, cosine(sun, normal))).filter(|&(_, cosine)| cosine > 0.0) {
            sum_kwh_m2 += cosine * sun.energy_kwh_m2;
            hours += sun.hours;
            while seen.len() < count as usize && sum_kwh_m2 >= (seen.len() as f64 + turn) * share_kwh_m2 {
                let passes = passes(sun);
                differences += seen.last().map_or(0.0, |before: &f64| (passes - before).powi(2));
                beamed.energy_kwh_m2 += passes * share_kwh_m2;
                beamed.sun_h += if passes > 0.0 { hours } else { 0.0 };
                hours = 0.0;
                seen.push(passes);
            }
        }
        before_kwh_m2 = end_kwh_m2;
    }
    // What is left of the last share has its sun; so does a share whose sun a rounding at the end has passed over.
    if let Some(&last) = seen.last() {
        beamed.energy_kwh_m2 += last * share_kwh_m2 * (f64::from(count) - seen.len() as f64);
        beamed.sun_h += if last > 0.0 { hours } else { 0.0 };
    }
    beamed.error_kwh_m2 = share_kwh_m2 * (differences / 2.0).sqrt();
    beamed
}
