//! What does the eye make of a spectrum? CIE 1931 by the fit of Wyman, Sloan and Shirley ("Simple analytic approximations to
//! the CIE XYZ color matching functions", JCGT 2(2), 2013), their many-lobed one; within 1% of the tables' integrals.

use super::table::{ROWS, TABLE};

/// Lumens a watt at the eye's best.
const LUMENS_PER_WATT: f64 = 683.002;

/// Step of the sum, um: the fit's narrowest slope is 12 nm wide.
const STEP_UM: f64 = 0.002;

/// CIE XYZ of an irradiance by the table's wavelengths, W/(m2 um), in kilolux.
pub(super) fn xyz_klx(irradiance_w_m2_um: &[f64; ROWS]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (rows, values) in TABLE.windows(2).zip(irradiance_w_m2_um.windows(2)) {
        let (a, b) = (rows[0][0], rows[1][0]);
        if a >= 0.83 {
            break;
        }
        // The middles of steps that fill the cell.
        let steps = ((b - a) / STEP_UM).ceil();
        for step in 0..steps as usize {
            let share = (step as f64 + 0.5) / steps;
            let irradiance = values[0] + (values[1] - values[0]) * share;
            let seen = matching(1000.0 * (a + (b - a) * share));
            for (sum, seen) in sum.iter_mut().zip(seen) {
                *sum += irradiance * seen * (b - a) / steps;
            }
        }
    }
    sum.map(|value| value * LUMENS_PER_WATT / 1000.0)
}

/// The observer's three functions of a wavelength in nanometres.
fn matching(wavelength_nm: f64) -> [f64; 3] {
    let lobe = |height: f64, centre: f64, below: f64, above: f64| {
        let width = if wavelength_nm < centre { below } else { above };
        height * (-0.5 * ((wavelength_nm - centre) / width).powi(2)).exp()
    };
    [
        lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tables' integrals are 106.865, 106.857 and 106.892 nm (CIE 1931, 2 degrees); white of equal energy is x = y = 1/3.
    #[test]
    fn equal_energy_is_white() {
        let xyz = xyz_klx(&[1000.0; ROWS]).map(|value| value / LUMENS_PER_WATT * 1000.0);
        for (value, want) in xyz.iter().zip([106.865, 106.857, 106.892]) {
            assert!((value / want - 1.0).abs() < 0.01, "{xyz:?}");
        }
    }

    /// The solar illumination constant is 133.1 klx (ASTM E490 with CIE 1924); the table's spectrum is an older one.
    #[test]
    fn the_sun_outside_the_atmosphere_is_as_bright_as_measured() {
        let klx = xyz_klx(&TABLE.map(|row| row[1]))[1];
        assert!((klx / 133.1 - 1.0).abs() < 0.03, "{klx}");
    }
}
