//! The files that are written say what the skeleton and the field are: read back by other means, nothing is lost.

use super::modelled::{model, scene};
use lightvein::export::{field, graphml, ply, skeleton_json, swc, voxels};
use lightvein::flow::backward;
use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Field, Settings};
use lightvein::model::{Model, Probe};
use lightvein::scene::Scene;
use ndarray::Array3;
use ndarray_npy::ReadNpyExt;
use serde_json::Value;
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::sync::LazyLock;

/// The gallery: its skeleton has loops and necks.
static GALLERY: LazyLock<(Scene, Model)> = LazyLock::new(|| {
    let scene = scene("gallery");
    let model = model(&scene);
    (scene, model)
});

fn bytes(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    bytes
}

fn text(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> String {
    String::from_utf8(bytes(write)).unwrap()
}

fn estimated(model: &Model, probes: &[Probe]) -> Field {
    backward::estimate(model, probes, &Settings::default(), &Quiet, &Cancel::new()).unwrap()
}

#[test]
fn swc_is_a_forest_and_names_the_edges_that_close_loops() {
    let (scene, model) = &*GALLERY;
    let text = text(|out| swc::write(out, scene, &model.skeleton));
    let (mut seen, mut roots) = (BTreeSet::new(), 0);
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let fields: Vec<f64> = line.split(' ').map(|field| field.parse().unwrap()).collect();
        let [id, _, _, _, _, radius, parent] = fields[..] else { panic!("{line}") };
        assert!(seen.insert(id as i64) && radius > 0.0);
        match parent as i64 {
            -1 => roots += 1,
            parent => assert!(seen.contains(&parent), "{line} stands before its parent"),
        }
    }
    let shape = model.skeleton.shape();
    assert_eq!((seen.len(), roots), (model.skeleton.graph.node_count(), shape.components));
    assert_eq!(text.lines().filter(|line| line.starts_with("# loop: ")).count(), shape.loops);
    assert!(shape.loops > 0);
}

#[test]
fn skeleton_json_holds_nodes_edges_cells_and_necks() {
    let (scene, model) = &*GALLERY;
    let skeleton = &model.skeleton;
    let at_nodes = estimated(model, &model.probes_at_nodes());
    let json: Value =
        serde_json::from_slice(&bytes(|out| skeleton_json::write(out, scene, skeleton, Some(&at_nodes)))).unwrap();
    let rows = |key: &str| json[key].as_array().unwrap();
    for (number, node) in skeleton.graph.node_weights().enumerate() {
        let row = &rows("nodes")[number];
        let want = scene.to_user_m(node.position_m).to_array();
        assert!((0..3).all(|axis| (row["position"][axis].as_f64().unwrap() - want[axis]).abs() < 1e-9));
        assert_eq!((row["id"].as_u64(), row["cell"].as_u64()), (Some(number as u64), Some(node.cell.into())));
        let want_w_m2 = at_nodes.readings[number].value_w_m2;
        assert!((row["irradiance"].as_f64().unwrap() - want_w_m2).abs() < 1e-12 * want_w_m2);
    }
    assert_eq!(rows("nodes").len(), skeleton.graph.node_count());
    for (row, edge) in rows("edges").iter().zip(skeleton.graph.raw_edges()) {
        let ends = [edge.source(), edge.target()].map(|end| Some(end.index() as u64));
        assert_eq!([row["ends"][0].as_u64(), row["ends"][1].as_u64()], ends);
        assert_eq!(row["neck"].as_u64(), edge.weight.neck.map(u64::from));
    }
    let counts = ["edges", "cells", "necks"].map(|key| rows(key).len());
    assert_eq!(counts, [skeleton.graph.edge_count(), skeleton.cells.len(), skeleton.necks.len()]);
}

#[test]
fn graphml_declares_every_key_it_uses() {
    let (scene, model) = &*GALLERY;
    let text = text(|out| graphml::write(out, scene, &model.skeleton));
    let graph = &model.skeleton.graph;
    let count = |mark: &str| text.matches(mark).count();
    assert_eq!((count("<node "), count("<edge ")), (graph.node_count(), graph.edge_count()));
    assert_eq!(
        (count("<data "), count("<data ")),
        (count("</data>"), 6 * count("<node ") + 2 * count("<edge ") + count("key=\"neck\""))
    );
    let declared: BTreeSet<&str> =
        text.split("<key id=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    let used: BTreeSet<&str> = text.split("<data key=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    assert_eq!(declared, used);
    let crossing = graph.edge_weights().filter(|edge| edge.neck.is_some()).count();
    assert!(crossing > 0 && count("key=\"neck\"") == crossing);
}

#[test]
fn the_ply_of_the_mesh_reads_back_as_the_faces_that_were_asked() {
    let (scene, model) = &*GALLERY;
    let faces_m = model.faces_to_void(scene);
    let at_faces = estimated(model, &model.probes_at_faces(&faces_m));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("field.ply");
    std::fs::write(&path, bytes(|out| ply::write_mesh_field(out, scene, &faces_m, &at_faces))).unwrap();
    let read = Scene::load(&path, &Quiet, &Cancel::new()).unwrap();
    assert_eq!(read.mesh.triangles.len(), faces_m.len());
    for (triangle, face_m) in faces_m.iter().enumerate() {
        let corners_m = read.mesh.corners_m(triangle).unwrap();
        for (found, want) in corners_m.iter().zip(face_m) {
            assert!(read.to_user_m(*found).distance(scene.to_user_m(*want)) < 1e-5);
        }
    }
}

#[test]
fn the_ply_of_the_skeleton_has_the_rows_it_announces() {
    let (scene, model) = &*GALLERY;
    let graph = &model.skeleton.graph;
    let text = text(|out| ply::write_skeleton(out, scene, &model.skeleton, None));
    let (head, body) = text.split_once("end_header\n").unwrap();
    assert!(head.contains(&format!("element vertex {}\n", graph.node_count())));
    assert!(head.contains(&format!("element edge {}\n", graph.edge_count())));
    let rows: Vec<usize> = body.lines().map(|line| line.split(' ').count()).collect();
    assert_eq!(rows, [vec![5; graph.node_count()], vec![4; graph.edge_count()]].concat());
}

#[test]
fn voxels_read_back_as_the_solid_and_the_void() {
    let (scene, model) = &*GALLERY;
    let bytes_of_array = bytes(|out| voxels::write_npy(out, &model.voxels));
    let array = Array3::<u8>::read_npy(&bytes_of_array[..]).unwrap();
    assert_eq!(array.shape(), model.voxels.lattice.size);
    let count = |kind: u8| array.iter().filter(|&&found| found == kind).count();
    assert_eq!((count(1), count(2)), (model.voxels.solid.count(), model.voxels.void.count()));
    assert!(model.voxels.void.iter().all(|voxel| array[voxel.0.as_usizevec3().to_array()] == 2));

    let legend: Value = serde_json::from_slice(&bytes(|out| voxels::write_legend(out, scene, &model.voxels))).unwrap();
    assert_eq!(legend["units"], "m");
    let origin_m = scene.to_user_m(model.voxels.lattice.origin_m);
    assert!((legend["origin_m"][0].as_f64().unwrap() - origin_m.x).abs() < 1e-9);
}

#[test]
fn the_field_has_a_row_for_each_sensor() {
    let (scene, model) = &*GALLERY;
    let at_sensors = estimated(model, &model.probes_at_sensors(scene));
    let text = text(|out| field::write_csv(out, scene, &at_sensors));
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), scene.sensors.len());
    for ((row, sensor), reading) in rows.iter().zip(&scene.sensors).zip(&at_sensors.readings) {
        assert_eq!((&row[0], &row[12]), (&*sensor.id, "ok"));
        assert_eq!(row[7].parse::<f64>().unwrap(), reading.value_w_m2);
        assert_eq!(row[1].parse::<f64>().unwrap(), scene.to_user_m(sensor.position_m).x);
    }
}
