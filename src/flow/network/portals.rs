//! Which lines go through a neck?
//!
//! A portal is the outline of a neck, filled by triangles about its centre. Lines are started evenly over it, by the cosine to
//! both its sides; and any line can be asked whether it crosses. As long as the two agree, lines through portals and lines
//! from walls can be weighed against each other, however well the outline fits the opening.

use crate::flow::sequence;
use crate::skeleton::Neck;
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// A neck as a surface.
#[derive(Debug, Clone)]
pub struct Portal {
    /// The cells it joins.
    pub cells: [u32; 2],
    /// The point that its triangles share, metres.
    pub centre_m: Vec3,
    /// Unit normal, from the first cell to the second.
    pub normal: Vec3,
    /// The area of its triangles, m2.
    pub area_m2: f64,
    /// Across the normal.
    axes: [Vec3; 2],
    /// Its border about the centre, along the axes, metres; evenly by angle, the first half a step from the first axis.
    border_m: Vec<Vec2>,
    /// The areas of a triangle and all before it, m2.
    areas_up_to_m2: Vec<f64>,
    /// The longest way from the centre to the border, metres.
    reach_m: f32,
}

/// Where a line goes through a portal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// How far along the line, metres.
    pub distance_m: f32,
    /// Cosine to the portal's normal, without its sign.
    pub cosine: f32,
}

impl Portal {
    /// The portal of a neck; `None` for one without an area.
    pub fn new(neck: &Neck) -> Option<Self> {
        let (u, v) = neck.normal.any_orthonormal_pair();
        let border_m: Vec<Vec2> = (neck.outline_m.iter())
            .map(|at_m| Vec2::new((at_m - neck.centre_m).dot(u), (at_m - neck.centre_m).dot(v)))
            .collect();
        let mut area_m2 = 0.0;
        let next = border_m.iter().cycle().skip(1);
        let areas_up_to_m2 = border_m.iter().zip(next).map(|(a, b)| {
            area_m2 += 0.5 * f64::from(a.perp_dot(*b).max(0.0));
            area_m2
        });
        let areas_up_to_m2: Vec<f64> = areas_up_to_m2.collect();
        let reach_m = border_m.iter().map(|at_m| at_m.length()).fold(0.0, f32::max);
        let (cells, centre_m, normal) = (neck.cells, neck.centre_m, neck.normal);
        (border_m.len() > 2 && area_m2 > 0.0).then_some(Self {
            cells,
            centre_m,
            normal,
            area_m2,
            axes: [u, v],
            border_m,
            areas_up_to_m2,
            reach_m,
        })
    }

    /// Point number `index` of `count` that are spread evenly over it, metres.
    pub fn point_m(&self, index: u32, count: u32, offset: [f64; 2]) -> Vec3 {
        let target_m2 = (f64::from(index) + offset[0]) / f64::from(count) * self.area_m2;
        let triangle = self.areas_up_to_m2.partition_point(|&up_to_m2| up_to_m2 <= target_m2);
        let triangle = triangle.min(self.border_m.len() - 1);
        let (a, b) = (self.border_m[triangle], self.border_m[(triangle + 1) % self.border_m.len()]);
        let [square, along] = sequence::square(index, offset).map(|number| number as f32);
        let at_m = square.sqrt() * (a + along * (b - a));
        self.centre_m + at_m.x * self.axes[0] + at_m.y * self.axes[1]
    }

    /// Where the ray from `from_m` along the unit vector `direction` goes through it within `most_m`.
    pub fn crossing(&self, from_m: Vec3, direction: Vec3, most_m: f32) -> Option<Crossing> {
        let cosine = direction.dot(self.normal);
        let distance_m = (self.centre_m - from_m).dot(self.normal) / cosine;
        if !(distance_m > 0.0 && distance_m < most_m) {
            return None;
        }
        let off_m = from_m + distance_m * direction - self.centre_m;
        if off_m.length_squared() > self.reach_m * self.reach_m {
            return None;
        }
        let at_m = Vec2::new(off_m.dot(self.axes[0]), off_m.dot(self.axes[1]));
        let steps = self.border_m.len();
        let turn = at_m.y.atan2(at_m.x) / TAU * steps as f32 - 0.5;
        let triangle = turn.rem_euclid(steps as f32).floor() as usize % steps;
        let (a, b) = (self.border_m[triangle], self.border_m[(triangle + 1) % steps]);
        ((b - a).perp_dot(at_m - a) >= 0.0).then_some(Crossing { distance_m, cosine: cosine.abs() })
    }

    /// How densely `count` directions from a point to evenly spread points of it lie about `direction`, per steradian; `None`
    /// for one that does not cross it.
    pub fn density_per_sr(&self, from_m: Vec3, direction: Vec3, count: u32) -> Option<f64> {
        let crossing = self.crossing(from_m, direction, f32::INFINITY)?;
        let squared_m2 = f64::from(crossing.distance_m).powi(2);
        Some(f64::from(count) * squared_m2 / (self.area_m2 * f64::from(crossing.cosine)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn door() -> Portal {
        let normal = Vec3::new(0.3, 0.8, -0.1).normalize();
        let centre_m = Vec3::new(5.0, 2.0, 1.0);
        let (u, v) = normal.any_orthonormal_pair();
        let outline_m = (0..64).map(|ray| {
            let (sine, cosine) = ((ray as f32 + 0.5) * TAU / 64.0).sin_cos();
            // A rectangle about a point that is not its middle.
            let reach = |part: f32, up: f32, down: f32| if part > 0.0 { up / part } else { -down / part };
            let reach_m = reach(cosine, 0.7, 0.3).min(reach(sine, 1.5, 0.4));
            centre_m + reach_m * (cosine * u + sine * v)
        });
        let outline_m = outline_m.collect();
        Portal::new(&Neck { cells: [0, 1], position_m: centre_m, normal, area_m2: 1.9, centre_m, outline_m }).unwrap()
    }

    #[test]
    fn what_starts_on_it_crosses_it_and_evenly() {
        let door = door();
        assert!((door.area_m2 / 1.9 - 1.0).abs() < 0.03, "{}", door.area_m2);
        let count = 2000;
        let mut right = 0;
        for index in 0..count {
            let at_m = door.point_m(index, count, [0.3, 0.6]);
            let direction = sequence::cosine_about(door.normal, sequence::square(index, [0.1, 0.7]));
            let found = door.crossing(at_m - 3.0 * direction, direction, 10.0).expect("it starts on it");
            assert!((found.distance_m - 3.0).abs() < 1e-3 && (found.cosine - direction.dot(door.normal)).abs() < 1e-4);
            assert_eq!(door.crossing(at_m - 3.0 * direction, direction, 2.9), None);
            assert_eq!(door.crossing(at_m - 3.0 * direction, -direction, 10.0), None);
            right += u32::from((at_m - door.centre_m).dot(door.axes[0]) > 0.0);
        }
        assert!((f64::from(right) / f64::from(count) - 0.7).abs() < 0.03, "{right}");
    }

    #[test]
    fn what_passes_beside_it_does_not_cross() {
        let door = door();
        let (u, v) = (door.axes[0], door.axes[1]);
        for (x, y, inside) in
            [(0.6, 1.2, true), (0.8, 0.0, false), (-0.2, -0.3, true), (-0.4, 0.5, false), (0.1, -0.5, false)]
        {
            let at_m = door.centre_m + x * u + y * v;
            let found = door.crossing(at_m - 2.0 * door.normal, door.normal, 9.0);
            assert_eq!(found.is_some(), inside, "{x} {y}");
        }
    }
}
