//! Parts of the scene moved, scaled or hidden after the first result: the second one, and how long it took.

use super::places::{Places, Scenery};
use crate::daylight::Exposure;
use crate::daylight::cast::Casting;
use crate::daylight::dynamic::{Known, changed, update};
use crate::job::{Cancel, Progress};
use crate::rays::Rays;
use crate::scene::Scene;
use crate::scene::parts::{Change, Edit};
use crate::sky::map::ExposureMap;
use anyhow::Result;
use std::time::Instant;

/// The result after the edits.
pub struct After {
    /// Where the points are now.
    pub places: Places,
    /// What they receive now.
    pub exposures: Vec<Exposure>,
    /// How many of them were asked again.
    pub again: usize,
    /// How many parts were changed, and how many triangles they have.
    pub changed: [usize; 2],
    /// How long it took, seconds.
    pub seconds: f64,
}

/// The first result and what it came from.
pub struct Before<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its rays.
    pub rays: &'a Rays,
    /// Its points.
    pub places: &'a Places,
    /// What they receive.
    pub exposures: &'a [Exposure],
    /// The sun and the sky of the period.
    pub map: &'a ExposureMap,
    /// Direction of true north, clockwise from +Y.
    pub north_rad: f64,
    /// Rays a point.
    pub casting: Casting,
}

impl Before<'_> {
    /// What becomes of the first result by changes of the scene.
    ///
    /// # Errors
    /// An interrupt.
    pub fn after(&self, changes: Vec<Change>, progress: &dyn Progress, cancel: &Cancel) -> Result<After> {
        let begin = Instant::now();
        let (rays, disturbance) = changed(self.scene, self.rays, &changes);
        let scenery = Scenery { changes, rays, disturbance };
        let places = self.places.changed(self.scene, &scenery, progress, cancel)?;
        let known = Known { rays: self.rays, asked: self.places.asked(), exposures: self.exposures };
        let Scenery { changes, rays, disturbance } = &scenery;
        let updated =
            update(rays, places.asked(), known, disturbance, self.map, self.north_rad, self.casting, progress, cancel)?;
        let seconds = begin.elapsed().as_secs_f64();
        let triangles = changes.iter().map(|change| self.scene.triangles_of(change.part).count()).sum();
        let changed = [changes.len(), triangles];
        Ok(After { places, exposures: updated.exposures, again: updated.again, changed, seconds })
    }
}

/// An edit as it was typed.
pub fn typed((name, edit): &(String, Edit)) -> String {
    match edit {
        Edit::Scale(by) => format!("scale {name}={by}"),
        Edit::Move(by_m) => format!("move {name}={},{},{}", by_m.x, by_m.y, by_m.z),
        Edit::Hide => format!("hide {name}"),
    }
}

/// What is odd about changes, a sentence each.
pub fn odd(scene: &Scene, changes: &[Change]) -> Vec<String> {
    let kept: usize =
        changes.iter().filter_map(|change| scene.parts.get(change.part)).map(|part| part.keeps_for_others).sum();
    let says =
        format!("{kept} faces go with the changed parts that others had in the same place, which are left open there");
    (kept > 0).then_some(says).into_iter().collect()
}
