//! Parts of the mesh taken away: light and sky come through where they stood.

use super::{Window, bring, errors, settle, started};
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use lightvein::daylight::Quantity;
use lightvein_viewer::state::Picked;

/// A meadow of 200 m x 200 m and a wall on it, its southern face at y = 0, from there 20 m to the east, west and up.
const MEADOW: &str = "o meadow
v -100 -100 0
v 100 -100 0
v 100 100 0
v -100 100 0
f 1 2 3 4
o wall
v -20 0 0
v 20 0 0
v 20 0 20
v -20 0 20
v -20 1 0
v 20 1 0
v 20 1 20
v -20 1 20
f 5 6 7 8
f 10 9 12 11
f 9 5 8 12
f 6 10 11 7
f 8 7 11 12
";

const SITE: &str = "name = \"meadow\"
[geometry]
meshes = [\"meadow.obj\"]
reflectance = 0.2
[sensors]
file = \"sensors.csv\"
[site]
latitude_deg = 50.0
longitude_deg = 8.0
utc_offset_h = 1.0
turbidity = 3.0
";

fn show_or_hide(window: &mut Window, part: &str) {
    window.get_by_role_and_label(Role::CheckBox, &format!("Show {part}")).click();
    settle(window);
    assert_eq!(errors(window), "");
}

#[test]
fn a_wall_that_is_hidden_lets_the_light_through() {
    let mut window = started(None);
    settle(&mut window);
    let values = |window: &Window| {
        let estimate = window.state().state.results.estimate.clone().expect("an estimate");
        estimate.at_sensors.readings.iter().map(|reading| reading.value_w_m2).collect::<Vec<f64>>()
    };
    let before = values(&window);
    bring(&mut window, "Scene");
    show_or_hide(&mut window, "partition south");
    let after = values(&window);
    // The last sensor is in the room without a lamp.
    assert!(after[3] > 2.0 * before[3], "{before:?} {after:?}");
    let scene = window.state().state.results.scene.clone().expect("a scene");
    let loaded = window.state().state.results.loaded.clone().expect("a scene");
    assert_eq!(loaded.mesh.triangles.len() - scene.mesh.triangles.len(), 12, "a box has twelve triangles");

    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut window);
    assert_eq!(values(&window), before);
}

#[test]
fn a_wall_that_is_hidden_lets_the_sky_through() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("meadow.obj", MEADOW);
    write("meadow.toml", SITE);
    write("sensors.csv", "id,x,y,z,nx,ny,nz\nbefore_it,0,-5,0.01,0,0,1\n");
    let mut window = started(Some(folder.path().join("meadow.toml")));
    settle(&mut window);
    assert_eq!(errors(&window), "");
    let svf = |window: &Window| {
        let sensors = window.state().state.results.outdoors.sensors.clone().expect("exposures");
        Quantity::Svf.of(&sensors.exposures[0])
    };
    // The wall's view factor from a horizontal patch d before it, of height h and width 2 w, as textbooks have it (a corner's,
    // twice): (atan(w / d) - d / s atan(w / s)) / pi with s the root of h h + d d.
    let (d, h, w) = (5.0_f64, 20.0_f64, 20.0_f64);
    let s = h.hypot(d);
    let of_wall = ((w / d).atan() - d / s * (w / s).atan()) / std::f64::consts::PI;
    assert!((svf(&window) - (1.0 - of_wall)).abs() < 0.01, "{} is not {}", svf(&window), 1.0 - of_wall);

    bring(&mut window, "Scene");
    show_or_hide(&mut window, "wall");
    assert!((svf(&window) - 1.0).abs() < 0.01, "{}", svf(&window));

    // Back, and picked by its name.
    show_or_hide(&mut window, "wall");
    assert!((svf(&window) - (1.0 - of_wall)).abs() < 0.01, "{}", svf(&window));
    window.get_by_role_and_label(Role::Button, "wall").click();
    window.run();
    assert!(matches!(window.state().state.picked, Some(Picked::Part(_))));
}
