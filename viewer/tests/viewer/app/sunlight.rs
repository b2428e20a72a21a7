//! Sun, sky and shadow in the window: switched, moved by the time, and met by a facade that is touched.

use super::{Window, click, opened, place, settle};
use crate::shot::can_draw;
use egui::Key;
use egui_kittest::kittest::Queryable;
use glam::{Vec2, Vec3};
use jiff::civil::date;
use lightvein::sky::facade::{ShadowAngles, shadow_angles};
use lightvein_viewer::camera::Standard;
use lightvein_viewer::draw::Drawer;
use lightvein_viewer::layers::{MeshColour, Shadow};
use lightvein_viewer::paint::{Offscreen, Picture};
use lightvein_viewer::shadows::Method;
use std::f64::consts::PI;
use std::sync::Arc;

const COURTYARD: &str = "outdoor/courtyard";

#[test]
fn a_touched_facade_tells_its_shadow_angles_and_they_go_with_the_time() {
    let mut window = opened(COURTYARD);
    window.state_mut().state.layers.sensors = false;
    window.run();
    let at = place(&window, Vec3::new(8.0, -15.0, 5.0));
    click(&mut window, at);
    let touched = window.state().state.facade.expect("a face");
    assert!(touched.normal.distance(Vec3::NEG_Y) < 1e-5 && touched.at_m.distance(Vec3::new(8.0, -15.0, 5.0)) < 0.5);
    window.get_by_label("180.0° from north (S)");

    for (time_h, is_in_front) in [(10.0, true), (15.0, true), (6.0, false)] {
        window.state_mut().state.outdoors.time_h = time_h;
        window.run();
        let sun = window.state().state.outdoors.now.as_ref().expect("a sun").sun;
        match shadow_angles(sun, PI) {
            ShadowAngles::Front { horizontal_rad, vertical_rad } => {
                let side = if horizontal_rad > 0.0 { "clockwise" } else { "counter-clockwise" };
                window.get_by_label(&format!("{:.1}° {side}", horizontal_rad.abs().to_degrees()));
                window.get_by_label(&format!("{:.1}°", vertical_rad.to_degrees()));
                assert!(is_in_front);
            }
            ShadowAngles::Behind { .. } => {
                window.get_by_label("the sun is behind it");
                assert!(!is_in_front);
            }
            ShadowAngles::Down => panic!("{sun:?}"),
        }
    }
    window.state_mut().state.outdoors.time_h = 23.0;
    window.run();
    window.get_by_label("the sun is down");

    // A roof says that it is one; Esc lets go.
    let at = place(&window, Vec3::new(-10.0, -10.0, 10.0));
    click(&mut window, at);
    window.get_by_label("up: a level face has no shadow angles");
    window.key_press(Key::Escape);
    window.run();
    assert_eq!(window.state().state.facade, None);
}

#[test]
fn sunlight_is_switched_by_its_key_and_follows_the_time() {
    let mut window = opened(COURTYARD);
    assert!(!window.state().state.layers.shadows && window.state().state.layers.mesh_colour == MeshColour::Exposure);
    window.key_press(Key::H);
    settle(&mut window);
    let layers = &window.state().state.layers;
    assert!(layers.shadows && layers.mesh_colour == MeshColour::Material, "what is switched on is to be seen");
    assert_eq!(window.state().state.history.can(), [false, false], "a layer is no step to undo");

    let mut drawer = Drawer::default();
    let mut drawn = |window: &mut Window| -> Arc<Picture> {
        drawer.draw(&mut window.state_mut().state, Vec2::splat(200.0), true, &(Arc::new(|| ()) as _)).picture
    };
    let noon = drawn(&mut window);
    assert!(Arc::ptr_eq(&noon, &drawn(&mut window)), "the same moment is the same picture");
    let towards = |picture: &Picture| picture.sunlight.as_ref().expect("a sun").light.towards_sun;
    assert!(towards(&noon).y < 0.0 && towards(&noon).z > 0.9, "{}", towards(&noon));
    let shadows = noon.sunlight.as_ref().and_then(|sunlight| sunlight.shadows.clone()).expect("shadows");
    assert_eq!(shadows.settings, Method::Hsm.settings(1024, Method::Hsm.default_layers()));

    window.state_mut().state.outdoors.time_h = 18.0;
    window.run();
    let evening = drawn(&mut window);
    assert!(towards(&evening).x < -0.8 && !Arc::ptr_eq(&noon, &evening), "{}", towards(&evening));
    window.state_mut().state.outdoors.time_h = 23.0;
    window.run();
    assert!(!drawn(&mut window).sunlight.as_ref().expect("a night").light.is_up());

    window.key_press(Key::H);
    window.run();
    assert!(drawn(&mut window).sunlight.is_none());
}

#[test]
fn the_shadow_of_a_block_lies_away_from_the_sun_by_every_method() {
    if !can_draw() {
        return;
    }
    let mut window = opened(COURTYARD);
    let state = &mut window.state_mut().state;
    (state.layers.sensors, state.layers.sun_path) = (false, false);
    state.camera.look_from(Standard::Top);
    state.outdoors.date = date(2025, 12, 21);
    let mut offscreen = Offscreen::new().expect("an adapter");
    let mut drawer = Drawer::default();
    let mut shown = |window: &mut Window, time_h: f64, method: Method| {
        let state = &mut window.state_mut().state;
        (state.outdoors.time_h, state.layers.shadow) = (time_h, Shadow::by(method));
        state.layers.light_by_sun(true);
        window.run();
        let state = &mut window.state_mut().state;
        let picture = drawer.draw(state, Vec2::splat(400.0), true, &(Arc::new(|| ()) as _)).picture;
        let image = offscreen.render_picture(&picture, [400, 400]).expect("an image");
        move |x: f32, y: f32| {
            let (px, _) = picture.camera.project(Vec3::new(x, y, 0.0), Vec2::splat(400.0)).expect("a place in view");
            i32::from(image.get_pixel(px.x as u32, px.y as u32).0[0])
        }
    };
    for method in Method::ALL {
        // The sun is 25 degrees high: 10 m of block cast 22 m of shadow.
        let noon = shown(&mut window, 12.0, method);
        let [north, south, beyond] = [25.0, -25.0, 60.0].map(|y| noon(0.0, y));
        assert!(north + 40 < south && (beyond - south).abs() < 4, "{}: {north} {south} {beyond}", method.name());
    }
    // In the morning it lies to the north-west.
    let morning = shown(&mut window, 9.0, Method::Hsm);
    let [west, east] = [morning(-24.0, 20.0), morning(24.0, 20.0)];
    assert!(west + 30 < east, "{west} {east}");
}
