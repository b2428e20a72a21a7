//! Which openings does the grid close?
//!
//! An opening of no more than two voxels can be solid all across, since its edges touch every voxel in it. Along each axis,
//! wherever up to nine solid voxels part two free ones (one of them void) and their faces do not plainly fill the section, up
//! to five exact rays are cast between the two. When one is clear, and the two are not joined around the corner within a
//! few voxels, an opening has closed there. Crossings that touch make one opening.
//!
//! Limits: an opening at least half a voxel wide and more or less across an axis is always found, a narrower one where a
//! ray happens to pass. Faces that lie double hide an opening that they seem to fill.

use super::bits::BitGrid;
use super::brick;
use super::flood::Flood;
use super::seeds::Ground;
use super::surface::SurfaceVoxels;
use crate::job::{Cancel, Cancelled};
use crate::scene::Scene;
use crate::space::VoxelIndex;
use glam::{IVec3, Vec3};
use rayon::prelude::*;

/// Longest closed opening that is looked for, voxels: two of the opening's edges and seven of wall.
const LONGEST: i32 = 9;

/// How far around a crossing its two ends may be joined without counting as parted, voxels. The way around an edge that
/// fills its voxel by half is two to three voxels long.
const AROUND: i32 = 3;

/// Share of a voxel's section from which on it counts as filled by faces, without a ray: all of it but for rounding.
const FILLED: f32 = 0.999;

/// An opening that light passes and the void does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedOpening {
    /// Its middle, metres.
    pub position_m: Vec3,
    /// How many rays between voxels pass it; each stands for a square of a voxel's edge.
    pub crossings: usize,
}

/// The openings that the grid closes beside the void, the largest first. Costs some tens of nanoseconds for each solid
/// voxel, and a ray where its faces leave doubt.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn closed_openings(
    ground: &Ground,
    surface: &SurfaceVoxels,
    void: &BitGrid,
    cancel: &Cancel,
) -> Result<Vec<ClosedOpening>, Cancelled> {
    let lattice = ground.lattice;
    let crossings = crossings(ground, surface, void, cancel)?;
    if crossings.is_empty() {
        return Ok(Vec::new());
    }

    // Crossings belong together when the solid voxels they pass touch.
    let mut passed = BitGrid::new(lattice.size);
    for crossing in &crossings {
        crossing.passed().for_each(|voxel| passed.set(voxel, true));
    }
    passed.complement();
    let mut flood = Flood::new(&passed);
    let mut is_counted = vec![false; crossings.len()];
    let mut openings = Vec::new();
    for first in 0..crossings.len() {
        let Some(VoxelIndex(start)) = crossings[first].passed().next() else { continue };
        if flood.flood(VoxelIndex(start)).is_none() {
            continue;
        }
        let (mut middles_m, mut count) = (Vec3::ZERO, 0);
        for (crossing, is_counted) in crossings.iter().zip(&mut is_counted).skip(first) {
            let belongs = crossing.passed().next().is_some_and(|voxel| flood.void().get(voxel));
            if belongs && !*is_counted {
                *is_counted = true;
                middles_m += 0.5 * (lattice.centre_m(crossing.low) + lattice.centre_m(crossing.high()));
                count += 1;
            }
        }
        openings.push(ClosedOpening { position_m: middles_m / count as f32, crossings: count });
    }
    openings.sort_by_key(|opening| std::cmp::Reverse(opening.crossings));
    Ok(openings)
}

/// The sentence that names closed openings; `None` where there are none. Positions are the user's own.
pub fn warning(closed: &[ClosedOpening], scene: &Scene, voxel_m: f32) -> Option<String> {
    const FEW: usize = 3;
    let at = closed.iter().take(FEW).map(|opening| {
        let at = scene.to_user_m(opening.position_m);
        format!("({:.2}, {:.2}, {:.2})", at.x, at.y, at.z)
    });
    let (at, more) = (at.collect::<Vec<_>>().join(", "), if closed.len() > FEW { ", ..." } else { "" });
    let count = closed.len();
    (count > 0).then(|| {
        format!("{count} opening(s) close, for one needs more than two voxels of {voxel_m} m; near {at}{more} m")
    })
}

/// Two free voxels on one axis with nothing but solid voxels in between.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    low: VoxelIndex,
    axis: usize,
    length: i32,
}

impl Crossing {
    fn at(&self, along: i32) -> VoxelIndex {
        let mut at = self.low.0;
        at[self.axis] += along;
        VoxelIndex(at)
    }

    fn high(&self) -> VoxelIndex {
        self.at(self.length + 1)
    }

    fn passed(&self) -> impl Iterator<Item = VoxelIndex> + '_ {
        (1..=self.length).map(|along| self.at(along))
    }
}

/// Where a ray passes what the grid has closed, in the order of the grid.
fn crossings(
    ground: &Ground,
    surface: &SurfaceVoxels,
    void: &BitGrid,
    cancel: &Cancel,
) -> Result<Vec<Crossing>, Cancelled> {
    let solid = ground.solid;
    let [across, rows, planes] = solid.bricks();
    let slabs = (0..planes).into_par_iter().map(|slab| {
        cancel.check()?;
        let mut found = Vec::new();
        for brick in slab * across * rows..(slab + 1) * across * rows {
            let free = !solid.words()[brick] & solid.inside(brick);
            for axis in 0..3 {
                let below_matter = free & solid.shifted(brick, axis, true);
                for low in brick::ones(below_matter).map(|bit| solid.voxel(brick, bit)) {
                    let crossing = crossing_from(low, axis, solid, void);
                    found.extend(crossing.filter(|crossing| {
                        !is_walled(crossing, ground, surface)
                            && is_seen_through(crossing, ground)
                            && !joined_around(crossing, solid)
                    }));
                }
            }
        }
        Ok(found)
    });
    Ok(slabs.collect::<Result<Vec<_>, Cancelled>>()?.concat())
}

/// The crossing that starts at a free voxel; `None` where matter goes on for too long, or neither end is void.
fn crossing_from(low: VoxelIndex, axis: usize, solid: &BitGrid, void: &BitGrid) -> Option<Crossing> {
    let at = |length| Crossing { low, axis, length };
    let crossing = (1..=LONGEST).map(at).find(|crossing| !solid.get(crossing.high()))?;
    (void.get(low) || void.get(crossing.high())).then_some(crossing)
}

/// Whether the faces in the voxels of a crossing, seen along it, plainly fill its section: one voxel's, or all together
/// where a tilted wall passes from voxel to voxel.
fn is_walled(crossing: &Crossing, ground: &Ground, surface: &SurfaceVoxels) -> bool {
    let filled_m2 = FILLED * ground.lattice.voxel_m.powi(2);
    let patches = crossing.passed().filter_map(|voxel| surface.at(ground.solid, voxel));
    let mut together_m2 = 0.0;
    for patch in patches {
        let seen_m2 = patch.normal[crossing.axis] * patch.area_m2;
        together_m2 += seen_m2;
        if seen_m2.abs() >= filled_m2 {
            return true;
        }
    }
    together_m2.abs() >= filled_m2
}

/// Whether an exact ray is clear between the two free voxels of a crossing: along its middle, or along the middles of the
/// quarters of its section, so that no hole of half a voxel is missed.
fn is_seen_through(crossing: &Crossing, ground: &Ground) -> bool {
    let [low_m, high_m] = [crossing.low, crossing.high()].map(|end| ground.lattice.centre_m(end));
    let quarter_m = 0.25 * ground.lattice.voxel_m;
    let aside = |u: f32, v: f32| {
        let mut aside_m = Vec3::ZERO;
        aside_m[(crossing.axis + 1) % 3] = u * quarter_m;
        aside_m[(crossing.axis + 2) % 3] = v * quarter_m;
        aside_m
    };
    let places = [(0.0, 0.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
    places.into_iter().map(|(u, v)| aside(u, v)).any(|aside_m| ground.rays.clear(low_m + aside_m, high_m + aside_m))
}

/// Whether free voxels near a crossing join its two ends.
fn joined_around(crossing: &Crossing, solid: &BitGrid) -> bool {
    let first = crossing.low.0 - AROUND;
    let size = crossing.high().0 + AROUND + 1 - first;
    let mut near = BitGrid::new(size.to_array().map(|along| along as usize));
    near.fill(true);
    let size = solid.size().map(|along| along as i32);
    for step in near.clone().iter() {
        let at = first + step.0;
        let inside = at.cmpge(IVec3::ZERO).all() && at.cmplt(IVec3::from_array(size)).all();
        near.set(step, !inside || solid.get(VoxelIndex(at)));
    }
    let mut flood = Flood::new(&near);
    flood.flood(VoxelIndex(crossing.low.0 - first));
    flood.void().get(VoxelIndex(crossing.high().0 - first))
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::{boxed, scene_of};
    use super::super::voxelise;
    use super::*;
    use crate::job::Quiet;
    use crate::rays::Rays;
    use crate::scene::Light;

    /// Two rooms of 2 m, parted by a wall as thick as given with a slot as wide as given across y = 1.05 m, and a door or not.
    fn rooms_with_a_slot(thick_m: f32, slot_m: f32, door_m: f32) -> Scene {
        let mut triangles = boxed(Vec3::ZERO, Vec3::new(4.0, 2.0, 2.0));
        let (from, to) = (2.0 - 0.5 * thick_m, 2.0 + 0.5 * thick_m);
        triangles.extend(boxed(Vec3::new(from, door_m, 0.0), Vec3::new(to, 1.05 - 0.5 * slot_m, 2.0)));
        triangles.extend(boxed(Vec3::new(from, 1.05 + 0.5 * slot_m, 0.0), Vec3::new(to, 2.0, 2.0)));
        let mut scene = scene_of(&triangles);
        scene.lights.push(Light::Point { position_m: Vec3::splat(0.7), flux_w: 1.0 });
        scene
    }

    fn openings(scene: &Scene, voxel_m: f32) -> Vec<ClosedOpening> {
        let rays = Rays::new(scene);
        voxelise(scene, &rays, &[], voxel_m, 1 << 30, &Quiet, &Cancel::new()).unwrap().closed
    }

    #[test]
    fn a_slot_that_closes_is_found() {
        for (thick_m, slot_m, door_m) in [
            (0.0, 0.15, 0.0),
            (0.1, 0.15, 0.0),
            (0.3, 0.15, 0.0),
            (0.1, 0.15, 0.6),
            (0.1, 0.055, 0.0),
            (0.3, 0.055, 0.0),
        ] {
            let found = openings(&rooms_with_a_slot(thick_m, slot_m, door_m), 0.1);
            assert_eq!(found.len(), 1, "{thick_m} {slot_m} {door_m} {found:?}");
            let off_m = (found[0].position_m - Vec3::new(2.0, 1.05, 1.0)).abs();
            assert!(off_m.x < 0.06 && off_m.y < 0.06 && off_m.z < 0.2, "{found:?}");
            assert!(found[0].crossings >= 15);
            let scene = Scene { origin_m: glam::DVec3::new(1000.0, 0.0, 0.0), ..Scene::default() };
            let told = warning(&found, &scene, 0.1).unwrap();
            assert!(told.starts_with("1 opening(s) close") && told.contains("(100"), "{told}");
        }
    }

    #[test]
    fn what_is_open_or_shut_is_not_reported() {
        for (slot_m, voxel_m) in [(0.0, 0.1), (0.35, 0.1), (0.15, 0.04)] {
            assert_eq!(openings(&rooms_with_a_slot(0.1, slot_m, 0.0), voxel_m), [], "{slot_m} {voxel_m}");
        }
        assert_eq!(warning(&[], &Scene::default(), 0.1), None);
    }

    #[test]
    fn edges_of_bodies_are_not_openings() {
        let mut triangles = boxed(Vec3::ZERO, Vec3::splat(3.0));
        for i in 0..8 {
            let at = Vec3::new(0.43 + 0.31 * i as f32, 1.1, 0.9);
            triangles.extend(boxed(at, at + Vec3::new(0.07, 0.9 + 0.05 * i as f32, 0.33)));
        }
        let mut scene = scene_of(&triangles);
        scene.lights.push(Light::Point { position_m: Vec3::splat(0.2), flux_w: 1.0 });
        assert_eq!(openings(&scene, 0.05), []);
    }
}
