//! What is drawn, as plain data: a camera, a background, cuts and batches of faces, balls, cubes and strokes.
//!
//! Positions are in scene space, metres, Z up. Data are shared ([`Arc`]) and compared by address: change data by making
//! a new `Arc`, and change how data look (tint, style, opacity) by changing the batch alone, which uploads nothing.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::sunlight::Sunlight;
use crate::camera::Camera;
use crate::colour::Scale;

/// A whole view. Equal to another when nothing to be seen differs (data are compared by address).
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// From where.
    pub camera: Camera,
    /// Colours (sRGB) of the background at the top and at the bottom; between them it fades.
    pub background: [[u8; 3]; 2],
    /// Sun and sky: the sky stands behind the scene instead of the background, and lights [`FaceStyle::Sunlit`] faces.
    pub sunlight: Option<Sunlight>,
    /// What is cut away of the batches that can be cut: at most [`Picture::MOST_CUTS`], further ones are not drawn.
    pub cuts: Vec<Cut>,
    /// Drawn in this order among those of a kind: first the opaque, then the transparent, then those on top.
    pub batches: Vec<Batch>,
}

impl Picture {
    /// Cuts that are heeded.
    pub const MOST_CUTS: usize = 2;

    /// Whether there is a sun and what keeps it off: where [`FaceStyle::Sunlit`] faces are lit by it.
    pub(super) fn has_shadows(&self) -> bool {
        self.sunlight.as_ref().is_some_and(|sunlight| sunlight.shadows.is_some())
    }
}

/// A half space that is cut away: point p is hidden where `normal . p > offset_m`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cut {
    /// Of length one.
    pub normal: Vec3,
    /// Of the cutting plane, along the normal.
    pub offset_m: f32,
}

/// Things of one kind that look alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// The things.
    pub what: What,
    /// Their colours.
    pub tint: Tint,
    /// Whether the picture's cuts apply (faces and cubes; balls and strokes by their own points).
    pub cut: bool,
    /// Drawn over everything else, hidden only by others on top: a selected path.
    pub on_top: bool,
    /// 1 hides what is behind; below, the batch is blended over the opaque ones, in the order of its data.
    pub opacity: f32,
}

impl Batch {
    /// An opaque batch in its own colours that nothing cuts and that lies among the rest.
    pub fn new(what: What) -> Self {
        Self { what, tint: Tint::Own, cut: false, on_top: false, opacity: 1.0 }
    }
}

/// The closed set of what can be drawn.
#[derive(Clone, Debug)]
pub enum What {
    /// Triangles, three corners each; a last incomplete one is left out.
    Faces {
        /// The corners.
        data: Arc<Vec<Corner>>,
        /// How their insides are drawn.
        style: FaceStyle,
        /// Which sides are drawn.
        culling: Culling,
    },
    /// Spheres; a radius on screen stays between two bounds in pixels.
    Balls {
        /// The spheres.
        data: Arc<Vec<Ball>>,
        /// Least radius on screen: small nodes stay visible.
        least_px: f32,
        /// Greatest radius on screen: near nodes do not fill it. `f32::INFINITY` for balls of their true size.
        most_px: f32,
    },
    /// Faces of voxels: squares that face along an axis, all of one size.
    Cubes {
        /// The faces.
        data: Arc<Vec<Cube>>,
        /// Edge of a voxel.
        edge_m: f32,
        /// [`Culling::ToVoid`] draws a face only from its outer side.
        culling: Culling,
    },
    /// Lines of constant width on screen, with round ends.
    Strokes {
        /// The lines.
        data: Arc<Vec<Stroke>>,
    },
}

impl PartialEq for What {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (
                What::Faces { data, style, culling },
                What::Faces { data: other_data, style: other_style, culling: other_culling },
            ) => Arc::ptr_eq(data, other_data) && style == other_style && culling == other_culling,
            (
                What::Balls { data, least_px, most_px },
                What::Balls { data: other_data, least_px: other_least_px, most_px: other_most_px },
            ) => Arc::ptr_eq(data, other_data) && least_px == other_least_px && most_px == other_most_px,
            (
                What::Cubes { data, edge_m, culling },
                What::Cubes { data: other_data, edge_m: other_edge_m, culling: other_culling },
            ) => Arc::ptr_eq(data, other_data) && edge_m == other_edge_m && culling == other_culling,
            (What::Strokes { data }, What::Strokes { data: other_data }) => Arc::ptr_eq(data, other_data),
            _ => false,
        }
    }
}

/// How the insides of faces are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum FaceStyle {
    /// Lit from the viewer and from above, never black.
    #[default]
    Shaded,
    /// Lit by the picture's sun and sky, with shadows; as [`FaceStyle::Shaded`] in a picture without them, and where
    /// values are shown.
    Sunlit,
    /// The colour as it is: heatmaps, whose colours are to be read off.
    Flat,
    /// The edges alone.
    Wireframe,
}

/// Which sides of a face are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Culling {
    /// Both sides of every face.
    #[default]
    None,
    /// A side only where the void borders it ([`Corner::sides`]; of a [`Cube`] the outer side): rooms are seen into
    /// from outside, through the backs of their walls.
    ToVoid,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Corner {
    /// Where it is.
    pub position_m: Vec3,
    /// Of the triangle's front, of length one: the same at all three corners.
    pub normal: Vec3,
    /// What [`Tint::Scaled`] colours; between corners it varies linearly, and with a NaN corner the triangle is grey.
    pub value: f32,
    /// What [`Tint::Own`] colours: sRGB and opacity.
    pub colour: [u8; 4],
    /// Bit 0: the void borders the front, where the normal points. Bit 1: it borders the back.
    pub sides: u32,
}

/// A sphere: a node, a sensor, a light, a maximal ball.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Ball {
    /// Where it is.
    pub centre_m: Vec3,
    /// Before the bounds in pixels.
    pub radius_m: f32,
    /// What [`Tint::Scaled`] colours.
    pub value: f32,
    /// What [`Tint::Own`] colours: sRGB and opacity.
    pub colour: [u8; 4],
}

/// One face of a voxel.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Cube {
    /// Of the voxel, not of the face.
    pub centre_m: Vec3,
    /// Which face: 0 to 5 for +X, -X, +Y, -Y, +Z, -Z. Above, none is drawn.
    pub face: u32,
    /// What [`Tint::Scaled`] colours.
    pub value: f32,
    /// What [`Tint::Own`] colours: sRGB and opacity.
    pub colour: [u8; 4],
}

/// A line from a to b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Where it begins.
    pub a_m: Vec3,
    /// Where it ends, and where the arrow's tip is.
    pub b_m: Vec3,
    /// On screen.
    pub width_px: f32,
    /// What [`Tint::Scaled`] colours.
    pub value: f32,
    /// What [`Tint::Own`] colours: sRGB and opacity.
    pub colour: [u8; 4],
    /// Dashes of constant length on screen.
    pub dashed: bool,
    /// An arrow head at b, of constant size on screen.
    pub arrow: bool,
}

/// Where colours come from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Tint {
    /// Each thing has its own.
    Own,
    /// By value; grey where there is none.
    Scaled(Scale),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_equal_when_they_share_their_data() {
        let stroke = Stroke {
            a_m: Vec3::ZERO,
            b_m: Vec3::ONE,
            width_px: 2.0,
            value: 0.0,
            colour: [255; 4],
            dashed: false,
            arrow: false,
        };
        let data = Arc::new(vec![stroke]);
        let picture = Picture {
            camera: Camera::fitted((Vec3::ZERO, Vec3::ONE), 1.0),
            background: [[0; 3]; 2],
            sunlight: None,
            cuts: Vec::new(),
            batches: vec![Batch::new(What::Strokes { data: Arc::clone(&data) })],
        };
        let mut other = picture.clone();
        assert_eq!(picture, other);
        other.batches = vec![Batch::new(What::Strokes { data: Arc::new(vec![stroke]) })];
        assert_ne!(picture, other, "other data, even of the same contents, are drawn anew");
        other = picture.clone();
        other.batches[0].opacity = 0.5;
        assert_ne!(picture, other);
    }
}
