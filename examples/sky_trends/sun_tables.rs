//! Tables of the sun: the simple formula against SPA, published sunrises against both, costs.

use crate::sun_charts::{YEAR, days, johor_bahru, late_min};
use jiff::civil::{DateTime, date};
use lightvein::sky::clear::{self, ClearAir};
use lightvein::sky::sun::{self, Air, SunError};
use lightvein::sky::{Place, events, simple_sun};
use std::time::Instant;

const LATITUDES_DEG: [f64; 9] = [-60.0, -30.0, 0.0, 15.0, 30.0, 45.0, 55.0, 63.0, 75.0];

/// Sunrise and sunset on the first of each month as printed by Kolivand & Sunar (2012), minutes after midnight.
const PRINTED: [[i32; 4]; 12] = [
    [7, 7, 19, 10],
    [7, 17, 19, 20],
    [7, 15, 19, 20],
    [7, 5, 19, 13],
    [6, 57, 19, 7],
    [6, 57, 19, 9],
    [7, 2, 19, 15],
    [7, 6, 19, 17],
    [7, 1, 19, 10],
    [6, 52, 18, 58],
    [6, 47, 18, 50],
    [6, 53, 18, 55],
];

/// Prints all of them.
pub fn print() -> Result<(), SunError> {
    print_positions()?;
    print_sunrises()?;
    print_printed()?;
    print_costs()
}

/// The simple formula's error in degrees of arc.
fn print_positions() -> Result<(), SunError> {
    println!("Position by the simple formula against SPA without refraction, degrees of arc, every hour of {YEAR}:\n");
    println!("| latitude | mean | max | mean, sun up | max, sun up |");
    println!("|---:|---:|---:|---:|---:|");
    for latitude_deg in LATITUDES_DEG {
        let place = Place::from_degrees(latitude_deg, 0.0, 0.0);
        let (mut all, mut up) = (Vec::new(), Vec::new());
        for day in days() {
            for hour in 0..24 {
                let time = day.at(hour, 0, 0, 0);
                let exact = sun::position(&place, time, None)?;
                let off_deg = exact.towards().angle_between(simple_sun::position(&place, time)?.towards()).to_degrees();
                all.push(off_deg);
                if exact.elevation_rad > 0.0 {
                    up.push(off_deg);
                }
            }
        }
        println!("| {latitude_deg} | {:.2} | {:.2} | {:.2} | {:.2} |", mean(&all), most(&all), mean(&up), most(&up));
    }
    Ok(())
}

/// The simple formula's error of sunrise and sunset in minutes.
fn print_sunrises() -> Result<(), SunError> {
    println!("\nSunrise and sunset by the simple formula against SPA, minutes, every day of {YEAR}:\n");
    println!(
        "| latitude | sunrise, mean | sunrise, max | sunset, mean | sunset, max | days on which only one of them has both |"
    );
    println!("|---:|---:|---:|---:|---:|---:|");
    for latitude_deg in LATITUDES_DEG {
        let place = Place::from_degrees(latitude_deg, 0.0, 0.0);
        let mut off_min = [Vec::new(), Vec::new()];
        let mut differ = 0;
        for day in days() {
            let has_both = |day: events::Day| matches!(day, events::Day::Normal { .. });
            differ += usize::from(has_both(events::day(&place, day)?) != has_both(simple_sun::day(&place, day)?));
            for (off_min, late_min) in off_min.iter_mut().zip(late_min(&place, day)?) {
                off_min.extend(Some(late_min.abs()).filter(|late| late.is_finite()));
            }
        }
        let [rise, set] = off_min;
        let figures = [mean(&rise), most(&rise), mean(&set), most(&set)].map(|minutes| format!("{minutes:.1}"));
        println!("| {latitude_deg} | {} | {differ} |", figures.join(" | "));
    }
    Ok(())
}

/// The paper's printed minutes against ours: where they belong, and at the place that it cites.
fn print_printed() -> Result<(), SunError> {
    println!("\nSunrise/sunset as printed (Kolivand & Sunar 2012), and minutes by which ours are later, {YEAR}:\n");
    println!("| date | printed | SPA | simple formula | simple formula at Alor Setar |");
    println!("|---|---|---|---|---|");
    let alor_setar = Place::from_degrees(6.12, 100.37, 8.0);
    let mut worst_min = [0.0_f64; 3];
    for (month, printed) in (1..).zip(PRINTED) {
        let day = date(YEAR, month, 1);
        let found = [
            events::day(&johor_bahru(), day)?,
            simple_sun::day(&johor_bahru(), day)?,
            simple_sun::day(&alor_setar, day)?,
        ];
        let [rise_h, rise_min, set_h, set_min] = printed;
        let off = found.map(|found| {
            [
                found.sunrise().map_or(f64::NAN, |time| minutes(time) - f64::from(60 * rise_h + rise_min)),
                found.sunset().map_or(f64::NAN, |time| minutes(time) - f64::from(60 * set_h + set_min)),
            ]
        });
        for (worst_min, off) in worst_min.iter_mut().zip(off) {
            *worst_min = off.iter().fold(*worst_min, |worst, off| worst.max(off.abs()));
        }
        let off = off.map(|[rise, set]| format!("{rise:+.1} / {set:+.1}"));
        println!("| 1-{month} | {rise_h:02}:{rise_min:02} / {set_h:02}:{set_min:02} | {} |", off.join(" | "));
    }
    let worst = worst_min.map(|minutes| format!("{minutes:.1}"));
    println!("| worst | | {} |", worst.join(" | "));
    Ok(())
}

/// What a call costs here, single-threaded.
fn print_costs() -> Result<(), SunError> {
    println!("\nCosts on this machine, one thread:\n");
    println!("| call | microseconds |");
    println!("|---|---:|");
    let place = johor_bahru();
    let times: Vec<DateTime> = days().flat_map(|day| (0..24).map(move |hour| day.at(hour, 0, 0, 0))).collect();
    let air = ClearAir { linke_turbidity: 3.0, altitude_m: 0.0 };
    cost("sun::position", &times, |time| Ok(sun::position(&place, time, Some(Air::STANDARD))?.elevation_rad))?;
    cost("simple_sun::position", &times, |time| Ok(simple_sun::position(&place, time)?.elevation_rad))?;
    cost("events::day", &times[..1000], |time| Ok(minutes(events::day(&place, time.date())?.transit())))?;
    cost(
        "events::crossings",
        &times[..1000],
        |time| Ok(events::crossings(&place, time.date())?.sunrises.len() as f64),
    )?;
    cost("clear::irradiance", &times, |time| {
        let elevation_rad = 0.01 + 0.05 * f64::from(time.hour());
        Ok(clear::irradiance(elevation_rad, 1361.0, air).dhi_w_m2)
    })
}

fn cost(name: &str, times: &[DateTime], call: impl Fn(DateTime) -> Result<f64, SunError>) -> Result<(), SunError> {
    let start = Instant::now();
    for &time in times {
        std::hint::black_box(call(time)?);
    }
    let microseconds = start.elapsed().as_secs_f64() * 1e6 / times.len() as f64;
    println!("| `{name}` | {microseconds:.3} |");
    Ok(())
}

fn minutes(time: DateTime) -> f64 {
    time.duration_since(time.date().at(0, 0, 0, 0)).as_secs_f64() / 60.0
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}
