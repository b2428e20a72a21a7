//! Which triangles make up a polygon?
//!
//! Convex polygons are cut as a fan, others by ear clipping (Meisters 1975) in the plane of their mean normal (Newell).
//! Limits: polygons that cross themselves have no right answer, and are cut as far as ears are found.

use crate::scene::input::counted;
use glam::DVec3;

/// Most tests of a corner against an ear for one polygon; about a second. Beyond, the rest becomes a fan. A
/// spiral of 1,000 corners needs a hundredth of it.
const MOST_TESTS: usize = 200_000_000;

/// How cutting up a polygon went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cut {
    /// As it should.
    Whole,
    /// There was nothing to cut: fewer than three corners.
    TooFewCorners,
    /// It crosses itself or is too tangled: the rest became a fan.
    Crossing,
}

/// The warning for so many polygons that were cut up as far as possible.
pub fn tangled(count: usize) -> String {
    format!("{} cut up as far as possible: crossing or too tangled", counted(count, "polygon"))
}

/// Appends the triangles of the polygon with `corners` (numbers into `positions`, which must hold them) to `triangles`,
/// in its winding. Cost: linear if convex, quadratic as a rule if not.
pub fn triangulate(corners: &[u32], positions: &[DVec3], triangles: &mut Vec<[u32; 3]>) -> Cut {
    if let &[a, b, c] = corners {
        triangles.push([a, b, c]);
        return Cut::Whole;
    }
    if corners.len() < 3 {
        return Cut::TooFewCorners;
    }
    let points: Vec<DVec3> = corners.iter().filter_map(|&corner| positions.get(corner as usize).copied()).collect();
    let around = |index: usize| (index + 1) % points.len();

    // Newell's normal: right for any planar polygon, and the best guess for one that is not planar.
    let origin = points.first().copied().unwrap_or_default();
    let edges = points.iter().zip(points.iter().cycle().skip(1));
    let normal: DVec3 = edges.map(|(&a, &b)| (a - origin).cross(b - origin)).sum();
    let turn = |a: DVec3, b: DVec3, c: DVec3| (b - a).cross(c - b).dot(normal);

    let mut left: Vec<usize> = (0..points.len()).collect();
    let convex = left.iter().all(|&a| {
        let (b, c) = (around(a), around(around(a)));
        turn(points[a], points[b], points[c]) >= 0.0
    });
    let mut outcome = Cut::Whole;
    if !convex && normal != DVec3::ZERO {
        outcome = clip_ears(&points, &turn, &mut left, |ear| triangles.push(ear.map(|index| corners[index])));
    }
    if let [first, rest @ ..] = &left[..] {
        triangles.extend(rest.windows(2).map(|pair| [corners[*first], corners[pair[0]], corners[pair[1]]]));
    }
    outcome
}

/// Cuts ears off until a triangle is left in `left`, or none is found.
fn clip_ears(
    points: &[DVec3],
    turn: &dyn Fn(DVec3, DVec3, DVec3) -> f64,
    left: &mut Vec<usize>,
    mut ear_found: impl FnMut([usize; 3]),
) -> Cut {
    let (mut at, mut failures, mut tests) = (0, 0, 0);
    while left.len() > 3 {
        let count = left.len();
        let [before, here, after] = [at % count, (at + 1) % count, (at + 2) % count].map(|index| left[index]);
        let [a, b, c] = [points[before], points[here], points[after]];

        // An ear turns outwards and holds no other corner; a corner with no turn at all only ends a flat spike.
        let inside = |p: DVec3| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
        let blocks = |&other: &usize| {
            let p = points[other];
            p != a && p != b && p != c && inside(p)
        };
        let bend = turn(a, b, c);
        tests += if bend > 0.0 { count } else { 1 };
        if tests > MOST_TESTS {
            return Cut::Crossing;
        }
        if bend == 0.0 || (bend > 0.0 && !left.iter().any(blocks)) {
            // A corner on a straight line is cut with the next ear if it can be, so that no slit is left.
            if bend == 0.0 && failures < count {
                (at, failures) = ((at + 1) % count, failures + 1);
                continue;
            }
            ear_found([before, here, after]);
            left.remove((at + 1) % count);
            (at, failures) = (at % (count - 1), 0);
        } else {
            (at, failures) = ((at + 1) % count, failures + 1);
            if failures > 2 * count {
                return Cut::Crossing;
            }
        }
    }
    Cut::Whole
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[[f64; 2]]) -> (Cut, f64, usize) {
        let positions: Vec<DVec3> = points.iter().map(|&[x, y]| DVec3::new(x, y, 0.5 * x)).collect();
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let mut triangles = Vec::new();
        let outcome = triangulate(&corners, &positions, &mut triangles);
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|corner| positions[corner as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        assert!(triangles.iter().all(|t| area(t) >= -1e-12), "a triangle is turned over");
        (outcome, triangles.iter().map(area).sum(), triangles.len())
    }

    #[test]
    fn convex_and_concave_polygons_keep_their_area() {
        assert_eq!(cut(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), (Cut::Whole, 1.0, 2));
        // An arrow head whose fan from the first corner would reach outside.
        assert_eq!(cut(&[[0.0, 2.0], [1.0, 0.0], [2.0, 2.0], [1.0, 1.0]]), (Cut::Whole, 1.0, 2));
        // An L, a comb, and a square with a corner on its side.
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        assert_eq!(cut(&l), (Cut::Whole, 3.0, 4));
        let comb = [[0., 0.], [5., 0.], [5., 3.], [4., 3.], [4., 1.], [3., 1.], [3., 3.], [2., 3.], [2., 1.], [0., 1.]];
        let (outcome, area, count) = cut(&comb);
        assert_eq!((outcome, count), (Cut::Whole, 8));
        assert!((area - 9.0).abs() < 1e-12);
        assert_eq!(cut(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]).1, 2.0);
    }

    #[test]
    fn a_hole_joined_by_a_bridge_stays_open() {
        let outer = [[0., 0.], [4., 0.], [4., 4.], [0., 4.], [0., 0.]];
        let hole = [[1., 1.], [1., 3.], [3., 3.], [3., 1.], [1., 1.]];
        let bridged: Vec<[f64; 2]> = outer.iter().chain(&hole).copied().collect();
        let (outcome, area, _) = cut(&bridged);
        assert_eq!(outcome, Cut::Whole);
        assert!((area - 12.0).abs() < 1e-12, "{area}");
    }

    #[test]
    fn a_long_spiral_is_cut_whole() {
        let turns = |count: usize, gap: f64| {
            (0..count).map(move |step| {
                let angle = step as f64 * 0.05;
                let radius = 1.0 + gap + 0.1 * angle;
                [radius * angle.cos(), radius * angle.sin()]
            })
        };
        let inner: Vec<_> = turns(500, 0.0).collect();
        let spiral: Vec<_> = turns(500, 0.3).chain(inner.into_iter().rev()).collect();
        let doubled: f64 = (0..spiral.len())
            .map(|at| (spiral[at], spiral[(at + 1) % spiral.len()]))
            .map(|([ax, ay], [bx, by])| ax * by - bx * ay)
            .sum();
        let spiral: Vec<_> = if doubled < 0.0 { spiral.into_iter().rev().collect() } else { spiral };
        let (outcome, area, count) = cut(&spiral);
        assert_eq!((outcome, count), (Cut::Whole, spiral.len() - 2));
        assert!((area / (0.5 * doubled.abs()) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn too_few_corners_and_crossings_are_told() {
        assert_eq!(triangulate(&[0, 1], &[DVec3::ZERO; 2], &mut Vec::new()), Cut::TooFewCorners);
        let positions =
            [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 3.0], [4.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let mut triangles = Vec::new();
        triangulate(&[0, 1, 2, 3, 4], &positions, &mut triangles);
        assert_eq!(triangles.len(), 3);
    }
}
