//! A request's answer as a list of steps, each shown as soon as it is there.

use super::asking::{Asking, Found, all_methods, estimates};
use super::cache::{Cache, Loaded, Modelled, Shaped};
use super::watch::available_bytes;
use crate::outdoors::OutdoorResults;
use crate::outdoors::compute::{Question, compute};
use crate::request::{Edits, How, Request, Source};
use crate::results::{Failed, Results};
use crate::{sides, welcome};
use anyhow::Context;
use lightvein::export::analysed::{Analysed, files};
use lightvein::export::whole_file;
use lightvein::job::{Cancel, Progress};
use lightvein::light::{Settings, Sources};
use lightvein::model::bare::light_bare_mesh;
use lightvein::model::choose::choose_voxel_m;
use lightvein::model::{Model, places_of_patches};
use lightvein::rays::Rays;
use lightvein::scene::{Light, Scene};
use lightvein::skeleton::Skeleton;
use lightvein::voxel::voxelise;
use std::path::Path;
use std::sync::Arc;

/// Share of the memory at hand that voxels and skeleton may take; the rest is for rays, fields and the picture.
const MEMORY_SHARE: f64 = 0.6;

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
    // Voxels hold where lights stand and what each reflects of the mesh; flux alone leaves them.
    let stays =
        |known: &&Modelled| positions(&known.scene) == positions(&scene) && known.scene.materials == scene.materials;
    progress.begin("voxels", 0);
    let voxels = match known.filter(stays) {
        Some(known) => Arc::clone(&known.model.voxels),
        None => {
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
