//! Where does the sun strike, in real time? Shadow maps: plain, percentage-closer, variance, layered variance, cascaded and
//! hybrid, from the same passes and apart by a few [`Settings`].
//!
//! Method: the scene's depth is drawn from the sun into one map or several; where the filter asks for it, the depth's first
//! two moments are made of it, and a point is in the sun by comparison or by Chebyshev's bound. The hybrid map of Kolivand &
//! Sunar ("Real-time outdoor rendering using hybrid shadow maps", 2012) divides what is seen by a logarithm that starts at the
//! first object and gives far layers fewer and shorter numbers.
//!
//! Limits: opaque casters only, glazing casts nothing; a sun without extent (the softness of a filter is no penumbra); at most
//! [`MOST_LAYERS`] layers.

mod settings;

pub use settings::{Classes, Filter, MOST_LAYERS, Method, Overlap, RESOLUTIONS, Settings, Split};
