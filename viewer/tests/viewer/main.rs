//! The viewer as its user meets it.

mod app;
mod keys;
mod legend;
mod outdoors;
mod panels;
mod scene;
mod sensors;
mod shadows;
mod shot;
mod snapshots;
mod worker;
