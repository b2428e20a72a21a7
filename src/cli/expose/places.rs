//! Where `expose` asks, and which files become of the answers.

use super::args::{At, ExposeArgs, WayName};
use crate::cli::tell;
use crate::cli::write::Folder;
use crate::daylight::camera::{Buffers, Camera};
use crate::daylight::cast::{Asked, Casting};
use crate::daylight::choose::{PICTURE_TOLERANCE, SENSOR_TOLERANCE};
use crate::daylight::dynamic::{Disturbance, seen_again};
use crate::daylight::surface::{Corners, Patch, corners, default_patch_m, patches, patches_changed};
use crate::daylight::way::Way;
use crate::daylight::{self, Exposure, Point};
use crate::export::exposures::mesh::{Colours, write_corners, write_patches};
use crate::export::exposures::view::{View, write_exr, write_npy};
use crate::export::exposures::{self, picture};
use crate::job::{Cancel, Progress};
use crate::rays::Rays;
use crate::scene::Scene;
use crate::scene::parts::Change;
use anyhow::{Context, Result, bail};
use std::io::Write;

/// How the points lie.
#[derive(Debug, Clone)]
pub enum Layout {
    /// The scene's sensors.
    Sensors,
    /// Patches of faces.
    Patches {
        /// A patch a point.
        patches: Vec<Patch>,
        /// Their longest side, metres.
        patch_m: f32,
    },
    /// Vertices of the mesh.
    Vertices(Corners),
    /// Pixels of a picture.
    Pixels(Buffers),
}

/// The scene after changes.
#[derive(Debug)]
pub struct Scenery {
    /// What became of its parts.
    pub changes: Vec<Change>,
    /// What rays hit now.
    pub rays: Rays,
    /// Where that differs from before.
    pub disturbance: Disturbance,
}

/// Points, and how they lie. The numbers tell each from the others, also where some of them are gone.
#[derive(Debug, Clone)]
pub struct Places {
    /// How they lie.
    pub layout: Layout,
    /// Where they are.
    pub points: Vec<Point>,
    /// A number each, ascending; of pixels their place in the picture.
    pub numbers: Vec<u32>,
}

/// Which places those of the command line are.
///
/// # Errors
/// Flags that do not go with the places.
pub fn at(args: &ExposeArgs, scene: &Scene) -> Result<At> {
    let given = match (args.view.is_given(), args.patch.is_some()) {
        (true, true) => {
            bail!("--from, --to, --fov and --size ask for a camera, --patch for faces: only one of both is possible")
        }
        (true, false) => Some((At::Camera, "--from, --to, --fov and --size are for --at camera")),
        (false, true) => Some((At::Faces, "--patch is for --at faces")),
        (false, false) => None,
    };
    match (args.at, given) {
        (Some(at), Some((other, says))) if at != other => bail!("{says}, not for --at {}", at.name()),
        (Some(at), _) => Ok(at),
        (None, Some((at, _))) => Ok(at),
        (None, None) => Ok(if scene.sensors.is_empty() { At::Faces } else { At::Sensors }),
    }
}

/// Rays a point: as many as were asked for, else the truth at sensors and fewer where there are many points.
pub fn casting(args: &ExposeArgs, at: At, seed: u64) -> Casting {
    let usual = match at {
        At::Sensors => Casting { seed, ..Casting::default() },
        At::Faces | At::Vertices => Casting::of_faces(seed),
        At::Camera => Casting::of_pixels(seed),
    };
    Casting {
        sun_rays: args.sun_rays.map_or(usual.sun_rays, |given| given.0),
        sky_rays: args.sky_rays.unwrap_or(usual.sky_rays),
        seed,
    }
}

/// The way that was asked for by name or by numbers of rays; `None` where tolerance is to choose. Edits are followed by rays.
///
/// # Errors
/// Flags that do not go together.
pub fn way(args: &ExposeArgs, at: At, seed: u64) -> Result<Option<Way>> {
    let by_rays = args.sun_rays.is_some() || args.sky_rays.is_some();
    let rays = Way::Rays(casting(args, at, seed));
    let edited = !args.edits.all().is_empty();
    match args.method {
        Some(WayName::Rays) => Ok(Some(rays)),
        Some(_) if by_rays => bail!("--sun-rays and --sky-rays are for --method rays"),
        Some(_) if edited => bail!("--move, --scale and --hide are followed by --method rays"),
        None if by_rays || edited => Ok(Some(rays)),
        None => Ok(None),
        Some(WayName::Isotropic) => Ok(Some(Way::Isotropic)),
        Some(WayName::Maps) => {
            let ways = ways(at, seed);
            Ok(ways.into_iter().rfind(|way| matches!(way, Way::Maps(_) | Way::View { .. })))
        }
    }
}

/// The ways that tolerance chooses among.
pub fn ways(at: At, seed: u64) -> [Way; 6] {
    if at == At::Camera { Way::for_pixels(seed) } else { Way::for_points(seed) }
}

/// The factor within which exposure is to be right: as typed, else as the scene says, else 1.02; 1.1 where what comes of it is
/// looked at and not read.
pub fn tolerance(args: &ExposeArgs, at: At, scene: &Scene) -> f64 {
    let by_place = if at == At::Sensors { SENSOR_TOLERANCE } else { PICTURE_TOLERANCE };
    args.tolerance.or(scene.model.tolerance).unwrap_or(by_place)
}

/// The camera that was asked for; `None` for other places.
///
/// # Errors
/// A camera that there cannot be.
pub fn camera(args: &ExposeArgs, at: At, scene: &Scene) -> Result<Option<Camera>> {
    if at != At::Camera {
        return Ok(None);
    }
    let (fov_rad, size) = (args.view.fov_rad(), args.view.size_px());
    let camera = match (args.view.from, args.view.to, Camera::of_mesh(&scene.mesh, fov_rad, size)) {
        (Some(from_m), Some(to_m), _) => {
            let [from_m, to_m] = [from_m, to_m].map(|at_m| (at_m - scene.origin_m).as_vec3());
            Camera::new(from_m, to_m, fov_rad, size)
        }
        (_, _, Some(camera)) => camera,
        (_, _, None) => bail!("{}: the scene has no face to look at", args.scene.display()),
    };
    Ok(Some(camera.with_context(|| args.scene.display().to_string())?))
}

impl Places {
    /// The points that were asked for.
    ///
    /// # Errors
    /// A camera that sees nothing, patches too small, or an interrupt.
    pub fn of(
        args: &ExposeArgs,
        at: At,
        camera: Option<&Camera>,
        scene: &Scene,
        rays: &Rays,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Self> {
        let (layout, points) = match (at, camera) {
            (_, Some(camera)) => {
                camera.check(rays).with_context(|| args.scene.display().to_string())?;
                return Ok(Self::seen(Buffers::render(rays, camera, progress, cancel)?));
            }
            (At::Faces | At::Camera, None) => {
                let patch_m = args.patch.unwrap_or_else(|| default_patch_m(&scene.mesh));
                let patches =
                    patches(&scene.mesh, patch_m, cancel).with_context(|| args.scene.display().to_string())?;
                let points = patches.iter().map(Patch::point).collect();
                (Layout::Patches { patches, patch_m }, points)
            }
            (At::Vertices, None) => {
                let corners = corners(&scene.mesh, &scene.parts, cancel)?;
                let points = corners.points.clone();
                (Layout::Vertices(corners), points)
            }
            (At::Sensors, None) => (Layout::Sensors, daylight::points(&scene.sensors)),
        };
        let numbers = (0..points.len() as u32).collect();
        Ok(Self { layout, points, numbers })
    }

    /// What a camera sees.
    pub fn seen(buffers: Buffers) -> Self {
        let seen = (0..buffers.depth_m.len()).filter_map(|pixel| Some((pixel as u32, buffers.point(pixel)?)));
        let (numbers, points) = seen.unzip();
        Self { layout: Layout::Pixels(buffers), points, numbers }
    }

    /// The places after parts of the scene were changed: what lies on them goes with them, sensors stay, and a camera looks again
    /// with rays that meet a change.
    ///
    /// # Errors
    /// An interrupt.
    pub fn changed(&self, scene: &Scene, scenery: &Scenery, progress: &dyn Progress, cancel: &Cancel) -> Result<Self> {
        let Scenery { rays, disturbance, changes } = scenery;
        let (layout, points, numbers) = match &self.layout {
            Layout::Sensors => return Ok(self.clone()),
            Layout::Pixels(buffers) => {
                return Ok(Self::seen(seen_again(buffers, rays, disturbance, progress, cancel)?));
            }
            Layout::Patches { patches, patch_m } => {
                let (left, patches) = patches_changed(patches, changes, &scene.change_of_triangles(changes));
                let points = patches.iter().map(Patch::point).collect();
                (Layout::Patches { patches, patch_m: *patch_m }, points, left)
            }
            Layout::Vertices(corners) => {
                let (left, corners) = corners.changed(changes, &scene.change_of_triangles(changes));
                (Layout::Vertices(corners.clone()), corners.points, left)
            }
        };
        Ok(Self { layout, points, numbers })
    }

    /// The question to the rays.
    pub fn asked(&self) -> Asked<'_> {
        let in_the_open = matches!(self.layout, Layout::Pixels(_));
        Asked { points: &self.points, numbers: Some(&self.numbers), in_the_open }
    }

    /// The buffers of the camera, where there is one.
    pub fn buffers(&self) -> Option<&Buffers> {
        if let Layout::Pixels(buffers) = &self.layout { Some(buffers) } else { None }
    }

    /// What share each point has in a mean: patches by their area, m2.
    pub fn weights(&self) -> Vec<f64> {
        match &self.layout {
            Layout::Patches { patches, .. } => patches.iter().map(Patch::area_m2).collect(),
            Layout::Sensors | Layout::Vertices(_) | Layout::Pixels(_) => vec![1.0; self.points.len()],
        }
    }

    /// How they lie, in words.
    pub fn words(&self) -> String {
        match &self.layout {
            Layout::Sensors => format!("{} sensors", self.points.len()),
            Layout::Patches { patch_m, .. } => {
                format!("{} patches of at most {patch_m} m, on the side of their normal", self.points.len())
            }
            Layout::Vertices(_) => {
                format!(
                    "{} vertices, one for each surface that meets there, on the side of its normal",
                    self.points.len()
                )
            }
            Layout::Pixels(Buffers { camera, .. }) => {
                let [wide, high] = camera.size;
                format!("{} of {wide} x {high} pixels of a camera", self.points.len())
            }
        }
    }

    /// Writes the files of the answers: a table, a mesh in colours or a picture, by the layout. `name` begins their names.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(
        &self,
        folder: &mut Folder,
        name: &str,
        scene: &Scene,
        found: &[Exposure],
        colours: Colours,
        [title, note]: [&str; 2],
    ) -> Result<Vec<String>> {
        let [csv, ply, exr, npy] = ["csv", "ply", "exr", "npy"].map(|ending| format!("{name}.{ending}"));
        let png = format!("{name}_{}.png", colours.quantity);
        let table = |out: &mut dyn Write, id: &dyn Fn(usize) -> String| {
            let ids = (0..self.points.len()).map(id);
            exposures::write_points_csv(out, scene, ids, &self.points, found)
        };
        let by_number =
            |what: &'static str| move |at: usize| format!("{what}{}", self.numbers.get(at).map_or(0, |n| *n));
        match &self.layout {
            Layout::Sensors => {
                folder.file(&csv, |out| exposures::write_csv(out, scene, found))?;
                Ok(vec![csv])
            }
            Layout::Patches { patches, .. } => {
                folder.file(&csv, |out| table(out, &by_number("patch")))?;
                folder.file(&ply, |out| write_patches(out, scene, patches, found, colours))?;
                Ok(vec![csv, ply])
            }
            Layout::Vertices(corners) => {
                folder.file(&csv, |out| table(out, &by_number("vertex")))?;
                folder.file(&ply, |out| write_corners(out, scene, corners, found, colours))?;
                Ok(vec![csv, ply])
            }
            Layout::Pixels(buffers) => {
                let view = View { size: buffers.camera.size, pixels: &self.numbers, exposures: found };
                let drawn = picture::draw(&view, colours, title, note).context("the picture cannot be drawn")?;
                if !drawn.has_text {
                    tell("warning: this system has no font: the picture is without text");
                }
                folder.file(&png, |out| out.write_all(&drawn.bytes))?;
                folder.file(&exr, |out| write_exr(out, &view))?;
                folder.file(&npy, |out| write_npy(out, &view))?;
                Ok(vec![png, exr, npy])
            }
        }
    }
}
