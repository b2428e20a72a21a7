//! What a renderer is seeded with, as files: a JSON object that describes them all, NumPy arrays of places, and tables and PLY
//! files of the rest. Field by field in `docs/seeding.md`.

mod arrays;
mod document;
mod tables;

use super::analysed::Writer;
use crate::guide::Guide;
use crate::model::Model;
use crate::scene::Scene;

/// A guide and what it is of.
#[derive(Debug, Clone, Copy)]
pub struct Guided<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What was modelled of it.
    pub model: &'a Model,
    /// What is known of its light.
    pub guide: &'a Guide,
}

/// The files of a guide, each by its name, `guide.json` first.
pub fn files(guided: Guided<'_>) -> Vec<(&'static str, Writer<'_>)> {
    let Guide { nodes, walls, .. } = guided.guide;
    let emitters = guided.model.sources.emitters.len();
    vec![
        ("guide.json", Box::new(move |out| document::write(out, &guided))),
        ("walls.npy", Box::new(move |out| arrays::write_walls(out, &guided))),
        ("walls_lobes.npy", Box::new(move |out| arrays::write_lobes(out, walls))),
        ("walls_lights.npy", Box::new(move |out| arrays::write_lights(out, walls, emitters))),
        ("nodes.npy", Box::new(move |out| arrays::write_nodes(out, &guided))),
        ("nodes_lobes.npy", Box::new(move |out| arrays::write_lobes(out, nodes))),
        ("nodes_lights.npy", Box::new(move |out| arrays::write_lights(out, nodes, emitters))),
        ("samples.npy", Box::new(move |out| arrays::write_samples(out, &guided))),
        ("necks.ply", Box::new(move |out| tables::write_necks(out, &guided))),
        ("vpls.csv", Box::new(move |out| tables::write_virtual_lights(out, &guided))),
        ("vpls.ply", Box::new(move |out| tables::write_virtual_lights_ply(out, &guided))),
        ("probes.csv", Box::new(move |out| tables::write_probes(out, &guided))),
        ("cache.csv", Box::new(move |out| tables::write_cache(out, &guided))),
    ]
}

/// A cell's number in files; -1 where there is none.
fn cell(cell: u32) -> i64 {
    if cell == u32::MAX { -1 } else { i64::from(cell) }
}
