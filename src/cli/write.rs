//! The files of a run: each whole or not at all, in a folder that is made if it is not there.

use super::stages::Stages;
use super::tell;
use crate::export::analysed::files;
use crate::export::{self, whole_file};
use crate::flow::Estimator;
use crate::job::{Cancel, Progress};
use crate::light::{Field, Settings};
use crate::model::{Model, Probe};
use crate::scene::Scene;
use anyhow::{Context, Result, bail};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A folder that files are written into; made with its first file, so that a run that fails before leaves nothing.
pub struct Folder<'a> {
    path: &'a Path,
    written: Vec<PathBuf>,
}

impl<'a> Folder<'a> {
    /// The folder at `path`. What must stop a run before hours of work shows here: a file where a folder is to be.
    ///
    /// # Errors
    /// Names the file that is in the way.
    pub fn new(path: &'a Path) -> Result<Self> {
        if let Some(there) = path.ancestors().find(|part| part.exists() && !part.is_dir()) {
            bail!("{}: the folder cannot be made: {} is not a folder", path.display(), there.display());
        }
        Ok(Self { path, written: Vec::new() })
    }

    /// Writes one file.
    ///
    /// # Errors
    /// Names the file and what the file system says.
    pub fn file(&mut self, name: &str, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
        std::fs::create_dir_all(self.path)
            .with_context(|| format!("{}: the folder cannot be made", self.path.display()))?;
        let path = self.path.join(name);
        whole_file(&path, write).with_context(|| format!("{}: cannot be written", path.display()))?;
        self.written.push(path);
        Ok(())
    }

    /// Lists on stderr what was written, a line a file.
    pub fn list(&self) {
        self.written.iter().for_each(|path| tell(format_args!("wrote {}", path.display())));
    }
}

/// What was analysed, and how to ask for more of it.
pub struct Analysed<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What was modelled of it.
    pub model: &'a Model,
    /// The field at its sensors.
    pub at_sensors: &'a Field,
    /// What gives the field elsewhere; `None` for the path tracer, which answers at sensors alone.
    pub estimate: Option<&'a Estimator<'a>>,
    /// The settings of the estimate.
    pub settings: &'a Settings,
}

/// What `analyse -o` writes, besides its report: voxels, the skeleton with the irradiance at its nodes, and the field at the
/// sensors and on the mesh.
///
/// # Errors
/// A file that cannot be written, or an interrupt.
pub fn analysis(folder: &mut Folder, analysed: &Analysed, stages: &Stages, cancel: &Cancel) -> Result<()> {
    stages.begin("files", 0);
    let Analysed { scene, model, at_sensors, estimate, settings } = *analysed;
    let ask = |probes: &[Probe]| estimate.map(|estimate| estimate(model, probes, settings, stages, cancel)).transpose();
    let at_nodes = ask(&model.probes_at_nodes())?;
    let faces_m = model.faces_to_void(scene);
    let at_faces = ask(&model.probes_at_faces(&faces_m))?;

    let at_faces = at_faces.as_ref().map(|field| (&faces_m[..], field));
    let files = files(&export::analysed::Analysed { scene, model, at_sensors, at_nodes: at_nodes.as_ref(), at_faces });
    for (name, write) in files {
        folder.file(name, write)?;
    }
    stages.end();
    Ok(())
}
