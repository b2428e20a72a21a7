//! The skeleton of every scene has the topology of its void, and its structures hold what they promise.

use super::modelled::{HELD_OUT, SCENES, model, scene};
use lightvein::skeleton::topology;

#[test]
fn every_skeleton_has_the_components_and_loops_of_its_void() {
    for name in SCENES {
        let model = model(&scene(name));
        let void = topology::of_void(&model.voxels.void);
        let shape = model.skeleton.shape();
        assert_eq!([shape.components as i64, shape.loops as i64], [void.components, void.loops], "{name}");
    }
}

#[test]
fn the_skeletons_of_the_test_set_have_the_loops_of_its_plans() {
    for (name, loops) in HELD_OUT {
        let model = model(&scene(name));
        let (void, shape) = (topology::of_void(&model.voxels.void), model.skeleton.shape());
        assert_eq!([void.components, void.loops], [1, loops as i64], "{name}");
        assert_eq!([shape.components, shape.loops], [1, loops], "{name}");
    }
}

#[test]
fn voxels_and_skeleton_are_valid() {
    for name in SCENES.into_iter().chain(HELD_OUT.map(|(name, _)| name)) {
        let model = model(&scene(name));
        assert_eq!(model.voxels.validate(), Ok(()), "{name}");
        assert_eq!(model.skeleton.validate(&model.voxels.void), Ok(()), "{name}");
    }
}
