//! How a scene is met: which layers are on, and what is asked of it without being told.

use crate::layers::{MeshColour, Slice, VoxelShow};
use crate::outdoors::OutdoorRequest;
use crate::sides::Inside;
use crate::state::State;
use crate::worker::stand_m;

/// Share of a storey's height that is left of its walls when the ceiling is cut away.
const CUT_SHARE: f32 = 0.93;

/// A scene was loaded. In the open and without a lamp nothing flows: sun and sky are what there is to see.
pub fn scene(state: &mut State) {
    let Some(scene) = &state.results.loaded else { return };
    let is_outdoors = scene.site.is_some();
    let is_dark = scene.lights.is_empty() && !scene.materials.iter().any(lightvein::scene::Material::emits);
    let only_sky = is_outdoors && is_dark;
    state.layers.sun_path = is_outdoors;
    state.layers.per_pixel = false;
    state.layers.shadows = is_outdoors && !is_dark;
    state.layers.mesh_colour = if only_sky { MeshColour::Exposure } else { MeshColour::Material };
    for layer in [&mut state.layers.nodes, &mut state.layers.edges, &mut state.layers.arrows] {
        *layer = !only_sky;
    }
    state.layers.cut = false;
    state.layers.section = None;
    if is_outdoors && state.request.outdoors.is_none() {
        state.request.outdoors = Some(OutdoorRequest::default());
    }
    follow_layers(state);
}

/// A scene was modelled: one that is lived in from inside begins cut below its ceiling.
pub fn model(state: &mut State) {
    let (Some(scene), Some(model)) = (&state.results.scene, &state.results.model) else { return };
    let is_indoors = Inside::of(&model.voxels, stand_m(scene)).is_indoors();
    state.layers.cut = is_indoors;
    state.layers.cut_share = CUT_SHARE;
    state.layers.cull_near_walls = is_indoors;
}

/// Asks for what the layers show, and for no more; that is no step to undo.
pub fn follow_layers(state: &mut State) {
    // Distances have their least value all around: only a slice shows them.
    if state.layers.voxel_show == VoxelShow::Distance {
        state.layers.voxel_slice.get_or_insert(Slice { axis: 2, share: 0.5 });
    }
    let Some(scene) = &state.results.loaded else { return };
    let layers = &state.layers;
    let is_lit = !scene.lights.is_empty()
        || state.request.edits.lights.as_ref().is_some_and(|lights| !lights.is_empty())
        || scene.materials.iter().any(lightvein::scene::Material::emits);
    let shows_model = layers.nodes || layers.edges || layers.voxels || layers.cells || layers.necks;
    let irradiance = layers.mesh && layers.mesh_colour == MeshColour::Irradiance;
    let wants = &mut state.request.wants;
    wants.model = is_lit || scene.site.is_none() || shows_model || irradiance;
    wants.faces = irradiance;
    if let Some(outdoors) = &mut state.request.outdoors {
        outdoors.on_faces = layers.mesh_colour == MeshColour::Exposure;
    }
}
