//! Exposure of odd scenes and odd places: no sun, no ground, in the ground, far from the origin, ten kilometres wide, weather
//! with gaps. Each is right or refused with a reason, and no number is ever missing.

use super::program::{run, text};
use glam::{DVec2, DVec3};
use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::{Exposure, points};
use lightvein::job::{Cancel, Quiet};
use lightvein::light::Status;
use lightvein::rays::Rays;
use lightvein::scene::{Scene, Site};
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::steps::Period;
use proptest::prelude::*;
use serde_json::Value;
use std::fmt::Write;
use std::path::{Path, PathBuf};

const CHICAGO: &str = "[site]\nlatitude_deg = 41.98\nlongitude_deg = -87.92\nutc_offset_h = -6.0\nturbidity = 3.0\n";

/// Corners of a polygon.
type Face = Vec<DVec3>;

/// A sensor: name, position, normal.
type Sensor = (&'static str, [f64; 3], [f64; 3]);

/// Writes a scene into a folder; gives the scene file.
fn write(folder: &Path, faces: &[Face], sensors: &[Sensor], site: &str) -> PathBuf {
    let (mut obj, mut first) = (String::new(), 1);
    for face in faces {
        face.iter().for_each(|p| writeln!(obj, "v {:.6} {:.6} {:.6}", p.x, p.y, p.z).unwrap());
        let corners: Vec<String> = (first..first + face.len()).map(|corner| corner.to_string()).collect();
        writeln!(obj, "f {}", corners.join(" ")).unwrap();
        first += face.len();
    }
    let mut table = String::from("id,x,y,z,nx,ny,nz\n");
    for (number, (id, [x, y, z], [nx, ny, nz])) in sensors.iter().enumerate() {
        writeln!(table, "{id}_{number},{x:.6},{y:.6},{z:.6},{nx},{ny},{nz}").unwrap();
    }
    let toml = format!("[geometry]\nmeshes = [\"a.obj\"]\n[sensors]\nfile = \"a.csv\"\n{site}");
    for (name, text) in [("a.obj", &obj), ("a.csv", &table), ("a.toml", &toml)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    folder.join("a.toml")
}

fn load(faces: &[Face], sensors: &[Sensor]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    Scene::load(&write(folder.path(), faces, sensors, ""), &Quiet, &Cancel::new()).unwrap()
}

/// A closed box, its faces outwards.
fn boxed([ax, ay, az]: [f64; 3], [bx, by, bz]: [f64; 3]) -> Vec<Face> {
    let corner = |x: usize, y: usize, z: usize| DVec3::new([ax, bx][x], [ay, by][y], [az, bz][z]);
    let sides = [
        [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
        [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
        [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
        [[1, 1, 0], [0, 1, 0], [0, 1, 1], [1, 1, 1]],
        [[0, 1, 0], [0, 0, 0], [0, 0, 1], [0, 1, 1]],
    ];
    sides.iter().map(|side| side.iter().map(|&[x, y, z]| corner(x, y, z)).collect()).collect()
}

/// A level sheet that looks up.
fn sheet(half: f64, z: f64) -> Face {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .iter()
        .map(|[x, y]| DVec3::new(half * x, half * y, z))
        .collect()
}

/// A clear year at 42 degrees north, two hours a step.
fn map(model: SkyModel) -> ExposureMap {
    let site = Site { latitude_deg: Some(42.0), longitude_deg: Some(-88.0), ..Site::default() };
    let outdoors = Outdoors::of(&site, None).unwrap();
    let steps = Outdoors { period: Period { step_min: 120.0, ..Period::YEAR }, ..outdoors }.steps().unwrap();
    let settings = MapSettings { size: [128, 64], model, ..MapSettings::default() };
    ExposureMap::build(&steps, &settings, &Quiet, &Cancel::new()).unwrap()
}

fn exposures(scene: &Scene, map: &ExposureMap, sky_rays: u32) -> Vec<Exposure> {
    let casting = Casting { sun_rays: None, sky_rays, seed: 1 };
    cast(&Rays::new(scene), &points(&scene.sensors), map, 0.0, casting, &Quiet, &Cancel::new()).unwrap()
}

/// The JSON of `expose`, every number of which is one; and what it said on stderr.
#[track_caller]
fn expose(scene: &Path, more: &[&str]) -> (Value, String) {
    let output = run(&[&["expose", scene.to_str().unwrap(), "--json", "--sky-rays", "256"], more].concat());
    let stderr = text(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    for key in ["seconds", "ghi", "dni", "dhi"] {
        assert!(told[key].is_f64(), "{key}: {}", told[key]);
    }
    for sensor in told["sensors"].as_array().unwrap() {
        for key in ["beam", "sky", "reflected", "total", "error", "svf", "sun_h"] {
            assert!(sensor[key].as_f64().is_some_and(|value| value >= 0.0), "{key}: {sensor}");
        }
    }
    (told, stderr)
}

fn statuses(told: &Value) -> Vec<&str> {
    told["sensors"].as_array().unwrap().iter().map(|sensor| sensor["status"].as_str().unwrap()).collect()
}

#[test]
fn a_polar_night_is_dark_and_says_so() {
    let scene = Path::new("scenes/outdoor/courtyard/courtyard.toml");
    let at = ["--latitude", "78.2", "--longitude", "15.6", "--utc-offset", "1", "--start", "12-01", "--end", "01-10"];
    let (told, stderr) = expose(scene, &at);
    assert!(stderr.contains("the sun does not rise in the period"), "{stderr}");
    assert!(statuses(&told).iter().all(|status| *status == "dark"), "{told}");
    let sensors = told["sensors"].as_array().unwrap();
    assert!(sensors.iter().all(|sensor| sensor["total"] == 0.0 && sensor["sun_h"] == 0.0));
    // The sky is dark, but not hidden.
    let roof = sensors.iter().find(|sensor| sensor["id"] == "roof").unwrap();
    assert!(roof["svf"].as_f64().unwrap() > 0.99, "{roof}");

    // Weather of another place, whose days are not this one's: what shines in the dark is told.
    let weather = ["--weather", "scenes/weather/clear_and_cloudy.wea"];
    let (told, stderr) = expose(scene, &[&at[..], &weather].concat());
    assert!(stderr.contains("direct beam in hours without sun"), "{stderr}");
    assert!(sensors.iter().all(|sensor| sensor["beam"] == 0.0) && told["dni"] == 0.0, "{told}");
}

#[test]
fn the_sun_on_the_horizon_all_day_is_finite() {
    // Noon of late January just within the polar circle: elevations under a degree.
    let scene = Path::new("scenes/outdoor/courtyard/courtyard.toml");
    let at = ["--latitude", "69.6", "--longitude", "18.9", "--utc-offset", "1", "--start", "01-16", "--end", "01-18"];
    let (told, _) = expose(scene, &at);
    let ghi = told["ghi"].as_f64().unwrap();
    assert!(ghi > 0.0 && ghi < 0.5, "{ghi}");
    assert!(statuses(&told).contains(&"ok"));
}

#[test]
fn a_floating_sheet_is_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let sensors: [Sensor; 5] = [
        ("over", [0.0, 0.0, 5.001], [0.0, 0.0, 1.0]),
        ("beside", [30.0, 0.0, 5.0], [0.0, 0.0, 1.0]),
        ("south", [0.0, -3.1, 5.0], [0.0, -1.0, 0.0]),
        ("under", [0.0, 0.0, 2.0], [0.0, 0.0, 1.0]),
        ("far", [2.0e4, 0.0, 5.0], [0.0, 0.0, 1.0]),
    ];
    let path = write(folder.path(), &[sheet(3.0, 5.0)], &sensors, CHICAGO);
    let (told, _) = expose(&path, &[]);
    assert_eq!(statuses(&told), ["ok"; 5]);
    let svf = |id: usize| told["sensors"][id]["svf"].as_f64().unwrap();
    assert!(svf(0) == 1.0 && svf(1) == 1.0 && svf(4) == 1.0 && (svf(2) - 0.5).abs() < 0.02, "{told}");
    // Beneath: what a square of 6 x 6 m at 3 m leaves, four times the textbook's corner factor.
    let corner = (1.0_f64 / 2.0_f64.sqrt()).atan() * 2.0 / (2.0_f64.sqrt() * std::f64::consts::TAU);
    assert!((svf(3) - (1.0 - 4.0 * corner)).abs() < 0.02, "{} {}", svf(3), 1.0 - 4.0 * corner);
}

/// Its panes face outwards, so that within nothing but backs is seen; but the sky is, through them.
#[test]
fn a_glass_house_is_not_matter() {
    let folder = tempfile::tempdir().unwrap();
    let glass = format!("[[materials]]\nname = \"*\"\ntransmittance = 0.8\n{CHICAGO}");
    let sensors: [Sensor; 2] =
        [("inside", [0.3, 0.2, 1.0], [0.0, 0.0, 1.0]), ("wall", [0.3, 0.2, 1.0], [0.0, -1.0, 0.0])];
    let path = write(folder.path(), &boxed([-2.0, -2.0, 0.0], [2.0, 2.0, 3.0]), &sensors, &glass);
    let (told, _) = expose(&path, &[]);
    assert_eq!(statuses(&told), ["ok"; 2]);
    for (sensor, open) in [(0, 1.0), (1, 0.5)] {
        let svf = told["sensors"][sensor]["svf"].as_f64().unwrap();
        assert!((svf - 0.8 * open).abs() < 0.02, "{svf}");
    }
}

#[test]
fn a_scene_without_a_face_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let line = vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
    let path = write(folder.path(), &[line], &[("a", [0.0; 3], [0.0, 0.0, 1.0])], CHICAGO);
    let output = run(&["expose", path.to_str().unwrap()]);
    assert!(output.status.code() == Some(1) && output.stdout.is_empty());
    assert!(text(&output.stderr).contains("face"), "{}", text(&output.stderr));
}

#[test]
fn a_sensor_under_the_ground_is_said_to_be_in_it() {
    let block = boxed([-5.0, -5.0, -1.0], [5.0, 5.0, 8.0]);
    let sensors: [Sensor; 7] = [
        ("in_block", [1.0, 1.0, 3.0], [0.0, 0.0, 1.0]),
        ("under_sheet_up", [20.0, 0.0, -0.5], [0.0, 0.0, 1.0]),
        ("under_sheet_aside", [20.0, 0.0, -2.0], [1.0, 0.0, 0.0]),
        ("on_sheet", [20.0, 0.0, 0.001], [0.0, 0.0, 1.0]),
        ("on_sheet_exactly", [20.0, 5.0, 0.0], [0.0, 0.0, 1.0]),
        ("behind_facade", [4.99, 1.0, 3.0], [1.0, 0.0, 0.0]),
        ("on_facade", [4.999, 1.0, 3.0], [1.0, 0.0, 0.0]),
    ];
    // Terrain is often a sheet; and often a slab.
    let map = map(SkyModel::Isotropic);
    let on_sheet = [block.clone(), vec![sheet(500.0, 0.0)]].concat();
    let in_slab = [block, boxed([-500.0, -500.0, -30.0], [500.0, 500.0, 0.0])].concat();
    for (ground, faces) in [("sheet", on_sheet), ("slab", in_slab)] {
        let found = exposures(&load(&faces, &sensors), &map, 1024);
        let statuses: Vec<Status> = found.iter().map(|exposure| exposure.status).collect();
        let under = Status::InSolid;
        assert_eq!(statuses[..5], [under, under, under, Status::Ok, Status::Ok], "{ground}");
        // A centimetre behind its facade, and a millimetre: less than what counts as on it in a scene of a kilometre.
        assert_eq!(statuses[5..], [under, Status::Ok], "{ground}");
        assert!(found[..3].iter().all(|exposure| exposure.total_kwh_m2() == 0.0));
        assert!((found[3].svf - found[4].svf).abs() < 0.02, "{ground}");
    }
}

/// A house with balconies 8 cm thick, a parapet and a louvre of plates 2 cm before its wall, on ground of 80 x 80 m.
fn house(at: DVec3) -> Vec<Face> {
    let mut faces = vec![sheet(40.0, 0.0)];
    faces.extend(boxed([-6.0, 0.0, -0.5], [6.0, 10.0, 9.0]));
    faces.extend(boxed([-6.0, 0.0, 9.0], [6.0, 0.2, 9.5]));
    for z in [3.0, 6.0] {
        faces.extend(boxed([-4.0, -1.5, z - 0.08], [4.0, 0.0, z]));
    }
    for plate in 0..24 {
        let z = 0.5 + 0.04 * f64::from(plate);
        faces.extend(boxed([-5.5, -0.03, z], [-4.5, -0.02, z + 0.02]));
    }
    faces.iter().map(|face| face.iter().map(|&corner| corner + at).collect()).collect()
}

/// Sensors a millimetre off the faces of that house.
const ON_HOUSE: [Sensor; 9] = [
    ("facade", [4.7, -0.001, 4.5], [0.0, -1.0, 0.0]),
    ("wall_below_balcony", [0.3, -0.001, 2.7], [0.0, -1.0, 0.0]),
    ("balcony", [0.4, -0.7, 3.001], [0.0, 0.0, 1.0]),
    ("balcony_corner", [3.95, -0.05, 3.001], [0.0, 0.0, 1.0]),
    ("behind_louvre", [-5.0, -0.001, 0.99], [0.0, -1.0, 0.0]),
    ("ground_below", [0.2, -0.8, 0.001], [0.0, 0.0, 1.0]),
    ("by_parapet", [1.0, 0.203, 9.001], [0.0, 0.0, 1.0]),
    ("soffit", [0.3, -0.7, 2.919], [0.0, 0.0, -1.0]),
    ("foot_of_wall", [1.1, -0.001, 3.004], [0.0, -1.0, 0.0]),
];

/// The same house at the origin, and at both ends of a city of 10 x 10 km in a national grid's coordinates: sensors a
/// millimetre off their faces receive the same, and keep their places between balconies and behind a louvre. Corners and
/// sensors are rounded to half a millimetre out there. An epsilon of 1e-5 of the largest coordinate, 5 cm, would put the
/// sensor behind the louvre before it: a sky factor of 0.47 where 0.13 is right.
#[test]
fn a_city_of_ten_kilometres_is_the_town_it_is_made_of() {
    let map = map(SkyModel::Perez);
    let alone = exposures(&load(&house(DVec3::ZERO), &ON_HOUSE), &map, 4096);
    let ends = [DVec3::new(678_000.123, 5_403_000.456, 400.789), DVec3::new(688_000.123, 5_413_000.456, 400.789)];
    let faces = [house(ends[0]), house(ends[1])].concat();
    for at in ends {
        let sensors = ON_HOUSE.map(|(id, place, normal)| (id, (DVec3::from(place) + at).to_array(), normal));
        let scene = load(&faces, &sensors);
        assert!(Rays::new(&scene).epsilon_m() < 0.011);
        for ((id, ..), (far, near)) in sensors.iter().zip(exposures(&scene, &map, 4096).iter().zip(&alone)) {
            println!(
                "{id}: svf {:.4} {:.4}, {:.1} {:.1} kWh/m2",
                far.svf,
                near.svf,
                far.total_kwh_m2(),
                near.total_kwh_m2()
            );
            assert_eq!(far.status, near.status, "{id}");
            // Out there rays start 2.5 mm off the wall, of the 2 cm to the louvre.
            let (of_svf, share) = if *id == "behind_louvre" { (0.015, 0.12) } else { (0.005, 0.01) };
            assert!((far.svf - near.svf).abs() < of_svf, "{id}: {} {}", far.svf, near.svf);
            let off = (far.total_kwh_m2() - near.total_kwh_m2()).abs();
            assert!(off < share * near.total_kwh_m2() + 1.0, "{id}: {far:?} {near:?}");
        }
    }
}

/// On one face as wide as the city no ray that goes up meets the ground it starts on, whatever its tilt.
#[test]
fn ground_of_ten_kilometres_does_not_shade_itself() {
    let map = map(SkyModel::Isotropic);
    for tilt in [0.0, 0.013, 0.3] {
        let up = DVec3::new(-tilt, 0.5 * tilt, 1.0).normalize();
        let height = |x: f64, y: f64| tilt * x - 0.5 * tilt * y;
        let ground = sheet(5000.0, 0.0).iter().map(|p| DVec3::new(p.x, p.y, height(p.x, p.y))).collect();
        let sensors: Vec<Sensor> = (0..60)
            .map(|at| {
                let [x, y] = [0.618_034, 0.754_878].map(|step| 9990.0 * ((f64::from(at) * step).fract() - 0.5));
                let place = DVec3::new(x, y, height(x, y)) + 0.001 * up;
                ("on_ground", place.to_array(), up.to_array())
            })
            .collect();
        let open = (1.0 + up.z) / 2.0;
        for (sensor, exposure) in sensors.iter().zip(exposures(&load(&[ground], &sensors), &map, 2048)) {
            assert_eq!(exposure.status, Status::Ok, "{tilt}: {sensor:?}");
            assert!((exposure.svf - open).abs() < 0.002, "{tilt}: {} {open} {sensor:?}", exposure.svf);
        }
    }
}

/// A scene whose coordinates are beyond what is held is refused; one that is very wide says what it loses.
#[test]
fn coordinates_beyond_bounds_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let far: Face = sheet(1.0, 0.0).iter().map(|&corner| corner + DVec3::new(2e8, 0.0, 0.0)).collect();
    let path = write(folder.path(), &[far], &[("a", [2e8, 0.0, 1.0], [0.0, 0.0, 1.0])], CHICAGO);
    let output = run(&["expose", path.to_str().unwrap()]);
    assert!(
        output.status.code() == Some(1) && text(&output.stderr).contains("-1e8 to 1e8"),
        "{}",
        text(&output.stderr)
    );
    let path = write(folder.path(), &[sheet(3e4, 0.0)], &[("a", [0.0, 0.0, 1.0], [0.0, 0.0, 1.0])], CHICAGO);
    let (_, stderr) = expose(&path, &["--start", "06-01", "--end", "06-02"]);
    assert!(stderr.contains("60 km wide"), "{stderr}");
}

/// A weather file that lacks a month brings what the year brings without that month.
#[test]
fn weather_with_gaps_brings_what_it_has() {
    let made =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/weather/clear_and_cloudy.wea"));
    let made = made.unwrap();
    let lines: Vec<&str> = made.lines().filter(|line| !line.starts_with("6 ")).collect();
    assert!(lines.len() < made.lines().count() - 700);
    let folder = tempfile::tempdir().unwrap();
    let gapped = folder.path().join("gapped.wea");
    std::fs::write(&gapped, lines.join("\n") + "\n").unwrap();

    let scene = Path::new("scenes/outdoor/courtyard/courtyard.toml");
    let total = |weather: &str, more: &[&str]| -> (Vec<f64>, String) {
        let (told, stderr) = expose(scene, &[&["--weather", weather], more].concat());
        (told["sensors"].as_array().unwrap().iter().map(|sensor| sensor["total"].as_f64().unwrap()).collect(), stderr)
    };
    let (year, _) = total("scenes/weather/clear_and_cloudy.wea", &[]);
    let (june, _) = total("scenes/weather/clear_and_cloudy.wea", &["--start", "06-01", "--end", "06-30"]);
    let (without, _) = total(gapped.to_str().unwrap(), &[]);
    for ((year, june), without) in year.iter().zip(&june).zip(&without) {
        assert!((year - june - without).abs() < 0.005 * year + 0.01, "{year} {june} {without}");
    }

    // Asked for the month that is not there, it says so.
    let (nothing, stderr) = total(gapped.to_str().unwrap(), &["--start", "06-01", "--end", "06-30"]);
    assert!(stderr.contains("no hours in the period") && nothing.iter().all(|&total| total == 0.0), "{stderr}");
}

/// `north_deg` turns the sky as turning the mesh the other way does, through the scene file.
#[test]
fn a_turned_site_is_the_turned_scene() {
    let turn = 37_f64.to_radians();
    // Clockwise, seen from above.
    let turned = |p: DVec3| DVec2::from_angle(-turn).rotate(p.truncate()).extend(p.z);
    let straight = house(DVec3::ZERO);
    let aslant: Vec<Face> = straight.iter().map(|face| face.iter().map(|&corner| turned(corner)).collect()).collect();
    let sensors = ON_HOUSE.map(|(id, at, n)| (id, turned(at.into()).to_array(), turned(n.into()).to_array()));
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let plain = write(folders[0].path(), &straight, &ON_HOUSE, CHICAGO);
    let north = write(folders[1].path(), &aslant, &sensors, &format!("{CHICAGO}north_deg = 37.0\n"));
    let many = ["--sky-rays", "16384"];
    let told = [plain, north].map(|path| {
        let output = run(&[&["expose", path.to_str().unwrap(), "--json"], &many[..]].concat());
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    });
    for (number, (id, ..)) in ON_HOUSE.iter().enumerate() {
        for part in ["beam", "sky", "svf"] {
            let [a, b] = [0, 1].map(|scene| told[scene]["sensors"][number][part].as_f64().unwrap());
            assert!((a - b).abs() <= 0.01 * a + if part == "svf" { 0.002 } else { 2.0 }, "{id} {part}: {a} {b}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A street between endless walls: anywhere on its floor the sky factor is the mean of the sines of the angles at which
    /// the walls' tops are seen from the zenith, and up a wall `(1 - sin(angle to the other's top)) / 2`.
    #[test]
    fn a_street_of_any_shape_sees_what_its_closed_form_says(
        wide in 3.0_f64..40.0, high in 1.0_f64..60.0, across in -0.48_f64..0.48, up in 0.02_f64..0.98,
    ) {
        let (half, long) = (wide / 2.0, 500.0 * wide);
        let wall = |x: f64| -> Face {
            vec![DVec3::new(x, -long, 0.0), DVec3::new(x, long, 0.0), DVec3::new(x, long, high), DVec3::new(x, -long, high)]
        };
        let floor = vec![
            DVec3::new(-half, -long, 0.0), DVec3::new(half, -long, 0.0), DVec3::new(half, long, 0.0), DVec3::new(-half, long, 0.0),
        ];
        let sensors: [Sensor; 2] = [
            ("floor", [across * wide, 0.0, 0.001], [0.0, 0.0, 1.0]),
            ("wall", [-half + 0.001, 0.0, up * high], [1.0, 0.0, 0.0]),
        ];
        let from_zenith = |away: f64| (away / high).atan().sin();
        let floor_svf = (from_zenith(half - across * wide) + from_zenith(half + across * wide)) / 2.0;
        let wall_svf = (1.0 - ((1.0 - up) * high / wide).atan().sin()) / 2.0;
        // The wall behind the floor's sensor looks away; both sides count.
        let map = map(SkyModel::Isotropic);
        let found = exposures(&load(&[wall(-half), wall(half), floor], &sensors), &map, 16_384);
        for (exposure, expected) in found.iter().zip([floor_svf, wall_svf]) {
            // Seen from within a canyon that is not endless, its ends add what they hide of the horizon.
            prop_assert!((exposure.svf - expected).abs() < 0.005, "{wide} {high} {across} {up}: {} {expected}", exposure.svf);
        }
    }
}
