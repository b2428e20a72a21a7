//! Which results something was made of, so that it is made again when they change and not before.

use crate::outdoors::sky::Sky;
use crate::outdoors::{FaceExposure, PixelExposure, SensorExposure};
use crate::results::{Answer, Estimate, Faces, Results};
use lightvein::model::Model;
use lightvein::scene::Scene;
use std::sync::{Arc, Weak};

/// Names results without keeping them in memory.
#[derive(Debug, Clone, Default)]
pub struct Stamp {
    scene: Weak<Scene>,
    model: Weak<Model>,
    estimate: Weak<Estimate>,
    faces: Weak<Faces>,
    answers: Weak<Vec<Answer>>,
    sky: Weak<Sky>,
    exposed_faces: Weak<FaceExposure>,
    exposed_sensors: Weak<SensorExposure>,
    exposed_pixels: Weak<PixelExposure>,
}

impl Stamp {
    /// The stamp of these results.
    pub fn of(results: &Results) -> Self {
        Self {
            scene: weak(results.scene.as_ref()),
            model: weak(results.model.as_ref()),
            estimate: weak(results.estimate.as_ref()),
            faces: weak(results.faces.as_ref()),
            answers: Arc::downgrade(&results.answers),
            sky: weak(results.outdoors.sky.as_ref()),
            exposed_faces: weak(results.outdoors.faces.as_ref()),
            exposed_sensors: weak(results.outdoors.sensors.as_ref()),
            exposed_pixels: weak(results.outdoors.pixels.as_ref()),
        }
    }

    /// Whether both are of the very same results.
    pub fn is(&self, other: &Self) -> bool {
        self.scene.ptr_eq(&other.scene)
            && self.model.ptr_eq(&other.model)
            && self.estimate.ptr_eq(&other.estimate)
            && self.faces.ptr_eq(&other.faces)
            && self.answers.ptr_eq(&other.answers)
            && self.sky.ptr_eq(&other.sky)
            && self.exposed_faces.ptr_eq(&other.exposed_faces)
            && self.exposed_sensors.ptr_eq(&other.exposed_sensors)
            && self.exposed_pixels.ptr_eq(&other.exposed_pixels)
    }
}

fn weak<T>(shared: Option<&Arc<T>>) -> Weak<T> {
    shared.map(Arc::downgrade).unwrap_or_default()
}
