//! The textures that maps need.

use super::super::plan::Plan;
use super::super::settings::{Class, Settings};
use eframe::wgpu::*;

/// How many textures of which size; equal needs share their textures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Need {
    /// Texels a side of maps, and how many are kept.
    depths: (u32, u32),
    /// Texels a side of the map that is drawn over again for each layer's moments.
    scratch: u32,
    /// Texels a side and number of moments, by class.
    moments: [(u32, u32); 3],
    /// Texels a side of what lies between rows and columns of a blur.
    rows: u32,
}

impl Need {
    pub(super) fn of(plan: &Plan, settings: &Settings) -> Self {
        let mut need = Self::default();
        for layer in &plan.layers {
            if !settings.split.has_map_each() {
                need.depths = (layer.map.resolution, 1);
            } else if layer.compares {
                need.depths = (layer.map.resolution, need.depths.1 + 1);
            } else {
                need.scratch = need.scratch.max(layer.map.resolution);
            }
            if !layer.compares {
                let (_, number) = need.moments[layer.class as usize];
                need.moments[layer.class as usize] = (layer.resolution, number + 1);
                need.rows = need.rows.max(layer.resolution);
            }
        }
        need
    }
}

/// The textures.
pub(super) struct Textures {
    pub(super) need: Need,
    /// Maps that points are compared with, or whose moments are made; one layer each, and all as an array.
    pub(super) depths: Vec<TextureView>,
    pub(super) all_depths: TextureView,
    pub(super) scratch: Option<TextureView>,
    pub(super) moments: [Moments; 3],
    pub(super) rows: Option<TextureView>,
    /// Stand for a source that a step does not read.
    pub(super) nothing: TextureView,
    pub(super) no_depth: TextureView,
}

/// Moments of the layers of one class.
pub(super) struct Moments {
    pub(super) views: Vec<TextureView>,
    pub(super) all: TextureView,
}

/// The numbers of a class's moments.
pub(super) const fn format(class: Class) -> TextureFormat {
    match class {
        Class::A => TextureFormat::Rg32Float,
        Class::B | Class::C => TextureFormat::Rg16Float,
    }
}

/// A map's numbers.
pub(super) const DEPTHS: TextureFormat = TextureFormat::Depth32Float;
/// What lies between rows and columns.
pub(super) const ROWS: TextureFormat = TextureFormat::Rg32Float;

impl Textures {
    pub(super) fn new(device: &Device, need: Need) -> Self {
        let (depths, all_depths) = array(device, "shadow depths", DEPTHS, need.depths);
        let single =
            |label, format, side| (side > 0).then(|| array(device, label, format, (side, 1)).0.pop()).flatten();
        let moments = [Class::A, Class::B, Class::C].map(|class| {
            let (views, all) = array(device, "shadow moments", format(class), need.moments[class as usize]);
            Moments { views, all }
        });
        let one = |format| {
            let texture = texture(device, "nothing", format, (1, 1));
            texture.create_view(&TextureViewDescriptor::default())
        };
        Self {
            need,
            depths,
            all_depths,
            scratch: single("shadow scratch", DEPTHS, need.scratch),
            moments,
            rows: single("shadow rows", ROWS, need.rows),
            nothing: one(ROWS),
            no_depth: one(DEPTHS),
        }
    }

    /// What they hold, without those that stand for nothing.
    pub(super) fn bytes(&self) -> u64 {
        let texels = |(side, number): (u32, u32)| u64::from(side) * u64::from(side) * u64::from(number);
        let bytes = |format: TextureFormat, count: (u32, u32)| {
            let each = if format == DEPTHS { 4 } else { format.block_copy_size(None).unwrap_or(0) };
            texels(count) * u64::from(each)
        };
        let Need { depths, scratch, moments, rows } = self.need;
        let of_moments: u64 =
            [Class::A, Class::B, Class::C].map(|class| bytes(format(class), moments[class as usize])).iter().sum();
        bytes(DEPTHS, depths) + bytes(DEPTHS, (scratch, 1)) + of_moments + bytes(ROWS, (rows, 1))
    }
}

/// A texture of several layers: each of them, and all; of one texel where none is needed.
fn array(
    device: &Device,
    label: &str,
    format: TextureFormat,
    (side, number): (u32, u32),
) -> (Vec<TextureView>, TextureView) {
    let texture = texture(device, label, format, (side.max(1), number.max(1)));
    let layer = |layer| {
        texture.create_view(&TextureViewDescriptor {
            dimension: Some(TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        })
    };
    let all = TextureViewDescriptor { dimension: Some(TextureViewDimension::D2Array), ..Default::default() };
    ((0..number).map(layer).collect(), texture.create_view(&all))
}

fn texture(device: &Device, label: &str, format: TextureFormat, (side, number): (u32, u32)) -> Texture {
    device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: Extent3d { width: side, height: side, depth_or_array_layers: number },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}
