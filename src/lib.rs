//! Lightvein finds the veins through which light flows in a 3D scene: it makes voxels of the scene, thins the void to a
//! skeleton of curves, and estimates on that how much light reaches every sensor, and from where.
//!
//! ```
//! use lightvein::flow::backward;
//! use lightvein::job::{Cancel, Quiet};
//! use lightvein::light::Settings;
//! use lightvein::model::Model;
//! use lightvein::rays::Rays;
//! use lightvein::scene::Scene;
//! use std::{path::Path, sync::Arc};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (progress, cancel) = (Quiet, Cancel::new());
//!
//! // Two rooms and a doorway, 60 W in the first; metres, Z up.
//! let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two_rooms/two_rooms.toml");
//! let scene = Scene::load(&path, &progress, &cancel)?;
//!
//! // Voxels of 0.1 m and the skeleton of their void, in at most 1 GB.
//! let rays = Arc::new(Rays::new(&scene));
//! let model = Model::build(&scene, rays, 0.1, 1_000_000_000, &progress, &cancel)?;
//! assert_eq!((model.skeleton.cells.len(), model.skeleton.necks.len()), (2, 1));
//! let door = &model.skeleton.necks[0];
//! println!("a door of {:.1} m2 at {:.1}", door.area_m2, scene.to_user_m(door.position_m));
//!
//! // How much light reaches the sensors, and from where.
//! let probes = model.probes_at_sensors(&scene);
//! let field = backward::estimate(&model, &probes, &Settings::default(), &progress, &cancel)?;
//! for (sensor, reading) in scene.sensors.iter().zip(&field.readings) {
//!     println!("{}: {:.3} W/m2 from {:.2}", sensor.id, reading.value_w_m2, reading.direction());
//! }
//! assert!(field.readings.iter().all(|reading| reading.value_w_m2 > 0.0));
//!
//! // How far that is from the truth: a factor.
//! let errors = lightvein::study::errors::errors(&field.readings, &scene.reference);
//! assert!(errors.rms_factor.is_some_and(|factor| factor < 5.0));
//! # Ok(())
//! # }
//! ```
//!
//! Modules stand in the order in which they may use each other. [`scene`] is what the user described, [`rays`] what a ray
//! hits, [`voxel`] where matter is, [`skeleton`] where the void runs, [`sky`] what the sun and the sky give, [`light`] the
//! question and the answer that all methods share, [`model`] all of this for one scene, [`flow`] the estimators,
//! [`mod@trace`] the path tracer that is the truth, [`daylight`] what surfaces receive of sun and sky, [`guide`] what a renderer is
//! seeded with, [`study`] how they compare, [`export`] the files that are written. Only [`scene`] and [`export`] touch files; any number of threads gives the same bits; every long step takes a
//! [`job::Progress`] and a [`job::Cancel`].
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod job;
pub mod space;

pub mod scene;

pub mod rays;

pub mod voxel;

pub mod skeleton;

pub mod sky;

pub mod light;

pub mod model;

pub mod flow;

pub mod trace;

pub mod daylight;

pub mod guide;

pub mod study;

pub mod export;

#[cfg(feature = "cli")]
pub mod cli;
