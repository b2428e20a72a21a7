//! What does light fall on? The triangles of the mesh, how each answers light, and points spread evenly over them.

use crate::rays::Surface;
use crate::scene::{Material, Scene};
use glam::Vec3;

/// The triangles of a scene's mesh, by their numbers there.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Walls {
    /// Their corners, metres; a triangle that names a missing vertex has none, and no area.
    pub corners_m: Vec<[Vec3; 3]>,
    /// How each answers light.
    pub answers: Vec<Answer>,
    /// The areas of a triangle and all before it, m2.
    areas_up_to_m2: Vec<f64>,
}

/// How a surface answers light, on both its sides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Answer {
    /// Share that it sends back diffusely.
    pub reflects: f32,
    /// Share that it passes straight on.
    pub passes: f32,
}

/// A point of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallPoint {
    /// The triangle's number.
    pub triangle: u32,
    /// Where it is, metres.
    pub position_m: Vec3,
    /// Unit normal of the triangle's front.
    pub normal: Vec3,
}

impl Walls {
    /// The triangles of a scene. Linear in their number.
    pub fn of(scene: &Scene) -> Self {
        let triangles = 0..scene.mesh.triangles.len();
        let corners_m: Vec<[Vec3; 3]> =
            triangles.clone().map(|triangle| scene.mesh.corners_m(triangle).unwrap_or_default()).collect();
        let answer = |material: &Material| Answer { reflects: material.reflects(), passes: material.passes() };
        let answers = triangles.map(|triangle| scene.material(triangle).map_or(Answer::default(), answer)).collect();
        let mut up_to_m2 = 0.0;
        let areas_up_to_m2 = corners_m.iter().map(|corners_m| {
            up_to_m2 += area_m2(corners_m);
            up_to_m2
        });
        let areas_up_to_m2 = areas_up_to_m2.collect();
        Self { corners_m, answers, areas_up_to_m2 }
    }

    /// How a surface answers light; lights absorb all.
    pub fn answer(&self, surface: Surface) -> Answer {
        match surface {
            Surface::Triangle(triangle) => self.answers.get(triangle as usize).copied().unwrap_or_default(),
            Surface::Light(_) => Answer::default(),
        }
    }

    /// The area of all triangles, one side each, m2.
    pub fn area_m2(&self) -> f64 {
        self.areas_up_to_m2.last().copied().unwrap_or(0.0)
    }

    /// The point at that share of the whole area (in [0, 1), along the triangles in their order), and within its triangle at
    /// the place that two more numbers in [0, 1) give, uniformly by area. `None` where there is no area.
    pub fn point_at(&self, share: f64, within: [f64; 2]) -> Option<WallPoint> {
        let target_m2 = share * self.area_m2();
        let triangle = self.areas_up_to_m2.partition_point(|&up_to_m2| up_to_m2 <= target_m2);
        let corners_m = self.corners_m.get(triangle)?;
        let [a, b, c] = corners_m;
        // A square folded along its diagonal keeps neighbours together.
        let [mut u, mut v] = within.map(|number| number as f32);
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let position_m = a + u * (b - a) + v * (c - a);
        Some(WallPoint { triangle: triangle as u32, position_m, normal: (b - a).cross(c - a).normalize_or_zero() })
    }
}

/// The area of a triangle, m2.
fn area_m2([a, b, c]: &[Vec3; 3]) -> f64 {
    0.5 * f64::from((b - a).cross(c - a).length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::voxel::test_scenes::{boxed, scene_of};

    #[test]
    fn points_are_spread_by_area() {
        let size = Vec3::new(4.0, 2.0, 1.0);
        let walls = Walls::of(&scene_of(&boxed(Vec3::ZERO, size)));
        assert!((walls.area_m2() - 28.0).abs() < 1e-5);
        let points = (0..28_000).map(|i| {
            let share = (f64::from(i) + 0.5) / 28_000.0;
            walls.point_at(share, [(f64::from(i) * 0.755).fract(), (f64::from(i) * 0.57).fract()]).unwrap()
        });
        let (mut on_floor, mut in_half) = (0, 0);
        for WallPoint { position_m, normal, .. } in points {
            let on_side = (position_m - 0.5 * size).abs() / (0.5 * size);
            assert!((on_side.max_element() - 1.0).abs() < 1e-5 && (normal.length() - 1.0).abs() < 1e-5);
            let is_floor = normal.z.abs() > 0.5 && position_m.z == 0.0;
            on_floor += u32::from(is_floor);
            in_half += u32::from(is_floor && position_m.x < 2.0);
        }
        assert!(on_floor.abs_diff(8000) <= 1 && in_half.abs_diff(4000) < 40, "{on_floor} {in_half}");
        assert_eq!(Walls::default().point_at(0.5, [0.0; 2]), None);
    }
}
