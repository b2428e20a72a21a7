//! The sky behind a scene, and faces under sun, sky and shadow, against the same by the library.

use super::*;
use crate::outdoors::light;
use crate::shadows::Method;
use glam::DVec3;
use jiff::civil::date;
use lightvein::scene::Site;
use lightvein::sky::Sun;
use lightvein::sky::colour::{Preetham, tone_mapped};
use lightvein::sky::harmonics::Harmonics;
use lightvein::sky::site::Outdoors;

const WHITE_KCD_M2: f64 = 9.0;

/// A sky without haze beyond turbidity 3, with true north that far clockwise from +Y, and its sun.
fn outdoors(north_deg: f64) -> Outdoors {
    let site =
        Site { latitude_deg: Some(45.0), longitude_deg: Some(0.0), turbidity: Some(3.0), north_deg, ..Site::default() };
    Outdoors::of(&site, None).unwrap()
}

fn skylight(sun: Sun, north_deg: f64) -> (Preetham, SkyLight) {
    let sky = Preetham::new(sun.elevation_rad, 3.0);
    let noon = date(2025, 6, 21).at(12, 0, 0, 0);
    (sky, light::of(&outdoors(north_deg), noon, sun, &sky, WHITE_KCD_M2))
}

fn sun(azimuth_deg: f64, elevation_deg: f64) -> Sun {
    Sun { azimuth_rad: azimuth_deg.to_radians(), elevation_rad: elevation_deg.to_radians() }
}

#[track_caller]
fn alike(got: [u8; 3], want: [u8; 3], what: &str) {
    let apart = got.iter().zip(want).map(|(got, want)| got.abs_diff(want)).max().unwrap();
    assert!(apart <= 3, "{got:?}, not {want:?}: {what}");
}

#[test]
fn the_sky_behind_the_scene_is_the_librarys_in_every_pixel() {
    let Some(mut offscreen) = offscreen() else { return };
    for (at, north_deg) in [(sun(150.0, 40.0), 0.0), (sun(250.0, 5.0), 30.0), (sun(300.0, -4.0), -70.0)] {
        let (sky, light) = skylight(at, north_deg);
        let to_sun = light.towards_sun.as_dvec3();
        let dimmed = f64::from(light.zenith[0]) * sky.at_zenith[0] / sky.zenith[0];
        assert!((0.1..1.0).contains(&dimmed), "{dimmed}");
        let mut shown = picture(Vec::new());
        shown.sunlight = Some(Sunlight { light, shadows: None });
        for (azimuth_rad, elevation_rad) in [(-1.6, -0.3), (1.0, -0.9), (3.0, 0.4)] {
            (shown.camera.azimuth_rad, shown.camera.elevation_rad) = (azimuth_rad, elevation_rad);
            let image = offscreen.render_picture(&shown, SIZE_PX).unwrap();
            for [x, y] in [[3, 4], [100, 75], [190, 20], [60, 140]] {
                let middle_px = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let (_, view) = shown.camera.ray(middle_px, Vec2::new(SIZE_PX[0] as f32, SIZE_PX[1] as f32));
                let view = view.as_dvec3().normalize();
                // The disc and the haze at the horizon are looked at elsewhere.
                if view.angle_between(to_sun) < 0.02 || view.z.abs() < 0.01 {
                    continue;
                }
                let rgb = match view.z {
                    // As bright as the light has it.
                    up if up > 0.0 => sky.rgb(up, view.dot(to_sun)).map(|value| dimmed * value),
                    // So deep down nothing of the horizon's air is left.
                    down if down < -0.4 => light.ground_kcd_m2.map(f64::from),
                    _ => continue,
                };
                let [red, green, blue, _] = image.get_pixel(x, y).0;
                alike(
                    [red, green, blue],
                    tone_mapped(rgb, f64::from(light.white_kcd_m2)),
                    &format!("{at:?} towards {view}"),
                );
            }
        }
    }
}

#[test]
fn the_suns_disc_stands_where_the_sun_is_in_either_projection() {
    let Some(mut offscreen) = offscreen() else { return };
    let (_, light) = skylight(sun(180.0, 20.0), 0.0);
    let mut shown = picture(Vec::new());
    shown.sunlight = Some(Sunlight { light, shadows: None });
    // Looking at the sun, narrowly.
    shown.camera.look_from(Standard::Back);
    (shown.camera.elevation_rad, shown.camera.field_of_view_rad) = (-20f32.to_radians(), 4f32.to_radians());
    for orthographic in [false, true] {
        shown.camera.orthographic = orthographic;
        let image = offscreen.render_picture(&shown, SIZE_PX).unwrap();
        let bright = |x: u32, y: u32| image.get_pixel(x, y).0[..3].iter().all(|&code| code > 250);
        let count = (0..SIZE_PX[0]).flat_map(|x| (0..SIZE_PX[1]).map(move |y| (x, y))).filter(|&(x, y)| bright(x, y));
        // 0.262 degrees of radius in June at 150 pixels for 4 degrees: 9.83 px.
        let radius_px = (count.count() as f32 / std::f32::consts::PI).sqrt();
        assert!(bright(100, 75) && (9.0..10.6).contains(&radius_px), "{radius_px}");
    }
}

/// A level ground of 8 m x 8 m and, 2 m above its southern half, a roof; grey, sunlit.
fn ground_and_roof() -> Batch {
    let square = |low: Vec3, high: Vec3| {
        let corners = [low, low.with_x(high.x), high, low, high, low.with_y(high.y)];
        corners.map(|position_m| Corner {
            position_m,
            normal: Vec3::Z,
            value: 0.0,
            colour: [180, 180, 180, 255],
            sides: 3,
        })
    };
    let ground = square(Vec3::new(-4.0, -4.0, 0.0), Vec3::new(4.0, 4.0, 0.0));
    let roof = square(Vec3::new(-1.0, -1.0, 2.0), Vec3::new(1.0, 1.0, 2.0));
    let data = Arc::new([ground, roof].concat());
    Batch::new(What::Faces { data, style: FaceStyle::Sunlit, culling: Culling::None })
}

fn sunlit(at: Sun, method: Method) -> Picture {
    let batch = ground_and_roof();
    let What::Faces { data, .. } = &batch.what else { panic!() };
    let shadows = Some(Shadows { casters: Arc::clone(data), settings: method.settings(512, method.default_layers()) });
    let mut shown = picture(vec![batch]);
    shown.sunlight = Some(Sunlight { light: skylight(at, 0.0).1, shadows });
    shown.camera.look_from(Standard::Oblique);
    shown.camera.distance_m = 14.0;
    shown
}

#[test]
fn a_shadow_falls_away_from_the_sun_and_the_rest_is_lit_by_both() {
    let Some(mut offscreen) = offscreen() else { return };
    let grey = ((180.0 / 255.0 + 0.055) / 1.055_f64).powf(2.4);
    // From the south at 45 degrees the roof's shadow lies 2 m to the north of it; from the west, to the east.
    for (at, shadow_m) in [(sun(180.0, 45.0), Vec3::new(0.0, 2.0, 0.0)), (sun(270.0, 45.0), Vec3::new(2.0, 0.0, 0.0))] {
        for method in Method::ALL {
            let mut shown = sunlit(at, method);
            // Looked at from the shadow's side, so that the roof does not hide it.
            shown.camera.look_from(Standard::Top);
            shown.camera.distance_m = 14.0;
            let image = offscreen.render_picture(&shown, SIZE_PX).unwrap();
            let light = shown.sunlight.as_ref().unwrap().light;
            let harmonics = Harmonics { rgb: light.harmonics_klx.map(|rgb| rgb.map(f64::from)) };
            let sky_klx = harmonics.irradiance(DVec3::Z);
            let toned = |share: f64| {
                let lit = |colour: usize| {
                    let beam = f64::from(light.beam_klx[colour]) * f64::from(light.towards_sun.z) * share;
                    grey * (sky_klx[colour] + beam) / std::f64::consts::PI
                };
                tone_mapped([lit(0), lit(1), lit(2)], f64::from(light.white_kcd_m2))
            };
            let seen = |at_m| super::at(&image, &shown.camera, at_m);
            let in_sun = seen(-shadow_m * 1.4);
            alike(in_sun, toned(1.0), "in the sun");
            let in_shadow = seen(shadow_m * 1.2);
            // Moments let a little light through.
            let [lit, dark, found] = [toned(1.0), toned(0.0), in_shadow].map(|[red, ..]| f32::from(red));
            let share = (found - dark) / (lit - dark);
            assert!(lit > dark + 60.0 && share < 0.1, "{method:?}: {found} from {dark} to {lit}");
        }
    }
}

#[test]
fn maps_are_drawn_again_when_sun_or_method_change_and_not_with_the_sun_down() {
    let Some(mut offscreen) = offscreen() else { return };
    let before = offscreen.canvas().shadow_redraws();
    let mut drawn = |picture: &Picture| {
        offscreen.draw(picture, SIZE_PX).unwrap();
        offscreen.canvas().shadow_redraws() - before
    };
    let mut shown = sunlit(sun(150.0, 30.0), Method::Hsm);
    assert_eq!((drawn(&shown), drawn(&shown.clone())), (1, 1));
    shown.background = [[1; 3]; 2];
    assert_eq!(drawn(&shown), 1, "what no shadow depends on");
    shown.sunlight.as_mut().unwrap().light = skylight(sun(151.0, 30.0), 0.0).1;
    assert_eq!(drawn(&shown), 2, "another sun");
    shown.sunlight.as_mut().unwrap().shadows.as_mut().unwrap().settings = Method::Vsm.settings(256, 1);
    assert_eq!(drawn(&shown), 3, "another method");
    shown.camera.distance_m += 1.0;
    assert_eq!(drawn(&shown), 4, "another view");
    shown.sunlight.as_mut().unwrap().light = skylight(sun(330.0, -20.0), 0.0).1;
    assert_eq!(drawn(&shown), 4, "night");
    shown.sunlight.as_mut().unwrap().shadows = None;
    assert_eq!(drawn(&shown), 4, "no shadows");
}

#[test]
fn by_night_shapes_can_still_be_made_out() {
    let Some(mut offscreen) = offscreen() else { return };
    let shown = sunlit(sun(330.0, -30.0), Method::Pcf);
    let mut shown = Picture { sunlight: shown.sunlight.clone(), ..shown };
    shown.sunlight.as_mut().unwrap().light.white_kcd_m2 = 0.7;
    let image = offscreen.render_picture(&shown, SIZE_PX).unwrap();
    let ground = super::at(&image, &shown.camera, Vec3::new(-3.0, -3.0, 0.0));
    assert!(ground.iter().all(|code| (10..80).contains(code)), "{ground:?}");
}
