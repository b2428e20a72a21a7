//! Who competes: a name, what it makes before its first sample, and how it then answers.

use glam::Vec3;
use lightvein::flow::network::Quality;
use lightvein::guide::known::{QUALITY, known};
use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Incident, Settings, Sources};
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

/// All of them, `plain` first; those with guides that say nothing or lie only where they are asked for.
pub fn contestants<'a>(stage: &'a Stage<'a>, with_wrong: bool) -> Vec<Contestant<'a>> {
    if with_wrong {
        let misled = |lie: fn(&mut Incident)| move || guided(stage, QUALITY, lie);
        return vec![
            Contestant { name: "plain", prepare: Box::new(|| Ok(plain(stage))), learns: false },
            Contestant {
                name: "empty",
                prepare: Box::new(misled(|place| *place = Incident::default())),
                learns: false,
            },
            Contestant { name: "turned", prepare: Box::new(misled(turned)), learns: false },
            Contestant { name: "boasting", prepare: Box::new(misled(boasting)), learns: false },
            Contestant { name: "modest", prepare: Box::new(misled(modest)), learns: false },
        ];
    }
    vec![
        Contestant { name: "plain", prepare: Box::new(|| Ok(plain(stage))), learns: false },
        Contestant { name: "guided", prepare: Box::new(|| guided(stage, QUALITY, |_| ())), learns: false },
        Contestant { name: "coarse", prepare: Box::new(|| guided(stage, Quality::COARSE, |_| ())), learns: false },
        Contestant { name: "learned", prepare: Box::new(|| Ok(learning(stage))), learns: true },
    ]
}

fn plain<'a>(stage: &'a Stage<'a>) -> Run<'a> {
    Box::new(|seed, samples| {
        let settings = Settings { seed, samples, ..Settings::default() };
        trace(stage.scene, &stage.rays, &stage.sources, &settings, &Quiet, &Cancel::new()).expect("nobody cancels")
    })
}

/// Voxels, skeleton, the light at places and at the sensors; then paths that follow it. Voxels twice as large as the scene's guide
/// as well and are made in a sixth of the time. What is told of each place, `lie` may change.
fn guided<'a>(stage: &'a Stage<'a>, quality: Quality, lie: fn(&mut Incident)) -> Result<Run<'a>, Box<dyn Error>> {
    let (quiet, cancel) = (&Quiet, &Cancel::new());
    let model = match stage.scene.model.voxel_m {
        Some(voxel_m) => Model::build(stage.scene, stage.rays.clone(), 2.0 * voxel_m, u64::MAX, quiet, cancel)?,
        None => choose_voxel_m(stage.scene, &stage.rays, u64::MAX, quiet, cancel)?.model,
    };
    // The guide borrows the model and both serve the runs: it lives as long as the program.
    let model: &Model = Box::leak(Box::new(model));
    let mut known = known(model, &quality, &Settings::default(), quiet, cancel)?;
    let mut at_sensors = known.at_probes(&model.probes_at_sensors(stage.scene), 0, cancel)?;
    known.walls.iter_mut().chain(&mut known.zones).chain(&mut at_sensors).for_each(lie);
    Ok(Box::new(move |seed, samples| {
        let place_of = |at_m: Vec3, normal: Option<Vec3>| known.place_of(at_m, normal);
        let guiding = known.guiding(&at_sensors, &place_of);
        let settings = Settings { seed, samples, ..Settings::default() };
        trace_guided(stage.scene, &stage.rays, &stage.sources, &guiding, &settings, &Quiet, &Cancel::new())
            .expect("nobody cancels")
    }))
}

/// Light comes from the other side, narrowly, and for sure; the lamps are each other's.
fn turned(place: &mut Incident) {
    for lobe in &mut place.lobes {
        let flat = place.normal.unwrap_or(Vec3::ZERO);
        lobe.direction = (2.0 * lobe.direction.dot(flat) * flat - lobe.direction).normalize();
        lobe.concentration = 500.0;
    }
    place.trust = 0.8;
    let lamps = place.direct_w_m2.len();
    place.direct_w_m2.rotate_left(lamps.min(1));
}

/// A hundred times too much light is expected at every place but the sensors' like.
fn boasting(place: &mut Incident) {
    place.reflected_w_m2 *= if place.normal.is_some() { 100.0 } else { 1.0 };
}

/// Hardly any light is expected.
fn modest(place: &mut Incident) {
    place.reflected_w_m2 *= if place.normal.is_some() { 0.01 } else { 1.0 };
    place.direct_w_m2.iter_mut().for_each(|direct_w_m2| *direct_w_m2 *= 0.01);
}

fn learning<'a>(stage: &'a Stage<'a>) -> Run<'a> {
    Box::new(|seed, samples| {
        let settings = Settings { seed, samples, ..Settings::default() };
        trace_learning(stage.scene, &stage.rays, &stage.sources, &settings, &Quiet, &Cancel::new())
            .expect("nobody cancels")
    })
}
