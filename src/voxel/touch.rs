//! Which voxels does a triangle touch?
//!
//! The separating-axis test for a triangle and a box (Akenine-Moeller 2001), with everything that depends on the triangle
//! alone computed once (Schwarz & Seidel 2010), walked over the columns of voxels along the triangle's dominant axis.
//! Triangle and box are closed sets: touching counts as overlap, so a connected surface gives voxels that no 26-connected
//! path crosses (the segment between two neighbouring centres runs inside their two closed boxes). Degenerate triangles
//! are the segments and points they are.

use glam::{DVec3, IVec3};

/// By how much a voxel's box is grown on every side before the test, voxels. Corners in `f32` are rounded by up to 6e-5 of
/// a voxel where the grid is a thousand voxels long: faces that meet, or walls that lie on a voxel face, up to rounding
/// still touch.
pub const SLACK_VOXELS: f64 = 1e-4;

/// Half the edge of the box that stands for a voxel.
const HALF: f64 = 0.5 + SLACK_VOXELS;

/// Rounding of a normal and of a distance along it, for a triangle one voxel long. It decides only for slivers thinner than
/// rounding, whose normal may point anywhere: they are left to their edges.
const ROUNDING: f64 = 4e-15;

/// An interval of a projection; a box whose centre projects outside it is apart from the triangle.
#[derive(Debug, Clone, Copy)]
struct Band {
    along: [f64; 2],
    low: f64,
    high: f64,
}

impl Band {
    fn holds(&self, at: [f64; 2]) -> bool {
        let projected = self.along[0] * at[0] + self.along[1] * at[1];
        self.low <= projected && projected <= self.high
    }
}

/// A triangle made ready for the test against many voxels.
#[derive(Debug, Clone)]
pub struct Touch {
    corner: DVec3,
    low: DVec3,
    high: DVec3,
    normal: DVec3,
    /// How far, along the normal and times its length, a voxel's centre may be off the triangle's plane.
    reach: f64,
    /// For each axis the three edges seen along it, in the coordinates of the two axes that follow it in turn.
    bands: [[Band; 3]; 3],
}

impl Touch {
    /// The triangle with these corners, in units of voxels from the grid's lowest corner.
    pub fn new(corners_in_grid: [DVec3; 3]) -> Self {
        let [a, b, c] = corners_in_grid;
        let normal = (b - a).cross(c - a);
        let bands = [0, 1, 2].map(|axis| {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            [(a, b), (b, c), (c, a)].map(|(from, to)| {
                let along = [from[v] - to[v], to[u] - from[u]];
                let reach = HALF * (along[0].abs() + along[1].abs());
                let projected = corners_in_grid.map(|corner| along[0] * corner[u] + along[1] * corner[v]);
                let low = projected.into_iter().fold(f64::INFINITY, f64::min) - reach;
                let high = projected.into_iter().fold(f64::NEG_INFINITY, f64::max) + reach;
                Band { along, low, high }
            })
        });
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let extent = (high - low).max_element();
        let rounding = ROUNDING * extent * extent * (extent + 1.0);
        Self { corner: a, low, high, normal, reach: HALF * normal.abs().element_sum() + rounding, bands }
    }

    /// The first and last voxel along each axis whose box meets the triangle's own; they may lie outside any grid.
    pub fn range(&self) -> (IVec3, IVec3) {
        range(self.low, self.high)
    }

    /// Whether the voxel and the triangle touch.
    pub fn touches(&self, voxel: IVec3) -> bool {
        let (first, last) = self.range();
        let in_range = voxel.cmpge(first).all() && voxel.cmple(last).all();
        in_range && (0..3).all(|axis| self.in_bands(axis, voxel)) && self.on_plane(voxel)
    }

    fn in_bands(&self, axis: usize, voxel: IVec3) -> bool {
        let at = [(axis + 1) % 3, (axis + 2) % 3].map(|other| f64::from(voxel[other]) + 0.5);
        self.bands[axis].iter().all(|band| band.holds(at))
    }

    fn on_plane(&self, voxel: IVec3) -> bool {
        self.normal.dot(voxel.as_dvec3() + 0.5 - self.corner).abs() <= self.reach
    }

    /// Calls `visit` once for each voxel from `first` to `last` (both inclusive) that touches the triangle, in an order that
    /// depends on the triangle alone. Costs a few tests for each column of voxels that the triangle crosses.
    pub fn each_voxel(&self, first: IVec3, last: IVec3, mut visit: impl FnMut(IVec3)) {
        let (low, high) = self.range();
        let (low, high) = (low.max(first), high.min(last));
        if low.cmpgt(high).any() {
            return;
        }

        // Columns run along the axis in which the triangle is thinnest.
        let steep = self.normal.abs();
        let w = if steep.x >= steep.y && steep.x >= steep.z { 0 } else { 1 + usize::from(steep.z > steep.y) };
        let (u, v) = ((w + 1) % 3, (w + 2) % 3);
        let mut at = IVec3::ZERO;
        for along_v in low[v]..=high[v] {
            at[v] = along_v;
            let (row_low, row_high) = self.row(w, along_v, low[u], high[u]);
            for along_u in row_low..=row_high {
                at[u] = along_u;
                if !self.in_bands(w, at) {
                    continue;
                }
                let (column_low, column_high) = self.column(w, at, low[w], high[w]);
                for along_w in column_low..=column_high {
                    at[w] = along_w;
                    if self.on_plane(at) && self.in_bands(u, at) && self.in_bands(v, at) {
                        visit(at);
                    }
                }
            }
        }
    }

    /// The part of a row of columns that the bands seen along `w` leave, a little too long rather than too short.
    fn row(&self, w: usize, along_v: i32, low: i32, high: i32) -> (i32, i32) {
        let at_v = f64::from(along_v) + 0.5;
        let bands = self.bands[w].iter().filter(|band| band.along[0].abs() > 1e-3 * band.along[1].abs());
        bands.fold((low, high), |(low, high), band| {
            let ends = [band.low, band.high].map(|end| (end - band.along[1] * at_v) / band.along[0]);
            narrowed(low, high, ends)
        })
    }

    /// The part of a column that lies near the triangle's plane, a little too long rather than too short.
    fn column(&self, w: usize, at: IVec3, low: i32, high: i32) -> (i32, i32) {
        if self.normal[w] == 0.0 {
            return (low, high);
        }
        let mut foot = at.as_dvec3() + 0.5 - self.corner;
        foot[w] = 0.0;
        let height = -self.normal.dot(foot);
        let ends = [height - self.reach, height + self.reach];
        narrowed(low, high, ends.map(|end| self.corner[w] + end / self.normal[w]))
    }
}

/// The first and last voxel along each axis whose box meets the box from `low` to `high`, in units of voxels.
pub fn range(low: DVec3, high: DVec3) -> (IVec3, IVec3) {
    ((low - 0.5 - HALF).ceil().as_ivec3(), (high - 0.5 + HALF).floor().as_ivec3())
}

/// The voxels of `low..=high` whose centres lie between two ends, widened by a thousandth for rounding.
fn narrowed(low: i32, high: i32, ends: [f64; 2]) -> (i32, i32) {
    let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    (low.max((from - 0.501).ceil() as i32), high.min((to - 0.499).floor() as i32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    /// Whether a convex polygon, cut by the six planes of the closed box, leaves anything: slow and independent.
    fn cut_leaves_something(corners: [DVec3; 3], voxel: IVec3) -> bool {
        let mut polygon = corners.to_vec();
        for axis in 0..3 {
            for (sign, bound) in
                [(1.0, f64::from(voxel[axis]) + 1.0 + SLACK_VOXELS), (-1.0, -(f64::from(voxel[axis]) - SLACK_VOXELS))]
            {
                let mut kept = Vec::new();
                for i in 0..polygon.len() {
                    let (p, q): (DVec3, DVec3) = (polygon[i], polygon[(i + 1) % polygon.len()]);
                    let (over_p, over_q) = (sign * p[axis] - bound, sign * q[axis] - bound);
                    if over_p <= 0.0 {
                        kept.push(p);
                    }
                    if over_p * over_q < 0.0 {
                        kept.push(p + (q - p) * (over_p / (over_p - over_q)));
                    }
                }
                polygon = kept;
            }
        }
        !polygon.is_empty()
    }

    fn check(corners: [DVec3; 3]) {
        let touch = Touch::new(corners);
        let mut visited = BTreeSet::new();
        let (first, last) = (IVec3::splat(-2), IVec3::splat(11));
        touch.each_voxel(first, last, |voxel| assert!(visited.insert(voxel.to_array()), "{voxel} twice"));
        for x in -2..12 {
            for y in -2..12 {
                for z in -2..12 {
                    let voxel = IVec3::new(x, y, z);
                    let want = cut_leaves_something(corners, voxel);
                    assert_eq!(touch.touches(voxel), want, "{voxel} {corners:?}");
                    assert_eq!(visited.contains(&voxel.to_array()), want, "{voxel} {corners:?}");
                }
            }
        }
    }

    fn point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(0.0..10.0_f64).prop_map(DVec3::from_array)
    }

    /// Corners on voxel corners, edges and faces: walls, edges and points that only touch.
    fn round_point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(0..20_i32).prop_map(|p| DVec3::from_array(p.map(|along| f64::from(along) / 2.0)))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]
        #[test]
        fn the_voxels_are_those_whose_box_holds_a_part(a in point(), b in point(), c in point()) {
            check([a, b, c]);
        }

        #[test]
        fn touching_counts(a in round_point(), b in round_point(), c in round_point()) {
            check([a, b, c]);
        }

        #[test]
        fn slivers_are_found(
            a in point(), b in point(), t in -0.5..1.5_f64,
            off in prop::array::uniform3(-1.0..1.0_f64), scale in prop::sample::select(vec![0.0, 1e-15, 1e-12, 1e-3]),
        ) {
            check([a, b, a + (b - a) * t + scale * DVec3::from_array(off)]);
        }
    }

    #[test]
    fn points_and_segments_touch_too() {
        check([DVec3::new(3.0, 3.0, 3.0); 3]);
        check([DVec3::new(1.5, 2.5, 3.0), DVec3::new(8.5, 2.5, 3.0), DVec3::new(4.0, 2.5, 3.0)]);
    }

    #[test]
    fn a_wall_on_a_voxel_face_touches_both_sides() {
        let wall = Touch::new([DVec3::new(1.0, 1.0, 4.0), DVec3::new(6.0, 1.0, 4.0), DVec3::new(1.0, 6.0, 4.0)]);
        assert!(wall.touches(IVec3::new(2, 2, 3)) && wall.touches(IVec3::new(2, 2, 4)));
        assert!(!wall.touches(IVec3::new(2, 2, 5)) && !wall.touches(IVec3::new(2, 2, 2)));
    }
}
