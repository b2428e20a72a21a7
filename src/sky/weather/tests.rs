use super::*;
use crate::job::Quiet;
use jiff::civil::date;
use std::fmt::Write;

/// Rows of an EPW of days of June from the 1st on, by irradiances, and how many of them an hour has.
fn epw_text(records_per_hour: usize, last_day: usize, row: impl Fn(usize) -> [String; 3]) -> String {
    let mut text = format!(
        "LOCATION,\"Here, there\",,DEU,made,0,48,11,1,500\nCOMMENTS 1,none\nDATA PERIODS,1,{records_per_hour},D,Monday,6/1, 6/{last_day}\n"
    );
    for number in 0..24 * last_day * records_per_hour {
        let (day, rest) = (number / (24 * records_per_hour), number % (24 * records_per_hour));
        let (hour, part) = (rest / records_per_hour, rest % records_per_hour);
        let minute = (part + 1) * 60 / records_per_hour;
        let [ghi, dni, dhi] = row(number);
        let ends = ",".repeat(19);
        writeln!(text, "2003,6,{},{},{minute},x,,,,,,,,{ghi},{dni},{dhi}{ends}", day + 1, hour + 1).unwrap();
    }
    text
}

fn read(text: &[u8], name: &str) -> Result<Weather, SceneError> {
    Weather::read(&Input::alone(text, Path::new(name), &Quiet, &Cancel::new()))
}

#[track_caller]
fn epw(text: &str) -> Weather {
    read(text.as_bytes(), "a.epw").unwrap_or_else(|error| panic!("{error}"))
}

fn plain(number: usize) -> [String; 3] {
    [number, 10 * number, number].map(|value| value.to_string())
}

#[test]
fn an_epw_row_is_the_hour_that_ends_with_its_stamp() {
    let weather = epw(&epw_text(1, 1, plain));
    assert_eq!(weather.name, "Here, there, DEU");
    assert_eq!(weather.place, Place { altitude_m: 500.0, ..Place::from_degrees(48.0, 11.0, 1.0) });
    assert_eq!(weather.hours.len(), 24);
    let hour = weather.hours[12];
    assert_eq!((hour.start, hour.end()), (date(2003, 6, 1).at(12, 0, 0, 0), date(2003, 6, 1).at(13, 0, 0, 0)));
    assert_eq!(hour.middle(), date(2003, 6, 1).at(12, 30, 0, 0));
    assert_eq!((hour.dni_w_m2, hour.dhi_w_m2, hour.ghi_w_m2, hour.line), (120.0, 12.0, Some(12.0), 16));
    assert_eq!(weather.hours[23].end(), date(2003, 6, 2).at(0, 0, 0, 0));
    assert!(weather.warnings.is_empty(), "{:?}", weather.warnings);
    let sums = weather.sums();
    assert!((sums.dni_kwh_m2 - 2.76).abs() < 1e-12 && (sums.dhi_kwh_m2 - 0.276).abs() < 1e-12);
    assert_eq!(sums.ghi_kwh_m2, Some(sums.dhi_kwh_m2));
}

#[test]
fn the_minute_of_hourly_rows_does_not_matter() {
    let at_60 = epw_text(1, 2, plain);
    for minute in ["0", "30"] {
        assert_eq!(epw(&at_60.replace(",60,x", &format!(",{minute},x"))), epw(&at_60));
    }
}

#[test]
fn bytes_that_do_not_matter_do_not() {
    let sound = epw_text(1, 1, plain);
    let same = epw(&sound);
    for other in [
        sound.replace('\n', "\r\n"),
        format!("\u{feff}{sound}"),
        format!("{sound}\n\n \n"),
        sound.trim_end().to_owned(),
        sound.replace(",x,", ",\"?9?9, 9\","),
        sound.replace("DATA PERIODS", "data periods"),
        // An apostrophe too few in a comment, and fields of later versions left out.
        sound.replace("COMMENTS 1,none", "COMMENTS 1,\"never closed"),
        sound.replace(",,,\n", "\n"),
    ] {
        assert_eq!(epw(&other), same);
    }
    // In Latin-1, whole.
    let latin1: Vec<u8> =
        sound.replace("there", "M\u{fc}nchen").chars().map(|letter| u8::try_from(letter).unwrap()).collect();
    assert_eq!(read(&latin1, "a.EPW").unwrap().name, "Here, M\u{fc}nchen, DEU");
}

#[test]
fn parts_of_hours_come_one_after_the_other() {
    let weather = epw(&epw_text(4, 1, |_| ["0", "100", "200"].map(str::to_owned)));
    assert_eq!(weather.hours.len(), 96);
    let hour = weather.hours[6];
    assert_eq!((hour.start, hour.length_h), (date(2003, 6, 1).at(1, 30, 0, 0), 0.25));
    assert_eq!(hour.middle(), date(2003, 6, 1).at(1, 37, 30, 0));
    assert!((weather.sums().dni_kwh_m2 - 2.4).abs() < 1e-12);
    assert!(weather.warnings[0].starts_with("with 4 records an hour"));
    // Stamps of the beginning of each part are the same parts.
    let begins = epw_text(4, 1, |_| ["0", "100", "200"].map(str::to_owned))
        .replace(",15,x", ",00,x")
        .replace(",30,x", ",15,x")
        .replace(",45,x", ",30,x")
        .replace(",60,x", ",45,x");
    assert_eq!(epw(&begins).hours, weather.hours);
}

#[test]
fn periods_may_be_several_and_go_over_the_turn_of_the_year() {
    let two_days = epw_text(1, 2, plain);
    let both = "1,1,D,Monday,6/1, 6/2";
    let apart = two_days.replace(both, "2,1,D,Monday,6/1,6/1,E,Monday, 6/9, 6/9").replace("2003,6,2,", "2003,6,9,");
    assert_eq!(epw(&apart).hours[24].start, date(2003, 6, 9).at(0, 0, 0, 0));
    let over = two_days.replace(both, "1,1,D,Monday,12/31,1/1");
    let over = over.replace("2003,6,1,", "2003,12,31,").replace("2003,6,2,", "2004,1,1,");
    assert_eq!(epw(&over).hours[24].start, date(2004, 1, 1).at(0, 0, 0, 0));
    // Days with a year are those of that year.
    assert_eq!(epw(&two_days.replace(both, "1,1,D,Monday,6/1/2003,6/2/2003")), epw(&two_days));
    let other = two_days.replace(both, "1,1,D,Monday,6/1/2004,6/2/2004");
    let error = read(other.as_bytes(), "a.epw").unwrap_err().to_string();
    assert_eq!(error, "a.epw:4: expected the row of 6/1/2004 hour 1, found 6/1/2003 hour 1");
}

#[test]
fn what_is_missing_is_found_from_the_others() {
    // With the sun up, GHI = DNI sin(elevation) + DHI. On 1 June, 12 to 13 h at 48 N, 11 E, the sun is at 64 degrees: sine
    // 0.897 (declination 22.0, hour angle about 4 degrees, by hand).
    let one = |ghi: &'static str, dni: &'static str, dhi: &'static str| {
        let text =
            epw_text(1, 1, |number| [ghi, dni, dhi].map(|value| if number == 12 { value } else { "0" }.to_owned()));
        let weather = epw(&text);
        (weather.hours[12], weather.warnings)
    };
    let (hour, warnings) = one("800", "9999", "100");
    assert!((hour.dni_w_m2 - 700.0 / 0.897).abs() < 3.0, "{hour:?}");
    assert_eq!(warnings, ["direct normal radiation is missing in 1 row (line 16), found from the others and the sun"]);
    let (hour, _) = one("800", "600", "9999.0");
    assert!((hour.dhi_w_m2 - (800.0 - 600.0 * 0.897)).abs() < 3.0, "{hour:?}");
    // More direct light than all: none is diffuse.
    assert_eq!(one("100", "600", "").0.dhi_w_m2, 0.0);
    // Two that are missing stay so.
    let (hour, warnings) = one("9999", "9999", "100");
    assert_eq!((hour.dni_w_m2, hour.dhi_w_m2, hour.ghi_w_m2), (0.0, 100.0, None));
    assert_eq!(warnings, ["direct normal radiation is missing in 1 row (line 16), taken as 0"]);
    let (hour, warnings) = one("800", "9999", "9999");
    assert_eq!((hour.dni_w_m2, hour.dhi_w_m2, warnings.len()), (0.0, 0.0, 2));
    // GHI is not needed.
    assert_eq!(one("9999", "600", "100").1.len(), 0);
}

#[test]
fn without_a_sun_there_is_no_direct_light_to_miss() {
    let text = epw_text(1, 1, |number| if number == 0 { ["3", "9999", "9999"] } else { ["0"; 3] }.map(str::to_owned));
    let weather = epw(&text);
    assert_eq!((weather.hours[0].dni_w_m2, weather.hours[0].dhi_w_m2), (0.0, 3.0));
    assert_eq!(weather.warnings.len(), 2);
    assert!(weather.warnings.iter().all(|warning| warning.ends_with("found from the others and the sun")));
}

#[test]
fn many_missing_rows_are_named_by_the_first() {
    let text = epw_text(1, 1, |_| ["9999", "5", "9999"].map(str::to_owned));
    assert_eq!(
        epw(&text).warnings,
        ["diffuse horizontal radiation is missing in 24 rows (lines 4, 5, 6, 7, 8 and 19 more), taken as 0"]
    );
}

#[test]
fn a_longitude_of_the_wrong_sign_is_told() {
    let text = epw_text(1, 1, plain).replace(",48,11,1,", ",48,-88,6,");
    assert_eq!(epw(&text).warnings, ["the zone 6 h is 11.9 h off the longitude -88.00 degrees east: is a sign wrong?"]);
    // Kiribati is at the date line, and a day ahead of its longitude.
    assert!(epw(&epw_text(1, 1, plain).replace(",48,11,1,", ",1.9,-157.4,14,")).warnings.is_empty());
}

#[test]
fn a_wea_row_is_the_hour_around_its_stamp() {
    let head =
        "place Here_DEU\nlatitude 48\nlongitude -11\ntime_zone -15\nsite_elevation 500\nweather_data_file_units ";
    let wea = |rest: &str| read(format!("{head}{rest}").as_bytes(), "a.wea").unwrap_or_else(|error| panic!("{error}"));
    let weather = wea("1\n6 1 12.500 600 100\n6 1 13.500 500 90 0.1 0.5\n");
    assert_eq!(weather.name, "Here_DEU");
    assert_eq!(weather.place, epw(&epw_text(1, 1, plain)).place);
    let hour = weather.hours[0];
    assert_eq!((hour.start, hour.length_h, hour.line), (date(2002, 6, 1).at(12, 0, 0, 0), 1.0, 7));
    assert_eq!((hour.dni_w_m2, hour.dhi_w_m2, hour.ghi_w_m2), (600.0, 100.0, None));
    assert_eq!((weather.hours.len(), weather.warnings.len()), (2, 0));

    // Direct on the horizontal; the sun as above.
    let weather = wea("2\n6 1 12.5 700 100\n");
    let hour = weather.hours[0];
    assert!((hour.dni_w_m2 - 700.0 / 0.897).abs() < 3.0 && hour.ghi_w_m2 == Some(800.0), "{hour:?}");

    // Quarters of an hour, with two decimals as epw2wea would write; the turn of a leap day; nights left out.
    let weather = wea("1\n2 29 23.63 0 1\n2 29 23.88 0 2\n3 1 0.125 0 3\n3 1 9.125 0 4\n");
    assert_eq!(weather.hours[1].start, date(2000, 2, 29).at(23, 45, 30, 0));
    assert!(weather.hours.iter().all(|hour| hour.length_h <= 0.25));
    assert_eq!(weather.warnings.len(), 1, "{:?}", weather.warnings);
}

#[test]
fn only_known_endings_are_read() {
    let error = read(b"", "a.csv").unwrap_err().to_string();
    assert_eq!(error, "a.csv: file \"a.csv\" is of no known format; known are epw, wea");
}
