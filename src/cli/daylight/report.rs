//! What `daylight` tells: the JSON object, the rows, the table.

use super::super::table::Table;
use crate::daylight::Exposure;
use crate::daylight::reflect::Reflected;
use crate::export::daylight::Seen;
use crate::scene::Scene;
use crate::sky::efficacy::Efficacies;
use serde::Serialize;

/// The JSON object.
#[derive(Serialize)]
pub struct Report<'a> {
    pub scene: &'a str,
    pub method: &'static str,
    pub moment: Option<String>,
    pub voxel_m: Option<f32>,
    pub prepare_seconds: f64,
    pub seconds: f64,
    pub ghi: f64,
    pub dni: f64,
    pub dhi: f64,
    pub lit_h: f64,
    pub beam_lm_w: f64,
    pub sky_lm_w: f64,
    pub sensors: Vec<Row<'a>>,
    pub modelled: &'a [Modelled],
    pub notes: &'a [String],
    pub warnings: &'a [String],
}

/// Rays or a network that were tried for the tolerance: the last of each kind was taken.
#[derive(Serialize)]
pub struct Modelled {
    /// Which.
    pub what: String,
    /// How far off it is, a share of the mean: of rays the RMSE against many, of a network its own error.
    pub error: f64,
}

/// A sensor of it: kWh/m2, hours of sun, lux and percent.
#[derive(Serialize)]
pub struct Row<'a> {
    id: &'a str,
    beam: f64,
    sky: f64,
    reflected: f64,
    total: f64,
    error: f64,
    reflected_error: f64,
    svf: f64,
    sun_h: f64,
    lux: f64,
    daylight_factor: f64,
    status: &'static str,
}

/// What was found at the sensors.
pub struct Found<'a> {
    /// All light.
    pub exposures: &'a [Exposure],
    /// The part that was reflected.
    pub reflected: &'a [Reflected],
    /// Of the period.
    pub efficacies: Efficacies,
    /// Hours of the period with light.
    pub lit_h: f64,
}

impl Found<'_> {
    /// Light for the eye at each sensor.
    pub fn seen(&self) -> Vec<Seen> {
        let Efficacies { beam_lm_w, sky_lm_w } = self.efficacies;
        let seen = |(exposure, reflected): (&Exposure, &Reflected)| {
            let of_beam = beam_lm_w * (exposure.beam_kwh_m2 + reflected.of_beam_kwh_m2);
            let of_sky = sky_lm_w * (exposure.sky_kwh_m2 + reflected.of_sky_kwh_m2);
            let lux = if self.lit_h > 0.0 { 1000.0 * (of_beam + of_sky) / self.lit_h } else { 0.0 };
            Seen { lux, daylight_factor: 100.0 * reflected.daylight_factor }
        };
        self.exposures.iter().zip(self.reflected).map(seen).collect()
    }

    /// A row a sensor.
    pub fn rows<'a>(&self, scene: &'a Scene) -> Vec<Row<'a>> {
        let found = self.exposures.iter().zip(self.reflected).zip(self.seen());
        let row = |(sensor, ((exposure, reflected), seen)): (&'a crate::scene::Sensor, _)| {
            let (exposure, reflected, seen): (&Exposure, &Reflected, Seen) = (exposure, reflected, seen);
            Row {
                id: &sensor.id,
                beam: exposure.beam_kwh_m2,
                sky: exposure.sky_kwh_m2,
                reflected: exposure.reflected_kwh_m2,
                total: exposure.total_kwh_m2(),
                error: exposure.error_kwh_m2,
                reflected_error: reflected.error_kwh_m2,
                svf: exposure.svf,
                sun_h: exposure.sun_h,
                lux: seen.lux,
                daylight_factor: seen.daylight_factor,
                status: exposure.status.name(),
            }
        };
        scene.sensors.iter().zip(found).map(row).collect()
    }
}

/// The report for a reader.
pub fn text(report: &Report) -> String {
    let head = ["sensor", "beam", "sky", "reflected", "total", "+-", "svf", "sun, h", "lux", "factor, %", "status"];
    let mut table = Table::new(head);
    // Of a moment there are hundreds of watts, not hundreds of kilowatt-hours.
    let figures = if report.moment.is_some() { 3 } else { 1 };
    for row in &report.sensors {
        let energies = [row.beam, row.sky, row.reflected, row.total, row.error];
        let energies = energies.map(|energy| format!("{energy:.figures$}"));
        let seen = [format!("{:.3}", row.svf), format!("{:.0}", row.sun_h)];
        let light = [format!("{:.0}", row.lux), format!("{:.2}", row.daylight_factor), row.status.to_owned()];
        table.row(std::iter::once(row.id.to_owned()).chain(energies).chain(seen).chain(light).collect());
    }
    let period = report.moment.as_ref().map_or_else(
        || String::from("kWh/m2 over the period"),
        |moment| format!("kW/m2 at {}", moment.replace('T', " ")),
    );
    let tried = report.modelled.iter().map(|tried| format!("tried {}: {:.1}% off\n", tried.what, 100.0 * tried.error));
    let tried: String = tried.collect();
    format!(
        "{}: {period}; global horizontal {:.figures$}, direct normal {:.figures$}, diffuse horizontal {:.figures$}\n\
         by rays and {}: prepared in {:.2} s, estimated in {:.2} s\n\
         lux: the mean of {:.0} lit hour(s), {:.0} lm/W of the beam and {:.0} of the sky; factor: under an overcast sky\n\
         {tried}\n{table}",
        report.scene,
        report.ghi,
        report.dni,
        report.dhi,
        report.method,
        report.prepare_seconds,
        report.seconds,
        report.lit_h,
        report.beam_lm_w,
        report.sky_lm_w,
    )
}
