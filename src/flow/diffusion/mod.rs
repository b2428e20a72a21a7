//! How much light reaches a point, if light spreads through the veins as a current does through resistors?
//!
//! Direct light is exact, by shadow rays. What walls send back after that is taken for diffuse: it flows along the skeleton
//! against resistances of known section, mean free path and length, leaks into the walls and out of the openings
//! ([`circuit`]), and one exact elimination gives it at every node ([`eliminate`]). Where the direct light lands is found by
//! a few thousand rays from the lights ([`photons`]); the estimate itself casts none. A higher quality lets those rays carry
//! the light on for some bounces more before it is taken for diffuse, which it then is with better right.
//!
//! Limits: in dark rooms light does not spread by diffusion: through long dark runs it falls too fast, by orders of
//! magnitude. Below a mean reflectance of [`LEAST_REFLECTANCE`] the field is a preview and says so. Across a room the
//! diffuse part has one value; a pane hinders it where the curve passes through the pane, not within a room of one node.

pub mod circuit;
pub mod eliminate;
pub mod lamps;
pub mod photons;
pub mod surroundings;
pub mod views;

use super::direct::{Direct, direct};
use super::sequence::{self, SPHERE_SR};
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Reading, Settings, Shares, Status};
use crate::model::{Model, Probe};
use circuit::{Circuit, Spread};
use glam::DVec3;
use petgraph::graph::NodeIndex;
use photons::Landed;
use rayon::prelude::*;
use surroundings::Surroundings;

/// Below this mean reflectance the field is a preview.
pub const LEAST_REFLECTANCE: f64 = 0.7;

/// The qualities: bounces that rays carry before the rest is taken for diffuse.
pub const BOUNCES: [u32; 4] = [0, 1, 2, 4];

/// Error of the diffuse part where both forms of diffusion agree, as a share of it: rooms are not uniform.
const MODEL_ERROR: f64 = 0.2;

/// Shadow rays to a light that has a size.
const SHADOW_RAYS: u32 = 16;

/// Irradiance at the probes by diffusion alone, no bounce carried by rays.
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
    carried(0, model, probes, settings, progress, cancel)
}

/// Irradiance at the probes, `bounces` reflections carried by rays and the rest by diffusion.
///
/// Costs a few milliseconds for the walls and rays of a house, then a shadow ray a light for each probe, and some hundred a
/// bounce.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn carried(
    bounces: u32,
    model: &Model,
    probes: &[Probe],
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Field, Cancelled> {
    progress.begin("circuit", 0);
    let around = Surroundings::of(model);
    let circuit = Circuit::new(model, &around);
    progress.end();
    cancel.check()?;

    progress.begin("lights", 0);
    let landed = photons::landed(model, bounces, settings.seed, cancel)?;
    let diffuse = diffused(model, &circuit, &landed, settings.shares);
    progress.end();

    progress.begin("probes", probes.len() as u64);
    let lit = Lit { model, circuit: &circuit, landed: &landed, diffuse: &diffuse, seed: settings.seed };
    let rows = probes.par_iter().enumerate().map(|(number, probe)| {
        cancel.check()?;
        progress.advance(1);
        Ok(lit.read(number, probe))
    });
    let rows: Vec<(Reading, Vec<f64>)> = rows.collect::<Result<_, Cancelled>>()?;
    progress.end();

    let (readings, shares): (Vec<Reading>, Vec<Vec<f64>>) = rows.into_iter().unzip();
    let emitters = model.sources.emitters.len();
    let shares = settings.shares.then(|| Shares { emitters, values_w_m2: shares.concat() });
    Ok(Field { readings, warnings: warnings(model, &circuit, &around), shares })
}

/// The diffuse light of some emitters.
struct Diffuse {
    /// Their numbers in [`Model::shining`].
    lights: std::ops::Range<usize>,
    spread: Spread,
}

/// The diffuse light of each emitter, or, where nobody asks for their shares, of all together.
fn diffused(model: &Model, circuit: &Circuit, landed: &[Landed], shares: bool) -> Vec<Diffuse> {
    let lights = model.shining.len();
    let groups: Vec<_> = if shares { (0..lights).map(|light| light..light + 1).collect() } else { vec![0..lights] };
    let diffuse = |lights: std::ops::Range<usize>| {
        let sources_w = sources_w(circuit, &landed[lights.clone()]);
        Diffuse { lights, spread: circuit.spread(&model.skeleton, &sources_w) }
    };
    groups.into_par_iter().map(diffuse).collect()
}

/// What walls send out for the circuit to spread, by node, W.
fn sources_w(circuit: &Circuit, landed: &[Landed]) -> Vec<f64> {
    let mut sources_w = vec![0.0; circuit.part.len()];
    for &(node, flux_w) in landed.iter().flat_map(|landed| &landed.sources) {
        sources_w[node as usize] += flux_w;
    }
    sources_w
}

/// All light, ready to be read.
struct Lit<'a> {
    model: &'a Model,
    circuit: &'a Circuit,
    landed: &'a [Landed],
    diffuse: &'a [Diffuse],
    seed: u64,
}

impl Lit<'_> {
    /// The reading of a probe, and what each emitter has in it where the emitters were kept apart.
    fn read(&self, number: usize, probe: &Probe) -> (Reading, Vec<f64>) {
        let mut shares = vec![0.0; self.model.sources.emitters.len()];
        let node = match probe.place {
            Ok(node) => node,
            Err(status) => return (Reading::none(status), shares),
        };
        let part = |node: NodeIndex| self.circuit.part.get(node.index());
        let mut reading = Reading::none(Status::Unreached);
        let (mut diffuse_w_m2, mut noise_w_m4, mut textbook_w_m2) = (0.0, 0.0, 0.0);
        for diffuse in self.diffuse {
            let mut reached = false;
            let mut sum = (0.0, DVec3::ZERO);
            for light in diffuse.lights.clone() {
                let shining = &self.model.shining[light];
                if shining.place.is_ok_and(|place| part(place) == part(node)) {
                    reached = true;
                    let (straight, carried, noise_w_m2) = self.on_rays(number, probe, node, light);
                    sum.0 += straight.value_w_m2 + carried.value_w_m2;
                    sum.1 += straight.flux_w_m2 + carried.flux_w_m2;
                    noise_w_m4 += noise_w_m2 * noise_w_m2;
                }
            }
            if !reached {
                continue;
            }
            let (spread_w_m2, flux_w_m2, other_w_m2) = self.diffuse(probe, node, &diffuse.spread);
            let value_w_m2 = sum.0 + spread_w_m2;
            reading.status = Status::Ok;
            reading.value_w_m2 += value_w_m2;
            reading.flux_w_m2 += sum.1 + flux_w_m2;
            diffuse_w_m2 += spread_w_m2;
            textbook_w_m2 += other_w_m2;
            if let [light] = diffuse.lights.clone().collect::<Vec<_>>()[..] {
                shares[self.model.shining[light].emitter] += value_w_m2;
            }
        }
        if reading.status == Status::Ok {
            let error_w_m2 = (MODEL_ERROR * diffuse_w_m2).hypot(noise_w_m4.sqrt()).hypot(textbook_w_m2);
            reading.error_w_m2 = Some(error_w_m2);
        }
        if reading.status == Status::Ok && reading.value_w_m2 == 0.0 {
            reading.status = Status::Dark;
        }
        (reading, shares)
    }

    /// What an emitter gives straight, and by the bounces that rays carried: and the noise of that.
    fn on_rays(&self, number: usize, probe: &Probe, node: NodeIndex, light: usize) -> (Direct, Direct, f64) {
        let lift_m = probe.normal.map_or(glam::Vec3::ZERO, |normal| 2.0 * self.model.rays.epsilon_m() * normal);
        let at_m = probe.position_m + lift_m;
        let emitter = self.model.shining[light].emitter;
        let offset = sequence::offset(self.seed, (emitter as u64) << 40 | number as u64);
        let straight = direct(self.model, at_m, probe.normal, emitter, SHADOW_RAYS, offset);
        let cell = self.cell(node);
        let next = self.circuit.cells_beside(&self.model.skeleton, cell);
        let lamps = &self.landed[light].lamps;
        let (carried, noise_w_m2) = lamps::gathered(self.model, probe, at_m, lamps, cell, &next, offset[0]);
        (straight, carried, noise_w_m2)
    }

    fn cell(&self, node: NodeIndex) -> u32 {
        self.model.skeleton.graph.node_weight(node).map_or(0, |node| node.cell)
    }

    /// What diffuse light gives: value, net flux, and what the textbook's diffusion adds to the value, W/m2.
    fn diffuse(&self, probe: &Probe, node: NodeIndex, spread: &Spread) -> (f64, DVec3, f64) {
        let skeleton = &self.model.skeleton;
        let at = |by_node: &[f64]| by_node.get(node.index()).copied().unwrap_or(0.0);
        let (phi, other) = (at(&spread.potentials_w_m2), at(&spread.textbook_w_m2));
        let mut flux = self.circuit.flux_w_m2(skeleton, node.index() as u32, spread);
        let normal = probe.normal.map(|normal| normal.as_dvec3());
        let (mut value, mut more) = match normal {
            None => (phi, other - phi),
            Some(normal) => (0.25 * phi + 0.5 * normal.dot(flux), 0.25 * (other - phi)),
        };

        let cell = self.cell(node);
        for &neck in self.circuit.necks_of.get(cell as usize).into_iter().flatten() {
            let (opening, sides) = (&skeleton.necks[neck as usize], &self.circuit.necks[neck as usize]);
            let side = usize::from(opening.cells[0] != cell);
            let Some(view) = views::view(self.model, opening, side, probe.position_m) else { continue };
            let radiance = sides.rise_w_m2(side, &spread.brightness_w_m2) / SPHERE_SR;
            let seen = normal.map_or(view.solid_angle_sr, |normal| normal.dot(view.flux).max(0.0));
            value += radiance * seen;
            flux += radiance * view.flux;
            more += sides.rise_w_m2(side, &spread.textbook_w_m2) / SPHERE_SR * seen - radiance * seen;
        }
        (value.max(0.0), flux, more)
    }
}

/// What a reader of the field should know.
fn warnings(model: &Model, circuit: &Circuit, around: &Surroundings) -> Vec<String> {
    let mut warnings = Vec::new();
    let lit: Vec<u32> = model
        .shining
        .iter()
        .filter_map(|light| light.place.ok())
        .filter_map(|place| circuit.part.get(place.index()).copied())
        .collect();
    let (mut wall_m2, mut reflecting_m2) = (0.0, 0.0);
    for (node, part) in circuit.part.iter().enumerate().filter(|(_, part)| lit.contains(part)) {
        let _ = part;
        wall_m2 += around.wall_m2[node];
        reflecting_m2 += around.reflecting_m2[node];
    }
    let reflectance = if wall_m2 > 0.0 { reflecting_m2 / wall_m2 } else { 0.0 };
    if !lit.is_empty() && reflectance < LEAST_REFLECTANCE {
        warnings.push(format!(
            "a mean reflectance of {reflectance:.2}: below {LEAST_REFLECTANCE} the diffusion of light is a preview, too dark by orders \
             of magnitude at the end of long runs"
        ));
    }
    if lit.iter().any(|&part| !circuit.has_loss[part as usize]) {
        warnings.push(
            "a void that is closed and absorbs nothing has no steady light: only what rays carry is counted there"
                .to_owned(),
        );
    }
    warnings
}

#[cfg(test)]
mod tests;
