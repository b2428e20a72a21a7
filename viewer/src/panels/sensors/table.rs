//! The table of sensors as plain data: columns, cells, order, text.

use crate::measure::Measure;
use crate::outdoors::SensorExposure;
use crate::results::{Answer, Estimate, Results};
use lightvein::daylight::Quantity;
use lightvein::light::{Reading, Status};
use lightvein::scene::Scene;
use std::cmp::Ordering;
use std::sync::Arc;

/// A column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// The sensor's number in the scene.
    Number,
    /// Its name.
    Id,
    /// Its position along an axis, in the user's coordinates; in files alone.
    Position(usize),
    /// The estimate.
    Value,
    /// The reference.
    Reference,
    /// Estimate over reference.
    Ratio,
    /// What the method of that number in the answers says.
    Answer(usize),
    /// What it receives of sun and sky over the period.
    Exposure(Quantity),
    /// What became of it.
    Status,
}

/// Which way a column is sorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// The least first.
    Up,
    /// The greatest first.
    Down,
}

/// What a cell holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// A name.
    Text(String),
    /// A number.
    Number(f64),
    /// Nothing.
    Missing,
}

/// What the table is made of; cheap to clone.
#[derive(Clone)]
pub struct Table {
    scene: Arc<Scene>,
    estimate: Option<Arc<Estimate>>,
    answers: Arc<Vec<Answer>>,
    exposed: Option<Arc<SensorExposure>>,
}

impl Table {
    /// The table of what was found; `None` before a scene is there.
    pub fn of(results: &Results) -> Option<Self> {
        let scene = results.scene.clone()?;
        let exposed = results.outdoors.sensors.clone();
        Some(Self { scene, estimate: results.estimate.clone(), answers: results.answers.clone(), exposed })
    }

    /// How many sensors there are.
    pub fn len(&self) -> usize {
        self.scene.sensors.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.scene.sensors.is_empty()
    }

    /// The columns on screen.
    pub fn columns(&self) -> Vec<Column> {
        let mut columns = vec![Column::Number, Column::Id, Column::Value];
        if !self.scene.reference.is_empty() {
            columns.extend([Column::Reference, Column::Ratio]);
        }
        columns.extend((0..self.answers.len()).map(Column::Answer));
        if self.exposed.is_some() {
            columns.extend([Quantity::Total, Quantity::Svf, Quantity::SunHours].map(Column::Exposure));
            // Where sun and sky alone were asked the rest would be empty.
            if self.estimate.is_none() {
                columns.retain(|column| !matches!(column, Column::Value | Column::Reference | Column::Ratio));
            }
        }
        columns.push(Column::Status);
        columns
    }

    /// The title of a column on screen.
    pub fn heading(&self, column: Column) -> String {
        match column {
            Column::Number => "No.".to_owned(),
            Column::Id => "Sensor".to_owned(),
            Column::Position(axis) => ["x", "y", "z"].get(axis).copied().unwrap_or_default().to_owned(),
            Column::Value => "W/m²".to_owned(),
            Column::Reference => "Reference".to_owned(),
            Column::Ratio => "Ratio".to_owned(),
            Column::Answer(answer) => self.answers.get(answer).map(Answer::label).unwrap_or_default(),
            // What it is of stands in the tip: columns are narrow.
            Column::Exposure(Quantity::SunHours) => "Sun, h".to_owned(),
            Column::Exposure(quantity) => {
                let measure = Measure::of(quantity);
                if measure.unit().is_empty() { measure.title() } else { measure.unit() }.to_owned()
            }
            Column::Status => "Status".to_owned(),
        }
    }

    /// What a column holds, in words.
    pub fn title(&self, column: Column) -> String {
        match column {
            Column::Number => "the number of the sensor".to_owned(),
            Column::Id => "the name of the sensor".to_owned(),
            Column::Position(_) => "position, m".to_owned(),
            Column::Value => match &self.estimate {
                Some(estimate) => format!("irradiance by {}, W/m²", estimate.method),
                None => "irradiance, W/m²".to_owned(),
            },
            Column::Reference => "the reference, W/m²".to_owned(),
            Column::Ratio => "estimate / reference".to_owned(),
            Column::Answer(_) => format!("irradiance by {}, W/m²", self.heading(column)),
            Column::Exposure(quantity) => format!("{} over the period", quantity.title()),
            Column::Status => "what became of the sensor".to_owned(),
        }
    }

    /// The name of a column in files, with its unit.
    fn header(&self, column: Column) -> String {
        match column {
            Column::Number => "number".to_owned(),
            Column::Id => "id".to_owned(),
            Column::Position(_) => format!("{}_m", self.heading(column)),
            Column::Value => "irradiance_w_m2".to_owned(),
            Column::Reference => "reference_w_m2".to_owned(),
            Column::Ratio => "ratio".to_owned(),
            Column::Answer(_) => format!("{}_w_m2", self.heading(column).replace(' ', "_")),
            Column::Exposure(quantity) => quantity.with_unit().to_owned(),
            Column::Status => "status".to_owned(),
        }
    }

    /// What stands in a column for a sensor.
    pub fn cell(&self, column: Column, sensor: usize) -> Cell {
        let number = |value: Option<f64>| value.map_or(Cell::Missing, Cell::Number);
        match column {
            Column::Number => Cell::Number(sensor as f64),
            Column::Id => self.scene.sensors.get(sensor).map_or(Cell::Missing, |sensor| Cell::Text(sensor.id.clone())),
            Column::Status => self.status(sensor).map_or(Cell::Missing, |status| Cell::Text(status.name().to_owned())),
            _ => number(self.value(column, sensor)),
        }
    }

    fn reading(&self, sensor: usize) -> Option<&Reading> {
        self.estimate.as_ref()?.at_sensors.readings.get(sensor)
    }

    /// What became of a sensor: by the estimate, else under sun and sky.
    fn status(&self, sensor: usize) -> Option<Status> {
        let exposed = || Some(self.exposed.as_ref()?.exposures.get(sensor)?.status);
        self.reading(sensor).map(|reading| reading.status).or_else(exposed)
    }

    /// The number in a column, where it has one.
    fn value(&self, column: Column, sensor: usize) -> Option<f64> {
        match column {
            Column::Number => Some(sensor as f64),
            Column::Id | Column::Status => None,
            Column::Position(axis) => {
                let at_m = self.scene.to_user_m(self.scene.sensors.get(sensor)?.position_m);
                at_m.to_array().get(axis).copied()
            }
            Column::Value => self.reading(sensor).and_then(value),
            Column::Reference => Some(self.scene.reference.get(sensor).copied().flatten()?.irradiance_w_m2),
            Column::Ratio => {
                let reference = self.value(Column::Reference, sensor).filter(|known| *known > 0.0)?;
                Some(self.reading(sensor).and_then(value)? / reference)
            }
            Column::Answer(answer) => self.answers.get(answer)?.at_sensors.get(sensor).and_then(value),
            Column::Exposure(quantity) => {
                let exposure = self.exposed.as_ref()?.exposures.get(sensor)?;
                matches!(exposure.status, Status::Ok | Status::Dark).then(|| quantity.of(exposure))
            }
        }
    }

    /// The numbers of the sensors, sorted by a column; missing ones last, equal ones in the scene's order.
    pub fn order(&self, column: Column, direction: Direction) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.len() as u32).collect();
        match column {
            Column::Id | Column::Status => {
                let text = |sensor: &u32| match column {
                    Column::Id => self.scene.sensors.get(*sensor as usize).map(|sensor| sensor.id.as_str()),
                    _ => self.status(*sensor as usize).map(Status::name),
                };
                order.sort_by(|a, b| directed(text(a).cmp(&text(b)), direction));
            }
            _ => {
                let values: Vec<Option<f64>> = (0..self.len()).map(|sensor| self.value(column, sensor)).collect();
                let value = |sensor: &u32| values.get(*sensor as usize).copied().flatten();
                order.sort_by(|a, b| match (value(a), value(b)) {
                    (Some(a), Some(b)) => directed(a.total_cmp(&b), direction),
                    (a, b) => b.is_some().cmp(&a.is_some()),
                });
            }
        }
        order
    }

    /// The whole table as text in the scene's order, with positions, its cells apart by `between`.
    pub fn text(&self, between: u8) -> String {
        let mut columns = self.columns();
        columns.splice(2..2, (0..3).map(Column::Position));
        let mut text = String::new();
        let mut line = |cells: &mut dyn Iterator<Item = String>| {
            for (number, cell) in cells.enumerate() {
                if number > 0 {
                    text.push(char::from(between));
                }
                text.push_str(&quoted(cell, between));
            }
            text.push('\n');
        };
        line(&mut columns.iter().map(|column| self.header(*column)));
        for sensor in 0..self.len() {
            line(&mut columns.iter().map(|column| match self.cell(*column, sensor) {
                Cell::Text(text) => text,
                Cell::Number(value) => value.to_string(),
                Cell::Missing => String::new(),
            }));
        }
        text
    }
}

/// A reading's value, where it has one.
fn value(reading: &Reading) -> Option<f64> {
    matches!(reading.status, Status::Ok | Status::Dark).then_some(reading.value_w_m2)
}

fn directed(order: Ordering, direction: Direction) -> Ordering {
    match direction {
        Direction::Up => order,
        Direction::Down => order.reverse(),
    }
}

/// A cell in quotes where it holds what would end it (RFC 4180).
fn quoted(cell: String, between: u8) -> String {
    let ends = |sign: char| sign == char::from(between) || matches!(sign, '"' | '\n' | '\r');
    if cell.contains(ends) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use lightvein::light::Field;
    use lightvein::scene::{Method, Reference, Sensor};

    fn table(values: &[Option<f64>]) -> Table {
        let sensors = values.iter().enumerate().map(|(number, _)| Sensor {
            id: [r#"the "first", left"#, "b", "a"][number % 3].to_owned(),
            position_m: Vec3::new(number as f32, 0.5, -1.0),
            normal: None,
        });
        let reference =
            values.iter().map(|_| Some(Reference { irradiance_w_m2: 2.0, stderr_w_m2: 0.0, flux_w_m2: DVec3::ZERO }));
        let scene = Scene {
            origin_m: DVec3::new(100.0, 0.0, 0.0),
            sensors: sensors.collect(),
            reference: reference.collect(),
            ..Scene::default()
        };
        let reading = |value: &Option<f64>| match value {
            Some(value_w_m2) => Reading { value_w_m2: *value_w_m2, ..Reading::none(Status::Ok) },
            None => Reading::none(Status::InSolid),
        };
        let readings: Vec<Reading> = values.iter().map(reading).collect();
        let errors = lightvein::study::errors::errors(&readings, &scene.reference);
        let at_sensors = Field { readings: readings.clone(), ..Field::default() };
        let (method, quality) = (Method::Network, "coarse".to_owned());
        let estimate = Estimate {
            method,
            quality: quality.clone(),
            at_nodes: Field::default(),
            at_sensors,
            through_edges_w: Vec::new(),
            errors,
            seconds: 0.0,
            is_first_pass: false,
        };
        let answer = Answer { method, quality, at_sensors: readings, at_nodes: Vec::new(), errors, seconds: 0.0 };
        Table {
            scene: Arc::new(scene),
            estimate: Some(Arc::new(estimate)),
            answers: Arc::new(vec![answer]),
            exposed: None,
        }
    }

    #[test]
    fn it_sorts_numbers_by_size_names_by_letters_and_what_is_missing_last() {
        let table = table(&[Some(3.0), None, Some(10.0), Some(0.5)]);
        assert_eq!(table.order(Column::Value, Direction::Up), [3, 0, 2, 1]);
        assert_eq!(table.order(Column::Ratio, Direction::Down), [2, 0, 3, 1]);
        assert_eq!(table.order(Column::Id, Direction::Up), [2, 1, 0, 3]);
        assert_eq!(table.order(Column::Number, Direction::Down), [3, 2, 1, 0]);
    }

    #[test]
    fn its_text_has_units_user_coordinates_and_quotes() {
        let text = table(&[Some(3.0), None]).text(b',');
        let header = "number,id,x_m,y_m,z_m,irradiance_w_m2,reference_w_m2,ratio,network_coarse_w_m2,status";
        let first = r#"0,"the ""first"", left",100,0.5,-1,3,2,1.5,3,ok"#;
        let second = "1,b,101,0.5,-1,,2,,,in_solid";
        assert_eq!(text, format!("{header}\n{first}\n{second}\n"));
    }

    #[test]
    fn tabs_need_no_quotes_around_commas() {
        assert_eq!(quoted("a,b".to_owned(), b'\t'), "a,b");
        assert_eq!(quoted("a\tb".to_owned(), b'\t'), "\"a\tb\"");
    }
}
