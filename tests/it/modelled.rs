//! The generated scenes, modelled as the program does.

use lightvein::job::{Cancel, Quiet};
use lightvein::model::Model;
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use std::path::Path;
use std::sync::Arc;

/// Every generated scene.
pub const SCENES: [&str; 6] = ["furnace", "two_rooms", "gallery", "corridor", "cave", "tower"];

/// A generated scene as its file has it.
pub fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}/{name}.toml"));
    Scene::load(&path, &Quiet, &Cancel::new()).unwrap_or_else(|error| panic!("{error}"))
}

/// The scene's model at the voxel size that its file gives.
pub fn model(scene: &Scene) -> Model {
    let voxel_m = scene.model.voxel_m.expect("generated scenes give their voxel size");
    Model::build(scene, Arc::new(Rays::new(scene)), voxel_m, u64::MAX, &Quiet, &Cancel::new())
        .expect("the scene models")
}
