//! How far is a field from its reference?
//!
//! Errors of light span decades, so they are factors: [`Errors::rms_factor`] is 10 to the root mean square of
//! `log10(estimate / reference)`. A sensor whose reference is zero, or known to worse than 10%, says nothing about the
//! estimate: it is left out and counted. An estimate of zero beside a good reference has no factor either: it is counted as
//! lost and makes both factors infinite, rather than being left out silently.

use crate::light::Reading;
use crate::scene::Reference;

/// A reference with a greater relative standard error is left out.
pub const WORST_REFERENCE: f64 = 0.1;

/// A reference whose net flux is under this share of its irradiance has no main direction to compare.
pub const LEAST_DIRECTED: f64 = 0.1;

/// The errors of one field over the sensors that have a good reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// `10^sqrt(mean(log10(estimate / reference)^2))`; `None` where no sensor has a good reference.
    pub rms_factor: Option<f64>,
    /// The greatest factor by which an estimate is off, either way.
    pub max_factor: Option<f64>,
    /// Median angle between the main directions, degrees; `None` where no reference has one.
    pub median_angle_deg: Option<f64>,
    /// Sensors that count.
    pub counted: usize,
    /// Sensors with a reference that is zero or known to worse than 10%.
    pub left_out: usize,
    /// Sensors that count and whose estimate is zero.
    pub lost: usize,
    /// Sensors that count and whose estimate is not below the reference.
    pub above: usize,
}

/// Whether a reference is good enough to measure an estimate by.
pub fn is_good(reference: &Reference) -> bool {
    reference.irradiance_w_m2 > 0.0 && reference.stderr_w_m2 <= WORST_REFERENCE * reference.irradiance_w_m2
}

/// Compares readings with references, entry by entry; entries without a reference count nowhere.
pub fn errors(readings: &[Reading], references: &[Option<Reference>]) -> Errors {
    let with_reference =
        || readings.iter().zip(references).filter_map(|(reading, known)| Some((reading, known.as_ref()?)));
    let good = || with_reference().filter(|(_, reference)| is_good(reference));

    let logs: Vec<f64> =
        good().map(|(reading, reference)| (reading.value_w_m2 / reference.irradiance_w_m2).log10()).collect();
    let mean_square = logs.iter().map(|log| log * log).sum::<f64>() / logs.len() as f64;
    let max_log = logs.iter().map(|log| log.abs()).fold(0.0, f64::max);

    let mut angles_deg: Vec<f64> = good().filter_map(|(reading, reference)| angle_deg(reading, reference)).collect();
    angles_deg.sort_by(f64::total_cmp);

    let some = !logs.is_empty();
    Errors {
        rms_factor: some.then(|| 10_f64.powf(mean_square.sqrt())),
        max_factor: some.then(|| 10_f64.powf(max_log)),
        median_angle_deg: median(&angles_deg),
        counted: logs.len(),
        left_out: with_reference().count() - logs.len(),
        lost: logs.iter().filter(|&&log| log == f64::NEG_INFINITY).count(),
        above: logs.iter().filter(|&&log| log >= 0.0).count(),
    }
}

/// The angle between the main directions, degrees; `None` where either has none.
pub fn angle_deg(reading: &Reading, reference: &Reference) -> Option<f64> {
    let directed = reference.flux_w_m2.length() > LEAST_DIRECTED * reference.irradiance_w_m2;
    let lit = reading.flux_w_m2.length() > 0.0;
    (directed && lit).then(|| reading.flux_w_m2.angle_between(reference.flux_w_m2).to_degrees())
}

/// The middle of sorted values, the mean of the two middle ones for an even number.
fn median(sorted: &[f64]) -> Option<f64> {
    let middle = sorted.len() / 2;
    let upper = sorted.get(middle)?;
    Some(if sorted.len() % 2 == 1 { *upper } else { (sorted[middle - 1] + upper) / 2.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Status;
    use glam::DVec3;

    fn reading(value_w_m2: f64) -> Reading {
        Reading { value_w_m2, flux_w_m2: DVec3::X * value_w_m2, error_w_m2: None, status: Status::Ok }
    }

    fn reference(irradiance_w_m2: f64, stderr_w_m2: f64) -> Option<Reference> {
        Some(Reference { irradiance_w_m2, stderr_w_m2, flux_w_m2: DVec3::Y * irradiance_w_m2 })
    }

    /// The poster's own table: reference, backward, forward at its points A to G, W/m2.
    const POSTER: [[f64; 3]; 7] = [
        [1.05, 1.17, 1.17],
        [0.23, 0.26, 0.22],
        [0.10, 0.14, 0.10],
        [0.08, 0.17, 0.01],
        [0.008, 0.036, 0.005],
        [0.01, 0.04, 0.009],
        [0.004, 0.03, 0.01],
    ];

    #[test]
    fn the_posters_table_gives_the_posters_factors() {
        let references: Vec<_> = POSTER.iter().map(|row| reference(row[0], 0.0)).collect();
        for (column, want) in [(1, 3.1), (2, 2.4)] {
            let readings: Vec<_> = POSTER.iter().map(|row| reading(row[column])).collect();
            let rms_factor = errors(&readings, &references).rms_factor.unwrap();
            assert!((rms_factor - want).abs() < 0.05, "column {column}: {rms_factor}");
        }
    }

    #[test]
    fn twice_and_half_are_the_same_factor() {
        let found = errors(&[reading(2.0), reading(0.5)], &[reference(1.0, 0.01), reference(1.0, 0.01)]);
        assert!((found.rms_factor.unwrap() - 2.0).abs() < 1e-12);
        assert!((found.max_factor.unwrap() - 2.0).abs() < 1e-12);
        assert!((found.median_angle_deg.unwrap() - 90.0).abs() < 1e-9);
        assert_eq!((found.counted, found.above), (2, 1));
    }

    #[test]
    fn poor_references_are_left_out_and_lost_light_is_not() {
        let readings = [reading(1.0), reading(1.0), reading(0.0), reading(1.0)];
        let references = [reference(1.0, 0.2), reference(0.0, 0.0), reference(1.0, 0.0), None];
        let found = errors(&readings, &references);
        assert_eq!((found.counted, found.left_out, found.lost), (1, 2, 1));
        assert_eq!(found.rms_factor, Some(f64::INFINITY));
        assert_eq!(errors(&readings[..1], &references[..1]).rms_factor, None);
    }
}
