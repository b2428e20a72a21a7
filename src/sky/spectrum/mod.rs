//! What does the sun bring through a clear atmosphere, by wavelength: as a beam, and scattered?
//!
//! The beam by the transmittances that Preetham, Shirley and Smits ("A practical analytic model for daylight", SIGGRAPH 1999,
//! appendix 1) take from Leckner and Iqbal: air, aerosol by turbidity, ozone, water vapour, mixed gases. The scattered light
//! on the horizontal by Bird and Riordan (SPCTRAL2, their equations 3-1 to 3-17), their rural aerosol. Table 0.3 to 4 um.
//!
//! Against SPCTRAL2 with the same aerosol: the beam within 0.2% from 30 degrees of elevation up, 0.6% at 10, 1.8% at 3, the
//! diffuse within 0.4%, 0.5% and 4.6%, for SPCTRAL2 gives ozone a path of its own and another fit of the air. Turbidity is the ratio of the whole atmosphere's
//! optical depth to that of clean air, in visible light (1.9 very clear, 10 haze), as in the sky models; it is not Linke's.
//! Water, ozone and pressure are inputs; the altitude's effect on aerosol is not known here.

mod observer;
mod table;

pub use table::{ROWS, TABLE};

use super::clear::kasten_air_mass;
use super::within;
use std::f64::consts::FRAC_PI_2;
use std::fmt;

/// Bands of the spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Band {
    /// 0.3 to 4 um: 98% of the sun's energy.
    Broadband,
    /// 400 to 700 nm.
    Visible,
    /// 320 to 400 nm: what reaches the ground below 320 nm is 0.1% of the energy, and no sky model here knows it.
    Ultraviolet,
    /// 700 nm to 4 um.
    Infrared,
}

impl Band {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Broadband, Self::Visible, Self::Ultraviolet, Self::Infrared];

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Broadband => "broadband",
            Self::Visible => "visible",
            Self::Ultraviolet => "ultraviolet",
            Self::Infrared => "infrared",
        }
    }

    /// The band of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|band| band.name() == name)
    }

    /// From and to, um.
    pub fn limits_um(self) -> (f64, f64) {
        match self {
            Self::Broadband => (0.3, 4.0),
            Self::Visible => (0.4, 0.7),
            Self::Ultraviolet => (0.32, 0.4),
            Self::Infrared => (0.7, 4.0),
        }
    }
}

impl fmt::Display for Band {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}

/// What the light passes and meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atmosphere {
    /// Turbidity of the sky models, clamped to 1 to 12.
    pub turbidity: f64,
    /// Ozone, cm at standard pressure.
    pub ozone_cm: f64,
    /// Water vapour, cm if all rained down.
    pub water_cm: f64,
    /// Air pressure as a share of that at the sea.
    pub pressure_share: f64,
    /// Share of light that the ground sends back to the sky, clamped to 0 to 1.
    pub ground_albedo: f64,
}

impl Atmosphere {
    /// Preetham's: 0.35 cm of ozone and 2 cm of water at the sea, over ground of albedo 0.2.
    pub fn new(turbidity: f64) -> Self {
        Self { turbidity, ozone_cm: 0.35, water_cm: 2.0, pressure_share: 1.0, ground_albedo: 0.2 }
    }
}

/// Irradiance by the wavelengths of [`TABLE`], W/(m2 um).
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Of the beam, on a plane that faces the sun.
    pub beam_w_m2_um: [f64; ROWS],
    /// Scattered, on the horizontal.
    pub diffuse_w_m2_um: [f64; ROWS],
}

impl Spectrum {
    /// Under a clear sky with the sun's centre at `sun_elevation_rad`; zero below the horizon. `eccentricity` is E0, the
    /// square of the mean distance of the sun over today's. About 30 us.
    pub fn clear(sun_elevation_rad: f64, eccentricity: f64, atmosphere: &Atmosphere) -> Self {
        let mut spectrum = Self { beam_w_m2_um: [0.0; ROWS], diffuse_w_m2_um: [0.0; ROWS] };
        if sun_elevation_rad < 0.0 || sun_elevation_rad.is_nan() {
            return spectrum;
        }
        let cos_zenith = sun_elevation_rad.sin().max(0.0);
        let air_mass = kasten_air_mass((FRAC_PI_2 - sun_elevation_rad).max(0.0));

        let lit = spectrum.beam_w_m2_um.iter_mut().zip(&mut spectrum.diffuse_w_m2_um).zip(&TABLE);
        for ((beam, diffuse), row) in lit {
            let extraterrestrial = eccentricity.max(0.0) * row[1];
            let passed = Passed::new(row, air_mass, atmosphere);
            *beam = extraterrestrial * passed.all();
            *diffuse = extraterrestrial * scattered(row, &passed, cos_zenith, atmosphere);
        }
        spectrum
    }

    /// The beam's irradiance within a band, W/m2, facing the sun. Broadband stands for DNI.
    pub fn beam_w_m2(&self, band: Band) -> f64 {
        integral(&self.beam_w_m2_um, band.limits_um())
    }

    /// The scattered irradiance within a band, W/m2, on the horizontal. Broadband stands for DHI.
    pub fn diffuse_w_m2(&self, band: Band) -> f64 {
        integral(&self.diffuse_w_m2_um, band.limits_um())
    }

    /// The beam's CIE XYZ facing the sun, kilolux (Y is the illuminance).
    pub fn beam_xyz_klx(&self) -> [f64; 3] {
        observer::xyz_klx(&self.beam_w_m2_um)
    }

    /// The scattered light's CIE XYZ on the horizontal, kilolux.
    pub fn diffuse_xyz_klx(&self) -> [f64; 3] {
        observer::xyz_klx(&self.diffuse_w_m2_um)
    }
}

/// Shares of light that pass each constituent.
struct Passed {
    air: f64,
    aerosol: f64,
    /// The aerosol as if it scattered alone, and as if it absorbed alone.
    aerosol_scattering: f64,
    aerosol_absorbing: f64,
    ozone: f64,
    water: f64,
    gases: f64,
}

impl Passed {
    fn new(row: &[f64; 5], air_mass: f64, atmosphere: &Atmosphere) -> Self {
        let &[wavelength_um, _, water, ozone, gases] = row;
        let pressed_mass = air_mass * atmosphere.pressure_share.max(0.0);
        let turbidity = within(atmosphere.turbidity, (1.0, 12.0));
        // Preetham's fit of Angstrom's coefficient to turbidity.
        let aerosol_depth = (0.046_08 * turbidity - 0.045_86) * wavelength_um.powf(-1.3) * air_mass;
        // Bird and Riordan's equation 3-16, their rural aerosol: the share of its extinction that is scattering.
        let scattering_share = 0.945 * (-0.095 * (wavelength_um / 0.4).ln().powi(2)).exp();
        let absorber =
            |strength: f64, mass: f64, width: f64| (-strength * mass / (1.0 + width * mass).powf(0.45)).exp();

        Self {
            air: (-0.008_735 * pressed_mass * wavelength_um.powf(-4.08)).exp(),
            aerosol: (-aerosol_depth).exp(),
            aerosol_scattering: (-aerosol_depth * scattering_share).exp(),
            aerosol_absorbing: (-aerosol_depth * (1.0 - scattering_share)).exp(),
            ozone: (-ozone * atmosphere.ozone_cm.max(0.0) * air_mass).exp(),
            water: absorber(0.2385, water * atmosphere.water_cm.max(0.0) * air_mass, 20.07),
            gases: absorber(1.41, gases * pressed_mass, 118.93),
        }
    }

    fn all(&self) -> f64 {
        self.air * self.aerosol * self.ozone * self.water * self.gases
    }
}

/// Light on the horizontal that air and aerosol scatter, and that the ground sends up and the sky back, as a share of what
/// arrives outside the atmosphere (Bird and Riordan's equations 3-1 to 3-17, in the form of their C program).
fn scattered(row: &[f64; 5], passed: &Passed, cos_zenith: f64, atmosphere: &Atmosphere) -> f64 {
    // Shares of the aerosol's scattering that go forwards: for the sun's path, and for the mean path of diffuse light.
    let forward = forward_share(cos_zenith);
    let forward_diffuse = forward_share(1.0 / DIFFUSE_AIR_MASS);

    let absorbed = cos_zenith * passed.ozone * passed.gases * passed.water * passed.aerosol_absorbing;
    let by_air = absorbed * (1.0 - passed.air.powf(0.95)) * 0.5;
    let by_aerosol = absorbed * passed.air.powf(1.5) * (1.0 - passed.aerosol_scattering) * forward;

    let up = Passed::new(row, DIFFUSE_AIR_MASS, atmosphere);
    let back_by_aerosol = (1.0 - forward_diffuse) * up.air * (1.0 - up.aerosol_scattering);
    let sky_albedo = up.gases * up.water * up.aerosol_absorbing * (0.5 * (1.0 - up.air) + back_by_aerosol);
    let to_and_fro = sky_albedo * within(atmosphere.ground_albedo, (0.0, 1.0));
    let by_ground = (passed.all() * cos_zenith + by_air + by_aerosol) * to_and_fro / (1.0 - to_and_fro);

    // Equation 3-17: more is scattered than once in the blue.
    let manifold = if row[0] <= 0.45 { (row[0] + 0.55).powf(1.8) } else { 1.0 };
    (by_air + by_aerosol + by_ground) * manifold
}

/// Air mass of diffuse light in Bird and Riordan.
const DIFFUSE_AIR_MASS: f64 = 1.8;

/// Share of the aerosol's scattering that goes down (their equations 3-11 to 3-15), for an asymmetry of 0.65.
fn forward_share(cos_zenith: f64) -> f64 {
    let log = (1.0f64 - 0.65).ln();
    let first = log * (1.459 + log * (0.1595 + log * 0.4129));
    let second = log * (0.0783 + log * (-0.3824 - log * 0.5874));
    1.0 - 0.5 * ((first + second * cos_zenith) * cos_zenith).exp()
}

/// The integral of what is linear between the wavelengths of the table, between two limits inside it.
fn integral(values: &[f64; ROWS], (from_um, to_um): (f64, f64)) -> f64 {
    let cells = TABLE.windows(2).zip(values.windows(2));
    cells
        .map(|(rows, values)| {
            let (a, b) = (rows[0][0], rows[1][0]);
            let (low, high) = (a.max(from_um), b.min(to_um));
            let at = |wavelength_um: f64| values[0] + (values[1] - values[0]) * (wavelength_um - a) / (b - a);
            if low < high { 0.5 * (at(low) + at(high)) * (high - low) } else { 0.0 }
        })
        .sum()
}

#[cfg(test)]
mod tests;
