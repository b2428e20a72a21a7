//! What bounds a solid made of axis-aligned boxes in the open air? `boxes`' plan with matter and void changing places.

use crate::boxes::Plan;
use crate::scene::Mesh;

/// Boxes in the order in which they are filled in or opened.
#[derive(Default)]
pub struct Matter(Plan);

impl Matter {
    /// Fills a box with matter.
    pub fn block(self, min: [f64; 3], max: [f64; 3]) -> Self {
        Self(self.0.void(min, max))
    }

    /// Opens a box to the air: a room, a window, a court.
    pub fn opening(self, min: [f64; 3], max: [f64; 3]) -> Self {
        Self(self.0.solid(min, max))
    }

    /// The boundary, its normals into the air.
    pub fn mesh(&self) -> Mesh {
        let mut mesh = self.0.mesh(|_| "");
        mesh.groups.iter_mut().flat_map(|(_, polygons)| polygons).for_each(|polygon| polygon.reverse());
        mesh
    }
}
