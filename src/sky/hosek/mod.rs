//! How bright is each direction of a clear sky, relative to the others? Hosek and Wilkie's sky.
//!
//! "An Analytic Model for Full Spectral Sky-Dome Radiance" (ACM Transactions on Graphics 31(4), 2012): nine coefficients and
//! a mean radiance a channel, fitted to path-traced atmospheres for ten turbidities and two ground albedos, joined by
//! quintic curves over the sun's elevation. The RGB data come with the crate `hw-skymodel`.
//!
//! Limits: a clear sky without the sun's disc, for a sun at or above the horizon; values are not watts. Use the shape and
//! scale it to the diffuse irradiance. The fit is weak with the sun within some degrees of the horizon.
//!
//! [`HosekSpectrum`] holds the same by wavelength, [`HosekBand`] within a band.

mod band;
mod spectral;

pub use band::{BandNotReached, HosekBand};
pub use spectral::{HosekSpectrum, WAVELENGTHS_NM};

use super::within;
use hw_skymodel::rgb::{SkyParams, SkyState};
use std::f64::consts::FRAC_PI_2;

/// Turbidities of the data: a clean atmosphere to a hazy one.
pub const TURBIDITY: (f64, f64) = (1.0, 10.0);

/// Shares of linear red, green and blue of Rec. 709 in luminance.
pub const LUMINANCE_REC709: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// One channel of a sky: the formula's nine coefficients and the mean radiance that scales it.
///
/// The paper's equation 8 by place: A to G, then I (of the root of the zenith's cosine) and H (of the forward peak), as in
/// the authors' own files. Plain data, so that a loop over many skies can read the numbers themselves; [`Channel::at`] is
/// the formula.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Channel {
    /// A, B, C, D, E, F, G, I, H.
    pub params: [f64; 9],
    /// Mean radiance of the sky, in the units of the data.
    pub radiance: f64,
}

impl Channel {
    /// Radiance towards one direction; never negative, never NaN.
    ///
    /// `cos_zenith` is the direction's cosine to the zenith, 0 used below the horizon; `gamma_rad` its angle to the sun and
    /// `cos_gamma` the cosine of that. Under 0.1 us.
    pub fn at(&self, cos_zenith: f64, gamma_rad: f64, cos_gamma: f64) -> f64 {
        let [a, b, c, d, e, f, g, i, h] = self.params;
        let cos_zenith = cos_zenith.max(0.0);
        let cos_gamma_2 = cos_gamma * cos_gamma;

        let gradation = 1.0 + a * (b / (cos_zenith + 0.01)).exp();
        let peak = (1.0 + cos_gamma_2) / (1.0 + h * h - 2.0 * h * cos_gamma).powf(1.5);
        let scattering = c + d * (e * gamma_rad).exp() + f * cos_gamma_2 + g * peak + i * cos_zenith.sqrt();
        // `max` takes 0 where the other is NaN.
        (self.radiance * gradation * scattering).max(0.0)
    }
}

/// The sky of one sun, turbidity and ground, in linear RGB of Rec. 709.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hosek {
    /// Red, green, blue.
    pub channels: [Channel; 3],
}

impl Hosek {
    /// The sky with the sun at `sun_elevation_rad`, clamped to 0 to a quarter turn; `turbidity` clamped to 1 to 10 and
    /// `ground_albedo` to 0 to 1. NaN counts as the lower bound. Under 1 us.
    pub fn new(sun_elevation_rad: f64, turbidity: f64, ground_albedo: f64) -> Self {
        let sky = SkyParams {
            elevation: within(sun_elevation_rad, (0.0, FRAC_PI_2)) as f32,
            turbidity: within(turbidity, TURBIDITY) as f32,
            albedo: [within(ground_albedo, (0.0, 1.0)) as f32; 3],
        };
        // The crate refuses only what is out of these bounds; a dark sky would be the answer.
        let (params, radiances) = SkyState::new(&sky).map(|state| state.raw()).unwrap_or(([0.0; 27], [0.0; 3]));

        let channels = std::array::from_fn(|channel| Channel {
            params: std::array::from_fn(|at| f64::from(params[9 * channel + at])),
            radiance: f64::from(radiances[channel]),
        });
        Self { channels }
    }

    /// Linear red, green and blue of Rec. 709 towards a direction, by its cosines to the zenith (0 used below the horizon)
    /// and to the sun. In the units of the data: only ratios mean something. Never negative, never NaN.
    pub fn radiance_rgb(&self, cos_zenith: f64, cos_gamma: f64) -> [f64; 3] {
        let cos_gamma = within(cos_gamma, (-1.0, 1.0));
        let gamma_rad = cos_gamma.acos();
        self.channels.map(|channel| channel.at(cos_zenith, gamma_rad, cos_gamma))
    }

    /// Luminance of [`Hosek::radiance_rgb`] (Rec. 709): the shape that stands for the sky of all wavelengths.
    pub fn relative(&self, cos_zenith: f64, cos_gamma: f64) -> f64 {
        let rgb = self.radiance_rgb(cos_zenith, cos_gamma);
        rgb.iter().zip(LUMINANCE_REC709).map(|(value, share)| value * share).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The crate's own sum, in f32 and by angles.
    #[test]
    fn the_formula_is_the_crates() {
        for (elevation, turbidity, albedo) in
            [(0.0, 1.0, 0.0), (0.3, 2.5, 0.2), (1.0, 6.0, 0.7), (FRAC_PI_2, 10.0, 1.0)]
        {
            let ours = Hosek::new(elevation, turbidity, albedo);
            let albedo = [albedo as f32; 3];
            let theirs =
                SkyState::new(&SkyParams { elevation: elevation as f32, turbidity: turbidity as f32, albedo }).unwrap();
            for (theta, gamma) in [(0.0f32, 0.9f32), (0.7, 0.01), (1.2, 2.0), (1.55, 3.0)] {
                let rgb = ours.radiance_rgb(f64::from(theta).cos(), f64::from(gamma).cos());
                use hw_skymodel::rgb::Channel::{B, G, R};
                for (value, channel) in rgb.iter().zip([R, G, B]) {
                    let want = f64::from(theirs.radiance(theta, gamma, channel)).max(0.0);
                    assert!((value - want).abs() <= 1e-5 * want + 1e-7, "{elevation} {theta} {gamma}: {value} {want}");
                }
            }
        }
    }

    #[test]
    fn what_is_out_of_bounds_is_within() {
        assert_eq!(Hosek::new(-1.0, 0.0, -1.0), Hosek::new(0.0, 1.0, 0.0));
        assert_eq!(Hosek::new(2.0, 12.0, 3.0), Hosek::new(FRAC_PI_2, 10.0, 1.0));
        assert_eq!(Hosek::new(f64::NAN, f64::NAN, f64::NAN), Hosek::new(0.0, 1.0, 0.0));
        let sky = Hosek::new(0.5, 3.0, 0.2);
        assert_eq!(sky.radiance_rgb(-0.5, 0.3), sky.radiance_rgb(0.0, 0.3));
        assert_eq!(sky.relative(0.5, 1.0 + 1e-12), sky.relative(0.5, 1.0));
    }

    proptest! {
        #[test]
        fn no_radiance_is_negative_or_nan(
            elevation in -FRAC_PI_2..FRAC_PI_2, turbidity in 1.0..12.0, albedo in 0.0..=1.0,
            cos_zenith in -1.0..=1.0, cos_gamma in -1.0..=1.0,
        ) {
            let value = Hosek::new(elevation, turbidity, albedo).relative(cos_zenith, cos_gamma);
            prop_assert!(value.is_finite() && value >= 0.0, "{value}");
        }
    }
}
