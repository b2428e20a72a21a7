//! The line at the foot: what was modelled, how it was estimated, and what is under the pointer.

use crate::panels::number;
use crate::state::State;
use crate::view::words;
use egui::Ui;

/// Shows the line.
pub fn show(ui: &mut Ui, state: &mut State) {
    ui.horizontal(|ui| {
        let results = &state.results;
        if let Some(scene) = &results.scene {
            ui.label(format!("{}: {} triangles", scene.name, scene.mesh.triangles.len()));
        }
        if let Some(model) = &results.model {
            let (nodes, edges) = (model.skeleton.graph.node_count(), model.skeleton.graph.edge_count());
            let cells = model.skeleton.cells.len();
            let voxel_m = number(f64::from(model.voxels.lattice.voxel_m));
            ui.separator();
            ui.label(format!("voxels {voxel_m} m, {nodes} nodes, {edges} edges, {cells} cells"));
        }
        if let Some(estimate) = &results.estimate {
            ui.separator();
            let label = format!("{} {}", estimate.method, estimate.quality);
            ui.label(format!("{} in {:.0} ms", label.trim_end(), 1e3 * estimate.seconds));
            if let Some(rms) = estimate.errors.rms_factor {
                ui.separator();
                ui.label(format!("rms factor {}", number(rms)));
            }
        }
        if let Some(words) = state.hovered.and_then(|hovered| words(state, hovered)) {
            ui.separator();
            ui.strong(words.replace('\n', ", "));
        }
    });
}
