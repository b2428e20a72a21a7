//! Exposure as files: tables of points, meshes with values at their vertices, pictures and arrays of what a camera sees.

pub mod mesh;
#[cfg(feature = "cli")]
pub mod picture;
pub mod view;

pub use crate::export::scale::Span;

use crate::daylight::{Exposure, Point, Quantity, points};
use crate::light::Status;
use crate::scene::Scene;
use std::io::{self, Write};

/// Share of the values that the colours of a picture have room for: a few noisy ones would darken all others.
const SHOWN_SHARE: f64 = 0.999;

/// Writes `id,x_m,y_m,z_m,nx,ny,nz,beam_kwh_m2,sky_kwh_m2,reflected_kwh_m2,total_kwh_m2,error_kwh_m2,svf,sun_h,status` of a
/// scene's sensors; an empty normal means from all around.
///
/// # Errors
/// What the writer says.
pub fn write_csv(out: &mut dyn Write, scene: &Scene, exposures: &[Exposure]) -> io::Result<()> {
    let ids = scene.sensors.iter().map(|sensor| sensor.id.clone());
    write_points_csv(out, scene, ids, &points(&scene.sensors), exposures)
}

/// The same of any points, each with a name of its own.
///
/// # Errors
/// What the writer says.
pub fn write_points_csv(
    out: &mut dyn Write,
    scene: &Scene,
    ids: impl Iterator<Item = String>,
    points: &[Point],
    exposures: &[Exposure],
) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let position = ["id", "x_m", "y_m", "z_m", "nx", "ny", "nz"];
    let energies = ["beam_kwh_m2", "sky_kwh_m2", "reflected_kwh_m2", "total_kwh_m2", "error_kwh_m2"];
    table.write_record(position.into_iter().chain(energies).chain(["svf", "sun_h", "status"]))?;
    for ((id, point), exposure) in ids.zip(points).zip(exposures) {
        let position = scene.to_user_m(point.position_m).to_array().map(|metres| metres.to_string());
        let normal = point.normal.map(|normal| normal.to_array().map(|part| part.to_string())).unwrap_or_default();
        let energies = [
            exposure.beam_kwh_m2,
            exposure.sky_kwh_m2,
            exposure.reflected_kwh_m2,
            exposure.total_kwh_m2(),
            exposure.error_kwh_m2,
        ];
        let energies = energies.map(|energy| format!("{energy:.6}"));
        let seen = [format!("{:.6}", exposure.svf), format!("{:.3}", exposure.sun_h)];
        let row = std::iter::once(id).chain(position).chain(normal).chain(energies).chain(seen);
        table.write_record(row.chain([exposure.status.name().to_owned()]))?;
    }
    table.flush()
}

/// Whether there is a value to show: a true zero is one, what lies inside matter has none.
pub fn has_value(exposure: &Exposure) -> bool {
    matches!(exposure.status, Status::Ok | Status::Dark)
}

/// What the colours of a picture span: all shares, or from 0 to what all but a few values reach.
pub fn span(quantity: Quantity, exposures: &[Exposure]) -> Span {
    if quantity == Quantity::Svf {
        return Span::SHARES;
    }
    let mut values: Vec<f64> =
        exposures.iter().filter(|exposure| has_value(exposure)).map(|exposure| quantity.of(exposure)).collect();
    values.sort_unstable_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    Span::up_to(values.get((SHOWN_SHARE * last as f64) as usize).copied().unwrap_or_default())
}
