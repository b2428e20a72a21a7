//! How long a full redraw takes: 20,000 nodes, as many edges and a mesh of 100,000 triangles at 1280 x 800, with the
//! camera moving, until the GPU is done; each layer alone and all together.
//!
//!     cargo bench -p lightvein-viewer --bench draw

use std::f32::consts::TAU;
use std::sync::Arc;
use std::time::Instant;

use glam::{Vec2, Vec3};
use jiff::civil::date;
use lightvein::scene::Site;
use lightvein::sky::site::Outdoors;
use lightvein_viewer::camera::Camera;
use lightvein_viewer::colour::{ColourMap, Scale};
use lightvein_viewer::layers::Shadow;
use lightvein_viewer::outdoors::sun::SunNow;
use lightvein_viewer::paint::{
    Ball, Batch, Corner, Culling, Cut, FaceStyle, Offscreen, Picture, Shadows, Stroke, Sunlight, Tint, What,
};

const SIZE_PX: [u32; 2] = [1280, 800];
/// Redraws of which the median is told.
const REDRAWS: usize = 20;
const NODES: usize = 20_000;
/// Quads each way of the hilly ground; two triangles each make 100,000.
const QUADS: [usize; 2] = [250, 200];
const BOUNDS_M: (Vec3, Vec3) = (Vec3::new(0.0, 0.0, -1.0), Vec3::new(25.0, 20.0, 4.0));

fn main() -> anyhow::Result<()> {
    let mut offscreen = match Offscreen::new() {
        Ok(offscreen) => offscreen,
        Err(error) => {
            println!("skipped: {error}");
            return Ok(());
        }
    };
    println!("{}, {} x {} pixels, median of {REDRAWS} redraws", offscreen.adapter(), SIZE_PX[0], SIZE_PX[1]);

    let (mesh, nodes, edges) = (mesh(), nodes(), edges());
    let wireframe = Batch { what: wireframe(&mesh.what), ..mesh.clone() };
    let heatmap = Batch { tint: scaled(), ..mesh.clone() };
    let mut cut = mesh.clone();
    cut.cut = true;
    let sunlit = Batch { what: sunlit(&mesh.what), ..mesh.clone() };
    let layers = [
        ("background", vec![]),
        ("mesh of 100,000 triangles", vec![mesh.clone()]),
        ("the same, in colours of its values", vec![heatmap]),
        ("the same, cut", vec![cut]),
        ("the same, as wireframe", vec![wireframe]),
        ("the same, in the sun, with hybrid shadow maps", vec![sunlit]),
        ("20,000 nodes", vec![nodes.clone()]),
        ("20,000 edges", vec![edges.clone()]),
        ("mesh, nodes and edges", vec![mesh, nodes, edges]),
    ];
    for (name, batches) in layers {
        println!("{:8.1} ms  {name}", median_ms(&mut offscreen, batches)?);
    }
    Ok(())
}

/// The median time of a redraw; the first, which uploads and compiles, is not counted.
fn median_ms(offscreen: &mut Offscreen, batches: Vec<Batch>) -> anyhow::Result<f64> {
    let aspect = SIZE_PX[0] as f32 / SIZE_PX[1] as f32;
    let cuts = vec![Cut { normal: Vec3::Z, offset_m: 0.5 }];
    let camera = Camera::fitted(BOUNDS_M, aspect);
    let sunlight = sunlight(&batches);
    let mut picture = Picture { camera, background: [[60, 66, 74], [28, 30, 34]], sunlight, cuts, batches };
    offscreen.draw(&picture, SIZE_PX)?;
    let mut times_ms = Vec::new();
    for _ in 0..REDRAWS {
        picture.camera.orbit(Vec2::new(9.0, 1.0), Vec2::new(SIZE_PX[0] as f32, SIZE_PX[1] as f32));
        let begun = Instant::now();
        offscreen.draw(&picture, SIZE_PX)?;
        times_ms.push(begun.elapsed().as_secs_f64() * 1e3);
    }
    times_ms.sort_by(f64::total_cmp);
    Ok(times_ms[REDRAWS / 2])
}

/// The sun of a June afternoon over a picture with sunlit faces; none over others.
fn sunlight(batches: &[Batch]) -> Option<Sunlight> {
    let casters = batches.iter().find_map(|batch| match &batch.what {
        What::Faces { data, style: FaceStyle::Sunlit, .. } => Some(Arc::clone(data)),
        _ => None,
    })?;
    let site = Site { latitude_deg: Some(48.8), longitude_deg: Some(11.4), ..Site::default() };
    let outdoors = Outdoors::of(&site, None).ok()?;
    let now = SunNow::of(&outdoors, date(2025, 6, 21).at(16, 0, 0, 0)).ok()?;
    Some(Sunlight { light: now.light, shadows: Some(Shadows { casters, settings: Shadow::default().settings() }) })
}

/// Height of the ground.
fn height_m(x_m: f32, y_m: f32) -> f32 {
    (x_m * 0.9).sin() * 0.5 + (y_m * 1.3).cos() * 0.4 + (x_m * 5.0).sin() * (y_m * 4.0).sin() * 0.1
}

fn mesh() -> Batch {
    let at = |column: usize, row: usize| {
        let (x_m, y_m) = (column as f32 * 0.1, row as f32 * 0.1);
        Vec3::new(x_m, y_m, height_m(x_m, y_m))
    };
    let mut corners = Vec::with_capacity(6 * QUADS[0] * QUADS[1]);
    for row in 0..QUADS[1] {
        for column in 0..QUADS[0] {
            let [a_m, b_m, c_m, d_m] =
                [at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)];
            for [a_m, b_m, c_m] in [[a_m, b_m, c_m], [a_m, c_m, d_m]] {
                let normal = (b_m - a_m).cross(c_m - a_m).normalize();
                let corner = |position_m: Vec3| Corner {
                    position_m,
                    normal,
                    value: position_m.z,
                    colour: [205, 200, 190, 255],
                    sides: 3,
                };
                corners.extend([a_m, b_m, c_m].map(corner));
            }
        }
    }
    Batch::new(What::Faces { data: Arc::new(corners), style: FaceStyle::Shaded, culling: Culling::ToVoid })
}

fn wireframe(what: &What) -> What {
    match what {
        What::Faces { data, culling, .. } => {
            What::Faces { data: Arc::clone(data), style: FaceStyle::Wireframe, culling: *culling }
        }
        other => other.clone(),
    }
}

fn sunlit(what: &What) -> What {
    match what {
        What::Faces { data, culling, .. } => {
            What::Faces { data: Arc::clone(data), style: FaceStyle::Sunlit, culling: *culling }
        }
        other => other.clone(),
    }
}

/// Places along a winding line above the ground: what a skeleton of so many nodes looks like.
fn place_m(number: usize) -> Vec3 {
    let along = number as f32 / NODES as f32;
    let (turn, sweep) = (along * 90.0 * TAU, along * TAU);
    let (x_m, y_m) = (12.5 + 10.0 * along * turn.cos() + sweep.sin(), 10.0 + 8.0 * along * turn.sin());
    Vec3::new(x_m, y_m, height_m(x_m, y_m) + 0.5)
}

fn scaled() -> Tint {
    Tint::Scaled(Scale { map: ColourMap::Viridis, low: -0.5, high: 1.5, logarithmic: false })
}

fn nodes() -> Batch {
    let ball = |number| {
        let centre_m = place_m(number);
        Ball { centre_m, radius_m: 0.06, value: centre_m.z, colour: [255; 4] }
    };
    let data = Arc::new((0..NODES).map(ball).collect());
    Batch { tint: scaled(), ..Batch::new(What::Balls { data, least_px: 1.5, most_px: 12.0 }) }
}

fn edges() -> Batch {
    let stroke = |number| Stroke {
        a_m: place_m(number),
        b_m: place_m(number + 1),
        width_px: 1.5,
        value: 0.0,
        colour: [230, 159, 0, 255],
        dashed: number % 7 == 0,
        arrow: number % 50 == 0,
    };
    Batch::new(What::Strokes { data: Arc::new((0..NODES).map(stroke).collect()) })
}
