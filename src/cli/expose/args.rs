//! What can be typed after `expose`.

use crate::cli::args::Flags;
use crate::cli::sky::args::SiteArgs;
use crate::daylight::Quantity;
use crate::daylight::camera::{DEFAULT_FOV_RAD, DEFAULT_SIZE};
use crate::scene::parts::Edit;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::DVec3;
use std::path::PathBuf;

/// What `expose` takes.
#[derive(Debug, clap::Args)]
pub struct ExposeArgs {
    /// A scene file (.toml) with a [site], or a mesh with --latitude and --longitude or --weather
    pub scene: PathBuf,
    /// Where: the scene's sensors, the faces of its mesh, its vertices, or what a camera sees; by default its sensors, its faces
    /// where it has none
    #[arg(long, value_enum)]
    pub at: Option<At>,
    #[command(flatten)]
    pub view: ViewArgs,
    /// At faces: the longest side of a patch, metres; by default such that there are some 20,000
    #[arg(long, value_name = "M", value_parser = patch_m)]
    pub patch: Option<f32>,
    #[command(flatten)]
    pub edits: EditArgs,
    /// What the colours of pictures and meshes show
    #[arg(long, value_parser = quantity(), default_value = "total")]
    pub show: Quantity,
    #[command(flatten)]
    pub site: SiteArgs,
    /// How exposure is found; by default the cheapest way inside --tolerance. `rays` takes the numbers below
    #[arg(long, value_enum)]
    pub method: Option<WayName>,
    /// Factor within which exposure is to be right: RMSE as a share of the mean, above 1; by default what the scene says, else
    /// 1.02 at sensors and 1.1 elsewhere
    #[arg(long, value_name = "F", value_parser = crate::cli::args::factor, conflicts_with_all = ["method", "sun_rays", "sky_rays"])]
    pub tolerance: Option<f64>,
    /// Suns of the period that a point looks at, or `all`: by rays; all at sensors, 64 at faces and vertices, 16 a pixel
    #[arg(long, value_name = "N", value_parser = sun_rays)]
    pub sun_rays: Option<SunRays>,
    /// Directions of the sky at a point: by rays; 4096 at sensors, 128 at faces and vertices, 32 a pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=1 << 24))]
    pub sky_rays: Option<u32>,
    #[command(flatten)]
    pub flags: Flags,
    /// Folder for the files; made if it is not there
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// The camera, in the user's coordinates; giving any of these asks for one.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct ViewArgs {
    /// Where the camera stands, metres; by default it sees the whole scene from the south-south-west and above
    #[arg(long, value_name = "X,Y,Z", value_parser = place, requires = "to", allow_hyphen_values = true)]
    pub from: Option<DVec3>,
    /// What it looks at, metres
    #[arg(long, value_name = "X,Y,Z", value_parser = place, requires = "from", allow_hyphen_values = true)]
    pub to: Option<DVec3>,
    /// Its vertical field of view, degrees, 1 to 170 [default: 40]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub fov: Option<f64>,
    /// Width and height of its picture, pixels [default: 800x600]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[usize; 2]>,
}

impl ViewArgs {
    /// Whether any of them was given.
    pub fn is_given(&self) -> bool {
        self.from.is_some() || self.fov.is_some() || self.size.is_some()
    }

    pub(super) fn fov_rad(&self) -> f64 {
        self.fov.map_or(DEFAULT_FOV_RAD, f64::to_radians)
    }

    pub(super) fn size_px(&self) -> [usize; 2] {
        self.size.unwrap_or(DEFAULT_SIZE)
    }
}

/// What is done to parts of the mesh after the first result; what depends on it is computed anew. A name with a trailing `*`
/// means all parts whose names begin so.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct EditArgs {
    /// Move a part of the mesh (an object, group, node or file), metres, and compute anew what depends on it; may be repeated
    #[arg(long = "move", value_name = "NAME=DX,DY,DZ", value_parser = moving)]
    pub moves: Vec<(String, Edit)>,
    /// Scale a part about the middle of its base
    #[arg(long = "scale", value_name = "NAME=F", value_parser = scaling)]
    pub scales: Vec<(String, Edit)>,
    /// Take a part away
    #[arg(long = "hide", value_name = "NAME")]
    pub hides: Vec<String>,
}

impl EditArgs {
    /// All edits.
    pub fn all(&self) -> Vec<(String, Edit)> {
        let hides = self.hides.iter().map(|name| (name.clone(), Edit::Hide));
        self.scales.iter().chain(&self.moves).cloned().chain(hides).collect()
    }
}

fn moving(text: &str) -> Result<(String, Edit), String> {
    let edit = text.rsplit_once('=').and_then(|(name, by_m)| Some((name.to_owned(), Edit::Move(vector(by_m)?))));
    edit.ok_or_else(|| "a move is NAME=DX,DY,DZ: a part and three numbers, metres".to_owned())
}

fn scaling(text: &str) -> Result<(String, Edit), String> {
    let edit = text.rsplit_once('=').and_then(|(name, by)| Some((name.to_owned(), Edit::Scale(by.parse().ok()?))));
    edit.ok_or_else(|| "a scale is NAME=F: a part and a factor".to_owned())
}

/// Where exposure is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum At {
    /// At the sensors of the scene.
    Sensors,
    /// At the faces of the mesh, cut into patches, on the side of their normal.
    Faces,
    /// At the vertices of the mesh, once for each surface that meets there.
    Vertices,
    /// At each pixel of a camera's picture.
    Camera,
}

impl At {
    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sensors => "sensors",
            Self::Faces => "faces",
            Self::Vertices => "vertices",
            Self::Camera => "camera",
        }
    }
}

/// How exposure is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum WayName {
    /// An open plane's exposure times the share of its sky that is seen.
    Isotropic,
    /// Maps of heights and of the sky; at the pixels of a camera also its own buffers.
    Maps,
    /// Rays to the suns and the sky.
    Rays,
}

/// How many suns; `None` for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SunRays(pub Option<u32>);

fn sun_rays(text: &str) -> Result<SunRays, String> {
    if text == "all" {
        return Ok(SunRays(None));
    }
    let count = text.parse().ok().filter(|&count: &u32| count > 0);
    count.map(|count| SunRays(Some(count))).ok_or_else(|| "neither a number of suns, 1 and more, nor all".to_owned())
}

fn place(text: &str) -> Result<DVec3, String> {
    vector(text).ok_or_else(|| "a place is X,Y,Z: three numbers, metres".to_owned())
}

/// Three finite numbers.
pub(super) fn vector(text: &str) -> Option<DVec3> {
    let parts: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let vector = DVec3::from_array(<[f64; 3]>::try_from(parts?).ok()?);
    vector.is_finite().then_some(vector)
}

fn size(text: &str) -> Result<[usize; 2], String> {
    let sides = text.split_once('x').and_then(|(wide, high)| Some([wide.parse().ok()?, high.parse().ok()?]));
    sides.ok_or_else(|| "a size is WIDTHxHEIGHT, pixels".to_owned())
}

fn patch_m(text: &str) -> Result<f32, String> {
    let patch_m: f32 = text.parse().map_err(|_| "not a number".to_owned())?;
    if patch_m.is_finite() && patch_m > 0.0 { Ok(patch_m) } else { Err("a patch is longer than 0 m".to_owned()) }
}

/// A quantity by its name.
fn quantity() -> impl TypedValueParser<Value = Quantity> {
    PossibleValuesParser::new(Quantity::ALL.map(Quantity::name))
        .try_map(|name| Quantity::from_name(&name).ok_or("not a quantity"))
}
