//! How much light reaches a point by any number of reflections, by exchange among patches of wall.
//!
//! Steps, each in its file: the void is parted into [zones] that never cross a neck; what a zone sees in one direction is a
//! [patch](patches); [lines] from patches and through [necks](portals) measure what each patch sees of each other; light
//! [lands](landing) straight from its sources; the [balance] of all reflections is one sparse system; a sensor [gathers] it by
//! rays over its sphere and through the necks of its room, beside the exact direct light. Oriented patches are the poster's
//! own next step, "an oriented reflectivity a node" (Chaussard, Biri, Couprie); the balance is radiosity (Goral et al. 1984)
//! with lines in place of form factors (Sbert 1993), weighed by the balance heuristic (Veach & Guibas 1995).
//!
//! Own error estimate, [`Reading::error_w_m2`](crate::light::Reading::error_w_m2): the same answer from either half of the
//! lines, from a coarser network on the same lines, and from either half of the gathering rays.
//!
//! Limits: radiosity is the same all over a patch but for the light that lands on it straight; openings that the voxels close
//! let no reflected light through; walls are Lambertian.

pub mod balance;
pub mod exchange;
mod gather;
pub mod landing;
pub mod lines;
pub mod patches;
pub mod portals;
pub mod walk;
pub mod zones;

use crate::flow::Estimator;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Settings};
use crate::model::{Model, Probe};
use exchange::{Exchange, Half};
use glam::Vec3;
use landing::{Landing, landing};
use patches::{Patches, Start};
use portals::Portal;
use zones::Zones;

/// How finely a network is made and asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// Length of a zone, in widths of the void there.
    pub spacing: f32,
    /// Lines from a patch.
    pub lines: u32,
    /// Lines through a neck.
    pub neck_lines: u32,
    /// Photons of all lights together.
    pub photons: u32,
    /// Shadow rays from a patch to a light.
    pub shadow_rays: u32,
    /// Rays from a sensor.
    pub gather_rays: u32,
    /// Rays from a sensor to each neck of its room.
    pub gather_neck_rays: u32,
}

impl Quality {
    /// The default.
    pub const MEDIUM: Self = Self {
        spacing: 0.4,
        lines: 16,
        neck_lines: 1024,
        photons: 4096,
        shadow_rays: 16,
        gather_rays: 256,
        gather_neck_rays: 64,
    };
}

/// Irradiance at the probes by the network at its default quality.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn estimate(
    model: &Model,
    probes: &[Probe],
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Field, Cancelled> {
    estimate_at(Quality::MEDIUM, model, probes, settings, progress, cancel)
}

/// The estimator of that quality.
pub fn with(quality: Quality) -> Box<Estimator<'static>> {
    Box::new(move |model, probes, settings, progress, cancel| {
        estimate_at(quality, model, probes, settings, progress, cancel)
    })
}

fn estimate_at(
    quality: Quality,
    model: &Model,
    probes: &[Probe],
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Field, Cancelled> {
    let mut quality = quality;
    let get = |k: &str, d: f32| std::env::var(k).ok().and_then(|v| v.parse().ok()).unwrap_or(d);
    quality.spacing = get("SP", quality.spacing);
    quality.lines = get("LN", quality.lines as f32) as u32;
    quality.neck_lines = get("NL", quality.neck_lines as f32) as u32;
    quality.gather_rays = get("GR", quality.gather_rays as f32) as u32;
    quality.gather_neck_rays = get("GN", quality.gather_neck_rays as f32) as u32;
    quality.shadow_rays = get("SR", quality.shadow_rays as f32) as u32;
    let network = Network::new(model, &quality, settings, progress, cancel)?;
    gather::gather(&network, &quality, probes, settings, progress, cancel)
}

/// What a network stands on.
pub struct Grounds<'a> {
    /// What was modelled of the scene.
    pub model: &'a Model,
    /// The parts of its void.
    pub zones: Zones,
    /// What they see.
    pub patches: Patches,
    /// The necks between its cells.
    pub portals: Vec<Portal>,
    /// The longest way across the grid, metres.
    pub farthest_m: f32,
}

impl<'a> Grounds<'a> {
    /// Zones, patches and necks of a model.
    pub fn new(model: &'a Model, quality: &Quality, seed: u64) -> Self {
        let zones = Zones::new(model, quality.spacing);
        let patches = Patches::new(model, &zones, quality, seed);
        let portals = model.skeleton.necks.iter().filter_map(Portal::new).collect();
        let lattice = &model.voxels.lattice;
        let farthest_m = lattice.voxel_m * Vec3::from_array(lattice.size.map(|along| along as f32)).length();
        Self { model, zones, patches, portals, farthest_m }
    }

    /// The patch of a place on a wall that a ray of that length came to along `direction`.
    fn patch_at(&self, at: &Start, direction: Vec3, length_m: f32) -> Option<u32> {
        self.patches.at(self.model, &self.zones, at, direction, length_m)
    }
}

/// The light of a scene on its patches.
pub struct Network<'a> {
    /// What it stands on.
    pub grounds: Grounds<'a>,
    /// What each patch sees of each other.
    pub exchange: Exchange,
    /// What lands straight from each emitter.
    pub landings: Vec<Landing>,
    /// For each emitter, or for all together where no shares are asked for, the irradiance on each patch by light that was
    /// reflected at least once, W/m2.
    pub reflected_w_m2: Vec<Vec<f64>>,
    /// The same for all together by either half of the lines and by a coarser network: what the error is judged by.
    variants_w_m2: [Vec<f64>; 3],
}

impl<'a> Network<'a> {
    /// Measures and solves the network of a model. Costs the rays that `quality` says, some microseconds each.
    ///
    /// # Errors
    /// [`Cancelled`] when `cancel` was raised.
    pub fn new(
        model: &'a Model,
        quality: &Quality,
        settings: &Settings,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        progress.begin("zones", 0);
        let grounds = Grounds::new(model, quality, settings.seed);
        progress.end();
        cancel.check()?;

        progress.begin("lines", 0);
        let lines = lines::lines(&grounds, quality, settings.seed);
        eprintln!(
            "zones {} patches {} starts {} lines {}",
            grounds.zones.count,
            grounds.patches.list.len(),
            grounds.patches.starts.len(),
            lines.len()
        );
        let patches = grounds.patches.list.len();
        let [exchange, odd, even] =
            [Half::Both, Half::Odd, Half::Even].map(|half| Exchange::new(patches, &lines, half, |patch| patch));
        progress.end();
        cancel.check()?;

        progress.begin("landing", 0);
        let landings: Vec<Landing> =
            model.shining.iter().map(|shining| landing(&grounds, quality, shining, settings.seed)).collect();
        progress.end();
        cancel.check()?;

        progress.begin("balance", 0);
        let reflectances: Vec<f64> = grounds.patches.list.iter().map(|patch| patch.reflectance).collect();
        let mut all_w = vec![0.0; patches];
        for landing in &landings {
            all_w.iter_mut().zip(&landing.reflected_w).for_each(|(sum, part)| *sum += part);
        }
        let each_w = || landings.iter().map(|landing| landing.reflected_w.clone()).collect();
        let columns_w: Vec<Vec<f64>> = if settings.shares { each_w() } else { vec![all_w.clone()] };
        let reflected_w_m2 = balance::reflected_w_m2(&exchange, &reflectances, &columns_w);
        let by = |exchange: &Exchange| {
            balance::reflected_w_m2(exchange, &reflectances, std::slice::from_ref(&all_w)).pop().unwrap_or_default()
        };
        let coarse = coarser(&grounds, &lines, &reflectances, &all_w);
        let variants_w_m2 = [by(&odd), by(&even), coarse];
        if std::env::var("DUMP").is_ok() {
            for (k, p) in grounds.patches.list.iter().enumerate() {
                let st = &grounds.patches.starts[p.starts.clone()];
                let lo = st.iter().fold(Vec3::INFINITY, |a, s| a.min(s.position_m));
                let hi = st.iter().fold(Vec3::NEG_INFINITY, |a, s| a.max(s.position_m));
                let cell = grounds.zones.groups().find(|(r, _)| r.contains(&p.zone)).map(|(_, c)| c);
                eprintln!(
                    "P {k} cell {cell:?} zone {} lo {lo:.2} hi {hi:.2} A {:.3} D {:.3} rho {:.2} E0 {:.4} Er {:.4} n {}",
                    p.zone,
                    p.area_m2,
                    exchange.seen_m2[k],
                    p.reflectance,
                    landings.iter().map(|l| l.flux_w[k]).sum::<f64>() / p.area_m2,
                    reflected_w_m2.iter().map(|c| c[k]).sum::<f64>(),
                    st.len()
                );
            }
        }
        progress.end();
        Ok(Self { grounds, exchange, landings, reflected_w_m2, variants_w_m2 })
    }
}

/// The reflected irradiance on each patch by a network whose zones see all around with one patch.
fn coarser(grounds: &Grounds, lines: &[lines::Line], reflectances: &[f64], landed_w: &[f64]) -> Vec<f64> {
    let zone = |patch: u32| grounds.patches.list[patch as usize].zone;
    let zones = grounds.zones.count;
    let exchange = Exchange::new(zones, lines, Half::Both, zone);
    let (mut area_m2, mut reflecting_m2, mut zone_w) = (vec![0.0; zones], vec![0.0; zones], vec![0.0; zones]);
    for ((patch, reflectance), landed_w) in grounds.patches.list.iter().zip(reflectances).zip(landed_w) {
        let zone = patch.zone as usize;
        area_m2[zone] += patch.area_m2;
        reflecting_m2[zone] += patch.area_m2 * reflectance;
        zone_w[zone] += landed_w;
    }
    let mean = |(reflecting, area): (&f64, &f64)| if *area > 0.0 { reflecting / area } else { 0.0 };
    let reflectances: Vec<f64> = reflecting_m2.iter().zip(&area_m2).map(mean).collect();
    let solved = balance::reflected_w_m2(&exchange, &reflectances, &[zone_w]).pop().unwrap_or_default();
    grounds.patches.list.iter().map(|patch| solved.get(patch.zone as usize).copied().unwrap_or(0.0)).collect()
}
