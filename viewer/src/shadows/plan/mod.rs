//! Which maps does a view need: what each covers, how fine it is, and how the scene is turned into it?
//!
//! Light space: x and y across the sun's rays, z along them, metres; y follows the camera's gaze, so that the visible, which is
//! long and narrow, lies along the map's sides. What the camera sees (its frustum cut with the scene's bounds) is divided
//! ([`partition`]) and each part boxed ([`fit`]); a map reaches from the box towards the sun as far as the scene does.

mod fit;
mod partition;

pub use fit::{LightMap, may_see};
pub use partition::Seen;

use super::View;
use super::settings::{Class, Classes, Settings, Split};
use fit::{Basis, Box3, depths_m, visible};
use glam::Vec3;

/// How far a layer reaches into the next one, as a share of its own length.
const OVERLAP: f32 = 0.1;

/// What a scene's bounds are made wider by, as a share of the longest.
const THICKNESS: f32 = 1e-4;

/// Texels of class A a side of one of class C.
const FEWEST: u32 = 4;

/// Least variance of moments, as a share of the layer's range squared: what rounding leaves of 32 bits, and of 16 where the
/// range is stored from -1 to 1.
const LEAST_VARIANCE: [f32; 2] = [1e-6, 2.5e-4];

/// The maps of a view.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Plan {
    /// From the nearest on; empty where nothing is seen.
    pub layers: Vec<Layer>,
}

/// One layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Where it begins, in the depth that is divided: metres from the camera along its gaze, or metres along the sun's rays
    /// from the map's nearest.
    pub from_m: f32,
    /// Where the next begins.
    pub to_m: f32,
    /// Where it ends, beyond the beginning of the next.
    pub until_m: f32,
    /// How fine it is.
    pub class: Class,
    /// Whether depths are compared with; else moments are asked.
    pub compares: bool,
    /// Texels a side.
    pub resolution: u32,
    /// Where its texels lie.
    pub map: LightMap,
    /// Depths of the map, 0 to 1, that its moments tell apart: nearer ones and farther ones are clamped to these.
    pub range: [f32; 2],
    /// Least variance of moments whose range goes from -1 to 1.
    pub least_variance: f32,
}

impl Layer {
    /// A texel of what is looked up, metres.
    pub fn texel_m(&self) -> f32 {
        self.map.texel_m * self.map.resolution as f32 / self.resolution as f32
    }
}

impl Plan {
    /// Plans the maps of a view. `bounds_m` holds all casters; `seen` is what the camera's depths are, which only logarithms ask.
    pub fn of(view: &View, settings: &Settings, bounds_m: (Vec3, Vec3), seen: Option<&Seen>) -> Self {
        Self::of_visible(view, settings, thick(bounds_m), seen).unwrap_or_default()
    }

    fn of_visible(view: &View, settings: &Settings, bounds_m: (Vec3, Vec3), seen: Option<&Seen>) -> Option<Self> {
        let basis = Basis::new(view);
        let whole = visible(view, bounds_m, depths_m(view, bounds_m)?);
        let part = Box3::of(&whole, &basis)?;
        let depths = Box3::depths_m(&whole, &view.camera)?;
        let scene = Box3::of_bounds(bounds_m, &basis);

        if settings.split.has_map_each() {
            let bounds = partition::by_camera(settings, depths, seen, !view.camera.orthographic);
            let classes = partition::classes(settings, &bounds, seen);
            let layer = |(ends, class): (&[f32], &Class)| {
                let &[from_m, to_m] = ends else { return None };
                let until_m = reach(settings, from_m, to_m);
                let inside = visible(view, bounds_m, [from_m, until_m]);
                let part = Box3::of(&inside, &basis)?;
                Some(layer(settings, *class, [from_m, to_m, until_m], &part, &scene, &basis, [part.low.z, part.high.z]))
            };
            return Some(Self { layers: bounds.windows(2).zip(&classes).filter_map(layer).collect() });
        }

        let bounds = partition::by_light(settings, [part.low.z, part.high.z], seen);
        let classes = partition::classes_by_light(settings, bounds.len() - 1, seen);
        let layer = |(ends, class): (&[f32], &Class)| {
            let &[from_m, to_m] = ends else { return None };
            let until_m = reach(settings, from_m, to_m);
            // What lies just before the layer stays apart from what lies at its beginning.
            let before_m = from_m - OVERLAP * (to_m - from_m);
            let mut layer =
                layer(settings, *class, [from_m, to_m, until_m], &part, &scene, &basis, [before_m, until_m]);
            for metres in [&mut layer.from_m, &mut layer.to_m, &mut layer.until_m] {
                *metres -= layer.map.nearest_m;
            }
            Some(layer)
        };
        Some(Self { layers: bounds.windows(2).zip(&classes).filter_map(layer).collect() })
    }

    /// Whether a plan asks what the camera sees.
    pub fn asks_depths(view: &View, settings: &Settings) -> bool {
        let is_logarithm = matches!(settings.split, Split::CameraLogarithm | Split::LightLogarithm);
        is_logarithm && settings.layers > 1 && !view.camera.orthographic
    }
}

/// Bounds that have an inside, however flat the scene is.
fn thick((low_m, high_m): (Vec3, Vec3)) -> (Vec3, Vec3) {
    let margin_m = Vec3::splat(THICKNESS * (high_m - low_m).max_element().max(THICKNESS));
    (low_m - margin_m, high_m + margin_m)
}

/// Where a layer ends: beyond the next one's beginning, for filters and for what both answer.
fn reach(settings: &Settings, from_m: f32, to_m: f32) -> f32 {
    let share = if settings.split == Split::Whole { 0.0 } else { OVERLAP };
    to_m + share * (to_m - from_m)
}

fn layer(
    settings: &Settings,
    class: Class,
    [from_m, to_m, until_m]: [f32; 3],
    part: &Box3,
    scene: &Box3,
    basis: &Basis,
    range_m: [f32; 2],
) -> Layer {
    let compares = settings.filter.compares(class);
    let shared = !settings.split.has_map_each();
    // A map that layers share has the first class's texels, whole ones of the last class too: of so many depths each of its moments
    // is made.
    let has_classes = settings.classes != Classes::One;
    let of_a = if shared && has_classes { settings.resolution / FEWEST * FEWEST } else { settings.resolution };
    let resolution = class.resolution(of_a);
    let of_map = if shared { of_a } else { resolution };
    let map = LightMap::new(part, scene, basis, of_map);
    Layer {
        from_m,
        to_m,
        until_m,
        class,
        compares,
        resolution: if compares { of_map } else { resolution },
        map,
        range: range_m.map(|metres| map.depth(metres)),
        least_variance: LEAST_VARIANCE[usize::from(class != Class::A)],
    }
}

#[cfg(test)]
mod tests;
