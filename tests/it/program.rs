//! The program as a user meets it: exit codes, one clear line for an error, Ctrl-C, files, JSON.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

const GALLERY: &str = "scenes/gallery/gallery.toml";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn lightvein(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightvein"));
    command.current_dir(root()).args(arguments).stdin(Stdio::null());
    command
}

pub fn run(arguments: &[&str]) -> Output {
    lightvein(arguments).output().unwrap()
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Exit code `code`, nothing on stdout, and an error that says `says`.
#[track_caller]
fn refuses(arguments: &[&str], code: i32, says: &str) {
    let output = run(arguments);
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    assert!(stderr.contains(says), "{arguments:?} should say {says:?}: {stderr}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    assert!(output.stdout.is_empty(), "{arguments:?}: {}", text(&output.stdout));
}

#[test]
fn a_wrong_path_is_named() {
    refuses(&["analyse", "no/such/scene.toml"], 1, "no/such/scene.toml");
}

#[test]
fn wrong_usage_is_told_apart_from_bad_input() {
    refuses(&["analyse"], 2, "SCENE");
    refuses(&["analyse", GALLERY, "--sharpness", "3"], 2, "--sharpness");
    refuses(&["analyse", GALLERY, "--voxel", "0"], 2, "above 0 m");
    refuses(&["analyse", GALLERY, "--voxel", "wide"], 2, "not a number");
    refuses(&["analyse", GALLERY, "--method", "guess"], 2, "backward");
    refuses(&["analyse", GALLERY, "--threads", "0"], 2, "1..=1024");
    refuses(&["analyse", GALLERY, "--tolerance", "0.5"], 2, "factor above 1");
}

#[test]
fn a_wrong_key_names_its_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("wrong.toml");
    fs::write(&scene, "name = \"wrong\"\n[geometry]\nmeshes = [\"a.obj\"]\nreflectanse = 0.5\n").unwrap();
    refuses(&["analyse", scene.to_str().unwrap()], 1, "wrong.toml:4");
}

/// Every broken file of the corpus: exit code 1, one line, nothing on stdout, no file.
#[test]
fn the_program_answers_every_broken_file_by_one_line() {
    let corpus = root().join("tests/bad_input");
    let expected = fs::read_to_string(corpus.join("expected.tsv")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for file in expected.lines().filter_map(|line| line.split('\t').next()) {
        let path = corpus.join(file);
        let output = run(&["analyse", path.to_str().unwrap(), "--json", "-o", out.to_str().unwrap()]);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{file}: {stderr}");
        assert!(stderr.starts_with("error: ") && stderr.lines().count() == 1, "{file}: {stderr}");
        assert!(output.stdout.is_empty() && !out.exists(), "{file} left something behind");
    }
}

#[test]
fn a_grid_that_does_not_fit_says_which_voxel_would() {
    refuses(&["analyse", GALLERY, "--voxel", "0.00001"], 1, "--voxel");
}

#[test]
fn any_number_of_threads_runs_and_gives_the_same_figures() {
    let sensors = |threads| json(&["analyse", GALLERY, "--threads", threads]).0["sensors"].clone();
    assert_eq!(sensors("1"), sensors("3"));
}

#[test]
fn analyse_speaks_the_json_of_the_contract() {
    let output = run(&["analyse", GALLERY, "--json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let keys = [
        "scene",
        "method",
        "voxel_m",
        "grid",
        "void_voxels",
        "skeleton",
        "stages",
        "peak_memory_mb",
        "sensors",
        "warnings",
    ];
    for key in keys {
        assert!(!json[key].is_null(), "{key} is missing");
    }
    for key in ["nodes", "edges", "components", "loops", "cells", "necks"] {
        assert!(json["skeleton"][key].is_u64(), "skeleton.{key} is missing");
    }
    let sensors = json["sensors"].as_array().unwrap();
    assert_eq!(sensors.len(), 7);
    for sensor in sensors {
        assert_eq!(sensor["status"], "ok");
        assert!(sensor["value"].as_f64().unwrap() > 0.0);
        assert_eq!(sensor["direction"].as_array().unwrap().len(), 3);
    }
}

#[test]
fn analyse_says_what_it_chose_and_skipped_and_a_method_overrides_it() {
    let (chosen, _) = json(&["analyse", GALLERY, "--tolerance", "2"]);
    let choice = &chosen["choice"];
    assert_eq!((choice["tolerance"].as_f64(), choice["voxel_m"].is_f64()), (Some(2.0), true));
    assert!(choice["method"].as_str().unwrap().starts_with(chosen["method"].as_str().unwrap()));
    for key in ["modelled", "skipped"] {
        assert!(!choice[key].as_array().unwrap().is_empty(), "{key}");
    }
    let is_inside = choice["expected_factor"].as_f64().unwrap() <= 2.0;
    assert_eq!(choice["inside"].as_bool(), Some(is_inside));
    let skipped: Vec<&str> =
        choice["skipped"].as_array().unwrap().iter().map(|skipped| skipped["what"].as_str().unwrap()).collect();
    assert!(skipped.contains(&"backward"), "it has no error estimate of its own: {skipped:?}");

    let (asked, _) = json(&["analyse", GALLERY, "--method", "backward"]);
    assert!(asked["choice"].is_null());
    assert_eq!(asked["method"], "backward");
    let told = text(&run(&["analyse", GALLERY, "--tolerance", "1.000001"]).stdout);
    assert!(told.contains("NOT inside the tolerance") && told.contains("skipped: forward"), "{told}");
}

#[test]
fn compare_speaks_the_json_of_the_contract() {
    let output = run(&["compare", GALLERY, "--methods", "backward,forward", "--json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["prepare_seconds"].as_f64().unwrap() > 0.0);
    let methods = json["methods"].as_array().unwrap();
    assert_eq!(
        methods.iter().map(|method| method["name"].as_str().unwrap()).collect::<Vec<_>>(),
        ["backward", "forward"]
    );
    for method in methods {
        for key in ["seconds", "rms_factor", "max_factor", "median_angle_deg"] {
            assert!(method[key].is_f64(), "{key} is missing");
        }
        for sensor in method["sensors"].as_array().unwrap() {
            let ratio = sensor["value"].as_f64().unwrap() / sensor["reference"].as_f64().unwrap();
            assert!((sensor["ratio"].as_f64().unwrap() - ratio).abs() < 1e-9 * ratio);
        }
    }
}

#[test]
fn analyse_writes_its_files_whole() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("made/for/it");
    let output = run(&["analyse", GALLERY, "-o", out.to_str().unwrap()]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut names: Vec<String> =
        files(&out).iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect();
    names.sort();
    let want = [
        "field.csv",
        "field.ply",
        "plan.svg",
        "report.json",
        "skeleton.graphml",
        "skeleton.json",
        "skeleton.ply",
        "skeleton.swc",
        "voxels.json",
        "voxels.npy",
    ];
    assert_eq!(names, want);
    let skeleton: Value = serde_json::from_slice(&fs::read(out.join("skeleton.json")).unwrap()).unwrap();
    assert!(skeleton["units"]["length"].is_string());
    assert!(!skeleton["nodes"].as_array().unwrap().is_empty());
    let field = fs::read_to_string(out.join("field.csv")).unwrap();
    assert_eq!(field.lines().count(), 8);
}

#[test]
fn trace_gives_rows_that_a_scene_can_refer_to() {
    let output = run(&["trace", "scenes/furnace/furnace.toml", "--spp", "16"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    let mut rows = table.lines().filter(|line| !line.starts_with('#'));
    assert_eq!(rows.next(), Some("id,irradiance,stderr,fx,fy,fz"));
    assert!(rows.all(|row| row.split(',').count() == 6));
}

/// The whole command on a small scene: its files, its table, and that its front is one.
#[test]
fn chart_writes_its_files_and_marks_a_front_that_nothing_dominates() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("chart");
    let peer = folder.path().join("peer.csv");
    let head = "scene,method,quality,sensors,seconds,scaled,rms_factor,max_factor,lost";
    fs::write(&peer, format!("{head}\ntwo_rooms,other,4 samples,7,0.5,false,inf,inf,3\n")).unwrap();
    let paths = [out.to_str().unwrap(), peer.to_str().unwrap()];
    let scene = "scenes/two_rooms/two_rooms.toml";
    let output = run(&["chart", scene, "-o", paths[0], "--peer", paths[1], "--budget", "0.05", "--voxel", "0.2"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("for 1,000 sensors"), "{}", text(&output.stdout));
    assert_eq!(fs::read_to_string(out.join("chart.txt")).unwrap(), text(&output.stdout));
    assert!(fs::read(out.join("chart.png")).unwrap().starts_with(b"\x89PNG"));
    assert!(fs::read_to_string(out.join("chart.svg")).unwrap().contains("two_rooms: 7 sensors"));

    let table = fs::read_to_string(out.join("chart.csv")).unwrap();
    let mut rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let head = rows.next().unwrap();
    let column = |name: &str| head.iter().position(|&cell| cell == name).unwrap();
    let [method, sensors, pareto] = ["method", "sensors", "pareto"].map(column);
    let rows: Vec<_> = rows.collect();
    for wanted in ["backward", "forward", "trace", "other"] {
        assert!(rows.iter().any(|row| row[method] == wanted), "{wanted} is missing");
    }
    let figures = |row: &[&str]| ["total_seconds", "rms_factor"].map(|name| row[column(name)].parse::<f64>().unwrap());
    for row in rows.iter().filter(|row| row[pareto] == "true") {
        let [time, error] = figures(row);
        let rivals = rows.iter().filter(|rival| rival[sensors] == row[sensors]).map(|rival| figures(rival));
        assert!(!rivals.into_iter().any(|[sooner, better]| sooner < time && better < error), "{row:?} is dominated");
    }
    for count in ["7", "1000", "10000", "100000"] {
        assert!(rows.iter().any(|row| row[sensors] == count && row[pareto] == "true"), "no front for {count} sensors");
    }
    let alone = house(&folder.path().join("house"), &format!("{LAMP}{SENSORS}"));
    refuses(&["chart", &alone, "-o", paths[0]], 1, "a chart needs a reference");
    refuses(&["chart", scene], 2, "--output");
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_it_with_130_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = house(&folder.path().join("house"), &format!("{LAMP}{SENSORS}"));
    // Each would take minutes and more.
    let commands: [&[&str]; 4] = [
        &["trace", GALLERY, "--spp", "400000000"],
        &["compare", &scene, "--voxel", "0.1", "--spp", "400000000"],
        &["analyse", &scene, "--voxel", "0.006"],
        &["guide", &scene, "--voxel", "0.006"],
    ];
    let children = commands.map(|command| {
        let mut command = lightvein(command);
        command.args(["-o", out.to_str().unwrap()]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    });
    std::thread::sleep(Duration::from_millis(700));
    for child in &children {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    }
    for child in children {
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
        assert!(text(&output.stderr).ends_with("interrupted; nothing was written\n"), "{}", text(&output.stderr));
        assert!(output.stdout.is_empty() && !out.exists());
    }
}

/// A reader that has had enough, of tables or of warnings, is no failure.
#[test]
fn streams_that_close_early_are_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    // A scene that is warned of.
    let scene = house(folder.path(), "");
    let out = folder.path().join("out");
    let guide = ["guide", &scene, "-o", out.to_str().unwrap()];
    for arguments in [&["analyse", &scene][..], &["compare", &scene], &["trace", &scene], &guide] {
        let mut child = lightvein(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().unwrap().code(), Some(0), "{arguments:?}");
    }
    let mut child = lightvein(&["analyse", "no/such.toml"]).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(1));
}

const LAMP: &str = "[[lights]]\nkind = \"point\"\nposition = [2.0, 1.5, 1.2]\nflux_w = 100.0\n";
const SENSORS: &str = "[sensors]\nfile = \"sensors.csv\"\n";

/// Two closed rooms beside each other, 4 x 3 x 2.5 m and 3 x 3 x 2.5 m, with sensors in the first, in the second, in a wall
/// and outside; `rest` is what the scene file says besides. Gives the scene file.
fn house(folder: &Path, rest: &str) -> String {
    let mut mesh = String::new();
    for (number, [low, high]) in [[0, 4], [6, 9]].into_iter().enumerate() {
        for corner in 0..8 {
            let pick = |bit: usize, low: f32, high: f32| if corner >> bit & 1 == 0 { low } else { high };
            mesh += &format!("v {} {} {}\n", pick(0, low as f32, high as f32), pick(1, 0.0, 3.0), pick(2, 0.0, 2.5));
        }
        for quad in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let [a, b, c, d] = quad.map(|corner: usize| corner + 1 + 8 * number);
            mesh += &format!("f {a} {b} {c} {d}\n");
        }
    }
    fs::create_dir_all(folder).unwrap();
    fs::write(folder.join("house.obj"), mesh).unwrap();
    let sensors = "id,x,y,z,nx,ny,nz\nfirst,1,1,1,,,\nsecond,7.5,1.5,1,,,\nwall,4,1.5,1,-1,0,0\nback,4,1.5,1,1,0,0\nout,40,1,1,,,\n";
    fs::write(folder.join("sensors.csv"), sensors).unwrap();
    let scene = folder.join("house.toml");
    let head = "[model]\nvoxel_m = 0.1\n[geometry]\nmeshes = [\"house.obj\"]\nreflectance = 0.5\n";
    fs::write(&scene, format!("{head}{rest}")).unwrap();
    scene.to_str().unwrap().to_owned()
}

/// The object that `--json` gives, and what stderr says.
#[track_caller]
pub fn json(arguments: &[&str]) -> (Value, String) {
    let output = lightvein(arguments).arg("--json").output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
    (serde_json::from_slice(&output.stdout).unwrap(), text(&output.stderr))
}

#[test]
fn every_sensor_is_told_what_became_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let lamp_at = |position: &str| LAMP.replace("2.0, 1.5, 1.2", position);
    let lit = "ok unreached ok unreached outside";
    for (lights, statuses, says) in [
        (LAMP.to_owned(), lit, "stand in voids that no light reaches"),
        (LAMP.to_owned() + &lamp_at("7.0, 1.5, 1.2"), "ok ok ok unreached outside", "2 separate voids"),
        (LAMP.replace("100.0", "0.0"), "dark unreached dark unreached outside", "outside the box"),
        (lamp_at("2.0, 1.5, 0.0"), lit, "outside the box"),
        (lamp_at("50.0, 1.5, 1.2"), "unreached unreached unreached unreached outside", "1 light(s) lie outside"),
        (String::new(), "unreached unreached unreached unreached outside", "the scene has no light"),
    ] {
        let scene = house(folder.path(), &format!("{lights}{SENSORS}"));
        let (json, stderr) = json(&["analyse", &scene]);
        let found: Vec<&str> =
            json["sensors"].as_array().unwrap().iter().map(|sensor| sensor["status"].as_str().unwrap()).collect();
        assert_eq!(found.join(" "), statuses, "{lights}");
        assert!(stderr.contains(says), "{says}: {stderr}");
    }
    let (json, stderr) = json(&["compare", &house(folder.path(), LAMP), "--methods", "forward,forward"]);
    assert!(stderr.contains("the scene has no sensor"), "{stderr}");
    assert_eq!(json["methods"].as_array().unwrap().len(), 1, "a method named twice runs once");
}

#[test]
fn voxels_larger_than_the_mesh_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = house(folder.path(), LAMP);
    for metres in ["9.5", "1e30"] {
        refuses(&["analyse", &scene, "--voxel", metres], 1, "larger than the mesh, 9 m at its longest");
    }
    refuses(&["analyse", &scene, "--voxel", "1e-30"], 1, "voxels of 1e-30 m");
}

#[test]
fn a_folder_as_a_scene_and_a_file_as_a_folder_are_named_at_once() {
    refuses(&["analyse", "scenes"], 1, "scenes: cannot be read: it is a folder");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("taken");
    fs::write(&file, "mine").unwrap();
    // Before any work: the samples would take hours.
    for command in [
        &["trace", GALLERY, "--spp", "400000000"][..],
        &["analyse", GALLERY],
        &["compare", GALLERY],
        &["guide", GALLERY],
    ] {
        let below = file.join("below");
        for out in [&file, &below] {
            let arguments = [command, &["-o", out.to_str().unwrap()]].concat();
            refuses(&arguments, 1, "is not a folder");
        }
    }
    assert_eq!(fs::read(&file).unwrap(), b"mine");
}

#[test]
fn a_bare_mesh_is_lit_and_asked_by_every_command() {
    let folder = tempfile::tempdir().unwrap();
    house(folder.path(), "");
    let mesh = folder.path().join("house.obj");
    let mesh = mesh.to_str().unwrap();
    let (analysis, stderr) = json(&["analyse", mesh]);
    assert!(stderr.contains("a bare mesh: a light of 100 W"), "{stderr}");
    assert_eq!(analysis["sensors"][0]["status"], "ok");
    let traced = run(&["trace", mesh, "--spp", "16"]);
    assert!(traced.status.success(), "{}", text(&traced.stderr));
    assert!(text(&traced.stdout).contains("\ncell 0,"), "{}", text(&traced.stdout));
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_made_is_named() {
    refuses(&["compare", GALLERY, "-o", "/dev/null/out"], 1, "/dev/null/out");
}

/// All files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}
