//! The window on what Lightvein finds: voxels, skeleton, flux, sun and exposure, seen and touched.
//!
//! It shows what the library computes and computes nothing of its own but the shadows of its pictures, which it holds to
//! rays. A [`request::Request`] is what was asked, the [`worker`] answers it on a thread of its own with [`results::Results`],
//! [`layers`] say what is shown of them, `draw` turns that into a [`paint::Picture`], and [`paint`] puts it on the screen.
//! [`state::State`] holds all of this; panels are functions that show it and change it.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod app;
pub mod args;
pub mod camera;
pub mod colour;
pub mod controls;
pub mod draw;
pub mod layers;
pub mod legend;
pub mod log;
pub mod measure;
pub mod outdoors;
pub mod paint;
pub mod panels;
pub mod pick;
pub mod request;
pub mod results;
pub mod shadows;
pub mod shot;
pub mod sides;
pub mod stamp;
pub mod state;
pub mod theme;
pub mod view;
pub mod ways;
pub mod welcome;
pub mod worker;
