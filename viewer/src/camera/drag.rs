//! What a drag in the picture means in the scene: along an axis, or over the plane that faces the viewer.

use glam::{Vec2, Vec3};

use super::Camera;

/// Least squared sine between axis and gaze at which an axis can be dragged along: about 6 degrees. Nearer to the gaze
/// a pixel would be metres.
const LEAST_SIN_SQUARED: f32 = 0.01;

impl Camera {
    /// How far along an axis a drag moves: metres from where the axis passes the first pixel to where it passes the
    /// second. The axis runs through `origin_m`; its direction need not have length one (zero gives zero). Zero too
    /// where the axis points at the viewer.
    pub fn along_axis_m(&self, origin_m: Vec3, axis: Vec3, from_px: Vec2, to_px: Vec2, size_px: Vec2) -> f32 {
        let axis = axis.normalize_or_zero();
        let from_m = self.passed_m(origin_m, axis, from_px, size_px);
        let to_m = self.passed_m(origin_m, axis, to_px, size_px);
        from_m.zip(to_m).map_or(0.0, |(from_m, to_m)| to_m - from_m)
    }

    /// Where a line comes nearest to a pixel's ray: metres along it.
    fn passed_m(&self, origin_m: Vec3, axis: Vec3, cursor_px: Vec2, size_px: Vec2) -> Option<f32> {
        let (ray_m, direction) = self.ray(cursor_px, size_px);
        let apart_m = origin_m - ray_m;
        let cosine = axis.dot(direction);
        let sine_squared = axis.length_squared() - cosine * cosine;
        let along_m = (cosine * direction.dot(apart_m) - axis.dot(apart_m)) / sine_squared;
        (sine_squared > LEAST_SIN_SQUARED).then_some(along_m)
    }

    /// Where the cursor meets the plane through a point that faces the viewer; the point itself where it lies behind
    /// the eye of a perspective.
    pub fn on_plane_m(&self, point_m: Vec3, to_px: Vec2, size_px: Vec2) -> Vec3 {
        let (origin_m, direction) = self.ray(to_px, size_px);
        let along_m = (point_m - origin_m).dot(self.forward()) / direction.dot(self.forward());
        if along_m > 0.0 { origin_m + direction * along_m } else { point_m }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{SIZE_PX, askew};
    use super::*;

    #[test]
    fn a_drag_from_one_point_of_an_axis_to_another_measures_what_lies_between() {
        for orthographic in [false, true] {
            let camera = askew(orthographic);
            let origin_m = Vec3::new(0.5, -1.0, 1.0);
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let (from_px, _) = camera.project(origin_m + axis * 0.2, SIZE_PX).unwrap();
                let (to_px, _) = camera.project(origin_m - axis * 0.9, SIZE_PX).unwrap();
                let along_m = camera.along_axis_m(origin_m, axis * 3.0, from_px, to_px, SIZE_PX);
                assert!((along_m + 1.1).abs() < 2e-3, "{along_m} along {axis}, orthographic: {orthographic}");
            }
        }
    }

    #[test]
    fn an_axis_towards_the_viewer_and_no_axis_stay() {
        let camera = askew(true);
        let (from_px, to_px) = (Vec2::new(100.0, 100.0), Vec2::new(700.0, 300.0));
        for axis in [camera.forward(), Vec3::ZERO] {
            assert_eq!(camera.along_axis_m(camera.target_m, axis, from_px, to_px, SIZE_PX), 0.0);
        }
    }

    #[test]
    fn a_point_dragged_over_its_plane_is_under_the_cursor_at_the_same_depth() {
        for orthographic in [false, true] {
            let camera = askew(orthographic);
            let (point_m, to_px) = (Vec3::new(0.0, -1.5, 0.2), Vec2::new(900.0, 650.0));
            let dragged_m = camera.on_plane_m(point_m, to_px, SIZE_PX);
            let (px, _) = camera.project(dragged_m, SIZE_PX).unwrap();
            assert!(px.distance(to_px) < 0.2, "{px}");
            assert!((camera.depth_m(dragged_m) - camera.depth_m(point_m)).abs() < 1e-3);
        }
        let camera = askew(false);
        let behind_m = camera.eye_m() - camera.forward();
        assert_eq!(camera.on_plane_m(behind_m, Vec2::ZERO, SIZE_PX), behind_m);
    }
}
