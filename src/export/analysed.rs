//! Which files does an analysis make? One list, for whoever writes them.

use super::{field, graphml, plan, ply, skeleton_json, swc, voxels};
use crate::light::Field;
use crate::model::Model;
use crate::scene::Scene;
use glam::Vec3;
use std::io::{self, Write};

/// What was analysed.
#[derive(Debug, Clone, Copy)]
pub struct Analysed<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What was modelled of it.
    pub model: &'a Model,
    /// The field at its sensors.
    pub at_sensors: &'a Field,
    /// The field at the nodes of the skeleton, where the method answers there.
    pub at_nodes: Option<&'a Field>,
    /// Faces of the mesh (three corners each, metres) and the field on them, where the method answers there.
    pub at_faces: Option<(&'a [[Vec3; 3]], &'a Field)>,
}

/// Writes one file.
pub type Writer<'a> = Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>;

/// The files of an analysis, each by its name: voxels, the skeleton with the irradiance at its nodes, and the field at the sensors
/// and on the mesh.
pub fn files<'a>(analysed: &Analysed<'a>) -> Vec<(&'static str, Writer<'a>)> {
    let Analysed { scene, model, at_sensors, at_nodes, at_faces } = *analysed;
    let skeleton = &model.skeleton;
    let mut files: Vec<(&'static str, Writer)> = vec![
        ("voxels.npy", Box::new(|out| voxels::write_npy(out, &model.voxels))),
        ("voxels.json", Box::new(|out| voxels::write_legend(out, scene, &model.voxels))),
        ("skeleton.json", Box::new(move |out| skeleton_json::write(out, scene, skeleton, at_nodes))),
        ("skeleton.ply", Box::new(move |out| ply::write_skeleton(out, scene, skeleton, at_nodes))),
        ("skeleton.graphml", Box::new(|out| graphml::write(out, scene, skeleton))),
        ("skeleton.swc", Box::new(|out| swc::write(out, scene, skeleton))),
        ("field.csv", Box::new(|out| field::write_csv(out, scene, at_sensors))),
    ];
    if let Some(at_nodes) = at_nodes {
        files.push(("plan.svg", Box::new(|out| plan::write(out, scene, model, at_nodes))));
    }
    if let Some((faces_m, at_faces)) = at_faces {
        files.push(("field.ply", Box::new(|out| ply::write_mesh_field(out, scene, faces_m, at_faces))));
    }
    files
}
