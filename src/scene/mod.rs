//! What did the user describe: mesh, materials, lights, sensors, references, site?
//!
//! After loading, everything is in metres, Z up, +Y north, +X east, and recentred: positions are relative to
//! [`Scene::origin_m`], so that city coordinates keep their millimetres in `f32`. Whoever writes a position to a file
//! adds the origin back ([`Scene::to_user_m`]).
//!
//! In a scene file `unit_m` and `up` describe the mesh files alone: lights and sensors are in metres, Z up, as the mesh is
//! after loading. The user's format is described in `docs/scene-file.md`.

pub mod error;
pub mod file;
pub mod input;
mod load;
mod merge;
pub mod parts;
pub mod read;
pub mod reference;
pub mod sensors;

use glam::{DVec3, Vec3};
use std::path::PathBuf;

pub use error::{Kind, SceneError};

/// One scene, ready to be voxelised and traced.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// Its name, from the scene file or the mesh's file name.
    pub name: String,
    /// What to add to a position here to get the user's own, metres; whole metres.
    pub origin_m: DVec3,
    /// All meshes as one.
    pub mesh: Mesh,
    /// The parts of the mesh that its files name, in their order; every triangle is in one.
    pub parts: Vec<parts::Part>,
    /// Materials; [`Mesh::material_of`] points into them.
    pub materials: Vec<Material>,
    /// Lights of the scene file, in its order (emissive mesh faces come besides: see `light::Sources`).
    pub lights: Vec<Light>,
    /// Sensors in the order of their file.
    pub sensors: Vec<Sensor>,
    /// References, one entry a sensor, `None` where the file has no row for it; empty when there is no file.
    pub reference: Vec<Option<Reference>>,
    /// What the file's `[model]` chooses.
    pub model: ModelChoice,
    /// The file's `[site]`.
    pub site: Option<Site>,
    /// Whether a mesh was loaded without a scene file: lights and sensors are not missing but were never asked for.
    pub bare: bool,
    /// What loading had to mend or leave out, counted, a sentence each.
    pub warnings: Vec<String>,
}

impl Scene {
    /// A position of this scene in the user's own coordinates, metres.
    pub fn to_user_m(&self, position_m: Vec3) -> DVec3 {
        position_m.as_dvec3() + self.origin_m
    }
}

/// Triangles with a material each. Vertices are in metres, in scene space.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions, metres.
    pub positions_m: Vec<Vec3>,
    /// Vertex numbers of each triangle, counter-clockwise seen from its front.
    pub triangles: Vec<[u32; 3]>,
    /// Material number of each triangle.
    pub material_of: Vec<u32>,
}

impl Mesh {
    /// The corners of triangle `triangle`, metres; `None` for a number beyond the mesh.
    pub fn corners_m(&self, triangle: usize) -> Option<[Vec3; 3]> {
        let [a, b, c] = *self.triangles.get(triangle)?;
        let at = |vertex: u32| self.positions_m.get(vertex as usize).copied();
        Some([at(a)?, at(b)?, at(c)?])
    }

    /// The lowest and highest corner of the box around all triangles, metres; `None` for a mesh without triangles.
    pub fn bounds_m(&self) -> Option<(Vec3, Vec3)> {
        let corners = self.triangles.iter().flatten().filter_map(|&vertex| self.positions_m.get(vertex as usize));
        corners.fold(None, |bounds, &corner| match bounds {
            None => Some((corner, corner)),
            Some((low, high)) => Some((low.min(corner), high.max(corner))),
        })
    }
}

/// How a surface answers light: Lambertian on both sides, one broadband channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The mesh's name for it; for faces without a material, the name of their object, group or file.
    pub name: String,
    /// Share of the light reflected diffusely, 0 to 1 (of a colour: its Rec. 709 luminance).
    pub reflectance: f32,
    /// Share of the light passed straight on, 0 to 1; above 0 it is thin glazing and not solid.
    pub transmittance: f32,
    /// Radiance given off on the front side, W/m2/sr. Above 0 the face is a light: opaque and black on both sides,
    /// whatever its other shares.
    pub emission_w_m2_sr: f32,
}

impl Material {
    /// Share of the light that a face of it sends back diffusely: nothing where it is a light itself.
    pub fn reflects(&self) -> f32 {
        if self.emits() { 0.0 } else { self.reflectance }
    }

    /// Share of the light that passes straight through a face of it: nothing where it is a light itself.
    pub fn passes(&self) -> f32 {
        if self.emits() { 0.0 } else { self.transmittance }
    }

    /// Whether its faces are lights.
    pub fn emits(&self) -> bool {
        self.emission_w_m2_sr > 0.0
    }
}

impl Scene {
    /// The material of a triangle; `None` for a number beyond the mesh.
    pub fn material(&self, triangle: usize) -> Option<&Material> {
        self.materials.get(*self.mesh.material_of.get(triangle)? as usize)
    }
}

/// A light of the scene file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// Isotropic and without a size; intensity is `flux_w / (4 pi)`.
    Point {
        /// Where it is, metres.
        position_m: Vec3,
        /// Its total flux, W.
        flux_w: f64,
    },
    /// A Lambertian sphere; opaque and black.
    Sphere {
        /// Its centre, metres.
        centre_m: Vec3,
        /// Its radius, metres.
        radius_m: f32,
        /// Its total flux, W.
        flux_w: f64,
    },
    /// A Lambertian parallelogram that emits along `u x v` alone; opaque and black.
    Quad {
        /// One corner, metres.
        corner_m: Vec3,
        /// The edge to the next corner, metres.
        u_m: Vec3,
        /// The edge to the last corner, metres.
        v_m: Vec3,
        /// Its total flux, W.
        flux_w: f64,
    },
}

/// Where light is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Its name in the tables.
    pub id: String,
    /// Where it is, metres.
    pub position_m: Vec3,
    /// Unit normal for planar irradiance (cosine, one side); `None` for scalar irradiance.
    pub normal: Option<Vec3>,
}

/// A trusted value at a sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// Irradiance, or scalar irradiance for a sensor without a normal, W/m2.
    pub irradiance_w_m2: f64,
    /// Its standard error, W/m2.
    pub stderr_w_m2: f64,
    /// Integral of L(w) w dw, w pointing away from the sensor, W/m2; zero where it is not known.
    pub flux_w_m2: DVec3,
}

/// What the scene file's `[model]` says; the command line overrides it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ModelChoice {
    /// Voxel edge, metres.
    pub voxel_m: Option<f32>,
    /// Estimator.
    pub method: Option<Method>,
    /// Factor within which the estimate is to be right.
    pub tolerance: Option<f64>,
    /// Threads to work on.
    pub threads: Option<usize>,
    /// Seed of all random numbers.
    pub seed: Option<u64>,
}

/// The built-in ways to answer how much light reaches a sensor. This is the closed set; a user's own heuristic comes in
/// as a closure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Method {
    /// The poster's upper estimate, by the farthest visible node of the shortest path.
    Backward,
    /// The poster's flux carried along the shortest-path tree.
    Forward,
    /// Light as a current through resistors.
    Diffusion,
    /// Exchange of light among patches of wall, with all reflections.
    Network,
    /// The path tracer, as a method beside the others.
    Trace,
}

impl Method {
    /// All of them, in the order of the tables.
    pub const ALL: [Method; 5] = [Method::Backward, Method::Forward, Method::Diffusion, Method::Network, Method::Trace];

    /// Its name in scene files, on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Backward => "backward",
            Method::Forward => "forward",
            Method::Diffusion => "diffusion",
            Method::Network => "network",
            Method::Trace => "trace",
        }
    }

    /// The method of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str(self.name())
    }
}

/// Where on earth the scene stands, and for which period it is asked.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Site {
    /// Latitude, degrees, north positive.
    pub latitude_deg: Option<f64>,
    /// Longitude, degrees, east positive.
    pub longitude_deg: Option<f64>,
    /// Zone, hours ahead of UTC.
    pub utc_offset_h: Option<f64>,
    /// Direction of true north, degrees clockwise from +Y.
    pub north_deg: f64,
    /// Turbidity of the clear sky.
    pub turbidity: Option<f64>,
    /// Reflectance of the ground round about, 0 to 1.
    pub ground_albedo: Option<f64>,
    /// Weather file.
    pub weather: Option<PathBuf>,
    /// First day, month and day of the month.
    pub start: Option<(u8, u8)>,
    /// Last day.
    pub end: Option<(u8, u8)>,
    /// Step, minutes.
    pub step_min: Option<f64>,
}
