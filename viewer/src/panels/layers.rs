//! Which layers are on, and how each looks.

use super::{choice, decimals, outdoors, row, rows, scrolled, section};
use crate::layers::{Layers, MeshColour, MeshStyle, NodeColour, Section, Slice, VoxelShow};
use crate::outdoors::QUANTITIES;
use crate::state::State;
use egui::{Slider, Ui};
use lightvein::daylight::Quantity;

/// Shows a switch for each layer, with its options while it is on.
pub fn show(ui: &mut Ui, state: &mut State) {
    let layers = &mut state.layers;
    scrolled(ui, "layers", |ui| {
        section(ui, "Mesh and cuts", true, |ui| {
            mesh(ui, layers);
            cuts(ui, layers);
        });
        section(ui, "Skeleton", true, |ui| skeleton(ui, layers));
        section(ui, "Lights and sensors", true, |ui| lights(ui, layers));
        section(ui, "Voxels", true, |ui| voxels(ui, layers));
        section(ui, "Sun and sky", true, |ui| sky(ui, layers));
    });
}

/// A switch, and its options in rows below while it is on.
pub(super) fn layer(ui: &mut Ui, on: &mut bool, name: &str, says: &str, options: impl FnOnce(&mut Ui)) {
    ui.checkbox(on, name).on_hover_text(says);
    if *on {
        indented(ui, |ui| rows(ui, name, options));
    }
}

fn indented(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let margin = egui::Margin { left: 18, right: 0, top: 0, bottom: 2 };
    egui::Frame::new().inner_margin(margin).show(ui, contents);
}

fn mesh(ui: &mut Ui, layers: &mut Layers) {
    let (style, colour) = (&mut layers.mesh_style, &mut layers.mesh_colour);
    let (quantity, per_pixel) = (&mut layers.quantity, &mut layers.per_pixel);
    layer(ui, &mut layers.mesh, "Mesh", "The scene's surfaces", |ui| {
        row(ui, "Mesh style", |ui| {
            let all = [MeshStyle::Shaded, MeshStyle::Wireframe, MeshStyle::Transparent];
            choice(ui, style, &all, |style| match style {
                MeshStyle::Shaded => "Shaded",
                MeshStyle::Wireframe => "Wireframe",
                MeshStyle::Transparent => "Transparent",
            })
        });
        row(ui, "Mesh colour", |ui| {
            let all = [MeshColour::Material, MeshColour::Irradiance, MeshColour::Exposure];
            choice(ui, colour, &all, |colour| match colour {
                MeshColour::Material => "Reflectance",
                MeshColour::Irradiance => "Irradiance",
                MeshColour::Exposure => "Sun and sky",
            })
        });
        if *colour == MeshColour::Exposure || *per_pixel {
            row(ui, "Quantity", |ui| choice(ui, quantity, &QUANTITIES, Quantity::title));
        }
    });
    ui.checkbox(&mut layers.cull_near_walls, "Hide near walls")
        .on_hover_text("Draw a wall only where the void in front of it faces the viewer, so that rooms are seen into");
}

fn cuts(ui: &mut Ui, layers: &mut Layers) {
    let share = &mut layers.cut_share;
    layer(ui, &mut layers.cut, "Cut below the ceiling", "Hide mesh and voxels above a height", |ui| {
        row(ui, "Cut height", |ui| ui.add(percent(share)).on_hover_text("Share of the scene's height"));
    });

    let mut is_on = layers.section.is_some();
    let mut section = layers.section.unwrap_or_default();
    layer(ui, &mut is_on, "Section plane", "Hide mesh and voxels on one side of a plane", |ui| {
        let Section { azimuth_deg, elevation_deg, share } = &mut section;
        row(ui, "Plane azimuth", |ui| {
            ui.add(Slider::new(azimuth_deg, -180.0..=180.0).suffix("°").custom_formatter(decimals(0)))
        });
        row(ui, "Plane elevation", |ui| {
            ui.add(Slider::new(elevation_deg, -90.0..=90.0).suffix("°").custom_formatter(decimals(0)))
        });
        row(ui, "Plane position", |ui| ui.add(percent(share)));
    });
    layers.section = is_on.then_some(section);
}

/// A slider for a share, shown in percent.
fn percent(share: &mut f32) -> Slider<'_> {
    let get_set = |value: Option<f64>| {
        if let Some(value) = value {
            *share = (value / 100.0) as f32;
        }
        f64::from(*share) * 100.0
    };
    Slider::from_get_set(0.0..=100.0, get_set).suffix(" %").custom_formatter(decimals(0))
}

fn skeleton(ui: &mut Ui, layers: &mut Layers) {
    let colour = &mut layers.node_colour;
    layer(ui, &mut layers.nodes, "Nodes", "Points of the skeleton, larger where the void is wider", |ui| {
        row(ui, "Node colour", |ui| choice(ui, colour, &NodeColour::ALL, NodeColour::name));
    });
    ui.checkbox(&mut layers.edges, "Edges").on_hover_text("Veins of light: wider where more flux passes");
    ui.checkbox(&mut layers.arrows, "Arrows").on_hover_text("Which way the flux goes");
    ui.checkbox(&mut layers.cells, "Cells").on_hover_text("Rooms: the void between necks");
    ui.checkbox(&mut layers.necks, "Necks").on_hover_text("Doorways and windows between cells");
}

fn lights(ui: &mut Ui, layers: &mut Layers) {
    ui.checkbox(&mut layers.lights, "Lights");
    ui.checkbox(&mut layers.sensors, "Sensors").on_hover_text("Where light is asked for");
    if layers.sensors {
        indented(ui, |ui| {
            ui.checkbox(&mut layers.sensor_values, "Values beside sensors");
            ui.checkbox(&mut layers.sensor_ratios, "Colour by estimate / reference");
        });
    }
    ui.checkbox(&mut layers.ball, "Ball of the picked node").on_hover_text("The largest ball in the void around it");
    ui.checkbox(&mut layers.paths, "Paths to the lights")
        .on_hover_text("From what is picked: forward solid, backward dashed, with the farthest visible node");
}

fn voxels(ui: &mut Ui, layers: &mut Layers) {
    let (which, slice) = (&mut layers.voxel_show, &mut layers.voxel_slice);
    layer(ui, &mut layers.voxels, "Voxels", "Matter and void as the skeleton sees them", |ui| {
        row(ui, "Which voxels", |ui| {
            let all = [VoxelShow::Solid, VoxelShow::Void, VoxelShow::Distance];
            choice(ui, which, &all, |which| match which {
                VoxelShow::Solid => "Solid",
                VoxelShow::Void => "Void",
                VoxelShow::Distance => "Distance to matter",
            })
        });
        let mut axis = slice.map(|slice| slice.axis);
        row(ui, "Slice across", |ui| {
            choice(ui, &mut axis, &[None, Some(0), Some(1), Some(2)], |axis| match axis {
                None => "All of them",
                Some(0) => "x",
                Some(1) => "y",
                Some(_) => "z",
            })
        });
        let mut share = slice.map_or(0.5, |slice| slice.share);
        if axis.is_some() {
            row(ui, "Slice position", |ui| ui.add(percent(&mut share)));
        }
        *slice = axis.map(|axis| Slice { axis, share });
    });
}

fn sky(ui: &mut Ui, layers: &mut Layers) {
    ui.checkbox(&mut layers.sun_path, "Sun path").on_hover_text("The sky dome with the sun's way over it");
    outdoors::light::show(ui, layers);
    ui.checkbox(&mut layers.per_pixel, "Exposure per pixel")
        .on_hover_text("Sun and sky for each pixel of the view instead of on the faces");
}
