//! What would the poster's heuristics, or diffusion, bring into rooms, with the openings as lights?
//!
//! Every neck between a cell in the open and one that is not becomes a lamp: a square of the neck's area that shines inwards, by
//! the cosine, with the flux of sun and sky that passes the neck, found by rays from it. The estimator carries that light
//! through the rooms as it carries a lamp's. What comes straight from the sky is known better by rays, so of the estimate
//! what comes straight from these lamps is left out: `backward` and `forward` count for openings that the point does not see,
//! `diffusion` counts less what shadow rays say of the lamps.
//!
//! Limits: a preview, like the methods. Points in the open get nothing reflected. What the street sends into a window is
//! not in its flux. Light keeps no direction on its way through a neck: no sun patch falls on a floor, no blind shades. Glazing
//! where the voxels have no neck is no opening.

use super::openings::{is_open, open_cells};
use super::skylight::{Asked, Asking, COLUMNS, Skylight};
use super::{Reflected, straight};
use crate::daylight::Point;
use crate::daylight::cast::Casting;
use crate::flow::direct::direct;
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

/// Shadow rays to an opening where what comes straight from it is left out.
const STRAIGHT_RAYS: u32 = 64;

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
        // From a voxel inside, so that glazing in the neck lies before the rays.
        let inside_m = inwards * model.voxels.lattice.voxel_m;
        let [place, beside] = [0, 1].map(|part| sequence::offset(seed, OFFSETS + 2 * number as u64 + part));
        let mut flux_kwh = [0.0; COLUMNS];
        for point in 0..POINTS {
            let from_m = portal.point_m(point, POINTS, place) + inside_m;
            let offset = sequence::square(point, beside);
            let asked = Asked { from_m, normal: Some(-inwards), necks: &[], offset };
            let brought = light.at_point(&model.rays, &asked, AT_POINT);
            flux_kwh.iter_mut().zip(brought).for_each(|(sum, part)| *sum += part * portal.area_m2 / f64::from(POINTS));
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

/// What an estimator on the skeleton brings to each point, the openings being its lights; the scene's own lights are put out.
///
/// # Errors
/// [`Cancelled`].
pub fn by_heuristic(
    method: Method,
    mut model: Model,
    points: &[Point],
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

    let mut found: Vec<Reflected> =
        points.par_iter().enumerate().map(|(number, point)| straight(&model.rays, light, point, &[], casting, number)).collect();
    let probes: Vec<Probe> = points.par_iter().map(|point| model.probe(point.position_m, point.normal)).collect();
    let cell = |probe: &Probe| probe.place.ok().and_then(|node| model.skeleton.graph.node_weight(node)).map(|node| node.cell);
    let in_rooms: Vec<bool> =
        probes.iter().map(|probe| cell(probe).is_some_and(|cell| !is_open(&open, cell))).collect();

    // The estimators are linear: each source of light by itself, and for those that see an opening or not each opening.
    let all: Vec<&Opening> = openings.iter().collect();
    let groups: Vec<Vec<&Opening>> =
        if method == Method::Diffusion { vec![all] } else { openings.iter().map(|opening| vec![opening]).collect() };
    let settings = Settings { seed: casting.seed, ..Settings::default() };
    let Some(estimate) = estimator(method) else { return Ok(found) };
    for group in groups {
        for column in 0..COLUMNS {
            cancel.check()?;
            light_with(&mut model, &group, column);
            let field = estimate(&model, &probes, &settings, progress, cancel)?;
            let carried: Vec<f64> = (probes.par_iter().zip(&field.readings).enumerate())
                .map(|(number, (probe, reading))| {
                    let offset = sequence::offset(casting.seed, OFFSETS ^ number as u64);
                    (reading.value_w_m2 - straight_w_m2(method, &model, probe, reading.value_w_m2, offset)).max(0.0)
                })
                .collect();
            for ((found, carried_kwh_m2), in_room) in found.iter_mut().zip(carried).zip(&in_rooms) {
                match column {
                    _ if !in_room => {}
                    0 => found.of_beam_kwh_m2 += carried_kwh_m2,
                    1 => found.of_sky_kwh_m2 += carried_kwh_m2,
                    _ => found.daylight_factor += carried_kwh_m2 / light.overcast_kwh_m2,
                }
            }
        }
    }
    Ok(found)
}

/// What of an estimate comes straight from its lights: all of it, where the heuristics see one.
fn straight_w_m2(method: Method, model: &Model, probe: &Probe, value_w_m2: f64, offset: [f64; 2]) -> f64 {
    if method == Method::Diffusion {
        let at_m = probe.position_m + probe.normal.unwrap_or(Vec3::ZERO) * 2.0 * model.rays.epsilon_m();
        let of = |shining: &Shining| {
            direct(model, at_m, probe.normal, shining.emitter, STRAIGHT_RAYS, offset).value_w_m2
        };
        return model.shining.iter().map(of).sum();
    }
    let is_seen = model.shining.iter().any(|shining| model.straight_share(probe.position_m, shining) > 0.0);
    if is_seen { value_w_m2 } else { 0.0 }
}

/// Puts openings in the place of the lights of a model, with the flux of one column. They have no body.
fn light_with(model: &mut Model, openings: &[&Opening], column: usize) {
    let emitter = |(number, opening): (usize, &&Opening)| {
        let [corner_m, u_m, v_m] = opening.quad;
        let flux_w = opening.flux_kwh[column];
        // A number that no body of the scene has.
        Emitter { shape: Shape::Light(usize::MAX - number, Light::Quad { corner_m, u_m, v_m, flux_w }), flux_w }
    };
    model.sources = Sources { emitters: openings.iter().enumerate().map(emitter).collect() };
    model.sampler = Sampler::new(&Scene::default(), &model.sources, model.rays.epsilon_m());
    let shining = |(emitter, opening): (usize, &&Opening)| {
        let place = model.place(opening.position_m, Some(opening.inwards));
        let to_node_m = place.map_or(0.0, |node| f64::from(model.node_m(node).distance(opening.position_m)));
        Shining { emitter, position_m: opening.position_m, flux_w: opening.flux_kwh[column], place, to_node_m }
    };
    let shining: Vec<Shining> = openings.iter().enumerate().map(shining).collect();
    model.shining = shining;
}
