//! What should not change an estimate: other lattices, other axes; and what should, by a known amount: other reflectances.
//!
//! Offsets and turns are those of a low-discrepancy sequence (M. Roberts 2018: steps by the powers of the root of
//! x^4 = x + 1), so that a few of them cover all there are evenly; turns by Shoemake's map of the unit cube to rotations (1992).

use crate::light::Field;
use crate::scene::{Light, Scene};
use glam::{Quat, Vec3};
use std::f64::consts::TAU;

/// Inverse powers of the root of x^4 = x + 1.
const R3: [f64; 3] = [0.819_172_513_396_164_5, 0.671_043_606_703_789_3, 0.549_700_477_901_970_3];

/// Point number `index` of the sequence in the unit cube.
pub fn cube(index: u32) -> [f64; 3] {
    R3.map(|step| (0.5 + step * f64::from(index + 1)).fract())
}

/// Offset number `index` of the lattice, voxels: in the unit cube.
pub fn offset_voxels(index: u32) -> Vec3 {
    Vec3::from_array(cube(index).map(|part| part as f32))
}

/// Turn number `index`: even over all rotations.
pub fn turn(index: u32) -> Quat {
    let [share, first, second] = cube(index);
    let [low, high] = [(1.0 - share).sqrt(), share.sqrt()];
    let [(s1, c1), (s2, c2)] = [first, second].map(|turns| (TAU * turns).sin_cos());
    Quat::from_array([low * s1, low * c1, high * s2, high * c2].map(|part| part as f32)).normalize()
}

/// The scene turned as a whole about the middle of its mesh: walls, lights, sensors and their normals. References are left
/// out: theirs are the directions before.
pub fn turned(scene: &Scene, turn: Quat) -> Scene {
    let middle_m = scene.mesh.bounds_m().map_or(Vec3::ZERO, |(low, high)| 0.5 * (low + high));
    let at = |point_m: Vec3| middle_m + turn * (point_m - middle_m);
    let mut turned = Scene { reference: Vec::new(), ..scene.clone() };
    turned.mesh.positions_m.iter_mut().for_each(|position_m| *position_m = at(*position_m));
    for light in &mut turned.lights {
        match light {
            Light::Point { position_m: centre_m, .. } | Light::Sphere { centre_m, .. } => *centre_m = at(*centre_m),
            Light::Quad { corner_m, u_m, v_m, .. } => {
                (*corner_m, *u_m, *v_m) = (at(*corner_m), turn * *u_m, turn * *v_m);
            }
        }
    }
    for sensor in &mut turned.sensors {
        sensor.position_m = at(sensor.position_m);
        sensor.normal = sensor.normal.map(|normal| (turn * normal).normalize());
    }
    turned
}

/// A field of a turned scene with the directions that it would have had before.
pub fn turned_back(mut field: Field, turn: Quat) -> Field {
    let back = turn.inverse().as_dquat();
    field.readings.iter_mut().for_each(|reading| reading.flux_w_m2 = back * reading.flux_w_m2);
    field
}

/// The scene with that reflectance on all its walls; glazing keeps what it passes on, lights stay black.
pub fn with_reflectance(scene: &Scene, reflectance: f32) -> Scene {
    let mut scene = Scene { reference: Vec::new(), ..scene.clone() };
    for material in scene.materials.iter_mut().filter(|material| !material.emits()) {
        material.reflectance = reflectance.min(1.0 - material.transmittance);
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{lamp, sensor};
    use crate::voxel::test_scenes::{boxed, scene_of};

    #[test]
    fn steps_are_powers_of_the_root() {
        let root = 1.0 / R3[0];
        assert!((root.powi(4) - root - 1.0).abs() < 1e-12);
        assert!((R3[1] * root.powi(2) - 1.0).abs() < 1e-12 && (R3[2] * root.powi(3) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn turns_cover_all_directions() {
        let mean = (0..64).map(|index| turn(index) * Vec3::Z).sum::<Vec3>() / 64.0;
        assert!(mean.length() < 0.1, "{mean}");
    }

    #[test]
    fn turning_keeps_all_distances_and_turning_back_all_directions() {
        let mut scene = scene_of(&boxed(Vec3::ZERO, Vec3::new(4.0, 3.0, 2.0)));
        scene.lights.push(lamp(Vec3::ONE, 1.0));
        scene.sensors.push(sensor(Vec3::new(3.0, 2.0, 1.5), Some(Vec3::Z)));
        let quarter = turn(3);
        let after = turned(&scene, quarter);
        let apart = |scene: &Scene| {
            let [Light::Point { position_m, .. }] = scene.lights[..] else { panic!("a lamp") };
            let sensor = &scene.sensors[0];
            let corner_m = scene.mesh.positions_m[7];
            let up = sensor.normal.unwrap().dot(position_m - sensor.position_m);
            [position_m.distance(sensor.position_m), corner_m.distance(sensor.position_m), up]
        };
        for (before, after) in apart(&scene).into_iter().zip(apart(&after)) {
            assert!((before - after).abs() < 1e-5);
        }
        let flux_w_m2 = (quarter * Vec3::X).as_dvec3();
        let reading = crate::light::Reading { flux_w_m2, ..crate::light::Reading::none(crate::light::Status::Ok) };
        let back = turned_back(Field { readings: vec![reading], ..Field::default() }, quarter);
        assert!(back.readings[0].flux_w_m2.distance(glam::DVec3::X) < 1e-6);
    }
}
