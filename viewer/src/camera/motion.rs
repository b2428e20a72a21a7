//! How a camera moves: fit, look from, orbit, pan, zoom, focus and fly.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Vec2, Vec3};

use super::{Camera, DISTANCE_M, FIELD_OF_VIEW_RAD, Standard};

/// Share of the picture that a fitted box may fill.
const FILLED: f32 = 0.95;
/// Turn of a drag across the picture's whole height.
const TURN_RAD: f32 = PI;

impl Camera {
    /// A new camera that sees a whole box (its least and greatest corner) from above the south-east, in perspective.
    /// `aspect` is the picture's width over its height. Boxes without extent are shown from one metre.
    pub fn fitted(bounds_m: (Vec3, Vec3), aspect: f32) -> Self {
        let mut camera = Self {
            target_m: Vec3::ZERO,
            azimuth_rad: 0.0,
            elevation_rad: 0.0,
            distance_m: 1.0,
            field_of_view_rad: FIELD_OF_VIEW_RAD,
            orthographic: false,
        };
        camera.look_from(Standard::Oblique);
        camera.fit(bounds_m, aspect);
        camera
    }

    /// Moves so that the box stands in the picture's middle and fills 95% of it one way and less the other; the direction
    /// stays. The target is then at the depth of the box's middle.
    pub fn fit(&mut self, bounds_m: (Vec3, Vec3), aspect: f32) {
        let (least_m, most_m) = bounds_m;
        if !(least_m.is_finite() && most_m.is_finite() && least_m.cmple(most_m).all()) {
            return;
        }
        let half_m = (most_m - least_m) / 2.0;
        let up_slope = (self.field_of_view_rad / 2.0).tan() * FILLED;
        let (across_m, across_distance_m) = self.fit_along(self.right(), up_slope * aspect, half_m);
        let (above_m, above_distance_m) = self.fit_along(self.up(), up_slope, half_m);

        self.target_m = (least_m + most_m) / 2.0 + self.right() * across_m + self.up() * above_m;
        let distance_m = across_distance_m.max(above_distance_m);
        self.distance_m = if distance_m > 0.0 { clamped_m(distance_m) } else { 1.0 };
    }

    /// Where along one axis of the picture the target must be, from the middle of a box of this half extent, and how far
    /// the eye, for the box to lie just between two planes that open by `slope` from the gaze.
    fn fit_along(&self, axis: Vec3, slope: f32, half_m: Vec3) -> (f32, f32) {
        // Nearer corners reach further out in perspective.
        let opening = if self.orthographic { 0.0 } else { slope };
        let reach_m = |side: f32| {
            let corner_m = corner_signs().map(|signs| half_m * signs);
            let reaches_m = corner_m.map(|corner_m| side * corner_m.dot(axis) - opening * corner_m.dot(self.forward()));
            reaches_m.fold(0.0, f32::max)
        };
        let (one_m, other_m) = (reach_m(1.0), reach_m(-1.0));
        ((one_m - other_m) / 2.0, (one_m + other_m) / (2.0 * slope))
    }

    /// Turns to a direction that has a name; target and distance stay. What was fitted is to be fitted anew: in perspective
    /// the target of a fitted box stands off the box's middle.
    pub fn look_from(&mut self, standard: Standard) {
        (self.azimuth_rad, self.elevation_rad) = standard.angles_rad();
    }

    /// Circles the target: what is seen follows the cursor, so a drag to the right brings the left side forward and a
    /// drag down raises the eye. A drag over the picture's height turns by half a circle; the poles stop it.
    pub fn orbit(&mut self, delta_px: Vec2, size_px: Vec2) {
        let turn_rad = delta_px * TURN_RAD / size_px.y.max(1.0);
        self.azimuth_rad = (self.azimuth_rad - turn_rad.x + PI).rem_euclid(TAU) - PI;
        self.elevation_rad = (self.elevation_rad + turn_rad.y).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// Shifts the picture: the point at the target's depth stays under the cursor.
    pub fn pan(&mut self, delta_px: Vec2, size_px: Vec2) {
        let metres_per_px = self.metres_per_px(self.target_m, size_px);
        self.target_m += (self.up() * delta_px.y - self.right() * delta_px.x) * metres_per_px;
    }

    /// Divides the distance by a factor (above one comes nearer); the point at the target's depth stays under the
    /// cursor. Factors that are not above zero do nothing.
    pub fn zoom(&mut self, factor: f32, cursor_px: Vec2, size_px: Vec2) {
        if !(factor > 0.0 && factor.is_finite()) {
            return;
        }
        let fixed_m = self.at_target_m(cursor_px, size_px);
        let distance_m = clamped_m(self.distance_m / factor);
        self.target_m = fixed_m + (self.target_m - fixed_m) * (distance_m / self.distance_m);
        self.distance_m = distance_m;
    }

    /// Makes a point the target; direction and distance stay.
    pub fn focus(&mut self, point_m: Vec3) {
        self.target_m = point_m;
    }

    /// Moves eye and target together: `right_forward_up` is a direction to the picture's right, along the gaze and
    /// along +Z, each from -1 to 1.
    pub fn fly(&mut self, right_forward_up: Vec3, metres: f32) {
        let Vec3 { x: right, y: forward, z: up } = right_forward_up;
        self.target_m += (self.right() * right + self.forward() * forward + Vec3::Z * up) * metres;
    }
}

/// The eight corners of a box of half extent one.
fn corner_signs() -> impl Iterator<Item = Vec3> {
    let sign = |corner: u8, axis: u8| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
    (0..8).map(move |corner| Vec3::new(sign(corner, 0), sign(corner, 1), sign(corner, 2)))
}

/// A distance within what pictures can show.
fn clamped_m(distance_m: f32) -> f32 {
    distance_m.clamp(*DISTANCE_M.start(), *DISTANCE_M.end())
}

#[cfg(test)]
mod tests {
    use super::super::tests::{SIZE_PX, askew};
    use super::*;

    #[test]
    fn a_fitted_box_is_wholly_visible_and_fills_the_picture() {
        let bounds_m = (Vec3::new(-3.0, 1.0, 0.0), Vec3::new(9.0, 5.0, 2.5));
        for orthographic in [false, true] {
            for standard in Standard::ALL {
                for size_px in [SIZE_PX, Vec2::new(400.0, 900.0)] {
                    let mut camera = askew(orthographic);
                    camera.look_from(standard);
                    camera.fit(bounds_m, size_px.x / size_px.y);
                    let (middle_m, half_m) = ((bounds_m.0 + bounds_m.1) / 2.0, (bounds_m.1 - bounds_m.0) / 2.0);
                    let corners: Vec<Vec2> = corner_signs()
                        .map(|signs| {
                            camera.project(middle_m + half_m * signs, size_px).unwrap().0 / size_px * 2.0 - 1.0
                        })
                        .collect();
                    let least = corners.iter().copied().fold(Vec2::ONE, Vec2::min);
                    let most = corners.iter().copied().fold(Vec2::NEG_ONE, Vec2::max);
                    let filled = most.max(-least).max_element();
                    assert!((filled - 0.95).abs() < 1e-3, "{standard:?} fills {filled} of {size_px}");
                    let limiting =
                        if (most - least).x > (most - least).y { (most + least).x } else { (most + least).y };
                    assert!(limiting.abs() < 1e-3, "{standard:?} stands off the middle by {limiting}");
                }
            }
        }
    }

    #[test]
    fn a_box_without_extent_is_shown_from_one_metre() {
        let camera = Camera::fitted((Vec3::ONE, Vec3::ONE), 1.6);
        assert_eq!((camera.target_m, camera.distance_m), (Vec3::ONE, 1.0));
        let mut unmoved = camera;
        unmoved.fit((Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY)), 1.6);
        assert_eq!(unmoved, camera);
    }

    #[test]
    fn orbit_turns_with_the_cursor_and_stops_at_the_poles() {
        let before = askew(false);
        let mut camera = before;
        let near_m = camera.target_m - camera.forward();
        let (near_px, _) = camera.project(near_m, SIZE_PX).unwrap();
        camera.orbit(Vec2::new(20.0, 10.0), SIZE_PX);
        let (moved_px, _) = camera.project(near_m, SIZE_PX).unwrap();
        assert!(moved_px.x > near_px.x && moved_px.y > near_px.y, "{near_px} to {moved_px}");
        assert!(camera.elevation_rad > before.elevation_rad, "a drag down raises the eye");

        for pull_px in [1e5, -1e5] {
            camera.orbit(Vec2::new(3e5, pull_px), SIZE_PX);
            assert_eq!(camera.elevation_rad, FRAC_PI_2.copysign(pull_px));
            assert!(camera.azimuth_rad.abs() <= PI);
            assert!(camera.view_projection(SIZE_PX).is_finite());
            assert!((camera.up().length() - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn pan_follows_the_cursor() {
        for orthographic in [false, true] {
            let mut camera = askew(orthographic);
            let held_m = camera.at_target_m(Vec2::new(300.0, 500.0), SIZE_PX);
            camera.pan(Vec2::new(120.0, -45.0), SIZE_PX);
            let (px, _) = camera.project(held_m, SIZE_PX).unwrap();
            assert!(px.distance(Vec2::new(420.0, 455.0)) < 0.05, "{px}");
        }
    }

    #[test]
    fn zoom_keeps_what_is_under_the_cursor() {
        for orthographic in [false, true] {
            let mut camera = askew(orthographic);
            let cursor_px = Vec2::new(1100.0, 90.0);
            let held_m = camera.at_target_m(cursor_px, SIZE_PX);
            for factor in [1.25, 3.0, 0.2] {
                let before_m = camera.distance_m;
                camera.zoom(factor, cursor_px, SIZE_PX);
                assert!((camera.distance_m * factor / before_m - 1.0).abs() < 1e-5);
                let (px, _) = camera.project(held_m, SIZE_PX).unwrap();
                assert!(px.distance(cursor_px) < 0.1, "{px}");
            }
            let before = camera;
            for factor in [0.0, -1.0, f32::NAN, f32::INFINITY] {
                camera.zoom(factor, cursor_px, SIZE_PX);
            }
            assert_eq!(camera, before);
        }
    }

    #[test]
    fn zoom_ends_where_numbers_would() {
        let mut camera = askew(false);
        camera.zoom(1e30, SIZE_PX / 3.0, SIZE_PX);
        assert_eq!(camera.distance_m, *DISTANCE_M.start());
        camera.zoom(1e-30, SIZE_PX / 3.0, SIZE_PX);
        assert_eq!(camera.distance_m, *DISTANCE_M.end());
        assert!(camera.view_projection(SIZE_PX).is_finite());
    }

    #[test]
    fn flying_and_focusing_move_eye_and_target_alike() {
        let before = askew(false);
        let mut camera = before;
        camera.fly(Vec3::new(0.0, 1.0, 0.0), 2.0);
        assert!((camera.eye_m() - before.eye_m()).distance(before.forward() * 2.0) < 1e-5);
        camera.fly(Vec3::new(0.0, 0.0, -1.0), 0.5);
        assert!((camera.target_m.z - (before.target_m + before.forward() * 2.0).z + 0.5).abs() < 1e-5);

        camera.focus(Vec3::new(4.0, 5.0, 6.0));
        let (px, _) = camera.project(Vec3::new(4.0, 5.0, 6.0), SIZE_PX).unwrap();
        assert!(px.distance(SIZE_PX / 2.0) < 0.01);
        assert_eq!(camera.distance_m, before.distance_m);
    }
}
