//! What the worker found: the library's own structures, shared and never changed, each with what it was made for.

use lightvein::job::Cancelled;
use lightvein::light::{Field, Reading};
use lightvein::model::Model;
use lightvein::scene::{Method, Scene};
use lightvein::study::errors::Errors;
use std::sync::Arc;

/// Everything there is to show. Parts are replaced one by one as a run gets on; the old ones stay until then.
#[derive(Debug, Clone, Default)]
pub struct Results {
    /// The scene as its file has it.
    pub loaded: Option<Arc<Scene>>,
    /// The scene with the user's changes; a bare mesh has its light.
    pub scene: Option<Arc<Scene>>,
    /// What was modelled of it.
    pub model: Option<Arc<Model>>,
    /// The mesh as the view draws it: which sides of its triangles border the void.
    pub sides: Option<Arc<Vec<u8>>>,
    /// The estimate by the chosen method, or by a faster one before.
    pub estimate: Option<Arc<Estimate>>,
    /// The estimate on the faces of the mesh.
    pub faces: Option<Arc<Faces>>,
    /// All methods, for comparison.
    pub answers: Arc<Vec<Answer>>,
    /// Every method at every quality, once that was asked for.
    pub rungs: Arc<Vec<Answer>>,
    /// What sun and sky give.
    pub outdoors: crate::outdoors::OutdoorResults,
    /// The stages of the last run.
    pub stages: Vec<Stage>,
    /// What a reader of the results should know, a sentence each.
    pub warnings: Vec<String>,
}

/// A field at nodes and sensors.
#[derive(Debug, Clone)]
pub struct Estimate {
    /// By which method.
    pub method: Method,
    /// At which quality.
    pub quality: String,
    /// Readings at the nodes of the skeleton; empty for the path tracer, which is not asked there.
    pub at_nodes: Field,
    /// Readings at the scene's sensors.
    pub at_sensors: Field,
    /// The flux through each edge from its first node to its second, W.
    pub through_edges_w: Vec<f64>,
    /// How far the sensors are from the reference.
    pub errors: Errors,
    /// How long it took, seconds.
    pub seconds: f64,
    /// Whether a better one is on its way.
    pub is_first_pass: bool,
}

/// A field on the faces of the mesh.
#[derive(Debug, Clone)]
pub struct Faces {
    /// Small triangles that face the void, three corners each, metres.
    pub faces_m: Vec<[glam::Vec3; 3]>,
    /// A reading a face.
    pub field: Field,
}

/// What one method answers.
#[derive(Debug, Clone)]
pub struct Answer {
    /// The method.
    pub method: Method,
    /// At which quality.
    pub quality: String,
    /// Readings at the sensors.
    pub at_sensors: Vec<Reading>,
    /// Readings at the nodes; empty for the path tracer.
    pub at_nodes: Vec<Reading>,
    /// How far the sensors are from the reference.
    pub errors: Errors,
    /// How long the sensors took, seconds.
    pub seconds: f64,
}

impl Answer {
    /// Method and quality: `network coarse`.
    pub fn label(&self) -> String {
        format!("{} {}", self.method, self.quality).trim_end().to_owned()
    }
}

/// A stage of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    /// Its name.
    pub name: String,
    /// How many stages it stood within.
    pub depth: usize,
    /// How long it took, seconds; so far where it still runs.
    pub seconds: f64,
    /// The most memory the process had taken by its end, MB; `None` where the system does not tell.
    pub peak_memory_mb: Option<f64>,
}

/// Why a run gave nothing.
#[derive(Debug)]
pub enum Failed {
    /// It was stopped.
    Cancelled,
    /// It cannot be done, for this reason.
    Because(anyhow::Error),
}

impl From<Cancelled> for Failed {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<lightvein::model::ModelError> for Failed {
    fn from(error: lightvein::model::ModelError) -> Self {
        if error.is_cancelled() { Self::Cancelled } else { Self::Because(error.into()) }
    }
}

impl From<lightvein::scene::SceneError> for Failed {
    fn from(error: lightvein::scene::SceneError) -> Self {
        if error.is_cancelled() { Self::Cancelled } else { Self::Because(error.into()) }
    }
}

impl From<anyhow::Error> for Failed {
    fn from(error: anyhow::Error) -> Self {
        if error.is::<Cancelled>() { Self::Cancelled } else { Self::Because(error) }
    }
}
