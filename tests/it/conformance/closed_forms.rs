//! Scenes whose light is known by energy alone, a closed room and two spheres; and how far from the truth is too far.

use super::cases::{Case, point, room, scene_of, sensor};
use super::coupled_spheres::{lamp, mean_irradiances, sensors, spheres};
use super::{Breaches, Law, Subject, settings};
use glam::Vec3;
use lightvein::light::{Reading, Settings};
use lightvein::scene::{Method, Sensor};

/// What a method may be off in a scene with a closed form, a factor: the bounds against references, tighter where
/// energy alone decides.
pub struct Allowed {
    pub control: f64,
    pub diffusion: f64,
    pub other: f64,
}

impl Allowed {
    pub fn of(&self, method: Method) -> f64 {
        match method {
            Method::Trace => self.control,
            Method::Diffusion => self.diffusion,
            Method::Backward | Method::Forward | Method::Network => self.other,
        }
    }
}

/// The weighted mean of readings and its standard error, where the method is the control.
fn mean(subject: &Subject, readings: &[Reading], weights: &[f64]) -> (f64, f64) {
    let total: f64 = weights.iter().sum();
    let sum: f64 = readings.iter().zip(weights).map(|(reading, weight)| reading.value_w_m2 * weight).sum();
    let squares =
        readings.iter().zip(weights).map(|(reading, weight)| (subject.noise_w_m2(&[reading]) * weight).powi(2));
    (sum / total, squares.sum::<f64>().sqrt() / total)
}

/// Sensors on the walls of a room in a grid of `steps` x `steps` a wall, and the area that each stands for.
fn on_walls(size: Vec3, steps: usize) -> (Vec<Sensor>, Vec<f64>) {
    let mut sensors = Vec::new();
    let mut areas_m2 = Vec::new();
    for (axis, side, cell) in
        (0..3).flat_map(|axis| (0..2).flat_map(move |side| (0..steps * steps).map(move |cell| (axis, side, cell))))
    {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (mut at, mut normal) = (Vec3::ZERO, Vec3::ZERO);
        at[u] = size[u] * ((cell / steps) as f32 + 0.5) / steps as f32;
        at[v] = size[v] * ((cell % steps) as f32 + 0.4) / steps as f32;
        at[axis] = side as f32 * size[axis];
        normal[axis] = 1.0 - 2.0 * side as f32;
        sensors.push(sensor(at, Some(normal)));
        areas_m2.push(f64::from(size[u] * size[v]) / (steps * steps) as f64);
    }
    (sensors, areas_m2)
}

/// A closed room: what the light gives, the walls absorb, `Phi = (1 - rho) A mean E`.
pub const FURNACE: Law = Law {
    name: "furnace",
    test: |subject, breaches| {
        let (size, flux_w) = (Vec3::new(4.0, 3.0, 2.5), 50.0);
        let (sensors, areas_m2) = on_walls(size, 8);
        let area_m2: f64 = areas_m2.iter().sum();
        for reflectance in [0.3_f32, 0.5, 0.8, 0.99] {
            let lights = vec![point(Vec3::new(1.90625, 1.40625, 1.28125), flux_w)];
            let case = Case::of(scene_of(room(size), reflectance, lights, sensors.clone()));
            let readings = subject.field_with(&case, &Settings { samples: 48, ..settings() }).readings;
            let (found, noise) = mean(subject, &readings, &areas_m2);
            let expected = flux_w / (area_m2 * (1.0 - f64::from(reflectance)));
            // Beside noise, the grid of sensors is 1% off in the direct light.
            let share = Allowed { control: 0.01, diffusion: 0.03, other: 0.03 }.of(subject.method);
            breaches.unless((found - expected).abs() <= share * expected + noise, || {
                format!("reflectance {reflectance}: a mean of {found} W/m2, not {expected}")
            });
        }
    },
};

/// Two spheres that meet in a port: the second has its light from the first's walls alone.
pub const SPHERES: Law = Law {
    name: "coupled spheres",
    test: |subject, breaches| {
        let count = 160;
        for reflectance in [0.5_f32, 0.8] {
            let [first, second] = [0, 1].map(|sphere| sensors(sphere, count));
            let scene = scene_of(spheres(), reflectance, vec![lamp(50.0)], [first, second].concat());
            let case = Case::at(scene, 0.1);
            let readings = subject.field_with(&case, &Settings { samples: 96, ..settings() }).readings;
            let expected = mean_irradiances(50.0, f64::from(reflectance));
            for (sphere, expected) in expected.into_iter().enumerate() {
                let some = readings.get(sphere * count..(sphere + 1) * count).unwrap_or_default();
                let (found, noise) = mean(subject, some, &vec![1.0; count]);
                // Beyond the port `diffusion` is no result below .7.
                let diffusion = if sphere == 1 && reflectance < 0.7 { 3.0 } else { 1.3 };
                let allowed = Allowed { control: 1.02, diffusion, other: 1.1 }.of(subject.method);
                let ratio = found / expected;
                let slack = noise / expected;
                breaches.unless(ratio <= allowed + slack && ratio >= 1.0 / allowed - slack, || {
                    format!("reflectance {reflectance}, sphere {}: {found} W/m2, not {}", sphere + 1, expected)
                });
            }
        }
    },
};

/// No single reading may be off by more than this factor, whatever the reflectance.
const LARGEST: f64 = 1.6;

/// Notes a breach unless the readings lie within a root mean square factor of the truth and no one beyond [`LARGEST`], or
/// beyond that factor where it is the larger; noise of the control is taken off each.
pub fn near(
    subject: &Subject,
    breaches: &mut Breaches,
    readings: &[Reading],
    truth_w_m2: &[f64],
    rms_factor: f64,
    place: impl Fn(usize) -> String,
) {
    breaches.unless(readings.len() == truth_w_m2.len(), || format!("{} readings", readings.len()));
    let mut squares = 0.0;
    for (at, (reading, truth)) in readings.iter().zip(truth_w_m2).enumerate() {
        let noise = subject.noise_w_m2(&[reading]) / truth;
        let ratio = reading.value_w_m2 / truth;
        let off = (ratio.log10().abs() - (1.0 + noise).log10()).max(0.0);
        squares += off * off;
        let holds = off <= LARGEST.max(rms_factor.powi(2)).log10();
        breaches.unless(holds, || format!("{}: {:.4e} W/m2, not {truth:.4e}", place(at), reading.value_w_m2));
    }
    let rms = 10.0_f64.powf((squares / truth_w_m2.len() as f64).sqrt());
    breaches.unless(rms <= rms_factor, || format!("{}: a root mean square factor of {rms:.3}", place(0)));
}
