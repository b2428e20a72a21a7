//! Scenes under the sky: what sun and sky bring to the ground, facades, roofs, and into a room.
//!
//! They have a site and no weather file, no light, and sensors with normals alone. The ground is part of the mesh: a closed
//! slab 0.5 m thick with its top at z = 0, so that it reflects; beyond its edge there is nothing. Normals point into the
//! air. Faces and sensors were fixed before any estimate was seen.

mod arcades;
mod blocks;
mod courtyard;
mod dice;
mod matter;
mod office;
mod open_air;
mod scatter;
mod solids;
mod street;

use std::path::Path;
use std::{fs, io};

pub use open_air::check;

use crate::scene::{MADE_BY, Mesh, Scene, Sensor, Table};

/// The folder of these scenes, in `scenes/`.
pub const FOLDER: &str = "outdoor";

/// Thickness of the ground.
const GROUND_M: f64 = 0.5;

/// A scene under the sky.
pub struct Outdoor {
    scene: Scene,
    /// First lines of the scene file.
    about: &'static str,
    /// Whether nothing overhangs: a map of heights tells all of it.
    is_height_field: bool,
}

/// All scenes under the sky.
pub fn scenes() -> Result<[Outdoor; 5], String> {
    Ok([courtyard::courtyard(), blocks::blocks()?, arcades::arcades()?, office::office(), street::street()?])
}

/// A mesh with its sensors.
fn scene(name: &'static str, mesh: Mesh, voxel_m: f64, about: &'static str, sensors: Vec<Sensor>) -> Scene {
    let tables = vec![Table { file: "sensors.csv", about, sensors }];
    Scene { name, mesh, materials: vec![], lights: vec![], voxel_m, tables, variants: vec![] }
}

impl Outdoor {
    /// Writes the folder `root/<name>`; references that lie there stay.
    pub fn write(&self, root: &Path) -> io::Result<()> {
        self.scene.write(root)?;
        let name = self.scene.name;
        fs::write(root.join(name).join(format!("{name}.toml")), self.toml())
    }

    /// One line for the person who ran the program.
    pub fn summary(&self) -> String {
        self.scene.summary()
    }

    fn toml(&self) -> String {
        let remarks: String = self.about.lines().map(|line| format!("# {line}\n")).collect();
        let (name, voxel_m) = (self.scene.name, self.scene.voxel_m);
        format!(
            "{MADE_BY}{remarks}name = \"{name}\"\n\n\
             [geometry]\nmeshes = [\"{name}.obj\"]\nunit_m = 1.0\nup = \"z\"\nreflectance = 0.5\n\n\
             [sensors]\nfile = \"sensors.csv\"\n\n\
             [model]\nvoxel_m = {voxel_m:?}\n\n\
             # Chicago; its weather is no part of this project, so the sky is a clear one.\n\
             [site]\nlatitude_deg = 41.98\nlongitude_deg = -87.92\nutc_offset_h = -6.0\nturbidity = 3.0\n"
        )
    }
}
