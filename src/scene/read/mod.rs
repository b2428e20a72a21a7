//! What does a mesh file say, whatever its format?
//!
//! One reader a format, each from bytes to a [`RawMesh`] in the file's own units and axes. The readers of OBJ, PLY and
//! STL are our own. The crates for these (tobj 4.0, ply-rs-bw 4.0, stl_io 0.11) give no lines (tobj, stl_io), fail on
//! names in Latin-1, panic on `Kd 0.5` (tobj) or fill memory for a damaged count (ply-rs-bw, an element without
//! properties); and finding the line of an error afterwards takes a second parser that makes the first one superfluous.
//! The tests hold our readers to these crates on valid files. glTF is parsed and validated by the crate `gltf`; its binary
//! data are taken apart here, with every range checked.

use super::error::{Kind, SceneError};
use super::input::Input;
use glam::DVec3;

mod accessor;
pub mod gltf;
pub mod mtl;
pub mod obj;
pub mod ply;
mod polygon;
pub mod stl;

/// Most vertices of one mesh file, instances counted; 1.5 GB of positions. More would come from a damaged count.
pub const MOST_VERTICES: usize = 64 << 20;

/// Largest radiance that is accepted, W/m2/sr; the disc of the sun has 2e7.
pub const MOST_EMISSION: f64 = 1e9;

/// Endings of the mesh formats that can be read.
pub const FORMATS: &str = "obj, gltf, glb, ply, stl";

/// A mesh as its file gives it: own units, own axes, nothing left out yet.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RawMesh {
    /// Vertices, finite.
    pub positions: Vec<DVec3>,
    /// Vertex numbers, in range.
    pub triangles: Vec<[u32; 3]>,
    /// Material of each triangle, in range.
    pub material_of: Vec<u32>,
    /// Materials of the file.
    pub materials: Vec<RawMaterial>,
    /// Names of the parts that the file has, as objects, groups or nodes; empty where it knows of none.
    pub parts: Vec<String>,
    /// Part of each triangle, in range; empty where the file knows of none.
    pub part_of: Vec<u32>,
    /// Faces with fewer than three corners, left out already.
    pub too_few_corners: usize,
    /// What the reader mended or left out, a sentence each, without the file's name.
    pub warnings: Vec<String>,
}

/// Number of the part of that name, a new one if there is none yet. Cost: `known` holds the numbers by name.
fn part(parts: &mut Vec<String>, known: &mut std::collections::HashMap<String, u32>, name: &str) -> u32 {
    if let Some(&number) = known.get(name) {
        return number;
    }
    let number = parts.len() as u32;
    parts.push(name.to_owned());
    known.insert(name.to_owned(), number);
    number
}

/// A material as its file gives it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RawMaterial {
    /// Its name, or what else names its faces.
    pub name: String,
    /// Diffuse reflectance, if the file gives one, 0 to 1.
    pub reflectance: Option<f64>,
    /// Radiance given off, W/m2/sr.
    pub emission_w_m2_sr: f64,
}

impl RawMesh {
    /// Number of the material of that name, a new one without properties if there is none yet. Cost: `known` holds
    /// the numbers by name.
    fn material(&mut self, known: &mut std::collections::HashMap<String, u32>, name: &str) -> u32 {
        if let Some(&number) = known.get(name) {
            return number;
        }
        let number = self.materials.len() as u32;
        self.materials.push(RawMaterial { name: name.to_owned(), ..RawMaterial::default() });
        known.insert(name.to_owned(), number);
        number
    }
}

/// Which reader an ending asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ with MTL.
    Obj,
    /// glTF 2 as text or binary.
    Gltf,
    /// Stanford PLY.
    Ply,
    /// STL, text or binary.
    Stl,
}

impl Format {
    /// The format of a file by its ending, in any case.
    pub fn of(path: &std::path::Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "gltf" | "glb" => Some(Self::Gltf),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            _ => None,
        }
    }

    /// Reads a mesh of this format.
    ///
    /// # Errors
    /// [`SceneError`] at the place of the first thing that is wrong.
    pub fn read(self, input: &Input) -> Result<RawMesh, SceneError> {
        match self {
            Self::Obj => obj::read_obj(input),
            Self::Gltf => gltf::read_gltf(input),
            Self::Ply => ply::read_ply(input),
            Self::Stl => stl::read_stl(input),
        }
    }
}

/// Refuses a mesh with more vertices than can be numbered or held.
fn check_vertices(input: &Input, count: usize) -> Result<(), SceneError> {
    if count <= MOST_VERTICES {
        return Ok(());
    }
    let kind = Kind::TooMany { what: "vertices", count: count as u64, most: MOST_VERTICES as u64 };
    Err(input.error(None, kind))
}

/// Rec. 709 luminance of a linear colour.
pub fn luminance(colour: [f64; 3]) -> f64 {
    let [red, green, blue] = colour;
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}
