//! Where and how often pictures are drawn: alone, in a user interface without a window, and in the test harness.

use eframe::egui;
use std::sync::OnceLock;

use super::*;

#[test]
fn an_equal_picture_is_not_drawn_again_and_data_go_up_once() {
    let Some(mut offscreen) = offscreen() else { return };
    let data = wall(Vec3::ZERO, 1.0, 0.0, RED, 3);
    let mut picture = picture(vec![flat(Arc::clone(&data), Culling::None)]);
    let (redraws, uploads) = (offscreen.canvas().redraws(), offscreen.canvas().uploads());
    let mut work = |picture: &Picture, size_px| {
        offscreen.draw(picture, size_px).unwrap();
        (offscreen.canvas().redraws() - redraws, offscreen.canvas().uploads() - uploads)
    };
    assert_eq!(work(&picture, SIZE_PX), (1, 1));
    assert_eq!(work(&picture.clone(), SIZE_PX), (1, 1), "equal");
    assert_eq!(work(&picture, [100, 100]), (2, 1), "another size");
    picture.camera.distance_m += 1.0;
    assert_eq!(work(&picture, [100, 100]), (3, 1), "another camera");
    picture.batches.push(Batch::new(What::Faces {
        data: Arc::clone(&data),
        style: FaceStyle::Wireframe,
        culling: Culling::None,
    }));
    assert_eq!(work(&picture, [100, 100]), (4, 1), "the same data in another style");
    let shown = std::mem::take(&mut picture.batches);
    assert_eq!(work(&picture, [100, 100]), (5, 1));
    picture.batches = shown;
    assert_eq!(work(&picture, [100, 100]), (6, 1), "hidden for a while");
    picture.batches[0] = flat(Arc::new(data.to_vec()), Culling::None);
    assert_eq!(work(&picture, [100, 100]), (7, 2), "other data");
}

#[test]
fn a_user_interface_shows_its_pictures_where_they_belong() {
    let Some(mut offscreen) = offscreen() else { return };
    let shown = Arc::new(picture(vec![ball(Vec3::ZERO, 1.0, 0.0, RED)]));
    let left = egui::Rect::from_min_size(egui::pos2(10.0, 10.0), egui::vec2(100.0, 75.0));
    let right = left.translate(egui::vec2(150.0, 20.0));
    let other = Arc::new(picture(vec![ball(Vec3::ZERO, 1.0, 0.0, GREEN)]));
    let image = offscreen.render_ui([600, 240], 2.0, |ui| {
        ui.painter().add(callback(left, 1, Arc::clone(&shown)));
        ui.painter().add(callback(right, 2, Arc::clone(&other)));
    });
    let image = image.unwrap();
    let at = |point: egui::Pos2| image.get_pixel((2.0 * point.x) as u32, (2.0 * point.y) as u32).0;
    assert_eq!(at(left.center())[..3], [255, 0, 0]);
    assert_eq!(at(right.center())[..3], [0, 255, 0]);
    assert_eq!(at(left.left_top() + egui::vec2(2.0, 2.0))[..3], BACKGROUND);
    assert_ne!(at(left.left_top() - egui::vec2(2.0, 2.0))[..3], BACKGROUND);
    assert_eq!(work_done(offscreen.render_state(), 1), Some((1, 1)));
}

/// An app that shows one picture wherever egui runs it.
struct Shower(Arc<Picture>);

impl eframe::App for Shower {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let rect = ui.max_rect();
        ui.painter().add(callback(rect, 7, Arc::clone(&self.0)));
    }
}

#[test]
fn the_test_harness_shows_pictures_too_and_draws_them_once() {
    if offscreen().is_none() {
        return;
    }
    let shown = Arc::new(picture(vec![ball(Vec3::ZERO, 1.0, 0.0, RED)]));
    let state = Arc::new(OnceLock::new());
    let kept = Arc::clone(&state);
    let mut harness = egui_kittest::Harness::builder().with_size(egui::vec2(200.0, 150.0)).wgpu().build_eframe(|cc| {
        let render_state = cc.wgpu_render_state.clone().unwrap();
        install(&render_state);
        let _ = kept.set(render_state);
        Shower(shown)
    });
    for _ in 0..3 {
        harness.run();
        let image = harness.render().unwrap();
        assert_eq!(image.get_pixel(100, 75).0[..3], [255, 0, 0]);
        assert_eq!(image.get_pixel(5, 5).0[..3], BACKGROUND);
    }
    assert_eq!(work_done(state.get().unwrap(), 7), Some((1, 1)));
}
