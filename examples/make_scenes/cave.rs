//! Chambers and tunnels with rough walls: the zero surface of a field of ellipsoids, tubes and noise.

use glam::{DVec3, IVec3};

use crate::isosurface::Samples;
use crate::scene::{Light, Mesh, Scene, Sensor, Table, Variant, planar, scalar};

/// The lattice of the surface: coarse enough for a file of half a megabyte, a third of the finest noise.
const STEP_M: f64 = 0.37;

/// Chambers: centre and half-axes.
const CHAMBERS: [(DVec3, DVec3); 5] = [
    (DVec3::new(2.9, 3.1, 2.3), DVec3::new(2.3, 2.1, 1.7)),
    (DVec3::new(8.7, 2.3, 2.9), DVec3::new(2.0, 1.5, 1.4)),
    (DVec3::new(13.6, 4.9, 2.1), DVec3::new(2.4, 2.6, 1.6)),
    (DVec3::new(8.1, 8.9, 2.6), DVec3::new(2.6, 1.8, 1.9)),
    (DVec3::new(2.6, 9.3, 3.3), DVec3::new(1.7, 1.6, 1.3)),
];

/// Tunnels: both ends and the radius. The first four close a ring, the last two lead to the blind end of one.
const TUNNELS: [(DVec3, DVec3, f64); 6] = [
    (DVec3::new(2.9, 3.1, 2.1), DVec3::new(8.7, 2.3, 2.7), 0.85),
    (DVec3::new(8.7, 2.3, 2.9), DVec3::new(13.6, 4.9, 2.0), 0.75),
    (DVec3::new(13.6, 4.9, 2.0), DVec3::new(8.1, 8.9, 2.4), 0.9),
    (DVec3::new(8.1, 8.9, 2.5), DVec3::new(2.9, 3.1, 2.2), 0.8),
    (DVec3::new(8.1, 8.9, 2.7), DVec3::new(2.6, 9.3, 3.2), 0.75),
    (DVec3::new(13.6, 4.9, 2.1), DVec3::new(15.1, 10.3, 2.9), 0.8),
];

/// Metres inside the void, roughly; negative in matter.
fn field(p: DVec3) -> f64 {
    let mut depth = f64::NEG_INFINITY;
    for (centre, half) in CHAMBERS {
        let inside = (1.0 - ((p - centre) / half).length()) * half.min_element();
        depth = smooth_max(depth, inside);
    }
    for (a, b, radius) in TUNNELS {
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        depth = smooth_max(depth, radius - p.distance(a.lerp(b, along)));
    }
    depth + 0.34 * noise(p / 1.7) + 0.16 * noise(p / 0.93)
}

/// The larger of two depths, rounded where they are within 0.4 m of each other.
fn smooth_max(a: f64, b: f64) -> f64 {
    const ROUND_M: f64 = 0.4;
    let near = (ROUND_M - (a - b).abs()).max(0.0) / ROUND_M;
    a.max(b) + near * near * ROUND_M / 4.0
}

/// Smooth noise from -1 to 1 with a period of one cell: hashed values at whole points, blended by a cubic.
fn noise(p: DVec3) -> f64 {
    let cell = p.floor();
    let t = p - cell;
    let blend = t * t * (3.0 - 2.0 * t);
    let mut sum = 0.0;
    for bits in 0..8 {
        let corner = IVec3::new(bits & 1, bits >> 1 & 1, bits >> 2);
        let weight: f64 = (0..3).map(|a| if corner[a] == 1 { blend[a] } else { 1.0 - blend[a] }).product();
        sum += weight * hashed(cell.as_ivec3() + corner);
    }
    sum
}

/// A value from -1 to 1 for a whole point (the finaliser of SplitMix64).
fn hashed(p: IVec3) -> f64 {
    let mut h = [p.x, p.y, p.z].iter().fold(0x1f2e_u64, |h, &c| {
        (h ^ u64::from(c.cast_unsigned())).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23)
    });
    h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((h ^ (h >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A sensor on the triangle nearest to a point, facing the void, `off_m` off its middle.
fn on_wall(mesh: &Mesh, id: &str, near: DVec3, off_m: f64) -> Option<Sensor> {
    let corners = |polygon: &Vec<usize>| [0, 1, 2].map(|i| mesh.vertices[polygon[i]]);
    let middle = |[a, b, c]: [DVec3; 3]| (a + b + c) / 3.0;
    let triangle = mesh.polygons().map(corners).min_by(|&s, &t| {
        let (s, t) = (middle(s).distance(near), middle(t).distance(near));
        s.total_cmp(&t)
    })?;
    let [a, b, c] = triangle;
    let normal = (b - a).cross(c - a).normalize();
    let p = middle(triangle) + normal * off_m;
    let mut sensor = planar(id, [0.0; 3], normal.to_array());
    // Not rounded to a tenth of a millimetre, for then it would be off its slanted triangle.
    sensor.position = p;
    Some(sensor)
}

/// The cave.
pub fn cave() -> Scene {
    let rim = DVec3::splat(0.5);
    let mut samples = Samples::of(DVec3::ZERO - rim, DVec3::new(16.6, 12.0, 5.2) + rim, STEP_M, field);
    samples.keep_largest_void();
    let mesh = samples.surface();

    let mut sensors: Vec<Sensor> = [
        ("a1", [3.61, 2.47, 1.93]),
        ("a2", [1.57, 3.83, 2.59]),
        ("tunnel_ab", [5.83, 2.69, 2.41]),
        ("b1", [8.87, 2.03, 3.17]),
        ("b2", [9.71, 2.71, 2.53]),
        ("tunnel_bc", [11.13, 3.59, 2.43]),
        ("c1", [13.27, 5.83, 1.79]),
        ("c2", [14.61, 4.13, 2.47]),
        ("tunnel_cd", [10.93, 6.83, 2.23]),
        ("d1", [7.37, 8.53, 2.93]),
        ("d2", [9.43, 9.17, 2.19]),
        ("tunnel_da", [5.47, 5.97, 2.37]),
        ("tunnel_de", [5.09, 9.13, 2.93]),
        ("e1", [2.43, 9.61, 3.41]),
        ("e2", [1.93, 8.87, 2.99]),
        ("blind_1", [14.29, 7.43, 2.47]),
        ("blind_2", [14.97, 9.89, 2.83]),
    ]
    .into_iter()
    .map(|(id, position)| scalar(id, position))
    .collect();
    let walls = [
        ("a_floor_on", DVec3::new(2.7, 2.9, 0.6), 0.0),
        ("a_wall_off", DVec3::new(0.6, 3.2, 2.3), 0.001),
        ("b_roof_off", DVec3::new(8.7, 2.3, 4.3), 0.001),
        ("c_floor_on", DVec3::new(13.7, 4.8, 0.5), 0.0),
        ("d_wall_off", DVec3::new(8.3, 10.7, 2.6), 0.001),
        ("e_floor_on", DVec3::new(2.6, 9.4, 2.0), 0.0),
    ];
    sensors.extend(walls.iter().filter_map(|(id, near, off_m)| on_wall(&mesh, id, *near, *off_m)));

    Scene {
        name: "cave",
        mesh,
        materials: vec![],
        lights: vec![
            Light::Point { position: DVec3::new(2.47, 3.29, 2.83), flux_w: 80.0 },
            Light::Point { position: DVec3::new(14.13, 5.37, 2.57), flux_w: 30.0 },
        ],
        voxel_m: 0.15,
        tables: vec![Table {
            file: "sensors.csv",
            about: "a to e: the five chambers; tunnel_*: between them; blind_*: the tunnel that ends. Those with a normal\n\
                    are irradiance, in the middle of a triangle; *_on lie exactly on it, *_off 1 mm off it.",
            sensors,
        }],
        variants: vec![Variant {
            name: "cave",
            about: "Five chambers joined by tunnels in a ring, rough walls, a blind end, two lights.",
            reflectance: 0.5,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    }
}
