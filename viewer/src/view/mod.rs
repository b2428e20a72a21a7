//! The pane with the picture: mouse and keys move the camera, pick and drag; names, chips and legends stand over it.

mod drag;
mod overlay;

pub use overlay::words;

use crate::controls::{self, Gesture, Touch};
use crate::draw::{Drawer, Wake, bounds_m, longest_m};
use crate::outdoors::facade::Facade;
use crate::outdoors::shown as outdoors;
use crate::paint;
use crate::panels::scene::asked_lights;
use crate::pick;
use crate::state::{Picked, State};
use drag::Drag;
use egui::{PointerButton, Rect, Response, Role, Sense, Ui, WidgetInfo};
use glam::{Vec2, Vec3};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The name of the view for screen readers and tests.
pub const NAME: &str = "3D view";

/// A notch of the wheel makes it nearer by this factor.
const ZOOM_A_POINT: f32 = 1.0025;

/// Flying crosses the distance to what is looked at in this many seconds.
const FLY_SECONDS: f32 = 1.5;

/// The camera has come to rest when it has not moved for so long.
const REST: Duration = Duration::from_millis(300);

/// The pane's own state: what it draws with and what the hand is at.
pub struct View {
    drawer: Drawer,
    wake: Wake,
    drag: Option<Drag>,
    moved: Option<Instant>,
    camera: Option<crate::camera::Camera>,
    /// The size of the pane at its last frame, pixels.
    pub size_px: Vec2,
}

impl View {
    /// A view; `wake` asks for a repaint from another thread.
    pub fn new(wake: Wake) -> Self {
        Self { drawer: Drawer::default(), wake, drag: None, moved: None, camera: None, size_px: Vec2::splat(100.0) }
    }

    /// Whether a layer is still being made.
    pub fn is_busy(&self) -> bool {
        self.drawer.is_busy() || self.moved.is_some()
    }

    /// Shows the pane in all the space there is.
    pub fn show(&mut self, ui: &mut Ui, state: &mut State) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, NAME));
        let pixels_per_point = ui.ctx().pixels_per_point();
        self.size_px = to_glam(rect.size()) * pixels_per_point;
        if self.size_px.min_element() < 1.0 {
            return;
        }
        let frame = Frame { rect, size_px: self.size_px, pixels_per_point };

        self.fly(ui, state, &response);
        self.touch(ui, state, &response, &frame);
        self.hover(ui, state, &response, &frame);
        state.gizmo = drag::gizmo(state, self.size_px);

        let drawn = self.drawer.draw(state, self.size_px, ui.visuals().dark_mode, &self.wake);
        ui.painter().add(paint::callback(rect, 0, Arc::clone(&drawn.picture)));
        self.rest(ui, state);
        let over = overlay::Over { frame: &frame, labels: &drawn.labels, notes: &drawn.notes };
        overlay::show(ui, state, &over);
    }

    /// Moves the camera while keys are held.
    fn fly(&mut self, ui: &Ui, state: &mut State, response: &Response) {
        let towards = controls::flying(ui.ctx(), state.kept.preset);
        let is_here =
            response.contains_pointer() || response.has_focus() || ui.memory(|memory| memory.focused().is_none());
        if towards == Vec3::ZERO || !is_here {
            return;
        }
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        state.camera.fly(towards, state.camera.distance_m * seconds / FLY_SECONDS);
        ui.ctx().request_repaint();
    }

    /// What the mouse does.
    fn touch(&mut self, ui: &Ui, state: &mut State, response: &Response, frame: &Frame) {
        let (modifiers, preset) = (ui.input(|input| input.modifiers), state.kept.preset);
        let pointer_px = response.interact_pointer_pos().map(|at| frame.to_px(at));
        let gesture = |touch| controls::touched(touch, modifiers, preset);

        for button in [PointerButton::Primary, PointerButton::Secondary, PointerButton::Middle] {
            if response.drag_started_by(button) && button == PointerButton::Primary {
                let from = ui.input(|input| input.pointer.press_origin()).map(|at| frame.to_px(at));
                self.drag = from.and_then(|from_px| Drag::begin(state, from_px, frame.size_px));
            }
            if !response.dragged_by(button) {
                continue;
            }
            let delta_px = to_glam(response.drag_delta()) * frame.pixels_per_point;
            match (&mut self.drag, pointer_px, gesture(Touch::Drag(button))) {
                (Some(drag), Some(pointer_px), _) if button == PointerButton::Primary => {
                    drag.follow(state, pointer_px, frame.size_px);
                }
                (_, _, Some(Gesture::Orbit)) => state.camera.orbit(delta_px, frame.size_px),
                (_, _, Some(Gesture::Pan)) => state.camera.pan(delta_px, frame.size_px),
                (_, Some(pointer_px), Some(Gesture::Zoom)) => {
                    state.camera.zoom(ZOOM_A_POINT.powf(-delta_px.y), pointer_px, frame.size_px);
                }
                _ => {}
            }
        }
        if response.drag_stopped() {
            self.drag = None;
        }
        let hover_px = response.hover_pos().map(|at| frame.to_px(at));
        if let (true, Some(at_px)) = (response.contains_pointer(), hover_px) {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta()));
            if gesture(Touch::Wheel) == Some(Gesture::Zoom) && scroll.y != 0.0 {
                state.camera.zoom(ZOOM_A_POINT.powf(scroll.y), at_px, frame.size_px);
            }
            if pinch != 1.0 {
                state.camera.zoom(pinch, at_px, frame.size_px);
            }
        }
        let Some(at_px) = pointer_px else { return };
        if response.clicked() || response.double_clicked() {
            response.request_focus();
        }
        if response.double_clicked() && gesture(Touch::DoubleClick(PointerButton::Primary)) == Some(Gesture::Focus) {
            focus_at(state, at_px, frame.size_px);
        } else if response.clicked() && gesture(Touch::Click(PointerButton::Primary)) == Some(Gesture::Pick) {
            state.pick(picked_at(state, at_px, frame.size_px, true));
            state.facade = facade_at(state, at_px, frame.size_px);
        }
    }

    /// What lies under the pointer.
    fn hover(&mut self, ui: &Ui, state: &mut State, response: &Response, frame: &Frame) {
        let at_px = response.hover_pos().filter(|_| response.contains_pointer()).map(|at| frame.to_px(at));
        let is_held = ui.input(|input| input.pointer.any_down());
        state.hovered = at_px.filter(|_| !is_held).and_then(|at_px| picked_at(state, at_px, frame.size_px, false));
    }

    /// Asks for what depends on the view once that has come to rest.
    fn rest(&mut self, ui: &Ui, state: &mut State) {
        if !state.layers.per_pixel {
            outdoors::follow_view(state, self.size_px);
            self.moved = None;
            return;
        }
        if self.camera != Some(state.camera) {
            self.camera = Some(state.camera);
            self.moved = Some(Instant::now());
        }
        match self.moved {
            Some(moved) if moved.elapsed() >= REST => {
                outdoors::follow_view(state, self.size_px);
                self.moved = None;
            }
            Some(moved) => ui.ctx().request_repaint_after(REST.saturating_sub(moved.elapsed())),
            None => outdoors::follow_view(state, self.size_px),
        }
    }
}

/// Where the pane is.
pub struct Frame {
    /// On screen, points.
    pub rect: Rect,
    /// Its size, pixels.
    pub size_px: Vec2,
    /// Pixels a point.
    pub pixels_per_point: f32,
}

impl Frame {
    /// A place on screen in the picture's pixels.
    pub fn to_px(&self, at: egui::Pos2) -> Vec2 {
        to_glam(at - self.rect.min) * self.pixels_per_point
    }

    /// A place in the picture on screen.
    pub fn to_point(&self, at_px: Vec2) -> egui::Pos2 {
        self.rect.min + egui::vec2(at_px.x, at_px.y) / self.pixels_per_point
    }
}

/// Whether a place on the mesh is cut away or drawn from its other side alone.
fn is_hidden(state: &State, at_m: Vec3, triangle: usize, direction: Vec3) -> bool {
    let is_cut = crate::draw::cuts(&state.layers, bounds_m(&state.results))
        .iter()
        .any(|cut| cut.normal.dot(at_m) > cut.offset_m);
    let (Some(scene), true) = (&state.results.scene, state.layers.cull_near_walls) else { return is_cut };
    let sides = state.results.sides.as_ref().and_then(|sides| sides.get(triangle)).copied().unwrap_or(3);
    let Some([a, b, c]) = scene.mesh.corners_m(triangle) else { return is_cut };
    let sees_front = (b - a).cross(c - a).dot(direction) < 0.0;
    is_cut || sides & if sees_front { 1 } else { 2 } == 0
}

/// What is picked at a place of the picture; with `parts` also parts of the mesh.
fn picked_at(state: &State, at_px: Vec2, size_px: Vec2, parts: bool) -> Option<Picked> {
    let lights = asked_lights(state);
    let thing = pick::pick(&state.results, &lights, &state.layers, &state.camera, at_px, size_px);
    let part = || {
        let hidden = |at_m, triangle, direction| is_hidden(state, at_m, triangle, direction);
        let (_, triangle) = pick::surface(&state.results, &state.camera, at_px, size_px, hidden)?;
        pick::part_of(&state.results, triangle).map(Picked::Part)
    };
    thing.or_else(|| part().filter(|_| parts && state.layers.mesh))
}

/// The face of the mesh under the pointer, of a scene under a sun, where nothing else is picked but the part that it is of.
fn facade_at(state: &State, at_px: Vec2, size_px: Vec2) -> Option<Facade> {
    let is_mesh = state.layers.mesh && matches!(state.picked, None | Some(Picked::Part(_)));
    state.outdoors.now.as_ref().filter(|_| is_mesh)?;
    let hidden = |at_m, triangle, direction| is_hidden(state, at_m, triangle, direction);
    let (at_m, triangle) = pick::surface(&state.results, &state.camera, at_px, size_px, hidden)?;
    let [a, b, c] = state.results.scene.as_ref()?.mesh.corners_m(triangle)?;
    let front = (b - a).cross(c - a).try_normalize()?;
    let (_, direction) = state.camera.ray(at_px, size_px);
    Some(Facade { at_m, normal: if front.dot(direction) > 0.0 { -front } else { front } })
}

/// Looks at what lies under the pointer.
fn focus_at(state: &mut State, at_px: Vec2, size_px: Vec2) {
    let lights = asked_lights(state);
    let thing = picked_at(state, at_px, size_px, false)
        .and_then(|picked| crate::draw::marks::position_m(&state.results, &lights, picked));
    let hidden = |at_m, triangle, direction| is_hidden(state, at_m, triangle, direction);
    let wall = || pick::surface(&state.results, &state.camera, at_px, size_px, hidden).map(|(at_m, _)| at_m);
    if let Some(at_m) = thing.or_else(wall) {
        state.camera.focus(at_m);
    }
}

/// Looks at what is picked; at the whole scene where nothing is.
pub fn focus_on_picked(state: &mut State, size_px: Vec2) {
    let lights = asked_lights(state);
    match state.picked.and_then(|picked| crate::draw::marks::position_m(&state.results, &lights, picked)) {
        Some(at_m) => state.camera.focus(at_m),
        None => fit(state, size_px),
    }
}

/// Fits the view to the scene, and to the sky's dome where that is shown.
pub fn fit(state: &mut State, size_px: Vec2) {
    let bounds = outdoors::dome_bounds_m(state).unwrap_or_else(|| bounds_m(&state.results));
    state.camera.fit(bounds, size_px.x / size_px.y.max(1.0));
}

/// The length that the gizmo's arrows have on screen, in metres at a place.
fn gizmo_length_m(state: &State, at_m: Vec3, size_px: Vec2) -> f32 {
    (70.0 * state.camera.metres_per_px(at_m, size_px)).min(longest_m(&state.results))
}

fn to_glam(along: egui::Vec2) -> Vec2 {
    Vec2::new(along.x, along.y)
}
