use super::super::settings::Method;
use super::*;
use crate::camera::Camera;

/// A street as the paper has it: the eye near one end of a box of 75 x 450 x 30 m, looking along it.
fn street() -> (View, (Vec3, Vec3)) {
    let camera = Camera {
        target_m: Vec3::new(0.0, 50.0, 2.0),
        azimuth_rad: -std::f32::consts::FRAC_PI_2,
        elevation_rad: 0.0,
        distance_m: 50.0,
        field_of_view_rad: 0.7,
        orthographic: false,
    };
    let towards_sun = Vec3::new(0.5, -0.4, 0.6).normalize();
    (View { camera, size_px: [640, 480], towards_sun }, (Vec3::new(-37.5, -20.0, 0.0), Vec3::new(37.5, 430.0, 30.0)))
}

fn seen(first_m: f32, last_m: f32) -> Seen {
    Seen { first_m, last_m, pixels: vec![1; Seen::BINS as usize] }
}

/// Points that the camera sees, by pixels and depths.
fn points_seen(view: &View, bounds_m: (Vec3, Vec3)) -> Vec<Vec3> {
    let size_px = glam::Vec2::new(view.size_px[0] as f32, view.size_px[1] as f32);
    let mut points = Vec::new();
    for pixel in 0..200 {
        let px = size_px * glam::Vec2::new((pixel % 20) as f32 + 0.5, (pixel / 20 * 2) as f32 + 0.5) / 20.0;
        let (origin_m, direction) = view.camera.ray(px, size_px);
        let along = |step: i32| origin_m + direction * 1.1_f32.powi(step);
        let inside = |point: &Vec3| point.cmpge(bounds_m.0).all() && point.cmple(bounds_m.1).all();
        points.extend((0..70).map(along).filter(inside));
    }
    points
}

#[test]
fn every_visible_point_lies_on_the_map_of_its_layer() {
    let (view, bounds_m) = street();
    let points = points_seen(&view, bounds_m);
    assert!(points.len() > 1000);
    for towards_sun in [view.towards_sun, Vec3::Z, Vec3::new(0.0, -1.0, 0.035).normalize(), -view.camera.forward()] {
        let view = View { towards_sun, ..view };
        for method in Method::ALL {
            let plan = Plan::of(&view, &method.settings(512, 5), bounds_m, Some(&seen(0.5, 400.0)));
            assert_eq!(plan.layers.len(), method.settings(512, 5).layers, "{method:?}");
            for point_m in &points {
                let on_map = |layer: &Layer| {
                    let clip = layer.map.clip_from_scene.project_point3(*point_m);
                    clip.truncate().abs().max_element() <= 1.0 && (0.0..=1.0).contains(&clip.z)
                };
                let depth_m = view.camera.depth_m(*point_m);
                let by_camera = method.settings(512, 5).split.has_map_each();
                let in_layer = |layer: &&Layer| !by_camera || (layer.from_m..=layer.until_m).contains(&depth_m);
                let is_inside = !by_camera || (plan.layers[0].from_m..=plan.layers[4].to_m).contains(&depth_m);
                assert!(!is_inside || plan.layers.iter().any(|layer| in_layer(&layer)), "{method:?} {point_m}");
                assert!(plan.layers.iter().filter(in_layer).all(on_map), "{method:?} {towards_sun} {point_m}");
            }
        }
    }
}

#[test]
fn near_layers_have_finer_texels_and_far_ones_cover_more() {
    let (view, bounds_m) = street();
    let plan = Plan::of(&view, &Method::Hsm.settings(1024, 5), bounds_m, Some(&seen(10.0, 380.0)));
    let texels: Vec<f32> = plan.layers.iter().map(|layer| layer.map.texel_m).collect();
    assert!(texels.windows(2).all(|pair| pair[0] < pair[1]), "{texels:?}");
    let resolutions: Vec<u32> = plan.layers.iter().map(|layer| layer.resolution).collect();
    assert_eq!(resolutions, [1024, 512, 512, 256, 256]);
    assert_eq!((plan.layers[0].from_m, plan.layers[4].to_m), (10.0, 380.0));
}

#[test]
fn where_nothing_is_seen_there_are_no_layers() {
    let (view, bounds_m) = street();
    let mut away = view;
    away.camera.azimuth_rad += std::f32::consts::PI;
    away.camera.target_m.y = -100.0;
    for method in Method::ALL {
        assert!(Plan::of(&away, &method.settings(256, 4), bounds_m, None).layers.is_empty());
    }
}

#[test]
fn a_map_holds_all_that_throws_a_shadow_on_it() {
    let (view, bounds_m) = street();
    let plan = Plan::of(&view, &Method::Hsm.settings(1024, 5), bounds_m, Some(&seen(10.0, 380.0)));
    let map = plan.layers[0].map;
    let middle_m = map.clip_from_scene.inverse().project_point3(Vec3::new(0.0, 0.0, 0.5));
    let near = |point_m: Vec3| (point_m - Vec3::splat(0.1), point_m + Vec3::splat(0.1));
    assert!(map.may_hold(near(middle_m)) && map.may_hold(near(middle_m + view.towards_sun * 500.0)));
    assert!(
        !map.may_hold(near(middle_m - view.towards_sun * 500.0)) && !map.may_hold(near(Vec3::new(0.0, 400.0, 0.0)))
    );
    assert!(map.may_hold(bounds_m));
}

#[test]
fn parallel_and_flat_views_are_planned_too() {
    let (mut view, bounds_m) = street();
    view.camera.orthographic = true;
    let flat_m = (bounds_m.0, Vec3::new(bounds_m.1.x, bounds_m.1.y, bounds_m.0.z));
    for method in Method::ALL {
        let settings = method.settings(256, 4);
        assert!(!Plan::asks_depths(&view, &settings));
        for bounds_m in [bounds_m, flat_m] {
            let plan = Plan::of(&view, &settings, bounds_m, None);
            assert_eq!(plan.layers.len(), settings.layers, "{method:?}");
            assert!(plan.layers.iter().all(|layer| layer.map.texel_m.is_finite() && layer.map.length_m > 0.0));
        }
    }
}

#[test]
fn moments_of_a_shared_map_are_of_whole_texels() {
    let (view, bounds_m) = street();
    for resolution in [16, 18, 333, 513, 1023] {
        let plan = Plan::of(&view, &Method::HsmLight.settings(resolution, 6), bounds_m, Some(&seen(10.0, 380.0)));
        assert!(plan.layers.iter().any(|layer| layer.class == Class::C));
        for layer in &plan.layers {
            let of_layer = layer.class.resolution(layer.map.resolution);
            assert!(layer.compares || layer.resolution == of_layer, "{resolution} {layer:?}");
            assert_eq!(layer.map.resolution % layer.resolution, 0, "{resolution} {layer:?}");
        }
    }
}
