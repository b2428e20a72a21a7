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
pub mod reach;
pub mod reading;
pub mod resistances;
pub mod surroundings;
pub mod views;

use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Reading, Settings, Shares};
use crate::model::{Model, Probe};
use circuit::Circuit;
use photons::Landed;
use rayon::prelude::*;
use reading::{Diffuse, Lit};
use surroundings::Surroundings;

/// Below this mean reflectance the field is a preview.
pub const LEAST_REFLECTANCE: f64 = 0.7;

/// The qualities: bounces that rays carry before the rest is taken for diffuse.
pub const BOUNCES: [u32; 4] = [0, 1, 2, 4];

/// Up to so many lights are solved one by one, whether their shares are asked for or not, for the same bits.
const FEW_LIGHTS: usize = 16;

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
    let diffuse = diffused(&circuit, &landed, probes, settings.shares);
    progress.end();
    cancel.check()?;

    progress.begin("probes", probes.len() as u64);
    let (shares, seed) = (settings.shares, settings.seed);
    let lit = Lit { model, circuit: &circuit, landed: &landed, diffuse: &diffuse, shares, seed };
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

/// The diffuse light of each emitter, or, where they are many and nobody asks for their shares, of all together.
fn diffused(circuit: &Circuit, landed: &[Landed], probes: &[Probe], shares: bool) -> Vec<Diffuse> {
    let mut asked = vec![false; circuit.part.len()];
    let nodes = probes.iter().filter_map(|probe| probe.place.ok());
    nodes.filter_map(|node| asked.get_mut(node.index()).map(|asked| *asked = true)).for_each(drop);
    let lights = landed.len();
    let at_once = if shares || lights <= FEW_LIGHTS { 1 } else { lights };
    let groups: Vec<_> = (0..lights).step_by(at_once).map(|first| first..first + at_once).collect();
    let diffuse = |lights: std::ops::Range<usize>| {
        let spread = circuit.spread(&sources_w(circuit, &landed[lights.clone()]));
        let flux_w_m2 = circuit.flux_w_m2(&spread, &asked);
        Diffuse { lights, spread, flux_w_m2 }
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

/// What a reader of the field should know.
fn warnings(model: &Model, circuit: &Circuit, around: &Surroundings) -> Vec<String> {
    let mut is_lit = vec![false; circuit.has_loss.len()];
    let places = model.shining.iter().filter_map(|light| circuit.part.get(light.place.ok()?.index()));
    places.for_each(|&part| is_lit[part as usize] = true);
    let (mut wall_m2, mut reflecting_m2) = (0.0, 0.0);
    for (node, _) in circuit.part.iter().enumerate().filter(|(_, part)| is_lit[**part as usize]) {
        wall_m2 += around.wall_m2[node];
        reflecting_m2 += around.reflecting_m2[node];
    }

    let mut warnings = Vec::new();
    if wall_m2 > 0.0 && reflecting_m2 / wall_m2 < LEAST_REFLECTANCE {
        warnings.push(format!(
            "a mean reflectance of {:.2}: below {LEAST_REFLECTANCE} light does not spread by diffusion, and this is a preview",
            reflecting_m2 / wall_m2
        ));
    }
    if is_lit.iter().zip(&circuit.has_loss).any(|(is_lit, has_loss)| *is_lit && !has_loss) {
        let says =
            "a void that is closed and absorbs nothing has no steady light: its walls are taken to absorb a millionth";
        warnings.push(says.to_owned());
    }
    warnings
}

#[cfg(test)]
mod tests;
