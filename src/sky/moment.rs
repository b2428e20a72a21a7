//! What do sun and sky bring at a moment?
//!
//! The step of its day that holds the moment, with the sun where it is seen then, standing for an hour: energies in kWh/m2 are
//! powers in kW/m2. Without weather the step is of four minutes; with weather it is the weather's own, mostly the mean of an
//! hour, on the same day of the weather's year.

use super::site::Outdoors;
use super::steps::{Period, Step, Steps};
use super::sun::{Air, SunError, position};
use crate::job::Cancel;
use jiff::civil::DateTime;

/// Length of a clear sky's step, minutes.
const CLEAR_STEP_MIN: f64 = 4.0;

/// Length of a step of weather, minutes; shorter where the weather's rows are.
const WEATHER_STEP_MIN: f64 = 60.0;

/// The step of a moment, local standard time; none with the sun down and no light measured.
///
/// # Errors
/// A place or a year beyond what the sun's position is known for, or [`SunError::Cancelled`].
pub fn steps_at(outdoors: &Outdoors, moment: DateTime, cancel: &Cancel) -> Result<Steps, SunError> {
    let step_min = if outdoors.weather.is_some() { WEATHER_STEP_MIN } else { CLEAR_STEP_MIN };
    let day = Outdoors { period: Period::day(moment.date(), step_min), year: moment.year(), ..outdoors.clone() };
    let steps = day.steps_unless(cancel)?;
    let hours = |time: DateTime| {
        let time = time.time();
        f64::from(time.hour()) + f64::from(time.minute()) / 60.0 + f64::from(time.second()) / 3600.0
    };
    let off_h = |step: &Step| (hours(step.time) - hours(moment)).abs();
    let near = steps.steps.iter().min_by(|a, b| off_h(a).total_cmp(&off_h(b)));
    // Half a second more, for times of steps are whole seconds.
    let holds = near.filter(|step| off_h(step) <= step.hours / 2.0 + 1e-3);
    let at = holds.map(|step| -> Result<Step, SunError> {
        let mut sun = position(&outdoors.place, step.time.date().to_datetime(moment.time()), Some(Air::STANDARD))?;
        sun.elevation_rad = sun.elevation_rad.max(0.0);
        Ok(Step { hours: 1.0, sun, ..*step })
    });
    let at = at.transpose()?;
    Ok(Steps { steps: at.into_iter().collect(), warnings: steps.warnings, ..Steps::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Site;
    use jiff::civil::date;

    fn outdoors() -> Outdoors {
        let site =
            Site { latitude_deg: Some(42.0), longitude_deg: Some(0.0), utc_offset_h: Some(0.0), ..Site::default() };
        Outdoors::of(&site, None).unwrap()
    }

    #[test]
    fn noon_of_the_solstice_is_bright_and_midnight_has_no_step() {
        let at =
            |hour, minute| steps_at(&outdoors(), date(2025, 6, 21).at(hour, minute, 0, 0), &Cancel::new()).unwrap();
        let noon = at(12, 2);
        assert_eq!(noon.steps.len(), 1);
        let step = noon.steps[0];
        // 90 - 42 + 23.44 degrees.
        assert!((step.sun.elevation_rad.to_degrees() - 71.44).abs() < 0.05, "{step:?}");
        assert!(step.hours == 1.0 && (700.0..1000.0).contains(&step.dni_w_m2), "{step:?}");
        assert!(at(0, 0).steps.is_empty() && at(23, 59).steps.is_empty());
        let early = at(5, 0).steps[0];
        assert!(early.dni_w_m2 < step.dni_w_m2 && early.sun.elevation_rad < step.sun.elevation_rad);
    }
}
