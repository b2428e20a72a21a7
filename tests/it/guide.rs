//! What a renderer is seeded with: whole scenes, the files, and the command.

use super::modelled::{model, scene};
use super::program::{json, lightvein, run, text};
use glam::Vec3;
use lightvein::export::guide::{Guided, files};
use lightvein::flow::network::{self, Quality};
use lightvein::guide::{Guide, Seeded, guide};
use lightvein::job::{Cancel, Quiet};
use lightvein::light::{MOST_LOBES, Settings};
use lightvein::model::Model;
use lightvein::scene::Scene;
use ndarray::{Array2, Array3};
use ndarray_npy::ReadNpyExt;
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

const ALL_FILES: [&str; 13] = [
    "cache.csv",
    "guide.json",
    "necks.ply",
    "nodes.npy",
    "nodes_lights.npy",
    "nodes_lobes.npy",
    "probes.csv",
    "samples.npy",
    "vpls.csv",
    "vpls.ply",
    "walls.npy",
    "walls_lights.npy",
    "walls_lobes.npy",
];

fn seeded(model: &Model) -> Seeded<'_> {
    guide(model, &Quality::MEDIUM, &Settings::default(), &Quiet, &Cancel::new()).expect("nobody stops it")
}

/// All files of a guide, by name.
fn written(scene: &Scene, model: &Model, guide: &Guide) -> Vec<(&'static str, Vec<u8>)> {
    let guided = Guided { scene, model, guide };
    let bytes = |(name, write): (&'static str, lightvein::export::analysed::Writer)| {
        let mut bytes = Vec::new();
        write(&mut bytes).unwrap();
        (name, bytes)
    };
    files(guided).into_iter().map(bytes).collect()
}

#[test]
fn places_belong_to_patches_and_their_parts_add_up() {
    for name in ["two_rooms", "gallery", "cave"] {
        let scene = scene(name);
        let model = model(&scene);
        let seeded = seeded(&model);
        let (guide, grounds) = (&seeded.guide, &seeded.known.network.grounds);
        assert_eq!(guide.nodes.len(), model.skeleton.graph.node_count(), "{name}");
        assert_eq!(guide.walls.len(), grounds.patches.list.len(), "{name}");
        assert_eq!(guide.walls.len(), guide.cache.len(), "{name}");

        // One wall place a patch, in their order, at one of its points; and asked for that point it is the one that answers.
        let mut own = 0;
        for (number, (place, patch)) in guide.walls.iter().zip(&grounds.patches.list).enumerate() {
            let (at_m, normal) = (place.incident.position_m, place.incident.normal.expect("on a wall"));
            let starts = &grounds.patches.starts[patch.starts.clone()];
            assert!(starts.iter().any(|start| start.position_m == at_m && start.normal == normal), "{name}: {number}");
            own += usize::from(seeded.known.place_of(at_m, Some(normal)) == Some(number as u32));
        }
        assert!(own * 10 > 8 * guide.walls.len(), "{name}: {own} of {} speak for themselves", guide.walls.len());

        let cells = model.skeleton.cells.len() as u32;
        for place in guide.walls.iter().chain(&guide.nodes) {
            let incident = &place.incident;
            let direct_w_m2: f32 = incident.direct_w_m2.iter().sum();
            let sum: f32 = place.shares.iter().sum();
            assert!(place.cell < cells && place.scalar_w_m2.is_finite(), "{name}: {place:?}");
            assert!((sum - 1.0).abs() < 1e-4 || direct_w_m2 + incident.reflected_w_m2 == 0.0, "{name}: {place:?}");
            assert!(incident.lobes.len() <= MOST_LOBES, "{name}");
            // Over a hemisphere or the sphere, scalar irradiance is no less than what falls on a surface.
            assert!(place.scalar_w_m2 * 1.3 >= direct_w_m2, "{name}: {place:?}");
        }
        for at in guide.probes.iter().map(|probe| probe.position_m) {
            let place = seeded.known.place_of(at, None).expect("probes stand in the void") as usize;
            assert!(
                place >= guide.walls.len() && place < seeded.known.walls.len() + seeded.known.zones.len(),
                "{name}"
            );
        }
    }
}

#[test]
fn virtual_lights_carry_all_that_is_reflected() {
    let scene = scene("gallery");
    let model = model(&scene);
    let guide = seeded(&model).guide;
    let sent_w: f64 = guide.vpls.iter().map(|light| light.flux_w).sum();
    // A grey room of reflectance rho reflects rho / (1 - rho) of its light in all, if nothing is lost.
    let flux_w = model.sources.flux_w();
    let mean: f64 =
        guide.reflectances.iter().map(|&share| f64::from(share)).sum::<f64>() / guide.reflectances.len() as f64;
    let want_w = flux_w * mean / (1.0 - mean);
    assert!((sent_w / want_w - 1.0).abs() < 0.05, "{sent_w} W for {want_w} W at reflectance {mean}");
    assert!((900..1200).contains(&guide.vpls.len()), "{}", guide.vpls.len());
}

/// A closed grey room, where the light that was reflected is nearly even: Phi rho / (A (1 - rho)).
#[test]
fn a_furnace_is_even_in_every_form() {
    let scene = scene("furnace");
    let model = model(&scene);
    let guide = seeded(&model).guide;
    let reflectance = f64::from(guide.reflectances[0]);
    let even_w_m2 = model.sources.flux_w() * reflectance / ((1.0 - reflectance) * model.walls.area_m2());
    let middle = |mut values: Vec<f32>| {
        values.sort_by(f32::total_cmp);
        f64::from(values[values.len() / 2])
    };
    let near =
        |found: f64, want: f64, what: &str| assert!((found / want - 1.0).abs() < 0.1, "{what}: {found} for {want}");
    near(middle(guide.cache.iter().map(|record| record.reflected_w_m2).collect()), even_w_m2, "walls");
    // The room's middle is nearer to the bright spots than its walls are.
    let scalar_w_m2 = middle(guide.nodes.iter().map(|place| place.incident.reflected_w_m2).collect());
    assert!((1.0..1.2).contains(&(scalar_w_m2 / (4.0 * even_w_m2))), "{scalar_w_m2} for {even_w_m2}");
    let radiance = |sample: &lightvein::guide::TrainingSample| sample.weight_w_m2 * sample.density_per_sr;
    let reflected = guide.samples.iter().filter(|sample| sample.flags == 0);
    // What walls send out has the direct light too, once.
    let sent_w_m2_sr = model.sources.flux_w() / model.walls.area_m2() * reflectance / (1.0 - reflectance) / PI;
    let mean = reflected.clone().map(|sample| f64::from(radiance(sample))).sum::<f64>() / reflected.count() as f64;
    near(mean, sent_w_m2_sr, "samples");
}

/// The network, asked at the nodes for all light, says what the guide says of them.
#[test]
fn nodes_have_the_light_that_the_network_reads_there() {
    let scene = scene("gallery");
    let model = model(&scene);
    let found = seeded(&model).guide.nodes;
    let read = network::with(Quality::MEDIUM.read());
    let wanted = read(&model, &model.probes_at_nodes(), &Settings::default(), &Quiet, &Cancel::new()).unwrap();
    let mut off = 0.0;
    for (place, reading) in found.iter().zip(&wanted.readings) {
        off += (f64::from(place.scalar_w_m2) / reading.value_w_m2).ln().powi(2) / found.len() as f64;
    }
    assert!(off.sqrt() < 0.05, "rms factor {}", off.sqrt().exp());
}

#[test]
fn any_number_of_threads_writes_the_same_files() {
    let scene = scene("gallery");
    let files = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let model = model(&scene);
            written(&scene, &model, &seeded(&model).guide)
        })
    });
    for other in &files[1..] {
        for ((name, bytes), (_, same)) in files[0].iter().zip(other) {
            assert!(bytes == same, "{name} differs");
        }
    }
}

#[test]
fn the_files_are_what_the_document_says() {
    let scene = scene("gallery");
    let model = model(&scene);
    let guide = seeded(&model).guide;
    let files = written(&scene, &model, &guide);
    let mut names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    names.sort_unstable();
    assert_eq!(names, ALL_FILES);
    let bytes = |name: &str| &files.iter().find(|(file, _)| *file == name).unwrap().1[..];
    let table = |name: &str| text(bytes(name)).lines().map(str::to_owned).collect::<Vec<_>>();

    let document: Value = serde_json::from_slice(bytes("guide.json")).unwrap();
    let emitters = model.sources.emitters.len();
    let (walls, nodes) = (guide.walls.len(), guide.nodes.len());
    let shapes = [
        ("walls.npy", vec![walls, 13]),
        ("nodes.npy", vec![nodes, 8]),
        ("walls_lobes.npy", vec![walls, 4, 6]),
        ("nodes_lobes.npy", vec![nodes, 4, 6]),
        ("walls_lights.npy", vec![walls, emitters, 2]),
        ("nodes_lights.npy", vec![nodes, emitters, 2]),
        ("samples.npy", vec![guide.samples.len(), 10]),
    ];
    for (name, shape) in shapes {
        let described = &document["arrays"][name];
        let columns = described["columns"].as_array().unwrap();
        assert_eq!(Some(&columns.len()), shape.last(), "{name}");
        assert_eq!(columns.len(), described["units"].as_array().unwrap().len(), "{name}");
        let found = match (shape.len(), described["type"].as_str().unwrap()) {
            (2, "float64") => Array2::<f64>::read_npy(bytes(name)).unwrap().shape().to_vec(),
            (2, "float32") => Array2::<f32>::read_npy(bytes(name)).unwrap().shape().to_vec(),
            _ => Array3::<f32>::read_npy(bytes(name)).unwrap().shape().to_vec(),
        };
        assert_eq!(found, shape, "{name}");
    }
    assert_eq!(document["emitters"].as_array().unwrap().len(), emitters);
    assert_eq!(document["cells"].as_u64(), Some(model.skeleton.cells.len() as u64));
    for (neck, found) in guide.necks.iter().zip(document["necks"].as_array().unwrap()) {
        let outline: Vec<Vec3> = neck.outline_m.clone();
        let middle_m = outline.iter().sum::<Vec3>() / outline.len() as f32;
        let next = outline.iter().cycle().skip(1);
        let area = outline.iter().zip(next).map(|(a, b)| 0.5 * (a - middle_m).cross(b - middle_m)).sum::<Vec3>();
        assert!((area.length() / neck.area_m2 - 1.0).abs() < 1e-3 && neck.flux_w.iter().all(|flux_w| *flux_w > 0.0));
        assert_eq!(found["outline"].as_array().unwrap().len(), outline.len());
        // The reader of JSON is right to the last digit but one.
        assert!((found["flux_w"][1].as_f64().unwrap() / neck.flux_w[1] - 1.0).abs() < 1e-12);
    }

    // The user's own coordinates, and the values of the structures.
    let found = Array2::<f64>::read_npy(bytes("walls.npy")).unwrap();
    let at = scene.to_user_m(guide.walls[7].incident.position_m);
    assert_eq!([found[[7, 0]], found[[7, 1]], found[[7, 2]]], at.to_array());
    assert_eq!(found[[7, 9]], f64::from(guide.cache[7].irradiance_w_m2));
    let lobes = Array3::<f32>::read_npy(bytes("walls_lobes.npy")).unwrap();
    let lights = Array3::<f32>::read_npy(bytes("walls_lights.npy")).unwrap();
    for (number, place) in guide.walls.iter().enumerate() {
        let weights: Vec<f32> = (0..4).map(|lobe| lobes[[number, lobe, 4]]).collect();
        let known: f32 = place.incident.lobes.iter().map(|lobe| lobe.weight).sum();
        assert!((weights.iter().sum::<f32>() - known).abs() < 1e-6, "{weights:?}");
        assert_eq!(lights[[number, 0, 1]], place.shares[0]);
    }
    assert_eq!(table("vpls.csv").len(), 1 + guide.vpls.len());
    assert_eq!(table("probes.csv").len(), 1 + guide.probes.len());
    assert_eq!(table("cache.csv").len(), 1 + walls);
    assert!(table("vpls.csv")[0].starts_with("x_m,y_m,z_m,nx,ny,nz,flux_w"));
    assert!(table("probes.csv")[0].starts_with("x_m,y_m,z_m,radius_m,cell,sh00_w_m2_sr"));
    let ply = table("necks.ply");
    let rows = ply.len() - 1 - ply.iter().position(|line| line == "end_header").unwrap();
    assert_eq!(rows, guide.necks.iter().map(|neck| neck.outline_m.len() + 1).sum::<usize>());
}

#[test]
fn a_raised_flag_stops_it() {
    let cancel = Cancel::new();
    let scene = scene("two_rooms");
    let model = model(&scene);
    cancel.cancel();
    assert!(guide(&model, &Quality::COARSE, &Settings::default(), &Quiet, &cancel).is_err());
}

#[test]
fn the_command_writes_its_files_and_speaks_its_json() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("made/for/it");
    let path = out.to_str().unwrap();
    let (report, stderr) = json(&["guide", "scenes/gallery/gallery.toml", "-o", path]);
    let mut keys: Vec<&str> = report.as_object().unwrap().keys().map(String::as_str).collect();
    keys.sort_unstable();
    assert_eq!(keys, ["files", "necks", "nodes", "seconds", "vpls", "wall_points"]);
    let mut named: Vec<&str> = report["files"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    named.sort_unstable();
    assert_eq!(named, ALL_FILES);
    let mut there: Vec<String> =
        fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    there.sort();
    assert_eq!(there, ALL_FILES);
    assert!(report["seconds"].as_f64().unwrap() > 0.0 && report["necks"].as_u64().unwrap() > 0);
    assert!(stderr.contains("wrote") && !stderr.contains("no sensor"), "{stderr}");

    let told = run(&["guide", "scenes/two_rooms/two_rooms.toml", "--voxel", "0.2", "-o", path]);
    assert!(told.status.success() && text(&told.stdout).contains("points on walls"), "{}", text(&told.stderr));
}

#[test]
fn wrong_usage_and_bad_input_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let path = out.to_str().unwrap();
    let refused = |arguments: &[&str], code: i32, says: &str| {
        let output = lightvein(arguments).output().unwrap();
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{stderr}");
        assert!(stderr.contains(says) && !out.exists(), "{stderr}");
    };
    refused(&["guide", "scenes/gallery/gallery.toml"], 2, "--output");
    refused(&["guide", "-o", path], 2, "SCENE");
    refused(&["guide", "no/such.toml", "-o", path], 1, "no/such.toml");
    refused(&["guide", "scenes/gallery/gallery.toml", "--tolerance", "2", "-o", path], 2, "--tolerance");
}

/// Real meshes: open ones, ones with slivers, and 78 lamps.
#[test]
fn real_scenes_have_finite_seeds_in_every_room() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, mesh) in [("quake_dm4", "quake/dm4_solid.obj"), ("cornell_original", "cornell/CornellBox-Original.obj")]
    {
        if !root.join("../shared/data").join(mesh).exists() {
            println!("skipped: ../shared/data/{mesh} is not there");
            continue;
        }
        let path = root.join(format!("scenes/real/{name}.toml"));
        let scene = Scene::load(&path, &Quiet, &Cancel::new()).unwrap();
        let model = model(&scene);
        let guide = guide(&model, &Quality::COARSE, &Settings::default(), &Quiet, &Cancel::new()).unwrap().guide;
        for cell in 0..model.skeleton.cells.len() as u32 {
            assert!(guide.walls.iter().any(|place| place.cell == cell), "{name}: no wall point in {cell}");
            assert!(guide.probes.iter().any(|probe| probe.cell == cell), "{name}: no probe in {cell}");
        }
        let numbers = (guide.walls.iter().chain(&guide.nodes))
            .flat_map(|place| [place.scalar_w_m2, place.incident.reflected_w_m2])
            .chain(guide.cache.iter().flat_map(|record| [record.irradiance_w_m2, record.radius_m]))
            .chain(guide.probes.iter().flat_map(|probe| probe.sh_w_m2_sr.into_iter().take(1)))
            .chain(guide.samples.iter().flat_map(|sample| [sample.weight_w_m2, sample.density_per_sr]))
            .chain(guide.vpls.iter().map(|light| light.flux_w as f32))
            .chain(guide.necks.iter().flat_map(|neck| neck.flux_w.map(|flux_w| flux_w as f32)));
        for (number, found) in numbers.enumerate() {
            assert!(found.is_finite() && found >= 0.0, "{name}: number {number} is {found}");
        }
        // More is reflected than lands at first, less than if nothing were lost.
        let mean = guide.reflectances.iter().sum::<f32>() / guide.reflectances.len() as f32;
        let sent_w: f64 = guide.vpls.iter().map(|light| light.flux_w).sum();
        let most_w = model.sources.flux_w() * f64::from(mean / (1.0 - mean)) * 1.1;
        assert!(sent_w > 0.0 && sent_w < most_w, "{name}: {sent_w} W of {most_w} W");
    }
}

/// A box without a light, then as a bare mesh, which is lit.
#[test]
fn a_scene_without_light_is_told_and_a_bare_mesh_is_lit() {
    let folder = tempfile::tempdir().unwrap();
    let mut mesh = String::new();
    for corner in 0..8 {
        let pick = |bit: usize, high: f32| if corner >> bit & 1 == 0 { 0.0 } else { high };
        mesh += &format!("v {} {} {}\n", pick(0, 4.0), pick(1, 3.0), pick(2, 2.5));
    }
    for [a, b, c, d] in [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]] {
        mesh += &format!("f {a} {b} {c} {d}\n");
    }
    let [bare, dark] = ["box.obj", "dark.toml"].map(|name| folder.path().join(name));
    fs::write(&bare, mesh).unwrap();
    fs::write(&dark, "[model]\nvoxel_m = 0.1\n[geometry]\nmeshes = [\"box.obj\"]\n").unwrap();
    let out = folder.path().join("out");
    let flux_w = |scene: &Path| {
        let (report, stderr) = json(&["guide", scene.to_str().unwrap(), "-o", out.to_str().unwrap()]);
        assert!(report["nodes"].as_u64().unwrap() > 0, "{report}");
        let table = fs::read_to_string(out.join("cache.csv")).unwrap();
        let irradiance = |row: &str| row.split(',').nth(7).unwrap().parse::<f64>().unwrap();
        (table.lines().skip(1).map(irradiance).sum::<f64>(), stderr)
    };
    let (none, stderr) = flux_w(&dark);
    assert!(none == 0.0 && stderr.contains("warning: no light shines into the void"), "{none}: {stderr}");
    let (some, stderr) = flux_w(&bare);
    assert!(some > 0.0 && stderr.contains("a bare mesh: a light of 100 W"), "{some}: {stderr}");
}
