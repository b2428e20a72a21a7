//! What does a probe read of direct, carried and diffuse light?
//!
//! A probe without a normal reads scalar irradiance: direct and carried light by shadow rays, and of the diffuse light the
//! potential of its node, mended by what it sees through the necks around ([`views`]). One with a normal reads
//! `phi/4 + f.n/2` of the diffuse light, `f` its net flux, and the cosine of what it sees through necks. The reading's own
//! error is the disagreement of the two forms of diffusion, the noise of the rays, and a share of the diffuse light for
//! rooms not being uniform.

use super::circuit::{Circuit, Spread};
use super::lamps::gathered;
use super::photons::Landed;
use super::views::{self, View};
use crate::flow::direct::{Direct, direct};
use crate::flow::sequence::{self, SPHERE_SR};
use crate::light::{Reading, Status};
use crate::model::{Model, Probe};
use glam::{DVec3, Vec3};
use petgraph::graph::NodeIndex;
use std::ops::Range;

/// Error of the diffuse part where both forms of diffusion agree, as a share of it: rooms are not uniform.
const DIFFUSE_ERROR: f64 = 0.2;

/// Error of the part that rays carry besides the noise of the draws, as a share of it: small lamps for whole walls.
const CARRIED_ERROR: f64 = 0.05;

/// Shadow rays to a light that has a size.
const SHADOW_RAYS: u32 = 16;

/// The diffuse light of some emitters.
#[derive(Debug)]
pub struct Diffuse {
    /// Their numbers in [`Model::shining`].
    pub lights: Range<usize>,
    /// By node.
    pub spread: Spread,
    /// Its net flux at the nodes of probes, W/m2.
    pub flux_w_m2: Vec<DVec3>,
}

/// All light, ready to be read.
#[derive(Debug)]
pub struct Lit<'a> {
    /// What was modelled of the scene.
    pub model: &'a Model,
    /// What light spreads through.
    pub circuit: &'a Circuit<'a>,
    /// For each light of [`Model::shining`] what became of its rays.
    pub landed: &'a [Landed],
    /// The diffuse light of all lights.
    pub diffuse: &'a [Diffuse],
    /// Whether each emitter's share is asked for; `Lit::diffuse` then has an entry a light.
    pub shares: bool,
    /// Seed of the shadow rays.
    pub seed: u64,
}

/// A probe and what it sees.
struct Looking<'a> {
    number: usize,
    probe: &'a Probe,
    node: NodeIndex,
    /// Lifted off the surface that it lies on.
    at_m: Vec3,
    cell: u32,
    next: Vec<u32>,
    /// The necks around, from which side, and how they look.
    views: Vec<(u32, usize, View)>,
}

impl Lit<'_> {
    /// The reading of a probe, and what each emitter has in it where that is asked for.
    pub fn read(&self, number: usize, probe: &Probe) -> (Reading, Vec<f64>) {
        let mut shares = if self.shares { vec![0.0; self.model.sources.emitters.len()] } else { Vec::new() };
        let node = match probe.place {
            Ok(node) => node,
            Err(status) => return (Reading::none(status), shares),
        };
        let looking = self.looking(number, probe, node);
        let mut reading = Reading::none(Status::Unreached);
        let (mut diffuse_w_m2, mut differs_w_m2, mut noise_w2_m4) = (0.0, 0.0, 0.0);
        for diffuse in self.diffuse {
            let mut value_w_m2 = 0.0;
            let lights = diffuse.lights.clone().filter(|&light| self.reaches(light, node));
            let mut reached = None;
            for light in lights {
                let (straight, carried, noise_w_m2) = self.on_rays(&looking, light);
                value_w_m2 += straight.value_w_m2 + carried.value_w_m2;
                reading.flux_w_m2 += straight.flux_w_m2 + carried.flux_w_m2;
                noise_w2_m4 += noise_w_m2.powi(2) + (CARRIED_ERROR * carried.value_w_m2).powi(2);
                reached = Some(light);
            }
            let Some(light) = reached else { continue };
            let (spread, differs) = self.diffuse(&looking, diffuse);
            value_w_m2 += spread.value_w_m2;
            diffuse_w_m2 += spread.value_w_m2;
            differs_w_m2 += differs;
            reading.status = Status::Ok;
            reading.value_w_m2 += value_w_m2;
            reading.flux_w_m2 += spread.flux_w_m2;
            if let Some(share) = shares.get_mut(self.model.shining[light].emitter) {
                *share += value_w_m2;
            }
        }
        if reading.status == Status::Ok {
            let error_w_m2 = (DIFFUSE_ERROR * diffuse_w_m2).hypot(differs_w_m2).hypot(noise_w2_m4.sqrt());
            reading.error_w_m2 = Some(error_w_m2);
            if reading.value_w_m2 == 0.0 {
                reading.status = Status::Dark;
            }
        }
        (reading, shares)
    }

    /// Whether a way through the void joins a light to a node.
    fn reaches(&self, light: usize, node: NodeIndex) -> bool {
        let part = |node: NodeIndex| self.circuit.part.get(node.index());
        self.model.shining[light].place.is_ok_and(|place| part(place) == part(node))
    }

    fn looking<'a>(&self, number: usize, probe: &'a Probe, node: NodeIndex) -> Looking<'a> {
        let skeleton = &self.model.skeleton;
        let cell = skeleton.graph.node_weight(node).map_or(0, |node| node.cell);
        let lift_m = probe.normal.map_or(Vec3::ZERO, |normal| 2.0 * self.model.rays.epsilon_m() * normal);
        let at_m = probe.position_m + lift_m;
        let necks = self.circuit.necks_of.get(cell as usize).into_iter().flatten();
        let views = necks.filter_map(|&number| {
            let neck = &skeleton.necks[number as usize];
            let side = usize::from(neck.cells[0] != cell);
            Some((number, side, views::view(self.model, neck, side, at_m)?))
        });
        Looking { number, probe, node, at_m, cell, next: self.circuit.cells_beside(cell), views: views.collect() }
    }

    /// What a light gives straight, and by the bounces that rays carried, with the noise of that, W/m2.
    fn on_rays(&self, looking: &Looking, light: usize) -> (Direct, Direct, f64) {
        let Looking { number, probe, at_m, cell, ref next, .. } = *looking;
        let emitter = self.model.shining[light].emitter;
        let offset = sequence::offset(self.seed, (emitter as u64) << 40 | number as u64);
        let straight = direct(self.model, at_m, probe.normal, emitter, SHADOW_RAYS, offset);
        let (carried, noise_w_m2) = gathered(self.model, probe, at_m, &self.landed[light].lamps, cell, next, offset[0]);
        (straight, carried, noise_w_m2)
    }

    /// What diffuse light gives, and how far its two forms are from it, W/m2.
    fn diffuse(&self, looking: &Looking, diffuse: &Diffuse) -> (Direct, f64) {
        let Diffuse { spread, .. } = diffuse;
        let node = looking.node.index();
        let at = |by_node: &[f64]| by_node.get(node).copied().unwrap_or(0.0);
        let phi = at(&spread.potentials_w_m2).max(0.0);
        // Light that is nearly even all around has no longer flux than half of it, and then none is negative on any plane.
        let flux_w_m2 = diffuse.flux_w_m2.get(node).copied().unwrap_or(DVec3::ZERO).clamp_length_max(0.5 * phi);
        let normal = looking.probe.normal.map(|normal| normal.as_dvec3());
        // Over the hemisphere of a plane it is half of the flux, and a quarter of what is even.
        let (mut value_w_m2, mut flux_w_m2, part) = match normal {
            None => (phi, flux_w_m2, 1.0),
            Some(normal) => (0.25 * phi + 0.5 * normal.dot(flux_w_m2), 0.25 * phi * normal + 0.5 * flux_w_m2, 0.25),
        };

        for (neck, side, view) in &looking.views {
            let sides = &self.circuit.necks[*neck as usize];
            let radiance = sides.opening * (sides.mean(1 - side, &spread.brightness_w_m2) - phi) / SPHERE_SR;
            let seen = normal.map_or(view.solid_angle_sr, |normal| normal.dot(view.flux).max(0.0));
            value_w_m2 += radiance * seen;
            if normal.is_none() || seen > 0.0 {
                flux_w_m2 += radiance * view.flux;
            }
        }
        let value_w_m2 = value_w_m2.max(0.0);
        let flux_w_m2 = match normal {
            None => flux_w_m2.clamp_length_max(value_w_m2),
            Some(_) if value_w_m2 == 0.0 => DVec3::ZERO,
            Some(_) => flux_w_m2,
        };
        (Direct { value_w_m2, flux_w_m2 }, part * phi * (at(&spread.apart) - 1.0))
    }
}
