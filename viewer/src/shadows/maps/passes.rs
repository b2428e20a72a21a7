//! The pipelines of all methods: depth from the sun, moments by rows and by columns, and the layout of what is looked up.

use super::numbers::{Making, STRIDE};
use super::textures::{DEPTHS, ROWS, Textures, format};
use crate::shadows::settings::{Class, MOST_LAYERS};
use eframe::wgpu::*;
use glam::{Mat4, Vec3};

/// Pipelines and what they are told.
pub(super) struct Passes {
    pub(super) from_sun: RenderPipeline,
    pub(super) clips: Buffer,
    pub(super) clip_group: BindGroup,
    pub(super) makings: Buffer,
    pub(super) making_group: BindGroup,
    pub(super) lookup_layout: BindGroupLayout,
    source_layout: BindGroupLayout,
    /// Rows and columns in the numbers of class A, and of the others.
    moments: [[RenderPipeline; 2]; 2],
    texels: Sampler,
}

impl Passes {
    pub(super) fn new(device: &Device) -> Self {
        let told_layout = group_layout(device, "step", ShaderStages::VERTEX_FRAGMENT, &[uniform(true)]);
        let source = [depth(TextureViewDimension::D2), moments(TextureViewDimension::D2)];
        let source_layout = group_layout(device, "source", ShaderStages::FRAGMENT, &source);
        let array = TextureViewDimension::D2Array;
        let looked_up = [
            uniform(false),
            depth(array),
            moments(array),
            moments(array),
            moments(array),
            BindingType::Sampler(SamplerBindingType::NonFiltering),
        ];
        let lookup_layout = group_layout(device, "shadows", ShaderStages::FRAGMENT, &looked_up);

        let (clips, clip_group) = told(device, &told_layout, size_of::<Mat4>());
        let (makings, making_group) = told(device, &told_layout, size_of::<Making>());
        let shader = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("moments"),
            source: ShaderSource::Wgsl(include_str!("../shaders/moments.wgsl").into()),
        });
        let layout = pipeline_layout(device, &[&told_layout, &source_layout]);
        let step = |entry, format| moments_pipeline(device, &layout, &shader, entry, format);
        let moments = [ROWS, format(Class::B)]
            .map(|format| ["rows_fragment", "columns_fragment"].map(|entry| step(entry, format)));
        let texels = device.create_sampler(&SamplerDescriptor { label: Some("texels"), ..Default::default() });
        let from_sun = depth_pipeline(device, &told_layout, CompareFunction::Less);
        Self { from_sun, clips, clip_group, makings, making_group, lookup_layout, source_layout, moments, texels }
    }

    /// Rows in 32 bits, and rows and columns in a class's own numbers.
    pub(super) fn moments(&self, class: Class) -> [&RenderPipeline; 3] {
        let [long, short] = &self.moments;
        let own = if class == Class::A { long } else { short };
        [&long[0], &own[0], &own[1]]
    }

    /// What a step of the moments reads.
    pub(super) fn source_group(&self, device: &Device, depths: &TextureView, rows: &TextureView) -> BindGroup {
        let views = [depths, rows].map(BindingResource::TextureView);
        group(device, "source", &self.source_layout, &views)
    }

    /// What lookups read.
    pub(super) fn lookup_group(&self, device: &Device, numbers: &Buffer, textures: &Textures) -> BindGroup {
        let [a, b, c] = &textures.moments;
        let resources = [
            numbers.as_entire_binding(),
            BindingResource::TextureView(&textures.all_depths),
            BindingResource::TextureView(&a.all),
            BindingResource::TextureView(&b.all),
            BindingResource::TextureView(&c.all),
            BindingResource::Sampler(&self.texels),
        ];
        group(device, "shadows", &self.lookup_layout, &resources)
    }
}

/// Begins a pass that draws depth alone, over what is this far at first.
pub(super) fn depth_pass<'a>(
    encoder: &'a mut CommandEncoder,
    label: &str,
    depth: &TextureView,
    clear: f32,
) -> RenderPass<'a> {
    encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some(label),
        depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(Operations { load: LoadOp::Clear(clear), store: StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

/// Begins a pass that fills a target of moments.
pub(super) fn moments_pass<'a>(encoder: &'a mut CommandEncoder, target: &TextureView) -> RenderPass<'a> {
    encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some("shadow moments"),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
        })],
        ..Default::default()
    })
}

/// Draws depth of positions alone; of two the one that compares so stays.
pub(super) fn depth_pipeline(device: &Device, told: &BindGroupLayout, stays: CompareFunction) -> RenderPipeline {
    let shader = device.create_shader_module(ShaderModuleDescriptor {
        label: Some("depth"),
        source: ShaderSource::Wgsl(include_str!("../shaders/depth.wgsl").into()),
    });
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some("depth"),
        layout: Some(&pipeline_layout(device, &[told])),
        vertex: positions(&shader, "depth_vertex"),
        primitive: PrimitiveState::default(),
        depth_stencil: Some(depth_state(stays)),
        multisample: MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}

fn moments_pipeline(
    device: &Device,
    layout: &PipelineLayout,
    shader: &ShaderModule,
    entry: &str,
    format: TextureFormat,
) -> RenderPipeline {
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some("moments"),
        layout: Some(layout),
        vertex: VertexState {
            module: shader,
            entry_point: Some("moments_vertex"),
            compilation_options: PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: PrimitiveState::default(),
        depth_stencil: None,
        multisample: MultisampleState::default(),
        fragment: Some(FragmentState {
            module: shader,
            entry_point: Some(entry),
            compilation_options: PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// A vertex stage that takes positions alone, as [`crate::shadows::Casters`] holds them.
pub(in crate::shadows) fn positions<'a>(shader: &'a ShaderModule, entry: &'a str) -> VertexState<'a> {
    const POSITION: [VertexAttribute; 1] = vertex_attr_array![0 => Float32x3];
    VertexState {
        module: shader,
        entry_point: Some(entry),
        compilation_options: PipelineCompilationOptions::default(),
        buffers: const {
            &[Some(VertexBufferLayout {
                array_stride: size_of::<Vec3>() as BufferAddress,
                step_mode: VertexStepMode::Vertex,
                attributes: &POSITION,
            })]
        },
    }
}

/// Depth that is written where it compares so.
pub(in crate::shadows) fn depth_state(stays: CompareFunction) -> DepthStencilState {
    DepthStencilState {
        format: DEPTHS,
        depth_write_enabled: Some(true),
        depth_compare: Some(stays),
        stencil: StencilState::default(),
        bias: DepthBiasState::default(),
    }
}

pub(in crate::shadows) fn uniform(has_dynamic_offset: bool) -> BindingType {
    BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset, min_binding_size: None }
}

pub(super) fn depth(view_dimension: TextureViewDimension) -> BindingType {
    BindingType::Texture { sample_type: TextureSampleType::Depth, view_dimension, multisampled: false }
}

fn moments(view_dimension: TextureViewDimension) -> BindingType {
    let sample_type = TextureSampleType::Float { filterable: false };
    BindingType::Texture { sample_type, view_dimension, multisampled: false }
}

/// A layout of bindings numbered from 0.
pub(in crate::shadows) fn group_layout(
    device: &Device,
    label: &str,
    visibility: ShaderStages,
    types: &[BindingType],
) -> BindGroupLayout {
    let entry = |(ty, binding): (&BindingType, u32)| BindGroupLayoutEntry { binding, visibility, ty: *ty, count: None };
    let entries: Vec<BindGroupLayoutEntry> = types.iter().zip(0..).map(entry).collect();
    device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// A group of resources numbered from 0.
pub(in crate::shadows) fn group(
    device: &Device,
    label: &str,
    layout: &BindGroupLayout,
    resources: &[BindingResource],
) -> BindGroup {
    let numbered = resources.iter().zip(0..);
    let entries: Vec<BindGroupEntry> =
        numbered.map(|(resource, binding)| BindGroupEntry { binding, resource: resource.clone() }).collect();
    device.create_bind_group(&BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

pub(in crate::shadows) fn pipeline_layout(device: &Device, groups: &[&BindGroupLayout]) -> PipelineLayout {
    let groups: Vec<Option<&BindGroupLayout>> = groups.iter().copied().map(Some).collect();
    device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: Some("shadows"),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// A buffer of numbers for every layer, and its group.
fn told(device: &Device, layout: &BindGroupLayout, bytes: usize) -> (Buffer, BindGroup) {
    let buffer = device.create_buffer(&BufferDescriptor {
        label: Some("step"),
        size: u64::from(STRIDE) * MOST_LAYERS as u64,
        usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let binding = BufferBinding { buffer: &buffer, offset: 0, size: BufferSize::new(bytes as u64) };
    let group = group(device, "step", layout, &[BindingResource::Buffer(binding)]);
    (buffer, group)
}
