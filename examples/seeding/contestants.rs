//! Who competes: a name, what it makes before its first sample, and how it then answers.

use glam::Vec3;
use lightvein::flow::network::{Network, Quality};
use lightvein::guide::places;
use lightvein::guide::shine::Shine;
use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Guiding, Incident, Settings, Sources};
use lightvein::model::Model;
use lightvein::model::choose::choose_voxel_m;
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::trace::guided::trace_guided;
use lightvein::trace::learned::trace_learning;
use lightvein::trace::{Traced, trace};
use std::error::Error;
use std::sync::Arc;

/// Answers at the scene's sensors, from a seed and a number of samples a sensor.
pub type Run<'a> = Box<dyn Fn(u64, u32) -> Traced + 'a>;

/// Who competes.
pub struct Contestant<'a> {
    pub name: &'static str,
    /// What comes before the first sample; its time is the contestant's.
    pub prepare: Box<dyn Fn() -> Result<Run<'a>, Box<dyn Error>> + 'a>,
    /// Whether samples of one run depend on earlier ones, so that a run of ten seconds is not ten of one.
    pub learns: bool,
}

/// A scene as all contestants have it: reading it and its tree of surfaces is nobody's time.
pub struct Stage<'a> {
    pub scene: &'a Scene,
    pub rays: Arc<Rays>,
    pub sources: Sources,
}

impl<'a> Stage<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        Self { scene, rays: Arc::new(Rays::new(scene)), sources: Sources::of(scene) }
    }
}

/// All of them, `plain` first.
pub fn contestants<'a>(stage: &'a Stage<'a>) -> Vec<Contestant<'a>> {
    vec![
        Contestant { name: "plain", prepare: Box::new(|| Ok(plain(stage))), learns: false },
        Contestant { name: "guided", prepare: Box::new(|| guided(stage)), learns: false },
        Contestant { name: "learned", prepare: Box::new(|| Ok(learning(stage))), learns: true },
    ]
}

fn plain<'a>(stage: &'a Stage<'a>) -> Run<'a> {
    Box::new(|seed, samples| {
        let settings = Settings { seed, samples, ..Settings::default() };
        trace(stage.scene, &stage.rays, &stage.sources, &settings, &Quiet, &Cancel::new()).expect("nobody cancels")
    })
}

/// Voxels, skeleton, network and lobes; then paths that follow the lobes.
fn guided<'a>(stage: &'a Stage<'a>) -> Result<Run<'a>, Box<dyn Error>> {
    let (quiet, cancel) = (&Quiet, &Cancel::new());
    let model = match stage.scene.model.voxel_m {
        Some(voxel_m) => Model::build(stage.scene, stage.rays.clone(), voxel_m, u64::MAX, quiet, cancel)?,
        None => choose_voxel_m(stage.scene, &stage.rays, u64::MAX, quiet, cancel)?.model,
    };
    // The network borrows the model and both serve the runs: they live as long as the program.
    let model: &Model = Box::leak(Box::new(model));
    let quality = Quality { spacing: 0.4, lines: 20, all_lines: 42_000, neck_lines: 1024, ..Quality::MEDIUM };
    let (mut network, lines) = Network::new(model, &quality, &Settings::default(), quiet, cancel)?;
    let grounds = &mut network.grounds;
    grounds.patches.fill_gaps(&grounds.zones);
    let shine = Shine::new(&network);
    let walls = places::at_walls(&network, &shine, &lines);
    let open = places::in_zones(&network, &shine, &lines, 0);
    drop(shine);
    Ok(Box::new(move |seed, samples| {
        let (patches, zones, first_open) = (&network.grounds.patches, &network.grounds.zones, walls.len() as u32);
        let in_open = |at_m: Vec3| {
            let node = model.skeleton.nearest.node(model.voxels.lattice.voxel_at(at_m))?;
            Some(zones.at(node, at_m) + first_open)
        };
        let place_of = |at_m: Vec3, normal: Option<Vec3>| {
            let on_wall = normal.and_then(|normal| patches.near(model, zones, at_m, normal));
            on_wall.or_else(|| in_open(at_m))
        };
        let places: Vec<&Incident> = walls.iter().chain(&open).collect();
        let guiding = Guiding { places, at_sensors: Vec::new(), place_of: &place_of };
        let settings = Settings { seed, samples, ..Settings::default() };
        trace_guided(stage.scene, &stage.rays, &stage.sources, &guiding, &settings, &Quiet, &Cancel::new())
            .expect("nobody cancels")
    }))
}

fn learning<'a>(stage: &'a Stage<'a>) -> Run<'a> {
    Box::new(|seed, samples| {
        let settings = Settings { seed, samples, ..Settings::default() };
        trace_learning(stage.scene, &stage.rays, &stage.sources, &settings, &Quiet, &Cancel::new())
            .expect("nobody cancels")
    })
}
