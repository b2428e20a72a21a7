//! Where does the void run?
//!
//! The void is thinned to curves in the middle of its passages and rooms, with the same topology.

pub mod anchors;
pub mod collapse;
pub mod complex;
