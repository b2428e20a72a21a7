//! How much light reaches a point, by the skeleton: the estimators, one a file.
//!
//! Every estimator has the shape of [`Estimator`]: it is asked at [`Probe`]s (sensors, nodes, faces of the mesh) and gives
//! a [`Field`] in their order. The built-in set is [`Method`]; a closure of the same shape runs wherever these do.
//! What the two heuristics of the poster (Chaussard, Biri, Couprie, "Coarse irradiance estimation using curvilinear
//! skeleton") share is [`add_lights`]: a shortest-path tree for each light, an [`Arrival`] for each probe, and their sum.

pub mod backward;
pub mod diffusion;
pub mod direct;
pub mod forward;
pub mod network;
pub mod paths;
pub mod sequence;
pub mod solve;
pub mod veins;

use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Reading, Settings, Status};
use crate::model::{Model, Probe, Shining};
use crate::scene::Method;
use paths::PathTree;
use petgraph::graph::NodeIndex;
use rayon::prelude::*;
use std::f64::consts::PI;

/// The shape of every estimator, built-in or a user's own: what it is asked at, and the field it gives in that order.
pub type Estimator<'a> =
    dyn Fn(&Model, &[Probe], &Settings, &dyn Progress, &Cancel) -> Result<Field, Cancelled> + Sync + 'a;

/// The built-in estimator of that name; `None` for the path tracer, which is not one.
pub fn estimator(method: Method) -> Option<&'static Estimator<'static>> {
    match method {
        Method::Backward => Some(&backward::estimate),
        Method::Forward => Some(&forward::estimate),
        Method::Diffusion => Some(&diffusion::estimate),
        Method::Network => Some(&network::estimate),
        Method::Trace => None,
    }
}

/// One quality of a method.
pub struct Rung {
    /// The method it is of.
    pub method: Method,
    /// What is set, for tables and charts: `coarse`, `2 bounces`; empty for a method that has one quality.
    pub quality: String,
    /// The estimator at that quality.
    pub estimate: Box<Estimator<'static>>,
}

impl Rung {
    /// Method and quality: `network coarse`.
    pub fn label(&self) -> String {
        format!("{} {}", self.method, self.quality).trim_end().to_owned()
    }
}

/// The qualities of a method, the cheapest first; none for the path tracer, which is no estimator.
pub fn ladder(method: Method) -> Vec<Rung> {
    let one = |estimate: Box<Estimator<'static>>| vec![Rung { method, quality: String::new(), estimate }];
    match method {
        Method::Backward => one(Box::new(backward::estimate)),
        Method::Forward => one(Box::new(forward::estimate)),
        Method::Diffusion => diffusion::BOUNCES.map(by_diffusion).into(),
        Method::Network => {
            let rung = |(quality, how): (&str, network::Quality)| Rung {
                method,
                quality: quality.to_owned(),
                estimate: network::with(how),
            };
            network::LADDER.map(rung).into()
        }
        Method::Trace => Vec::new(),
    }
}

/// Diffusion after so many bounces.
fn by_diffusion(bounces: u32) -> Rung {
    let quality = format!("{bounces} bounce{}", if bounces == 1 { "" } else { "s" });
    let estimate: Box<Estimator<'static>> = Box::new(move |model, probes, settings, progress, cancel| {
        diffusion::carried(bounces, model, probes, settings, progress, cancel)
    });
    Rung { method: Method::Diffusion, quality, estimate }
}

/// One light and the ways from it.
pub struct Lit<'a> {
    /// What was modelled of the scene.
    pub model: &'a Model,
    /// The light.
    pub light: &'a Shining,
    /// Shortest paths from the light's node.
    pub tree: &'a PathTree,
}

/// What one light gives at one point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Arrival {
    /// Irradiance on a surface that faces `towards`, or scalar irradiance, W/m2.
    pub irradiance_w_m2: f64,
    /// Where it comes from: unit length, pointing away from the probe.
    pub towards: glam::DVec3,
}

/// What a heuristic gives for one light: the answer at a probe that the light's tree reaches, given the probe's node.
pub type AtProbe<'a> = Box<dyn Fn(&Probe, NodeIndex) -> Arrival + Sync + 'a>;

/// Lights whose path trees are held at the same time; bounds the memory at 16 trees of 20 bytes a node.
const LIGHTS_AT_ONCE: usize = 16;

/// Sums a heuristic over all lights: `heuristic` is called once a light and gives what answers at each probe.
///
/// At a probe with a normal an arrival counts by its cosine. Lights add in their order, so the bits are the same for any
/// number of threads. A probe without a node keeps its own status, one that no light's tree reaches is `Unreached`, one
/// that is reached and gets nothing is `Dark`. Arrivals that are negative or not finite count as nothing and are warned of.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn add_lights(
    model: &Model,
    probes: &[Probe],
    progress: &dyn Progress,
    cancel: &Cancel,
    heuristic: impl for<'a> Fn(&'a Lit<'a>) -> AtProbe<'a> + Sync,
) -> Result<Field, Cancelled> {
    let unlit = |probe: &Probe| Reading::none(probe.place.err().unwrap_or(Status::Unreached));
    let mut readings: Vec<Reading> = probes.iter().map(unlit).collect();
    let mut refused = 0_usize;

    progress.begin("lights", model.shining.len() as u64);
    for some_lights in model.shining.chunks(LIGHTS_AT_ONCE) {
        cancel.check()?;
        let tree = |light: &Shining| light.place.ok().map(|root| PathTree::from(&model.skeleton, root));
        let trees: Vec<Option<PathTree>> = some_lights.par_iter().map(tree).collect();

        for (light, tree) in some_lights.iter().zip(&trees) {
            cancel.check()?;
            if let Some(tree) = tree {
                let lit = Lit { model, light, tree };
                let at_probe = heuristic(&lit);
                let added =
                    readings.par_iter_mut().zip(probes).map(|(reading, probe)| add(reading, probe, &lit, &at_probe));
                refused += added.filter(|&taken| !taken).count();
            }
            progress.advance(1);
        }
    }
    progress.end();

    for reading in readings.iter_mut().filter(|reading| reading.status == Status::Ok && reading.value_w_m2 == 0.0) {
        reading.status = Status::Dark;
    }
    let mut warnings = Vec::new();
    if refused > 0 {
        warnings.push(format!("{refused} arrivals were negative or not finite and count as nothing"));
    }
    let faces_away = |(reading, probe): &(&Reading, &Probe)| reading.status == Status::Dark && probe.normal.is_some();
    let facing_away = readings.iter().zip(probes).filter(faces_away).count();
    if facing_away > 0 && model.walls.answers.iter().any(|answer| answer.reflects > 0.0) {
        warnings.push(format!(
            "{facing_away} sensor(s) face away from the one direction a light comes from here: their zero knows of no reflection"
        ));
    }
    Ok(Field { readings, warnings, shares: None })
}

/// Adds one light to one reading; false when its arrival was refused.
fn add(reading: &mut Reading, probe: &Probe, lit: &Lit, at_probe: &AtProbe) -> bool {
    let Some(node) = probe.place.ok().filter(|&node| lit.tree.reaches(node)) else { return true };
    reading.status = Status::Ok;
    let arrival = at_probe(probe, node);
    let cosine = probe.normal.map_or(1.0, |normal| normal.as_dvec3().dot(arrival.towards).max(0.0));
    let value_w_m2 = arrival.irradiance_w_m2 * cosine;
    if !(value_w_m2.is_finite() && value_w_m2 >= 0.0) {
        return false;
    }
    reading.value_w_m2 += value_w_m2;
    // A surface sees only what comes from its front, and of that the whole radiance, not its cosine.
    if cosine > 0.0 {
        reading.flux_w_m2 += arrival.irradiance_w_m2 * arrival.towards;
    }
    true
}

/// The poster's `B = L0 / (pi d^2)` with `L0 = Phi / 4`: scalar irradiance at `distance_m` from an isotropic light, W/m2.
///
/// A light without a size has no bound close by; within `nearest_m`, half a voxel, the skeleton knows nothing and the
/// value at that distance stands.
pub fn inverse_square(flux_w: f64, distance_m: f64, nearest_m: f64) -> f64 {
    let distance_m = distance_m.max(nearest_m);
    flux_w / (4.0 * PI * distance_m * distance_m)
}

#[cfg(test)]
pub(crate) mod tests;
