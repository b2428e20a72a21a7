//! Which depths does the camera see? Drawn, counted by depth on the card, and read: a kilobyte, and one wait.
//!
//! The paper's first step, the moments from the viewpoint: of the counts, its mean and its variance follow for any range.

use super::super::View;
use super::super::casters::Casters;
use super::super::plan::Seen;
use super::numbers::clip_numbers;
use super::passes::{depth, depth_pass, depth_pipeline, group, group_layout, pipeline_layout, uniform};
use super::textures::DEPTHS;
use bytemuck::{Pod, Zeroable};
use eframe::wgpu::*;
use glam::Vec2;
use std::sync::mpsc;
use std::time::Duration;

/// How long the card may take before it counts as lost.
const MOST_WAIT: Duration = Duration::from_secs(20);
/// First and last depth, and the counts.
const WORDS: usize = 2 + Seen::BINS as usize;

/// Pixels that are counted together, as seen.wgsl has it.
const WORKGROUP: u32 = 8 * 8;

/// Draws and counts depths.
pub(super) struct Eye {
    from_eye: RenderPipeline,
    clip: Buffer,
    clip_group: BindGroup,
    counting: ComputePipeline,
    counting_layout: BindGroupLayout,
    reading: Buffer,
    counts: Buffer,
    read: Buffer,
    depths: Option<Texture>,
}

/// `Reading` of seen.wgsl.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Reading {
    near_m: f32,
    least_m: f32,
    bins_an_octave: f32,
    nothing: f32,
}

impl Eye {
    /// None on cards that do not compute (OpenGL before 4.3).
    pub(super) fn new(device: &Device) -> Option<Self> {
        if device.limits().max_compute_invocations_per_workgroup < WORKGROUP {
            return None;
        }
        let told = group_layout(device, "eye", ShaderStages::VERTEX, &[uniform(true)]);
        let storage = BindingType::Buffer {
            ty: BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let types = [uniform(false), depth(TextureViewDimension::D2), storage];
        let counting_layout = group_layout(device, "counting", ShaderStages::COMPUTE, &types);
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("seen"),
            source: ShaderSource::Wgsl(include_str!("../shaders/seen.wgsl").into()),
        });
        let counting = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some("seen"),
            layout: Some(&pipeline_layout(device, &[&counting_layout])),
            module: &module,
            entry_point: Some("seen_of"),
            compilation_options: PipelineCompilationOptions::default(),
            cache: None,
        });
        let buffer = |label, size, usage| {
            device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let bytes = (WORDS * size_of::<u32>()) as u64;
        let clip = buffer("eye", 256, BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let binding = BufferBinding { buffer: &clip, offset: 0, size: BufferSize::new(64) };
        Some(Self {
            from_eye: depth_pipeline(device, &told, CompareFunction::Greater),
            clip_group: group(device, "eye", &told, &[BindingResource::Buffer(binding)]),
            counting,
            counting_layout,
            reading: buffer("reading", size_of::<Reading>() as u64, BufferUsages::UNIFORM | BufferUsages::COPY_DST),
            counts: buffer("counts", bytes, BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC),
            read: buffer("counts read", bytes, BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            clip,
            depths: None,
        })
    }

    /// The depths that a perspective sees; none where it sees nothing, or the card is lost.
    pub(super) fn seen(&mut self, device: &Device, queue: &Queue, casters: &Casters, view: &View) -> Option<Seen> {
        let size_px = Vec2::new(view.size_px[0] as f32, view.size_px[1] as f32);
        let clip_from_scene = view.camera.view_projection(size_px);
        let reading = Reading {
            near_m: view.camera.near_m(),
            least_m: Seen::LEAST_M,
            bins_an_octave: Seen::BINS_AN_OCTAVE as f32,
            nothing: 0.0,
        };
        let mut none = [0_u32; WORDS];
        none[0] = f32::INFINITY.to_bits();
        queue.write_buffer(&self.clip, 0, &clip_numbers(clip_from_scene).collect::<Vec<u8>>());
        queue.write_buffer(&self.reading, 0, bytemuck::bytes_of(&reading));
        queue.write_buffer(&self.counts, 0, bytemuck::cast_slice(&none));

        let depths = self.depths(device, view.size_px);
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor { label: Some("seen") });
        let mut pass = depth_pass(&mut encoder, "seen", &depths, 0.0);
        pass.set_pipeline(&self.from_eye);
        pass.set_bind_group(0, &self.clip_group, &[0]);
        casters.draw(&mut pass, |bounds_m| super::super::plan::may_see(view, bounds_m));
        drop(pass);

        let resources =
            [self.reading.as_entire_binding(), BindingResource::TextureView(&depths), self.counts.as_entire_binding()];
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&self.counting);
        pass.set_bind_group(0, &group(device, "counting", &self.counting_layout, &resources), &[]);
        pass.dispatch_workgroups(view.size_px[0].div_ceil(8), view.size_px[1].div_ceil(8), 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.counts, 0, &self.read, 0, self.read.size());
        queue.submit([encoder.finish()]);
        self.words(device).and_then(|words| counted(&words))
    }

    /// A texture of the view's size.
    fn depths(&mut self, device: &Device, [width, height]: [u32; 2]) -> TextureView {
        let fits = |texture: &Texture| [texture.width(), texture.height()] == [width, height];
        let texture = self.depths.take().filter(fits).unwrap_or_else(|| {
            device.create_texture(&TextureDescriptor {
                label: Some("seen"),
                size: Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format: DEPTHS,
                usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        });
        let view = texture.create_view(&TextureViewDescriptor::default());
        self.depths = Some(texture);
        view
    }

    /// Waits for the counts.
    fn words(&self, device: &Device) -> Option<Vec<u32>> {
        let (sender, receiver) = mpsc::channel();
        self.read.map_async(MapMode::Read, .., move |mapped| drop(sender.send(mapped)));
        device.poll(PollType::Wait { submission_index: None, timeout: Some(MOST_WAIT) }).ok()?;
        receiver.try_recv().ok()?.ok()?;
        let mapped = self.read.get_mapped_range(..).ok()?;
        let words = bytemuck::pod_collect_to_vec(&mapped);
        drop(mapped);
        self.read.unmap();
        Some(words)
    }
}

/// The counts in words.
fn counted(words: &[u32]) -> Option<Seen> {
    let [first, last, pixels @ ..] = words else { return None };
    let [first_m, last_m] = [*first, *last].map(f32::from_bits);
    (first_m <= last_m).then(|| Seen { first_m, last_m, pixels: pixels.to_vec() })
}
