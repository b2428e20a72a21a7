//! Shadows of boxes on the ground, pixel by pixel, against rays; and where the methods fail.

mod failures;
mod scenes;

use super::*;
use crate::paint::Offscreen;
use crate::paint::test_adapter::offscreen;
use glam::Vec2;
use scenes::{Town, Wrong, wrong};

/// What rays find wrong of a method's frame.
fn errors(offscreen: &Offscreen, town: &Town, settings: &Settings) -> Wrong {
    let mut studio = Studio::new(offscreen, &town.corners_m());
    studio.frame(&town.view, settings).unwrap();
    wrong(town, &studio.lit().unwrap())
}

#[test]
fn all_methods_put_the_shadow_where_rays_do() {
    let Some(offscreen) = offscreen() else { return };
    let town = Town::block_on_ground();
    for method in Method::ALL {
        for layers in [1, 3] {
            let found = errors(&offscreen, &town, &method.settings(1024, layers));
            assert!(
                found.share < 0.002 && found.bleeding < 0.005 && found.acne < 0.002,
                "{method:?} {layers} {found:?}"
            );
        }
    }
}

/// A roof over a screen over the ground: the ground's moments mix three depths.
#[test]
fn light_bleeds_through_three_occluders_with_variance_and_less_in_layers() {
    let Some(offscreen) = offscreen() else { return };
    let town = Town::three_occluders();
    let bleeding = |method: Method, layers| errors(&offscreen, &town, &method.settings(512, layers)).bleeding;
    let [plain, pcf, vsm] = [Method::Plain, Method::Pcf, Method::Vsm].map(|method| bleeding(method, 1));
    let [lvsm_4, lvsm_12] = [4, 12].map(|layers| bleeding(Method::Lvsm, layers));
    assert!(plain < 1e-3 && pcf < 1e-3, "{plain} {pcf}");
    assert!(vsm > 0.01, "this test is to see light bleed: {vsm}");
    assert!(lvsm_4 < 0.2 * vsm && lvsm_12 < 0.05 * vsm, "{vsm} {lvsm_4} {lvsm_12}");
    // In class A hybrid maps are compared with: what is near has no bleeding.
    let near = Settings { classes: Classes::One, ..Method::Hsm.settings(512, 4) };
    assert!(errors(&offscreen, &town, &near).bleeding < 1e-3);
}

#[test]
fn too_little_lift_is_acne_and_too_much_is_peter_panning() {
    let Some(offscreen) = offscreen() else { return };
    let town = Town::block_on_ground();
    for method in [Method::Plain, Method::Pcf, Method::Csm, Method::Hsm] {
        let own = method.settings(512, 3);
        let at = |settings| errors(&offscreen, &town, &settings);
        let none = at(Settings { lift_texels: 0.0, follows_planes: false, ..own });
        let much = at(Settings { lift_texels: 40.0, ..own });
        let own = at(own);
        assert!(none.acne > 0.05 && own.acne < 0.005, "{method:?} {none:?} {own:?}");
        assert!(much.share > 3.0 * own.share, "{method:?} {own:?} {much:?}");
    }
}

/// Neighbours, one above the other, between which a layer ends and of which rays say the same: how many look alike, and how many
/// differ by more than a tenth.
fn across_seams(offscreen: &Offscreen, town: &Town, settings: &Settings) -> [usize; 2] {
    let mut studio = Studio::new(offscreen, &town.corners_m());
    studio.frame(&town.view, settings).unwrap();
    let (lit, truth) = (studio.lit().unwrap(), town.truth());
    let layers = &studio.maps().plan().layers;
    let width = town.view.size_px[0] as usize;
    let size_px = town.view.size_px.map(|side| side as f32);
    let divided_m = |at: usize, depth_m: f32| {
        if settings.split.has_map_each() {
            return depth_m;
        }
        let px = Vec2::new((at % width) as f32 + 0.5, (at / width) as f32 + 0.5);
        let camera = &town.view.camera;
        let (origin_m, direction) = camera.ray(px, Vec2::from(size_px));
        let point_m = origin_m + direction * (depth_m - camera.depth_m(origin_m)) / direction.dot(camera.forward());
        let map = &layers[0].map;
        map.clip_from_scene.project_point3(point_m).z * map.length_m
    };
    let mut pairs = [0; 2];
    for (at, upper) in lit.iter().enumerate().take(lit.len() - width) {
        let (Some(upper), Some(lower)) = (upper, lit[at + width]) else { continue };
        let [a_m, b_m] = [divided_m(at, upper.depth_m), divided_m(at + width, lower.depth_m)];
        let is_seam = layers.iter().skip(1).any(|layer| (a_m.min(b_m)..a_m.max(b_m)).contains(&layer.from_m));
        if is_seam && truth[at].is_some() && truth[at] == truth[at + width] {
            pairs[usize::from((upper.share - lower.share).abs() > 0.1)] += 1;
        }
    }
    pairs
}

#[test]
fn no_seam_shows_between_layers() {
    let Some(offscreen) = offscreen() else { return };
    let town = Town::long_wall();
    // Fewer neighbours lie across a seam of the light's depth, and of its logarithm most seams lie above the roofs.
    for (method, layers, least) in
        [(Method::Csm, 5, 500), (Method::Hsm, 5, 500), (Method::Lvsm, 12, 200), (Method::HsmLight, 16, 50)]
    {
        let pairs = across_seams(&offscreen, &town, &method.settings(1024, layers));
        assert!(pairs[0] > least && pairs[1] * 50 < pairs[0], "{method:?}: {pairs:?}");
    }
}

#[test]
fn low_and_high_suns_are_survived() {
    let Some(offscreen) = offscreen() else { return };
    for (towards_sun, most) in [
        // Two degrees above the horizon, and the zenith.
        (glam::Vec3::new(-2.0_f32.to_radians().cos(), 0.0, 2.0_f32.to_radians().sin()), 0.03),
        (glam::Vec3::Z, 0.005),
    ] {
        let mut town = Town::block_on_ground();
        town.view.towards_sun = towards_sun;
        for method in Method::ALL {
            let found = errors(&offscreen, &town, &method.settings(1024, 4));
            assert!(found.share < most, "{method:?} {towards_sun} {found:?}");
        }
    }
}

#[test]
fn inside_an_arcade_maps_over_the_cameras_depth_see_the_sun_between_the_columns() {
    let Some(offscreen) = offscreen() else { return };
    let town = Town::arcade();
    let found = |method: Method| errors(&offscreen, &town, &method.settings(1024, 4)).share;
    for method in [Method::Csm, Method::Hsm] {
        assert!(found(method) < 0.005, "{method:?} {}", found(method));
    }
    // One map for the columns at hand and the end of the street has texels as wide as these are.
    for method in [Method::Plain, Method::Pcf, Method::Vsm, Method::Lvsm] {
        assert!((0.01..0.05).contains(&found(method)), "{method:?} {}", found(method));
    }
}

#[test]
fn nothing_seen_and_nothing_in_the_way_are_no_trouble() {
    let Some(offscreen) = offscreen() else { return };
    let mut away = Town::block_on_ground();
    away.view.camera.elevation_rad = -1.2;
    away.view.camera.target_m.z = 300.0;
    let mut bare = Town::block_on_ground();
    bare.boxes_m.truncate(1);
    for method in Method::ALL {
        let settings = method.settings(256, 4);
        let mut studio = Studio::new(&offscreen, &away.corners_m());
        studio.frame(&away.view, &settings).unwrap();
        assert!(studio.lit().unwrap().iter().all(Option::is_none));
        let found = errors(&offscreen, &bare, &settings);
        assert!(found.share == 0.0 && found.acne < 1e-3, "{method:?} {found:?}");
        let mut studio = Studio::new(&offscreen, &[]);
        studio.frame(&bare.view, &settings).unwrap();
        assert!(studio.lit().unwrap().iter().all(Option::is_none));
    }
}

#[test]
fn layers_of_lower_classes_take_less_memory_and_methods_without_layers_one_map() {
    let Some(offscreen) = offscreen() else { return };
    let town = Town::long_wall();
    let bytes = |settings: Settings| {
        let mut studio = Studio::new(&offscreen, &town.corners_m());
        studio.frame(&town.view, &settings).unwrap();
        studio.maps().bytes()
    };
    let mib = |settings| bytes(settings) as f64 / f64::from(1 << 20);
    assert_eq!(mib(Method::Plain.settings(1024, 9)), 4.0);
    assert_eq!(mib(Method::Csm.settings(1024, 3)), 12.0);
    // Depth, moments, and what lies between rows and columns.
    assert_eq!(mib(Method::Vsm.settings(1024, 1)), 4.0 + 8.0 + 8.0);
    assert_eq!(mib(Method::Lvsm.settings(1024, 4)), 4.0 + 4.0 * 8.0 + 8.0);
    let hsm = Method::Hsm.settings(1024, 5);
    assert!(mib(hsm) < 0.7 * mib(Settings { classes: Classes::One, ..hsm }));
}
