//! What does a camera on its back see of a clear sky?
//!
//! A fisheye picture as a photograph of the sky has it: seen from below, north up, east to the LEFT, the zenith in the middle,
//! the horizon on the circle that fills the square. Equidistant: the distance from the middle is the angle from the zenith.
//! Linear sRGB in kcd/m2, the sun's disc with its own luminance in it; outside the circle nothing.
//!
//! A clear sky alone: no clouds, no ground, no night's lights; the disc is not flattened at the horizon.

use super::colour::{Preetham, linear_srgb};
use super::disc::Disc;
use super::hosek::Hosek;
use super::spectrum::{Atmosphere, Spectrum};
use super::{Sun, azimuth_elevation_rad};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Which model gives the colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colours {
    /// Preetham's: fuller colours, levels too bright with the sun low; knows twilight.
    Preetham,
    /// Hosek and Wilkie's: the better light. Black with the sun below the horizon.
    Hosek,
}

/// A square picture of the whole sky.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height, pixels.
    pub size_px: usize,
    /// Linear sRGB, luminance in kcd/m2, row by row from the north; `None` outside the circle.
    pub rgb: Vec<Option<[f32; 3]>>,
}

/// Hosek and Wilkie's RGB data are radiances weighted by the eye's curves, W/(m2 sr); this makes them kcd/m2. (Their
/// spectral data, weighted so, give the same luminance within 0.4% on average, 6% at worst.)
const KCD_PER_HOSEK: f64 = 0.683;

/// Points across the sun's radius at which its brightness is asked.
const POINTS_PER_RADIUS: f64 = 16.0;

impl Picture {
    /// Paints the sky. `eccentricity` is E0 of the day, for the sun's size and strength. 512 x 512 in about 30 ms on two cores.
    pub fn paint(sun: Sun, eccentricity: f64, atmosphere: &Atmosphere, colours: Colours, size_px: usize) -> Self {
        let towards_sun = sun.towards();
        let colour = sky_colour(sun, atmosphere, colours);
        let pixel = |at: usize| {
            let view = direction(size_px, centre(at % size_px), centre(at / size_px));
            let inside = view.z >= 0.0;
            inside.then(|| colour(view.z, view.dot(towards_sun)).map(|value| value as f32))
        };
        let rgb = (0..size_px * size_px).into_par_iter().map(pixel).collect();
        let mut picture = Self { size_px, rgb };

        let beam_klx = Spectrum::clear(sun.elevation_rad, eccentricity, atmosphere).beam_xyz_klx();
        let beam_rgb_klx = linear_srgb(beam_klx).map(|value| value.max(0.0));
        for (at, share_per_sr) in disc_pixels(towards_sun, Disc::new(eccentricity), size_px) {
            if let Some(Some(pixel)) = picture.rgb.get_mut(at) {
                for (value, klx) in pixel.iter_mut().zip(beam_rgb_klx) {
                    *value += (klx * share_per_sr) as f32;
                }
            }
        }
        picture
    }

    /// Illuminance of the picture on a plane that faces a direction, klx: red, green and blue.
    pub fn illuminance_klx(&self, normal: DVec3) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (at, rgb) in self.rgb.iter().enumerate() {
            let Some(rgb) = rgb else { continue };
            let view = direction(self.size_px, centre(at % self.size_px), centre(at / self.size_px));
            let weight = view.dot(normal).max(0.0) * solid_angle_sr(view, pixel_rad(self.size_px));
            for (sum, value) in sum.iter_mut().zip(rgb) {
                *sum += f64::from(*value) * weight;
            }
        }
        sum
    }
}

/// The colour of the sky by the cosines to zenith and sun, linear sRGB in kcd/m2.
fn sky_colour(sun: Sun, atmosphere: &Atmosphere, colours: Colours) -> impl Fn(f64, f64) -> [f64; 3] + Sync {
    let preetham = Preetham::new(sun.elevation_rad, atmosphere.turbidity);
    let hosek = Hosek::new(sun.elevation_rad, atmosphere.turbidity, atmosphere.ground_albedo);
    let level = if sun.elevation_rad < 0.0 { 0.0 } else { KCD_PER_HOSEK };
    move |cos_zenith, cos_gamma| match colours {
        Colours::Preetham => preetham.rgb(cos_zenith, cos_gamma),
        Colours::Hosek => hosek.radiance_rgb(cos_zenith, cos_gamma).map(|value| value * level),
    }
}

/// The pixels that the sun's disc meets, by place, with the mean share of the beam per steradian in each. Shares times solid
/// angles sum to 1; what of the disc is outside the square is not there.
fn disc_pixels(towards_sun: DVec3, disc: Disc, size_px: usize) -> Vec<(usize, f64)> {
    let pixel_rad = pixel_rad(size_px);
    let (azimuth_rad, elevation_rad) = azimuth_elevation_rad(towards_sun);
    let radius_px = (FRAC_PI_2 - elevation_rad) / pixel_rad;
    let middle_px = 0.5 * size_px as f64;
    let (column, row) = (middle_px - radius_px * azimuth_rad.sin(), middle_px - radius_px * azimuth_rad.cos());

    // On the horizon the picture is stretched along the circle, by half of pi.
    let reach = (FRAC_PI_2 * disc.angular_radius_rad / pixel_rad).ceil() + 1.0;
    let places = |middle: f64| ((middle - reach).floor() as isize)..((middle + reach).ceil() as isize);
    let points = (POINTS_PER_RADIUS * pixel_rad / disc.angular_radius_rad).ceil().clamp(4.0, 512.0) as usize;
    let inside = |at: usize| (at as f64 + 0.5) / points as f64;

    let (mut pixels, mut whole) = (Vec::new(), 0.0);
    for row in places(row) {
        for column in places(column) {
            let mut share = 0.0;
            for point in 0..points * points {
                let view =
                    direction(size_px, column as f64 + inside(point % points), row as f64 + inside(point / points));
                let sr = solid_angle_sr(view, pixel_rad / points as f64);
                share += disc.radiance_share_per_sr(view.angle_between(towards_sun)) * sr;
            }
            whole += share;
            let in_picture = |at: isize| usize::try_from(at).ok().filter(|at| *at < size_px);
            if let (Some(row), Some(column)) = (in_picture(row), in_picture(column)) {
                let pixel_sr = solid_angle_sr(direction(size_px, centre(column), centre(row)), pixel_rad);
                pixels.push((row * size_px + column, share / pixel_sr));
            }
        }
    }
    // The points miss the disc's edge by a little.
    pixels.retain(|(_, share)| *share > 0.0);
    pixels.iter_mut().for_each(|(_, share)| *share /= whole);
    pixels
}

/// The middle of a pixel.
fn centre(at: usize) -> f64 {
    at as f64 + 0.5
}

/// Angle from the zenith a pixel.
fn pixel_rad(size_px: usize) -> f64 {
    std::f64::consts::PI / size_px as f64
}

/// Solid angle of a pixel in a direction.
fn solid_angle_sr(view: DVec3, pixel_rad: f64) -> f64 {
    let zenith_rad = view.z.clamp(-1.0, 1.0).acos();
    let squeezed = if zenith_rad > 0.0 { zenith_rad.sin() / zenith_rad } else { 1.0 };
    squeezed * pixel_rad * pixel_rad
}

/// The direction of a place in the picture, in pixels from the upper left corner; below the horizon outside the circle.
pub fn direction(size_px: usize, column_px: f64, row_px: f64) -> DVec3 {
    let middle_px = 0.5 * size_px as f64;
    let (west_px, north_px) = (column_px - middle_px, middle_px - row_px);
    let radius_px = west_px.hypot(north_px);
    if radius_px == 0.0 {
        return DVec3::Z;
    }
    let (sin, cos) = (radius_px * pixel_rad(size_px)).sin_cos();
    DVec3::new(-west_px / radius_px * sin, north_px / radius_px * sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sun(azimuth_deg: f64, elevation_deg: f64) -> Sun {
        Sun { azimuth_rad: azimuth_deg.to_radians(), elevation_rad: elevation_deg.to_radians() }
    }

    fn brightest(picture: &Picture) -> (usize, usize) {
        let light = |rgb: &Option<[f32; 3]>| rgb.map_or(-1.0, |rgb| rgb[0] + rgb[1] + rgb[2]);
        let at = (0..picture.rgb.len()).max_by(|&a, &b| light(&picture.rgb[a]).total_cmp(&light(&picture.rgb[b])));
        let at = at.unwrap();
        (at % picture.size_px, at / picture.size_px)
    }

    #[test]
    fn north_is_up_and_east_is_left() {
        assert!(direction(100, 50.0, 0.0).abs_diff_eq(DVec3::Y, 1e-12));
        assert!(direction(100, 0.0, 50.0).abs_diff_eq(DVec3::X, 1e-12));
        assert!(direction(100, 50.0, 50.0).abs_diff_eq(DVec3::Z, 1e-12));
        // Half way to the horizon in the south-west: right and below.
        for colours in [Colours::Preetham, Colours::Hosek] {
            let picture = Picture::paint(sun(225.0, 45.0), 1.0, &Atmosphere::new(3.0), colours, 101);
            let (column, row) = brightest(&picture);
            assert!(column.abs_diff(50 + 18) <= 1 && row.abs_diff(50 + 18) <= 1, "{column} {row}");
        }
    }

    /// The disc's light is the beam's, in pixels larger and smaller than the disc.
    #[test]
    fn the_disc_brings_the_beam() {
        for size_px in [32, 101, 512, 2000] {
            let disc = Disc::new(1.0);
            let towards_sun = sun(130.0, 25.0).towards();
            let sum: f64 = disc_pixels(towards_sun, disc, size_px)
                .iter()
                .map(|&(at, share)| {
                    let view = direction(size_px, centre(at % size_px), centre(at / size_px));
                    share * solid_angle_sr(view, pixel_rad(size_px))
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-9, "{size_px}: {sum}");
        }
    }

    #[test]
    fn a_sun_below_the_horizon_dims_to_night() {
        let level = |elevation_deg: f64, colours| {
            let picture = Picture::paint(sun(270.0, elevation_deg), 1.0, &Atmosphere::new(3.0), colours, 64);
            assert!(picture.rgb.iter().flatten().flatten().all(|value| value.is_finite() && *value >= 0.0));
            picture.illuminance_klx(DVec3::Z)[1]
        };
        let levels = [10.0, 0.0, -3.0, -10.0, -30.0].map(|elevation| level(elevation, Colours::Preetham));
        assert!(levels.windows(2).all(|pair| pair[1] < pair[0]), "{levels:?}");
        assert_eq!((levels[4], level(-1.0, Colours::Hosek)), (0.0, 0.0));
    }

    /// Clear noon: some 100 klx, a fifth of it from the sky.
    #[test]
    fn noon_is_as_bright_as_noon() {
        for colours in [Colours::Preetham, Colours::Hosek] {
            let picture = Picture::paint(sun(180.0, 60.0), 1.0, &Atmosphere::new(3.0), colours, 256);
            let klx = super::super::colour::luminance(picture.illuminance_klx(DVec3::Z));
            assert!((85.0..130.0).contains(&klx), "{colours:?}: {klx}");
        }
    }

    #[test]
    fn outside_the_circle_is_nothing() {
        let picture = Picture::paint(sun(0.0, 10.0), 1.0, &Atmosphere::new(3.0), Colours::Preetham, 64);
        let share = picture.rgb.iter().flatten().count() as f64 / (64.0 * 64.0);
        assert!(picture.rgb[0].is_none() && (share - std::f64::consts::FRAC_PI_4).abs() < 0.01, "{share}");
    }
}
