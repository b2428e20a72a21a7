//! A field at sensors as CSV: a line a sensor, with units in the header's names.

use crate::light::Field;
use crate::scene::Scene;
use std::io::{self, Write};

/// Writes `id,x_m,y_m,z_m,nx,ny,nz,irradiance_w_m2,error_w_m2,dx,dy,dz,status`; an empty normal means scalar irradiance,
/// an empty error that the method has none.
///
/// # Errors
/// What the writer says.
pub fn write_csv(out: &mut dyn Write, scene: &Scene, field: &Field) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "id",
        "x_m",
        "y_m",
        "z_m",
        "nx",
        "ny",
        "nz",
        "irradiance_w_m2",
        "error_w_m2",
        "dx",
        "dy",
        "dz",
        "status",
    ])?;
    for (sensor, reading) in scene.sensors.iter().zip(&field.readings) {
        let position = scene.to_user_m(sensor.position_m).to_array().map(|metres| metres.to_string());
        let normal = sensor.normal.map(|normal| normal.to_array().map(|part| part.to_string())).unwrap_or_default();
        let direction = reading.direction().to_array().map(|part| part.to_string());
        let value = format!("{:e}", reading.value_w_m2);
        let error = reading.error_w_m2.map(|error| format!("{error:e}")).unwrap_or_default();
        let status = reading.status.name().to_owned();
        let row = [
            vec![sensor.id.clone()],
            position.into(),
            normal.into(),
            vec![value, error],
            direction.into(),
            vec![status],
        ];
        table.write_record(row.concat())?;
    }
    table.flush()
}
