//! Pictures of sun, sky and exposure for the view: plain data for `paint`, and names beside them.

use super::light::in_scene;
use super::sky::Sky;
use super::sun::{DOME, SunDay, SunNow, dome_corner};
use super::{FaceExposure, PixelExposure, values_of};
use crate::colour::Scale;
use crate::paint::{Ball, Batch, Corner, Culling, FaceStyle, Stroke, Tint, What};
use glam::{DVec3, Vec3};
use lightvein::daylight::Quantity;
use lightvein::export::sun_path::{SunPath, above_horizon};
use lightvein::sky::{Sun, towards};
use std::sync::Arc;

/// Radius of the dome in half diagonals of the scene: outside of all that stands in it.
const DOME_RADII: f32 = 1.2;

/// The sun's radius, in radii of the dome: five times its own, to be seen.
const SUN_RADII: f32 = 0.025;

const SUN: [u8; 4] = [255, 214, 64, 255];
const SUN_DOWN: [u8; 4] = [110, 100, 130, 255];
const DAY: [u8; 4] = [255, 176, 0, 255];
const YEAR: [u8; 4] = [250, 246, 230, 150];
const HOURS: [u8; 4] = [250, 246, 230, 90];
const HORIZON: [u8; 4] = [150, 150, 150, 255];

/// Days of the year whose paths stand beside the shown one, as the library's sun paths name them.
const SEASONS: [&str; 3] = ["21 Dec", "21 Mar", "21 Jun"];

/// Where the dome stands in the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dome {
    /// Its middle, on the ground, metres.
    pub middle_m: Vec3,
    /// Its radius, metres.
    pub radius_m: f32,
    /// Direction of true north, clockwise from +Y.
    pub north_rad: f64,
}

impl Dome {
    /// The dome about a scene within these bounds.
    pub fn about((low_m, high_m): (Vec3, Vec3), north_rad: f64) -> Self {
        let middle_m = ((low_m + high_m) / 2.0).with_z(low_m.z);
        let radius_m = DOME_RADII * ((high_m - low_m) / 2.0).length().max(1e-3);
        Self { middle_m, radius_m, north_rad }
    }

    /// The box around it, metres.
    pub fn bounds_m(&self) -> (Vec3, Vec3) {
        let flat_m = Vec3::new(self.radius_m, self.radius_m, 0.0);
        (self.middle_m - flat_m, self.middle_m + flat_m + Vec3::Z * self.radius_m)
    }

    /// A direction (x east, y true north, z up) in the scene.
    pub fn direction(&self, direction: DVec3) -> Vec3 {
        in_scene(self.north_rad, direction).as_vec3()
    }

    /// Where a direction meets it.
    pub fn at(&self, direction: DVec3) -> Vec3 {
        self.middle_m + self.radius_m * self.direction(direction)
    }
}

/// A dome to be drawn, and the names beside its lines.
#[derive(Debug, Clone, Default)]
pub struct Drawn {
    /// What is drawn.
    pub batches: Vec<Batch>,
    /// Names, and where they stand.
    pub labels: Vec<(Vec3, String)>,
}

/// The sky of a moment with the sun, its path on that day and over the year.
pub fn dome(dome: &Dome, day: &SunDay, now: &SunNow, year: &SunPath) -> Drawn {
    let mut strokes = horizon(dome);
    for (_, path) in year.days().filter(|(name, _)| SEASONS.contains(name)) {
        strokes.extend(track(dome, path, 1.5, YEAR));
    }
    for hour in 0..24 {
        let mut suns: Vec<Sun> = year.at_hour(hour).into_iter().map(|(_, sun)| sun).collect();
        suns.extend(suns.first().copied());
        strokes.extend(track(dome, &suns, 1.0, HOURS));
    }
    strokes.extend(track(dome, &day.path, 3.0, DAY));

    let up = |sun: &&Sun| sun.elevation_rad > 0.0;
    let dot = |sun: &Sun| ball(dome.at(sun.towards()), 0.2 * SUN_RADII * dome.radius_m, DAY);
    let mut balls: Vec<Ball> = day.hours.iter().filter(up).map(dot).collect();
    let colour = if now.sun.elevation_rad > 0.0 { SUN } else { SUN_DOWN };
    balls.push(ball(dome.at(now.sun.towards()), SUN_RADII * dome.radius_m, colour));

    let sky = What::Faces { data: Arc::new(sky(dome, now)), style: FaceStyle::Flat, culling: Culling::ToVoid };
    let balls = What::Balls { data: Arc::new(balls), least_px: 2.0, most_px: f32::INFINITY };
    let strokes = What::Strokes { data: Arc::new(strokes) };
    Drawn { batches: [sky, strokes, balls].map(Batch::new).into(), labels: labels(dome, day, now) }
}

/// The dome's cells, seen from within alone, so that its near half does not hide the scene.
fn sky(dome: &Dome, now: &SunNow) -> Vec<Corner> {
    let [columns, rows] = DOME;
    let corner = |column: usize, row: usize, inwards: Vec3| {
        let [r, g, b] = now.colours.get(row * columns + column % columns).copied().unwrap_or_default();
        let position_m = dome.at(dome_corner(column, row));
        Corner { position_m, normal: inwards, value: f32::NAN, colour: [r, g, b, 255], sides: 1 }
    };
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    cells
        .flat_map(|(column, row)| {
            let middle = dome_corner(column, row) + dome_corner(column + 1, row + 1);
            let inwards = -dome.direction(middle.normalize());
            // Azimuths run clockwise, so from within these run counter-clockwise.
            let [a, b, c, d] =
                [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(right, up)| corner(column + right, row + up, inwards));
            [a, c, b, a, d, c]
        })
        .collect()
}

/// The horizon with its ticks.
fn horizon(dome: &Dome) -> Vec<Stroke> {
    let at = |azimuth_deg: usize, share: f64| {
        dome.middle_m + (dome.at(towards((azimuth_deg as f64).to_radians(), 0.0)) - dome.middle_m) * share as f32
    };
    let ring = (0..360).step_by(5).map(|degrees| stroke(at(degrees, 1.0), at(degrees + 5, 1.0), 1.5, HORIZON));
    let ticks = (0..360).step_by(30).map(|degrees| {
        let share = if degrees % 90 == 0 { 0.95 } else { 0.98 };
        stroke(at(degrees, share), at(degrees, 1.0), 1.5, HORIZON)
    });
    ring.chain(ticks).collect()
}

/// The part of a track above the horizon.
fn track(dome: &Dome, suns: &[Sun], width_px: f32, colour: [u8; 4]) -> Vec<Stroke> {
    let runs = above_horizon(suns);
    let pairs = runs.iter().flat_map(|run| run.windows(2));
    pairs.map(|pair| stroke(dome.at(pair[0]), dome.at(pair[1]), width_px, colour)).collect()
}

/// The quarters of the sky, the hours of the day's path, and the moment beside the sun.
fn labels(dome: &Dome, day: &SunDay, now: &SunNow) -> Vec<(Vec3, String)> {
    let quarter = |(azimuth_deg, name): (f64, &str)| {
        let rim_m = dome.at(towards(f64::to_radians(azimuth_deg), 0.0));
        (dome.middle_m + 1.05 * (rim_m - dome.middle_m), name.to_owned())
    };
    let quarters = [(0.0, "N"), (90.0, "E"), (180.0, "S"), (270.0, "W")].map(quarter);
    let beyond = |sun: &Sun| dome.middle_m + 1.04 * (dome.at(sun.towards()) - dome.middle_m);
    let hours = day.hours.iter().enumerate().filter(|(_, sun)| sun.elevation_rad > 0.0);
    let hours = hours.map(|(hour, sun)| (beyond(sun), hour.to_string()));
    let now_m = dome.middle_m + 1.1 * (dome.at(now.sun.towards()) - dome.middle_m);
    let clock = now.moment.strftime("%H:%M").to_string();
    quarters.into_iter().chain(hours).chain([(now_m, clock)]).collect()
}

fn stroke(a_m: Vec3, b_m: Vec3, width_px: f32, colour: [u8; 4]) -> Stroke {
    Stroke { a_m, b_m, width_px, value: f32::NAN, colour, dashed: false, arrow: false }
}

fn ball(centre_m: Vec3, radius_m: f32, colour: [u8; 4]) -> Ball {
    Ball { centre_m, radius_m, value: f32::NAN, colour }
}

/// The corners of patches with a quantity of their exposures as values; NaN where there is none. `sides` are those of the
/// mesh's triangles, where these are known.
pub fn corners(faces: &FaceExposure, quantity: Quantity, sides: Option<&[u8]>) -> Vec<Corner> {
    let values = values_of(&faces.exposures, quantity);
    // Sides are numbered as the file's triangles as long as none of these is hidden.
    let triangles = faces.scenery.scene.mesh.triangles.len();
    let sides = sides.filter(|sides| sides.len() == triangles);
    let patches = faces.patches.iter().zip(values);
    patches
        .flat_map(|(patch, value)| {
            let [a, b, c] = patch.corners_m;
            let normal = (b - a).cross(c - a).normalize_or(Vec3::Z);
            // The side that is asked is the front; a back that nobody asked shows the front's value.
            let sides = sides.and_then(|sides| sides.get(patch.triangle as usize)).map_or(3, |&sides| u32::from(sides));
            [a, b, c].map(|position_m| Corner { position_m, normal, value, colour: [128, 128, 128, 255], sides })
        })
        .collect()
}

/// Faces in the colours of a quantity.
pub fn faces(data: Arc<Vec<Corner>>, scale: Scale, culling: Culling) -> Batch {
    let what = What::Faces { data, style: FaceStyle::Flat, culling };
    Batch { tint: Tint::Scaled(scale), cut: true, ..Batch::new(what) }
}

/// Exposure by pixels as a picture, transparent where nothing is seen: to be laid over the whole view.
pub fn picture(pixels: &PixelExposure, quantity: Quantity, scale: &Scale) -> egui::ColorImage {
    let size = pixels.buffers.camera.size;
    let mut colours = vec![egui::Color32::TRANSPARENT; size[0] * size[1]];
    for (&pixel, value) in pixels.numbers.iter().zip(values_of(&pixels.exposures, quantity)) {
        if let Some(colour) = colours.get_mut(pixel as usize) {
            let [r, g, b] = scale.colour(value);
            *colour = egui::Color32::from_rgb(r, g, b);
        }
    }
    egui::ColorImage::new(size, colours)
}

/// The exposure map, row 0 of the picture at the zenith.
pub fn map(sky: &Sky, scale: &Scale) -> egui::ColorImage {
    let [columns, rows] = sky.map.size;
    let radiances = sky.radiances();
    let from_zenith = radiances.chunks(columns.max(1)).rev().flatten();
    let colours = from_zenith.map(|&radiance| {
        let [r, g, b] = scale.colour(radiance);
        egui::Color32::from_rgb(r, g, b)
    });
    egui::ColorImage::new([columns, rows], colours.collect())
}
