//! The mesh in its materials' grey, its glazing and its lamps, and the faces in the colours of a field.

use crate::layers::{Layers, MeshStyle};
use crate::measure::shown;
use crate::paint::{Batch, Corner, Culling, FaceStyle, Tint, What};
use crate::results::Faces;
use glam::Vec3;
use lightvein::scene::{Material, Scene};
use std::sync::Arc;

/// How much of what is behind a transparent mesh shows.
const TRANSPARENT: f32 = 0.25;

/// The same for glazing.
const GLASS: f32 = 0.3;

/// Corners of opaque faces and of glazing.
pub type Parts = [Arc<Vec<Corner>>; 2];

/// The mesh's corners, each face in the grey that its reflectance is on a screen.
pub fn corners(scene: &Scene, sides: Option<&[u8]>) -> Parts {
    let mut parts = [Vec::new(), Vec::new()];
    for triangle in 0..scene.mesh.triangles.len() {
        let (Some(corners_m), Some(material)) = (scene.mesh.corners_m(triangle), scene.material(triangle)) else {
            continue;
        };
        let sides = sides.and_then(|sides| sides.get(triangle)).map_or(3, |sides| u32::from(*sides));
        let is_glass = material.passes() > 0.0;
        let colour = colour(material);
        parts[usize::from(is_glass)].extend(face(corners_m, f32::NAN, colour, if is_glass { 3 } else { sides }));
    }
    parts.map(Arc::new)
}

/// The colour of a material: its reflectance as grey; glass is bluish, lamps are yellow.
fn colour(material: &Material) -> [u8; 4] {
    if material.emits() {
        return [255, 236, 160, 255];
    }
    if material.passes() > 0.0 {
        return [150, 190, 220, 255];
    }
    // Dark materials stay visible and white ones below the brightest, so that shading shows on both.
    let grey = 60.0 + 165.0 * material.reflectance.clamp(0.0, 1.0).powf(1.0 / 2.2);
    [grey as u8, grey as u8, (grey * 0.97) as u8, 255]
}

/// The faces of a field with their values, three corners each.
pub fn valued(faces: &Faces) -> Arc<Vec<Corner>> {
    let readings = faces.field.readings.iter().map(shown);
    // They face the void by how they were made.
    Arc::new(
        faces
            .faces_m
            .iter()
            .zip(readings)
            .flat_map(|(face_m, value)| face(*face_m, value, [128, 128, 128, 255], 1))
            .collect(),
    )
}

/// The corners of one face.
pub fn face([a, b, c]: [Vec3; 3], value: f32, colour: [u8; 4], sides: u32) -> [Corner; 3] {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    [a, b, c].map(|position_m| Corner { position_m, normal, value, colour, sides })
}

/// The mesh in its own colours, in the light of sun and sky where these shine and nothing is to be seen through it.
pub fn batches([opaque, glass]: Parts, layers: &Layers) -> Vec<Batch> {
    let culling = if layers.cull_near_walls { Culling::ToVoid } else { Culling::None };
    let style = match layers.mesh_style {
        MeshStyle::Wireframe => FaceStyle::Wireframe,
        MeshStyle::Shaded if layers.shadows => FaceStyle::Sunlit,
        MeshStyle::Shaded | MeshStyle::Transparent => FaceStyle::Shaded,
    };
    let opacity = if layers.mesh_style == MeshStyle::Transparent { TRANSPARENT } else { 1.0 };
    let batch = |data, opacity| Batch { cut: true, opacity, ..Batch::new(What::Faces { data, style, culling }) };
    let glass_opacity = if style == FaceStyle::Wireframe { opacity } else { GLASS.min(opacity) };
    vec![batch(opaque, opacity), batch(glass, glass_opacity)]
}

/// The faces in the colours of their values.
pub fn coloured(data: Arc<Vec<Corner>>, tint: Tint, layers: &Layers) -> Batch {
    let culling = if layers.cull_near_walls { Culling::ToVoid } else { Culling::None };
    let style = if layers.mesh_style == MeshStyle::Wireframe { FaceStyle::Wireframe } else { FaceStyle::Flat };
    let opacity = if layers.mesh_style == MeshStyle::Transparent { 2.0 * TRANSPARENT } else { 1.0 };
    Batch { cut: true, opacity, tint, ..Batch::new(What::Faces { data, style, culling }) }
}
