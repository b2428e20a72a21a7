//! Which layers are on and how each looks: plain data that the panels change and `draw` turns into a picture.

use crate::measure::Measure;
use crate::shadows::{Method, Settings};
use lightvein::daylight::Quantity;
use serde::{Deserialize, Serialize};

/// How the mesh is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MeshStyle {
    /// Opaque, in its materials' grey or in colours.
    Shaded,
    /// Its edges alone.
    Wireframe,
    /// Seen through.
    Transparent,
}

/// What colours the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MeshColour {
    /// Its materials' reflectance, as grey.
    Material,
    /// The estimate on its faces.
    Irradiance,
    /// What its faces receive from sun and sky.
    Exposure,
}

/// What the voxel layer shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum VoxelShow {
    /// Matter.
    Solid,
    /// The void that was modelled.
    Void,
    /// The void, coloured by its distance to matter.
    Distance,
}

/// What colours the nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NodeColour {
    /// The flux of the strongest edge that meets there.
    Flux,
    /// Scalar irradiance.
    Irradiance,
    /// The radius of its ball.
    Radius,
    /// The room that it is in.
    Cell,
    /// The light that gives most, or is nearest along the veins.
    Light,
}

impl NodeColour {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Irradiance, Self::Flux, Self::Radius, Self::Cell, Self::Light];

    /// Its name on screen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flux => "Flux",
            Self::Irradiance => "Irradiance",
            Self::Radius => "Radius",
            Self::Cell => "Cell",
            Self::Light => "Light",
        }
    }

    /// The measure whose scale it uses; `None` for names without an order.
    pub const fn measure(self) -> Option<Measure> {
        match self {
            Self::Flux => Some(Measure::Flux),
            Self::Irradiance => Some(Measure::Irradiance),
            Self::Radius => Some(Measure::Radius),
            Self::Cell | Self::Light => None,
        }
    }
}

/// A slice of voxels across an axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Slice {
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Where along the lattice, 0 to 1.
    pub share: f32,
}

/// A half space whose mesh and voxels are hidden.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Azimuth of its normal, degrees from +X counter-clockwise.
    pub azimuth_deg: f32,
    /// Elevation of its normal, degrees.
    pub elevation_deg: f32,
    /// Where along the normal the plane lies, 0 to 1 of the scene's extent.
    pub share: f32,
}

impl Default for Section {
    fn default() -> Self {
        Self { azimuth_deg: -90.0, elevation_deg: 0.0, share: 0.5 }
    }
}

/// How shadows are found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Shadow {
    /// By which method.
    pub method: Method,
    /// Texels a side of a map.
    pub resolution: u32,
    /// Layers, where the method has several.
    pub layers: usize,
}

impl Default for Shadow {
    fn default() -> Self {
        Self::by(Method::Hsm)
    }
}

impl Shadow {
    /// Resolutions that menus offer.
    pub const RESOLUTIONS: [u32; 4] = [256, 512, 1024, 2048];

    /// A method with the layers that it has by default, at 1024 texels.
    pub const fn by(method: Method) -> Self {
        Self { method, resolution: 1024, layers: method.default_layers() }
    }

    /// The settings of the method.
    pub fn settings(&self) -> Settings {
        self.method.settings(self.resolution, self.layers)
    }
}

/// All layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Layers {
    /// The mesh.
    pub mesh: bool,
    /// How it is drawn.
    pub mesh_style: MeshStyle,
    /// What colours it.
    pub mesh_colour: MeshColour,
    /// Voxels.
    pub voxels: bool,
    /// Which.
    pub voxel_show: VoxelShow,
    /// Just one slice of them.
    pub voxel_slice: Option<Slice>,
    /// Nodes of the skeleton.
    pub nodes: bool,
    /// What colours them.
    pub node_colour: NodeColour,
    /// Edges of the skeleton.
    pub edges: bool,
    /// Arrows along the flow.
    pub arrows: bool,
    /// Cells: the void coloured by its rooms.
    pub cells: bool,
    /// Necks: the openings between cells.
    pub necks: bool,
    /// Sensors.
    pub sensors: bool,
    /// Their values beside them.
    pub sensor_values: bool,
    /// Sensors coloured by their ratio to the reference instead of their irradiance.
    pub sensor_ratios: bool,
    /// Lights.
    pub lights: bool,
    /// The maximal ball of the picked node.
    pub ball: bool,
    /// Paths from what is picked to the lights, and the farthest visible node.
    pub paths: bool,
    /// The sky dome with the sun's path.
    pub sun_path: bool,
    /// The sky behind the scene, and the mesh in the light of sun and sky with shadows.
    pub shadows: bool,
    /// How the shadows are found.
    pub shadow: Shadow,
    /// Which quantity of the exposure is shown.
    #[serde(skip, default = "total")]
    pub quantity: Quantity,
    /// Whether exposure is shown pixel by pixel of the view instead of on the faces.
    pub per_pixel: bool,
    /// Enclosed scenes: hide what is above this share of their height.
    pub cut: bool,
    /// Where the cut is, share of the height of the scene.
    pub cut_share: f32,
    /// Draw a face only where the void in front of it faces the viewer, so that rooms are seen into.
    pub cull_near_walls: bool,
    /// One free section plane.
    pub section: Option<Section>,
}

fn total() -> Quantity {
    Quantity::Total
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            mesh: true,
            mesh_style: MeshStyle::Shaded,
            mesh_colour: MeshColour::Material,
            voxels: false,
            voxel_show: VoxelShow::Solid,
            voxel_slice: None,
            nodes: true,
            node_colour: NodeColour::Irradiance,
            edges: true,
            arrows: true,
            cells: false,
            necks: false,
            sensors: true,
            sensor_values: false,
            sensor_ratios: false,
            lights: true,
            ball: true,
            paths: true,
            sun_path: false,
            shadows: false,
            shadow: Shadow::default(),
            quantity: Quantity::Total,
            per_pixel: false,
            cut: false,
            cut_share: 0.9,
            cull_near_walls: true,
            section: None,
        }
    }
}

impl Layers {
    /// What colours the sensors: their ratio where that is asked for, else what colours the mesh, irradiance by default.
    pub fn sensor_measure(&self) -> Measure {
        match self.mesh_colour {
            _ if self.sensor_ratios => Measure::Ratio,
            MeshColour::Exposure => Measure::of(self.quantity),
            MeshColour::Material | MeshColour::Irradiance => Measure::Irradiance,
        }
    }

    /// Switches the light of sun and sky: on, it is to be seen, so that no exposure stands in its place.
    pub fn light_by_sun(&mut self, is_on: bool) {
        self.shadows = is_on;
        if is_on {
            (self.mesh, self.per_pixel) = (true, false);
            if self.mesh_colour == MeshColour::Exposure {
                self.mesh_colour = MeshColour::Material;
            }
        }
    }

    /// The measures whose scales are in use, in the order of their legends.
    pub fn measures(&self) -> Vec<Measure> {
        let exposure = Measure::of(self.quantity);
        let mesh = match self.mesh_colour {
            MeshColour::Irradiance if self.mesh => Some(Measure::Irradiance),
            MeshColour::Exposure if self.mesh || self.per_pixel => Some(exposure),
            _ => self.per_pixel.then_some(exposure),
        };
        let nodes = self.node_colour.measure().filter(|_| self.nodes);
        let edges = self.edges.then_some(Measure::Flux);
        let sensors = self.sensors.then(|| self.sensor_measure());
        let voxels = (self.voxels && self.voxel_show == VoxelShow::Distance).then_some(Measure::Distance);
        let mut all: Vec<Measure> = [mesh, nodes, sensors, edges, voxels].into_iter().flatten().collect();
        let mut seen = Vec::new();
        all.retain(|measure| {
            !seen.contains(measure) && {
                seen.push(*measure);
                true
            }
        });
        all
    }
}
