//! What does a ray hit?
//!
//! One compressed wide BVH (Ylitie, Karras & Laine 2017, crate `obvhs`) over the triangles of the mesh and the bodies of
//! the lights: quads as two triangles, spheres as they are; point lights have no body. Triangles are tested by the
//! watertight method of Woop, Benthin & Wald 2013, because the crate's own test leaks at shared edges, and a ray that
//! slips between two walls carries the light of a bright room into a dark one. Both sides of everything are hit.
//!
//! Coordinates are `f32`. One constant for each scene, [`Rays::epsilon_m`], says how far a point found by a ray may be
//! off its surface; whoever starts a ray on a surface lifts it off by that much along the normal. Features thinner than
//! this (0.1 mm in a scene of 10 m, 2 mm in a town, 1 cm in a city of 10 km) are not resolved. The build is serial and gives
//! the same tree every time.
//!
//! Where parts of the mesh are moved, scaled or hidden ([`Rays::changed`]), their bodies are blanked in the tree, which stays as
//! it is, and what became of them stands in a small tree of its own: a ray goes through both, and the time is that of what moves.

mod body;
mod level;
mod lift;

use crate::scene::parts::{Change, moved};
use crate::scene::{Material, Scene};
use body::{Body, Shear, UNITS_PER_M, bodies_of};
use glam::Vec3;
use level::{Level, Solid};
use obvhs::ray::RayHit;

/// Share of the largest coordinate by which boxes are padded: rounding in the box test must not lose a ray that runs
/// along the seam of two flat boxes.
const PAD_SHARE: f32 = 2e-6;

/// Coordinates below this do not shrink the epsilon further, metres: no flat box may be left without a volume.
const SMALLEST_SCENE_M: f32 = 1e-3;

/// What a ray can end on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Surface {
    /// The mesh triangle of that number.
    Triangle(u32),
    /// The body of that light in [`Scene::lights`].
    Light(usize),
}

/// Where a ray ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// How far along the ray, metres.
    pub distance_m: f32,
    /// Unit geometric normal of the surface's front side (of a sphere: outwards), whichever side was hit.
    pub normal: Vec3,
    /// Whether the ray came from the front.
    pub front: bool,
    /// What was hit.
    pub surface: Surface,
}

impl Hit {
    /// The unit normal on the side that the ray came from.
    pub fn facing(&self) -> Vec3 {
        if self.front { self.normal } else { -self.normal }
    }
}

/// The surfaces of a scene, ready to be hit. Building takes about a second a million triangles.
#[derive(Clone)]
pub struct Rays {
    /// The scene as it was built, then what was moved.
    levels: Vec<Level>,
    largest_m: f32,
    epsilon_m: f32,
    /// How far off a measured surface rays start.
    leaving_m: f32,
}

impl std::fmt::Debug for Rays {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let bodies: usize = self.levels.iter().map(Level::len).sum();
        out.debug_struct("Rays").field("bodies", &bodies).field("epsilon_m", &self.epsilon_m).finish()
    }
}

impl Rays {
    /// Builds the tree over all triangles and light bodies of a scene; a scene without any is clear everywhere.
    pub fn new(scene: &Scene) -> Self {
        let mut solids: Vec<Solid> = Vec::with_capacity(scene.mesh.triangles.len());
        for triangle in 0..scene.mesh.triangles.len() {
            solids.extend(scene.mesh.corners_m(triangle).map(|corners_m| solid_of(scene, triangle, corners_m)));
        }
        for (number, light) in scene.lights.iter().enumerate() {
            for body in bodies_of(light) {
                solids.push(Solid { body, surface: Surface::Light(number), transmittance: 0.0 });
            }
        }

        let sensors = scene.sensors.iter().map(|sensor| sensor.position_m.abs().max_element());
        let largest_m =
            solids.iter().map(|solid| solid.body.largest_coordinate()).chain(sensors).fold(SMALLEST_SCENE_M, f32::max);
        let levels = vec![Level::new(&solids, PAD_SHARE * largest_m)];
        Self { levels, largest_m, epsilon_m: lift::epsilon_m(largest_m), leaving_m: lift::leaving_m(largest_m) }
    }

    /// The rays of the scene, which are these, with some of its parts changed: as new ones would be, at a cost of what is changed
    /// and a copy of the bodies. `None` where a new tree is needed: something moves beyond the scene's largest coordinate, which
    /// decides on [`Rays::epsilon_m`], or these have been changed before.
    pub fn changed(&self, scene: &Scene, changes: &[Change]) -> Option<Self> {
        let [before] = self.levels.as_slice() else { return None };
        let mut moving = Vec::new();
        for change in changes {
            let Some(to) = &change.to else { continue };
            for triangle in scene.triangles_of(change.part) {
                let corners_m = scene.mesh.corners_m(triangle)?.map(|at_m| moved(to, at_m));
                moving.push(solid_of(scene, triangle, corners_m));
            }
        }
        let largest_m = self.largest_m;
        if moving.iter().any(|solid| solid.body.largest_coordinate() > largest_m) {
            return None;
        }
        let is_changed = scene.change_of_triangles(changes);
        let stays = |surface| match surface {
            Surface::Triangle(triangle) => is_changed.get(triangle as usize).is_none_or(Option::is_none),
            Surface::Light(_) => true,
        };
        let levels = vec![before.keeping(stays), Level::new(&moving, PAD_SHARE * largest_m)];
        Some(Self { levels, ..*self })
    }

    /// The first surface, glazing too, from `origin_m` along the unit vector `direction` within `max_m` (which may be
    /// infinite).
    pub fn closest(&self, origin_m: Vec3, direction: Vec3, max_m: f32) -> Option<Hit> {
        let ray = Shear::new(origin_m, direction);
        let mut nearest: Option<Hit> = None;
        for level in &self.levels {
            let within_m = nearest.map_or(max_m, |hit| hit.distance_m);
            let mut found = RayHit::none();
            let any = level.tree.ray_traverse(ray.in_tree(within_m), &mut found, |_, leaf| {
                level.bodies.get(leaf).map_or(f32::INFINITY, |body| body.distance_m(&ray) * UNITS_PER_M)
            });
            let leaf = found.primitive_id as usize;
            let (Some(body), Some(surface), true) = (level.bodies.get(leaf), level.surfaces.get(leaf), any) else {
                continue;
            };
            let distance_m = found.t / UNITS_PER_M;
            let normal = body.normal(origin_m + distance_m * direction);
            nearest = Some(Hit { distance_m, normal, front: normal.dot(direction) < 0.0, surface: *surface });
        }
        nearest
    }

    /// Whether nothing opaque lies between two points; glazing does not block. Both ends are pulled in by
    /// [`Rays::epsilon_m`], so that the surfaces they lie on do not count.
    pub fn clear(&self, from_m: Vec3, to_m: Vec3) -> bool {
        self.transmitted(from_m, to_m) > 0.0
    }

    /// The share of light that passes from one point straight to another: 0 where something opaque lies between, else
    /// the product of the transmittances of the glazing between (panes nearer to each other than the epsilon count as
    /// one). Ends as in [`Rays::clear`].
    pub fn transmitted(&self, from_m: Vec3, to_m: Vec3) -> f32 {
        let inwards_m = (to_m - from_m).normalize_or_zero() * self.epsilon_m;
        if from_m.distance_squared(to_m) <= 4.0 * self.epsilon_m * self.epsilon_m {
            return 1.0;
        }
        self.transmitted_past(from_m + inwards_m, to_m - inwards_m, |_| false)
    }

    /// As [`Rays::transmitted`], for ends that already stand clear of their surfaces and are not pulled in; surfaces for
    /// which `ignore` holds let all light through (the body of the light that is looked at).
    pub fn transmitted_past(&self, from_m: Vec3, to_m: Vec3, ignore: impl Fn(Surface) -> bool) -> f32 {
        let length_m = from_m.distance(to_m);
        if length_m <= 0.0 {
            return 1.0;
        }
        self.passing(from_m, (to_m - from_m) / length_m, length_m, ignore)
    }

    /// The share of light from outside the scene, along the unit vector `direction` that points to where it comes from, that
    /// reaches a point which stands clear of its surface: 0 where something opaque is in the way, else the product of the
    /// transmittances of the glazing.
    pub fn from_afar(&self, at_m: Vec3, direction: Vec3) -> f32 {
        self.passing(at_m, direction, f32::MAX / UNITS_PER_M, |_| false)
    }

    fn passing(&self, from_m: Vec3, direction: Vec3, length_m: f32, ignore: impl Fn(Surface) -> bool) -> f32 {
        let ray = Shear::new(from_m, direction);
        let mut panes: Vec<(f32, f32)> = Vec::new();
        for level in &self.levels {
            let misses = level.tree.ray_traverse_miss(ray.in_tree(length_m), |_, leaf| {
                let distance_m = level.bodies.get(leaf).map_or(f32::INFINITY, |body| body.distance_m(&ray));
                if distance_m >= length_m || level.surfaces.get(leaf).is_some_and(|&surface| ignore(surface)) {
                    return f32::INFINITY;
                }
                match level.transmittances.get(leaf) {
                    Some(&transmittance) if transmittance > 0.0 => {
                        panes.push((distance_m, transmittance));
                        f32::INFINITY
                    }
                    _ => distance_m * UNITS_PER_M,
                }
            });
            if !misses {
                return 0.0;
            }
        }
        // A ray through the seam of two triangles meets both, and is weakened once.
        panes.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        panes.dedup_by(|pane, before| pane.0 - before.0 <= self.epsilon_m);
        panes.iter().map(|&(_, transmittance)| transmittance).product()
    }
}

/// A triangle of a scene, wherever its corners are.
fn solid_of(scene: &Scene, triangle: usize, corners_m: [Vec3; 3]) -> Solid {
    let transmittance = scene.material(triangle).map_or(0.0, Material::passes);
    Solid { body: Body::Triangle(corners_m), surface: Surface::Triangle(triangle as u32), transmittance }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Light, Material, Mesh};
    use proptest::prelude::*;

    /// An octahedron, each face cut into `cuts * cuts`, pushed out to a bumpy closed surface about the origin.
    fn ball(cuts: i32, radius_m: f32, bump: f32) -> Mesh {
        let mut mesh = Mesh::default();
        let corner = |axis: usize, sign: f32| {
            let mut corner = Vec3::ZERO;
            corner[axis] = sign;
            corner
        };
        for face in 0..8 {
            let sign = |axis: usize| if face >> axis & 1 == 0 { 1.0 } else { -1.0 };
            let [a, b, c] = [0, 1, 2].map(|axis| corner(axis, sign(axis)));
            let at = |i: i32, j: i32| {
                // From integers alone, so that neighbouring faces make the same corner bit by bit.
                let flat = a * (cuts - i - j) as f32 + b * i as f32 + c * j as f32;
                let unit = flat.normalize();
                unit * radius_m * (1.0 + bump * (17.0 * unit.x + 5.0 * unit.y * unit.z).sin())
            };
            for i in 0..cuts {
                for j in 0..cuts - i {
                    push(&mut mesh, [at(i, j), at(i + 1, j), at(i, j + 1)]);
                    if i + j + 1 < cuts {
                        push(&mut mesh, [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                    }
                }
            }
        }
        mesh
    }

    fn push(mesh: &mut Mesh, corners_m: [Vec3; 3]) {
        let first = mesh.positions_m.len() as u32;
        mesh.positions_m.extend(corners_m);
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.material_of.push(0);
    }

    fn grey(transmittance: f32) -> Material {
        Material { name: String::new(), reflectance: 0.5, transmittance, emission_w_m2_sr: 0.0 }
    }

    fn scene_of(mesh: Mesh, lights: Vec<Light>) -> Scene {
        Scene { mesh, lights, materials: vec![grey(0.0)], ..Scene::default() }
    }

    /// A square of side 2 m at height `z`, seen from above at its front.
    fn square(mesh: &mut Mesh, z: f32, material: u32) {
        let [a, b, c, d] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, z));
        push(mesh, [a, b, c]);
        push(mesh, [a, c, d]);
        let count = mesh.material_of.len();
        mesh.material_of[count - 2..].fill(material);
    }

    #[test]
    fn nothing_leaves_a_closed_mesh_through_corners_edges_or_faces() {
        for (cuts, shift) in [(1, 0.0), (9, 0.0), (9, 1000.0)] {
            let mut mesh = ball(cuts, 3.0, 0.05);
            let centre = Vec3::new(shift, 0.3 * shift, -shift);
            mesh.positions_m.iter_mut().for_each(|position| *position += centre);
            let scene = scene_of(mesh, Vec::new());
            let rays = Rays::new(&scene);
            for origin in [Vec3::ZERO, Vec3::new(0.3, -0.7, 0.2), Vec3::new(0.0, 0.5, 0.0)].map(|at| centre + at) {
                for triangle in 0..scene.mesh.triangles.len() {
                    let [a, b, c] = scene.mesh.corners_m(triangle).expect("the triangle exists");
                    for target in [a, b, c, (a + b) / 2.0, (2.0 * a + c) / 3.0, (a + b + c) / 3.0] {
                        let direction = (target - origin).normalize();
                        let hit = rays.closest(origin, direction, f32::INFINITY);
                        let distance = hit.unwrap_or_else(|| panic!("{cuts} {target} from {origin}")).distance_m;
                        assert!((distance - origin.distance(target)).abs() < 0.3, "{distance}");
                        assert!(!rays.clear(origin, origin + 10.0 * direction));
                    }
                }
            }
        }
    }

    #[test]
    fn a_ray_that_starts_just_before_a_wall_hits_it() {
        let mut mesh = Mesh::default();
        square(&mut mesh, 0.0, 0);
        let rays = Rays::new(&scene_of(mesh, Vec::new()));
        for gap_m in [1e-3, 1e-4, 1e-5, 1e-6] {
            for (x, y) in [(0.0, 0.0), (0.3, 0.3), (0.1, -0.7)] {
                let hit = rays.closest(Vec3::new(x, y, gap_m), Vec3::NEG_Z, 10.0).expect("the wall");
                assert!((hit.distance_m - gap_m).abs() < 1e-7);
                assert!(hit.front && hit.normal == Vec3::Z && hit.facing() == Vec3::Z);
                let hit = rays.closest(Vec3::new(x, y, -gap_m), Vec3::Z, 10.0).expect("the wall");
                assert!(!hit.front && hit.normal == Vec3::Z && hit.facing() == Vec3::NEG_Z);
            }
        }
        assert_eq!(rays.closest(Vec3::new(0.0, 0.0, 1.0), Vec3::NEG_Z, 0.5), None);
    }

    #[test]
    fn glazing_weakens_and_walls_block() {
        let mut mesh = Mesh::default();
        square(&mut mesh, 1.0, 1);
        square(&mut mesh, 2.0, 2);
        square(&mut mesh, 3.0, 0);
        let scene = Scene { materials: vec![grey(0.0), grey(0.5), grey(0.8)], ..scene_of(mesh, Vec::new()) };
        let rays = Rays::new(&scene);
        // On the seam of each square's two triangles.
        let at = |z: f32| Vec3::new(0.2, 0.2, z);
        assert_eq!(rays.transmitted(at(0.0), at(0.9)), 1.0);
        assert_eq!(rays.transmitted(at(0.0), at(1.5)), 0.5);
        assert!((rays.transmitted(at(0.0), at(2.5)) - 0.4).abs() < 1e-6);
        assert_eq!(rays.transmitted(at(0.0), at(3.5)), 0.0);
        assert!(rays.clear(at(2.5), at(0.0)) && !rays.clear(at(3.5), at(2.5)));
        // Ends on the surfaces themselves do not count.
        assert_eq!(rays.transmitted(at(1.0), at(3.0)), 0.8);
        let wall = |surface| matches!(surface, Surface::Triangle(4 | 5));
        assert!((rays.transmitted_past(at(0.0), at(3.5), wall) - 0.4).abs() < 1e-6);
    }

    #[test]
    fn lights_are_opaque_bodies() {
        let lights = vec![
            Light::Point { position_m: Vec3::new(0.0, 0.0, 4.0), flux_w: 1.0 },
            Light::Sphere { centre_m: Vec3::new(0.0, 0.0, 2.0), radius_m: 0.5, flux_w: 1.0 },
            Light::Quad { corner_m: Vec3::splat(-5.0), u_m: Vec3::Y, v_m: Vec3::X, flux_w: 1.0 },
        ];
        let rays = Rays::new(&scene_of(Mesh::default(), lights));
        let hit = rays.closest(Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z, 100.0).expect("the sphere");
        assert_eq!((hit.surface, hit.distance_m, hit.normal, hit.front), (Surface::Light(1), 2.5, Vec3::Z, true));
        let hit = rays.closest(Vec3::new(0.0, 0.0, 2.0), Vec3::X, 100.0).expect("the sphere from inside");
        assert_eq!((hit.distance_m, hit.front), (0.5, false));
        let hit = rays.closest(Vec3::new(-4.5, -4.7, 0.0), Vec3::NEG_Z, 100.0).expect("the quad");
        assert_eq!((hit.surface, hit.normal, hit.front), (Surface::Light(2), Vec3::NEG_Z, false));
        assert!(!rays.clear(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO));
    }

    #[test]
    fn an_empty_scene_is_clear() {
        let rays = Rays::new(&Scene::default());
        assert_eq!(rays.closest(Vec3::ZERO, Vec3::X, f32::INFINITY), None);
        assert!(rays.clear(Vec3::ZERO, Vec3::ONE));
    }

    #[test]
    fn many_triangles_in_one_place_are_not_lost() {
        let mut mesh = Mesh::default();
        for copy in 0..20_000 {
            square(&mut mesh, if copy == 0 { 0.5 } else { 0.0 }, 0);
        }
        // A long strip of equal tiles beside them ties as well.
        for step in 0..20_000 {
            let at = |x: i32, y: f32| Vec3::new((step + x) as f32 * 0.1, y, 0.0);
            push(&mut mesh, [at(20, 0.0), at(21, 0.0), at(20, 0.1)]);
        }
        let rays = Rays::new(&scene_of(mesh, Vec::new()));
        assert_eq!(rays.closest(Vec3::new(0.1, 0.2, -1.0), Vec3::Z, 10.0).map(|hit| hit.distance_m), Some(1.0));
        assert_eq!(rays.closest(Vec3::new(0.1, 0.2, 1.0), Vec3::NEG_Z, 10.0).map(|hit| hit.distance_m), Some(0.5));
    }

    fn point() -> impl Strategy<Value = Vec3> {
        [-4.0f32..4.0, -4.0f32..4.0, -4.0f32..4.0].prop_map(Vec3::from_array)
    }

    proptest! {
        #[test]
        fn the_tree_finds_what_every_triangle_in_turn_finds(origin in point(), target in point()) {
            let mesh = ball(6, 3.0, 0.2);
            let scene = scene_of(mesh, Vec::new());
            let rays = Rays::new(&scene);
            let direction = (target - origin).normalize_or(Vec3::X);
            let ray = Shear::new(origin, direction);
            let each = rays.levels[0].bodies.iter().map(|body| body.distance_m(&ray)).fold(f32::INFINITY, f32::min);
            let found = rays.closest(origin, direction, f32::INFINITY).map_or(f32::INFINITY, |hit| hit.distance_m);
            prop_assert!(found == each || (found - each).abs() < 1e-5, "{} {}", found, each);
            let length = origin.distance(target);
            let far_from_the_end = (each - length).abs() > 1e-3 && each > 1e-3;
            prop_assert!(!far_from_the_end || rays.clear(origin, target) == (each > length));
        }
    }
}
