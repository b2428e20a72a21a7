//! What is a mesh without a scene file lit by, and where is it asked?

use super::Model;
use crate::scene::{Light, Scene, Sensor};
use crate::skeleton::Cell;
use crate::space::VoxelIndex;
use glam::{IVec3, Vec3};

/// Flux of the light that is put into a bare mesh, W: a bright household lamp.
const BARE_FLUX_W: f64 = 100.0;

/// Puts a scalar sensor in the middle of every cell of a mesh that came without a scene file, and, where none of its own
/// faces shine, a point light in the middle of the largest; says so in the scene's warnings.
pub fn light_bare_mesh(scene: &mut Scene, model: Model) -> Model {
    let cells = &model.skeleton.cells;
    let largest = cells.iter().enumerate().max_by(|(_, a), (_, b)| a.volume_m3.total_cmp(&b.volume_m3));
    let Some((number, largest)) = largest else {
        scene.warnings.push("the mesh encloses no void that a light could stand in".to_owned());
        return model;
    };
    let sensor = |(number, cell): (usize, &Cell)| Sensor {
        id: format!("cell {number}"),
        position_m: middle_m(&model, cell),
        normal: None,
    };
    scene.sensors = cells.iter().enumerate().map(sensor).collect();
    if !model.sources.emitters.is_empty() {
        scene
            .warnings
            .push("a bare mesh: its own faces shine, and a sensor stands in the middle of each cell".to_owned());
        return model;
    }

    let position_m = middle_m(&model, largest);
    // Where the light itself stands there is no telling how bright it is.
    if let Some(beside) = scene.sensors.get_mut(number) {
        let radius_m = model.skeleton.graph.node_weight(largest.centre).map_or(0.0, |node| node.radius_m);
        beside.position_m -= 0.5 * radius_m * Vec3::Z;
    }
    scene.lights = vec![Light::Point { position_m, flux_w: BARE_FLUX_W }];
    scene.warnings.push(format!(
        "a bare mesh: a light of {BARE_FLUX_W} W stands at {:.3} in the middle of its largest cell ({number}), a sensor half \
         way from there to the nearest wall, downwards, and one in the middle of each other cell",
        scene.to_user_m(position_m)
    ));
    model.lit(scene)
}

/// The middle of a cell, metres: that of a void voxel at its central node, which itself may lie on the border of the grid.
fn middle_m(model: &Model, cell: &Cell) -> Vec3 {
    let node_m = model.node_m(cell.centre);
    let corner = model.voxels.lattice.point_in_grid(node_m).round().as_ivec3();
    let mut around = (0..8).map(|i| VoxelIndex(corner - IVec3::new(i & 1, i >> 1 & 1, i >> 2)));
    let voxel = around.find(|&voxel| model.voxels.void.get(voxel));
    voxel.map_or(node_m, |voxel| model.voxels.lattice.centre_m(voxel))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use crate::rays::Rays;
    use crate::voxel::test_scenes::{boxed, scene_of};
    use std::sync::Arc;

    fn lit(mut scene: Scene) -> (Scene, Model) {
        let rays = Arc::new(Rays::new(&scene));
        let model = Model::build(&scene, rays, 0.1, u64::MAX, &Quiet, &Cancel::new()).unwrap();
        let model = light_bare_mesh(&mut scene, model);
        (scene, model)
    }

    #[test]
    fn a_room_gets_a_light_in_its_middle_and_a_sensor_under_it() {
        let (scene, model) = lit(scene_of(&boxed(Vec3::ZERO, Vec3::new(4.0, 3.0, 2.0))));
        let [Light::Point { position_m, .. }] = scene.lights[..] else { panic!("{:?}", scene.lights) };
        assert!(position_m.distance(Vec3::new(2.0, 1.5, 1.0)) < 1.1, "{position_m}");
        assert!(model.shining[0].place.is_ok() && model.voxels.void.get(model.voxels.lattice.voxel_at(position_m)));
        let apart_m = position_m.z - scene.sensors[0].position_m.z;
        assert!((0.4..0.6).contains(&apart_m), "{apart_m}");
        assert!(model.probes_at_sensors(&scene)[0].place.is_ok());
    }

    #[test]
    fn faces_that_shine_are_light_enough() {
        let mut scene = scene_of(&boxed(Vec3::ZERO, Vec3::splat(2.0)));
        scene.mesh.material_of[0] = 1;
        scene.materials.push(crate::scene::Material { emission_w_m2_sr: 5.0, ..scene.materials[0].clone() });
        let (scene, model) = lit(scene);
        assert!(scene.lights.is_empty() && scene.sensors.len() == 1);
        assert_eq!(model.sources.emitters.len(), 1);
    }

    #[test]
    fn a_mesh_that_encloses_nothing_is_lit_from_outside() {
        let plate = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let (scene, model) = lit(scene_of(&[plate]));
        assert!(model.shining[0].place.is_ok(), "{:?}", model.shining);
        assert!(scene.warnings[0].contains("a bare mesh"), "{:?}", scene.warnings);
    }
}
