//! Which of the things that an exposure tells is shown?

use super::Exposure;

/// One of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Sun, sky and surfaces together, kWh/m2.
    Total,
    /// The sun, kWh/m2.
    Beam,
    /// The sky, kWh/m2.
    Sky,
    /// What surfaces send, kWh/m2.
    Reflected,
    /// Sky view factor.
    Svf,
    /// Hours of sun.
    SunHours,
}

impl Quantity {
    /// All of them, in the order of the tables.
    pub const ALL: [Self; 6] = [Self::Total, Self::Beam, Self::Sky, Self::Reflected, Self::Svf, Self::SunHours];

    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Total => "total",
            Self::Beam => "beam",
            Self::Sky => "sky",
            Self::Reflected => "reflected",
            Self::Svf => "svf",
            Self::SunHours => "sun_h",
        }
    }

    /// Its name in files, with its unit.
    pub const fn with_unit(self) -> &'static str {
        match self {
            Self::Total => "total_kwh_m2",
            Self::Beam => "beam_kwh_m2",
            Self::Sky => "sky_kwh_m2",
            Self::Reflected => "reflected_kwh_m2",
            Self::Svf => "svf",
            Self::SunHours => "sun_h",
        }
    }

    /// What it is, for the title of a picture.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Total => "exposure to sun and sky",
            Self::Beam => "exposure to the sun",
            Self::Sky => "exposure to the sky",
            Self::Reflected => "exposure to what surfaces reflect",
            Self::Svf => "sky view factor",
            Self::SunHours => "hours of sun",
        }
    }

    /// Its unit, for the legend of a picture.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Svf => "share",
            Self::SunHours => "h",
            Self::Total | Self::Beam | Self::Sky | Self::Reflected => "kWh/m²",
        }
    }

    /// The quantity of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// Its value.
    pub fn of(self, exposure: &Exposure) -> f64 {
        match self {
            Self::Total => exposure.total_kwh_m2(),
            Self::Beam => exposure.beam_kwh_m2,
            Self::Sky => exposure.sky_kwh_m2,
            Self::Reflected => exposure.reflected_kwh_m2,
            Self::Svf => exposure.svf,
            Self::SunHours => exposure.sun_h,
        }
    }
}

impl std::fmt::Display for Quantity {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str(self.name())
    }
}
