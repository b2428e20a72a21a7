//! The skeleton as a network of resistors through which light flows.
//!
//! The potential of a node is the scalar irradiance phi of the diffuse light there, W/m2, a current is a net flux, W.
//!
//! - An edge conducts `A lambda / (3 h)`: section `A`, length `h`, mean free path `lambda = 4 V / S`, `V` void and `S` wall
//!   pooled over the curve within [`WIDTHS`] of its width to either side and not through a neck.
//! - A neck resists once more, as a Lambertian opening does: `2 (1/A - 1/A_1) + 2 (1/A - 1/A_2)`, `A_i` the section beyond it
//!   on each side (both the same: `4 (1 - A/A_1)/A`). Strands of the curve through one neck share it.
//! - Walls take light as Marshak's boundary has it: of absorptance `alpha`, a wall `S` conducts `alpha S / 4 / (1 - alpha/2)`
//!   to the ground, and what it sends out by itself, `s` W/m2, feeds `S s / (1 - alpha/2)` in; it receives
//!   `(phi/4 - s/2) / (1 - alpha/2)` W/m2.
//! - Glazing that passes the share `t` resists `4 (1/t - 1) / A`.
//! - The border of the grid conducts `A / 4` to the ground where a void leaks.

use super::eliminate::Eliminated;
use super::surroundings::Surroundings;
use crate::model::Model;
use crate::skeleton::Skeleton;
use crate::skeleton::links::Links;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::VecDeque;

/// How far along the curve walls and void are pooled to either side, in widths (twice the opening) of the void there.
const WIDTHS: f64 = 0.5;

/// The section beyond a neck is the widest within this many times the root of the neck's area.
const BEYOND_NECK: f64 = 2.0;

/// A sink below this share of the walls takes so little that there is no telling where the light stays.
const LEAST_ABSORPTANCE: f64 = 1e-6;

/// The resistor network of a model.
#[derive(Debug)]
pub struct Circuit {
    links: Links,
    ends: Vec<[u32; 2]>,
    conductance_m2: Vec<f64>,
    /// By node: how far its surroundings are pooled, metres, and what was found there.
    reach_m: Vec<f64>,
    pools: Vec<Pool>,
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
    /// By neck: the nodes on its two sides, and the part of the fall of potential between them that is the opening's.
    pub necks: Vec<Sides>,
    /// By cell: the necks around it.
    pub necks_of: Vec<Vec<u32>>,
    eliminated: Eliminated,
    textbook: Eliminated,
}

/// The two sides of a neck.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sides {
    /// For each strand of the curve through it the node in its first and in its second cell.
    pub nodes: Vec<[u32; 2]>,
    /// The resistance of the opening over that of the whole edge.
    pub opening: f64,
}

impl Sides {
    /// How much more light there is beyond the neck than on side `side`: scalar irradiance, W/m2.
    pub fn rise_w_m2(&self, side: usize, brightness_w_m2: &[f64]) -> f64 {
        let mean = |side: usize| {
            let sum: f64 = self.nodes.iter().map(|nodes| brightness_w_m2[nodes[side] as usize]).sum();
            sum / self.nodes.len().max(1) as f64
        };
        self.opening * (mean(1 - side) - mean(side))
    }
}

/// Diffuse light in the circuit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spread {
    /// Scalar irradiance by node, W/m2.
    pub potentials_w_m2: Vec<f64>,
    /// Four times what the walls around each node send out, W/m2: its scalar irradiance for one who sees them alone.
    pub brightness_w_m2: Vec<f64>,
    /// Scalar irradiance by node if currents followed it instead, W/m2: the textbook's diffusion. Where both agree light
    /// does spread by diffusion; where they do not, neither is to be trusted.
    pub textbook_w_m2: Vec<f64>,
}

/// What lies within reach of a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pool {
    /// Void, m3.
    pub volume_m3: f64,
    /// Wall, m2.
    pub wall_m2: f64,
    /// Wall times its reflectance, m2.
    pub reflecting_m2: f64,
}

impl Pool {
    /// The mean way between two walls, metres; 0 where there is none.
    fn free_path_m(&self) -> f64 {
        if self.wall_m2 > 0.0 { 4.0 * self.volume_m3 / self.wall_m2 } else { 0.0 }
    }

    /// The mean reflectance of the walls; 0 where there is none.
    pub fn reflectance(&self) -> f64 {
        if self.wall_m2 > 0.0 { self.reflecting_m2 / self.wall_m2 } else { 0.0 }
    }
}

impl Circuit {
    /// The network of a model whose nodes are surrounded so.
    pub fn new(model: &Model, around: &Surroundings) -> Self {
        let skeleton = &model.skeleton;
        let ends: Vec<[u32; 2]> = skeleton
            .graph
            .raw_edges()
            .iter()
            .map(|edge| [edge.source(), edge.target()].map(|end| end.index() as u32))
            .collect();
        let links = Links::new(skeleton.graph.node_count(), &ends);
        let voxel_m = f64::from(skeleton.lattice.voxel_m);
        let widths_m = skeleton.graph.node_weights().map(|node| 2.0 * voxel_m * f64::from(node.opening_voxels));
        let reach_m: Vec<f64> = widths_m.map(|width_m| WIDTHS * width_m).collect();
        let pools = pooled(skeleton, &links, &reach_m, around);
        let (conductance_m2, necks) = conductances_m2(model, &links, &ends, &pools);
        let mut necks_of = vec![Vec::new(); skeleton.cells.len()];
        for (neck, cell) in skeleton.necks.iter().enumerate().flat_map(|(neck, at)| at.cells.map(|cell| (neck, cell))) {
            necks_of[cell as usize].push(neck as u32);
        }

        let coupling: Vec<f64> = pools.iter().map(|pool| 2.0 / (1.0 + pool.reflectance())).collect();
        let absorbing =
            around.wall_m2.iter().zip(&around.reflecting_m2).map(|(wall, reflecting)| (wall - reflecting).max(0.0));
        let absorbing_m2: Vec<f64> = absorbing.collect();
        let open_m2 = around.open_m2.clone();
        let part = parts(&links);
        let has_loss = has_loss(&part, &absorbing_m2, &open_m2, &around.wall_m2);

        let to_ground: Vec<f64> =
            (0..part.len()).map(|node| 0.25 * (absorbing_m2[node] * coupling[node] + open_m2[node])).collect();
        let joints = |share: &dyn Fn(f64) -> f64| -> Vec<(u32, u32, f64)> {
            let joint = |(&[a, b], conductance_m2): (&[u32; 2], &f64)| {
                let reflectance = 0.5 * (pools[a as usize].reflectance() + pools[b as usize].reflectance());
                (a, b, conductance_m2 * share(reflectance))
            };
            ends.iter().zip(&conductance_m2).map(joint).collect()
        };
        let (hops, textbook) = (joints(&|reflectance| 2.0 * reflectance / (1.0 + reflectance)), joints(&|_| 1.0));
        let grounded = |joints: &[_]| Eliminated::new(Vec::clone(&to_ground), joints);
        let (eliminated, textbook) = rayon::join(|| grounded(&hops), || grounded(&textbook));
        Self {
            links,
            ends,
            conductance_m2,
            reach_m,
            pools,
            coupling,
            absorbing_m2,
            open_m2,
            part,
            has_loss,
            necks,
            necks_of,
            eliminated,
            textbook,
        }
    }

    /// The light that walls spread, which send out these fluxes by node, W. Nothing in parts that lose nothing, where no light
    /// would ever be enough.
    pub fn spread(&self, skeleton: &Skeleton, sources_w: &[f64]) -> Spread {
        let lossy = |node: usize| self.has_loss[self.part[node] as usize];
        let own_w_m2 = self.pooled_mean(skeleton, sources_w);
        let given_w_m2 = |node: u32| {
            if lossy(node as usize) { 2.0 * self.coupling[node as usize] * own_w_m2[node as usize] } else { 0.0 }
        };
        let mut currents_w: Vec<f64> = (0..self.part.len())
            .map(|node| if lossy(node) { self.coupling[node] * sources_w[node] } else { 0.0 })
            .collect();
        let textbook_w_m2 = self.textbook.potentials(&currents_w);
        for (&[a, b], conductance_m2) in self.ends.iter().zip(&self.conductance_m2) {
            let current_w = conductance_m2 * (given_w_m2(a) - given_w_m2(b));
            currents_w[a as usize] -= current_w;
            currents_w[b as usize] += current_w;
        }
        let potentials_w_m2 = self.eliminated.potentials(&currents_w);
        let brightness = |node: u32| self.kept(node) * potentials_w_m2[node as usize] + given_w_m2(node);
        let brightness_w_m2 = (0..self.part.len() as u32).map(brightness).collect();
        Spread { potentials_w_m2, brightness_w_m2, textbook_w_m2 }
    }

    /// The mean over the walls within reach of each node of what is given by node; per m2.
    fn pooled_mean(&self, skeleton: &Skeleton, by_node: &[f64]) -> Vec<f64> {
        let mean = |seen: &mut Vec<bool>, node: usize| {
            let mut sum = 0.0;
            let reach_m = self.reach_m[node];
            within_reach(&self.links, skeleton, node as u32, reach_m, seen, |near| sum += by_node[near as usize]);
            let wall_m2 = self.pools[node].wall_m2;
            if wall_m2 > 0.0 { sum / wall_m2 } else { 0.0 }
        };
        (0..by_node.len()).into_par_iter().map_init(Vec::new, mean).collect()
    }

    /// The share of a node's potential that its walls send back: `rho / (1 - alpha/2)`.
    fn kept(&self, node: u32) -> f64 {
        self.pools[node as usize].reflectance() * self.coupling[node as usize]
    }

    /// The net flux around a node, W/m2: its integral over the pool, from the currents on the edges in it, over the pool's
    /// volume; pointing to where the light comes from.
    pub fn flux_w_m2(&self, skeleton: &Skeleton, node: u32, spread: &Spread) -> DVec3 {
        let mut sum = DVec3::ZERO;
        let mut within = Vec::new();
        within_reach(&self.links, skeleton, node, self.reach_m[node as usize], &mut Vec::new(), |node| {
            within.push(node)
        });
        for &here in &within {
            for link in self.links.of(here).iter().filter(|link| link.node > here && within.contains(&link.node)) {
                let [from, to] = [here, link.node]
                    .map(|end| skeleton.graph[petgraph::graph::NodeIndex::new(end as usize)].position_m.as_dvec3());
                let rise_w_m2 = spread.brightness_w_m2[link.node as usize] - spread.brightness_w_m2[here as usize];
                sum += self.conductance_m2[link.edge as usize] * rise_w_m2 * (to - from);
            }
        }
        let volume_m3 = self.pools[node as usize].volume_m3;
        if volume_m3 > 0.0 { sum / volume_m3 } else { DVec3::ZERO }
    }

    /// What the walls around a node take of light they send out (W, by node) and of its potentials, W, and what leaves
    /// by openings.
    pub fn losses_w(&self, sources_w: &[f64], potentials_w_m2: &[f64]) -> (f64, f64) {
        let (mut absorbed_w, mut escaped_w) = (0.0, 0.0);
        for (node, (source_w, phi)) in sources_w.iter().zip(potentials_w_m2).enumerate() {
            let alpha_share = 1.0 - 1.0 / self.coupling[node];
            absorbed_w += self.coupling[node] * (0.25 * self.absorbing_m2[node] * phi - alpha_share * source_w);
            escaped_w += 0.25 * self.open_m2[node] * phi;
        }
        (absorbed_w, escaped_w)
    }

    /// What lies within reach of a node.
    pub fn pool(&self, node: u32) -> Pool {
        self.pools.get(node as usize).copied().unwrap_or_default()
    }

    /// The cells that necks join to one.
    pub fn cells_beside(&self, skeleton: &Skeleton, cell: u32) -> Vec<u32> {
        let necks = self.necks_of.get(cell as usize).into_iter().flatten();
        necks.flat_map(|&neck| skeleton.necks[neck as usize].cells).filter(|&other| other != cell).collect()
    }

    /// How many edges there are.
    pub fn edges(&self) -> usize {
        self.ends.len()
    }
}

/// Calls `visit` for each node within `reach_m` of a node along the curve, itself first, not through necks. `seen` is room to
/// work in, left as found.
fn within_reach(
    links: &Links,
    skeleton: &Skeleton,
    node: u32,
    reach_m: f64,
    seen: &mut Vec<bool>,
    mut visit: impl FnMut(u32),
) {
    seen.resize(links.nodes(), false);
    seen[node as usize] = true;
    let mut order = vec![node];
    let mut open = VecDeque::from([(node, 0.0)]);
    while let Some((here, along_m)) = open.pop_front() {
        visit(here);
        for link in links.of(here) {
            let edge = &skeleton.graph.raw_edges()[link.edge as usize].weight;
            let next_m = along_m + f64::from(edge.length_m);
            if edge.neck.is_none() && next_m <= reach_m && !seen[link.node as usize] {
                seen[link.node as usize] = true;
                order.push(link.node);
                open.push_back((link.node, next_m));
            }
        }
    }
    order.into_iter().for_each(|node| seen[node as usize] = false);
}

/// What lies within reach of each node.
fn pooled(skeleton: &Skeleton, links: &Links, reach_m: &[f64], around: &Surroundings) -> Vec<Pool> {
    let pool = |seen: &mut Vec<bool>, (node, &reach_m): (usize, &f64)| {
        let mut pool = Pool::default();
        within_reach(links, skeleton, node as u32, reach_m, seen, |near| {
            pool.volume_m3 += around.volume_m3[near as usize];
            pool.wall_m2 += around.wall_m2[near as usize];
            pool.reflecting_m2 += around.reflecting_m2[near as usize];
        });
        pool
    };
    reach_m.par_iter().enumerate().map_init(Vec::new, pool).collect()
}

/// The conductance of each edge, m2, and the sides of each neck.
fn conductances_m2(model: &Model, links: &Links, ends: &[[u32; 2]], pools: &[Pool]) -> (Vec<f64>, Vec<Sides>) {
    let skeleton = &model.skeleton;
    let edges = skeleton.graph.raw_edges();
    let has_glazing = model.walls.answers.iter().any(|answer| answer.passes > 0.0);
    let cell_of = |node: u32| skeleton.graph.raw_nodes()[node as usize].weight.cell;
    let mut necks = vec![Sides::default(); skeleton.necks.len()];
    for (edge, &[a, b]) in edges.iter().zip(ends) {
        if let Some(neck) = edge.weight.neck {
            let forwards = cell_of(a) == skeleton.necks[neck as usize].cells[0];
            necks[neck as usize].nodes.push(if forwards { [a, b] } else { [b, a] });
        }
    }

    let mut conductances_m2 = Vec::with_capacity(ends.len());
    for (edge, &[a, b]) in edges.iter().zip(ends) {
        let free_path_m = 0.5 * (pools[a as usize].free_path_m() + pools[b as usize].free_path_m());
        let (section_m2, length_m) = (f64::from(edge.weight.section_m2), f64::from(edge.weight.length_m));
        let along = 3.0 * length_m / free_path_m.max(f64::MIN_POSITIVE);
        let pane = if has_glazing { pane(model, a, b) } else { 0.0 };
        let Some(neck) = edge.weight.neck else {
            conductances_m2.push(section_m2 / (along + pane));
            continue;
        };
        let area_m2 = f64::from(skeleton.necks[neck as usize].area_m2).max(f64::MIN_POSITIVE);
        let beyond = [a, b].map(|side| beyond_m2(skeleton, links, side, area_m2));
        let opening: f64 = beyond.iter().map(|beyond_m2| 2.0 * (1.0 / area_m2 - 1.0 / beyond_m2.max(area_m2))).sum();
        let resistance = (along + pane) / area_m2 + opening;
        let sides = &mut necks[neck as usize];
        sides.opening = opening / resistance;
        conductances_m2.push(1.0 / (resistance * sides.nodes.len() as f64));
    }
    (conductances_m2, necks)
}

/// What glazing between two nodes resists, times its area: as an opening that lets its share through.
fn pane(model: &Model, a: u32, b: u32) -> f64 {
    let [from_m, to_m] = [a, b].map(|end| model.node_m(petgraph::graph::NodeIndex::new(end as usize)));
    let share = f64::from(model.rays.transmitted_past(from_m, to_m, |_| false));
    if share > 0.0 { 4.0 * (1.0 / share - 1.0) } else { 0.0 }
}

/// The widest section on one side of a neck, near it, m2.
fn beyond_m2(skeleton: &Skeleton, links: &Links, side: u32, neck_m2: f64) -> f64 {
    let mut widest_m2 = 0.0_f64;
    within_reach(links, skeleton, side, BEYOND_NECK * neck_m2.sqrt(), &mut Vec::new(), |node| {
        for link in links.of(node) {
            let edge = &skeleton.graph.raw_edges()[link.edge as usize].weight;
            if edge.neck.is_none() {
                widest_m2 = widest_m2.max(f64::from(edge.section_m2));
            }
        }
    });
    widest_m2
}

/// The connected part of each node, numbered by their lowest nodes.
fn parts(links: &Links) -> Vec<u32> {
    let mut part = vec![u32::MAX; links.nodes()];
    let mut count = 0;
    for node in 0..links.nodes() as u32 {
        if part[node as usize] != u32::MAX {
            continue;
        }
        part[node as usize] = count;
        let mut open = vec![node];
        while let Some(here) = open.pop() {
            for link in
                links.of(here).iter().filter(|link| part[link.node as usize] == u32::MAX).copied().collect::<Vec<_>>()
            {
                part[link.node as usize] = count;
                open.push(link.node);
            }
        }
        count += 1;
    }
    part
}

/// Whether the walls and openings of each part take anything.
fn has_loss(part: &[u32], absorbing_m2: &[f64], open_m2: &[f64], wall_m2: &[f64]) -> Vec<bool> {
    let count = part.iter().max().map_or(0, |most| *most as usize + 1);
    let mut sums = vec![(0.0, 0.0); count];
    for (node, &part) in part.iter().enumerate() {
        sums[part as usize].0 += absorbing_m2[node] + open_m2[node];
        sums[part as usize].1 += wall_m2[node];
    }
    sums.iter().map(|(loss_m2, wall_m2)| *loss_m2 > LEAST_ABSORPTANCE * wall_m2).collect()
}
