//! What do the methods say where it is known to be hard?
//!
//! Every scene of [`scenes`] is modelled, path-traced at all its sensors, and asked. Across a tie the answers of
//! neighbouring sensors are held against each other besides: the truth is smooth there.

use super::asked::{Asked, not_modelled};
use super::scenes::{self, Built};
use super::{Failure, Row};
use crate::job::Cancelled;

/// Asks at the scenes of [`Trials::failures`](super::Trials::failures), with voxels of that size; rows in the scenes' order.
///
/// # Errors
/// [`Cancelled`] when the run was stopped.
pub fn stress_built_in(voxel_m: f32, asked: Asked) -> Result<Vec<Row>, Cancelled> {
    let mut rows = Vec::new();
    for built in scenes::all(voxel_m).iter().filter(|built| asked.trials.failures.contains(&built.failure)) {
        asked.progress.begin(built.failure.name(), 0);
        rows.extend(rows_of(built, voxel_m, asked)?);
        asked.progress.end();
    }
    Ok(rows)
}

fn rows_of(built: &Built, voxel_m: f32, asked: Asked) -> Result<Vec<Row>, Cancelled> {
    let Built { failure, case, scene, samples_times } = built;
    let names = asked.contestants.iter().map(|contestant| &contestant.name);
    let mut rows: Vec<Row> = names.map(|name| Row::new(scene, *failure, case, name)).collect();
    let model = match asked.model(scene, scene.model.voxel_m.unwrap_or(voxel_m)) {
        Ok(model) => model,
        Err(error) => return not_modelled(&mut rows, &error).map(|()| rows),
    };
    let samples = asked.trials.samples.saturating_mul(*samples_times);
    let truth = asked.traced(scene, &model, samples, usize::MAX)?;

    for (row, field) in rows.iter_mut().zip(asked.fields(scene, &model, asked.trials.seed)?) {
        row.add(&field, None, &truth);
        if *failure == Failure::Tie {
            row.moved.add_moves(&field.readings[1..], &field.readings);
        }
        row.warn(&model.voxels.warnings, &[]);
        row.warn(&field.warnings, &[]);
    }
    Ok(rows)
}
