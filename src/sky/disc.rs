//! How is the sun's beam spread over the sun's disc?
//!
//! A disc of the sun's nominal radius (695 700 km, IAU 2015 resolution B3) at the day's distance, darkened to its limb by
//! 0.3 + 0.93 mu - 0.23 mu2 (550 nm, Cox, "Allen's Astrophysical Quantities", 4th edition, 2000, section 14.7), mu being the
//! cosine at the sun's surface. Light of all wavelengths follows 0.4 + 0.6 mu (Eddington), whose mean over the disc is 0.800
//! of the centre against 0.805 here. Atmospheric flattening near the horizon is left out.

/// The sun's radius over the mean distance.
const RADIUS_OVER_DISTANCE: f64 = 695_700.0 / 149_597_870.7;

/// Brightness by powers of mu, 0 to 2; 1 at the centre.
const LIMB: [f64; 3] = [0.3, 0.93, -0.23];

/// The sun's disc on one day.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// From centre to limb, radians: 0.266 degrees at the mean distance.
    pub angular_radius_rad: f64,
}

impl Disc {
    /// The disc on a day of eccentricity E0, the square of the mean distance of the sun over today's (0.967 to 1.035).
    pub fn new(eccentricity: f64) -> Self {
        Self { angular_radius_rad: (RADIUS_OVER_DISTANCE * eccentricity.max(0.0).sqrt()).asin() }
    }

    /// Solid angle of the disc, steradians: 6.8e-5.
    pub fn solid_angle_sr(&self) -> f64 {
        2.0 * std::f64::consts::PI * one_minus_cos(self.angular_radius_rad)
    }

    /// Share of the beam that comes from one steradian at an angle from the disc's centre: radiance is DNI times this.
    /// 0 outside; its integral over the disc is 1.
    pub fn radiance_share_per_sr(&self, angle_from_centre_rad: f64) -> f64 {
        // The share of the disc's solid angle that is nearer to the centre. It differs from the square of the distance from
        // the centre in radii by 1e-5, and makes the mean over the disc exact.
        let inside = one_minus_cos(angle_from_centre_rad) / one_minus_cos(self.angular_radius_rad);
        if inside > 1.0 || inside.is_nan() {
            return 0.0;
        }
        let mu = (1.0 - inside).sqrt();
        let mean = LIMB[0] + LIMB[1] * 2.0 / 3.0 + LIMB[2] / 2.0;
        (LIMB[0] + mu * (LIMB[1] + mu * LIMB[2])) / (mean * self.solid_angle_sr())
    }
}

/// 1 - cos, exact at small angles.
fn one_minus_cos(angle_rad: f64) -> f64 {
    2.0 * (0.5 * angle_rad).sin().powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disc_has_the_known_size() {
        // 31'59" at the mean distance (959.23" radius); 6.80e-5 sr.
        let disc = Disc::new(1.0);
        assert!((disc.angular_radius_rad.to_degrees() * 3600.0 - 959.23).abs() < 0.05);
        assert!((disc.solid_angle_sr() - 6.794e-5).abs() < 1e-8);
        // Perihelion: 0.98328 of the mean distance.
        assert!((Disc::new(0.98328f64.powi(-2)).angular_radius_rad.to_degrees() * 3600.0 - 975.54).abs() < 0.05);
    }

    #[test]
    fn the_whole_beam_comes_from_the_disc() {
        for eccentricity in [0.967, 1.0, 1.035] {
            let disc = Disc::new(eccentricity);
            let rings = 20_000;
            let width = disc.angular_radius_rad / f64::from(rings);
            let sum: f64 = (0..rings)
                .map(|ring| (f64::from(ring) + 0.5) * width)
                .map(|angle| disc.radiance_share_per_sr(angle) * std::f64::consts::TAU * angle.sin() * width)
                .sum();
            assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        }
    }

    #[test]
    fn the_limb_is_dark_and_nothing_is_outside() {
        let disc = Disc::new(1.0);
        let centre = disc.radiance_share_per_sr(0.0);
        let limb = disc.radiance_share_per_sr(disc.angular_radius_rad * (1.0 - 1e-12));
        assert!((limb / centre - 0.3).abs() < 1e-3, "{limb} {centre}");
        assert_eq!(disc.radiance_share_per_sr(disc.angular_radius_rad * 1.0001), 0.0);
        assert_eq!(disc.radiance_share_per_sr(f64::NAN), 0.0);
    }
}
