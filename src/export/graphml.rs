//! The skeleton as GraphML (graphml.graphdrawing.org), for yEd, Gephi, NetworkX; units stand in the keys' names.

use crate::scene::Scene;
use crate::skeleton::Skeleton;
use petgraph::visit::EdgeRef;
use std::io::{self, Write};

/// What nodes and edges carry: for which of the two, and the attribute's name.
const KEYS: [(&str, &str, &str); 9] = [
    ("node", "x_m", "double"),
    ("node", "y_m", "double"),
    ("node", "z_m", "double"),
    ("node", "radius_m", "float"),
    ("node", "saliency", "float"),
    ("node", "cell", "int"),
    ("edge", "length_m", "float"),
    ("edge", "section_m2", "float"),
    ("edge", "neck", "int"),
];

/// Writes the skeleton as an undirected graph; an edge has a `neck` where it crosses one.
///
/// # Errors
/// What the writer says.
pub fn write(out: &mut dyn Write, scene: &Scene, skeleton: &Skeleton) -> io::Result<()> {
    writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(out, r#"<graphml xmlns="http://graphml.graphdrawing.org/xmlns">"#)?;
    for (of, name, kind) in KEYS {
        writeln!(out, r#"<key id="{name}" for="{of}" attr.name="{name}" attr.type="{kind}"/>"#)?;
    }
    writeln!(out, r#"<graph edgedefault="undirected">"#)?;
    for (id, node) in skeleton.graph.node_weights().enumerate() {
        let [x, y, z] = scene.to_user_m(node.position_m).to_array();
        writeln!(
            out,
            r#"<node id="n{id}"><data key="x_m">{x}</data><data key="y_m">{y}</data><data key="z_m">{z}</data><data key="radius_m">{}</data><data key="saliency">{}</data><data key="cell">{}</data></node>"#,
            node.radius_m,
            node.saliency(),
            node.cell
        )?;
    }
    for edge in skeleton.graph.edge_references() {
        let neck = edge.weight().neck.map(|neck| format!(r#"<data key="neck">{neck}</data>"#)).unwrap_or_default();
        writeln!(
            out,
            r#"<edge source="n{}" target="n{}"><data key="length_m">{}</data><data key="section_m2">{}</data>{neck}</edge>"#,
            edge.source().index(),
            edge.target().index(),
            edge.weight().length_m,
            edge.weight().section_m2
        )?;
    }
    writeln!(out, "</graph>\n</graphml>")
}
