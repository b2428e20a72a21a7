//! The shown moment: day, time, play, and the sun then. Results are of a period and do not depend on it.

use crate::panels::{named, row, rows, told};
use crate::state::State;
use egui::{Button, DragValue, Response, Slider, Ui};
use jiff::civil::{Date, Time};

/// How fast the shown time may run, hours a second: from one that the eye can follow to a day in a second.
const HOURS_A_SECOND: std::ops::RangeInclusive<f64> = 0.05..=24.0;

/// Shows the moment, and changes it.
pub fn show(ui: &mut Ui, state: &mut State) {
    let shown = &mut state.outdoors;
    rows(ui, "moment", |ui| {
        row(ui, "Date", |ui| day_of_year(ui, &mut shown.date));
        row(ui, "Time", |ui| {
            let slider = Slider::new(&mut shown.time_h, 0.0..=24.0).step_by(1.0 / 60.0);
            ui.add(slider.custom_formatter(|hours, _| clock(hours)).custom_parser(hours));
        });
        row(ui, "Speed", |ui| {
            let drag = DragValue::new(&mut shown.hours_a_second).range(HOURS_A_SECOND).speed(0.02);
            named(ui.add(drag.max_decimals(2).suffix(" h/s")), "Speed");
        });
    });
    ui.horizontal(|ui| {
        let name = if shown.is_playing { "Stop" } else { "Play" };
        let play = ui.add_sized([52.0, ui.spacing().interact_size.y], Button::new(name));
        if play.on_hover_text("Lets the shown time run (Space)").clicked() {
            shown.is_playing = !shown.is_playing;
            // What is played is to be seen.
            state.layers.sun_path |= shown.is_playing;
        }
        ui.checkbox(&mut shown.runs_on, "on to the next day");
        ui.checkbox(&mut state.layers.sun_path, "Dome");
    });
    let (Some(day), Some(now)) = (&shown.day, &shown.now) else { return };
    ui.add_space(2.0);
    ui.label(day.words());
    rows(ui, "sun", |ui| {
        let [azimuth_deg, elevation_deg] = [now.sun.azimuth_rad, now.sun.elevation_rad].map(f64::to_degrees);
        told(ui, "Azimuth", format!("{azimuth_deg:.1}° from north"));
        told(ui, "Elevation", format!("{elevation_deg:.1}°"));
        told(ui, "Highest", day.events.transit().strftime("%H:%M").to_string());
    });
}

/// A slider over the days of a date's year.
pub fn day_of_year(ui: &mut Ui, date: &mut Date) -> Response {
    let year = date.year();
    let mut number = date.day_of_year();
    let name = move |number: f64, _: std::ops::RangeInclusive<usize>| {
        on_day(year, number as i16).map_or_else(String::new, |date| date.strftime("%-d %b").to_string())
    };
    let parse = move |text: &str| Some(f64::from(day_named(text, year)?.day_of_year()));
    let slider = Slider::new(&mut number, 1..=date.days_in_year()).custom_formatter(name).custom_parser(parse);
    let response = ui.add(slider);
    *date = on_day(year, number).unwrap_or(*date);
    response
}

fn on_day(year: i16, number: i16) -> Option<Date> {
    Date::new(year, 1, 1).ok()?.with().day_of_year(number).build().ok()
}

/// A day as it is typed: 21 Jun, or 06-21.
fn day_named(text: &str, year: i16) -> Option<Date> {
    let text = text.trim();
    let by_name = Date::strptime("%d %b %Y", format!("{text} {year}"));
    by_name.or_else(|_| Date::strptime("%m-%d %Y", format!("{text} {year}"))).ok()
}

/// Hours since midnight as a clock has them.
fn clock(hours: f64) -> String {
    let minutes = (hours * 60.0).round() as u32;
    format!("{:02}:{:02}", minutes / 60, minutes % 60)
}

fn hours(text: &str) -> Option<f64> {
    let text = text.trim();
    let time = Time::strptime("%H:%M", text).or_else(|_| Time::strptime("%H", text)).ok()?;
    Some(f64::from(time.hour()) + f64::from(time.minute()) / 60.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jiff::civil::date;

    #[test]
    fn days_and_times_are_read_as_they_are_written() {
        assert_eq!(day_named("21 Jun", 2025), Some(date(2025, 6, 21)));
        assert_eq!(day_named("06-21", 2025), Some(date(2025, 6, 21)));
        assert_eq!(day_named("29 Feb", 2025), None);
        assert_eq!(day_named("29 Feb", 2024), Some(date(2024, 2, 29)));
        assert_eq!(on_day(2025, 365), Some(date(2025, 12, 31)));
        assert_eq!(clock(13.5), "13:30");
        assert_eq!((hours("13:30"), hours(" 7"), hours("25:00")), (Some(13.5), Some(7.0), None));
    }
}
