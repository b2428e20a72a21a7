//! PLY files (ASCII, so that their comments and a reader's eye can go over them): the skeleton, and the mesh with values.

use crate::light::Field;
use crate::scene::Scene;
use crate::skeleton::Skeleton;
use glam::Vec3;
use petgraph::visit::EdgeRef;
use std::io::{self, Write};

/// Writes the skeleton: vertices with radius and scalar irradiance (0 without a field), and edges.
///
/// # Errors
/// What the writer says.
pub fn write_skeleton(
    out: &mut dyn Write,
    scene: &Scene,
    skeleton: &Skeleton,
    at_nodes: Option<&Field>,
) -> io::Result<()> {
    let graph = &skeleton.graph;
    writeln!(out, "ply\nformat ascii 1.0")?;
    writeln!(out, "comment positions, radius and length in m; flux is scalar irradiance in W/m2; section in m2")?;
    writeln!(out, "element vertex {}", graph.node_count())?;
    writeln!(
        out,
        "property double x\nproperty double y\nproperty double z\nproperty float radius\nproperty float flux"
    )?;
    writeln!(out, "element edge {}", graph.edge_count())?;
    writeln!(
        out,
        "property int vertex1\nproperty int vertex2\nproperty float length\nproperty float section\nend_header"
    )?;
    for (id, node) in graph.node_weights().enumerate() {
        let [x, y, z] = scene.to_user_m(node.position_m).to_array();
        let flux = at_nodes.and_then(|field| field.readings.get(id)).map_or(0.0, |reading| reading.value_w_m2);
        writeln!(out, "{x} {y} {z} {} {flux:e}", node.radius_m)?;
    }
    for edge in graph.edge_references() {
        let [a, b] = [edge.source().index(), edge.target().index()];
        writeln!(out, "{a} {b} {} {}", edge.weight().length_m, edge.weight().section_m2)?;
    }
    Ok(())
}

/// Writes triangles with an irradiance each: three vertices a triangle, in the order of `readings`.
///
/// # Errors
/// What the writer says.
pub fn write_mesh_field(
    out: &mut dyn Write,
    scene: &Scene,
    triangles_m: &[[Vec3; 3]],
    field: &Field,
) -> io::Result<()> {
    writeln!(out, "ply\nformat ascii 1.0")?;
    writeln!(out, "comment positions in m; irradiance in W/m2 on the side of the face that sees the void")?;
    writeln!(out, "element vertex {}", 3 * triangles_m.len())?;
    writeln!(out, "property double x\nproperty double y\nproperty double z")?;
    writeln!(out, "element face {}", triangles_m.len())?;
    writeln!(out, "property list uchar int vertex_indices\nproperty float irradiance\nend_header")?;
    for corner_m in triangles_m.iter().flatten() {
        let [x, y, z] = scene.to_user_m(*corner_m).to_array();
        writeln!(out, "{x} {y} {z}")?;
    }
    for (face, reading) in field.readings.iter().take(triangles_m.len()).enumerate() {
        writeln!(out, "3 {} {} {} {:e}", 3 * face, 3 * face + 1, 3 * face + 2, reading.value_w_m2)?;
    }
    Ok(())
}
