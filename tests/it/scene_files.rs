//! Scenes that load: every key of a scene file, every format, units and axes, and the real data.

use glam::{DVec3, Vec3};
use lightvein::job::{Cancel, Quiet};
use lightvein::scene::{Light, Method, Scene, SceneError};
use std::path::{Path, PathBuf};

/// Loads a scene from files written into a folder of their own; the first one is the scene.
fn load(files: &[(&str, &str)]) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().expect("a folder for the scene");
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("a file of the scene");
    }
    Scene::load(&folder.path().join(files[0].0), &Quiet, &Cancel::new())
}

#[track_caller]
fn loads(files: &[(&str, &str)]) -> Scene {
    load(files).unwrap_or_else(|error| panic!("{error}"))
}

/// A tetrahedron with one face a material.
const TETRAHEDRON: &str = "\
v 100 0 0\nv 101 0 0\nv 100 1 0\nv 100 0 1\n\
usemtl floor\nf 1 3 2\nusemtl glass_a\nf 1 2 4\nusemtl lamp\nf 2 3 4\nusemtl glass_b\nf 3 1 4\n";

#[test]
fn every_key_of_a_scene_file_is_taken() {
    let scene = loads(&[
        (
            "all.toml",
            r#"
name = "everything"
[geometry]
meshes = ["t.obj"]
unit_m = 2
up = "z"
reflectance = 0.25
[[materials]]
name = "glass*"
transmittance = 0.7
[[materials]]
name = "glass_b"
reflectance = 0.1
[[materials]]
name = "lamp"
emission = 12
[[lights]]
kind = "point"
position = [200.25, 0.25, 0.25]
flux_w = 100
[[lights]]
kind = "sphere"
center = [200.5, 0.25, 0.25]
radius = 0.125
flux_w = 5.0
[[lights]]
kind = "quad"
corner = [200, 0, 1]
u = [1, 0, 0]
v = [0, 0.5, 0]
flux_w = 0
[sensors]
file = "s.csv"
reference = "r.csv"
[model]
voxel_m = 0.1
method = "forward"
tolerance = 1.5
threads = 2
seed = 7
[site]
latitude_deg = 47.4
longitude_deg = 8.5
utc_offset_h = 1
north_deg = 10
turbidity = 3
ground_albedo = 0.2
weather = "w.epw"
start = "01-01"
end = "02-29"
step_min = 60
"#,
        ),
        ("t.obj", TETRAHEDRON),
        ("s.csv", "id,x,y,z,nx,ny,nz\na,200.1,0.1,0.1,,,\nb,200.2,0.1,0.1,0,3,4\n"),
        ("r.csv", "# by hand\nid,irradiance,stderr\nb,4,0.1\nc,1,0\n"),
        ("w.epw", ""),
    ]);
    assert_eq!((scene.name.as_str(), scene.bare), ("everything", false));
    assert_eq!(scene.origin_m, DVec3::new(201.0, 1.0, 1.0));
    assert_eq!(scene.to_user_m(scene.mesh.positions_m[0]), DVec3::new(200.0, 0.0, 0.0));

    let materials: Vec<_> = scene.materials.iter().map(|m| (m.name.as_str(), m.reflectance, m.transmittance)).collect();
    let want = [("floor", 0.25, 0.0), ("glass_a", 0.0, 0.7), ("lamp", 0.25, 0.0), ("glass_b", 0.1, 0.7)];
    assert_eq!(materials, want);
    assert_eq!(scene.materials[2].emission_w_m2_sr, 12.0);

    let position_m = Vec3::new(-0.75, -0.75, -0.75);
    assert_eq!(scene.lights[0], Light::Point { position_m, flux_w: 100.0 });
    let centre_m = Vec3::new(-0.5, -0.75, -0.75);
    assert_eq!(scene.lights[1], Light::Sphere { centre_m, radius_m: 0.125, flux_w: 5.0 });
    let Light::Quad { corner_m, u_m, v_m, .. } = scene.lights[2] else { panic!("a quad") };
    assert_eq!([corner_m, u_m, v_m], [Vec3::new(-1.0, -1.0, 0.0), Vec3::X, 0.5 * Vec3::Y]);

    assert_eq!(scene.sensors[0].normal, None);
    assert!((scene.sensors[1].normal.unwrap() - Vec3::new(0.0, 0.6, 0.8)).length() < 1e-6);
    assert_eq!(scene.reference[0], None);
    assert_eq!(scene.reference[1].unwrap().irradiance_w_m2, 4.0);
    assert_eq!(
        scene.warnings,
        ["r.csv: 1 id left out that no sensor is called", "r.csv: 1 sensor without a reference"]
    );

    assert_eq!((scene.model.voxel_m, scene.model.method), (Some(0.1), Some(Method::Forward)));
    assert_eq!((scene.model.tolerance, scene.model.threads, scene.model.seed), (Some(1.5), Some(2), Some(7)));
    let site = scene.site.expect("a site");
    assert_eq!((site.start, site.end, site.step_min), (Some((1, 1)), Some((2, 29)), Some(60.0)));
    assert!(site.weather.expect("a weather file").ends_with("w.epw"));
}

#[test]
fn unit_and_axis_describe_the_mesh_alone() {
    let toml = "[geometry]\nmeshes = [\"t.obj\"]\nunit_m = 0.5\nup = \"y\"\n\
        [[lights]]\nkind = \"point\"\nposition = [1, 2, 3]\nflux_w = 1\n[sensors]\nfile = \"s.pts\"\n";
    let scene = loads(&[("a.toml", toml), ("t.obj", "v 1 2 3\nv 2 2 3\nv 1 3 3\nf 1 2 3\n"), ("s.pts", "4 5 6\n")]);
    assert_eq!(scene.to_user_m(scene.mesh.positions_m[0]), DVec3::new(0.5, -1.5, 1.0));
    assert_eq!(scene.to_user_m(scene.sensors[0].position_m), DVec3::new(4.0, 5.0, 6.0));
    let Light::Point { position_m, .. } = scene.lights[0] else { panic!("a point") };
    assert_eq!(scene.to_user_m(position_m), DVec3::new(1.0, 2.0, 3.0));
}

#[test]
fn up_is_what_the_scene_file_says_and_else_what_the_format_says() {
    let size = |line: &str| {
        let toml = format!("[geometry]\nmeshes = [{:?}]\n{line}", sound("box.gltf"));
        let (low, high) = loads(&[("a.toml", &toml)]).mesh.bounds_m().expect("a mesh");
        high - low
    };
    assert_eq!(size(""), Vec3::new(4.0, 3.0, 2.0));
    assert_eq!(size("up = \"y\""), Vec3::new(4.0, 3.0, 2.0));
    assert_eq!(size("up = \"z\""), Vec3::new(4.0, 2.0, 3.0));
}

#[test]
fn a_mesh_alone_is_a_scene() {
    let scene = loads(&[("t.OBJ", TETRAHEDRON)]);
    assert!(scene.bare && scene.lights.is_empty() && scene.sensors.is_empty());
    assert_eq!((scene.name.as_str(), scene.mesh.triangles.len()), ("t", 4));
    assert!(scene.materials.iter().all(|material| material.reflectance == 0.5));
}

#[test]
fn what_is_left_out_is_said() {
    let toml = "[geometry]\nmeshes = [\"t.obj\"]\n[[materials]]\nname = \"gras\"\nreflectance = 0.2\n[sensors]\nfile = \"s.csv\"\n";
    let mesh = "mtllib models/t.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\n\
        usemtl grass\nf 1 2 3\nusemtl none\nf 3 2 1\nf 1 2 4\nf 1 2\nhello\n";
    let scene = loads(&[
        ("a.toml", toml),
        ("t.obj", mesh),
        ("t.mtl", "newmtl grass\nKd 0.25\nmap_Kd grass.png\n"),
        ("s.csv", "# none yet\nid,x,y,z\n"),
    ]);
    assert_eq!(scene.materials[0].reflectance, 0.25);
    let want = [
        "s.csv: no sensors in it",
        "t.obj: 1 texture (map_Kd) not read, Kd stands for it",
        "t.obj: material file \"gone.mtl\" is missing",
        "t.obj: 1 material in no material file",
        "t.obj: 1 unknown statement left out",
        "materials \"gras\" (line 3) match no face",
        "t.obj: 2 degenerate faces left out",
        "t.obj: 1 duplicate face left out",
    ];
    assert_eq!(scene.warnings, want);
}

/// A file of the shared real data; `None`, said on stderr, where the data are not there.
fn real(file: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(file);
    if path.exists() {
        return path.canonicalize().ok();
    }
    eprintln!("skipped: ../shared/data/{file} is not there");
    None
}

/// Loads real meshes by a scene file with these further lines of `[geometry]` and below.
fn load_real(files: &[&str], rest: &str) -> Option<Scene> {
    let paths: Option<Vec<_>> = files.iter().map(|file| real(file)).collect();
    let toml = format!("[geometry]\nmeshes = {:?}\n{rest}", paths?);
    Some(loads(&[("real.toml", &toml)]))
}

#[test]
fn the_cornell_boxes_load() {
    let Some(scene) = load_real(&["cornell/CornellBox-Original.obj"], "up = \"y\"\n") else { return };
    // The file gives the tall box the same face as its front and as its bottom.
    assert_eq!(scene.mesh.triangles.len(), 34);
    assert_eq!(scene.warnings, ["CornellBox-Original.obj: 2 duplicate faces left out"]);
    let find = |name: &str| scene.materials.iter().find(|material| material.name == name).expect(name);
    assert!((find("light").emission_w_m2_sr - (17.0 * 0.2126 + 12.0 * 0.7152 + 4.0 * 0.0722)).abs() < 1e-4);
    assert!((find("leftWall").reflectance - (0.63 * 0.2126 + 0.065 * 0.7152 + 0.05 * 0.0722)).abs() < 1e-6);

    // The lamp hangs below the ceiling and shines down: the faces point up after a wrong turn of the axes.
    let lamp = scene.materials.iter().position(|material| material.name == "light").expect("a lamp") as u32;
    let triangle = scene.mesh.material_of.iter().position(|&number| number == lamp).expect("its face");
    let [a, b, c] = scene.mesh.corners_m(triangle).expect("its corners");
    assert!((b - a).cross(c - a).z < 0.0);
    assert!(scene.to_user_m(a).z > 1.9);

    let Some(scene) = load_real(&["cornell/CornellBox-Empty-White.obj"], "up = \"y\"\n") else { return };
    assert_eq!(scene.mesh.triangles.len(), 12);
}

#[test]
fn the_duplex_the_cabin_and_the_quake_maps_load() {
    let duplex = ["duplex/duplex_structure.obj", "duplex/duplex_window.obj"];
    if let Some(scene) = load_real(&duplex, "[[materials]]\nname = \"IfcWindow*\"\ntransmittance = 0.7\n") {
        let glazing = scene.materials.iter().filter(|material| material.transmittance > 0.0).count();
        eprintln!("duplex: {} triangles, {glazing} glazed, {:?}", scene.mesh.triangles.len(), scene.warnings);
        assert!(glazing > 20 && scene.mesh.triangles.len() > 10_000);
    }
    if let Some(scene) = load_real(&["cabin/cabin_shell_opaque.obj"], "") {
        eprintln!("cabin: {} triangles, {:?}", scene.mesh.triangles.len(), scene.warnings);
        assert!(scene.materials.iter().any(|material| material.name == "wood_floor"));
    }
    if let Some(scene) = load_real(&["cabin/cabin_furnished_opaque.obj", "cabin/cabin_furnished_light.obj"], "") {
        eprintln!("furnished cabin: {} triangles, {:?}", scene.mesh.triangles.len(), scene.warnings);
    }
    for map in ["dm4", "e1m1"] {
        let Some(scene) = load_real(&[&format!("quake/{map}_solid.obj")], "unit_m = 0.0254\n") else { return };
        let (low, high) = scene.mesh.bounds_m().expect("a mesh");
        eprintln!("{map}: {} triangles, {} m, {:?}", scene.mesh.triangles.len(), high - low, scene.warnings);
        assert!((high - low).max_element() < 150.0);
    }
    if let Some(scene) = load_real(&["city/ingolstadt_lod3_mid.obj"], "") {
        eprintln!("Ingolstadt: {} triangles, {:?}", scene.mesh.triangles.len(), scene.warnings);
        assert!(!scene.warnings.is_empty());
    }
    if let Some(scene) = load_real(&["city/DenHaag_01.obj"], "") {
        eprintln!("Den Haag: {} triangles, {:?}", scene.mesh.triangles.len(), scene.warnings);
    }
}

/// Corners of all triangles as another crate reads them, rounded as that crate does.
type Soup = Vec<[[f32; 3]; 3]>;

fn soup_of(mesh: &lightvein::scene::read::RawMesh) -> Soup {
    let corner = |vertex: u32| mesh.positions[vertex as usize].as_vec3().to_array();
    mesh.triangles.iter().map(|triangle| triangle.map(corner)).collect()
}

fn read_alone(path: &Path) -> lightvein::scene::read::RawMesh {
    let bytes = std::fs::read(path).expect("a mesh");
    let cancel = Cancel::new();
    let input = lightvein::scene::input::Input::alone(&bytes, path, &Quiet, &cancel);
    let format = lightvein::scene::read::Format::of(path).expect("a mesh");
    format.read(&input).unwrap_or_else(|error| panic!("{error}"))
}

fn sound(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_input/sound").join(file)
}

#[test]
fn obj_is_read_as_tobj_reads_it() {
    let real = ["cornell/CornellBox-Original.obj", "duplex/duplex_structure.obj", "cabin/cabin_furnished_opaque.obj"];
    let files = real.into_iter().filter_map(self::real).chain([sound("box.obj")]);
    for path in files {
        let options = tobj::LoadOptions { triangulate: true, single_index: false, ..Default::default() };
        // Without materials: a colour of one component makes tobj 4.0 panic.
        // It also knows neither an empty usemtl nor lines that go on.
        let text = std::fs::read_to_string(&path).expect("a mesh");
        let text = text.replace("usemtl\n", "usemtl none\n").replace("\\\n", "");
        let mut file = text.as_bytes();
        let (models, _) =
            tobj::load_obj_buf(&mut file, &options, |_| Err(tobj::LoadError::GenericFailure)).expect("tobj");
        let mut theirs = Soup::new();
        for mesh in models.iter().map(|model| &model.mesh) {
            let corner = |vertex: u32| [0, 1, 2].map(|axis| mesh.positions[3 * vertex as usize + axis]);
            theirs.extend(mesh.indices.chunks_exact(3).map(|t| [corner(t[0]), corner(t[1]), corner(t[2])]));
        }
        assert_eq!(soup_of(&read_alone(&path)), theirs, "{}", path.display());
    }
}

#[test]
fn stl_is_read_as_stl_io_reads_it() {
    for path in [sound("box.stl"), sound("box_binary.stl")] {
        let mut file = std::fs::File::open(&path).expect("a mesh");
        let theirs = stl_io::create_stl_reader(&mut file).expect("stl_io reads it");
        let theirs: Soup = theirs.map(|triangle| triangle.expect("a triangle").vertices.map(|v| v.0)).collect();
        assert_eq!(soup_of(&read_alone(&path)), theirs, "{}", path.display());
    }
}

#[test]
fn ply_is_read_as_ply_rs_reads_it() {
    use ply_rs_bw::ply::{DefaultElement, Property};
    for path in [sound("box.ply"), sound("box_little.ply"), sound("box_big.ply")] {
        let mut file = std::fs::File::open(&path).expect("a mesh");
        let parser = ply_rs_bw::parser::Parser::<DefaultElement>::new();
        let ply = parser.read_ply(&mut file).expect("ply-rs-bw reads it");
        let coordinate = |vertex: &DefaultElement, axis: &str| match vertex.get(axis) {
            Some(Property::Float(value)) => *value,
            other => panic!("{other:?}"),
        };
        let vertices: Vec<[f32; 3]> =
            ply.payload["vertex"].iter().map(|vertex| ["x", "y", "z"].map(|axis| coordinate(vertex, axis))).collect();
        let mut theirs = Soup::new();
        for face in &ply.payload["face"] {
            let Some(Property::ListInt(corners)) = face.get("vertex_indices") else { panic!("{face:?}") };
            let at = |corner: usize| vertices[corners[corner] as usize];
            theirs.extend((2..corners.len()).map(|last| [at(0), at(last - 1), at(last)]));
        }
        assert_eq!(soup_of(&read_alone(&path)), theirs, "{}", path.display());
    }
}

#[test]
fn all_formats_give_the_same_box() {
    let cancel = Cancel::new();
    let volume = |file: &str| {
        let scene = Scene::load(&sound(file), &Quiet, &cancel).unwrap_or_else(|error| panic!("{error}"));
        let corners = (0..scene.mesh.triangles.len()).filter_map(|triangle| scene.mesh.corners_m(triangle));
        corners.map(|[a, b, c]| a.cross(b).dot(c) / 6.0).sum::<f32>()
    };
    for file in ["box.ply", "box_little.ply", "box_big.ply", "box.stl", "box_binary.stl", "box.gltf", "box.glb"] {
        assert!((volume(file) - 24.0).abs() < 1e-4, "{file}: {}", volume(file));
    }
}
