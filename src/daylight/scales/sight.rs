//! Between which heights does a point see the sky, in one direction of the horizon?
//!
//! The large scale of Muñoz-Pandiella et al. 2017: the map of heights is read along the direction, and the steepest slope to
//! what stands there is the horizon. Over a point that something covers, the map shows the cover; the sky is seen beneath it
//! up to the opening angle, taken right before the first sample that is lower than the point. With the peeled map each
//! [`Span`] of matter covers the elevations between its sides, and the sky is seen in what is left: any number of bands.
//!
//! Samples lie ever farther apart, as wide as a share of their distance, and never nearer than a texel. A height that jumps up
//! between two samples is taken to do so half-way. What lies behind the plane of the point's surface does not count: it is the
//! point's own wall, cut by texels.
//!
//! Limits: bands are told to 1/64 of the sine of their elevation where something floats; what is thinner than the distance of
//! two samples may be missed.

use super::zenith::{Level, NOTHING_M, Span, Zenith};
use glam::{Vec2, Vec3};

/// A slope steeper than this between two samples is a wall: 63 degrees, steeper than most roofs.
const WALL_SLOPE: f32 = 2.0;

/// Nearer along than this, in texels, a sample's texel is the point's own.
const NEAREST_TEXELS: f32 = 0.25;

/// Elevations that are told apart under what floats, evenly by their sine.
const STEPS: u32 = u64::BITS;

/// What stands in the way: how samples are spread along a direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Rings {
    /// The distance of each sample, metres, and those up to which it stands for what is there, ascending.
    rings: Vec<Ring>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Ring {
    near_m: f32,
    middle_m: f32,
    far_m: f32,
    /// The level of the map it is read from, whose texels are no wider.
    level: u32,
}

impl Rings {
    /// At most `samples` of them, out to `reach_m`: one a texel near the point, then farther apart in
    /// proportion to the distance. `turn`, 0 to 1, places each sample in its ring; 0.5 in the middle.
    pub fn new(zenith: &Zenith, samples: usize, reach_m: f32, turn: f32) -> Self {
        let texel_m = zenith.texel_m;
        let samples = samples.max(1);
        let reach_m = reach_m.max(texel_m);
        let edges = |growth: f32| {
            let next = move |&edge_m: &f32| Some(edge_m + texel_m.max(growth * edge_m));
            std::iter::successors(Some(0.5 * texel_m), next).take(samples + 1)
        };
        // The least growth that reaches out, by halves.
        let (mut low, mut high) = (0.0_f32, 2.0 * reach_m / texel_m);
        for _ in 0..32 {
            let growth = 0.5 * (low + high);
            let reaches = edges(growth).last().is_some_and(|edge_m| edge_m >= reach_m);
            if reaches { high = growth } else { low = growth }
        }
        let edges: Vec<f32> = edges(high).collect();
        let ring = |edge: &[f32]| Ring {
            near_m: edge[0],
            middle_m: edge[0] + turn.clamp(0.0, 1.0) * (edge[1] - edge[0]),
            far_m: edge[1],
            level: zenith.level_of(edge[1] - edge[0]) as u32,
        };
        let inside = |ring: &Ring| ring.near_m < reach_m;
        Self { rings: edges.windows(2).map(ring).take_while(inside).collect() }
    }

    /// The level of the map and the distance of each sample, metres.
    pub fn places(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.rings.iter().map(|ring| (ring.level as usize, ring.middle_m))
    }

    /// How many samples there are.
    pub fn len(&self) -> usize {
        self.rings.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rings.is_empty()
    }
}

/// What is made of things that stand over a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Overhangs {
    /// The map is a height field: under a cover no sky is seen.
    Ignored,
    /// The sky is seen beneath a cover up to the opening angle.
    Opening,
    /// Every span of a peeled map covers what it covers.
    Peeled,
}

/// A band of visible sky by the sines of its elevations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Its lower edge.
    pub low: f32,
    /// Its upper edge.
    pub high: f32,
}

/// The sine of the elevation of a slope.
pub fn sine_of_slope(slope: f32) -> f32 {
    if slope.is_infinite() { slope.signum() } else { slope / (1.0 + slope * slope).sqrt() }
}

/// Calls `see` with each band of sky that a point sees along the unit vector `along`, from below to above: between the slopes
/// `from` and `to`, those of the plane it lies on.
pub fn bands(
    zenith: &Zenith,
    rings: &Rings,
    overhangs: Overhangs,
    point: &super::Seer,
    along: Vec2,
    [from, to]: [f32; 2],
    see: impl FnMut(Band),
) {
    let seen = match overhangs {
        Overhangs::Peeled => peeled(zenith, rings, point, along),
        _ => heights(zenith, rings, overhangs, point, along),
    };
    let (low, high) = (sine_of_slope(seen.low.max(from).max(0.0)), sine_of_slope(seen.high.min(to)));
    each_open(!seen.covered, low, high, see);
}

/// Calls `see` with each band of the open elevations, which are told apart evenly by their sine, between two sines.
pub fn each_open(mut open: u64, low: f32, high: f32, mut see: impl FnMut(Band)) {
    while open != 0 && low < high {
        let first = open.trailing_zeros();
        let count = (open >> first).trailing_ones();
        let edge = |step: u32| step as f32 / STEPS as f32;
        let band = Band { low: edge(first).max(low), high: edge(first + count).min(high) };
        if band.low < band.high {
            see(band);
        }
        open = if first + count < STEPS { open & (u64::MAX << (first + count)) } else { 0 };
    }
}

/// What is left open along a direction: above one slope and below another, less some elevations.
#[derive(Debug, Clone, Copy)]
struct Seen {
    low: f32,
    high: f32,
    covered: u64,
}

/// A sample that lies on the map: where, how far off its middle lies, and how far along.
struct Sample<'a> {
    level: &'a Level,
    texel: usize,
    ring: &'a Ring,
    along_m: f32,
    off_m: Vec2,
}

/// The samples along a direction that lie on the map, the nearest first.
#[inline]
fn samples<'a>(
    zenith: &'a Zenith,
    rings: &'a Rings,
    point: &'a super::Seer,
    along: Vec2,
) -> impl Iterator<Item = Sample<'a>> + 'a {
    let step = along / zenith.texel_m;
    let sample = move |ring: &'a Ring| {
        let level = zenith.levels.get(ring.level as usize)?;
        // Left of the map and below it lies no texel but, within one, that on its edge.
        let at = (point.at + step * ring.middle_m).to_array().map(|at| at as i32 >> ring.level);
        let texel = level.texel(at[0], at[1])?;
        // A texel of a thin level is the one of the finest below and left of its middle.
        let middle = at.map(|at| ((at << ring.level) + (1 << ring.level) - 1) as f32 + 0.5);
        let off_m = (Vec2::from(middle) - point.at) * zenith.texel_m;
        Some(Sample { level, texel, ring, along_m: off_m.dot(along), off_m })
    };
    let nearest_m = NEAREST_TEXELS * zenith.texel_m;
    rings.rings.iter().map_while(sample).filter(move |sample| sample.along_m > nearest_m)
}

/// The horizon so far, and the sample before.
#[derive(Debug, Clone, Copy)]
struct Horizon {
    low: f32,
    before_m: f32,
    before_along_m: f32,
}

impl Horizon {
    const LEVEL: Self = Self { low: f32::NEG_INFINITY, before_m: 0.0, before_along_m: 0.0 };

    /// Raises it by what stands so high above the point so far along: half-way to the sample before if it rises there like a wall.
    #[inline]
    fn raise(&mut self, rise_m: f32, along_m: f32) {
        let step_m = along_m - self.before_along_m;
        let is_wall = rise_m - self.before_m > WALL_SLOPE * step_m;
        let at_m = if is_wall { along_m - 0.5 * step_m } else { along_m };
        if rise_m > self.low * at_m {
            self.low = rise_m / at_m;
        }
        (self.before_m, self.before_along_m) = (rise_m, along_m);
    }
}

/// By the highest surfaces.
fn heights(zenith: &Zenith, rings: &Rings, overhangs: Overhangs, point: &super::Seer, along: Vec2) -> Seen {
    let z_m = point.position_m.z;
    let mut is_covered = overhangs == Overhangs::Opening && point.covered;
    let (mut horizon, mut high) = (Horizon::LEVEL, f32::INFINITY);
    let highest_m = zenith.highest_m - z_m;
    for Sample { level, texel, along_m, off_m, .. } in samples(zenith, rings, point, along) {
        // Nothing that is left can rise above the horizon.
        if highest_m < horizon.low * along_m {
            break;
        }
        let rise_m = level.top_m[texel] - z_m;
        if !point.is_before(off_m, rise_m) {
            continue;
        }
        if is_covered {
            is_covered = rise_m > 0.0;
            high = if is_covered { rise_m / along_m } else { high };
            (horizon.before_m, horizon.before_along_m) = (rise_m, along_m);
        } else {
            horizon.raise(rise_m, along_m);
        }
    }
    let covered = if is_covered { u64::MAX } else { 0 };
    Seen { low: horizon.low, high, covered }
}

/// By all spans of matter.
fn peeled(zenith: &Zenith, rings: &Rings, point: &super::Seer, along: Vec2) -> Seen {
    let z_m = point.position_m.z;
    let (mut horizon, mut covered) = (Horizon::LEVEL, 0_u64);
    let highest_m = zenith.highest_m - z_m;
    for Sample { level, texel, ring, along_m, off_m } in samples(zenith, rings, point, along) {
        if highest_m < horizon.low * ring.near_m {
            break;
        }
        let (ground_m, spans) = level.column(texel);
        let rise_m = ground_m - z_m;
        if point.is_before(off_m, rise_m) {
            horizon.raise(rise_m, along_m);
        }
        for span in spans {
            if point.is_before(off_m, span.top_m - z_m) {
                covered |= cover(span, z_m, ring);
            }
        }
    }
    Seen { low: horizon.low, high: f32::INFINITY, covered }
}

/// The elevations that a span covers all through its ring.
fn cover(span: &Span, z_m: f32, ring: &Ring) -> u64 {
    let [under_m, over_m] = [span.bottom_m - z_m, span.top_m - z_m];
    if over_m <= 0.0 {
        return 0;
    }
    let low = under_m / (if under_m > 0.0 { ring.far_m } else { ring.near_m });
    between(sine_of_slope(low), sine_of_slope(over_m / ring.near_m))
}

/// The elevations between two sines.
pub fn between(low: f32, high: f32) -> u64 {
    // Rounds to the nearest.
    let step = |sine: f32| ((sine.max(0.0) * STEPS as f32 + 0.5) as u32).min(STEPS);
    let below = |step: u32| if step >= STEPS { u64::MAX } else { (1 << step) - 1 };
    below(step(high)) & !below(step(low))
}

impl super::Seer {
    /// Whether something lies in front of the surface that the point lies on.
    #[inline]
    fn is_before(&self, off_m: Vec2, rise_m: f32) -> bool {
        rise_m > NOTHING_M && self.normal.is_none_or(|normal| normal.dot(Vec3::new(off_m.x, off_m.y, rise_m)) > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_reach_out_and_grow() {
        let size = [1024, 1024];
        let mut levels = vec![Level::default(); 5];
        levels.iter_mut().enumerate().for_each(|(at, level)| level.size = size.map(|side| side >> at));
        let zenith = Zenith { corner_m: Vec2::ZERO, texel_m: 0.25, highest_m: 0.0, levels };
        for (samples, reach_m) in [(1, 10.0), (8, 100.0), (64, 100.0), (4096, 100.0)] {
            let rings = Rings::new(&zenith, samples, reach_m, 0.5).rings;
            assert!(rings.len() <= samples && rings[0].near_m == 0.125);
            assert!(rings.last().unwrap().far_m >= reach_m * 0.999, "{samples}");
            for pair in rings.windows(2) {
                assert_eq!(pair[0].far_m, pair[1].near_m);
                let [a, b] = [pair[0], pair[1]].map(|ring| ring.far_m - ring.near_m);
                assert!(b >= a * 0.999 && a >= 0.2499);
            }
            assert!(rings.iter().all(|ring| {
                let texel_m = 0.25 * (1 << ring.level) as f32;
                texel_m <= 1.0001 * (ring.far_m - ring.near_m) || ring.level == 0
            }));
        }
    }

    #[test]
    fn a_span_covers_the_elevations_between_its_sides() {
        let ring = Ring { near_m: 1.0, middle_m: 1.0, far_m: 1.0, level: 0 };
        let cover = |bottom_m: f32, top_m: f32| cover(&Span { bottom_m, top_m }, 10.0, &ring);
        // 30 degrees is half the sine, 90 all of it.
        let at = |degrees: f32| 10.0 + degrees.to_radians().tan();
        assert_eq!(cover(at(30.0), f32::INFINITY), u64::MAX << 32);
        assert_eq!(cover(9.0, at(30.0)), u64::MAX >> 32);
        assert_eq!(cover(5.0, 9.9), 0);
        assert_eq!(cover(at(0.0), f32::INFINITY), u64::MAX);
        assert_eq!(cover(at(30.0), at(30.1)), 0);
    }
}
