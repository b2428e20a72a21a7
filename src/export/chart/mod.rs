//! The chart of speed against accuracy: SVG, CSV, and a PNG of the same SVG.
//!
//! A row of panels for each scene, a panel for each number of sensors; seconds to the right, the error upwards, both
//! logarithmic. Every point is one method at one quality and voxel size, at the time of preparation and estimate together;
//! the pale bar to its left begins at the estimate alone.

mod axes;
mod csv;
mod labels;
pub mod loglog;
mod panel;
mod style;

pub use csv::write_csv;

use super::plan::escaped;
use crate::study::chart::{SceneChart, verdict::grouped};
use axes::factor_range;
use panel::{HEIGHT, Panel, WIDTH};
use std::io::{self, Write};
use style::{PLAIN, draw_mark, style};

/// The numbers of sensors that have a panel.
const PANELS: [usize; 3] = [7, 1_000, 100_000];

/// Room to the left for the factors, between panels, for the legend, above and below a row.
const LEFT: f64 = 76.0;
const GAP: f64 = 22.0;
const LEGEND: f64 = 66.0;
const ABOVE: f64 = 30.0;
const BELOW: f64 = 48.0;

/// Writes the chart of one or more scenes.
///
/// # Errors
/// What the writer says.
pub fn write_svg(out: &mut dyn Write, charts: &[SceneChart]) -> io::Result<()> {
    let width = LEFT + PANELS.len() as f64 * (WIDTH + GAP);
    let row = ABOVE + HEIGHT + BELOW;
    let height = LEGEND + row * charts.len() as f64;
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0} {height:.0}" width="{width:.0}" height="{height:.0}" font-family="DejaVu Sans, Verdana, Arial, sans-serif" font-size="13">"#
    )?;
    writeln!(out, r##"<rect width="100%" height="100%" fill="#ffffff"/>"##)?;
    draw_legend(out, charts)?;
    for (number, chart) in charts.iter().enumerate() {
        draw_row(out, chart, LEGEND + number as f64 * row)?;
    }
    writeln!(out, "</svg>")
}

fn draw_row(out: &mut dyn Write, chart: &SceneChart, top: f64) -> io::Result<()> {
    let factors = factor_range(chart.points.iter().filter_map(|point| point.rms_factor()));
    let [above, below] = [top + ABOVE, top + ABOVE + HEIGHT];
    for (number, sensors) in PANELS.into_iter().enumerate() {
        let left = LEFT + number as f64 * (WIDTH + GAP);
        let panel = Panel { chart, sensors, corner: [left, above], factors, is_first: number == 0 };
        panel.draw(out)?;
        let name = if number == 0 { format!("{}: ", escaped(&chart.scene)) } else { String::new() };
        writeln!(
            out,
            r#"<text x="{left:.1}" y="{:.1}" font-weight="bold">{name}{} sensors</text>"#,
            above - 8.0,
            grouped(sensors)
        )?;
        writeln!(
            out,
            r##"<text x="{:.1}" y="{:.1}" text-anchor="middle" fill="#444444">{}, preparation included</text>"##,
            left + WIDTH / 2.0,
            below + 34.0,
            escaped(&chart.timed_by)
        )?;
    }
    let middle = above + HEIGHT / 2.0;
    writeln!(
        out,
        r##"<text transform="translate(18 {middle:.1}) rotate(-90)" text-anchor="middle" fill="#444444">rms factor of error at {} sensors</text>"##,
        chart.referenced
    )
}

/// Two lines: the methods with their colours and shapes; what marks, lines and arrows mean.
fn draw_legend(out: &mut dyn Write, charts: &[SceneChart]) -> io::Result<()> {
    let mut methods: Vec<&str> = Vec::new();
    for point in charts.iter().flat_map(|chart| &chart.points) {
        if !methods.contains(&point.method.as_str()) {
            methods.push(&point.method);
        }
    }
    let mut left = LEFT;
    for method in methods {
        draw_mark(out, style(method), [left + 6.0, 20.0], 5.5, false, false)?;
        writeln!(out, r#"<text x="{:.1}" y="24.5">{}</text>"#, left + 17.0, escaped(method))?;
        left += 40.0 + 8.2 * method.len() as f64;
    }
    let marks: [(&str, bool, bool, f64); 4] = [
        ("scaled from fewer sensors", true, false, 5.0),
        ("best for its time", false, true, 4.5),
        ("coarse voxels", false, false, 6.5),
        ("fine voxels", false, false, 3.2),
    ];
    for (says, is_scaled, is_front, half) in marks {
        draw_mark(out, PLAIN, [left + 6.0, 20.0], half, is_scaled, is_front)?;
        writeln!(out, r##"<text x="{:.1}" y="24.5" fill="#444444">{says}</text>"##, left + 17.0)?;
        left += 36.0 + 7.4 * says.len() as f64;
    }
    writeln!(
        out,
        r##"<text x="{LEFT}" y="48" font-size="12" fill="#444444">Down and left is better. Pale bar: preparation (voxels, skeleton). Arrow and number: so many sensors lost, the error is infinite. The upward axis is logarithmic in rms factor - 1.</text>"##
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::chart::Point;
    use crate::study::chart::mark_fronts;
    use crate::study::errors::Errors;

    fn charts() -> Vec<SceneChart> {
        let point = |method: &str, sensors: usize, seconds: f64, rms_factor: f64| Point {
            method: method.to_owned(),
            quality: "64 samples".to_owned(),
            voxel_m: (method != "trace").then_some(0.1),
            sensors,
            prepare_seconds: 0.01,
            seconds,
            is_scaled: sensors > 1_000,
            errors: Errors {
                rms_factor: Some(rms_factor),
                max_factor: Some(rms_factor),
                median_angle_deg: None,
                counted: 20,
                left_out: 0,
                lost: usize::from(rms_factor.is_infinite()) * 3,
                above: 0,
            },
            is_front: false,
            equal_error: None,
        };
        let mut points: Vec<Point> = PANELS
            .into_iter()
            .flat_map(|sensors| {
                let each = sensors as f64 * 1e-5;
                [("forward", each, 3.0), ("trace", 9.0 * each, f64::INFINITY), ("trace", 99.0 * each, 1.1)]
                    .map(|(method, seconds, factor)| point(method, sensors, seconds, factor))
            })
            .collect();
        mark_fronts(&mut points);
        vec![SceneChart { scene: "a < b".to_owned(), timed_by: "time".to_owned(), points, ..SceneChart::default() }; 2]
    }

    /// Whether no place in a picture is lost; its legend speaks of infinite errors.
    fn is_finite(svg: &str) -> bool {
        let places = svg.replace("infinite", "");
        !places.contains("inf") && !places.contains("NaN")
    }

    #[test]
    fn the_picture_has_every_point_its_scene_and_the_lost_ones() {
        let mut svg = Vec::new();
        write_svg(&mut svg, &charts()).unwrap();
        let svg = String::from_utf8(svg).unwrap();
        assert_eq!(svg.matches("a &lt; b: 7 sensors").count(), 2);
        assert_eq!(svg.matches("\u{2191}3").count(), 6, "a count of lost sensors in each panel");
        assert_eq!(svg.matches("100,000 sensors").count(), 2);
        assert!(is_finite(&svg));
    }

    #[test]
    fn a_scene_without_points_is_drawn_all_the_same() {
        let mut svg = Vec::new();
        write_svg(&mut svg, &[SceneChart::default()]).unwrap();
        let svg = String::from_utf8(svg).unwrap();
        assert!(svg.ends_with("</svg>\n") && is_finite(&svg));
    }

    #[test]
    fn a_row_a_point_with_the_head_of_the_contract() {
        let charts = charts();
        let mut table = Vec::new();
        write_csv(&mut table, &charts).unwrap();
        let table = String::from_utf8(table).unwrap();
        let head = "scene,method,quality,voxel_m,sensors,prepare_seconds,seconds,total_seconds,scaled,rms_factor,\
                    max_factor,median_angle_deg,lost,pareto,equal_error";
        assert_eq!(table.lines().next(), Some(head));
        assert_eq!(table.lines().count(), 1 + 2 * charts[0].points.len());
        assert!(table.contains(",inf,"));
    }
}
