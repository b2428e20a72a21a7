//! Which colour is each direction of a clear sky? Preetham, Shirley and Smits ("A practical analytic model for daylight",
//! SIGGRAPH 1999): Perez' form in CIE Y, x and y, to XYZ and to linear sRGB.
//!
//! Where the model breaks, it is held: turbidity within 2 to 10 (below, 1 + A exp(B) runs through 0 at 1.643 and the horizon
//! blows up from 1.203 down; above, the zenith turns black at 11.2), no negative luminance, no colour outside sRGB. The paper knows
//! no night: below the horizon the sky keeps the colours of sunset and dims as twilight does on the ground (Janiczek and
//! DeYoung, USNO circular 171, 1987), to nothing from 18 degrees below. Its levels are known to be too bright with the sun
//! low (Zotti, Wilkie and Purgathofer, "A critical review of the Preetham skylight model", 2007); it serves for pictures.

use super::hosek::LUMINANCE_REC709;
use super::within;
use std::f64::consts::{FRAC_PI_2, PI};

/// Turbidities at which the model holds.
const TURBIDITY: (f64, f64) = (2.0, 10.0);

/// A to E of Perez' form for Y, x and y, each as slope and level over turbidity.
const PEREZ: [[[f64; 2]; 5]; 3] = [
    [[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]],
    [[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]],
    [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]],
];

/// x and y of the zenith: rows by powers 2, 1, 0 of turbidity, columns by powers 3 to 0 of the sun's zenith angle.
const ZENITH_XY: [[[f64; 4]; 3]; 2] = [
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]],
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]],
];

/// XYZ to linear sRGB (IEC 61966-2-1).
pub const RGB_OF_XYZ: [[f64; 3]; 3] =
    [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];

/// The sky of one sun and turbidity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preetham {
    /// Y (kcd/m2), x and y at the zenith.
    pub zenith: [f64; 3],
    /// A to E for Y, x and y.
    pub perez: [[f64; 5]; 3],
    /// Perez' form at the zenith: Y, x and y of a direction are those of the zenith by its form over this.
    pub at_zenith: [f64; 3],
}

impl Preetham {
    /// The sky with the sun at `sun_elevation_rad`, which may be below the horizon; `turbidity` is clamped to 2 to 10. NaN
    /// counts as the horizon and as 2.
    pub fn new(sun_elevation_rad: f64, turbidity: f64) -> Self {
        let turbidity = within(turbidity, TURBIDITY);
        let elevation = within(sun_elevation_rad, (0.0, FRAC_PI_2));
        let sun_zenith_rad = FRAC_PI_2 - elevation;

        let [luminance, x, y] = zenith(turbidity, sun_zenith_rad);
        let perez = PEREZ.map(|channel| channel.map(|[slope, level]| slope * turbidity + level));
        let at_zenith = perez.map(|channel| form(channel, 1.0, sun_zenith_rad, sun_zenith_rad.cos()));
        Self { zenith: [luminance.max(0.0) * twilight(sun_elevation_rad), x, y], perez, at_zenith }
    }

    /// CIE Y (kcd/m2), x and y towards a direction, by its cosines to the zenith (0 used below the horizon) and to the sun.
    pub fn luminance_xy(&self, cos_zenith: f64, cos_gamma: f64) -> [f64; 3] {
        let cos_gamma = within(cos_gamma, (-1.0, 1.0));
        let gamma_rad = cos_gamma.acos();
        std::array::from_fn(|channel| {
            let here = form(self.perez[channel], cos_zenith, gamma_rad, cos_gamma);
            (self.zenith[channel] * here / self.at_zenith[channel]).max(0.0)
        })
    }

    /// Linear sRGB towards a direction, its luminance in kcd/m2. Negative channels, colours outside sRGB, are cut to 0.
    /// Never NaN. About 0.1 us.
    pub fn rgb(&self, cos_zenith: f64, cos_gamma: f64) -> [f64; 3] {
        linear_srgb(xyz(self.luminance_xy(cos_zenith, cos_gamma))).map(|value| value.max(0.0))
    }
}

/// Preetham's zenith: Y (kcd/m2), x and y, by turbidity and the sun's zenith angle in radians; as printed, nothing clamped.
pub fn zenith(turbidity: f64, sun_zenith_rad: f64) -> [f64; 3] {
    let chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * sun_zenith_rad);
    let luminance = (4.0453 * turbidity - 4.9710) * chi.tan() - 0.2155 * turbidity + 2.4192;

    let over = |by_power: &[f64], value: f64| by_power.iter().fold(0.0, |sum, coefficient| sum * value + coefficient);
    let [x, y] = ZENITH_XY.map(|rows| over(&rows.map(|row| over(&row, sun_zenith_rad)), turbidity));
    [luminance, x, y]
}

/// Perez' form: (1 + A exp(B / cos zenith)) (1 + C exp(D gamma) + E cos2 gamma).
fn form([a, b, c, d, e]: [f64; 5], cos_zenith: f64, gamma_rad: f64, cos_gamma: f64) -> f64 {
    // B is negative at the turbidities allowed: at the horizon the exponential is 0.
    let cos_zenith = cos_zenith.max(1e-6);
    (1.0 + a * (b / cos_zenith).exp()) * (1.0 + c * (d * gamma_rad).exp() + e * cos_gamma * cos_gamma)
}

/// Light of a sky whose sun is below the horizon, as a share of that with the sun on it; 1 above, 0 from -18 degrees down.
fn twilight(sun_elevation_rad: f64) -> f64 {
    // Decimal logarithm of the illuminance in lux by the elevation over 90 degrees, and the lowest degree of each line.
    const LINES: [(f64, [f64; 4]); 3] = [
        (-5.0, [2.88, 21.81, -258.11, -858.36]),
        (-12.0, [2.70, 12.17, -431.69, -1899.83]),
        (-18.0, [13.84, 262.72, 1447.42, 2797.93]),
    ];
    if sun_elevation_rad >= 0.0 || sun_elevation_rad.is_nan() {
        return 1.0;
    }
    let degrees = sun_elevation_rad.to_degrees();
    let x = degrees / 90.0;
    let line = LINES.iter().find(|(lowest, _)| degrees > *lowest);
    line.map_or(0.0, |(_, [a, b, c, d])| 10f64.powf((b + (c + d * x) * x) * x + a - LINES[0].1[0]).min(1.0))
}

/// CIE XYZ of Y, x and y; black where y is 0.
pub fn xyz([luminance, x, y]: [f64; 3]) -> [f64; 3] {
    if y > 0.0 { [x * luminance / y, luminance, (1.0 - x - y) * luminance / y] } else { [0.0; 3] }
}

/// Linear sRGB of CIE XYZ; negative for colours outside sRGB.
pub fn linear_srgb(xyz: [f64; 3]) -> [f64; 3] {
    RGB_OF_XYZ.map(|row| row.iter().zip(xyz).map(|(share, value)| share * value).sum())
}

/// Luminance of linear sRGB.
pub fn luminance(rgb: [f64; 3]) -> f64 {
    rgb.iter().zip(LUMINANCE_REC709).map(|(value, share)| value * share).sum()
}

/// The sRGB code (0 to 1) of a linear value, cut to 0 to 1; NaN is 0.
pub fn srgb_code(linear: f64) -> f64 {
    let linear = within(linear, (0.0, 1.0));
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The tone mapping of a linear colour for a screen, in sRGB's code: luminance Y becomes 1 - exp(-Y / `white`), so that what
/// is as bright as `white` takes 63%; the colour stays, mixed with grey as far as a screen needs it. Black without light or
/// white.
pub fn tone_mapped(rgb: [f64; 3], white: f64) -> [u8; 3] {
    let seen = luminance(rgb);
    if seen <= 0.0 || white <= 0.0 {
        return [0; 3];
    }
    let grey = 1.0 - (-seen / white).exp();
    let mapped = rgb.map(|value| value * grey / seen);

    // Towards grey until the strongest channel fits.
    let strongest = mapped.iter().copied().fold(grey, f64::max);
    let colour = if strongest > 1.0 { (1.0 - grey) / (strongest - grey) } else { 1.0 };
    mapped.map(|value| (255.0 * srgb_code(grey + (value - grey) * colour)).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(value: f64, want: f64) {
        assert!((value - want).abs() < 1e-9 * want.abs().max(1.0), "{value} {want}");
    }

    /// By Python from the printed formulas: zen(2, 0), zen(3, 0.8), zen(6, 1.2), zen(10, pi/2).
    #[test]
    fn the_zenith_is_as_printed() {
        for (turbidity, sun, want) in [
            (2.0, 0.0, [15.500672137416844, 0.26674, 0.2772]),
            (3.0, 0.8, [7.1812888061261, 0.24540735999999996, 0.25123808000000003]),
            (6.0, 1.2, [6.938753725363177, 0.2705556799999999, 0.2886489600000001]),
            (10.0, FRAC_PI_2, [0.2642000000000002, 0.3152834415941268, 0.3441721526329403]),
        ] {
            for (value, want) in zenith(turbidity, sun).into_iter().zip(want) {
                close(value, want);
            }
        }
    }

    /// By the same Python: turbidity 3, sun at zenith angle 0.8, view at 1.2, 0.5 from the sun.
    #[test]
    fn a_direction_is_as_printed() {
        let sky = Preetham::new(FRAC_PI_2 - 0.8, 3.0);
        let want = [17.163088316589604, 0.28168232505106044, 0.2910478074879029];
        for (value, want) in sky.luminance_xy(1.2f64.cos(), 0.5f64.cos()).into_iter().zip(want) {
            close(value, want);
        }
    }

    #[test]
    fn the_zenith_is_the_zenith() {
        for (elevation, turbidity) in [(0.1, 2.0), (0.7, 4.5), (1.5, 9.0), (-0.1, 3.0)] {
            let sky = Preetham::new(elevation, turbidity);
            let seen = sky.luminance_xy(1.0, f64::max(elevation, 0.0).sin());
            for (value, want) in seen.into_iter().zip(sky.zenith) {
                close(value, want);
            }
        }
    }

    #[test]
    fn white_is_white() {
        // D65: x 0.3127, y 0.3290.
        for value in linear_srgb(xyz([1.0, 0.3127, 0.3290])) {
            assert!((value - 1.0).abs() < 2e-3, "{value}");
        }
        assert_eq!((srgb_code(0.0), srgb_code(-1.0), srgb_code(f64::NAN)), (0.0, 0.0, 0.0));
        close(srgb_code(2.0), 1.0);
        // 18% grey is code 118 of 255.
        assert_eq!((srgb_code(0.18) * 255.0).round(), 118.0);
    }

    /// 759, 3.4 and 0.0083 lux at 0, -6 and -12 degrees, of the circular's tables (795, 3.4, 0.008 are usual figures).
    #[test]
    fn twilight_dims_as_measured() {
        assert_eq!(twilight(0.1), 1.0);
        assert!((twilight(-6f64.to_radians()) * 758.6 - 3.41).abs() < 0.05);
        assert!((twilight(-12f64.to_radians() + 1e-9) * 758.6 - 0.0083).abs() < 0.0005);
        assert_eq!(twilight(-18.1f64.to_radians()), 0.0);
        let mut last = 1.0;
        for step in 0..200 {
            let now = twilight(-f64::from(step).to_radians() / 10.0);
            assert!(now <= last * 1.05, "{step}: {last} {now}");
            last = now;
        }
    }

    proptest! {
        #[test]
        fn no_colour_is_negative_or_nan(
            turbidity in 1.0..12.0, elevation_deg in -90.0..=90.0f64, cos_zenith in -1.0..=1.0, cos_gamma in -1.0..=1.0,
        ) {
            let sky = Preetham::new(elevation_deg.to_radians(), turbidity);
            for (cos_zenith, cos_gamma) in [(cos_zenith, cos_gamma), (0.0, cos_gamma), (1.0, 1.0), (0.0, 1.0)] {
                for value in sky.rgb(cos_zenith, cos_gamma) {
                    // Brighter than 1000 kcd/m2 would be a blow-up: the brightest sky beside the sun is some hundred.
                    prop_assert!(value.is_finite() && (0.0..1000.0).contains(&value), "{value}");
                }
            }
        }
    }
}
