//! What does a ray meet, in patches?

use super::Grounds;
use super::patches::Start;
use crate::model::walls::Answer;
use crate::rays::Surface;
use glam::Vec3;

/// Panes that a ray may cross; the next one stands as a wall that passes nothing.
const MOST_PANES: usize = 16;

/// Where a ray ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// On a patch.
    Patch(u32),
    /// On the body of a light, which is black.
    Black,
    /// Nowhere: it leaves the scene.
    Outside,
}

/// Glazing that a ray crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pane {
    /// The patches of its two sides, the one first met first.
    pub sides: [u32; 2],
    /// Where, with the normal on the side first met.
    pub at: Start,
}

/// The way of a ray.
#[derive(Debug, Clone, PartialEq)]
pub struct Walk {
    /// Where it ends.
    pub end: End,
    /// The place there, with the normal on the side that was hit; of a ray that leaves the scene only where it came from.
    pub at: Start,
    /// Glazing on it, in order.
    pub panes: Vec<Pane>,
    /// Its length, metres; of one that leaves the scene as far as the scene reaches.
    pub length_m: f32,
}

/// Follows a ray, through glazing, to its end; `None` where that end says nothing, because it lies in matter or in a crevice
/// that the voxels close.
pub fn walk(grounds: &Grounds, mut from_m: Vec3, direction: Vec3) -> Option<Walk> {
    let rays = &grounds.model.rays;
    let (mut panes, mut length_m) = (Vec::new(), 0.0);
    loop {
        let Some(hit) = rays.closest(from_m, direction, f32::INFINITY) else {
            let at = Start { position_m: from_m, normal: -direction, answer: Answer::default() };
            return Some(Walk { end: End::Outside, at, panes, length_m: length_m + grounds.farthest_m });
        };
        length_m += hit.distance_m;
        let position_m = from_m + hit.distance_m * direction;
        let at = Start { position_m, normal: hit.facing(), answer: grounds.model.walls.answer(hit.surface) };
        if let Surface::Light(_) = hit.surface {
            return Some(Walk { end: End::Black, at, panes, length_m });
        }
        let patch = grounds.patch_at(&at, direction, hit.distance_m)?;
        if at.answer.passes <= 0.0 || panes.len() == MOST_PANES {
            return Some(Walk { end: End::Patch(patch), at, panes, length_m });
        }
        let behind = grounds.patch_at(&Start { normal: -at.normal, ..at }, -direction, 0.0)?;
        panes.push(Pane { sides: [patch, behind], at });
        from_m = position_m - at.normal * rays.epsilon_m();
    }
}
