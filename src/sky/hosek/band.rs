//! How bright is each direction of a clear sky within a band of the spectrum?
//!
//! Few channels whose sum is the band's radiance, weighted once so that the sum is all a caller does. Broadband is the shape
//! of the RGB data's luminance; ultraviolet and visible come from the spectral data, which end at 320 and 720 nm: infrared
//! is refused.
//!
//! Ultraviolet is the trapezoid over 320, 360 and 400 nm, W/(m2 sr). Visible takes four of the nine wavelengths it reaches,
//! with the weights that are right for every spectrum cubic in the wavelength. Against the trapezoid over all nine, each
//! scaled to the same diffuse irradiance, its shape is off by 0.7% RMS on average and 2.7% at worst, with the sun on the
//! horizon (the test below).

use super::spectral::channels;
use super::{Channel, Hosek, LUMINANCE_REC709};
use crate::sky::spectrum::Band;
use crate::sky::within;

/// Places of 320, 360 and 400 nm, and their trapezoid weights, nm.
const ULTRAVIOLET: ([usize; 3], [f64; 3]) = ([0, 1, 2], [20.0, 40.0, 20.0]);

/// Places of 440, 520, 600 and 680 nm, and the integrals of their Lagrange polynomials from 400 to 700 nm, nm.
const VISIBLE: ([usize; 4], [f64; 4]) = ([3, 5, 7, 9], [90.820_312_5, 55.664_062_5, 103.710_937_5, 49.804_687_5]);

/// A band that Hosek and Wilkie's data do not reach.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the sky's shape in {0} light is not known: the spectral data of Hosek and Wilkie reach from 320 to 720 nm; \
     ask for broadband, visible (400 to 700 nm) or ultraviolet (320 to 400 nm)"
)]
pub struct BandNotReached(pub Band);

/// The sky of one sun, turbidity and ground within a band: its radiance is the sum of its channels.
#[derive(Debug, Clone, PartialEq)]
pub struct HosekBand {
    /// Three or four; radiances carry the weights of the band. W/(m2 sr); for broadband a shape without unit.
    pub channels: Vec<Channel>,
}

impl HosekBand {
    /// The sky with the sun at `sun_elevation_rad`, clamped as by [`Hosek::new`]. About 4 us.
    ///
    /// # Errors
    /// Infrared: the data end at 720 nm.
    pub fn new(sun_elevation_rad: f64, turbidity: f64, ground_albedo: f64, band: Band) -> Result<Self, BandNotReached> {
        let channels = match band {
            Band::Broadband => {
                weighted(&Hosek::new(sun_elevation_rad, turbidity, ground_albedo).channels, &LUMINANCE_REC709)
            }
            Band::Ultraviolet => {
                weighted(&channels(sun_elevation_rad, turbidity, ground_albedo, ULTRAVIOLET.0), &ULTRAVIOLET.1)
            }
            Band::Visible => weighted(&channels(sun_elevation_rad, turbidity, ground_albedo, VISIBLE.0), &VISIBLE.1),
            Band::Infrared => return Err(BandNotReached(band)),
        };
        Ok(Self { channels })
    }

    /// Radiance of the band towards a direction, by its cosines to the zenith (0 used below the horizon) and to the sun.
    /// Never negative, never NaN.
    pub fn relative(&self, cos_zenith: f64, cos_gamma: f64) -> f64 {
        let cos_gamma = within(cos_gamma, (-1.0, 1.0));
        let gamma_rad = cos_gamma.acos();
        self.channels.iter().map(|channel| channel.at(cos_zenith, gamma_rad, cos_gamma)).sum()
    }
}

/// Channels with their radiances times their weights.
fn weighted(channels: &[Channel], weights: &[f64]) -> Vec<Channel> {
    let weigh = |(channel, weight): (&Channel, &f64)| Channel { radiance: channel.radiance * weight, ..*channel };
    channels.iter().zip(weights).map(weigh).collect()
}

#[cfg(test)]
mod tests {
    use super::super::HosekSpectrum;
    use super::*;
    use crate::sky::towards;

    #[test]
    fn infrared_is_refused_with_the_bound() {
        let refused = HosekBand::new(1.0, 3.0, 0.2, Band::Infrared).unwrap_err();
        assert!(refused.to_string().contains("720 nm"), "{refused}");
    }

    #[test]
    fn broadband_is_the_luminance() {
        let (band, sky) = (HosekBand::new(0.6, 4.0, 0.3, Band::Broadband).unwrap(), Hosek::new(0.6, 4.0, 0.3));
        assert!((band.relative(0.4, 0.7) / sky.relative(0.4, 0.7) - 1.0).abs() < 1e-12);
    }

    /// The weights hold for cubics: of 1, x, x2 and x3 over 400 to 700 nm.
    #[test]
    fn the_visible_weights_are_right_for_cubics() {
        for power in 0..4 {
            let sum: f64 =
                VISIBLE.0.iter().zip(VISIBLE.1).map(|(&at, w)| w * (40.0 * at as f64 + 320.0).powi(power)).sum();
            let exact = (700f64.powi(power + 1) - 400f64.powi(power + 1)) / f64::from(power + 1);
            assert!((sum / exact - 1.0).abs() < 1e-9, "{power}: {sum} {exact}");
        }
    }

    /// Four wavelengths against all nine, over suns, turbidities and grounds; both scaled to one diffuse irradiance.
    #[test]
    fn few_wavelengths_keep_the_shape() {
        // The integral of what is linear between the wavelengths, 400 to 700 nm.
        let trapezoid = [0.0, 0.0, 20.0, 40.0, 40.0, 40.0, 40.0, 40.0, 40.0, 35.0, 5.0];
        let directions: Vec<(f64, f64)> =
            (0..400).map(|at| (f64::from(at) * 2.4, ((f64::from(at) + 0.5) / 400.0).asin())).collect();

        let mut errors = Vec::new();
        for elevation in [0.0f64, 0.1, 0.5, 1.0, 1.5] {
            for turbidity in [1.0, 2.0, 4.0, 10.0] {
                let few = HosekBand::new(elevation, turbidity, 0.2, Band::Visible).unwrap();
                let all = HosekSpectrum::new(elevation, turbidity, 0.2);
                let sun = towards(0.0, elevation);
                let values = directions.iter().map(|&(azimuth, elevation)| {
                    let view = towards(azimuth, elevation);
                    let whole = all.radiance(view.z, view.dot(sun));
                    let whole: f64 = whole.iter().zip(trapezoid).map(|(value, weight)| value * weight).sum();
                    (view.z, few.relative(view.z, view.dot(sun)), whole)
                });
                let values: Vec<_> = values.collect();
                let few_sum: f64 = values.iter().map(|(cos, few, _)| cos * few).sum();
                let whole_sum: f64 = values.iter().map(|(cos, _, whole)| cos * whole).sum();
                let mean: f64 = values.iter().map(|(_, _, whole)| whole / whole_sum).sum::<f64>() / 400.0;
                let square: f64 =
                    values.iter().map(|(_, few, whole)| (few / few_sum - whole / whole_sum).powi(2)).sum::<f64>()
                        / 400.0;
                errors.push(square.sqrt() / mean);
            }
        }
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let worst = errors.iter().copied().fold(0.0, f64::max);
        assert!(mean < 0.01 && worst < 0.03, "{mean} {worst}");
    }
}
