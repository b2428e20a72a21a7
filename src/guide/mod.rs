//! What is a renderer seeded with?
//!
//! All that Lightvein knows of the light in a scene, in the forms that renderers take: lobes of incident light at nodes and on
//! walls (guided path tracing), necks as polygons with their flux (portals), virtual point lights (Keller 1997), probes with
//! spherical harmonics of first order (Ramamoorthi & Hanrahan 2001), records of an irradiance cache (Ward, Rubinstein & Clear
//! 1988), and samples that train a guiding library (OpenPGL). Everything comes from one [`Network`](crate::flow::network): its
//! lines have measured the exchange of light, and say from where it comes.
//!
//! Limits: those of the network. What the voxels close has no place of its own.

pub mod cache;
pub mod fit;
pub mod known;
pub mod necks;
pub mod places;
pub mod probes;
pub mod samples;
pub mod shares;
pub mod shine;
pub mod sights;
pub mod straight;
pub mod vpls;
pub mod whole;

use crate::flow::network::Quality;
use crate::flow::network::read::Tracks;
use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Incident, Settings};
use crate::model::Model;
use glam::Vec3;
use known::Known;
use shares::Shares;
use shine::Shine;
use straight::InView;

/// Virtual point lights, about.
const VIRTUAL_LIGHTS: usize = 1024;

/// Told where nothing shines.
const NO_LIGHT: &str = "no light shines into the void: all light in the guide is zero";

/// A guide beside what it stands on.
pub struct Seeded<'a> {
    /// What a guided tracer asks.
    pub known: Known<'a>,
    /// What renderers are seeded with.
    pub guide: Guide,
}

/// Everything that a renderer can be seeded with, for all emitters of a model; `settings` gives the seed. Costs a network of
/// that quality and about as much again.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn guide<'a>(
    model: &'a Model,
    quality: &Quality,
    settings: &Settings,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Seeded<'a>, Cancelled> {
    let (known, lines) = known::known_by_lines(model, quality, settings, progress, cancel)?;
    let Known { network, walls, zones } = &known;
    let shine = Shine::new(network);
    let radiosity_w_m2 = shine.means_w_m2();
    // Side by side, for each has a part that a single thread does.
    let (tracks, shares) = staged("tracks", progress, cancel, || {
        let radiosity_w_m2 = std::slice::from_ref(&radiosity_w_m2);
        let tracks = || Tracks::new(&network.grounds, &lines, radiosity_w_m2, 1, settings.seed);
        rayon::join(tracks, || Shares::new(network))
    })?;
    let ((views, samples), necks) = staged("sights", progress, cancel, || {
        let views = || cache::views(network, walls, &lines, &radiosity_w_m2);
        let samples = || samples::samples(network, &shine, &lines);
        let necks = || necks::openings(network, &lines, &radiosity_w_m2, settings.seed);
        rayon::join(|| rayon::join(views, samples), necks)
    })?;

    let (nodes, probes) = staged("open", progress, cancel, || {
        let in_view = InView::new(network, settings.seed);
        let nodes = whole::nodes(network, places::at_nodes(network, zones), &tracks, &in_view, &shares);
        (nodes, probes::probes(network, &tracks, &in_view))
    })?;
    let walls = whole::walls(network, walls.clone(), &shares, &views);
    let cache = cache::records(&walls, &views);
    let vpls = vpls::virtual_lights(network, &shine, VIRTUAL_LIGHTS);

    let reflectances = network.grounds.patches.list.iter().map(|patch| patch.reflectance as f32).collect();
    let dark = network.lamps().next().is_none().then(|| NO_LIGHT.to_owned());
    let warnings = network.warnings().iter().cloned().chain(dark).collect();
    let guide = Guide { nodes, walls, reflectances, necks, vpls, probes, cache, samples, warnings };
    Ok(Seeded { known, guide })
}

/// One step, reported; stops before it when asked to.
fn staged<T>(stage: &str, progress: &dyn Progress, cancel: &Cancel, work: impl FnOnce() -> T) -> Result<T, Cancelled> {
    cancel.check()?;
    progress.begin(stage, 0);
    let done = work();
    progress.end();
    Ok(done)
}

/// What a renderer is seeded with. Positions are the scene's own, metres.
#[derive(Debug, Clone, Default)]
pub struct Guide {
    /// The light at each node of the skeleton, in their order.
    pub nodes: Vec<Place>,
    /// The light on walls, one place for each patch of the network, in their order: every zone of the void has a point
    /// on each side it sees.
    pub walls: Vec<Place>,
    /// Mean reflectance of the walls around each of [`Guide::walls`].
    pub reflectances: Vec<f32>,
    /// The doorways and windows, those of the skeleton in their order.
    pub necks: Vec<Opening>,
    /// Virtual point lights.
    pub vpls: Vec<VirtualLight>,
    /// Where light probes stand.
    pub probes: Vec<LightProbe>,
    /// Records of an irradiance cache, one for each of [`Guide::walls`].
    pub cache: Vec<CacheRecord>,
    /// What trains a guiding library.
    pub samples: Vec<TrainingSample>,
    /// What a reader should know, a sentence each.
    pub warnings: Vec<String>,
}

/// A place and the light that comes to it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Place {
    /// Lobes, and irradiance by part.
    pub incident: Incident,
    /// Scalar irradiance by all light, W/m2.
    pub scalar_w_m2: f32,
    /// The share of each emitter of [`Sources`](crate::light::Sources) in it, all reflections counted; they add up to 1, or
    /// are all 0 where there is no light.
    pub shares: Vec<f32>,
    /// The cell (room) it lies in; `u32::MAX` where it lies in none.
    pub cell: u32,
}

/// A neck as a surface that light flows through.
#[derive(Debug, Clone, PartialEq)]
pub struct Opening {
    /// The cells it joins.
    pub cells: [u32; 2],
    /// Its middle, metres.
    pub position_m: Vec3,
    /// Unit normal, from the first cell to the second.
    pub normal: Vec3,
    /// Its area, m2.
    pub area_m2: f32,
    /// Its border in order, metres.
    pub outline_m: Vec<Vec3>,
    /// What flows through it from the first cell to the second, and back, W.
    pub flux_w: [f64; 2],
}

/// A point on a wall that shines as the wall around it does: Lambertian, on the side of its normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VirtualLight {
    /// Where, metres.
    pub position_m: Vec3,
    /// Unit normal of the side it shines on.
    pub normal: Vec3,
    /// The flux it sends out, W.
    pub flux_w: f64,
    /// The cell it shines into.
    pub cell: u32,
}

/// A place for a light probe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightProbe {
    /// Where, metres.
    pub position_m: Vec3,
    /// Distance to the nearest wall, metres.
    pub radius_m: f32,
    /// The cell it stands in.
    pub cell: u32,
    /// Incident radiance in real spherical harmonics of orders 0 and 1: (0,0), (1,-1), (1,0), (1,1), which follow 1, y, z, x;
    /// orthonormal, without the Condon-Shortley phase, W/m2/sr.
    pub sh_w_m2_sr: [f32; 4],
}

/// A record of an irradiance cache.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CacheRecord {
    /// Where, metres.
    pub position_m: Vec3,
    /// Unit normal of the surface.
    pub normal: Vec3,
    /// Irradiance by reflected light, W/m2: what a renderer that samples its lights caches.
    pub reflected_w_m2: f32,
    /// Irradiance by all light, W/m2.
    pub irradiance_w_m2: f32,
    /// Harmonic mean distance to what the point sees, metres: Ward's validity radius.
    pub radius_m: f32,
}

/// A sample of incident radiance, as guiding libraries train on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrainingSample {
    /// Where, metres, on a surface.
    pub position_m: Vec3,
    /// Unit direction that the light comes from.
    pub direction: Vec3,
    /// Radiance over density, W/m2.
    pub weight_w_m2: f32,
    /// Density of the direction, per steradian.
    pub density_per_sr: f32,
    /// Distance to what shines, metres.
    pub distance_m: f32,
    /// As OpenPGL has them: [`samples::DIRECT_LIGHT`] where what shines is an emitter itself, 0 where it is a wall.
    pub flags: u32,
}
