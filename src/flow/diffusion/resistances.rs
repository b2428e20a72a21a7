//! How much does each step of the curve, each doorway and each pane resist diffuse light?
//!
//! A step of section `A`, length `h` and mean free path `lambda` conducts `A lambda / (3 h)`. A neck resists once more, as a
//! Lambertian opening does: `2 (1/A - 1/A_1) + 2 (1/A - 1/A_2)`, `A_i` the section beyond it on each side (both the same:
//! `4 (1 - A/A_1) / A`). Glazing that passes the share `t` resists `4 (1/t - 1) / A`. Strands of the curve through one neck
//! share it.

use super::reach::{Curve, Pool, Reached};
use crate::model::Model;
use petgraph::graph::NodeIndex;

/// The section beyond a neck is the widest within this many times the root of the neck's area.
const BEYOND_NECK: f64 = 2.0;

/// No opening and no free path counts for less than this, m2 and metres: so small they let nothing through that matters.
const LEAST: f64 = 1e-9;

/// The two sides of a neck.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sides {
    /// For each strand of the curve through it the node in its first and in its second cell.
    pub nodes: Vec<[u32; 2]>,
    /// The resistance of the opening over that of the whole edge.
    pub opening: f64,
}

impl Sides {
    /// The mean over the strands, on side `side`, of what is given by node.
    pub fn mean(&self, side: usize, by_node: &[f64]) -> f64 {
        let sum: f64 = self.nodes.iter().map(|nodes| by_node[nodes[side] as usize]).sum();
        sum / self.nodes.len().max(1) as f64
    }
}

/// The conductance of each edge, m2, and the sides of each neck.
pub fn conductances_m2(model: &Model, curve: &Curve, pools: &[Pool]) -> (Vec<f64>, Vec<Sides>) {
    let skeleton = curve.skeleton;
    let edges = skeleton.graph.raw_edges();
    let has_glazing = model.walls.answers.iter().any(|answer| answer.passes > 0.0);
    let cell_of = |node: u32| skeleton.graph.raw_nodes()[node as usize].weight.cell;
    let mut necks = vec![Sides::default(); skeleton.necks.len()];
    for (edge, &[a, b]) in edges.iter().zip(&curve.ends) {
        if let Some(neck) = edge.weight.neck {
            let forwards = cell_of(a) == skeleton.necks[neck as usize].cells[0];
            necks[neck as usize].nodes.push(if forwards { [a, b] } else { [b, a] });
        }
    }

    let mut reached = Reached::default();
    let mut conductances_m2 = Vec::with_capacity(edges.len());
    for (edge, &[a, b]) in edges.iter().zip(&curve.ends) {
        let free_path_m = 0.5 * (pools[a as usize].free_path_m + pools[b as usize].free_path_m);
        let along = 3.0 * f64::from(edge.weight.length_m) / free_path_m.max(LEAST);
        let pane = if has_glazing { pane(model, a, b) } else { 0.0 };
        let Some(neck) = edge.weight.neck else {
            conductances_m2.push(f64::from(edge.weight.section_m2) / (along + pane));
            continue;
        };
        let area_m2 = f64::from(skeleton.necks[neck as usize].area_m2).max(LEAST);
        let beyond = [a, b].map(|side| beyond_m2(curve, &mut reached, side, area_m2));
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
    let [from_m, to_m] = [a, b].map(|end| model.node_m(NodeIndex::new(end as usize)));
    let share = f64::from(model.rays.transmitted_past(from_m, to_m, |_| false));
    if share > 0.0 { 4.0 * (1.0 / share - 1.0) } else { 0.0 }
}

/// The widest section on one side of a neck, near it, m2.
fn beyond_m2(curve: &Curve, reached: &mut Reached, side: u32, neck_m2: f64) -> f64 {
    reached.collect(curve, side, BEYOND_NECK * neck_m2.sqrt());
    let edges = curve.skeleton.graph.raw_edges();
    let links = reached.nodes.iter().flat_map(|&node| curve.links.of(node));
    let inside = links.map(|link| &edges[link.edge as usize].weight).filter(|edge| edge.neck.is_none());
    inside.map(|edge| f64::from(edge.section_m2)).fold(0.0, f64::max)
}
