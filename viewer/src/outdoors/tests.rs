//! Answers to questions about a ground with a tower on it, on one day.

use super::compute::{Question, compute};
use super::*;
use crate::results::Failed;
use glam::{DVec3, Vec3};
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::parts::{Edit, Part};
use lightvein::scene::{Mesh, Scene, Sensor};

/// A ground of 20 m x 20 m and a tower of 2 m x 2 m x 10 m in its middle, on the 21st of June at 45 degrees north.
fn scene() -> Arc<Scene> {
    let mut mesh = Mesh::default();
    let mut square = |corners: [[f32; 3]; 4]| {
        let first = mesh.positions_m.len() as u32;
        mesh.positions_m.extend(corners.map(Vec3::from));
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    };
    square([[-10.0, -10.0, 0.0], [10.0, -10.0, 0.0], [10.0, 10.0, 0.0], [-10.0, 10.0, 0.0]]);
    let rim = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    for side in 0..4 {
        let ([x0, y0], [x1, y1]) = (rim[side], rim[(side + 1) % 4]);
        square([[x0, y0, 0.0], [x1, y1, 0.0], [x1, y1, 10.0], [x0, y0, 10.0]]);
    }
    square(rim.map(|[x, y]| [x, y, 10.0]));
    mesh.material_of = vec![0; mesh.triangles.len()];
    let part = |name: &str, triangles| Part { name: name.to_owned(), triangles: vec![triangles], keeps_for_others: 0 };
    let sensor = |id: &str, position_m| Sensor { id: id.to_owned(), position_m, normal: Some(Vec3::Z) };
    Arc::new(Scene {
        name: "tower".to_owned(),
        mesh,
        parts: vec![part("ground", 0..2), part("tower", 2..12)],
        sensors: vec![sensor("roof", Vec3::Z * 10.01), sensor("north", Vec3::new(0.0, 1.5, 0.01))],
        site: Some(site()),
        ..Scene::default()
    })
}

fn site() -> Site {
    Site {
        latitude_deg: Some(45.0),
        longitude_deg: Some(0.0),
        utc_offset_h: Some(0.0),
        turbidity: Some(3.0),
        start: Some((6, 21)),
        end: Some((6, 21)),
        ..Site::default()
    }
}

fn asked() -> OutdoorRequest {
    OutdoorRequest { patch_m: Some(1.0), ..OutdoorRequest::default() }
}

fn view(from_m: Vec3) -> Option<Camera> {
    Some(Camera::new(from_m, Vec3::ZERO, 0.9, [64, 48]).unwrap())
}

/// The answer, and all that was heard before it.
fn answer(
    scene: &Arc<Scene>,
    asked: &OutdoorRequest,
    edits: &[(String, Edit)],
    before: &OutdoorResults,
) -> (OutdoorResults, Vec<OutdoorResults>) {
    let question = Question { asked, scene, edits, seed: 0 };
    let mut heard = Vec::new();
    let found = compute(&question, before, &Quiet, &Cancel::new(), &mut |part| heard.push(part)).unwrap();
    (found, heard)
}

fn mean(exposures: &[Exposure]) -> f64 {
    exposures.iter().map(Exposure::total_kwh_m2).sum::<f64>() / exposures.len() as f64
}

fn same<T>(a: &Option<Arc<T>>, b: &Option<Arc<T>>) -> bool {
    Arc::ptr_eq(a.as_ref().unwrap(), b.as_ref().unwrap())
}

#[test]
fn a_roof_has_the_whole_sky_and_the_ground_north_of_a_tower_less() {
    let (found, heard) = answer(&scene(), &asked(), &[], &OutdoorResults::default());
    let (sky, sensors) = (found.sky.as_ref().unwrap(), &found.sensors.as_ref().unwrap().exposures);
    let ghi = sky.map.totals.ghi_kwh_m2;
    assert!((sensors[0].total_kwh_m2() / ghi - 1.0).abs() < 0.01, "{:?} {ghi}", sensors[0]);
    assert!((sensors[0].svf - 1.0).abs() < 1e-6);
    // Right at a wall half of the sky is gone; here the wall is narrow.
    assert!(sensors[1].svf > 0.5 && sensors[1].svf < 0.9 && sensors[1].sun_h < sensors[0].sun_h);

    let firsts: Vec<_> = heard.iter().filter_map(|part| part.faces.as_ref()).collect();
    let faces = found.faces.as_ref().unwrap();
    assert!(firsts[0].is_first_pass && !faces.is_first_pass);
    let [first, last] = [firsts[0], faces].map(|faces| mean(&faces.exposures));
    assert!((first / last - 1.0).abs() < 0.1, "{first} {last}");
}

#[test]
fn values_are_those_of_the_quantity_and_nothing_where_nothing_stands() {
    let (found, _) = answer(&scene(), &asked(), &[], &OutdoorResults::default());
    let hours = found.values(Measure::SunHours);
    let (faces, sensors) = (found.faces.as_ref().unwrap(), found.sensors.as_ref().unwrap());
    assert_eq!(hours.len(), faces.exposures.len() + sensors.exposures.len());
    assert_eq!(hours[0], faces.exposures[0].sun_h as f32);
    // A long day: 15 h 37 min of sun at 45 degrees north, on whatever is in the open.
    assert!((hours.iter().copied().fold(0.0, f32::max) - 15.6).abs() < 0.2);
    assert_eq!(found.values(Measure::MapRadiance).len(), 512 * 512);
    assert!(found.values(Measure::Flux).is_empty());
    let none = Exposure::none(Status::InSolid);
    assert!(values_of(&[none], Quantity::Svf).all(f32::is_nan));
}

#[test]
fn a_turned_view_asks_its_pixels_again_and_nothing_else() {
    let scene = scene();
    let from_south = OutdoorRequest { view: view(Vec3::new(0.0, -30.0, 20.0)), ..asked() };
    let (first, heard) = answer(&scene, &from_south, &[], &OutdoorResults::default());
    let sizes: Vec<_> = heard.iter().filter_map(|part| Some(part.pixels.as_ref()?.buffers.camera.size)).collect();
    assert_eq!((sizes[0], sizes.last()), ([16, 12], Some(&[64, 48])));

    let from_north = OutdoorRequest { view: view(Vec3::new(0.0, 30.0, 20.0)), ..asked() };
    let (second, heard) = answer(&scene, &from_north, &[], &first);
    assert!(same(&first.sky, &second.sky) && same(&first.scenery, &second.scenery));
    assert!(same(&first.faces, &second.faces) && same(&first.sensors, &second.sensors));
    let (north, south) = (second.pixels.unwrap(), first.pixels.unwrap());
    assert!(Arc::ptr_eq(&north.way, &south.way), "nothing that the way needs was made again");
    assert!(!north.is_first_pass && north.buffers.camera.size == [64, 48]);
    // The sun shines on the ground about the tower in both, and on the tower's south side.
    assert!(mean(&south.exposures) > mean(&north.exposures));
    // The sky, the coarse view, the view.
    assert_eq!(heard.len(), 3);

    // No view, no pixels.
    let (third, _) = answer(&scene, &asked(), &[], &first_of(&scene, &from_north));
    assert!(third.pixels.is_none() && third.faces.is_some());
}

fn first_of(scene: &Arc<Scene>, asked: &OutdoorRequest) -> OutdoorResults {
    answer(scene, asked, &[], &OutdoorResults::default()).0
}

#[test]
fn the_same_question_again_costs_nothing_and_other_air_all_but_the_paths() {
    let scene = scene();
    let first = first_of(&scene, &asked());
    let (again, heard) = answer(&scene, &asked(), &[], &first);
    assert!(same(&first.sky, &again.sky) && same(&first.faces, &again.faces) && heard.len() == 1);

    let hazy = OutdoorRequest { site: Some(Site { turbidity: Some(6.0), ..site() }), ..asked() };
    let (hazy, _) = answer(&scene, &hazy, &[], &first);
    let [clear_sky, hazy_sky] = [&first, &hazy].map(|found| found.sky.as_ref().unwrap());
    assert!(hazy_sky.map.totals.dni_kwh_m2 < clear_sky.map.totals.dni_kwh_m2);
    assert!(Arc::ptr_eq(&hazy_sky.sun_path, &clear_sky.sun_path));
    let [clear, hazy] = [&first, &hazy].map(|found| mean(&found.faces.as_ref().unwrap().exposures));
    assert!(hazy < clear, "{hazy} {clear}");
}

#[test]
fn exposure_follows_a_part_that_is_moved_hidden_and_brought_back() {
    let scene = scene();
    let first = first_of(&scene, &asked());
    let edit = |edit| vec![("tower".to_owned(), edit)];

    let (moved, _) = answer(&scene, &asked(), &edit(Edit::Move(DVec3::new(6.0, 0.0, 0.0))), &first);
    assert!(same(&first.sky, &moved.sky) && same(&first.unchanged_faces, &moved.unchanged_faces));
    let (before, after) = (first.faces.as_ref().unwrap(), moved.faces.as_ref().unwrap());
    assert!(after.again < before.exposures.len(), "{} of {}", after.again, before.exposures.len());
    let top_m = after.patches.last().unwrap().corners_m[0];
    assert!((5.0..=7.0).contains(&top_m.x) && top_m.z == 10.0, "{top_m}");

    // Without the tower the ground is an open plane.
    let (hidden, _) = answer(&scene, &asked(), &edit(Edit::Hide), &moved);
    let (faces, sky) = (hidden.faces.as_ref().unwrap(), hidden.sky.as_ref().unwrap());
    assert!(faces.exposures.iter().all(|exposure| (exposure.svf - 1.0).abs() < 1e-6));
    let off = mean(&faces.exposures) / sky.map.totals.ghi_kwh_m2 - 1.0;
    assert!(off.abs() < 0.02, "{off}");
    assert!(hidden.sensors.as_ref().unwrap().exposures[1].svf > 0.999);

    let (back, _) = answer(&scene, &asked(), &[], &hidden);
    assert_eq!(back.faces.unwrap().exposures, before.exposures);
}

#[test]
fn pixels_follow_a_part_that_is_hidden() {
    let scene = scene();
    let asked = OutdoorRequest { on_faces: false, view: view(Vec3::new(0.0, 20.0, 30.0)), ..asked() };
    let first = first_of(&scene, &asked);
    assert!(first.faces.is_none());
    let (hidden, _) = answer(&scene, &asked, &[("tower".to_owned(), Edit::Hide)], &first);
    let [before, after] = [first, hidden].map(|found| mean(&found.pixels.unwrap().exposures));
    assert!(after > before, "{after} {before}");
}

#[test]
fn a_scene_without_a_site_has_no_sky_and_another_scene_keeps_nothing() {
    let first = first_of(&scene(), &asked());
    let nowhere = Arc::new(Scene { site: None, ..(*scene()).clone() });
    let (found, heard) = answer(&nowhere, &asked(), &[], &first);
    assert!(found.sky.is_none() && found.faces.is_none() && heard.is_empty());
    let (found, heard) = answer(&scene(), &asked(), &[], &first);
    assert!(heard[0].faces.is_none() && found.faces.is_some());
}

#[test]
fn what_cannot_be_is_told() {
    let scene = scene();
    let says = |asked: &OutdoorRequest, edits: &[(String, Edit)]| {
        let question = Question { asked, scene: &scene, edits, seed: 0 };
        match compute(&question, &OutdoorResults::default(), &Quiet, &Cancel::new(), &mut |_| ()) {
            Err(Failed::Because(error)) => format!("{error:#}"),
            other => panic!("{other:?}"),
        }
    };
    let no_file = Site { weather: Some("no/such.epw".into()), ..site() };
    assert!(says(&OutdoorRequest { site: Some(no_file), ..asked() }, &[]).contains("such.epw"));
    let nowhere = Site { latitude_deg: None, ..site() };
    assert!(says(&OutdoorRequest { site: Some(nowhere), ..asked() }, &[]).contains("latitude_deg is missing"));
    assert!(says(&asked(), &[("tree".to_owned(), Edit::Hide)]).contains("tree"));
    // A camera so far away that its rays are lost in rounding gives no pixels, and a reason.
    let far = OutdoorRequest { view: view(Vec3::Z * 1e5), ..asked() };
    let (found, _) = answer(&scene, &far, &[], &OutdoorResults::default());
    assert!(found.pixels.is_none() && found.notes[0].contains("beyond"), "{:?}", found.notes);

    let cancel = Cancel::new();
    cancel.cancel();
    let question = Question { asked: &asked(), scene: &scene, edits: &[], seed: 0 };
    let stopped = compute(&question, &OutdoorResults::default(), &Quiet, &cancel, &mut |_| ());
    assert!(matches!(stopped, Err(Failed::Cancelled)));
}
