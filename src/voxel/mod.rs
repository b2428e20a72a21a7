//! Where is matter?
//!
//! Everything on the regular grid of voxels, kept as bits: 64 voxels, a brick of 4 x 4 x 4, to a word.

pub mod bits;
pub mod brick;
pub mod chessboard;
pub mod groups;
pub mod levels;
pub mod morphology;
pub mod opening;
