//! How strong are sun and sky when no cloud is there?
//!
//! The clear sky of Ineichen & Perez ("A new airmass independent formulation for the Linke turbidity coefficient", Solar
//! Energy 73(3), 2002) with the optical air mass of Kasten & Young (1989) and the pressure of the standard atmosphere.
//! The coefficients are those of the 2002 article; the enhancement of low suns (Perez et al. 2002, `perez_enhancement` in
//! pvlib) is left out. Broadband, within about 5% in the mean where the turbidity is right. It was fitted up to 1600 m; much
//! higher, near 5000 m and with clean air, its global irradiance can come out above what enters the atmosphere.

/// What the sun and the sky give, W/m2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Irradiance {
    /// The beam, on a plane that faces it (direct normal irradiance).
    pub dni_w_m2: f64,
    /// The sky without the sun, on a level plane (diffuse horizontal irradiance).
    pub dhi_w_m2: f64,
}

impl Irradiance {
    /// All that falls on a level plane, W/m2, with the sun at this elevation, radians; at or below the horizon the sky alone.
    pub fn ghi_w_m2(&self, elevation_rad: f64) -> f64 {
        self.dhi_w_m2 + self.dni_w_m2 * elevation_rad.sin().max(0.0)
    }
}

/// The air that the beam crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClearAir {
    /// Linke turbidity at air mass 2: how many clean and dry atmospheres dim the beam as much. 2 is very clear, 3 a usual
    /// clear day, 5 hazy. At least 1: less counts as 1.
    pub linke_turbidity: f64,
    /// Height above the sea, metres.
    pub altitude_m: f64,
}

/// Beam and diffuse irradiance of a clear sky.
///
/// `elevation_rad` is the apparent elevation of the sun (with refraction), `extraterrestrial_w_m2` the beam outside the air
/// ([`super::sun::extraterrestrial_w_m2`]). A sun at or below the horizon gives nothing. About 60 nanoseconds.
pub fn irradiance(elevation_rad: f64, extraterrestrial_w_m2: f64, air: ClearAir) -> Irradiance {
    if elevation_rad.is_nan() || elevation_rad <= 0.0 {
        return Irradiance::default();
    }
    let sin_elevation = elevation_rad.sin();
    let ClearAir { altitude_m, .. } = air;
    let turbidity = air.linke_turbidity.max(1.0);
    let air_mass = relative_air_mass(elevation_rad) * relative_pressure(altitude_m);

    // How the clean air (fh1) and the aerosol (fh2) thin out with height.
    let fh1 = (-altitude_m / 8000.0).exp();
    let fh2 = (-altitude_m / 1250.0).exp();
    let cg1 = 5.09e-5 * altitude_m + 0.868;
    let cg2 = 3.92e-5 * altitude_m + 0.0387;
    let transmitted = (-cg2 * air_mass * (fh1 + fh2 * (turbidity - 1.0))).exp();
    let ghi_w_m2 = cg1 * extraterrestrial_w_m2 * sin_elevation * transmitted;

    // The beam by its own formula, and no more than leaves the sky its least share of the global irradiance.
    let beam_w_m2 = extraterrestrial_w_m2 * (0.664 + 0.163 / fh1) * (-0.09 * air_mass * (turbidity - 1.0)).exp();
    let least_diffuse_share = (0.1 - 0.2 * (-turbidity).exp()) / (0.1 + 0.882 / fh1);
    let most_w_m2 = ghi_w_m2 * (1.0 - least_diffuse_share) / sin_elevation;
    let dni_w_m2 = beam_w_m2.min(most_w_m2);
    Irradiance { dni_w_m2, dhi_w_m2: (ghi_w_m2 - dni_w_m2 * sin_elevation).max(0.0) }
}

/// How many times the air straight above the beam crosses, by its apparent elevation from 0 up (Kasten & Young 1989).
pub fn relative_air_mass(elevation_rad: f64) -> f64 {
    1.0 / (elevation_rad.sin() + 0.505_72 * (6.079_95 + elevation_rad.to_degrees()).powf(-1.6364))
}

/// The same by Kasten's older fit (1966), with which Perez' sky and the published transmittances were made, by the zenith
/// angle of a sun at or above the horizon: 1 overhead, 36.5 on the horizon.
pub fn kasten_air_mass(zenith_rad: f64) -> f64 {
    1.0 / (zenith_rad.cos() + 0.15 * (93.885 - zenith_rad.to_degrees()).powf(-1.253))
}

/// The pressure of the standard atmosphere at a height, metres, as a share of 1013.25 hPa.
pub fn relative_pressure(altitude_m: f64) -> f64 {
    // The polytropic atmosphere of constant lapse rate, 6.5 K a km; its top is at 44 km.
    ((44_331.514 - altitude_m).max(0.0) / 11_880.516).powf(1.0 / 0.190_263_2) / 1013.25
}
