//! What does the skeleton keep of the curves that thinning finds?

/// What it keeps. The default is what all figures of this library were made with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Filter {
    /// Layers that an edge must outlive its birth by, at least: a curve of a few cells in a void too small to say otherwise is
    /// noise. Any value from 0 (the published rule) to 6 gives nearly the same; above, side branches go, the shortest first.
    pub least_life_layers: u32,
    /// Whether rooms hold their middles: without, a curve ends at the mouth of a dead-end room.
    pub keeps_middles: bool,
    /// Whether branches that stay inside the ball of what they leave are cut: noise on walls makes such.
    pub cuts_branches: bool,
    /// Whether dead ends grow on to their walls, which thinning stops short of.
    pub grows_ends: bool,
}

impl Filter {
    /// The most layers that [`Filter::least_life_layers`] makes sense up to: a curve that long is no noise on any wall.
    pub const MOST_LAYERS: u32 = 64;
}

impl Default for Filter {
    fn default() -> Self {
        Self { least_life_layers: 3, keeps_middles: true, cuts_branches: true, grows_ends: true }
    }
}
