//! How the series look: a colour and a shape for each method, so that they can be told apart without colours too.
//!
//! Colours are those of Okabe & Ito ("Color Universal Design", 2008), which all common kinds of colour vision tell apart.

use crate::study::chart::Point;
use std::io::{self, Write};

/// The look of one method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// Its colour.
    pub colour: &'static str,
    shape: Shape,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Circle,
    Square,
    Diamond,
    Up,
    Down,
    Cross,
}

/// The look of no method in particular, for the legend.
pub const PLAIN: Style = Style { colour: "#666666", shape: Shape::Square };

/// The look of a method; of another program for a name that is none of ours.
pub fn style(method: &str) -> Style {
    let (colour, shape) = match method {
        "backward" => ("#e69f00", Shape::Down),
        "forward" => ("#56b4e9", Shape::Up),
        "diffusion" => ("#009e73", Shape::Square),
        "network" => ("#d55e00", Shape::Diamond),
        "trace" => ("#000000", Shape::Circle),
        _ => ("#cc79a7", Shape::Cross),
    };
    Style { colour, shape }
}

/// Colours of series in their order: those of Okabe & Ito, grey for their yellow, which is too pale for lines.
const COLOURS: [&str; 8] = ["#777777", "#e69f00", "#56b4e9", "#009e73", "#d55e00", "#0072b2", "#000000", "#cc79a7"];

/// Shapes of series in their order.
const SHAPES: [Shape; 6] = [Shape::Square, Shape::Down, Shape::Up, Shape::Diamond, Shape::Circle, Shape::Cross];

/// The look of a series by its number.
pub fn by_order(number: usize) -> Style {
    Style { colour: COLOURS[number % COLOURS.len()], shape: SHAPES[number % SHAPES.len()] }
}

/// Half the size of the mark of a point without voxels, and of one with the scene's own.
const HALF: f64 = 4.5;

/// Half the size of a point's mark: the coarser its voxels, the larger. `own_m` is the scene's own voxel size.
pub fn half_size(point: &Point, own_m: Option<f32>) -> f64 {
    let coarser = point.voxel_m.zip(own_m).map_or(1.0, |(voxel_m, own_m)| f64::from(voxel_m / own_m));
    HALF * coarser.clamp(0.25, 4.0).powf(0.45)
}

/// Draws a mark: hollow for a scaled or smoothed point, ringed for one on the front, pale elsewhere.
///
/// # Errors
/// What the writer says.
pub fn draw_mark(
    out: &mut dyn Write,
    style: Style,
    [x, y]: [f64; 2],
    half: f64,
    is_scaled: bool,
    is_front: bool,
) -> io::Result<()> {
    let Style { colour, shape } = style;
    let fill = if is_scaled { "#ffffff" } else { colour };
    let opacity = if is_front { 1.0 } else { 0.55 };
    let look = format!(r#"fill="{fill}" stroke="{colour}" stroke-width="1.6" opacity="{opacity}""#);
    if is_front {
        writeln!(out, r##"<circle cx="{x:.1}" cy="{y:.1}" r="{:.1}" fill="none" stroke="#555555"/>"##, half + 3.5)?;
    }
    let polygon = |corners: &[[f64; 2]]| {
        let places = corners.iter().map(|[right, down]| format!("{:.1},{:.1}", x + right * half, y + down * half));
        format!(r#"<polygon points="{}" {look}/>"#, places.collect::<Vec<_>>().join(" "))
    };
    let mark = match shape {
        Shape::Circle => format!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="{:.1}" {look}/>"#, 0.9 * half),
        Shape::Square => polygon(&[[-0.85, -0.85], [0.85, -0.85], [0.85, 0.85], [-0.85, 0.85]]),
        Shape::Diamond => polygon(&[[0.0, -1.2], [1.2, 0.0], [0.0, 1.2], [-1.2, 0.0]]),
        Shape::Up => polygon(&[[0.0, -1.1], [1.05, 0.8], [-1.05, 0.8]]),
        Shape::Down => polygon(&[[0.0, 1.1], [1.05, -0.8], [-1.05, -0.8]]),
        Shape::Cross => {
            let (thin, long) = (0.35, 1.1);
            let right = [[long, -thin], [long, thin], [thin, thin]];
            let turned = |[x, y]: [f64; 2], turns: usize| (0..turns).fold([x, y], |[x, y], _| [-y, x]);
            let corners: Vec<[f64; 2]> = (0..4).flat_map(|turns| right.map(|corner| turned(corner, turns))).collect();
            polygon(&corners)
        }
    };
    writeln!(out, "{mark}")
}
