//! What surrounds each node: how much wall, how bright, how much open air?
//!
//! The true area of the mesh in each surface voxel goes to the node nearest to the void before it; a sheet with void on
//! both sides counts on both. The outermost layer of the grid, which the mesh does not reach, is the outside: walls that face
//! it are not in the void, and where a void leaks, its faces towards it are openings.

use crate::flow::sequence;
use crate::model::Model;
use crate::space::VoxelIndex;
use crate::voxel::brick;
use crate::voxel::morphology::{self, Neighbours};
use crate::voxel::surface::SurfacePatch;
use glam::{IVec3, Vec3};
use rayon::prelude::*;

/// Bricks that are done in one piece; fixed, so that sums do not depend on the threads.
const BRICKS_A_PIECE: usize = 256;

/// A mean normal shorter than this is that of faces back to back, or of a crumb: its area is shared among all sides.
const FLAT: f32 = 0.5;

/// Points that stand for a pane at most.
const MOST_PIECES: f64 = 10_000.0;

/// Void in a direction this much along the mean normal lies on that side; less is beside the face.
const ON_A_SIDE: f32 = 0.2;

/// What surrounds each node; all by the number of the node.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surroundings {
    /// Void volume, m3.
    pub volume_m3: Vec<f64>,
    /// Wall area, m2.
    pub wall_m2: Vec<f64>,
    /// Wall area times its reflectance, m2.
    pub reflecting_m2: Vec<f64>,
    /// Area towards the outside of the grid, m2.
    pub open_m2: Vec<f64>,
}

impl Surroundings {
    /// What surrounds the nodes of a model. Takes some tens of nanoseconds a surface voxel.
    pub fn of(model: &Model) -> Self {
        let nodes = model.skeleton.graph.node_count();
        let volumes_m3 = model.skeleton.graph.node_weights().map(|node| f64::from(node.volume_m3));
        let mut all = Self {
            volume_m3: volumes_m3.collect(),
            wall_m2: vec![0.0; nodes],
            reflecting_m2: vec![0.0; nodes],
            open_m2: open_m2(model),
        };
        let panes = panes(model);
        for (node, area_m2, reflecting_m2) in walls(model).into_iter().flatten().chain(panes) {
            all.wall_m2[node as usize] += area_m2;
            all.reflecting_m2[node as usize] += reflecting_m2;
        }
        all
    }
}

/// Each piece of wall: its node, its area, and that times its reflectance, m2.
fn walls(model: &Model) -> Vec<Vec<(u32, f64, f64)>> {
    let (solid, void, surface) = (&model.voxels.solid, &model.voxels.void, &model.voxels.surface);
    let near_void = morphology::dilate(void, Neighbours::All);
    let words = || solid.words().iter().zip(near_void.words()).map(|(solid, near)| solid & near);
    let words: Vec<(usize, u64)> = words().enumerate().filter(|(_, word)| *word != 0).collect();
    let last = IVec3::from_array(solid.size().map(|along| along as i32 - 1));
    let is_inside = |VoxelIndex(at)| at.cmpgt(IVec3::ZERO).all() && at.cmplt(last).all();
    let pieces = words.par_chunks(BRICKS_A_PIECE).map(|words| {
        let mut found = Vec::new();
        for &(brick, word) in words {
            let solids = solid.words()[brick];
            let first = surface.number(solid, solid.voxel(brick, solids.trailing_zeros())).unwrap_or(usize::MAX);
            let patches = surface.patches().get(first..).unwrap_or_default();
            let over_faces = [(0, true), (0, false), (1, true), (1, false), (2, true), (2, false)]
                .map(|(axis, up)| void.shifted(brick, axis, up));
            for bit in brick::ones(word) {
                let Some(patch) = patches.get((solids & ((1 << bit) - 1)).count_ones() as usize) else { continue };
                let voxel = solid.voxel(brick, bit);
                let is_void = |step: usize| match over_faces.get(step) {
                    Some(mask) => mask >> bit & 1 == 1,
                    None => void.get(VoxelIndex(voxel.0 + STEPS[step])),
                };
                each_side(patch, is_void, |step, area_m2| {
                    if is_inside(VoxelIndex(voxel.0 + STEPS[step]))
                        && let Some(node) = model.skeleton.nearest.node(VoxelIndex(voxel.0 + STEPS[step]))
                    {
                        found.push((node, area_m2, area_m2 * f64::from(patch.reflectance)));
                    }
                });
            }
        }
        found
    });
    pieces.collect()
}

/// Each piece of glazing, which is no matter to the voxels, for the node on each of its sides: as much of a wall as it does not
/// let pass.
fn panes(model: &Model) -> Vec<(u32, f64, f64)> {
    let voxel_m = model.voxels.lattice.voxel_m;
    let mut found = Vec::new();
    for (corners_m, answer) in model.walls.corners_m.iter().zip(&model.walls.answers).filter(|(_, at)| at.passes > 0.0)
    {
        let [a, b, c] = *corners_m;
        let cross = (b - a).cross(c - a);
        let (area_m2, normal) = (0.5 * f64::from(cross.length()), cross.normalize_or_zero());
        let pieces = (area_m2 / f64::from(voxel_m * voxel_m)).ceil().clamp(1.0, MOST_PIECES);
        for index in 0..pieces as u32 {
            let [u, v] = sequence::square(index, [0.0; 2]).map(|number| number as f32);
            let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
            let at_m = a + u * (b - a) + v * (c - a);
            for side in [normal, -normal] {
                let voxel = model.voxels.lattice.voxel_at(at_m + 0.6 * voxel_m * side);
                if let Some(node) = model.skeleton.nearest.node(voxel) {
                    let [passed, reflected] = [answer.passes, answer.reflects].map(f64::from);
                    found.push((node, (1.0 - passed) * area_m2 / pieces, reflected * area_m2 / pieces));
                }
            }
        }
    }
    found
}

/// Gives the area of a patch to the void before it, on each side that has void, by the number of the step there.
fn each_side(patch: &SurfacePatch, is_void: impl Fn(usize) -> bool, mut give: impl FnMut(usize, f64)) {
    if patch.area_m2 <= 0.0 {
        return;
    }
    let area_m2 = f64::from(patch.area_m2);
    // Over faces first, then over edges and corners.
    let near = [0..FACES, FACES..STEPS.len()];
    if patch.normal.length_squared() >= FLAT * FLAT {
        for steps in near.clone() {
            // The void that lies straightest before the face, and behind it.
            let mut sides = [(ON_A_SIDE, None); 2];
            for step in steps {
                let along = patch.normal.dot(STEPS[step].as_vec3());
                let side = &mut sides[usize::from(along < 0.0)];
                if along.abs() > side.0 && is_void(step) {
                    *side = (along.abs(), Some(step));
                }
            }
            let found = sides.iter().filter_map(|(_, step)| *step);
            if found.clone().count() > 0 {
                return found.for_each(|step| give(step, area_m2));
            }
        }
    }
    for steps in near {
        let found = steps.filter(|&step| is_void(step));
        let count = found.clone().count();
        if count > 0 {
            return found.for_each(|step| give(step, area_m2 / count as f64));
        }
    }
}

/// How many of the steps lead over a face.
const FACES: usize = 6;

/// Steps to the 26 voxels around one: over its faces, then over its edges and corners.
const STEPS: [IVec3; 26] = {
    let mut steps = [IVec3::ZERO; 26];
    let faces = [IVec3::X, IVec3::NEG_X, IVec3::Y, IVec3::NEG_Y, IVec3::Z, IVec3::NEG_Z];
    let mut count = 0;
    while count < FACES {
        steps[count] = faces[count];
        count += 1;
    }
    let mut at = 0;
    while at < 27 {
        let step = IVec3::new(at % 3 - 1, at / 3 % 3 - 1, at / 9 - 1);
        if (step.x != 0) as u8 + (step.y != 0) as u8 + (step.z != 0) as u8 > 1 {
            steps[count] = step;
            count += 1;
        }
        at += 1;
    }
    steps
};

/// The area of each node's void towards the outermost layer of the grid, m2, which lies outside the mesh's box; nothing where
/// no void leaks.
fn open_m2(model: &Model) -> Vec<f64> {
    let mut open_m2 = vec![0.0; model.skeleton.graph.node_count()];
    if !model.voxels.voids.iter().any(|part| part.leaks) {
        return open_m2;
    }
    let lattice = &model.voxels.lattice;
    let size = IVec3::from_array(lattice.size.map(|along| along as i32));
    let face_m2 = f64::from(lattice.voxel_m).powi(2);
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (border, inside) in [(0, 1), (size[axis] - 1, size[axis] - 2)] {
            for (i, j) in (1..size[u] - 1).flat_map(|i| (1..size[v] - 1).map(move |j| (i, j))) {
                let [out, within] = [border, inside].map(|along| {
                    let mut voxel = IVec3::ZERO;
                    (voxel[axis], voxel[u], voxel[v]) = (along, i, j);
                    VoxelIndex(voxel)
                });
                if model.voxels.void.get(out)
                    && let Some(node) = model.skeleton.nearest.node(within)
                {
                    open_m2[node as usize] += face_m2;
                }
            }
        }
    }
    open_m2
}

/// The node of a point on a wall: that of the void before the wall, looked for along the wall's normal and then back along
/// the ray that found it, `back_m` long; `None` where the whole ray runs outside the void.
pub fn node_before(model: &Model, point_m: Vec3, facing: Vec3, back: Vec3, back_m: f32) -> Option<u32> {
    let lattice = &model.voxels.lattice;
    let node = |at_m: Vec3| model.skeleton.nearest.node(lattice.voxel_at(at_m));
    let before = [0.6, 1.1, 1.6].into_iter().find_map(|voxels| node(point_m + voxels * lattice.voxel_m * facing));
    before.or_else(|| {
        let steps = (2.0 * back_m / lattice.voxel_m).ceil().max(1.0);
        (1..=steps as u32).find_map(|step| node(point_m + (step as f32 / steps * back_m) * back))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{FLUX_W, lamp, modelled, room, two_rooms};
    use crate::voxel::test_scenes::boxed;

    fn sums(triangles: &[[Vec3; 3]]) -> (f64, f64, f64) {
        let (_, model) = modelled(triangles, vec![lamp(Vec3::new(1.0, 1.4, 1.5), FLUX_W)], Vec::new());
        let all = Surroundings::of(&model);
        (all.volume_m3.iter().sum(), all.wall_m2.iter().sum(), all.open_m2.iter().sum())
    }

    #[test]
    fn the_walls_of_rooms_are_all_there_once() {
        let (volume_m3, wall_m2, open_m2) = sums(&room());
        assert!((wall_m2 / 54.0 - 1.0).abs() < 1e-3 && open_m2 == 0.0, "{wall_m2}");
        assert!((volume_m3 / 27.0 - 1.0).abs() < 0.05, "{volume_m3}");
        // Floor and ceiling lose the foot of the wall between the rooms; it has two sides, and a front in the door.
        let inside_m2 = 2.0 * (24.0 - 0.8) + 2.0 * 9.0 + 2.0 * 24.0 - 0.4 * 3.0 + 2.0 * 6.0 + 0.4 * 3.0;
        let (_, wall_m2, _) = sums(&two_rooms());
        assert!((wall_m2 / inside_m2 - 1.0).abs() < 0.02, "{wall_m2} for {inside_m2}");
    }

    #[test]
    fn a_sheet_counts_on_both_sides() {
        let mut triangles = room();
        triangles.extend(&boxed(Vec3::new(1.0, 1.0, 0.5), Vec3::new(1.0, 2.0, 2.5))[8..10]);
        let (_, wall_m2, _) = sums(&triangles);
        let sheet_m2 = wall_m2 - 54.0;
        assert!((sheet_m2 / 4.0 - 1.0).abs() < 0.1, "{sheet_m2}");
    }

    #[test]
    fn a_void_that_leaks_is_open() {
        let (_, _, open_m2) = sums(&room()[..10]);
        assert!((open_m2 / 9.0 - 1.0).abs() < 0.1, "{open_m2}");
    }
}
