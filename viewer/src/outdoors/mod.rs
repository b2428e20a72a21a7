//! Sun and sky: what is asked of them, and what they give.

use crate::measure::Measure;

/// Sun and sky as the panels show them.
#[derive(Debug, Clone, Default)]
pub struct OutdoorState {}

/// What is asked of sun and sky.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OutdoorRequest {}

/// What they give.
#[derive(Debug, Clone, Default)]
pub struct OutdoorResults {}

impl OutdoorResults {
    /// All values of a measure; empty where there are none.
    pub fn values(&self, _measure: Measure) -> Vec<f32> {
        Vec::new()
    }
}
