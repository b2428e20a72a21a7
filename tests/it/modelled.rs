//! The generated scenes, modelled as the program does.

use lightvein::job::{Cancel, Quiet};
use lightvein::model::Model;
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use std::path::Path;
use std::sync::Arc;

/// Every generated scene.
pub const SCENES: [&str; 7] = ["furnace", "two_rooms", "keyhole", "gallery", "corridor", "cave", "tower"];

/// The test set, and how many loops the void of each scene has by its plan: pillars, a pier, doors between neighbours.
pub const HELD_OUT: [(&str, usize); 5] = [
    ("held_out/loft", 0),
    ("held_out/pipes", 0),
    ("held_out/halls", 8),
    ("held_out/crypt", 1),
    ("held_out/offices", 3),
];

/// A generated scene as its file has it.
pub fn scene(folder: &str) -> Scene {
    let name = folder.rsplit('/').next().expect("a folder");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{folder}/{name}.toml"));
    Scene::load(&path, &Quiet, &Cancel::new()).unwrap_or_else(|error| panic!("{error}"))
}

/// The scene's model at the voxel size that its file gives.
pub fn model(scene: &Scene) -> Model {
    let voxel_m = scene.model.voxel_m.expect("generated scenes give their voxel size");
    Model::build(scene, Arc::new(Rays::new(scene)), voxel_m, u64::MAX, &Quiet, &Cancel::new())
        .expect("the scene models")
}
