//! What panels, menus and keys asked for: files through the desktop's dialogs, steps, pictures, exports.

use super::App;
use crate::log::Level;
use crate::panels;
use crate::request::Source;
use crate::state::Action;
use crate::view;
use crate::worker::Task;
use anyhow::Context;
use image::RgbaImage;
use lightvein::export::whole_file;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// A dialog that is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialog {
    /// Which scene is opened.
    Open,
    /// Which weather is read.
    Weather,
    /// Where the picture goes.
    Picture,
    /// Where the table goes.
    Table,
    /// Which folder the files go into.
    Export,
}

/// A picture that was asked for: where it goes, and the pixels once they are there.
#[derive(Default, Clone)]
pub struct Shot(Arc<Mutex<Option<(PathBuf, RgbaImage)>>>);

/// Endings of files that hold a scene.
const SCENES: [&str; 6] = ["toml", "obj", "gltf", "glb", "ply", "stl"];

impl App {
    /// Does what was asked for since the last frame.
    pub(super) fn act(&mut self, ctx: &egui::Context) {
        for action in std::mem::take(&mut self.state.actions) {
            match action {
                Action::OpenDialog => self.ask_for(Dialog::Open, ctx),
                Action::ChooseWeather => self.ask_for(Dialog::Weather, ctx),
                Action::SavePicture => self.ask_for(Dialog::Picture, ctx),
                Action::SaveTable => self.ask_for(Dialog::Table, ctx),
                Action::Export => self.ask_for(Dialog::Export, ctx),
                Action::Open(path) => self.open(Source::File(path)),
                Action::Reload => {
                    if let Some(worker) = &self.worker {
                        worker.forget();
                    }
                    self.asked = None;
                }
                Action::Cancel => {
                    if let Some(worker) = &self.worker {
                        worker.cancel();
                    }
                }
                Action::Undo => {
                    if let Some(before) = self.state.history.undo(&self.state.request) {
                        self.state.request = before;
                    }
                }
                Action::Redo => {
                    if let Some(after) = self.state.history.redo(&self.state.request) {
                        self.state.request = after;
                    }
                }
                Action::Measure => {
                    if let Some(worker) = &self.worker {
                        worker.ask(Task::Measure(Box::new(self.state.results.clone()), self.state.request.how.seed));
                    }
                }
                Action::Fit => view::fit(&mut self.state, self.view.size_px),
                Action::Focus => view::focus_on_picked(&mut self.state, self.view.size_px),
                Action::Refit(measure) => self.state.refit(measure),
                Action::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            }
        }
        self.answered(ctx);
        self.write_picture();
    }

    /// Opens one of the desktop's dialogs on a thread of its own: the window goes on.
    fn ask_for(&mut self, what: Dialog, ctx: &egui::Context) {
        if self.dialog.is_some() {
            return;
        }
        let (send, chosen) = channel();
        let ctx = ctx.clone();
        let name = self.state.results.scene.as_ref().map_or_else(|| "scene".to_owned(), |scene| scene.name.clone());
        let open = move || {
            let dialog = rfd::FileDialog::new();
            let path = match what {
                Dialog::Open => dialog.add_filter("Scenes and meshes", &SCENES).pick_file(),
                Dialog::Weather => dialog.add_filter("Weather", &["epw"]).pick_file(),
                Dialog::Picture => dialog.set_file_name(format!("{name}.png")).add_filter("PNG", &["png"]).save_file(),
                Dialog::Table => {
                    dialog.set_file_name(format!("{name}_sensors.csv")).add_filter("CSV", &["csv"]).save_file()
                }
                Dialog::Export => dialog.pick_folder(),
            };
            // The window may be gone by then.
            let _ = send.send(path);
            ctx.request_repaint();
        };
        match std::thread::Builder::new().name("dialog".to_owned()).spawn(open) {
            Ok(_) => self.dialog = Some((what, chosen)),
            Err(error) => self.state.log.tell(Level::Error, "", format!("no dialog can be opened: {error}")),
        }
    }

    /// Goes on with what a dialog was opened for.
    fn answered(&mut self, ctx: &egui::Context) {
        let Some((what, chosen)) = &self.dialog else { return };
        let (what, chosen) = (*what, chosen.try_recv());
        match chosen {
            Err(TryRecvError::Empty) => return,
            // None is no choice or no portal: which of both the desktop does not tell.
            Ok(None) | Err(TryRecvError::Disconnected) => {
                let text = "no file was chosen; where no dialog opened, drop the file on the window or name it on the command line";
                self.state.log.tell(Level::Note, "", text);
            }
            Ok(Some(path)) => self.chosen(what, path, ctx),
        }
        self.dialog = None;
    }

    /// A file was chosen.
    pub fn chosen(&mut self, what: Dialog, path: PathBuf, ctx: &egui::Context) {
        match what {
            Dialog::Open => self.open(Source::File(path)),
            Dialog::Weather => panels::outdoors::with_weather(&mut self.state, path),
            Dialog::Picture => self.take_picture(path, ctx),
            Dialog::Table => {
                let csv = panels::sensors::csv(&self.state);
                let written = whole_file(&path, |out| out.write_all(csv.as_bytes()));
                self.tell_written(&path, written.map_err(Into::into));
            }
            Dialog::Export => {
                if let Some(worker) = &self.worker {
                    worker.ask(Task::Export(path, Box::new(self.state.results.clone())));
                }
            }
        }
    }

    /// Asks for the pixels of the window as it is; they come with one of the next frames.
    fn take_picture(&self, path: PathBuf, ctx: &egui::Context) {
        let shot = self.shot.clone();
        let wake = ctx.clone();
        ctx.request_screenshot(move |image| {
            let size = image.size.map(|along| along as u32);
            let pixels = image.pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
            if let Some(image) = RgbaImage::from_raw(size[0], size[1], pixels) {
                *shot.0.lock().unwrap_or_else(PoisonError::into_inner) = Some((path, image));
                wake.request_repaint();
            }
        });
    }

    /// Writes the picture that was taken.
    fn write_picture(&mut self) {
        let taken = self.shot.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some((path, image)) = taken {
            let written = write_png(&path, &image);
            self.tell_written(&path, written);
        }
    }

    fn tell_written(&mut self, path: &Path, written: anyhow::Result<()>) {
        match written {
            Ok(()) => self.state.log.tell(Level::Note, "", format!("wrote {}", path.display())),
            Err(error) => self.state.log.tell(Level::Error, path.display().to_string(), format!("{error:#}")),
        }
    }
}

/// Writes a picture, whole or not at all.
///
/// # Errors
/// Names the file and what the file system says.
pub fn write_png(path: &Path, image: &RgbaImage) -> anyhow::Result<()> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).context("the picture cannot be packed")?;
    whole_file(path, |out| out.write_all(bytes.get_ref()))
        .with_context(|| format!("{}: cannot be written", path.display()))
}
