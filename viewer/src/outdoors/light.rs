//! What do sun and sky give a picture at a moment: the beam's colour and strength, the sky's colours, their light on surfaces?
//!
//! The beam is the sun's spectrum through clear air, whatever the weather. The sky has the colours and the shape of Preetham's,
//! Shirley's and Smits' (Perez' form), dimmed to what the same air scatters, for by itself it is too bright, most of all with the
//! sun low; what it casts on surfaces is summed up by harmonics.

use super::sun::LEAST_WHITE;
use crate::paint::SkyLight;
use glam::DVec3;
use jiff::civil::DateTime;
use lightvein::sky::Sun;
use lightvein::sky::colour::{Preetham, linear_srgb, luminance};
use lightvein::sky::disc::Disc;
use lightvein::sky::harmonics::Harmonics;
use lightvein::sky::site::Outdoors;
use lightvein::sky::spectrum::{Atmosphere, Spectrum};
use lightvein::sky::sun::eccentricity;
use std::f64::consts::PI;

/// By night surfaces get so much light, klx, or nothing of them could be made out: what is left ten minutes after sunset.
const NIGHT_KLX: [f64; 3] = [0.10, 0.11, 0.15];

/// Lower suns than this scatter less than is measured, for the air is not flat: their sky is dimmed as this one's.
const LEAST_ELEVATION_RAD: f64 = 3.0 * PI / 180.0;

/// What level ground of this reflectance sends back shows at 63% of the screen's brightest, unless the sky is brighter yet.
const MIDDLE: f64 = 0.5;

/// The light of a site's sun and sky at a moment. `sky_white_kcd_m2` is the luminance that shows at 63% in a picture of the
/// sky alone. About 0.4 ms.
pub fn of(outdoors: &Outdoors, moment: DateTime, sun: Sun, sky: &Preetham, sky_white_kcd_m2: f64) -> SkyLight {
    let eccentricity = eccentricity(moment.date());
    let spectrum = |elevation_rad| Spectrum::clear(elevation_rad, eccentricity, &air(outdoors));
    let beam_klx = linear_srgb(spectrum(sun.elevation_rad).beam_xyz_klx()).map(|value| value.max(0.0));
    let towards_sun = in_scene(outdoors.north_rad, sun.towards());

    // How far the sky is dimmed; below the least elevation as there.
    let at = Sun { elevation_rad: sun.elevation_rad.max(LEAST_ELEVATION_RAD), ..sun };
    let undimmed = of_sky(&Preetham::new(at.elevation_rad, outdoors.haze.turbidity), at.towards());
    let dimmed = spectrum(at.elevation_rad).diffuse_xyz_klx()[1]
        / luminance(undimmed.irradiance(DVec3::Z)).max(f64::MIN_POSITIVE);

    // The sky's own light, what the ground makes of it and of the sun's, and a rest by night.
    let of_sky = Harmonics::default().and(&of_sky(sky, towards_sun), [dimmed; 3]);
    let level_klx = of_sky.irradiance(DVec3::Z);
    let lit_klx: [f64; 3] = std::array::from_fn(|colour| {
        (level_klx[colour] + beam_klx[colour] * towards_sun.z.max(0.0)).max(NIGHT_KLX[colour])
    });
    let ground_kcd_m2 = lit_klx.map(|klx| outdoors.haze.ground_albedo * klx / PI);
    let below = Harmonics::of(|view| if view.z > 0.0 { [0.0; 3] } else { [1.0; 3] });
    let alike = Harmonics::of(|_| [1.0 / PI; 3]);
    let rest_klx = std::array::from_fn(|colour| (NIGHT_KLX[colour] - level_klx[colour]).max(0.0));
    let on_surfaces = of_sky.and(&below, ground_kcd_m2).and(&alike, rest_klx);

    SkyLight {
        towards_sun: towards_sun.as_vec3(),
        disc_radius_rad: Disc::new(eccentricity).angular_radius_rad as f32,
        beam_klx: beam_klx.map(|value| value as f32),
        zenith: std::array::from_fn(|channel| {
            let level = if channel == 0 { dimmed } else { 1.0 };
            (level * sky.zenith[channel] / sky.at_zenith[channel]) as f32
        }),
        perez: sky.perez.map(|letters| letters.map(|value| value as f32)),
        harmonics_klx: on_surfaces.rgb.map(|rgb| rgb.map(|value| value as f32)),
        ground_kcd_m2: ground_kcd_m2.map(|value| value as f32),
        white_kcd_m2: (dimmed * sky_white_kcd_m2).max(MIDDLE * luminance(lit_klx) / PI).max(LEAST_WHITE) as f32,
    }
}

/// What a sky without ground casts on surfaces.
fn of_sky(sky: &Preetham, towards_sun: DVec3) -> Harmonics {
    Harmonics::of(|view| if view.z > 0.0 { sky.rgb(view.z, view.dot(towards_sun)) } else { [0.0; 3] })
}

/// The air of a site.
fn air(outdoors: &Outdoors) -> Atmosphere {
    let haze = outdoors.haze;
    Atmosphere { ground_albedo: haze.ground_albedo, ..Atmosphere::new(haze.turbidity) }
}

/// A direction (x east, y true north, z up) in a scene whose true north is that far clockwise from +Y.
pub fn in_scene(north_rad: f64, direction: DVec3) -> DVec3 {
    let (sin, cos) = north_rad.sin_cos();
    DVec3::new(direction.x * cos + direction.y * sin, direction.y * cos - direction.x * sin, direction.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jiff::civil::date;
    use lightvein::scene::Site;

    fn skylight(azimuth_deg: f64, elevation_deg: f64, north_deg: f64) -> SkyLight {
        let site = Site {
            latitude_deg: Some(45.0),
            longitude_deg: Some(0.0),
            turbidity: Some(3.0),
            ground_albedo: Some(0.25),
            north_deg,
            ..Site::default()
        };
        let outdoors = Outdoors::of(&site, None).unwrap();
        let [azimuth_rad, elevation_rad] = [azimuth_deg, elevation_deg].map(f64::to_radians);
        let sky = Preetham::new(elevation_rad, 3.0);
        of(&outdoors, date(2025, 6, 21).at(12, 0, 0, 0), Sun { azimuth_rad, elevation_rad }, &sky, 0.7)
    }

    /// What falls on a surface from sky and ground, luminance in klx.
    fn aside_klx(light: &SkyLight, normal: DVec3) -> f64 {
        luminance(Harmonics { rgb: light.harmonics_klx.map(|rgb| rgb.map(f64::from)) }.irradiance(normal))
    }

    /// A high sun in a clear sky brings some 100 klx to level ground, a tenth to a fifth of it from the sky (IES handbook).
    #[test]
    fn noon_is_as_bright_as_noon() {
        let noon = skylight(180.0, 65.0, 0.0);
        let sky_klx = aside_klx(&noon, DVec3::Z);
        let both_klx = sky_klx + luminance(noon.beam_klx.map(f64::from)) * 65f64.to_radians().sin();
        assert!(
            (85.0..120.0).contains(&both_klx) && (0.08..0.25).contains(&(sky_klx / both_klx)),
            "{sky_klx} {both_klx}"
        );
        // A ceiling has the ground's light alone, a quarter of what the ground gets; within the harmonics' error.
        let below_klx = aside_klx(&noon, DVec3::NEG_Z);
        assert!((below_klx / both_klx - 0.25).abs() < 0.03, "{below_klx}");
        // Lit ground of a quarter shows at half of 63%'s luminance.
        let ground = luminance(noon.ground_kcd_m2.map(f64::from));
        assert!((ground / f64::from(noon.white_kcd_m2) - 0.5).abs() < 0.01, "{ground} {}", noon.white_kcd_m2);
    }

    #[test]
    fn the_evening_is_warm_and_the_night_dark_with_a_rest() {
        let evening = skylight(290.0, 3.0, 0.0);
        assert!(evening.is_up() && evening.beam_klx[0] > 2.0 * evening.beam_klx[2], "{:?}", evening.beam_klx);
        let night = skylight(340.0, -30.0, 0.0);
        assert!(!night.is_up() && night.zenith[0] == 0.0 && night.white_kcd_m2 == LEAST_WHITE as f32);
        let rest_klx = aside_klx(&night, DVec3::X);
        assert!((0.1..0.2).contains(&rest_klx), "{rest_klx}");
    }

    #[test]
    fn a_turned_scene_has_its_light_turned() {
        let (straight, turned) = (skylight(120.0, 30.0, 0.0), skylight(120.0, 30.0, 75.0));
        let turn = |direction: DVec3| in_scene(75f64.to_radians(), direction);
        let towards = turn(straight.towards_sun.as_dvec3());
        assert!(towards.distance(turned.towards_sun.as_dvec3()) < 1e-6);
        for normal in [DVec3::X, DVec3::NEG_Y, DVec3::new(0.6, 0.0, 0.8)] {
            let (here, there) = (aside_klx(&straight, normal), aside_klx(&turned, turn(normal)));
            assert!((here / there - 1.0).abs() < 1e-3, "{normal}: {here} {there}");
        }
    }
}
