//! The command `daylight`.

use super::super::program::{run, text};
use super::near;

#[test]
fn the_command_tells_each_sensor_and_what_was_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let scene = "scenes/outdoor/office/office.toml";
    let quick = ["--voxel", "0.2", "--sun-rays", "64", "--sky-rays", "64", "--step", "120"];
    let arguments = [&["daylight", scene, "--json", "-o", out.to_str().unwrap()][..], &quick].concat();
    let output = run(&arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(!text(&output.stderr).contains("leaks"), "{}", text(&output.stderr));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for key in ["scene", "seconds", "prepare_seconds", "method", "ghi", "lit_h"] {
        assert!(!told[key].is_null(), "{key}");
    }
    let sensors = told["sensors"].as_array().unwrap();
    assert_eq!(sensors.len(), 55);
    for key in ["id", "beam", "sky", "reflected", "total", "svf", "status", "error", "sun_h", "lux", "daylight_factor"]
    {
        assert!(sensors.iter().all(|sensor| !sensor[key].is_null()), "{key}");
    }
    let of = |id: &str, key: &str| sensors.iter().find(|row| row["id"] == id).unwrap()[key].as_f64().unwrap();
    assert!(of("room_middle_8", "reflected") > 5.0 && of("roof", "reflected") < 5.0);
    near(of("roof", "daylight_factor"), 100.0, 0.02, "on the roof");
    let table = std::fs::read_to_string(out.join("daylight.csv")).unwrap();
    assert!(table.lines().count() == 56 && table.starts_with("id,x_m,"), "{table}");

    // A moment, by a preview; at night there is nothing.
    let at = |time: &str, method: &str| {
        let arguments =
            ["daylight", scene, "--voxel", "0.2", "--sky-rays", "64", "--date", "2025-06-21", "--time", time];
        let output = run(&[&arguments[..], &["--method", method]].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        (text(&output.stdout), text(&output.stderr))
    };
    let (noon, warned) = at("12:00", "diffusion");
    assert!(noon.contains("kW/m2 at 2025-06-21 12:00") && warned.contains("preview"), "{noon}{warned}");
    assert!(at("00:30", "network").0.contains("dark"));
    let output = run(&["daylight", scene, "--date", "2025-06-21"]);
    assert_eq!(output.status.code(), Some(2));
}

/// A scene of 12 x 12 m of ground with a wall, or of a box, as files; what the program says of it.
fn says(reflectance: f64, sealed: bool) -> (serde_json::Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let corners = "v -6 -6 0\nv 6 -6 0\nv 6 6 0\nv -6 6 0\nv -6 -6 4\nv 6 -6 4\nv 6 6 4\nv -6 6 4\n";
    let ground_and_wall = "f 1 2 3 4\nf 3 4 8 7\n";
    // Seen from inside.
    let more = if sealed { "f 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 4 1 5 8\n" } else { "" };
    let toml = format!(
        "[geometry]\nmeshes = [\"a.obj\"]\nreflectance = {reflectance}\n[sensors]\nfile = \"a.csv\"\n\
         [site]\nlatitude_deg = 42.0\nlongitude_deg = 0.0\nutc_offset_h = 0.0\nturbidity = 3.0\n"
    );
    let sensors = "id,x,y,z,nx,ny,nz\na,0,0,0.8,0,0,1\n";
    for (name, text) in
        [("a.obj", &format!("{corners}{ground_and_wall}{more}")), ("a.toml", &toml), ("a.csv", &sensors.into())]
    {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let scene = folder.path().join("a.toml");
    let quick = ["--json", "--voxel", "0.25", "--sky-rays", "256", "--sun-rays", "64", "--step", "120"];
    let output = run(&[&["daylight", scene.to_str().unwrap()][..], &quick].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    (serde_json::from_slice(&output.stdout).unwrap(), text(&output.stderr))
}

#[test]
fn what_needs_no_skeleton_gets_none_and_a_sealed_room_is_told() {
    let (told, notes) = says(0.0, false);
    assert!(told["voxel_m"].is_null() && notes.contains("no surface reflects"), "{notes}");
    let sensor = &told["sensors"][0];
    assert!(sensor["reflected"] == 0.0 && sensor["daylight_factor"].as_f64().unwrap() > 60.0, "{sensor}");

    let (told, notes) = says(0.5, false);
    assert!(told["voxel_m"] == 0.25 && !notes.contains("leaks") && !notes.contains("sealed"), "{notes}");
    assert!(told["sensors"][0]["reflected"].as_f64().unwrap() > 10.0);

    let (told, notes) = says(0.5, true);
    assert!(notes.contains("no sky reaches it"), "{notes}");
    assert!(told["sensors"][0]["total"] == 0.0 && told["sensors"][0]["status"] == "dark", "{told}");
}
