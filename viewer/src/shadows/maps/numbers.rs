//! What the shaders are told, as they read it.

use super::super::View;
use super::super::plan::{Layer, Plan};
use super::super::settings::{Filter, MOST_LAYERS, Overlap, Settings};
use super::place;
use bytemuck::{Pod, Zeroable};
use glam::Mat4;

/// Bytes from one layer's numbers to the next: what every device aligns to.
pub(super) const STRIDE: u32 = 256;

/// Texels that a blur reaches to each side.
const BLUR_REACH: i32 = 2;

/// `Shadows` of lookup.wgsl.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct ShadowNumbers {
    towards: [f32; 4],
    mode: [u32; 4],
    layers: [LayerNumbers; MOST_LAYERS],
}

/// `ShadowLayer` of lookup.wgsl.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct LayerNumbers {
    clip_from_scene: [[f32; 4]; 4],
    bounds_m: [f32; 4],
    making: [f32; 4],
    place: [u32; 4],
}

impl ShadowNumbers {
    pub(super) fn new(plan: &Plan, view: &View, settings: &Settings) -> Self {
        let mut numbers = Self::zeroed();
        let shared_m = plan.layers.first().map_or(0.0, |layer| layer.map.length_m);
        let by_light_m = if settings.split.has_map_each() { 0.0 } else { shared_m };
        let blends = u32::from(settings.overlap == Overlap::Medium);
        let texels = if settings.filter == Filter::Compare { 1 } else { 4 };
        numbers.towards = view.towards_sun.extend(by_light_m).to_array();
        numbers.mode = [plan.layers.len().min(MOST_LAYERS) as u32, blends, texels, u32::from(settings.follows_planes)];
        for (number, (slot, layer)) in numbers.layers.iter_mut().zip(&plan.layers).enumerate() {
            let [scale, shift] = warp(layer);
            let place = if settings.split.has_map_each() || !layer.compares { place(&plan.layers, number) } else { 0 };
            let lift_m = settings.lift_texels * layer.texel_m();
            *slot = LayerNumbers {
                clip_from_scene: layer.map.clip_from_scene.to_cols_array_2d(),
                bounds_m: [layer.from_m, layer.to_m, layer.until_m, layer.texel_m()],
                making: [scale, shift, layer.least_variance, lift_m],
                place: [layer.class as u32, place as u32, layer.resolution, u32::from(layer.compares)],
            };
        }
        numbers
    }
}

/// Depth of the map to the layer's range, -1 to 1.
fn warp(layer: &Layer) -> [f32; 2] {
    let [near, far] = layer.range;
    let scale = 2.0 / (far - near).max(f32::EPSILON);
    [scale, -1.0 - scale * near]
}

/// `Making` of moments.wgsl.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Making {
    warp: [f32; 2],
    depths: i32,
    reach: i32,
    size: i32,
    nothing: [i32; 3],
}

impl Making {
    pub(super) fn of(layer: &Layer, settings: &Settings) -> Self {
        Self {
            warp: warp(layer),
            depths: (layer.map.resolution / layer.resolution).max(1) as i32,
            reach: if settings.blurred { BLUR_REACH } else { 0 },
            size: layer.resolution as i32,
            nothing: [0; 3],
        }
    }

    /// As it stands in its buffer.
    pub(super) fn padded(&self) -> impl Iterator<Item = u8> + use<> {
        padded(bytemuck::bytes_of(self))
    }
}

/// A matrix as it stands in its buffer.
pub(super) fn clip_numbers(clip_from_scene: Mat4) -> impl Iterator<Item = u8> {
    padded(bytemuck::bytes_of(&clip_from_scene))
}

fn padded(bytes: &[u8]) -> impl Iterator<Item = u8> + use<> {
    let bytes = bytes.to_vec();
    let missing = (STRIDE as usize).saturating_sub(bytes.len());
    bytes.into_iter().chain(std::iter::repeat_n(0, missing))
}
