//! Who competes: a name, what it makes before its first sample, and how it then answers.

use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Settings, Sources};
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::trace::{Traced, learned, trace};
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
        Contestant { name: "learned", prepare: Box::new(|| Ok(learning(stage))), learns: true },
    ]
}

fn plain<'a>(stage: &'a Stage<'a>) -> Run<'a> {
    Box::new(|seed, samples| {
        let settings = Settings { seed, samples, ..Settings::default() };
        trace(stage.scene, &stage.rays, &stage.sources, &settings, &Quiet, &Cancel::new()).expect("nobody cancels")
    })
}

fn learning<'a>(stage: &'a Stage<'a>) -> Run<'a> {
    Box::new(|seed, samples| {
        let settings = Settings { seed, samples, ..Settings::default() };
        learned::trace(stage.scene, &stage.rays, &stage.sources, &settings, &Quiet, &Cancel::new())
            .expect("nobody cancels")
    })
}
