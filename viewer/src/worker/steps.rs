//! A request's answer as a list of steps, each shown as soon as it is there.

use super::cache::{Cache, Loaded, Modelled, Shaped};
use super::watch::available_bytes;
use crate::outdoors::OutdoorResults;
use crate::outdoors::compute::{Question, compute};
use crate::request::{Edits, How, Request, Source};
use crate::results::{Answer, Estimate, Faces, Failed, Results};
use crate::{sides, welcome};
use anyhow::Context;
use lightvein::export::analysed::{Analysed, files};
use lightvein::export::whole_file;
use lightvein::flow::network::{self, Quality};
use lightvein::flow::veins::through_edges_w;
use lightvein::flow::{Rung, estimator, ladder};
use lightvein::job::{Cancel, Progress, Quiet};
use lightvein::light::{Field, Settings, Sources};
use lightvein::model::bare::light_bare_mesh;
use lightvein::model::choose::choose_voxel_m;
use lightvein::model::{Model, Probe, places_of_patches};
use lightvein::rays::Rays;
use lightvein::scene::{Light, Method, Scene};
use lightvein::skeleton::Skeleton;
use lightvein::study::errors::errors;
use lightvein::trace;
use lightvein::voxel::voxelise;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Share of the memory at hand that voxels and skeleton may take; the rest is for rays, fields and the picture.
const MEMORY_SHARE: f64 = 0.6;

/// The method where neither user nor file names one.
const METHOD: Method = Method::Network;

/// Samples a sensor of the path tracer: some seconds for a handful of sensors.
const SAMPLES: u32 = 256;

/// Shows results so far.
type Found<'a> = &'a mut dyn FnMut(&Results);

/// Answers a request; `found` hears of each part.
///
/// # Errors
/// A file that cannot be read, a scene that cannot be modelled; [`Failed::Cancelled`].
pub fn answer(
    request: &Request,
    cache: &mut Cache,
    progress: &dyn Progress,
    cancel: &Cancel,
    found: Found,
) -> Result<Results, Failed> {
    let loaded = loaded(&request.source, cache, progress, cancel)?;
    let mut results = Results { loaded: Some(Arc::clone(&loaded)), ..cache.shown.clone() };
    if results.scene.is_none() {
        results.scene = Some(Arc::clone(&loaded));
        found(&results);
    }

    let (shape, rays) = shaped(&loaded, &request.edits, cache, progress)?;
    if !request.wants.model {
        results = without_model(results, &edited(&shape, &request.edits, &loaded));
        found(&results);
    } else {
        let (scene, model) = modelled(&shape, rays, request, cache, progress, cancel)?;
        results.scene = Some(Arc::clone(&scene));
        results.sides = cache.modelled.as_ref().map(|modelled| Arc::clone(&modelled.sides));
        results.model = Some(Arc::clone(&model));
        results.warnings = warnings(&scene, &model);
        estimates(&mut results, &scene, &model, request, progress, cancel, found)?;
    }
    cache.shown = results.clone();

    if let Some(asked) = &request.outdoors {
        let question = Question { asked, scene: &loaded, edits: &request.edits.parts, seed: request.how.seed };
        let before = results.outdoors.clone();
        let mut each = |outdoors| {
            results.outdoors = outdoors;
            found(&results);
        };
        let outdoors = compute(&question, &before, progress, cancel, &mut each)?;
        results.outdoors = outdoors;
        cache.shown = results.clone();
    } else {
        results.outdoors = OutdoorResults::default();
    }
    if let (true, Some(scene), Some(model)) = (request.wants.all_methods, &results.scene, &results.model)
        && request.wants.model
    {
        found(&results);
        results.answers = Arc::new(all_methods(scene, model, request, progress, cancel)?);
        cache.shown = results.clone();
    }
    Ok(results)
}

/// The scene as its file has it.
fn loaded(source: &Source, cache: &mut Cache, progress: &dyn Progress, cancel: &Cancel) -> Result<Arc<Scene>, Failed> {
    cache.keep_only(source);
    if let Some(loaded) = &cache.loaded {
        return Ok(Arc::clone(&loaded.scene));
    }
    progress.begin("load", 0);
    let scene = match source {
        Source::Welcome => welcome::scene(),
        Source::File(path) => Scene::load(path, progress, cancel)?,
    };
    progress.end();
    let scene = Arc::new(scene);
    cache.loaded = Some(Loaded { source: source.clone(), scene: Arc::clone(&scene) });
    Ok(scene)
}

/// The scene with its parts changed, and its rays with the bodies of its lights.
fn shaped(
    loaded: &Arc<Scene>,
    edits: &Edits,
    cache: &mut Cache,
    progress: &dyn Progress,
) -> Result<(Arc<Scene>, Arc<Rays>), Failed> {
    let lights = edits.lights.as_ref().unwrap_or(&loaded.lights);
    let bodies: Vec<Light> = lights.iter().filter(|light| !matches!(light, Light::Point { .. })).copied().collect();
    if let Some(shaped) = &cache.shaped
        && shaped.parts == edits.parts
        && shaped.bodies == bodies
    {
        return Ok((Arc::clone(&shaped.scene), Arc::clone(&shaped.rays)));
    }
    progress.begin("rays", 0);
    let scene = match &edits.parts[..] {
        [] => Arc::clone(loaded),
        parts => Arc::new(loaded.changed(&loaded.changes(parts).map_err(anyhow::Error::from)?)),
    };
    let rays = Arc::new(Rays::new(&edited(&scene, edits, loaded)));
    progress.end();
    let shaped = Shaped { parts: edits.parts.clone(), bodies, scene: Arc::clone(&scene), rays: Arc::clone(&rays) };
    cache.shaped = Some(shaped);
    Ok((scene, rays))
}

/// The scene with the user's lights and reflectances.
fn edited(shape: &Arc<Scene>, edits: &Edits, loaded: &Arc<Scene>) -> Arc<Scene> {
    if edits.lights.is_none() && edits.reflectances.is_empty() {
        return Arc::clone(shape);
    }
    let mut scene = (**shape).clone();
    if let Some(lights) = &edits.lights {
        scene.lights.clone_from(lights);
    }
    for (&material, &reflectance) in &edits.reflectances {
        if let Some(material) = scene.materials.get_mut(material) {
            material.reflectance = reflectance;
        }
    }
    // A reference is of the scene as it was.
    if scene.lights != loaded.lights || scene.materials != loaded.materials {
        scene.reference.clear();
    }
    Arc::new(scene)
}

/// Nothing is modelled: the mesh as it is, seen from both sides.
fn without_model(results: Results, scene: &Arc<Scene>) -> Results {
    Results {
        loaded: results.loaded,
        scene: Some(Arc::clone(scene)),
        warnings: scene.warnings.clone(),
        outdoors: results.outdoors,
        ..Results::default()
    }
}

/// Voxels and skeleton; of a model that is there already, what the change leaves as it was.
fn modelled(
    shape: &Arc<Scene>,
    rays: Arc<Rays>,
    request: &Request,
    cache: &mut Cache,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<(Arc<Scene>, Arc<Model>), Failed> {
    let loaded = cache.loaded.as_ref().map_or(shape, |loaded| &loaded.scene).clone();
    let How { filter, .. } = request.how;
    // Where a bare mesh got its light belongs to it from then on.
    let mut scene = edited(
        cache.bare.as_ref().filter(|_| request.edits.parts.is_empty()).unwrap_or(shape),
        &request.edits,
        &loaded,
    );
    let asked_m = request.how.voxel_m.or(scene.model.voxel_m).or(cache.chosen_voxel_m);
    if let Some(known) = &cache.modelled
        && known.edits == request.edits
        && known.filter == filter
        && asked_m.is_none_or(|voxel_m| voxel_m == known.voxel_m)
    {
        return Ok((Arc::clone(&known.scene), Arc::clone(&known.model)));
    }

    let most_bytes = available_bytes().map_or(u64::MAX, |bytes| (bytes as f64 * MEMORY_SHARE) as u64);
    let voxel_m = match asked_m {
        Some(voxel_m) => voxel_m,
        None => {
            let chosen = choose_voxel_m(&scene, &rays, most_bytes, progress, cancel)?;
            let voxel_m = chosen.model.voxels.lattice.voxel_m;
            cache.chosen_voxel_m = Some(voxel_m);
            voxel_m
        }
    };
    let known =
        cache.modelled.as_ref().filter(|known| known.voxel_m == voxel_m && known.edits.parts == request.edits.parts);
    let sources = Sources::of(&scene);
    let lights_stay = known.is_some_and(|known| positions(&known.scene) == positions(&scene));
    progress.begin("voxels", 0);
    let voxels = match known {
        Some(known) if lights_stay => Arc::clone(&known.model.voxels),
        _ => {
            let patches = places_of_patches(&scene, &sources);
            let voxels = voxelise(&scene, &rays, &patches, voxel_m, most_bytes, progress, cancel);
            Arc::new(voxels.map_err(lightvein::model::ModelError::from)?)
        }
    };
    progress.end();
    progress.begin("skeleton", 0);
    let same_void = known.filter(|known| known.filter == filter && known.model.voxels.void == voxels.void);
    let skeleton = match same_void {
        Some(known) => Arc::clone(&known.model.skeleton),
        None => {
            let (lattice, void) = (voxels.lattice, &voxels.void);
            Arc::new(Skeleton::build_from(lattice, void, &filter, &rays, progress, cancel)?)
        }
    };
    progress.end();
    let sides = match same_void {
        Some(known) => Arc::clone(&known.sides),
        None => Arc::new(sides::of(&scene.mesh, &sides::Inside::of(&voxels, stand_m(&scene)))),
    };
    let mut model = Model::of(&scene, rays, sources, voxels, skeleton);
    if scene.bare && cache.bare.is_none() {
        let mut lit = (*scene).clone();
        model = light_bare_mesh(&mut lit, model);
        scene = Arc::new(lit);
        cache.bare = Some(Arc::clone(&scene));
    }
    let model = Arc::new(model);
    cache.modelled = Some(Modelled {
        edits: request.edits.clone(),
        voxel_m,
        filter,
        model: Arc::clone(&model),
        scene: Arc::clone(&scene),
        sides,
    });
    Ok((scene, model))
}

/// Where lights and sensors stand, metres.
pub fn stand_m(scene: &Scene) -> impl Iterator<Item = glam::Vec3> {
    let lights = scene.lights.iter().map(crate::panels::scene::middle_m);
    lights.chain(scene.sensors.iter().map(|sensor| sensor.position_m))
}

/// Where lights stand: what voxels depend on.
fn positions(scene: &Scene) -> Vec<Light> {
    let without_flux = |light: &Light| {
        let mut light = *light;
        match &mut light {
            Light::Point { flux_w, .. } | Light::Sphere { flux_w, .. } | Light::Quad { flux_w, .. } => *flux_w = 0.0,
        }
        light
    };
    scene.lights.iter().map(without_flux).collect()
}

/// What loading and modelling warn of.
fn warnings(scene: &Scene, model: &Model) -> Vec<String> {
    let missing = [
        (model.sources.emitters.is_empty(), "the scene has no light"),
        (scene.sensors.is_empty(), "the scene has no sensor"),
    ];
    let missing = missing.into_iter().filter(|(is_missing, _)| *is_missing).map(|(_, says)| says.to_owned());
    scene.warnings.iter().cloned().chain(model.voxels.warnings.iter().cloned()).chain(missing).collect()
}

/// The estimate that was asked for at nodes and sensors; by `backward` first where that is much faster.
fn estimates(
    results: &mut Results,
    scene: &Arc<Scene>,
    model: &Arc<Model>,
    request: &Request,
    progress: &dyn Progress,
    cancel: &Cancel,
    found: Found,
) -> Result<(), Failed> {
    let settings = Settings { seed: request.how.seed, samples: SAMPLES, ..Settings::default() };
    let method = request.how.method.or(scene.model.method).unwrap_or(METHOD);
    let asking = Asking { scene, model, settings, progress, cancel };
    if matches!(method, Method::Network | Method::Trace) {
        let first = asking.estimate(Method::Backward, None)?;
        let keeps_older = results.estimate.as_ref().is_some_and(|older| !older.is_first_pass)
            && results
                .estimate
                .as_ref()
                .is_some_and(|older| older.at_nodes.readings.len() == first.at_nodes.readings.len());
        // While a slider is dragged the older estimate of the same method says more than the first pass of another.
        if !keeps_older {
            results.estimate = Some(Arc::new(Estimate { is_first_pass: true, ..first }));
            results.faces = None;
            found(results);
        }
    }
    let estimate = asking.estimate(method, request.how.quality)?;
    results.warnings.extend(estimate.at_sensors.warnings.iter().cloned());
    results.estimate = Some(Arc::new(estimate));
    results.faces = None;
    if request.wants.faces {
        found(results);
        results.faces = Some(Arc::new(asking.faces(method)?));
    }
    found(results);
    Ok(())
}

/// Every estimator at its default quality.
fn all_methods(
    scene: &Arc<Scene>,
    model: &Arc<Model>,
    request: &Request,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Answer>, Failed> {
    let settings = Settings { seed: request.how.seed, ..Settings::default() };
    let asking = Asking { scene, model, settings, progress, cancel };
    let methods = Method::ALL.into_iter().filter(|&method| estimator(method).is_some());
    let answer = |method| {
        let Estimate { quality, at_nodes, at_sensors, errors, seconds, .. } = asking.estimate(method, None)?;
        let (at_nodes, at_sensors) = (at_nodes.readings, at_sensors.readings);
        Ok(Answer { method, quality, at_sensors, at_nodes, errors, seconds })
    };
    methods.map(answer).collect()
}

/// Samples a sensor of the path tracer on the chart.
const TRACED: [u32; 3] = [16, 64, 256];

/// Every method at every quality, and the path tracer with few samples, at the sensors.
///
/// # Errors
/// Results without a model; [`Failed::Cancelled`].
pub fn every_quality(
    results: &Results,
    seed: u64,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Answer>, Failed> {
    let (Some(scene), Some(model)) = (&results.scene, &results.model) else {
        return Err(Failed::Because(anyhow::anyhow!("there is no model to measure methods on yet")));
    };
    let probes = model.probes_at_sensors(scene);
    let settings = Settings { seed, ..Settings::default() };
    let mut answers = Vec::new();
    let mut keep = |method, quality, seconds, field: Field| {
        let errors = errors(&field.readings, &scene.reference);
        let (at_sensors, at_nodes) = (field.readings, Vec::new());
        answers.push(Answer { method, quality, at_sensors, at_nodes, errors, seconds });
    };
    let rungs: Vec<Rung> = Method::ALL.into_iter().flat_map(ladder).collect();
    progress.begin("qualities", (rungs.len() + TRACED.len()) as u64);
    for rung in rungs {
        let began = Instant::now();
        let field = (rung.estimate)(model, &probes, &settings, &Quiet, cancel)?;
        keep(rung.method, rung.quality, began.elapsed().as_secs_f64(), field);
        progress.advance(1);
    }
    for samples in TRACED {
        let began = Instant::now();
        let settings = Settings { samples, ..settings };
        let traced = trace::trace(scene, &model.rays, &model.sources, &settings, &Quiet, cancel)?;
        keep(Method::Trace, format!("{samples} samples"), began.elapsed().as_secs_f64(), traced.field);
        progress.advance(1);
    }
    progress.end();
    Ok(answers)
}

/// What all questions about one model share.
struct Asking<'a> {
    scene: &'a Scene,
    model: &'a Model,
    settings: Settings,
    progress: &'a dyn Progress,
    cancel: &'a Cancel,
}

impl Asking<'_> {
    /// The field at nodes and sensors by a method, at a rung of its ladder or its default quality. The seconds are those of
    /// both together where one network serves both.
    fn estimate(&self, method: Method, rung: Option<usize>) -> Result<Estimate, Failed> {
        let Self { scene, model, progress, cancel, settings } = *self;
        let (at_sensors, at_nodes) = (model.probes_at_sensors(scene), model.probes_at_nodes());
        progress.begin(method.name(), 0);
        let began = Instant::now();
        let quality = network_quality(method, rung);
        let rung = rung.and_then(|rung| ladder(method).into_iter().nth(rung));
        let label = rung.as_ref().map_or_else(String::new, |rung| rung.quality.clone());
        let [at_sensors, at_nodes] = match (quality, method) {
            (Some(quality), _) => {
                network::gathered_and_read(&quality, model, [&at_sensors, &at_nodes], &settings, progress, cancel)?
            }
            (None, Method::Trace) => {
                let traced = trace::trace(scene, &model.rays, &model.sources, &settings, progress, cancel)?;
                [traced.field, Field::default()]
            }
            (None, _) => [self.by(method, rung.as_ref(), &at_sensors)?, self.by(method, rung.as_ref(), &at_nodes)?],
        };
        let seconds = began.elapsed().as_secs_f64();
        progress.end();
        Ok(Estimate {
            method,
            quality: label,
            through_edges_w: through_edges_w(&model.skeleton, &at_nodes),
            errors: errors(&at_sensors.readings, &scene.reference),
            at_nodes,
            at_sensors,
            seconds,
            is_first_pass: false,
        })
    }

    /// The field on the faces of the mesh; read off the zones of a network, for faces are many.
    fn faces(&self, method: Method) -> Result<Faces, Failed> {
        let faces_m = self.model.faces_to_void(self.scene);
        let probes = self.model.probes_at_faces(&faces_m);
        self.progress.begin("faces", 0);
        let field = match method {
            Method::Network | Method::Trace => {
                let read = network::with(Quality::MEDIUM.read());
                read(self.model, &probes, &self.settings, self.progress, self.cancel)?
            }
            _ => self.by(method, None, &probes)?,
        };
        self.progress.end();
        Ok(Faces { faces_m, field })
    }

    fn by(&self, method: Method, rung: Option<&Rung>, probes: &[Probe]) -> Result<Field, Failed> {
        let Self { model, progress, cancel, settings, .. } = *self;
        match (rung, estimator(method)) {
            (Some(rung), _) => Ok((rung.estimate)(model, probes, &settings, progress, cancel)?),
            (None, Some(estimate)) => Ok(estimate(model, probes, &settings, progress, cancel)?),
            (None, None) => Ok(Field::default()),
        }
    }
}

/// The quality of a network on that rung; `None` for other methods.
fn network_quality(method: Method, rung: Option<usize>) -> Option<Quality> {
    let of_rung = rung.and_then(|rung| network::LADDER.get(rung)).map(|(_, quality)| *quality);
    (method == Method::Network).then(|| of_rung.unwrap_or(Quality::MEDIUM))
}

/// Writes the files that `analyse -o` writes; gives their number.
///
/// # Errors
/// Results without an estimate, a folder or file that cannot be written.
pub fn export(folder: &Path, results: &Results, progress: &dyn Progress, cancel: &Cancel) -> Result<usize, Failed> {
    let (Some(scene), Some(model), Some(estimate)) = (&results.scene, &results.model, &results.estimate) else {
        return Err(Failed::Because(anyhow::anyhow!("there is no estimate to export yet")));
    };
    let settings = Settings::default();
    let asking = Asking { scene, model, settings, progress, cancel };
    let faces = match &results.faces {
        Some(faces) => Arc::clone(faces),
        None => Arc::new(asking.faces(estimate.method)?),
    };
    let at_nodes = (!estimate.at_nodes.readings.is_empty()).then_some(&estimate.at_nodes);
    let at_faces = Some((&faces.faces_m[..], &faces.field));
    let analysed = Analysed { scene, model, at_sensors: &estimate.at_sensors, at_nodes, at_faces };

    progress.begin("files", 0);
    std::fs::create_dir_all(folder).with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    let files = files(&analysed);
    for (name, write) in &files {
        cancel.check()?;
        let path = folder.join(name);
        whole_file(&path, |out| write(out)).with_context(|| format!("{}: cannot be written", path.display()))?;
    }
    progress.end();
    Ok(files.len())
}
