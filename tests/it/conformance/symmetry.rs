//! What does not care where, how large or which way round the world is.

use super::cases::{Case, VOXEL_M, both_rooms, moved};
use super::{Breaches, Law, Subject};
use glam::{Mat3, Vec3};
use lightvein::light::Reading;
use lightvein::scene::Method;

/// A power of two scales every coordinate without rounding: all lengths are in proportion, and so must all decisions be.
const EXACT: f64 = 1e-9;

/// By whole voxels, only the epsilon of the rays changes; of a sensor's rays, some hundred, one or two at edges may meet
/// another wall.
const SHIFT: f64 = 0.02;

/// Mirrored or turned, ties break and samples fall the other way: the factors that issue 3 allows a rotation; for the
/// heuristics, what their voxels allow.
fn turned_factor(method: Method) -> f64 {
    match method {
        // The way round the door's jamb by nodes that lie a voxel off.
        Method::Backward => 1.3,
        // The door's half-width is 4 voxels or 5, and counts by its square: 1.56, and the way besides.
        Method::Forward => 1.8,
        Method::Diffusion => 1.3,
        // Noise is allowed for apart.
        Method::Trace => 1.01,
        Method::Network => 1.1,
    }
}

/// The largest angle that a mirror or turn may put between directions, degrees: the median that issue 3 allows against truth.
/// Directions of `forward` are those of steps between nodes, of `diffusion` those of currents along edges.
fn turned_angle_deg(method: Method) -> f64 {
    match method {
        Method::Forward => 25.0,
        Method::Diffusion => 20.0,
        Method::Backward | Method::Network | Method::Trace => 10.0,
    }
}

pub const SCALED: Law = Law {
    name: "scaled",
    test: |subject, breaches| {
        let scene = both_rooms();
        let one = Case::of(scene.clone());
        let readings = subject.field(&one).readings;
        for scale in [2.0_f32, 0.25] {
            let case = Case::at(moved(&scene, Mat3::IDENTITY, scale, Vec3::ZERO), scale * VOXEL_M);
            let area = f64::from(scale).powi(2);
            for (at, (one, other)) in readings.iter().zip(&subject.field(&case).readings).enumerate() {
                let what = format!("scale {scale}, {}", case.id(at));
                breaches.unless_within(EXACT, &what, area * other.value_w_m2, one.value_w_m2);
                let apart = (area * other.flux_w_m2).distance(one.flux_w_m2);
                breaches.unless(apart <= EXACT * one.value_w_m2, || format!("{what}: flux off by {apart:.3e}"));
                breaches.unless(one.status == other.status, || format!("{what}: {:?}", other.status));
            }
        }
    },
};

pub const SHIFTED: Law = Law {
    name: "shifted",
    test: |subject, breaches| {
        let scene = both_rooms();
        let readings = subject.field(&Case::of(scene.clone())).readings;
        for voxels in [Vec3::new(16.0, -8.0, 3.0), Vec3::new(-41.0, 5.0, 80.0)] {
            let case = Case::of(moved(&scene, Mat3::IDENTITY, 1.0, VOXEL_M * voxels));
            for (at, (one, other)) in readings.iter().zip(&subject.field(&case).readings).enumerate() {
                let what = format!("shift {voxels} voxels, {}", case.id(at));
                let noise = subject.noise_w_m2(&[one, other]);
                let off = (other.value_w_m2 - one.value_w_m2).abs();
                breaches.unless(off <= SHIFT * one.value_w_m2 + noise, || {
                    format!("{what}: {:.6e} was {:.6e}", other.value_w_m2, one.value_w_m2)
                });
                breaches.unless(one.status == other.status, || format!("{what}: {:?}", other.status));
            }
        }
    },
};

pub const MIRRORED: Law = Law {
    name: "mirrored",
    test: |subject, breaches| {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            turned(subject, breaches, Mat3::from_diagonal(Vec3::ONE - 2.0 * axis), &format!("mirror {axis}"));
        }
    },
};

pub const TURNED: Law = Law {
    name: "turned",
    test: |subject, breaches| {
        // Quarter turns about z, and one that stands the rooms on end.
        let quarter = Mat3::from_cols(Vec3::Y, Vec3::NEG_X, Vec3::Z);
        turned(subject, breaches, quarter, "quarter turn");
        turned(subject, breaches, quarter * quarter, "half turn");
        turned(subject, breaches, Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X), "axes in turn");
    },
};

/// Directions of a flux below this share of the value are noise.
const DIRECTED: f64 = 0.2;

fn turned(subject: &Subject, breaches: &mut Breaches, turn: Mat3, what: &str) {
    let scene = both_rooms();
    let readings = subject.field(&Case::of(scene.clone())).readings;
    let case = Case::of(moved(&scene, turn, 1.0, Vec3::ZERO));
    let factor = turned_factor(subject.method);
    for (at, (one, other)) in readings.iter().zip(&subject.field(&case).readings).enumerate() {
        let what = format!("{what}, {}", scene.sensors[at].id);
        let noise_w_m2 = subject.noise_w_m2(&[one, other]);
        if (other.value_w_m2 - one.value_w_m2).abs() > noise_w_m2 {
            breaches.unless_factor(factor, &what, other.value_w_m2, one.value_w_m2);
        }
        let angle_deg = (turn.as_dmat3() * one.direction()).angle_between(other.direction()).to_degrees();
        let noise_deg = (noise_w_m2 / one.flux_w_m2.length()).to_degrees();
        let holds = !directed(one) || angle_deg <= turned_angle_deg(subject.method) + noise_deg;
        breaches.unless(holds, || format!("{what}: directions {angle_deg:.1} degrees apart"));
    }
}

fn directed(reading: &Reading) -> bool {
    reading.flux_w_m2.length() > DIRECTED * reading.value_w_m2
}
