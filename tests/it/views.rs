//! Exposure on faces, at vertices and in a camera's picture.

use super::program::{run, text};
use ndarray::Array3;
use ndarray_npy::ReadNpyExt;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};
use serde_json::Value;
use std::path::Path;

const COURTYARD: &str = "scenes/outdoor/courtyard/courtyard.toml";
const QUICK: [&str; 7] = ["--sun-rays", "24", "--sky-rays", "24", "--step", "120", "--json"];

fn told(arguments: &[&str]) -> Value {
    let output = run(&[&["expose"], arguments].concat());
    assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(vertex: &DefaultElement, name: &str) -> f64 {
    match vertex[name] {
        Property::Float(value) => f64::from(value),
        Property::Double(value) => value,
        Property::UChar(value) => f64::from(value),
        ref other => panic!("{name}: {other:?}"),
    }
}

/// The vertices and the number of faces of a PLY file, by another's reader.
fn read_ply(path: &Path) -> (Vec<DefaultElement>, usize) {
    let bytes = std::fs::read(path).unwrap();
    let mut ply = Parser::<DefaultElement>::new().read_ply(&mut bytes.as_slice()).unwrap();
    (ply.payload.shift_remove("vertex").unwrap(), ply.payload["face"].len())
}

#[test]
fn a_camera_writes_a_picture_and_numbers_the_same_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let mut arrays = Vec::new();
    for threads in ["1", "3"] {
        let out = folder.path().join(threads);
        let view = ["--size", "64x48", "--show", "svf", "--threads", threads, "-o", out.to_str().unwrap()];
        let told = told(&[&[COURTYARD], &view[..], &QUICK].concat());
        assert!(told["sensors"].is_null() && told["at"] == "camera");
        let points = &told["points"];
        assert_eq!(told["way"], "rays to 24 suns and 24 directions of the sky");
        assert!(points["error"].as_f64().unwrap() > 0.0);
        for quantity in ["total", "beam", "sky", "reflected", "svf", "sun_h"] {
            let spread = |name: &str| points["values"][quantity][name].as_f64().unwrap();
            let order = ["min", "p5", "p25", "p50", "p75", "p95", "max"].map(spread);
            assert!(order.windows(2).all(|pair| pair[0] <= pair[1]), "{quantity}: {order:?}");
            assert!((spread("min")..=spread("max")).contains(&spread("mean")), "{quantity}");
        }
        assert_eq!(points["files"].as_array().unwrap(), &["exposure_svf.png", "exposure.exr", "exposure.npy"]);
        let picture = image::open(out.join("exposure_svf.png")).unwrap();
        assert!(picture.width() > 560 && picture.height() > 48);
        let numbers = image::open(out.join("exposure.exr")).unwrap();
        assert_eq!((numbers.width(), numbers.height()), (64, 48));
        let bytes = std::fs::read(out.join("exposure.npy")).unwrap();
        let array = Array3::<f32>::read_npy(bytes.as_slice()).unwrap();
        assert_eq!(array.shape(), [48, 64, 6]);
        let seen = array.iter().filter(|value| value.is_finite()).count() / 6;
        assert_eq!(points["count"].as_u64(), Some(seen as u64));
        arrays.push(bytes);
    }
    assert_eq!(arrays[0], arrays[1]);
}

/// One pixel that looks down into the middle of the well: its sky view factor in closed form.
#[test]
fn a_pixel_in_the_well_sees_what_its_closed_form_says() {
    let view = ["--from", "0,0,40", "--to", "0,0,0", "--fov", "5", "--size", "1x1"];
    let rays = ["--sun-rays", "8", "--sky-rays", "16384", "--step", "240", "--json"];
    let told = told(&[&[COURTYARD], &view[..], &rays].concat());
    let svf = told["points"]["values"]["svf"]["mean"].as_f64().unwrap();
    assert_eq!(told["points"]["count"], 1);
    assert!((svf - 0.239_49).abs() < 0.005, "{svf}");
}

#[test]
fn a_ground_of_two_triangles_becomes_patches_that_know_the_shade() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let arguments = [&[COURTYARD, "--at", "faces", "--patch", "8", "-o", out.to_str().unwrap()], &QUICK[..]].concat();
    let told = told(&arguments);
    let count = told["points"]["count"].as_u64().unwrap() as usize;
    assert!((1_500..20_000).contains(&count), "{count}");
    let table = std::fs::read_to_string(out.join("exposure.csv")).unwrap();
    assert_eq!(table.lines().count(), count + 1);

    let (vertices, faces) = read_ply(&out.join("exposure.ply"));
    assert_eq!((vertices.len(), faces), (3 * count, count));
    let ghi = told["ghi"].as_f64().unwrap();
    let (mut shaded, mut open) = (0, 0);
    for patch in vertices.chunks(3) {
        let at = |name: &str| patch.iter().map(|vertex| number(vertex, name)).sum::<f64>() / 3.0;
        let total = at("total_kwh_m2");
        assert!(total.is_nan() || (total - at("quality")).abs() < 1e-3);
        let is_ground = patch.iter().all(|vertex| number(vertex, "z") == 0.0);
        if is_ground && at("y").abs() > 60.0 && at("x").abs() > 60.0 {
            assert!((total / ghi - 1.0).abs() < 0.05, "{total} of {ghi} at {} {}", at("x"), at("y"));
            open += 1;
        }
        if is_ground && at("x").abs() < 4.0 && at("y").abs() < 4.0 {
            assert!(total < 0.5 * ghi, "in the well: {total} of {ghi}");
            shaded += 1;
        }
    }
    assert!(open > 50 && shaded >= 1, "{open} {shaded}");
}

#[test]
fn vertices_of_a_roof_see_the_whole_sky_and_those_of_its_walls_half() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "o house\nv 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nv 0 0 6\nv 9 0 6\nv 9 9 6\nv 0 9 6\n\
        f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let (mesh, out) = (folder.path().join("house.obj"), folder.path().join("out"));
    std::fs::write(&mesh, obj).unwrap();
    let site = ["--at", "vertices", "--latitude", "42", "--longitude", "-88", "-o", out.to_str().unwrap()];
    let rays = ["--sun-rays", "8", "--sky-rays", "4096", "--step", "240", "--json"];
    let told = told(&[&[mesh.to_str().unwrap()], &site[..], &rays].concat());
    assert_eq!((told["points"]["count"].as_u64(), told["points"]["in_solid"].as_u64()), (Some(24), Some(0)));
    let (vertices, faces) = read_ply(&out.join("exposure.ply"));
    assert_eq!((vertices.len(), faces), (24, 12));
    let mut seen: Vec<f64> = vertices.iter().map(|vertex| number(vertex, "svf")).collect();
    seen.sort_by(f64::total_cmp);
    for (svf, want) in seen.into_iter().zip([[0.0; 4], [0.5; 4], [0.5; 4], [0.5; 4], [0.5; 4], [1.0; 4]].concat()) {
        assert!((svf - want).abs() < 0.005, "{svf} {want}");
    }
}

/// Without sensors a scene is asked at its faces; with some, at those.
#[test]
fn places_have_a_default() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("roof.obj");
    std::fs::write(&mesh, "v 0 0 0\nv 9 0 0\nv 9 9 0\nf 1 2 3\n").unwrap();
    let site = ["--latitude", "42", "--longitude", "-88"];
    assert_eq!(told(&[&[mesh.to_str().unwrap()], &site[..], &QUICK].concat())["at"], "faces");
    assert!(told(&[&[COURTYARD], &QUICK[..]].concat())["sensors"].is_array());
}

#[test]
fn impossible_views_are_refused_with_their_bound() {
    #[track_caller]
    fn refuses(arguments: &[&str], code: i32, says: &str) {
        let output = run(&[&["expose", COURTYARD, "--step", "240"], arguments].concat());
        let stderr = text(&output.stderr);
        assert!(output.status.code() == Some(code) && stderr.contains(says), "{arguments:?}: {stderr}");
        assert!(output.stdout.is_empty());
    }
    let place = "courtyard.toml: the camera";
    refuses(
        &["--from", "0,0,9", "--to", "0,0,9"],
        1,
        "courtyard.toml: the camera stands 0.0000 m from what it looks at",
    );
    refuses(&["--fov", "0"], 1, "field of view of 0 degrees is outside 1 to 170");
    refuses(&["--fov", "180"], 1, place);
    refuses(&["--fov", "-5"], 1, place);
    refuses(&["--size", "0x10"], 1, "0 x 10 pixels is outside 1 to 10000");
    refuses(&["--size", "20000x10"], 1, "20000 x 10 pixels is outside 1 to 10000");
    refuses(&["--size", "wide"], 2, "WIDTHxHEIGHT");
    refuses(&["--from", "1,2"], 2, "X,Y,Z");
    refuses(&["--from", "1,2,3"], 2, "--to");
    refuses(&["--from", "10,0,5", "--to", "0,0,5"], 1, "the camera stands inside matter");
    refuses(&["--from", "1e6,0,5", "--to", "0,0,5"], 1, "from the middle of the scene; beyond 4000 m");
    refuses(&["--at", "faces", "--fov", "40"], 1, "are for --at camera, not for --at faces");
    refuses(&["--at", "camera", "--patch", "4"], 1, "--patch is for --at faces, not for --at camera");
    refuses(&["--at", "faces", "--patch", "1e-4"], 1, "patches of 0.0001 m are more than 10000000; patches of");
    refuses(&["--show", "heat"], 2, "sun_h");
}
