//! Parts of a scene moved, scaled or hidden: what is computed anew is what all of it would be, bit by bit.

use super::program::{run, text};
use glam::{DVec3, Vec3};
use lightvein::daylight::camera::{Buffers, Camera};
use lightvein::daylight::cast::{Asked, Casting, cast_at};
use lightvein::daylight::dynamic::{Known, changed, seen_again, update};
use lightvein::daylight::surface::{Patch, corners, patches, patches_changed};
use lightvein::daylight::{Point, points};
use lightvein::job::{Cancel, Cancelled, Quiet};
use lightvein::light::Status;
use lightvein::rays::Rays;
use lightvein::scene::parts::Edit;
use lightvein::scene::{Scene, Site};
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::steps::Period;
use proptest::prelude::*;
use std::fmt::Write;
use std::path::Path;
use std::sync::LazyLock;

/// A closed box as an object of an OBJ file, its faces outwards.
fn solid(obj: &mut String, name: &str, low: [f64; 3], high: [f64; 3], vertices: &mut usize) {
    writeln!(obj, "o {name}").unwrap();
    for corner in 0..8 {
        let at = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
        writeln!(obj, "v {} {} {}", at(0), at(1), at(2)).unwrap();
    }
    for quad in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        let [a, b, c, d] = quad.map(|corner: usize| corner + *vertices + 1);
        writeln!(obj, "f {a} {b} {c} {d}").unwrap();
    }
    *vertices += 8;
}

/// A yard of 60 m with a tower, a shed, a wall and a pane before it; sensors about them. No two faces lie in one plane, and no
/// patch's middle in that of a wall: there it is the order in a tree that says which of two is hit.
fn yard() -> String {
    let (mut obj, mut vertices) = (String::new(), 0);
    for (name, low, high) in [
        ("ground", [-30.0, -30.0, -0.5], [30.0, 30.0, 0.0]),
        ("tower", [-2.93, -2.93, 0.02], [2.93, 2.93, 20.0]),
        ("shed", [8.07, -12.03, 0.02], [12.03, -8.07, 3.0]),
        ("wall", [-20.01, 10.13, 0.02], [20.01, 10.53, 5.0]),
    ] {
        solid(&mut obj, name, low, high, &mut vertices);
    }
    obj + "o pane\nusemtl glass\nv -6 -9 0.2\nv 6 -9 0.2\nv 6 -9 4\nv -6 -9 4\nf -4 -3 -2 -1\n"
}

const SENSORS: &str = "id,x,y,z,nx,ny,nz\nnorth,0,8,0,0,0,1\nsouth,0,-8,0,0,0,1\nroof,0,0,20,0,0,1\n\
    facade,0,-3,6,0,-1,0\nshed,10,-10,3,0,0,1\nfree,-25,-25,0,0,0,1\nall,0,-10,2,,,\nunder,0,0,-0.2,0,0,1\nbehind,0,12,1,0,1,0\n";

fn write_yard(folder: &Path, obj: &str) -> std::path::PathBuf {
    let toml = "[geometry]\nmeshes = [\"yard.obj\"]\n[[materials]]\nname = \"glass\"\ntransmittance = 0.5\n\
        [sensors]\nfile = \"yard.csv\"\n[site]\nlatitude_deg = 42.0\nlongitude_deg = -88.0\n";
    for (name, text) in [("yard.obj", obj), ("yard.toml", toml), ("yard.csv", SENSORS)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    folder.join("yard.toml")
}

static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    Scene::load(&write_yard(folder.path(), &yard()), &Quiet, &Cancel::new()).unwrap()
});

static RAYS: LazyLock<Rays> = LazyLock::new(|| Rays::new(&SCENE));

static MAP: LazyLock<ExposureMap> = LazyLock::new(|| {
    let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
    let outdoors = Outdoors::of(&site, None).unwrap();
    let steps = Outdoors { period: Period { step_min: 120.0, ..Period::YEAR }, ..outdoors }.steps().unwrap();
    let settings = MapSettings { size: [128, 64], ..MapSettings::default() };
    ExposureMap::build(&steps, &settings, &Quiet, &Cancel::new()).unwrap()
});

const CASTING: Casting = Casting { sun_rays: Some(24), sky_rays: 32, seed: 3 };

/// What an update gives, what all of it asked again with the same rays gives, and how many points were asked again.
fn both(edits: &[(String, Edit)], before: Asked, after: Asked) -> (usize, bool, bool) {
    let changes = SCENE.changes(edits).unwrap();
    let (rays, disturbance) = changed(&SCENE, &RAYS, &changes);
    let full = |rays: &Rays, asked| cast_at(rays, asked, &MAP, 0.3, CASTING, &Quiet, &Cancel::new()).unwrap();
    let exposures = full(&RAYS, before);
    let known = Known { rays: &RAYS, asked: before, exposures: &exposures };
    let updated = update(&rays, after, known, &disturbance, &MAP, 0.3, CASTING, &Quiet, &Cancel::new()).unwrap();
    let fresh = Rays::new(&SCENE.changed(&changes));
    let is_as_fresh = fresh.epsilon_m() != rays.epsilon_m() || updated.exposures == full(&fresh, after);
    (updated.again, updated.exposures == full(&rays, after), is_as_fresh)
}

fn edits() -> impl Strategy<Value = Vec<(String, Edit)>> {
    let part = prop::sample::select(vec!["tower", "shed", "wall", "pane", "*e*", "s*"]);
    let edit = prop_oneof![
        [-25.0..25.0, -25.0..25.0, -3.0..3.0].prop_map(|by_m| Edit::Move(DVec3::from_array(by_m))),
        (0.3..1.6).prop_map(Edit::Scale),
        Just(Edit::Hide),
    ];
    prop::collection::vec((part.prop_map(|name| name.replace("*e*", "*")), edit), 1..3)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn sensors_and_patches_get_what_a_full_run_gives(edits in edits()) {
        let sensors = points(&SCENE.sensors);
        let (again, is_full, is_fresh) = both(&edits, Asked::all(&sensors), Asked::all(&sensors));
        prop_assert!(is_full && again <= sensors.len());
        prop_assert!(is_fresh, "sensors, against rays of the changed scene");

        let cut = patches(&SCENE.mesh, 6.0, &Cancel::new()).unwrap();
        let changes = SCENE.changes(&edits).unwrap();
        let (left, moved) = patches_changed(&cut, &changes, &SCENE.change_of_triangles(&changes));
        let [before, after] = [&cut, &moved].map(|patches| patches.iter().map(Patch::point).collect::<Vec<Point>>());
        let asked = Asked { points: &after, numbers: Some(&left), in_the_open: false };
        let (_, is_full, is_fresh) = both(&edits, Asked::all(&before), asked);
        prop_assert!(is_full);
        prop_assert!(is_fresh, "patches, against rays of the changed scene");
    }

    #[test]
    fn a_camera_gets_what_a_full_run_gives(edits in edits()) {
        let (low_m, high_m) = SCENE.mesh.bounds_m().unwrap();
        let camera = Camera::around(low_m, high_m, 0.7, [48, 36]).unwrap();
        let (progress, cancel) = (Quiet, Cancel::new());
        let before = Buffers::render(&RAYS, &camera, &progress, &cancel).unwrap();
        let changes = SCENE.changes(&edits).unwrap();
        let (rays, disturbance) = changed(&SCENE, &RAYS, &changes);
        let after = seen_again(&before, &rays, &disturbance, &progress, &cancel).unwrap();
        prop_assert_eq!(&after, &Buffers::render(&rays, &camera, &progress, &cancel).unwrap());

        let listed = |buffers: &Buffers| -> (Vec<u32>, Vec<Point>) {
            (0..camera.pixels()).filter_map(|pixel| Some((pixel as u32, buffers.point(pixel)?))).unzip()
        };
        let [(old, old_points), (new, new_points)] = [listed(&before), listed(&after)];
        let [asked, again] = [(&old, &old_points), (&new, &new_points)]
            .map(|(numbers, points)| Asked { points, numbers: Some(numbers), in_the_open: true });
        let (_, is_full, _) = both(&edits, asked, again);
        prop_assert!(is_full);
    }
}

#[test]
fn what_lies_behind_or_below_concerns_nobody() {
    let edits = [("shed".to_owned(), Edit::Move(DVec3::new(3.0, 1.0, 0.0)))];
    let up = |x: f32, y: f32, z: f32| Point { position_m: Vec3::new(x, y, z), normal: Some(Vec3::Z) };
    let away = Point { position_m: Vec3::new(0.0, 10.53, 1.0), normal: Some(Vec3::Y) };
    // The scene's origin is its middle, in whole metres.
    let at = |point: Point| Point { position_m: point.position_m - SCENE.origin_m.as_vec3(), ..point };
    let open = |points: &[Point]| {
        let points: Vec<Point> = points.iter().copied().map(at).collect();
        let asked = Asked { points: &points, numbers: None, in_the_open: true };
        let (again, is_full, is_fresh) = both(&edits, asked, asked);
        assert!(is_full && is_fresh);
        again
    };
    assert_eq!(open(&[up(0.0, 0.0, 20.0), up(14.0, -14.0, 3.1), away]), 0);
    assert_eq!(open(&[up(10.0, -13.0, 0.0), up(0.0, 0.0, 20.0)]), 1);
}

#[test]
fn what_grows_beyond_the_scene_is_asked_anew_and_a_raised_flag_stops() {
    let sensors = points(&SCENE.sensors);
    let asked = Asked::all(&sensors);
    let edits = [("tower".to_owned(), Edit::Scale(4.0))];
    assert_eq!(both(&edits, asked, asked), (sensors.len(), true, true));

    let cancel = Cancel::new();
    cancel.cancel();
    let changes = SCENE.changes(&edits).unwrap();
    let (rays, disturbance) = changed(&SCENE, &RAYS, &changes);
    let known = Known { rays: &RAYS, asked, exposures: &[] };
    assert_eq!(update(&rays, asked, known, &disturbance, &MAP, 0.0, CASTING, &Quiet, &cancel), Err(Cancelled));
    assert_eq!(corners(&SCENE.mesh, &SCENE.parts, &cancel), Err(Cancelled));
}

#[test]
fn vertices_go_with_their_parts() {
    let corners = corners(&SCENE.mesh, &SCENE.parts, &Cancel::new()).unwrap();
    let changes =
        SCENE.changes(&[("tower".to_owned(), Edit::Hide), ("shed".to_owned(), Edit::Move(DVec3::X))]).unwrap();
    let (left, after) = corners.changed(&changes, &SCENE.change_of_triangles(&changes));
    assert_eq!((corners.points.len() - after.points.len(), corners.triangles.len() - after.triangles.len()), (24, 12));
    for (number, point) in left.iter().zip(&after.points) {
        let before = corners.points[*number as usize];
        let of_shed = SCENE.triangles_of(2).any(|triangle| triangle as u32 == corners.triangle_of[*number as usize]);
        let moved_m = point.position_m - before.position_m;
        assert!((moved_m - if of_shed { Vec3::X } else { Vec3::ZERO }).length() < 1e-5, "{moved_m}");
    }
    for (triangle, corners) in after.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|corner| after.positions_m[corner as usize]);
        assert!((b - a).cross(c - a).length() > 0.0, "{triangle}");
    }
}

#[test]
fn files_name_their_parts() {
    assert_eq!(
        SCENE.parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(),
        ["ground", "tower", "shed", "wall", "pane"]
    );
    let count: usize = SCENE.parts.iter().flat_map(|part| &part.triangles).map(|range| range.len()).sum();
    assert_eq!(count, SCENE.mesh.triangles.len());

    let folder = tempfile::tempdir().unwrap();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    let files = [
        ("a.obj", format!("o lid\n{square}g rim\nv 2 2 2\nf 2 3 4\no lid\nf 1 3 4\ng rim\nf 1 2 4\n")),
        ("b.obj", square.replace(" 0\n", " 7\n")),
        ("two.toml", "[geometry]\nmeshes = [\"a.obj\", \"b.obj\"]\n".to_owned()),
    ];
    for (name, text) in &files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let parts = |name: &str| {
        let scene = Scene::load(&folder.path().join(name), &Quiet, &Cancel::new()).unwrap();
        scene.parts.into_iter().map(|part| (part.name, part.triangles)).collect::<Vec<_>>()
    };
    let [lid, rim] = [vec![0..1, 2..3], vec![1..2, 3..4]];
    assert_eq!(parts("a.obj"), [("lid".to_owned(), lid), ("rim".to_owned(), rim)]);
    let names: Vec<String> = parts("two.toml").into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["a/lid", "a/rim", "b/b"]);
}

#[test]
fn expose_tells_both_results_and_hiding_is_as_if_it_had_never_been() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = write_yard(folder.path(), &yard());
    let quick = ["--sun-rays", "64", "--sky-rays", "64", "--step", "120", "--json"];
    let told = |scene: &Path, more: &[&str]| -> serde_json::Value {
        let output = run(&[&["expose", scene.to_str().unwrap()][..], &quick, more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let both = told(&scene, &["--hide", "tower", "--move", "shed=-5,0,0", "-o", out.to_str().unwrap()]);
    let update = &both["update"];
    assert_eq!((update["parts"].as_u64(), update["triangles"].as_u64()), (Some(2), Some(24)));
    assert_eq!(update["edits"].as_array().unwrap(), &["move shed=-5,0,0", "hide tower"]);
    assert!(update["seconds"].as_f64().unwrap() > 0.0 && update["full_seconds"].as_f64().unwrap() > 0.0);
    assert!(out.join("exposure.csv").exists() && out.join("exposure_after.csv").exists());
    assert_eq!(both["sensors"], told(&scene, &[])["sensors"], "the first result is of the scene as it is");

    // The same yard, written as the edits leave it.
    let (mut obj, mut vertices) = (String::new(), 0);
    for (name, low, high) in [
        ("ground", [-30.0, -30.0, -0.5], [30.0, 30.0, 0.0]),
        ("shed", [3.07, -12.03, 0.02], [7.03, -8.07, 3.0]),
        ("wall", [-20.01, 10.13, 0.02], [20.01, 10.53, 5.0]),
        ("mast", [29.9, 29.9, 0.0], [30.0, 30.0, 20.0]),
    ] {
        solid(&mut obj, name, low, high, &mut vertices);
    }
    obj += "o pane\nusemtl glass\nv -6 -9 0.2\nv 6 -9 0.2\nv 6 -9 4\nv -6 -9 4\nf -4 -3 -2 -1\n";
    let written = told(&write_yard(folder.path(), &obj), &["--hide", "mast"]);
    let [edited, written] = [update, &written["update"]].map(|update| update["sensors"].as_array().unwrap());
    assert_eq!(edited.len(), 9);
    for (edited, written) in edited.iter().zip(written) {
        let [a, b] = [edited, written].map(|sensor| sensor["total"].as_f64().unwrap());
        assert!((a - b).abs() < 0.5, "{edited} {written}");
    }
    let north = |sensors: &serde_json::Value| sensors[0]["beam"].as_f64().unwrap();
    assert!(north(&update["sensors"]) > 1.2 * north(&both["sensors"]), "no tower to the south any more");
    let under = &both["sensors"][7];
    assert_eq!(under["status"], Status::InSolid.name());
}

#[test]
fn edits_that_cannot_be_are_refused_with_what_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let scene = write_yard(folder.path(), &yard());
    #[track_caller]
    fn refuses(scene: &Path, edit: [&str; 2], code: i32, says: &str) {
        let output = run(&["expose", scene.to_str().unwrap(), edit[0], edit[1], "--step", "240"]);
        let stderr = text(&output.stderr);
        assert!(output.status.code() == Some(code) && stderr.contains(says), "{edit:?}: {stderr}");
    }
    let says = "yard.toml: no part is called \"garage\"; there are ground, tower, shed, wall, pane";
    refuses(&scene, ["--hide", "garage"], 1, says);
    refuses(&scene, ["--move", "garage=1,2,3"], 1, says);
    refuses(&scene, ["--move", "tower=1,2"], 2, "NAME=DX,DY,DZ");
    refuses(&scene, ["--move", "tower=1,2,inf"], 2, "NAME=DX,DY,DZ");
    refuses(&scene, ["--move", "tower=1,2,3e9"], 1, "tower: moved by 3000000000 m, which is outside -1e6 to 1e6");
    refuses(&scene, ["--scale", "tower=0"], 1, "tower: scaled by 0, which is outside 0.001 to 1000");
    refuses(&scene, ["--scale", "tower=NaN"], 1, "tower: scaled by NaN");
}
