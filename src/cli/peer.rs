//! Points of other programs, for the chart: a CSV with a row for each number of samples and sensors.

use crate::study::chart::Point;
use crate::study::errors::Errors;
use anyhow::{Context, Result, bail};
use serde::Deserialize;
use std::path::PathBuf;

/// A row of the table.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    scene: String,
    method: String,
    quality: String,
    sensors: usize,
    seconds: f64,
    scaled: bool,
    /// `inf` where sensors were lost.
    rms_factor: f64,
    max_factor: f64,
    lost: usize,
}

/// What other programs measured.
#[derive(Debug, Default)]
pub struct Peers {
    rows: Vec<Row>,
}

/// Reads all tables.
///
/// # Errors
/// Names the file, and the line of the first row that is not one.
pub fn read_all(paths: &[PathBuf]) -> Result<Peers> {
    let mut peers = Peers::default();
    for path in paths {
        let place = || format!("{}: cannot be read as a table of points", path.display());
        let mut table = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).with_context(place)?;
        for row in table.deserialize() {
            let row: Row = row.with_context(place)?;
            if !(row.seconds > 0.0 && row.seconds.is_finite() && row.rms_factor >= 1.0 && row.max_factor >= 1.0) {
                bail!("{}: seconds are above 0, factors 1 and above: {row:?}", path.display());
            }
            peers.rows.push(row);
        }
    }
    Ok(peers)
}

impl Peers {
    /// The points measured in a scene.
    pub fn points_of(&self, scene: &str) -> impl Iterator<Item = Point> {
        let rows = self.rows.iter().filter(move |row| row.scene == scene);
        rows.map(|row| Point {
            method: row.method.clone(),
            quality: row.quality.clone(),
            voxel_m: None,
            sensors: row.sensors,
            prepare_seconds: 0.0,
            seconds: row.seconds,
            is_scaled: row.scaled,
            errors: Errors {
                rms_factor: Some(row.rms_factor),
                max_factor: Some(row.max_factor),
                median_angle_deg: None,
                counted: 0,
                left_out: 0,
                lost: row.lost,
                above: 0,
            },
            is_front: false,
            equal_error: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_points_of_their_scene_and_wrong_ones_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("peer.csv");
        let head = "scene,method,quality,sensors,seconds,scaled,rms_factor,max_factor,lost\n";
        let read = |rows: &str| {
            std::fs::write(&path, format!("# by a peer\n{head}{rows}")).unwrap();
            read_all(std::slice::from_ref(&path))
        };
        let peers =
            read("hall,mitsuba,4 samples,7,0.5,false,inf,inf,3\nother,mitsuba,4 samples,7,1,true,2,3,0\n").unwrap();
        let points: Vec<Point> = peers.points_of("hall").collect();
        assert_eq!((points.len(), points[0].errors.lost, points[0].total_seconds()), (1, 3, 0.5));
        assert!(points[0].rms_factor().is_some_and(f64::is_infinite));
        for rows in
            ["hall,mitsuba,4 samples,7,-1,false,2,2,0\n", "hall,mitsuba,4 samples,few,1,false,2,2,0\n", "hall\n"]
        {
            assert!(format!("{:#}", read(rows).unwrap_err()).contains("peer.csv"), "{rows}");
        }
    }
}
