//! A picture of the window without a window: the whole program runs offscreen until all is computed and drawn.

use crate::app::{App, Start, write_png};
use crate::args::{Args, Theme, point};
use crate::draw::bounds_m;
use crate::log::Level;
use crate::outdoors::facade::Facade;
use crate::outdoors::shown::dome_bounds_m;
use crate::paint::Offscreen;
use crate::state::{Kept, Picked, State};
use crate::view::facade_at;
use anyhow::{Context, Result, bail};
use glam::Vec2;
use image::RgbaImage;
use petgraph::graph::NodeIndex;
use std::path::Path;
use std::time::Duration;

/// Between two looks at a run that goes on.
const PAUSE: Duration = Duration::from_millis(20);

/// Takes the picture that was asked for and writes it.
///
/// # Errors
/// No graphics adapter, a scene that cannot be read or modelled, something to pick that is not there, a file that cannot be
/// written.
pub fn run(args: &Args, to: &Path) -> Result<()> {
    let mut offscreen = Offscreen::new()?;
    let image = picture(args, &mut offscreen)?;
    write_png(to, &image)?;
    eprintln!("wrote {}", to.display());
    Ok(())
}

/// The picture that was asked for.
///
/// # Errors
/// As [`run`].
pub fn picture(args: &Args, offscreen: &mut Offscreen) -> Result<RgbaImage> {
    let mut app = App::new(offscreen.context(), start(args));
    settle(&mut app, args, offscreen)?;
    arrange(&mut app.state, args)?;
    settle(&mut app, args, offscreen)?;
    // The layers may have brought the sky's dome, which belongs into the picture.
    if args.camera.is_none() {
        crate::view::fit(&mut app.state, app.view.size_px);
    }
    settle(&mut app, args, offscreen)?;
    frame(&mut app, args, offscreen)
}

/// How the program starts for a picture, or in its window by the same arguments.
pub fn start(args: &Args) -> Start {
    let dark = args.theme.map(|theme| theme == Theme::Dark);
    let kept = Kept { dark: if args.screenshot.is_some() { dark.or(Some(true)) } else { dark }, ..Kept::default() };
    Start { scene: args.scene.clone(), kept, ..Start::default() }
}

/// One frame of the program.
fn frame(app: &mut App, args: &Args, offscreen: &mut Offscreen) -> Result<RgbaImage> {
    if args.view_only {
        offscreen.render_ui(args.size, 1.0, |ui| app.show_view(ui))
    } else {
        offscreen.render_ui(args.size, 1.0, |ui| app.show(ui))
    }
}

/// Runs the program until all that was asked is answered.
fn settle(app: &mut App, args: &Args, offscreen: &mut Offscreen) -> Result<()> {
    loop {
        frame(app, args, offscreen)?;
        if let Some(error) = app.state.log.entries.iter().find(|entry| entry.level == Level::Error) {
            bail!("{}", error.line().trim_start_matches("error: "));
        }
        if app.is_settled() {
            return Ok(());
        }
        std::thread::sleep(PAUSE);
    }
}

/// Layers, camera, method and what is picked, as they were typed.
pub fn arrange(state: &mut State, args: &Args) -> Result<()> {
    for look in &args.layers {
        look.apply(&mut state.layers);
    }
    state.request.how.voxel_m = args.voxel.or(state.request.how.voxel_m);
    state.request.how.method = args.method.or(state.request.how.method);
    state.outdoors.date = args.date.unwrap_or(state.outdoors.date);
    if let Some(time) = args.time {
        state.outdoors.time_h = f64::from(time.hour()) + f64::from(time.minute()) / 60.0;
    }
    if let Some(viewpoint) = args.camera {
        let origin_m = state.results.loaded.as_ref().map(|scene| scene.origin_m).unwrap_or_default();
        let bounds_m = dome_bounds_m(state).unwrap_or_else(|| bounds_m(&state.results));
        let aspect = args.size[0] as f32 / args.size[1] as f32;
        state.camera = viewpoint.camera(origin_m, bounds_m, aspect);
    }
    if let Some(what) = &args.pick {
        match what.strip_prefix("wall:") {
            Some(towards) => state.facade = Some(wall(state, args, towards)?),
            None => state.pick(Some(picked(state, what)?)),
        }
    }
    Ok(())
}

/// The face that the camera sees towards a point of the user's.
fn wall(state: &State, args: &Args, towards: &str) -> Result<Facade> {
    let what = format!("--pick wall:{towards}");
    let towards_m = point(towards).with_context(|| format!("{what}: a point is meant, as wall:x,y,z in metres"))?;
    let scene = state.results.scene.as_ref().context("there is no scene")?;
    let size_px = Vec2::new(args.size[0] as f32, args.size[1] as f32);
    let seen = state.camera.project((towards_m - scene.origin_m).as_vec3(), size_px);
    let facade = seen.and_then(|(at_px, _)| facade_at(state, at_px, size_px));
    facade.with_context(|| format!("{what}: the camera sees no face of the mesh there, or the scene has no sun"))
}

/// What is meant by `sensor:ID`, `node:N` or `light:N`.
fn picked(state: &State, what: &str) -> Result<Picked> {
    let (kind, name) = what
        .split_once(':')
        .with_context(|| format!("--pick {what}: sensor:ID, node:N, light:N or wall:X,Y,Z is meant"))?;
    let number = || name.parse::<usize>().with_context(|| format!("--pick {what}: {name:?} is not a number"));
    let scene = state.results.scene.as_ref().context("there is no scene")?;
    Ok(match kind {
        "sensor" => {
            let found = scene.sensors.iter().position(|sensor| sensor.id == name);
            Picked::Sensor(found.with_context(|| format!("--pick {what}: no sensor has that id"))?)
        }
        "light" => {
            let (number, lights) = (number()?, scene.lights.len());
            if number >= lights {
                bail!("--pick {what}: there are {lights} lights, numbered from 0");
            }
            Picked::Light(number)
        }
        "node" => {
            let nodes = state.results.model.as_ref().map_or(0, |model| model.skeleton.graph.node_count());
            let number = number()?;
            if number >= nodes {
                bail!("--pick {what}: there are {nodes} nodes, numbered from 0");
            }
            Picked::Node(NodeIndex::new(number))
        }
        _ => bail!("--pick {what}: sensor:ID, node:N, light:N or wall:X,Y,Z is meant"),
    })
}
