//! Which void does a light or a sensor stand in, or face?
//!
//! Lights and sensors often lie on a wall or within a voxel of one, inside a solid voxel. They stand for the void that they
//! face: the nearest void voxel within a few voxels, on the side of the normal where there is one, to whose centre an exact
//! ray from the point is clear. A point from which no such ray is clear lies inside matter. Bodies of lights do not count,
//! for a light does not stand in its own way. The modelled domain is the grid around the mesh's box: what lies beyond it
//! is reported as outside.
//!
//! Limits: a point inside a closed body that is several voxels wide stands in that body's hollow inside, a void that no
//! light reaches; a point without a normal exactly on a thin wall goes to the side whose voxel is nearer.

use super::bits::BitGrid;
use crate::job::{Cancel, Cancelled};
use crate::rays::{Rays, Surface};
use crate::scene::{Light, Mesh, Sensor};
use crate::space::{Lattice, VoxelIndex};
use glam::{IVec3, Vec3};
use rayon::prelude::*;

/// How far from a point in matter its void may be, voxels along each axis. A wall between two voxels is two voxels thick,
/// and in a corner the nearest void voxel can be one more away.
const REACH_VOXELS: i32 = 3;

/// A point that lies in or faces a void.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Where it is, metres.
    pub point_m: Vec3,
    /// The unit direction it faces; `None` where it faces every way.
    pub normal: Option<Vec3>,
}

impl Place {
    /// Where a light of the scene file shines from: its centre, and for a quad its front.
    pub fn of_light(light: &Light) -> Self {
        match *light {
            Light::Point { position_m, .. } => Self { point_m: position_m, normal: None },
            Light::Sphere { centre_m, .. } => Self { point_m: centre_m, normal: None },
            Light::Quad { corner_m, u_m, v_m, .. } => {
                Self { point_m: corner_m + 0.5 * (u_m + v_m), normal: u_m.cross(v_m).try_normalize() }
            }
        }
    }

    /// Where a patch of emissive triangles shines from: the centre of the triangle nearest to the patch's own centre, which
    /// itself may lie inside matter (a bulb). `None` for a patch without triangles.
    pub fn of_patch(mesh: &Mesh, triangles: &[u32], centroid_m: Vec3) -> Option<Self> {
        let places = triangles.iter().filter_map(|&triangle| {
            let [a, b, c] = mesh.corners_m(triangle as usize)?;
            Some(Self { point_m: (a + b + c) / 3.0, normal: (b - a).cross(c - a).try_normalize() })
        });
        let distance = |place: &Self| place.point_m.distance_squared(centroid_m);
        places.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Where a sensor is asked for light.
    pub fn of_sensor(sensor: &Sensor) -> Self {
        Self { point_m: sensor.position_m, normal: sensor.normal }
    }
}

/// The void voxel that stands for a light or a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seed {
    /// The voxel; it belongs to the void.
    pub voxel: VoxelIndex,
    /// The number of its void in `Voxels::voids`.
    pub part: usize,
}

/// Why a light or a sensor stands in no void.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lost {
    /// It lies inside matter and faces no void within reach.
    InSolid,
    /// It lies outside the grid.
    Outside,
}

/// Where lights and sensors stand.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Seeds {
    /// One a light of the scene in its order, then one a patch of emissive faces.
    pub lights: Vec<Result<Seed, Lost>>,
    /// One a sensor.
    pub sensors: Vec<Result<Seed, Lost>>,
}

/// What places are resolved on.
#[derive(Clone, Copy)]
pub struct Ground<'a> {
    /// The grid.
    pub lattice: &'a Lattice,
    /// Its solid voxels.
    pub solid: &'a BitGrid,
    /// The scene's surfaces as they are.
    pub rays: &'a Rays,
}

/// The voxel that stands for each place: its own where that is not solid, else the nearest that it faces. A voxel of
/// `preferred` (the void that lights reach) comes first, as long as the place sees one within reach. [`Lost`] where a place
/// lies outside the grid or faces no void. Parallel; some microseconds for a place in or near matter.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn resolved(
    places: &[Place],
    ground: &Ground,
    preferred: &BitGrid,
    cancel: &Cancel,
) -> Result<Vec<Result<VoxelIndex, Lost>>, Cancelled> {
    let voxels = places.par_iter().map(|place| {
        cancel.check()?;
        Ok(resolved_one(place, ground, preferred))
    });
    voxels.collect()
}

/// The voxel that stands for one place, as in [`resolved`].
///
/// # Errors
/// [`Lost`] where the place lies outside the grid or faces no void.
pub fn resolved_one(place: &Place, ground: &Ground, preferred: &BitGrid) -> Result<VoxelIndex, Lost> {
    let own = ground.lattice.voxel_at(place.point_m);
    if !ground.lattice.contains(own) {
        return Err(Lost::Outside);
    }
    if preferred.get(own) {
        return Ok(own);
    }
    let free = |voxel| ground.lattice.contains(voxel) && !ground.solid.get(voxel);
    faced(place, ground, |voxel| preferred.get(voxel))
        .or_else(|| free(own).then_some(own))
        .or_else(|| faced(place, ground, free))
        .ok_or(Lost::InSolid)
}

/// The nearest wanted voxel whose centre the place sees, the lowest of equals (z, then y, then x).
fn faced(place: &Place, ground: &Ground, wanted: impl Fn(VoxelIndex) -> bool) -> Option<VoxelIndex> {
    let Ground { lattice, rays, .. } = *ground;
    let own = lattice.voxel_at(place.point_m).0;
    let across = 2 * REACH_VOXELS + 1;
    let around = (0..across.pow(3)).map(|i| IVec3::new(i % across, i / across % across, i / across.pow(2)));
    let near = around.map(|step| VoxelIndex(own + step - REACH_VOXELS)).filter(|&voxel| wanted(voxel));
    let in_front = near.filter_map(|voxel| {
        let towards_m = lattice.centre_m(voxel) - place.point_m;
        let faces = place.normal.is_none_or(|normal| normal.dot(towards_m) > 0.0);
        faces.then_some((towards_m.length_squared(), voxel))
    });
    let mut by_distance: Vec<(f32, VoxelIndex)> = in_front.collect();
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0));
    by_distance.into_iter().map(|(_, voxel)| voxel).find(|&voxel| sees(place, lattice.centre_m(voxel), rays))
}

/// Whether nothing but bodies of lights lies between a place, lifted off its own surface, and a point.
fn sees(place: &Place, point_m: Vec3, rays: &Rays) -> bool {
    let lift = place.normal.unwrap_or_else(|| (point_m - place.point_m).normalize_or_zero());
    let from_m = place.point_m + rays.epsilon_m() * lift;
    rays.transmitted_past(from_m, point_m, |surface| matches!(surface, Surface::Light(_))) > 0.0
}

#[cfg(test)]
mod tests {
    use super::super::surface::voxelised;
    use super::super::test_scenes::{boxed, scene_of};
    use super::*;
    use crate::job::Quiet;
    use crate::scene::Scene;

    fn check(scene: &Scene, place: Place, voxel_m: f32) -> Result<Vec3, Lost> {
        let (low, high) = scene.mesh.bounds_m().unwrap();
        let lattice = Lattice::around(low, high, voxel_m);
        let (solid, _) = voxelised(scene, &lattice, &Quiet, &Cancel::new()).unwrap();
        let rays = Rays::new(scene);
        let ground = Ground { lattice: &lattice, solid: &solid, rays: &rays };
        let voxel = resolved(&[place], &ground, &BitGrid::new(lattice.size), &Cancel::new()).unwrap()[0]?;
        assert!(!solid.get(voxel));
        Ok(lattice.centre_m(voxel))
    }

    /// Two rooms of 2 m that a wall without thickness at x = 2 parts.
    fn two_rooms() -> Scene {
        let mut triangles = boxed(Vec3::ZERO, Vec3::new(4.0, 2.0, 2.0));
        let wall = [[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 2.0, 2.0], [2.0, 0.0, 2.0]].map(Vec3::from_array);
        triangles.extend([[wall[0], wall[1], wall[2]], [wall[0], wall[2], wall[3]]]);
        scene_of(&triangles)
    }

    #[test]
    fn a_point_in_the_void_stays() {
        let at = Vec3::new(1.07, 1.02, 0.93);
        let centre = check(&two_rooms(), Place { point_m: at, normal: None }, 0.1).unwrap();
        assert!((centre - at).abs().max_element() <= 0.0501);
    }

    #[test]
    fn a_point_on_a_wall_goes_to_the_side_it_faces() {
        let scene = two_rooms();
        for (normal, side) in [(Vec3::X, 1.0), (Vec3::NEG_X, -1.0)] {
            let place = Place { point_m: Vec3::new(2.0, 1.0, 1.0), normal: Some(normal) };
            let centre = check(&scene, place, 0.1).unwrap();
            assert!(side * (centre.x - 2.0) > 0.0 && (centre - place.point_m).length() < 0.25, "{centre}");
        }
        let floor = Place { point_m: Vec3::new(1.0, 1.0, 0.0), normal: Some(Vec3::Z) };
        assert!(check(&scene, floor, 0.1).unwrap().z > 0.0);
    }

    #[test]
    fn a_point_beside_a_wall_stays_on_its_side() {
        for x in [1.97, 2.03] {
            let place = Place { point_m: Vec3::new(x, 1.0, 1.0), normal: None };
            let centre = check(&two_rooms(), place, 0.1).unwrap();
            assert!((centre.x > 2.0) == (x > 2.0), "{centre}");
        }
    }

    #[test]
    fn a_point_inside_matter_is_lost() {
        let mut triangles = boxed(Vec3::ZERO, Vec3::splat(3.0));
        triangles.extend(boxed(Vec3::splat(1.46), Vec3::splat(1.54)));
        let scene = scene_of(&triangles);
        assert_eq!(check(&scene, Place { point_m: Vec3::splat(1.5), normal: None }, 0.1), Err(Lost::InSolid));
        assert_eq!(check(&scene, Place { point_m: Vec3::splat(1.5), normal: Some(Vec3::X) }, 0.1), Err(Lost::InSolid));
        assert_eq!(check(&scene, Place { point_m: Vec3::splat(30.0), normal: None }, 0.1), Err(Lost::Outside));
    }

    #[test]
    fn a_lamp_in_a_corner_is_not_in_its_own_way() {
        let mut scene = two_rooms();
        scene.lights.push(Light::Sphere { centre_m: Vec3::new(1.0, 1.0, 1.99), radius_m: 0.05, flux_w: 1.0 });
        let place = Place::of_light(&scene.lights[0]);
        assert!(check(&scene, place, 0.1).is_ok());
    }

    #[test]
    fn a_patch_shines_from_one_of_its_triangles() {
        let scene = scene_of(&boxed(Vec3::ZERO, Vec3::ONE));
        let place = Place::of_patch(&scene.mesh, &[0, 1, 2, 3, 4, 5], Vec3::splat(0.5)).unwrap();
        let normal = place.normal.unwrap();
        assert!((normal.length() - 1.0).abs() < 1e-6);
        assert!((normal.dot(place.point_m - Vec3::splat(0.5)).abs() - 0.5).abs() < 1e-6);
        assert_eq!(Place::of_patch(&scene.mesh, &[], Vec3::ZERO), None);
    }
}
