//! What would the poster's heuristics, or diffusion, bring into rooms, with the openings as lights?
//!
//! Every neck between a cell in the open and one that is not becomes a lamp: a square of the neck's area that shines inwards, by
//! the cosine, with the flux of sun and sky that passes the neck, straight and off the first surface outside, found by rays from
//! it. The estimator carries that light through the rooms as it carries a lamp's. What it says at a point stands for all that
//! comes through the openings; what of that is beam and sky is known by rays, and the rest counts as reflected.
//!
//! Limits: a preview, like the methods. Points in the open get nothing reflected. Light keeps no direction on its way through a
//! neck: no sun patch falls on a floor, no shelf shades. Glazing where the voxels have no neck is no opening.

use super::openings::{is_open, open_cells};
use super::skylight::{Asked, Asking, COLUMNS, Skylight};
use super::{Reflected, by_nothing};
use crate::daylight::cast::Casting;
use crate::daylight::{Exposure, Point};
use crate::flow::estimator;
use crate::flow::network::portals::Portal;
use crate::flow::sequence;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Emitter, Sampler, Settings, Shape, Sources};
use crate::model::{Model, Probe, Shining};
use crate::scene::{Light, Method, Scene};
use glam::Vec3;
use rayon::prelude::*;

/// Points of an opening at which the light that passes is found.
const POINTS: u32 = 256;

/// What each of them asks.
const AT_POINT: Asking = Asking { suns: 16, sky_rays: 16, neck_rays: 0 };

/// What the surfaces ask that are seen from there, and how many of them.
const AT_SURFACE: Asking = Asking { suns: 4, sky_rays: 4, neck_rays: 0 };
const SURFACES: u32 = 4;

/// Panes that are looked through.
const MOST_PANES: u32 = 4;

/// Offsets of the sequences start here.
const OFFSETS: u64 = 1 << 51;

/// An opening between the open and a room.
#[derive(Debug, Clone, PartialEq)]
pub struct Opening {
    /// The light that stands for it; its flux is not set.
    pub quad: [Vec3; 3],
    /// The middle, metres.
    pub position_m: Vec3,
    /// Unit normal into the room.
    pub inwards: Vec3,
    /// What passes into the room: beam, sky, overcast sky, kWh.
    pub flux_kwh: [f64; COLUMNS],
}

/// The openings of a model: necks between the open and what is not in it, with what passes.
pub fn openings(model: &Model, light: &Skylight, seed: u64) -> Vec<Opening> {
    let open = open_cells(model);
    let into_rooms = |portal: &Portal| {
        let [a, b] = portal.cells.map(|cell| is_open(&open, cell));
        (a != b).then_some(if a { portal.normal } else { -portal.normal })
    };
    let portals: Vec<Portal> = model.skeleton.necks.iter().filter_map(Portal::new).collect();
    let opening = |(number, portal): (usize, &Portal)| {
        let inwards = into_rooms(portal)?;
        // Glazing may lie on either side of the neck's plane: what is within a voxel of it is asked for apart.
        let aside_m = inwards * model.voxels.lattice.voxel_m;
        let [place, beside] = [0, 1].map(|part| sequence::offset(seed, OFFSETS + 2 * number as u64 + part));
        let mut flux_kwh = [0.0; COLUMNS];
        for point in 0..POINTS {
            let at_m = portal.point_m(point, POINTS, place);
            let passes = f64::from(model.rays.transmitted_past(at_m + aside_m, at_m - aside_m, |_| false));
            if passes <= 0.0 {
                continue;
            }
            let from_m = at_m - aside_m;
            let offset = sequence::square(point, beside);
            let asked = Asked { from_m, normal: Some(-inwards), necks: &[], offset };
            let straight = light.at_point(&model.rays, &asked, AT_POINT);
            let sent = sent_back(model, light, &asked, -inwards);
            let each_m2 = passes * portal.area_m2 / f64::from(POINTS);
            for (column, flux_kwh) in flux_kwh.iter_mut().enumerate() {
                *flux_kwh += each_m2 * (straight[column] + sent[column]);
            }
        }
        let (u, v) = inwards.any_orthonormal_pair();
        // A quad shines along u x v.
        let (u, v) = if u.cross(v).dot(inwards) > 0.0 { (u, v) } else { (v, u) };
        let edge_m = portal.area_m2.sqrt() as f32;
        let position_m = portal.centre_m;
        let quad = [position_m - 0.5 * edge_m * (u + v), edge_m * u, edge_m * v];
        Some(Opening { quad, position_m, inwards, flux_kwh })
    };
    portals.par_iter().enumerate().filter_map(opening).collect()
}

/// What surfaces outside send to a point after one reflection, kWh/m2.
fn sent_back(model: &Model, light: &Skylight, asked: &Asked, outwards: Vec3) -> [f64; COLUMNS] {
    let mut sums = [0.0; COLUMNS];
    for ray in 0..SURFACES {
        let direction = sequence::cosine_about(outwards, sequence::square(ray, asked.offset));
        let Some((from_m, normal, share)) = wall(model, asked.from_m, direction) else { continue };
        let offset = sequence::square(ray, [asked.offset[1], asked.offset[0]]);
        let at_wall = Asked { from_m, normal: Some(normal), necks: &[], offset };
        let lands = light.at_point(&model.rays, &at_wall, AT_SURFACE);
        sums.iter_mut().zip(lands).for_each(|(sum, lands)| *sum += share * lands / f64::from(SURFACES));
    }
    sums
}

/// Where a ray meets a wall, clear of it, the wall's normal there, and the share that it sends back through the glazing before.
fn wall(model: &Model, mut from_m: Vec3, direction: Vec3) -> Option<(Vec3, Vec3, f64)> {
    let mut share = 1.0;
    for _ in 0..MOST_PANES {
        let hit = model.rays.closest(from_m, direction, f32::INFINITY)?;
        let (answer, lift_m) = (model.walls.answer(hit.surface), hit.facing() * model.rays.epsilon_m());
        let at_m = from_m + hit.distance_m * direction;
        if answer.passes <= 0.0 {
            return Some((at_m + lift_m, hit.facing(), share * f64::from(answer.reflects)));
        }
        share *= f64::from(answer.passes);
        from_m = at_m - lift_m;
    }
    None
}

/// What an estimator on the skeleton brings to each point, the openings being its lights; the scene's own lights are put out.
/// `exposures` are what rays know of the points' beam and sky.
///
/// # Errors
/// [`Cancelled`].
pub fn by_heuristic(
    method: Method,
    mut model: Model,
    (points, exposures): (&[Point], &[Exposure]),
    light: &Skylight,
    casting: Casting,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Reflected>, Cancelled> {
    progress.begin("openings", 0);
    let open = open_cells(&model);
    let openings = openings(&model, light, casting.seed);
    progress.end();
    cancel.check()?;

    let mut found = by_nothing(&model.rays, points, light, casting, cancel)?;
    let probes: Vec<Probe> = points.par_iter().map(|point| model.probe(point.position_m, point.normal)).collect();
    let settings = Settings { seed: casting.seed, ..Settings::default() };
    let Some(estimate) = estimator(method) else { return Ok(found) };
    for column in 0..COLUMNS {
        light_with(&mut model, &openings, column);
        let field = estimate(&model, &probes, &settings, progress, cancel)?;
        for (((found, exposure), probe), reading) in found.iter_mut().zip(exposures).zip(&probes).zip(&field.readings) {
            let cell = probe.place.ok().and_then(|node| model.skeleton.graph.node_weight(node)).map(|node| node.cell);
            if cell.is_none_or(|cell| is_open(&open, cell)) {
                continue;
            }
            let comes = reading.value_w_m2;
            match column {
                0 => found.of_beam_kwh_m2 = (comes - exposure.beam_kwh_m2).max(0.0),
                1 => found.of_sky_kwh_m2 = (comes - exposure.sky_kwh_m2).max(0.0),
                _ => found.daylight_factor = found.daylight_factor.max(comes / light.overcast_kwh_m2),
            }
        }
    }
    Ok(found)
}

/// Puts openings in the place of the lights of a model, with the flux of one column. They have no body.
fn light_with(model: &mut Model, openings: &[Opening], column: usize) {
    let emitter = |(number, opening): (usize, &Opening)| {
        let [corner_m, u_m, v_m] = opening.quad;
        let flux_w = opening.flux_kwh[column];
        // A number that no body of the scene has.
        Emitter { shape: Shape::Light(usize::MAX - number, Light::Quad { corner_m, u_m, v_m, flux_w }), flux_w }
    };
    model.sources = Sources { emitters: openings.iter().enumerate().map(emitter).collect() };
    model.sampler = Sampler::new(&Scene::default(), &model.sources, model.rays.epsilon_m());
    let shining = |(emitter, opening): (usize, &Opening)| {
        let place = model.place(opening.position_m, Some(opening.inwards));
        let to_node_m = place.map_or(0.0, |node| f64::from(model.node_m(node).distance(opening.position_m)));
        Shining { emitter, position_m: opening.position_m, flux_w: opening.flux_kwh[column], place, to_node_m }
    };
    let shining: Vec<Shining> = openings.iter().enumerate().map(shining).collect();
    model.shining = shining;
}
