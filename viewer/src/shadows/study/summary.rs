//! What do the rows say of the paper's claims? Layers for the same error, error for the same memory, time against VSM's.

use super::Row;
use super::asks::Variant;
use crate::shadows::Method;

/// HSM is said to need four layers where LVSM needs five for the same quality; a part of a layer is a layer.
pub const CLAIMED: [usize; 2] = [4, 5];

/// No method is to take longer than this many times VSM's time at its resolution times its layers.
pub const MOST_TIMES_VSM: f64 = 2.0;

/// Which error is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// Share of wrong pixels.
    Wrong,
    /// Mean absolute error against a sun without extent.
    Hard,
    /// Mean absolute error against the sun's disc.
    Disc,
}

impl By {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Wrong, Self::Hard, Self::Disc];

    /// In tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wrong => "wrong",
            Self::Hard => "hard",
            Self::Disc => "disc",
        }
    }

    /// That error of a row; `None` where the view has no pixel that counts.
    pub fn of(self, row: &Row) -> Option<f64> {
        let errors = row.errors?;
        Some(match self {
            Self::Wrong => errors.wrong,
            Self::Hard => errors.hard,
            Self::Disc => errors.disc,
        })
    }
}

/// How many layers a hybrid map needs for the error of an LVSM of the same resolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Texels a side of both.
    pub resolution: u32,
    /// By which error.
    pub by: By,
    /// Which hybrid map.
    pub method: Method,
    /// Layers of the LVSM.
    pub lvsm: usize,
    /// Its error.
    pub error: f64,
    /// The least measured number of layers with which the hybrid map is no further off; `None` where none is.
    pub needed: Option<usize>,
}

impl Layers {
    /// Whether no more than the claimed share is needed.
    pub fn holds(&self) -> bool {
        let claimed = (CLAIMED[0] * self.lvsm).div_ceil(CLAIMED[1]);
        self.needed.is_some_and(|needed| needed <= claimed)
    }

    /// Layers needed over LVSM's.
    pub fn ratio(&self) -> Option<f64> {
        self.needed.map(|needed| needed as f64 / self.lvsm as f64)
    }
}

/// A hybrid map against another method that takes as much memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory {
    /// By which error.
    pub by: By,
    /// The hybrid map: number of its row.
    pub hybrid: usize,
    /// The other method's row.
    pub other: usize,
    /// The hybrid map's error, and the other's.
    pub errors: [f64; 2],
}

impl Memory {
    /// Whether the hybrid map is less far off.
    pub fn holds(&self) -> bool {
        self.errors[0] < self.errors[1]
    }
}

/// A row's time over VSM's at its resolution, times its layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    /// Number of the row.
    pub row: usize,
    /// The ratio.
    pub ratio: f64,
}

impl Time {
    /// Whether it is within the bound.
    pub fn holds(&self) -> bool {
        self.ratio <= MOST_TIMES_VSM
    }
}

/// What the rows say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Layers for the same error, LVSM by LVSM.
    pub layers: Vec<Layers>,
    /// Error for the same memory, at the largest resolution of the hybrid map.
    pub memory: Vec<Memory>,
    /// Time, row by row where VSM was measured at its resolution.
    pub time: Vec<Time>,
}

/// What these rows say.
pub fn summary(rows: &[Row]) -> Summary {
    Summary { layers: layers(rows), memory: memory(rows), time: time(rows) }
}

/// Rows of a method as it is named, at resolutions that were asked for.
fn named(rows: &[Row], method: Method) -> impl Iterator<Item = (usize, &Row)> {
    let is_named =
        move |row: &Row| row.ask.method == method && row.ask.variant == Variant::AsNamed && !row.ask.is_by_memory;
    rows.iter().enumerate().filter(move |(_, row)| is_named(row))
}

/// The hybrid maps of their largest resolution that was asked for.
pub fn largest_hybrids(rows: &[Row]) -> Vec<usize> {
    let largest = named(rows, Method::Hsm).map(|(_, row)| row.ask.settings.resolution).max();
    let of_largest = named(rows, Method::Hsm).filter(|(_, row)| Some(row.ask.settings.resolution) == largest);
    of_largest.map(|(at, _)| at).collect()
}

fn layers(rows: &[Row]) -> Vec<Layers> {
    let mut found = Vec::new();
    for by in By::ALL {
        for method in [Method::Hsm, Method::HsmLight] {
            for (_, lvsm) in named(rows, Method::Lvsm) {
                let (Some(error), resolution) = (by.of(lvsm), lvsm.ask.settings.resolution) else { continue };
                let alike = || named(rows, method).filter(|(_, row)| row.ask.settings.resolution == resolution);
                if alike().next().is_none() {
                    continue;
                }
                let enough = alike().filter(|(_, row)| by.of(row).is_some_and(|of_row| of_row <= error));
                let needed = enough.map(|(_, row)| row.ask.settings.layers).min();
                found.push(Layers { resolution, by, method, lvsm: lvsm.ask.settings.layers, error, needed });
            }
        }
    }
    found
}

fn memory(rows: &[Row]) -> Vec<Memory> {
    let mut found = Vec::new();
    for hybrid in largest_hybrids(rows) {
        for method in [Method::Vsm, Method::Csm] {
            // The nearest from above.
            let is_named = |row: &Row| row.ask.method == method && row.ask.variant == Variant::AsNamed;
            let others = rows.iter().enumerate().filter(|(_, row)| is_named(row));
            let as_large = others.filter(|(_, row)| row.bytes >= rows[hybrid].bytes);
            let Some((other, _)) = as_large.min_by_key(|(_, row)| row.bytes) else { continue };
            for by in By::ALL {
                if let (Some(its), Some(others)) = (by.of(&rows[hybrid]), by.of(&rows[other])) {
                    found.push(Memory { by, hybrid, other, errors: [its, others] });
                }
            }
        }
    }
    found
}

fn time(rows: &[Row]) -> Vec<Time> {
    let vsm_ms = |resolution: u32| {
        named(rows, Method::Vsm).find(|(_, row)| row.ask.settings.resolution == resolution).map(|(_, row)| row.frame_ms)
    };
    let ratio = |(at, row): (usize, &Row)| {
        let most_ms = vsm_ms(row.ask.settings.resolution)? * row.ask.settings.layers as f64;
        (row.ask.method != Method::Vsm).then(|| Time { row: at, ratio: row.frame_ms / most_ms })
    };
    rows.iter().enumerate().filter_map(ratio).collect()
}

#[cfg(test)]
mod tests {
    use super::super::asks::{Ask, Extent, asks};
    use super::*;
    use crate::shadows::study::errors::Errors;

    fn row(ask: Ask, hard: f64, bytes: u64, frame_ms: f64) -> Row {
        let errors = Errors { counted: 1, left_out: 0, wrong: hard, hard, disc: hard, bleeding: None, acne: None };
        Row { ask, layers: ask.settings.layers, bytes, frame_ms, frames: 5, errors: Some(errors) }
    }

    fn rows(methods: &[Method], layers: &[usize], error: impl Fn(&Ask) -> f64) -> Vec<Row> {
        let extent = Extent { methods: methods.to_vec(), resolutions: vec![1024], layers: Some(layers.to_vec()) };
        asks(&extent)
            .into_iter()
            .filter(|ask| ask.variant == Variant::AsNamed)
            .map(|ask| row(ask, error(&ask), 100 * ask.settings.layers as u64, ask.settings.layers as f64))
            .collect()
    }

    #[test]
    fn layers_for_the_same_error_are_the_fewest_that_suffice() {
        // One over the layers; the hybrid map one over 1.25 times as many.
        let rows = rows(&[Method::Lvsm, Method::Hsm], &[2, 4, 5, 8, 10], |ask| {
            let better = if ask.method == Method::Hsm { 1.25 } else { 1.0 };
            1.0 / (better * ask.settings.layers as f64)
        });
        let found: Vec<Layers> = summary(&rows).layers.into_iter().filter(|layers| layers.by == By::Hard).collect();
        let needed: Vec<_> = found.iter().map(|layers| (layers.lvsm, layers.needed, layers.holds())).collect();
        let want =
            [(2, Some(2), true), (4, Some(4), true), (5, Some(4), true), (8, Some(8), false), (10, Some(8), true)];
        assert_eq!(needed, want);
        assert_eq!(found[2].ratio(), Some(0.8));
    }

    #[test]
    fn an_error_that_is_never_reached_refutes() {
        let rows = rows(&[Method::Lvsm, Method::Hsm], &[2, 4], |ask| f64::from(u8::from(ask.method == Method::Hsm)));
        let found = summary(&rows).layers;
        assert!(!found.is_empty() && found.iter().all(|layers| !layers.holds() && layers.ratio().is_none()));
    }

    #[test]
    fn memory_is_matched_from_above() {
        let mut rows = rows(&[Method::Vsm, Method::Hsm], &[3], |_| 0.5);
        let vsm = rows[0];
        // Too small, large enough, larger than need be.
        rows.extend([(299, 0.1), (310, 0.6), (900, 0.2)].map(|(bytes, hard)| row(vsm.ask, hard, bytes, 1.0)));
        let found = summary(&rows).memory;
        assert_eq!(found.len(), By::ALL.len());
        assert!(found.iter().all(|memory| memory.errors == [0.5, 0.6] && memory.holds() && memory.other == 3));
    }

    #[test]
    fn time_is_held_against_vsm_times_layers() {
        let mut rows = rows(&[Method::Vsm, Method::Lvsm], &[4], |_| 0.5);
        rows[1].frame_ms = 9.0;
        let found = summary(&rows).time;
        assert_eq!(found, [Time { row: 1, ratio: 2.25 }]);
        assert!(!found[0].holds());
        assert_eq!(summary(&rows[1..]).time, [], "without VSM there is nothing to hold against");
    }
}
