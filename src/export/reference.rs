//! Rows of a reference file: what is taken for the truth at each sensor, as a scene file's `reference` reads it back.
//!
//! CSV with the header `id,irradiance,stderr,fx,fy,fz`; W/m2 throughout. Irradiance is scalar irradiance for sensors
//! without a normal; `fx,fy,fz` is the integral of L(w) w dw, w pointing away from the sensor.

use crate::light::Field;
use crate::scene::Sensor;
use std::io::{Error, Result, Write};

/// Writes one row a sensor that has an error estimate, after `#` lines that say how the rows were made (one for each line of
/// `origin`). Sensors without an error estimate cannot serve as a reference and are left out.
///
/// # Errors
/// Those of `out`.
pub fn write_reference(out: &mut dyn Write, origin: &str, sensors: &[Sensor], field: &Field) -> Result<()> {
    for line in origin.lines() {
        writeln!(out, "# {line}")?;
    }
    let mut rows = csv::Writer::from_writer(out);
    rows.write_record(["id", "irradiance", "stderr", "fx", "fy", "fz"]).map_err(Error::other)?;
    for (sensor, reading) in sensors.iter().zip(&field.readings) {
        let Some(stderr) = reading.error_w_m2 else { continue };
        let flux = reading.flux_w_m2;
        let numbers = [reading.value_w_m2, stderr, flux.x, flux.y, flux.z].map(|number| number.to_string());
        rows.write_record(std::iter::once(&sensor.id).chain(&numbers)).map_err(Error::other)?;
    }
    rows.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{Reading, Status};
    use glam::{DVec3, Vec3};

    #[test]
    fn rows_carry_the_reading_and_where_it_came_from() {
        let sensor = |id: &str| Sensor { id: id.into(), position_m: Vec3::ZERO, normal: None };
        let flux_w_m2 = DVec3::new(0.5, -0.25, 0.0);
        let ok = Reading { value_w_m2: 1.5, flux_w_m2, error_w_m2: Some(0.01), status: Status::Ok };
        let field = Field { readings: vec![ok, Reading::none(Status::InSolid)], warnings: Vec::new(), shares: None };
        let mut out = Vec::new();
        write_reference(&mut out, "by trace\nseed 1", &[sensor("a, b"), sensor("c")], &field)
            .expect("a vector takes all");
        let text = String::from_utf8(out).expect("text");
        assert_eq!(text, "# by trace\n# seed 1\nid,irradiance,stderr,fx,fy,fz\n\"a, b\",1.5,0.01,0.5,-0.25,0\n");
    }
}
