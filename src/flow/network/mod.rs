//! How much light reaches a point by any number of reflections, by exchange among patches of wall.
//!
//! Steps, each in its file: the void is parted into [zones] that never cross a neck; what a zone sees in one direction is a
//! [patch](patches); [lines] from patches and through [necks](portals) measure what each patch sees of each other; light
//! [lands](mod@landing) straight from its sources; the [balance] of all reflections is one sparse system; a sensor
//! [gathers](mod@gather) it by rays over its sphere and through the necks of its room, beside the exact direct light; or
//! the zones are [read](mod@read) without a ray more, for many thousands of points. Oriented patches are the poster's own
//! next step, "an oriented reflectivity a node" (Chaussard, Biri, Couprie); the balance is radiosity (Goral et al. 1984)
//! with lines in place of form factors (Sbert 1993), weighed by the balance heuristic (Veach & Guibas 1995).
//!
//! Own error estimate, [`Reading::error_w_m2`](crate::light::Reading::error_w_m2): the same answer from either half of the
//! lines, from a coarser network on the same lines, and from either half of the gathering rays.
//!
//! Limits: radiosity is the same all over a patch but for the light that lands on it straight; openings that the voxels close
//! let no reflected light through; walls are Lambertian.

pub mod balance;
pub mod exchange;
pub mod gather;
pub mod landing;
pub mod lines;
pub mod patches;
pub mod portals;
pub mod read;
pub mod walk;
pub mod zones;

use crate::flow::Estimator;
use crate::flow::direct::{Direct, direct};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Reading, Settings, Shares, Status};
use crate::model::{Model, Probe, Shining};
use exchange::{Exchange, Half};
use glam::Vec3;
use landing::{Landing, landing};
use lines::Line;
use patches::{Patches, Start};
use petgraph::graph::NodeIndex;
use portals::Portal;
use rayon::prelude::*;
use read::Tracks;
use zones::Zones;

/// Told where light never ends.
const NOTHING_ABSORBS: &str = "the walls of a void absorb nothing: their light has no balance, and stands for a reflectance \
                               of 0.999999";

/// How finely a network is made and asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// Length of a zone, in widths of the void there.
    pub spacing: f32,
    /// Lines from a patch.
    pub lines: u32,
    /// Lines from all patches: where these are few, each sends more, up to [`MOST_TIMES_LINES`] times as many.
    pub all_lines: u32,
    /// Lines through a neck.
    pub neck_lines: u32,
    /// Photons of all lights together.
    pub photons: u32,
    /// Shadow rays from a patch to a light.
    pub shadow_rays: u32,
    /// Rays by which sensors gather; `None` to read the zones.
    pub gather: Option<Gather>,
}

/// How many times as many lines a patch sends where patches are few: more would only sharpen what the patch blurs.
pub const MOST_TIMES_LINES: u32 = 4;

/// The rays of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gather {
    /// Over all it sees.
    pub rays: u32,
    /// To each neck of its room.
    pub neck_rays: u32,
}

impl Quality {
    /// Large zones, few lines.
    pub const COARSE: Self = Self {
        spacing: 0.8,
        lines: 8,
        all_lines: 4096,
        neck_lines: 256,
        photons: 2048,
        shadow_rays: 8,
        gather: Some(Gather { rays: 128, neck_rays: 32 }),
    };

    /// The default.
    pub const MEDIUM: Self = Self {
        spacing: 0.4,
        lines: 20,
        all_lines: 42_000,
        neck_lines: 1024,
        photons: 4096,
        shadow_rays: 16,
        gather: Some(Gather { rays: 768, neck_rays: 192 }),
    };

    /// Small zones, many lines.
    pub const FINE: Self = Self {
        spacing: 0.28,
        lines: 48,
        all_lines: 200_000,
        neck_lines: 4096,
        photons: 32_768,
        shadow_rays: 32,
        gather: Some(Gather { rays: 4096, neck_rays: 512 }),
    };

    /// The same network, read at its zones.
    pub const fn read(self) -> Self {
        Self { gather: None, ..self }
    }
}

/// The qualities, the cheapest first, with their names.
pub const LADDER: [(&str, Quality); 4] =
    [("coarse", Quality::COARSE), ("read", Quality::MEDIUM.read()), ("", Quality::MEDIUM), ("fine", Quality::FINE)];

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
    let (network, lines) = Network::new(model, &quality, settings, progress, cancel)?;
    match &quality.gather {
        Some(gather) => gather::gather(&network, gather, probes, settings, progress, cancel),
        None => {
            let tracks = network.tracks(&lines, settings);
            read::read(&network, &tracks, probes, settings, progress, cancel)
        }
    }
}

/// One network asked twice: gathered at the probes where the answer is to be right, and read at its zones at those that are
/// many. As much as [`with`] gives for each, for the price of one network.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn gathered_and_read(
    quality: &Quality,
    model: &Model,
    [gathered, read]: [&[Probe]; 2],
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<[Field; 2], Cancelled> {
    let (network, lines) = Network::new(model, quality, settings, progress, cancel)?;
    let tracks = network.tracks(&lines, settings);
    let many = read::read(&network, &tracks, read, settings, progress, cancel)?;
    let few = match &quality.gather {
        Some(gather) => gather::gather(&network, gather, gathered, settings, progress, cancel)?,
        None => read::read(&network, &tracks, gathered, settings, progress, cancel)?,
    };
    Ok([few, many])
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

    /// The same with a patch for every wall of a cell that has any ([`Patches::fill_gaps`]).
    pub fn filled(mut self) -> Self {
        self.patches.fill_gaps(&self.zones);
        self
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
    /// For each node whether a path through the void joins it to a light.
    lit: Vec<bool>,
    /// What a reader of its fields should know.
    warnings: Vec<String>,
}

impl<'a> Network<'a> {
    /// Measures and solves the network of a model; the lines that it stands on beside it. Costs the rays that `quality` says,
    /// some microseconds each.
    ///
    /// # Errors
    /// [`Cancelled`] when `cancel` was raised.
    pub fn new(
        model: &'a Model,
        quality: &Quality,
        settings: &Settings,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<(Self, Vec<Line>), Cancelled> {
        let of_lamps = |grounds: &Grounds| {
            let promised = landing::promised(grounds);
            let of = |shining| landing(grounds, quality, shining, &promised, settings.seed);
            Ok(model.shining.iter().map(of).collect())
        };
        progress.begin("zones", 0);
        let grounds = Grounds::new(model, quality, settings.seed);
        progress.end();
        cancel.check()?;
        Self::lit_by(grounds, quality, settings, &of_lamps, progress, cancel)
    }

    /// The same for light from elsewhere: `land` says what lands straight on each patch, a landing a source. The unit is the
    /// caller's: energies for fluxes, W, give energies per area for irradiances, W/m2.
    ///
    /// # Errors
    /// [`Cancelled`] when `cancel` was raised.
    pub fn lit_by(
        grounds: Grounds<'a>,
        quality: &Quality,
        settings: &Settings,
        land: &dyn Fn(&Grounds) -> Result<Vec<Landing>, Cancelled>,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<(Self, Vec<Line>), Cancelled> {
        progress.begin("lines", 0);
        let lines = lines::lines(&grounds, quality, settings.seed);
        let patches = grounds.patches.list.len();
        let halves = [Half::Both, Half::Odd, Half::Even];
        let of_half = |half: Half| Exchange::new(patches, &lines, half, |patch| patch);
        let exchanges: Vec<Exchange> = halves.into_par_iter().map(of_half).collect();
        progress.end();
        cancel.check()?;

        progress.begin("landing", 0);
        let landings = land(&grounds)?;
        progress.end();
        cancel.check()?;

        progress.begin("balance", 0);
        let reflectances: Vec<f64> = grounds.patches.list.iter().map(|patch| patch.reflectance).collect();
        let mut all_w = vec![0.0; patches];
        for landing in &landings {
            all_w.iter_mut().zip(&landing.reflected_w).for_each(|(sum, part)| *sum += part);
        }
        let each_w = || landings.iter().map(|landing| landing.reflected_w.clone()).collect();
        let by = |exchange: &Exchange| {
            balance::reflected_w_m2(exchange, &reflectances, std::slice::from_ref(&all_w)).pop().unwrap_or_default()
        };
        let columns_w: Vec<Vec<f64>> = if settings.shares { each_w() } else { vec![all_w.clone()] };
        let ((reflected_w_m2, odd), (even, coarse)) = rayon::join(
            || (balance::reflected_w_m2(&exchanges[0], &reflectances, &columns_w), by(&exchanges[1])),
            || (by(&exchanges[2]), coarser(&grounds, &lines, &reflectances, &all_w)),
        );
        let exchange = exchanges.into_iter().next().unwrap_or_default();
        let variants_w_m2 = [odd, even, coarse];
        progress.end();
        let lit = lit(grounds.model);
        let warnings = balance::without_end(&exchange, &reflectances, &all_w).then(|| NOTHING_ABSORBS.to_owned());
        let warnings = warnings.into_iter().collect();
        Ok((Self { grounds, exchange, landings, reflected_w_m2, variants_w_m2, lit, warnings }, lines))
    }

    /// The diffuse field in the zones, by the lines that the network stands on; the variants after the columns.
    pub fn tracks(&self, lines: &[Line], settings: &Settings) -> Tracks {
        let patches = &self.grounds.patches.list;
        let radiosity = |reflected_w_m2: &Vec<f64>, landed_w: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let of = |(number, patch): (usize, &patches::Patch)| {
                landed_w(number) / patch.area_m2 + patch.reflectance * reflected_w_m2[number]
            };
            patches.iter().enumerate().map(of).collect()
        };
        let all = |patch: usize| self.landings.iter().map(|landing| landing.reflected_w[patch]).sum::<f64>();
        let each = self.reflected_w_m2.len() == self.landings.len();
        let columns = self.reflected_w_m2.iter().enumerate().map(|(column, reflected_w_m2)| match each {
            true => radiosity(reflected_w_m2, &|patch| self.landings[column].reflected_w[patch]),
            false => radiosity(reflected_w_m2, &all),
        });
        let variants = self.variants_w_m2.iter().map(|variant| radiosity(variant, &all));
        let radiosity_w_m2: Vec<Vec<f64>> = columns.chain(variants).collect();
        Tracks::new(&self.grounds, lines, &radiosity_w_m2, self.reflected_w_m2.len(), settings.seed)
    }

    /// The lights that shine into the void.
    pub fn lamps(&self) -> impl Iterator<Item = &Shining> {
        self.grounds.model.shining.iter().filter(|shining| shining.place.is_ok() && shining.flux_w > 0.0)
    }

    /// What comes straight from the lights to a probe, and of it the part of each emitter, W/m2. `rays` go to each light that
    /// has a body.
    fn straight(&self, probe: &Probe, rays: u32, offset: [f64; 2]) -> (Direct, Vec<f64>) {
        let model = self.grounds.model;
        let from_m = probe.position_m + probe.normal.unwrap_or(Vec3::ZERO) * model.rays.epsilon_m();
        let (mut sum, mut row) = (Direct::default(), vec![0.0; model.shining.len()]);
        for shining in self.lamps() {
            let of_lamp = direct(model, from_m, probe.normal, shining.emitter, rays, offset);
            sum.value_w_m2 += of_lamp.value_w_m2;
            sum.flux_w_m2 += of_lamp.flux_w_m2;
            row[shining.emitter] += of_lamp.value_w_m2;
        }
        (sum, row)
    }

    /// What a reader of its fields should know, a sentence each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The field of readings that each have a row of shares.
    fn field(&self, answers: Vec<(Reading, Vec<f64>)>, settings: &Settings) -> Field {
        let (readings, rows): (Vec<Reading>, Vec<Vec<f64>>) = answers.into_iter().unzip();
        let emitters = self.grounds.model.shining.len();
        let shares = settings.shares.then(|| Shares { emitters, values_w_m2: rows.concat() });
        Field { readings, warnings: self.warnings.clone(), shares }
    }

    /// What became of a sensor at that node with that value.
    fn status(&self, node: NodeIndex, value_w_m2: f64) -> Status {
        match self.lit.get(node.index()) {
            _ if value_w_m2 > 0.0 => Status::Ok,
            Some(true) => Status::Dark,
            _ => Status::Unreached,
        }
    }
}

/// For each node whether it hangs together with that of a light.
fn lit(model: &Model) -> Vec<bool> {
    let graph = &model.skeleton.graph;
    let mut lit = vec![false; graph.node_count()];
    let mut open: Vec<NodeIndex> = model.shining.iter().filter_map(|shining| shining.place.ok()).collect();
    while let Some(node) = open.pop() {
        if lit.get(node.index()) == Some(&false) {
            lit[node.index()] = true;
            open.extend(graph.neighbors(node));
        }
    }
    lit
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
