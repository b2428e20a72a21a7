//! What of sun and sky is on the screen: the shown moment, and what was made of the results for the view, each kept until what it
//! was made of changes, so that a still picture costs nothing.

use super::draw::{self, Dome, Drawn};
use super::sky::Sky;
use super::sun::{SunDay, SunNow};
use super::{FaceExposure, OutdoorRequest, PixelExposure};
use crate::colour::Scale;
use crate::layers::MeshColour;
use crate::measure::Measure;
use crate::paint::{Batch, Corner, Culling};
use crate::state::State;
use egui::{Context, TextureHandle, TextureOptions};
use glam::{Vec2, Vec3};
use jiff::civil::{Date, DateTime, date};
use lightvein::daylight::Quantity;
use lightvein::daylight::camera::Camera;
use lightvein::scene::Scene;
use std::sync::Arc;

/// Longest step of the shown time while it is played, seconds of the viewer's own: after a pause it does not jump.
const LONGEST_STEP: f64 = 0.1;

/// Sun and sky as the panels show them.
pub struct OutdoorState {
    /// The day that is shown.
    pub date: Date,
    /// The time that is shown, hours since midnight, local standard time.
    pub time_h: f64,
    /// Whether the shown time runs.
    pub is_playing: bool,
    /// How fast it runs, hours a second.
    pub hours_a_second: f64,
    /// Whether it goes on to the next day at midnight, instead of beginning the same one again.
    pub runs_on: bool,
    /// The sun on that day; `None` without a site.
    pub day: Option<Arc<SunDay>>,
    /// The sun and the sky at that time.
    pub now: Option<Arc<SunNow>>,
    /// Why there is no sun to show, where there should be one.
    pub problem: Option<String>,
    kept: Kept,
}

/// What each is made of.
type OfDome = (Arc<SunDay>, Arc<SunNow>, Arc<Scene>);
type OfCorners = (Arc<FaceExposure>, Quantity);
type OfOverlay = (Arc<PixelExposure>, Quantity, Scale);

/// What was made for the view, with what it was made of.
#[derive(Default)]
struct Kept {
    scene: Option<Arc<Scene>>,
    sky: Option<Arc<Sky>>,
    dome: Option<(OfDome, Arc<Drawn>)>,
    corners: Option<(OfCorners, Arc<Vec<Corner>>)>,
    overlay: Option<(OfOverlay, TextureHandle)>,
    map: Option<((Arc<Sky>, Scale), TextureHandle)>,
}

impl Default for OutdoorState {
    fn default() -> Self {
        Self {
            date: date(2025, 6, 21),
            time_h: 12.0,
            is_playing: false,
            hours_a_second: 2.0,
            runs_on: false,
            day: None,
            now: None,
            problem: None,
            kept: Kept::default(),
        }
    }
}

impl OutdoorState {
    /// The shown moment.
    pub fn moment(&self) -> DateTime {
        let seconds = (self.time_h.clamp(0.0, 24.0) * 3600.0).round().min(86_399.0) as i64;
        let midnight = self.date.at(0, 0, 0, 0);
        midnight.checked_add(jiff::SignedDuration::from_secs(seconds)).unwrap_or(midnight)
    }

    /// Lets so many seconds of the viewer's own time go by.
    pub fn play(&mut self, seconds: f64) {
        if !self.is_playing {
            return;
        }
        let later_h = self.time_h + seconds * self.hours_a_second;
        if self.runs_on && later_h >= 24.0 {
            self.date = self.date.tomorrow().unwrap_or(self.date);
        }
        self.time_h = later_h.rem_euclid(24.0);
    }

    /// The sun's day and moment under a sky, made anew where the date, the time or the sky is another.
    fn shine(&mut self, sky: Option<&Arc<Sky>>) {
        let Some(sky) = sky else {
            (self.day, self.now, self.problem, self.kept.sky) = (None, None, None, None);
            return;
        };
        // Days are those of the site's year, so that a year's end goes on with its beginning.
        let year = sky.outdoors.year;
        if self.date.year() != year {
            let same_day = Date::new(year, self.date.month(), self.date.day());
            self.date = same_day.unwrap_or(date(year, 2, 28));
        }
        let (date, moment) = (self.date, self.moment());
        let is_same_sky = self.kept.sky.as_ref().is_some_and(|known| Arc::ptr_eq(known, sky));
        let has_day = self.day.as_ref().is_some_and(|day| day.date == date);
        let has_moment = self.now.as_ref().is_some_and(|now| now.moment == moment);
        if is_same_sky && (has_day && has_moment || self.problem.is_some()) {
            return;
        }
        let day = match &self.day {
            Some(day) if day.date == date && day.place == sky.outdoors.place => Ok(Arc::clone(day)),
            _ => SunDay::of(sky.outdoors.place, date).map(Arc::new),
        };
        let found = day.and_then(|day| Ok((day, Arc::new(SunNow::of(&sky.outdoors, moment)?))));
        self.kept.sky = Some(Arc::clone(sky));
        self.problem = found.as_ref().err().map(ToString::to_string);
        (self.day, self.now) = found.ok().unzip();
    }
}

/// To be called once a frame: a scene with a site is asked about it, the shown time runs while it is played, and the sun follows.
pub fn tick(state: &mut State, ctx: &Context) {
    follow_scene(state);
    if state.outdoors.is_playing {
        state.outdoors.play(ctx.input(|input| f64::from(input.stable_dt)).min(LONGEST_STEP));
        ctx.request_repaint();
    }
    state.outdoors.shine(state.results.outdoors.sky.as_ref());
}

/// A scene that was just opened and has a site is asked about it; that is no step to undo.
fn follow_scene(state: &mut State) {
    let Some(scene) = &state.results.loaded else { return };
    if state.outdoors.kept.scene.as_ref().is_some_and(|known| Arc::ptr_eq(known, scene)) {
        return;
    }
    state.outdoors.kept.scene = Some(Arc::clone(scene));
    if scene.site.is_some() && state.request.outdoors.is_none() {
        state.request.outdoors = Some(OutdoorRequest::default());
    }
}

/// Asks for the pixels of the view as it is now, or no more; to be called when the camera has come to rest. A view is looked at
/// and not changed by hand, so it is no step to undo.
pub fn follow_view(state: &mut State, size_px: Vec2) {
    let wanted = state.layers.per_pixel.then(|| seen_by(&state.camera, size_px)).flatten();
    if let Some(asked) = &mut state.request.outdoors
        && asked.view != wanted
    {
        asked.view = wanted;
    }
}

/// The camera of the view as the library has it; `None` for a parallel projection, which it does not know.
pub fn seen_by(camera: &crate::camera::Camera, size_px: Vec2) -> Option<Camera> {
    let size = [size_px.x.round() as usize, size_px.y.round() as usize];
    let is_picture = size.iter().all(|side| (1..=10_000).contains(side));
    (is_picture && !camera.orthographic).then(|| Camera {
        from_m: camera.eye_m(),
        forward: camera.forward(),
        right: camera.right(),
        up: camera.up(),
        fov_rad: f64::from(camera.field_of_view_rad),
        size,
    })
}

/// What is drawn of sun and sky in the view: exposure on the faces of the mesh, and the dome with the sun's path.
pub fn batches(state: &mut State) -> Vec<Batch> {
    let faces = exposed_faces(state);
    let dome = drawn_dome(state).map(|dome| dome.batches.clone()).unwrap_or_default();
    // The dome's own sky gives way to the one behind the scene.
    let is_open = state.layers.shadows;
    faces.into_iter().chain(dome.into_iter().skip(usize::from(is_open))).collect()
}

/// The names beside what is drawn, and where they stand.
pub fn labels(state: &mut State) -> Vec<(Vec3, String)> {
    drawn_dome(state).map(|dome| dome.labels.clone()).unwrap_or_default()
}

/// Whether the faces of the mesh are drawn by [`batches`], so that nobody else draws them.
pub fn draws_faces(state: &State) -> bool {
    let layers = &state.layers;
    layers.mesh && layers.mesh_colour == MeshColour::Exposure && state.results.outdoors.faces.is_some()
}

/// The box around the dome, where one is shown: what a view of everything has to hold.
pub fn dome_bounds_m(state: &State) -> Option<(Vec3, Vec3)> {
    Some(dome_of(state)?.bounds_m()).filter(|_| state.layers.sun_path)
}

fn dome_of(state: &State) -> Option<Dome> {
    let north_rad = state.results.outdoors.sky.as_ref()?.outdoors.north_rad;
    Some(Dome::about(state.results.loaded.as_ref()?.mesh.bounds_m()?, north_rad))
}

fn drawn_dome(state: &mut State) -> Option<Arc<Drawn>> {
    if !state.layers.sun_path {
        return None;
    }
    let shown = &state.outdoors;
    let key = (shown.day.clone()?, shown.now.clone()?, state.results.loaded.clone()?);
    if let Some((known, drawn)) = &shown.kept.dome
        && Arc::ptr_eq(&known.0, &key.0)
        && Arc::ptr_eq(&known.1, &key.1)
        && Arc::ptr_eq(&known.2, &key.2)
    {
        return Some(Arc::clone(drawn));
    }
    let sun_path = Arc::clone(&state.results.outdoors.sky.as_ref()?.sun_path);
    let drawn = Arc::new(draw::dome(&dome_of(state)?, &key.0, &key.1, &sun_path));
    state.outdoors.kept.dome = Some((key, Arc::clone(&drawn)));
    Some(drawn)
}

fn exposed_faces(state: &mut State) -> Option<Batch> {
    if !draws_faces(state) {
        return None;
    }
    let quantity = state.layers.quantity;
    let scale = state.scale(Measure::of(quantity));
    let faces = Arc::clone(state.results.outdoors.faces.as_ref()?);
    // Sides are known by triangle as long as none is hidden.
    let triangles = faces.scenery.scene.mesh.triangles.len();
    let sides = state.results.sides.clone().filter(|sides| sides.len() == triangles);
    let corners = match &state.outdoors.kept.corners {
        Some(((known, of), corners)) if Arc::ptr_eq(known, &faces) && *of == quantity => Arc::clone(corners),
        _ => Arc::new(draw::corners(&faces, quantity, sides.as_deref().map(Vec::as_slice))),
    };
    state.outdoors.kept.corners = Some(((faces, quantity), Arc::clone(&corners)));
    let culling = if state.layers.cull_near_walls { Culling::ToVoid } else { Culling::None };
    Some(draw::faces(corners, scale, culling))
}

/// Exposure by pixels, to be laid over the whole view; `None` while the view is not the one that was asked.
pub fn overlay(state: &mut State, ctx: &Context, size_px: Vec2) -> Option<TextureHandle> {
    let pixels = Arc::clone(state.results.outdoors.pixels.as_ref().filter(|_| state.layers.per_pixel)?);
    let now = seen_by(&state.camera, size_px)?;
    let is_this_view = Camera { size: now.size, ..pixels.view } == now;
    if !is_this_view {
        return None;
    }
    let quantity = state.layers.quantity;
    let scale = state.scale(Measure::of(quantity));
    if let Some(((known, of, by), texture)) = &state.outdoors.kept.overlay
        && (Arc::ptr_eq(known, &pixels) && (*of, *by) == (quantity, scale))
    {
        return Some(texture.clone());
    }
    let picture = draw::picture(&pixels, quantity, &scale);
    let texture = ctx.load_texture("exposure by pixels", picture, TextureOptions::NEAREST);
    state.outdoors.kept.overlay = Some(((pixels, quantity, scale), texture.clone()));
    Some(texture)
}

/// The exposure map as a picture, the horizon at its foot and north at both sides.
pub fn map_picture(state: &mut State, ctx: &Context) -> Option<TextureHandle> {
    let sky = Arc::clone(state.results.outdoors.sky.as_ref()?);
    let scale = state.scale(Measure::MapRadiance);
    if let Some(((known, by), texture)) = &state.outdoors.kept.map
        && (Arc::ptr_eq(known, &sky) && *by == scale)
    {
        return Some(texture.clone());
    }
    let texture = ctx.load_texture("exposure map", draw::map(&sky, &scale), TextureOptions::NEAREST);
    state.outdoors.kept.map = Some(((sky, scale), texture.clone()));
    Some(texture)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_runs_while_it_is_played_and_midnight_may_begin_the_next_day() {
        let mut shown = OutdoorState { time_h: 23.0, hours_a_second: 2.0, ..OutdoorState::default() };
        shown.play(1.0);
        assert_eq!(shown.time_h, 23.0);
        shown.is_playing = true;
        shown.play(1.0);
        assert_eq!((shown.time_h, shown.date), (1.0, date(2025, 6, 21)));
        (shown.time_h, shown.runs_on) = (23.5, true);
        shown.play(1.0);
        assert_eq!((shown.time_h, shown.date), (1.5, date(2025, 6, 22)));
        assert_eq!(shown.moment(), date(2025, 6, 22).at(1, 30, 0, 0));
        shown.time_h = 24.0;
        assert_eq!(shown.moment(), date(2025, 6, 22).at(23, 59, 59, 0));
    }
}
