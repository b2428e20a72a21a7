//! `analyse` within a tolerance: voxels, method and quality are chosen.

use super::plan::Plan;
use super::run::{most_bytes, warnings_of};
use super::stages::Stages;
use crate::flow::{Estimator, Rung, ladder};
use crate::job::{Cancel, Progress};
use crate::light::Field;
use crate::model::Model;
use crate::model::bare::light_bare_mesh;
use crate::model::choose::choose_voxel_m;
use crate::rays::Rays;
use crate::scene::{Method, Scene};
use crate::study::tolerance::{self, Choice};
use anyhow::{Context, Result};
use std::sync::Arc;

/// The factor within which `analyse` is right where nobody says otherwise.
const DEFAULT_TOLERANCE: f64 = 1.5;

/// What `analyse` found, chosen or as asked for.
pub struct Analysed {
    /// What was modelled.
    pub model: Model,
    /// The method.
    pub method: Method,
    /// The name of its stage, with its quality.
    pub name: String,
    /// What gives the field elsewhere; `None` for the path tracer.
    pub estimate: Option<Box<Estimator<'static>>>,
    /// The field at the sensors.
    pub field: Field,
    /// What was chosen, and why; `None` where nothing was.
    pub choice: Option<Choice>,
    /// What to warn of.
    pub warnings: Vec<String>,
}

/// Chooses what the plan leaves open: the voxels, the method, or only the quality of the method that was asked for.
///
/// # Errors
/// Voxels that do not fit, or an interrupt.
pub fn analysed(scene: &mut Scene, plan: &Plan, stages: &Stages, cancel: &Cancel) -> Result<Analysed> {
    stages.begin("rays", 0);
    let rays = Arc::new(Rays::new(scene));
    stages.end();

    let max_bytes = most_bytes();
    let (model, finer, reason) = match plan.voxel_m {
        Some(voxel_m) => {
            let model = Model::build(scene, rays.clone(), voxel_m, max_bytes, stages, cancel)?;
            (model, None, format!("voxels of {voxel_m} m, as asked for"))
        }
        None => {
            let chosen = choose_voxel_m(scene, &rays, max_bytes, stages, cancel)?;
            (chosen.model, chosen.finer, chosen.reason)
        }
    };
    // A bare mesh gets its light by the cells of one model; another has other cells.
    let (model, finer) = if scene.bare { (light_bare_mesh(scene, model), None) } else { (model, finer) };

    let rungs: Vec<Rung> = match plan.method {
        Some(method) => ladder(method),
        None => Method::ALL.into_iter().flat_map(ladder).collect(),
    };
    let search = tolerance::Search {
        rungs: &rungs,
        tolerance: plan.tolerance.unwrap_or(DEFAULT_TOLERANCE),
        settings: &plan.settings,
        probes: &|model: &Model| model.probes_at_sensors(scene),
        build: &|voxel_m| Model::build(scene, rays.clone(), voxel_m, max_bytes, stages, cancel),
    };
    let chosen = search.run(model, finer, reason, stages, cancel)?.context("there is no method to choose from")?;

    let tolerance::Chosen { model, rung, field, choice } = chosen;
    let Rung { method, estimate, .. } = rungs.into_iter().nth(rung).context("the chosen method is not there")?;
    let mut warnings = warnings_of(scene, &model);
    warnings.extend(field.warnings.iter().cloned());
    if !choice.is_inside() {
        warnings.push(format!("no method here is expected to be right within a factor of {}", choice.tolerance));
    }
    let name = choice.method.clone();
    Ok(Analysed { model, method, name, estimate: Some(estimate), field, choice: Some(choice), warnings })
}
