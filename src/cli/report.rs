//! What the program says: the JSON objects that others read, and the tables a person reads.
//!
//! The keys of the JSON objects are a contract (docs/commands.md); tables may change.

use super::stages::Stage;
use super::table::{Table, figure};
use crate::light::{Field, Reading, Status};
use crate::model::Model;
use crate::scene::{Reference, Scene};
use crate::study::compare::Entry;
use crate::study::errors::{Errors, angle_deg, is_good};
use crate::study::tolerance::{Choice, Skipped};
use serde::Serialize;

/// `analyse --json`.
#[derive(Debug, Serialize)]
pub struct Analysis<'a> {
    scene: &'a str,
    method: &'a str,
    voxel_m: f32,
    grid: [usize; 3],
    void_voxels: usize,
    skeleton: SkeletonCounts,
    stages: Vec<StageRow>,
    peak_memory_mb: Option<f64>,
    sensors: Vec<SensorRow<'a>>,
    choice: Option<ChoiceRow<'a>>,
    warnings: &'a [String],
}

#[derive(Debug, Serialize)]
struct ChoiceRow<'a> {
    tolerance: f64,
    method: &'a str,
    voxel_m: f32,
    expected_factor: Option<f64>,
    inside: bool,
    modelled: &'a [String],
    skipped: Vec<SkippedRow<'a>>,
}

#[derive(Debug, Serialize)]
struct SkippedRow<'a> {
    what: &'a str,
    why: &'a str,
}

impl<'a> ChoiceRow<'a> {
    fn of(choice: &'a Choice) -> Self {
        Self {
            tolerance: choice.tolerance,
            method: &choice.method,
            voxel_m: choice.voxel_m,
            expected_factor: choice.expected_factor.filter(|factor| factor.is_finite()),
            inside: choice.is_inside(),
            modelled: &choice.modelled,
            skipped: choice.skipped.iter().map(|Skipped { what, why }| SkippedRow { what, why }).collect(),
        }
    }
}

#[derive(Debug, Serialize)]
struct SkeletonCounts {
    nodes: usize,
    edges: usize,
    components: usize,
    loops: usize,
    cells: usize,
    necks: usize,
}

#[derive(Debug, Serialize)]
struct StageRow {
    name: String,
    seconds: f64,
}

#[derive(Debug, Serialize)]
struct SensorRow<'a> {
    id: &'a str,
    value: f64,
    direction: [f64; 3],
    status: Status,
}

impl<'a> Analysis<'a> {
    /// The outcome of `analyse`; only outermost stages are listed, so that they add up.
    pub fn new(
        scene: &'a Scene,
        model: &Model,
        method: &'a str,
        field: &Field,
        choice: Option<&'a Choice>,
        stages: &[Stage],
        warnings: &'a [String],
    ) -> Self {
        let outermost = stages.iter().filter(|stage| stage.depth == 0);
        let sensors = scene.sensors.iter().zip(&field.readings).map(|(sensor, reading)| SensorRow {
            id: &sensor.id,
            value: reading.value_w_m2,
            direction: reading.direction().to_array(),
            status: reading.status,
        });
        let shape = model.skeleton.shape();
        Self {
            scene: &scene.name,
            method,
            voxel_m: model.voxels.lattice.voxel_m,
            grid: model.voxels.lattice.size,
            void_voxels: model.voxels.void.count(),
            skeleton: SkeletonCounts {
                nodes: model.skeleton.graph.node_count(),
                edges: model.skeleton.graph.edge_count(),
                components: shape.components,
                loops: shape.loops,
                cells: model.skeleton.cells.len(),
                necks: shape.necks,
            },
            stages: outermost.map(|stage| StageRow { name: stage.name.clone(), seconds: stage.seconds }).collect(),
            peak_memory_mb: stages
                .iter()
                .filter_map(|stage| stage.peak_memory_mb)
                .fold(None, |most: Option<f64>, mb| Some(most.map_or(mb, |most| most.max(mb)))),
            sensors: sensors.collect(),
            choice: choice.map(ChoiceRow::of),
            warnings,
        }
    }

    /// The same for a person, without the sensors.
    pub fn summary(&self) -> String {
        let [nx, ny, nz] = self.grid;
        let SkeletonCounts { nodes, edges, components, loops, cells, necks } = self.skeleton;
        format!(
            "{}: {nx} x {ny} x {nz} voxels of {} m, {} of them void\n\
             skeleton: {nodes} nodes, {edges} edges, {components} components, {loops} loops, {cells} cells, {necks} necks\n",
            self.scene, self.voxel_m, self.void_voxels
        )
    }
}

/// `compare --json`.
#[derive(Debug, Serialize)]
pub struct Comparison<'a> {
    scene: &'a str,
    voxel_m: f32,
    prepare_seconds: f64,
    methods: Vec<MethodRow<'a>>,
}

#[derive(Debug, Serialize)]
struct MethodRow<'a> {
    name: &'a str,
    seconds: f64,
    rms_factor: Option<f64>,
    max_factor: Option<f64>,
    median_angle_deg: Option<f64>,
    sensors: Vec<ComparedRow<'a>>,
}

#[derive(Debug, Serialize)]
struct ComparedRow<'a> {
    id: &'a str,
    value: f64,
    direction: [f64; 3],
    reference: Option<f64>,
    ratio: Option<f64>,
    status: Status,
}

impl<'a> Comparison<'a> {
    /// The outcome of `compare`; `seconds` gives the time of each entry. Infinite factors have no JSON and become null.
    pub fn new(
        scene: &'a Scene,
        model: &Model,
        entries: &'a [Entry],
        reference: &[Option<Reference>],
        prepare_seconds: f64,
        seconds: impl Fn(&Entry) -> f64,
    ) -> Self {
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        let method = |entry: &'a Entry| MethodRow {
            name: &entry.name,
            seconds: seconds(entry),
            rms_factor: finite(entry.errors.rms_factor),
            max_factor: finite(entry.errors.max_factor),
            median_angle_deg: entry.errors.median_angle_deg,
            sensors: (scene.sensors.iter().zip(&entry.field.readings).enumerate())
                .map(|(number, (sensor, reading))| {
                    let known = reference.get(number).copied().flatten();
                    ComparedRow {
                        id: &sensor.id,
                        value: reading.value_w_m2,
                        direction: reading.direction().to_array(),
                        reference: known.map(|known| known.irradiance_w_m2),
                        ratio: known.and_then(|known| ratio(reading, &known)),
                        status: reading.status,
                    }
                })
                .collect(),
        };
        Self {
            scene: &scene.name,
            voxel_m: model.voxels.lattice.voxel_m,
            prepare_seconds,
            methods: entries.iter().map(method).collect(),
        }
    }
}

/// Estimate over reference; `None` beside a reference of zero.
fn ratio(reading: &Reading, reference: &Reference) -> Option<f64> {
    (reference.irradiance_w_m2 > 0.0).then(|| reading.value_w_m2 / reference.irradiance_w_m2)
}

/// The sensors of an analysis, brightest first, their reference beside them.
pub fn sensor_table(scene: &Scene, method: &str, field: &Field) -> Table {
    let mut table = Table::with_head(
        ["sensor", &format!("{method} W/m2"), "reference W/m2", "ratio", "from", "angle", "status"]
            .map(str::to_owned)
            .into(),
    );
    for number in brightest_first(&field.readings) {
        let (Some(sensor), Some(reading)) = (scene.sensors.get(number), field.readings.get(number)) else { continue };
        let known = scene.reference.get(number).copied().flatten();
        let [x, y, z] = reading.direction().to_array();
        table.row(vec![
            sensor.id.clone(),
            figure(reading.value_w_m2),
            known.map_or_else(String::new, |known| figure(known.irradiance_w_m2)),
            known.and_then(|known| ratio(reading, &known)).map_or_else(String::new, figure),
            format!("{x:+.2} {y:+.2} {z:+.2}"),
            known
                .and_then(|known| angle_deg(reading, &known))
                .map_or_else(String::new, |angle| format!("{angle:.0} deg")),
            reading.status.name().to_owned(),
        ]);
    }
    table
}

/// The poster's table: a row a sensor, brightest first, a column of values and one of ratios for each method.
pub fn comparison_table(scene: &Scene, entries: &[Entry], reference: &[Option<Reference>]) -> Table {
    let columns = entries.iter().flat_map(|entry| [format!("{} W/m2", entry.name), "ratio".to_owned()]);
    let mut table =
        Table::with_head(["sensor".to_owned(), "reference W/m2".to_owned()].into_iter().chain(columns).collect());

    let known_first: Vec<f64> = (0..scene.sensors.len())
        .map(|number| {
            let known = reference.get(number).copied().flatten().map(|known| known.irradiance_w_m2);
            known.or_else(|| Some(entries.first()?.field.readings.get(number)?.value_w_m2)).unwrap_or(0.0)
        })
        .collect();
    let mut order: Vec<usize> = (0..scene.sensors.len()).collect();
    order.sort_by(|&a, &b| known_first[b].total_cmp(&known_first[a]));

    for number in order {
        let known = reference.get(number).copied().flatten();
        let mark = |known: &Reference| if is_good(known) { "" } else { " (left out)" };
        let shown = known.map_or_else(String::new, |known| {
            format!("{} +- {}{}", figure(known.irradiance_w_m2), figure(known.stderr_w_m2), mark(&known))
        });
        let mut row = vec![scene.sensors[number].id.clone(), shown];
        for entry in entries {
            let Some(reading) = entry.field.readings.get(number) else { continue };
            let value = match reading.status {
                Status::Ok => figure(reading.value_w_m2),
                other => format!("{} ({})", figure(reading.value_w_m2), other.name()),
            };
            row.extend([value, known.and_then(|known| ratio(reading, &known)).map_or_else(String::new, figure)]);
        }
        table.row(row);
    }
    table
}

/// A row of errors and seconds for each method.
pub fn error_table(entries: &[Entry], seconds: impl Fn(&Entry) -> f64) -> Table {
    let mut table = Table::new([
        "method",
        "rms factor",
        "max factor",
        "median angle",
        "not below",
        "lost",
        "sensors",
        "left out",
        "seconds",
    ]);
    for entry in entries {
        let Errors { rms_factor, max_factor, median_angle_deg, counted, left_out, lost, above } = entry.errors;
        let factor = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"));
        table.row(vec![
            entry.name.clone(),
            factor(rms_factor),
            factor(max_factor),
            median_angle_deg.map_or_else(|| "-".to_owned(), |angle| format!("{angle:.0} deg")),
            format!("{above} of {counted}"),
            lost.to_string(),
            counted.to_string(),
            left_out.to_string(),
            format!("{:.4}", seconds(entry)),
        ]);
    }
    table
}

/// Inner stages shorter than this are left out of the table, seconds.
const SHORTEST_SHOWN: f64 = 0.5e-3;

/// Stages with their times and the peak of memory by their end; inner stages that took long enough are indented.
pub fn stage_table(stages: &[Stage]) -> Table {
    let mut table = Table::new(["stage", "seconds", "peak MB"]);
    let is_shown = |stage: &&Stage| stage.depth == 0 || (stage.depth == 1 && stage.seconds >= SHORTEST_SHOWN);
    for stage in stages.iter().filter(is_shown) {
        let peak = stage.peak_memory_mb.map_or_else(|| "-".to_owned(), |mb| format!("{mb:.1}"));
        table.row(vec![format!("{}{}", "  ".repeat(stage.depth), stage.name), format!("{:.4}", stage.seconds), peak]);
    }
    table
}

/// Sensor numbers by falling value.
fn brightest_first(readings: &[Reading]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..readings.len()).collect();
    order.sort_by(|&a, &b| readings[b].value_w_m2.total_cmp(&readings[a].value_w_m2));
    order
}
