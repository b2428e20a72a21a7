//! A picture to see at a glance what was found: the void from above, the skeleton coloured by irradiance, necks, lights,
//! sensors. SVG, a legend with units in it. Storeys lie over each other.

use super::scale::{self, INFERNO_ON_WHITE};
use crate::light::Field;
use crate::model::Model;
use crate::scene::Scene;
use crate::space::VoxelIndex;
use crate::voxel::Voxels;
use glam::{IVec3, Vec3};
use petgraph::visit::EdgeRef;
use std::io::{self, Write};

/// Width of the drawing without its margins, in SVG units.
const WIDTH: f32 = 900.0;

/// Room around the drawing, and under it for the legend.
const MARGIN: f32 = 20.0;
const LEGEND: f32 = 60.0;

/// The void is drawn in at most this many cells across; finer ones only make the file larger.
const MOST_CELLS: usize = 300;

/// Decades of irradiance that the colours span, from the brightest node down.
const DECADES: f64 = 5.0;

/// Writes the plan; `at_nodes` is a field at the skeleton's nodes, in their order.
///
/// # Errors
/// What the writer says.
pub fn write(out: &mut dyn Write, scene: &Scene, model: &Model, at_nodes: &Field) -> io::Result<()> {
    let sheet = Sheet::of(model);
    let [width, height] = [WIDTH + 2.0 * MARGIN, sheet.height + 2.0 * MARGIN + LEGEND];
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" font-family="sans-serif" font-size="12">"#
    )?;
    writeln!(out, r##"<rect width="100%" height="100%" fill="#fff"/>"##)?;
    draw_void(out, model, &sheet)?;
    let brightest = at_nodes.readings.iter().map(|reading| reading.value_w_m2).fold(0.0, f64::max);
    draw_skeleton(out, model, &sheet, at_nodes, brightest)?;
    draw_necks(out, model, &sheet)?;
    draw_points(out, scene, model, &sheet)?;
    draw_legend(out, scene, &sheet, brightest)?;
    writeln!(out, "</svg>")
}

/// How metres become places on the sheet: x to the right, y up. It shows the box around the void and a voxel more.
struct Sheet {
    /// Lowest and highest voxel shown, along x and y.
    low: [usize; 2],
    high: [usize; 2],
    low_m: Vec3,
    units_per_m: f32,
    height: f32,
}

impl Sheet {
    fn of(model: &Model) -> Self {
        let Voxels { lattice, void, .. } = &*model.voxels;
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for VoxelIndex(at) in void.iter() {
            for (axis, along) in [at.x, at.y].into_iter().enumerate() {
                low[axis] = low[axis].min((along as usize).saturating_sub(1));
                high[axis] = high[axis].max((along as usize + 1).min(lattice.size[axis] - 1));
            }
        }
        let low = if void.is_empty() { [0; 2] } else { low };
        let [wide, deep] = [0, 1].map(|axis| (high[axis] - low[axis] + 1) as f32);
        Self {
            low,
            high,
            low_m: lattice.corner_m(IVec3::new(low[0] as i32, low[1] as i32, 0)),
            units_per_m: WIDTH / (wide * lattice.voxel_m),
            height: WIDTH * deep / wide,
        }
    }

    fn place(&self, point_m: Vec3) -> [f32; 2] {
        let from_low = (point_m - self.low_m) * self.units_per_m;
        [MARGIN + from_low.x, MARGIN + self.height - from_low.y]
    }
}

/// Columns that hold void, in runs along x.
fn draw_void(out: &mut dyn Write, model: &Model, sheet: &Sheet) -> io::Result<()> {
    let [nx, ny] = [0, 1].map(|axis| sheet.high[axis] - sheet.low[axis] + 1);
    let stride = nx.max(ny).div_ceil(MOST_CELLS);
    let has_void = |x: usize, y: usize| {
        let column = [x + sheet.low[0], y + sheet.low[1]].map(|along| along as i32);
        let up = 0..model.voxels.lattice.size[2] as i32;
        up.into_iter().any(|z| model.voxels.void.get(VoxelIndex::new(column[0], column[1], z)))
    };
    let cell = WIDTH / nx as f32 * stride as f32;
    writeln!(out, r##"<g fill="#d9dde3">"##)?;
    for (row, y) in (0..ny).step_by(stride).enumerate() {
        let open: Vec<bool> = (0..nx).step_by(stride).map(|x| has_void(x, y)).collect();
        let mut start = 0;
        for run in open.chunk_by(|a, b| a == b) {
            if run[0] {
                let [left, top] = [MARGIN + start as f32 * cell, MARGIN + sheet.height - (row + 1) as f32 * cell];
                let wide = run.len() as f32 * cell;
                writeln!(out, r#"<rect x="{left:.1}" y="{top:.1}" width="{wide:.1}" height="{:.1}"/>"#, cell + 0.6)?;
            }
            start += run.len();
        }
    }
    writeln!(out, "</g>")
}

fn draw_skeleton(
    out: &mut dyn Write,
    model: &Model,
    sheet: &Sheet,
    at_nodes: &Field,
    brightest: f64,
) -> io::Result<()> {
    writeln!(out, r#"<g stroke-width="3" stroke-linecap="round">"#)?;
    for edge in model.skeleton.graph.edge_references() {
        let [[x1, y1], [x2, y2]] = [edge.source(), edge.target()].map(|end| sheet.place(model.node_m(end)));
        let value = |end: petgraph::graph::NodeIndex| {
            at_nodes.readings.get(end.index()).map_or(0.0, |reading| reading.value_w_m2)
        };
        let colour = colour((value(edge.source()) + value(edge.target())) / 2.0, brightest);
        writeln!(out, r#"<line x1="{x1:.1}" y1="{y1:.1}" x2="{x2:.1}" y2="{y2:.1}" stroke="{colour}"/>"#)?;
    }
    writeln!(out, "</g>")
}

/// Necks as bars across the passage, as wide as a square of their area; those that lead up or down as squares.
fn draw_necks(out: &mut dyn Write, model: &Model, sheet: &Sheet) -> io::Result<()> {
    writeln!(out, r##"<g stroke="#0a7d8c" stroke-width="4" fill="none">"##)?;
    for neck in &model.skeleton.necks {
        let [x, y] = sheet.place(neck.position_m);
        let half = neck.area_m2.sqrt() / 2.0 * sheet.units_per_m;
        let level = Vec3::new(neck.normal.x, neck.normal.y, 0.0);
        if level.length() > 0.5 {
            let [across_x, across_y] = [half * -level.y / level.length(), half * -level.x / level.length()];
            let [x1, y1, x2, y2] = [x - across_x, y - across_y, x + across_x, y + across_y];
            writeln!(out, r#"<line x1="{x1:.1}" y1="{y1:.1}" x2="{x2:.1}" y2="{y2:.1}"/>"#)?;
        } else {
            let [left, top, side] = [x - half, y - half, 2.0 * half];
            writeln!(out, r#"<rect x="{left:.1}" y="{top:.1}" width="{side:.1}" height="{side:.1}"/>"#)?;
        }
    }
    writeln!(out, "</g>")
}

/// More sensors than this are drawn without their names, more lights than this as small dots.
const MOST_NAMES: usize = 40;

fn draw_points(out: &mut dyn Write, scene: &Scene, model: &Model, sheet: &Sheet) -> io::Result<()> {
    let radius = if model.shining.len() > MOST_NAMES { 3.5 } else { 7.0 };
    for light in &model.shining {
        let [x, y] = sheet.place(light.position_m);
        writeln!(out, r##"<circle cx="{x:.1}" cy="{y:.1}" r="{radius}" fill="#ffd400" stroke="#333"/>"##)?;
    }
    for sensor in &scene.sensors {
        let [x, y] = sheet.place(sensor.position_m);
        writeln!(out, r##"<circle cx="{x:.1}" cy="{y:.1}" r="3" fill="#1a56c4"/>"##)?;
        if scene.sensors.len() <= MOST_NAMES {
            let [x, y] = [x + 6.0, y - 6.0];
            writeln!(out, r##"<text x="{x:.1}" y="{y:.1}" fill="#1a56c4">{}</text>"##, escaped(&sensor.id))?;
        }
    }
    Ok(())
}

fn draw_legend(out: &mut dyn Write, scene: &Scene, sheet: &Sheet, brightest: f64) -> io::Result<()> {
    let top = sheet.height + 2.0 * MARGIN;
    let step = 40.0;
    for decade in 0..=DECADES as usize {
        let value = brightest * 10_f64.powf(decade as f64 - DECADES);
        let left = MARGIN + decade as f32 * step;
        writeln!(
            out,
            r#"<rect x="{left:.1}" y="{top:.1}" width="{step}" height="12" fill="{}"/>"#,
            colour(value, brightest)
        )?;
        writeln!(out, r#"<text x="{left:.1}" y="{:.1}" font-size="10">{value:.0e}</text>"#, top + 24.0)?;
    }
    let [left, line] = [MARGIN + 7.0 * step, top + 11.0];
    writeln!(
        out,
        r##"<text x="{left:.1}" y="{line:.1}">W/m2 at the skeleton's nodes; yellow: lights; blue: sensors; teal: necks</text>"##
    )?;
    let metre = sheet.units_per_m;
    writeln!(
        out,
        r##"<line x1="{left:.1}" y1="{0:.1}" x2="{1:.1}" y2="{0:.1}" stroke="#333"/>"##,
        top + 24.0,
        left + metre
    )?;
    writeln!(
        out,
        r#"<text x="{:.1}" y="{:.1}">1 m; {} from above</text>"#,
        left + metre + 6.0,
        top + 28.0,
        escaped(&scene.name)
    )
}

/// The colour of an irradiance, by its decades below the brightest.
fn colour(value: f64, brightest: f64) -> String {
    let share = if value > 0.0 { 1.0 + (value / brightest).log10() / DECADES } else { 0.0 };
    let [red, green, blue] = scale::colour(&INFERNO_ON_WHITE, share);
    format!("rgb({red},{green},{blue})")
}

/// A name as XML text.
pub(super) fn escaped(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
