//! The worker keeps what a change leaves: its answers must be those of one that knows nothing, to the bit.

use glam::{DVec3, Vec3};
use lightvein::scene::parts::Edit;
use lightvein::scene::{Light, Method};
use lightvein_viewer::request::{Request, Source};
use lightvein_viewer::results::{Failed, Results};
use lightvein_viewer::worker::{Task, Told, Worker};
use std::path::Path;
use std::time::{Duration, Instant};

/// What no answer here takes.
const PATIENCE: Duration = Duration::from_secs(120);

fn scene(name: &str) -> Source {
    Source::File(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name))
}

/// The full answer to a request, and how many partial ones came before it.
#[track_caller]
fn answered(worker: &Worker, request: &Request) -> (Results, usize) {
    worker.ask(Task::Answer(Box::new(request.clone())));
    wait(worker, request)
}

#[track_caller]
fn wait(worker: &Worker, request: &Request) -> (Results, usize) {
    let (began, mut found, mut last) = (Instant::now(), 0, Results::default());
    while began.elapsed() < PATIENCE {
        for told in worker.told() {
            match told {
                Told::Found(_, results) => (found, last) = (found + 1, *results),
                Told::Answered(of) if *of == *request => return (last, found),
                Told::Failed { about, why, .. } => panic!("{about}: {why:?}"),
                _ => {}
            }
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    panic!("no answer in {PATIENCE:?}");
}

fn values(results: &Results) -> Vec<f64> {
    let estimate = results.estimate.as_ref().expect("an estimate");
    let readings = estimate.at_sensors.readings.iter().chain(&estimate.at_nodes.readings);
    readings.map(|reading| reading.value_w_m2).collect()
}

fn moved(results: &Results, by_m: Vec3) -> Vec<Light> {
    let mut lights = results.scene.as_ref().expect("a scene").lights.clone();
    if let Some(Light::Point { position_m, .. }) = lights.first_mut() {
        *position_m += by_m;
    }
    lights
}

#[test]
fn answers_after_changes_are_those_of_a_fresh_start() {
    let worker = Worker::start(|| ()).expect("a thread");
    let mut request = Request::of(scene("two_rooms/two_rooms.toml"));
    request.wants.all_methods = false;
    let (first, _) = answered(&worker, &request);
    let before = values(&first);

    let mut requests = Vec::new();
    request.edits.lights = Some(moved(&first, Vec3::new(0.3, 0.2, -0.1)));
    requests.push(request.clone());
    request.edits.reflectances.insert(0, 0.35);
    requests.push(request.clone());
    if let Some(Light::Point { flux_w, .. }) = request.edits.lights.as_mut().and_then(|lights| lights.first_mut()) {
        *flux_w *= 3.0;
    }
    requests.push(request.clone());
    request.how.filter.least_life_layers = 9;
    requests.push(request.clone());
    request.how.method = Some(Method::Diffusion);
    requests.push(request.clone());
    request.how.voxel_m = Some(0.15);
    requests.push(request.clone());
    request.edits = Default::default();
    requests.push(request.clone());
    for (number, request) in requests.iter().enumerate() {
        let (kept, _) = answered(&worker, request);
        let (fresh, _) = answered(&Worker::start(|| ()).expect("a thread"), request);
        assert_eq!(values(&kept), values(&fresh), "change {number}");
        assert_ne!(values(&kept), before, "change {number} changes something");
        assert_eq!(kept.sides, fresh.sides, "change {number}");
    }
    request.how = Default::default();
    assert_eq!(values(&answered(&worker, &request).0), before, "all changes taken back");
}

#[test]
fn parts_that_are_hidden_and_moved_change_the_void() {
    let worker = Worker::start(|| ()).expect("a thread");
    let mut request = Request { wants: Default::default(), ..Request::of(Source::Welcome) };
    request.wants.all_methods = false;
    let (whole, _) = answered(&worker, &request);
    let door = |results: &Results| {
        let scene = results.scene.as_ref().expect("a scene");
        let next_room = scene.sensors.iter().position(|sensor| sensor.id == "next room").expect("a sensor");
        results.estimate.as_ref().expect("an estimate").at_sensors.readings[next_room].value_w_m2
    };
    request.edits.parts = vec![("partition south".to_owned(), Edit::Hide)];
    let (open, _) = answered(&worker, &request);
    assert!(door(&open) > 3.0 * door(&whole), "{} {}", door(&open), door(&whole));
    request.edits.parts = vec![("table".to_owned(), Edit::Move(DVec3::new(0.0, 0.0, 40.0)))];
    let (away, _) = answered(&worker, &request);
    assert!(away.scene.as_ref().unwrap().mesh.bounds_m().unwrap().1.z > 40.0);
    request.edits.parts.clear();
    assert_eq!(values(&answered(&worker, &request).0), values(&whole));
}

#[test]
fn a_bare_mesh_keeps_the_light_it_was_given() {
    let worker = Worker::start(|| ()).expect("a thread");
    let mut request = Request::of(scene("two_rooms/two_rooms.obj"));
    request.wants.all_methods = false;
    let (given, _) = answered(&worker, &request);
    let lights = given.scene.as_ref().unwrap().lights.clone();
    assert_eq!(lights.len(), 1);
    request.edits.reflectances.insert(0, 0.2);
    let (darker, _) = answered(&worker, &request);
    assert_eq!(darker.scene.as_ref().unwrap().lights, lights);
    let sums: Vec<f64> = [&given, &darker].map(|results| values(results).iter().sum()).into();
    assert!(sums[1] < sums[0], "{sums:?}");
}

#[test]
fn of_many_requests_in_a_row_the_last_is_answered_and_few_are_begun() {
    let worker = Worker::start(|| ()).expect("a thread");
    let mut request = Request::of(scene("two_rooms/two_rooms.toml"));
    request.wants.all_methods = false;
    let (first, _) = answered(&worker, &request);
    for step in 1..=60 {
        request.edits.lights = Some(moved(&first, Vec3::X * 0.005 * step as f32));
        worker.ask(Task::Answer(Box::new(request.clone())));
        std::thread::sleep(Duration::from_millis(4));
    }
    let (last, found) = wait(&worker, &request);
    assert_eq!(Some(&last.scene.as_ref().unwrap().lights), request.edits.lights.as_ref());
    assert!(found < 60, "{found} answers to 60 requests within a quarter of a second");
}

#[test]
fn a_scene_that_cannot_be_read_is_told_of_and_the_next_is_answered() {
    let worker = Worker::start(|| ()).expect("a thread");
    worker.ask(Task::Answer(Box::new(Request::of(scene("nothing.toml")))));
    let began = Instant::now();
    let (about, text) = loop {
        assert!(began.elapsed() < PATIENCE);
        let failed = worker.told().into_iter().find_map(|told| match told {
            Told::Failed { about, why: Failed::Because(error), of_request: true } => {
                Some((about, format!("{error:#}")))
            }
            _ => None,
        });
        if let Some(failed) = failed {
            break failed;
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    assert!(about.ends_with("nothing.toml") && text.contains("cannot be read"), "{about}: {text}");
    assert!(answered(&worker, &Request::of(Source::Welcome)).0.estimate.is_some());
}
