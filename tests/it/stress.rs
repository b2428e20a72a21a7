//! The stress test as a user runs it: rows for every failure asked for, files, JSON.

use super::program::{json, lightvein, run, text};
use serde_json::Value;
use std::fs;

const TWO_ROOMS: &str = "scenes/two_rooms/two_rooms.toml";

/// Few trials, so that it takes a moment.
const FEW: [&str; 8] = ["--offsets", "2", "--turns", "1", "--seeds", "1", "--spp", "64"];

fn rows(output: &Value) -> &Vec<Value> {
    output["rows"].as_array().expect("rows")
}

#[test]
fn a_scene_is_disturbed_and_every_method_has_its_rows() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let disturbances = "grid_shift,turn,seed,voxel_size,wall_noise,reflectance";
    let mut arguments = vec!["stress", TWO_ROOMS, "--rows", disturbances, "--methods", "backward,forward,backward"];
    arguments.extend(FEW);
    arguments.extend(["-o", out.to_str().unwrap()]);
    let (output, _) = json(&arguments);

    // One case each of shift, turn and seed, four voxel sizes, two noises, six reflectances; a method named twice runs once.
    assert_eq!(rows(&output).len(), 2 * (3 + 4 + 2 + 6));
    let shift = &rows(&output)[0];
    assert_eq!((shift["scene"].as_str(), shift["failure"].as_str()), (Some("two_rooms"), Some("grid_shift")));
    assert_eq!(shift["moved"]["answers"], 40);
    assert!(shift["moved"]["p95_factor"].as_f64().unwrap() >= 1.0 && shift["worst_sensor"].is_string());
    assert_eq!(shift["truth"]["answers"], 40);
    for row in rows(&output) {
        let statuses = row["statuses"].as_object().unwrap();
        let sensors: u64 = statuses.values().map(|count| count.as_u64().unwrap()).sum();
        assert!(sensors >= 20 && row["warnings"].is_array(), "{row}");
    }

    let mut files: Vec<String> =
        fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    files.sort();
    assert_eq!(files, ["stress.csv", "stress.json", "stress.svg"]);
    let csv = fs::read_to_string(out.join("stress.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + rows(&output).len());
}

#[test]
fn without_a_scene_the_built_in_ones_are_asked() {
    let output = run(&["stress", "--rows", "thin_wall,separate_voids", "--methods", "forward", "--spp", "16"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    assert_eq!(table.lines().filter(|line| line.starts_with("built in")).count(), 5, "{table}");
    assert!(
        table.contains("4 unreached") && table.contains("] 4 sensor(s) stand in voids that no light reaches"),
        "{table}"
    );
}

#[test]
fn the_same_figures_on_one_thread_and_on_two() {
    let of = |threads| {
        let mut arguments = vec!["stress", TWO_ROOMS, "--rows", "grid_shift,wall_noise", "--threads", threads];
        arguments.extend(FEW);
        json(&arguments).0["rows"].clone()
    };
    assert_eq!(of("1"), of("2"));
}

#[test]
fn what_is_no_failure_is_refused() {
    let output = lightvein(&["stress", "--rows", "rain"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("grid_shift"), "{}", text(&output.stderr));
}
