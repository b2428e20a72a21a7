//! Whole frames offscreen, for figures: the maps, and the view lit by them, read as numbers.

use super::View;
use super::casters::Casters;
use super::maps::Maps;
use super::maps::passes::{depth_state, group, group_layout, pipeline_layout, positions, uniform};
use super::plan::may_see;
use super::settings::Settings;
use crate::paint::Offscreen;
use anyhow::{Context, Result};
use bytemuck::{Pod, Zeroable};
use eframe::wgpu::*;
use glam::{Vec2, Vec3};

/// What is drawn: share of the sun and depth.
const LIT: TextureFormat = TextureFormat::Rg32Float;

/// The share where nothing is seen.
const NOTHING: f32 = -1.0;

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lit {
    /// Share of the sun that reaches the surface, 0 to 1; 0 where it faces away.
    pub share: f32,
    /// Depth along the gaze, metres.
    pub depth_m: f32,
}

/// A scene, and frames of it.
pub struct Studio<'a> {
    offscreen: &'a Offscreen,
    casters: Casters,
    maps: Maps,
    pipeline: RenderPipeline,
    eye: Buffer,
    eye_group: BindGroup,
    target: Option<Target>,
}

struct Target {
    size_px: [u32; 2],
    lit: Texture,
    lit_view: TextureView,
    depth_view: TextureView,
}

/// `Eye` of lit.wgsl.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Eye {
    clip_from_scene: [[f32; 4]; 4],
    forward: [f32; 4],
    eye_m: [f32; 4],
}

impl<'a> Studio<'a> {
    /// A scene of these triangles, three corners each.
    pub fn new(offscreen: &'a Offscreen, corners_m: &[Vec3]) -> Self {
        let device = &offscreen.render_state().device;
        let maps = Maps::new(device);
        let told = group_layout(device, "eye", ShaderStages::VERTEX_FRAGMENT, &[uniform(false)]);
        let source = [include_str!("shaders/lit.wgsl"), include_str!("shaders/lookup.wgsl")].concat();
        let shader = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("lit"),
            source: ShaderSource::Wgsl(source.into()),
        });
        let nothing = group_layout(device, "nothing", ShaderStages::NONE, &[]);
        let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("lit"),
            layout: Some(&pipeline_layout(device, &[&told, &nothing, maps.layout()])),
            vertex: positions(&shader, "lit_vertex"),
            primitive: PrimitiveState::default(),
            depth_stencil: Some(depth_state(CompareFunction::Greater)),
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &shader,
                entry_point: Some("lit_fragment"),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &[Some(LIT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let eye = device.create_buffer(&BufferDescriptor {
            label: Some("eye"),
            size: size_of::<Eye>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let eye_group = group(device, "eye", &told, &[eye.as_entire_binding()]);
        Self { offscreen, casters: Casters::new(device, corners_m), maps, pipeline, eye, eye_group, target: None }
    }

    /// Draws a whole frame, maps and view, and waits until it is done.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn frame(&mut self, view: &View, settings: &Settings) -> Result<()> {
        let state = self.offscreen.render_state();
        let (device, queue) = (&state.device, &state.queue);
        self.maps.draw(device, queue, &self.casters, view, settings);
        if self.target.as_ref().is_none_or(|target| target.size_px != view.size_px) {
            self.target = Some(Target::new(device, view.size_px));
        }
        let target = self.target.as_ref().context("there is a target")?;
        queue.write_buffer(&self.eye, 0, bytemuck::bytes_of(&Eye::new(view)));
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor { label: Some("lit") });
        let mut pass = target.begin(&mut encoder);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.eye_group, &[]);
        pass.set_bind_group(2, self.maps.group(), &[]);
        self.casters.draw(&mut pass, |bounds_m| may_see(view, bounds_m));
        drop(pass);
        queue.submit([encoder.finish()]);
        self.offscreen.wait()
    }

    /// What the last frame shows, rows from the top; `None` where nothing is seen.
    ///
    /// # Errors
    /// Before the first frame, or when the adapter is lost.
    pub fn lit(&self) -> Result<Vec<Option<Lit>>> {
        let target = self.target.as_ref().context("no frame was drawn")?;
        let bytes = self.offscreen.read_bytes(&target.lit)?;
        let numbers: Vec<[f32; 2]> = bytemuck::pod_collect_to_vec(&bytes);
        // A share that is no number is something seen, and wrong.
        let lit = |[share, depth_m]: [f32; 2]| (share != NOTHING).then_some(Lit { share, depth_m });
        Ok(numbers.into_iter().map(lit).collect())
    }

    /// The maps of the last frame.
    pub fn maps(&self) -> &Maps {
        &self.maps
    }
}

impl Eye {
    fn new(view: &View) -> Self {
        let camera = &view.camera;
        let size_px = Vec2::new(view.size_px[0] as f32, view.size_px[1] as f32);
        Self {
            clip_from_scene: camera.view_projection(size_px).to_cols_array_2d(),
            forward: camera.forward().extend(camera.depth_m(Vec3::ZERO)).to_array(),
            eye_m: camera.eye_m().extend(f32::from(u8::from(!camera.orthographic))).to_array(),
        }
    }
}

impl Target {
    fn new(device: &Device, size_px: [u32; 2]) -> Self {
        let texture = |label, format, usage| {
            device.create_texture(&TextureDescriptor {
                label: Some(label),
                size: Extent3d { width: size_px[0], height: size_px[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format,
                usage: TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let lit = texture("lit", LIT, TextureUsages::COPY_SRC);
        let depth = texture("lit depth", TextureFormat::Depth32Float, TextureUsages::empty());
        let view = |texture: &Texture| texture.create_view(&TextureViewDescriptor::default());
        Self { size_px, lit_view: view(&lit), depth_view: view(&depth), lit }
    }

    /// Begins the pass.
    fn begin<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        let nothing = Color { r: f64::from(NOTHING), ..Color::TRANSPARENT };
        encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("lit"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &self.lit_view,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(nothing), store: StoreOp::Store },
            })],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &self.depth_view,
                depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }
}
