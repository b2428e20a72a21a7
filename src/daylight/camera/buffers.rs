//! What a camera sees, pixel by pixel.

use super::Camera;
use crate::daylight::Point;
use crate::job::{Cancel, Cancelled, Progress};
use crate::rays::Rays;
use glam::Vec3;
use rayon::prelude::*;

/// What a camera sees, pixel by pixel, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Buffers {
    /// Whose picture it is.
    pub camera: Camera,
    /// Distance of the surface along the camera's forward axis, metres; infinite where there is none.
    pub depth_m: Vec<f32>,
    /// The surface's unit normal on the side that the camera sees; zero where there is none.
    pub normals: Vec<Vec3>,
}

impl Buffers {
    /// Sends a ray through each pixel.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn render(rays: &Rays, camera: &Camera, progress: &dyn Progress, cancel: &Cancel) -> Result<Self, Cancelled> {
        let [width, height] = camera.size;
        let mut depth_m = vec![f32::INFINITY; camera.pixels()];
        let mut normals = vec![Vec3::ZERO; camera.pixels()];
        progress.begin("buffers", height as u64);
        let rows = depth_m.par_chunks_mut(width).zip(normals.par_chunks_mut(width)).enumerate();
        let rendered = rows.try_for_each(|(row, (depths_m, normals))| {
            cancel.check()?;
            for (column, (depth_m, normal)) in depths_m.iter_mut().zip(normals).enumerate() {
                if let Some((seen_m, facing)) = camera.look(rays, column, row) {
                    (*depth_m, *normal) = (seen_m, facing);
                }
            }
            progress.advance(1);
            Ok(())
        });
        progress.end();
        rendered.map(|()| Self { camera: *camera, depth_m, normals })
    }

    /// The place behind a pixel, on its surface, with the normal that faces the camera; `None` where nothing is hit and for
    /// pixels beyond the picture.
    pub fn point(&self, pixel: usize) -> Option<Point> {
        let (&depth_m, &normal) = (self.depth_m.get(pixel)?, self.normals.get(pixel)?);
        let width = self.camera.size[0];
        let position_m = self.camera.from_m + depth_m * self.camera.along(pixel % width, pixel / width);
        depth_m.is_finite().then_some(Point { position_m, normal: Some(normal) })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::ground_and_wall;
    use super::super::{Camera, DEFAULT_FOV_RAD};
    use super::*;
    use crate::job::Quiet;
    use crate::scene::Scene;

    fn rendered(scene: &Scene, camera: &Camera) -> Buffers {
        Buffers::render(&Rays::new(scene), camera, &Quiet, &Cancel::new()).unwrap()
    }

    #[test]
    fn a_plane_has_one_depth_straight_down_and_north_is_at_the_top() {
        let scene = ground_and_wall(0.0);
        let camera = Camera::new(Vec3::Z * 8.0, Vec3::ZERO, 1.0, [40, 30]).unwrap();
        assert_eq!((camera.up, camera.right), (Vec3::Y, Vec3::X));
        let buffers = rendered(&scene, &camera);
        for (pixel, (&depth_m, &normal)) in buffers.depth_m.iter().zip(&buffers.normals).enumerate() {
            assert!((depth_m - 8.0).abs() < 1e-5, "pixel {pixel}: {depth_m}");
            assert_eq!(normal, Vec3::Z);
        }
        let [top, last] = [0, 1199].map(|pixel| buffers.point(pixel).unwrap().position_m);
        let half_m = 8.0 * 0.5_f32.tan();
        let corner_m = Vec3::new(-half_m * 4.0 / 3.0 * 39.0 / 40.0, half_m * 29.0 / 30.0, 0.0);
        assert!(top.distance(corner_m) < 1e-4 && last.distance(-corner_m) < 1e-4, "{top} {last}");
        assert_eq!(buffers.point(1200), None);
    }

    #[test]
    fn row_zero_is_the_top_and_what_is_missed_is_infinitely_far() {
        let scene = ground_and_wall(0.0);
        let camera = Camera::new(Vec3::new(0.0, -9.0, 2.0), Vec3::new(0.0, 5.0, 2.0), 1.0, [33, 33]).unwrap();
        let buffers = rendered(&scene, &camera);
        // Up the middle column: ground, the wall 14 m away from the camera, the sky above it.
        let at = |row: usize| (buffers.depth_m[row * 33 + 16], buffers.normals[row * 33 + 16]);
        assert_eq!((at(0), buffers.point(16)), ((f32::INFINITY, Vec3::ZERO), None));
        assert!((at(16).0 - 14.0).abs() < 1e-5 && at(16).1 == Vec3::NEG_Y);
        assert!(at(32).0 < 14.0 && at(32).1 == Vec3::Z);
        // Off the middle the wall is farther along its ray, but not along the axis.
        assert!((buffers.depth_m[16 * 33 + 2] - 14.0).abs() < 1e-4);
    }

    #[test]
    fn a_back_is_seen_with_the_normal_that_faces_the_camera() {
        let scene = ground_and_wall(0.0);
        let camera = Camera::new(Vec3::new(0.0, 9.0, 2.0), Vec3::new(0.0, 5.0, 2.0), 0.5, [5, 5]).unwrap();
        assert_eq!(rendered(&scene, &camera).normals[12], Vec3::Y);
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits_and_a_raised_flag_stops() {
        let scene = ground_and_wall(0.0);
        let (low_m, high_m) = scene.mesh.bounds_m().unwrap();
        let camera = Camera::around(low_m, high_m, DEFAULT_FOV_RAD, [64, 48]).unwrap();
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| rendered(&scene, &camera))
        };
        assert_eq!(on(1), on(3));
        let cancel = Cancel::new();
        cancel.cancel();
        assert_eq!(Buffers::render(&Rays::new(&scene), &camera, &Quiet, &cancel), Err(Cancelled));
    }
}
