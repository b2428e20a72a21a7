//! The skeleton as a network of resistors through which light flows.
//!
//! The potential of a node is the scalar irradiance phi of the diffuse light there, W/m2, a current is a net flux, W. What
//! edges resist is in [`resistances`](super::resistances).
//!
//! Walls take light as Marshak's boundary has it: of absorptance `alpha` (reflectance `rho`), a wall `S` conducts
//! `alpha S / 4 / (1 - alpha/2)` to the ground, and what it sends out by itself, `s` W/m2, feeds `S s / (1 - alpha/2)` in; it
//! receives `(phi/4 - s/2) / (1 - alpha/2)` W/m2. Openings to the outside conduct `A / 4` to the ground.
//!
//! Along the curve light goes from wall to wall, so its currents follow what walls send out, `4 B = (rho phi + 2 s) /
//! (1 - alpha/2)`, and not phi, which counts light on its last way to where it is absorbed too. That is exact to the second
//! moment of one hop for any reflectance, but hops down a straight run have no second moment to speak of: a little light
//! goes very far, and such currents end too soon. The textbook's diffusion follows phi; it carries light too far where bends
//! and doors cut hops short. Both are solved and their mean is taken, so that lights still add; where they differ neither is to be
//! trusted.

use super::eliminate::Eliminated;
use super::reach::{Curve, Pool, Reached};
use super::resistances::{Sides, conductances_m2};
use super::surroundings::Surroundings;
use crate::model::Model;
use glam::DVec3;
use petgraph::graph::NodeIndex;

/// No wall absorbs less: a closed void that absorbs nothing has no steady light.
const LEAST_ABSORPTANCE: f64 = 1e-6;

/// The resistor network of a model.
#[derive(Debug)]
pub struct Circuit<'a> {
    /// The skeleton's curve.
    pub curve: Curve<'a>,
    /// By edge: its conductance, m2.
    pub conductance_m2: Vec<f64>,
    /// By node: what lies around it.
    pub pools: Vec<Pool>,
    /// By node: `1 / (1 - alpha/2)` of the walls around.
    pub coupling: Vec<f64>,
    /// By node: wall area times its absorptance, m2.
    pub absorbing_m2: Vec<f64>,
    /// By node: openings to the outside, m2.
    pub open_m2: Vec<f64>,
    /// By node: the connected part of the skeleton it belongs to.
    pub part: Vec<u32>,
    /// By part: whether light ever gets out of it.
    pub has_loss: Vec<bool>,
    /// By neck: its two sides.
    pub necks: Vec<Sides>,
    /// By cell: the necks around it.
    pub necks_of: Vec<Vec<u32>>,
    eliminated: Eliminated,
    textbook: Eliminated,
}

/// Diffuse light in the circuit, by node, W/m2.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spread {
    /// Scalar irradiance where currents follow what walls send out.
    pub hops_w_m2: Vec<f64>,
    /// Scalar irradiance by the textbook's diffusion.
    pub textbook_w_m2: Vec<f64>,
    /// Scalar irradiance, the mean of the two.
    pub potentials_w_m2: Vec<f64>,
    /// By what factor the two differ, at least 1.
    pub apart: Vec<f64>,
    /// Four times what the walls around send out, the mean of the two: the scalar irradiance of one who sees them alone.
    pub brightness_w_m2: Vec<f64>,
}

/// Where walls shine most, currents that follow them can leave less than nothing behind; less than this share of the
/// textbook's is not believed when the two are compared.
const LEAST_SHARE: f64 = 1e-3;

impl<'a> Circuit<'a> {
    /// The network of a model whose nodes are surrounded so. About a microsecond a node.
    pub fn new(model: &'a Model, around: &Surroundings) -> Self {
        let curve = Curve::new(&model.skeleton);
        let pools = curve.pools(around);
        let (conductance_m2, necks) = conductances_m2(model, &curve, &pools);
        let mut necks_of = vec![Vec::new(); model.skeleton.cells.len()];
        for (number, neck) in model.skeleton.necks.iter().enumerate() {
            neck.cells.iter().for_each(|&cell| necks_of[cell as usize].push(number as u32));
        }

        let coupling: Vec<f64> = pools.iter().map(|pool| 2.0 / (1.0 + pool.reflectance)).collect();
        let walls = around.wall_m2.iter().zip(&around.reflecting_m2);
        let absorbing_m2: Vec<f64> =
            walls.map(|(wall, reflecting)| (wall - reflecting).max(LEAST_ABSORPTANCE * wall)).collect();
        let open_m2 = around.open_m2.clone();
        let part = curve.parts();
        let has_loss = has_loss(&part, &absorbing_m2, &open_m2, &around.wall_m2);

        let to_ground = |node: usize| 0.25 * (absorbing_m2[node] * coupling[node] + open_m2[node]);
        let to_ground: Vec<f64> = (0..part.len()).map(to_ground).collect();
        let eliminated = |share: &(dyn Fn(f64) -> f64 + Sync)| {
            let joint = |(&[a, b], conductance_m2): (&[u32; 2], &f64)| {
                let reflectance = 0.5 * (pools[a as usize].reflectance + pools[b as usize].reflectance);
                (a, b, conductance_m2 * share(reflectance))
            };
            let joints: Vec<(u32, u32, f64)> = curve.ends.iter().zip(&conductance_m2).map(joint).collect();
            Eliminated::new(to_ground.clone(), &joints)
        };
        let (hops, textbook) = rayon::join(|| eliminated(&kept), || eliminated(&|_| 1.0));
        Self {
            conductance_m2,
            pools,
            coupling,
            absorbing_m2,
            open_m2,
            part,
            has_loss,
            necks,
            necks_of,
            eliminated: hops,
            textbook,
            curve,
        }
    }

    /// The light that walls spread, which send out these fluxes by node, W.
    pub fn spread(&self, sources_w: &[f64]) -> Spread {
        let own_w_m2 = self.curve.around_each(|node, reached| {
            let sum: f64 = reached.nodes.iter().map(|&near| sources_w[near as usize]).sum();
            let wall_m2 = self.pools[node as usize].wall_m2;
            if wall_m2 > 0.0 { sum / wall_m2 } else { 0.0 }
        });
        let given_w_m2: Vec<f64> = own_w_m2.iter().zip(&self.coupling).map(|(own, fed)| 2.0 * fed * own).collect();
        let mut currents_w: Vec<f64> = sources_w.iter().zip(&self.coupling).map(|(flux, fed)| fed * flux).collect();
        let textbook_w_m2 = self.textbook.potentials(&currents_w);

        for (&[a, b], conductance_m2) in self.curve.ends.iter().zip(&self.conductance_m2) {
            let current_w = conductance_m2 * (given_w_m2[a as usize] - given_w_m2[b as usize]);
            currents_w[a as usize] -= current_w;
            currents_w[b as usize] += current_w;
        }
        let hops_w_m2 = self.eliminated.potentials(&currents_w);
        let sent = |node: usize| kept(self.pools[node].reflectance) * hops_w_m2[node] + given_w_m2[node];
        let nodes = 0..textbook_w_m2.len();
        let apart = |node: usize| match (hops_w_m2[node], textbook_w_m2[node]) {
            (_, textbook) if textbook <= 0.0 => 1.0,
            (hops, textbook) => f64::max(textbook / hops.max(LEAST_SHARE * textbook), hops / textbook),
        };
        Spread {
            apart: nodes.clone().map(apart).collect(),
            potentials_w_m2: nodes.clone().map(|node| 0.5 * (hops_w_m2[node] + textbook_w_m2[node])).collect(),
            brightness_w_m2: nodes.map(|node| 0.5 * (sent(node) + textbook_w_m2[node])).collect(),
            hops_w_m2,
            textbook_w_m2,
        }
    }

    /// The net flux around each node that is `asked` for, W/m2 (zero at the others): its integral over what is pooled there,
    /// from the currents on the edges in it, over the volume; pointing to where the light comes from.
    pub fn flux_w_m2(&self, spread: &Spread, asked: &[bool]) -> Vec<DVec3> {
        let node_m = |node: u32| {
            let node = self.curve.skeleton.graph.node_weight(NodeIndex::new(node as usize));
            node.map_or(DVec3::ZERO, |node| node.position_m.as_dvec3())
        };
        let flux = |node: usize| {
            let volume_m3 = self.pools[node].volume_m3;
            if !asked[node] || volume_m3 <= 0.0 {
                return DVec3::ZERO;
            }
            let mut reached = Reached::default();
            reached.collect(&self.curve, node as u32, self.curve.reach_m[node]);
            let mut sum = DVec3::ZERO;
            for &here in &reached.nodes {
                for link in self.curve.links.of(here).iter().filter(|at| at.node > here && reached.holds(at.node)) {
                    let rise_w_m2 = spread.brightness_w_m2[link.node as usize] - spread.brightness_w_m2[here as usize];
                    sum += self.conductance_m2[link.edge as usize] * rise_w_m2 * (node_m(link.node) - node_m(here));
                }
            }
            sum / volume_m3
        };
        (0..asked.len()).map(flux).collect()
    }

    /// What the walls take of the light they send out (W, by node) and spread by hops, and what leaves by openings, W.
    /// Together they are what was sent out.
    pub fn losses_w(&self, sources_w: &[f64], spread: &Spread) -> (f64, f64) {
        let (mut absorbed_w, mut escaped_w) = (0.0, 0.0);
        for (node, (source_w, phi)) in sources_w.iter().zip(&spread.hops_w_m2).enumerate() {
            let half_alpha = 1.0 - 1.0 / self.coupling[node];
            absorbed_w += self.coupling[node] * (0.25 * self.absorbing_m2[node] * phi - half_alpha * source_w);
            escaped_w += 0.25 * self.open_m2[node] * phi;
        }
        (absorbed_w, escaped_w)
    }

    /// The cells that necks join to one.
    pub fn cells_beside(&self, cell: u32) -> Vec<u32> {
        let necks = self.necks_of.get(cell as usize).into_iter().flatten();
        let cells = necks.flat_map(|&neck| self.curve.skeleton.necks[neck as usize].cells);
        cells.filter(|&other| other != cell).collect()
    }
}

/// The share of the potential that walls of a reflectance send back: `rho / (1 - alpha/2)`.
fn kept(reflectance: f64) -> f64 {
    2.0 * reflectance / (1.0 + reflectance)
}

/// Whether the walls and openings of each part take more than the least.
fn has_loss(part: &[u32], absorbing_m2: &[f64], open_m2: &[f64], wall_m2: &[f64]) -> Vec<bool> {
    let count = part.iter().max().map_or(0, |most| *most as usize + 1);
    let mut sums = vec![(0.0, 0.0); count];
    for (node, &part) in part.iter().enumerate() {
        sums[part as usize].0 += absorbing_m2[node] + open_m2[node];
        sums[part as usize].1 += wall_m2[node];
    }
    sums.iter().map(|(loss_m2, wall_m2)| *loss_m2 > 2.0 * LEAST_ABSORPTANCE * wall_m2).collect()
}
