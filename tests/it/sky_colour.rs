//! Hosek and Wilkie's sky against Mitsuba's, in RGB and by wavelength.

use lightvein::sky::hosek::{Hosek, HosekSpectrum, WAVELENGTHS_NM};
use lightvein::sky::towards;

/// Written by `benches/peers/sky_mitsuba.py rgb`.
const RGB: &str = include_str!("../data/hosek_mitsuba.csv");
/// Written by `benches/peers/sky_mitsuba.py spectral`.
const SPECTRAL: &str = include_str!("../data/hosek_spectral_mitsuba.csv");

/// Our RGB values over Mitsuba's: it scales by the integral of CIE's y.
const MITSUBA_SCALE: f64 = 106.75;

#[test]
fn rgb_is_mitsubas() {
    let rows = rows(RGB, 8);
    assert!(rows.len() > 400, "{} rows", rows.len());
    let mut worst = 0.0f64;
    for row in rows {
        let (cos_zenith, cos_gamma) = cosines(&row);
        let ours = Hosek::new(row[0].to_radians(), row[1], row[2]).radiance_rgb(cos_zenith, cos_gamma);
        for (value, want) in ours.iter().zip(&row[5..8]) {
            worst = worst.max(off(*value, want * MITSUBA_SCALE, &row));
        }
    }
    println!("worst: {worst:.1e}");
}

#[test]
fn wavelengths_are_mitsubas() {
    let rows = rows(SPECTRAL, 7);
    assert!(rows.len() > 250, "{} rows", rows.len());
    let mut worst = 0.0f64;
    for row in rows {
        let (cos_zenith, cos_gamma) = cosines(&row);
        let radiance = HosekSpectrum::new(row[0].to_radians(), row[1], row[2]).radiance(cos_zenith, cos_gamma);
        let cell = WAVELENGTHS_NM.iter().rposition(|nm| *nm <= row[5]).unwrap().min(WAVELENGTHS_NM.len() - 2);
        let share = (row[5] - WAVELENGTHS_NM[cell]) / (WAVELENGTHS_NM[cell + 1] - WAVELENGTHS_NM[cell]);
        let ours = radiance[cell] * (1.0 - share) + radiance[cell + 1] * share;
        worst = worst.max(off(ours, row[6], &row));
    }
    println!("worst: {worst:.1e}");
}

/// The relative difference; Mitsuba lets the fit's few negative values stand, ours are 0.
#[track_caller]
fn off(ours: f64, mitsubas: f64, row: &[f64]) -> f64 {
    if mitsubas <= 0.0 {
        assert_eq!(ours, 0.0, "{row:?}");
        return 0.0;
    }
    let off = (ours / mitsubas - 1.0).abs();
    assert!(off < 1e-4, "{row:?}: {ours} {mitsubas}");
    off
}

/// Cosines of a row's view to the zenith and to the sun.
fn cosines(row: &[f64]) -> (f64, f64) {
    let (sun, view) = (towards(0.0, row[0].to_radians()), towards(row[3].to_radians(), row[4].to_radians()));
    (view.z, view.dot(sun))
}

/// The numbers of a table after its comments and its head.
fn rows(table: &str, columns: usize) -> Vec<Vec<f64>> {
    let lines = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    let rows: Vec<Vec<f64>> = lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert!(rows.iter().all(|row| row.len() == columns));
    rows
}
