//! Steps of a period and the exposure map made of them: energy kept, nothing invented, anywhere on earth; and the command
//! `sky` as a user meets it.

use super::program::{run, text};
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::Site;
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings, least_counted};
use lightvein::sky::site::{ClearSky, Outdoors};
use lightvein::sky::spectrum::Band;
use lightvein::sky::steps::{Period, Steps};
use lightvein::sky::weather::Weather;
use proptest::prelude::*;
use serde_json::Value;
use std::path::{Path, PathBuf};

const MADE: &str = "scenes/weather/clear_and_cloudy.wea";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The weather files that are there: the one of our own making, and those of the shared data.
fn weather_files() -> Vec<PathBuf> {
    let shared = ["chicago.epw", "mannheim_latin1.epw"].map(|name| root().join("../shared/data/weather").join(name));
    let (there, absent): (Vec<PathBuf>, Vec<PathBuf>) = shared.into_iter().partition(|path| path.exists());
    absent.iter().for_each(|path| println!("skipped: {} is not here", path.display()));
    [vec![root().join(MADE)], there].concat()
}

fn under_weather(path: &Path) -> (Weather, Outdoors) {
    let weather = Weather::load(path, &Quiet, &Cancel::new()).unwrap();
    (weather.clone(), Outdoors::of(&Site::default(), Some(weather)).unwrap())
}

fn clear(latitude_deg: f64, longitude_deg: f64, turbidity: f64) -> Outdoors {
    let at = Site { latitude_deg: Some(latitude_deg), longitude_deg: Some(longitude_deg), ..Site::default() };
    Outdoors::of(&Site { turbidity: Some(turbidity), ..at }, None).unwrap()
}

fn build(steps: &Steps, settings: MapSettings) -> ExposureMap {
    ExposureMap::build(steps, &settings, &Quiet, &Cancel::new()).unwrap()
}

#[track_caller]
fn close(a: f64, b: f64, share: f64, what: &str) {
    assert!((a - b).abs() <= share * b.abs(), "{what}: {a} against {b}");
}

/// What the file holds is in the steps, but for beams at night, which are told; and in the texels within 0.5%.
#[test]
fn a_map_holds_the_weathers_energy() {
    for path in weather_files() {
        let (weather, outdoors) = under_weather(&path);
        let steps = outdoors.steps().unwrap();
        let (mut dni, mut dhi) = (0.0, 0.0);
        for hour in &weather.hours {
            dni += hour.dni_w_m2 * hour.length_h / 1000.0;
            dhi += hour.dhi_w_m2 * hour.length_h / 1000.0;
        }
        let totals = steps.totals();
        close(totals.dni_kwh_m2 + steps.night_beam_kwh_m2, dni, 1e-9, "beam of the file");
        close(totals.dhi_kwh_m2, dhi, 1e-9, "diffuse of the file");
        assert_eq!(steps.night_beam_kwh_m2 > 0.0, steps.warnings.iter().any(|warning| warning.contains("beam")));

        let map = build(&steps, MapSettings { size: [256, 256], model: outdoors.model, ..MapSettings::default() });
        let texels = map.texel_totals();
        close(texels.dni_kwh_m2, totals.dni_kwh_m2, 0.005, "beam of the texels");
        close(texels.dhi_kwh_m2, totals.dhi_kwh_m2, 0.005, "diffuse of the texels");
        close(texels.ghi_kwh_m2, totals.ghi_kwh_m2, 0.005, "both of the texels");
        let beams: f64 = map.suns.iter().map(|sun| sun.energy_kwh_m2).sum();
        close(beams, totals.dni_kwh_m2, 1e-9, "the suns");
    }
}

/// The sum `DNI sin elevation + DHI` is the file's own global irradiation, within what files differ by themselves.
#[test]
fn global_irradiation_is_the_files_own() {
    for path in weather_files() {
        let (_, outdoors) = under_weather(&path);
        let steps = outdoors.steps().unwrap();
        let Some(measured) = steps.measured_ghi_kwh_m2 else { continue };
        close(steps.totals().ghi_kwh_m2, measured, 0.006, "global");
    }
}

#[test]
fn a_step_of_any_length_holds_the_same_energy() {
    let (_, outdoors) = under_weather(&root().join(MADE));
    let whole = outdoors.steps().unwrap();
    for step_min in [7.0, 15.0, 90.0, 180.0, 1440.0] {
        let period = Period { step_min, ..outdoors.period };
        let steps = Outdoors { period, ..outdoors.clone() }.steps().unwrap();
        close(steps.totals().dni_kwh_m2, whole.totals().dni_kwh_m2, 1e-9, "beam");
        close(steps.totals().dhi_kwh_m2, whole.totals().dhi_kwh_m2, 1e-9, "diffuse");
        assert!((step_min < 60.0) == (steps.steps.len() > whole.steps.len()), "{step_min}");
    }
}

#[test]
fn months_add_up_to_the_year() {
    let (_, outdoors) = under_weather(&root().join(MADE));
    let halves = [((11, 1), (4, 30)), ((5, 1), (10, 31))].map(|(first, last)| {
        let period = Period { first, last, ..outdoors.period };
        Outdoors { period, ..outdoors.clone() }.steps().unwrap().totals()
    });
    let year = outdoors.steps().unwrap().totals();
    close(halves[0].ghi_kwh_m2 + halves[1].ghi_kwh_m2, year.ghi_kwh_m2, 1e-12, "halves");
    assert!(halves[0].ghi_kwh_m2 < halves[1].ghi_kwh_m2, "the half with summer has more");
}

/// A made year, interpolated, against the full sum, in the texels that hold 99.9% of the energy.
#[test]
fn a_year_of_weather_is_within_half_a_percent_of_the_full_sum() {
    let (_, outdoors) = under_weather(&root().join(MADE));
    let steps = outdoors.steps().unwrap();
    let settings = MapSettings { size: [160, 90], model: outdoors.model, ..MapSettings::default() };
    let (map, full) = (build(&steps, settings), build(&steps, MapSettings { tolerance: None, ..settings }));
    let least = least_counted(&full.diffuse_kwh_m2);
    for (some, full) in map.diffuse_kwh_m2.iter().zip(&full.diffuse_kwh_m2).filter(|(_, full)| **full >= least) {
        assert!((some / full - 1.0).abs() < 0.005, "{some} {full}");
    }
    assert!(map.check.largest < 0.005 && map.check.texels > 300, "{:?}", map.check);
}

#[test]
fn a_spectral_sky_in_bands_is_less_than_in_all_light() {
    let all = Outdoors { clear_sky: ClearSky::Spectral, ..clear(30.0, 0.0, 3.0) };
    let sums = [Band::Broadband, Band::Visible, Band::Ultraviolet].map(|band| {
        let outdoors = all.clone().in_band(band).unwrap();
        let steps = outdoors.steps().unwrap();
        let settings =
            MapSettings { size: [64, 32], model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
        let (totals, texels) = (steps.totals(), build(&steps, settings).texel_totals());
        close(texels.dhi_kwh_m2, totals.dhi_kwh_m2, 0.01, "texels of a small map");
        totals.ghi_kwh_m2
    });
    // Of what reaches the ground some 45% is visible and 4% ultraviolet.
    assert!((0.38..0.52).contains(&(sums[1] / sums[0])), "{sums:?}");
    assert!((0.02..0.06).contains(&(sums[2] / sums[0])), "{sums:?}");
    assert!(all.clone().in_band(Band::Infrared).is_err());
    let (_, measured) = under_weather(&root().join(MADE));
    assert!(measured.in_band(Band::Visible).is_err());
}

#[test]
fn a_raised_flag_stops_a_map() {
    let (_, outdoors) = under_weather(&root().join(MADE));
    let cancel = Cancel::new();
    cancel.cancel();
    let steps = outdoors.steps().unwrap();
    assert!(ExposureMap::build(&steps, &MapSettings::default(), &Quiet, &cancel).is_err());
}

#[test]
fn any_number_of_threads_gives_the_same_map() {
    let (_, outdoors) = under_weather(&root().join(MADE));
    let maps = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let steps = outdoors.steps().unwrap();
            build(&steps, MapSettings { size: [128, 64], ..MapSettings::default() })
        })
    });
    let bits = |map: &ExposureMap| -> Vec<u32> {
        map.diffuse_kwh_m2.iter().chain(&map.direct_kwh_m2).map(|energy| energy.to_bits()).collect()
    };
    for map in &maps[1..] {
        assert_eq!(bits(map), bits(&maps[0]));
        assert_eq!((map.totals, &map.suns), (maps[0].totals, &maps[0].suns));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Poles, date line, leap day, sun on and below the horizon, any turbidity: every energy is a number and not negative,
    /// and the texels hold what the period brings.
    #[test]
    fn every_sky_on_earth_is_light_or_dark_but_a_number(
        latitude in prop_oneof![Just(90.0), Just(-90.0), Just(0.0), -90.0..90.0_f64],
        longitude in prop_oneof![Just(180.0), Just(-180.0), -180.0..180.0_f64],
        zone in prop_oneof![Just(None), (-12..15).prop_map(Some)],
        turbidity in prop_oneof![Just(1.0), Just(10.0), Just(12.0), 1.0..12.0_f64],
        albedo in 0.0..=1.0_f64,
        day in prop_oneof![Just((2, 29)), Just((3, 20)), Just((6, 21)), Just((12, 21)), (1..13_i8, 1..29_i8)],
        step_min in prop_oneof![Just(60.0), 5.0..1440.0_f64],
        model in prop::sample::select(SkyModel::ALL.to_vec()),
        clear_sky in prop::sample::select(ClearSky::ALL.to_vec()),
    ) {
        let mut outdoors = clear(latitude, longitude, turbidity);
        outdoors.haze.ground_albedo = albedo;
        outdoors.place.utc_offset_h = zone.map_or(outdoors.place.utc_offset_h, f64::from);
        let outdoors = Outdoors {
            period: Period { first: day, last: day, step_min },
            year: 2024,
            model,
            clear_sky,
            ..outdoors
        };
        let steps = outdoors.steps().unwrap();
        for step in &steps.steps {
            prop_assert!((0.0..=std::f64::consts::FRAC_PI_2).contains(&step.sun.elevation_rad), "{step:?}");
            prop_assert!(step.dni_w_m2 >= 0.0 && step.dhi_w_m2 >= 0.0 && step.hours > 0.0, "{step:?}");
        }
        let map = build(&steps, MapSettings { size: [96, 48], model, haze: outdoors.haze, ..MapSettings::default() });
        for energy in map.diffuse_kwh_m2.iter().chain(&map.direct_kwh_m2) {
            prop_assert!(energy.is_finite() && *energy >= 0.0, "{energy}");
        }
        // Texels this large keep a narrow aureole within some percent.
        let (texels, totals) = (map.texel_totals(), map.totals);
        prop_assert!((texels.dhi_kwh_m2 - totals.dhi_kwh_m2).abs() <= 0.03 * totals.dhi_kwh_m2, "{texels:?} {totals:?}");
        prop_assert!((texels.dni_kwh_m2 - totals.dni_kwh_m2).abs() <= 1e-4 * totals.dni_kwh_m2, "{texels:?} {totals:?}");
    }
}

/// Stdout as JSON of a run that ends well.
#[track_caller]
fn json(arguments: &[&str]) -> Value {
    let output = run(arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn sky_writes_its_files_and_its_json() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out_text = out.to_str().unwrap();
    let told = json(&[
        "sky",
        MADE,
        "--date",
        "2023-06-21",
        "--time",
        "09:30",
        "--facade",
        "135",
        "--size",
        "64x32",
        "--json",
        "-o",
        out_text,
    ]);
    for key in ["seconds", "ghi", "dni", "dhi", "sunrise", "sunset", "map"] {
        assert!(!told[key].is_null(), "{key}");
    }
    assert_eq!(told["map"], serde_json::json!([64, 32]));
    assert!(told["sunrise"].as_str().unwrap().starts_with("2023-06-21T0"));
    assert!(told["sun"]["vertical_shadow_angle_deg"].as_f64().unwrap() > 40.0);

    let mut names: Vec<String> =
        std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let expected = [
        "exposure.exr",
        "exposure.hdr",
        "exposure.png",
        "exposure_diffuse.npy",
        "exposure_direct.npy",
        "sky.exr",
        "sky.hdr",
        "sky.json",
        "sky.png",
        "sun_path.csv",
        "sun_path.svg",
        "suns.csv",
    ];
    assert_eq!(names, expected);

    // The array and the OpenEXR picture hold the same energies, the picture with the zenith at the top.
    let array: ndarray::Array2<f32> = ndarray_npy::read_npy(out.join("exposure_diffuse.npy")).unwrap();
    assert_eq!(array.dim(), (32, 64));
    let sky_kwh: f64 = array.iter().map(|&energy| f64::from(energy)).sum();
    assert!(sky_kwh > told["dhi"].as_f64().unwrap(), "no cosine is in the map");
    let picture = image::open(out.join("exposure.exr")).unwrap().to_rgb32f();
    assert_eq!(picture.dimensions(), (64, 32));
    let (row, rows) = (3, 32.0);
    let edge = |row: f64| (std::f64::consts::FRAC_PI_2 * row / rows).sin();
    let solid_angle = std::f64::consts::TAU / 64.0 * (edge(4.0) - edge(3.0));
    close(f64::from(picture.get_pixel(7, 31 - row)[1]) * solid_angle, f64::from(array[(row as usize, 7)]), 1e-5, "EXR");
    assert_eq!(image::open(out.join("sky.png")).unwrap().width(), image::open(out.join("sky.png")).unwrap().height());
}

#[test]
fn sky_knows_polar_day_and_night() {
    let at = ["sky", "--latitude", "78.2", "--longitude", "15.6", "--utc-offset", "1", "--size", "32x16", "--json"];
    let day = json(&[&at[..], &["--date", "2024-06-21"]].concat());
    assert_eq!((day["day"].as_str(), day["sunrise"].is_null()), (Some("polar day"), true));
    assert!(day["ghi"].as_f64().unwrap() > 6.0);
    let night = json(&[&at[..], &["--date", "2024-12-21"]].concat());
    assert_eq!((night["day"].as_str(), night["ghi"].as_f64()), (Some("polar night"), Some(0.0)));
}

#[test]
fn sky_keeps_a_map_where_it_is_asked_to() {
    let folder = tempfile::tempdir().unwrap();
    let cache = folder.path().join("kept");
    let arguments = ["sky", MADE, "--size", "64x32", "--json", "--cache", cache.to_str().unwrap()];
    let first = json(&arguments);
    let kept: Vec<PathBuf> = std::fs::read_dir(&cache).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(kept.len(), 1);
    let again = json(&arguments);
    for key in ["ghi", "check", "texels_dhi_off"] {
        assert_eq!(first[key], again[key], "{key}");
    }

    // A kept map that was tampered with is named and made anew.
    std::fs::write(kept[0].join("diffuse.npy"), b"no array").unwrap();
    let output = run(&arguments);
    assert!(output.status.success() && text(&output.stderr).contains("made anew"), "{}", text(&output.stderr));
    assert_eq!(json(&arguments)["texels_dhi_off"], first["texels_dhi_off"]);

    // Another question is another map.
    json(&["sky", MADE, "--size", "32x16", "--json", "--cache", cache.to_str().unwrap()]);
    assert_eq!(std::fs::read_dir(&cache).unwrap().count(), 2);
}

#[test]
fn sky_refuses_what_it_cannot_answer_in_a_line() {
    let folder = tempfile::tempdir().unwrap();
    let without_site = folder.path().join("scene.toml");
    std::fs::write(&without_site, "[geometry]\nmeshes = [\"a.obj\"]\n").unwrap();
    let half_a_site = folder.path().join("half.toml");
    std::fs::write(&half_a_site, "[geometry]\nmeshes = [\"a.obj\"]\n[site]\nlatitude_deg = 10.0\n").unwrap();
    for (arguments, code, says) in [
        (vec!["sky"], 2, "required"),
        (vec!["sky", "nowhere.epw"], 1, "nowhere.epw: cannot be read"),
        (vec!["sky", "scenes/gallery/gallery.obj"], 1, "neither a scene file"),
        (vec!["sky", without_site.to_str().unwrap()], 1, "[site] is missing"),
        (vec!["sky", half_a_site.to_str().unwrap()], 1, "longitude_deg is missing"),
        (vec!["sky", MADE, "--date", "2023-02-29"], 2, "not a day"),
        (vec!["sky", MADE, "--time", "12:00"], 2, "--date"),
        (vec!["sky", MADE, "--date", "2023-02-20", "--time", "24:10"], 2, "not a time"),
        (vec!["sky", MADE, "--size", "0x16"], 2, "1 to 8192"),
        (vec!["sky", MADE, "--step", "0"], 2, "outside 1 to 1440"),
        (vec!["sky", MADE, "--turbidity", "12"], 2, "outside 1 to 10"),
        (vec!["sky", MADE, "--band", "visible"], 1, "weather files have all light together"),
        (vec!["sky", "--latitude", "5", "--longitude", "5", "--band", "infrared"], 1, "720 nm"),
        (vec!["sky", MADE, "--clear-sky", "spectral"], 1, "the weather says"),
        (
            vec!["sky", "--latitude", "5", "--longitude", "5", "--clear-sky", "ineichen", "--band", "visible"],
            1,
            "visible light is spectral",
        ),
        (vec!["sky", "--latitude", "95", "--longitude", "5"], 2, "outside -90 to 90"),
    ] {
        let output = run(&arguments);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
        assert!(stderr.contains(says) && output.stdout.is_empty(), "{arguments:?}: {stderr}");
    }
}
