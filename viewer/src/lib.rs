//! The window on what Lightvein finds.
#![forbid(unsafe_code)]

pub mod camera;
pub mod colour;
pub mod paint;
