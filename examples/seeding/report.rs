//! How is what was found told? A table on the terminal, a CSV with a row a sensor, a panel of the chart.

use crate::measure::{Finding, Outcome, median};
use lightvein::export::chart::loglog::{Mark, Panel};
use std::io::{self, Write};

/// Tells a scene on the terminal.
pub fn print(found: &Finding) {
    let lit: Vec<f64> =
        found.truth_error.iter().zip(&found.truth_w_m2).filter(|(_, truth)| **truth > 0.0).map(|(e, _)| *e).collect();
    let worst = lit.iter().copied().fold(0.0, f64::max);
    println!(
        "\n{}: {} sensors, {} threads; truth within {:.2}% (median), {:.2}% (worst); {} of {} beyond 3 standard errors of the reference",
        found.scene,
        found.sensors.len(),
        rayon::current_num_threads(),
        100.0 * median(&lit),
        100.0 * worst,
        found.off_reference[1],
        found.off_reference[0],
    );
    println!(
        "  {:8} {:>9} {:>6} {:>10} {:>22} {:>8}",
        "", "prepared", "budget", "rms error", "plain / its MSE", "doubtful"
    );
    println!("  {:8} {:>9} {:>6} {:>10} {:>11} {:>10}", "", "s", "s", "median %", "median", "worst");
    for outcome in &found.outcomes {
        for (budget, budget_s) in found.budgets_s.iter().enumerate() {
            let ratios = ratios(found, outcome, budget);
            if ratios.is_empty() {
                continue;
            }
            println!(
                "  {:8} {:9.3} {budget_s:6} {:10.3} {:11.2} {:10.2} {:8}",
                outcome.name,
                outcome.prepare_s,
                100.0 * rms(outcome, budget),
                median(&ratios),
                ratios.iter().copied().fold(f64::INFINITY, f64::min),
                doubtful(found, outcome),
            );
        }
        if let (Some((squares, sample_s)), Some((plain, plain_s))) =
            (&outcome.sample, plain(found).and_then(|it| it.sample.as_ref()))
        {
            let by_samples: Vec<f64> = plain.iter().zip(squares).map(|(plain, its)| plain / its).collect();
            println!(
                "  {:8} by equal samples {:.2} (median); a sample takes {:.2} us, {:.2} of plain's",
                outcome.name,
                median(&by_samples),
                1e6 * sample_s,
                sample_s / plain_s
            );
        }
    }
    let chosen: Vec<String> = (0..found.budgets_s.len())
        .filter_map(|budget| {
            let outcome = chosen(found, budget)?;
            let ratio = median(&ratios(found, outcome, budget));
            Some(format!("{} s {} {ratio:.2}", found.budgets_s[budget], outcome.name))
        })
        .collect();
    if !chosen.is_empty() {
        println!("  by the finer guide that takes no more than a tenth of the budget: {}", chosen.join(", "));
    }
}

/// The guide for a budget: the finer one if making it takes no more than a tenth of the budget, else the coarser.
fn chosen(found: &Finding, budget: usize) -> Option<&Outcome> {
    let named = |name: &str| found.outcomes.iter().find(|outcome| outcome.name == name);
    named("guided").filter(|fine| fine.prepare_s <= 0.1 * found.budgets_s[budget]).or_else(|| named("coarse"))
}

fn plain(found: &Finding) -> Option<&Outcome> {
    found.outcomes.iter().find(|outcome| outcome.name == "plain")
}

/// How many sensors cannot be judged, for its samples or for plain's.
fn doubtful(found: &Finding, outcome: &Outcome) -> usize {
    let plain = plain(found).map_or(&outcome.is_doubtful, |plain| &plain.is_doubtful);
    outcome.is_doubtful.iter().zip(plain).filter(|(its, plain)| **its || **plain).count()
}

/// The median over sensors of its relative error.
fn rms(outcome: &Outcome, budget: usize) -> f64 {
    median(&outcome.squares[budget]).sqrt()
}

/// Plain's mean square error over its own, sensor by sensor; those without light are left out.
fn ratios(found: &Finding, outcome: &Outcome, budget: usize) -> Vec<f64> {
    let plain = plain(found).map_or(&outcome.squares[budget], |plain| &plain.squares[budget]);
    let ratios = plain.iter().zip(&outcome.squares[budget]).map(|(plain, its)| plain / its);
    ratios.filter(|ratio| !ratio.is_nan()).collect()
}

/// The table of `docs/seeding.md`: for each scene and contestant the seconds of preparation, and for each budget plain's mean
/// square error over its own, median over sensors and, in brackets, at the worst.
pub fn print_summary(findings: &[Finding]) {
    let Some(first) = findings.first() else { return };
    let rivals = || first.outcomes.iter().filter(|outcome| outcome.name != "plain");
    let budgets: String = first.budgets_s.iter().map(|budget_s| format!(" {budget_s} s |")).collect();
    let names: String = rivals().map(|outcome| format!(" {}: prepared |{budgets}", outcome.name)).collect();
    let columns = 1 + rivals().count() * (1 + first.budgets_s.len());
    println!("\n| scene |{names}\n|{}", "---|".repeat(columns));
    for found in findings {
        let cells = found.outcomes.iter().filter(|outcome| outcome.name != "plain").map(|outcome| {
            let ratios = (0..found.budgets_s.len()).map(|budget| {
                let ratios = ratios(found, outcome, budget);
                if ratios.is_empty() {
                    return " |".to_owned();
                }
                format!(" {:.1} ({:.2}) |", median(&ratios), ratios.iter().copied().fold(f64::INFINITY, f64::min))
            });
            format!(" {:.2} s |{}", outcome.prepare_s, ratios.collect::<String>())
        });
        println!("| {} |{}", found.scene, cells.collect::<String>());
    }
}

/// Time against error, a curve a contestant.
pub fn panel(found: &Finding) -> Panel {
    let marks = found.outcomes.iter().flat_map(|outcome| {
        let measured = found.budgets_s.iter().enumerate().filter(|(budget, _)| rms(outcome, *budget).is_finite());
        measured.map(move |(budget, budget_s)| Mark {
            series: outcome.name.to_owned(),
            label: String::new(),
            at: [*budget_s, 100.0 * rms(outcome, budget)],
            is_hollow: false,
        })
    });
    Panel {
        title: found.scene.clone(),
        axes: ["seconds".to_owned(), "relative rms error, %".to_owned()],
        marks: marks.collect(),
        has_front: false,
    }
}

/// A row a scene, contestant, budget and sensor: errors are relative to the truth, `ratio` is plain's mean square error over
/// its own, `doubtful` whether a sample of it is over 5% of the sum.
pub fn write_table(out: &mut dyn Write, findings: &[Finding]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "scene",
        "contestant",
        "prepare_s",
        "budget_s",
        "sensor",
        "truth_w_m2",
        "truth_error",
        "rms_error",
        "ratio",
        "doubtful",
    ])?;
    for found in findings {
        for outcome in &found.outcomes {
            for (budget, budget_s) in found.budgets_s.iter().enumerate() {
                for (at, sensor) in found.sensors.iter().enumerate() {
                    let square = outcome.squares[budget][at];
                    let plain = plain(found).map_or(f64::NAN, |plain| plain.squares[budget][at]);
                    table.write_record([
                        found.scene.clone(),
                        outcome.name.to_owned(),
                        format!("{:.4}", outcome.prepare_s),
                        budget_s.to_string(),
                        sensor.clone(),
                        format!("{:.5e}", found.truth_w_m2[at]),
                        format!("{:.5}", found.truth_error[at]),
                        format!("{:.6}", square.sqrt()),
                        format!("{:.3}", plain / square),
                        outcome.is_doubtful[at].to_string(),
                    ])?;
                }
            }
        }
    }
    table.flush()
}
