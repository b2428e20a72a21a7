//! Pictures inside egui: a callback draws one into its view's canvas before egui's own pass, and copies it there.
//!
//! [`install`] once, when the renderer is new (eframe's and the test harness's `CreationContext` both carry its
//! state); [`callback`] every frame. The renderer must have neither depth nor several samples, as by default.

use std::collections::HashMap;
use std::sync::Arc;

use eframe::egui::{PaintCallback, PaintCallbackInfo, Rect};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use eframe::wgpu::*;

use super::canvas::Canvas;
use super::picture::Picture;

/// Makes a renderer ready for [`callback`]s; those of a renderer that is not show nothing.
pub fn install(state: &RenderState) {
    let views = Views { blit: Blit::new(&state.device, state.target_format), canvases: HashMap::new() };
    state.renderer.write().callback_resources.insert(views);
}

/// Shows a picture in a rectangle (points). Views that are seen at the same time have different numbers; a view's
/// picture is drawn anew only when it or its size differs from the one before.
pub fn callback(rect: Rect, view: u64, picture: Arc<Picture>) -> PaintCallback {
    Callback::new_paint_callback(rect, Shown { rect, view, picture })
}

/// How often a view was drawn anew and how many vectors it has uploaded: what tests and the performance panel ask.
pub fn work_done(state: &RenderState, view: u64) -> Option<(usize, usize)> {
    let renderer = state.renderer.read();
    let shown = renderer.callback_resources.get::<Views>()?.canvases.get(&view)?;
    Some((shown.canvas.redraws(), shown.canvas.uploads()))
}

/// One frame's wish.
struct Shown {
    rect: Rect,
    view: u64,
    picture: Arc<Picture>,
}

/// What stays from frame to frame.
struct Views {
    blit: Blit,
    canvases: HashMap<u64, View>,
}

struct View {
    canvas: Canvas,
    group: Option<BindGroup>,
}

impl CallbackTrait for Shown {
    fn prepare(
        &self,
        device: &Device,
        queue: &Queue,
        screen: &ScreenDescriptor,
        encoder: &mut CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<CommandBuffer> {
        let Some(Views { blit, canvases }) = resources.get_mut::<Views>() else { return Vec::new() };
        let view =
            canvases.entry(self.view).or_insert_with(|| View { canvas: Canvas::new(device, queue), group: None });

        // The same pixels that egui's pass will ask for.
        let (viewport, clip_rect) = (self.rect, self.rect);
        let (pixels_per_point, screen_size_px) = (screen.pixels_per_point, screen.size_in_pixels);
        let info = PaintCallbackInfo { viewport, clip_rect, pixels_per_point, screen_size_px };
        let in_px = info.viewport_in_pixels();
        if in_px.width_px > 0 && in_px.height_px > 0 {
            let size_px = [in_px.width_px as u32, in_px.height_px as u32];
            view.canvas.draw(device, queue, encoder, size_px, &self.picture);
            view.group = view.canvas.picture().map(|picture| blit.group(device, picture));
        }
        Vec::new()
    }

    fn paint(&self, _info: PaintCallbackInfo, pass: &mut RenderPass<'static>, resources: &CallbackResources) {
        let Some(Views { blit, canvases }) = resources.get::<Views>() else { return };
        let Some(group) = canvases.get(&self.view).and_then(|view| view.group.as_ref()) else { return };
        pass.set_pipeline(&blit.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Copies a picture into egui's pass.
struct Blit {
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
    nearest: Sampler,
}

impl Blit {
    fn new(device: &Device, target: TextureFormat) -> Self {
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("blit"),
            source: ShaderSource::Wgsl(include_str!("shaders/blit.wgsl").into()),
        });
        let entry = |binding, ty| BindGroupLayoutEntry { binding, visibility: ShaderStages::FRAGMENT, ty, count: None };
        let texture = BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: false },
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let layout = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("blit"),
            entries: &[entry(0, texture), entry(1, BindingType::Sampler(SamplerBindingType::NonFiltering))],
        });
        let pipeline_layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("blit"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let constants = [("LINEAR", f64::from(u8::from(target.is_srgb())))];
        let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("blit"),
            layout: Some(&pipeline_layout),
            vertex: VertexState {
                module: &module,
                entry_point: Some("blit_vertex"),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: None,
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &module,
                entry_point: Some("blit_fragment"),
                compilation_options: PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets: &[Some(target.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let nearest = device.create_sampler(&SamplerDescriptor { label: Some("nearest"), ..Default::default() });
        Self { layout, pipeline, nearest }
    }

    fn group(&self, device: &Device, picture: &Texture) -> BindGroup {
        let picture = picture.create_view(&TextureViewDescriptor::default());
        device.create_bind_group(&BindGroupDescriptor {
            label: Some("blit"),
            layout: &self.layout,
            entries: &[
                BindGroupEntry { binding: 0, resource: BindingResource::TextureView(&picture) },
                BindGroupEntry { binding: 1, resource: BindingResource::Sampler(&self.nearest) },
            ],
        })
    }
}
