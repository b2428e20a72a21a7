//! What two spheres with a common port exchange, and their mesh.
//!
//! In a sphere every element of the wall sees each part of the wall, and the cap that a port cuts off, by its share of the whole
//! sphere, wherever the element is (Sumpner 1892; with ports and several spheres Goebel, Applied Optics 6, 125, 1967). Light that
//! enters by the port must fall on the wall, for a sphere is convex. So the fluxes on the two walls balance exactly, for a port of
//! any size and any distribution of the light: with `f = cap / sphere`, a source that shines at the first wall alone, and `P` the
//! flux on a wall,
//!
//! `P1 = Phi + rho P1 (1 - f1) + rho P2 f2`,  `P2 = rho P1 f1 + rho P2 (1 - f2)`.

use super::cases::{sensor, triangle};
use glam::{DVec3, Vec3};
use lightvein::scene::{Light, Mesh, Sensor};
use std::f64::consts::{PI, TAU};

/// Radii of the two spheres and of the port between them, metres.
const RADII_M: [f64; 2] = [1.3, 1.0];
const PORT_M: f64 = 0.35;

/// Facets about the axis: the inscribed polygon lacks 0.07% of the circle's area.
const SECTORS: usize = 96;
const RINGS: usize = 48;

/// Sensors stand this share of the radius from the centre, clear of the facets.
const INSIDE: f64 = 0.997;

/// Distance of the port's plane from the centre of a sphere, metres.
fn port_at_m(sphere: usize) -> f64 {
    (RADII_M[sphere].powi(2) - PORT_M.powi(2)).sqrt()
}

/// Centre of a sphere, metres; the axis is x and the port lies in the plane x = 0.
fn centre_m(sphere: usize) -> DVec3 {
    DVec3::X * [-port_at_m(0), port_at_m(1)][sphere]
}

/// Share of a whole sphere that its port cuts off.
fn port_share(sphere: usize) -> f64 {
    (RADII_M[sphere] - port_at_m(sphere)) / (2.0 * RADII_M[sphere])
}

/// Both walls, with one material.
pub fn spheres() -> Mesh {
    let mut mesh = Mesh::default();
    for sphere in 0..2 {
        // From the rim of the port to the far pole; the rim is the same for both, to the bit.
        let from = (PORT_M / RADII_M[sphere]).asin();
        let away = [-1.0, 1.0][sphere];
        let at = |ring: usize, sector: usize| {
            let (turn_sine, turn_cosine) = (TAU * (sector % SECTORS) as f64 / SECTORS as f64).sin_cos();
            let polar = from + (PI - from) * ring as f64 / RINGS as f64;
            let (out_m, along_m) = match ring {
                0 => (PORT_M, 0.0),
                RINGS => (0.0, port_at_m(sphere) + RADII_M[sphere]),
                _ => (RADII_M[sphere] * polar.sin(), port_at_m(sphere) - RADII_M[sphere] * polar.cos()),
            };
            DVec3::new(away * along_m, out_m * turn_cosine, out_m * turn_sine).as_vec3()
        };
        for (ring, sector) in (0..RINGS).flat_map(|ring| (0..SECTORS).map(move |sector| (ring, sector))) {
            let [a, b] = [at(ring, sector), at(ring, sector + 1)];
            let [c, d] = [at(ring + 1, sector), at(ring + 1, sector + 1)];
            for corners_m in [[a, b, d], [a, d, c]] {
                let [p, q, r] = corners_m;
                let normal = (q - p).cross(r - p);
                if normal.length() > 1e-9 {
                    let inwards = normal.dot(centre_m(sphere).as_vec3() - p) > 0.0;
                    triangle(&mut mesh, 0, if inwards { corners_m } else { [p, r, q] });
                }
            }
        }
    }
    mesh
}

/// A small square in the middle of the first sphere that shines away from the port; it absorbs 0.1% of the light.
pub fn lamp(flux_w: f64) -> Light {
    let side_m = 0.04;
    let corner_m = centre_m(0).as_vec3() - 0.5 * side_m * (Vec3::Y + Vec3::Z);
    Light::Quad { corner_m, u_m: side_m * Vec3::Z, v_m: side_m * Vec3::Y, flux_w }
}

/// Sensors spread evenly over the wall of a sphere.
pub fn sensors(sphere: usize, count: usize) -> Vec<Sensor> {
    let away = [-1.0, 1.0][sphere];
    let highest = port_at_m(sphere) / RADII_M[sphere];
    let direction = |at: usize| {
        // Equal areas are equal heights: from the far pole to the rim.
        let along = 1.0 - (1.0 + highest) * (at as f64 + 0.5) / count as f64;
        let (sine, cosine) = (2.399_963_229_728_653 * at as f64).sin_cos();
        let out = (1.0 - along * along).sqrt();
        DVec3::new(away * along, out * cosine, out * sine)
    };
    let on_wall = |direction: DVec3| {
        let at_m = centre_m(sphere) + INSIDE * RADII_M[sphere] * direction;
        sensor(at_m.as_vec3(), Some(-direction.as_vec3()))
    };
    (0..count).map(direction).map(on_wall).collect()
}

/// Mean irradiance on the two walls, W/m2.
pub fn mean_irradiances(flux_w: f64, reflectance: f64) -> [f64; 2] {
    let [f1, f2] = [port_share(0), port_share(1)];
    // Cramer's rule on the two balances.
    let (a, b) = (1.0 - reflectance * (1.0 - f1), -reflectance * f2);
    let (c, d) = (-reflectance * f1, 1.0 - reflectance * (1.0 - f2));
    let determinant = a * d - b * c;
    let fluxes_w = [flux_w * d / determinant, -flux_w * c / determinant];
    [0, 1].map(|sphere| {
        let wall_m2 = 4.0 * PI * RADII_M[sphere].powi(2) * (1.0 - port_share(sphere));
        fluxes_w[sphere] / wall_m2
    })
}

#[test]
fn the_balance_keeps_its_energy_and_its_limits() {
    for reflectance in [0.0, 0.5, 0.9] {
        let means = mean_irradiances(7.0, reflectance);
        let absorbed_w: f64 = (0..2)
            .map(|sphere| {
                let wall_m2 = 4.0 * PI * RADII_M[sphere].powi(2) * (1.0 - port_share(sphere));
                (1.0 - reflectance) * means[sphere] * wall_m2
            })
            .sum();
        assert!((absorbed_w - 7.0).abs() < 1e-9, "{absorbed_w}");
        assert!(means[1] < means[0]);
    }
    assert_eq!(mean_irradiances(7.0, 0.0)[1], 0.0);
    // White walls share their light evenly.
    let [first, second] = mean_irradiances(7.0, 1.0 - 1e-9);
    assert!((second / first - 1.0).abs() < 1e-6);
}
