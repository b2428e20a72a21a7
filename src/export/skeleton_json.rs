//! The skeleton as one JSON object: nodes, edges, cells and necks, with their units named in it.

use crate::light::Field;
use crate::scene::Scene;
use crate::skeleton::{Node, Skeleton};
use petgraph::visit::EdgeRef;
use serde::Serialize;
use std::io::{self, Write};

#[derive(Serialize)]
struct Document<'a> {
    scene: &'a str,
    units: Units,
    voxel_m: f32,
    nodes: Vec<NodeRow>,
    edges: Vec<EdgeRow>,
    cells: Vec<CellRow>,
    necks: Vec<NeckRow>,
}

#[derive(Serialize)]
struct Units {
    position: &'static str,
    radius: &'static str,
    length: &'static str,
    section: &'static str,
    area: &'static str,
    volume: &'static str,
    irradiance: &'static str,
    saliency: &'static str,
}

const UNITS: Units = Units {
    position: "m",
    radius: "m",
    length: "m",
    section: "m2",
    area: "m2",
    volume: "m3",
    irradiance: "W/m2, scalar",
    saliency: "1: distance over opening, 1 at the centre of a maximal ball",
};

#[derive(Serialize)]
struct NodeRow {
    id: usize,
    position: [f64; 3],
    radius: f32,
    saliency: f32,
    cell: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    irradiance: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct EdgeRow {
    ends: [usize; 2],
    length: f32,
    section: f32,
    neck: Option<u32>,
}

#[derive(Serialize)]
struct CellRow {
    id: usize,
    centre: usize,
    volume: f32,
}

#[derive(Serialize)]
struct NeckRow {
    id: usize,
    cells: [u32; 2],
    position: [f64; 3],
    normal: [f32; 3],
    area: f32,
}

/// Writes the skeleton; `at_nodes` is a field at its nodes, in their order.
///
/// # Errors
/// What the writer says.
pub fn write(out: &mut dyn Write, scene: &Scene, skeleton: &Skeleton, at_nodes: Option<&Field>) -> io::Result<()> {
    let node_row = |(id, node): (usize, &Node)| {
        let reading = at_nodes.and_then(|field| field.readings.get(id));
        NodeRow {
            id,
            position: scene.to_user_m(node.position_m).to_array(),
            radius: node.radius_m,
            saliency: node.saliency(),
            cell: node.cell,
            irradiance: reading.map(|reading| reading.value_w_m2),
            direction: reading.map(|reading| reading.direction().to_array()),
        }
    };
    let edges = skeleton.graph.edge_references().map(|edge| EdgeRow {
        ends: [edge.source().index(), edge.target().index()],
        length: edge.weight().length_m,
        section: edge.weight().section_m2,
        neck: edge.weight().neck,
    });
    let cells = skeleton.cells.iter().enumerate();
    let necks = skeleton.necks.iter().enumerate();

    let document = Document {
        scene: &scene.name,
        units: UNITS,
        voxel_m: skeleton.lattice.voxel_m,
        nodes: skeleton.graph.node_weights().enumerate().map(node_row).collect(),
        edges: edges.collect(),
        cells: cells.map(|(id, cell)| CellRow { id, centre: cell.centre.index(), volume: cell.volume_m3 }).collect(),
        necks: necks
            .map(|(id, neck)| NeckRow {
                id,
                cells: neck.cells,
                position: scene.to_user_m(neck.position_m).to_array(),
                normal: neck.normal.to_array(),
                area: neck.area_m2,
            })
            .collect(),
    };
    serde_json::to_writer(&mut *out, &document)?;
    writeln!(out)
}
