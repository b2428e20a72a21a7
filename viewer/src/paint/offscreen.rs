//! Drawing without a window or a display: pictures, and whole user interfaces, into images.

use std::fmt;
use std::sync::mpsc;
use std::time::Duration;

use anyhow::{Context as _, Result, anyhow};
use eframe::egui::{self, Pos2, Rect, Vec2};
use eframe::egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor, WgpuConfiguration, WgpuSetup};
use eframe::wgpu::*;
use image::RgbaImage;

use super::canvas::Canvas;
use super::{callback, picture::Picture};

/// Frames that a user interface gets to settle its layout and its short animations.
const MOST_FRAMES: usize = 16;
/// Time that passes from one such frame to the next: animations end soon.
const FRAME_S: f64 = 0.1;
/// How long the card may take for one image before it counts as lost.
const MOST_WAIT: Duration = Duration::from_secs(60);

/// A graphics adapter with nothing to show on.
pub struct Offscreen {
    state: RenderState,
    canvas: Canvas,
    context: egui::Context,
    time_s: f64,
}

/// Why there is no graphics adapter.
#[derive(Debug)]
pub struct NoAdapter {
    cause: String,
}

impl fmt::Display for NoAdapter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "no graphics adapter: {}. Install a Vulkan driver (Debian's mesa-vulkan-drivers has one in software), or use \
             the program `lightvein`, which computes and exports the same without one",
            self.cause.trim_end_matches('.')
        )
    }
}

impl std::error::Error for NoAdapter {}

impl Offscreen {
    /// Opens the best adapter there is, a software one if need be.
    ///
    /// # Errors
    /// Where there is none, or it does not open.
    pub fn new() -> Result<Self, NoAdapter> {
        // OpenGL last: without a display its probe complains on stderr.
        Self::of(Backends::PRIMARY).or_else(|_| Self::of(Backends::all()))
    }

    fn of(backends: Backends) -> Result<Self, NoAdapter> {
        let mut wgpu_setup = WgpuSetup::without_display_handle();
        if let WgpuSetup::CreateNew(create) = &mut wgpu_setup {
            create.instance_descriptor.backends = backends;
        }
        let instance = pollster::block_on(wgpu_setup.new_instance());
        let configuration = WgpuConfiguration { wgpu_setup, ..Default::default() };
        let options = RendererOptions { dithering: false, ..Default::default() };
        let state = pollster::block_on(RenderState::create(&configuration, &instance, None, options));
        let state = state.map_err(|error| NoAdapter { cause: error.to_string() })?;
        callback::install(&state);
        let canvas = Canvas::new(&state.device, &state.queue);
        Ok(Self { state, canvas, context: egui::Context::default(), time_s: 0.0 })
    }

    /// The adapter's name and driver, as benchmarks state it.
    pub fn adapter(&self) -> String {
        let info = self.state.adapter.get_info();
        format!("{} ({:?})", info.name, info.backend)
    }

    /// The context that [`Offscreen::render_ui`] runs: for fonts, themes and styles.
    pub fn context(&self) -> &egui::Context {
        &self.context
    }

    /// What eframe hands to an app: for apps that install callbacks themselves.
    pub fn render_state(&self) -> &RenderState {
        &self.state
    }

    /// The canvas that [`Offscreen::draw`] draws on.
    pub fn canvas(&self) -> &Canvas {
        &self.canvas
    }

    /// Draws a picture and waits until it is done, without reading it.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn draw(&mut self, picture: &Picture, size_px: [u32; 2]) -> Result<()> {
        let RenderState { device, queue, .. } = &self.state;
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        self.canvas.draw(device, queue, &mut encoder, size_px, picture);
        queue.submit([encoder.finish()]);
        wait(device)
    }

    /// Waits until all that was submitted is done.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn wait(&self) -> Result<()> {
        wait(&self.state.device)
    }

    /// The bytes of a texture that can be copied from, rows from the top without gaps.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn read_bytes(&self, texture: &Texture) -> Result<Vec<u8>> {
        read_bytes(&self.state, texture)
    }

    /// A picture as an image.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn render_picture(&mut self, picture: &Picture, size_px: [u32; 2]) -> Result<RgbaImage> {
        self.draw(picture, size_px)?;
        let drawn = self.canvas.picture().context("nothing was drawn")?;
        read(&self.state, drawn)
    }

    /// A user interface as an image: run frame by frame until it asks for no further one, at most 16 times.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn render_ui(
        &mut self,
        size_px: [u32; 2],
        pixels_per_point: f32,
        mut run: impl FnMut(&mut egui::Ui),
    ) -> Result<RgbaImage> {
        let size_px = size_px.map(|pixels| pixels.clamp(1, self.state.device.limits().max_texture_dimension_2d));
        let mut textures = egui::TexturesDelta::default();
        for frame in 1.. {
            let output = self.context.clone().run_ui(self.input(size_px, pixels_per_point), &mut run);
            textures.append(output.textures_delta);
            let at_once = output.viewport_output.values().any(|viewport| viewport.repaint_delay.is_zero());
            if frame < MOST_FRAMES && (at_once || frame == 1) {
                continue;
            }
            let shapes = self.context.tessellate(output.shapes, pixels_per_point);
            return self.paint(size_px, pixels_per_point, textures, &shapes);
        }
        Err(anyhow!("no frame was run"))
    }

    /// A frame's input: no events, only time and size.
    fn input(&mut self, size_px: [u32; 2], pixels_per_point: f32) -> egui::RawInput {
        self.time_s += FRAME_S;
        let size = Vec2::new(size_px[0] as f32, size_px[1] as f32) / pixels_per_point;
        let mut input = egui::RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            max_texture_side: Some(self.state.device.limits().max_texture_dimension_2d as usize),
            time: Some(self.time_s),
            focused: true,
            ..Default::default()
        };
        if let Some(viewport) = input.viewports.get_mut(&egui::ViewportId::ROOT) {
            viewport.native_pixels_per_point = Some(pixels_per_point);
        }
        input
    }

    /// Draws one frame of egui and reads it.
    fn paint(
        &self,
        size_px: [u32; 2],
        pixels_per_point: f32,
        mut textures: egui::TexturesDelta,
        shapes: &[egui::ClippedPrimitive],
    ) -> Result<RgbaImage> {
        let RenderState { device, queue, renderer, target_format, .. } = &self.state;
        let mut renderer = renderer.write();
        for (id, images) in textures.set.drain() {
            for image in images {
                renderer.update_texture(device, queue, id, &image);
            }
        }
        let target = device.create_texture(&TextureDescriptor {
            label: Some("user interface"),
            size: Extent3d { width: size_px[0], height: size_px[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: *target_format,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = target.create_view(&TextureViewDescriptor::default());

        let screen = ScreenDescriptor { size_in_pixels: size_px, pixels_per_point };
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        let before = renderer.update_buffers(device, queue, &mut encoder, shapes, &screen);
        let pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("user interface"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store },
            })],
            ..Default::default()
        });
        renderer.render(&mut pass.forget_lifetime(), shapes, &screen);
        queue.submit(before.into_iter().chain([encoder.finish()]));
        for id in textures.free.drain() {
            renderer.free_texture(&id);
        }
        drop(renderer);
        read(&self.state, &target)
    }
}

/// Waits until all that was submitted is done.
fn wait(device: &Device) -> Result<()> {
    device.poll(PollType::Wait { submission_index: None, timeout: Some(MOST_WAIT) })?;
    Ok(())
}

/// Reads a texture of four bytes a pixel as an image.
fn read(state: &RenderState, texture: &Texture) -> Result<RgbaImage> {
    let pixels = read_bytes(state, texture)?;
    RgbaImage::from_raw(texture.width(), texture.height(), pixels).context("the image read is too short")
}

/// Reads a texture.
fn read_bytes(state: &RenderState, texture: &Texture) -> Result<Vec<u8>> {
    let RenderState { device, queue, .. } = state;
    let (width, height) = (texture.width(), texture.height());
    let pixel_bytes = texture.format().block_copy_size(None).context("the texture has no pixels to read")?;
    let row_bytes = (pixel_bytes * width) as usize;
    let padded_bytes = row_bytes.next_multiple_of(COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let buffer = device.create_buffer(&BufferDescriptor {
        label: Some("image"),
        size: (padded_bytes * height as usize) as u64,
        usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
    let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_bytes as u32), rows_per_image: None };
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        TexelCopyBufferInfo { buffer: &buffer, layout },
        texture.size(),
    );
    queue.submit([encoder.finish()]);

    let (sender, receiver) = mpsc::channel();
    buffer.map_async(MapMode::Read, .., move |mapped| drop(sender.send(mapped)));
    wait(device)?;
    receiver.recv()??;
    let mapped = buffer.get_mapped_range(..)?;
    Ok(mapped.chunks(padded_bytes).flat_map(|row| &row[..row_bytes]).copied().collect())
}
