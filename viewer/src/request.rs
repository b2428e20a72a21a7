//! What was asked: all that results depend on, as plain data that can be compared, undone and handed to the worker.

use lightvein::scene::parts::Edit;
use lightvein::scene::{Light, Method};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Where a scene comes from.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Source {
    /// The scene that greets who starts the viewer bare.
    #[default]
    Welcome,
    /// A scene file or a mesh.
    File(PathBuf),
}

impl Source {
    /// What it is called in titles and errors.
    pub fn name(&self) -> String {
        match self {
            Self::Welcome => "welcome".to_owned(),
            Self::File(path) => path.display().to_string(),
        }
    }
}

/// What the user changed of the scene as its file has it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edits {
    /// All lights, in scene space, once one was changed; `None` leaves the file's.
    pub lights: Option<Vec<Light>>,
    /// Reflectances by the number of the material, 0 to 1.
    pub reflectances: BTreeMap<usize, f32>,
    /// What is done to named parts of the mesh.
    pub parts: Vec<(String, Edit)>,
}

impl Edits {
    /// Whether nothing was changed.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// How the estimate is made.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct How {
    /// Edge of a voxel, metres; `None` for the file's, or one that the library chooses.
    pub voxel_m: Option<f32>,
    /// The method; `None` for the file's, or `network`.
    pub method: Option<Method>,
    /// Which rung of the method's ladder of qualities, the cheapest first; `None` for its default quality.
    pub quality: Option<usize>,
    /// What the skeleton keeps.
    pub filter: lightvein::skeleton::Filter,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// All that results depend on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Request {
    /// The scene.
    pub source: Source,
    /// What was changed of it.
    pub edits: Edits,
    /// How the estimate is made.
    pub how: How,
    /// What is asked of sun and sky; `None` where nothing is.
    pub outdoors: Option<crate::outdoors::OutdoorRequest>,
    /// What else is wanted: what nobody looks at is not computed.
    pub wants: Wants,
}

/// Parts of an answer that are made on demand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wants {
    /// Voxels, skeleton and an estimate: off for scenes in the open without a lamp, where nothing flows.
    pub model: bool,
    /// The estimate on the faces of the mesh.
    pub faces: bool,
    /// All methods beside the chosen one.
    pub all_methods: bool,
}

impl Default for Wants {
    fn default() -> Self {
        Self { model: true, faces: false, all_methods: true }
    }
}

impl Request {
    /// A fresh request for a scene.
    pub fn of(source: Source) -> Self {
        Self { source, ..Self::default() }
    }
}

/// Requests that were left, and those that undoing left.
#[derive(Debug, Clone, Default)]
pub struct History {
    undone: Vec<Request>,
    done: Vec<Request>,
    gesture: Option<u64>,
}

/// Most steps that are kept.
const LONGEST: usize = 200;

impl History {
    /// Keeps `before`, the request that a change is about to leave. Changes of one gesture (a drag, a typed number) share a
    /// number and are one step.
    pub fn keep(&mut self, before: &Request, gesture: u64) {
        self.undone.clear();
        if self.gesture == Some(gesture) {
            return;
        }
        self.gesture = Some(gesture);
        self.done.push(before.clone());
        if self.done.len() > LONGEST {
            self.done.remove(0);
        }
    }

    /// The request before the last change; `now` can be had back.
    pub fn undo(&mut self, now: &Request) -> Option<Request> {
        let before = self.done.pop()?;
        self.undone.push(now.clone());
        self.gesture = None;
        Some(before)
    }

    /// The request that was undone last.
    pub fn redo(&mut self, now: &Request) -> Option<Request> {
        let after = self.undone.pop()?;
        self.done.push(now.clone());
        self.gesture = None;
        Some(after)
    }

    /// Whether there is a step to undo, and one to redo.
    pub fn can(&self) -> [bool; 2] {
        [!self.done.is_empty(), !self.undone.is_empty()]
    }

    /// Forgets all: another scene was opened.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(seed: u64) -> Request {
        Request { how: How { seed, ..How::default() }, ..Request::default() }
    }

    #[test]
    fn a_gesture_is_one_step_and_a_change_forgets_what_was_undone() {
        let mut history = History::default();
        history.keep(&of(0), 1);
        history.keep(&of(1), 1);
        history.keep(&of(2), 2);
        assert_eq!(history.undo(&of(3)), Some(of(2)));
        assert_eq!(history.undo(&of(2)), Some(of(0)));
        assert_eq!(history.undo(&of(0)), None);
        assert_eq!(history.redo(&of(0)), Some(of(2)));
        history.keep(&of(2), 3);
        assert_eq!((history.can(), history.redo(&of(4))), ([true, false], None));
    }

    #[test]
    fn the_same_widget_after_an_undo_is_a_new_step() {
        let mut history = History::default();
        history.keep(&of(0), 1);
        assert_eq!(history.undo(&of(1)), Some(of(0)));
        history.keep(&of(0), 1);
        assert_eq!(history.undo(&of(5)), Some(of(0)));
    }

    #[test]
    fn the_oldest_steps_are_forgotten() {
        let mut history = History::default();
        (0..LONGEST as u64 + 5).for_each(|step| history.keep(&of(step), step));
        assert_eq!((history.done.len(), history.done[0].how.seed), (LONGEST, 5));
    }
}
