//! A scene with all that the worker finds of it, made once for all tests.

use lightvein_viewer::layers::Layers;
use lightvein_viewer::request::{How, Request, Source};
use lightvein_viewer::results::Results;
use lightvein_viewer::state::{Kept, State};
use lightvein_viewer::worker::{Task, Told, Worker};
use std::path::Path;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Voxels that are coarse, so that tests are fast.
const VOXEL_M: f32 = 0.2;

/// Longest that the worker may take.
const PATIENCE: Duration = Duration::from_secs(300);

/// Two rooms and a doorway, with every method's answer and a reference.
pub fn state() -> State {
    static FOUND: OnceLock<(Request, Results)> = OnceLock::new();
    let (request, results) = FOUND.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/two_rooms/two_rooms.toml");
        let how = How { voxel_m: Some(VOXEL_M), ..How::default() };
        let request = Request { how, ..Request::of(Source::File(path)) };
        let results = answered(&request);
        (request, results)
    });
    let mut state = State::new(Kept::default(), Layers::default());
    state.request = request.clone();
    state.answered = Some(request.clone());
    state.results = results.clone();
    state
}

fn answered(request: &Request) -> Results {
    let worker = Worker::start(|| ()).expect("a thread");
    worker.ask(Task::Answer(Box::new(request.clone())));
    let begun = Instant::now();
    let mut results = Results::default();
    while begun.elapsed() < PATIENCE {
        for told in worker.told() {
            match told {
                Told::Found(_, found) => results = *found,
                Told::Answered(_) => return results,
                Told::Failed { about, why, .. } => panic!("{about}: {why:?}"),
                Told::Measured(..) => {}
                Told::Written(..) => {}
            }
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("the worker gave nothing in {PATIENCE:?}");
}
