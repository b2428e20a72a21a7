//! Weather files as they should be, long ones that are not, and the sky that follows from them, against Radiance.

use glam::DVec3;
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::{SceneError, input::Input};
use lightvein::sky::dome::{Haze, SkyModel, skies};
use lightvein::sky::perez::Perez;
use lightvein::sky::spectrum::Band;
use lightvein::sky::steps::{Period, Step, of_weather};
use lightvein::sky::term::Term;
use lightvein::sky::weather::{Hour, Weather};
use lightvein::sky::{Place, Sun, sun, towards};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// What Perez' sky does not ask for.
const HAZE: Haze = Haze { turbidity: 3.0, ground_albedo: 0.2, band: Band::Broadband };

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A file of the data that lie beside the project; `None`, said aloud, where they do not.
fn shared(file: &str) -> Option<PathBuf> {
    let path = root().join("../shared/data").join(file);
    if !path.exists() {
        eprintln!("skipped: no {}", path.display());
    }
    path.exists().then_some(path)
}

#[track_caller]
fn load(path: &Path) -> Weather {
    Weather::load(path, &Quiet, &Cancel::new()).unwrap_or_else(|error| panic!("{error}"))
}

fn read(text: &str) -> Result<Weather, SceneError> {
    Weather::read(&Input::alone(text.as_bytes(), Path::new("year.epw"), &Quiet, &Cancel::new()))
}

/// The year made by `examples/make_weather.rs`.
fn made() -> Weather {
    load(&root().join("scenes/weather/clear_and_cloudy.wea"))
}

#[test]
fn chicago_brings_what_its_file_says() {
    let Some(path) = shared("weather/chicago.epw") else { return };
    let weather = load(&path);
    assert_eq!(weather.name, "Chicago Ohare Intl Ap, IL, USA");
    assert_eq!(weather.place, Place { altitude_m: 201.0, ..Place::from_degrees(41.98, -87.92, -6.0) });
    assert_eq!((weather.hours.len(), weather.warnings.len()), (8760, 0), "{:?}", weather.warnings);
    let sums = weather.sums();
    let rounded = [sums.ghi_kwh_m2.unwrap_or(0.0), sums.dni_kwh_m2, sums.dhi_kwh_m2].map(f64::round);
    assert_eq!(rounded, [1407.0, 1294.0, 660.0]);
    // A typical year: each month has its own.
    let years: std::collections::BTreeSet<i16> = weather.hours.iter().map(|hour| hour.start.year()).collect();
    assert!(years.len() > 3, "{years:?}");
}

#[test]
fn mannheim_is_read_in_latin1_and_with_its_beam_by_night() {
    let Some(path) = shared("weather/mannheim_latin1.epw") else { return };
    let weather = load(&path);
    assert_eq!((weather.name.as_str(), weather.hours.len()), ("Mannheim, BW, DEU", 8760));
    assert!(weather.warnings.is_empty(), "{:?}", weather.warnings);
    let night = |hour: &&Hour| {
        let down = |share| sun::position(&weather.place, hour.at(share), None).unwrap().elevation_rad < 0.0;
        down(0.0) && down(0.5) && down(1.0)
    };
    let at_night: f64 = weather.hours.iter().filter(night).map(|hour| hour.dni_w_m2 * hour.length_h / 1000.0).sum();
    println!("Mannheim: {:?}; direct by night {at_night:.1} kWh/m2", weather.sums());
    assert!(at_night > 1.0);
}

#[test]
fn the_made_year_has_every_sky() {
    let weather = made();
    assert_eq!((weather.hours.len(), weather.warnings.len()), (8760, 0), "{:?}", weather.warnings);
    let sums = weather.sums();
    println!("made: {sums:?}");
    // Plausible for the place: Munich has 1000 to 1150 of direct and about 550 of diffuse light.
    assert!((900.0..1300.0).contains(&sums.dni_kwh_m2) && (400.0..700.0).contains(&sums.dhi_kwh_m2));
    let mut rows = [0; 8];
    for (hour, stand) in lit(&weather, |place, time| sun::position(place, time, None).unwrap()) {
        rows[sky(hour, stand).bin()] += 1;
    }
    assert!(rows.iter().all(|&count| count > 100), "{rows:?}");
}

/// An EPW of a year by the dates of its rows.
fn year(rows: impl Iterator<Item = jiff::civil::DateTime>) -> String {
    let mut text = "LOCATION,A,B,C,made,0,48,11,1,500\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n".to_owned();
    for time in rows {
        let (date, hour) = (time.date(), time.hour() + 1);
        let [year, month, day] = [date.year(), date.month().into(), date.day().into()];
        writeln!(text, "{year},{month},{day},{hour},60,,,,,,,,,0,0,0,,,,,,,,,,,,,,,,,,,").unwrap();
    }
    text
}

fn hours_from(year: i16, count: usize) -> impl Iterator<Item = jiff::civil::DateTime> {
    jiff::civil::date(year, 1, 1).at(0, 0, 0, 0).series(jiff::Span::new().hours(1)).take(count)
}

#[test]
fn years_with_and_without_a_leap_day_are_whole() {
    assert_eq!(read(&year(hours_from(2005, 8760))).unwrap().hours.len(), 8760);
    assert_eq!(read(&year(hours_from(2004, 8784))).unwrap().hours.len(), 8784);
    // A leap year's months without its leap day, as typical years have them.
    let without = hours_from(2004, 8784).filter(|time| (time.month(), time.day()) != (2, 29));
    assert_eq!(read(&year(without)).unwrap().hours.len(), 8760);
}

#[test]
fn years_that_are_not_whole_are_refused() {
    let fails = |text: &str| read(text).expect_err("broken").to_string();
    let whole = year(hours_from(2005, 8760));
    let answers = [
        fails(&year(hours_from(2005, 8759))),
        fails(&year(hours_from(2005, 8761))),
        fails(&year(hours_from(2005, 4344))),
        fails(&year(hours_from(2005, 8760).filter(|time| time.month() != 7))),
        // 29 February in a year that has none: its first row is line 1419, below 2 + 59 * 24 others.
        fails(&whole.replace("2005,3,1,", "2005,2,29,")),
        fails(&whole.replace("2005,12,31,24,", "2005,12,31,23,")),
        fails(&whole.replace(",0,0,0,", ",0,1500.1,0,")),
    ];
    let expected = [
        "year.epw: the row of 12/31 hour 24 of the data up to 12/31 is missing",
        "year.epw:8763: expected no row after the last day of DATA PERIODS, found 1/1 hour 1",
        "year.epw: the row of 7/1 hour 1 of the data up to 12/31 is missing",
        "year.epw:4347: expected the row of 7/1 hour 1, found 8/1 hour 1",
        "year.epw:1419: there is no 2005-02-29",
        "year.epw:8762: expected the row of 12/31 hour 24, found 12/31 hour 23",
        "year.epw:3: direct normal radiation 1500.1 is outside 0 to 1500 W/m2",
    ];
    assert_eq!(answers, expected);
}

/// The hours in which there is light, with the sun at their middle; a sun below the horizon is taken as on it.
fn lit(weather: &Weather, position: impl Fn(&Place, jiff::civil::DateTime) -> Sun) -> Vec<(&Hour, Sun)> {
    let lit = weather.hours.iter().filter(|hour| hour.dni_w_m2 + hour.dhi_w_m2 > 1e-4);
    lit.map(|hour| {
        let stand = position(&weather.place, hour.middle());
        (hour, Sun { elevation_rad: stand.elevation_rad.max(0.0), ..stand })
    })
    .collect()
}

/// Perez's sky of an hour.
fn sky(hour: &Hour, stand: Sun) -> Perez {
    let eccentricity = sun::eccentricity(hour.start.date());
    Perez::new(FRAC_PI_2 - stand.elevation_rad, hour.dni_w_m2, hour.dhi_w_m2, eccentricity)
}

/// Tregenza's patches with Reinhart's subdivision as gendaymtx orders them: rows upwards, each from north clockwise, the zenith
/// last. Their middles and their solid angles.
fn patches(subdivisions: usize) -> Vec<(DVec3, f64)> {
    let rows = [30, 30, 24, 24, 18, 12, 6].into_iter().flat_map(|count| vec![count * subdivisions; subdivisions]);
    let height = FRAC_PI_2 / (7.0 * subdivisions as f64 + 0.5);
    let mut patches = Vec::new();
    for (row, count) in rows.enumerate() {
        let (low, high) = (row as f64 * height, (row as f64 + 1.0) * height);
        let solid_angle = 2.0 * PI * (high.sin() - low.sin()) / count as f64;
        let direction = |number: usize| towards(2.0 * PI * number as f64 / count as f64, (low + high) / 2.0);
        patches.extend((0..count).map(|number| (direction(number), solid_angle)));
    }
    patches.push((DVec3::Z, 2.0 * PI * (1.0 - (height / 2.0).cos())));
    patches
}

/// What the relative sky is divided by.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Norm {
    /// Its sum over the patches' middles, as gendaymtx does.
    Patches,
    /// Its integral.
    Integral,
}

/// The integrals of the hours' relative skies: what the library's domes divide by. 1 for an hour without diffuse light.
fn integrals(lit: &[(&Hour, Sun)]) -> Vec<f64> {
    let step = |&(hour, sun): &(&Hour, Sun)| Step {
        time: hour.middle(),
        hours: hour.length_h,
        sun,
        dni_w_m2: hour.dni_w_m2,
        dhi_w_m2: hour.dhi_w_m2,
        eccentricity: sun::eccentricity(hour.start.date()),
    };
    let steps: Vec<Step> = lit.iter().map(step).collect();
    let mut integrals = vec![1.0; lit.len()];
    for (number, term) in skies(SkyModel::Perez, HAZE, &steps, &Cancel::new()).unwrap() {
        integrals[number] = steps[number].dhi_w_m2 / term.weight;
    }
    integrals
}

/// Mean radiance of the patches over a year as the exposure map has it, W/m2/sr: its steps, its sun, its domes.
fn program_sky(weather: &Weather, patches: &[(DVec3, f64)]) -> Vec<[f64; 9]> {
    let steps = of_weather(&weather.place, weather, &Period::YEAR, &Cancel::new()).unwrap().steps;
    let terms = skies(SkyModel::Perez, HAZE, &steps, &Cancel::new()).unwrap();
    let share = |number: usize| steps[number].hours / weather.hours.len() as f64;
    let terms: Vec<Term> =
        terms.into_iter().map(|(number, term)| Term { weight: term.weight * share(number), ..term }).collect();
    let radiance = |direction: DVec3| terms.iter().map(|term| term.radiance(direction)).sum::<f64>();
    patches
        .par_iter()
        .map(|&(direction, _)| std::array::from_fn(|column| if column == 0 { radiance(direction) } else { 0.0 }))
        .collect()
}

/// Mean radiance of the patches over a year and the parts of the eight rows of the table, W/m2/sr.
fn mean_sky(weather: &Weather, lit: &[(&Hour, Sun)], patches: &[(DVec3, f64)], norm: Norm) -> Vec<[f64; 9]> {
    let integrals = integrals(lit);
    let mut mean = vec![[0.0; 9]; patches.len()];
    for (&(hour, stand), integral) in lit.iter().zip(integrals) {
        let (sky, to_sun) = (sky(hour, stand), stand.towards());
        let relative: Vec<f64> =
            patches.iter().map(|&(direction, _)| sky.relative(direction.z, direction.dot(to_sun))).collect();
        let whole = match norm {
            Norm::Patches => {
                relative.iter().zip(patches).map(|(value, (direction, size))| value * direction.z * size).sum()
            }
            Norm::Integral => integral,
        };
        let scale = hour.dhi_w_m2 / whole / weather.hours.len() as f64;
        for (sum, value) in mean.iter_mut().zip(relative) {
            sum[0] += value * scale;
            sum[1 + sky.bin()] += value * scale;
        }
    }
    mean
}

/// gendaymtx's figures: the mean of each patch, and where it is stored the parts of the eight rows.
fn stored(file: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(root().join("tests/data").join(file)).expect("gendaymtx's figures");
    let rows = text.lines().filter(|line| !line.starts_with(['#', 'm']));
    rows.map(|row| row.split(',').map(|value| value.parse().expect("a number")).collect()).collect()
}

/// Root mean square and greatest of the relative differences over the patches, of the whole or of a row's part.
fn differences(ours: &[[f64; 9]], theirs: &[Vec<f64>], column: usize) -> (f64, f64) {
    assert_eq!(ours.len(), theirs.len());
    let relative = ours.iter().zip(theirs).map(|(ours, theirs)| (ours[column] / theirs[column] - 1.0).abs());
    let relative: Vec<f64> = relative.collect();
    let mean = relative.iter().map(|value| value * value).sum::<f64>() / relative.len() as f64;
    (mean.sqrt(), relative.into_iter().fold(0.0, f64::max))
}

/// The sun of the gendaymtx that made the figures (pyradiance 1.3.1), found from what its option `-D` writes: Cooper's
/// declination, which is about 1 degree off in October, and the equation of time of the short formula. Days of a common year.
fn radiance_sun(place: &Place, time: jiff::civil::DateTime) -> Sun {
    let day = f64::from(jiff::civil::date(2001, time.month(), time.day()).day_of_year());
    let wave = |turns: f64, zero: f64, length: f64| (turns * PI * (day - zero) / length).sin();
    let (sin_declination, cos_declination) = (23.45_f64.to_radians() * wave(2.0, -284.0, 365.0)).sin_cos();
    let hours = f64::from(time.hour()) + f64::from(time.minute()) / 60.0;
    let solar_h = hours + 0.170 * wave(4.0, 80.0, 373.0) - 0.129 * wave(2.0, 8.0, 355.0)
        + place.longitude_rad.to_degrees() / 15.0
        - place.utc_offset_h;
    let (sin_hour, cos_hour) = (PI * solar_h / 12.0).sin_cos();
    let (sin_latitude, cos_latitude) = place.latitude_rad.sin_cos();
    let up = sin_latitude * sin_declination - cos_latitude * cos_declination * cos_hour;
    let north = cos_latitude * sin_declination + sin_latitude * cos_declination * cos_hour;
    Sun { azimuth_rad: (cos_declination * sin_hour).atan2(north), elevation_rad: up.asin() }
}

/// Holds a year's mean sky to gendaymtx's: with its sun and its sum over patches the model alone, within 0.01%; with the true
/// sun and the integral all of it, within 1%; and so does what the exposure map is made of.
#[track_caller]
fn check_sky(weather: &Weather, file: &str, subdivisions: usize) {
    let (patches, theirs) = (patches(subdivisions), stored(file));
    let alike = lit(weather, radiance_sun);
    let exact = lit(weather, |place, time| sun::position(place, time, None).unwrap());
    let compare = |name: &str, lit: &[(&Hour, Sun)], norm: Norm| {
        let ours = mean_sky(weather, lit, &patches, norm);
        let (rms, most) = differences(&ours, &theirs, 0);
        println!("{file}, {name}, {norm:?}: RMS {:.4}%, at most {:.4}%", 100.0 * rms, 100.0 * most);
        if theirs[0].len() > 1 {
            let rows = (1..9).map(|column| differences(&ours, &theirs, column));
            let rows = rows.map(|(rms, most)| format!("{:.2} ({:.2})", 100.0 * rms, 100.0 * most));
            println!("  by row of the table, RMS (greatest) %: {}", rows.collect::<Vec<_>>().join(", "));
        }
        rms
    };
    let model = compare("its sun", &alike, Norm::Patches);
    compare("its sun", &alike, Norm::Integral);
    compare("SPA's sun", &exact, Norm::Patches);
    let whole = compare("SPA's sun", &exact, Norm::Integral);
    let (program, most) = differences(&program_sky(weather, &patches), &theirs, 0);
    println!("{file}, the map's steps and domes: RMS {:.4}%, at most {:.4}%", 100.0 * program, 100.0 * most);
    assert!(program < 0.01, "{file}: the map's sky differs by {program}");
    assert!(model < 1e-4, "{file}: the model differs by {model}");
    assert!(whole < 0.01, "{file}: the mean sky differs by {whole}");
}

#[test]
fn the_made_years_sky_is_that_of_gendaymtx() {
    check_sky(&made(), "gendaymtx_made.csv", 1);
    check_sky(&made(), "gendaymtx_made_fine.csv", 4);
}

#[test]
fn chicagos_sky_is_that_of_gendaymtx() {
    let Some(path) = shared("weather/chicago.epw") else { return };
    check_sky(&load(&path), "gendaymtx_chicago.csv", 1);
}
