//! How fine a network does a scene need?
//!
//! From coarse to fine, until a network's own error, root of the mean square over the points, is inside the tolerance as a share
//! of the points' mean exposure. That error has been held to Radiance: it is within once of it at nine points in ten (docs/daylight.md).
//!
//! Limits: what all networks on the same voxels have in common, closed openings, is in no error.

use super::{Reflected, by_network};
use crate::daylight::cast::Casting;
use crate::daylight::reflect::skylight::Skylight;
use crate::daylight::{Exposure, Point};
use crate::flow::network::Quality;
use crate::job::{Cancel, Cancelled, Progress};
use crate::model::Model;

/// The networks that are tried, the coarsest first, with their names.
const NETWORKS: [(&str, Quality); 3] =
    [("coarse network", Quality::COARSE), ("network", Quality::MEDIUM), ("fine network", Quality::FINE)];

/// A network that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// Its name.
    pub name: &'static str,
    /// Its own error, a share of the mean exposure.
    pub error: f64,
}

/// What is reflected to points that receive `straight` from sun and sky, by the coarsest network whose own error is inside
/// `tolerance`, a factor above 1; the finest if none is. All that were tried beside it, the one that was taken last.
///
/// # Errors
/// [`Cancelled`].
#[expect(clippy::too_many_arguments, reason = "the question of by_network, and what decides")]
pub fn by_fitting_network(
    model: &Model,
    points: &[Point],
    straight: &[Exposure],
    light: &Skylight,
    casting: Casting,
    tolerance: f64,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<(Vec<Reflected>, Vec<Tried>), Cancelled> {
    let (mut found, mut tried) = (Vec::new(), Vec::new());
    for (name, quality) in NETWORKS {
        found = by_network(model, points, light, &quality, casting, progress, cancel)?;
        let error = own_error(&found, straight);
        tried.push(Tried { name, error });
        if error <= tolerance - 1.0 {
            break;
        }
    }
    Ok((found, tried))
}

/// The root of the mean square of the own errors, a share of the mean exposure; 0 where all is dark.
fn own_error(found: &[Reflected], straight: &[Exposure]) -> f64 {
    let count = found.len().max(1) as f64;
    let square: f64 = found.iter().map(|reflected| reflected.error_kwh_m2.powi(2)).sum();
    let all: f64 =
        found.iter().map(Reflected::all_kwh_m2).sum::<f64>() + straight.iter().map(Exposure::total_kwh_m2).sum::<f64>();
    if square > 0.0 { (square / count).sqrt() * count / all.max(f64::MIN_POSITIVE) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Status;

    #[test]
    fn the_error_is_a_share_of_all_light() {
        let found =
            [3.0, 4.0].map(|error_kwh_m2| Reflected { of_sky_kwh_m2: 10.0, error_kwh_m2, ..Reflected::default() });
        let straight = [Exposure { beam_kwh_m2: 90.0, ..Exposure::none(Status::Ok) }; 2];
        assert!((own_error(&found, &straight) - 12.5_f64.sqrt() / 100.0).abs() < 1e-12);
        assert_eq!(own_error(&[Reflected::default()], &[Exposure::none(Status::Dark)]), 0.0);
        assert_eq!(own_error(&[], &[]), 0.0);
    }
}
