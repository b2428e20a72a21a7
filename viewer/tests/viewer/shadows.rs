//! The command `shadows` as it is run: what it tells and writes, and how it ends.

use crate::app::scene;
use crate::shot::can_draw;
use std::path::Path;
use std::process::{Command, Output};

/// Columns of the table on stdout.
const COLUMNS: usize = 10;

/// The built program, few rows of few pixels asked for.
fn shadows(scene: &Path) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_lightvein-viewer"));
    program.arg("shadows").arg(scene).args(["--size", "96x72", "--resolutions", "64,128", "--layers", "2,3"]);
    program.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    program
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn run(program: &mut Command) -> Output {
    let output = program.output().expect("the program");
    assert!(!text(&output.stderr).contains("panicked"), "{}", text(&output.stderr));
    output
}

#[test]
fn table_chart_and_pictures_are_there() {
    if !can_draw() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("shadows of blocks");
    let mut program = shadows(&scene("outdoor/blocks"));
    program.args(["--date", "2025-03-20", "--time", "15:00", "--methods", "plain,vsm,lvsm,csm,hsm", "-o"]).arg(&out);
    let output = run(&mut program);
    assert!(output.status.success(), "{}", text(&output.stderr));

    let table = text(&output.stdout);
    let rows: Vec<Vec<&str>> = table.lines().skip(3).map_while(row).collect();
    // Two resolutions, two numbers of layers where there are layers, four variants of the hybrid map; then those by memory.
    assert!(rows.len() >= 2 + 2 + 4 + 4 + 4 + 4 && rows.iter().all(|row| row.len() == COLUMNS), "{table}");
    for row in &rows {
        let number = |column: usize| row[column].trim_end_matches('%').parse::<f64>().unwrap_or(f64::NAN);
        assert!(number(3) > 0.0 && number(4) > 0.0, "no memory or no time: {row:?}");
        assert!((0.0..40.0).contains(&number(5)) && (0.0..0.5).contains(&number(6)), "{row:?}");
    }
    // Finer maps are nearer to the truth.
    let wrong = |side: &str| rows.iter().find(|row| row[0] == "plain" && row[1] == side).map(|row| row[6]);
    assert!(wrong("64") > wrong("128") && wrong("128").is_some(), "{table}");
    for claim in ["layers that a hybrid map needs", "what takes as much memory", "time over VSM's"] {
        assert!(table.contains(claim), "{claim}: {table}");
    }

    let csv = std::fs::read_to_string(out.join("shadows.csv")).expect("the table");
    assert_eq!(csv.lines().count(), 1 + rows.len());
    assert!(std::fs::read_to_string(out.join("shadows.svg")).expect("the chart").contains("</svg>"));
    for name in ["truth", "truth_disc", "plain", "vsm_difference", "hsm", "hsm_difference"] {
        let image = image::open(out.join(format!("{name}.png"))).expect(name).to_rgba8();
        assert_eq!(image.dimensions(), (96, 72), "{name}");
        let first = image.get_pixel(48, 36);
        assert!(image.pixels().any(|pixel| pixel != first), "{name} is one colour");
    }
    let names: Vec<String> = std::fs::read_dir(&out)
        .expect("the folder")
        .map(|file| file.expect("a file").file_name().to_string_lossy().into_owned())
        .collect();
    assert!(names.len() == 2 + 2 + 2 * 5 && !names.iter().any(|name| name.ends_with(".part")), "{names:?}");
}

/// A line of the table, its method's name as one word; `None` after the last.
fn row(line: &str) -> Option<Vec<&str>> {
    let (name, numbers) = (line.get(..28)?.trim_end(), line.get(28..)?.trim_end_matches("by memory"));
    Some(std::iter::once(name).chain(numbers.split_whitespace()).collect())
}

#[test]
fn json_is_one_object_with_the_sun_and_the_rows() {
    if !can_draw() {
        return;
    }
    let mut program = shadows(&scene("outdoor/blocks"));
    program.args(["--date", "2025-06-21", "--time", "12:00", "--methods", "pcf", "--camera", "top", "--json"]);
    let output = run(&mut program);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON alone on stdout");
    assert_eq!(told["scene"], "blocks");
    // Chicago at noon of the longest day, some minutes after the sun's own: 71.5 degrees up, past south.
    let angle = |name: &str| told["sun"][name].as_f64().expect("an angle");
    assert!((angle("elevation_deg") - 71.4).abs() < 0.2 && (175.0..185.0).contains(&angle("azimuth_deg")), "{told}");
    let rows = told["rows"].as_array().expect("rows");
    // Two sizes, and the lifted variant at one of them.
    assert_eq!(rows.len(), 3);
    assert_eq!(rows.iter().filter(|row| row["variant"] == "lifted").count(), 1);
    assert!(rows.iter().all(|row| row["errors"]["counted_px"].as_u64() > Some(1000)), "{told}");
    assert_eq!(told["files"].as_array().map(Vec::len), Some(0));
}

#[test]
fn what_is_wrong_is_told_in_a_line_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let blocks = scene("outdoor/blocks");
    let two_rooms = scene("two_rooms");
    let file = folder.path().join("a file");
    std::fs::write(&file, "").expect("a file");
    let cases: [(&Path, &[&str], i32, &str); 7] = [
        (&blocks, &["--methods", "plain,smap"], 2, "\"smap\" is no shadow method; there are plain, pcf"),
        (&blocks, &["--resolutions", "9"], 2, "16 to 4096"),
        (&blocks, &["--layers", "40"], 2, "1 to 16"),
        (&blocks, &["--date", "2025-02-30"], 2, "--date"),
        (Path::new("nowhere.toml"), &[], 1, "nowhere.toml"),
        (&two_rooms, &[], 1, "there is no [site]"),
        (&blocks, &["--time", "02:00"], 1, "degrees below the horizon on 2025-06-21 at 02:00"),
    ];
    for (scene, args, code, told) in cases {
        let mut program = Command::new(env!("CARGO_BIN_EXE_lightvein-viewer"));
        let output = run(program.arg("shadows").arg(scene).args(args).arg("-o").arg(&out));
        let words = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{args:?}: {words}");
        let lines = words.lines().filter(|line| line.starts_with("error: ") && line.contains(told));
        assert_eq!(lines.count(), 1, "{args:?}: {told:?} is not in {words:?}");
        assert!(output.stdout.is_empty() && !out.exists(), "{args:?}");
    }
    let output = run(shadows(&blocks).arg("-o").arg(file.join("below")));
    assert!(text(&output.stderr).contains("is not a folder"), "{}", text(&output.stderr));
}

#[test]
fn a_view_of_nothing_has_times_and_no_errors() {
    if !can_draw() {
        return;
    }
    let mut program = shadows(&scene("outdoor/blocks"));
    // Up into the sky.
    program.args(["--methods", "plain,csm,hsm,hsm-light,lvsm", "--camera", "0,0,100:1,0,900"]);
    let output = run(&mut program);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("nothing in view faces the sun"), "{}", text(&output.stderr));
    assert!(text(&output.stdout).lines().skip(3).map_while(row).all(|row| row[5] == "-"), "{}", text(&output.stdout));
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_it_with_130_and_leaves_nothing() {
    if !can_draw() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let mut program = Command::new(env!("CARGO_BIN_EXE_lightvein-viewer"));
    program.arg("shadows").arg(scene("outdoor/blocks")).args(["--size", "2000x2000", "-o"]).arg(&out);
    program.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped());
    let child = program.spawn().expect("the program");
    std::thread::sleep(std::time::Duration::from_millis(500));
    let told = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(told.success());
    let output = child.wait_with_output().expect("its end");
    assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    assert!(text(&output.stderr).ends_with("interrupted; nothing was written\n"), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty() && !out.exists());
}
