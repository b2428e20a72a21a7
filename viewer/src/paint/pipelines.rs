//! How each kind of thing is drawn: the pipelines, made when first needed.

use std::collections::HashMap;

use eframe::wgpu::*;

use super::picture::{Ball, Batch, Corner, Cube, FaceStyle, Picture, Tint, What};
use super::upload::StrokeVertex;

/// Samples a pixel: smooth edges of faces, and balls and lines that fade at their edges in any order of drawing.
pub(super) const SAMPLES: u32 = 4;
/// Colours as egui has them: encoded, without the card's own decoding.
pub(super) const COLOURS: TextureFormat = TextureFormat::Rgba8Unorm;
/// Reversed depth wants a float.
pub(super) const DEPTHS: TextureFormat = TextureFormat::Depth32Float;

/// The closed set of shapes that have shaders of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Shape {
    Background,
    Sky,
    Faces,
    Sunlit,
    Edges,
    Balls,
    Cubes,
    Strokes,
}

impl Shape {
    /// Name and stem of the entry points, and the sources after `view.wgsl`.
    fn shader(self) -> (&'static str, &'static [&'static str]) {
        const SKYLIGHT: &str = include_str!("shaders/skylight.wgsl");
        const LOOKUP: &str = include_str!("../shadows/shaders/lookup.wgsl");
        const FACES: &str = include_str!("shaders/faces.wgsl");
        match self {
            Shape::Background => ("background", &[include_str!("shaders/background.wgsl")]),
            Shape::Sky => ("sky", &[SKYLIGHT, include_str!("shaders/sky.wgsl")]),
            Shape::Faces => ("faces", &[FACES]),
            Shape::Sunlit => ("sunlit", &[FACES, SKYLIGHT, LOOKUP, include_str!("shaders/sunlit.wgsl")]),
            Shape::Edges => ("edges", &[FACES]),
            Shape::Balls => ("balls", &[include_str!("shaders/balls.wgsl")]),
            Shape::Cubes => ("cubes", &[include_str!("shaders/cubes.wgsl")]),
            Shape::Strokes => ("strokes", &[include_str!("shaders/strokes.wgsl")]),
        }
    }

    /// Whether it stands behind everything.
    fn is_background(self) -> bool {
        matches!(self, Shape::Background | Shape::Sky)
    }

    /// A vertex's size and fields, as the shader's input has them.
    fn vertex(self) -> Option<(usize, &'static [VertexAttribute])> {
        const CORNER: [VertexAttribute; 5] =
            vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Uint32, 3 => Unorm8x4, 4 => Uint32];
        const BALL: [VertexAttribute; 4] = vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Uint32, 3 => Unorm8x4];
        const CUBE: [VertexAttribute; 4] = vertex_attr_array![0 => Float32x3, 1 => Uint32, 2 => Uint32, 3 => Unorm8x4];
        const STROKE: [VertexAttribute; 6] = vertex_attr_array![
            0 => Float32x3, 1 => Float32, 2 => Float32x3, 3 => Uint32, 4 => Unorm8x4, 5 => Uint32
        ];
        match self {
            Shape::Background | Shape::Sky => None,
            Shape::Faces | Shape::Sunlit | Shape::Edges => Some((size_of::<Corner>(), &CORNER)),
            Shape::Balls => Some((size_of::<Ball>(), &BALL)),
            Shape::Cubes => Some((size_of::<Cube>(), &CUBE)),
            Shape::Strokes => Some((size_of::<StrokeVertex>(), &STROKE)),
        }
    }
}

/// Everything that tells one pipeline from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Key {
    shape: Shape,
    scaled: bool,
    cut: bool,
    blended: bool,
}

impl Key {
    /// The one of what stands behind a picture.
    pub(super) fn background(picture: &Picture) -> Self {
        let shape = if picture.sunlight.is_some() { Shape::Sky } else { Shape::Background };
        Self { shape, scaled: false, cut: false, blended: false }
    }

    /// A batch's in its picture.
    pub(super) fn new(batch: &Batch, picture: &Picture) -> Self {
        let scaled = matches!(batch.tint, Tint::Scaled(_));
        let shape = match batch.what {
            What::Faces { style: FaceStyle::Sunlit, .. } if picture.has_shadows() && !scaled => Shape::Sunlit,
            What::Faces { style: FaceStyle::Wireframe, .. } => Shape::Edges,
            What::Faces { .. } => Shape::Faces,
            What::Balls { .. } => Shape::Balls,
            What::Cubes { .. } => Shape::Cubes,
            What::Strokes { .. } => Shape::Strokes,
        };
        Self { shape, scaled, cut: batch.cut && !picture.cuts.is_empty(), blended: batch.opacity < 1.0 }
    }

    /// Whether its shader looks shadows up.
    pub(super) fn is_sunlit(self) -> bool {
        self.shape == Shape::Sunlit
    }

    /// Whether it draws indexed rectangles.
    pub(super) fn rectangles(self) -> bool {
        matches!(self.shape, Shape::Balls | Shape::Cubes | Shape::Strokes)
    }
}

/// The pipelines made so far, and what all of them are told.
pub(super) struct Pipelines {
    pub(super) view_layout: BindGroupLayout,
    pub(super) batch_layout: BindGroupLayout,
    made: HashMap<Key, RenderPipeline>,
}

impl Pipelines {
    pub(super) fn new(device: &Device) -> Self {
        let uniform = |binding, has_dynamic_offset| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset, min_binding_size: None },
            count: None,
        };
        let maps = BindGroupLayoutEntry {
            binding: 1,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: BindingType::Texture {
                sample_type: TextureSampleType::Float { filterable: false },
                view_dimension: TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let group = |label, entries: &[BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let view_layout = group("view", &[uniform(0, false), maps, uniform(2, false)]);
        let batch_layout = group("batch", &[uniform(0, true)]);
        Self { view_layout, batch_layout, made: HashMap::new() }
    }

    /// Makes a pipeline unless it is there. A sunlit one reads maps of the layout `shadows`, and is not made without.
    pub(super) fn make(&mut self, device: &Device, key: Key, shadows: Option<&BindGroupLayout>) {
        let shadows = shadows.filter(|_| key.is_sunlit());
        if self.made.contains_key(&key) || shadows.is_some() != key.is_sunlit() {
            return;
        }
        let groups: Vec<_> = [&self.view_layout, &self.batch_layout].into_iter().chain(shadows).map(Some).collect();
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("picture"),
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        self.made.insert(key, pipeline(device, &layout, key));
    }

    /// A pipeline that was made.
    pub(super) fn get(&self, key: Key) -> Option<&RenderPipeline> {
        self.made.get(&key)
    }
}

fn pipeline(device: &Device, layout: &PipelineLayout, key: Key) -> RenderPipeline {
    let (name, sources) = key.shape.shader();
    let source = [include_str!("shaders/view.wgsl")].iter().chain(sources).copied().collect::<String>();
    let module = device
        .create_shader_module(ShaderModuleDescriptor { label: Some(name), source: ShaderSource::Wgsl(source.into()) });
    let constants = [("SCALED", f64::from(u8::from(key.scaled))), ("CUT", f64::from(u8::from(key.cut)))];
    let compilation_options = PipelineCompilationOptions { constants: &constants, ..Default::default() };
    let buffer = key.shape.vertex().map(|(size, attributes)| VertexBufferLayout {
        array_stride: size as BufferAddress,
        step_mode: VertexStepMode::Vertex,
        attributes,
    });
    let buffers: &[_] = if buffer.is_some() { &[buffer] } else { &[] };
    let (vertex_entry, fragment_entry) = (format!("{name}_vertex"), format!("{name}_fragment"));

    // Where edges fade, opaque things cover a share of a pixel's samples: no order of drawing is asked for. What is
    // transparent is blended and leaves the depth alone. The picture itself stays opaque.
    let is_background = key.shape.is_background();
    let fades = matches!(key.shape, Shape::Edges | Shape::Balls | Shape::Strokes);
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some(name),
        layout: Some(layout),
        vertex: VertexState {
            module: &module,
            entry_point: Some(&vertex_entry),
            compilation_options: compilation_options.clone(),
            buffers,
        },
        primitive: PrimitiveState::default(),
        depth_stencil: Some(DepthStencilState {
            format: DEPTHS,
            depth_write_enabled: Some(!key.blended && !is_background),
            // The background is infinitely far away.
            depth_compare: Some(CompareFunction::GreaterEqual),
            stencil: StencilState::default(),
            bias: DepthBiasState::default(),
        }),
        multisample: MultisampleState {
            count: SAMPLES,
            mask: !0,
            alpha_to_coverage_enabled: fades && !key.blended && SAMPLES > 1,
        },
        fragment: Some(FragmentState {
            module: &module,
            entry_point: Some(&fragment_entry),
            compilation_options,
            targets: &[Some(ColorTargetState {
                format: COLOURS,
                blend: key.blended.then_some(BlendState::ALPHA_BLENDING),
                write_mask: if is_background { ColorWrites::ALL } else { ColorWrites::COLOR },
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
