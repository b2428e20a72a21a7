//! Where the eye is and what it sees: a turntable camera, free of window and GPU.
//!
//! Space: the scene's own, metres, Z up, right-handed. Pixels count from the picture's upper left corner, x to the
//! right and y down; `size_px` is the picture's width and height. The camera circles a target point; nothing ever
//! tilts the horizon. Both projections show what lies at the target's depth at the same size.
//!
//! Depth is reversed (1 at the nearest, 0 infinitely far), as a float's precision wants it: the same share of the
//! distance can be told apart inside a room and over a city, and no bounds of the scene are needed.

mod drag;
mod motion;

use std::f32::consts::{FRAC_PI_2, PI};

use glam::camera::rh::proj::directx;
use glam::{Mat4, Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Vertical field of view of a new camera, 40 degrees: wide enough for rooms, and straight lines look straight.
const FIELD_OF_VIEW_RAD: f32 = 40.0 * PI / 180.0;
/// Nearest distance drawn in perspective, as a share of the distance to the target, and at most in metres. Reversed
/// depth loses nothing by a small one.
const NEAR_SHARE: f32 = 0.01;
const NEAR_MOST_M: f32 = 0.01;
/// How far a parallel projection sees before and behind the target: metres, and distances to the target besides.
/// A city zoomed in on one window is still drawn whole; one step of depth is then about 1/8 mm.
const REACH_M: f32 = 1000.0;
const REACH_DISTANCES: f32 = 100.0;
/// Distances from eye to target: finite pictures of anything from a grain to a country.
const DISTANCE_M: std::ops::RangeInclusive<f32> = 1e-3..=1e6;

/// A turntable camera. Any finite values draw; angles are in radians.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// What the eye looks at and circles.
    pub target_m: Vec3,
    /// Of the eye as seen from the target, from +X counter-clockwise.
    pub azimuth_rad: f32,
    /// Of the eye above the target's horizon, -pi/2 to pi/2.
    pub elevation_rad: f32,
    /// From eye to target.
    pub distance_m: f32,
    /// Vertical, of the whole picture.
    pub field_of_view_rad: f32,
    /// Parallel rays: as large as the perspective shows the target.
    pub orthographic: bool,
}

/// The directions to look from that have a name. North is +Y, east +X.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Standard {
    /// From the south (-Y).
    Front,
    /// From the east (+X).
    Right,
    /// From above, north up.
    Top,
    /// From the north (+Y).
    Back,
    /// From the west (-X).
    Left,
    /// From below, south up.
    Bottom,
    /// From above the south-east.
    Oblique,
}

impl Standard {
    /// All of them, as menus list them.
    pub const ALL: [Standard; 7] = [
        Standard::Front,
        Standard::Right,
        Standard::Top,
        Standard::Back,
        Standard::Left,
        Standard::Bottom,
        Standard::Oblique,
    ];

    /// As menus and the command line call it.
    pub fn name(self) -> &'static str {
        match self {
            Standard::Front => "front",
            Standard::Right => "right",
            Standard::Top => "top",
            Standard::Back => "back",
            Standard::Left => "left",
            Standard::Bottom => "bottom",
            Standard::Oblique => "oblique",
        }
    }

    /// Azimuth and elevation of the eye, radians.
    fn angles_rad(self) -> (f32, f32) {
        match self {
            Standard::Front => (-FRAC_PI_2, 0.0),
            Standard::Right => (0.0, 0.0),
            Standard::Top => (-FRAC_PI_2, FRAC_PI_2),
            Standard::Back => (FRAC_PI_2, 0.0),
            Standard::Left => (PI, 0.0),
            Standard::Bottom => (-FRAC_PI_2, -FRAC_PI_2),
            Standard::Oblique => (-55.0 * PI / 180.0, 35.0 * PI / 180.0),
        }
    }
}

impl Camera {
    /// Unit vector from target to eye.
    fn outward(&self) -> Vec3 {
        let (sin_azimuth, cos_azimuth) = self.azimuth_rad.sin_cos();
        let (sin_elevation, cos_elevation) = self.elevation_rad.sin_cos();
        Vec3::new(cos_elevation * cos_azimuth, cos_elevation * sin_azimuth, sin_elevation)
    }

    /// Where the eye is. In a parallel projection it stands for the picture's middle only.
    pub fn eye_m(&self) -> Vec3 {
        self.target_m + self.outward() * self.distance_m
    }

    /// Unit vector of the gaze.
    pub fn forward(&self) -> Vec3 {
        -self.outward()
    }

    /// Unit vector to the picture's right; always level, and defined at the poles too.
    pub fn right(&self) -> Vec3 {
        let (sin_azimuth, cos_azimuth) = self.azimuth_rad.sin_cos();
        Vec3::new(-sin_azimuth, cos_azimuth, 0.0)
    }

    /// Unit vector to the picture's top.
    pub fn up(&self) -> Vec3 {
        self.right().cross(self.forward())
    }

    /// Scene to view space: x right, y up, z towards the viewer, the eye at the origin.
    pub fn view(&self) -> Mat4 {
        let (right, up, back, eye_m) = (self.right(), self.up(), self.outward(), self.eye_m());
        let turned = Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), glam::Vec4::W);
        turned.transpose() * Mat4::from_translation(-eye_m)
    }

    /// View to clip space, depth reversed: 1 at the near plane; 0 infinitely far (perspective) or at the far end of a
    /// parallel projection's reach.
    pub fn projection(&self, size_px: Vec2) -> Mat4 {
        if !self.orthographic {
            return directx::perspective_infinite_reverse(self.field_of_view_rad, aspect(size_px), self.near_m());
        }
        let (half_height_m, reach_m) = (self.half_height_m(), self.reach_m());
        let half_width_m = half_height_m * aspect(size_px);

        // Far and near change places: that reverses the depth.
        let far_m = self.distance_m + reach_m;
        let near_m = self.distance_m - reach_m;
        directx::orthographic(-half_width_m, half_width_m, -half_height_m, half_height_m, far_m, near_m)
    }

    /// Scene to clip space.
    pub fn view_projection(&self, size_px: Vec2) -> Mat4 {
        self.projection(size_px) * self.view()
    }

    /// The nearest distance from the eye that a perspective draws.
    pub fn near_m(&self) -> f32 {
        (self.distance_m * NEAR_SHARE).min(NEAR_MOST_M)
    }

    /// How far before and behind the target a parallel projection sees.
    pub fn reach_m(&self) -> f32 {
        REACH_M + REACH_DISTANCES * self.distance_m
    }

    /// Half of the picture's height at the target's depth.
    fn half_height_m(&self) -> f32 {
        self.distance_m * (self.field_of_view_rad / 2.0).tan()
    }

    /// How far a point lies from the eye along the gaze; negative behind it.
    pub fn depth_m(&self, point_m: Vec3) -> f32 {
        self.distance_m + (point_m - self.target_m).dot(self.forward())
    }

    /// What one pixel measures at a point's depth. Zero or less at and behind the eye of a perspective.
    pub fn metres_per_px(&self, point_m: Vec3, size_px: Vec2) -> f32 {
        let at_target_m = 2.0 * self.half_height_m() / size_px.y.max(1.0);
        if self.orthographic { at_target_m } else { at_target_m * self.depth_m(point_m) / self.distance_m }
    }

    /// Where a point appears: its pixel (which may lie outside the picture) and its depth as the picture's depth
    /// buffer holds it, the larger the nearer. None before the nearest or beyond the farthest depth drawn.
    pub fn project(&self, point_m: Vec3, size_px: Vec2) -> Option<(Vec2, f32)> {
        let clip = self.view_projection(size_px) * point_m.extend(1.0);
        let depth = clip.z / clip.w;
        let drawn = clip.w > 0.0 && (0.0..=1.0).contains(&depth);
        drawn.then(|| (Vec2::new(1.0 + clip.x / clip.w, 1.0 - clip.y / clip.w) * size_px / 2.0, depth))
    }

    /// What lies under a pixel: origin and unit direction of its ray. In perspective the origin is the eye, in a
    /// parallel projection the nearest point drawn.
    pub fn ray(&self, cursor_px: Vec2, size_px: Vec2) -> (Vec3, Vec3) {
        let at_target_m = self.at_target_m(cursor_px, size_px);
        if self.orthographic {
            return (at_target_m - self.forward() * self.reach_m(), self.forward());
        }
        let eye_m = self.eye_m();
        (eye_m, (at_target_m - eye_m).normalize())
    }

    /// The point under a pixel at the target's depth.
    fn at_target_m(&self, cursor_px: Vec2, size_px: Vec2) -> Vec3 {
        let from_middle_px = cursor_px - size_px / 2.0;
        let metres_per_px = self.metres_per_px(self.target_m, size_px);
        self.target_m + (self.right() * from_middle_px.x - self.up() * from_middle_px.y) * metres_per_px
    }
}

/// Width over height; one for a picture of no size.
fn aspect(size_px: Vec2) -> f32 {
    if size_px.min_element() > 0.0 { size_px.x / size_px.y } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) const SIZE_PX: Vec2 = Vec2::new(1280.0, 800.0);

    /// A camera askew, so that no axis is special.
    pub(super) fn askew(orthographic: bool) -> Camera {
        Camera {
            target_m: Vec3::new(1.0, -2.0, 0.5),
            azimuth_rad: 0.7,
            elevation_rad: 0.4,
            distance_m: 6.0,
            field_of_view_rad: FIELD_OF_VIEW_RAD,
            orthographic,
        }
    }

    #[test]
    fn the_axes_are_the_named_ones() {
        let check = |standard, forward: Vec3, up: Vec3| {
            let mut camera = askew(false);
            camera.look_from(standard);
            assert!(camera.forward().distance(forward) < 1e-6, "{standard:?} looks {}", camera.forward());
            assert!(camera.up().distance(up) < 1e-6, "{standard:?} has {} up", camera.up());
        };
        check(Standard::Front, Vec3::Y, Vec3::Z);
        check(Standard::Right, Vec3::NEG_X, Vec3::Z);
        check(Standard::Back, Vec3::NEG_Y, Vec3::Z);
        check(Standard::Left, Vec3::X, Vec3::Z);
        check(Standard::Top, Vec3::NEG_Z, Vec3::Y);
        check(Standard::Bottom, Vec3::Z, Vec3::NEG_Y);
    }

    #[test]
    fn the_view_space_is_right_handed_with_the_eye_at_its_origin() {
        let camera = askew(false);
        let view = camera.view();
        assert!(view.transform_point3(camera.eye_m()).length() < 1e-5);
        assert!(view.transform_vector3(camera.right()).distance(Vec3::X) < 1e-6);
        assert!(view.transform_vector3(camera.up()).distance(Vec3::Y) < 1e-6);
        assert!(view.transform_vector3(camera.forward()).distance(Vec3::NEG_Z) < 1e-6);
    }

    #[test]
    fn the_target_is_in_the_middle_and_higher_is_further_up() {
        for orthographic in [false, true] {
            let camera = askew(orthographic);
            let (px, _) = camera.project(camera.target_m, SIZE_PX).unwrap();
            assert!(px.distance(SIZE_PX / 2.0) < 0.01, "{px}");
            let (above_px, _) = camera.project(camera.target_m + Vec3::Z, SIZE_PX).unwrap();
            assert!(above_px.y < px.y - 10.0);
        }
    }

    #[test]
    fn a_ray_passes_through_the_point_that_projects_there() {
        for orthographic in [false, true] {
            let camera = askew(orthographic);
            for point_m in [Vec3::ZERO, Vec3::new(2.0, -1.0, 1.5), Vec3::new(0.3, -4.0, -2.0)] {
                let (px, _) = camera.project(point_m, SIZE_PX).unwrap();
                let (origin_m, direction) = camera.ray(px, SIZE_PX);
                let missed_m = (point_m - origin_m).cross(direction).length();
                assert!(missed_m < 2e-3, "missed {point_m} by {missed_m} m, orthographic: {orthographic}");
                assert!((point_m - origin_m).dot(direction) > 0.0);
            }
        }
    }

    #[test]
    fn nearer_is_deeper_and_what_is_behind_the_eye_is_not_drawn() {
        for orthographic in [false, true] {
            let camera = askew(orthographic);
            let depth = |metres| camera.project(camera.target_m + camera.forward() * metres, SIZE_PX).unwrap().1;
            assert!(depth(-1.0) > depth(0.0) && depth(0.0) > depth(1.0) && depth(1.0) > depth(500.0));
        }
        let camera = askew(false);
        assert_eq!(camera.project(camera.eye_m() - camera.forward(), SIZE_PX), None);
    }

    #[test]
    fn a_pixel_measures_the_same_at_the_target_in_both_projections() {
        let (perspective, parallel) = (askew(false), askew(true));
        let target_m = perspective.target_m;
        let metres_per_px = perspective.metres_per_px(target_m, SIZE_PX);
        assert!((metres_per_px / parallel.metres_per_px(target_m, SIZE_PX) - 1.0).abs() < 1e-6);

        // A point that many metres to the right appears one pixel to the right.
        for camera in [perspective, parallel] {
            let (px, _) = camera.project(target_m + camera.right() * metres_per_px * 100.0, SIZE_PX).unwrap();
            assert!((px.x - SIZE_PX.x / 2.0 - 100.0).abs() < 0.05, "{px}");
        }
        let farther_m = target_m + perspective.forward() * perspective.distance_m;
        assert!((perspective.metres_per_px(farther_m, SIZE_PX) - 2.0 * metres_per_px).abs() < 1e-6);
    }
}
