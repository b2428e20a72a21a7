//! What does a glTF 2 file say?
//!
//! The crate `gltf` parses and validates the document; buffers, accessors and the tree of nodes are walked here with
//! every range checked. Taken: triangles, strips and fans of the default scene (else the first, else all root nodes)
//! with the transforms of their nodes; of materials the luminance of `baseColorFactor` and of `emissiveFactor` times
//! `KHR_materials_emissive_strength`. A base colour that is all white or has a texture says nothing: it is what the
//! format puts where a writer had nothing to say. Skins, morph targets and compressed meshes are not read. glTF is in
//! metres with Y up.

use super::accessor::{Buffers, read_indices, read_positions};
use super::{MOST_EMISSION, RawMaterial, RawMesh, check_vertices, luminance, part};
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::{Input, counted, without_mark};
use ::gltf::json::validation::Checked;
use ::gltf::mesh::Mode;
use glam::{DMat4, DVec3};
use std::collections::HashMap;

/// Reads a glTF file, text or binary, with the buffers it names.
///
/// # Errors
/// [`SceneError`], with the line where the JSON of a text file is broken: documents that are not valid, buffers that are
/// missing or too short, nodes used twice, indices without a vertex, coordinates that are not finite or too large,
/// reflectances above 1.
pub fn read_gltf(input: &Input) -> Result<RawMesh, SceneError> {
    let stage = input.parse();
    let gltf = parse(input)?;
    drop(stage);
    let buffers = Buffers::load(input, &gltf.document, gltf.blob.as_deref())?;
    let mut mesh = RawMesh::default();
    let mut textures = 0;
    for material in gltf.document.materials() {
        textures += usize::from(material.pbr_metallic_roughness().base_color_texture().is_some());
        textures += usize::from(material.emissive_texture().is_some());
        let number = material.index().unwrap_or_default();
        mesh.materials.push(read_material(&material).map_err(|kind| in_material(input, number, kind))?);
    }

    input.progress.begin("nodes", gltf.document.nodes().len() as u64);
    let walked = read_nodes(input, &gltf.document, &buffers, &mut mesh);
    input.progress.end();
    let passed_over = walked?;
    let warnings = [
        (passed_over.primitives, "primitive", "of points or lines left out"),
        (passed_over.deformations, "mesh node", "with skin or morph targets taken at rest"),
        (textures, "texture", "not read"),
    ];
    for (count, thing, fate) in warnings.into_iter().filter(|&(count, ..)| count > 0) {
        mesh.warnings.push(format!("{} {fate}", counted(count, thing)));
    }
    Ok(mesh)
}

/// What is in a document and not read.
#[derive(Default)]
struct PassedOver {
    primitives: usize,
    deformations: usize,
}

/// Adds the meshes of all nodes to `mesh`.
fn read_nodes(
    input: &Input,
    document: &::gltf::Document,
    buffers: &Buffers,
    mesh: &mut RawMesh,
) -> Result<PassedOver, SceneError> {
    let mut passed_over = PassedOver::default();
    let (mut names, mut parts) = (HashMap::new(), HashMap::new());

    // The tree of nodes is walked with a stack of our own: a deep one would overflow that of the program.
    let mut visited = vec![false; document.nodes().len()];
    let mut open = roots(document);
    open.reverse();
    while let Some((node, above)) = open.pop() {
        input.progress.advance(1);
        input.cancel.check().map_err(|_| input.error(None, Kind::Cancelled))?;
        let twice = visited.get_mut(node.index()).is_none_or(|visited| std::mem::replace(visited, true));
        if twice {
            return Err(input.error(None, Kind::Gltf(format!("node {} has two parents", node.index()))));
        }
        let to_world =
            above * DMat4::from_cols_array_2d(&node.transform().matrix().map(|column| column.map(f64::from)));
        let children: Vec<_> = node.children().map(|child| (child, to_world)).collect();
        open.extend(children.into_iter().rev());

        let Some(instance) = node.mesh() else { continue };
        passed_over.deformations += usize::from(node.skin().is_some() || instance.weights().is_some());
        for primitive in instance.primitives() {
            if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
                passed_over.primitives += 1;
                continue;
            }
            let material = primitive.material().index().map(|number| number as u32).unwrap_or_else(|| {
                let name = instance.name().or(node.name()).map_or_else(|| input.stem(), str::to_owned);
                mesh.material(&mut names, &name)
            });
            read_primitive(input, buffers, &primitive, to_world, material, mesh)?;
        }
        // Nodes without a name of their own are told apart by their number: each is placed alone.
        let name = node.name().map_or_else(|| format!("node{}", node.index()), str::to_owned);
        let number = part(&mut mesh.parts, &mut parts, &name);
        mesh.part_of.resize(mesh.triangles.len(), number);
    }
    Ok(passed_over)
}

/// The validated document.
fn parse(input: &Input) -> Result<::gltf::Gltf, SceneError> {
    let bytes = without_mark(input.bytes);
    let binary = bytes.starts_with(b"glTF");

    // The crate takes the length of the header away from the length in it without a look.
    let length = bytes.get(8..12).and_then(|length| length.try_into().ok()).map(u32::from_le_bytes);
    if binary && length.is_some_and(|length| length < 12) {
        return Err(input.error(None, Kind::Gltf("the length in the header is below that of the header, 12".into())));
    }
    if binary && length.is_none_or(|length| u64::from(length) > bytes.len() as u64) {
        let (needed, left) = (u64::from(length.unwrap_or(12)), bytes.len() as u64);
        return Err(input.error(None, Kind::EndsEarly { what: "a GLB with its header".into(), needed, left }));
    }
    let explain = |error| match error {
        ::gltf::Error::Deserialize(error) => {
            let words = error.to_string();
            let words = words.split(" at line ").next().unwrap_or_default().to_owned();
            let line = if binary || error.line() == 0 { None } else { Some(error.line()) };
            input.error(line, Kind::Gltf(words))
        }
        ::gltf::Error::Validation(errors) => {
            let first = errors.first().map(|(path, error)| format!("{path}: {error}")).unwrap_or_default();
            let more = if errors.len() > 1 { format!(" (and {} more)", errors.len() - 1) } else { String::new() };
            input.error(None, Kind::Gltf(format!("{first}{more}")))
        }
        other => input.error(None, Kind::Gltf(other.to_string())),
    };
    let ::gltf::Gltf { document, blob } = ::gltf::Gltf::from_slice_without_validation(bytes).map_err(explain)?;

    // The crate's validation looks up the accessor of POSITION before it checks that there is one.
    let json = document.into_json();
    let positions = Checked::Valid(::gltf::Semantic::Positions);
    let mut primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let beyond = |index: &usize| *index >= json.accessors.len();
    if let Some(index) =
        primitives.find_map(|one| one.attributes.get(&positions).map(|index| index.value()).filter(beyond))
    {
        let words = format!("POSITION is accessor {index}, but there are {}", json.accessors.len());
        return Err(input.error(None, Kind::Gltf(words)));
    }
    let document = ::gltf::Document::from_json(json).map_err(explain)?;
    Ok(::gltf::Gltf { document, blob })
}

/// The nodes to begin with, each with nothing above it.
fn roots(document: &::gltf::Document) -> Vec<(::gltf::Node<'_>, DMat4)> {
    let scene = document.default_scene().or_else(|| document.scenes().next());
    if let Some(scene) = scene {
        return scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect();
    }
    let mut below = vec![false; document.nodes().count()];
    for child in document.nodes().flat_map(|node| node.children()) {
        if let Some(below) = below.get_mut(child.index()) {
            *below = true;
        }
    }
    let is_root = |node: &::gltf::Node| below.get(node.index()) == Some(&false);
    document.nodes().filter(is_root).map(|node| (node, DMat4::IDENTITY)).collect()
}

fn in_material(input: &Input, number: usize, kind: Kind) -> SceneError {
    let kind = match kind {
        Kind::Outside { what, value, bound } => {
            Kind::Outside { what: format!("material {number}: {what}"), value, bound }
        }
        Kind::NotFinite { what, value } => Kind::NotFinite { what: format!("material {number}: {what}"), value },
        other => other,
    };
    input.error(None, kind)
}

fn read_material(material: &::gltf::Material) -> Result<RawMaterial, Kind> {
    let pbr = material.pbr_metallic_roughness();
    let [red, green, blue, _] = pbr.base_color_factor().map(f64::from);
    if let Some(value) = [red, green, blue].into_iter().find(|share| !(0.0..=1.0).contains(share)) {
        return Err(Kind::Outside { what: "baseColorFactor".into(), value, bound: "0 to 1" });
    }
    let says_nothing = pbr.base_color_texture().is_some() || [red, green, blue] == [1.0; 3];
    let strength = f64::from(material.emissive_strength().unwrap_or(1.0));
    let emission = luminance(material.emissive_factor().map(f64::from)) * strength;
    if !emission.is_finite() {
        return Err(Kind::NotFinite { what: "emission".into(), value: emission });
    }
    if !(0.0..=MOST_EMISSION).contains(&emission) {
        return Err(Kind::Outside { what: "emission".into(), value: emission, bound: "0 to 1e9 W/m2/sr" });
    }
    Ok(RawMaterial {
        name: material.name().unwrap_or_default().to_owned(),
        reflectance: if says_nothing { None } else { Some(luminance([red, green, blue]).min(1.0)) },
        emission_w_m2_sr: emission,
    })
}

/// Adds the triangles of one primitive, placed by `to_world`.
fn read_primitive(
    input: &Input,
    buffers: &Buffers,
    primitive: &::gltf::Primitive,
    to_world: DMat4,
    material: u32,
    mesh: &mut RawMesh,
) -> Result<(), SceneError> {
    let Some(accessor) = primitive.get(&::gltf::Semantic::Positions) else {
        return Err(input.error(None, Kind::Gltf("a primitive has no POSITION".into())));
    };
    let first = mesh.positions.len();
    check_vertices(input, first.saturating_add(accessor.count()))?;
    let positions = read_positions(input, buffers, &accessor)?;
    for (number, position) in positions.iter().enumerate() {
        let placed: DVec3 = to_world.transform_point3(*position);
        let what = format_args!("vertex {number} of accessor {}", accessor.index());
        // The text is made for the error alone.
        if input.fits(placed) {
            mesh.positions.push(placed);
        } else {
            input.position(None, &what.to_string(), placed)?;
        }
    }
    let count = positions.len();
    let corners = match primitive.indices() {
        Some(accessor) => read_indices(input, buffers, &accessor, count)?,
        None => (0..count as u32).collect(),
    };
    check_vertices(input, mesh.triangles.len().saturating_add(corners.len()))?;

    // Transforms that mirror turn the front to the back.
    let mirrored = to_world.determinant() < 0.0;
    let mut add = |a: u32, b: u32, c: u32| {
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        mesh.triangles.push(corners.map(|corner| corner + first as u32));
        mesh.material_of.push(material);
    };
    match primitive.mode() {
        Mode::TriangleStrip => {
            for (number, corners) in corners.windows(3).enumerate() {
                let &[a, b, c] = corners else { continue };
                if number % 2 == 0 { add(a, b, c) } else { add(b, a, c) }
            }
        }
        Mode::TriangleFan => {
            let Some((&hub, rest)) = corners.split_first() else { return Ok(()) };
            rest.windows(2).for_each(|pair| add(hub, pair[0], pair[1]));
        }
        _ => corners.chunks_exact(3).for_each(|corners| add(corners[0], corners[1], corners[2])),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use std::path::Path;

    /// A unit triangle in the base64 of a data URI, 36 bytes of positions and 6 of indices.
    const BUFFER: &str =
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA";

    fn document(nodes: &str) -> String {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],
            "meshes":[{{"name":"lid","primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}},
                {{"attributes":{{"POSITION":0}},"mode":5}},{{"attributes":{{"POSITION":0}},"mode":1}}]}}],
            "materials":[{{"name":"red","pbrMetallicRoughness":{{"baseColorFactor":[0.5,0.5,0.5,1]}},"emissiveFactor":[1,1,1],
                "extensions":{{"KHR_materials_emissive_strength":{{"emissiveStrength":10}}}}}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
                {{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":6}}],
            "buffers":[{{"byteLength":42,"uri":"{BUFFER}"}}]}}"#
        )
    }

    fn read(text: &str) -> Result<RawMesh, SceneError> {
        read_gltf(&Input::alone(text.as_bytes(), Path::new("a.gltf"), &Quiet, &Cancel::new()))
    }

    #[test]
    fn nodes_place_their_meshes() {
        let nodes = r#"{"children":[1],"translation":[10,0,0]},{"mesh":0,"scale":[-2,1,1]}"#;
        let mesh = read(&document(nodes)).unwrap();
        let want = [[10.0, 0.0, 0.0], [8.0, 0.0, 0.0], [10.0, 1.0, 0.0]].map(DVec3::from_array);
        assert_eq!(mesh.positions, [want, want].concat());
        assert_eq!(mesh.triangles, [[0, 2, 1], [3, 5, 4]]);
        assert_eq!(mesh.material_of, [0, 1]);
        assert_eq!((mesh.materials[0].reflectance, mesh.materials[0].emission_w_m2_sr), (Some(0.5), 10.0));
        assert_eq!((mesh.materials[1].name.as_str(), mesh.materials[1].reflectance), ("lid", None));
        assert_eq!(mesh.warnings, ["1 primitive of points or lines left out"]);
    }

    #[test]
    fn broken_documents_are_refused() {
        #[track_caller]
        fn fails(text: &str, want: &str) {
            let error = read(text).expect_err("broken").to_string();
            assert!(error.contains(want), "{error}");
        }
        let good = document(r#"{"mesh":0}"#);
        fails(&good[..300], "a.gltf:4: glTF: EOF");
        fails(&document(r#"{"children":[1]},{"children":[0],"mesh":0}"#), "node 0 has two parents");
        fails(
            &good.replace("\"count\":3,\"type\":\"VEC3\"", "\"count\":4,\"type\":\"VEC3\""),
            "accessor 0 needs 48 bytes",
        );
        fails(&good.replace("\"byteLength\":6", "\"byteLength\":600"), "buffer view 1 needs 636 bytes, 42 are left");
        fails(&good.replace("AAABAAIA", "AAABAAkA"), "accessor 1 uses vertex 9, but there are 3");
        fails(&good.replace("AACAPw", "AADAfw"), "vertex 1 of accessor 0 NaN is not a finite number");
        fails(&good.replace("0.5,0.5,0.5", "2,2,2"), "material 0: baseColorFactor 2.0 is outside 0 to 1");
        fails(&good.replace("\"mesh\":0", "\"mesh\":5"), "glTF: nodes[0].mesh");
        fails(&good.replace(BUFFER, "gone.bin"), "gone.bin");
        fails(&good.replace("base64,", "base64,!"), "base64");
    }
}
