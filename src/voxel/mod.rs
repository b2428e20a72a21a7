//! Where is matter?
//!
//! Everything on the regular grid of voxels, kept as bits: 64 voxels, a brick of 4 x 4 x 4, to a word.

pub mod bits;
pub mod brick;
pub mod cut;
pub mod flood;
pub mod march;
pub mod memory;
pub mod morphology;
pub mod surface;
pub mod touch;
