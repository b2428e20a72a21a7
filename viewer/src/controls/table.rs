//! The table of controls itself.

use super::{Command, Gesture, KeyRow, Layer, Preset, Stroke, TextScale, Topic, Touch, TouchRow};
use crate::camera::Standard;
use egui::{Key, PointerButton};

const fn plain(key: Key) -> Stroke {
    Stroke { key, ctrl: false, shift: Some(false) }
}

const fn ctrl(key: Key) -> Stroke {
    Stroke { key, ctrl: true, shift: Some(false) }
}

const fn ctrl_shift(key: Key) -> Stroke {
    Stroke { key, ctrl: true, shift: Some(true) }
}

/// For signs that need Shift on some keyboards and not on others.
const fn sign(key: Key, ctrl: bool) -> Stroke {
    Stroke { key, ctrl, shift: None }
}

const fn view(stroke: Stroke, command: Command, does: &'static str) -> KeyRow {
    KeyRow { topic: Topic::View, stroke, command, does, preset: None }
}

const fn layer(key: Key, layer: Layer, does: &'static str) -> KeyRow {
    KeyRow { topic: Topic::Layers, stroke: plain(key), command: Command::Toggle(layer), does, preset: None }
}

const fn program(stroke: Stroke, command: Command, does: &'static str) -> KeyRow {
    KeyRow { topic: Topic::Program, stroke, command, does, preset: None }
}

/// All keys.
pub const KEYS: &[KeyRow] = &[
    view(plain(Key::W), Command::Fly([0, 1, 0]), "fly forward"),
    view(plain(Key::S), Command::Fly([0, -1, 0]), "fly back"),
    view(plain(Key::A), Command::Fly([-1, 0, 0]), "fly left"),
    view(plain(Key::D), Command::Fly([1, 0, 0]), "fly right"),
    view(plain(Key::E), Command::Fly([0, 0, 1]), "fly up"),
    view(plain(Key::Q), Command::Fly([0, 0, -1]), "fly down"),
    KeyRow { preset: Some(Preset::Lightvein), ..view(plain(Key::F), Command::Fit, "fit the scene") },
    KeyRow { preset: Some(Preset::Blender), ..view(plain(Key::Home), Command::Fit, "fit the scene") },
    view(plain(Key::Period), Command::Focus, "look at what is picked"),
    view(plain(Key::Num1), Command::Look(Standard::Front), "look from the front (south)"),
    view(plain(Key::Num3), Command::Look(Standard::Right), "look from the right (east)"),
    view(plain(Key::Num7), Command::Look(Standard::Top), "look from above"),
    view(ctrl(Key::Num1), Command::Look(Standard::Back), "look from the back (north)"),
    view(ctrl(Key::Num3), Command::Look(Standard::Left), "look from the left (west)"),
    view(ctrl(Key::Num7), Command::Look(Standard::Bottom), "look from below"),
    view(plain(Key::Num5), Command::Projection, "perspective or parallel projection"),
    layer(Key::M, Layer::Mesh, "mesh"),
    layer(Key::V, Layer::Voxels, "voxels"),
    layer(Key::N, Layer::Nodes, "nodes"),
    layer(Key::G, Layer::Edges, "edges"),
    layer(Key::R, Layer::Arrows, "arrows along the flow"),
    layer(Key::C, Layer::Cells, "cells"),
    layer(Key::K, Layer::Necks, "necks"),
    layer(Key::P, Layer::Sensors, "sensors"),
    layer(Key::L, Layer::Lights, "lights"),
    layer(Key::B, Layer::Ball, "ball of the picked node"),
    layer(Key::T, Layer::Paths, "paths to the lights"),
    layer(Key::X, Layer::Cut, "cut below the ceiling"),
    layer(Key::H, Layer::Shadows, "sunlight and shadows"),
    program(plain(Key::Space), Command::Play, "play the day, or stop it"),
    program(plain(Key::Escape), Command::Cancel, "stop the run, pick nothing"),
    program(sign(Key::Questionmark, false), Command::Help, "this sheet"),
    program(plain(Key::F1), Command::Help, "this sheet"),
    program(ctrl(Key::O), Command::Open, "open a scene or a mesh"),
    program(plain(Key::F5), Command::Reload, "read and compute again"),
    program(ctrl(Key::Z), Command::Undo, "undo"),
    program(ctrl_shift(Key::Z), Command::Redo, "redo"),
    program(ctrl(Key::Y), Command::Redo, "redo"),
    program(ctrl(Key::S), Command::SavePicture, "save a picture"),
    program(ctrl(Key::E), Command::Export, "export all files"),
    program(sign(Key::Plus, true), Command::Text(TextScale::Larger), "larger text"),
    program(sign(Key::Equals, true), Command::Text(TextScale::Larger), "larger text"),
    program(sign(Key::Minus, true), Command::Text(TextScale::Smaller), "smaller text"),
    program(ctrl(Key::Num0), Command::Text(TextScale::Reset), "text as it was"),
    program(ctrl(Key::Q), Command::Quit, "close the window"),
];

const fn touch(touch: Touch, gesture: Gesture, does: &'static str) -> TouchRow {
    TouchRow { touch, ctrl: false, shift: false, gesture, does, preset: None }
}

const fn lightvein(row: TouchRow) -> TouchRow {
    TouchRow { preset: Some(Preset::Lightvein), ..row }
}

const fn blender(row: TouchRow) -> TouchRow {
    TouchRow { preset: Some(Preset::Blender), ..row }
}

/// All that the mouse does in the view.
pub const TOUCHES: &[TouchRow] = &[
    lightvein(touch(Touch::Drag(PointerButton::Primary), Gesture::Orbit, "turn")),
    lightvein(TouchRow { shift: true, ..touch(Touch::Drag(PointerButton::Primary), Gesture::Pan, "move aside") }),
    lightvein(touch(Touch::Drag(PointerButton::Secondary), Gesture::Pan, "move aside")),
    lightvein(touch(Touch::Drag(PointerButton::Middle), Gesture::Pan, "move aside")),
    blender(touch(Touch::Drag(PointerButton::Middle), Gesture::Orbit, "turn")),
    blender(TouchRow { shift: true, ..touch(Touch::Drag(PointerButton::Middle), Gesture::Pan, "move aside") }),
    blender(TouchRow { ctrl: true, ..touch(Touch::Drag(PointerButton::Middle), Gesture::Zoom, "nearer or farther") }),
    touch(Touch::Wheel, Gesture::Zoom, "nearer or farther, to the pointer"),
    touch(Touch::Click(PointerButton::Primary), Gesture::Pick, "pick a node, a sensor, a light, a part or a wall"),
    touch(Touch::DoubleClick(PointerButton::Primary), Gesture::Focus, "look at what lies there"),
];
