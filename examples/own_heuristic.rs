//! A heuristic of one's own in `compare`, beside the built-in ones: here the inverse square of the path's length alone.
//!
//! `cargo run --release --example own_heuristic -- scenes/gallery/gallery.toml`

use lightvein::flow::{Arrival, add_lights, inverse_square};
use lightvein::job::{Cancel, Quiet};
use lightvein::model::Model;
use lightvein::rays::Rays;
use lightvein::scene::{Method, Scene};
use lightvein::study::compare::{Contestant, Run, compare};
use std::sync::Arc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args_os().nth(1).ok_or("usage: own_heuristic SCENE")?;
    let (progress, cancel) = (Quiet, Cancel::new());
    let scene = Scene::load(path.as_ref(), &progress, &cancel)?;
    let model = Model::build(&scene, Arc::new(Rays::new(&scene)), 0.1, u64::MAX, &progress, &cancel)?;

    let by_path_alone: &lightvein::flow::Estimator = &|model, probes, _settings, progress, cancel| {
        add_lights(model, probes, progress, cancel, |lit| {
            Box::new(|probe, node| {
                let to_node_m = (lit.model.node_m(node) - probe.position_m).as_dvec3();
                let path_m = to_node_m.length() + lit.tree.distance_m[node.index()] + lit.light.to_node_m;
                Arrival {
                    irradiance_w_m2: inverse_square(lit.light.flux_w, path_m, lit.model.nearest_m()),
                    towards: to_node_m.normalize_or_zero(),
                }
            })
        })
    };

    let contestants = [
        Contestant::built_in(Method::Backward),
        Contestant::built_in(Method::Forward),
        Contestant { name: "by path alone".to_owned(), run: Run::Estimate(by_path_alone) },
    ];
    let entries = compare(&scene, &model, &contestants, &scene.reference, &Default::default(), &progress, &cancel)?;
    for entry in entries {
        println!("{:14} rms factor {:?}", entry.name, entry.errors.rms_factor);
    }
    Ok(())
}
