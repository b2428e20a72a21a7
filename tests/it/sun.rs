//! The sun against SPA's own program, the almanac of the US Naval Observatory and a published table; clear skies against
//! pvlib; laws on generated input.

use jiff::ToSpan;
use jiff::civil::{Date, DateTime, date};
use lightvein::sky::clear::{self, ClearAir};
use lightvein::sky::events::{self, Day};
use lightvein::sky::sun::{self, Air};
use lightvein::sky::{Place, Sun, simple_sun};
use std::fs;
use std::path::Path;

/// The rows of a table of the shared data, without comments; nothing where that data is absent.
fn rows(name: &str) -> Option<Vec<Vec<String>>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/solar").join(name);
    let Ok(text) = fs::read_to_string(&path) else {
        eprintln!("skipped: no ../shared/data/solar/{name} here");
        return None;
    };
    let rows = text.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    Some(rows.map(|row| row.split(',').map(|field| field.trim().to_owned()).collect()).collect())
}

fn degrees(field: &str) -> f64 {
    field.parse().unwrap()
}

/// The difference of two azimuths, degrees, around the whole turn.
fn turned_deg(a_deg: f64, b_deg: f64) -> f64 {
    let turned = (a_deg - b_deg).rem_euclid(360.0);
    turned.min(360.0 - turned)
}

fn sun_at(latitude_deg: f64, longitude_deg: f64, time: &str, air: Option<Air>) -> (f64, f64) {
    let place = Place::from_degrees(latitude_deg, longitude_deg, 0.0);
    let time: DateTime = time.trim_end_matches('Z').parse().unwrap();
    let Sun { azimuth_rad, elevation_rad } = sun::position_with_delta_t(&place, time, air, 0.0).unwrap();
    (azimuth_rad.to_degrees(), 90.0 - elevation_rad.to_degrees())
}

/// The air of SPA's reference rows.
const AIR: Air = Air { pressure_hpa: 1000.0, temperature_c: 10.0 };

/// Rows of NREL's own program (spa.c, 2014; 1000 hPa, 10 C, delta T 0), a few known here, 512 in the shared data.
#[test]
fn positions_are_those_of_nrels_program() {
    let known: [[&str; 5]; 3] = [
        ["1910-03-15T00:30:00Z", "-36.840556", "174.74", "0.188643", "34.269919"],
        ["1910-03-15T06:30:00Z", "-36.840556", "174.74", "268.082350", "88.143823"],
        ["1910-03-15T09:30:00Z", "-36.840556", "174.74", "237.156205", "122.642657"],
    ];
    let known = known.map(|row| row.map(str::to_owned).to_vec()).to_vec();
    let rows = rows("spa_reference_testdata.csv").unwrap_or(known);
    let (mut most_deg, mut unjudged) = (0.0_f64, 0);
    for row in &rows {
        let [time, latitude, longitude, azimuth, zenith] = row.as_slice() else { panic!("{row:?}") };
        let (azimuth_want, zenith_want) = (degrees(azimuth), degrees(zenith));
        // Refracted down to the horizon, not below 91 degrees of zenith; between them rows would have to say.
        if (90.0..=91.0).contains(&zenith_want) {
            unjudged += 1;
        }
        let (azimuth_deg, zenith_deg) = sun_at(degrees(latitude), degrees(longitude), time, Some(AIR));
        let off_deg = turned_deg(azimuth_deg, azimuth_want).max((zenith_deg - zenith_want).abs());
        assert!(off_deg < 1e-4, "{row:?}: {azimuth_deg} {zenith_deg}");
        most_deg = most_deg.max(off_deg);
    }
    println!("{} rows, at most {most_deg:.1e} degrees off; {unjudged} between 90 and 91 degrees of zenith", rows.len());
}

/// Minutes from a time of day of a table, within half a day.
fn minutes_off(found: DateTime, hours_minutes: &str) -> f64 {
    let (hours, minutes) = hours_minutes.split_once(':').unwrap();
    let want: f64 = 60.0 * degrees(hours) + degrees(minutes);
    let found = found.duration_since(found.date().at(0, 0, 0, 0)).as_secs_f64() / 60.0;
    (found - want + 720.0).rem_euclid(1440.0) - 720.0
}

fn check_almanac(name: &str) {
    let Some(rows) = rows(name) else { return };
    let mut most_min = 0.0_f64;
    let (mut normal, mut always) = (0, 0);
    for row in &rows {
        let [time, latitude, longitude, kind, sunrise, sunset] = row.as_slice() else { panic!("{row:?}") };
        let place = Place::from_degrees(degrees(latitude), degrees(longitude), 0.0);
        let date: Date = time.split('T').next().unwrap().parse().unwrap();
        let found = events::crossings(&place, date).unwrap();
        if kind == "NORMAL" {
            normal += 1;
            let [rise, set] = [&found.sunrises, &found.sunsets].map(|times| times[0]);
            for off_min in [minutes_off(rise, sunrise), minutes_off(set, sunset)] {
                // The almanac rounds to the minute.
                assert!(off_min.abs() <= 1.0, "{row:?}: {off_min} minutes, {found:?}");
                most_min = most_min.max(off_min.abs());
            }
        } else {
            always += 1;
            assert!(found.sunrises.is_empty() && found.sunsets.is_empty(), "{row:?}: {found:?}");
            assert_eq!(found.is_up_at_start, kind == "ALL_DAY", "{row:?}");
            let day = events::day(&place, date).unwrap();
            let is_as_said = if kind == "ALL_DAY" {
                matches!(day, Day::AlwaysUp { .. })
            } else {
                matches!(day, Day::AlwaysDown { .. })
            };
            assert!(is_as_said, "{row:?}: {day:?}");
        }
    }
    println!("{name}: {normal} days with at most {most_min:.2} minutes off, {always} polar days and nights");
}

#[test]
fn sunrise_and_sunset_are_the_almanacs() {
    check_almanac("usno_reference_testdata.csv");
}

#[test]
fn sunrise_and_sunset_are_the_almanacs_near_the_poles_too() {
    check_almanac("usno_reference_testdata_extreme.csv");
}

/// Sunrise and sunset on the first of each month, as printed by Kolivand & Sunar (2012); they cite Alor Setar, the times are
/// those of Johor Bahru.
const JOHOR_BAHRU: [[&str; 2]; 12] = [
    ["07:07", "19:10"],
    ["07:17", "19:20"],
    ["07:15", "19:20"],
    ["07:05", "19:13"],
    ["06:57", "19:07"],
    ["06:57", "19:09"],
    ["07:02", "19:15"],
    ["07:06", "19:17"],
    ["07:01", "19:10"],
    ["06:52", "18:58"],
    ["06:47", "18:50"],
    ["06:53", "18:55"],
];

#[test]
fn johor_bahrus_sun_rises_and_sets_when_it_was_published_to() {
    let place = Place::from_degrees(1.47, 103.75, 8.0);
    for year in 2009..=2012 {
        let mut most_min = [0.0_f64; 2];
        for (month, printed) in (1..).zip(JOHOR_BAHRU) {
            let day = date(year, month, 1);
            for (number, found) in [events::day(&place, day), simple_sun::day(&place, day)].into_iter().enumerate() {
                let Ok(Day::Normal { sunrise, sunset, .. }) = found else { panic!("{found:?}") };
                let off = [minutes_off(sunrise, printed[0]), minutes_off(sunset, printed[1])];
                println!("{day} {} {:.1} {:.1}", ["SPA", "simple"][number], off[0], off[1]);
                most_min[number] = off.iter().fold(most_min[number], |most, off| most.max(off.abs()));
            }
        }
        println!("{year}: SPA at most {:.1} minutes off, the simple formula {:.1}", most_min[0], most_min[1]);
    }
}

/// By pvlib 0.16.1: `ineichen(90 - elevation, absolute airmass by kastenyoung1989 and alt2pres, turbidity, altitude,
/// dni_extra)`; elevation (degrees), turbidity, altitude (m), dni_extra (W/m2), then dni, dhi, ghi.
const PVLIB: [[f64; 7]; 9] = [
    [0.5, 3.0, 0.0, 1361.0, 3.987640712, 0.235941447, 0.270739735],
    [10.0, 2.0, 0.0, 1361.0, 680.808590702, 14.909118841, 133.130289957],
    [30.0, 3.0, 0.0, 1400.0, 808.599891178, 77.717049719, 482.016995308],
    [60.0, 5.0, 250.0, 1361.0, 756.718127362, 168.968326237, 824.305448037],
    [90.0, 3.0, 0.0, 1361.0, 940.184622020, 111.706485007, 1051.891107027],
    [45.0, 1.0, 0.0, 1361.0, 1088.403124313, 21.281880329, 790.899110196],
    [25.0, 12.0, 1500.0, 1316.5, 161.769874792, 169.129347119, 237.496250406],
    [75.0, 2.5, 4500.0, 1406.25, 1233.819058504, 187.310945043, 1379.088638620],
    [3.0, 7.0, 5000.0, 1361.0, 16.827569104, 22.657610600, 23.538297521],
];

#[test]
fn clear_skies_are_those_of_pvlib() {
    for row in PVLIB {
        let [elevation_deg, linke_turbidity, altitude_m, extraterrestrial_w_m2, dni, dhi, ghi] = row;
        let elevation_rad = elevation_deg.to_radians();
        let found = clear::irradiance(elevation_rad, extraterrestrial_w_m2, ClearAir { linke_turbidity, altitude_m });
        for (got, want) in [(found.dni_w_m2, dni), (found.dhi_w_m2, dhi), (found.ghi_w_m2(elevation_rad), ghi)] {
            assert!((got / want - 1.0).abs() < 1e-6 || (got - want).abs() < 1e-9, "{row:?}: {got} for {want}");
        }
    }
}

/// Annual global irradiation of clear days, kWh/m2, turbidity 3, at the height of the sea.
#[test]
fn clear_years_bring_what_they_are_known_to() {
    for (latitude_deg, want) in [(0.0, 2661.0), (25.0, 2399.0), (42.0, 1955.0), (51.5, 1644.0), (60.0, 1359.0)] {
        let place = Place::from_degrees(latitude_deg, 0.0, 0.0);
        let mut kwh_m2 = 0.0;
        let mut time = date(2023, 1, 1).at(0, 30, 0, 0);
        while time.year() == 2023 {
            let sun = sun::position(&place, time, Some(Air::STANDARD)).unwrap();
            let air = ClearAir { linke_turbidity: 3.0, altitude_m: 0.0 };
            let clear = clear::irradiance(sun.elevation_rad, sun::extraterrestrial_w_m2(time.date()), air);
            kwh_m2 += clear.ghi_w_m2(sun.elevation_rad) / 1000.0;
            time = time.checked_add(1.hour()).unwrap();
        }
        println!("{latitude_deg}: {kwh_m2:.1}, known {want}");
        assert!((kwh_m2 / want - 1.0).abs() < 0.01, "{latitude_deg}: {kwh_m2} for {want}");
    }
}
