//! Draws pictures into a texture of its own: colours and depths, in two passes, and only what has changed.
//!
//! First pass: the opaque batches, the background behind them, then the transparent ones, blended in the order given (within a
//! batch in the order of its data: where several transparent faces lie behind one another their order may be wrong; culling
//! to the void leaves mostly one). Second pass: what is on top, over everything, among itself hidden as usual. Before both,
//! where the sun shines, shadow maps, in passes of their own.

use eframe::wgpu::*;

use super::picture::{Batch, Picture};
use super::pipelines::{COLOURS, DEPTHS, Key, Pipelines, SAMPLES};
use super::shade::Shade;
use super::uniforms::{BATCH_STRIDE, BatchUniform, SkyUniform, ViewUniform, colour_maps};
use super::upload::Uploads;

/// Everything on the GPU that one view needs.
pub struct Canvas {
    pipelines: Pipelines,
    uploads: Uploads,
    view: Buffer,
    sky: Buffer,
    view_group: BindGroup,
    batches: Batches,
    /// Made when the first shadows are asked for.
    shade: Option<Shade>,
    target: Option<Target>,
    drawn: Option<Picture>,
    redraws: usize,
}

/// The numbers of all batches.
struct Batches {
    buffer: Buffer,
    group: BindGroup,
}

/// The textures of one size.
struct Target {
    size_px: [u32; 2],
    picture: Texture,
    picture_view: TextureView,
    samples: TextureView,
    depths: TextureView,
}

/// The passes, and the batches of each.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    Scene,
    OnTop,
}

impl Canvas {
    /// An empty canvas. Costs a texture of four rows and two small buffers; pipelines are made when first needed.
    pub fn new(device: &Device, queue: &Queue) -> Self {
        let pipelines = Pipelines::new(device);
        let view = uniforms(device, "view", size_of::<ViewUniform>());
        let sky = uniforms(device, "sky", size_of::<SkyUniform>());
        let maps = colour_maps(device, queue).create_view(&TextureViewDescriptor::default());
        let view_group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("view"),
            layout: &pipelines.view_layout,
            entries: &[
                BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
                BindGroupEntry { binding: 1, resource: BindingResource::TextureView(&maps) },
                BindGroupEntry { binding: 2, resource: sky.as_entire_binding() },
            ],
        });
        let batches = Batches::new(device, &pipelines.batch_layout, 1);
        let uploads = Uploads::default();
        Self { pipelines, uploads, view, sky, view_group, batches, shade: None, target: None, drawn: None, redraws: 0 }
    }

    /// Draws a picture with this many pixels, unless it is the one drawn last. Uploads only data that are new.
    ///
    /// The commands go to `encoder`; of two pictures drawn by one canvas before a submit, the second is shown.
    pub fn draw(
        &mut self,
        device: &Device,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        size_px: [u32; 2],
        picture: &Picture,
    ) {
        let most_px = device.limits().max_texture_dimension_2d;
        let size_px = size_px.map(|pixels| pixels.clamp(1, most_px));
        let fits = self.target.as_ref().is_some_and(|target| target.size_px == size_px);
        if fits && self.drawn.as_ref() == Some(picture) {
            return;
        }
        if !fits {
            self.target = Some(Target::new(device, size_px));
        }
        self.prepare(device, queue, size_px, picture);
        self.record(encoder, picture);
        self.drawn = Some(picture.clone());
        self.redraws += 1;
    }

    /// The last picture drawn; none before the first.
    pub fn picture(&self) -> Option<&Texture> {
        self.target.as_ref().map(|target| &target.picture)
    }

    /// Pictures drawn so far, without those that were the same as the one before.
    pub fn redraws(&self) -> usize {
        self.redraws
    }

    /// Vectors uploaded so far.
    pub fn uploads(&self) -> usize {
        self.uploads.count
    }

    /// Times that shadow maps were drawn so far.
    pub fn shadow_redraws(&self) -> usize {
        self.shade.as_ref().map_or(0, |shade| shade.redraws)
    }

    /// Brings to the GPU what the picture needs.
    fn prepare(&mut self, device: &Device, queue: &Queue, size_px: [u32; 2], picture: &Picture) {
        self.uploads.update(device, picture.batches.iter().map(|batch| &batch.what));
        if picture.has_shadows() {
            self.shade.get_or_insert_with(|| Shade::new(device)).draw(device, queue, size_px, picture);
        }
        let shadows = self.shade.as_ref().map(Shade::layout);
        self.pipelines.make(device, Key::background(picture), shadows);
        for batch in &picture.batches {
            self.pipelines.make(device, Key::new(batch, picture), shadows);
        }

        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&ViewUniform::new(picture, size_px)));
        if let Some(sunlight) = &picture.sunlight {
            queue.write_buffer(&self.sky, 0, bytemuck::bytes_of(&SkyUniform::new(&sunlight.light)));
        }
        self.batches.grow(device, &self.pipelines.batch_layout, picture.batches.len());
        let mut numbers = vec![0; BATCH_STRIDE * picture.batches.len()];
        for (slot, batch) in numbers.chunks_exact_mut(BATCH_STRIDE).zip(&picture.batches) {
            slot[..size_of::<BatchUniform>()].copy_from_slice(bytemuck::bytes_of(&BatchUniform::new(batch)));
        }
        queue.write_buffer(&self.batches.buffer, 0, &numbers);
    }

    /// Records both passes.
    fn record(&self, encoder: &mut CommandEncoder, picture: &Picture) {
        let Some(target) = &self.target else { return };
        let (scene, on_top): (Vec<_>, Vec<_>) =
            picture.batches.iter().enumerate().partition(|(_, batch)| !batch.on_top);
        let (opaque, transparent): (Vec<_>, Vec<_>) = scene.into_iter().partition(|(_, batch)| batch.opacity >= 1.0);

        let is_last = on_top.is_empty();
        let mut pass = target.begin(encoder, Pass::Scene, is_last);
        self.draw_batches(&mut pass, opaque.into_iter(), picture);
        // Behind them, and only where nothing hides it: a sky takes longer than a fade.
        self.draw_background(&mut pass, picture);
        self.draw_batches(&mut pass, transparent.into_iter(), picture);
        drop(pass);
        if !is_last {
            self.draw_batches(&mut target.begin(encoder, Pass::OnTop, true), on_top.into_iter(), picture);
        }
    }

    fn draw_background(&self, pass: &mut RenderPass<'_>, picture: &Picture) {
        let Some(pipeline) = self.pipelines.get(Key::background(picture)) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.view_group, &[]);
        pass.set_bind_group(1, &self.batches.group, &[0]);
        pass.draw(0..3, 0..1);
    }

    fn draw_batches<'a>(
        &self,
        pass: &mut RenderPass<'_>,
        batches: impl Iterator<Item = (usize, &'a Batch)>,
        picture: &Picture,
    ) {
        pass.set_bind_group(0, &self.view_group, &[]);
        for (number, batch) in batches {
            let key = Key::new(batch, picture);
            let Some(pipeline) = self.pipelines.get(key) else { continue };
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, &self.batches.group, &[(number * BATCH_STRIDE) as u32]);
            if let Some(shade) = self.shade.as_ref().filter(|_| key.is_sunlit()) {
                pass.set_bind_group(2, shade.group(), &[]);
            }
            for part in self.uploads.parts(&batch.what) {
                pass.set_vertex_buffer(0, part.vertices.slice(..));
                match self.uploads.rectangles().filter(|_| key.rectangles()) {
                    Some(indices) => {
                        pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
                        pass.draw_indexed(0..part.count, 0, 0..1);
                    }
                    None => pass.draw(0..part.count, 0..1),
                }
            }
        }
    }
}

impl Batches {
    fn new(device: &Device, layout: &BindGroupLayout, number: usize) -> Self {
        let buffer = uniforms(device, "batches", BATCH_STRIDE * number);
        let size = BufferSize::new(size_of::<BatchUniform>() as u64);
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("batch"),
            layout,
            entries: &[BindGroupEntry {
                binding: 0,
                resource: BindingResource::Buffer(BufferBinding { buffer: &buffer, offset: 0, size }),
            }],
        });
        Self { buffer, group }
    }

    /// Makes room for so many batches.
    fn grow(&mut self, device: &Device, layout: &BindGroupLayout, number: usize) {
        if self.buffer.size() < (BATCH_STRIDE * number) as u64 {
            *self = Self::new(device, layout, number.next_power_of_two());
        }
    }
}

impl Target {
    fn new(device: &Device, size_px: [u32; 2]) -> Self {
        let texture = |label, format, sample_count, usage| {
            device.create_texture(&TextureDescriptor {
                label: Some(label),
                size: Extent3d { width: size_px[0], height: size_px[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: TextureDimension::D2,
                format,
                usage: TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let view = |texture: &Texture| texture.create_view(&TextureViewDescriptor::default());
        let picture = texture("picture", COLOURS, 1, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC);
        let samples = texture("samples", COLOURS, SAMPLES, TextureUsages::empty());
        let depths = texture("depths", DEPTHS, SAMPLES, TextureUsages::empty());
        Self { size_px, picture_view: view(&picture), picture, samples: view(&samples), depths: view(&depths) }
    }

    /// Begins a pass; the last one makes pixels of the samples.
    fn begin<'a>(&self, encoder: &'a mut CommandEncoder, pass: Pass, is_last: bool) -> RenderPass<'a> {
        let load = if pass == Pass::Scene { LoadOp::Clear(Color::BLACK) } else { LoadOp::Load };
        encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &self.samples,
                depth_slice: None,
                resolve_target: is_last.then_some(&self.picture_view),
                ops: Operations { load, store: if is_last { StoreOp::Discard } else { StoreOp::Store } },
            })],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &self.depths,
                depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Discard }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}

/// A buffer of numbers for shaders.
fn uniforms(device: &Device, label: &str, bytes: usize) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size: bytes as u64,
        usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
