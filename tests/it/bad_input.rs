//! Files that are broken: each is answered by one clear line, and no edit of a sound file makes a reader panic or hang.
//!
//! `tests/bad_input/expected.tsv` names a file and its error, one a line; `UPDATE_GOLDEN=1` writes it anew. What the
//! system says of a file it cannot read is left out. `tests/bad_input/sound/` holds what the edits begin with.

use lightvein::job::{Cancel, Progress, Quiet};
use lightvein::scene::file::read_scene_file;
use lightvein::scene::input::Input;
use lightvein::scene::read::{Format, RawMesh, mtl::read_mtl};
use lightvein::scene::reference::read_reference_csv;
use lightvein::scene::sensors::{read_pts, read_sensors_csv};
use lightvein::scene::{Scene, SceneError};
use lightvein::sky::weather::{Weather, WeatherFormat, epw::read_epw, wea::read_wea};
use proptest::prelude::*;
use std::fmt::Write;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_input")
}

/// Loads a file as what it is, a scene or weather, and gives its warnings.
fn load(file: &str, progress: &dyn Progress) -> Result<Vec<String>, SceneError> {
    let path = folder().join(file);
    match WeatherFormat::of(&path) {
        Some(_) => Weather::load(&path, progress, &Cancel::new()).map(|weather| weather.warnings),
        None => Scene::load(&path, progress, &Cancel::new()).map(|scene| scene.warnings),
    }
}

/// The error of a file without the folder it is in and without the system's words.
fn answer(file: &str) -> String {
    let error = match load(file, &Quiet) {
        Ok(warnings) => panic!("{file} loads, with {warnings:?}"),
        Err(error) => error.to_string(),
    };
    let inside = format!("{}/", folder().display());
    let error = error.replace(&inside, "");
    error.split_once("cannot be read: ").map_or(error.clone(), |(start, _)| format!("{start}cannot be read"))
}

#[test]
fn every_broken_file_is_answered_by_one_line_that_names_the_place() {
    let list = folder().join("expected.tsv");
    let expected = std::fs::read_to_string(&list).expect("the list of broken files");
    let mut answers = String::new();
    for line in expected.lines() {
        let (file, _) = line.split_once('\t').expect("a file and its error");
        let answer = answer(file);
        assert!(!answer.contains('\n') && answer.chars().all(|c| !c.is_control()), "{file}: {answer:?}");
        writeln!(answers, "{file}\t{answer}").expect("a string");
    }
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&list, &answers).expect("the list of broken files");
    }
    assert!(expected.lines().count() >= 60);
    for (want, got) in expected.lines().zip(answers.lines()) {
        assert_eq!(got, want);
    }

    // No file of the corpus lies there without being asked for.
    for entry in std::fs::read_dir(folder()).expect("the corpus") {
        let name = entry.expect("a file").file_name().into_string().expect("a plain name");
        let beside = [".mtl", ".csv", ".pts"].iter().any(|ending| name.ends_with(ending));
        let listed = expected.lines().any(|line| line.split('\t').next() == Some(&name));
        let known = ["expected.tsv", "make_binary.py", "make_weather.py", "sound", "folder.obj", "obj_wide.obj"]
            .contains(&name.as_str());
        assert!(beside || listed || known, "{name} is in no test");
    }
}

#[test]
fn the_sound_files_load() {
    for entry in std::fs::read_dir(folder().join("sound")).expect("the sound files") {
        let path = entry.expect("a file").path();
        if matches!(path.extension().and_then(|ending| ending.to_str()), Some("mtl" | "csv" | "pts" | "epw" | "wea")) {
            continue;
        }
        let scene = Scene::load(&path, &Quiet, &Cancel::new()).unwrap_or_else(|error| panic!("{error}"));
        assert!(scene.mesh.triangles.len() >= 12, "{}", path.display());
        let (low, high) = scene.mesh.bounds_m().expect("a mesh");
        assert_eq!(high - low, glam::Vec3::new(4.0, 3.0, 2.0), "{}", path.display());
    }
}

#[test]
fn loading_can_be_cancelled() {
    let cancel = Cancel::new();
    cancel.cancel();
    let error = Scene::load(&folder().join("sound/box.toml"), &Quiet, &cancel).expect_err("cancelled");
    assert!(error.is_cancelled());
}

/// Hears whether each stage ends before the next one begins.
#[derive(Default)]
struct Open(std::sync::atomic::AtomicI64);

impl Progress for Open {
    fn begin(&self, stage: &str, _total: u64) {
        let open = self.0.fetch_add(1, std::sync::atomic::Ordering::SeqCst);
        assert_eq!(open, 0, "{stage} begins inside another stage");
    }
    fn advance(&self, _units: u64) {
        assert_eq!(self.0.load(std::sync::atomic::Ordering::SeqCst), 1, "outside of any stage");
    }
    fn end(&self) {
        self.0.fetch_sub(1, std::sync::atomic::Ordering::SeqCst);
    }
}

#[test]
fn stages_follow_each_other_and_end_also_in_failure() {
    let expected = std::fs::read_to_string(folder().join("expected.tsv")).expect("the list of broken files");
    let broken = expected.lines().filter_map(|line| line.split('\t').next());
    for file in broken.chain([
        "sound/box.toml",
        "sound/box.gltf",
        "sound/box.glb",
        "sound/box.stl",
        "sound/box_big.ply",
        "sound/day.epw",
    ]) {
        let open = Open::default();
        let _ = load(file, &open);
        assert_eq!(open.0.into_inner(), 0, "{file} leaves a stage open");
    }
}

/// A change to a file: where, as a share of its length, and what.
#[derive(Debug, Clone)]
enum Edit {
    Overwrite(f64, Vec<u8>),
    Insert(f64, Vec<u8>),
    Delete(f64, usize),
    Repeat(f64, usize),
    Cut(f64),
}

/// Bytes that mean something to one reader or another, and bytes that do not.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let telling: Vec<Vec<u8>> = [
        "-",
        "0",
        "9999999999",
        "1e999",
        "nan",
        "inf",
        " ",
        "\n",
        "\r",
        "\"",
        "#",
        ",",
        "[",
        "]",
        "{",
        "}",
        "*",
        "\\",
        "/",
        "f 1 2 3\n",
        "v 0 0 0\n",
        "usemtl a\n",
        "\u{fffd}",
        "\0\0\0\0",
        "element vertex 99\n",
        "endfacet\n",
        "null",
        "-1",
    ]
    .iter()
    .map(|text| text.as_bytes().to_vec())
    .chain([vec![0xff; 4], vec![0xff], vec![0, 0, 0x80, 0x7f]])
    .collect();
    prop_oneof![prop::sample::select(telling), prop::collection::vec(any::<u8>(), 1..9)]
}

fn edit() -> impl Strategy<Value = Edit> {
    let at = || 0.0..1.0_f64;
    prop_oneof![
        4 => (at(), bytes()).prop_map(|(at, bytes)| Edit::Overwrite(at, bytes)),
        4 => (at(), bytes()).prop_map(|(at, bytes)| Edit::Insert(at, bytes)),
        2 => (at(), 1..40_usize).prop_map(|(at, count)| Edit::Delete(at, count)),
        2 => (at(), 1..200_usize).prop_map(|(at, count)| Edit::Repeat(at, count)),
        1 => at().prop_map(Edit::Cut),
    ]
}

fn apply(file: &mut Vec<u8>, edit: &Edit) {
    let offset = |share: f64, length: usize| (share * length as f64) as usize;
    match edit {
        Edit::Overwrite(at, bytes) => {
            let start = offset(*at, file.len());
            let end = (start + bytes.len()).min(file.len());
            file.splice(start..end, bytes.iter().copied());
        }
        Edit::Insert(at, bytes) => {
            let start = offset(*at, file.len());
            file.splice(start..start, bytes.iter().copied());
        }
        Edit::Delete(at, count) => {
            let start = offset(*at, file.len());
            file.drain(start..(start + count).min(file.len()));
        }
        Edit::Repeat(at, count) => {
            let start = offset(*at, file.len());
            let end = (start + count).min(file.len());
            let again = file[start..end].to_vec();
            file.splice(end..end, again);
        }
        Edit::Cut(at) => file.truncate(offset(*at, file.len())),
    }
}

/// Runs `read` on edited copies of a sound file: it must come back with a result or with an error of one line.
fn survives_edits<T>(sound: &str, read: impl Fn(&Input) -> Result<T, SceneError>, check: impl Fn(T)) {
    let path = folder().join("sound").join(sound);
    let whole = std::fs::read(&path).expect("a sound file");
    assert!(read(&Input { folder: path.parent().map(Path::to_owned), ..input(&whole, &path) }).is_ok(), "{sound}");
    let config = ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() };
    let outcome = proptest::test_runner::TestRunner::new(config).run(&prop::collection::vec(edit(), 1..6), |edits| {
        let mut bytes = whole.clone();
        edits.iter().for_each(|edit| apply(&mut bytes, edit));
        match read(&input(&bytes, &path)) {
            Ok(result) => check(result),
            Err(error) => assert!(!error.to_string().chars().any(char::is_control), "{error:?}"),
        }
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{sound}: {failure}"));
}

fn input<'a>(bytes: &'a [u8], path: &'a Path) -> Input<'a> {
    static NEVER: Cancel = Cancel::new();
    Input::alone(bytes, path, &Quiet, &NEVER)
}

/// What every reader promises of a mesh.
fn check_mesh(mesh: RawMesh) {
    assert_eq!(mesh.triangles.len(), mesh.material_of.len());
    assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < mesh.positions.len()));
    assert!(mesh.material_of.iter().all(|&number| (number as usize) < mesh.materials.len()));
    assert!(mesh.positions.iter().all(|position| position.is_finite()));
    for material in &mesh.materials {
        assert!(material.reflectance.is_none_or(|reflectance| (0.0..=1.0).contains(&reflectance)));
        assert!(material.emission_w_m2_sr >= 0.0 && material.emission_w_m2_sr.is_finite());
    }
    // No edit of these small files can ask for much.
    assert!(mesh.positions.len() < 1 << 16 && mesh.triangles.len() < 1 << 16);
}

#[test]
fn the_readers_of_meshes_survive_edits() {
    let files =
        ["box.obj", "box.ply", "box_little.ply", "box_big.ply", "box.stl", "box_binary.stl", "box.gltf", "box.glb"];
    for file in files {
        let format = Format::of(Path::new(file)).expect("a mesh");
        survives_edits(file, |input| format.read(input), check_mesh);
    }
    survives_edits("box.mtl", read_mtl, |_| {});
}

#[test]
fn the_readers_of_scenes_and_tables_survive_edits() {
    survives_edits("box.toml", read_scene_file, |description| assert!(!description.meshes.is_empty()));
    survives_edits("sensors.csv", read_sensors_csv, |sensors| {
        assert!(sensors.iter().all(|sensor| sensor.normal.is_none_or(|normal| (normal.length() - 1.0).abs() < 1e-9)));
    });
    survives_edits("sensors.pts", read_pts, |sensors| assert!(sensors.iter().all(|s| s.position_m.is_finite())));
    survives_edits("reference.csv", read_reference_csv, |rows| {
        assert!(rows.iter().all(|(_, reference)| reference.irradiance_w_m2 >= 0.0 && reference.stderr_w_m2 >= 0.0));
    });
}

/// What the readers promise of weather.
fn check_weather(weather: Weather) {
    let place = weather.place;
    assert!(place.latitude_rad.abs() < 1.6 && place.longitude_rad.abs() < 3.2 && place.utc_offset_h.abs() <= 14.0);
    for hour in &weather.hours {
        let given = [hour.dni_w_m2, hour.dhi_w_m2, hour.ghi_w_m2.unwrap_or(0.0)];
        assert!(given.iter().all(|irradiance| (0.0..=3000.0).contains(irradiance)), "{hour:?}");
        assert!(hour.length_h > 0.0 && hour.length_h <= 1.0 && hour.end() > hour.start);
    }
    assert!(weather.warnings.iter().all(|warning| !warning.contains(char::is_control)));
}

#[test]
fn the_readers_of_weather_survive_edits() {
    survives_edits("day.epw", read_epw, check_weather);
    survives_edits("day_crlf.epw", read_epw, check_weather);
    survives_edits("day.wea", read_wea, check_weather);
}

#[test]
fn edited_scenes_load_whole_or_fail() {
    let sound = folder().join("sound");
    let files = ["box.toml", "box.obj", "box.mtl", "box.ply", "sensors.csv", "reference.csv"];
    let whole = files.map(|file| std::fs::read(sound.join(file)).expect("a sound file"));
    let config = ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() };
    let edits = (0..files.len(), prop::collection::vec(edit(), 1..4));
    let outcome = proptest::test_runner::TestRunner::new(config).run(&edits, |(which, edits)| {
        let folder = tempfile::tempdir().expect("a folder");
        for (number, (name, bytes)) in files.iter().zip(&whole).enumerate() {
            let mut bytes = bytes.clone();
            edits.iter().filter(|_| number == which).for_each(|edit| apply(&mut bytes, edit));
            std::fs::write(folder.path().join(name), bytes).expect("an edited file");
        }
        if let Ok(scene) = Scene::load(&folder.path().join("box.toml"), &Quiet, &Cancel::new()) {
            let mesh = &scene.mesh;
            assert!(!mesh.triangles.is_empty() && mesh.triangles.len() == mesh.material_of.len());
            assert!((0..mesh.triangles.len()).all(|triangle| mesh.corners_m(triangle).is_some()));
            assert!(scene.materials.iter().all(|material| material.reflectance + material.transmittance <= 1.0 + 1e-6));
            assert!(scene.reference.is_empty() || scene.reference.len() == scene.sensors.len());
        }
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}
