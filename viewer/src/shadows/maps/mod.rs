//! Draws the maps of a view, and hands them to whoever looks points up in them.
//!
//! In this order, each step only where the method asks for it: the depths that the camera sees, read back ([`seen`]); the plan;
//! the scene's depth from the sun, once for all layers or once for each; their moments, blurred along rows and columns.
//! `shaders/lookup.wgsl` reads what comes out as group 2 of a pipeline.

mod numbers;
pub(super) mod passes;
mod seen;
mod textures;

use super::View;
use super::casters::Casters;
use super::plan::{Layer, Plan};
use super::settings::Settings;
use eframe::wgpu::*;
use numbers::{Making, STRIDE, ShadowNumbers, clip_numbers};
use passes::Passes;
use seen::Eye;
use textures::{Need, Textures};

/// The maps of one view.
pub struct Maps {
    passes: Passes,
    /// None where the card does not compute: layers are even there.
    eye: Option<Eye>,
    textures: Textures,
    numbers: Buffer,
    group: BindGroup,
    plan: Plan,
}

impl Maps {
    /// Maps that let all of the sun through. Makes a few pipelines, some milliseconds.
    pub fn new(device: &Device) -> Self {
        let passes = Passes::new(device);
        let numbers = device.create_buffer(&BufferDescriptor {
            label: Some("shadows"),
            size: size_of::<ShadowNumbers>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let textures = Textures::new(device, Need::default());
        let group = passes.lookup_group(device, &numbers, &textures);
        Self { eye: Eye::new(device), passes, textures, numbers, group, plan: Plan::default() }
    }

    /// Draws the maps of a view; submits them, and waits once for the card where a method asks what the camera sees.
    pub fn draw(&mut self, device: &Device, queue: &Queue, casters: &Casters, view: &View, settings: &Settings) {
        let most_px = device.limits().max_texture_dimension_2d;
        let settings = &Settings { resolution: settings.resolution.min(most_px), ..*settings };
        let eye = self.eye.as_mut().filter(|_| Plan::asks_depths(view, settings));
        let seen = eye.and_then(|eye| eye.seen(device, queue, casters, view));
        let plan = |bounds_m| Plan::of(view, settings, bounds_m, seen.as_ref());
        self.plan = casters.bounds_m().map(plan).unwrap_or_default();

        let need = Need::of(&self.plan, settings);
        if self.textures.need != need {
            self.textures = Textures::new(device, need);
            self.group = self.passes.lookup_group(device, &self.numbers, &self.textures);
        }
        let numbers = ShadowNumbers::new(&self.plan, view, settings);
        queue.write_buffer(&self.numbers, 0, bytemuck::bytes_of(&numbers));
        self.write_steps(queue, settings);

        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor { label: Some("shadows") });
        self.record(device, &mut encoder, casters, settings);
        queue.submit([encoder.finish()]);
    }

    /// The layout of [`Maps::group`]: group 2 of pipelines whose shader has `lookup.wgsl` in it.
    pub fn layout(&self) -> &BindGroupLayout {
        &self.passes.lookup_layout
    }

    /// The maps as shaders read them; another after each [`Maps::draw`].
    pub fn group(&self) -> &BindGroup {
        &self.group
    }

    /// What was drawn.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What all maps, moments and what lies between them hold, bytes.
    pub fn bytes(&self) -> u64 {
        self.textures.bytes()
    }

    /// What each step is told, at the place of its layer.
    fn write_steps(&self, queue: &Queue, settings: &Settings) {
        let (mut clips, mut makings) = (Vec::new(), Vec::new());
        for layer in &self.plan.layers {
            clips.extend(clip_numbers(layer.map.clip_from_scene));
            makings.extend(Making::of(layer, settings).padded());
        }
        queue.write_buffer(&self.passes.clips, 0, &clips);
        queue.write_buffer(&self.passes.makings, 0, &makings);
    }

    fn record(&self, device: &Device, encoder: &mut CommandEncoder, casters: &Casters, settings: &Settings) {
        let textures = &self.textures;
        for (number, layer) in self.plan.layers.iter().enumerate() {
            let offset = number as u32 * STRIDE;
            let depth = if !settings.split.has_map_each() {
                textures.depths.first()
            } else if layer.compares {
                textures.depths.get(place(&self.plan.layers, number))
            } else {
                textures.scratch.as_ref()
            };
            let Some(depth) = depth else { continue };
            if number == 0 || settings.split.has_map_each() {
                self.draw_depth(encoder, casters, layer, depth, offset);
            }
            if !layer.compares {
                self.make_moments(device, encoder, layer, number, depth, settings);
            }
        }
    }

    /// The scene's depth from the sun.
    fn draw_depth(
        &self,
        encoder: &mut CommandEncoder,
        casters: &Casters,
        layer: &Layer,
        depth: &TextureView,
        offset: u32,
    ) {
        let mut pass = passes::depth_pass(encoder, "shadow depth", depth, 1.0);
        // What is drawn may be a corner of a larger texture, where classes share one.
        let side = layer.map.resolution as f32;
        pass.set_viewport(0.0, 0.0, side, side, 0.0, 1.0);
        pass.set_pipeline(&self.passes.from_sun);
        pass.set_bind_group(0, &self.passes.clip_group, &[offset]);
        casters.draw(&mut pass, |bounds_m| layer.map.may_hold(bounds_m));
    }

    /// Moments of a layer: rows first, unless nothing is blurred, then columns.
    fn make_moments(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        layer: &Layer,
        number: usize,
        depth: &TextureView,
        settings: &Settings,
    ) {
        let class = layer.class as usize;
        let moments = self.textures.moments[class].views.get(place(&self.plan.layers, number));
        let (Some(moments), Some(rows)) = (moments, &self.textures.rows) else { return };
        let offset = number as u32 * STRIDE;
        let side = layer.resolution as f32;
        let mut step = |target: &TextureView, pipeline: &RenderPipeline, source: &BindGroup| {
            let mut pass = passes::moments_pass(encoder, target);
            pass.set_viewport(0.0, 0.0, side, side, 0.0, 1.0);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.passes.making_group, &[offset]);
            pass.set_bind_group(1, source, &[]);
            pass.draw(0..3, 0..1);
        };
        let [rows_32, rows_own, columns_own] = self.passes.moments(layer.class);
        if settings.blurred {
            step(rows, rows_32, &self.passes.source_group(device, depth, &self.textures.nothing));
            step(moments, columns_own, &self.passes.source_group(device, &self.textures.no_depth, rows));
        } else {
            step(moments, rows_own, &self.passes.source_group(device, depth, &self.textures.nothing));
        }
    }
}

/// A layer's place among the maps, or among the moments of its class.
fn place(layers: &[Layer], number: usize) -> usize {
    let Some(layer) = layers.get(number) else { return 0 };
    let is_alike = |other: &&Layer| other.compares == layer.compares && (layer.compares || other.class == layer.class);
    layers[..number].iter().filter(is_alike).count()
}
