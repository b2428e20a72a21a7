//! Where does the light of each emitter land, and how much of it leaves?
//!
//! Rays leave each emitter in an even sequence and carry equal parts of its flux. What a wall sends back after `bounces`
//! reflections is left there as a source; until then it goes on from where it landed, in a random direction by the cosine,
//! and the place where it set out is kept as a small lamp ([`Lamp`]), from which sensors take the light on its way . Glazing passes its part straight on. Nothing is drawn or dropped by chance, so what lands, is
//! absorbed and escapes adds up to what was emitted.

use super::lamps::Lamp;
use super::surroundings::node_before;
use crate::flow::sequence;
use crate::job::{Cancel, Cancelled};
use crate::model::Model;
use glam::Vec3;
use rayon::prelude::*;

/// Rays of all emitters together where they only have to find what the light falls on: half a millisecond.
const RAYS: usize = 2048;

/// Rays of all emitters together for each bounce that they carry: a bounce thins them out.
const RAYS_A_BOUNCE: usize = 8192;

/// Rays that each emitter has at least.
const LEAST_RAYS: usize = 64;

/// Rays of all emitters together that leave lamps for the sensors, the first of each emitter.
const LAMP_RAYS: usize = 8192;

/// Surfaces of glazing and walls together that a ray may meet; what is left then stays where it is.
const MOST_SURFACES: u32 = 64;

/// Rays in one piece of work.
const RAYS_A_PIECE: usize = 128;

/// Inverse powers of the root of x^5 = x + 1: the even sequence in four dimensions (M. Roberts 2018).
const R4: [f64; 4] = [0.856_674_883_854_502_7, 0.733_891_856_627_126, 0.628_706_721_037_809_1, 0.538_597_257_220_701_7];

/// What became of the light of one emitter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Landed {
    /// What is left to diffuse: the node and the flux that a wall there sends back, W, in the order of the rays.
    pub sources: Vec<(u32, f64)>,
    /// Where light that rays carried set out from.
    pub lamps: Vec<Lamp>,
    /// What walls and lights took of the light that rays carried, W.
    pub absorbed_w: f64,
    /// What left the scene on rays, W.
    pub escaped_w: f64,
}

/// Light on its way.
#[derive(Debug, Clone, Copy)]
struct Ray {
    origin_m: Vec3,
    direction: Vec3,
    flux_w: f64,
    bounces: u32,
    surfaces: u32,
    /// The last node it came by.
    node: u32,
}

/// Sends out the light of every emitter that stands in a void, in their order, `bounces` of its reflections carried by rays.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn landed(model: &Model, bounces: u32, seed: u64, cancel: &Cancel) -> Result<Vec<Landed>, Cancelled> {
    let emitters = model.shining.len().max(1);
    let count = (RAYS.max(RAYS_A_BOUNCE * bounces as usize) / emitters).max(LEAST_RAYS);
    let with_lamps = (LAMP_RAYS / emitters).clamp(LEAST_RAYS, count);
    let pieces = count.div_ceil(RAYS_A_PIECE);

    let piece = |number: usize| {
        cancel.check()?;
        let shines = &model.shining[number / pieces];
        let mut landed = Landed::default();
        if let Ok(place) = shines.place {
            let first = number % pieces * RAYS_A_PIECE;
            for index in first..count.min(first + RAYS_A_PIECE) {
                let lamps = if index < with_lamps { count as f64 / with_lamps as f64 } else { 0.0 };
                let walk = Walk { model, bounces, seed: sequence_seed(seed, shines.emitter, index), lamps, with_lamps };
                let (flux_w, node) = (shines.flux_w / count as f64, place.index() as u32);
                if let Some((origin_m, direction)) = emitted(model, shines.emitter, index, seed) {
                    walk.follow(Ray { origin_m, direction, flux_w, bounces: 0, surfaces: 0, node }, &mut landed);
                }
            }
        }
        Ok(landed)
    };
    let parts: Vec<Landed> =
        (0..pieces * model.shining.len()).into_par_iter().map(piece).collect::<Result<_, Cancelled>>()?;
    Ok(parts.chunks(pieces).map(joined).collect())
}

/// The seed of the random walk of one ray.
fn sequence_seed(seed: u64, emitter: usize, index: usize) -> u64 {
    sequence::offset(seed, (emitter as u64) << 32 | index as u64)[0].to_bits()
}

/// Where ray number `index` of an emitter starts, and where it goes.
fn emitted(model: &Model, emitter: usize, index: usize, seed: u64) -> Option<(Vec3, Vec3)> {
    let [a, b] = [0, 1].map(|half| sequence::offset(seed, !(2 * emitter as u64 + half)));
    let offset = [a[0], a[1], b[0], b[1]];
    let random = [0, 1, 2, 3].map(|axis| (offset[axis] + R4[axis] * (index as f64 + 0.5)).fract());
    let leaves = model.sampler.emit(emitter, random)?;
    Some((leaves.origin_m, leaves.direction))
}

/// How one ray goes on.
struct Walk<'a> {
    model: &'a Model,
    bounces: u32,
    seed: u64,
    /// How many rays this one stands for where it leaves lamps; 0 where it leaves none.
    lamps: f64,
    with_lamps: usize,
}

impl Walk<'_> {
    /// Follows a ray and what it becomes to the end.
    fn follow(&self, ray: Ray, landed: &mut Landed) {
        let mut open = vec![ray];
        let mut draws = 0;
        let nodes = self.model.skeleton.graph.raw_nodes();
        while let Some(ray) = open.pop() {
            let Some(hit) = self.model.rays.closest(ray.origin_m, ray.direction, f32::INFINITY) else {
                landed.escaped_w += ray.flux_w;
                continue;
            };
            let answer = self.model.walls.answer(hit.surface);
            let [reflected_w, passed_w] = [answer.reflects, answer.passes].map(|share| f64::from(share) * ray.flux_w);
            landed.absorbed_w += ray.flux_w - reflected_w - passed_w;

            let lift_m = 2.0 * self.model.rays.epsilon_m();
            let (at_m, facing) = (ray.origin_m + hit.distance_m * ray.direction, hit.facing());
            let surfaces = ray.surfaces + 1;
            if passed_w > 0.0 {
                if surfaces < MOST_SURFACES {
                    let origin_m = at_m + lift_m * ray.direction - lift_m * facing;
                    open.push(Ray { origin_m, flux_w: passed_w, surfaces, ..ray });
                } else {
                    landed.absorbed_w += passed_w;
                }
            }
            if reflected_w <= 0.0 {
                continue;
            }
            let origin_m = at_m + lift_m * facing;
            // In a corner there may be no void before the wall: then the light stays where it came from.
            let before = node_before(self.model, at_m, facing, -ray.direction, hit.distance_m);
            let node = before.unwrap_or(ray.node);
            if ray.bounces < self.bounces && surfaces < MOST_SURFACES {
                if self.lamps > 0.0 {
                    let distance_m = f64::from(hit.distance_m);
                    let slant = f64::from(facing.dot(-ray.direction)).max(0.1);
                    landed.lamps.push(Lamp {
                        position_m: origin_m,
                        normal: facing,
                        flux_w: reflected_w * self.lamps,
                        radius_squared_m2: 4.0 * distance_m * distance_m / (slant * self.with_lamps as f64),
                        cell: nodes.get(node as usize).map_or(u32::MAX, |node| node.weight.cell),
                    });
                }
                let direction = sequence::cosine_about(facing, sequence::offset(self.seed, draws));
                draws += 1;
                open.push(Ray { origin_m, direction, flux_w: reflected_w, bounces: ray.bounces + 1, surfaces, node });
            } else {
                landed.sources.push((node, reflected_w));
            }
        }
    }
}

/// The parts of one emitter's light, in their order.
fn joined(parts: &[Landed]) -> Landed {
    let mut all = Landed::default();
    for part in parts {
        all.sources.extend(&part.sources);
        all.lamps.extend(&part.lamps);
        all.absorbed_w += part.absorbed_w;
        all.escaped_w += part.escaped_w;
    }
    all
}
