//! A light or a part dragged by hand: by itself across the screen, or along an axis by the gizmo's arrows.

use super::gizmo_length_m;
use crate::draw::marks::{bounds_of_part, position_m};
use crate::panels::scene::{asked_lights, moved_by};
use crate::pick;
use crate::state::{Picked, State};
use glam::{DVec3, Vec2, Vec3};
use lightvein::scene::Light;
use lightvein::scene::parts::Edit;
use std::sync::atomic::{AtomicU64, Ordering};

/// An arrow is taken hold of within this distance on screen.
const REACH_PX: f32 = 9.0;

/// Numbers of drags, each a step to undo; beyond those of widgets, which are hashes.
static DRAGS: AtomicU64 = AtomicU64::new(0);

/// What the hand holds.
#[derive(Debug, Clone)]
pub struct Drag {
    what: Held,
    axis: Option<usize>,
    from_px: Vec2,
    from_m: Vec3,
    gesture: u64,
}

#[derive(Debug, Clone)]
enum Held {
    Light(usize, Light),
    Part(String, DVec3),
}

/// Where the arrows of what is picked stand, and how long they are; `None` for what cannot be dragged.
pub fn gizmo(state: &State, size_px: Vec2) -> Option<(Vec3, f32)> {
    let at_m = match state.picked? {
        picked @ Picked::Light(_) if state.layers.lights => position_m(&state.results, &asked_lights(state), picked)?,
        Picked::Part(part) if state.layers.mesh => {
            let scene = state.results.scene.as_ref()?;
            let (low, high) = bounds_of_part(scene, part)?;
            ((low + high) / 2.0).with_z(high.z)
        }
        _ => return None,
    };
    Some((at_m, gizmo_length_m(state, at_m, size_px)))
}

impl Drag {
    /// The drag that a press at `from_px` begins; `None` where it holds nothing and moves the camera.
    pub fn begin(state: &mut State, from_px: Vec2, size_px: Vec2) -> Option<Self> {
        let on_arrow = state.gizmo.and_then(|(at_m, length_m)| arrow_at(state, at_m, length_m, from_px, size_px));
        let lights = asked_lights(state).into_owned();
        let under = pick::pick(&state.results, &lights, &state.layers, &state.camera, from_px, size_px);
        let picked = match (on_arrow, under) {
            (Some(_), _) => state.picked?,
            (None, Some(light @ Picked::Light(_))) => light,
            _ => return None,
        };
        let (what, from_m) = match picked {
            Picked::Light(number) => {
                let light = *lights.get(number)?;
                state.pick(Some(picked));
                (Held::Light(number, light), position_m(&state.results, &lights, picked)?)
            }
            Picked::Part(number) => {
                let part = state.results.loaded.as_ref()?.parts.get(number)?;
                let moved = state.request.edits.parts.iter().filter(|(name, _)| *name == part.name);
                let by_m =
                    moved.filter_map(|(_, edit)| if let Edit::Move(by_m) = edit { Some(*by_m) } else { None }).sum();
                (Held::Part(part.name.clone(), by_m), state.gizmo?.0)
            }
            Picked::Node(_) | Picked::Sensor(_) => return None,
        };
        let gesture = DRAGS.fetch_add(1, Ordering::Relaxed);
        Some(Self { what, axis: on_arrow, from_px, from_m, gesture })
    }

    /// Moves what is held to where the pointer is.
    pub fn follow(&self, state: &mut State, to_px: Vec2, size_px: Vec2) {
        let by_m = match self.axis {
            Some(axis) => {
                let along_m = state.camera.along_axis_m(self.from_m, Vec3::AXES[axis], self.from_px, to_px, size_px);
                Vec3::AXES[axis] * along_m
            }
            None => {
                let [from_m, to_m] =
                    [self.from_px, to_px].map(|at_px| state.camera.on_plane_m(self.from_m, at_px, size_px));
                to_m - from_m
            }
        };
        if !by_m.is_finite() {
            return;
        }
        match &self.what {
            Held::Light(number, light) => {
                let mut lights = asked_lights(state).into_owned();
                if let Some(held) = lights.get_mut(*number) {
                    *held = moved_by(*light, by_m);
                    state.change(self.gesture, |request| request.edits.lights = Some(lights));
                }
            }
            Held::Part(name, before_m) => {
                let moved = Edit::Move(*before_m + by_m.as_dvec3());
                state.change(self.gesture, |request| {
                    request.edits.parts.retain(|(of, edit)| of != name || !matches!(edit, Edit::Move(_)));
                    request.edits.parts.push((name.clone(), moved));
                });
            }
        }
    }
}

/// The arrow under the pointer.
fn arrow_at(state: &State, at_m: Vec3, length_m: f32, pointer_px: Vec2, size_px: Vec2) -> Option<usize> {
    let off_px = |axis: &usize| {
        let (from_px, _) = state.camera.project(at_m, size_px)?;
        let (to_px, _) = state.camera.project(at_m + Vec3::AXES[*axis] * length_m, size_px)?;
        // Its outer half: the inner one is what is dragged across the screen.
        let along = to_px - from_px;
        let share = (pointer_px - from_px).dot(along) / along.length_squared().max(1e-6);
        Some(pointer_px.distance(from_px + along * share.clamp(0.3, 1.05)))
    };
    let near = (0..3).filter_map(|axis| Some((off_px(&axis)?, axis)));
    near.filter(|(off_px, _)| *off_px < REACH_PX).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, axis)| axis)
}
