//! The light of sun and sky on the scene: on or off, and how shadows are found.

use crate::layers::{Layers, Shadow};
use crate::panels::layers::layer;
use crate::panels::{choice, row};
use crate::shadows::{MOST_LAYERS, Method};
use egui::{Slider, Ui};

/// Shows the switch, and the method while it is on.
pub fn show(ui: &mut Ui, layers: &mut Layers) {
    let mut is_on = layers.shadows;
    let says = "The sky behind the scene, and the mesh in the light of sun and sky at the shown moment";
    layer(ui, &mut is_on, "Sunlight and shadows", says, |ui| method(ui, &mut layers.shadow));
    if is_on != layers.shadows {
        layers.light_by_sun(is_on);
    }
}

/// The method, and what it leaves to choose.
fn method(ui: &mut Ui, shadow: &mut Shadow) {
    row(ui, "Shadow method", |ui| {
        let mut method = shadow.method;
        if choice(ui, &mut method, &Method::ALL, Method::title) {
            *shadow = Shadow { resolution: shadow.resolution, ..Shadow::by(method) };
        }
    });
    row(ui, "Map size", |ui| {
        choice(ui, &mut shadow.resolution, &Shadow::RESOLUTIONS, |texels| match texels {
            256 => "256",
            512 => "512",
            1024 => "1024",
            _ => "2048",
        })
    });
    if shadow.method.is_layered() {
        row(ui, "Shadow layers", |ui| ui.add(Slider::new(&mut shadow.layers, 1..=MOST_LAYERS)));
    }
}
