//! Which method wins where, in words.

use super::equal::Ratio;
use super::{Point, SENSORS, SceneChart};
use std::fmt::Write;

/// Times that are asked about, seconds.
const WITHIN_SECONDS: [f64; 7] = [0.01, 0.1, 1.0, 10.0, 100.0, 1_000.0, 10_000.0];

/// How many sensors the path tracer is held against the estimators at.
const EQUAL_ERROR_SENSORS: usize = 10_000;

/// The text of one scene: for each number of sensors the best answer within given times, from where on the path tracer is
/// alone, and how much longer it takes for the error of the best estimate.
pub fn verdict(chart: &SceneChart) -> String {
    let SceneChart { scene, referenced, timed_by, load_seconds, rays_seconds, .. } = chart;
    let mut text = format!(
        "{scene}: errors at {referenced} referenced sensors; seconds are {timed_by}, with preparation, without loading \
         ({load_seconds:.3} s) and BVH ({rays_seconds:.3} s)\n"
    );
    for sensors in SENSORS {
        text += &format!("\nfor {} sensors\n", grouped(sensors));
        winners(&mut text, &chart.front(sensors));
    }
    if let Some((best, ratio)) = best_estimate(chart) {
        text += &format!(
            "\nequal error, {} sensors: the path tracer takes {ratio} times as long as {} ({}, {} s)\n\
             by its own series, interpolated on the chart's axes; \"at least\" where its last point does not get there\n",
            grouped(EQUAL_ERROR_SENSORS),
            best.label(),
            error(best),
            seconds(best.total_seconds()),
        );
    }
    for note in &chart.notes {
        text += &format!("note: {note}\n");
    }
    text
}

/// The best of the front within each time, a line for each that differs from the one before; then where the path tracer wins.
fn winners(text: &mut String, front: &[&Point]) {
    let mut before = None;
    for within in WITHIN_SECONDS {
        let best = front.iter().rev().find(|point| point.total_seconds() <= within);
        if best.is_some() && best.map(|best| best.label()) != before {
            before = best.map(|best| best.label());
            let Some(best) = best else { continue };
            let mark = if best.is_scaled { ", scaled" } else { "" };
            // Writing to a String cannot fail.
            _ = writeln!(
                text,
                "  within {} s: {}, {} ({} s{mark})",
                seconds(within),
                best.label(),
                error(best),
                seconds(best.total_seconds()),
            );
        }
    }
    let best_estimate = front.iter().rposition(|point| point.voxel_m.is_some());
    let beyond = front.get(best_estimate.map_or(0, |best| best + 1));
    *text += &match (best_estimate.and_then(|best| front.get(best)), beyond) {
        (Some(best), Some(first)) => format!(
            "  the best estimate: {}, {}; below that path tracing alone, from {} s on\n",
            best.label(),
            error(best),
            seconds(first.total_seconds())
        ),
        (Some(_), None) => "  no path-traced point in the chart is better than the best estimate\n".to_owned(),
        (None, Some(_)) => "  no estimate stands on the front: path tracing wins everywhere\n".to_owned(),
        (None, None) => "  no method has a finite error\n".to_owned(),
    };
}

/// The most accurate estimate and the path tracer's time beside it.
fn best_estimate(chart: &SceneChart) -> Option<(&Point, Ratio)> {
    let estimates = chart.panel(EQUAL_ERROR_SENSORS).filter(|point| point.voxel_m.is_some());
    let with_ratio = estimates.filter_map(|point| Some((point, point.equal_error?)));
    let by_error = |(point, _): &(&Point, Ratio)| point.rms_factor().unwrap_or(f64::INFINITY);
    with_ratio.min_by(|a, b| by_error(a).total_cmp(&by_error(b)))
}

fn error(point: &Point) -> String {
    match point.rms_factor() {
        Some(factor) if factor.is_finite() => format!("rms factor {factor:.3}"),
        _ => format!("{} sensors lost", point.errors.lost),
    }
}

/// Seconds to two digits, without an exponent.
fn seconds(seconds: f64) -> String {
    if seconds >= 10.0 {
        return grouped(seconds.round() as usize);
    }
    let decimals = (1.0 - seconds.max(1e-6).log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{seconds:.decimals$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A number with commas between its thousands: 100,000.
pub fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let first = digits.len() % 3;
    let (head, rest) = digits.split_at(first);
    let groups = rest.as_bytes().chunks(3).map(|group| String::from_utf8_lossy(group).into_owned());
    let parts = (!head.is_empty()).then(|| head.to_owned()).into_iter().chain(groups);
    parts.collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::super::measure::compare_points;
    use super::super::tests::point;
    use super::*;

    #[test]
    fn the_text_names_who_wins_where() {
        let sensors = EQUAL_ERROR_SENSORS;
        let estimate = |name, seconds, error| Point { voxel_m: Some(0.1), ..point(name, sensors, seconds, error) };
        let mut points = vec![
            estimate("forward", 0.004, 5.0),
            estimate("network", 0.5, 1.1),
            point("trace", sensors, 1.0, f64::INFINITY),
            point("trace", sensors, 100.0, 1.2),
            point("trace", sensors, 1_600.0, 1.05),
        ];
        compare_points(&mut points);
        let text = verdict(&SceneChart { scene: "hall".to_owned(), points, ..SceneChart::default() });
        for line in [
            "for 10,000 sensors",
            "within 0.01 s: forward, 0.1 m, rms factor 5.000 (0.004 s)",
            "within 1 s: network, 0.1 m, rms factor 1.100 (0.5 s)",
            "within 10,000 s: trace, rms factor 1.050 (1,600 s)",
            "below that path tracing alone, from 1,600 s on",
            "the path tracer takes 800 times as long as network, 0.1 m",
        ] {
            assert!(text.contains(line), "{line}\n{text}");
        }
        assert!(
            !text.contains("within 0.1 s") && text.contains("for 7 sensors\n  no method has a finite error"),
            "{text}"
        );
    }

    #[test]
    fn numbers_are_grouped_by_thousands() {
        assert_eq!([7, 1_000, 123_456, 1_048_576].map(grouped), ["7", "1,000", "123,456", "1,048,576"]);
        assert_eq!([0.0123, 0.5, 1.0, 3.456, 35.1].map(seconds), ["0.012", "0.5", "1", "3.5", "35"]);
    }
}
