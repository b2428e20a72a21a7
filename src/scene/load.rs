//! How does a path become a [`Scene`]?
//!
//! The scene file is read and checked, then the meshes, sensors and references it names, relative to it; a bare mesh is
//! a scene without lights and sensors. All files are read whole, one after the other.

use super::error::{Kind, SceneError};
use super::file::{DEFAULT_REFLECTANCE, DescribedLight, Description, Lined, Override, Up, read_scene_file};
use super::input::{FARTHEST_M, Input, counted, read_file};
use super::merge::{Merged, OfFile, merge};
use super::parts::Part;
use super::read::{FORMATS, Format, RawMesh};
use super::reference::{match_sensors, read_reference_csv};
use super::sensors::{RawSensor, read_pts, read_sensors_csv};
use super::{Light, Material, Scene, Sensor, Site};
use crate::job::{Cancel, Progress};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// What [`Scene::load`] works with.
struct Loader<'a> {
    path: &'a Path,
    folder: PathBuf,
    progress: &'a dyn Progress,
    cancel: &'a Cancel,
}

impl Scene {
    /// Loads a scene file, or a mesh alone ([`Scene::bare`]: in metres, no lights, no sensors).
    ///
    /// What can be mended is counted in [`Scene::warnings`]. Reports the stages "read" and "parse" of each file in
    /// bytes, "nodes" of a glTF, and "merge". Memory: twice the largest file, and the mesh.
    ///
    /// # Errors
    /// [`SceneError`] with file, line, what and the bound for anything that cannot be used, see `docs/scene-file.md`;
    /// [`Kind::Cancelled`].
    pub fn load(path: &Path, progress: &dyn Progress, cancel: &Cancel) -> Result<Self, SceneError> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let loader = Loader { path, folder, progress, cancel };
        let is_scene_file = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
        if is_scene_file {
            let bytes = read_file(path, progress, cancel)?;
            let description = read_scene_file(&loader.input(path, &bytes, 1.0))?;
            return loader.scene(description, false);
        }
        if path.is_dir() {
            return Err(SceneError::new(path, None, Kind::Read(std::io::Error::other("it is a folder"))));
        }
        if Format::of(path).is_none() {
            let file = path.display().to_string();
            return Err(SceneError::new(path, None, Kind::UnknownFormat { file, known: FORMATS_AND_TOML }));
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let description = Description {
            meshes: vec![Lined { value: name, line: 0 }],
            unit_m: 1.0,
            reflectance: DEFAULT_REFLECTANCE,
            ..Description::default()
        };
        loader.scene(description, true)
    }
}

impl Site {
    /// The name and the site of a scene file, and nothing else of it: its meshes are not read. The weather file's path is
    /// made whole, and the file is there.
    ///
    /// # Errors
    /// As [`Scene::load`] for the scene file itself; a weather file that is not there.
    pub fn load(path: &Path, progress: &dyn Progress, cancel: &Cancel) -> Result<(String, Option<Self>), SceneError> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let loader = Loader { path, folder, progress, cancel };
        let bytes = read_file(path, progress, cancel)?;
        let description = read_scene_file(&loader.input(path, &bytes, 1.0))?;
        Ok((loader.name(&description), loader.site(&description)?))
    }
}

/// What [`Scene::load`] itself accepts.
const FORMATS_AND_TOML: &str = "toml (a scene file), obj, gltf, glb, ply, stl";

impl Loader<'_> {
    /// An input whose named files lie beside it.
    fn input<'b>(&'b self, path: &'b Path, bytes: &'b [u8], unit_m: f64) -> Input<'b> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let alone = Input::alone(bytes, path, self.progress, self.cancel);
        Input { farthest: FARTHEST_M / unit_m, folder: Some(folder), ..alone }
    }

    /// The bytes of a file that the scene file names in `line`.
    fn named(&self, what: &'static str, file: &Lined<String>, bare: bool) -> Result<(PathBuf, Vec<u8>), SceneError> {
        let path = if bare { self.path.to_owned() } else { self.folder.join(&file.value) };
        match read_file(&path, self.progress, self.cancel) {
            Ok(bytes) => Ok((path, bytes)),
            Err(SceneError { kind: Kind::Read(reason), .. }) if !bare => {
                let kind = Kind::Named { what, file: file.value.clone(), reason };
                Err(SceneError::new(self.path, file.line, kind))
            }
            Err(error) => Err(error),
        }
    }

    /// Everything that the description names, put together.
    fn scene(&self, description: Description, bare: bool) -> Result<Scene, SceneError> {
        let mut scene = Scene { bare, model: description.model, name: self.name(&description), ..Scene::default() };

        // Sensors and references before the meshes: their mistakes show at once, and not after minutes.
        let sensors = self.sensors(&description)?;
        if let (Some(file), true) = (&description.sensors, sensors.is_empty()) {
            scene.warnings.push(format!("{}: no sensors in it", file.value));
        }
        let rows = match &description.reference {
            None => None,
            Some(file) => {
                let (path, bytes) = self.named("reference", file, false)?;
                Some((path.clone(), read_reference_csv(&self.input(&path, &bytes, 1.0))?))
            }
        };
        scene.site = self.site(&description)?;

        let meshes = self.meshes(&description, bare)?;
        let (materials, numbers) = self.materials(&description, &meshes, &mut scene.warnings)?;
        scene.materials = materials;
        let mut names = Vec::new();
        let alone = meshes.len() == 1;
        let files =
            numbers.iter().zip(meshes).map(|(numbers, mesh)| mesh.into_file(numbers, alone, &mut names)).collect();
        self.progress.begin("merge", 0);
        let merged = merge(self.path, files, &scene.materials, self.cancel);
        self.progress.end();
        let Merged { mesh, origin_m, part_of, kept_by, warnings } = merged?;
        scene.parts = Part::of_triangles(names, &part_of, &kept_by);
        (scene.mesh, scene.origin_m) = (mesh, origin_m);
        scene.warnings.extend(warnings);

        scene.lights = description.lights.iter().map(|light| recentred(light, origin_m)).collect();
        let sensor = |raw: RawSensor| Sensor {
            id: raw.id,
            position_m: (raw.position_m - origin_m).as_vec3(),
            normal: raw.normal.map(|normal| normal.as_vec3().normalize()),
        };
        scene.sensors = sensors.into_iter().map(sensor).collect();
        if let Some((path, rows)) = rows {
            let (matched, unknown) = match_sensors(rows, &scene.sensors);
            let without = matched.iter().filter(|reference| reference.is_none()).count();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if unknown > 0 {
                scene.warnings.push(format!("{name}: {} left out that no sensor is called", counted(unknown, "id")));
            }
            if without > 0 {
                scene.warnings.push(format!("{name}: {} without a reference", counted(without, "sensor")));
            }
            scene.reference = matched;
        }
        Ok(scene)
    }

    fn sensors(&self, description: &Description) -> Result<Vec<RawSensor>, SceneError> {
        let Some(file) = &description.sensors else { return Ok(Vec::new()) };
        let (path, bytes) = self.named("sensors", file, false)?;
        let input = self.input(&path, &bytes, 1.0);
        match path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("csv") => read_sensors_csv(&input),
            Some("pts") => read_pts(&input),
            _ => {
                let kind = Kind::UnknownFormat { file: file.value.clone(), known: "csv, pts" };
                Err(SceneError::new(self.path, file.line, kind))
            }
        }
    }

    /// The name that the file gives the scene, or its own.
    fn name(&self, description: &Description) -> String {
        let stem = || self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        description.name.clone().unwrap_or_else(stem)
    }

    fn site(&self, description: &Description) -> Result<Option<Site>, SceneError> {
        let mut site = description.site.clone();
        if let Some(weather) = site.as_mut().and_then(|site| site.weather.as_mut()) {
            let path = self.folder.join(&*weather);
            if let Err(reason) = std::fs::metadata(&path) {
                let kind = Kind::Named { what: "weather", file: weather.display().to_string(), reason };
                return Err(SceneError::new(self.path, description.weather_line, kind));
            }
            *weather = path;
        }
        Ok(site)
    }

    /// All mesh files, in metres and Z up.
    fn meshes(&self, description: &Description, bare: bool) -> Result<Vec<LoadedMesh>, SceneError> {
        let mut meshes = Vec::new();
        for file in &description.meshes {
            let Some(format) = Format::of(Path::new(&file.value)) else {
                let kind = Kind::UnknownFormat { file: file.value.clone(), known: FORMATS };
                return Err(SceneError::new(self.path, file.line, kind));
            };
            let (path, bytes) = self.named("mesh", file, bare)?;
            let mut raw = format.read(&self.input(&path, &bytes, description.unit_m))?;
            drop(bytes);
            let by_format = if format == Format::Gltf { Up::Y } else { Up::Z };
            let up = description.up.unwrap_or(by_format);
            for position in &mut raw.positions {
                let p = *position * description.unit_m;
                *position = match up {
                    Up::Y => DVec3::new(p.x, -p.z, p.y),
                    Up::Z => p,
                };
            }
            meshes.push(LoadedMesh { path, raw });
        }
        Ok(meshes)
    }

    /// The materials of the scene, and for each mesh the number in it of each of its own.
    fn materials(
        &self,
        description: &Description,
        meshes: &[LoadedMesh],
        warnings: &mut Vec<String>,
    ) -> Result<(Vec<Material>, Vec<Vec<u32>>), SceneError> {
        let mut used = vec![false; description.overrides.len()];
        let (mut materials, mut numbers) = (Vec::new(), Vec::new());
        for mesh in meshes {
            let name = mesh.path.file_name().unwrap_or_default().to_string_lossy();
            warnings.extend(mesh.raw.warnings.iter().map(|warning| format!("{name}: {warning}")));
            let first = materials.len() as u32;
            numbers.push((first..first + mesh.raw.materials.len() as u32).collect());
            for raw in &mesh.raw.materials {
                let mut material = Material {
                    name: raw.name.clone(),
                    reflectance: raw.reflectance.map_or(description.reflectance, |reflectance| reflectance as f32),
                    transmittance: 0.0,
                    emission_w_m2_sr: raw.emission_w_m2_sr as f32,
                };
                for (entry, used) in description.overrides.iter().zip(&mut used) {
                    if entry.value.matches(&raw.name) {
                        *used = true;
                        apply(&entry.value, &mut material);
                        self.check_energy(&material, entry.line)?;
                    }
                }
                materials.push(material);
            }
        }
        for (entry, _) in description.overrides.iter().zip(used).filter(|(_, used)| !used) {
            warnings.push(format!("materials {:?} (line {}) match no face", entry.value.pattern, entry.line));
        }
        Ok((materials, numbers))
    }

    fn check_energy(&self, material: &Material, line: usize) -> Result<(), SceneError> {
        let &Material { reflectance, transmittance, .. } = material;
        // A rounding of the sum in f32 is no mistake of the user.
        if reflectance + transmittance <= 1.0 + 1e-6 {
            return Ok(());
        }
        let kind = Kind::TooBright { name: material.name.clone(), reflectance, transmittance };
        Err(SceneError::new(self.path, line, kind))
    }
}

/// A mesh file in metres, Z up.
struct LoadedMesh {
    path: PathBuf,
    raw: RawMesh,
}

impl LoadedMesh {
    /// The same with numbers of the scene: of materials, of which `numbers` has one for each of the mesh's own, and of parts,
    /// whose names are added to `names`: the file's name where it knows of no parts, and before them where several files may
    /// have parts of one name.
    fn into_file(self, numbers: &[u32], alone: bool, names: &mut Vec<String>) -> OfFile {
        let number = |&own: &u32| numbers.get(own as usize).copied().unwrap_or_default();
        let first = names.len() as u32;
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        match self.raw.parts.as_slice() {
            [] => names.push(stem.to_string()),
            parts if alone => names.extend_from_slice(parts),
            parts => names.extend(parts.iter().map(|part| format!("{stem}/{part}"))),
        }
        let part = |triangle: usize| first + self.raw.part_of.get(triangle).copied().unwrap_or_default();
        OfFile {
            part_of: (0..self.raw.triangles.len()).map(part).collect(),
            path: self.path,
            material_of: self.raw.material_of.iter().map(number).collect(),
            positions_m: self.raw.positions,
            triangles: self.raw.triangles,
            too_few_corners: self.raw.too_few_corners,
        }
    }
}

/// What the override says, put in place of what the material has. Glazing for which no reflectance is said has none:
/// what it does not pass on, it absorbs.
fn apply(entry: &Override, material: &mut Material) {
    let glazed = entry.transmittance.is_some_and(|transmittance| transmittance > 0.0);
    material.reflectance = entry.reflectance.unwrap_or(if glazed { 0.0 } else { material.reflectance });
    material.transmittance = entry.transmittance.unwrap_or(material.transmittance);
    material.emission_w_m2_sr = entry.emission_w_m2_sr.unwrap_or(material.emission_w_m2_sr);
}

/// A light of the description relative to the scene's origin.
fn recentred(light: &DescribedLight, origin_m: DVec3) -> Light {
    let here = |point: DVec3| (point - origin_m).as_vec3();
    match *light {
        DescribedLight::Point { position_m, flux_w } => Light::Point { position_m: here(position_m), flux_w },
        DescribedLight::Sphere { centre_m, radius_m, flux_w } => {
            Light::Sphere { centre_m: here(centre_m), radius_m: radius_m as f32, flux_w }
        }
        DescribedLight::Quad { corner_m, u_m, v_m, flux_w } => {
            Light::Quad { corner_m: here(corner_m), u_m: u_m.as_vec3(), v_m: v_m.as_vec3(), flux_w }
        }
    }
}
