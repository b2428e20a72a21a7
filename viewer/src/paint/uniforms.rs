//! What shaders are told of a picture and of each batch: the numbers of `view.wgsl`, and the colour maps as a texture.

use bytemuck::{Pod, Zeroable};
use eframe::wgpu::{
    Device, Extent3d, Queue, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
    util::{DeviceExt, TextureDataOrder},
};
use glam::Vec2;

use super::picture::{Batch, Culling, FaceStyle, Picture, Tint, What};
use super::sunlight::SkyLight;
use crate::colour::{ColourMap, GREY};

/// Steps of a colour map: one more would not be another colour of 8 bits.
const STEPS: usize = 256;
/// Bytes from one batch to the next: what every device aligns to.
pub(super) const BATCH_STRIDE: usize = 256;

/// The view, as shaders read it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct ViewUniform {
    clip_from_scene: [[f32; 4]; 4],
    eye_m: [f32; 4],
    forward: [f32; 4],
    right: [f32; 4],
    up: [f32; 4],
    size_px: [f32; 4],
    cuts: [[f32; 4]; Picture::MOST_CUTS],
    background: [[f32; 4]; 2],
}

impl ViewUniform {
    pub(super) fn new(picture: &Picture, size_px: [u32; 2]) -> Self {
        let camera = &picture.camera;
        let size = Vec2::new(size_px[0] as f32, size_px[1] as f32);
        let at_target_m = camera.metres_per_px(camera.target_m, size);
        let (perspective, per_px_m) =
            if camera.orthographic { (0.0, at_target_m) } else { (1.0, at_target_m / camera.distance_m) };
        // Of the picture at a distance of one.
        let half_high = (0.5 * camera.field_of_view_rad).tan();
        let mut cuts = [[0.0; 4]; Picture::MOST_CUTS];
        for (slot, cut) in cuts.iter_mut().zip(&picture.cuts) {
            *slot = cut.normal.extend(cut.offset_m).to_array();
        }
        Self {
            clip_from_scene: camera.view_projection(size).to_cols_array_2d(),
            eye_m: camera.eye_m().extend(perspective).to_array(),
            forward: camera.forward().extend(per_px_m).to_array(),
            right: camera.right().extend(half_high * size.x / size.y).to_array(),
            up: camera.up().extend(half_high).to_array(),
            size_px: [size.x, size.y, camera.near_m(), 0.0],
            cuts,
            background: picture.background.map(rgba),
        }
    }
}

/// Sun and sky, as shaders read them.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SkyUniform {
    towards_sun: [f32; 4],
    beam: [f32; 4],
    ground: [f32; 4],
    zenith: [f32; 4],
    perez: [[f32; 4]; 5],
    harmonics: [[f32; 4]; 9],
}

impl SkyUniform {
    pub(super) fn new(light: &SkyLight) -> Self {
        let with = |[a, b, c]: [f32; 3], d| [a, b, c, d];
        Self {
            towards_sun: light.towards_sun.extend(light.disc_radius_rad).to_array(),
            beam: with(light.beam_klx, light.white_kcd_m2),
            ground: with(light.ground_kcd_m2, 0.0),
            zenith: with(light.zenith, 0.0),
            perez: std::array::from_fn(|letter| with(light.perez.map(|of| of[letter]), 0.0)),
            harmonics: light.harmonics_klx.map(|rgb| with(rgb, 0.0)),
        }
    }
}

/// A batch, as shaders read it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct BatchUniform {
    straight: [f32; 4],
    look: [f32; 4],
    sizes: [f32; 4],
    grey: [f32; 4],
}

impl BatchUniform {
    pub(super) fn new(batch: &Batch) -> Self {
        let (straight, row) = match batch.tint {
            Tint::Own => ([0.0; 4], 0),
            Tint::Scaled(scale) => {
                let [low, per_step, at_low] = scale.straight();
                let row = ColourMap::ALL.iter().position(|map| *map == scale.map).unwrap_or(0);
                ([low, per_step, at_low, f32::from(u8::from(scale.logarithmic))], row)
            }
        };
        let (culling, shaded, sizes) = match &batch.what {
            What::Faces { style, culling, .. } => {
                (*culling, matches!(style, FaceStyle::Shaded | FaceStyle::Sunlit), [0.0; 4])
            }
            What::Balls { least_px, most_px, .. } => (Culling::None, true, [*least_px, *most_px, 0.0, 0.0]),
            What::Cubes { edge_m, culling, .. } => (*culling, true, [*edge_m, 0.0, 0.0, 0.0]),
            What::Strokes { .. } => (Culling::None, false, [0.0; 4]),
        };
        let to_void = f32::from(u8::from(culling == Culling::ToVoid));
        let look = [row as f32, batch.opacity, to_void, f32::from(u8::from(shaded))];
        Self { straight, look, sizes, grey: rgba(GREY) }
    }
}

/// Opaque, from 0 to 1.
fn rgba([red, green, blue]: [u8; 3]) -> [f32; 4] {
    [red, green, blue, 255].map(|channel| f32::from(channel) / 255.0)
}

/// All colour maps, a row each.
pub(super) fn colour_maps(device: &Device, queue: &Queue) -> Texture {
    let row = |map: ColourMap| {
        (0..STEPS).flat_map(move |step| {
            let [red, green, blue] = map.rgb(step as f32 / (STEPS - 1) as f32);
            [red, green, blue, 255]
        })
    };
    let texels: Vec<u8> = ColourMap::ALL.into_iter().flat_map(row).collect();
    let descriptor = TextureDescriptor {
        label: Some("colour maps"),
        size: Extent3d { width: STEPS as u32, height: ColourMap::ALL.len() as u32, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba8Unorm,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    };
    device.create_texture_with_data(queue, &descriptor, TextureDataOrder::LayerMajor, &texels)
}
