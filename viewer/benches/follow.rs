//! How long until the view follows the hand: from a request to its first and to its full answer, in the gallery.
//!
//! `cargo bench -p lightvein-viewer --bench follow`

use lightvein::scene::Light;
use lightvein_viewer::request::{Request, Source};
use lightvein_viewer::results::Results;
use lightvein_viewer::worker::{Task, Told, Worker};
use std::path::Path;
use std::time::{Duration, Instant};

/// Runs of each change; the median is told.
const RUNS: usize = 11;

/// A change by its name; the number of the run makes each another one.
type Change<'a> = (&'a str, Box<dyn Fn(&mut Request, usize) + 'a>);

fn main() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/gallery/gallery.toml");
    let Ok(worker) = Worker::start(|| {}) else { return println!("the system gives no thread") };
    let mut request = Request::of(Source::File(path));
    request.wants.all_methods = false;
    let ([_, opened], results) = timed(&worker, &request);
    println!("gallery: opened and answered in {:.0} ms", opened.as_secs_f64() * 1e3);
    let Some(scene) = results.scene.clone() else { return };

    let with_light = |request: &mut Request, change: &dyn Fn(&mut Light)| {
        let mut lights = scene.lights.clone();
        lights.first_mut().into_iter().for_each(change);
        request.edits.lights = Some(lights);
    };
    let moved = |light: &mut Light, by_m: f32| {
        if let Light::Point { position_m, .. } = light {
            position_m.x += by_m;
        }
    };
    let brighter = |light: &mut Light, by_w: f64| {
        if let Light::Point { flux_w, .. } = light {
            *flux_w += by_w;
        }
    };
    let changes: [Change; 4] = [
        ("light moved", Box::new(|request, run| with_light(request, &|light| moved(light, 0.02 * (run + 1) as f32)))),
        ("flux", Box::new(|request, run| with_light(request, &|light| brighter(light, (run + 1) as f64)))),
        (
            "reflectance",
            Box::new(|request, run| {
                request.edits.reflectances.insert(0, 0.5 + 0.01 * run as f32);
            }),
        ),
        ("filter", Box::new(|request, run| request.how.filter.least_life_layers = 4 + run as u32)),
    ];
    for (name, change) in changes {
        let mut times: Vec<[Duration; 2]> = (0..RUNS)
            .map(|run| {
                let mut changed = request.clone();
                change(&mut changed, run);
                timed(&worker, &changed).0
            })
            .collect();
        let mut median = |which: usize| {
            times.sort_by_key(|times| times[which]);
            times[RUNS / 2][which].as_secs_f64() * 1e3
        };
        let [first, full] = [median(0), median(1)];
        println!("{name}: first shown after {first:.0} ms, in full after {full:.0} ms (median of {RUNS})");
    }
}

/// Until the first news and until the full answer, and what was found.
fn timed(worker: &Worker, request: &Request) -> ([Duration; 2], Results) {
    let began = Instant::now();
    worker.ask(Task::Answer(Box::new(request.clone())));
    let (mut first, mut found) = (None, Results::default());
    loop {
        for told in worker.told() {
            match told {
                Told::Found(of, results) if *of == *request => {
                    first.get_or_insert(began.elapsed());
                    found = *results;
                }
                Told::Answered(of) if *of == *request => {
                    return ([first.unwrap_or_default(), began.elapsed()], found);
                }
                _ => {}
            }
        }
        std::thread::sleep(Duration::from_micros(200));
    }
}
