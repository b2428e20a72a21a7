//! How good is an estimate, and beside what?

pub mod chart;
pub mod compare;
pub mod errors;
pub mod tolerance;
