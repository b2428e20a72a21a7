use lightvein::flow::network::Quality;
use lightvein::guide::guide;
use lightvein::job::{Cancel, Quiet};
use lightvein::light::{Guiding, Settings, Sources};
use lightvein::model::Model;
use lightvein::rays::Rays;
use lightvein::scene::Scene;
use lightvein::trace::guided::trace_guided;
use lightvein::trace::trace;
use std::{path::Path, sync::Arc, time::Instant};
fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 200.0
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let e = |k: &str, or: f64| std::env::var(k).ok().and_then(|v| v.parse().ok()).unwrap_or(or);
    let seconds: f64 = e("SECONDS_EACH", 2.0);
    for path in std::env::args().skip(1) {
        let (p, c) = (Quiet, Cancel::new());
        let scene = Scene::load(Path::new(&path), &p, &c)?;
        let began = Instant::now();
        let rays = Arc::new(Rays::new(&scene));
        let model = Model::build(
            &scene,
            rays.clone(),
            scene.model.voxel_m.unwrap_or(0.1) * e("VOXELS", 1.0) as f32,
            4_000_000_000,
            &p,
            &c,
        )?;
        let t_model = began.elapsed().as_secs_f64();
        let settings = Settings::default();
        let seeded =
            guide(&model, &if e("COARSE", 0.0) > 0.0 { Quality::COARSE } else { Quality::MEDIUM }, &settings, &p, &c)?;
        let t_guide = began.elapsed().as_secs_f64();
        let own = seeded.at_probes(&model.probes_at_sensors(&scene), 0, &c)?;
        let build = began.elapsed().as_secs_f64();
        let mut places = seeded.places();
        let first = places.len() as u32;
        places.extend(&own);
        let place_of = |at: glam::Vec3, normal: Option<glam::Vec3>| seeded.place_of(at, normal);
        let guiding = Guiding { places, at_sensors: (first..first + own.len() as u32).collect(), place_of: &place_of };
        println!(
            "== {path}: {} walls {} nodes; model {t_model:.3} guide {:.3} sensors {:.3}",
            seeded.guide.walls.len(),
            seeded.guide.nodes.len(),
            t_guide - t_model,
            build - t_guide
        );
        let sources = Sources::of(&scene);
        let timed = |guided: bool, samples: u32, seed: u64| {
            let settings = Settings { samples, seed, ..settings };
            let began = cpu();
            let t = if guided {
                trace_guided(&scene, &rays, &sources, &guiding, &settings, &p, &c)
            } else {
                trace(&scene, &rays, &sources, &settings, &p, &c)
            };
            (t.unwrap(), cpu() - began)
        };
        let mut per = [0.0; 2];
        let mut vars = Vec::new();
        let mut fields = Vec::new();
        for guided in [false, true] {
            let (_, t) = timed(guided, 2048, 1);
            let n = (2048.0 * seconds / t) as u32;
            let (tr, t) = timed(guided, n, 2);
            per[guided as usize] = t / f64::from(n) / scene.sensors.len() as f64;
            vars.push(
                tr.field
                    .readings
                    .iter()
                    .map(|r| r.error_w_m2.unwrap_or(0.0).powi(2) * f64::from(n))
                    .collect::<Vec<_>>(),
            );
            fields.push(tr);
        }
        let mut ratios = Vec::new();
        for (i, s) in scene.sensors.iter().enumerate().take(400) {
            let equal = vars[0][i] / vars[1][i];
            if !equal.is_finite() {
                continue;
            }
            ratios.push(equal * per[0] / per[1]);
            if scene.sensors.len() <= 400 {
                let reference =
                    scene.reference.get(i).and_then(|r| r.as_ref()).map(|r| r.irradiance_w_m2).unwrap_or(0.0);
                let r = |k: usize| fields[k].field.readings[i];
                let z =
                    (r(1).value_w_m2 - r(0).value_w_m2) / (r(0).error_w_m2.unwrap().hypot(r(1).error_w_m2.unwrap()));
                println!(
                    "{:>12} ref {reference:.5} plain {:.5} guided {:.5} z {z:.1} relvar plain {:.1} guided {:.1} equal {equal:.1} time {:.1} top {:.3} {:.3}",
                    s.id,
                    r(0).value_w_m2,
                    r(1).value_w_m2,
                    vars[0][i] / r(1).value_w_m2.powi(2),
                    vars[1][i] / r(1).value_w_m2.powi(2),
                    equal * per[0] / per[1],
                    fields[0].top_share[i],
                    fields[1].top_share[i]
                );
            }
        }
        ratios.sort_by(f64::total_cmp);
        println!(
            "us/sample plain {:.2} guided {:.2}; equal-time variance ratio median {:.2} min {:.2}",
            per[0] * 1e6,
            per[1] * 1e6,
            ratios[ratios.len() / 2],
            ratios[0]
        );
    }
    Ok(())
}
