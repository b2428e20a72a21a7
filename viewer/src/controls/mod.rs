//! Which keys and mouse buttons do what: one table, which input and the help sheet both read.
//!
//! [`KEYS`] and [`TOUCHES`] are the table. [`pressed`] and [`flying`] read the keys, [`gesture`] and [`touched`] the mouse. Keys do
//! nothing while text is typed, and Space is left to a widget that the keyboard has reached.

mod table;

pub use table::{KEYS, TOUCHES};

use crate::camera::Standard;
use egui::{Event, Key, Modifiers, PointerButton};
use serde::{Deserialize, Serialize};

/// A set of controls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Preset {
    /// Left orbits, right or middle pans.
    #[default]
    Lightvein,
    /// As Blender has it: middle orbits, Shift and middle pans, left picks.
    Blender,
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Lightvein, Self::Blender];

    /// Its name on screen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lightvein => "Lightvein",
            Self::Blender => "Blender",
        }
    }
}

/// A layer that a key switches on and off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layer {
    /// The mesh.
    Mesh,
    /// Voxels.
    Voxels,
    /// Nodes of the skeleton.
    Nodes,
    /// Edges of the skeleton.
    Edges,
    /// Arrows along the flow.
    Arrows,
    /// Cells.
    Cells,
    /// Necks.
    Necks,
    /// Sensors.
    Sensors,
    /// Lights.
    Lights,
    /// The maximal ball of the picked node.
    Ball,
    /// Paths to the lights.
    Paths,
    /// The cut below the ceiling.
    Cut,
    /// Sunlight and shadows.
    Shadows,
}

impl Layer {
    /// Its switch.
    pub fn switch(self, layers: &mut crate::layers::Layers) -> &mut bool {
        match self {
            Self::Mesh => &mut layers.mesh,
            Self::Voxels => &mut layers.voxels,
            Self::Nodes => &mut layers.nodes,
            Self::Edges => &mut layers.edges,
            Self::Arrows => &mut layers.arrows,
            Self::Cells => &mut layers.cells,
            Self::Necks => &mut layers.necks,
            Self::Sensors => &mut layers.sensors,
            Self::Lights => &mut layers.lights,
            Self::Ball => &mut layers.ball,
            Self::Paths => &mut layers.paths,
            Self::Cut => &mut layers.cut,
            Self::Shadows => &mut layers.shadows,
        }
    }

    /// Switches it on or off, with what belongs to it.
    pub fn set(self, layers: &mut crate::layers::Layers, is_on: bool) {
        match self {
            Self::Shadows => layers.light_by_sun(is_on),
            layer => *layer.switch(layers) = is_on,
        }
    }
}

/// What the text scale becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextScale {
    /// A step larger.
    Larger,
    /// A step smaller.
    Smaller,
    /// As it was at first.
    Reset,
}

/// What a key does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// While it is held: fly along right, forward and up, each -1, 0 or 1.
    Fly([i8; 3]),
    /// Fit the view to the scene.
    Fit,
    /// Look at what is picked.
    Focus,
    /// Look from a standard direction.
    Look(Standard),
    /// Change between perspective and parallel projection.
    Projection,
    /// Switch a layer.
    Toggle(Layer),
    /// Play the time of sun and sky, or stop it.
    Play,
    /// Stop the run; close the help sheet; pick nothing.
    Cancel,
    /// Show the sheet of controls, or close it.
    Help,
    /// Ask for a file and open it.
    Open,
    /// Compute again from the file.
    Reload,
    /// One step back.
    Undo,
    /// One step forth.
    Redo,
    /// Save a picture of the window.
    SavePicture,
    /// Write the files that the command line writes.
    Export,
    /// Text larger or smaller.
    Text(TextScale),
    /// Close the window.
    Quit,
}

/// Under which heading of the help sheet something stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Topic {
    /// The camera.
    View,
    /// What is shown.
    Layers,
    /// Files, steps and the window.
    Program,
}

impl Topic {
    /// All of them, in the order of the sheet.
    pub const ALL: [Self; 3] = [Self::View, Self::Layers, Self::Program];

    /// Its heading.
    pub const fn title(self) -> &'static str {
        match self {
            Self::View => "View",
            Self::Layers => "Layers",
            Self::Program => "Program",
        }
    }
}

/// A key with what is held besides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stroke {
    /// The key.
    pub key: Key,
    /// Whether Ctrl (on a Mac: Command) is held.
    pub ctrl: bool,
    /// Whether Shift is held; `None` for signs that need it on some keyboards and not on others.
    pub shift: Option<bool>,
}

impl Stroke {
    /// Whether a key event is this one.
    fn is(self, key: Key, modifiers: Modifiers) -> bool {
        let shift_fits = self.shift.is_none_or(|shift| shift == modifiers.shift);
        self.key == key && self.ctrl == modifiers.command && shift_fits && !modifiers.alt
    }

    /// How it is written: `Ctrl+Shift+Z`.
    pub fn name(self) -> String {
        let ctrl = if self.ctrl { "Ctrl+" } else { "" };
        let shift = if self.shift == Some(true) { "Shift+" } else { "" };
        // The sign of a minus in this font is longer than the key's.
        let key = match self.key {
            Key::Minus => "-",
            Key::Escape => "Esc",
            key => key.symbol_or_name(),
        };
        format!("{ctrl}{shift}{key}")
    }
}

/// A row of the table of keys.
#[derive(Debug, Clone, Copy)]
pub struct KeyRow {
    /// Where it stands on the help sheet.
    pub topic: Topic,
    /// The key.
    pub stroke: Stroke,
    /// What it does.
    pub command: Command,
    /// The same in words.
    pub does: &'static str,
    /// The preset that it belongs to; `None` for all.
    pub preset: Option<Preset>,
}

/// What the mouse does in the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gesture {
    /// Turn the camera around its target.
    Orbit,
    /// Shift the camera.
    Pan,
    /// Nearer and farther.
    Zoom,
    /// Look at what lies under the pointer.
    Focus,
    /// Pick what lies under the pointer.
    Pick,
}

/// What is done with the mouse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// A button is held and the mouse moved.
    Drag(PointerButton),
    /// A button is clicked.
    Click(PointerButton),
    /// A button is clicked twice.
    DoubleClick(PointerButton),
    /// The wheel is turned.
    Wheel,
}

/// A row of the table of the mouse.
#[derive(Debug, Clone, Copy)]
pub struct TouchRow {
    /// What is done.
    pub touch: Touch,
    /// Whether Ctrl is held.
    pub ctrl: bool,
    /// Whether Shift is held.
    pub shift: bool,
    /// What it does.
    pub gesture: Gesture,
    /// The same in words.
    pub does: &'static str,
    /// The preset that it belongs to; `None` for all.
    pub preset: Option<Preset>,
}

impl TouchRow {
    /// How it is written: `Shift + drag with the left button`.
    pub fn name(&self) -> String {
        let ctrl = if self.ctrl { "Ctrl + " } else { "" };
        let shift = if self.shift { "Shift + " } else { "" };
        let button = |button| match button {
            PointerButton::Primary => "left",
            PointerButton::Secondary => "right",
            PointerButton::Middle => "middle",
            PointerButton::Extra1 => "fourth",
            PointerButton::Extra2 => "fifth",
        };
        match self.touch {
            Touch::Drag(with) => format!("{ctrl}{shift}{} drag", button(with)),
            Touch::Click(with) => format!("{ctrl}{shift}{} click", button(with)),
            Touch::DoubleClick(with) => format!("{ctrl}{shift}{} double click", button(with)),
            Touch::Wheel => format!("{ctrl}{shift}wheel"),
        }
    }
}

/// The rows of keys that hold in a preset.
pub fn keys(preset: Preset) -> impl Iterator<Item = &'static KeyRow> {
    KEYS.iter().filter(move |row| row.preset.is_none_or(|of| of == preset))
}

/// The rows of the mouse that hold in a preset.
pub fn touches(preset: Preset) -> impl Iterator<Item = &'static TouchRow> {
    TOUCHES.iter().filter(move |row| row.preset.is_none_or(|of| of == preset))
}

/// How the first key of a command is written; empty where it has none.
pub fn shortcut(command: Command, preset: Preset) -> String {
    keys(preset).find(|row| row.command == command).map_or_else(String::new, |row| row.stroke.name())
}

/// The commands whose keys were pressed since the last frame, in their order; their events are taken. Keys that are held to
/// fly are not among them: [`flying`].
pub fn pressed(ctx: &egui::Context, preset: Preset) -> Vec<Command> {
    if ctx.text_edit_focused() {
        return Vec::new();
    }
    let is_reached = ctx.egui_wants_keyboard_input();
    let has_popup = egui::Popup::is_any_open(ctx);
    let mut commands = Vec::new();
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            let &Event::Key { key, pressed: true, repeat: false, modifiers, .. } = event else { return true };
            // Space presses the widget that has the focus, Esc closes an open list.
            if (is_reached && key == Key::Space) || (has_popup && key == Key::Escape) {
                return true;
            }
            let row = keys(preset).find(|row| row.stroke.is(key, modifiers));
            match row {
                Some(row) if !matches!(row.command, Command::Fly(_)) => {
                    commands.push(row.command);
                    false
                }
                _ => true,
            }
        });
    });
    commands
}

/// Where the held keys fly to, along right, forward and up; zero where none is held, or text is typed.
pub fn flying(ctx: &egui::Context, preset: Preset) -> glam::Vec3 {
    if ctx.text_edit_focused() {
        return glam::Vec3::ZERO;
    }
    ctx.input(|input| {
        let held = |row: &&KeyRow| input.key_down(row.stroke.key) && row.stroke.is(row.stroke.key, input.modifiers);
        let along = |row: &KeyRow| match row.command {
            Command::Fly(along) => glam::Vec3::from_array(along.map(f32::from)),
            _ => glam::Vec3::ZERO,
        };
        keys(preset).filter(held).map(along).sum()
    })
}

/// What the mouse does; `None` where the preset has nothing for it.
pub fn touched(touch: Touch, modifiers: Modifiers, preset: Preset) -> Option<Gesture> {
    let fits = |row: &&TouchRow| row.touch == touch && row.ctrl == modifiers.command && row.shift == modifiers.shift;
    touches(preset).find(fits).map(|row| row.gesture)
}

/// What dragging with a button does.
pub fn gesture(button: PointerButton, modifiers: Modifiers, preset: Preset) -> Option<Gesture> {
    touched(Touch::Drag(button), modifiers, preset)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_commands_share_a_key_in_a_preset() {
        for preset in Preset::ALL {
            let rows: Vec<&KeyRow> = keys(preset).collect();
            for (number, row) in rows.iter().enumerate() {
                let same = |other: &&&KeyRow| {
                    let either = other.stroke.shift.is_none() || row.stroke.shift.is_none();
                    let shift = either || other.stroke.shift == row.stroke.shift;
                    other.stroke.key == row.stroke.key && other.stroke.ctrl == row.stroke.ctrl && shift
                };
                let also = rows[..number].iter().find(same).map(|other| other.does);
                assert_eq!(also, None, "{preset:?}: {} also does: {}", row.stroke.name(), row.does);
            }
        }
    }

    #[test]
    fn no_two_gestures_share_a_touch_in_a_preset() {
        for preset in Preset::ALL {
            let rows: Vec<&TouchRow> = touches(preset).collect();
            for (number, row) in rows.iter().enumerate() {
                let same =
                    |other: &&&TouchRow| (other.touch, other.ctrl, other.shift) == (row.touch, row.ctrl, row.shift);
                assert!(!rows[..number].iter().any(|other| same(&other)), "{preset:?}: {}", row.name());
            }
        }
    }

    #[test]
    fn presets_differ_as_they_say() {
        let shift = Modifiers::SHIFT;
        let of = |button, modifiers, preset| gesture(button, modifiers, preset);
        use PointerButton::{Middle, Primary, Secondary};
        assert_eq!(of(Primary, Modifiers::NONE, Preset::Lightvein), Some(Gesture::Orbit));
        assert_eq!(of(Primary, shift, Preset::Lightvein), Some(Gesture::Pan));
        assert_eq!(of(Secondary, Modifiers::NONE, Preset::Lightvein), Some(Gesture::Pan));
        assert_eq!(of(Middle, Modifiers::NONE, Preset::Lightvein), Some(Gesture::Pan));
        assert_eq!(of(Primary, Modifiers::NONE, Preset::Blender), None);
        assert_eq!(of(Middle, Modifiers::NONE, Preset::Blender), Some(Gesture::Orbit));
        assert_eq!(of(Middle, shift, Preset::Blender), Some(Gesture::Pan));
        for preset in Preset::ALL {
            assert_eq!(touched(Touch::Click(Primary), Modifiers::NONE, preset), Some(Gesture::Pick));
            assert_eq!(touched(Touch::DoubleClick(Primary), Modifiers::NONE, preset), Some(Gesture::Focus));
            assert_eq!(touched(Touch::Wheel, Modifiers::NONE, preset), Some(Gesture::Zoom));
        }
    }
}
