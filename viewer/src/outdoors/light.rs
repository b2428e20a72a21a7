//! What do sun and sky give a picture at a moment: the beam's colour and strength, the sky's colours, their light on surfaces?
//!
//! The sky is Preetham's, Shirley's and Smits' (Perez' form), the beam the sun's spectrum through the same clear air, whatever
//! the weather; what the sky casts on surfaces is summed up by harmonics. Sky and beam are two models, which differ most with
//! the sun low, where this sky is known to be too bright.

use crate::paint::SkyLight;
use glam::DVec3;
use jiff::civil::DateTime;
use lightvein::sky::Sun;
use lightvein::sky::colour::{Preetham, linear_srgb};
use lightvein::sky::disc::Disc;
use lightvein::sky::harmonics::Harmonics;
use lightvein::sky::site::Outdoors;
use lightvein::sky::spectrum::{Atmosphere, Spectrum};
use lightvein::sky::sun::eccentricity;
use std::f64::consts::PI;

/// By night surfaces get so much light, klx, or nothing of them could be made out: what is left ten minutes after sunset.
const NIGHT_KLX: [f64; 3] = [0.10, 0.11, 0.15];

/// The light of a site's sun and sky at a moment. `white_kcd_m2` is the luminance that shows at 63%. About 0.2 ms.
pub fn of(outdoors: &Outdoors, moment: DateTime, sun: Sun, sky: &Preetham, white_kcd_m2: f64) -> SkyLight {
    let eccentricity = eccentricity(moment.date());
    let beam_klx = beam_klx(outdoors, sun, eccentricity);
    let towards_sun = in_scene(outdoors.north_rad, sun.towards());

    // The sky's own light, what the ground makes of it and of the sun's, and a rest by night.
    let of_sky = Harmonics::of(|view| if view.z > 0.0 { sky.rgb(view.z, view.dot(towards_sun)) } else { [0.0; 3] });
    let level_klx = of_sky.irradiance(DVec3::Z);
    let ground_kcd_m2: [f64; 3] = std::array::from_fn(|colour| {
        let lit_klx = level_klx[colour] + beam_klx[colour] * towards_sun.z.max(0.0);
        outdoors.haze.ground_albedo * lit_klx.max(NIGHT_KLX[colour]) / PI
    });
    let below = Harmonics::of(|view| if view.z > 0.0 { [0.0; 3] } else { [1.0; 3] });
    let alike = Harmonics::of(|_| [1.0 / PI; 3]);
    let rest_klx = std::array::from_fn(|colour| (NIGHT_KLX[colour] - level_klx[colour]).max(0.0));
    let on_surfaces = of_sky.and(&below, ground_kcd_m2).and(&alike, rest_klx);

    SkyLight {
        towards_sun: towards_sun.as_vec3(),
        disc_radius_rad: Disc::new(eccentricity).angular_radius_rad as f32,
        beam_klx: beam_klx.map(|value| value as f32),
        zenith: std::array::from_fn(|channel| (sky.zenith[channel] / sky.at_zenith[channel]) as f32),
        perez: sky.perez.map(|letters| letters.map(|value| value as f32)),
        harmonics_klx: on_surfaces.rgb.map(|rgb| rgb.map(|value| value as f32)),
        ground_kcd_m2: ground_kcd_m2.map(|value| value as f32),
        white_kcd_m2: white_kcd_m2 as f32,
    }
}

/// The beam on a surface that faces it, linear sRGB; black with the sun down.
fn beam_klx(outdoors: &Outdoors, sun: Sun, eccentricity: f64) -> [f64; 3] {
    let haze = outdoors.haze;
    let air = Atmosphere { ground_albedo: haze.ground_albedo, ..Atmosphere::new(haze.turbidity) };
    let xyz_klx = Spectrum::clear(sun.elevation_rad, eccentricity, &air).beam_xyz_klx();
    linear_srgb(xyz_klx).map(|value| value.max(0.0))
}

/// A direction (x east, y true north, z up) in a scene whose true north is that far clockwise from +Y.
pub fn in_scene(north_rad: f64, direction: DVec3) -> DVec3 {
    let (sin, cos) = north_rad.sin_cos();
    DVec3::new(direction.x * cos + direction.y * sin, direction.y * cos - direction.x * sin, direction.z)
}
