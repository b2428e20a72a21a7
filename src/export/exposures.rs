//! Exposure at sensors as CSV: a line a sensor, with units in the header's names.

use crate::daylight::Exposure;
use crate::scene::Scene;
use std::io::{self, Write};

/// Writes `id,x_m,y_m,z_m,nx,ny,nz,beam_kwh_m2,sky_kwh_m2,reflected_kwh_m2,total_kwh_m2,error_kwh_m2,svf,sun_h,status`; an
/// empty normal means from all around.
///
/// # Errors
/// What the writer says.
pub fn write_csv(out: &mut dyn Write, scene: &Scene, exposures: &[Exposure]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let position = ["id", "x_m", "y_m", "z_m", "nx", "ny", "nz"];
    let energies = ["beam_kwh_m2", "sky_kwh_m2", "reflected_kwh_m2", "total_kwh_m2", "error_kwh_m2"];
    table.write_record(position.into_iter().chain(energies).chain(["svf", "sun_h", "status"]))?;
    for (sensor, exposure) in scene.sensors.iter().zip(exposures) {
        let position = scene.to_user_m(sensor.position_m).to_array().map(|metres| metres.to_string());
        let normal = sensor.normal.map(|normal| normal.to_array().map(|part| part.to_string())).unwrap_or_default();
        let energies = [
            exposure.beam_kwh_m2,
            exposure.sky_kwh_m2,
            exposure.reflected_kwh_m2,
            exposure.total_kwh_m2(),
            exposure.error_kwh_m2,
        ];
        let energies = energies.map(|energy| format!("{energy:.6}"));
        let seen = [format!("{:.6}", exposure.svf), format!("{:.3}", exposure.sun_h)];
        let row = std::iter::once(sensor.id.clone()).chain(position).chain(normal).chain(energies).chain(seen);
        table.write_record(row.chain([exposure.status.name().to_owned()]))?;
    }
    table.flush()
}
