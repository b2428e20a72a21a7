//! Lightvein finds the veins through which light flows in a 3D scene.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod job;
pub mod space;

pub mod scene;

pub mod rays;

pub mod voxel;

pub mod skeleton;

pub mod light;

pub mod model;

pub mod flow;

pub mod trace;

pub mod study;

pub mod export;

#[cfg(feature = "cli")]
pub mod cli;
