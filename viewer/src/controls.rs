//! Which keys and mouse buttons do what: one table, which input and the help sheet both read.

use serde::{Deserialize, Serialize};

/// A set of controls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Preset {
    /// Left orbits, right or middle pans.
    #[default]
    Lightvein,
    /// As Blender has it: middle orbits, Shift and middle pans, left picks.
    Blender,
}
