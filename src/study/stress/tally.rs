//! By which factors do answers differ, and what became of the sensors?
//!
//! A factor is the greater of two values over the lesser, 1 where both are zero. A value that vanished has no finite factor:
//! it counts as infinite, and so do values that appear out of nothing.

use super::Failure;
use crate::light::{Field, Reading, Status};
use crate::scene::{Reference, Scene};
use crate::study::errors::is_good;
use serde::Serialize;

/// Factors between answers and what they are held against, one a sensor and trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spread {
    /// All of them, none below 1; infinite where one of the two is zero.
    pub factors: Vec<f64>,
    /// Angles between the directions where both have one, degrees.
    pub angles_deg: Vec<f64>,
    /// Answers of zero where there is light.
    pub lost: usize,
    /// Answers above zero where there is none.
    pub phantom: usize,
}

impl Spread {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.factors.len()
    }

    /// The factor that 95% do not exceed; `None` where there are none.
    pub fn p95(&self) -> Option<f64> {
        percentile(&self.factors, 0.95)
    }

    /// The greatest factor; `None` where there are none.
    pub fn max(&self) -> Option<f64> {
        percentile(&self.factors, 1.0)
    }

    /// `10^` the root mean square of the logarithms of the factors, as `rms_factor` elsewhere.
    pub fn rms(&self) -> Option<f64> {
        let mean_square = self.factors.iter().map(|factor| factor.log10().powi(2)).sum::<f64>() / self.count() as f64;
        (self.count() > 0).then(|| 10_f64.powf(mean_square.sqrt()))
    }

    /// The angle that 95% do not exceed, degrees; `None` where there are none.
    pub fn angle_p95_deg(&self) -> Option<f64> {
        percentile(&self.angles_deg, 0.95)
    }

    /// The greatest angle, degrees; `None` where there are none.
    pub fn angle_max_deg(&self) -> Option<f64> {
        percentile(&self.angles_deg, 1.0)
    }

    /// One more answer, and the value and net flux that it is held against.
    pub fn add(&mut self, reading: &Reading, value_w_m2: f64, flux_w_m2: glam::DVec3) {
        let answer_w_m2 = reading.value_w_m2;
        let [low, high] = [answer_w_m2.min(value_w_m2), answer_w_m2.max(value_w_m2)];
        self.factors.push(if high == 0.0 { 1.0 } else { high / low });
        self.lost += usize::from(answer_w_m2 == 0.0 && value_w_m2 > 0.0);
        self.phantom += usize::from(answer_w_m2 > 0.0 && value_w_m2 == 0.0);
        if reading.flux_w_m2.length() > 0.0 && flux_w_m2.length() > 0.0 {
            self.angles_deg.push(reading.flux_w_m2.angle_between(flux_w_m2).to_degrees());
        }
    }

    /// The factors between readings and those before, sensor by sensor.
    pub fn add_moves(&mut self, readings: &[Reading], before: &[Reading]) {
        readings.iter().zip(before).for_each(|(reading, was)| self.add(reading, was.value_w_m2, was.flux_w_m2));
    }

    /// The factors between readings and the truth, where it is good or a true zero.
    pub fn add_truth(&mut self, readings: &[Reading], truth: &[Option<Reference>]) {
        for (reading, known) in readings.iter().zip(truth) {
            if let Some(known) = known.filter(|known| is_good(known) || known.irradiance_w_m2 == 0.0) {
                self.add(reading, known.irradiance_w_m2, known.flux_w_m2);
            }
        }
    }
}

/// The value that this share of all do not exceed.
fn percentile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = (share * sorted.len() as f64).ceil() as usize;
    sorted.get(last.saturating_sub(1)).copied()
}

/// How many sensors have which status.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Statuses {
    /// [`Status::Ok`].
    pub ok: usize,
    /// [`Status::Dark`].
    pub dark: usize,
    /// [`Status::InSolid`].
    pub in_solid: usize,
    /// [`Status::Unreached`].
    pub unreached: usize,
    /// [`Status::Outside`].
    pub outside: usize,
}

impl Statuses {
    fn add(&mut self, readings: &[Reading]) {
        for reading in readings {
            *match reading.status {
                Status::Ok => &mut self.ok,
                Status::Dark => &mut self.dark,
                Status::InSolid => &mut self.in_solid,
                Status::Unreached => &mut self.unreached,
                Status::Outside => &mut self.outside,
            } += 1;
        }
    }

    /// Those that are not zero, in words: `12 ok, 3 dark`.
    pub fn in_words(&self) -> String {
        let Self { ok, dark, in_solid, unreached, outside } = *self;
        let counts =
            [(ok, "ok"), (dark, "dark"), (in_solid, "in_solid"), (unreached, "unreached"), (outside, "outside")];
        let words = counts.iter().filter(|(count, _)| *count > 0).map(|(count, name)| format!("{count} {name}"));
        words.collect::<Vec<_>>().join(", ")
    }
}

/// What one method did under one failure.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The scene's name.
    pub scene: String,
    /// The names of its sensors.
    pub sensors: Vec<String>,
    /// What was tried.
    pub failure: Failure,
    /// With which parameter: `noise of 0.5 voxel`.
    pub case: String,
    /// The method.
    pub method: String,
    /// The factors between disturbed and undisturbed answers.
    pub moved: Spread,
    /// The factors between disturbed answers and the truth.
    pub truth: Spread,
    /// What became of the sensors, over all trials.
    pub statuses: Statuses,
    /// Warnings that a user reads and that the undisturbed scene does not have, one of each kind.
    pub warnings: Vec<String>,
}

impl Row {
    /// A row without any answer yet.
    pub fn new(scene: &Scene, failure: Failure, case: &str, method: &str) -> Self {
        let [name, case, method] = [&scene.name, case, method].map(str::to_owned);
        Self {
            scene: name,
            sensors: scene.sensors.iter().map(|sensor| sensor.id.clone()).collect(),
            failure,
            case,
            method,
            moved: Spread::default(),
            truth: Spread::default(),
            statuses: Statuses::default(),
            warnings: Vec::new(),
        }
    }

    /// Where an answer moved the most: the sensor, and the number of the trial that was modelled, from 1. `None` where none
    /// moved.
    pub fn worst(&self) -> Option<(&str, usize)> {
        let most = self.moved.max().filter(|&most| most > 1.0)?;
        let number = self.moved.factors.iter().position(|&factor| factor == most)?;
        let sensor = self.sensors.get(number.checked_rem(self.sensors.len())?)?;
        Some((sensor, 1 + number / self.sensors.len()))
    }

    /// One more trial: a field, the readings before it, and the truth.
    pub fn add(&mut self, field: &Field, before: Option<&[Reading]>, truth: &[Option<Reference>]) {
        self.moved.add_moves(&field.readings, before.unwrap_or_default());
        self.truth.add_truth(&field.readings, truth);
        self.statuses.add(&field.readings);
    }

    /// Warnings of a trial, but for those of a kind that is in `known` or already here.
    pub fn warn<'a>(&mut self, warnings: impl IntoIterator<Item = &'a String>, known: &[String]) {
        for warning in warnings {
            let is_new = |other: &String| kind(other) != kind(warning);
            if known.iter().all(is_new) && self.warnings.iter().all(is_new) {
                self.warnings.push(warning.clone());
            }
        }
    }
}

/// A warning without its figures: what it is about.
fn kind(warning: &str) -> String {
    warning.chars().filter(|letter| letter.is_alphabetic() || *letter == ' ').collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn reading(value_w_m2: f64, direction: DVec3) -> Reading {
        let status = if value_w_m2 > 0.0 { Status::Ok } else { Status::Dark };
        Reading { value_w_m2, flux_w_m2: direction * value_w_m2, error_w_m2: None, status }
    }

    #[test]
    fn factors_count_either_way_and_zeros_are_not_silent() {
        let mut spread = Spread::default();
        spread.add_moves(
            &[reading(2.0, DVec3::X), reading(0.0, DVec3::X)],
            &[reading(4.0, DVec3::Y), reading(0.0, DVec3::X)],
        );
        assert_eq!((spread.max(), spread.lost, spread.phantom), (Some(2.0), 0, 0));
        assert!((spread.angle_p95_deg().unwrap() - 90.0).abs() < 1e-9);
        spread.add_moves(
            &[reading(0.0, DVec3::X), reading(1.0, DVec3::X)],
            &[reading(1.0, DVec3::X), reading(0.0, DVec3::X)],
        );
        assert_eq!((spread.max(), spread.lost, spread.phantom), (Some(f64::INFINITY), 1, 1));
        assert_eq!(Spread::default().p95(), None);
    }

    #[test]
    fn percentiles_are_values_that_occur() {
        let values: Vec<f64> = (1..=20).map(f64::from).collect();
        assert_eq!((percentile(&values, 0.95), percentile(&values, 1.0)), (Some(19.0), Some(20.0)));
        assert_eq!(percentile(&values[..1], 0.95), Some(1.0));
    }

    #[test]
    fn truths_that_are_not_known_count_nowhere() {
        let known =
            |irradiance_w_m2, stderr_w_m2| Some(Reference { irradiance_w_m2, stderr_w_m2, flux_w_m2: DVec3::X });
        let mut spread = Spread::default();
        let readings = [2.0, 3.0, 1.0, 5.0].map(|value| reading(value, DVec3::X));
        spread.add_truth(&readings, &[known(1.0, 0.01), known(1.0, 0.5), known(0.0, 0.0), None]);
        assert_eq!((spread.count(), spread.phantom), (2, 1));
    }

    #[test]
    fn the_worst_is_a_sensor_in_a_trial() {
        let sensor = |id: &str| crate::scene::Sensor { id: id.into(), position_m: glam::Vec3::ZERO, normal: None };
        let scene = Scene { sensors: vec![sensor("a"), sensor("b")], ..Scene::default() };
        let mut row = Row::new(&scene, Failure::Turn, "", "backward");
        assert_eq!(row.worst(), None);
        row.moved.factors = vec![1.0, 1.1, 1.2, 1.9, 1.0, 1.3];
        assert_eq!(row.worst(), Some(("b", 2)));
    }

    #[test]
    fn a_warning_is_said_once_whatever_its_figures() {
        let mut row = Row::new(&Scene::default(), Failure::Turn, "", "backward");
        let said =
            ["1 opening closes near 0.3".to_owned(), "2 opening closes near 0.5".to_owned(), "it leaks".to_owned()];
        row.warn(&said, &["it leaks".to_owned()]);
        assert_eq!(row.warnings, said[..1]);
    }
}
