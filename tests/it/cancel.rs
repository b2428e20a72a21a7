//! Every long step stops when asked to.

use super::modelled::{model, scene};
use lightvein::flow::estimator;
use lightvein::job::{Cancel, Cancelled, Quiet};
use lightvein::light::Settings;
use lightvein::model::{Model, ModelError};
use lightvein::rays::Rays;
use lightvein::scene::{Method, Scene};
use lightvein::skeleton::thin;
use lightvein::trace::trace;
use lightvein::voxel::VoxelError;
use std::path::Path;
use std::sync::Arc;

#[test]
fn a_raised_flag_stops_every_step() {
    let cancel = Cancel::new();
    cancel.cancel();
    let scene = scene("two_rooms");
    let model = model(&scene);
    let settings = Settings::default();

    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two_rooms/two_rooms.toml");
    assert!(Scene::load(&path, &Quiet, &cancel).is_err_and(|error| error.to_string().contains("interrupted")));
    let built = Model::build(&scene, Arc::new(Rays::new(&scene)), 0.1, u64::MAX, &Quiet, &cancel);
    assert!(matches!(built, Err(ModelError::Voxel(VoxelError::Cancelled(_)) | ModelError::Cancelled(_))));
    assert!(thin(&model.voxels.void, &Quiet, &cancel).is_err());
    for method in [Method::Backward, Method::Forward, Method::Diffusion] {
        let estimate = estimator(method).unwrap();
        let stopped = estimate(&model, &model.probes_at_sensors(&scene), &settings, &Quiet, &cancel);
        assert_eq!(stopped, Err(Cancelled));
    }
    assert_eq!(trace(&scene, &model.rays, &model.sources, &settings, &Quiet, &cancel), Err(Cancelled));
}
