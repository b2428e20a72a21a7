//! The scene that greets who starts the viewer bare: two rooms, a doorway and a lamp, made here so that no file is needed.

use glam::Vec3;
use lightvein::scene::parts::Part;
use lightvein::scene::{Light, Material, Mesh, Scene, Sensor};

/// Height of the rooms, metres.
const HIGH_M: f32 = 2.6;

/// Two rooms of 5 m x 4 m and 3 m x 4 m side by side, a door of 1 m x 2.1 m between them, a table in the first, and four
/// sensors.
pub fn scene() -> Scene {
    let mut mesh = Mesh::default();
    let mut names = Vec::new();
    let mut of_part = Vec::new();
    let mut part = |name: &str, low: Vec3, high: Vec3| {
        add_box(&mut mesh, low, high);
        of_part.push(names.len());
        names.push(name.to_owned());
    };
    // Walls 0.2 m thick around and between the rooms, floor and ceiling.
    let wall = 0.2;
    part("floor", Vec3::new(-wall, -wall, -wall), Vec3::new(8.0 + 2.0 * wall, 4.0 + wall, 0.0));
    part("ceiling", Vec3::new(-wall, -wall, HIGH_M), Vec3::new(8.0 + 2.0 * wall, 4.0 + wall, HIGH_M + wall));
    part("wall south", Vec3::new(-wall, -wall, 0.0), Vec3::new(8.0 + 2.0 * wall, 0.0, HIGH_M));
    part("wall north", Vec3::new(-wall, 4.0, 0.0), Vec3::new(8.0 + 2.0 * wall, 4.0 + wall, HIGH_M));
    part("wall west", Vec3::new(-wall, 0.0, 0.0), Vec3::new(0.0, 4.0, HIGH_M));
    part("wall east", Vec3::new(8.0 + wall, 0.0, 0.0), Vec3::new(8.0 + 2.0 * wall, 4.0, HIGH_M));
    part("partition south", Vec3::new(5.0, 0.0, 0.0), Vec3::new(5.0 + wall, 2.4, HIGH_M));
    part("partition north", Vec3::new(5.0, 3.4, 0.0), Vec3::new(5.0 + wall, 4.0, HIGH_M));
    part("lintel", Vec3::new(5.0, 2.4, 2.1), Vec3::new(5.0 + wall, 3.4, HIGH_M));
    part("table", Vec3::new(2.6, 0.8, 0.65), Vec3::new(4.2, 1.7, 0.75));

    mesh.material_of = vec![0; mesh.triangles.len()];
    let parts = names.into_iter().zip(of_part).map(|(name, number)| {
        let first = (TRIANGLES_A_BOX * number) as u32;
        Part { name, triangles: std::iter::once(first..first + TRIANGLES_A_BOX as u32).collect(), keeps_for_others: 0 }
    });
    let sensor = |id: &str, position_m: Vec3, normal: Option<Vec3>| Sensor { id: id.to_owned(), position_m, normal };
    Scene {
        name: "welcome".to_owned(),
        parts: parts.collect(),
        materials: vec![Material {
            name: "plaster".to_owned(),
            reflectance: 0.7,
            transmittance: 0.0,
            emission_w_m2_sr: 0.0,
        }],
        lights: vec![Light::Point { position_m: Vec3::new(1.2, 1.2, 2.2), flux_w: 100.0 }],
        sensors: vec![
            sensor("table", Vec3::new(3.4, 1.25, 0.77), Some(Vec3::Z)),
            sensor("under the table", Vec3::new(3.4, 1.25, 0.3), Some(Vec3::Z)),
            sensor("door", Vec3::new(5.1, 2.9, 1.2), None),
            sensor("next room", Vec3::new(7.2, 1.0, 0.8), Some(Vec3::Z)),
        ],
        mesh,
        ..Scene::default()
    }
}

const TRIANGLES_A_BOX: usize = 12;

/// A closed box, its faces turned outwards.
fn add_box(mesh: &mut Mesh, low: Vec3, high: Vec3) {
    let first = mesh.positions_m.len() as u32;
    let corner = |bits: u32| {
        let pick = |bit: u32, low: f32, high: f32| if bits >> bit & 1 == 1 { high } else { low };
        Vec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
    };
    mesh.positions_m.extend((0..8).map(corner));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    for [a, b, c, d] in quads.map(|quad: [u32; 4]| quad.map(|corner| first + corner)) {
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightvein::job::{Cancel, Quiet};
    use lightvein::model::Model;
    use lightvein::rays::Rays;
    use std::sync::Arc;

    #[test]
    fn it_has_two_rooms_and_a_doorway_and_its_boxes_face_outwards() {
        let scene = scene();
        let middles = scene.parts.iter().enumerate().map(|(part, _)| {
            let corners: Vec<Vec3> = scene.corners_of(part).collect();
            corners.iter().sum::<Vec3>() / corners.len() as f32
        });
        for (part, middle_m) in middles.enumerate() {
            for triangle in scene.triangles_of(part) {
                let [a, b, c] = scene.mesh.corners_m(triangle).unwrap();
                assert!((b - a).cross(c - a).dot(a - middle_m) > 0.0, "{}", scene.parts[part].name);
            }
        }
        let rays = Arc::new(Rays::new(&scene));
        let model = Model::build(&scene, rays, 0.1, u64::MAX, &Quiet, &Cancel::new()).unwrap();
        assert_eq!((model.skeleton.cells.len(), model.skeleton.necks.len()), (2, 1));
        assert!(model.voxels.warnings.is_empty(), "{:?}", model.voxels.warnings);
        assert!(model.probes_at_sensors(&scene).iter().all(|probe| probe.place.is_ok()));
        let sides = crate::sides::of(&scene.mesh, &crate::sides::Inside::of(&model.voxels, std::iter::empty()));
        let seen = |name: &str| {
            let part = scene.parts.iter().position(|part| part.name == name).unwrap();
            scene.triangles_of(part).filter(|&triangle| sides[triangle] != 0).count()
        };
        // Of an outer wall just the inner side is seen; of the table all.
        assert_eq!((seen("wall south"), seen("ceiling"), seen("table")), (2, 2, 12));
    }
}
