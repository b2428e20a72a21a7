//! What is seen: pictures of known scenes, pixel by pixel.

mod shown;
mod sunlit;

use std::sync::Arc;

use glam::{Vec2, Vec3};
use image::RgbaImage;

use super::test_adapter::offscreen;
use super::*;
use crate::camera::{Camera, Standard};
use crate::colour::{ColourMap, GREY, Scale};

const SIZE_PX: [u32; 2] = [200, 150];
const BACKGROUND: [u8; 3] = [10, 20, 30];
const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];

/// The origin seen from the south at 10 m.
fn camera() -> Camera {
    let mut camera = Camera::fitted((Vec3::NEG_ONE, Vec3::ONE), 4.0 / 3.0);
    camera.look_from(Standard::Front);
    camera.target_m = Vec3::ZERO;
    camera.distance_m = 10.0;
    camera
}

fn picture(batches: Vec<Batch>) -> Picture {
    Picture { camera: camera(), background: [BACKGROUND; 2], sunlight: None, cuts: Vec::new(), batches }
}

/// An upright square wall through a point, its front to the south where the camera is.
fn wall(middle_m: Vec3, half_m: f32, value: f32, colour: [u8; 4], sides: u32) -> Arc<Vec<Corner>> {
    let corner = |x: f32, z: f32| Corner {
        position_m: middle_m + Vec3::new(x, 0.0, z) * half_m,
        normal: Vec3::NEG_Y,
        value,
        colour,
        sides,
    };
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    Arc::new(square.map(|(x, z)| corner(x, z)).to_vec())
}

fn flat(data: Arc<Vec<Corner>>, culling: Culling) -> Batch {
    Batch::new(What::Faces { data, style: FaceStyle::Flat, culling })
}

fn ball(centre_m: Vec3, radius_m: f32, value: f32, colour: [u8; 4]) -> Batch {
    let data = Arc::new(vec![Ball { centre_m, radius_m, value, colour }]);
    Batch::new(What::Balls { data, least_px: 0.0, most_px: f32::INFINITY })
}

fn stroke(a_m: Vec3, b_m: Vec3, width_px: f32) -> Stroke {
    Stroke { a_m, b_m, width_px, value: 0.0, colour: GREEN, dashed: false, arrow: false }
}

fn strokes(strokes: Vec<Stroke>) -> Batch {
    Batch::new(What::Strokes { data: Arc::new(strokes) })
}

/// The colour where a point appears.
fn at(image: &RgbaImage, camera: &Camera, point_m: Vec3) -> [u8; 3] {
    let (px, _) = camera.project(point_m, Vec2::new(SIZE_PX[0] as f32, SIZE_PX[1] as f32)).unwrap();
    let [red, green, blue, alpha] = image.get_pixel(px.x as u32, px.y as u32).0;
    assert_eq!(alpha, 255, "pictures are opaque");
    [red, green, blue]
}

#[track_caller]
fn check(image: &RgbaImage, camera: &Camera, point_m: Vec3, want: [u8; 3]) {
    let got = at(image, camera, point_m);
    let apart = got.iter().zip(want).map(|(got, want)| got.abs_diff(want)).max().unwrap();
    assert!(apart <= 4, "{got:?} at {point_m}, not {want:?}");
}

#[test]
fn a_red_ball_is_red_in_the_middle_and_round() {
    let Some(mut offscreen) = offscreen() else { return };
    for orthographic in [false, true] {
        let mut picture = picture(vec![ball(Vec3::ZERO, 1.0, 0.0, RED)]);
        picture.camera.orthographic = orthographic;
        let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
        let camera = &picture.camera;
        check(&image, camera, Vec3::ZERO, [255, 0, 0]);
        let rim = at(&image, camera, Vec3::new(0.9, 0.0, 0.0));
        assert!(rim[0] > 100 && rim[0] < 220 && rim[1] == 0, "dimmer at the rim: {rim:?}");
        check(&image, camera, Vec3::new(0.8, 0.0, 0.8), BACKGROUND);
        check(&image, camera, Vec3::new(1.2, 0.0, 0.0), BACKGROUND);
    }
}

#[test]
fn a_ball_is_as_deep_as_it_is_round() {
    let Some(mut offscreen) = offscreen() else { return };
    // A wall 0.8 m before the middle of a ball of 1 m: the ball stands out of it with a radius of 0.6 m.
    for orthographic in [false, true] {
        let wall = flat(wall(Vec3::new(0.0, -0.8, 0.0), 2.0, 0.0, GREEN, 3), Culling::None);
        let mut picture = picture(vec![ball(Vec3::ZERO, 1.0, 0.0, RED), wall]);
        picture.camera.orthographic = orthographic;
        let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
        for (x, want_red) in [(0.0, true), (0.5, true), (0.72, false), (0.9, false)] {
            let [red, green, _] = at(&image, &picture.camera, Vec3::new(x, -0.8, 0.0));
            assert_eq!(red > green, want_red, "{x} m from the middle");
        }
    }
}

#[test]
fn small_balls_keep_their_least_size_and_near_ones_their_greatest() {
    let Some(mut offscreen) = offscreen() else { return };
    let mut picture = picture(Vec::new());
    for (radius_m, radius_px) in [(1e-4, 5.0), (3.0, 12.0)] {
        let data = Arc::new(vec![Ball { centre_m: Vec3::ZERO, radius_m, value: 0.0, colour: RED }]);
        picture.batches = vec![Batch::new(What::Balls { data, least_px: 5.0, most_px: 12.0 })];
        let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
        let red = image.pixels().filter(|pixel| pixel.0[0] > 60).count() as f32;
        let want = std::f32::consts::PI * radius_px * radius_px;
        assert!((red / want - 1.0).abs() < 0.15, "{red} pixels, not {want}");
    }
}

#[test]
fn the_nearer_of_two_walls_hides_the_other_whatever_the_order() {
    let Some(mut offscreen) = offscreen() else { return };
    let near = flat(wall(Vec3::new(0.0, -1.0, 0.0), 1.0, 0.0, RED, 3), Culling::None);
    let far = flat(wall(Vec3::new(0.0, 1.0, 0.0), 1.0, 0.0, GREEN, 3), Culling::None);
    for orthographic in [false, true] {
        for batches in [vec![near.clone(), far.clone()], vec![far.clone(), near.clone()]] {
            let mut picture = picture(batches);
            picture.camera.orthographic = orthographic;
            let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
            check(&image, &picture.camera, Vec3::ZERO, [255, 0, 0]);
        }
    }
}

#[test]
fn a_cut_takes_faces_away_and_leaves_strokes_that_it_does_not_concern() {
    let Some(mut offscreen) = offscreen() else { return };
    let mut face = flat(wall(Vec3::ZERO, 2.0, 0.0, RED, 3), Culling::None);
    face.cut = true;
    let line = strokes(vec![stroke(Vec3::new(-1.0, -0.5, 1.0), Vec3::new(1.0, -0.5, 1.0), 8.0)]);
    let mut picture = picture(vec![face, line]);
    picture.cuts = vec![Cut { normal: Vec3::Z, offset_m: 0.5 }];
    let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
    let camera = &picture.camera;
    check(&image, camera, Vec3::new(0.0, 0.0, 0.3), [255, 0, 0]);
    check(&image, camera, Vec3::new(0.0, 0.0, 0.7), BACKGROUND);
    check(&image, camera, Vec3::new(0.0, -0.5, 1.0), [0, 255, 0]);

    // A second cut takes away more, and the stroke too once it is told so.
    picture.cuts.push(Cut { normal: Vec3::X, offset_m: 0.0 });
    picture.batches[1].cut = true;
    let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
    check(&image, camera, Vec3::new(-0.5, 0.0, 0.3), [255, 0, 0]);
    check(&image, camera, Vec3::new(0.5, 0.0, 0.3), BACKGROUND);
    check(&image, camera, Vec3::new(-0.5, -0.5, 1.0), BACKGROUND);
}

#[test]
fn a_stroke_is_cut_where_the_plane_crosses_it() {
    let Some(mut offscreen) = offscreen() else { return };
    let mut line = strokes(vec![stroke(Vec3::new(-1.5, 0.0, 0.0), Vec3::new(1.5, 0.0, 0.0), 6.0)]);
    line.cut = true;
    let mut picture = picture(vec![line]);
    picture.cuts = vec![Cut { normal: Vec3::X, offset_m: 0.5 }];
    let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
    check(&image, &picture.camera, Vec3::new(0.3, 0.0, 0.0), [0, 255, 0]);
    check(&image, &picture.camera, Vec3::new(1.0, 0.0, 0.0), BACKGROUND);
}

#[test]
fn missing_values_are_grey_and_others_as_their_scale_has_them() {
    let Some(mut offscreen) = offscreen() else { return };
    for map in ColourMap::ALL {
        for logarithmic in [false, true] {
            let scale = Scale { map, low: 0.1, high: 10.0, logarithmic };
            for value in [f32::NAN, -1.0, 0.0, 0.01, 1.0, 3.0, 1e5] {
                let cube = Cube { centre_m: Vec3::new(2.5, 0.5, 0.0), face: 3, value, colour: RED };
                let dot = Ball { centre_m: Vec3::new(-2.5, 0.0, 0.0), radius_m: 1.0, value, colour: RED };
                let whats = [
                    What::Faces {
                        data: wall(Vec3::ZERO, 1.0, value, RED, 3),
                        style: FaceStyle::Flat,
                        culling: Culling::None,
                    },
                    What::Balls { data: Arc::new(vec![dot]), least_px: 1.0, most_px: 100.0 },
                    What::Cubes { data: Arc::new(vec![cube]), edge_m: 1.0, culling: Culling::None },
                ];
                let scaled = |what| Batch { tint: Tint::Scaled(scale), ..Batch::new(what) };
                let picture = picture(whats.map(scaled).to_vec());
                let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
                let want = scale.colour(value);
                check(&image, &picture.camera, Vec3::new(0.1, 0.0, 0.0), want);
                check(&image, &picture.camera, Vec3::new(-2.5, 0.0, 0.0), want);
                let cube = at(&image, &picture.camera, Vec3::new(2.5, 0.0, 0.0));
                let dimmed = want.map(f32::from).iter().zip(cube).all(|(want, got)| f32::from(got) <= want + 4.0);
                assert!(dimmed, "{cube:?} is a shade of {want:?}");
            }
        }
    }
    assert_eq!(Scale { map: ColourMap::Turbo, low: 0.0, high: 1.0, logarithmic: false }.colour(f32::NAN), GREY);
}

#[test]
fn values_vary_over_a_face_and_one_missing_corner_makes_it_grey() {
    let Some(mut offscreen) = offscreen() else { return };
    let mut corners = wall(Vec3::ZERO, 2.0, 0.0, RED, 3).to_vec();
    for corner in &mut corners {
        corner.value = corner.position_m.x;
    }
    let scale = Scale { map: ColourMap::Viridis, low: -2.0, high: 2.0, logarithmic: false };
    let heat = |corners| Batch { tint: Tint::Scaled(scale), ..flat(Arc::new(corners), Culling::None) };
    let mut shown = picture(vec![heat(corners.clone())]);
    let image = offscreen.render_picture(&shown, SIZE_PX).unwrap();
    for x in [-1.5, -0.4, 0.9] {
        check(&image, &shown.camera, Vec3::new(x, 0.0, 0.0), scale.colour(x));
    }
    corners[0].value = f32::NAN;
    shown.batches = vec![heat(corners)];
    let image = offscreen.render_picture(&shown, SIZE_PX).unwrap();
    check(&image, &shown.camera, Vec3::new(0.5, 0.0, -0.5), GREY);
    check(&image, &shown.camera, Vec3::new(-0.5, 0.0, 0.5), scale.colour(-0.5));
}

#[test]
fn only_sides_that_the_void_borders_are_drawn() {
    let Some(mut offscreen) = offscreen() else { return };
    // Seen from the south, the side of the normal: bit 0.
    for (sides, from_south, from_north) in [(0, false, false), (1, true, false), (2, false, true), (3, true, true)] {
        for (standard, want) in [(Standard::Front, from_south), (Standard::Back, from_north)] {
            for orthographic in [false, true] {
                let mut picture = picture(vec![flat(wall(Vec3::ZERO, 1.0, 0.0, RED, sides), Culling::ToVoid)]);
                picture.camera.look_from(standard);
                picture.camera.orthographic = orthographic;
                let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
                let want = if want { [255, 0, 0] } else { BACKGROUND };
                check(&image, &picture.camera, Vec3::new(0.2, 0.0, 0.1), want);
            }
        }
    }
}

#[test]
fn every_face_of_a_voxel_is_where_it_should_be_and_seen_from_outside_alone() {
    let Some(mut offscreen) = offscreen() else { return };
    let views = [Standard::Right, Standard::Left, Standard::Back, Standard::Front, Standard::Top, Standard::Bottom];
    for (face, outside) in (0..).zip(views) {
        for standard in views {
            let cube = Cube { centre_m: Vec3::ZERO, face, value: 0.0, colour: RED };
            let what = What::Cubes { data: Arc::new(vec![cube]), edge_m: 2.0, culling: Culling::ToVoid };
            let mut picture = picture(vec![Batch::new(what)]);
            picture.camera.look_from(standard);
            let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
            let red = image.pixels().filter(|pixel| pixel.0[0] > 100).count();
            let drawn = at(&image, &picture.camera, Vec3::ZERO) != BACKGROUND;
            assert_eq!(drawn, standard == outside, "face {face} from {standard:?}");
            assert_eq!(red > 0, drawn);
        }
    }
}

#[test]
fn shaded_faces_are_never_black_and_flat_ones_not_shaded() {
    let Some(mut offscreen) = offscreen() else { return };
    let data = wall(Vec3::ZERO, 1.0, 0.0, [200, 200, 200, 255], 3);
    for standard in [Standard::Front, Standard::Back, Standard::Oblique] {
        let [shaded, flat] = [FaceStyle::Shaded, FaceStyle::Flat].map(|style| {
            let what = What::Faces { data: Arc::clone(&data), style, culling: Culling::None };
            let mut picture = picture(vec![Batch::new(what)]);
            picture.camera.look_from(standard);
            let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
            at(&image, &picture.camera, Vec3::new(0.1, 0.0, 0.1))
        });
        assert_eq!(flat, [200; 3]);
        assert!((90..=200).contains(&shaded[0]), "{shaded:?} from {standard:?}");
    }
}

#[test]
fn a_wireframe_has_edges_and_no_insides() {
    let Some(mut offscreen) = offscreen() else { return };
    let what =
        What::Faces { data: wall(Vec3::ZERO, 2.0, 0.0, RED, 3), style: FaceStyle::Wireframe, culling: Culling::None };
    let picture = picture(vec![Batch::new(what)]);
    let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
    check(&image, &picture.camera, Vec3::new(0.9, 0.0, -0.4), BACKGROUND);
    let red = |x: f32, z: f32| at(&image, &picture.camera, Vec3::new(x, 0.0, z))[0];
    assert!(red(0.7, 0.7) > 100, "the diagonal: {}", red(0.7, 0.7));
    assert!(red(1.99, 0.5) > 60, "an edge: {}", red(1.99, 0.5));
}

#[test]
fn what_is_transparent_shows_what_is_behind_and_what_is_on_top_hides_it() {
    let Some(mut offscreen) = offscreen() else { return };
    let far = flat(wall(Vec3::new(0.0, 1.0, 0.0), 1.0, 0.0, GREEN, 3), Culling::None);
    let mut near = flat(wall(Vec3::new(0.0, -1.0, 0.0), 1.0, 0.0, RED, 3), Culling::None);
    near.opacity = 0.5;
    let mut shown = picture(vec![near, far]);
    let image = offscreen.render_picture(&shown, SIZE_PX).unwrap();
    check(&image, &shown.camera, Vec3::ZERO, [128, 128, 0]);

    shown.batches[0].opacity = 1.0;
    shown.batches[1].on_top = true;
    let image = offscreen.render_picture(&shown, SIZE_PX).unwrap();
    check(&image, &shown.camera, Vec3::ZERO, [0, 255, 0]);
}

#[test]
fn strokes_are_as_wide_as_asked_from_near_and_far() {
    let Some(mut offscreen) = offscreen() else { return };
    for distance_m in [5.0, 50.0] {
        let line = stroke(Vec3::new(-0.4, 0.0, 0.0), Vec3::new(0.4, 0.0, 0.0), 6.0);
        let mut picture = picture(vec![strokes(vec![line])]);
        picture.camera.distance_m = distance_m;
        let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
        let column = (0..SIZE_PX[1]).map(|y| f32::from(image.get_pixel(SIZE_PX[0] / 2, y).0[1]));
        let lit: f32 = column.map(|green| (green - 20.0) / 235.0).sum();
        assert!((lit - 6.0).abs() < 0.6, "{lit} px at {distance_m} m");
    }
}

#[test]
fn dashes_have_gaps_and_arrows_heads_at_their_ends() {
    let Some(mut offscreen) = offscreen() else { return };
    let plain = stroke(Vec3::new(-2.0, 0.0, 0.0), Vec3::new(2.0, 0.0, 0.0), 3.0);
    let mut green = |stroke: Stroke| {
        let picture = picture(vec![strokes(vec![stroke])]);
        let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
        let half = |right: bool| {
            let in_half = |x: u32| (x >= SIZE_PX[0] / 2) == right;
            image.enumerate_pixels().filter(|(x, _, pixel)| in_half(*x) && pixel.0[1] > 120).count()
        };
        (half(false), half(true))
    };
    let (plain_left, plain_right) = green(plain);
    let (dashed_left, dashed_right) = green(Stroke { dashed: true, ..plain });
    let (arrow_left, arrow_right) = green(Stroke { arrow: true, ..plain });
    assert!((plain_left as i64 - plain_right as i64).abs() < 10);
    assert!(3 * (dashed_left + dashed_right) < 2 * (plain_left + plain_right), "gaps");
    assert!(
        arrow_right > plain_right + 8 && arrow_left == plain_left,
        "a head at b: {arrow_right}, not {plain_right}; at a {arrow_left}, not {plain_left}"
    );
}

#[test]
fn a_stroke_that_passes_the_eye_is_drawn_up_to_it() {
    let Some(mut offscreen) = offscreen() else { return };
    let eye_m = camera().eye_m();
    let along = stroke(Vec3::new(0.3, 5.0, -0.5), eye_m + Vec3::new(0.3, -5.0, -0.5), 4.0);
    let picture = picture(vec![strokes(vec![along])]);
    let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
    check(&image, &picture.camera, Vec3::new(0.3, -5.0, -0.5), [0, 255, 0]);
    assert_eq!(at(&image, &picture.camera, Vec3::new(-0.3, -5.0, -0.5)), BACKGROUND);
}

#[test]
fn nothing_and_broken_numbers_draw_the_background() {
    let Some(mut offscreen) = offscreen() else { return };
    let empty = vec![
        flat(Arc::new(Vec::new()), Culling::None),
        flat(Arc::new(wall(Vec3::ZERO, 1.0, 0.0, RED, 3)[..2].to_vec()), Culling::None),
        strokes(Vec::new()),
        strokes(vec![stroke(Vec3::NAN, Vec3::NAN, 3.0), stroke(Vec3::ZERO, Vec3::X, 0.0)]),
        ball(Vec3::NAN, 1.0, 0.0, RED),
        ball(Vec3::ZERO, 0.0, 0.0, RED),
    ];
    let picture = picture(empty);
    let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
    assert!(image.pixels().all(|pixel| pixel.0[..3] == BACKGROUND));
}

#[test]
fn a_background_fades_from_top_to_bottom() {
    let Some(mut offscreen) = offscreen() else { return };
    let mut picture = picture(Vec::new());
    picture.background = [[0, 0, 200], [100, 0, 0]];
    let image = offscreen.render_picture(&picture, SIZE_PX).unwrap();
    let [top, middle, bottom] = [0, SIZE_PX[1] / 2, SIZE_PX[1] - 1].map(|y| image.get_pixel(7, y).0);
    assert!(top[2] >= 198 && bottom[0] >= 98 && middle[0].abs_diff(50) < 3 && middle[2].abs_diff(100) < 3);
}
