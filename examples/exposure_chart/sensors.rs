//! The ways that answer anywhere, at a scene's sensors.

use crate::measure::{Row, TRUTH, median_s, per_second, rmse, svf_error};
use lightvein::daylight::cast::{Asked, Casting, cast};
use lightvein::daylight::scales::sight::Overhangs;
use lightvein::daylight::way::{Fineness, Ground, Way};
use lightvein::daylight::{Exposure, Point, points};
use lightvein::job::{Cancel, Cancelled, Quiet};

/// Most points of a run.
const MOST: usize = 100_000;

/// Texels, directions and samples of the paper's large scale, and one finer.
const HEIGHTS: [[usize; 3]; 3] = [[512, 8, 8], [512, 16, 16], [1024, 32, 32]];

/// The same of all layers.
const LAYERS: [[usize; 3]; 4] = [[1024, 16, 16], [1024, 32, 32], [2048, 64, 64], [2048, 128, 128]];

/// Suns and directions.
const RAYS: [u32; 6] = [32, 64, 128, 256, 512, 1024];

/// The truth at the sensors, and what each way is worth there.
pub fn rows(ground: &Ground) -> Result<(Vec<Exposure>, Vec<Row>), Cancelled> {
    let own = points(&ground.scene.sensors);
    let truth = cast(ground.rays, &own, ground.map, ground.north_rad, TRUTH, &Quiet, &Cancel::new())?;
    let rows = ways().into_iter().map(|(series, quality, way)| row(ground, &own, &truth, (series, quality), way));
    let rows: Result<Vec<Row>, Cancelled> = rows.collect();
    Ok((truth, rows?))
}

/// Each way with the name of its series and its quality.
fn ways() -> Vec<(&'static str, String, Way)> {
    let maps = |series, overhangs, [texels, directions, samples]: [usize; 3]| {
        let fineness = Fineness { texels, directions, samples, overhangs };
        (series, format!("{directions} x {samples}"), Way::Maps(fineness))
    };
    let rays = |sun_rays: Option<u32>, sky_rays: u32| {
        let quality = format!("{} + {sky_rays}", sun_rays.map_or("all".to_owned(), |count| count.to_string()));
        ("rays", quality, Way::Rays(Casting { sun_rays, sky_rays, seed: 0 }))
    };
    let mut ways = vec![("isotropic", "isotropic".to_owned(), Way::Isotropic)];
    ways.extend(HEIGHTS.map(|fine| maps("height field", Overhangs::Ignored, fine)));
    ways.extend(HEIGHTS.map(|fine| maps("opening angles", Overhangs::Opening, fine)));
    ways.extend(LAYERS.map(|fine| maps("layers", Overhangs::Peeled, fine)));
    ways.extend(RAYS.map(|count| rays(Some(count), count)));
    ways.push(rays(None, 4096));
    ways
}

fn row(
    ground: &Ground,
    own: &[Point],
    truth: &[Exposure],
    (series, quality): (&'static str, String),
    way: Way,
) -> Result<Row, Cancelled> {
    let cancel = Cancel::new();
    let prepared = way.prepare(ground, &cancel)?;
    let at = |points: &[Point]| prepared.ask(ground, Asked::all(points), None, &Quiet, &cancel);
    let found = at(own)?;
    // The scene's sensors again and again, with other offsets each.
    let many: Vec<Point> = own.iter().cycle().take(MOST.max(own.len())).copied().collect();
    let per_s = per_second([own.len(), many.len()], |count| drop(at(&many[..count])));
    let made_s = median_s(3, || drop(way.prepare(ground, &cancel)));
    let totals: Vec<f64> = found.iter().map(Exposure::total_kwh_m2).collect();
    let svf: Vec<f64> = found.iter().map(|exposure| exposure.svf).collect();
    let (rmse, svf) = (rmse(&totals, truth), Some(svf_error(&svf, truth)));
    Ok(Row { at: "sensors", series, quality, is_smooth: false, made_s, per_s, rmse, svf }.said())
}
