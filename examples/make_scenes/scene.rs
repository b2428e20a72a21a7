//! What a scene is made of and how it is written: `<name>.obj` (+ `.mtl`), scene files, tables of sensors.

use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use glam::{DQuat, DVec3};

/// The command that made a file, told in its first line.
pub const MADE_BY: &str = "# made by: cargo run --release --example make_scenes -- scenes\n";

/// Polygons over shared vertices, in metres, Z up; normals (right-hand rule) point into the void.
#[derive(Default)]
pub struct Mesh {
    pub vertices: Vec<DVec3>,
    /// Faces of one material each; a material without a name is left to the scene file.
    pub groups: Vec<(&'static str, Vec<Vec<usize>>)>,
}

/// A diffuse material, written to the MTL file as `Kd`.
pub struct Material {
    pub name: &'static str,
    pub rgb: [f64; 3],
}

/// Lights as the scene file knows them; fluxes in watts, lengths in metres.
pub enum Light {
    Point {
        position: DVec3,
        flux_w: f64,
    },
    Sphere {
        center: DVec3,
        radius: f64,
        flux_w: f64,
    },
    /// Shines to one side, along u x v.
    Quad {
        corner: DVec3,
        u: DVec3,
        v: DVec3,
        flux_w: f64,
    },
}

/// A sensor: scalar irradiance without a normal, irradiance with one.
pub struct Sensor {
    pub id: String,
    pub position: DVec3,
    pub normal: Option<DVec3>,
}

/// A table of sensors: `sensors.csv`, `sensors_200.csv`.
pub struct Table {
    pub file: &'static str,
    pub about: &'static str,
    pub sensors: Vec<Sensor>,
}

/// One scene file over the scene's mesh and lights.
pub struct Variant {
    pub name: &'static str,
    pub about: &'static str,
    /// Of every face without a material of its own.
    pub reflectance: f64,
    pub sensors: &'static str,
    pub reference: &'static str,
}

/// A folder of `scenes/`.
pub struct Scene {
    pub name: &'static str,
    pub mesh: Mesh,
    pub materials: Vec<Material>,
    pub lights: Vec<Light>,
    pub voxel_m: f64,
    pub tables: Vec<Table>,
    pub variants: Vec<Variant>,
}

/// A coordinate in whole tenths of a millimetre: short in a file, and the same on every machine.
fn tidy(p: [f64; 3]) -> DVec3 {
    (DVec3::from(p) * 1e4).round() / 1e4
}

/// A sensor on a slanted wall, placed to a micrometre; a tenth of a millimetre would be as much off its wall.
pub fn on_slant(id: String, position: DVec3, normal: DVec3) -> Sensor {
    Sensor { id, position: (position * 1e6).round() / 1e6, normal: Some((normal * 1e9).round() / 1e9) }
}

/// A sensor of scalar irradiance.
pub fn scalar(id: impl Into<String>, position: [f64; 3]) -> Sensor {
    Sensor { id: id.into(), position: tidy(position), normal: None }
}

/// A sensor that faces along `normal` (unit length).
pub fn planar(id: impl Into<String>, position: [f64; 3], normal: [f64; 3]) -> Sensor {
    Sensor { id: id.into(), position: tidy(position), normal: Some(DVec3::from(normal)) }
}

impl Mesh {
    /// How many triangles the polygons make when fanned.
    pub fn triangles(&self) -> usize {
        self.polygons().map(|p| p.len() - 2).sum()
    }

    /// Every polygon of every material.
    pub fn polygons(&self) -> impl Iterator<Item = &Vec<usize>> {
        self.groups.iter().flat_map(|(_, polygons)| polygons)
    }

    /// Corners of the triangles that the polygons make when fanned.
    pub fn triangle_corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.polygons().flat_map(|p| (1..p.len() - 1).map(|i| [p[0], p[i], p[i + 1]].map(|v| self.vertices[v])))
    }

    fn obj(&self, scene: &Scene) -> String {
        let mut text = format!("{MADE_BY}# {}, metres, Z up, normals into the void\n", scene.name);
        if !scene.materials.is_empty() {
            let _ = writeln!(text, "mtllib {}.mtl", scene.name);
        }
        for v in &self.vertices {
            let _ = writeln!(text, "v {} {} {}", v.x, v.y, v.z);
        }
        for (material, polygons) in &self.groups {
            if !material.is_empty() {
                let _ = writeln!(text, "usemtl {material}");
            }
            for polygon in polygons {
                text.push('f');
                for corner in polygon {
                    let _ = write!(text, " {}", corner + 1);
                }
                text.push('\n');
            }
        }
        text
    }
}

impl Table {
    fn csv(&self) -> String {
        let mut text = String::from(MADE_BY);
        for line in self.about.lines() {
            let _ = writeln!(text, "# {line}");
        }
        // A table of scalar sensors alone needs no columns for normals.
        let has_normals = self.sensors.iter().any(|s| s.normal.is_some());
        text.push_str(if has_normals { "id,x,y,z,nx,ny,nz\n" } else { "id,x,y,z\n" });
        for sensor in &self.sensors {
            let p = sensor.position;
            let _ = write!(text, "{},{},{},{}", sensor.id, p.x, p.y, p.z);
            match sensor.normal {
                Some(n) => {
                    let _ = writeln!(text, ",{},{},{}", n.x, n.y, n.z);
                }
                None => text.push_str(if has_normals { ",,,\n" } else { "\n" }),
            }
        }
        text
    }
}

impl Scene {
    /// The scene turned about the z axis: mesh, lights and sensors.
    pub fn turned(mut self, degrees: f64) -> Self {
        let turn = DQuat::from_rotation_z(degrees.to_radians());
        // Vertices and lights in whole tenths of a millimetre again.
        let place = |p: DVec3| tidy((turn * p).to_array());
        self.mesh.vertices = self.mesh.vertices.into_iter().map(place).collect();
        self.lights = self
            .lights
            .into_iter()
            .map(|light| match light {
                Light::Point { position, flux_w } => Light::Point { position: place(position), flux_w },
                Light::Sphere { center, radius, flux_w } => Light::Sphere { center: place(center), radius, flux_w },
                Light::Quad { corner, u, v, flux_w } => {
                    Light::Quad { corner: place(corner), u: place(u), v: place(v), flux_w }
                }
            })
            .collect();
        for sensor in self.tables.iter_mut().flat_map(|table| &mut table.sensors) {
            *sensor = match sensor.normal {
                Some(normal) => on_slant(sensor.id.clone(), turn * sensor.position, turn * normal),
                None => scalar(sensor.id.clone(), (turn * sensor.position).to_array()),
            };
        }
        self
    }

    /// Writes the folder `root/<name>`; references that lie there stay.
    pub fn write(&self, root: &Path) -> io::Result<()> {
        let folder = root.join(self.name);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join(format!("{}.obj", self.name)), self.mesh.obj(self))?;
        if !self.materials.is_empty() {
            fs::write(folder.join(format!("{}.mtl", self.name)), self.mtl())?;
        }
        for table in &self.tables {
            fs::write(folder.join(table.file), table.csv())?;
        }
        for variant in &self.variants {
            fs::write(folder.join(format!("{}.toml", variant.name)), self.toml(variant))?;
        }
        Ok(())
    }

    /// One line for the person who ran the program.
    pub fn summary(&self) -> String {
        let sensors: usize = self.tables.iter().map(|t| t.sensors.len()).sum();
        format!("{}: {} triangles, {} lights, {sensors} sensors", self.name, self.mesh.triangles(), self.lights.len())
    }

    fn mtl(&self) -> String {
        let mut text = String::from(MADE_BY);
        for Material { name, rgb } in &self.materials {
            let [r, g, b] = rgb;
            let _ = writeln!(text, "newmtl {name}\nKd {r} {g} {b}");
        }
        text
    }

    fn toml(&self, variant: &Variant) -> String {
        let mut text = String::from(MADE_BY);
        for line in variant.about.lines() {
            let _ = writeln!(text, "# {line}");
        }
        let _ = write!(
            text,
            "name = \"{}\"\n\n[geometry]\nmeshes = [\"{}.obj\"]\nunit_m = 1.0\nup = \"z\"\nreflectance = {:?}\n",
            variant.name, self.name, variant.reflectance
        );
        for light in &self.lights {
            text.push_str("\n[[lights]]\n");
            text.push_str(&light.toml());
        }
        let _ = write!(
            text,
            "\n[sensors]\nfile = \"{}\"\nreference = \"{}\"\n\n[model]\nvoxel_m = {:?}\n",
            variant.sensors, variant.reference, self.voxel_m
        );
        text
    }
}

impl Light {
    fn toml(&self) -> String {
        let list = |p: &DVec3| format!("[{:?}, {:?}, {:?}]", p.x, p.y, p.z);
        match self {
            Light::Point { position, flux_w } => {
                format!("kind = \"point\"\nposition = {}\nflux_w = {flux_w:?}\n", list(position))
            }
            Light::Sphere { center, radius, flux_w } => {
                format!("kind = \"sphere\"\ncenter = {}\nradius = {radius:?}\nflux_w = {flux_w:?}\n", list(center))
            }
            Light::Quad { corner, u, v, flux_w } => format!(
                "kind = \"quad\"\ncorner = {}\nu = {}\nv = {}\nflux_w = {flux_w:?}\n",
                list(corner),
                list(u),
                list(v)
            ),
        }
    }

    /// A point of the void that the light must not have left.
    pub fn place(&self) -> DVec3 {
        match self {
            Light::Point { position, .. } => *position,
            Light::Sphere { center, .. } => *center,
            Light::Quad { corner, u, v, .. } => *corner + (*u + *v) * 0.5,
        }
    }
}
