//! Between which heights does a point see the sky, in one direction of the horizon?
//!
//! The large scale of Muñoz-Pandiella et al. 2017: the map of heights is read along the direction, and the steepest slope to
//! what stands there is the horizon. Over a point that something covers, the map shows the cover; the sky is seen beneath it
//! up to the opening angle, taken right before the first sample that is lower than the point. With the peeled map each
//! [`Span`] of matter covers the elevations between its sides, and the sky is seen in what is left: any number of bands.
//!
//! Samples lie ever farther apart, as wide as a share of their distance, and never nearer than a texel. Where one raises the
//! horizon, the edge since the one before is looked for by halves, and a jump that is left is taken to be half-way. What lies behind the plane of the point's surface does not count: it is the
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

/// How often the gap before a sample that raises the horizon is halved. In a narrow street of 16 samples a direction that halves
/// the error of the sky view factor; a third time changes nothing.
const HALVINGS: usize = 2;

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
    let line = Line { zenith, point, along };
    let seen = match overhangs {
        Overhangs::Peeled => peeled(&line, rings),
        _ => heights(&line, rings, overhangs),
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
    along_m: f32,
    off_m: Vec2,
}

/// Along a direction from a point.
struct Line<'a> {
    zenith: &'a Zenith,
    point: &'a super::Seer,
    along: Vec2,
}

impl<'a> Line<'a> {
    /// The samples that lie on the map, the nearest first.
    #[inline]
    fn samples(&self, rings: &'a Rings) -> impl Iterator<Item = (&'a Ring, Sample<'a>)> {
        let nearest_m = NEAREST_TEXELS * self.zenith.texel_m;
        let sample = move |ring: &'a Ring| Some((ring, self.sample(ring.middle_m, ring.level)?));
        rings.rings.iter().map_while(sample).filter(move |(_, sample)| sample.along_m > nearest_m)
    }

    /// What a level of the map has so far along; nothing beyond the map.
    #[inline]
    fn sample(&self, distance_m: f32, level: u32) -> Option<Sample<'a>> {
        let Self { zenith, point, along } = *self;
        let on_map = zenith.levels.get(level as usize)?;
        // Left of the map and below it lies no texel but, within one, that on its edge.
        let at = (point.at + along / zenith.texel_m * distance_m).to_array().map(|at| at as i32 >> level);
        let texel = on_map.texel(at[0], at[1])?;
        // A texel of a thin level is the one of the finest below and left of its middle.
        let middle = at.map(|at| ((at << level) + (1 << level) - 1) as f32 + 0.5);
        let off_m = (Vec2::from(middle) - point.at) * zenith.texel_m;
        Some(Sample { level: on_map, texel, along_m: off_m.dot(along), off_m })
    }

    /// What stands there.
    #[inline]
    fn stand(&self, sample: &Sample, top_m: f32) -> Stand {
        let rise_m = top_m - self.point.position_m.z;
        Stand { rise_m, along_m: sample.along_m, is_before: self.point.is_before(sample.off_m, rise_m) }
    }
}

/// What stands at a place: how high above a point, how far along from it, metres, and whether it lies before the point's plane.
#[derive(Debug, Clone, Copy)]
struct Stand {
    rise_m: f32,
    along_m: f32,
    is_before: bool,
}

/// The horizon so far, and the sample before.
#[derive(Debug, Clone, Copy)]
struct Horizon {
    low: f32,
    before: Stand,
}

impl Horizon {
    const LEVEL: Self = Self { low: f32::NEG_INFINITY, before: Stand { rise_m: 0.0, along_m: 0.0, is_before: false } };

    /// Raises it by what stands there. Where that begins, since the sample before, is looked for by halves, `at` distances; what
    /// is left rises half-way if it does so like a wall.
    #[inline]
    fn raise(&mut self, this: Stand, at: impl Fn(f32) -> Option<Stand>) {
        let (mut near, mut far) = (self.before, this);
        self.before = this;
        if !this.is_before || this.rise_m <= self.low * 0.5 * (near.along_m + far.along_m) {
            return;
        }
        for _ in 0..HALVINGS {
            let Some(middle) = at(0.5 * (near.along_m + far.along_m)) else { break };
            let is_steeper = middle.is_before && middle.rise_m * far.along_m >= far.rise_m * middle.along_m;
            *(if is_steeper { &mut far } else { &mut near }) = middle;
        }
        let step_m = far.along_m - near.along_m;
        let is_wall = far.rise_m - near.rise_m > WALL_SLOPE * step_m;
        let at_m = if is_wall { far.along_m - 0.5 * step_m } else { far.along_m };
        self.low = self.low.max(far.rise_m / at_m);
    }
}

/// By the highest surfaces.
fn heights(line: &Line, rings: &Rings, overhangs: Overhangs) -> Seen {
    let z_m = line.point.position_m.z;
    let mut is_covered = overhangs == Overhangs::Opening && line.point.covered;
    let (mut horizon, mut high) = (Horizon::LEVEL, f32::INFINITY);
    let highest_m = line.zenith.highest_m - z_m;
    let top = |sample: &Sample| line.stand(sample, sample.level.top_m[sample.texel]);
    for (ring, sample) in line.samples(rings) {
        // Nothing that is left can rise above the horizon.
        if highest_m < horizon.low * sample.along_m {
            break;
        }
        let this = top(&sample);
        if !is_covered {
            horizon.raise(this, |distance_m| line.sample(distance_m, ring.level).as_ref().map(top));
        } else if this.is_before || this.rise_m == NOTHING_M {
            // Where the mesh has no ground nothing covers either.
            is_covered = this.rise_m > 0.0;
            high = if is_covered { this.rise_m / this.along_m } else { high };
            horizon.before = this;
        }
    }
    let covered = if is_covered { u64::MAX } else { 0 };
    Seen { low: horizon.low, high, covered }
}

/// By all spans of matter.
fn peeled(line: &Line, rings: &Rings) -> Seen {
    let z_m = line.point.position_m.z;
    let (mut horizon, mut covered) = (Horizon::LEVEL, 0_u64);
    let highest_m = line.zenith.highest_m - z_m;
    let ground = |sample: &Sample| line.stand(sample, sample.level.column(sample.texel).0);
    for (ring, sample) in line.samples(rings) {
        if highest_m < horizon.low * ring.near_m {
            break;
        }
        horizon.raise(ground(&sample), |distance_m| line.sample(distance_m, ring.level).as_ref().map(ground));
        for span in sample.level.column(sample.texel).1 {
            if line.point.is_before(sample.off_m, span.top_m - z_m) {
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
    use crate::daylight::Point;
    use crate::job::Cancel;
    use crate::scene::{Mesh, Scene};

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
    fn a_wall_across_flat_ground_is_as_steep_as_it_is() {
        // A block of 20 m before which the ground goes on for 60 m.
        let corners_m = |[low, high]: [f32; 2], z: f32| {
            [(low, -40.0, z), (high, -40.0, z), (high, 40.0, z), (low, 40.0, z)].map(Vec3::from)
        };
        let mesh = Mesh {
            positions_m: [corners_m([0.0, 80.0], 0.0), corners_m([60.0, 80.0], 20.0)].concat(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            material_of: vec![0; 4],
        };
        let zenith = Zenith::new(&Scene { mesh, ..Scene::default() }, 800, true, &Cancel::new()).unwrap();
        for (away_m, overhangs) in [3.0, 8.0, 9.5, 11.0, 30.0].into_iter().flat_map(|away_m| {
            [Overhangs::Ignored, Overhangs::Opening, Overhangs::Peeled].map(|overhangs| (away_m, overhangs))
        }) {
            let position_m = Vec3::new(60.0 - away_m, 0.0, 0.01);
            let seer = super::super::Seer::new(&zenith, &Point { position_m, normal: Some(Vec3::Z) });
            let sine = |samples: usize, turn: f32| {
                let rings = Rings::new(&zenith, samples, 80.0, turn);
                let mut low = 0.0;
                let all = [f32::NEG_INFINITY, f32::INFINITY];
                bands(&zenith, &rings, overhangs, &seer, Vec2::X, all, |band| low = band.low);
                low
            };
            let want = sine_of_slope(20.0 / away_m);
            let fine = sine(1000, 0.5);
            assert!((fine - want).abs() < 0.01, "{overhangs:?}, {away_m} m: {fine} for {want}");
            for turn in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let coarse = sine(16, turn);
                assert!((coarse - want).abs() < 0.03, "{overhangs:?}, {away_m} m, turn {turn}: {coarse} for {want}");
            }
        }
    }

    #[test]
    fn a_cover_ends_where_there_is_no_ground() {
        // A roof 4 m over the point, which ends 5 m away; nothing else but a curb at 30 m.
        let corners_m = |[low, high]: [f32; 2], z: f32| {
            [(low, -10.0, z), (high, -10.0, z), (high, 10.0, z), (low, 10.0, z)].map(Vec3::from)
        };
        let mesh = Mesh {
            positions_m: [corners_m([0.0, 10.0], 5.0), corners_m([35.0, 36.0], 0.0)].concat(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            material_of: vec![0; 4],
        };
        let zenith = Zenith::new(&Scene { mesh, ..Scene::default() }, 360, false, &Cancel::new()).unwrap();
        let point = Point { position_m: Vec3::new(5.0, 0.0, 1.0), normal: Some(Vec3::X) };
        let seer = super::super::Seer::new(&zenith, &point);
        let rings = Rings::new(&zenith, 1000, 36.0, 0.5);
        let mut seen = Vec::new();
        let all = [f32::NEG_INFINITY, f32::INFINITY];
        bands(&zenith, &rings, Overhangs::Opening, &seer, Vec2::X, all, |band| seen.push(band));
        assert!(seen.len() == 1 && seen[0].low == 0.0, "{seen:?}");
        assert!((seen[0].high - sine_of_slope(4.0 / 5.0)).abs() < 0.01, "{seen:?}");
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
