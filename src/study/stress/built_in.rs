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
    let Built { failure, case, scene, samples_times, is_shut } = built;
    let names = asked.contestants.iter().map(|contestant| &contestant.name);
    let mut rows: Vec<Row> = names.map(|name| Row::new(scene, *failure, case, name)).collect();
    let model = match asked.model(scene, scene.model.voxel_m.unwrap_or(voxel_m)) {
        Ok(model) => model,
        Err(error) => return not_modelled(&mut rows, &error).map(|()| rows),
    };
    let samples = asked.trials.samples.saturating_mul(*samples_times);
    let truth = asked.traced(scene, &model, samples, usize::MAX, *is_shut)?;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use crate::scene::Method;
    use crate::study::compare::Contestant;
    use crate::study::stress::Trials;

    /// The rows of a failure by the two heuristics, which take no time, beside a truth of a few paths.
    fn rows(failure: Failure) -> Vec<Row> {
        let trials = Trials { failures: vec![failure], samples: 8, ..Trials::default() };
        let contestants = [Method::Backward, Method::Forward].map(Contestant::built_in);
        let asked = Asked { contestants: &contestants, trials: &trials, progress: &Quiet, cancel: &Cancel::new() };
        stress_built_in(0.1, asked).unwrap()
    }

    /// A user sees a status or a warning wherever the case is beyond the method.
    #[track_caller]
    fn check(failure: Failure, want: &[(&str, &str, &str)]) {
        let rows = rows(failure);
        assert_eq!(rows.len(), 2 * want.len(), "{failure}: a row a method and case");
        for (pair, (case, statuses, warning)) in rows.chunks(2).zip(want) {
            for row in pair {
                assert!(row.case.contains(case), "{} is not {case}", row.case);
                assert!(row.statuses.in_words().starts_with(statuses), "{failure} {case}: {:?}", row.statuses);
                let said = row.warnings.join("; ");
                assert!(said.contains(warning), "{failure} {case}: {said:?} should say {warning:?}");
                assert_eq!(row.truth.phantom, 0, "{failure} {case} {}: light where there is none", row.method);
            }
        }
    }

    #[test]
    fn light_does_not_bleed_through_thin_walls() {
        let shut = ("shut", "4 unreached", "no light reaches");
        let door = ("door", "3 ok", "");
        check(Failure::ThinWall, &[shut, shut, door, ("door", "", "")]);
    }

    #[test]
    fn no_method_sees_light_through_matter() {
        let failures = [Failure::ThinWall, Failure::InSolid, Failure::SeparateVoids];
        let trials = Trials { failures: failures.into(), samples: 8, ..Trials::default() };
        let methods = Method::ALL.into_iter().filter(|&method| method != Method::Trace);
        let contestants: Vec<Contestant> = methods.map(Contestant::built_in).collect();
        let asked = Asked { contestants: &contestants, trials: &trials, progress: &Quiet, cancel: &Cancel::new() };
        for row in stress_built_in(0.1, asked).unwrap() {
            let shut = row.case.ends_with("shut") || row.case.starts_with("the light in");
            assert_eq!(row.truth.phantom, 0, "{} {}: light where there is none", row.case, row.method);
            assert!(
                !shut || row.statuses.unreached == row.sensors.len(),
                "{} {}: {:?}",
                row.case,
                row.method,
                row.statuses
            );
        }
    }

    #[test]
    fn openings_that_close_are_named() {
        let dark = ("hole of", "3 unreached", "1 opening(s) close");
        check(Failure::Keyhole, &[("hole of 4", "3 ok", ""), ("hole of 2", "3 ok", ""), dark, dark]);
    }

    #[test]
    fn ties_dead_ends_and_block_in_the_air_are_answered() {
        check(Failure::Tie, &[("middle", "41 ok", ""), ("aside", "41 ok", ""), ("narrow", "41 ok", "")]);
        check(Failure::DeadEnd, &[("6 m", "6 ok", "")]);
        check(Failure::FloatingSolid, &[("a block", "4 ok", "")]);
        check(Failure::DarkRooms, &[("0.3", "5 ok", "")]);
    }

    #[test]
    fn what_lies_in_matter_or_apart_has_its_status() {
        let in_pillar = ("sensors in a pillar", "2 unreached, 1 outside", "no light reaches");
        let in_wall = ("a wall of a voxel", "2 unreached", "lie inside matter");
        check(Failure::InSolid, &[in_pillar, ("light in a pillar", "2 unreached", "no light reaches"), in_wall]);
        check(Failure::SeparateVoids, &[("three rooms", "2 ok, 1 unreached", "2 separate voids")]);
        check(Failure::Leak, &[("no lid", "3 ok", "leaks"), ("crack", "3 ok", "1 opening(s) close")]);
    }

    #[test]
    fn a_light_by_a_wall_lights_the_room() {
        let off = ("voxel off", "4 ok", "");
        check(Failure::NearWall, &[off, off, off, off]);
    }
}
