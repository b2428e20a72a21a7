//! Which part of the year is added up, and under which air: a clear sky's or measured weather.

use super::{changed, site};
use crate::panels::outdoors::time::day_of_year;
use crate::panels::{named, row, rows};
use crate::state::{Action, State};
use egui::{DragValue, Slider, Ui};
use jiff::civil::Date;
use lightvein::sky::steps::Period;

/// Shows the period and the air, and changes them.
pub fn show(ui: &mut Ui, state: &mut State) {
    let now = site(state);
    rows(ui, "period", |ui| {
        let year = state.outdoors.date.year();
        let [mut first, mut last] =
            [(now.start, Period::YEAR.first), (now.end, Period::YEAR.last)].map(|(said, else_day)| {
                let (month, day) = said.map_or(else_day, |(month, day)| (month.cast_signed(), day.cast_signed()));
                Date::new(year, month, day).unwrap_or(state.outdoors.date)
            });
        row(ui, "First day", |ui| {
            let response = day_of_year(ui, &mut first);
            changed(state, &response, |site| site.start = Some(month_and_day(first)));
        });
        row(ui, "Last day", |ui| {
            let response = day_of_year(ui, &mut last);
            changed(state, &response, |site| site.end = Some(month_and_day(last)));
        });
        row(ui, "", |ui| {
            let year_round = ui.button("All year");
            changed(state, &year_round, |site| (site.start, site.end) = (None, None));
            let shown = Some(month_and_day(state.outdoors.date));
            let day = ui.button("The shown day");
            changed(state, &day, |site| (site.start, site.end) = (shown, shown));
        });
    });
    rows(ui, "air", |ui| {
        row(ui, "Weather", |ui| weather(ui, state));
        let decided = state.results.outdoors.sky.as_ref().map(|sky| sky.outdoors.haze);
        row(ui, "Turbidity", |ui| {
            let mut turbidity = now.turbidity.or(decided.map(|haze| haze.turbidity)).unwrap_or(3.0);
            let slider = Slider::new(&mut turbidity, 1.0..=10.0).max_decimals(1);
            let says = "Of a clear sky: 1 is clean air, 3 a usual clear day, 10 thick haze; weather has its own";
            let response = ui.add_enabled(now.weather.is_none(), slider).on_hover_text(says);
            changed(state, &response, |site| site.turbidity = Some(turbidity));
        });
        row(ui, "Ground albedo", |ui| {
            let mut albedo = now.ground_albedo.or(decided.map(|haze| haze.ground_albedo)).unwrap_or(0.2);
            let response = ui.add(Slider::new(&mut albedo, 0.0..=1.0).max_decimals(2));
            changed(state, &response, |site| site.ground_albedo = Some(albedo));
        });
        row(ui, "Step", |ui| {
            let mut step_min = now.step_min.unwrap_or(Period::YEAR.step_min);
            let drag = DragValue::new(&mut step_min).range(1.0..=1440.0).suffix(" min").max_decimals(0);
            let response = named(ui.add(drag), "Step");
            changed(state, &response, |site| site.step_min = Some(step_min));
        });
    });
}

/// The weather file: its name, another, none.
fn weather(ui: &mut Ui, state: &mut State) {
    let path = site(state).weather;
    let name = path.as_ref().map(|path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned());
    let label = ui.label(name.as_deref().unwrap_or("clear sky"));
    if let Some(path) = &path {
        label.on_hover_text(path.display().to_string());
    }
    if ui.button("Choose").on_hover_text("A weather file, .epw or .wea; or drop one on the window").clicked() {
        state.ask(Action::ChooseWeather);
    }
    if path.is_some() {
        let none = ui.button("None").on_hover_text("A clear sky instead");
        changed(state, &none, |site| site.weather = None);
    }
}

fn month_and_day(date: Date) -> (u8, u8) {
    (date.month().cast_unsigned(), date.day().cast_unsigned())
}
