//! All that the window shows and its user changes; panels read it, and change it through a few functions.
//!
//! The [`Request`] is what results depend on: changing it goes through [`State::change`], which keeps a step to undo, and the
//! app asks the worker when it differs from the last one asked. Everything else (layers, camera, what is picked) is shown at once.

use crate::camera::Camera;
use crate::colour::{ColourMap, Scale};
use crate::controls::Preset;
use crate::layers::{Layers, MeshColour};
use crate::log::Log;
use crate::measure::Measure;
use crate::outdoors::facade::Facade;
use crate::request::{History, Request};
use crate::results::Results;
use glam::Vec3;
use petgraph::graph::NodeIndex;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Something in the view that can be picked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Picked {
    /// A node of the skeleton.
    Node(NodeIndex),
    /// The sensor of that number.
    Sensor(usize),
    /// The light of that number in the scene's lights.
    Light(usize),
    /// The part of the mesh of that number.
    Part(usize),
}

/// What a panel or a key asks the app to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Ask for a file and open it.
    OpenDialog,
    /// Open a scene file or a mesh.
    Open(PathBuf),
    /// Ask for a weather file and take it.
    ChooseWeather,
    /// Compute again from the file.
    Reload,
    /// Stop the run.
    Cancel,
    /// One step back, one step forth.
    Undo,
    /// One step forth.
    Redo,
    /// Fit the view to the scene.
    Fit,
    /// Look at what is picked.
    Focus,
    /// Save a picture of the window.
    SavePicture,
    /// Run every method at every quality, for the chart.
    Measure,
    /// Write the files that `analyse -o` writes.
    Export,
    /// Write the table of sensors.
    SaveTable,
    /// Fit the scale of a measure to its values.
    Refit(Measure),
    /// Close the window.
    Quit,
}

/// What is kept from one start to the next.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Kept {
    /// Files opened last, the latest first.
    pub recent: Vec<PathBuf>,
    /// Which mouse and keys do what.
    pub preset: Preset,
    /// Size of text and widgets, 1 as the system has it.
    pub zoom: f32,
    /// Whether the dark theme is on; `None` as the system has it.
    pub dark: Option<bool>,
    /// The colour map of each measure, where its user chose one.
    pub maps: BTreeMap<Measure, ColourMap>,
}

impl Default for Kept {
    fn default() -> Self {
        Self { recent: Vec::new(), preset: Preset::default(), zoom: 1.0, dark: None, maps: BTreeMap::new() }
    }
}

/// How a run goes.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Running {
    /// Nothing runs.
    #[default]
    Idle,
    /// A stage runs.
    Stage {
        /// Its name, those it stands within before it.
        name: String,
        /// Its share that is done; `None` where nobody knows.
        share: Option<f32>,
        /// How long the run has taken so far, seconds.
        seconds: f64,
    },
}

/// All that the window shows.
pub struct State {
    /// What is asked.
    pub request: Request,
    /// What was asked before.
    pub history: History,
    /// What was found.
    pub results: Results,
    /// The request that the results are of; differs from `request` while they are stale.
    pub answered: Option<Request>,
    /// How the run goes.
    pub running: Running,
    /// Which layers are on.
    pub layers: Layers,
    /// The scales of measures that were shown; a range stays until it is refitted.
    pub scales: BTreeMap<Measure, Scale>,
    /// The camera.
    pub camera: Camera,
    /// What is picked.
    pub picked: Option<Picked>,
    /// The face of the mesh that was touched last, while nothing else is picked.
    pub facade: Option<Facade>,
    /// What the pointer is over.
    pub hovered: Option<Picked>,
    /// Where the arrows stand that what is picked is dragged by, and how long they are, metres; `None` without.
    pub gizmo: Option<(Vec3, f32)>,
    /// The ways from what is picked to each light.
    pub ways: Vec<crate::panels::inspector::WayToLight>,
    /// What was told.
    pub log: Log,
    /// What the panels asked for since the last frame.
    pub actions: Vec<Action>,
    /// What is kept from one start to the next.
    pub kept: Kept,
    /// Whether the sheet of controls is open.
    pub shows_help: bool,
    /// Sun and sky as the panels show them.
    pub outdoors: crate::outdoors::OutdoorState,
}

impl State {
    /// A state without a scene.
    pub fn new(kept: Kept, layers: Layers) -> Self {
        Self {
            request: Request::default(),
            history: History::default(),
            results: Results::default(),
            answered: None,
            running: Running::Idle,
            layers,
            scales: BTreeMap::new(),
            camera: Camera::fitted((Vec3::ZERO, Vec3::ONE), 1.0),
            picked: None,
            facade: None,
            hovered: None,
            gizmo: None,
            ways: Vec::new(),
            log: Log::default(),
            actions: Vec::new(),
            kept,
            shows_help: false,
            outdoors: crate::outdoors::OutdoorState::default(),
        }
    }

    /// Whether the results are of an older request than the one that stands.
    pub fn is_stale(&self) -> bool {
        let faces = self.results.outdoors.faces.as_ref().filter(|_| self.layers.mesh_colour == MeshColour::Exposure);
        let shows_old_parts = faces.is_some_and(|faces| faces.scenery.edits != self.request.edits.parts);
        shows_old_parts || self.answered.as_ref().is_some_and(|answered| *answered != self.request)
    }

    /// Whether a run is under way.
    pub fn is_busy(&self) -> bool {
        self.running != Running::Idle
    }

    /// Changes the request; changes of one `gesture` (an egui id's value, say) are one step to undo.
    pub fn change(&mut self, gesture: u64, change: impl FnOnce(&mut Request)) {
        let before = self.request.clone();
        change(&mut self.request);
        if self.request != before {
            self.history.keep(&before, gesture);
        }
    }

    /// The scale of a measure; fitted to its values when it is asked for the first time.
    pub fn scale(&mut self, measure: Measure) -> Scale {
        if let Some(scale) = self.scales.get(&measure) {
            return *scale;
        }
        let map = self.map(measure);
        let values = measure.values(&self.results);
        let scale = measure.fitted(&values, map);
        if values.iter().any(|value| value.is_finite()) {
            self.scales.insert(measure, scale);
        }
        scale
    }

    /// Fits the scale of a measure to its values.
    pub fn refit(&mut self, measure: Measure) {
        self.scales.remove(&measure);
        self.scale(measure);
    }

    /// The colour map of a measure.
    pub fn map(&self, measure: Measure) -> ColourMap {
        self.kept.maps.get(&measure).copied().unwrap_or_else(|| measure.map())
    }

    /// Picks something, or nothing, and finds its ways to the lights; no face of the mesh stays picked.
    pub fn pick(&mut self, picked: Option<Picked>) {
        self.facade = None;
        self.picked = picked;
        self.ways = picked.map_or_else(Vec::new, |picked| crate::ways::to_lights(&self.results, picked));
    }

    /// Asks the app to do something.
    pub fn ask(&mut self, action: Action) {
        self.actions.push(action);
    }
}
