//! How a picture in 3D is drawn: plain data ([`Picture`]) first, then the GPU.
//!
//! A picture says what is to be seen and holds shared data by reference counts; two pictures are equal when nothing
//! to be seen differs.

mod picture;

pub use picture::{Ball, Batch, Corner, Cube, Culling, Cut, FaceStyle, Picture, Stroke, Tint, What};
