//! What shines in a scene, and from where?
//!
//! The lights of the scene file come first, then the emissive faces of the mesh, joined into patches: triangles of one
//! material that share a corner position. A patch emits on its front side alone and reflects nothing, like a quad light;
//! its flux is `pi L A`.

use super::{Emitter, Shape, Sources};
use crate::rays::{Rays, Surface};
use crate::scene::{Light, Mesh, Scene};
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::PI;

/// Below this share of its area, the vector area of a patch is rounding, and the patch is taken for a closed body that
/// faces every way.
const CLOSED_SHARE: f64 = 1e-3;

/// Where an emitter stands for those who see it as a point, and where it shines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// Its centre, metres; on the surface of a quad, inside a sphere, anywhere near a bent patch.
    pub position_m: Vec3,
    /// The unit normal of the side it shines on; `None` where it shines all around.
    pub facing: Option<Vec3>,
}

impl Sources {
    /// The sources of a scene: its lights in their order, then the emissive patches by their lowest triangle. Emissive
    /// faces without an area give none. Cost: linear in the emissive triangles.
    pub fn of(scene: &Scene) -> Self {
        let lights = scene.lights.iter().enumerate();
        let lights =
            lights.map(|(number, &light)| Emitter { shape: Shape::Light(number, light), flux_w: light.flux_w() });
        let patches = emissive_patches(scene).into_iter();
        let patches = patches.filter_map(|(triangles, radiance)| patch(&scene.mesh, triangles, radiance));
        Self { emitters: lights.chain(patches).collect() }
    }

    /// The flux of all of them, W.
    pub fn flux_w(&self) -> f64 {
        self.emitters.iter().map(|emitter| emitter.flux_w).sum()
    }
}

impl Emitter {
    /// Where it stands and where it shines.
    pub fn aim(&self) -> Aim {
        match self.shape {
            Shape::Light(_, Light::Point { position_m, .. }) => Aim { position_m, facing: None },
            Shape::Light(_, Light::Sphere { centre_m, .. }) => Aim { position_m: centre_m, facing: None },
            Shape::Light(_, Light::Quad { corner_m, u_m, v_m, .. }) => {
                Aim { position_m: corner_m + 0.5 * (u_m + v_m), facing: u_m.cross(v_m).try_normalize() }
            }
            Shape::Patch { centroid_m, normal, .. } => {
                Aim { position_m: centroid_m, facing: Some(normal).filter(|&normal| normal != Vec3::ZERO) }
            }
        }
    }

    /// Whether that surface is part of this emitter's body.
    pub fn owns(&self, surface: Surface) -> bool {
        match (&self.shape, surface) {
            (Shape::Light(number, _), Surface::Light(hit)) => *number == hit,
            (Shape::Patch { triangles, .. }, Surface::Triangle(hit)) => triangles.binary_search(&hit).is_ok(),
            _ => false,
        }
    }

    /// The share of light that passes straight from the emitter's centre to a point in the open: 0 behind it or where
    /// something opaque lies between, below 1 through glazing. Its own body does not count.
    pub fn seen_from(&self, rays: &Rays, point_m: Vec3) -> f32 {
        let aim = self.aim();
        if aim.facing.is_some_and(|facing| facing.dot(point_m - aim.position_m) <= 0.0) {
            return 0.0;
        }
        let target_m = aim.position_m + aim.facing.unwrap_or(Vec3::ZERO) * rays.epsilon_m();
        rays.transmitted_past(point_m, target_m, |surface| self.owns(surface))
    }
}

/// The triangles of each patch, ascending, with their radiance.
fn emissive_patches(scene: &Scene) -> Vec<(Vec<u32>, f64)> {
    let Mesh { triangles, material_of, .. } = &scene.mesh;
    let emission = |material: u32| {
        scene.materials.get(material as usize).map_or(0.0, |material| f64::from(material.emission_w_m2_sr))
    };
    let shining: Vec<usize> =
        (0..triangles.len().min(material_of.len())).filter(|&triangle| emission(material_of[triangle]) > 0.0).collect();

    // Join each triangle to the first one of its material at each of its corners; the lowest number leads.
    let mut leader: Vec<usize> = (0..shining.len()).collect();
    let mut first_at: HashMap<(u32, [u32; 3]), usize> = HashMap::new();
    for (number, &triangle) in shining.iter().enumerate() {
        for corner_m in scene.mesh.corners_m(triangle).into_iter().flatten() {
            // Adding zero joins -0 with 0.
            let place = (corner_m + 0.0).to_array().map(f32::to_bits);
            let first = *first_at.entry((material_of[triangle], place)).or_insert(number);
            let (a, b) = (leader_of(&mut leader, first), leader_of(&mut leader, number));
            leader[a.max(b)] = a.min(b);
        }
    }
    let mut patches: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for (number, &triangle) in shining.iter().enumerate() {
        patches.entry(leader_of(&mut leader, number)).or_default().push(triangle as u32);
    }
    patches.into_iter().map(|(first, triangles)| (triangles, emission(material_of[shining[first]]))).collect()
}

fn leader_of(leader: &mut [usize], mut number: usize) -> usize {
    while leader[number] != number {
        leader[number] = leader[leader[number]];
        number = leader[number];
    }
    number
}

fn patch(mesh: &Mesh, triangles: Vec<u32>, radiance_w_m2_sr: f64) -> Option<Emitter> {
    let (mut area_m2, mut moment, mut vector_area) = (0.0, DVec3::ZERO, DVec3::ZERO);
    for corners_m in triangles.iter().filter_map(|&triangle| mesh.corners_m(triangle as usize)) {
        let [a, b, c] = corners_m.map(|corner_m| corner_m.as_dvec3());
        let half_cross = 0.5 * (b - a).cross(c - a);
        area_m2 += half_cross.length();
        vector_area += half_cross;
        moment += half_cross.length() * (a + b + c) / 3.0;
    }
    if area_m2 <= 0.0 {
        return None;
    }
    let normal = if vector_area.length() > CLOSED_SHARE * area_m2 { vector_area.normalize() } else { DVec3::ZERO };
    let (centroid_m, normal) = ((moment / area_m2).as_vec3(), normal.as_vec3());
    let shape = Shape::Patch { triangles, radiance_w_m2_sr, area_m2, centroid_m, normal };
    Some(Emitter { shape, flux_w: PI * radiance_w_m2_sr * area_m2 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;

    fn shining(emission_w_m2_sr: f32) -> Material {
        Material { name: String::new(), reflectance: 0.5, transmittance: 0.0, emission_w_m2_sr }
    }

    /// Three unit squares: two that touch along an edge, and one apart; the second of another material on demand.
    fn squares(material_of_second: u32) -> Scene {
        let mut mesh = Mesh::default();
        for (number, x) in [0.0, 1.0, 3.0].into_iter().enumerate() {
            let corners = [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0)].map(|(x, y)| Vec3::new(x, y, -0.0));
            let first = mesh.positions_m.len() as u32;
            mesh.positions_m.extend(corners);
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            mesh.material_of.extend([if number == 1 { material_of_second } else { 1 }; 2]);
        }
        Scene { mesh, materials: vec![shining(0.0), shining(10.0), shining(10.0)], ..Scene::default() }
    }

    #[test]
    fn touching_faces_of_one_material_are_one_patch() {
        let sources = Sources::of(&squares(1));
        let [first, second] = &sources.emitters[..] else { panic!("{sources:?}") };
        let Shape::Patch { triangles, area_m2, centroid_m, normal, .. } = &first.shape else { panic!("{first:?}") };
        assert_eq!((&triangles[..], *area_m2), (&[0, 1, 2, 3][..], 2.0));
        assert!(centroid_m.distance(Vec3::new(1.0, 0.5, 0.0)) < 1e-6);
        assert_eq!(*normal, Vec3::Z);
        assert!((first.flux_w - 20.0 * PI).abs() < 1e-9);
        assert!(second.owns(Surface::Triangle(5)) && !second.owns(Surface::Triangle(0)));
        assert_eq!(Sources::of(&squares(2)).emitters.len(), 3);
        assert_eq!(Sources::of(&squares(0)).emitters.len(), 2);
    }

    #[test]
    fn a_closed_patch_faces_every_way() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mesh = Mesh { positions_m: corners.to_vec(), triangles, material_of: vec![0; 4] };
        let scene = Scene { mesh, materials: vec![shining(1.0)], ..Scene::default() };
        let sources = Sources::of(&scene);
        assert_eq!(sources.emitters.len(), 1);
        assert_eq!(sources.emitters[0].aim().facing, None);
        let rays = Rays::new(&scene);
        assert_eq!(sources.emitters[0].seen_from(&rays, Vec3::splat(5.0)), 1.0);
    }

    #[test]
    fn a_quad_is_seen_from_its_front_alone_past_its_own_body() {
        let quad = Light::Quad { corner_m: Vec3::ZERO, u_m: Vec3::X, v_m: Vec3::Y, flux_w: 1.0 };
        let sphere = Light::Sphere { centre_m: Vec3::new(0.5, 0.5, 3.0), radius_m: 0.5, flux_w: 1.0 };
        let scene = Scene { lights: vec![quad, sphere], ..Scene::default() };
        let (rays, sources) = (Rays::new(&scene), Sources::of(&scene));
        let seen = |light: usize, z: f32| sources.emitters[light].seen_from(&rays, Vec3::new(0.5, 0.5, z));
        assert_eq!([seen(0, 2.0), seen(0, -2.0), seen(0, 4.0)], [1.0, 0.0, 0.0]);
        assert_eq!([seen(1, 2.0), seen(1, 4.0), seen(1, -2.0)], [1.0, 1.0, 0.0]);
    }
}
