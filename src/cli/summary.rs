//! A run in a screenful: what it cost, how good it is, the curves and the peak loads.

use std::fmt::Write as _;

use crate::number::number;
use linkwear_runtime::{At, Description, Extremes, Peak, Run};

use super::plot::sparklines;
use super::table::{count, plural, short_table, table};

/// Curves shown at most.
const CURVES: usize = 8;
/// Part of the largest load (N and N m alike, for machines of about a metre) that is rounding: some thousand
/// roundings of 1e-16 each.
const ROUNDING: f64 = 1e-12;

/// The screenful.
pub fn text(description: &Description, run: &Run, head: &str, method: &str) -> String {
    let numbers = &run.statistics;
    let mut text = format!("{head}\n\n");
    let mut facts = Vec::new();
    let mut fact = |name: &str, value: String| facts.push(vec![name.to_owned(), value]);
    fact("steps", format!("{} ({}), {} rejected", count(numbers.steps), method, count(numbers.rejected)));
    fact("evaluations", count(numbers.evaluations));
    let loop_errors = [(false, numbers.max_loop_error_m, "m"), (true, numbers.max_loop_error_rad, "rad")]
        .into_iter()
        .filter(|(angular, ..)| description.rows.iter().any(|row| row.angular == *angular))
        .map(|(_, error, unit)| format!("{} {unit}", number(error)));
    let loop_errors: Vec<String> = loop_errors.collect();
    if !loop_errors.is_empty() {
        fact("loop error", format!("at most {}", loop_errors.join(", ")));
    }
    if numbers.newton_iterations > 0 {
        fact("Newton", plural(numbers.newton_iterations, "iteration", "iterations"));
    }
    let (error, moved) = (number(numbers.energy_error_J), number(numbers.energy_throughput_J));
    fact("energy error", format!("{error} J, while {moved} J went through"));
    if numbers.rank_revealing_solves > 0 {
        let solves = plural(numbers.rank_revealing_solves, "evaluation", "evaluations");
        fact("singular", format!("{solves} near a singular position"));
    }
    text.push_str(&table(&["", ""], &facts));
    curves(&mut text, run);
    let peaks = &run.peaks;
    if !peaks.is_empty() {
        let header = ["peak load at", "force [N]", "at t [s]", "moment [N m]", "at t [s]"];
        let _ = write!(text, "\n{}", short_table(&header, peak_rows(peaks)));
    }
    text
}

/// Loads of no more than rounding are shown as the zero they are.
fn peak_rows(peaks: &[Peak]) -> Vec<Vec<String>> {
    let largest = peaks.iter().fold(0.0_f64, |most, peak| most.max(peak.force.value).max(peak.moment.value));
    let cells = |At { value, t }: At| {
        let is_rounding = value <= ROUNDING * largest;
        if is_rounding { ["0".to_owned(), String::new()] } else { [value, t].map(number) }
    };
    let rows = peaks.iter().map(|peak| {
        let numbers = [peak.force, peak.moment].map(cells).concat();
        [peak.joint.clone()].into_iter().chain(numbers).collect()
    });
    rows.collect()
}

/// Drives first, then joint positions: what one looks at first.
fn curves(text: &mut String, run: &Run) {
    let columns = |suffix: &'static str| {
        run.channels.iter().enumerate().filter(move |(_, channel)| channel.name.ends_with(suffix))
    };
    let shown = columns(".drive").chain(columns(".q")).take(CURVES);
    let rows: Vec<Vec<String>> = shown
        .filter_map(|(at, channel)| {
            let Extremes { low, high, envelope } = run.extremes.get(at)?;
            let (low, high) = (low.value, high.value);
            // An end that is rounding next to the other is the zero that it means.
            let zeroed = |end: f64| if end.abs() <= ROUNDING * (high - low) { 0.0 } else { end };
            let name = format!("{} [{}]", channel.name, channel.unit);
            let range = format!("{} to {}", number(zeroed(low)), number(zeroed(high)));
            // The lower side of an envelope goes under the upper one, without name and range.
            let lines = sparklines(envelope).into_iter().enumerate();
            Some(lines.map(move |(line, curve)| match line {
                0 => vec![name.clone(), curve, range.clone()],
                _ => vec![String::new(), curve, String::new()],
            }))
        })
        .flatten()
        .collect();
    if !rows.is_empty() {
        let _ = write!(text, "\n{}", table(&["", "", ""], &rows));
    }
}
