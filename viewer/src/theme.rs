//! How the window looks: a dark and a light theme, sizes, colours of categories.

use crate::controls::TextScale;
use crate::state::Kept;
use egui::{Color32, Context, CornerRadius, Margin, Stroke, Style, TextStyle, Theme, ThemePreference, vec2};

/// Colour of `forward`, drawn solid.
pub const FORWARD: [u8; 3] = [0xE6, 0x9F, 0x00];

/// Colour of `backward`, drawn dashed.
pub const BACKWARD: [u8; 3] = [0x00, 0x72, 0xB2];

/// Colours that are told apart with any colour vision: those of Okabe and Ito (2008) but black, which no theme shows on dark.
const CATEGORIES: [[u8; 3]; 7] = [
    [0xE6, 0x9F, 0x00],
    [0x56, 0xB4, 0xE9],
    [0x00, 0x9E, 0x73],
    [0xF0, 0xE4, 0x42],
    [0x00, 0x72, 0xB2],
    [0xD5, 0x5E, 0x00],
    [0xCC, 0x79, 0xA7],
];

/// Smallest and largest scale of text and widgets.
pub const ZOOMS: [f32; 2] = [0.5, 3.0];

/// What a step of the text scale multiplies by.
const ZOOM_STEP: f32 = 1.1;

/// The colour of a category by its number, sRGB. After seven they come again lighter, then darker, then from the start: who
/// needs to tell apart more than that reads the label.
pub fn category(number: usize) -> [u8; 3] {
    let colour = CATEGORIES[number % CATEGORIES.len()];
    let towards = |white: f32, share: f32| colour.map(|part| (f32::from(part) * (1.0 - share) + white * share) as u8);
    match number / CATEGORIES.len() % 3 {
        0 => colour,
        1 => towards(255.0, 0.5),
        _ => towards(0.0, 0.45),
    }
}

/// A colour as egui has it.
pub const fn colour([red, green, blue]: [u8; 3]) -> Color32 {
    Color32::from_rgb(red, green, blue)
}

/// A step of the text scale, within its bounds.
pub fn zoomed(zoom: f32, step: TextScale) -> f32 {
    let zoom = match step {
        TextScale::Larger => zoom * ZOOM_STEP,
        TextScale::Smaller => zoom / ZOOM_STEP,
        TextScale::Reset => 1.0,
    };
    zoom.clamp(ZOOMS[0], ZOOMS[1])
}

/// Makes the window look as it is kept. Cheap, so it may be called each frame: styles are made once.
pub fn apply(ctx: &Context, kept: &Kept) {
    let preference = match kept.dark {
        None => ThemePreference::System,
        Some(true) => ThemePreference::Dark,
        Some(false) => ThemePreference::Light,
    };
    ctx.set_theme(preference);
    let zoom = kept.zoom.clamp(ZOOMS[0], ZOOMS[1]);
    if ctx.zoom_factor() != zoom {
        ctx.set_zoom_factor(zoom);
    }

    let made = egui::Id::unique("lightvein theme");
    if ctx.data(|data| data.get_temp::<bool>(made)).is_none() {
        ctx.data_mut(|data| data.insert_temp(made, true));
        // Keys of the text scale stand in the table of controls.
        ctx.options_mut(|options| options.zoom_with_keyboard = false);
        ctx.all_styles_mut(sizes);
        ctx.style_mut_of(Theme::Dark, dark);
        ctx.style_mut_of(Theme::Light, light);
    }
}

/// What both themes share.
fn sizes(style: &mut Style) {
    style.spacing.item_spacing = vec2(8.0, 5.0);
    style.spacing.button_padding = vec2(8.0, 3.0);
    style.spacing.slider_width = 120.0;
    style.spacing.interact_size.y = 21.0;
    style.spacing.window_margin = Margin::same(10);
    style.spacing.indent = 14.0;
    if let Some(heading) = style.text_styles.get_mut(&TextStyle::Heading) {
        heading.size = 16.0;
    }
    style.visuals.indent_has_left_vline = false;
    style.visuals.weak_text_alpha = 0.75;
    style.visuals.slider_trailing_fill = true;
    style.visuals.window_corner_radius = CornerRadius::same(8);
    for widget in [
        &mut style.visuals.widgets.inactive,
        &mut style.visuals.widgets.hovered,
        &mut style.visuals.widgets.active,
        &mut style.visuals.widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(4);
    }
}

fn dark(style: &mut Style) {
    let visuals = &mut style.visuals;
    visuals.panel_fill = Color32::from_rgb(28, 30, 34);
    visuals.window_fill = Color32::from_rgb(34, 36, 41);
    visuals.extreme_bg_color = Color32::from_rgb(17, 18, 21);
    visuals.faint_bg_color = Color32::from_rgb(33, 35, 40);
    visuals.window_stroke = Stroke::new(1.0, Color32::from_rgb(62, 65, 72));
    visuals.widgets.noninteractive.bg_fill = visuals.panel_fill;
    visuals.widgets.noninteractive.weak_bg_fill = visuals.panel_fill;
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, Color32::from_rgb(54, 57, 63));
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_rgb(200, 203, 208);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_rgb(222, 224, 228);
    visuals.widgets.inactive.weak_bg_fill = Color32::from_rgb(50, 53, 60);
    visuals.widgets.inactive.bg_fill = Color32::from_rgb(62, 66, 74);
    visuals.selection.bg_fill = Color32::from_rgb(0, 92, 145);
    visuals.warn_fg_color = Color32::from_rgb(240, 180, 60);
    visuals.error_fg_color = Color32::from_rgb(255, 110, 100);
}

fn light(style: &mut Style) {
    let visuals = &mut style.visuals;
    visuals.panel_fill = Color32::from_rgb(246, 247, 249);
    visuals.window_fill = Color32::from_rgb(252, 252, 253);
    visuals.faint_bg_color = Color32::from_rgb(238, 240, 243);
    visuals.window_stroke = Stroke::new(1.0, Color32::from_rgb(198, 202, 208));
    visuals.widgets.noninteractive.bg_fill = visuals.panel_fill;
    visuals.widgets.noninteractive.weak_bg_fill = visuals.panel_fill;
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, Color32::from_rgb(214, 217, 222));
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_rgb(48, 51, 56);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_rgb(40, 43, 48);
    visuals.selection.bg_fill = Color32::from_rgb(150, 205, 240);
    visuals.warn_fg_color = Color32::from_rgb(166, 95, 0);
    visuals.error_fg_color = Color32::from_rgb(190, 30, 30);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_categories_differ_and_so_do_their_lightnesses() {
        let all: std::collections::BTreeSet<[u8; 3]> = (0..21).map(category).collect();
        assert_eq!(all.len(), 21);
        assert_eq!(category(21), category(0));
        assert_eq!((category(0), category(4)), (FORWARD, BACKWARD));
    }

    #[test]
    fn text_grows_and_shrinks_within_bounds() {
        let largest = (0..50).fold(1.0, |zoom, _| zoomed(zoom, TextScale::Larger));
        let smallest = (0..50).fold(1.0, |zoom, _| zoomed(zoom, TextScale::Smaller));
        assert_eq!(([smallest, largest], zoomed(2.3, TextScale::Reset)), (ZOOMS, 1.0));
    }
}
