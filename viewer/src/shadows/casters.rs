//! The triangles that cast shadows, on the GPU, sorted into compact chunks: what lies beside a map is not drawn into it.

use eframe::wgpu::util::{BufferInitDescriptor, DeviceExt};
use eframe::wgpu::{Buffer, BufferUsages, Device, RenderPass};
use glam::Vec3;
use std::ops::Range;

/// Triangles of a chunk: enough that a draw call costs less than what it draws.
const CHUNK: usize = 512;
/// Bytes of one buffer: a quarter of the 256 MiB that every device takes, and whole triangles.
const MOST_BYTES: usize = 36 * CHUNK * 3640;

/// Triangles on the GPU.
pub struct Casters {
    buffers: Vec<Buffer>,
    chunks: Vec<Chunk>,
}

/// Triangles that lie together.
struct Chunk {
    buffer: usize,
    vertices: Range<u32>,
    bounds_m: (Vec3, Vec3),
}

impl Casters {
    /// Uploads triangles, three corners each; a last incomplete one is left out. About 0.1 ms for a thousand.
    pub fn new(device: &Device, corners_m: &[Vec3]) -> Self {
        let (triangles, _) = corners_m.as_chunks::<3>();
        let sorted = along_a_curve(triangles);
        let per_buffer = MOST_BYTES / size_of::<[Vec3; 3]>();
        let (mut buffers, mut chunks) = (Vec::new(), Vec::new());
        for part in sorted.chunks(per_buffer) {
            let mut first = 0;
            for chunk in part.chunks(CHUNK) {
                let vertices = first..first + 3 * chunk.len() as u32;
                first = vertices.end;
                chunks.extend(bounds_m(chunk.as_flattened()).map(|bounds_m| Chunk {
                    buffer: buffers.len(),
                    vertices,
                    bounds_m,
                }));
            }
            buffers.push(device.create_buffer_init(&BufferInitDescriptor {
                label: Some("casters"),
                contents: bytemuck::cast_slice(part.as_flattened()),
                usage: BufferUsages::VERTEX,
            }));
        }
        Self { buffers, chunks }
    }

    /// Around all of them; none where there are none.
    pub fn bounds_m(&self) -> Option<(Vec3, Vec3)> {
        let bounds = self.chunks.iter().map(|chunk| chunk.bounds_m);
        bounds.reduce(|(low_m, high_m), (low, high)| (low_m.min(low), high_m.max(high)))
    }

    /// Draws the chunks whose bounds are wanted; a pipeline that takes positions is set.
    pub(super) fn draw(&self, pass: &mut RenderPass<'_>, wanted: impl Fn((Vec3, Vec3)) -> bool) {
        let mut bound = None;
        for chunk in self.chunks.iter().filter(|chunk| wanted(chunk.bounds_m)) {
            let Some(buffer) = self.buffers.get(chunk.buffer) else { continue };
            if bound.replace(chunk.buffer) != Some(chunk.buffer) {
                pass.set_vertex_buffer(0, buffer.slice(..));
            }
            pass.draw(chunk.vertices.clone(), 0..1);
        }
    }
}

fn bounds_m(points_m: &[Vec3]) -> Option<(Vec3, Vec3)> {
    let bounds = points_m.iter().map(|point| (*point, *point));
    bounds.reduce(|(low_m, high_m), (low, high)| (low_m.min(low), high_m.max(high)))
}

/// Triangles in the order of Morton's curve through their middles, 10 bits an axis: neighbours in space are neighbours in it.
/// Those that are somewhere infinite are left out.
fn along_a_curve(triangles: &[[Vec3; 3]]) -> Vec<[Vec3; 3]> {
    let is_somewhere = |corners: &&[Vec3; 3]| corners.iter().all(|at| at.is_finite());
    let triangles: Vec<[Vec3; 3]> = triangles.iter().filter(is_somewhere).copied().collect();
    let (low_m, high_m) = bounds_m(triangles.as_flattened()).unwrap_or_default();
    let cells = 1023.0 / (high_m - low_m).max_element().max(f32::MIN_POSITIVE);
    let place = |corners: &[Vec3; 3]| {
        let middle = (corners.iter().sum::<Vec3>() / 3.0 - low_m) * cells;
        middle.to_array().iter().enumerate().map(|(axis, cell)| spread(*cell as u32) << axis).sum::<u32>()
    };
    let mut sorted: Vec<(u32, [Vec3; 3])> = triangles.iter().map(|corners| (place(corners), *corners)).collect();
    sorted.sort_by_key(|(place, _)| *place);
    sorted.into_iter().map(|(_, corners)| corners).collect()
}

/// Puts two zeros after each of ten bits.
fn spread(bits: u32) -> u32 {
    (0..10).map(|bit| (bits >> bit & 1) << (3 * bit)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread_and_neighbours_stay_together() {
        assert_eq!([spread(0b111), spread(1023)], [0b100_1001, 0o1_111_111_111]);
        let at = |x: f32| [Vec3::new(x, 0.0, 0.0), Vec3::new(x, 1.0, 0.0), Vec3::new(x, 0.0, 1.0)];
        let mixed = [at(90.0), at(1.0), at(91.0), at(0.0), [Vec3::NAN; 3]];
        let xs: Vec<f32> = along_a_curve(&mixed).iter().map(|corners| corners[0].x).collect();
        assert_eq!(xs, [0.0, 1.0, 90.0, 91.0]);
    }
}
