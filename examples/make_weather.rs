//! Makes the weather of `scenes/weather/`, a year that never was, the same bytes on every run.
//!
//!     cargo run --release --example make_weather -- scenes/weather
//!
//! Like the scenes it uses nothing of the library. The place is 48 N, 11 E, 500 m, UTC+1. Each hour is the mean of six
//! moments: the sun by Iqbal's short formula, a clear sky by an air mass and a rule of thumb, and clouds by a random walk of
//! fixed seed that leaves whole days clear and others overcast. The numbers are plausible, not measured: they are there to try
//! the program with and to hold the sky models to others.

use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::PathBuf;

const LATITUDE_DEG: f64 = 48.0;
const LONGITUDE_DEG: f64 = 11.0;
const ZONE_H: f64 = 1.0;
const ALTITUDE_M: f64 = 500.0;

/// Irradiance outside the atmosphere at the mean distance of the sun, W/m2.
const SOLAR_CONSTANT_W_M2: f64 = 1361.0;

/// Share of what the clear air takes from the beam that reaches the ground as diffuse light; the rest is absorbed or goes
/// back to space.
const SCATTERED_DOWN: f64 = 0.3;

/// What is left of a clear sky's light under the thickest clouds.
const OVERCAST: f64 = 0.2;

/// Moments of an hour.
const MOMENTS: usize = 6;

/// Days of the months of a common year.
const MONTHS: [usize; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("scenes/weather"), PathBuf::from);
    let mut text = format!(
        "place Clear and cloudy by examples/make_weather.rs_synthetic\nlatitude {LATITUDE_DEG}\nlongitude {}\ntime_zone {}\n\
         site_elevation {ALTITUDE_M}\nweather_data_file_units 1\n",
        -LONGITUDE_DEG,
        -15.0 * ZONE_H
    );
    let mut clouds = Clouds::new();
    let mut day_of_year = 0;
    for (month, days) in MONTHS.into_iter().enumerate() {
        for day in 1..=days {
            day_of_year += 1;
            for hour in 0..24 {
                let cover = clouds.next_hour(hour);
                let (direct, diffuse) = hour_mean(day_of_year, hour, cover);
                writeln!(text, "{} {day} {hour}.5 {direct:.0} {diffuse:.0}", month + 1)?;
            }
        }
    }
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("clear_and_cloudy.wea"), text)?;
    Ok(())
}

/// Mean direct normal and diffuse horizontal irradiance of an hour under a cover of clouds (0 to 1), W/m2.
fn hour_mean(day_of_year: usize, hour: usize, cover: f64) -> (f64, f64) {
    let mut sum = (0.0, 0.0);
    for moment in 0..MOMENTS {
        let hours = hour as f64 + (moment as f64 + 0.5) / MOMENTS as f64;
        let (direct, diffuse) = irradiance(day_of_year as f64, hours, cover);
        sum = (sum.0 + direct, sum.1 + diffuse);
    }
    (sum.0 / MOMENTS as f64, sum.1 / MOMENTS as f64)
}

/// Direct normal and diffuse horizontal irradiance of a moment, W/m2.
fn irradiance(day_of_year: f64, hours: f64, cover: f64) -> (f64, f64) {
    let up = sin_elevation(day_of_year, hours);
    if up <= 0.0 {
        return (0.0, 0.0);
    }
    // Clear air: the beam by its way through it, and a share of what it lost.
    let outside = SOLAR_CONSTANT_W_M2 * (1.0 + 0.033 * (2.0 * PI * day_of_year / 365.0).cos());
    let air_mass = 1.0 / (up + 0.15 * (up.asin().to_degrees() + 3.885).powf(-1.253));
    let beam = outside * 0.7_f64.powf(air_mass.powf(0.678));
    let clear_diffuse = SCATTERED_DOWN * (outside - beam) * up;

    // Clouds take the beam first and give most of it back as diffuse light; thick ones take that too.
    let through = (1.0 - cover).powi(2);
    let whole = (clear_diffuse + beam * up) * (1.0 - (1.0 - OVERCAST) * cover.powi(3));
    let direct = beam * through;
    (direct, (whole - direct * up).max(0.0))
}

/// Sine of the sun's elevation by Iqbal's formula: local standard time in hours.
fn sin_elevation(day_of_year: f64, hours: f64) -> f64 {
    let wave = |amplitude: f64, turns: f64, zero: f64, length: f64| {
        amplitude * (turns * PI * (day_of_year - zero) / length).sin()
    };
    let solar = hours + wave(0.170, 4.0, 80.0, 373.0) - wave(0.129, 2.0, 8.0, 355.0) + LONGITUDE_DEG / 15.0 - ZONE_H;
    let declination = wave(0.4093, 2.0, 81.0, 368.0);
    let latitude = LATITUDE_DEG.to_radians();
    latitude.sin() * declination.sin() - latitude.cos() * declination.cos() * (PI * solar / 12.0).cos()
}

/// Clouds: the weather of days wanders slowly, that of hours about it.
struct Clouds {
    state: u64,
    days: f64,
    hours: f64,
}

impl Clouds {
    fn new() -> Self {
        Self { state: 1, days: 0.0, hours: 0.0 }
    }

    /// The cover of the next hour, 0 to 1.
    fn next_hour(&mut self, hour: usize) -> f64 {
        // Weather lasts a few days; clouds last a few hours. Both walks have a variance of 1.
        if hour == 0 {
            self.days = 0.7 * self.days + (1.0 - 0.7_f64.powi(2)).sqrt() * self.normal();
        }
        self.hours = 0.8 * self.hours + (1.0 - 0.8_f64.powi(2)).sqrt() * self.normal();
        // Half of the time somewhere between; the ends are clear and overcast.
        (0.5 + 0.7 * self.days + 0.3 * self.hours).clamp(0.0, 1.0)
    }

    /// About normal: the sum of twelve even numbers.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.even()).sum::<f64>() - 6.0
    }

    /// Even from 0 to 1 (SplitMix64).
    fn even(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.state ^ (self.state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
