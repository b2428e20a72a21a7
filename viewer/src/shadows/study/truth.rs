//! Where does the sun really reach? Each pixel of a view by rays: the truth that the maps are measured against.
//!
//! Method: the closest hit of the ray through the pixel's middle; from there, lifted off its surface as sensors are, one ray to
//! the sun's centre (a sun without extent, as the maps have it) and [`DISC_RAYS`] to places of its disc, which follow a sunflower's
//! spiral, each standing for as much of the disc, weighted by how bright it is there. The same places at every pixel, and
//! the same bits for any number of threads.
//!
//! Limits: opaque triangles alone are seen and cast, exactly those that the maps are drawn of; glazing is left out of both, and
//! so are the bodies of lights. The disc is not cut by the horizon.

use crate::shadows::View;
use glam::{Vec2, Vec3};
use lightvein::job::{Cancel, Cancelled};
use lightvein::rays::Rays;
use lightvein::scene::{Material, Mesh, Scene};
use lightvein::sky::disc::Disc;
use rayon::prelude::*;
use std::f32::consts::TAU;

/// Rays to the sun's disc from a pixel: a straight edge across it is found within a hundredth or two of its area.
pub const DISC_RAYS: usize = 32;

/// A pixel that lies as far inside a shadow, or in the light, has to have neighbours of its kind this far around.
const INSIDE_PX: usize = 3;

/// 1 - 1/golden ratio, in turns: the angle from one floret to the next.
const GOLDEN_TURN: f32 = 0.381_966;

/// What is in a view, and where the sun reaches it.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Width and height.
    pub size_px: [u32; 2],
    /// Rows from the top; `None` where nothing is seen.
    pub pixels: Vec<Option<Seen>>,
}

/// What is behind a pixel's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// How far along the gaze, metres.
    pub depth_m: f32,
    /// Of the side that is seen, of length one.
    pub normal: Vec3,
    /// Cosine of the sun's direction on that side; 0 and less where it faces away.
    pub cosine: f32,
    /// What it gets of the sun; `None` where it faces away, which needs no map to tell.
    pub sun: Option<Reached>,
}

/// How much of the sun reaches a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// Of a sun without extent: all or nothing, 1 or 0.
    pub hard: f32,
    /// Of the light of its disc, 0 to 1.
    pub disc: f32,
}

/// The opaque triangles of a scene, three corners each: what is seen and what casts shadows.
pub fn opaque_corners_m(scene: &Scene) -> Vec<Vec3> {
    let triangles = 0..scene.mesh.triangles.len();
    let opaque = triangles.filter(|&triangle| scene.material(triangle).is_none_or(|material| material.passes() <= 0.0));
    opaque.filter_map(|triangle| scene.mesh.corners_m(triangle)).flatten().collect()
}

/// The truth of a view on these triangles, three corners each. Some millions of rays a second.
///
/// # Errors
/// [`Cancelled`].
pub fn truth(corners_m: &[Vec3], view: &View, cancel: &Cancel) -> Result<Truth, Cancelled> {
    let rays = Rays::new(&scene_of(corners_m));
    let disc = Places::on_disc(view.towards_sun);
    let [wide, high] = view.size_px;
    let row = |y: u32| -> Result<Vec<Option<Seen>>, Cancelled> {
        cancel.check()?;
        Ok((0..wide).map(|x| seen(&rays, view, &disc, Vec2::new(x as f32, y as f32) + 0.5)).collect())
    };
    let rows = (0..high).into_par_iter().map(row).collect::<Result<Vec<_>, Cancelled>>()?;
    Ok(Truth { size_px: view.size_px, pixels: rows.concat() })
}

fn seen(rays: &Rays, view: &View, disc: &Places, at_px: Vec2) -> Option<Seen> {
    let size_px = Vec2::new(view.size_px[0] as f32, view.size_px[1] as f32);
    let (origin_m, direction) = view.camera.ray(at_px, size_px);
    let hit = rays.closest(origin_m, direction, f32::INFINITY)?;
    let (at_m, normal) = (origin_m + hit.distance_m * direction, hit.facing());
    let cosine = normal.dot(view.towards_sun);
    let sun = (cosine > 0.0).then(|| {
        let start_m = rays.off_surface(at_m, Some(normal));
        let reaches = |direction: Vec3| normal.dot(direction) > 0.0 && rays.from_afar(start_m, direction) > 0.0;
        let shares = disc.directions.iter().filter(|(direction, _)| reaches(*direction)).map(|(_, share)| share);
        Reached { hard: f32::from(u8::from(reaches(view.towards_sun))), disc: shares.sum::<f32>().min(1.0) }
    });
    Some(Seen { depth_m: view.camera.depth_m(at_m), normal, cosine, sun })
}

/// A scene of these triangles and nothing else.
fn scene_of(corners_m: &[Vec3]) -> Scene {
    let count = corners_m.len() as u32 / 3;
    let opaque = Material { name: String::new(), reflectance: 0.5, transmittance: 0.0, emission_w_m2_sr: 0.0 };
    let mesh = Mesh {
        positions_m: corners_m.to_vec(),
        triangles: (0..count).map(|triangle| [3 * triangle, 3 * triangle + 1, 3 * triangle + 2]).collect(),
        material_of: vec![0; count as usize],
    };
    Scene { mesh, materials: vec![opaque], ..Scene::default() }
}

/// Places of the sun's disc: unit vectors towards them, and the share of the light that each stands for; together 1.
struct Places {
    directions: Vec<(Vec3, f32)>,
}

impl Places {
    fn on_disc(towards_sun: Vec3) -> Self {
        let disc = Disc::new(1.0);
        let radius = (disc.angular_radius_rad as f32).tan();
        let (right, up) = towards_sun.any_orthonormal_pair();
        let place = |number: usize| {
            let from_centre = ((number as f32 + 0.5) / DISC_RAYS as f32).sqrt();
            let (sin, cos) = (TAU * GOLDEN_TURN * number as f32).sin_cos();
            let direction = towards_sun + radius * from_centre * (right * cos + up * sin);
            let light = disc.radiance_share_per_sr(disc.angular_radius_rad * f64::from(from_centre));
            (direction.normalize(), light)
        };
        let places: Vec<(Vec3, f64)> = (0..DISC_RAYS).map(place).collect();
        let whole: f64 = places.iter().map(|(_, light)| light).sum();
        Self { directions: places.into_iter().map(|(at, light)| (at, (light / whole) as f32)).collect() }
    }
}

impl Truth {
    /// Pixels that lie well inside a shadow, and pixels that lie as deep in the light: they and all in the 7 x 7 around them
    /// face the sun and get nothing of it, or all. In the order of the pixels.
    pub fn inside(&self) -> [Vec<bool>; 2] {
        [0.0, 1.0].map(|all| {
            let is_all = |seen: &Option<Seen>| {
                seen.and_then(|seen| seen.sun).is_some_and(|sun| sun.hard == all && (sun.disc - all).abs() < 1e-4)
            };
            self.eroded(&self.pixels.iter().map(is_all).collect::<Vec<_>>())
        })
    }

    /// Which pixels have none but marked ones in the square around them; those at the picture's edge have not.
    fn eroded(&self, marked: &[bool]) -> Vec<bool> {
        let wide = self.size_px[0] as usize;
        let along = runs(marked, wide, 1);
        runs(&along, self.size_px[1] as usize, wide)
    }
}

/// Which places have marked ones alone as far as [`INSIDE_PX`] before and behind them, along lines of so many places that are
/// `step` apart.
fn runs(marked: &[bool], count: usize, step: usize) -> Vec<bool> {
    let is_inside = |at: usize| {
        let place = at / step % count;
        let is_far_in = place >= INSIDE_PX && place + INSIDE_PX < count;
        let (first, last) = (at.saturating_sub(INSIDE_PX * step), at + INSIDE_PX * step);
        is_far_in && (first..=last).step_by(step).all(|at| marked.get(at).copied().unwrap_or(false))
    };
    (0..marked.len()).map(is_inside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Standard};

    const SIZE_PX: [u32; 2] = [90, 60];

    /// A square of side 2 half, at a height, about a middle.
    fn square(middle: Vec3, half: f32) -> Vec<Vec3> {
        let [a, b, c, d] =
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| middle + half * Vec3::new(x, y, 0.0));
        vec![a, b, c, a, c, d]
    }

    /// From above, on a ground of 20 m with a sheet of 4 m at a height of 3 m.
    fn view(towards_sun: Vec3) -> (Vec<Vec3>, View) {
        let mut camera = Camera::fitted((Vec3::splat(-10.0), Vec3::splat(10.0)), 1.5);
        camera.look_from(Standard::Top);
        camera.orthographic = true;
        let corners_m = [square(Vec3::ZERO, 10.0), square(Vec3::Z * 3.0, 2.0)].concat();
        (corners_m, View { camera, size_px: SIZE_PX, towards_sun: towards_sun.normalize() })
    }

    fn asked(corners_m: &[Vec3], view: &View) -> Truth {
        truth(corners_m, view, &Cancel::new()).unwrap()
    }

    #[test]
    fn a_sheet_shades_what_geometry_says() {
        // The sun in the east at 45 degrees: the shadow of the sheet lies 3 m west of it.
        let (corners_m, view) = view(Vec3::new(1.0, 0.0, 1.0));
        let truth = asked(&corners_m, &view);
        let size_px = Vec2::new(90.0, 60.0);
        let at = |point_m: Vec3| {
            let (px, _) = view.camera.project(point_m, size_px).unwrap();
            truth.pixels[px.y as usize * 90 + px.x as usize].unwrap()
        };
        for (x, hard) in [(-5.5, 1.0), (-4.3, 0.0), (-2.7, 0.0), (3.0, 1.0)] {
            let seen = at(Vec3::new(x, 0.4, 0.0));
            assert_eq!(seen.sun.map(|sun| sun.hard), Some(hard), "{x}");
            assert!((seen.cosine - 0.5f32.sqrt()).abs() < 1e-5);
        }
        // The top of the sheet is 3 m nearer than the ground.
        let nearer_m = at(Vec3::new(5.0, 0.4, 0.0)).depth_m - at(Vec3::new(0.4, 0.4, 3.0)).depth_m;
        assert!((nearer_m - 3.0).abs() < 1e-2, "{nearer_m}");
        assert_eq!(truth.pixels[0], None, "past the ground's edge");
    }

    #[test]
    fn sides_that_face_away_are_not_asked() {
        let (corners_m, mut view) = view(Vec3::new(1.0, 0.0, 1.0));
        view.camera.look_from(Standard::Bottom);
        let truth = asked(&corners_m, &view);
        let seen: Vec<&Seen> = truth.pixels.iter().flatten().collect();
        assert!(!seen.is_empty() && seen.iter().all(|seen| seen.sun.is_none() && seen.cosine < 0.0));
    }

    #[test]
    fn a_half_covered_disc_gives_half_and_the_light_of_all_places_is_one() {
        let places = Places::on_disc(Vec3::new(0.3, -0.5, 0.8).normalize());
        let sum: f32 = places.directions.iter().map(|(_, share)| share).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");

        // A wide sheet, its edge straight above: half of a sun at the zenith is hidden. A tenth of a radius aside it is not.
        let disc_rad = Disc::new(1.0).angular_radius_rad as f32;
        let share = |edge_radii: f32| {
            let (_, view) = view(Vec3::Z);
            let places = Places::on_disc(view.towards_sun);
            let free = places.directions.iter().filter(|(at, _)| at.x > edge_radii * disc_rad);
            free.map(|(_, share)| share).sum::<f32>()
        };
        assert!((share(0.0) - 0.5).abs() < 0.03, "{}", share(0.0));
        assert!(share(-1.01) > 0.9999 && share(1.01) == 0.0);
    }

    #[test]
    fn penumbras_are_as_wide_as_the_sun() {
        // A sheet 3 m up under the zenith: 28 mm from the first dimming to the last, half of it at the edge.
        let (corners_m, mut view) = view(Vec3::Z);
        view.camera.target_m = Vec3::new(2.0, 0.0, 0.0);
        // Between ground and sheet, so that the edge is seen from below it.
        view.camera.orthographic = false;
        view.camera.distance_m = 1.0;
        view.camera.field_of_view_rad = 0.1;
        let truth = asked(&corners_m, &view);
        let row: Vec<f32> = truth.pixels[30 * 90..31 * 90].iter().map(|seen| seen.unwrap().sun.unwrap().disc).collect();
        let partly = row.iter().filter(|share| (0.01..0.99).contains(*share)).count() as f32;
        let mm_per_px = 1000.0 * 2.0 * 0.05f32.tan() / 60.0;
        let want_mm = 1000.0 * 3.0 * 2.0 * Disc::new(1.0).angular_radius_rad.tan() as f32;
        assert!((partly * mm_per_px / want_mm - 1.0).abs() < 0.2, "{} mm for {want_mm}", partly * mm_per_px);
        assert!(row[0] == 0.0 && row[89] > 0.999);
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let (corners_m, view) = view(Vec3::new(0.3, 0.2, 0.4));
        let of = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| asked(&corners_m, &view))
        };
        assert_eq!(of(1), of(3));
    }

    #[test]
    fn inside_is_three_pixels_from_any_edge() {
        let size_px = [12, 9];
        let sun =
            |disc| Some(Seen { depth_m: 1.0, normal: Vec3::Z, cosine: 1.0, sun: Some(Reached { hard: 0.0, disc }) });
        let mut truth = Truth { size_px, pixels: vec![sun(0.0); 12 * 9] };
        let inside = |truth: &Truth| -> Vec<usize> {
            let [shadow, light] = truth.inside();
            assert!(!light.contains(&true));
            (0..12 * 9).filter(|&at| shadow[at]).collect()
        };
        // Columns 3 to 8 of rows 3 to 5.
        assert_eq!(inside(&truth).len(), 6 * 3);
        // Half a shadow at column 0 of row 4 costs nothing, at column 1 the pixels about column 3.
        truth.pixels[4 * 12] = sun(0.5);
        assert_eq!(inside(&truth).len(), 15);
        truth.pixels[4 * 12] = sun(0.0);
        truth.pixels[0] = None;
        assert_eq!(inside(&truth).len(), 17);
    }

    #[test]
    fn a_raised_flag_stops_it() {
        let (corners_m, view) = view(Vec3::Z);
        let cancel = Cancel::new();
        cancel.cancel();
        assert_eq!(truth(&corners_m, &view, &cancel), Err(Cancelled));
    }
}
