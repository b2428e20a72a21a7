//! What `expose` tells: each sensor, or what many points add up to.

use super::args::At;
use super::places::Places;
use crate::cli::table::Table;
use crate::daylight::choose::{Chosen, Tried};
use crate::daylight::{Exposure, Quantity};
use crate::export::exposures::has_value;
use crate::light::Status;
use crate::scene::Scene;
use crate::sky::map::ExposureMap;
use serde::Serialize;
use std::collections::BTreeMap;

/// The JSON object.
#[derive(Serialize)]
pub struct Report<'a> {
    scene: &'a str,
    seconds: f64,
    method: &'static str,
    /// All that the method is, in words.
    way: String,
    /// What was tried for the tolerance.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    tried: Vec<Trial>,
    ghi: f64,
    dni: f64,
    dhi: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<&'static str>,
    #[serde(flatten)]
    found: Found<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    update: Option<Update<'a>>,
    warnings: &'a [String],
}

/// A way that was tried.
#[derive(Serialize)]
struct Trial {
    method: &'static str,
    way: String,
    /// RMSE against many rays at some of the points, a share of their mean.
    error: f64,
}

/// The result after edits.
#[derive(Serialize)]
pub struct Update<'a> {
    /// What was done, as it was typed.
    pub edits: Vec<String>,
    /// How many parts it concerned, and how many triangles they have.
    pub parts: usize,
    pub triangles: usize,
    /// How many points there are, and how many were asked again.
    pub count: usize,
    pub again: usize,
    /// How long this took, and how long the first result, the map of the sky taken out.
    pub seconds: f64,
    pub full_seconds: f64,
    /// What was found.
    #[serde(flatten)]
    pub found: Found<'a>,
}

/// One row a sensor; of other places a summary.
#[derive(Serialize)]
pub struct Found<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    sensors: Option<Vec<Row<'a>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    points: Option<Summary>,
}

/// A sensor: kWh/m2, and hours of sun.
#[derive(Serialize)]
struct Row<'a> {
    id: &'a str,
    beam: f64,
    sky: f64,
    reflected: f64,
    total: f64,
    error: f64,
    svf: f64,
    sun_h: f64,
    status: &'static str,
}

impl<'a> Row<'a> {
    fn new(id: &'a str, exposure: &Exposure) -> Self {
        Self {
            id,
            beam: exposure.beam_kwh_m2,
            sky: exposure.sky_kwh_m2,
            reflected: exposure.reflected_kwh_m2,
            total: exposure.total_kwh_m2(),
            error: exposure.error_kwh_m2,
            svf: exposure.svf,
            sun_h: exposure.sun_h,
            status: exposure.status.name(),
        }
    }
}

/// What many points add up to.
#[derive(Serialize)]
struct Summary {
    places: String,
    count: usize,
    in_solid: usize,
    /// Root of the mean squared standard error of a point, kWh/m2.
    error: f64,
    values: BTreeMap<&'static str, Spread>,
    files: Vec<String>,
}

/// How a value is spread over the points, each by its share.
#[derive(Serialize, Default, Clone, Copy)]
struct Spread {
    mean: f64,
    min: f64,
    p5: f64,
    p25: f64,
    p50: f64,
    p75: f64,
    p95: f64,
    max: f64,
}

impl Spread {
    fn of(values: &mut [(f64, f64)]) -> Self {
        values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let all: f64 = values.iter().map(|(_, weight)| weight).sum();
        let (Some(&(min, _)), Some(&(max, _))) = (values.first(), values.last()) else { return Self::default() };
        let quantile = |part: f64| {
            let mut below = 0.0;
            let reaches = |&&(_, weight): &&(f64, f64)| {
                below += weight;
                below >= part * all
            };
            values.iter().find(reaches).map_or(max, |&(value, _)| value)
        };
        let mean = values.iter().map(|(value, weight)| value * weight).sum::<f64>() / all;
        let [p5, p25, p50, p75, p95] = [0.05, 0.25, 0.5, 0.75, 0.95].map(quantile);
        Self { mean, min, p5, p25, p50, p75, p95, max }
    }
}

impl<'a> Found<'a> {
    /// What was found at places, and the files it was written to.
    pub fn new(scene: &'a Scene, at: At, places: &Places, found: &[Exposure], files: &[String]) -> Self {
        if at == At::Sensors {
            let rows = scene.sensors.iter().zip(found).map(|(sensor, found)| Row::new(&sensor.id, found)).collect();
            return Self { sensors: Some(rows), points: None };
        }
        let valued = || found.iter().zip(places.weights()).filter(|(exposure, _)| has_value(exposure));
        let spread = |quantity: Quantity| {
            let mut values: Vec<(f64, f64)> =
                valued().map(|(exposure, share)| (quantity.of(exposure), share)).collect();
            (quantity.name(), Spread::of(&mut values))
        };
        let squares: f64 = valued().map(|(exposure, _)| exposure.error_kwh_m2.powi(2)).sum();
        let summary = Summary {
            places: places.words(),
            count: found.len(),
            in_solid: found.iter().filter(|exposure| exposure.status == Status::InSolid).count(),
            error: (squares / valued().count().max(1) as f64).sqrt(),
            values: Quantity::ALL.map(spread).into(),
            files: files.to_vec(),
        };
        Self { sensors: None, points: Some(summary) }
    }

    /// For a reader.
    fn text(&self) -> String {
        if let Some(summary) = &self.points {
            return summary.text();
        }
        let mut table = Table::new(["sensor", "beam", "sky", "total", "+-", "svf", "sun, h", "status"]);
        for row in self.sensors.iter().flatten() {
            let energies = [row.beam, row.sky, row.total, row.error].map(|energy| format!("{energy:.1}"));
            let seen = [format!("{:.3}", row.svf), format!("{:.0}", row.sun_h), row.status.to_owned()];
            table.row(std::iter::once(row.id.to_owned()).chain(energies).chain(seen).collect());
        }
        table.to_string()
    }
}

impl Trial {
    fn new(tried: &Tried) -> Self {
        Self { method: tried.way.name(), way: tried.way.words(), error: tried.error }
    }

    fn text(&self) -> String {
        format!("tried {}: {:.1}% off\n", self.way, 100.0 * self.error)
    }
}

impl Update<'_> {
    fn text(&self) -> String {
        format!(
            "\nafter {}: {} parts, {} triangles; {} of {} points asked again\n\
             in {:.3} s, where all of it takes {:.3} s\n\n{}",
            self.edits.join(", "),
            self.parts,
            self.triangles,
            self.again,
            self.count,
            self.seconds,
            self.full_seconds,
            self.found.text()
        )
    }
}

impl Summary {
    fn text(&self) -> String {
        let mut table = Table::new(["", "mean", "min", "5%", "25%", "50%", "75%", "95%", "max"]);
        for quantity in Quantity::ALL {
            let Some(spread) = self.values.get(quantity.name()) else { continue };
            let Spread { mean, min, p5, p25, p50, p75, p95, max } = *spread;
            let places = if quantity == Quantity::Svf { 3 } else { 1 };
            let values = [mean, min, p5, p25, p50, p75, p95, max].map(|value| format!("{value:.places$}"));
            table.row(std::iter::once(quantity.name().to_owned()).chain(values).collect());
        }
        let mean = self.values.get(Quantity::Total.name()).map_or(0.0, |total| total.mean);
        let share = if mean > 0.0 { format!(", {:.1}% of the mean", 100.0 * self.error / mean) } else { String::new() };
        let within = if self.in_solid > 0 { format!("; {} lie inside matter", self.in_solid) } else { String::new() };
        // Views and isotropic factors have no error of their own.
        let error = match self.error > 0.0 {
            true => format!("standard error of a point {:.1} kWh/m2{share}\n", self.error),
            false => String::new(),
        };
        format!("{}{within}\n{error}\n{table}", self.places)
    }
}

impl<'a> Report<'a> {
    /// The report of a run.
    pub fn new(
        scene: &'a Scene,
        at: At,
        map: &ExposureMap,
        seconds: f64,
        chosen: &Chosen,
        found: Found<'a>,
        warnings: &'a [String],
    ) -> Self {
        Self {
            scene: &scene.name,
            seconds,
            method: chosen.way.way.name(),
            way: chosen.way.way.words(),
            tried: chosen.tried.iter().map(Trial::new).collect(),
            ghi: map.totals.ghi_kwh_m2,
            dni: map.totals.dni_kwh_m2,
            dhi: map.totals.dhi_kwh_m2,
            at: (at != At::Sensors).then(|| at.name()),
            found,
            update: None,
            warnings,
        }
    }

    /// The same with what became of it by edits.
    pub fn with(self, update: Option<Update<'a>>) -> Self {
        Self { update, ..self }
    }

    /// The report for a reader.
    pub fn text(&self) -> String {
        let tried: String = self.tried.iter().map(Trial::text).collect();
        let update = self.update.as_ref().map_or_else(String::new, Update::text);
        format!(
            "{}: kWh/m2 over the period; global horizontal {:.0}, direct normal {:.0}, diffuse horizontal {:.0}\n\
             by {} in {:.2} s; what surfaces reflect is not in it\n{tried}\n{}{update}",
            self.scene,
            self.ghi,
            self.dni,
            self.dhi,
            self.way,
            self.seconds,
            self.found.text()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_count_by_share() {
        let spread = Spread::of(&mut [(3.0, 1.0), (1.0, 8.0), (2.0, 1.0)]);
        assert_eq!((spread.min, spread.p50, spread.p75, spread.p95, spread.max), (1.0, 1.0, 1.0, 3.0, 3.0));
        assert!((spread.mean - 1.3).abs() < 1e-12);
        assert_eq!(Spread::of(&mut []).mean, 0.0);
    }
}
