use super::*;
use crate::job::Quiet;
use crate::scene::Site;
use crate::sky::site::Outdoors;
use crate::sky::steps::Period;

/// A clear period at a latitude.
fn clear(latitude_deg: f64, turbidity: f64, period: Period) -> Steps {
    let site = Site {
        latitude_deg: Some(latitude_deg),
        longitude_deg: Some(0.0),
        utc_offset_h: Some(0.0),
        turbidity: Some(turbidity),
        ..Site::default()
    };
    Outdoors { period, ..Outdoors::of(&site, None).unwrap() }.steps().unwrap()
}

fn build(steps: &Steps, settings: MapSettings) -> ExposureMap {
    ExposureMap::build(steps, &settings, &Quiet, &Cancel::new()).unwrap()
}

/// Largest error of the sky's part against the full sum, in the texels that hold 99.9% of its energy.
fn largest_error(map: &ExposureMap, full: &ExposureMap) -> f64 {
    let least = least_counted(&full.diffuse_kwh_m2);
    let texels = map.diffuse_kwh_m2.iter().zip(&full.diffuse_kwh_m2).filter(|(_, full)| **full >= least);
    texels.map(|(some, full)| (f64::from(*some) / f64::from(*full) - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn what_is_interpolated_is_within_half_a_percent_of_the_full_sum() {
    let day = |month, day| Period { first: (month, day), last: (month, day), step_min: 60.0 };
    let hour = Period { step_min: 720.0, ..day(6, 21) };
    for model in SkyModel::ALL {
        for (latitude, turbidity, period) in [
            (42.0, 3.0, Period::YEAR),
            (0.0, 6.0, Period { step_min: 180.0, ..Period::YEAR }),
            (-75.0, 2.0, day(12, 21)),
            (51.5, 3.0, day(3, 20)),
            (42.0, 3.0, hour),
        ] {
            let steps = clear(latitude, turbidity, period);
            let settings = MapSettings { size: [256, 128], model, ..MapSettings::default() };
            let map = build(&steps, settings);
            let full = build(&steps, MapSettings { tolerance: None, ..settings });
            let error = largest_error(&map, &full);
            println!("{model:?} {latitude} {period:?}: {error:.5}, {:?}", map.check);
            assert!(error < 0.005, "{model:?} {latitude} {period:?}: {error}");
            assert_eq!(map.direct_kwh_m2, full.direct_kwh_m2);
        }
    }
}

#[test]
fn the_texels_hold_what_the_period_brings() {
    for (model, latitude, size) in [
        (SkyModel::Perez, 42.0, [128, 128]),
        (SkyModel::Hosek, 65.0, [100, 70]),
        (SkyModel::Isotropic, 5.0, [512, 512]),
    ] {
        let steps = clear(latitude, 3.0, Period::YEAR);
        let map = build(&steps, MapSettings { size, model, ..MapSettings::default() });
        let (texels, totals) = (map.texel_totals(), map.totals);
        for (of_texels, of_steps) in [
            (texels.ghi_kwh_m2, totals.ghi_kwh_m2),
            (texels.dni_kwh_m2, totals.dni_kwh_m2),
            (texels.dhi_kwh_m2, totals.dhi_kwh_m2),
        ] {
            println!("{model:?} {size:?}: {of_texels:.3} {of_steps:.3} {:.5}", of_texels / of_steps - 1.0);
            assert!((of_texels / of_steps - 1.0).abs() < 0.002, "{model:?}: {of_texels} against {of_steps}");
        }
    }
}

#[test]
fn the_least_that_counts_is_that_of_sorted_energies() {
    // Halves are exact, so that sums do not depend on their order; many are alike.
    let energies: Vec<f32> = (0..5000_u32).map(|number| ((number * 7919) % 613) as f32 * 0.5).collect();
    for energies in [&energies[..], &energies[..1], &energies[..2], &energies[..1001], &[0.0; 9], &[]] {
        let mut sorted = energies.to_vec();
        sorted.sort_by(|a, b| b.total_cmp(a));
        let all: f64 = sorted.iter().map(|&energy| f64::from(energy)).sum();
        let held = sorted.iter().scan(0.0, |held, &energy| {
            *held += f64::from(energy);
            Some((energy, *held))
        });
        let want = held.into_iter().find(|(_, held)| *held >= COUNTED_ENERGY * all).map_or(0.0, |(energy, _)| energy);
        assert_eq!(least_counted(energies), want, "of {}", energies.len());
    }
}

#[test]
fn a_flag_raised_on_the_way_stops_within_a_texel() {
    // A year of quarters of an hour in every texel of a row of 8192 would take seconds.
    let steps = clear(42.0, 3.0, Period { step_min: 15.0, ..Period::YEAR });
    let cancel = Cancel::new();
    let settings = MapSettings { size: [8192, 1], tolerance: None, ..MapSettings::default() };
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(std::time::Duration::from_millis(50));
            cancel.cancel();
        });
        assert!(ExposureMap::build(&steps, &settings, &Quiet, &cancel).is_err());
    });
}
