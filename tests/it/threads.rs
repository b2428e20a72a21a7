//! Any number of threads gives the same bits: voxels, skeleton and fields of whole scenes.

use super::modelled::{model, scene};
use lightvein::flow::network::{self, Quality};
use lightvein::flow::{estimator, ladder};
use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Field, Settings};
use lightvein::model::Model;
use lightvein::scene::Method;
use lightvein::trace::trace;
use std::fmt::Write;

const THREADS: [usize; 3] = [1, 2, 5];

#[test]
fn one_thread_and_many_give_the_same_bits() {
    for name in ["gallery", "cave", "tower"] {
        let scene = scene(name);
        let answers = THREADS.map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let model = model(&scene);
                let settings = Settings { samples: 300, ..Settings::default() };
                let estimate = |method| {
                    let estimate = estimator(method).unwrap();
                    estimate(&model, &model.probes_at_sensors(&scene), &settings, &Quiet, &Cancel::new()).unwrap()
                };
                let traced = trace(&scene, &model.rays, &model.sources, &settings, &Quiet, &Cancel::new()).unwrap();
                let carried = &ladder(Method::Diffusion)[1].estimate;
                let carried =
                    carried(&model, &model.probes_at_sensors(&scene), &settings, &Quiet, &Cancel::new()).unwrap();
                let estimated = [Method::Backward, Method::Forward, Method::Diffusion].map(estimate);
                let fields: Vec<Field> = estimated.into_iter().chain([carried, traced.field]).collect();
                (skeleton_in_words(&model), model.voxels.clone(), fields)
            })
        });
        for other in &answers[1..] {
            assert!(other.0 == answers[0].0, "{name}: the skeletons differ");
            assert!(other.1 == answers[0].1, "{name}: the voxels differ");
            assert!(same_bits(&other.2, &answers[0].2), "{name}: the fields differ");
        }
    }
}

/// Nodes, edges, cells and necks, with all their digits.
fn skeleton_in_words(model: &Model) -> String {
    let skeleton = &model.skeleton;
    let mut words = String::new();
    let nodes = skeleton.graph.raw_nodes().iter().map(|node| &node.weight).collect::<Vec<_>>();
    write!(words, "{nodes:?} {:?} {:?} {:?}", skeleton.graph.raw_edges(), skeleton.cells, skeleton.necks).unwrap();
    words
}

fn same_bits(a: &[Field], b: &[Field]) -> bool {
    let bits = |field: &Field| -> Vec<[u64; 4]> {
        let readings = field.readings.iter();
        readings
            .map(|reading| {
                [reading.value_w_m2, reading.flux_w_m2.x, reading.flux_w_m2.y, reading.flux_w_m2.z].map(f64::to_bits)
            })
            .collect()
    };
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| bits(a) == bits(b))
}

/// A network that is asked once at both kinds of probes answers as one for each.
#[test]
fn a_network_gathered_and_read_is_both_at_once() {
    let scene = scene("two_rooms");
    let (model, settings, never) = (model(&scene), Settings::default(), Cancel::new());
    let (at_sensors, at_nodes) = (model.probes_at_sensors(&scene), model.probes_at_nodes());
    let quality = Quality::COARSE;
    let asked = [&at_sensors[..], &at_nodes[..]];
    let [gathered, read] =
        network::gathered_and_read(&quality, &model, asked, &settings, &Quiet, &never).expect("nobody stops it");
    let alone = |quality, probes: &[_]| network::with(quality)(&model, probes, &settings, &Quiet, &never).unwrap();
    assert_eq!(gathered.readings, alone(quality, &at_sensors).readings);
    assert_eq!(read.readings, alone(quality.read(), &at_nodes).readings);
}
