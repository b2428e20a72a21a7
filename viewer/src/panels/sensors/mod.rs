//! The table of sensors: estimate, reference and ratio of each, and what every method says.
//!
//! The order is kept from frame to frame and made again when the results or the sorted column change; only the rows that are seen
//! are drawn, so that 100,000 sensors cost what twenty do.

mod table;

pub use table::{Column, Direction, Table};

use super::number;
use crate::stamp::Stamp;
use crate::state::{Action, Picked, State};
use egui::{Align, Layout, RichText, Sense, Ui};
use egui_extras::TableBuilder;
use std::sync::Arc;

/// What is kept of the table from frame to frame.
#[derive(Clone)]
struct Kept {
    stamp: Stamp,
    sorted: (Column, Direction),
    order: Arc<Vec<u32>>,
}

/// Shows the table; a click on a heading sorts by it, one on a row picks its sensor.
pub fn show(ui: &mut Ui, state: &mut State) {
    let Some(table) = Table::of(&state.results).filter(|table| !table.is_empty()) else {
        return super::nothing(ui, state, "the scene has no sensors");
    };
    let key = ui.scope_id().with("sensors");
    let kept: Option<Kept> = ui.data(|data| data.get_temp(key));
    let mut sorted = kept.as_ref().map_or((Column::Number, Direction::Up), |kept| kept.sorted);
    let stamp = Stamp::of(&state.results);
    let still = kept.filter(|kept| kept.stamp.is(&stamp));

    tools(ui, state, &table);
    let columns = table.columns();
    let before = sorted;
    let order = match &still {
        Some(kept) => kept.order.clone(),
        None => Arc::new(table.order(sorted.0, sorted.1)),
    };
    grid(ui, state, &table, &columns, &order, &mut sorted);

    let order = if sorted == before { order } else { Arc::new(table.order(sorted.0, sorted.1)) };
    ui.data_mut(|data| data.insert_temp(key, Kept { stamp, sorted, order }));
}

fn tools(ui: &mut Ui, state: &mut State, table: &Table) {
    ui.horizontal_wrapped(|ui| {
        ui.label(format!("{} sensors", table.len()));
        if ui.button("Copy").on_hover_text("The table as text with tabs, for a spreadsheet").clicked() {
            ui.copy_text(table.text(b'\t'));
        }
        if ui.button("Save CSV").on_hover_text("The table as a file").clicked() {
            state.ask(Action::SaveTable);
        }
        if let Some(rms_factor) = state.results.estimate.as_ref().and_then(|estimate| estimate.errors.rms_factor) {
            ui.label(RichText::new(format!("off by a factor of {rms_factor:.2} (root mean square)")).weak());
        }
    });
}

fn grid(
    ui: &mut Ui,
    state: &mut State,
    table: &Table,
    columns: &[Column],
    order: &[u32],
    sorted: &mut (Column, Direction),
) {
    let height = ui.spacing().interact_size.y;
    let mut picked = None;
    egui::ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
        let widths = columns.iter().map(|column| match column {
            Column::Number => egui_extras::Column::initial(48.0).at_least(36.0).clip(true),
            Column::Id => egui_extras::Column::initial(110.0).at_least(50.0).clip(true),
            _ => egui_extras::Column::initial(92.0).at_least(50.0).clip(true),
        });
        let mut builder = TableBuilder::new(ui)
            .striped(true)
            .resizable(true)
            .sense(Sense::click())
            .auto_shrink(false)
            .min_scrolled_height(60.0)
            .cell_layout(Layout::left_to_right(Align::Center));
        for width in widths {
            builder = builder.column(width);
        }
        let header = builder.header(height, |mut header| {
            for column in columns {
                header.col(|ui| heading(ui, table, *column, sorted));
            }
        });
        header.body(|body| {
            body.rows(height, order.len(), |mut row| {
                let Some(sensor) = order.get(row.index()).map(|sensor| *sensor as usize) else { return };
                row.set_selected(state.picked == Some(Picked::Sensor(sensor)));
                for column in columns {
                    row.col(|ui| {
                        let text = table.cell(*column, sensor).shown(*column);
                        ui.add(egui::Label::new(text).selectable(false).truncate());
                    });
                }
                if row.response().clicked() {
                    picked = Some(sensor);
                }
            });
        });
    });
    if let Some(sensor) = picked {
        state.pick(Some(Picked::Sensor(sensor)));
    }
}

/// A heading that sorts, the sorted one marked by a sign.
fn heading(ui: &mut Ui, table: &Table, column: Column, sorted: &mut (Column, Direction)) {
    let mark = match sorted {
        (by, Direction::Up) if *by == column => " ⏶",
        (by, Direction::Down) if *by == column => " ⏷",
        _ => "",
    };
    let text = RichText::new(format!("{}{mark}", table.heading(column))).strong();
    let button = ui.add(egui::Button::new(text).frame(false).truncate());
    if button.on_hover_text(format!("Sort by {}", table.title(column))).clicked() {
        *sorted = match *sorted {
            (by, Direction::Up) if by == column => (column, Direction::Down),
            _ => (column, Direction::Up),
        };
    }
}

/// The table as CSV, with units in the header and positions in the user's coordinates; empty without sensors.
pub fn csv(state: &State) -> String {
    Table::of(&state.results).map(|table| table.text(b',')).unwrap_or_default()
}

impl table::Cell {
    /// As it stands on screen.
    fn shown(&self, column: Column) -> String {
        match self {
            Self::Text(text) if column == Column::Status => text.replace('_', " "),
            Self::Text(text) => text.clone(),
            Self::Number(value) if column == Column::Number => value.to_string(),
            Self::Number(value) => number(*value),
            Self::Missing => "-".to_owned(),
        }
    }
}
