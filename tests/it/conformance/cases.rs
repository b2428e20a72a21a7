//! Small scenes that are modelled in milliseconds. All sizes are multiples of an eighth of a metre, so that shifts by whole
//! voxels, doubling, mirrors and quarter turns are exact in `f32`.

use glam::{Mat3, Vec3};
use lightvein::job::{Cancel, Quiet};
use lightvein::model::{Model, Probe};
use lightvein::rays::Rays;
use lightvein::scene::{Light, Material, Mesh, Scene, Sensor};
use std::sync::Arc;

/// Voxels of the cases, metres.
pub const VOXEL_M: f32 = 0.125;

/// A scene, modelled.
pub struct Case {
    pub scene: Scene,
    pub model: Model,
}

impl Case {
    pub fn of(scene: Scene) -> Self {
        Self::at(scene, VOXEL_M)
    }

    pub fn at(scene: Scene, voxel_m: f32) -> Self {
        let rays = Arc::new(Rays::new(&scene));
        let model = Model::build(&scene, rays, voxel_m, u64::MAX, &Quiet, &Cancel::new()).expect("the case models");
        Self { scene, model }
    }

    pub fn probes(&self) -> Vec<Probe> {
        self.model.probes_at_sensors(&self.scene)
    }

    /// What is written of sensor number `at` in a breach.
    pub fn id(&self, at: usize) -> &str {
        &self.scene.sensors[at].id
    }
}

pub fn grey(reflectance: f32) -> Material {
    Material { name: String::new(), reflectance, transmittance: 0.0, emission_w_m2_sr: 0.0 }
}

pub fn point(position_m: Vec3, flux_w: f64) -> Light {
    Light::Point { position_m, flux_w }
}

pub fn sensor(position_m: Vec3, normal: Option<Vec3>) -> Sensor {
    let way = normal.map_or(String::new(), |normal| format!(" facing {normal}"));
    Sensor { id: format!("{position_m}{way}"), position_m, normal }
}

/// Adds a triangle.
pub fn triangle(mesh: &mut Mesh, material: u32, corners_m: [Vec3; 3]) {
    let first = mesh.positions_m.len() as u32;
    mesh.positions_m.extend(corners_m);
    mesh.triangles.push([first, first + 1, first + 2]);
    mesh.material_of.push(material);
}

/// Adds a parallelogram, its front along `u x v`.
pub fn quad(mesh: &mut Mesh, material: u32, corner: Vec3, u: Vec3, v: Vec3) {
    triangle(mesh, material, [corner, corner + u, corner + u + v]);
    triangle(mesh, material, [corner, corner + u + v, corner + v]);
}

/// Adds a closed box whose faces look inwards (a room), or outwards (`outwards`: a block).
pub fn boxed(mesh: &mut Mesh, material: u32, low: Vec3, high: Vec3, outwards: bool) {
    let size = high - low;
    let [x, y, z] = [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z];
    for (corner, u, v) in [(Vec3::ZERO, x, y), (z, y, x), (Vec3::ZERO, z, x), (y, x, z), (Vec3::ZERO, y, z), (x, z, y)]
    {
        let (u, v) = if outwards { (v, u) } else { (u, v) };
        quad(mesh, material, low + corner, u, v);
    }
}

/// An empty room from the origin to `size`.
pub fn room(size: Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    boxed(&mut mesh, 0, Vec3::ZERO, size, false);
    mesh
}

pub fn scene_of(mesh: Mesh, reflectance: f32, lights: Vec<Light>, sensors: Vec<Sensor>) -> Scene {
    Scene { mesh, materials: vec![grey(reflectance)], lights, sensors, ..Scene::default() }
}

/// Two rooms of 3 x 3 m, 2.5 m high, that a wall from x = 3 to 3.25 parts; the door in it goes from y = 2 to 3, floor to
/// ceiling. No face is hidden in another body.
pub fn two_rooms() -> Mesh {
    let mut mesh = Mesh::default();
    let z = Vec3::Z * 2.5;
    // Floor and ceiling leave out what the wall stands on.
    for (low, high) in [([0.0, 0.0], [3.0, 3.0]), ([3.0, 2.0], [3.25, 3.0]), ([3.25, 0.0], [6.25, 3.0])] {
        let (low, high) = (Vec3::new(low[0], low[1], 0.0), Vec3::new(high[0], high[1], 0.0));
        let (x, y) = (Vec3::X * (high.x - low.x), Vec3::Y * (high.y - low.y));
        quad(&mut mesh, 0, low, x, y);
        quad(&mut mesh, 0, low + z, y, x);
    }
    // Walls, the void to the left of each: round about as the corners go.
    let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [3.25, 2.0], [3.25, 0.0], [6.25, 0.0], [6.25, 3.0], [0.0, 3.0]];
    for (at, from) in corners.iter().enumerate() {
        let to = corners[(at + 1) % corners.len()];
        let from = Vec3::new(from[0], from[1], 0.0);
        quad(&mut mesh, 0, from, z, Vec3::new(to[0], to[1], 0.0) - from);
    }
    mesh
}

/// A lamp in each of the two rooms.
pub const LAMPS_M: [Vec3; 2] = [Vec3::new(0.96875, 1.03125, 1.78125), Vec3::new(5.3125, 0.71875, 1.53125)];

/// Where laws ask in the two rooms: points and planes in the open, on walls, in the door.
pub fn sensors_in_two_rooms() -> Vec<Sensor> {
    let places = [
        ([2.1875, 2.28125, 1.03125], None),
        ([2.03125, 0.71875, 0.0], Some(Vec3::Z)),
        ([2.15625, 1.84375, 1.28125], Some(Vec3::NEG_X)),
        ([3.15625, 2.46875, 1.28125], None),
        ([4.96875, 1.03125, 1.21875], None),
        ([6.25, 1.59375, 1.15625], Some(Vec3::NEG_X)),
        ([4.53125, 2.21875, 1.03125], Some(Vec3::NEG_X)),
    ];
    places.map(|(at, normal)| sensor(at.into(), normal)).into()
}

/// The two rooms with these lights.
pub fn lit_rooms(reflectance: f32, lights: Vec<Light>) -> Scene {
    scene_of(two_rooms(), reflectance, lights, sensors_in_two_rooms())
}

/// The two rooms at reflectance .7 with a lamp in the first and a weaker one in the second.
pub fn both_rooms() -> Scene {
    lit_rooms(0.7, vec![point(LAMPS_M[0], 100.0), point(LAMPS_M[1], 20.0)])
}

/// The scene after every place went through `turn` (orthogonal), then times `scale`, then by `shift_m`.
pub fn moved(scene: &Scene, turn: Mat3, scale: f32, shift_m: Vec3) -> Scene {
    let mut scene = scene.clone();
    let place = |at: Vec3| scale * (turn * at) + shift_m;
    scene.mesh.positions_m.iter_mut().for_each(|at| *at = place(*at));
    // A mirror turns fronts round; to swap two corners turns them back.
    let mirrors = turn.determinant() < 0.0;
    if mirrors {
        scene.mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    for sensor in &mut scene.sensors {
        sensor.position_m = place(sensor.position_m);
        sensor.normal = sensor.normal.map(|normal| turn * normal);
    }
    for light in &mut scene.lights {
        match light {
            Light::Point { position_m, .. } => *position_m = place(*position_m),
            Light::Sphere { centre_m, radius_m, .. } => {
                *centre_m = place(*centre_m);
                *radius_m *= scale;
            }
            Light::Quad { corner_m, u_m, v_m, .. } => {
                *corner_m = place(*corner_m);
                let (u, v) = (scale * (turn * *u_m), scale * (turn * *v_m));
                (*u_m, *v_m) = if mirrors { (v, u) } else { (u, v) };
            }
        }
    }
    scene
}
