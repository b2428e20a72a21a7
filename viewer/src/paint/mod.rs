//! How a picture in 3D is drawn: plain data ([`Picture`]) first, then the GPU.
//!
//! A picture says what is to be seen and holds shared data by reference counts; two pictures are equal when nothing
//! to be seen differs, and an equal picture is not drawn again. [`Canvas`] draws pictures into a texture, [`callback()`]
//! puts them into egui, and [`Offscreen`] makes images without a window.

mod callback;
mod canvas;
mod offscreen;
mod picture;
mod pipelines;
mod shade;
mod sunlight;
#[cfg(test)]
pub(crate) mod test_adapter;
#[cfg(test)]
mod tests;
mod uniforms;
mod upload;

pub use callback::{callback, install, work_done};
pub use canvas::Canvas;
pub use offscreen::{NoAdapter, Offscreen};
pub use picture::{Ball, Batch, Corner, Cube, Culling, Cut, FaceStyle, Picture, Stroke, Tint, What};
pub use sunlight::{Shadows, SkyLight, Sunlight};
