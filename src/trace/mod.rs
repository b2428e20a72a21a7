//! How much light is there truly? An unidirectional path tracer, plain, slow and trusted.
//!
//! Method: paths from the sensor with next-event estimation at every vertex (Kajiya 1986; Shirley, Wang & Zimmerman
//! 1996), Lambertian surfaces reflecting on both sides, thin glazing, Russian roulette after four surfaces, any number of
//! reflections. Every sample is independent, so the standard error comes from their variance.
//!
//! Limits: no light passes that needs a hit on a lamp by chance (there are no mirrors, so nothing is lost). Where a few
//! rare paths carry the light, the standard error is itself a rare event: [`Traced::top_share`] shows it, and such
//! sensors are named in the warnings. A wall very near a point light gives rare, very bright samples.

pub mod guided;
pub mod learned;
mod path;
mod random;

use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Field, Reading, Sampler, Settings, Shape, Sources, Status};
use crate::rays::Rays;
use crate::scene::{Light, Scene, Sensor};
use glam::DVec3;
use path::{Paths, Sample};
use random::Random;
use rayon::prelude::*;

/// Samples that one thread takes in a row, with a random stream of their own. Small enough that two threads share a single
/// sensor's work and that a run can be stopped within milliseconds.
const BLOCK: u32 = 128;

/// Blocks whose results are held at a time: 4 MB.
const BLOCKS_HELD: u64 = 65_536;

/// A largest sample above this share of the sum makes the standard error worthless.
const LARGEST_TRUSTED_SHARE: f64 = 0.05;

/// Sensors that a warning names.
const MOST_NAMED: usize = 5;

/// Path-traced readings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Traced {
    /// The readings; [`Reading::error_w_m2`] is the standard error (`None` for a single sample).
    pub field: Field,
    /// For each sensor its largest sample over the sum of all; above 0.05 its standard error is not to be trusted.
    pub top_share: Vec<f64>,
}

/// Traces [`Settings::samples`] paths (at least 1) from each sensor.
///
/// `rays` and `sources` are those of `scene`. Runs on the current rayon pool; any number of threads gives the same bits.
/// The stage is "trace", its unit 128 samples. A sensor inside a sphere light is [`Status::InSolid`]; one that no sample
/// found light for is [`Status::Dark`]; a warning says that this is no proof.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised; it is looked at every 128 samples.
///
/// ```
/// use glam::Vec3;
/// use lightvein::job::{Cancel, Cancelled, Quiet};
/// use lightvein::light::{Settings, Sources};
/// use lightvein::rays::Rays;
/// use lightvein::scene::{Light, Scene, Sensor};
/// use lightvein::trace::trace;
///
/// // 100 W in empty space, 2 m above a sensor that looks up.
/// let light = Light::Point { position_m: Vec3::Z * 2.0, flux_w: 100.0 };
/// let sensor = Sensor { id: "a".to_owned(), position_m: Vec3::ZERO, normal: Some(Vec3::Z) };
/// let scene = Scene { lights: vec![light], sensors: vec![sensor], ..Scene::default() };
/// let settings = Settings { samples: 16, ..Settings::default() };
/// let traced = trace(&scene, &Rays::new(&scene), &Sources::of(&scene), &settings, &Quiet, &Cancel::new())?;
/// let inverse_square = 100.0 / (4.0 * std::f64::consts::PI * 4.0);
/// assert!((traced.field.readings[0].value_w_m2 / inverse_square - 1.0).abs() < 1e-4);
/// # Ok::<(), Cancelled>(())
/// ```
pub fn trace(
    scene: &Scene,
    rays: &Rays,
    sources: &Sources,
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Traced, Cancelled> {
    let sampler = Sampler::new(scene, sources, rays.epsilon_m());
    let paths = Paths { scene, rays, sampler: &sampler, max_bounces: settings.max_bounces.unwrap_or(u32::MAX) };
    let sample = |sensor: usize, random: &mut Random| paths.sample(&scene.sensors[sensor], random);
    let sums = sampled("trace", scene, &sample, settings, progress, cancel)?;
    Ok(traced(scene, sources, &sums))
}

/// How one sample is taken at the sensor of that number.
type TakeSample<'a> = dyn Fn(usize, &mut Random) -> Sample + Sync + 'a;

/// The sums of samples that are taken one by one, for each sensor.
fn sampled(
    stage: &str,
    scene: &Scene,
    take: &TakeSample,
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Vec<Sums>, Cancelled> {
    let samples = settings.samples.max(1);
    let blocks = u64::from(samples.div_ceil(BLOCK));
    let total = blocks * scene.sensors.len() as u64;

    // Blocks run in any order on any thread, and are added up in their own.
    let mut sums = vec![Sums::default(); scene.sensors.len()];
    progress.begin(stage, total);
    let mut first = 0;
    while first < total {
        let last = total.min(first + BLOCKS_HELD);
        let part: Result<Vec<Sums>, Cancelled> = (0..(last - first) as usize)
            .into_par_iter()
            .map(|offset| {
                cancel.check()?;
                let (sensor, block) = ((first + offset as u64) / blocks, (first + offset as u64) % blocks);
                let count = BLOCK.min(samples - block as u32 * BLOCK);
                let random = Random::new(settings.seed, sensor, block);
                let sums = Sums::of(take, sensor as usize, count, random);
                progress.advance(1);
                Ok(sums)
            })
            .collect();
        for (offset, block) in part?.iter().enumerate() {
            sums[((first + offset as u64) / blocks) as usize].add(block);
        }
        first = last;
    }
    progress.end();
    Ok(sums)
}

/// The readings that sums stand for.
fn traced(scene: &Scene, sources: &Sources, sums: &[Sums]) -> Traced {
    let standings: Vec<Standing> = scene.sensors.iter().map(|sensor| Standing::of(sensor, sources)).collect();
    let readings = sums.iter().zip(&standings).map(|(sums, standing)| sums.reading(*standing)).collect();
    let top_share: Vec<f64> = sums.iter().map(Sums::top_share).collect();
    let warnings = warnings(scene, &standings, &top_share);
    Traced { field: Field { readings, warnings, shares: None }, top_share }
}

/// What is known of a number of samples.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    samples: f64,
    value: f64,
    squares: f64,
    largest: f64,
    flux: DVec3,
    /// Rays that the samples took.
    rays: f64,
}

impl Sums {
    fn of(take: &TakeSample, sensor: usize, count: u32, mut random: Random) -> Self {
        let mut sums = Self::default();
        for _ in 0..count {
            sums.add_sample(&take(sensor, &mut random));
        }
        sums
    }

    fn add_sample(&mut self, sample: &Sample) {
        self.add(&Self {
            samples: 1.0,
            value: sample.value_w_m2,
            squares: sample.value_w_m2 * sample.value_w_m2,
            largest: sample.value_w_m2,
            flux: sample.flux_w_m2,
            rays: f64::from(sample.rays),
        });
    }

    fn add(&mut self, other: &Self) {
        self.samples += other.samples;
        self.value += other.value;
        self.squares += other.squares;
        self.largest = self.largest.max(other.largest);
        self.flux += other.flux;
        self.rays += other.rays;
    }

    fn reading(&self, standing: Standing) -> Reading {
        if standing == Standing::InLight {
            return Reading::none(Status::InSolid);
        }
        let mean = self.value / self.samples;
        let variance = (self.squares / self.samples - mean * mean).max(0.0);
        let error = (self.samples > 1.0).then(|| (variance / (self.samples - 1.0)).sqrt());
        let status = if self.value > 0.0 { Status::Ok } else { Status::Dark };
        Reading { value_w_m2: mean, flux_w_m2: self.flux / self.samples, error_w_m2: error, status }
    }

    fn top_share(&self) -> f64 {
        if self.value > 0.0 { self.largest / self.value } else { 0.0 }
    }
}

/// How a sensor stands to the lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Standing {
    Free,
    /// Inside the body of a sphere light.
    InLight,
    /// Exactly on a point light, whose direct light is infinite there.
    OnPoint,
}

impl Standing {
    fn of(sensor: &Sensor, sources: &Sources) -> Self {
        let at_m = sensor.position_m;
        let stands = sources.emitters.iter().map(|emitter| match emitter.shape {
            Shape::Light(_, Light::Sphere { centre_m, radius_m, .. }) if at_m.distance(centre_m) < radius_m => {
                Self::InLight
            }
            Shape::Light(_, Light::Point { position_m, .. }) if at_m == position_m => Self::OnPoint,
            _ => Self::Free,
        });
        stands.fold(Self::Free, |worst, standing| if worst == Self::Free { standing } else { worst })
    }
}

/// A sentence for each kind of trouble, with the sensors that are in it.
fn warnings(scene: &Scene, standings: &[Standing], top_share: &[f64]) -> Vec<String> {
    let named = |held: &dyn Fn(usize) -> bool, says: &str| {
        let ids: Vec<&str> =
            scene.sensors.iter().enumerate().filter(|(at, _)| held(*at)).map(|(_, it)| &*it.id).collect();
        let shown = ids[..ids.len().min(MOST_NAMED)].join(", ");
        let more = if ids.len() > MOST_NAMED { format!(" and {} more", ids.len() - MOST_NAMED) } else { String::new() };
        (!ids.is_empty()).then(|| format!("{says}: sensors {shown}{more}"))
    };
    let kinds = [
        named(&|at| standings[at] == Standing::InLight, "inside a sphere light"),
        named(&|at| standings[at] == Standing::OnPoint, "on a point light, whose infinite direct light is left out"),
        named(
            &|at| standings[at] == Standing::Free && top_share[at] <= 0.0,
            "no sample found light; dark, or very nearly",
        ),
        named(
            &|at| top_share[at] > LARGEST_TRUSTED_SHARE,
            "one sample is over 5% of the sum, so that the standard error is not to be trusted",
        ),
    ];
    kinds.into_iter().flatten().collect()
}
