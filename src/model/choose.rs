//! How fine must the voxels be?
//!
//! From 1/128 of the longest side, halved until halving opens no new passage. Limits: two sizes that agree by chance end the
//! search, and an opening under two voxels of the finer of them is not seen.

use super::{Model, ModelError};
use crate::job::{Cancel, Progress};
use crate::rays::Rays;
use crate::scene::Scene;
use crate::skeleton::Shape;
use crate::voxel::VoxelError;
use std::sync::Arc;

/// The longest side is cut into this many voxels where nobody says how many.
const FIRST_VOXELS_A_SIDE: f32 = 128.0;

/// No voxel size is chosen by itself that gives more voxels than this.
pub const MOST_VOXELS: usize = 200_000_000;

/// A voxel size that was chosen, the model made with it, and why.
#[derive(Debug)]
pub struct Chosen {
    /// The model at that size.
    pub model: Model,
    /// The model of voxels half as large, where that was made and opens no new passage.
    pub finer: Option<Model>,
    /// Why that size, a sentence.
    pub reason: String,
}

/// Chooses the voxel size: from 1/128 of the longest side, halved until halving opens no new passage (components, loops and
/// necks agree), at most 200 M voxels.
///
/// # Errors
/// As [`Model::build`], for the first size; where a finer one does not fit, the finest that did is taken and the reason
/// says so.
pub fn choose_voxel_m(
    scene: &Scene,
    rays: &Arc<Rays>,
    max_bytes: u64,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Chosen, ModelError> {
    let longest_m = scene.mesh.bounds_m().map_or(1.0, |(low, high)| (high - low).max_element());
    let build = |voxel_m| Model::build(scene, rays.clone(), voxel_m, max_bytes, progress, cancel);

    let mut voxel_m = longest_m / FIRST_VOXELS_A_SIDE;
    let mut model = build(voxel_m)?;
    loop {
        let finer_m = voxel_m / 2.0;
        let too_many = 8 * model.voxels.lattice.voxels() > MOST_VOXELS;
        let finer = if too_many { None } else { Some(build(finer_m)) };
        match finer {
            None => return Ok(chosen(model, None, "half of it would take over 200 million voxels")),
            Some(Err(ModelError::Voxel(VoxelError::TooLarge { .. }))) => {
                return Ok(chosen(model, None, "half of it would not fit in memory"));
            }
            Some(Err(error)) => return Err(error),
            Some(Ok(finer)) if finer.skeleton.shape() == model.skeleton.shape() => {
                return Ok(chosen(model, Some(finer), "half of it opens no new passage"));
            }
            Some(Ok(finer)) => {
                model = finer;
                voxel_m = finer_m;
            }
        }
    }
}

fn chosen(model: Model, finer: Option<Model>, because: &str) -> Chosen {
    let Shape { components, loops, necks } = model.skeleton.shape();
    let voxel_m = model.voxels.lattice.voxel_m;
    let reason = format!("voxels of {voxel_m:.4} m: {because} ({components} components, {loops} loops, {necks} necks)");
    Chosen { model, finer, reason }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::Quiet;
    use crate::scene::Light;
    use crate::voxel::test_scenes::{boxed, scene_of};
    use glam::Vec3;

    /// A bar of 8 m that a wall without thickness parts at x = 3, with a slot of that width in it.
    fn chosen(slot_m: f32) -> Chosen {
        let mut triangles = boxed(Vec3::ZERO, Vec3::new(8.0, 0.6, 0.6));
        let wall = boxed(Vec3::new(3.0, 0.0, 0.0), Vec3::new(3.0, 0.6 - slot_m, 0.6));
        triangles.extend(&wall[8..10]);
        let mut scene = scene_of(&triangles);
        scene.lights.push(Light::Point { position_m: Vec3::new(1.0, 0.3, 0.3), flux_w: 1.0 });
        let rays = Arc::new(Rays::new(&scene));
        choose_voxel_m(&scene, &rays, u64::MAX, &Quiet, &Cancel::new()).unwrap()
    }

    #[test]
    fn voxels_are_halved_until_the_slot_is_open() {
        let first_m = 8.0 / FIRST_VOXELS_A_SIDE;
        let Chosen { model, reason, .. } = chosen(0.0);
        assert_eq!((model.voxels.lattice.voxel_m, model.skeleton.necks.len()), (first_m, 0), "{reason}");
        // Less than a voxel of the first size.
        let Chosen { model, reason, .. } = chosen(0.06);
        assert!(model.voxels.lattice.voxel_m <= first_m / 2.0 && model.skeleton.necks.len() == 1, "{reason}");
        assert!(reason.contains("opens no new passage"), "{reason}");
    }
}
