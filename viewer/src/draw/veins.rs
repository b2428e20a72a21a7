//! The skeleton: nodes as balls, edges as strokes as wide as their flux, arrows along the flow, and necks.

use crate::camera::Camera;
use crate::colour::Scale;
use crate::layers::NodeColour;
use crate::measure::shown;
use crate::paint::{Ball, Corner, Stroke};
use crate::results::Estimate;
use crate::theme::category;
use crate::ways::nearest_lights;
use glam::{Vec2, Vec3};
use lightvein::model::Model;
use petgraph::graph::NodeIndex;
use petgraph::visit::EdgeRef;
use std::collections::HashSet;

/// A node's radius as a share of the scene's longest side, and at most as a share of the median edge.
const NODE_OF_SCENE: f32 = 0.005;
const NODE_OF_EDGE: f32 = 0.35;

/// Widths of an edge: without flux, and at the top of the scale.
const EDGE_PX: [f32; 2] = [1.2, 6.0];

/// Arrows are at least so far apart, and at most so many.
const ARROWS_APART_PX: f32 = 24.0;
const MOST_ARROWS: usize = 400;

/// The length of an arrow.
const ARROW_PX: f32 = 16.0;

/// The middle radius of nodes, metres: 0.005 of the scene, at most 0.35 of the median edge.
pub fn node_radius_m(model: &Model) -> f32 {
    let lattice = &model.voxels.lattice;
    let longest_m = lattice.size.iter().max().map_or(1.0, |voxels| *voxels as f32 * lattice.voxel_m);
    let mut lengths_m: Vec<f32> = model.skeleton.graph.edge_weights().map(|edge| edge.length_m).collect();
    let middle = lengths_m.len() / 2;
    let median_m = if lengths_m.is_empty() {
        lattice.voxel_m
    } else {
        *lengths_m.select_nth_unstable_by(middle, f32::total_cmp).1
    };
    (NODE_OF_SCENE * longest_m).min(NODE_OF_EDGE * median_m)
}

/// The nodes, larger where their ball is, with the value of their colour.
pub fn nodes(model: &Model, estimate: Option<&Estimate>, colour: NodeColour) -> Vec<Ball> {
    let graph = &model.skeleton.graph;
    let nearest_light = if colour == NodeColour::Light { nearest_lights(model) } else { Vec::new() };
    let middle_m = node_radius_m(model);
    let mut radii_m: Vec<f32> = graph.node_weights().map(|node| node.radius_m).collect();
    let median = radii_m.len() / 2;
    let median_m = if radii_m.is_empty() { 1.0 } else { *radii_m.select_nth_unstable_by(median, f32::total_cmp).1 };
    let reading = |node: NodeIndex| estimate.and_then(|estimate| estimate.at_nodes.readings.get(node.index()));
    let ball = |node: NodeIndex| {
        let weight = &graph[node];
        let value = match colour {
            NodeColour::Irradiance => reading(node).map_or(f32::NAN, shown),
            NodeColour::Radius => weight.radius_m,
            NodeColour::Flux => strongest(model, estimate, node),
            NodeColour::Cell | NodeColour::Light => f32::NAN,
        };
        let [r, g, b] = match colour {
            NodeColour::Cell => category(weight.cell as usize),
            NodeColour::Light => {
                nearest_light.get(node.index()).copied().flatten().map_or(crate::colour::GREY, category)
            }
            _ => crate::colour::GREY,
        };
        let size = (weight.radius_m / median_m.max(1e-6)).sqrt().clamp(0.6, 1.8);
        Ball { centre_m: weight.position_m, radius_m: middle_m * size, value, colour: [r, g, b, 255] }
    };
    graph.node_indices().map(ball).collect()
}

/// The flux of the strongest edge at a node, W; NaN where nothing is known.
fn strongest(model: &Model, estimate: Option<&Estimate>, node: NodeIndex) -> f32 {
    let Some(estimate) = estimate else { return f32::NAN };
    let edges = model.skeleton.graph.edges(node);
    let fluxes_w = edges.filter_map(|edge| estimate.through_edges_w.get(edge.id().index()));
    fluxes_w.map(|flux_w| flux_w.abs() as f32).fold(f32::NAN, f32::max)
}

/// The edges, as wide as their share of the scale of fluxes.
pub fn edges(model: &Model, estimate: Option<&Estimate>, scale: &Scale) -> Vec<Stroke> {
    let graph = &model.skeleton.graph;
    let stroke = |edge| {
        let (a, b) = graph.edge_endpoints(edge)?;
        let flux_w = estimate.and_then(|estimate| estimate.through_edges_w.get(edge.index()));
        let value = flux_w.map_or(f32::NAN, |flux_w| flux_w.abs() as f32);
        let share = scale.share(value).unwrap_or(0.0).clamp(0.0, 1.0);
        Some(Stroke {
            a_m: graph[a].position_m,
            b_m: graph[b].position_m,
            width_px: EDGE_PX[0] + (EDGE_PX[1] - EDGE_PX[0]) * share,
            value,
            colour: [128, 128, 128, 255],
            dashed: false,
            arrow: false,
        })
    };
    graph.edge_indices().filter_map(stroke).collect()
}

/// Arrows along the flow: strongest first, none too close to another on the screen.
pub fn arrows(
    model: &Model,
    estimate: &Estimate,
    order: &[u32],
    camera: &Camera,
    size_px: Vec2,
    colour: [u8; 4],
) -> Vec<Stroke> {
    let graph = &model.skeleton.graph;
    let mut taken: HashSet<(i32, i32)> = HashSet::new();
    let mut placed: Vec<Vec2> = Vec::new();
    let mut arrows = Vec::new();
    for &edge in order {
        if arrows.len() >= MOST_ARROWS {
            break;
        }
        let edge = petgraph::graph::EdgeIndex::new(edge as usize);
        let Some((a, b)) = graph.edge_endpoints(edge) else { continue };
        // Along the net flux itself: a step of a lattice has no direction worth showing.
        let comes_from =
            |node: NodeIndex| estimate.at_nodes.readings.get(node.index()).map(|reading| reading.flux_w_m2);
        let flows = -(comes_from(a).unwrap_or_default() + comes_from(b).unwrap_or_default());
        let middle_m = (graph[a].position_m + graph[b].position_m) / 2.0;
        let Some((at_px, _)) = camera.project(middle_m, size_px) else { continue };
        if at_px.cmplt(Vec2::ZERO).any() || at_px.cmpgt(size_px).any() {
            continue;
        }
        // Squares as large as the distance: whoever is too close stands in this one or one beside it.
        let square = (at_px / ARROWS_APART_PX).floor().as_ivec2();
        let is_close = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (square.x + dx, square.y + dy)));
        let near = is_close.into_iter().any(|place| taken.contains(&place));
        if near && placed.iter().any(|other| other.distance(at_px) < ARROWS_APART_PX) {
            continue;
        }
        taken.insert((square.x, square.y));
        placed.push(at_px);
        let half_m = flows.normalize_or_zero().as_vec3() * 0.5 * ARROW_PX * camera.metres_per_px(middle_m, size_px);
        arrows.push(Stroke {
            a_m: middle_m - half_m,
            b_m: middle_m + half_m,
            width_px: 2.0,
            value: f32::NAN,
            colour,
            dashed: false,
            arrow: true,
        });
    }
    arrows
}

/// Edges with flux, the strongest first.
pub fn by_strength(estimate: &Estimate) -> Vec<u32> {
    let flux_w = |edge: &u32| estimate.through_edges_w[*edge as usize].abs();
    let mut order: Vec<u32> = (0..estimate.through_edges_w.len() as u32).filter(|edge| flux_w(edge) > 0.0).collect();
    order.sort_by(|a, b| flux_w(b).total_cmp(&flux_w(a)).then(a.cmp(b)));
    order
}

/// The openings between cells: their panes, and their borders.
pub fn necks(model: &Model) -> (Vec<Corner>, Vec<Stroke>) {
    let colour = [204, 121, 167, 255];
    let (mut panes, mut borders) = (Vec::new(), Vec::new());
    for neck in &model.skeleton.necks {
        let next = neck.outline_m.iter().cycle().skip(1);
        for (&from_m, &to_m) in neck.outline_m.iter().zip(next) {
            panes.extend(super::mesh::face([neck.centre_m, from_m, to_m], f32::NAN, colour, 3));
            borders.push(line(from_m, to_m, 2.0, colour));
        }
    }
    (panes, borders)
}

/// A plain line.
pub fn line(a_m: Vec3, b_m: Vec3, width_px: f32, colour: [u8; 4]) -> Stroke {
    Stroke { a_m, b_m, width_px, value: f32::NAN, colour, dashed: false, arrow: false }
}
