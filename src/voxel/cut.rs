//! How much of a triangle lies in each voxel?
//!
//! The triangle is cut by the planes between voxels, first along z, then y, then x (Sutherland & Hodgman 1974, both sides
//! of each plane kept), in `f64`. Voxels are half-open boxes, so the pieces share the triangle without gap or overlap,
//! and a wall that lies on a voxel face is counted once, in the voxel above it.

use glam::{DVec3, IVec3};

/// A triangle gains at most one corner at each of the six planes of a box, and one more while it is being cut.
const MOST_CORNERS: usize = 10;

/// A convex polygon in units of voxels.
#[derive(Debug, Clone, Copy)]
struct Polygon {
    corners: [DVec3; MOST_CORNERS],
    count: usize,
}

impl Polygon {
    const EMPTY: Self = Self { corners: [DVec3::ZERO; MOST_CORNERS], count: 0 };

    fn push(&mut self, corner: DVec3) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// The voxels it spans along an axis, first and last.
    fn span(&self, axis: usize) -> (i32, i32) {
        let along = self.corners().iter().map(|corner| corner[axis]);
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), at| (l.min(at), h.max(at)));
        (low.floor() as i32, high.floor() as i32)
    }

    /// The parts below and above the plane `axis = at`. What lies in the plane belongs to both, without an area.
    fn split(&self, axis: usize, at: f64) -> (Self, Self) {
        let (mut below, mut above) = (Self::EMPTY, Self::EMPTY);
        let corners = self.corners();
        for (number, &corner) in corners.iter().enumerate() {
            let next = corners[(number + 1) % corners.len()];
            let (here, there) = (corner[axis] - at, next[axis] - at);
            if here <= 0.0 {
                below.push(corner);
            }
            if here >= 0.0 {
                above.push(corner);
            }
            if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
                let mut crossing = corner + (next - corner) * (here / (here - there));
                crossing[axis] = at;
                below.push(crossing);
                above.push(crossing);
            }
        }
        (below, above)
    }

    fn area(&self) -> f64 {
        let Some((&apex, rest)) = self.corners().split_first() else { return 0.0 };
        let doubled: DVec3 = rest.windows(2).map(|edge| (edge[0] - apex).cross(edge[1] - apex)).sum();
        doubled.length() / 2.0
    }

    /// Hands on the parts in each layer of voxels along an axis, from `first` to `last` at most.
    fn layers(mut self, axis: usize, first: i32, last: i32, mut visit: impl FnMut(i32, Self)) {
        let (low, high) = self.span(axis);
        if low > last || high < first {
            return;
        }
        if low < first {
            (_, self) = self.split(axis, f64::from(first));
        }
        let last = high.min(last);
        for layer in low.max(first)..=last {
            if layer == high {
                visit(layer, self);
            } else {
                let (below, above) = self.split(axis, f64::from(layer + 1));
                visit(layer, below);
                self = above;
            }
        }
    }
}

/// Calls `visit` with each voxel from `first` to `last` (inclusive) that holds a part of the triangle, and that part's area
/// in squares of a voxel's edge. Corners are in units of voxels from the grid's lowest corner. Costs one cut a voxel.
pub fn each_piece(corners_in_grid: [DVec3; 3], first: IVec3, last: IVec3, mut visit: impl FnMut(IVec3, f64)) {
    let mut triangle = Polygon::EMPTY;
    corners_in_grid.into_iter().for_each(|corner| triangle.push(corner));
    triangle.layers(2, first.z, last.z, |z, slice| {
        slice.layers(1, first.y, last.y, |y, strip| {
            strip.layers(0, first.x, last.x, |x, piece| visit(IVec3::new(x, y, z), piece.area()));
        });
    });
}

#[cfg(test)]
mod tests {
    use super::super::touch::Touch;
    use super::*;
    use proptest::prelude::*;

    const ALL: (IVec3, IVec3) = (IVec3::splat(-1000), IVec3::splat(1000));

    fn point() -> impl Strategy<Value = DVec3> {
        let free = prop::array::uniform3(0.0..9.0_f64);
        let round = prop::array::uniform3((0..18).prop_map(|along| f64::from(along) / 2.0));
        prop_oneof![free, round].prop_map(DVec3::from_array)
    }

    /// The area in a box by points on a fine triangular lattice over the triangle.
    fn sampled_area(corners: [DVec3; 3], voxel: IVec3) -> f64 {
        let [a, b, c] = corners;
        let steps = 400;
        let mut inside = 0;
        for i in 0..steps {
            for j in 0..steps - i {
                let (s, t) =
                    ((f64::from(i) + 1.0 / 3.0) / f64::from(steps), (f64::from(j) + 1.0 / 3.0) / f64::from(steps));
                let point = a + (b - a) * s + (c - a) * t;
                inside += i32::from(point.floor().as_ivec3() == voxel);
            }
        }
        let all = f64::from(steps * (steps + 1) / 2);
        (b - a).cross(c - a).length() / 2.0 * f64::from(inside) / all
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]
        #[test]
        fn pieces_share_the_triangle(a in point(), b in point(), c in point()) {
            let area = (b - a).cross(c - a).length() / 2.0;
            let touch = Touch::new([a, b, c]);
            let mut total = 0.0;
            each_piece([a, b, c], ALL.0, ALL.1, |voxel, piece| {
                assert!(piece <= 3_f64.sqrt() + 1e-9 && (piece == 0.0 || touch.touches(voxel)), "{voxel} {piece}");
                total += piece;
            });
            prop_assert!((total - area).abs() <= 1e-9 * (1.0 + area), "{} {}", total, area);
        }

        #[test]
        fn slabs_share_it_too(a in point(), b in point(), c in point()) {
            let area = (b - a).cross(c - a).length() / 2.0;
            let mut total = 0.0;
            for slab in 0..3 {
                let (first, last) = (IVec3::new(0, 0, 4 * slab), IVec3::new(9, 9, 4 * slab + 3));
                each_piece([a, b, c], first, last, |_, piece| total += piece);
            }
            prop_assert!((total - area).abs() <= 1e-9 * (1.0 + area), "{} {}", total, area);
        }
    }

    #[test]
    fn each_voxel_gets_what_lies_in_it() {
        let corners = [DVec3::new(0.3, 0.2, 0.1), DVec3::new(2.7, 0.9, 1.2), DVec3::new(0.8, 2.6, 2.9)];
        each_piece(corners, ALL.0, ALL.1, |voxel, piece| {
            assert!((piece - sampled_area(corners, voxel)).abs() < 0.01, "{voxel} {piece}");
        });
    }

    #[test]
    fn a_wall_on_a_voxel_face_counts_once() {
        let corners = [DVec3::new(1.0, 1.0, 4.0), DVec3::new(3.0, 1.0, 4.0), DVec3::new(1.0, 3.0, 4.0)];
        let mut pieces = Vec::new();
        each_piece(corners, ALL.0, ALL.1, |voxel, piece| {
            if piece > 0.0 {
                pieces.push((voxel.to_array(), piece));
            }
        });
        assert_eq!(pieces, [([1, 1, 4], 1.0), ([2, 1, 4], 0.5), ([1, 2, 4], 0.5)]);
    }
}
