//! The shadow maps behind a canvas's pictures: drawn anew when the view, the sun, what casts or the method has changed.

use super::picture::{Corner, Picture};
use crate::shadows::{Casters, Maps, Settings, View};
use eframe::wgpu::{BindGroup, BindGroupLayout, Device, Queue};
use glam::Vec3;
use std::sync::{Arc, Weak};

/// Maps, and what they were drawn of.
pub(super) struct Shade {
    maps: Maps,
    /// What casts, and the corners that it was uploaded from.
    casters: Option<(Weak<Vec<Corner>>, Casters)>,
    drawn: Option<(View, Settings)>,
    /// Times that maps were drawn.
    pub(super) redraws: usize,
}

impl Shade {
    /// Maps that let all of the sun through.
    pub(super) fn new(device: &Device) -> Self {
        Self { maps: Maps::new(device), casters: None, drawn: None, redraws: 0 }
    }

    /// Draws the maps of a picture, unless they are those drawn last; with the sun down none are needed.
    pub(super) fn draw(&mut self, device: &Device, queue: &Queue, size_px: [u32; 2], picture: &Picture) {
        let Some(sunlight) = &picture.sunlight else { return };
        let Some(shadows) = sunlight.shadows.as_ref().filter(|_| sunlight.light.is_up()) else { return };
        let source = Arc::downgrade(&shadows.casters);
        let casters = match self.casters.take() {
            Some((known, casters)) if known.ptr_eq(&source) => casters,
            _ => {
                self.drawn = None;
                let corners_m: Vec<Vec3> = shadows.casters.iter().map(|corner| corner.position_m).collect();
                Casters::new(device, &corners_m)
            }
        };
        let view = View { camera: picture.camera, size_px, towards_sun: sunlight.light.towards_sun };
        if self.drawn != Some((view, shadows.settings)) {
            self.maps.draw(device, queue, &casters, &view, &shadows.settings);
            self.drawn = Some((view, shadows.settings));
            self.redraws += 1;
        }
        self.casters = Some((source, casters));
    }

    /// The layout of [`Shade::group`].
    pub(super) fn layout(&self) -> &BindGroupLayout {
        self.maps.layout()
    }

    /// The maps, group 2 of pipelines with `lookup.wgsl` in them.
    pub(super) fn group(&self) -> &BindGroup {
        self.maps.group()
    }
}
