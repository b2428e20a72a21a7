//! What was modelled of a scene: its rays, voxels, skeleton and where its lights stand in them; what every estimator reads.
//!
//! [`Model::build`] models at a given voxel size; [`choose::choose_voxel_m`] finds one where the user gives none;
//! [`bare::light_bare_mesh`] lights a mesh that came without a scene file; [`faces`] are where a mesh is asked for its light.

pub mod bare;
pub mod choose;
pub mod faces;
pub mod walls;

use crate::job::{Cancel, Cancelled, Progress};
use crate::light::{Aim, Emitter, Sampler, Shape, Sources, Status};
use crate::rays::Rays;
use crate::scene::{Scene, Sensor};
use crate::skeleton::Skeleton;
use crate::space::{Lattice, VoxelIndex};
use crate::voxel::seeds::{self, Ground, Lost, Place};
use crate::voxel::{VoxelError, Voxels, voxelise, voxelise_on};
use glam::Vec3;
use petgraph::graph::NodeIndex;
use rayon::prelude::*;
use std::sync::Arc;
use walls::Walls;

/// What was modelled of a scene.
#[derive(Debug)]
pub struct Model {
    /// Exact visibility.
    pub rays: Arc<Rays>,
    /// What shines.
    pub sources: Sources,
    /// How to look towards what shines.
    pub sampler: Sampler,
    /// What light falls on.
    pub walls: Walls,
    /// Where matter and void are.
    pub voxels: Arc<Voxels>,
    /// Where the void runs.
    pub skeleton: Arc<Skeleton>,
    /// Where each emitter of [`Model::sources`] stands, in their order.
    pub shining: Vec<Shining>,
}

/// An emitter as the skeleton sees it: one point with a flux.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shining {
    /// Its number in [`Sources::emitters`].
    pub emitter: usize,
    /// Its centre, metres.
    pub position_m: Vec3,
    /// Its total flux, W.
    pub flux_w: f64,
    /// The node it enters the skeleton by, or why it has none.
    pub place: Result<NodeIndex, Status>,
    /// The straight distance from it to that node, metres; 0 without one.
    pub to_node_m: f64,
}

/// A point at which an estimator is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Where it is, metres.
    pub position_m: Vec3,
    /// Unit normal for planar irradiance, `None` for scalar irradiance.
    pub normal: Option<Vec3>,
    /// The node nearest to it along the void, or why it has none.
    pub place: Result<NodeIndex, Status>,
}

/// Why a scene could not be modelled.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The voxels failed.
    #[error(transparent)]
    Voxel(#[from] VoxelError),
    /// The run was stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl ModelError {
    /// Whether the run was stopped, rather than the scene refused.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Cancelled(_) | Self::Voxel(VoxelError::Cancelled(_)))
    }
}

impl Model {
    /// Models a scene with voxels of `voxel_m` metres, taking at most `max_bytes` for voxels and skeleton.
    ///
    /// # Errors
    /// [`ModelError::Voxel`] for a grid that does not fit, with the size that would; [`ModelError::Cancelled`].
    pub fn build(
        scene: &Scene,
        rays: Arc<Rays>,
        voxel_m: f32,
        max_bytes: u64,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Self, ModelError> {
        Self::voxelised(scene, rays, progress, cancel, |rays, patches| {
            voxelise(scene, rays, patches, voxel_m, max_bytes, progress, cancel)
        })
    }

    /// The same on a lattice of one's own, as [`voxelise_on`].
    ///
    /// # Errors
    /// [`ModelError::Cancelled`].
    pub fn build_on(
        lattice: Lattice,
        scene: &Scene,
        rays: Arc<Rays>,
        progress: &dyn Progress,
        cancel: &Cancel,
    ) -> Result<Self, ModelError> {
        Self::voxelised(scene, rays, progress, cancel, |rays, patches| {
            voxelise_on(lattice, scene, rays, patches, progress, cancel)
        })
    }

    fn voxelised(
        scene: &Scene,
        rays: Arc<Rays>,
        progress: &dyn Progress,
        cancel: &Cancel,
        voxelise: impl FnOnce(&Rays, &[Place]) -> Result<Voxels, VoxelError>,
    ) -> Result<Self, ModelError> {
        let sources = Sources::of(scene);

        progress.begin("voxels", 0);
        let voxels = voxelise(&rays, &places_of_patches(scene, &sources))?;
        progress.end();

        progress.begin("skeleton", 0);
        let skeleton = Skeleton::build(&voxels, &rays, progress, cancel)?;
        progress.end();

        Ok(Self::of(scene, rays, sources, voxels, skeleton))
    }

    /// The model of a scene that these parts of it make. Parts of another model may be shared where what changed in the scene
    /// does not touch them: flux leaves voxels and skeleton, reflectance and a light that moves within the void the skeleton.
    pub fn of(
        scene: &Scene,
        rays: Arc<Rays>,
        sources: Sources,
        voxels: impl Into<Arc<Voxels>>,
        skeleton: impl Into<Arc<Skeleton>>,
    ) -> Self {
        let (voxels, skeleton) = (voxels.into(), skeleton.into());
        let sampler = Sampler::new(scene, &sources, rays.epsilon_m());
        let walls = Walls::of(scene);
        let mut model = Self { rays, sources, sampler, walls, voxels, skeleton, shining: Vec::new() };
        model.shining = model.places_of_lights();
        model
    }

    /// The model of a scene that had no light and now has some, standing in the same void.
    fn lit(mut self, scene: &Scene) -> Self {
        self.sources = Sources::of(scene);
        self.sampler = Sampler::new(scene, &self.sources, self.rays.epsilon_m());
        self.shining = self.places_of_lights();
        self
    }

    fn places_of_lights(&self) -> Vec<Shining> {
        let shining = |(emitter, shines): (usize, &Emitter)| {
            let Aim { position_m, facing } = shines.aim();
            let seed = self.voxels.seeds.lights.get(emitter).copied();
            let place = match seed {
                Some(seed) => seed.map_err(status).and_then(|seed| self.node_of(seed.voxel)),
                None => self.place(position_m, facing),
            };
            let to_node_m = place.map_or(0.0, |node| f64::from(self.node_m(node).distance(position_m)));
            Shining { emitter, position_m, flux_w: shines.flux_w, place, to_node_m }
        };
        self.sources.emitters.iter().enumerate().map(shining).collect()
    }

    /// The node that a point, looking along `facing` if it lies on a wall, has along the void; or why it has none.
    pub fn place(&self, point_m: Vec3, facing: Option<Vec3>) -> Result<NodeIndex, Status> {
        let Voxels { lattice, solid, void, .. } = &*self.voxels;
        let place = Place { point_m, normal: facing };
        let ground = Ground { lattice, solid, rays: &self.rays };
        let voxel = seeds::resolved_one(&place, &ground, void).map_err(status)?;
        self.node_of(voxel)
    }

    fn node_of(&self, voxel: VoxelIndex) -> Result<NodeIndex, Status> {
        self.skeleton.nearest_node(voxel).ok_or(Status::Unreached)
    }

    /// Where a node is, metres; the origin for a number beyond the skeleton.
    pub fn node_m(&self, node: NodeIndex) -> Vec3 {
        self.skeleton.graph.node_weight(node).map_or(Vec3::ZERO, |node| node.position_m)
    }

    /// The share of light that comes straight from the centre of a light to a point in the open: 0 where the point does not
    /// see it, below 1 through glazing.
    pub fn straight_share(&self, from_m: Vec3, light: &Shining) -> f64 {
        let emitter = self.sources.emitters.get(light.emitter);
        emitter.map_or(0.0, |emitter| f64::from(emitter.seen_from(&self.rays, from_m)))
    }

    /// Half a voxel, metres: nearer than that the skeleton tells no distances apart.
    pub fn nearest_m(&self) -> f64 {
        0.5 * f64::from(self.voxels.lattice.voxel_m)
    }

    /// The scene's sensors as probes, in their order.
    pub fn probes_at_sensors(&self, scene: &Scene) -> Vec<Probe> {
        let seeds = &self.voxels.seeds.sensors;
        let probe = |(number, sensor): (usize, &Sensor)| match seeds.get(number) {
            Some(seed) => Probe {
                position_m: sensor.position_m,
                normal: sensor.normal,
                place: seed.map_err(status).and_then(|seed| self.node_of(seed.voxel)),
            },
            // Sensors that came after the voxels.
            None => self.probe(sensor.position_m, sensor.normal),
        };
        scene.sensors.par_iter().enumerate().map(probe).collect()
    }

    /// A probe anywhere.
    pub fn probe(&self, position_m: Vec3, normal: Option<Vec3>) -> Probe {
        Probe { position_m, normal, place: self.place(position_m, normal) }
    }

    /// The skeleton's nodes as scalar probes, in their order.
    pub fn probes_at_nodes(&self) -> Vec<Probe> {
        let graph = &self.skeleton.graph;
        let probe = |node| Probe { position_m: self.node_m(node), normal: None, place: Ok(node) };
        graph.node_indices().map(probe).collect()
    }
}

/// What became of a light or sensor that stands in no void.
fn status(lost: Lost) -> Status {
    match lost {
        Lost::InSolid => Status::InSolid,
        Lost::Outside => Status::Outside,
    }
}

/// Where the patches of emissive faces shine from, in the order of the sources.
pub fn places_of_patches(scene: &Scene, sources: &Sources) -> Vec<Place> {
    let place = |emitter: &Emitter| match &emitter.shape {
        Shape::Patch { triangles, centroid_m, .. } => Place::of_patch(&scene.mesh, triangles, *centroid_m),
        Shape::Light(..) => None,
    };
    sources.emitters.iter().filter_map(place).collect()
}
