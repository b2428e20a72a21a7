//! What is on the GPU of a picture's data: one upload for each shared vector, kept while anything holds it.
//!
//! Faces go up as they are, three corners a triangle. Balls, cubes and strokes go up four times each, once for every
//! corner of the rectangle that shows them, and share one index buffer: drawing instances would leave software
//! rasterisers one rectangle at a time, and pulling from storage buffers is not to be had on every GL.
//! Long vectors are split so that no buffer comes near a device's limit.

use std::any::Any;
use std::collections::HashMap;
use std::sync::{Arc, Weak};

use bytemuck::{Pod, Zeroable};
use eframe::wgpu::util::{BufferInitDescriptor, DeviceExt};
use eframe::wgpu::{Buffer, BufferUsages, Device};

use super::picture::{Corner, Stroke, What};

/// Bytes of one buffer: a quarter of the 256 MiB that every device takes.
const MOST_BYTES: usize = 64 << 20;
/// Corners and indices of a rectangle.
const CORNERS: usize = 4;
const RECTANGLE: [u32; 6] = [0, 1, 2, 2, 1, 3];

/// Uploaded data, found by the address of what they were made from.
#[derive(Default)]
pub(super) struct Uploads {
    kept: HashMap<usize, Upload>,
    rectangles: Option<Rectangles>,
    /// Uploads so far.
    pub(super) count: usize,
}

/// One vector's buffers.
struct Upload {
    /// Keeps the address from being given to other data.
    source: Weak<dyn Any + Send + Sync>,
    parts: Vec<Part>,
}

/// One buffer.
pub(super) struct Part {
    pub(super) vertices: Buffer,
    /// Vertices to draw (faces), or indices (the rest).
    pub(super) count: u32,
}

/// The indices of as many rectangles as were ever asked for.
struct Rectangles {
    indices: Buffer,
    number: usize,
}

/// A stroke, as the numbers that its shader reads.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct StrokeVertex {
    a_m: [f32; 3],
    width_px: f32,
    b_m: [f32; 3],
    value: f32,
    colour: [u8; 4],
    kind: u32,
}

/// A stroke as its shader reads it.
fn stroke_vertex(stroke: &Stroke) -> StrokeVertex {
    StrokeVertex {
        a_m: stroke.a_m.to_array(),
        width_px: stroke.width_px,
        b_m: stroke.b_m.to_array(),
        value: stroke.value,
        colour: stroke.colour,
        kind: u32::from(stroke.dashed) | u32::from(stroke.arrow) << 1,
    }
}

impl Uploads {
    /// Uploads what is not there yet, and forgets what nothing holds any more.
    pub(super) fn update<'a>(&mut self, device: &Device, whats: impl Iterator<Item = &'a What>) {
        self.kept.retain(|_, upload| upload.source.strong_count() > 0);
        for what in whats {
            match what {
                What::Faces { data, .. } => self.keep(data, |data| {
                    let whole = data.len() - data.len() % 3;
                    let triangles = MOST_BYTES / (3 * size_of::<Corner>());
                    data[..whole].chunks(3 * triangles).map(|part| filled(device, part, part.len())).collect()
                }),
                What::Balls { data, .. } => self.keep_rectangles(device, data, |ball| *ball),
                What::Cubes { data, .. } => self.keep_rectangles(device, data, |cube| *cube),
                What::Strokes { data } => self.keep_rectangles(device, data, stroke_vertex),
            }
        }
    }

    /// The buffers of data that were uploaded.
    pub(super) fn parts(&self, what: &What) -> &[Part] {
        let address = match what {
            What::Faces { data, .. } => address(data),
            What::Balls { data, .. } => address(data),
            What::Cubes { data, .. } => address(data),
            What::Strokes { data } => address(data),
        };
        self.kept.get(&address).map_or(&[], |upload| &upload.parts)
    }

    /// The indices that draw rectangles; none before the first were uploaded.
    pub(super) fn rectangles(&self) -> Option<&Buffer> {
        self.rectangles.as_ref().map(|rectangles| &rectangles.indices)
    }

    fn keep<T: Send + Sync + 'static>(&mut self, data: &Arc<Vec<T>>, parts: impl FnOnce(&[T]) -> Vec<Part>) {
        let source: Weak<dyn Any + Send + Sync> = Arc::downgrade(data) as _;
        let count = &mut self.count;
        self.kept.entry(address(data)).or_insert_with(|| {
            *count += 1;
            Upload { source, parts: parts(data) }
        });
    }

    fn keep_rectangles<T: Send + Sync + 'static, V: Pod>(
        &mut self,
        device: &Device,
        data: &Arc<Vec<T>>,
        vertex: impl Fn(&T) -> V,
    ) {
        let most = MOST_BYTES / (CORNERS * size_of::<V>());
        self.index(device, data.len().min(most));
        self.keep(data, |data| {
            let part = |part: &[T]| {
                let vertices: Vec<V> = part.iter().flat_map(|thing| [vertex(thing); CORNERS]).collect();
                filled(device, &vertices, part.len() * RECTANGLE.len())
            };
            data.chunks(most).map(part).collect()
        });
    }

    /// Sees to indices for so many rectangles.
    fn index(&mut self, device: &Device, number: usize) {
        if self.rectangles.as_ref().is_some_and(|rectangles| rectangles.number >= number) || number == 0 {
            return;
        }
        let number = number.next_power_of_two();
        let corners =
            (0..number as u32).flat_map(|rectangle| RECTANGLE.map(|corner| CORNERS as u32 * rectangle + corner));
        let indices = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("rectangles"),
            contents: bytemuck::cast_slice(&corners.collect::<Vec<u32>>()),
            usage: BufferUsages::INDEX,
        });
        self.rectangles = Some(Rectangles { indices, number });
    }
}

/// A buffer of these vertices.
fn filled<V: Pod>(device: &Device, vertices: &[V], count: usize) -> Part {
    let vertices = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("vertices"),
        contents: bytemuck::cast_slice(vertices),
        usage: BufferUsages::VERTEX,
    });
    Part { vertices, count: count as u32 }
}

fn address<T>(data: &Arc<Vec<T>>) -> usize {
    Arc::as_ptr(data).addr()
}
