//! What do sun and sky bring to a point of a surface, by few rays?
//!
//! The truth ([`cast`](super::super::cast)) asks thousands of rays a point; a network asks at thousands of points, and few rays at each
//! have no bias together. Suns are drawn by their energy, evenly along the order in which neighbours are near. The sky is
//! drawn by the cosine and, in rooms, evenly over the necks that lead out of them, both weighed by the sum of their densities
//! (the balance heuristic, Veach & Guibas 1995): what shows through a small opening would be met by few rays.
//!
//! Beside the period's beam and sky rides the overcast sky of the CIE (ISO 15469, type 16: `L = Lz (1 + 2 sin el) / 3`), as dim
//! as to be lost in them: the same rays then tell daylight factors.

use super::super::beams::{Beam, in_order};
use super::super::cast::Sky;
use crate::flow::network::portals::Portal;
use crate::flow::sequence;
use crate::rays::Rays;
use crate::sky::map::ExposureMap;
use glam::Vec3;
use std::f64::consts::PI;

/// Beam, sky, and the overcast sky.
pub const COLUMNS: usize = 3;

/// The overcast sky's horizontal irradiance, as a share of the period's: too little to count where all light is added up.
const OVERCAST_SHARE: f64 = 1e-7;

/// Blocks that directions are dealt out to: how far they differ is the error.
const BLOCKS: usize = 8;

/// Sun and skies of a period, in the scene.
pub struct Skylight<'a> {
    suns: Vec<Beam>,
    /// The energy of each sun and all before it, kWh/m2.
    up_to_kwh_m2: Vec<f64>,
    sky: Sky<'a>,
    /// What the overcast sky brings to open ground, kWh/m2.
    pub overcast_kwh_m2: f64,
}

/// Where light is asked for.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// A point that stands clear of its surface, metres.
    pub from_m: Vec3,
    /// Unit normal of the side; `None` for light from all around, unweighted.
    pub normal: Option<Vec3>,
    /// Necks that rays are aimed at.
    pub necks: &'a [&'a Portal],
    /// Offset of the sequences.
    pub offset: [f64; 2],
}

impl Asked<'_> {
    fn cosine(&self, direction: Vec3) -> f64 {
        self.normal.map_or(1.0, |normal| f64::from(direction.dot(normal)))
    }
}

/// How finely a point is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Asking {
    /// Suns.
    pub suns: u32,
    /// Directions by the cosine.
    pub sky_rays: u32,
    /// Directions to each neck.
    pub neck_rays: u32,
}

impl<'a> Skylight<'a> {
    /// The light of a map. `north_rad` is the direction of true north, clockwise from the scene's +Y.
    pub fn new(map: &'a ExposureMap, north_rad: f64) -> Self {
        let suns = in_order(map, north_rad);
        let mut sum_kwh_m2 = 0.0;
        let up_to_kwh_m2 = suns.iter().map(|sun| {
            sum_kwh_m2 += sun.energy_kwh_m2;
            sum_kwh_m2
        });
        let up_to_kwh_m2 = up_to_kwh_m2.collect();
        let overcast_kwh_m2 = OVERCAST_SHARE * map.totals.ghi_kwh_m2.max(1e-3);
        Self { suns, up_to_kwh_m2, sky: Sky { map, north_rad }, overcast_kwh_m2 }
    }

    /// What beam, sky and overcast sky bring to a point that stands clear of its surface, on that side of it, kWh/m2.
    pub fn at_point(&self, rays: &Rays, asked: &Asked, asking: Asking) -> [f64; COLUMNS] {
        let beam = self.beam(rays, asked, asking.suns);
        let [sky, overcast] = self.skies(rays, asked, asking)[0];
        [beam, sky, overcast]
    }

    /// What sky and overcast sky bring to a point, kWh/m2, and the standard error of each.
    pub fn skies_at(&self, rays: &Rays, asked: &Asked, asking: Asking) -> [[f64; 2]; 2] {
        self.skies(rays, asked, asking)
    }

    fn beam(&self, rays: &Rays, asked: &Asked, count: u32) -> f64 {
        let all_kwh_m2 = self.up_to_kwh_m2.last().copied().unwrap_or(0.0);
        let share_kwh_m2 = all_kwh_m2 / f64::from(count.max(1));
        let brings = |number: u32| {
            let target_kwh_m2 = (f64::from(number) + asked.offset[0]) * share_kwh_m2;
            let sun = self.suns.get(self.up_to_kwh_m2.partition_point(|&up_to| up_to <= target_kwh_m2))?;
            let cosine = asked.cosine(sun.towards);
            (cosine > 0.0).then(|| cosine * f64::from(rays.from_afar(asked.from_m, sun.towards)))
        };
        share_kwh_m2 * (0..count).filter_map(brings).sum::<f64>()
    }

    /// The sums of sky and overcast sky, and their standard errors by blocks.
    fn skies(&self, rays: &Rays, asked: &Asked, asking: Asking) -> [[f64; 2]; 2] {
        let Asking { sky_rays, neck_rays, .. } = asking;
        let Asked { from_m, normal, necks, offset } = *asked;
        let over_all = (0..sky_rays).map(|ray| {
            let square = sequence::square(ray, offset);
            match normal {
                Some(normal) => sequence::cosine_about(normal, square),
                None => sequence::on_sphere([square[0] / 2.0, square[1]]),
            }
        });
        let to_necks = necks.iter().flat_map(|neck| {
            (0..neck_rays).map(move |ray| (neck.point_m(ray, neck_rays, offset) - from_m).normalize_or_zero())
        });
        let mut blocks = [[0.0; 2]; BLOCKS];
        for (number, direction) in over_all.chain(to_necks).enumerate() {
            let cosine = asked.cosine(direction);
            if cosine <= 0.0 || direction.z <= 0.0 {
                continue;
            }
            let passes = f64::from(rays.from_afar(from_m, direction));
            if passes > 0.0 {
                let aimed = necks.iter().filter_map(|neck| neck.density_per_sr(from_m, direction, neck_rays));
                let over_all = f64::from(sky_rays) * if normal.is_some() { cosine / PI } else { 0.5 / PI };
                let sees_sr = passes * cosine / (over_all + aimed.sum::<f64>());
                blocks[number % BLOCKS][0] += sees_sr * self.sky.radiance_kwh_m2_sr(direction.as_dvec3());
                blocks[number % BLOCKS][1] += sees_sr * self.overcast_kwh_m2_sr(direction);
            }
        }
        let sum = |column: usize| blocks.iter().map(|block| block[column]).sum::<f64>();
        let error = |column: usize| {
            let mean = sum(column) / BLOCKS as f64;
            let spread: f64 = blocks.iter().map(|block| (block[column] - mean).powi(2)).sum();
            (spread * BLOCKS as f64 / (BLOCKS - 1) as f64).sqrt()
        };
        [[sum(0), sum(1)], [error(0), error(1)]]
    }

    /// The overcast sky's radiance, kWh/m2/sr: over open ground it brings `7 pi / 9` of that at the zenith.
    fn overcast_kwh_m2_sr(&self, direction: Vec3) -> f64 {
        let zenith = self.overcast_kwh_m2 * 9.0 / (7.0 * PI);
        zenith * (1.0 + 2.0 * f64::from(direction.z)) / 3.0
    }
}
