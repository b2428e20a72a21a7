//! Lightvein finds the veins through which light flows in a 3D scene.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod job;
pub mod skeleton;
pub mod space;
pub mod voxel;
