//! Maps kept between runs, in a folder that the user names: a folder each, called by a hash of all that the map is made of.

use crate::cli::tell;
use crate::export::exposure::{Part, write_npy};
use crate::export::whole_file;
use crate::sky::map::{Check, ExposureMap, MapSettings};
use crate::sky::steps::{Step, Steps};
use anyhow::{Context, Result, ensure};
use ndarray::Array2;
use ndarray_npy::ReadNpyExt;
use std::fs::File;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// The file of each part.
const PARTS: [(Part, &str); 2] = [(Part::Diffuse, "diffuse.npy"), (Part::Direct, "direct.npy")];

/// What the comparison with the full sum found.
const CHECK: &str = "check.json";

/// The map that was kept for this question, if there is one and it is whole. One that is there and broken is named on stderr
/// and made anew.
pub fn kept(folder: &Path, steps: &Steps, settings: &MapSettings) -> Option<ExposureMap> {
    let folder = place(folder, steps, settings);
    if !folder.join(CHECK).exists() {
        return None;
    }
    match read(&folder, steps, settings) {
        Ok(map) => Some(map),
        Err(error) => {
            tell(format_args!("warning: {}: not the map that was kept, made anew: {error:#}", folder.display()));
            None
        }
    }
}

fn read(folder: &Path, steps: &Steps, settings: &MapSettings) -> Result<ExposureMap> {
    let part = |(_, name): (Part, &str)| -> Result<Vec<f32>> {
        let energies = Array2::<f32>::read_npy(File::open(folder.join(name))?).with_context(|| name.to_owned())?;
        let [columns, rows] = settings.size;
        ensure!(energies.dim() == (rows, columns), "{name}: {:?} and not {rows} x {columns}", energies.dim());
        ensure!(energies.iter().all(|energy| energy.is_finite() && *energy >= 0.0), "{name}: energies below 0 or none");
        Ok(energies.into_iter().collect())
    };
    let check: Check = serde_json::from_reader(File::open(folder.join(CHECK))?).context(CHECK)?;
    let [diffuse, direct] = PARTS.map(part);
    Ok(ExposureMap::of_parts(steps, settings.size, diffuse?, direct?, check))
}

/// Keeps a map.
///
/// # Errors
/// Names the file that cannot be written.
pub fn keep(folder: &Path, steps: &Steps, settings: &MapSettings, map: &ExposureMap) -> Result<()> {
    let folder = place(folder, steps, settings);
    std::fs::create_dir_all(&folder).with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    let written = |path: &Path| format!("{}: cannot be written", path.display());
    for (part, name) in PARTS {
        let path = folder.join(name);
        whole_file(&path, |out| write_npy(out, map, part)).with_context(|| written(&path))?;
    }
    // Last, so that the others are whole where it is there.
    let path = folder.join(CHECK);
    whole_file(&path, |out| Ok(serde_json::to_writer(out, &map.check)?)).with_context(|| written(&path))
}

/// The folder of one question: every number that goes into its map, and the version of the program that makes it.
fn place(folder: &Path, steps: &Steps, settings: &MapSettings) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    env!("CARGO_PKG_VERSION").hash(&mut hasher);
    (settings.size, settings.model, settings.haze.band, settings.tolerance.map(f64::to_bits)).hash(&mut hasher);
    let mut number = |value: f64| value.to_bits().hash(&mut hasher);
    number(settings.haze.turbidity);
    number(settings.haze.ground_albedo);
    for step in &steps.steps {
        let Step { hours, sun, dni_w_m2, dhi_w_m2, eccentricity, .. } = *step;
        for value in [hours, sun.azimuth_rad, sun.elevation_rad, dni_w_m2, dhi_w_m2, eccentricity] {
            number(value);
        }
    }
    folder.join(format!("exposure-{:016x}", hasher.finish()))
}
