//! The answer to an [`OutdoorRequest`], by the library's steps: the sky of the period, then sensors, faces and pixels under it.
//! A step whose ground has not changed is not done again, and each is handed out as soon as it is there.
//!
//! Faces are asked by maps of heights first, some tenths of a second, and then by rays, which alone follow changes of parts
//! point by point ([`lightvein::daylight::dynamic`]). A view is asked by the cheapest way within the library's tolerance for
//! pictures, at a quarter of its size first.

use super::sky::{Scenery, Sky};
use super::{FaceExposure, OutdoorRequest, OutdoorResults, PixelExposure, SensorExposure};
use crate::results::Failed;
use lightvein::daylight::camera::{Buffers, Camera};
use lightvein::daylight::cast::{Asked, Casting, cast_at};
use lightvein::daylight::choose::{PICTURE_TOLERANCE, choose};
use lightvein::daylight::dynamic::{Known, update};
use lightvein::daylight::surface::{Patch, PatchError, default_patch_m, patches, patches_changed};
use lightvein::daylight::way::{Ground, Prepared, Way};
use lightvein::daylight::{self, Point};
use lightvein::job::{Cancel, Progress};
use lightvein::scene::parts::Edit;
use lightvein::scene::{Scene, Site};
use std::sync::Arc;
use std::time::Instant;

/// Rays of a sensor: within 0.2% of all suns and of many directions, a few tenths of a millisecond each.
const AT_SENSORS: Casting = Casting { sun_rays: Some(1024), sky_rays: 1024, seed: 0 };

/// A view's first pass has its sides divided by this.
const FIRST_PASS: usize = 4;

/// Everything that the answer depends on.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// What is asked.
    pub asked: &'a OutdoorRequest,
    /// The scene as its file has it.
    pub scene: &'a Arc<Scene>,
    /// What is done to its parts.
    pub edits: &'a [(String, Edit)],
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Question<'_> {
    /// The site that is asked about; `None` where there is none.
    pub fn site(&self) -> Option<&Site> {
        self.asked.site.as_ref().or(self.scene.site.as_ref())
    }
}

/// Answers a question. Parts of `before`, an earlier answer, are taken over where they still hold; `each` hears every new part
/// as soon as it is there, with the older ones of the same scene that are still to be replaced. A scene without a site
/// has an empty answer.
///
/// # Errors
/// Broken weather, a site that lacks something, edits that cannot be; [`Failed::Cancelled`].
pub fn compute(
    question: &Question,
    before: &OutdoorResults,
    progress: &dyn Progress,
    cancel: &Cancel,
    each: &mut dyn FnMut(OutdoorResults),
) -> Result<OutdoorResults, Failed> {
    let started = Instant::now();
    let Some(site) = question.site() else { return Ok(OutdoorResults::default()) };
    let is_same_scene = before.scenery.as_ref().is_some_and(|known| Arc::ptr_eq(&known.scene, question.scene));
    let mut now = if is_same_scene { before.clone() } else { OutdoorResults::default() };
    now.notes.clear();

    let sky = match now.sky.take() {
        Some(known) if known.site == *site => known,
        known => Arc::new(Sky::of(site, known.as_deref(), progress, cancel)?),
    };
    now.sky = Some(Arc::clone(&sky));
    let scenery = match now.scenery.take() {
        Some(known) if known.is_of(question.scene, question.edits) => known,
        known => Arc::new(Scenery::of(question.scene, question.edits, known.as_deref())?),
    };
    now.scenery = Some(Arc::clone(&scenery));
    // Faces that nobody looks at now stay, as long as they are of this sky: asking them again takes long.
    let is_of_sky = |faces: &Arc<FaceExposure>| question.asked.on_faces || Arc::ptr_eq(&faces.sky, &sky);
    now.faces = now.faces.filter(is_of_sky);
    now.unchanged_faces = now.unchanged_faces.filter(is_of_sky);
    if question.asked.view.is_none() {
        now.pixels = None;
    }
    each(now.clone());

    let run = Run { question, sky, scenery, progress, cancel };
    run.sensors(&mut now)?;
    run.pixels(&mut now, each)?;
    run.faces(&mut now, each)?;
    now.seconds = started.elapsed().as_secs_f64();
    Ok(now)
}

/// What all steps of an answer share.
struct Run<'a> {
    question: &'a Question<'a>,
    sky: Arc<Sky>,
    scenery: Arc<Scenery>,
    progress: &'a dyn Progress,
    cancel: &'a Cancel,
}

impl Run<'_> {
    fn stands_on(&self, sky: &Arc<Sky>, scenery: &Arc<Scenery>) -> bool {
        Arc::ptr_eq(&self.sky, sky) && Arc::ptr_eq(&self.scenery, scenery)
    }

    fn north_rad(&self) -> f64 {
        self.sky.outdoors.north_rad
    }

    fn sensors(&self, now: &mut OutdoorResults) -> Result<(), Failed> {
        if now.sensors.as_ref().is_some_and(|known| self.stands_on(&known.sky, &known.scenery)) {
            return Ok(());
        }
        let points = daylight::points(&self.question.scene.sensors);
        let casting = Casting { seed: self.question.seed, ..AT_SENSORS };
        let (rays, map, north_rad) = (self.scenery.rays_now(), &self.sky.map, self.north_rad());
        let exposures = cast_at(rays, Asked::all(&points), map, north_rad, casting, self.progress, self.cancel)?;
        now.sensors = Some(Arc::new(SensorExposure {
            exposures,
            sky: Arc::clone(&self.sky),
            scenery: Arc::clone(&self.scenery),
        }));
        Ok(())
    }

    fn faces(&self, now: &mut OutdoorResults, each: &mut dyn FnMut(OutdoorResults)) -> Result<(), Failed> {
        if !self.question.asked.on_faces {
            return Ok(());
        }
        let patch_m = self.question.asked.patch_m.unwrap_or_else(|| default_patch_m(&self.question.scene.mesh));
        let is_whole = |known: &&Arc<FaceExposure>| known.patch_m == patch_m && !known.is_first_pass;
        if now.faces.as_ref().filter(is_whole).is_some_and(|known| self.stands_on(&known.sky, &known.scenery)) {
            return Ok(());
        }
        let is_of_sky = |known: &&Arc<FaceExposure>| Arc::ptr_eq(&known.sky, &self.sky);
        let unchanged = match now.unchanged_faces.as_ref().filter(is_whole).filter(is_of_sky) {
            Some(known) => Arc::clone(known),
            None => self.unchanged_faces(patch_m, now, each)?,
        };
        now.unchanged_faces = Some(Arc::clone(&unchanged));
        now.faces = Some(self.changed_faces(unchanged)?);
        each(now.clone());
        Ok(())
    }

    /// Faces of the mesh as its file has it, by rays; where no part is changed, `each` hears of them by maps first.
    fn unchanged_faces(
        &self,
        patch_m: f32,
        now: &mut OutdoorResults,
        each: &mut dyn FnMut(OutdoorResults),
    ) -> Result<Arc<FaceExposure>, Failed> {
        let scene = self.question.scene;
        let patches = patches(&scene.mesh, patch_m, self.cancel).map_err(|error| match error {
            PatchError::Cancelled(_) => Failed::Cancelled,
            error => Failed::Because(error.into()),
        })?;
        let points: Vec<Point> = patches.iter().map(Patch::point).collect();
        let by = |way: Way| {
            let rays = &self.scenery.rays;
            let (map, north_rad, seed) = (&self.sky.map, self.north_rad(), self.question.seed);
            let ground = Ground { scene, rays, map, north_rad, seed };
            way.prepare(&ground, self.cancel)?.ask(&ground, Asked::all(&points), None, self.progress, self.cancel)
        };
        let whole = FaceExposure {
            numbers: (0..points.len() as u32).collect(),
            exposures: Vec::new(),
            patch_m,
            again: points.len(),
            is_first_pass: false,
            sky: Arc::clone(&self.sky),
            scenery: Arc::clone(&self.scenery),
            patches,
        };
        if self.scenery.changed.is_none() {
            let [_, by_maps, ..] = Way::for_points(self.question.seed);
            let exposures = by(by_maps)?;
            now.faces = Some(Arc::new(FaceExposure { exposures, is_first_pass: true, ..whole.clone() }));
            each(now.clone());
        }
        let exposures = by(Way::Rays(Casting::of_faces(self.question.seed)))?;
        Ok(Arc::new(FaceExposure { exposures, ..whole }))
    }

    /// The faces after the changes of parts: only points that these concern are asked again.
    fn changed_faces(&self, unchanged: Arc<FaceExposure>) -> Result<Arc<FaceExposure>, Failed> {
        let Some(changed) = &self.scenery.changed else {
            // The scenery may be one whose edits were undone.
            let is_of_this = Arc::ptr_eq(&unchanged.scenery, &self.scenery);
            let scenery = Arc::clone(&self.scenery);
            return Ok(if is_of_this { unchanged } else { Arc::new(FaceExposure { scenery, ..(*unchanged).clone() }) });
        };
        let change_of = self.question.scene.change_of_triangles(&changed.changes);
        let (numbers, patches) = patches_changed(&unchanged.patches, &changed.changes, &change_of);
        let points = |patches: &[Patch]| patches.iter().map(Patch::point).collect::<Vec<Point>>();
        let (points_before, points) = (points(&unchanged.patches), points(&patches));
        let asked = Asked { points: &points, numbers: Some(&numbers), in_the_open: false };
        let asked_before = Asked { points: &points_before, numbers: Some(&unchanged.numbers), in_the_open: false };
        let known = Known { rays: &self.scenery.rays, asked: asked_before, exposures: &unchanged.exposures };
        let updated = update(
            &changed.rays,
            asked,
            known,
            &changed.disturbance,
            &self.sky.map,
            self.north_rad(),
            Casting::of_faces(self.question.seed),
            self.progress,
            self.cancel,
        )?;
        Ok(Arc::new(FaceExposure {
            patches,
            numbers,
            exposures: updated.exposures,
            patch_m: unchanged.patch_m,
            again: updated.again,
            is_first_pass: false,
            sky: Arc::clone(&self.sky),
            scenery: Arc::clone(&self.scenery),
        }))
    }

    fn pixels(&self, now: &mut OutdoorResults, each: &mut dyn FnMut(OutdoorResults)) -> Result<(), Failed> {
        let Some(view) = self.question.asked.view else { return Ok(()) };
        let known = now.pixels.as_ref().filter(|known| self.stands_on(&known.sky, &known.scenery));
        if known.is_some_and(|known| known.view == view && !known.is_first_pass) {
            return Ok(());
        }
        if let Err(error) = view.check(self.scenery.rays_now()) {
            now.notes.push(format!("no exposure by pixels: {error}"));
            now.pixels = None;
            return Ok(());
        }
        let scene = self.scenery.scene_now();
        let ground = Ground {
            scene: &scene,
            rays: self.scenery.rays_now(),
            map: &self.sky.map,
            north_rad: self.north_rad(),
            seed: self.question.seed,
        };
        let first = Camera { size: view.size.map(|side| side.div_ceil(FIRST_PASS)), ..view };
        let seen = self.seen(&ground, first)?;
        let way = match (known, &now.pixels) {
            (Some(known), _) => Arc::clone(&known.way),
            // The kind of way that served the scene before its parts were moved serves it again.
            (None, Some(other)) if Arc::ptr_eq(&other.scenery.scene, &self.scenery.scene) => {
                Arc::new(other.way.way.prepare(&ground, self.cancel)?)
            }
            _ => Arc::new(self.chosen(&ground, &seen)?),
        };
        now.pixels = Some(Arc::new(self.exposed(&ground, seen, &way, view, true)?));
        each(now.clone());
        let seen = self.seen(&ground, view)?;
        now.pixels = Some(Arc::new(self.exposed(&ground, seen, &way, view, false)?));
        each(now.clone());
        Ok(())
    }

    /// What a camera sees, and the points behind its pixels.
    fn seen(&self, ground: &Ground, camera: Camera) -> Result<Seen, Failed> {
        let buffers = Buffers::render(ground.rays, &camera, self.progress, self.cancel)?;
        let seen = (0..buffers.depth_m.len()).filter_map(|pixel| Some((pixel as u32, buffers.point(pixel)?)));
        let (numbers, points) = seen.unzip();
        Ok(Seen { buffers, numbers, points })
    }

    fn chosen(&self, ground: &Ground, seen: &Seen) -> Result<Prepared, Failed> {
        let ways = Way::for_pixels(ground.seed);
        let (progress, cancel) = (self.progress, self.cancel);
        Ok(choose(ground, seen.asked(), Some(&seen.buffers), &ways, PICTURE_TOLERANCE, progress, cancel)?.way)
    }

    fn exposed(
        &self,
        ground: &Ground,
        seen: Seen,
        way: &Arc<Prepared>,
        view: Camera,
        is_first_pass: bool,
    ) -> Result<PixelExposure, Failed> {
        let exposures = way.ask(ground, seen.asked(), Some(&seen.buffers), self.progress, self.cancel)?;
        Ok(PixelExposure {
            buffers: seen.buffers,
            numbers: seen.numbers,
            exposures,
            way: Arc::clone(way),
            view,
            is_first_pass,
            sky: Arc::clone(&self.sky),
            scenery: Arc::clone(&self.scenery),
        })
    }
}

/// Pixels of a picture and what is behind them.
struct Seen {
    buffers: Buffers,
    numbers: Vec<u32>,
    points: Vec<Point>,
}

impl Seen {
    fn asked(&self) -> Asked<'_> {
        Asked { points: &self.points, numbers: Some(&self.numbers), in_the_open: true }
    }
}
