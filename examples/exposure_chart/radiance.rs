//! Radiance at a scene's sensors, through the script `radiance_annual.py`.
//!
//! All of the script is timed: Python's start, the scene's octree, the coefficients of the sky and one shadow ray an hour and
//! sensor. Its sky and the places of its suns are not ours, so a part of its error here, some tenths of a percent, is none.

use crate::measure::{Row, rmse, timed};
use lightvein::daylight::Exposure;
use lightvein::scene::Scene;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Divisions of the sky, 145 mf^2 patches, and rays of a sensor.
const QUALITIES: [[u32; 2]; 2] = [[1, 1000], [4, 1000]];

/// What it is worth at the sensors, which need normals.
pub fn rows(scene: &Scene, script: &Path, weather: &Path, truth: &[Exposure]) -> Result<Vec<Row>, Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("exposure_chart_{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let [mesh, sensors, table] = ["scene.obj", "sensors.csv", "out.csv"].map(|name| folder.join(name));
    fs::write(&mesh, wavefront(scene))?;
    fs::write(&sensors, sensor_table(scene))?;
    let mut rows = Vec::new();
    for [mf, samples] in QUALITIES {
        let mut command = Command::new("python3");
        command.arg(script).args([&mesh, weather, &sensors, &table]);
        command.args(["--mf", &mf.to_string(), "--samples", &samples.to_string()]);
        let (seconds, status) = timed(|| command.status());
        if !status?.success() {
            return Err(format!("{} failed", script.display()).into());
        }
        let mut totals = Vec::new();
        for record in csv::Reader::from_path(&table)?.records() {
            totals.push(record?.get(4).ok_or("the script's table has no total")?.parse()?);
        }
        let row = Row {
            at: "sensors",
            series: "Radiance",
            quality: format!("MF{mf}, {samples}"),
            is_smooth: false,
            made_s: 0.0,
            per_s: totals.len() as f64 / seconds,
            rmse: rmse(&totals, truth),
            svf: None,
        };
        rows.push(row.said());
    }
    fs::remove_dir_all(&folder)?;
    Ok(rows)
}

fn wavefront(scene: &Scene) -> String {
    let mut text = String::new();
    for at_m in &scene.mesh.positions_m {
        let _ = writeln!(text, "v {} {} {}", at_m.x, at_m.y, at_m.z);
    }
    for [a, b, c] in &scene.mesh.triangles {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    text
}

fn sensor_table(scene: &Scene) -> String {
    let mut text = "id,x,y,z,nx,ny,nz\n".to_owned();
    for (number, sensor) in scene.sensors.iter().enumerate() {
        let (at_m, normal) = (sensor.position_m, sensor.normal.unwrap_or_default());
        let _ = writeln!(text, "{number},{},{},{},{},{},{}", at_m.x, at_m.y, at_m.z, normal.x, normal.y, normal.z);
    }
    text
}
