//! What does a camera see of a scene: how far away is the surface behind each pixel, and which way does it face?
//!
//! A pinhole camera and its buffers, rendered by one ray through the middle of each pixel. Pixels are counted by rows from the
//! top, each row from the left. Up in a picture is +Z; a camera that looks straight up or down has +Y (north) at the top.
//!
//! Cost: a ray a pixel, all near their neighbours: some 0.2 us each and thread.
//! Limits: one sample a pixel, so edges are stepped; glazing is seen as a surface; no lens.

mod buffers;

pub use buffers::Buffers;

use super::cast::is_inside;
use crate::rays::Rays;
use crate::scene::Mesh;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Width and height of a picture that nobody gave a size, pixels.
pub const DEFAULT_SIZE: [usize; 2] = [800, 600];

/// Vertical field of view of a camera that nobody gave one.
pub const DEFAULT_FOV_RAD: f64 = 40.0 / 180.0 * PI;

/// Fields of view that are accepted: outside them a picture shows a point, or mostly its own corners.
const FOV_RAD: [f64; 2] = [PI / 180.0, 170.0 / 180.0 * PI];

/// Longest side of a picture, pixels: 1.6 GB of buffers for a square.
const MOST_PX: usize = 10_000;

/// Nearest that what is looked at may be, metres.
const NEAREST_M: f64 = 1e-3;

/// Farthest that a camera may stand, in lifts off surfaces ([`Rays::epsilon_m`]): 40 times a small scene's largest coordinate.
/// Beyond, rounding puts hits farther under their surfaces than the lift.
const FARTHEST_EPSILONS: f32 = 4e6;

/// Sine of the angle to the vertical below which a camera looks straight up or down.
const STRAIGHT: f64 = 1e-4;

/// Room left about the scene in the default view, as a share of it.
const MARGIN: f64 = 0.04;

/// What reaches no higher than this share of a scene's height is its ground.
const GROUND: f32 = 0.1;

/// Where the default view stands, seen from the scene: south-south-west and well above, where the sun is in the north's
/// afternoon.
const VIEW: DVec3 = DVec3::new(-0.45, -0.9, 0.75);

/// Why there is no such camera.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A coordinate is not finite.
    #[error("the camera's {0} is not a finite position")]
    NotFinite(&'static str),
    /// It looks at itself.
    #[error("the camera stands {0:.4} m from what it looks at; at least 0.001 m are needed")]
    NoDirection(f64),
    /// A field of view without an angle, or with too wide a one.
    #[error("the camera's field of view of {0} degrees is outside 1 to 170")]
    FieldOfView(f64),
    /// A picture without pixels, or with too many.
    #[error("a picture of {0} x {1} pixels is outside 1 to 10000 either way")]
    Size(usize, usize),
    /// Too far for the scene's precision.
    #[error(
        "the camera stands {0:.0} m from the middle of the scene; beyond {1:.0} m its surfaces are lost in rounding"
    )]
    TooFar(f32, f32),
    /// Matter all around.
    #[error("the camera stands inside matter: it sees the backs of surfaces in most directions")]
    InSolid,
}

/// A pinhole camera in a scene. The three axes are unit vectors at right angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Where it stands, metres.
    pub from_m: Vec3,
    /// Into the picture.
    pub forward: Vec3,
    /// To the right in the picture.
    pub right: Vec3,
    /// Up in the picture.
    pub up: Vec3,
    /// Angle from the lower edge of the picture to the upper one.
    pub fov_rad: f64,
    /// Width and height of the picture, pixels.
    pub size: [usize; 2],
}

impl Camera {
    /// The camera at `from_m` with `to_m` in the middle of its picture. `fov_rad` is the vertical field of view.
    ///
    /// # Errors
    /// [`CameraError`] for places that are not finite or are one, a field of view outside 1 to 170 degrees, and sides of the
    /// picture outside 1 to 10000 pixels.
    pub fn new(from_m: Vec3, to_m: Vec3, fov_rad: f64, size: [usize; 2]) -> Result<Self, CameraError> {
        for (what, at_m) in [("from", from_m), ("to", to_m)] {
            if !at_m.is_finite() {
                return Err(CameraError::NotFinite(what));
            }
        }
        let towards_m = to_m.as_dvec3() - from_m.as_dvec3();
        if towards_m.length() < NEAREST_M {
            return Err(CameraError::NoDirection(towards_m.length()));
        }
        // A degree that went to radians and back may miss its bound by a rounding.
        let slack_rad = 1e-9;
        if !(FOV_RAD[0] - slack_rad..=FOV_RAD[1] + slack_rad).contains(&fov_rad) {
            return Err(CameraError::FieldOfView((fov_rad.to_degrees() * 1e6).round() / 1e6));
        }
        if !size.iter().all(|side| (1..=MOST_PX).contains(side)) {
            return Err(CameraError::Size(size[0], size[1]));
        }
        let forward = towards_m.normalize();
        let is_straight = forward.truncate().length() < STRAIGHT;
        let right = forward.cross(if is_straight { DVec3::Y } else { DVec3::Z }).normalize();
        let up = right.cross(forward).normalize();
        let [forward, right, up] = [forward, right, up].map(|axis| axis.as_vec3());
        Ok(Self { from_m, forward, right, up, fov_rad, size })
    }

    /// The view of all that lies in the box from `low_m` to `high_m`, from the south-south-west and above.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn around(low_m: Vec3, high_m: Vec3, fov_rad: f64, size: [usize; 2]) -> Result<Self, CameraError> {
        let [low_m, high_m] = [low_m, high_m].map(|corner| corner.as_dvec3());
        let middle_m = (low_m + high_m) / 2.0;
        let half_m = ((high_m - low_m) / 2.0).max(DVec3::splat(NEAREST_M));
        let back = VIEW.normalize();
        let aimed = Self::new((middle_m + half_m.length() * back).as_vec3(), middle_m.as_vec3(), fov_rad, size)?;

        // The pyramid of view holds each corner of the box where it is no farther aside than the tangent of its depth: from how
        // near can it hold all of them?
        let [right, up, forward] = [aimed.right, aimed.up, aimed.forward].map(Vec3::as_dvec3);
        let corners = (0..8_u8).map(|corner| {
            let side = |axis: u8| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
            half_m * DVec3::new(side(0), side(1), side(2))
        });
        let needed_m = |axis: DVec3, tangent: f64| {
            let edge = |side: f64| {
                let reach = |at_m: DVec3| side * at_m.dot(axis) - tangent * at_m.dot(forward);
                corners.clone().map(reach).fold(f64::NEG_INFINITY, f64::max)
            };
            (edge(1.0) + edge(-1.0)) / (2.0 * tangent)
        };
        let [wide, high] = aimed.tangents();
        let needed_m = needed_m(right, wide).max(needed_m(up, high)).max(half_m.length() * MARGIN);
        let distance_m = needed_m * (1.0 + MARGIN);

        // And with as much room on one side as on the other: by halves, as nearer corners are seen farther aside.
        let centred_m = |axis: DVec3| {
            let room = |aside_m: f64, side: f64| {
                let seen = |at_m: DVec3| side * (at_m.dot(axis) - aside_m) / (distance_m + at_m.dot(forward));
                corners.clone().map(seen).fold(f64::NEG_INFINITY, f64::max)
            };
            let mut between_m = [-half_m.length(), half_m.length()];
            for _ in 0..50 {
                let aside_m = (between_m[0] + between_m[1]) / 2.0;
                let is_short = room(aside_m, 1.0) > room(aside_m, -1.0);
                between_m[if is_short { 0 } else { 1 }] = aside_m;
            }
            between_m[0]
        };
        let to_m = middle_m + centred_m(right) * right + centred_m(up) * up;
        Self::new((to_m + distance_m * back).as_vec3(), to_m.as_vec3(), fov_rad, size)
    }

    /// The default view of a mesh: of what stands on its ground, and of the ground about that for as far as it is high; `None`
    /// without faces.
    pub fn of_mesh(mesh: &Mesh, fov_rad: f64, size: [usize; 2]) -> Option<Result<Self, CameraError>> {
        let (low_m, high_m) = mesh.bounds_m()?;
        let ground_m = low_m.z + GROUND * (high_m.z - low_m.z);
        let standing = mesh.triangles.iter().flatten().filter_map(|&vertex| mesh.positions_m.get(vertex as usize));
        let (near_m, far_m) = standing
            .filter(|at_m| at_m.z >= ground_m)
            .fold((high_m, low_m), |(near_m, far_m), &at_m| (near_m.min(at_m), far_m.max(at_m)));
        let about_m = Vec3::splat(high_m.z - low_m.z);
        let (near_m, far_m) = ((near_m - about_m).max(low_m), (far_m + about_m).min(high_m));
        Some(Self::around(near_m, far_m, fov_rad, size))
    }

    /// Whether a picture can be taken from where it stands.
    ///
    /// # Errors
    /// [`CameraError`] inside matter, and too far from the scene for its precision.
    pub fn check(&self, rays: &Rays) -> Result<(), CameraError> {
        let (away_m, farthest_m) = (self.from_m.length(), FARTHEST_EPSILONS * rays.epsilon_m());
        if away_m > farthest_m {
            return Err(CameraError::TooFar(away_m, farthest_m));
        }
        if is_inside(rays, self.from_m) { Err(CameraError::InSolid) } else { Ok(()) }
    }

    /// How many pixels the picture has.
    pub fn pixels(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// The unit direction of the ray through the middle of a pixel; row 0 is the top one.
    pub fn ray(&self, column: usize, row: usize) -> Vec3 {
        self.along(column, row).normalize()
    }

    /// The same ray where it is as long as its part along the camera's forward axis is 1: a depth times this, from the camera, is
    /// a place.
    pub fn along(&self, column: usize, row: usize) -> Vec3 {
        let [wide, high] = self.tangents();
        let part = |at: usize, side: usize| 2.0 * (at as f64 + 0.5) / side as f64 - 1.0;
        let (x, y) = (part(column, self.size[0]) * wide, -part(row, self.size[1]) * high);
        self.forward + x as f32 * self.right + y as f32 * self.up
    }

    /// What is behind a pixel: its depth along the forward axis, metres, and its normal on the side that is seen.
    pub fn look(&self, rays: &Rays, column: usize, row: usize) -> Option<(f32, Vec3)> {
        let direction = self.ray(column, row);
        let hit = rays.closest(self.from_m, direction, f32::INFINITY)?;
        Some((hit.distance_m * direction.dot(self.forward), hit.facing()))
    }

    /// Where in the picture a place is seen: columns and rows from the upper left corner (the middle of the first pixel is at
    /// 0.5, 0.5), and its depth along the forward axis, metres; `None` for places not before the camera.
    pub fn seen_at(&self, at_m: Vec3) -> Option<([f32; 2], f32)> {
        let to_m = at_m - self.from_m;
        let depth_m = to_m.dot(self.forward);
        if depth_m <= 0.0 {
            return None;
        }
        let focal_px = self.focal_px();
        let column = self.size[0] as f32 / 2.0 + focal_px * to_m.dot(self.right) / depth_m;
        let row = self.size[1] as f32 / 2.0 - focal_px * to_m.dot(self.up) / depth_m;
        Some(([column, row], depth_m))
    }

    /// Pixels that a metre across the view takes at a depth of a metre.
    pub fn focal_px(&self) -> f32 {
        (self.size[1] as f64 / (2.0 * (self.fov_rad / 2.0).tan())) as f32
    }

    /// Tangents of half the angles of view, across and up.
    fn tangents(&self) -> [f64; 2] {
        let high = (self.fov_rad / 2.0).tan();
        [high * self.size[0] as f64 / self.size[1] as f64, high]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::scene::Scene;

    /// A ground at a height, 20 m a side, and a wall over it that stands at y = 5 m.
    pub fn ground_and_wall(z: f32) -> Scene {
        let ground = [(-10.0, -10.0, z), (10.0, -10.0, z), (10.0, 10.0, z), (-10.0, 10.0, z)];
        let wall = [(-10.0, 5.0, z), (10.0, 5.0, z), (10.0, 5.0, z + 4.0), (-10.0, 5.0, z + 4.0)];
        Scene {
            mesh: Mesh {
                positions_m: ground.into_iter().chain(wall).map(Vec3::from).collect(),
                triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
                material_of: vec![0; 4],
            },
            ..Scene::default()
        }
    }

    #[test]
    fn places_are_seen_where_their_pixels_are() {
        let camera = Camera::new(Vec3::new(3.0, -4.0, 5.0), Vec3::new(-1.0, 2.0, 0.5), 0.8, [17, 9]).unwrap();
        for (column, row) in [(0, 0), (16, 8), (5, 7)] {
            let at_m = camera.from_m + 7.0 * camera.along(column, row);
            let ([x, y], depth_m) = camera.seen_at(at_m).unwrap();
            assert!((x - column as f32 - 0.5).abs() < 1e-4 && (y - row as f32 - 0.5).abs() < 1e-4, "{x} {y}");
            assert!((depth_m - 7.0).abs() < 1e-5);
        }
        assert_eq!(camera.seen_at(camera.from_m - camera.forward), None);
    }

    #[test]
    fn the_default_view_holds_the_box_and_little_more() {
        for (low_m, high_m) in
            [(Vec3::splat(-1.0), Vec3::ONE), (Vec3::new(-500.0, -20.0, 0.0), Vec3::new(500.0, 80.0, 9.0))]
        {
            let camera = Camera::around(low_m, high_m, DEFAULT_FOV_RAD, DEFAULT_SIZE).unwrap();
            let [mut least, mut most] = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];
            for corner in 0..8 {
                let pick = |axis: usize| if corner >> axis & 1 == 0 { low_m[axis] } else { high_m[axis] };
                let (at, _) = camera.seen_at(Vec3::new(pick(0), pick(1), pick(2))).unwrap();
                for axis in 0..2 {
                    least[axis] = least[axis].min(at[axis]);
                    most[axis] = most[axis].max(at[axis]);
                }
            }
            assert!(least[0] >= 0.0 && least[1] >= 0.0 && most[0] <= 800.0 && most[1] <= 600.0, "{least:?} {most:?}");
            let filled = ((most[0] - least[0]) / 800.0).max((most[1] - least[1]) / 600.0);
            assert!(filled > 0.9, "{filled}");
            for (axis, side) in [(0, 800.0), (1, 600.0)] {
                assert!((least[axis] + most[axis] - side).abs() < 1.0, "in the middle: {least:?} {most:?}");
            }
        }
    }

    #[test]
    fn a_wide_ground_does_not_make_what_stands_on_it_small() {
        let mut mesh = ground_and_wall(0.0).mesh;
        mesh.positions_m[..4].iter_mut().for_each(|ground_m| *ground_m *= 100.0);
        let camera = Camera::of_mesh(&mesh, DEFAULT_FOV_RAD, DEFAULT_SIZE).unwrap().unwrap();
        let [left, right] = [4, 5].map(|vertex| camera.seen_at(mesh.positions_m[vertex]).unwrap().0[0]);
        assert!((300.0..800.0).contains(&(right - left)), "{left} {right}");
        assert!(Camera::of_mesh(&Mesh::default(), DEFAULT_FOV_RAD, DEFAULT_SIZE).is_none());
    }

    #[test]
    fn impossible_cameras_are_refused_with_their_bound() {
        #[track_caller]
        fn refused(from_m: Vec3, to_m: Vec3, fov_deg: f64, size: [usize; 2], want: &str) {
            let error = Camera::new(from_m, to_m, fov_deg.to_radians(), size).unwrap_err().to_string();
            assert!(error.contains(want), "{error}");
        }
        let [here, there] = [Vec3::ZERO, Vec3::X];
        refused(here, here, 40.0, [8, 8], "stands 0.0000 m from what it looks at");
        refused(here, Vec3::X * f32::NAN, 40.0, [8, 8], "camera's to is not a finite position");
        for fov_deg in [0.0, 180.0, -3.0, f64::NAN] {
            refused(here, there, fov_deg, [8, 8], "degrees is outside 1 to 170");
        }
        refused(here, there, 40.0, [0, 8], "a picture of 0 x 8 pixels is outside 1 to 10000");
        refused(here, there, 40.0, [8, 10_001], "10001 pixels");
        for fov_deg in [1.0_f64, 170.0] {
            assert!(Camera::new(here, there, fov_deg.to_radians(), [1, 10_000]).is_ok());
        }
        let rays = Rays::new(&ground_and_wall(0.0));
        let far = Camera::new(Vec3::Z * 1e4, here, 0.5, [8, 8]).unwrap();
        assert!(
            far.check(&rays).unwrap_err().to_string().contains("10000 m from the middle of the scene; beyond 400 m")
        );
        assert_eq!(Camera::new(Vec3::Z * 9.0, here, 0.5, [8, 8]).unwrap().check(&rays), Ok(()));
    }
}
