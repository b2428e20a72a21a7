//! How well do cells and necks match the rooms and doors that an architect named?
//!
//! Compares the skeleton of the Duplex house with the spaces and doors of its IFC model, and prints what comes out:
//!
//!     cargo run --release --example duplex_truth -- scenes/real/duplex.toml ../shared/data/duplex 0.1
//!
//! A space is covered by the cell that holds most of its void voxels. A door that joins two spaces (or more) is found when
//! a neck at the door joins two cells that cover them; a neck between covering cells is right when such a door exists.

use anyhow::Context;
use glam::{DVec3, Vec3};
use lightvein::job::{Cancel, Progress, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::skeleton::Skeleton;
use lightvein::voxel::{Voxels, voxelise};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

/// Memory for voxels and skeleton, bytes.
const MOST_BYTES: u64 = 4 << 30;

/// A neck is at a door when it lies within this distance of the door's box, metres.
const AT_DOOR_M: f64 = 0.3;

/// Prints how long each stage took.
#[derive(Default)]
struct Clock(Mutex<Vec<(String, Instant)>>);

impl Progress for Clock {
    fn begin(&self, stage: &str, _total: u64) {
        if let Ok(mut stages) = self.0.lock() {
            stages.push((stage.to_owned(), Instant::now()));
        }
    }

    fn advance(&self, _units: u64) {}

    fn end(&self) {
        if let Some((stage, begun)) = self.0.lock().ok().and_then(|mut stages| stages.pop()) {
            println!("{stage:10} {:8.1} ms", 1e3 * begun.elapsed().as_secs_f64());
        }
    }
}

struct Space {
    id: String,
    name: String,
    triangles: Vec<[DVec3; 3]>,
}

struct Door {
    name: String,
    low: DVec3,
    high: DVec3,
    spaces: Vec<String>,
}

fn main() -> anyhow::Result<()> {
    let mut args = std::env::args().skip(1);
    let scene_path = PathBuf::from(args.next().unwrap_or("scenes/real/duplex.toml".into()));
    let data = PathBuf::from(args.next().unwrap_or("../shared/data/duplex".into()));
    let voxel_m: f32 = args.next().map_or(Ok(0.1), |arg| arg.parse()).context("the voxel size is not a number")?;

    let scene = Scene::load(&scene_path, &Quiet, &Cancel::new())?;
    let rays = Rays::new(&scene);
    let voxels = voxelise(&scene, &rays, &[], voxel_m, MOST_BYTES, &Quiet, &Cancel::new())?;
    let begun = Instant::now();
    let skeleton = Skeleton::build(&voxels, &rays, &Clock::default(), &Cancel::new())?;
    let shape = skeleton.shape();
    println!(
        "{} void voxels, {} nodes, {} components, {} loops, {} cells, {} necks, {:.3} s",
        voxels.void.count(),
        skeleton.graph.node_count(),
        shape.components,
        shape.loops,
        skeleton.cells.len(),
        shape.necks,
        begun.elapsed().as_secs_f64()
    );
    skeleton.validate(&voxels.void).map_err(anyhow::Error::msg)?;

    let (spaces, doors) = truth(&data)?;
    let covering = covering(&scene, &voxels, &skeleton, &spaces);
    report_doors(&scene, &skeleton, &spaces, &doors, &covering);
    Ok(())
}

/// The named spaces with their walls, and the doors.
fn truth(data: &Path) -> anyhow::Result<(Vec<Space>, Vec<Door>)> {
    let text = std::fs::read_to_string(data.join("duplex_truth.json"))?;
    let truth: serde_json::Value = serde_json::from_str(&text)?;
    let mut triangles = objects(&std::fs::read_to_string(data.join("duplex_space.obj"))?)?;
    let entries = |key: &str| truth[key].as_object().into_iter().flatten();
    let spaces = entries("spaces").map(|(id, space)| Space {
        id: id.clone(),
        name: format!("{} {}", space["name"].as_str().unwrap_or("?"), space["long"].as_str().unwrap_or("")),
        triangles: triangles.remove(&format!("IfcSpace_{id}")).unwrap_or_default(),
    });
    let spaces: Vec<Space> = spaces.collect();
    let corner = |value: &serde_json::Value| {
        let along: Vec<f64> = value.as_array().into_iter().flatten().filter_map(serde_json::Value::as_f64).collect();
        DVec3::from_slice(&along)
    };
    let doors = entries("doors").map(|(_, door)| Door {
        name: door["name"].as_str().unwrap_or("?").into(),
        low: corner(&door["bbox"][0]),
        high: corner(&door["bbox"][1]),
        spaces: door["spaces"].as_array().into_iter().flatten().filter_map(|id| Some(id.as_str()?.into())).collect(),
    });
    Ok((spaces, doors.collect()))
}

/// The triangles of each object of an OBJ file of triangles.
fn objects(text: &str) -> anyhow::Result<BTreeMap<String, Vec<[DVec3; 3]>>> {
    let (mut points, mut objects, mut name) = (Vec::new(), BTreeMap::<_, Vec<_>>::new(), String::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let along: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>()?;
                points.push(DVec3::from_slice(&along));
            }
            Some("o") => name = words.next().unwrap_or_default().into(),
            Some("f") => {
                let corners: Vec<usize> =
                    words.map(|word| word.split('/').next().unwrap_or_default().parse()).collect::<Result<_, _>>()?;
                objects.entry(name.clone()).or_default().push([0, 1, 2].map(|i| points[corners[i] - 1]));
            }
            _ => {}
        }
    }
    Ok(objects)
}

/// Whether a ray upwards from a point crosses the walls an odd number of times.
fn holds(space: &Space, point: DVec3) -> bool {
    let crosses = space.triangles.iter().filter(|[a, b, c]| {
        let normal = (b - a).cross(c - a);
        let inside = [(a, b), (b, c), (c, a)].iter().all(|(from, to)| {
            let side = (*to - *from).truncate().perp_dot((point - *from).truncate());
            side * normal.z > 0.0
        });
        inside && normal.dot(*a - point) * normal.z > 0.0
    });
    crosses.count() % 2 == 1
}

/// The cell that covers each space, if any voxel of it is void; a line for each.
fn covering(scene: &Scene, voxels: &Voxels, skeleton: &Skeleton, spaces: &[Space]) -> Vec<Option<u32>> {
    let mut voxels_of_cell = vec![0_usize; skeleton.cells.len()];
    let mut shared = vec![BTreeMap::<u32, usize>::new(); spaces.len()];
    for voxel in voxels.void.iter() {
        let Some(node) = skeleton.nearest_node(voxel) else { continue };
        let cell = skeleton.graph[node].cell;
        voxels_of_cell[cell as usize] += 1;
        // Off round numbers, where the spaces' own edges are.
        let point = scene.to_user_m(voxels.lattice.centre_m(voxel)) + DVec3::new(1.3e-4, 2.7e-4, 0.0);
        for (space, shared) in spaces.iter().zip(&mut shared) {
            if holds(space, point) {
                *shared.entry(cell).or_default() += 1;
            }
        }
    }
    println!("\nspace                cell  of the space  of the cell");
    let each = spaces.iter().zip(&shared).map(|(space, shared)| {
        let whole: usize = shared.values().sum();
        let (&cell, &most) = shared.iter().max_by_key(|(cell, count)| (**count, std::cmp::Reverse(**cell)))?;
        let of_cell = most as f64 / voxels_of_cell[cell as usize] as f64;
        println!("{:20} {cell:4} {:13.2} {of_cell:12.2}", space.name, most as f64 / whole as f64);
        Some(cell)
    });
    each.collect()
}

fn report_doors(scene: &Scene, skeleton: &Skeleton, spaces: &[Space], doors: &[Door], covering: &[Option<u32>]) {
    let names = |cell: u32| {
        let covered: Vec<&str> = (spaces.iter().zip(covering))
            .filter(|(_, covering)| **covering == Some(cell))
            .map(|(space, _)| space.name.as_str())
            .collect();
        if covered.is_empty() { format!("#{cell}") } else { covered.join(" + ") }
    };
    let cell_of = |id: &String| spaces.iter().position(|space| space.id == *id).and_then(|space| covering[space]);
    let joined: BTreeSet<[u32; 2]> = skeleton.necks.iter().map(|neck| neck.cells).collect();

    println!("\ndoor                                   found  neck there");
    let (mut wanted, mut found, mut pairs) = (0, 0, BTreeSet::new());
    for door in doors {
        let at_door = skeleton.necks.iter().find(|neck| {
            let at = scene.to_user_m(neck.position_m);
            (at - at.clamp(door.low, door.high)).length() < AT_DOOR_M
        });
        let there = at_door.map_or("-".into(), |neck| {
            format!("{:.2} m2, {} | {}", neck.area_m2, names(neck.cells[0]), names(neck.cells[1]))
        });
        let beside: BTreeSet<u32> = door.spaces.iter().filter_map(cell_of).collect();
        let is_found = at_door.is_some_and(|neck| neck.cells.iter().all(|cell| beside.contains(cell)));
        pairs.extend(beside.iter().flat_map(|a| beside.range(a + 1..).map(|b| [*a, *b])));
        let result = match (door.spaces.len(), is_found) {
            (0 | 1, _) => "(out)",
            (_, true) => "yes",
            (_, false) => "NO",
        };
        wanted += usize::from(door.spaces.len() > 1);
        found += usize::from(door.spaces.len() > 1 && is_found);
        println!("{:.38} {result:>6}  {there}", format!("{:38}", door.name));
    }

    let covers = |cell: u32| covering.contains(&Some(cell));
    println!("\nnecks at no door");
    let (mut right, mut between) = (0, 0);
    for cells in &joined {
        if cells.iter().all(|cell| covers(*cell)) {
            between += 1;
            right += usize::from(pairs.contains(cells));
        }
    }
    for neck in &skeleton.necks {
        let at = scene.to_user_m(neck.position_m);
        let at_door = doors.iter().any(|door| (at - at.clamp(door.low, door.high)).length() < AT_DOOR_M);
        if !at_door {
            let [a, b] = neck.cells.map(names);
            let volumes = neck.cells.map(|cell| skeleton.cells[cell as usize].volume_m3);
            let normal: Vec3 = neck.normal;
            println!(
                "{:.2} m2 at {at:.2} across {normal:.1}: {a} ({:.1} m3) | {b} ({:.1} m3)",
                neck.area_m2, volumes[0], volumes[1]
            );
        }
    }
    println!(
        "\nrecall {found}/{wanted} doors between two spaces; precision {right}/{between} adjacent pairs of covering cells"
    );
}
