//! The points of a chart as CSV.

use crate::study::chart::{Point, SceneChart};
use std::io::{self, Write};

/// Writes a row a point. Times are seconds; `total_seconds` includes the preparation; `scaled`: measured at fewer sensors;
/// `rms_factor` is `inf` where sensors were lost; `pareto`: no other point of the same number of sensors is both faster and
/// more accurate; `equal_error`: how many times longer the path tracer takes for the same error, with `>` or `<` for a bound.
///
/// # Errors
/// What the writer says.
pub fn write_csv(out: &mut dyn Write, charts: &[SceneChart]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "scene",
        "method",
        "quality",
        "voxel_m",
        "sensors",
        "prepare_seconds",
        "seconds",
        "total_seconds",
        "scaled",
        "rms_factor",
        "max_factor",
        "median_angle_deg",
        "lost",
        "pareto",
        "equal_error",
    ])?;
    for chart in charts {
        for point in &chart.points {
            table.write_record(row(&chart.scene, point))?;
        }
    }
    table.flush()
}

fn row(scene: &str, point: &Point) -> Vec<String> {
    let figure = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4}"));
    let seconds = |seconds: f64| format!("{seconds:.6}");
    vec![
        scene.to_owned(),
        point.method.clone(),
        point.quality.clone(),
        point.voxel_m.map_or_else(String::new, |voxel_m| voxel_m.to_string()),
        point.sensors.to_string(),
        seconds(point.prepare_seconds),
        seconds(point.seconds),
        seconds(point.total_seconds()),
        point.is_scaled.to_string(),
        figure(point.rms_factor()),
        figure(point.errors.max_factor),
        figure(point.errors.median_angle_deg),
        point.errors.lost.to_string(),
        point.is_front.to_string(),
        point.equal_error.map_or_else(String::new, |ratio| ratio.short()),
    ]
}
