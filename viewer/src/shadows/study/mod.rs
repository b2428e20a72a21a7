//! What does each shadow method cost, and how far off is it? Frames of one view by many settings, timed and held to the truth.
//!
//! A row's time is the median of whole frames (maps, and the view lit by them), each waited for, the first one left out: it
//! makes textures and pipelines. Rows share a budget evenly; slow ones end with fewer frames. Errors are those of
//! [`errors`].
//!
//! Limits: times are of the machine and whatever else it does; on a software driver they go by texels and triangles and say
//! little of a graphics card.

pub mod asks;
pub mod chart;
pub mod command;
pub mod errors;
pub mod pictures;
pub mod report;
pub mod summary;
pub mod truth;

use super::{Lit, Method, Studio, View};
use anyhow::Result;
use asks::{Ask, Variant, as_large_as};
use errors::{Errors, Judge};
use lightvein::job::Cancel;
use std::time::{Duration, Instant};
use summary::{Summary, largest_hybrids, summary};

/// Timed frames of a row, least and most.
const FRAMES: [usize; 2] = [5, 100];

/// A row that has taken this many times its share of the budget ends with three frames, and with twice that after one.
const LATE: u32 = 2;

/// How often a map's side is chosen anew, until it takes as much memory as it should.
const MOST_SIDES: usize = 3;

/// Hybrid maps of more layers are not compared at equal memory: the others' maps would be the largest there are.
const MOST_LAYERS_BY_MEMORY: usize = 8;

/// How long a study may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// No row that has frames enough takes longer.
    pub row: Duration,
    /// Of all rows, evenly shared: what is left of it among those that are left.
    pub all: Duration,
}

impl Default for Budget {
    /// For a default run within 45 s on two cores without a graphics card, truth and pictures included.
    fn default() -> Self {
        Self { row: Duration::from_millis(300), all: Duration::from_secs(30) }
    }
}

/// What a row's settings cost, and how far off they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// What was measured.
    pub ask: Ask,
    /// Layers that the view needed of those that were asked for.
    pub layers: usize,
    /// Of all textures of the maps.
    pub bytes: u64,
    /// Median time of a frame, milliseconds.
    pub frame_ms: f64,
    /// How many were timed.
    pub frames: usize,
    /// How far off; `None` where nothing in view faces the sun.
    pub errors: Option<Errors>,
}

/// What was found of a view.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// In the order of the asks, those that memory decided on last.
    pub rows: Vec<Row>,
    /// What they say together.
    pub summary: Summary,
    /// Each method's row with the least error against a sun without extent, and what it shows.
    pub best: Vec<(usize, Vec<Option<Lit>>)>,
}

/// Measures a view. `hear` is told of every row, and how many there are to be.
///
/// # Errors
/// When the adapter is lost; [`lightvein::job::Cancelled`].
pub fn measure(
    studio: &mut Studio,
    view: &View,
    judge: &Judge,
    asks: &[Ask],
    budget: &Budget,
    cancel: &Cancel,
    hear: &mut dyn FnMut(&Row, [usize; 2]),
) -> Result<Findings> {
    let begun = Instant::now();
    let mut findings = Findings::default();
    let mut add = |findings: &mut Findings, studio: &mut Studio, ask: Ask, left: usize| -> Result<Row> {
        cancel.check()?;
        let share = budget.all.saturating_sub(begun.elapsed()) / left.max(1) as u32;
        let (row, lit) = row(studio, view, judge, ask, [share, budget.row])?;
        hear(&row, [findings.rows.len() + 1, findings.rows.len() + left]);
        findings.add(row, lit);
        Ok(row)
    };

    for (at, &ask) in asks.iter().enumerate() {
        add(&mut findings, studio, ask, asks.len() - at)?;
    }
    let as_large = by_memory(&findings.rows);
    for (at, &(mut ask, bytes)) in as_large.iter().enumerate() {
        for _ in 0..MOST_SIDES {
            let row = add(&mut findings, studio, ask, as_large.len() - at)?;
            let larger = if row.bytes < bytes { as_large_as(ask, row.bytes, bytes) } else { None };
            let Some(larger) = larger else { break };
            ask = larger;
        }
    }
    findings.summary = summary(&findings.rows);
    Ok(findings)
}

impl Findings {
    /// Takes in a row; what it shows is kept if it is its method's best so far.
    fn add(&mut self, row: Row, lit: Vec<Option<Lit>>) {
        let off = |row: &Row| row.errors.map_or(f64::INFINITY, |errors| errors.hard);
        let at = self.rows.len();
        self.rows.push(row);
        if row.ask.variant != Variant::AsNamed || row.ask.is_by_memory {
            return;
        }
        match self.best.iter_mut().find(|(best, _)| self.rows[*best].ask.method == row.ask.method) {
            Some(best) if off(&row) < off(&self.rows[best.0]) => *best = (at, lit),
            Some(_) => (),
            None => self.best.push((at, lit)),
        }
    }
}

/// VSM and CSM at the memory of the largest hybrid maps: what is to be measured, and how many bytes it is to take at least.
fn by_memory(rows: &[Row]) -> Vec<(Ask, u64)> {
    let mut found = Vec::new();
    for hybrid in largest_hybrids(rows).into_iter().map(|at| &rows[at]) {
        for method in [Method::Vsm, Method::Csm] {
            // Of the rows that were asked for the one with most layers, which is the method at its best.
            let is_named = |row: &&Row| row.ask.variant == Variant::AsNamed && !row.ask.is_by_memory;
            let its = rows.iter().filter(|row| row.ask.method == method).filter(is_named);
            let most = its.max_by_key(|row| (row.ask.settings.layers, row.bytes));
            let as_large = most.and_then(|most| as_large_as(most.ask, most.bytes, hybrid.bytes));
            if hybrid.ask.settings.layers <= MOST_LAYERS_BY_MEMORY {
                found.extend(as_large.map(|ask| (ask, hybrid.bytes)));
            }
        }
    }
    found
}

/// One row, and what it shows; `times` are its share of the budget, and the most that it takes without need.
fn row(
    studio: &mut Studio,
    view: &View,
    judge: &Judge,
    ask: Ask,
    times: [Duration; 2],
) -> Result<(Row, Vec<Option<Lit>>)> {
    studio.frame(view, &ask.settings)?;
    let begun = Instant::now();
    let mut frames_ms = Vec::new();
    while goes_on(frames_ms.len(), begun.elapsed(), times) {
        let frame = Instant::now();
        studio.frame(view, &ask.settings)?;
        frames_ms.push(1e3 * frame.elapsed().as_secs_f64());
    }
    let lit = studio.lit()?;
    let row = Row {
        ask,
        layers: studio.maps().plan().layers.len(),
        bytes: studio.maps().bytes(),
        frames: frames_ms.len(),
        frame_ms: median(frames_ms),
        errors: judge.errors(&lit),
    };
    Ok((row, lit))
}

/// Whether a row that has so many frames after so long takes another.
fn goes_on(frames: usize, elapsed: Duration, [share, longest]: [Duration; 2]) -> bool {
    let [least, most] = FRAMES;
    let least = match elapsed {
        elapsed if elapsed < LATE * share => least,
        elapsed if elapsed < 2 * LATE * share => 3,
        _ => 1,
    };
    frames < least || (frames < most && elapsed < share.min(longest))
}

/// The middle of some times; not a number where there is none.
fn median(mut times_ms: Vec<f64>) -> f64 {
    times_ms.sort_by(f64::total_cmp);
    let middle = times_ms.len() / 2;
    match (times_ms.get(middle), times_ms.len() % 2) {
        (Some(&above), 0) => f64::midpoint(times_ms[middle - 1], above),
        (Some(&middle), _) => middle,
        (None, _) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::asks::{Extent, asks};
    use super::*;

    fn row(ask: Ask, hard: f64, bytes: u64) -> Row {
        let errors = Errors { counted: 1, left_out: 0, wrong: 0.0, hard, disc: hard, bleeding: None, acne: None };
        Row { ask, layers: 1, bytes, frame_ms: 1.0, frames: 5, errors: Some(errors) }
    }

    #[test]
    fn rows_have_enough_frames_and_slow_ones_fewer() {
        let frames = |share_ms: u64, frame_ms: u64| {
            let times = [share_ms, 300].map(Duration::from_millis);
            let goes_on = |&count: &usize| goes_on(count, Duration::from_millis(frame_ms) * count as u32, times);
            (0..).find(|count| !goes_on(count)).unwrap()
        };
        // Of a share of 400 ms: the most, as many as 300 ms hold, five, four, three and one.
        assert_eq!([1, 10, 100, 250, 500, 2000].map(|frame_ms| frames(400, frame_ms)), [100, 30, 5, 4, 3, 1]);
        assert_eq!(frames(0, 1), 1, "with nothing left");
    }

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(vec![9.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 100.0]), 3.0);
        assert!(median(Vec::new()).is_nan());
    }

    #[test]
    fn the_best_row_of_a_method_is_kept() {
        let extent = Extent { methods: vec![Method::Vsm], resolutions: vec![256, 512, 1024], layers: None };
        let mut findings = Findings::default();
        for (number, (ask, hard)) in asks(&extent).into_iter().zip([0.3, 0.1, 0.2]).enumerate() {
            findings.add(row(ask, hard, 0), vec![Some(Lit { share: number as f32, depth_m: 1.0 })]);
        }
        assert_eq!(findings.rows.len(), 3);
        assert_eq!(findings.best, [(1, vec![Some(Lit { share: 1.0, depth_m: 1.0 })])]);
    }

    #[test]
    fn others_are_made_as_large_as_the_hybrid_map() {
        let methods = vec![Method::Vsm, Method::Csm, Method::Hsm];
        let extent = Extent { methods, resolutions: vec![256, 1024], layers: Some(vec![4, 12]) };
        let of = |ask: Ask| row(ask, 0.1, u64::from(ask.settings.resolution).pow(2) * ask.settings.layers as u64);
        let rows: Vec<Row> = asks(&extent).into_iter().map(of).collect();
        let found = by_memory(&rows);
        // VSM at four layers' texels, and twelve cascades at a third of their own; not at twelve layers.
        let sides: Vec<_> = found.iter().map(|(ask, _)| (ask.method, ask.settings.resolution)).collect();
        assert_eq!(sides, [(Method::Vsm, 2048), (Method::Csm, 592)]);
        assert!(found.iter().all(|(_, bytes)| *bytes == 4 << 20));
    }
}
