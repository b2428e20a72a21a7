//! Daylight at sensors as CSV: a line a sensor, with units in the header's names.

use crate::daylight::Exposure;
use crate::scene::Scene;
use std::io::{self, Write};

/// Light for the eye at a sensor, beside its exposure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Mean illuminance over the lit hours, lux.
    pub lux: f64,
    /// Daylight factor, percent.
    pub daylight_factor: f64,
}

/// Writes `id,x_m,y_m,z_m,nx,ny,nz,beam_kwh_m2,sky_kwh_m2,reflected_kwh_m2,total_kwh_m2,error_kwh_m2,svf,sun_h,mean_lux,
/// daylight_factor_percent,status`; an empty normal means from all around.
///
/// # Errors
/// What the writer says.
pub fn write_csv(out: &mut dyn Write, scene: &Scene, exposures: &[Exposure], seen: &[Seen]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let position = ["id", "x_m", "y_m", "z_m", "nx", "ny", "nz"];
    let energies = ["beam_kwh_m2", "sky_kwh_m2", "reflected_kwh_m2", "total_kwh_m2", "error_kwh_m2"];
    let rest = ["svf", "sun_h", "mean_lux", "daylight_factor_percent", "status"];
    table.write_record(position.into_iter().chain(energies).chain(rest))?;
    for ((sensor, exposure), seen) in scene.sensors.iter().zip(exposures).zip(seen) {
        let position = scene.to_user_m(sensor.position_m).to_array().map(|metres| metres.to_string());
        let normal = sensor.normal.map(|normal| normal.to_array().map(|part| part.to_string())).unwrap_or_default();
        let numbers = [
            exposure.beam_kwh_m2,
            exposure.sky_kwh_m2,
            exposure.reflected_kwh_m2,
            exposure.total_kwh_m2(),
            exposure.error_kwh_m2,
            exposure.svf,
            exposure.sun_h,
            seen.lux,
            seen.daylight_factor,
        ];
        let numbers = numbers.map(|number| format!("{number:.6}"));
        let row = std::iter::once(sensor.id.clone()).chain(position).chain(normal).chain(numbers);
        table.write_record(row.chain([exposure.status.name().to_owned()]))?;
    }
    table.flush()
}
