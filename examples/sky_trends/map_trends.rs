//! Trends of the exposure map: clear years by latitude and by turbidity, as pictures, a table and curves.

use lightvein::export::curves::{self, Axis, Curve, Panel as Chart};
use lightvein::export::exposure::picture::{Panel, draw_many};
use lightvein::export::whole_file;
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::Site;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::{ClearSky, Outdoors};
use lightvein::sky::steps::Totals;
use std::error::Error;
use std::path::Path;

const LATITUDES_DEG: [f64; 6] = [0.0, 25.0, 42.0, 51.5, 66.0, 80.0];
const TURBIDITIES: [f64; 4] = [2.0, 3.0, 5.0, 8.0];

/// What stays as it is while the other changes.
const LATITUDE_DEG: f64 = 42.0;
const TURBIDITY: f64 = 3.0;

/// Step of the maps, minutes: so short that the suns of an hour run together.
const STEP_MIN: f64 = 4.0;

/// Step of the curves, minutes.
const CURVE_STEP_MIN: f64 = 60.0;

/// Texels of the maps, one a pixel.
const SIZE: [usize; 2] = [240, 120];

/// Bands of elevation in the table, each of 15 degrees.
const BANDS: usize = 6;

/// A clear year and its map.
struct Year {
    title: String,
    map: ExposureMap,
    /// What the year brings by the spectral transmittances instead of Linke's turbidity.
    spectral: Totals,
}

/// Writes the pictures into a folder and prints the table.
pub fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    let by_latitude = LATITUDES_DEG.map(|latitude_deg| (format!("{latitude_deg}\u{b0} N"), latitude_deg, TURBIDITY));
    let by_turbidity = TURBIDITIES.map(|turbidity| (format!("turbidity {turbidity}"), LATITUDE_DEG, turbidity));
    let [by_latitude, by_turbidity] = [years(&by_latitude)?, years(&by_turbidity)?];
    draw_maps(&folder.join("maps_by_latitude.png"), &by_latitude, 3)?;
    draw_maps(&folder.join("maps_by_turbidity.png"), &by_turbidity, 2)?;
    let charts = [chart_by_latitude()?, chart_by_turbidity()?];
    whole_file(&folder.join("irradiation.svg"), |out| curves::write(out, &charts, 2))?;
    print(by_latitude.iter().chain(&by_turbidity));
    Ok(())
}

/// The clear sky of a year at the meridian of Greenwich.
fn clear(latitude_deg: f64, turbidity: f64, step_min: f64) -> Result<Outdoors, Box<dyn Error>> {
    let site = Site {
        latitude_deg: Some(latitude_deg),
        longitude_deg: Some(0.0),
        turbidity: Some(turbidity),
        step_min: Some(step_min),
        ..Site::default()
    };
    Ok(Outdoors::of(&site, None)?)
}

/// Clear years by title, latitude and turbidity.
fn years(asked: &[(String, f64, f64)]) -> Result<Vec<Year>, Box<dyn Error>> {
    let year = |(title, latitude_deg, turbidity): &(String, f64, f64)| {
        let outdoors = clear(*latitude_deg, *turbidity, STEP_MIN)?;
        let settings = MapSettings { size: SIZE, model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
        let map = ExposureMap::build(&outdoors.steps()?, &settings, &Quiet, &Cancel::new())?;
        let spectral = Outdoors { clear_sky: ClearSky::Spectral, ..outdoors }.steps()?.totals();
        Ok(Year { title: title.clone(), map, spectral })
    };
    asked.iter().map(year).collect()
}

fn draw_maps(path: &Path, years: &[Year], columns: usize) -> Result<(), Box<dyn Error>> {
    let panels: Vec<Panel> = years.iter().map(|year| Panel { title: year.title.clone(), map: &year.map }).collect();
    let picture = draw_many(&panels, columns, SIZE)?;
    Ok(whole_file(path, |out| out.write_all(&picture.bytes))?)
}

/// Irradiations, the shares of what comes through the map by elevation, and how far the map is off.
fn print<'a>(years: impl Iterator<Item = &'a Year>) {
    println!("Clear years, steps of {STEP_MIN} minutes, maps of {} x {}:\n", SIZE[0], SIZE[1]);
    println!(
        "| year | GHI | DNI | DHI | 0-15\u{b0} | 15-30\u{b0} | 30-45\u{b0} | 45-60\u{b0} | 60-75\u{b0} | 75-90\u{b0} | error, rms | largest | spectral GHI | DNI | DHI |"
    );
    println!("|---|{}", "---:|".repeat(14));
    let three =
        |totals: Totals| format!("{:.0} | {:.0} | {:.0}", totals.ghi_kwh_m2, totals.dni_kwh_m2, totals.dhi_kwh_m2);
    for Year { title, map, spectral } in years {
        let shares = shares(map).map(|share| format!("{:.1}%", 100.0 * share)).join(" | ");
        let [rms, largest] = [map.check.rms, map.check.largest].map(|share| format!("{:.4}%", 100.0 * share));
        println!("| {title} | {} | {shares} | {rms} | {largest} | {} |", three(map.totals), three(*spectral));
    }
    println!();
}

/// How much of all energy through the texels, sky and beams, comes from each band of elevation.
fn shares(map: &ExposureMap) -> [f64; BANDS] {
    let mut bands = [0.0; BANDS];
    let [columns, rows] = map.size;
    for (texel, (diffuse, direct)) in map.diffuse_kwh_m2.iter().zip(&map.direct_kwh_m2).enumerate() {
        bands[(2 * (texel / columns) + 1) * BANDS / (2 * rows)] += f64::from(diffuse + direct);
    }
    let all: f64 = bands.iter().sum();
    bands.map(|band| band / all)
}

fn chart_by_latitude() -> Result<Chart, Box<dyn Error>> {
    let curves = curves((0..=36).map(|step| 2.5 * f64::from(step)), |latitude_deg| (latitude_deg, TURBIDITY))?;
    let x = Axis::every("latitude (degrees north)", [0.0, 90.0], 15.0);
    Ok(chart(format!("Clear year, turbidity {TURBIDITY}"), x, curves))
}

fn chart_by_turbidity() -> Result<Chart, Box<dyn Error>> {
    let curves = curves((0..=36).map(|step| 1.0 + 0.25 * f64::from(step)), |turbidity| (LATITUDE_DEG, turbidity))?;
    let x = Axis::every("turbidity (Linke)", [1.0, 10.0], 1.0);
    Ok(chart(format!("Clear year, {LATITUDE_DEG}\u{b0} N"), x, curves))
}

fn chart(title: String, x: Axis, curves: Vec<Curve>) -> Chart {
    Chart { title, x, y: Axis::every("kWh/m\u{b2} a year", [0.0, 5000.0], 1000.0), curves }
}

/// What a year brings, along latitudes or turbidities.
fn curves(along: impl Iterator<Item = f64>, sky: impl Fn(f64) -> (f64, f64)) -> Result<Vec<Curve>, Box<dyn Error>> {
    let mut points = [const { Vec::new() }; 3];
    for x in along {
        let (latitude_deg, turbidity) = sky(x);
        let totals = clear(latitude_deg, turbidity, CURVE_STEP_MIN)?.steps()?.totals();
        for (points, y) in points.iter_mut().zip([totals.ghi_kwh_m2, totals.dni_kwh_m2, totals.dhi_kwh_m2]) {
            points.push([x, y]);
        }
    }
    let names = ["global horizontal", "direct normal", "diffuse horiz."];
    Ok(names.into_iter().zip(points).map(|(name, points)| Curve { name: name.to_owned(), points }).collect())
}
