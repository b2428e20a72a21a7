//! What `sky` tells: as text, and as the JSON object of the contract.

use super::args::SkyArgs;
use crate::sky::Sun;
use crate::sky::events::Day;
use crate::sky::facade::{ShadowAngles, shadow_angles};
use crate::sky::map::{Check, ExposureMap};
use crate::sky::site::Outdoors;
use crate::sky::steps::Steps;
use jiff::civil::DateTime;
use serde::Serialize;
use std::fmt::Write;

/// The report of a run.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Name of the scene or the weather's place.
    pub scene: String,
    latitude_deg: f64,
    longitude_deg: f64,
    utc_offset_h: f64,
    model: &'static str,
    band: &'static str,
    /// Time of steps and map, without files.
    pub seconds: f64,
    /// kWh/m2 over the period.
    ghi: f64,
    dni: f64,
    dhi: f64,
    /// The weather's own global horizontal irradiation, kWh/m2.
    measured_ghi: Option<f64>,
    /// Beam in hours without sun, left out, kWh/m2.
    night_beam: f64,
    /// Diffuse light in hours without sun, kWh/m2.
    twilight: f64,
    steps: usize,
    /// For a single day, local standard time.
    sunrise: Option<String>,
    sunset: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    day: Option<&'static str>,
    /// At `--time`.
    #[serde(skip_serializing_if = "Option::is_none")]
    sun: Option<SunReport>,
    /// Columns and rows.
    map: [usize; 2],
    /// What the texels add up to over what the period brings, less one.
    texels_ghi_off: f64,
    texels_dni_off: f64,
    texels_dhi_off: f64,
    /// Directions in which the full sum was evaluated, and the error found where it was compared.
    check: Check,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct SunReport {
    azimuth_deg: f64,
    elevation_deg: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    horizontal_shadow_angle_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    vertical_shadow_angle_deg: Option<f64>,
}

/// What was found.
pub struct Found<'a> {
    /// Name of the scene or the weather's place.
    pub name: &'a str,
    /// The site.
    pub outdoors: &'a Outdoors,
    /// The period.
    pub steps: &'a Steps,
    /// Its map.
    pub map: &'a ExposureMap,
    /// For a single day, when the sun is up.
    pub day: Option<Day>,
    /// At a single time, where the sun stands.
    pub sun: Option<Sun>,
    /// Seconds of steps and map.
    pub seconds: f64,
    /// What a user should hear.
    pub warnings: Vec<String>,
}

impl Report {
    /// The report of what was found.
    pub fn new(args: &SkyArgs, found: Found) -> Self {
        let Found { outdoors, steps, map, day, .. } = found;
        let (totals, texels) = (map.totals, map.texel_totals());
        let off = |texels: f64, all: f64| if all > 0.0 { texels / all - 1.0 } else { 0.0 };
        let clock = |time: DateTime| time.to_string();
        Self {
            scene: found.name.to_owned(),
            latitude_deg: outdoors.place.latitude_rad.to_degrees(),
            longitude_deg: outdoors.place.longitude_rad.to_degrees(),
            utc_offset_h: outdoors.place.utc_offset_h,
            model: outdoors.model.name(),
            band: outdoors.haze.band.name(),
            seconds: found.seconds,
            ghi: totals.ghi_kwh_m2,
            dni: totals.dni_kwh_m2,
            dhi: totals.dhi_kwh_m2,
            measured_ghi: steps.measured_ghi_kwh_m2,
            night_beam: steps.night_beam_kwh_m2,
            twilight: steps.twilight_kwh_m2,
            steps: steps.steps.len(),
            sunrise: day.and_then(|day| day.sunrise()).map(clock),
            sunset: day.and_then(|day| day.sunset()).map(clock),
            day: day.map(|day| match day {
                Day::Normal { .. } => "normal",
                Day::OnlyRises { .. } => "only rises",
                Day::OnlySets { .. } => "only sets",
                Day::AlwaysUp { .. } => "polar day",
                Day::AlwaysDown { .. } => "polar night",
            }),
            sun: found.sun.map(|sun| SunReport::new(sun, args.facade)),
            map: map.size,
            texels_ghi_off: off(texels.ghi_kwh_m2, totals.ghi_kwh_m2),
            texels_dni_off: off(texels.dni_kwh_m2, totals.dni_kwh_m2),
            texels_dhi_off: off(texels.dhi_kwh_m2, totals.dhi_kwh_m2),
            check: map.check,
            warnings: found.warnings,
        }
    }

    /// The report for a reader.
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let mut put = |line: String| _ = writeln!(text, "{line}");
        put(format!(
            "{}: latitude {:.3}, longitude {:.3}, UTC{:+}",
            self.scene, self.latitude_deg, self.longitude_deg, self.utc_offset_h
        ));
        let time = |time: &Option<String>| time.as_deref().map_or("none".to_owned(), |time| time.replace('T', " "));
        if let Some(day) = self.day {
            put(format!("day: {day}; sunrise {}, sunset {}", time(&self.sunrise), time(&self.sunset)));
        }
        if let Some(sun) = &self.sun {
            put(format!("sun: azimuth {:.3}, elevation {:.3} degrees", sun.azimuth_deg, sun.elevation_deg));
            if let Some(horizontal) = sun.horizontal_shadow_angle_deg {
                let vertical = sun
                    .vertical_shadow_angle_deg
                    .map_or("none: it is behind the facade".to_owned(), |angle| format!("{angle:.3}"));
                put(format!("shadow angles: horizontal {horizontal:.3}, vertical {vertical}"));
            }
        }
        put(format!(
            "kWh/m2: global horizontal {:.1}, direct normal {:.1}, diffuse horizontal {:.1}",
            self.ghi, self.dni, self.dhi
        ));
        if let Some(measured) = self.measured_ghi.filter(|measured| *measured > 0.0) {
            let off = 100.0 * (self.ghi / measured - 1.0);
            put(format!("the weather's own global horizontal {measured:.1}: ours is {off:+.2}% from it"));
        }
        if self.twilight > 0.0 {
            put(format!(
                "of the diffuse, {:.3} from hours without sun, with the sun taken on the horizon",
                self.twilight
            ));
        }
        let Check { evaluated, texels, rms, largest } = self.check;
        let [columns, rows] = self.map;
        put(format!("map: {columns} x {rows}, sky {}, {} steps; {:.3} s", self.model, self.steps, self.seconds));
        let directions = format!("{evaluated} directions evaluated for {} texels", columns * rows);
        put(if texels > 0 {
            format!("{directions}; off by {:.3}% rms, {:.3}% at most, at {texels} texels", 100.0 * rms, 100.0 * largest)
        } else {
            directions
        });
        put(format!(
            "texels against the period: global {:+.3}%, direct {:+.3}%, diffuse {:+.3}%",
            100.0 * self.texels_ghi_off,
            100.0 * self.texels_dni_off,
            100.0 * self.texels_dhi_off
        ));
        text
    }
}

impl SunReport {
    fn new(sun: Sun, facade_deg: Option<f64>) -> Self {
        let angles = facade_deg.map(|azimuth| shadow_angles(sun, azimuth.to_radians()));
        let (horizontal, vertical) = match angles {
            Some(ShadowAngles::Front { horizontal_rad, vertical_rad }) => (Some(horizontal_rad), Some(vertical_rad)),
            Some(ShadowAngles::Behind { horizontal_rad }) => (Some(horizontal_rad), None),
            Some(ShadowAngles::Down) | None => (None, None),
        };
        Self {
            azimuth_deg: sun.azimuth_rad.to_degrees(),
            elevation_deg: sun.elevation_rad.to_degrees(),
            horizontal_shadow_angle_deg: horizontal.map(f64::to_degrees),
            vertical_shadow_angle_deg: vertical.map(f64::to_degrees),
        }
    }
}
