//! Keys, by the one table that the help sheet is made from.

use egui::{Key, Modifiers, Ui};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightvein_viewer::controls::{self, Command, Layer, Preset};
use lightvein_viewer::panels;
use lightvein_viewer::state::{Kept, State};

/// What was pressed so far, beside a text field, a switch and the help sheet.
#[derive(Default)]
struct Pressed {
    commands: Vec<Command>,
    flown: glam::Vec3,
    text: String,
    is_on: bool,
}

fn harness() -> Harness<'static, Pressed> {
    let show = |ui: &mut Ui, pressed: &mut Pressed| {
        pressed.commands.extend(controls::pressed(ui.ctx(), Preset::Lightvein));
        pressed.flown += controls::flying(ui.ctx(), Preset::Lightvein);
        let label = ui.label("Name");
        ui.text_edit_singleline(&mut pressed.text).labelled_by(label.id);
        ui.checkbox(&mut pressed.is_on, "Switch");
    };
    Harness::new_ui_state(show, Pressed::default())
}

#[test]
fn keys_are_commands() {
    let mut harness = harness();
    harness.key_press(Key::N);
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::Questionmark);
    harness.key_press(Key::Space);
    harness.run();
    let want = [Command::Toggle(Layer::Nodes), Command::Redo, Command::Undo, Command::Help, Command::Play];
    assert_eq!(harness.state().commands, want);
}

#[test]
fn held_keys_fly_and_are_no_commands() {
    let mut harness = harness();
    harness.key_down(Key::W);
    harness.key_down(Key::E);
    harness.step();
    assert_eq!(harness.state().flown.signum(), glam::vec3(1.0, 1.0, 1.0).with_x(harness.state().flown.x.signum()));
    assert_eq!(harness.state().flown.x, 0.0);
    assert!(harness.state().flown.y > 0.0 && harness.state().flown.z > 0.0 && harness.state().commands.is_empty());
}

#[test]
fn typed_text_is_text() {
    let mut harness = harness();
    harness.get_by_label("Name").focus();
    harness.run();
    harness.key_press(Key::N);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run();
    assert!(harness.state().commands.is_empty(), "{:?}", harness.state().commands);
}

#[test]
fn space_is_left_to_a_switch_that_the_keyboard_reached() {
    let mut harness = harness();
    harness.get_by_label("Switch").focus();
    harness.run();
    harness.key_press(Key::Space);
    harness.key_press(Key::N);
    harness.run();
    assert!(harness.state().is_on);
    assert_eq!(harness.state().commands, [Command::Toggle(Layer::Nodes)]);
}

#[test]
fn the_help_sheet_has_every_row_of_the_table() {
    let mut state = State::new(Kept::default(), Default::default());
    state.shows_help = true;
    let show = |ui: &mut Ui, state: &mut State| panels::help::show(ui.ctx(), state);
    let mut harness = Harness::builder().with_size([900.0, 1000.0]).build_ui_state(show, state);
    for preset in Preset::ALL {
        harness.get_by_label(preset.name()).click();
        harness.run();
        assert_eq!(harness.state().kept.preset, preset);
        let rows = controls::keys(preset).map(|row| (row.stroke.name(), row.does));
        for (name, does) in rows.chain(controls::touches(preset).map(|row| (row.name(), row.does))) {
            assert!(harness.query_all_by_label(does).next().is_some(), "{does}");
            assert!(harness.query_all_by_label_contains(&name).next().is_some(), "{name}");
        }
    }
}
