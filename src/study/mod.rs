//! How good is an estimate, and beside what? How far does it move when nothing should move it?

pub mod chart;
pub mod compare;
pub mod errors;
pub mod stress;
pub mod tolerance;
