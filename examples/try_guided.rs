use lightvein::flow::network::{Network, Quality};
use lightvein::guide::places;
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
    let seconds: f64 = std::env::var("SECONDS_EACH").ok().and_then(|s| s.parse().ok()).unwrap_or(4.0);
    for path in std::env::args().skip(1) {
        let (p, c) = (Quiet, Cancel::new());
        let scene = Scene::load(Path::new(&path), &p, &c)?;
        let began = Instant::now();
        let rays = Arc::new(Rays::new(&scene));
        let model = Model::build(&scene, rays.clone(), scene.model.voxel_m.unwrap_or(0.1), 4_000_000_000, &p, &c)?;
        let t_model = began.elapsed().as_secs_f64();
        let settings = Settings::default();
        let mut quality = Quality::MEDIUM;
        let e = |k: &str, or: f64| std::env::var(k).ok().and_then(|v| v.parse().ok()).unwrap_or(or);
        quality.spacing = e("SPACING", 0.4) as f32;
        quality.lines = e("LINES", 20.0) as u32;
        quality.all_lines = e("ALL_LINES", 42000.0) as u32;
        quality.neck_lines = e("NECK", 1024.0) as u32;
        let (mut network, lines) = Network::new(&model, &quality, &settings, &p, &c)?;
        let t_net = began.elapsed().as_secs_f64();
        if e("FILL", 1.0) > 0.0 {
            let grounds = &mut network.grounds;
            grounds.patches.fill_gaps(&grounds.zones);
        }
        let network = network;
        let walls = {
            let shine = lightvein::guide::shine::Shine::new(&network);
            places::at_walls(&network, &shine, &lines)
        };
        let t_walls = began.elapsed().as_secs_f64();
        let zones = {
            let shine = lightvein::guide::shine::Shine::new(&network);
            places::in_zones(&network, &shine, &lines, 0)
        };
        let nodes = places::at_nodes(&network, &zones);
        let build = began.elapsed().as_secs_f64();
        let shine = lightvein::guide::shine::Shine::new(&network);
        let g =
            |r: &str, n: &str| lightvein::flow::network::Gather { rays: e(r, 0.0) as u32, neck_rays: e(n, 0.0) as u32 };
        let t0 = Instant::now();
        let own: Vec<lightvein::light::Incident> = if e("SR", 0.0) > 0.0 {
            use rayon::prelude::*;
            model
                .probes_at_sensors(&scene)
                .par_iter()
                .enumerate()
                .map(|(i, probe)| {
                    let cell = probe.place.map(|n| model.skeleton.graph[n].cell).unwrap_or(0);
                    let from = probe.position_m + probe.normal.unwrap_or_default() * rays.epsilon_m();
                    let open = if let Ok(n) = probe.place {
                        zones[network.grounds.zones.at(n.index() as u32, probe.position_m) as usize].direct_w_m2.clone()
                    } else {
                        Vec::new()
                    };
                    lightvein::light::Incident {
                        direct_w_m2: open,
                        ..places::at_point(
                            &network,
                            &shine,
                            &g("SR", "SN"),
                            from,
                            probe.normal,
                            cell,
                            [i as f64 * 0.618 % 1.0, i as f64 * 0.7548 % 1.0],
                        )
                    }
                })
                .collect()
        } else {
            Vec::new()
        };
        let t1 = t0.elapsed().as_secs_f64();
        let mut walls = walls;
        if e("WR", 0.0) > 0.0 {
            use rayon::prelude::*;
            walls.par_iter_mut().enumerate().for_each(|(i, wall)| {
                let cell = network.grounds.zones.cell(network.grounds.patches.list[i].zone);
                let from = wall.position_m + wall.normal.unwrap() * rays.epsilon_m();
                *wall = lightvein::light::Incident {
                    reflected_w_m2: wall.reflected_w_m2,
                    direct_w_m2: wall.direct_w_m2.clone(),
                    ..places::at_point(
                        &network,
                        &shine,
                        &g("WR", "WN"),
                        from,
                        wall.normal,
                        cell,
                        [i as f64 * 0.618 % 1.0, i as f64 * 0.7548 % 1.0],
                    )
                };
            });
        }
        println!("sensors own {t1:.3} walls own {:.3}", t0.elapsed().as_secs_f64() - t1);
        let all: Vec<_> = walls.iter().chain(&zones).chain(&own).collect();
        let zones_of = &network.grounds.zones;
        let open = |at: glam::Vec3| {
            model.skeleton.nearest.node(model.voxels.lattice.voxel_at(at)).map(|n| zones_of.at(n, at) + first)
        };
        let place_of = |at: glam::Vec3, normal: Option<glam::Vec3>| match normal {
            Some(n) => network.grounds.patches.near(&model, zones_of, at, n).or_else(|| open(at)),
            None => open(at),
        };
        let guiding = Guiding {
            places: all,
            at_sensors: (0..own.len()).map(|i| (walls.len() + zones.len() + i) as u32).collect(),
            place_of: &place_of,
        };
        println!(
            "== {path}: {} walls {} nodes {} lines; model {t_model:.3} net {:.3} walls {:.3} nodes {:.3}",
            walls.len(),
            nodes.len(),
            lines.len(),
            t_net - t_model,
            t_walls - t_net,
            build - t_walls
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
                tr.field.readings.iter().map(|r| r.error_w_m2.unwrap().powi(2) * f64::from(n)).collect::<Vec<_>>(),
            );
            fields.push(tr);
        }
        let mut ratios = Vec::new();
        for (i, s) in scene.sensors.iter().enumerate().take(400) {
            let equal = vars[0][i] / vars[1][i];
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
                    ratios[i],
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
