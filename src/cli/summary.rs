//! A run in a screenful: what it cost, how good it is, the curves and the peak loads.

use std::fmt::Write as _;

use linkwear::number::number;
use linkwear_runtime::{Description, Run};
use serde_json::{Value, json};

use super::plot::{range, sparkline};
use super::table::{count, plural, short_table, table};

/// Curves shown at most.
const CURVES: usize = 8;
/// Part of the largest load (N and N m alike, for machines of about a metre) that is rounding: some thousand
/// roundings of 1e-16 each.
const ROUNDING: f64 = 1e-12;
/// Width of a curve.
const WIDTH: usize = 48;

/// Largest force [N] and moment [N m] at a joint over the recorded rows, each with its time [s].
pub struct Peak {
    joint: String,
    force: (f64, f64),
    moment: (f64, f64),
}

impl Peak {
    pub fn to_json(&self) -> Value {
        json!({
            "joint": self.joint, "force_N": self.force.0, "force_time_s": self.force.1,
            "moment_N_m": self.moment.0, "moment_time_s": self.moment.1,
        })
    }
}

/// Peaks of every joint that has a wrench, in column order.
pub fn peaks(run: &Run) -> Vec<Peak> {
    let joints = run.channels.iter().filter_map(|channel| channel.name.strip_suffix(".Fx"));
    let peak = |joint: &str| {
        let [force, moment] = ["F", "M"].map(|vector| largest(run, &format!("{joint}.{vector}")));
        Peak { joint: joint.to_owned(), force, moment }
    };
    joints.map(peak).collect()
}

/// Largest length of a vector, and when; zero if there is none.
fn largest(run: &Run, stem: &str) -> (f64, f64) {
    let vectors = run.vector(stem).unwrap_or_default();
    let lengths = vectors.iter().map(|vector| vector.iter().map(|x| x * x).sum::<f64>().sqrt());
    lengths.zip(&run.times).fold(
        (0.0, 0.0),
        |best, (length, time)| {
            if length > best.0 { (length, *time) } else { best }
        },
    )
}

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
    let peaks = peaks(run);
    if !peaks.is_empty() {
        let header = ["peak load at", "force [N]", "at t [s]", "moment [N m]", "at t [s]"];
        let _ = write!(text, "\n{}", short_table(&header, peak_rows(&peaks)));
    }
    text
}

/// Loads of no more than rounding are shown as the zero they are.
fn peak_rows(peaks: &[Peak]) -> Vec<Vec<String>> {
    let largest = peaks.iter().fold(0.0_f64, |most, peak| most.max(peak.force.0).max(peak.moment.0));
    let cells = |(value, time): (f64, f64)| {
        let is_rounding = value <= ROUNDING * largest;
        if is_rounding { ["0".to_owned(), String::new()] } else { [value, time].map(number) }
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
    let rows: Vec<Vec<String>> = columns(".drive")
        .chain(columns(".q"))
        .take(CURVES)
        .map(|(at, channel)| {
            let values: Vec<f64> = run.rows.iter().map(|row| row[at]).collect();
            let (low, high) = range(&values);
            // An end that is rounding next to the other is the zero that it means.
            let zeroed = |end: f64| if end.abs() <= ROUNDING * (high - low) { 0.0 } else { end };
            vec![
                format!("{} [{}]", channel.name, channel.unit),
                sparkline(&values, WIDTH),
                format!("{} to {}", number(zeroed(low)), number(zeroed(high))),
            ]
        })
        .collect();
    if !rows.is_empty() && !run.rows.is_empty() {
        let _ = write!(text, "\n{}", table(&["", "", ""], &rows));
    }
}
