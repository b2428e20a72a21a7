//! Scenes made for one failure each, with their parameter: which, and what is asked of them.
//!
//! All are in metres, in multiples of the voxel where the voxel decides, of one grey material. Lights and sensors keep off
//! planes of symmetry unless that is the point.

use super::Failure;
use super::boxes::Boxes;
use crate::scene::{Light, Material, ModelChoice, Scene, Sensor};
use glam::Vec3;

/// A scene that shows a failure.
#[derive(Debug, Clone)]
pub struct Built {
    /// The failure.
    pub failure: Failure,
    /// Its parameter in words.
    pub case: String,
    /// The scene, with the voxel size to ask at.
    pub scene: Scene,
    /// Samples that its truth takes, in multiples of [`Trials::samples`](super::Trials::samples).
    pub samples_times: u32,
    /// Whether walls without any opening part lights from sensors, so that a truth of zero is one.
    pub is_shut: bool,
}

/// Reflectance of the walls, where nothing else is said.
const REFLECTANCE: f32 = 0.7;

/// Flux of each light, W.
const FLUX_W: f64 = 100.0;

/// Height of rooms, metres.
const HIGH_M: f32 = 2.5;

/// Every scene, for voxels of that size, in the order of [`Failure::ALL`].
pub fn all(voxel_m: f32) -> Vec<Built> {
    let made = [
        thin_walls(voxel_m),
        keyholes(voxel_m),
        openings(voxel_m),
        ties(voxel_m),
        vec![dead_end(), hall(), dark_rooms()],
        in_solids(),
        vec![separate_voids()],
        leaks(voxel_m),
        vec![floating_solids(voxel_m)],
        near_walls(voxel_m),
    ];
    let mut made = made.concat();
    for built in &mut made {
        built.scene.model.voxel_m.get_or_insert(voxel_m);
    }
    made
}

/// Two rooms of 3 x 3 m and a wall between them that is thinner than a voxel; sensors close behind it and in the middle.
fn thin_walls(voxel_m: f32) -> Vec<Built> {
    let half_m = 0.5 * voxel_m;
    let thick = Boxes::default().void([0.0; 3], [3.0, 3.0, HIGH_M]).void([3.0 + half_m, 0.0, 0.0], [6.0, 3.0, HIGH_M]);
    let whole = Boxes::default().void([0.0; 3], [6.0, 3.0, HIGH_M]);
    let cases = [
        ("half a voxel, shut", half_m, thick.clone()),
        ("no thickness, shut", 0.0, whole.clone().sheet([3.0, 0.0, 0.0], [3.0, 3.0, HIGH_M])),
        ("half a voxel, a door aside", half_m, thick.void([3.0, 2.1, 0.0], [3.0 + half_m, 3.0, 2.0])),
        (
            "no thickness, a door aside",
            0.0,
            whole.sheet([3.0, 0.0, 0.0], [3.0, 2.1, HIGH_M]).sheet([3.0, 2.1, 2.0], [3.0, 3.0, HIGH_M]),
        ),
    ];
    let built = cases.map(|(case, thick_m, boxes)| {
        let behind = |apart_m: f32| at([3.0 + thick_m + apart_m, 0.63, 1.17]);
        let sensors =
            [scalar(behind(0.2 * voxel_m)), scalar(behind(voxel_m)), scalar(behind(1.5)), behind_facing(behind)];
        built(Failure::ThinWall, case, boxes, &[[2.57, 0.71, 1.31]], sensors.into(), 16)
    });
    built.into()
}

/// A sensor on the far side of a wall that looks away from it.
fn behind_facing(behind: impl Fn(f32) -> Vec3) -> Sensor {
    planar(behind(0.001), Vec3::X)
}

/// Two rooms of 2 m and a square hole in the wall between them, of four voxels down to half a voxel.
fn keyholes(voxel_m: f32) -> Vec<Built> {
    // Light through a hole is as rare as the hole is small.
    let holes = [(4.0, 16), (2.0, 32), (1.0, 64), (0.5, 256)];
    let built = holes.map(|(voxels, times)| {
        let case = format!("hole of {voxels} voxel");
        let (boxes, sensors) = rooms_with_hole(voxels * voxel_m);
        built(Failure::Keyhole, &case, boxes, &[[0.55, 0.47, 1.43]], sensors, times)
    });
    built.into()
}

/// The same with a hole of four voxels, and voxels from the whole hole down to an eighth of it.
fn openings(voxel_m: f32) -> Vec<Built> {
    let hole_m = 4.0 * voxel_m;
    let built = [1.0, 2.0, 3.0, 4.0, 8.0].map(|voxels| {
        let case = format!("opening of {voxels} voxel");
        let (boxes, sensors) = rooms_with_hole(hole_m);
        let mut built = built(Failure::Opening, &case, boxes, &[[0.55, 0.47, 1.43]], sensors, 16);
        built.scene.model.voxel_m = Some(hole_m / voxels);
        built
    });
    built.into()
}

fn rooms_with_hole(side_m: f32) -> (Boxes, Vec<Sensor>) {
    let [y, z] = [1.03, 1.07];
    let half_m = 0.5 * side_m;
    let boxes = Boxes::default()
        .void([0.0; 3], [2.0, 2.0, 2.0])
        .void([2.2, 0.0, 0.0], [4.2, 2.0, 2.0])
        .void([2.0, y - half_m, z - half_m], [2.2, y + half_m, z + half_m]);
    let sensors = vec![scalar(at([3.2, 0.9, 0.9])), scalar(at([3.9, 1.6, 1.5])), planar(at([2.7, y, z]), Vec3::NEG_X)];
    (boxes, sensors)
}

/// A square ring of a corridor; sensors a quarter of a voxel apart, across the place where both ways round are equal: like
/// each other, and then one of them through a narrow place.
fn ties(voxel_m: f32) -> Vec<Built> {
    let ring = Boxes::default().void([0.0; 3], [6.0, 6.0, HIGH_M]).solid([1.6, 1.6, 0.0], [4.4, 4.4, HIGH_M]);
    let narrow = ring.clone().solid([0.0, 2.5, 0.0], [1.1, 3.5, HIGH_M]);
    let cases = [
        ("ways alike, the light in the middle", &ring, 3.0),
        ("ways alike, the light aside", &ring, 2.43),
        ("one way narrow", &narrow, 3.0),
    ];
    let built = cases.map(|(case, boxes, light_x)| {
        let tie_x = 6.0 - light_x;
        let sensors = (-20..=20).map(|step| scalar(at([tie_x + 0.25 * voxel_m * step as f32, 5.17, 1.21])));
        built(Failure::Tie, case, boxes.clone(), &[[light_x, 0.83, 1.61]], sensors.collect(), 8)
    });
    built.into()
}

/// A corridor with a branch of 6 m that ends; sensors along the branch to its end.
fn dead_end() -> Built {
    let boxes = Boxes::default().void([0.0; 3], [10.0, 1.6, HIGH_M]).void([4.0, 1.6, 0.0], [5.2, 7.6, HIGH_M]);
    let sensors = [0.6, 1.8, 3.0, 4.2, 5.4, 5.9].map(|deep_m| scalar(at([4.57, 1.6 + deep_m, 1.19])));
    built(Failure::DeadEnd, "6 m deep, 1.2 m wide", boxes, &[[1.53, 0.79, 1.71]], sensors.into(), 16)
}

fn hall() -> Built {
    let boxes = Boxes::default().void([0.0; 3], [40.0, 40.0, 4.0]);
    let light_m = at([5.31, 6.13, 3.11]);
    let away = Vec3::new(0.72, 0.69, 0.0);
    let sensors = [2.0, 5.0, 10.0, 20.0, 30.0, 45.0].map(|far_m| scalar((light_m + far_m * away).with_z(1.23)));
    built(Failure::Hall, "40 x 40 x 4 m", boxes, &[light_m.to_array()], sensors.into(), 4)
}

/// Five rooms in a row with doors on alternate sides, walls of reflectance 0.3; a sensor in each.
fn dark_rooms() -> Built {
    let mut boxes = Boxes::default();
    let mut sensors = Vec::new();
    for room in 0..5 {
        let [from, next] = [room, room + 1].map(|room| 3.2 * room as f32);
        let to = next - 0.2;
        boxes = boxes.void([from, 0.0, 0.0], [to, 3.0, HIGH_M]);
        if room < 4 {
            let y = if room % 2 == 0 { 0.2 } else { 1.9 };
            boxes = boxes.void([to, y, 0.0], [next, y + 0.9, 2.0]);
        }
        sensors.push(scalar(at([from + 1.57, 1.43, 0.97])));
    }
    let mut built = built(Failure::DarkRooms, "five rooms, reflectance 0.3", boxes, &[[1.13, 1.71, 1.83]], sensors, 64);
    built.scene.materials[0].reflectance = 0.3;
    built
}

/// A room with a pillar; sensors and then the light inside matter.
fn in_solids() -> Vec<Built> {
    let room = Boxes::default().void([0.0; 3], [4.0, 4.0, HIGH_M]).solid([1.5, 1.5, 0.0], [2.5, 2.5, HIGH_M]);
    let thin = Boxes::default().void([0.0; 3], [2.0, 2.0, HIGH_M]).void([2.1, 0.0, 0.0], [4.0, 2.0, HIGH_M]);
    let inside = [[2.03, 1.97, 1.21], [1.57, 2.03, 1.21], [5.03, 2.03, 1.21]].map(|place| scalar(at(place)));
    let open = [[0.71, 3.23, 1.21], [3.27, 3.31, 1.21]].map(|place| scalar(at(place)));
    let beside = [[0.93, 1.07, 1.21], [3.03, 0.93, 1.21]].map(|place| scalar(at(place)));
    vec![
        built(
            Failure::InSolid,
            "sensors in a pillar, in its skin, outside",
            room.clone(),
            &[[0.73, 0.67, 1.71]],
            inside.into(),
            1,
        ),
        built(Failure::InSolid, "the light in a pillar", room, &[[2.03, 1.97, 1.31]], open.into(), 1),
        built(Failure::InSolid, "the light in a wall of a voxel", thin, &[[2.05, 1.03, 1.31]], beside.into(), 1),
    ]
}

/// Three rooms that nothing joins, lights in two of them, a sensor in each.
fn separate_voids() -> Built {
    let boxes = (0..3).fold(Boxes::default(), |boxes, room| {
        let from = 3.3 * room as f32;
        boxes.void([from, 0.0, 0.0], [from + 3.0, 3.0, HIGH_M])
    });
    let sensors = [0, 1, 2].map(|room| scalar(at([3.3 * room as f32 + 1.93, 1.87, 0.93])));
    let lights = [[1.03, 0.97, 1.71], [4.37, 1.03, 1.67]];
    built(Failure::SeparateVoids, "three rooms, two lit", boxes, &lights, sensors.into(), 1)
}

/// A room without a lid, and one with a crack in it.
fn leaks(voxel_m: f32) -> Vec<Built> {
    let cracks = [("no lid", 3.0), ("a crack of half a voxel in the lid", 0.5 * voxel_m)];
    let built = cracks.map(|(case, crack_m)| {
        let boxes = Boxes::default().void([0.0; 3], [3.0, 3.0, HIGH_M]);
        let sensors = [[1.93, 1.87, 0.93], [0.63, 2.47, 1.93], [2.53, 0.41, 0.23]].map(|place| scalar(at(place)));
        let mut built = built(Failure::Leak, case, boxes, &[[1.03, 0.97, 1.71]], sensors.into(), 1);
        let mesh = &mut built.scene.mesh;
        let is_lid = |triangle: &[u32; 3]| triangle.iter().all(|&corner| mesh.positions_m[corner as usize].z == HIGH_M);
        mesh.triangles.retain(|triangle| !is_lid(triangle));
        mesh.material_of.truncate(mesh.triangles.len());
        if crack_m < 3.0 {
            let first = mesh.positions_m.len() as u32;
            let half_m = 0.5 * crack_m;
            let lid = Boxes::default()
                .sheet([0.0, 0.0, HIGH_M], [1.5 - half_m, 3.0, HIGH_M])
                .sheet([1.5 + half_m, 0.0, HIGH_M], [3.0, 3.0, HIGH_M]);
            let lid = lid.mesh();
            mesh.positions_m.extend(lid.positions_m);
            mesh.triangles.extend(lid.triangles.iter().map(|triangle| triangle.map(|corner| corner + first)));
            mesh.material_of.extend(lid.material_of);
        }
        built
    });
    built.into()
}

/// A room with a block and a plate of half a voxel that hang in the air; sensors in their shadows and in the light.
fn floating_solids(voxel_m: f32) -> Built {
    let boxes = Boxes::default()
        .void([0.0; 3], [4.0, 4.0, HIGH_M])
        .solid([1.6, 1.6, 0.9], [2.2, 2.2, 1.5])
        .solid([2.6, 1.0, 1.2], [3.4, 2.0, 1.2 + 0.5 * voxel_m]);
    let places = [[2.73, 2.81, 0.83], [3.07, 1.53, 0.93], [3.03, 1.47, 1.63], [0.83, 2.91, 1.23]];
    built(
        Failure::FloatingSolid,
        "a block and a thin plate",
        boxes,
        &[[0.71, 0.87, 1.89]],
        places.map(|place| scalar(at(place))).into(),
        1,
    )
}

/// A room with a light from a voxel off the wall down to on it.
fn near_walls(voxel_m: f32) -> Vec<Built> {
    let built = [1.0, 0.5, 0.1, 0.0].map(|voxels| {
        let case = format!("light {voxels} voxel off");
        let boxes = Boxes::default().void([0.0; 3], [4.0, 3.0, HIGH_M]);
        let places = [[0.57, 2.13, 1.83], [1.73, 1.27, 0.63], [3.43, 2.37, 1.93], [2.03, 0.31, 2.17]];
        let light_m = [voxels * voxel_m, 1.43, 1.31];
        built(Failure::NearWall, &case, boxes, &[light_m], places.map(|place| scalar(at(place))).into(), 16)
    });
    built.into()
}

fn built(
    failure: Failure,
    case: &str,
    boxes: Boxes,
    lights_m: &[[f32; 3]],
    sensors: Vec<Sensor>,
    samples_times: u32,
) -> Built {
    let grey =
        Material { name: "grey".to_owned(), reflectance: REFLECTANCE, transmittance: 0.0, emission_w_m2_sr: 0.0 };
    let lights = lights_m.iter().map(|&place| Light::Point { position_m: at(place), flux_w: FLUX_W }).collect();
    let sensors = sensors.into_iter().enumerate().map(|(number, sensor)| Sensor { id: format!("s{number}"), ..sensor });
    let scene = Scene {
        name: "built in".to_owned(),
        mesh: boxes.mesh(),
        materials: vec![grey],
        lights,
        sensors: sensors.collect(),
        model: ModelChoice::default(),
        ..Scene::default()
    };
    let is_shut = matches!(failure, Failure::InSolid | Failure::SeparateVoids) || case.ends_with("shut");
    Built { failure, case: case.to_owned(), scene, samples_times, is_shut }
}

fn at(place: [f32; 3]) -> Vec3 {
    Vec3::from_array(place)
}

fn scalar(position_m: Vec3) -> Sensor {
    Sensor { id: String::new(), position_m, normal: None }
}

fn planar(position_m: Vec3, normal: Vec3) -> Sensor {
    Sensor { id: String::new(), position_m, normal: Some(normal) }
}
