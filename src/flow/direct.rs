//! How much light comes straight from an emitter to a point?
//!
//! Exact visibility by shadow rays, weakened by glazing on the way. A point light takes one; bodies take a number of points
//! spread evenly over what they show. What is not in view gives nothing: what goes round corners is the estimators' own.

use super::sequence;
use crate::model::Model;
use glam::{DVec3, Vec3};

/// Light straight from one emitter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Direct {
    /// Irradiance, or without a normal scalar irradiance, W/m2.
    pub value_w_m2: f64,
    /// Integral of L(w) w dw, w pointing away from the point (with a normal: over its hemisphere), W/m2.
    pub flux_w_m2: DVec3,
}

/// Light straight from emitter number `emitter` to a point that stands clear of its own surface by
/// [`Rays::epsilon_m`](crate::rays::Rays::epsilon_m). `samples` shadow rays (for point lights one, to
/// bodies close by more), placed by `offset`.
pub fn direct(
    model: &Model,
    position_m: Vec3,
    normal: Option<Vec3>,
    emitter: usize,
    samples: u32,
    offset: [f64; 2],
) -> Direct {
    let mut sum = Direct::default();
    let mut taken = 0;
    let samples = samples.max(1) * model.sampler.nearness(emitter, position_m);
    for index in 0..samples {
        let sample = model.sampler.sample(emitter, position_m, sequence::square(index, offset));
        taken += 1;
        let Some(light) = sample else { continue };
        let cosine = normal.map_or(1.0, |normal| f64::from(normal.dot(light.direction)));
        if cosine > 0.0 {
            let share = model.rays.transmitted_past(position_m, light.end_m, |_| false);
            let irradiance_w_m2 = f64::from(share) * light.irradiance_w_m2;
            sum.value_w_m2 += cosine * irradiance_w_m2;
            sum.flux_w_m2 += irradiance_w_m2 * light.direction.as_dvec3();
        }
        if light.density_per_sr.is_none() {
            break;
        }
    }
    Direct { value_w_m2: sum.value_w_m2 / f64::from(taken), flux_w_m2: sum.flux_w_m2 / f64::from(taken) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::{FLUX_W, close, lamp, modelled, room};
    use crate::scene::Light;
    use std::f64::consts::PI;

    #[test]
    fn a_point_is_the_inverse_square_and_the_cosine() {
        let (_, model) = modelled(&room(), vec![lamp(Vec3::new(1.0, 1.0, 2.0), FLUX_W)], Vec::new());
        let at_m = Vec3::new(1.0, 2.0, 1.0);
        let scalar = direct(&model, at_m, None, 0, 16, [0.0; 2]);
        close(scalar.value_w_m2, FLUX_W / (8.0 * PI));
        close(direct(&model, at_m, Some(Vec3::Z), 0, 16, [0.0; 2]).value_w_m2, FLUX_W / (8.0 * PI) / 2.0_f64.sqrt());
        assert_eq!(direct(&model, at_m, Some(Vec3::Y), 0, 16, [0.0; 2]), Direct::default());
        assert!(scalar.flux_w_m2.normalize().distance(DVec3::new(0.0, -1.0, 1.0).normalize()) < 1e-6);
    }

    #[test]
    fn bodies_give_what_their_shape_gives() {
        // A Lambertian square over a point that faces it: four corners of the closed form; and a sphere, which acts as a point.
        let quad = Light::Quad { corner_m: Vec3::new(1.0, 1.0, 2.5), u_m: Vec3::Y, v_m: Vec3::X, flux_w: FLUX_W };
        let (_, model) = modelled(&room(), vec![quad], Vec::new());
        let found = direct(&model, Vec3::new(1.5, 1.5, 1.5), Some(Vec3::Z), 0, 256, [0.0; 2]).value_w_m2;
        let half = 0.5_f64;
        let corner = 2.0 / (2.0 * PI) * half / (1.0 + half * half).sqrt() * (half / (1.0 + half * half).sqrt()).atan();
        assert!((found / (FLUX_W * 4.0 * corner) - 1.0).abs() < 0.01, "{found}");

        let ball = Light::Sphere { centre_m: Vec3::new(1.5, 1.5, 2.0), radius_m: 0.3, flux_w: FLUX_W };
        let (_, model) = modelled(&room(), vec![ball], Vec::new());
        let found = direct(&model, Vec3::new(1.5, 1.5, 1.0), Some(Vec3::Z), 0, 64, [0.0; 2]).value_w_m2;
        assert!((found / (FLUX_W / (4.0 * PI)) - 1.0).abs() < 1e-3, "{found}");
    }
}
