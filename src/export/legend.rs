//! What the colours of a picture mean: a bar with marks, as SVG.

use super::scale::{INFERNO, colour};
use std::fmt::Arguments;

/// Steps in which the bar shows the colours.
const STEPS: usize = 64;

/// A bar of the scale [`INFERNO`] with its left edge at `left`, from `top` to `bottom`; marks at parts of it, 0 at the foot, 1 at
/// the head; the unit above.
pub(super) fn bar(
    put: &mut dyn FnMut(Arguments),
    left: usize,
    [top, bottom]: [usize; 2],
    marks: &[(f64, String)],
    unit: &str,
) {
    let high = (bottom - top) as f32;
    let height = |part: f32| bottom as f32 - high * part;
    for step in 0..STEPS {
        let [red, green, blue] = colour(&INFERNO, (step as f64 + 0.5) / STEPS as f64);
        put(format_args!(
            r#"<rect x="{left}" y="{}" width="16" height="{}" fill="rgb({red},{green},{blue})"/>"#,
            height((step + 1) as f32 / STEPS as f32),
            high / STEPS as f32 + 0.5
        ));
    }
    for (part, text) in marks {
        let y = height(*part as f32);
        put(format_args!(r##"<path d="M{} {y}h5" stroke="#444"/>"##, left + 16));
        put(format_args!(r#"<text x="{}" y="{}">{text}</text>"#, left + 24, y + 5.0));
    }
    put(format_args!(r##"<text x="{}" y="{}" fill="#555">{unit}</text>"##, left - 8, top - 12));
}
