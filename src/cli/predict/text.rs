//! A prediction for people. In: its numbers. Out: text.

use std::fmt::Write as _;

use linkwear_gamma::life::Band;
use linkwear_gamma::{Answers, Prediction};

use super::super::calendar::Calendar;
use super::super::table::table;
use super::machine::Joints;
use crate::number::{decimals, number};

/// Every how many-th time is shown to people.
const STRIDE: usize = 5;
/// In place of a time that part of the lives, or of the laws that the data leave open, never reach.
const NEVER: &str = "never";
/// Decimals of times.
const DECIMALS: usize = 6;

pub fn to_text(answer: &Prediction, survived: f64, machine: Option<&Joints>, calendar: &Calendar) -> String {
    let after = if survived > 0.0 {
        format!(", after {} more without failure", number(survived))
    } else {
        String::new()
    };
    let mut text = format!(
        "remaining life from wear {} to {}{}, by {}\n\n",
        number(answer.current),
        number(answer.threshold),
        after,
        answer.from
    );
    let mean = answer.moments.as_ref().map(|(_, band)| *band);
    text.push_str(&lives(&answer.quantiles, mean, &answer.answers, calendar));
    let _ = writeln!(text, "\n{}", ends(answer.interval, answer.interval_kind.words(), calendar));
    if let (Some((moments, _)), Some(whole)) = (&answer.moments, &answer.whole) {
        let _ = writeln!(
            text,
            "standard deviation {}, coefficient of variation {:.5}; in whole units of time: mean {}",
            decimals(moments.std, DECIMALS),
            moments.cov(),
            decimals(whole.mean, 4)
        );
    }
    text.push_str(&asked(&answer.answers));
    let course: Vec<Vec<String>> = answer
        .course
        .iter()
        .step_by(STRIDE)
        .map(|(t, band, hazard)| {
            let mut row = vec![number(*t)];
            row.extend(shares(band));
            row.push(number(*hazard));
            row
        })
        .collect();
    text.push('\n');
    text.push_str(&table(&["time", "reliability", "lower 95 %", "upper 95 %", "hazard"], &course));
    if let Some(budget) = &answer.budget {
        let _ = writeln!(text, "\nerror budget of the mean, half-widths at 95 %\n{budget}");
    }
    if let Some(joints) = machine {
        text.push_str(&of_machine(joints, calendar));
    }
    let warnings = answer.warnings.iter().chain(machine.iter().flat_map(|joints| &joints.life.warnings));
    for warning in warnings {
        let _ = writeln!(text, "\nwarning: {warning}");
    }
    text
}

fn of_machine(joints: &Joints, calendar: &Calendar) -> String {
    let life = &joints.life;
    let mut text =
        format!("\nmachine of {} joints, which fails with the first of them\n\n", joints.names.len());
    let mean = life.moments.as_ref().map(|(_, band)| *band);
    text.push_str(&lives(&life.quantiles, mean, &life.answers, calendar));
    let _ = writeln!(text, "\n{}", ends(life.interval, life.interval_kind.words(), calendar));
    text.push_str(&asked(&life.answers));
    let rows: Vec<Vec<String>> =
        joints.names.iter().zip(&life.first).map(|(name, p)| vec![name.clone(), format!("{p:.5}")]).collect();
    text.push('\n');
    text.push_str(&table(&["joint", "fails first"], &rows));
    text
}

/// Quantiles, usual and asked, and the mean.
fn lives(usual: &[Band; 3], mean: Option<Band>, answers: &Answers, calendar: &Calendar) -> String {
    let mut quantiles: Vec<(f64, Band)> = [0.1, 0.5, 0.9].into_iter().zip(usual.iter().copied()).collect();
    quantiles.extend(&answers.quantiles);
    quantiles.sort_by(|a, b| a.0.total_cmp(&b.0));
    quantiles.dedup_by(|a, b| a.0 == b.0);
    let named = quantiles.into_iter().map(|(p, band)| (b_name(p), band));
    let rows: Vec<Vec<String>> = named
        .chain(mean.map(|band| ("mean".to_owned(), band)))
        .map(|(name, Band { value, lower, upper })| {
            let mut row = vec![name];
            row.extend([value, lower, upper].map(time_or_never));
            if calendar.is_given() {
                row.push(if value.is_finite() { calendar.told(value) } else { NEVER.to_owned() });
            }
            row
        })
        .collect();
    let mut heads = vec!["", "time", "lower 95 %", "upper 95 %"];
    if calendar.is_given() {
        heads.push("date");
    }
    table(&heads, &rows)
}

/// B10 for a tenth; digits beyond the twelfth are rounding.
fn b_name(p: f64) -> String {
    format!("B{}", (1e14 * p).round() / 1e12)
}

/// A time, or that there is none.
fn time_or_never(time: f64) -> String {
    if time == f64::INFINITY { NEVER.to_owned() } else { decimals(time, DECIMALS) }
}

fn ends((lower, upper): (f64, f64), kind: &str, calendar: &Calendar) -> String {
    if upper == f64::INFINITY {
        let date = if calendar.is_given() { format!(", {}", calendar.told(lower)) } else { String::new() };
        return format!(
            "95 % of lives end after {}{date}, or never: no upper end ({kind})",
            time_or_never(lower)
        );
    }
    let dates = if calendar.is_given() {
        format!(", {} to {}", calendar.told(lower), calendar.told(upper))
    } else {
        String::new()
    };
    let [lower, upper] = [lower, upper].map(|time| decimals(time, DECIMALS));
    format!("95 % of lives end between {lower} and {upper}{dates} ({kind})")
}

fn shares(band: &Band) -> [String; 3] {
    [band.value, band.lower, band.upper].map(|share| format!("{share:.5}"))
}

/// Times and missions that were asked for.
fn asked(answers: &Answers) -> String {
    let mut text = String::new();
    if !answers.times.is_empty() {
        let row = |at: &linkwear_gamma::AtTime| {
            let mut row = vec![number(at.time)];
            row.extend(shares(&at.reliability));
            row.push(number(at.hazard));
            row.push(at.rest.map_or_else(|| "-".to_owned(), |rest| decimals(rest.value, DECIMALS)));
            row
        };
        let rows: Vec<Vec<String>> = answers.times.iter().map(row).collect();
        let heads = ["at time", "reliability", "lower 95 %", "upper 95 %", "hazard", "mean residual life"];
        let _ = write!(text, "\n{}", table(&heads, &rows));
    }
    if !answers.missions.is_empty() {
        let row = |([from, to], band): &([f64; 2], Band)| {
            let mut row = vec![format!("{} to {}", number(*from), number(*to))];
            row.extend(shares(band));
            row
        };
        let rows: Vec<Vec<String>> = answers.missions.iter().map(row).collect();
        let _ = write!(text, "\n{}", table(&["mission", "survives", "lower 95 %", "upper 95 %"], &rows));
    }
    text
}
