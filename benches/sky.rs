//! What does a year's exposure map cost, and how far is it from the full sum?
//!
//!     cargo bench --bench sky
//!
//! Clear years and, where a weather file is named, that one: `cargo bench --bench sky -- --weather x.epw`. Medians of runs
//! in turn: map, full sum.

use lightvein::job::{Cancel, Quiet};
use lightvein::scene::Site;
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings, least_counted};
use lightvein::sky::site::Outdoors;
use std::time::Instant;

fn main() {
    for tolerance in [0.0005, 0.001, 0.002] {
        for model in SkyModel::ALL {
            let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
            let outdoors = Outdoors::of(&site, None).unwrap();
            let begin = Instant::now();
            let steps = outdoors.steps().unwrap();
            let steps_s = begin.elapsed().as_secs_f64();
            let settings = MapSettings { model, tolerance: Some(tolerance), ..MapSettings::default() };
            let begin = Instant::now();
            let map = ExposureMap::build(&steps, &settings, &Quiet, &Cancel::new()).unwrap();
            let map_s = begin.elapsed().as_secs_f64();
            let begin = Instant::now();
            let full = ExposureMap::build(&steps, &MapSettings { tolerance: None, ..settings }, &Quiet, &Cancel::new())
                .unwrap();
            let full_s = begin.elapsed().as_secs_f64();
            let least = least_counted(&full.diffuse_kwh_m2);
            let texels = map.diffuse_kwh_m2.iter().zip(&full.diffuse_kwh_m2).filter(|(_, full)| **full >= least);
            let error =
                texels.map(|(some, full)| (f64::from(*some) / f64::from(*full) - 1.0).abs()).fold(0.0, f64::max);
            println!(
                "{tolerance} {model:?}: steps {steps_s:.3} map {map_s:.3} full {full_s:.3} error {error:.5} {:?}",
                map.check
            );
        }
    }
}
