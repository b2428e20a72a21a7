//! The program in its window: asks the worker when the request has changed, takes what it tells, and shows menus, panes and view.

mod actions;
mod greet;
mod menu;
mod status;
mod tiles;
mod toasts;

pub use actions::{Dialog, write_png};

use crate::args::Args;
use crate::camera::Camera;
use crate::controls::{self, Command};
use crate::layers::Layers;
use crate::log::Level;
use crate::measure::Measure;
use crate::outdoors::shown as outdoors;
use crate::panels::{self, Pane};
use crate::request::{Request, Source};
use crate::results::{Failed, Results};
use crate::state::{Action, Kept, State};
use crate::theme;
use crate::view::{self, View};
use crate::worker::{Task, Told, Worker};
use egui::Ui;
use egui_tiles::Tree;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Duration;
use toasts::Toasts;

/// While a run is under way its progress is looked at this often.
const LOOK_EVERY: Duration = Duration::from_millis(100);

/// What is kept in the storage, by its key.
const KEPT: &str = "kept";
const LAYERS: &str = "layers";
const TREE: &str = "panes";

/// How the window begins.
#[derive(Debug, Clone, Default)]
pub struct Start {
    /// The scene; `None` for the one that greets.
    pub scene: Option<PathBuf>,
    /// What was kept from the last time.
    pub kept: Kept,
    /// The layers of the last time.
    pub layers: Layers,
    /// The panes of the last time.
    pub tree: Option<Tree<Pane>>,
}

/// The program.
pub struct App {
    /// All that is shown.
    pub state: State,
    /// The pane with the picture.
    pub view: View,
    worker: Option<Worker>,
    asked: Option<Request>,
    tree: Tree<Pane>,
    toasts: Toasts,
    dialog: Option<(actions::Dialog, Receiver<Option<PathBuf>>)>,
    shot: actions::Shot,
    /// The camera as the scene was fitted, and whether with the sky's dome.
    fitted: Option<(Camera, bool)>,
    is_framed: bool,
    typed: Option<Args>,
}

impl App {
    /// The program as it starts. `ctx` is woken when there is something new to show.
    pub fn new(ctx: &egui::Context, start: Start) -> Self {
        let wake: crate::draw::Wake = {
            let ctx = ctx.clone();
            Arc::new(move || ctx.request_repaint())
        };
        let mut state = State::new(start.kept, start.layers);
        let worker = {
            let wake = Arc::clone(&wake);
            Worker::start(move || wake())
        };
        let worker = match worker {
            Ok(worker) => Some(worker),
            Err(error) => {
                state.log.tell(Level::Error, "", format!("the system gives no thread to compute on: {error}"));
                None
            }
        };
        let source = start.scene.map_or(Source::Welcome, Source::File);
        let mut app = Self {
            state,
            view: View::new(wake),
            worker,
            asked: None,
            tree: start.tree.filter(tiles::is_whole).unwrap_or_else(tiles::first),
            toasts: Toasts::default(),
            dialog: None,
            shot: actions::Shot::default(),
            fitted: None,
            is_framed: false,
            typed: None,
        };
        app.open(source);
        app
    }

    /// The program in its window, with what eframe kept of the last time; makes its renderer ready for pictures. What was typed
    /// about layers, camera and method holds once the scene is there.
    pub fn of_window(cc: &eframe::CreationContext, args: Args) -> Self {
        if let Some(state) = &cc.wgpu_render_state {
            crate::paint::install(state);
        }
        let kept = |key: &str| cc.storage.and_then(|storage| storage.get_string(key)).unwrap_or_default();
        let typed = crate::shot::start(&args);
        let mut start = Start {
            kept: serde_json::from_str(&kept(KEPT)).unwrap_or_default(),
            layers: serde_json::from_str(&kept(LAYERS)).unwrap_or_default(),
            tree: serde_json::from_str(&kept(TREE)).ok(),
            ..typed
        };
        start.kept.dark = typed.kept.dark.or(start.kept.dark);
        let mut app = Self::new(&cc.egui_ctx, start);
        app.typed = Some(args);
        app
    }

    /// Opens a scene: all that was asked and found of the one before stays until the new one is there.
    pub fn open(&mut self, source: Source) {
        if let Source::File(path) = &source {
            let path = std::path::absolute(path).unwrap_or_else(|_| path.clone());
            self.state.kept.recent.retain(|known| *known != path);
            self.state.kept.recent.insert(0, path);
            self.state.kept.recent.truncate(MOST_RECENT);
        }
        self.state.request = Request::of(source);
        self.state.history.clear();
        self.fitted = None;
    }

    /// Whether all that was asked has been answered and drawn: what pictures without a user wait for.
    pub fn is_settled(&self) -> bool {
        let is_idle = self.worker.as_ref().is_none_or(|worker| worker.running() == crate::state::Running::Idle);
        is_idle && self.asked.as_ref() == Some(&self.state.request) && !self.state.is_busy() && !self.view.is_busy()
    }

    /// One frame.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        theme::apply(&ctx, &self.state.kept);
        self.hear(&ctx);
        outdoors::tick(&mut self.state, &ctx);
        greet::follow_layers(&mut self.state);
        self.keys(&ctx);
        self.dropped(&ctx);

        egui::Panel::top("menu").show(ui, |ui| menu::show(ui, &mut self.state, &mut self.tree));
        egui::Panel::bottom("status").show(ui, |ui| status::show(ui, &mut self.state));
        let frame = egui::Frame::new().fill(ui.visuals().panel_fill);
        egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            let mut panes = tiles::Panes { state: &mut self.state, view: &mut self.view };
            self.tree.ui(&mut panes, ui);
        });
        panels::help::show(&ctx, &mut self.state);

        self.act(&ctx);
        self.ask();
        self.toasts.show(&ctx, &mut self.state.log);
    }

    /// Only the view, for pictures.
    pub fn show_view(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        theme::apply(&ctx, &self.state.kept);
        self.hear(&ctx);
        outdoors::tick(&mut self.state, &ctx);
        greet::follow_layers(&mut self.state);
        self.view.show(ui, &mut self.state);
        self.ask();
    }

    /// Takes what the worker has told.
    fn hear(&mut self, ctx: &egui::Context) {
        let Some(worker) = &self.worker else { return };
        self.state.running = worker.running();
        if self.state.is_busy() {
            ctx.request_repaint_after(LOOK_EVERY);
        }
        for told in worker.told() {
            match told {
                Told::Found(request, results) => self.found(*request, *results),
                Told::Answered(request) => {
                    self.state.answered = Some(*request);
                }
                Told::Measured(of, rungs) => {
                    let is_of_now = match (&of.model, &self.state.results.model) {
                        (Some(of), Some(now)) => Arc::ptr_eq(of, now),
                        _ => false,
                    };
                    if is_of_now {
                        self.state.results.rungs = Arc::new(rungs);
                    }
                }
                Told::Written(folder, files) => {
                    self.state.log.tell(Level::Note, "", format!("{files} files written into {}", folder.display()));
                }
                Told::Failed { about, why: Failed::Because(error), of_request } => {
                    self.state.log.tell(Level::Error, about, format!("{error:#}"));
                    // What is shown goes on being that of the last request that could be answered.
                    let is_current = self.asked.as_ref() == Some(&self.state.request);
                    if of_request && is_current && self.state.answered.is_none() {
                        self.state.answered = Some(Request::default());
                    }
                }
                Told::Failed { why: Failed::Cancelled, about, .. } => {
                    self.state.log.tell(Level::Note, about, "stopped");
                }
            }
        }
        // The size of the view is known with its first frame. The sky's dome comes later than the scene: who has not moved the
        // camera by then sees it whole.
        let has_dome = outdoors::dome_bounds_m(&self.state).is_some();
        let waits = match self.fitted {
            None => self.state.results.scene.is_some() && self.is_framed,
            Some((camera, had_dome)) => has_dome && !had_dome && camera == self.state.camera,
        };
        if waits {
            view::fit(&mut self.state, self.view.size_px);
            self.fitted = Some((self.state.camera, has_dome));
        }
        self.is_framed = true;
        // Nodes and sensors can be picked once there is an estimate of them.
        let has_answered = self.state.answered.as_ref() == Some(&self.state.request) && !self.state.is_busy();
        if let Some(args) = self.typed.take_if(|_| has_answered)
            && let Err(error) = crate::shot::arrange(&mut self.state, &args)
        {
            self.state.log.tell(Level::Error, "", format!("{error:#}"));
        }
    }

    /// Shows new results.
    fn found(&mut self, request: Request, results: Results) {
        let is_new_scene = match (&self.state.results.loaded, &results.loaded) {
            (Some(old), Some(new)) => !Arc::ptr_eq(old, new),
            _ => true,
        };
        let had_model = self.state.results.model.is_some() && !is_new_scene;
        let was_first_pass = self.state.results.estimate.as_ref().is_none_or(|estimate| estimate.is_first_pass);
        for warning in results.warnings.iter().filter(|warning| !self.state.results.warnings.contains(warning)) {
            self.state.log.note(Level::Warning, request.source.name(), warning.as_str());
        }
        let is_same_model = match (&self.state.results.model, &results.model) {
            (Some(old), Some(new)) => Arc::ptr_eq(old, new),
            _ => false,
        };
        let is_same_mesh = match (&self.state.results.scene, &results.scene) {
            (Some(old), Some(new)) => Arc::ptr_eq(old, new),
            _ => false,
        };
        let facade = self.state.facade.filter(|_| is_same_mesh);
        let rungs = std::mem::take(&mut self.state.results.rungs);
        self.state.results = results;
        if is_same_model {
            self.state.results.rungs = rungs;
        }
        self.state.answered = Some(request);
        if is_new_scene {
            (self.state.picked, self.state.hovered) = (None, None);
            self.state.scales.clear();
            self.fitted = None;
            greet::scene(&mut self.state);
        }
        if !had_model && self.state.results.model.is_some() {
            greet::model(&mut self.state);
        }
        let is_first_pass = self.state.results.estimate.as_ref().is_none_or(|estimate| estimate.is_first_pass);
        if was_first_pass && !is_first_pass {
            // The first pass is another method's: its range is not that of the answer.
            self.state.scales.remove(&Measure::Irradiance);
            self.state.scales.remove(&Measure::Flux);
        }
        self.keep_picked();
        self.state.facade = facade;
    }

    /// What is picked stays as long as there is such a thing; its ways are those of the new results.
    fn keep_picked(&mut self) {
        let state = &mut self.state;
        let lights = panels::scene::asked_lights(state).into_owned();
        let is_there = |picked| crate::draw::marks::position_m(&state.results, &lights, picked).is_some();
        let picked = state.picked.filter(|&picked| is_there(picked));
        state.hovered = state.hovered.filter(|&hovered| is_there(hovered));
        state.pick(picked);
    }

    /// Asks the worker when the request is another than the one asked last.
    fn ask(&mut self) {
        if self.asked.as_ref() == Some(&self.state.request) {
            return;
        }
        if let Some(worker) = &self.worker {
            worker.ask(Task::Answer(Box::new(self.state.request.clone())));
            self.state.running = worker.running();
        }
        self.asked = Some(self.state.request.clone());
    }

    /// What the keys do.
    fn keys(&mut self, ctx: &egui::Context) {
        let state = &mut self.state;
        for command in controls::pressed(ctx, state.kept.preset) {
            match command {
                Command::Fly(_) => {}
                Command::Fit => state.ask(Action::Fit),
                Command::Focus => state.ask(Action::Focus),
                Command::Look(standard) => {
                    state.camera.look_from(standard);
                    view::fit(state, self.view.size_px);
                }
                Command::Projection => state.camera.orthographic = !state.camera.orthographic,
                Command::Toggle(layer) => {
                    let is_on = *layer.switch(&mut state.layers);
                    layer.set(&mut state.layers, !is_on);
                }
                Command::Play => state.outdoors.is_playing = !state.outdoors.is_playing,
                Command::Cancel if state.shows_help => state.shows_help = false,
                Command::Cancel if state.is_busy() => state.ask(Action::Cancel),
                Command::Cancel => state.pick(None),
                Command::Help => state.shows_help = !state.shows_help,
                Command::Open => state.ask(Action::OpenDialog),
                Command::Reload => state.ask(Action::Reload),
                Command::Undo => state.ask(Action::Undo),
                Command::Redo => state.ask(Action::Redo),
                Command::SavePicture => state.ask(Action::SavePicture),
                Command::Export => state.ask(Action::Export),
                Command::Text(step) => state.kept.zoom = theme::zoomed(state.kept.zoom, step),
                Command::Quit => state.ask(Action::Quit),
            }
        }
    }

    /// Files dropped on the window.
    fn dropped(&mut self, ctx: &egui::Context) {
        let dropped = ctx.input(|input| input.raw.dropped_files.first().map(|file| file.path().to_path_buf()));
        if let Some(path) = dropped {
            self.open(Source::File(path));
        }
    }
}

/// Files that are remembered.
const MOST_RECENT: usize = 10;

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        let mut keep = |key: &str, value: Result<String, serde_json::Error>| {
            if let Ok(value) = value {
                storage.set_string(key, value);
            }
        };
        keep(KEPT, serde_json::to_string(&self.state.kept));
        keep(LAYERS, serde_json::to_string(&self.state.layers));
        keep(TREE, serde_json::to_string(&self.tree));
    }
}
