//! What the worker keeps from one request to the next, so that a change costs only what depends on it.

use crate::request::{Edits, Source};
use crate::results::Results;
use lightvein::model::Model;
use lightvein::rays::Rays;
use lightvein::scene::parts::Edit;
use lightvein::scene::{Light, Scene};
use lightvein::skeleton::Filter;
use std::sync::Arc;

/// What is kept.
#[derive(Default)]
pub struct Cache {
    /// The scene as its file has it.
    pub loaded: Option<Loaded>,
    /// The same with its parts changed.
    pub shaped: Option<Shaped>,
    /// Its model.
    pub modelled: Option<Modelled>,
    /// The voxel size that the library chose for the scene, metres.
    pub chosen_voxel_m: Option<f32>,
    /// Where a bare mesh got its light, and its sensors.
    pub bare: Option<Arc<Scene>>,
    /// What was shown last of this scene; newer parts replace it one by one.
    pub shown: Results,
}

/// A scene and where it came from.
pub struct Loaded {
    /// Where it came from.
    pub source: Source,
    /// The scene.
    pub scene: Arc<Scene>,
}

/// A scene's geometry after edits of its parts, and its rays with the bodies of its lights.
pub struct Shaped {
    /// The edits.
    pub parts: Vec<(String, Edit)>,
    /// The lights whose bodies stand in the rays.
    pub bodies: Vec<Light>,
    /// The scene with its parts changed, and else as loaded.
    pub scene: Arc<Scene>,
    /// What rays hit.
    pub rays: Arc<Rays>,
}

/// A model and what it was made of.
pub struct Modelled {
    /// Edits that it holds.
    pub edits: Edits,
    /// Voxel size, metres.
    pub voxel_m: f32,
    /// What the skeleton keeps.
    pub filter: Filter,
    /// The model.
    pub model: Arc<Model>,
    /// The scene that it is of.
    pub scene: Arc<Scene>,
    /// Which sides of the mesh's triangles border the void.
    pub sides: Arc<Vec<u8>>,
}

impl Cache {
    /// Forgets all but the scene of that source.
    pub fn keep_only(&mut self, source: &Source) {
        if self.loaded.as_ref().is_none_or(|loaded| loaded.source != *source) {
            *self = Self::default();
        }
    }
}
