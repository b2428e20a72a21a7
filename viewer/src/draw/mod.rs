//! From what was found, which layers are on and where the camera stands to the picture: each layer makes its data once and keeps
//! them until what it shows has changed.

pub mod marks;
pub mod memo;
pub mod mesh;
pub mod veins;
pub mod voxels;

use crate::camera::Camera;
use crate::colour::Scale;
use crate::layers::{Layers, MeshColour, NodeColour, Section, Slice, VoxelShow};
use crate::measure::Measure;
use crate::outdoors::SensorExposure;
use crate::outdoors::facade::Facade;
use crate::outdoors::shown as outdoors;
use crate::paint::{Ball, Batch, Corner, Culling, Cut, FaceStyle, Picture, Shadows, Stroke, Sunlight, Tint, What};
use crate::panels::inspector::WayToLight;
use crate::results::{Estimate, Faces, Results};
use crate::state::{Picked, State};
use glam::{Vec2, Vec3};
use lightvein::model::Model;
use lightvein::scene::{Light, Scene};
use memo::{Later, Memo, Same};
use std::f32::consts::PI;
use std::sync::Arc;
use voxels::{Show, Squares};

/// Backgrounds at the top and at the bottom, dark and light.
const DARK: [[u8; 3]; 2] = [[44, 48, 56], [22, 24, 28]];
const LIGHT: [[u8; 3]; 2] = [[232, 236, 242], [206, 211, 219]];

/// More sensors than this are drawn smaller, or they would hide what they stand on.
const MANY_SENSORS: usize = 60;

/// The box of a scene without a mesh.
const NO_BOX: (Vec3, Vec3) = (Vec3::splat(-1.0), Vec3::ONE);

/// What layers are made of, one after the other the parts that they depend on.
type OfMesh = (Same<Scene>, Same<Vec<u8>>);
type OfVoxels = (Same<Model>, VoxelShow, Option<Slice>);
type OfModel<T> = (Same<Model>, Same<Estimate>, T);
type OfSensors = (Same<Scene>, Same<Estimate>, Same<SensorExposure>, Measure);
type Seen = (Camera, [u32; 2], bool);
type OfMark = (Same<Scene>, Vec<Light>, Option<Picked>, bool);

/// Balls and strokes of one layer.
type Marks = (Arc<Vec<Ball>>, Arc<Vec<Stroke>>);

/// Makes pictures.
#[derive(Default)]
pub struct Drawer {
    mesh: Memo<OfMesh, mesh::Parts>,
    faces: Memo<Same<Faces>, Arc<Vec<Corner>>>,
    voxels: Later<OfVoxels, Squares>,
    cells: Later<(Same<Model>, Option<Slice>), Squares>,
    nodes: Memo<OfModel<NodeColour>, Arc<Vec<Ball>>>,
    edges: Memo<OfModel<Scale>, Arc<Vec<Stroke>>>,
    order: Memo<Same<Estimate>, Arc<Vec<u32>>>,
    arrows: Memo<OfModel<Seen>, Arc<Vec<Stroke>>>,
    necks: Memo<Same<Model>, Vec<Batch>>,
    sensors: Memo<OfSensors, Marks>,
    lights: Memo<(Vec<Light>, f32), Vec<Batch>>,
    picked: Memo<OfModel<OfMark>, Vec<Batch>>,
    facade: Memo<(Facade, f32), Batch>,
    hovered: Memo<OfModel<OfMark>, Vec<Batch>>,
    ways: Memo<(Same<Model>, Vec<WayToLight>), Vec<Batch>>,
    gizmo: Memo<(Vec3, f32), Batch>,
    picture: Option<Arc<Picture>>,
}

/// A picture and the names in it.
pub struct Drawn {
    /// The picture; the same one as before when nothing has changed.
    pub picture: Arc<Picture>,
    /// Names of the sky's quarters and hours, and where they stand.
    pub labels: Vec<(Vec3, String)>,
    /// What could not be drawn, a sentence each.
    pub notes: Vec<String>,
}

impl Drawer {
    /// The picture of a state. `is_dark` picks the background, `wake` is called when a layer that takes long is ready.
    pub fn draw(&mut self, state: &mut State, size_px: Vec2, is_dark: bool, wake: &Wake) -> Drawn {
        let layers = state.layers.clone();
        let mut notes = Vec::new();
        let mut batches = outdoors::batches(state);
        let labels = outdoors::labels(state);
        if layers.mesh && !outdoors::draws_faces(state) {
            batches.extend(self.mesh(state, &layers));
        }
        batches.extend(self.voxels(state, &layers, wake, &mut notes));
        batches.extend(self.veins(state, &layers, size_px, is_dark));
        batches.extend(self.marks(state, &layers));

        let sunlight = self.sunlight(state, &layers, &batches);
        let picture = Picture {
            camera: state.camera,
            background: if is_dark { DARK } else { LIGHT },
            sunlight,
            cuts: cuts(&layers, bounds_m(&state.results)),
            batches,
        };
        let shown = match self.picture.take() {
            Some(before) if *before == picture => before,
            _ => Arc::new(picture),
        };
        self.picture = Some(Arc::clone(&shown));
        Drawn { picture: shown, labels, notes }
    }

    /// Sun and sky over the picture, where they are asked for and known; shadows where something is lit by the sun.
    fn sunlight(&mut self, state: &State, layers: &Layers, batches: &[Batch]) -> Option<Sunlight> {
        let now = state.outdoors.now.as_ref().filter(|_| layers.shadows)?;
        let is_sunlit = |batch: &Batch| matches!(batch.what, What::Faces { style: FaceStyle::Sunlit, .. });
        let casters = self.parts(state).filter(|_| batches.iter().any(is_sunlit)).map(|[opaque, _]| opaque);
        let shadows = casters.map(|casters| Shadows { casters, settings: layers.shadow.settings() });
        Some(Sunlight { light: now.light, shadows })
    }

    /// Whether a layer is still being made.
    pub fn is_busy(&self) -> bool {
        self.voxels.is_busy() || self.cells.is_busy()
    }

    fn mesh(&mut self, state: &mut State, layers: &Layers) -> Vec<Batch> {
        if layers.mesh_colour == MeshColour::Irradiance
            && let Some(faces) = state.results.faces.clone()
        {
            let data = self.faces.get(Same(Some(Arc::clone(&faces))), |_| mesh::valued(&faces));
            return vec![mesh::coloured(data, Tint::Scaled(state.scale(Measure::Irradiance)), layers)];
        }
        self.parts(state).map_or_else(Vec::new, |parts| mesh::batches(parts, layers))
    }

    /// The corners of the mesh.
    fn parts(&mut self, state: &State) -> Option<mesh::Parts> {
        let scene = state.results.scene.clone()?;
        // Sides are those of another mesh while a new one is on its way.
        let sides = state.results.sides.clone().filter(|sides| sides.len() == scene.mesh.triangles.len());
        let key = (Same(Some(Arc::clone(&scene))), Same(sides.clone()));
        Some(self.mesh.get(key, |_| mesh::corners(&scene, sides.as_ref().map(|sides| &sides[..]))))
    }

    fn voxels(&mut self, state: &mut State, layers: &Layers, wake: &Wake, notes: &mut Vec<String>) -> Vec<Batch> {
        let Some(model) = state.results.model.clone() else { return Vec::new() };
        let edge_m = model.voxels.lattice.voxel_m;
        let mut batches = Vec::new();
        let mut note = |squares: &Squares| {
            if squares.left_out > 0 {
                notes.push(format!("{} faces of voxels are not drawn: show a slice", squares.left_out));
            }
        };
        let squares = |squares: Squares, tint, opacity| {
            let what = What::Cubes { data: squares.cubes, edge_m, culling: Culling::ToVoid };
            Batch { cut: true, tint, opacity, ..Batch::new(what) }
        };
        if layers.voxels {
            let key = (Same(Some(Arc::clone(&model))), layers.voxel_show, layers.voxel_slice);
            let make = |(model, show, slice): &OfVoxels| {
                model
                    .0
                    .as_ref()
                    .map_or_else(Squares::default, |model| voxels::squares(model, Show::Voxels(*show), *slice))
            };
            let wake = wake.clone();
            if let Some(made) = self.voxels.get(&key, make, move || wake()) {
                note(&made);
                let is_distance = layers.voxel_show == VoxelShow::Distance;
                let tint = if is_distance { Tint::Scaled(state.scale(Measure::Distance)) } else { Tint::Own };
                let opacity =
                    if layers.voxel_show == VoxelShow::Void && layers.voxel_slice.is_none() { 0.35 } else { 1.0 };
                batches.push(squares(made, tint, opacity));
            }
        }
        if layers.cells {
            let key = (Same(Some(Arc::clone(&model))), layers.voxel_slice);
            let make = |(model, slice): &(Same<Model>, Option<Slice>)| {
                model.0.as_ref().map_or_else(Squares::default, |model| voxels::squares(model, Show::Cells, *slice))
            };
            let wake = wake.clone();
            if let Some(made) = self.cells.get(&key, make, move || wake()) {
                note(&made);
                batches.push(squares(made, Tint::Own, 0.3));
            }
        }
        batches
    }

    fn veins(&mut self, state: &mut State, layers: &Layers, size_px: Vec2, is_dark: bool) -> Vec<Batch> {
        let Some(model) = state.results.model.clone() else { return Vec::new() };
        // An older estimate may be of another skeleton while a new one is on its way.
        let estimate = state.results.estimate.clone();
        let estimate = estimate.filter(|estimate| estimate.through_edges_w.len() == model.skeleton.graph.edge_count());
        let of_model = Same(Some(Arc::clone(&model)));
        let of_estimate = Same(estimate.clone());
        let mut batches = Vec::new();
        if layers.edges {
            let scale = state.scale(Measure::Flux);
            let key = (of_model.clone(), of_estimate.clone(), scale);
            let data = self.edges.get(key, |_| Arc::new(veins::edges(&model, estimate.as_deref(), &scale)));
            batches.push(Batch { tint: Tint::Scaled(scale), ..Batch::new(What::Strokes { data }) });
        }
        if layers.nodes {
            let colour = layers.node_colour;
            let key = (of_model.clone(), of_estimate.clone(), colour);
            let data = self.nodes.get(key, |_| Arc::new(veins::nodes(&model, estimate.as_deref(), colour)));
            let tint = colour.measure().map_or(Tint::Own, |measure| Tint::Scaled(state.scale(measure)));
            batches.push(Batch { tint, ..Batch::new(What::Balls { data, least_px: 1.5, most_px: 12.0 }) });
        }
        if let (true, true, Some(estimate)) = (layers.edges, layers.arrows, &estimate) {
            let order = self.order.get(of_estimate.clone(), |_| Arc::new(veins::by_strength(estimate)));
            let size = size_px.to_array().map(|along| along as u32);
            let key = (of_model.clone(), of_estimate, (state.camera, size, is_dark));
            let colour = if is_dark { [255, 255, 255, 255] } else { [20, 22, 26, 255] };
            let camera = state.camera;
            let make = |_: &_| Arc::new(veins::arrows(&model, estimate, &order, &camera, size_px, colour));
            batches.push(Batch::new(What::Strokes { data: self.arrows.get(key, make) }));
        }
        if layers.necks {
            batches.extend(self.necks.get(of_model, |_| {
                let (panes, borders) = veins::necks(&model);
                vec![marks::flat(panes, 0.45), Batch::new(What::Strokes { data: Arc::new(borders) })]
            }));
        }
        batches
    }

    fn marks(&mut self, state: &mut State, layers: &Layers) -> Vec<Batch> {
        let results = state.results.clone();
        let longest_m = longest_m(&results);
        let lights = crate::panels::scene::asked_lights(state).into_owned();
        let (of_scene, of_estimate) = (Same(results.scene.clone()), Same(results.estimate.clone()));
        let of_model = Same(results.model.clone());
        let mut batches = Vec::new();
        if layers.sensors {
            let measure = layers.sensor_measure();
            let tint = Tint::Scaled(state.scale(measure));
            let exposed = Same(results.outdoors.sensors.clone());
            let key = (of_scene.clone(), of_estimate.clone(), exposed, measure);
            let (balls, normals) = self.sensors.get(key, |_| {
                let (balls, normals) = marks::sensors(&results, measure, longest_m);
                (Arc::new(balls), Arc::new(normals))
            });
            let least_px = if balls.len() > MANY_SENSORS { 2.5 } else { 4.0 };
            batches.push(Batch { tint, ..Batch::new(What::Balls { data: balls, least_px, most_px: 9.0 }) });
            batches.push(Batch { tint, ..Batch::new(What::Strokes { data: normals }) });
        }
        if layers.lights {
            batches.extend(self.lights.get((lights.clone(), longest_m), |_| marks::lights(&lights, longest_m)));
        }
        if let (true, Some(picked), Some(model)) = (layers.paths, state.picked, &results.model)
            && let Some(at_m) = marks::position_m(&results, &lights, picked)
        {
            let key = (of_model.clone(), state.ways.clone());
            let make = |_: &_| {
                let data = Arc::new(marks::ways(model, at_m, &state.ways));
                vec![Batch { on_top: true, ..Batch::new(What::Strokes { data }) }]
            };
            batches.extend(self.ways.get(key, make));
        }
        if let Some(picked) = state.picked {
            let key =
                (of_model.clone(), of_estimate.clone(), (of_scene.clone(), lights.clone(), Some(picked), layers.ball));
            let make = |_: &_| marks::picked(&results, &lights, picked, layers.ball, longest_m);
            batches.extend(self.picked.get(key, make));
        }
        if let Some(facade) = state.facade {
            batches.push(self.facade.get((facade, longest_m), |_| marks::facade(&facade, longest_m)));
        }
        if let Some(hovered) = state.hovered.filter(|hovered| Some(*hovered) != state.picked) {
            let without = Results { estimate: None, ..results.clone() };
            let make = |_: &_| marks::picked(&without, &lights, hovered, false, longest_m);
            batches.extend(
                self.hovered.get((of_model, of_estimate, (of_scene, lights.clone(), Some(hovered), false)), make),
            );
        }
        if let Some((at_m, length_m)) = state.gizmo {
            let make = |_: &_| {
                let data = Arc::new(marks::gizmo(at_m, length_m));
                Batch { on_top: true, ..Batch::new(What::Strokes { data }) }
            };
            batches.push(self.gizmo.get((at_m, length_m), make));
        }
        batches
    }
}

/// Called from another thread when there is something new to draw.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// The box around the scene, metres.
pub fn bounds_m(results: &Results) -> (Vec3, Vec3) {
    results.scene.as_ref().and_then(|scene| scene.mesh.bounds_m()).unwrap_or(NO_BOX)
}

/// The longest side of the scene, metres.
pub fn longest_m(results: &Results) -> f32 {
    let (low, high) = bounds_m(results);
    (high - low).max_element().max(1e-3)
}

/// What is cut away: above the ceiling, and beyond the free plane.
pub fn cuts(layers: &Layers, (low, high): (Vec3, Vec3)) -> Vec<Cut> {
    let above = Cut { normal: Vec3::Z, offset_m: low.z + layers.cut_share * (high.z - low.z) };
    let free = layers.section.map(|section| plane(section, (low, high)));
    layers.cut.then_some(above).into_iter().chain(free).collect()
}

/// The free plane, its share counted between the box's nearest and farthest corner along the normal.
fn plane(section: Section, (low, high): (Vec3, Vec3)) -> Cut {
    let [azimuth, elevation] = [section.azimuth_deg, section.elevation_deg].map(|degrees| degrees * PI / 180.0);
    let normal = Vec3::new(azimuth.cos() * elevation.cos(), azimuth.sin() * elevation.cos(), elevation.sin());
    let middle = normal.dot((low + high) / 2.0);
    let reach = normal.abs().dot((high - low) / 2.0);
    Cut { normal, offset_m: middle + (2.0 * section.share - 1.0) * reach }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_free_plane_sweeps_the_whole_box() {
        let bounds = (Vec3::new(-1.0, 0.0, 2.0), Vec3::new(3.0, 2.0, 4.0));
        let along_y = |share| plane(Section { azimuth_deg: 90.0, elevation_deg: 0.0, share }, bounds);
        for (share, want) in [(0.0, 0.0), (0.5, 1.0), (1.0, 2.0)] {
            let cut = along_y(share);
            assert!(cut.normal.distance(Vec3::Y) < 1e-6 && (cut.offset_m - want).abs() < 1e-5, "{cut:?}");
        }
        let slanted = plane(Section { azimuth_deg: 45.0, elevation_deg: 0.0, share: 1.0 }, bounds);
        let corner = slanted.normal.dot(Vec3::new(3.0, 2.0, 0.0));
        assert!((slanted.offset_m - corner).abs() < 1e-5);
    }

    #[test]
    fn layers_cut_only_where_they_are_told_to() {
        let bounds = (Vec3::ZERO, Vec3::splat(10.0));
        assert!(cuts(&Layers::default(), bounds).is_empty());
        let layers = Layers { cut: true, cut_share: 0.8, section: Some(Section::default()), ..Layers::default() };
        let cuts = cuts(&layers, bounds);
        assert_eq!((cuts[0].normal, cuts[0].offset_m, cuts.len()), (Vec3::Z, 8.0, 2));
    }
}
