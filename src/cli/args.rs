//! What can be typed.

use super::daylight::DaylightArgs;
use super::expose::ExposeArgs;
use super::guide::GuideArgs;
use super::sky::args::SkyArgs;
use crate::scene::Method;
use crate::study::stress::Failure;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// Finds the veins through which light flows in a 3D scene, and how much light they bring to every sensor.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 120)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Voxels, skeleton, and an estimate at the sensors, the reference beside it
    Analyse {
        #[command(flatten)]
        common: Common,
        /// The estimator
        #[arg(long, value_parser = method())]
        method: Option<Method>,
    },
    /// Several methods at the sensors, with their errors against the reference
    Compare {
        #[command(flatten)]
        common: Common,
        /// The methods, in the order of the columns
        #[arg(long, value_delimiter = ',', value_parser = method(), default_values_t = [Method::Backward, Method::Forward])]
        methods: Vec<Method>,
        /// Without a reference in the scene: trace one with this many samples a sensor; also the samples of `trace`
        #[arg(long, value_parser = clap::value_parser!(u32).range(2..))]
        spp: Option<u32>,
    },
    /// Speed against accuracy: every method at every quality, over one or more scenes, as pictures, a table and a text
    Chart {
        #[command(flatten)]
        many: Many,
        /// No run of an estimate is begun that would take longer; points beyond are scaled from fewer sensors and marked
        #[arg(long, value_name = "SECONDS", default_value_t = 20.0, value_parser = seconds)]
        budget: f64,
        /// The same for the path tracer's runs; by default as --budget
        #[arg(long, value_name = "SECONDS", value_parser = seconds)]
        trace_budget: Option<f64>,
        /// Count the processor time of all threads, not wall time: on a machine that has other work to do. With --threads 1
        /// it is the time an idle core would take. Linux only
        #[arg(long)]
        processor_time: bool,
        /// A table of another program's points, as benches/peers/chart_mitsuba.py writes it; joins the scenes it names
        #[arg(long, value_name = "FILE")]
        peer: Vec<PathBuf>,
    },
    /// Path-traced truth at the sensors with standard errors, as a reference file on stdout or in -o
    Trace {
        #[command(flatten)]
        common: Common,
        /// Samples a sensor
        #[arg(long, default_value_t = 4096, value_parser = clap::value_parser!(u32).range(2..))]
        spp: u32,
        /// Most reflections of a path; without it Russian roulette alone ends paths
        #[arg(long)]
        bounces: Option<u32>,
    },
    /// What a renderer is seeded with: lobes of incident light, portals, virtual lights, probes, an irradiance cache, samples
    Guide(GuideArgs),
    /// Stability where methods fail: scenes disturbed, and built-in scenes made for one failure each
    Stress(StressArgs),
    /// The sun's path, a picture of the sky, and the exposure map of a period: what comes from each direction
    Sky(SkyArgs),
    /// What the sensors receive from sun and sky over a period, by rays; without what surfaces reflect
    Expose(ExposeArgs),
    /// The same with what surfaces reflect, and in rooms; daylight factor and illuminance
    Daylight(DaylightArgs),
}

/// What `stress` takes.
#[derive(Debug, clap::Args)]
pub struct StressArgs {
    /// Scene files or meshes to disturb; without one the built-in scenes alone
    pub scenes: Vec<PathBuf>,
    /// The methods; by default every estimator
    #[arg(long, value_delimiter = ',', value_parser = method())]
    pub methods: Vec<Method>,
    /// The failures to try; by default all
    #[arg(long, value_delimiter = ',', value_parser = failure(), default_values_t = Failure::ALL, hide_default_value = true)]
    pub rows: Vec<Failure>,
    /// Offsets of the lattice
    #[arg(long, default_value_t = 16)]
    pub offsets: u32,
    /// Turns of the scene
    #[arg(long, default_value_t = 8)]
    pub turns: u32,
    /// Seeds beside the first
    #[arg(long, default_value_t = 8)]
    pub seeds: u32,
    /// Samples a sensor of a traced truth; small openings take up to 256 times as many
    #[arg(long, default_value_t = 4096, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub spp: u32,
    #[command(flatten)]
    pub flags: Flags,
    /// Folder for the files; made if it is not there
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// What every command takes.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct Flags {
    /// Edge of a voxel in metres; by default the scene file's, or one that is chosen
    #[arg(long, value_name = "METRES", value_parser = edge_m)]
    pub voxel: Option<f32>,
    /// Threads to work on; by default one a core. The figures do not depend on it
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Seed of all random numbers
    #[arg(long)]
    pub seed: Option<u64>,
    /// One JSON object on stdout instead of tables and text
    #[arg(long)]
    pub json: bool,
}

/// What commands over one scene take.
#[derive(Debug, clap::Args)]
pub struct Common {
    /// A scene file (.toml), or a mesh (.obj .gltf .glb .ply .stl)
    pub scene: PathBuf,
    /// Factor within which the estimate is to be right
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    pub tolerance: Option<f64>,
    #[command(flatten)]
    pub flags: Flags,
    /// Folder for the files; made if it is not there
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// What commands over several scenes take.
#[derive(Debug, clap::Args)]
pub struct Many {
    /// Scene files (.toml)
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    #[command(flatten)]
    pub flags: Flags,
    /// Folder for the files; made if it is not there
    #[arg(short, long = "output", value_name = "DIR", required = true)]
    pub output: PathBuf,
}

/// A time above 0.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if seconds.is_finite() && seconds > 0.0 { Ok(seconds) } else { Err("a budget is above 0 seconds".to_owned()) }
}

/// A length above 0.
fn edge_m(text: &str) -> Result<f32, String> {
    let metres: f32 = text.parse().map_err(|_| "not a number".to_owned())?;
    if metres.is_finite() && metres > 0.0 { Ok(metres) } else { Err("a voxel's edge is above 0 m".to_owned()) }
}

/// A factor above 1.
pub(super) fn factor(text: &str) -> Result<f64, String> {
    let factor: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if factor.is_finite() && factor > 1.0 { Ok(factor) } else { Err("a tolerance is a factor above 1".to_owned()) }
}

/// A method by its name.
fn method() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(Method::name))
        .try_map(|name| Method::from_name(&name).ok_or("not a method"))
}

/// A failure by its name.
fn failure() -> impl TypedValueParser<Value = Failure> {
    PossibleValuesParser::new(Failure::ALL.map(Failure::name))
        .try_map(|name| Failure::from_name(&name).ok_or("not a failure"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Args::command().debug_assert();
    }
}
