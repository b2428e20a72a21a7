//! Virtual lights, probes and cache records as CSV, with units in the names of the columns; virtual lights and necks as PLY.

use super::{Guided, cell};
use glam::Vec3;
use std::io::{self, Write};

/// Writes `vpls.csv`.
///
/// # Errors
/// What the writer says.
pub fn write_virtual_lights(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    writeln!(out, "x_m,y_m,z_m,nx,ny,nz,flux_w,cell")?;
    for light in &guided.guide.vpls {
        let at = placed(guided, light.position_m, light.normal, ',');
        writeln!(out, "{at},{:e},{}", light.flux_w, cell(light.cell))?;
    }
    Ok(())
}

/// Writes `vpls.ply`.
///
/// # Errors
/// What the writer says.
pub fn write_virtual_lights_ply(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    writeln!(out, "ply\nformat ascii 1.0")?;
    writeln!(out, "comment virtual point lights: Lambertian, on the side of their normal; positions in m, flux in W")?;
    writeln!(out, "element vertex {}", guided.guide.vpls.len())?;
    writeln!(out, "property double x\nproperty double y\nproperty double z")?;
    writeln!(out, "property float nx\nproperty float ny\nproperty float nz")?;
    writeln!(out, "property float flux\nproperty int cell\nend_header")?;
    for light in &guided.guide.vpls {
        let at = placed(guided, light.position_m, light.normal, ' ');
        writeln!(out, "{at} {:e} {}", light.flux_w, cell(light.cell))?;
    }
    Ok(())
}

/// Writes `probes.csv`.
///
/// # Errors
/// What the writer says.
pub fn write_probes(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    writeln!(out, "x_m,y_m,z_m,radius_m,cell,sh00_w_m2_sr,sh1m1_w_m2_sr,sh10_w_m2_sr,sh11_w_m2_sr")?;
    for probe in &guided.guide.probes {
        let [x, y, z] = guided.scene.to_user_m(probe.position_m).to_array();
        let [sh00, sh1m1, sh10, sh11] = probe.sh_w_m2_sr;
        let cell = cell(probe.cell);
        writeln!(out, "{x},{y},{z},{},{cell},{sh00:e},{sh1m1:e},{sh10:e},{sh11:e}", probe.radius_m)?;
    }
    Ok(())
}

/// Writes `cache.csv`.
///
/// # Errors
/// What the writer says.
pub fn write_cache(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    writeln!(out, "x_m,y_m,z_m,nx,ny,nz,reflected_w_m2,irradiance_w_m2,radius_m")?;
    for record in &guided.guide.cache {
        let at = placed(guided, record.position_m, record.normal, ',');
        writeln!(out, "{at},{:e},{:e},{}", record.reflected_w_m2, record.irradiance_w_m2, record.radius_m)?;
    }
    Ok(())
}

/// Writes `necks.ply`: a polygon a neck with what flows through it.
///
/// # Errors
/// What the writer says.
pub fn write_necks(out: &mut dyn Write, guided: &Guided) -> io::Result<()> {
    let necks = &guided.guide.necks;
    writeln!(out, "ply\nformat ascii 1.0")?;
    writeln!(
        out,
        "comment necks: positions in m, area in m2; forward is the flux from the first cell to the second, W"
    )?;
    writeln!(out, "element vertex {}", necks.iter().map(|neck| neck.outline_m.len()).sum::<usize>())?;
    writeln!(out, "property double x\nproperty double y\nproperty double z")?;
    writeln!(out, "element face {}", necks.len())?;
    writeln!(out, "property list uint uint vertex_indices\nproperty int first_cell\nproperty int second_cell")?;
    writeln!(out, "property float area\nproperty float forward\nproperty float back\nend_header")?;
    for &at_m in necks.iter().flat_map(|neck| &neck.outline_m) {
        let [x, y, z] = guided.scene.to_user_m(at_m).to_array();
        writeln!(out, "{x} {y} {z}")?;
    }
    let mut first = 0;
    for neck in necks {
        write!(out, "{}", neck.outline_m.len())?;
        (first..first + neck.outline_m.len()).try_for_each(|corner| write!(out, " {corner}"))?;
        first += neck.outline_m.len();
        let ([one, other], [forward, back]) = (neck.cells.map(cell), neck.flux_w);
        writeln!(out, " {one} {other} {} {forward:e} {back:e}", neck.area_m2)?;
    }
    Ok(())
}

/// A position and a normal.
fn placed(guided: &Guided, position_m: Vec3, normal: Vec3, between: char) -> String {
    let [x, y, z] = guided.scene.to_user_m(position_m).to_array();
    let [nx, ny, nz] = normal.to_array();
    format!("{x}{between}{y}{between}{z}{between}{nx}{between}{ny}{between}{nz}")
}
