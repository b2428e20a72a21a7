//! The generated scenes under the sky: meshes, sensors and the tables beside them, which are Radiance's.

use glam::{DVec3, Vec3};
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use std::f64::consts::TAU;
use std::path::Path;

/// A generated scene under the sky.
fn outdoor(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/outdoor/{name}/{name}.toml"));
    Scene::load(&path, &Quiet, &Cancel::new()).unwrap_or_else(|error| panic!("{error}"))
}

/// The rows of a table beside an outdoor scene: id and numbers.
fn outdoor_table(name: &str, file: &str) -> Vec<(String, Vec<f64>)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/outdoor/{name}/{file}"));
    let text = std::fs::read_to_string(path).expect("a table");
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let split = |row: &str| {
        let (id, numbers) = row.split_once(',').expect("a field");
        (id.to_owned(), numbers.split(',').map(|number| number.parse().expect("a number")).collect())
    };
    rows.map(split).collect()
}

/// Name, triangles, sensors, and how many sensors that do not look down have something straight above them.
const OUTDOOR: [(&str, usize, usize, std::ops::RangeInclusive<usize>); 5] = [
    ("courtyard", 172, 38, 0..=0),
    ("blocks", 4164, 400, 0..=0),
    ("arcades", 4824, 400, 90..=300),
    ("office", 2120, 55, 40..=55),
    ("street", 9136, 100, 1..=30),
];

#[test]
fn outdoor_scenes_have_a_site_and_sensors_in_the_air() {
    for (name, triangles, sensors, covered) in OUTDOOR {
        let scene = outdoor(name);
        assert_eq!((scene.mesh.triangles.len(), scene.sensors.len()), (triangles, sensors), "{name}");
        assert!(scene.warnings.is_empty() && scene.lights.is_empty(), "{name}: {:?}", scene.warnings);
        let site = scene.site.as_ref().expect("a site");
        assert_eq!((site.latitude_deg, site.longitude_deg, site.utc_offset_h), (Some(41.98), Some(-87.92), Some(-6.0)));
        assert_eq!((site.turbidity, &site.weather), (Some(3.0), &None));

        // In the air every ray meets a face's front, and those that go down meet the ground at the latest.
        let rays = Rays::new(&scene);
        let mut below_roofs = 0;
        for sensor in &scene.sensors {
            let normal = sensor.normal.expect("a normal");
            let from_m = sensor.position_m + normal * rays.epsilon_m();
            let hit = |direction: Vec3| rays.closest(from_m, direction.normalize(), f32::INFINITY);
            for corner in 0..8 {
                let side = |bit: u32| if corner >> bit & 1 == 1 { 0.9 } else { -1.0 };
                let hit = hit(Vec3::new(side(0), 1.1 * side(1), 0.7 * side(2)));
                assert!(hit.is_none_or(|hit| hit.front), "{name}: {} lies in matter", sensor.id);
            }
            assert!(hit(Vec3::NEG_Z).is_some_and(|hit| hit.front), "{name}: nothing below {}", sensor.id);
            below_roofs += usize::from(normal.z > -0.1 && hit(Vec3::Z).is_some());
        }
        assert!(covered.contains(&below_roofs), "{name}: {below_roofs} sensors are covered");
    }
}

#[test]
fn outdoor_references_are_of_their_sensors_and_add_up() {
    for (name, ..) in OUTDOOR {
        let ids: Vec<String> = outdoor(name).sensors.into_iter().map(|sensor| sensor.id).collect();
        let svf = outdoor_table(name, "svf.csv");
        let exposure = outdoor_table(name, "exposure_chicago.csv");
        assert!(
            ids.iter().eq(svf.iter().map(|row| &row.0)) && ids.iter().eq(exposure.iter().map(|row| &row.0)),
            "{name}"
        );
        for ((id, svf), (_, exposure)) in svf.iter().zip(&exposure) {
            let [beam, sky, reflected, total] = exposure[..] else { panic!("{name}: {id} has {exposure:?}") };
            assert!((beam + sky + reflected - total).abs() <= 2e-5 * total.abs() + 1e-3, "{name}: {id}");
            // No sky seen, none received: one ray of 20,000 would bring 0.03 of the open sky's 660 kWh/m2.
            assert!((0.0..1.01).contains(&svf[0]) && (svf[0] > 0.0 || sky < 2.0), "{name}: {id}");
        }
    }
}

/// The example that hybrid shadow maps were published with: the nearest object 10 m from the camera, the farthest 380 m.
#[test]
fn the_street_is_in_view_from_10_m_to_380_m() {
    let street = outdoor("street");
    let rays = Rays::new(&street);
    // Level, to the north; 40 degrees from the lower edge to the upper one, 4:3.
    let eye_m = (DVec3::new(0.0, -165.0, 3.64) - street.origin_m).as_vec3();
    let slope = 20f32.to_radians().tan();
    let mut depths_m = Vec::new();
    for y in 0..240 {
        for x in 0..320 {
            let [right, up] =
                [(x as f32 + 0.5) / 120.0 - 4.0 / 3.0, 1.0 - (y as f32 + 0.5) / 120.0].map(|at| at * slope);
            let direction = Vec3::new(right, 1.0, up).normalize();
            depths_m.extend(rays.closest(eye_m, direction, f32::INFINITY).map(|hit| hit.distance_m * direction.y));
        }
    }
    let nearest_m = depths_m.iter().copied().fold(f32::INFINITY, f32::min);
    let farthest_m = depths_m.iter().copied().fold(0.0, f32::max);
    assert!((nearest_m - 10.0).abs() < 0.01 && (farthest_m - 380.0).abs() < 0.01, "{nearest_m} m to {farthest_m} m");
}

/// Sky view factors in a well 10 m wide and 10 m deep: closed forms, worked out apart; on its walls and before a wall of
/// 30 x 10 m: the textbook's form, from a small patch to a rectangle square to it. And what a year in Chicago brings, beam
/// and sky, by exact suns and a diffuse sky of 2320 patches: another run of Radiance's.
#[test]
fn the_courtyard_is_as_its_closed_forms_say() {
    let number = |file: &str, id: &str, columns: std::ops::Range<usize>| {
        let table = outdoor_table("courtyard", file);
        let row = table.iter().find(|row| row.0 == id).expect(id);
        row.1[columns].iter().sum::<f64>()
    };
    // From a small patch to half a rectangle square to its plane, from the patch's foot on: height or depth, half width.
    let square_to = |far_m: f64, half_m: f64, away_m: f64| {
        let slant_m = far_m.hypot(away_m);
        ((half_m / away_m).atan() - away_m / slant_m * (half_m / slant_m).atan()) / TAU
    };
    let mut factors = vec![
        (String::from("court_centre"), 0.23949),
        (String::from("court_side"), 0.19960),
        (String::from("court_corner"), 0.14141),
        (String::from("court_half_way_up"), 0.55413),
        (String::from("roof"), 1.0),
    ];
    for side in ["south", "east", "north", "west"] {
        factors.push((format!("court_wall_{side}"), 2.0 * square_to(10.0, 5.0, 5.0)));
        factors.push((format!("facade_{side}"), 0.5));
        for away_m in [0.5, 2.0, 5.0, 10.0, 20.0, 40.0] {
            factors.push((format!("ground_{side}_{away_m}"), 1.0 - 2.0 * square_to(10.0, 15.0, away_m)));
        }
    }
    for (id, want) in factors {
        let svf = number("svf.csv", &id, 0..1);
        assert!((svf - want).abs() < 0.0015, "{id}: {svf}, {want}");
    }
    for (id, want) in [("court_centre", 318.5), ("court_wall_east", 294.4), ("facade_south", 957.9), ("roof", 1397.0)] {
        let total = number("exposure_chicago.csv", id, 0..2);
        assert!((total / want - 1.0).abs() < 0.005, "{id}: {total}, {want}");
    }
}
