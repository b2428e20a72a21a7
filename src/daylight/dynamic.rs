//! Parts of a scene were moved, scaled or hidden: which points does that concern, and what do they receive now?
//!
//! A ray that meets neither a box in which something stood nor one in which it stands now ends where it ended. The rays of a
//! point are known without being traced, for they follow from its number, so each is held against those boxes, which costs a
//! few nanoseconds where tracing costs hundreds; those that meet a box are sent through the scene as it was and as it is; only
//! points for which any of them ends otherwise are asked again, all others keep their bits. Of suns all are held against the
//! boxes, also where a point looks at some, and none is sent: meeting a box is enough. (Figure 12 of Munoz-Pandiella et al. 2017 has times of
//! updates; there the maps of depth are drawn anew for all.)
//!
//! Limits: for the suns boxes stand for what is in them, so points that see past a part's corners are asked again for nothing; a change that
//! reaches beyond the scene's largest coordinate changes the precision of all rays, and all is asked again.

use super::beams::{Cone, Suns};
use super::camera::Buffers;
use super::cast::{Asked, Casting, cast_at, look, looks, sky_directions, stands_at};
use super::{Exposure, Point};
use crate::job::{Cancel, Cancelled, Progress};
use crate::rays::Rays;
use crate::scene::Scene;
use crate::scene::parts::{Change, moved};
use crate::sky::map::ExposureMap;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Boxes beyond which those of before are taken as one, and those of after as another.
const MOST_BOXES: usize = 16;

/// Room about boxes, in lifts off surfaces: rays may meet a triangle by a rounding beside it, and points that stand off a surface
/// by twice the lift are put in their place by it.
const PAD_EPSILONS: f32 = 4.0;

/// Where something changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Disturbance {
    /// Boxes around what stood or stands there, metres; `None` for everywhere.
    boxes: Option<Vec<Around>>,
}

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Around {
    low_m: DVec3,
    high_m: DVec3,
}

impl Around {
    fn points(points_m: impl Iterator<Item = Vec3>, pad_m: f64) -> Option<Self> {
        let around = points_m.map(Vec3::as_dvec3).fold(None, |around: Option<Self>, at_m| {
            Some(around.map_or(Self { low_m: at_m, high_m: at_m }, |around| Self {
                low_m: around.low_m.min(at_m),
                high_m: around.high_m.max(at_m),
            }))
        })?;
        Some(Self { low_m: around.low_m - pad_m, high_m: around.high_m + pad_m })
    }

    fn with(&self, other: &Self) -> Self {
        Self { low_m: self.low_m.min(other.low_m), high_m: self.high_m.max(other.high_m) }
    }

    fn half_surface_m2(&self) -> f64 {
        let size = self.high_m - self.low_m;
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// Whether a ray without an end meets it (Kay & Kajiya 1986: between the pairs of planes).
    fn is_met(&self, from_m: DVec3, direction: DVec3) -> bool {
        let inverse = direction.recip();
        let [one, other] = [(self.low_m - from_m) * inverse, (self.high_m - from_m) * inverse];
        let (enters, leaves) = (one.min(other).max_element(), one.max(other).min_element());
        leaves >= enters.max(0.0)
    }

    /// Whether any of it is before the plane through a point.
    fn is_before(&self, from_m: DVec3, normal: DVec3) -> bool {
        let farthest = DVec3::select(normal.cmpgt(DVec3::ZERO), self.high_m, self.low_m);
        (farthest - from_m).dot(normal) > 0.0
    }

    /// Whether a point is in it.
    fn holds(&self, at_m: DVec3) -> bool {
        at_m.cmpge(self.low_m).all() && at_m.cmple(self.high_m).all()
    }

    /// A cone that holds all directions in which it is seen from a point.
    fn cone(&self, from_m: DVec3) -> Cone {
        let to_m = (self.low_m + self.high_m) / 2.0 - from_m;
        let sine = (self.high_m - self.low_m).length() / 2.0 / to_m.length();
        // The slack is far above the rounding of f32.
        let cosine = if sine < 1.0 { (1.0 - sine * sine).sqrt() - 1e-5 } else { -2.0 };
        Cone { axis: to_m.normalize_or_zero().as_vec3(), cosine: cosine as f32 }
    }
}

impl Disturbance {
    /// Where a scene, whose rays these are, is changed.
    fn of(scene: &Scene, rays: &Rays, changes: &[Change]) -> Self {
        let pad_m = f64::from(PAD_EPSILONS * rays.epsilon_m());
        let [mut before, mut after] = [Vec::new(), Vec::new()];
        for change in changes {
            before.extend(Around::points(scene.corners_of(change.part), pad_m));
            let moved = change.to.map(|to| scene.corners_of(change.part).map(move |at_m| moved(&to, at_m)));
            after.extend(moved.and_then(|corners_m| Around::points(corners_m, pad_m)));
        }
        let boxes = [before, after].into_iter().flat_map(joined).collect();
        Self { boxes: Some(boxes) }
    }

    /// Whether a ray without an end meets a place where something changed.
    pub fn meets(&self, from_m: Vec3, direction: Vec3) -> bool {
        let (from_m, direction) = (from_m.as_dvec3(), direction.as_dvec3());
        self.boxes.as_ref().is_none_or(|boxes| boxes.iter().any(|around| around.is_met(from_m, direction)))
    }
}

/// Boxes, those joined that together are no larger than apart.
fn joined(mut boxes: Vec<Around>) -> Vec<Around> {
    if boxes.len() > MOST_BOXES {
        return boxes.into_iter().reduce(|all, around| all.with(&around)).into_iter().collect();
    }
    let mut at = 0;
    while at < boxes.len() {
        let join = (at + 1..boxes.len()).find(|&other| {
            let (one, two) = (boxes[at], boxes[other]);
            one.with(&two).half_surface_m2() <= one.half_surface_m2() + two.half_surface_m2()
        });
        match join {
            Some(other) => {
                boxes[at] = boxes[at].with(&boxes[other]);
                boxes.swap_remove(other);
                at = 0;
            }
            None => at += 1,
        }
    }
    boxes
}

/// The rays of a scene after changes, and where they differ from those before.
pub fn changed(scene: &Scene, rays: &Rays, changes: &[Change]) -> (Rays, Disturbance) {
    match rays.changed(scene, changes) {
        Some(changed) => (changed, Disturbance::of(scene, rays, changes)),
        None => (Rays::new(&scene.changed(changes)), Disturbance { boxes: None }),
    }
}

/// A camera's buffers after changes: rays through pixels that meet no change are not sent again.
///
/// # Errors
/// [`Cancelled`].
pub fn seen_again(
    before: &Buffers,
    rays: &Rays,
    disturbance: &Disturbance,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Buffers, Cancelled> {
    let mut after = before.clone();
    let camera = before.camera;
    let [width, height] = camera.size;
    progress.begin("buffers", height as u64);
    let rows = after.depth_m.par_chunks_mut(width).zip(after.normals.par_chunks_mut(width)).enumerate();
    let looked = rows.try_for_each(|(row, (depths_m, normals))| {
        cancel.check()?;
        for (column, (depth_m, normal)) in depths_m.iter_mut().zip(normals).enumerate() {
            if disturbance.meets(camera.from_m, camera.ray(column, row)) {
                (*depth_m, *normal) = camera.look(rays, column, row).unwrap_or((f32::INFINITY, Vec3::ZERO));
            }
        }
        progress.advance(1);
        Ok(())
    });
    progress.end();
    looked.map(|()| after)
}

/// What points receive after a change.
#[derive(Debug, Clone, PartialEq)]
pub struct Updated {
    /// All of them, in the order of the points.
    pub exposures: Vec<Exposure>,
    /// How many were asked again.
    pub again: usize,
}

/// What was known before a change: points with ascending numbers, and what they received.
#[derive(Debug, Clone, Copy)]
pub struct Known<'a> {
    /// The rays that told so.
    pub rays: &'a Rays,
    /// The points.
    pub asked: Asked<'a>,
    /// Their exposures.
    pub exposures: &'a [Exposure],
}

/// What `asked`, with ascending numbers, receives after a change: the same bits as [`cast_at`] gives with the rays after it. Points
/// that are where they were under their number, and have no ray that meets a change, keep what they had.
///
/// # Errors
/// [`Cancelled`].
#[expect(clippy::too_many_arguments, reason = "the question of cast_at, what was known, and where it changed")]
pub fn update(
    rays: &Rays,
    asked: Asked,
    known: Known,
    disturbance: &Disturbance,
    map: &ExposureMap,
    north_rad: f64,
    casting: Casting,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Updated, Cancelled> {
    let suns = Suns::new(map, north_rad);
    let kept = same_points(asked, known);
    progress.begin("rays concerned", asked.points.len() as u64);
    let concerned: Result<Vec<Option<&Exposure>>, Cancelled> = (asked.points.par_iter().enumerate())
        .map(|(at, point)| {
            cancel.check()?;
            progress.advance(1);
            let looks = !asked.in_the_open;
            let stays = |_: &&Exposure| {
                let concern = Concern { disturbance, rays: [known.rays, rays], suns: &suns, casting, looks };
                !concern.is_of(point, asked.number(at))
            };
            Ok(kept[at].and_then(|old| known.exposures.get(old)).filter(stays))
        })
        .collect();
    progress.end();
    let kept = concerned?;

    let again: Vec<usize> = (0..kept.len()).filter(|&at| kept[at].is_none()).collect();
    let points: Vec<Point> = again.iter().map(|&at| asked.points[at]).collect();
    let numbers: Vec<u32> = again.iter().map(|&at| asked.number(at) as u32).collect();
    let some = Asked { points: &points, numbers: Some(&numbers), ..asked };
    let found = cast_at(rays, some, map, north_rad, casting, progress, cancel)?;
    let mut found = found.into_iter();
    let exposures = kept.into_iter().filter_map(|kept| kept.copied().or_else(|| found.next())).collect();
    Ok(Updated { exposures, again: again.len() })
}

/// For each point the place before of the one with its number, where that was the same point.
fn same_points(asked: Asked, known: Known) -> Vec<Option<usize>> {
    let mut old = 0;
    (0..asked.points.len())
        .map(|at| {
            let number = asked.number(at);
            while old < known.asked.points.len() && known.asked.number(old) < number {
                old += 1;
            }
            let is_same = old < known.asked.points.len()
                && known.asked.number(old) == number
                && known.asked.points[old] == asked.points[at];
            is_same.then_some(old)
        })
        .collect()
}

/// What a point's rays are held against.
struct Concern<'a> {
    disturbance: &'a Disturbance,
    /// Before and after.
    rays: [&'a Rays; 2],
    suns: &'a Suns,
    casting: Casting,
    /// Whether points look whether they are inside matter.
    looks: bool,
}

impl Concern<'_> {
    /// Whether a ray that a point sends may end otherwise than before, or the point itself is at a change: where its rays begin
    /// depends on what is near.
    fn is_of(&self, point: &Point, number: u64) -> bool {
        let Some(boxes) = &self.disturbance.boxes else { return true };
        let [old, new] = self.rays;
        let from_m = stands_at(new, point);
        let from = from_m.as_dvec3();
        if boxes.iter().any(|around| around.holds(from) || around.holds(point.position_m.as_dvec3())) {
            return true;
        }
        let differs = |direction: Vec3| {
            self.disturbance.meets(from_m, direction) && look(old, from_m, direction) != look(new, from_m, direction)
        };
        if self.looks && looks().any(differs) {
            return true;
        }
        let before = |around: &&Around| point.normal.is_none_or(|normal| around.is_before(from, normal.as_dvec3()));
        let seen: Vec<(&Around, Cone)> =
            boxes.iter().filter(before).map(|around| (around, around.cone(from))).collect();

        let in_front = |sun: Vec3| point.normal.is_none_or(|normal| sun.dot(normal) > 0.0);
        let is_shaded = |&(around, cone): &(&Around, Cone)| {
            self.suns.any_in(&cone, |sun| in_front(sun) && around.is_met(from, sun.as_dvec3()))
        };
        if seen.iter().any(is_shaded) {
            return true;
        }

        // The sky is looked for above the horizon alone.
        let is_met = |direction: Vec3| {
            seen.iter().any(|(around, cone)| {
                direction.dot(cone.axis) >= cone.cosine && around.is_met(from, direction.as_dvec3())
            })
        };
        let differs = |direction: Vec3| {
            let is_asked = direction.z > 0.0 && is_met(direction);
            is_asked && old.from_afar(from_m, direction) != new.from_afar(from_m, direction)
        };
        seen.iter().any(|(around, _)| around.high_m.z > from.z)
            && sky_directions(point.normal, self.casting, number).any(differs)
    }
}
