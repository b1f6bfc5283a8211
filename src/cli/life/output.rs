//! What `life` says. In: a life. Out: one JSON object, or a page of text.

use std::fmt::Write as _;

use crate::life::{Cost, HOUR, JointProcess, LifeFacts, LifeResult, Shard, YEAR};
use crate::number::{decimals, number};
use crate::wear_measure::paragraph;
use linkwear_gamma::life::{CountedLives, LifeStatistics, WithError};
use linkwear_runtime::Column;
use linkwear_runtime::life::{CycleJoint, CycleRecord};
use serde_json::json;

use super::super::answer::Answer;
use super::super::answer::life::{CycleAnswer, ShardAnswer, known};
use super::super::table::{count, table};
use super::hours::hours;
use super::mission::mission_text;
use super::told::told_of;

/// Cycles that are printed before long lives are thinned out.
const SHOWN: usize = 40;

/// The answer.
pub fn answer(facts: &LifeFacts, life: &LifeResult) -> Answer {
    let statistics = life.statistics();
    let text = to_text(facts, life, statistics.as_ref());
    Answer::new(text, told_of(facts, life, statistics.as_ref()), Some(&facts.provenance))
}

/// The answer of a shard, said to be one.
pub fn of_shard(answer: Answer, shard: Shard) -> Answer {
    let text = format!(
        "shard {shard}: what follows is of its lives alone; `linkwear merge` puts the lives of all shards together\n\n{}",
        answer.text
    );
    let mut json = answer.json;
    json["shard"] = json!(ShardAnswer { index: shard.index, of: shard.of });
    Answer { text, json, disagrees: false }
}

/// Cycles alone, of a life that stopped.
pub fn cycles(names: &[String], cycles: &[CycleRecord]) -> Answer {
    let json = cycles.iter().map(|cycle| json!(CycleAnswer::new(names, cycle))).collect();
    Answer { text: cycles_table(names, cycles), json, disagrees: false }
}

/// What a life with the dynamics at every wear step will cost, and what a table would.
pub fn cost(cost: &Cost) -> String {
    let Cost { seconds_per_revolution, revolutions, cycles, mean_path: [least, most], .. } = cost;
    let Cost { mean_path_side_by_side: together, lives, side_by_side, table, too_long, .. } = cost;
    let time = |measurements: f64| about(cost.seconds(measurements));
    let mut text = format!(
        "full coupling runs the dynamics at every wear step: {} a measurement ({revolutions} revolutions of {}). If all wore as \
         the first does, the mean path would have {}: {least:.0} to {most:.0} measurements, {} to {}",
        time(1.0),
        about(*seconds_per_revolution),
        match *cycles {
            ..1.0 => "less than a cycle".to_owned(),
            1.0..1.5 => "1 cycle".to_owned(),
            _ => format!("{cycles:.0} cycles"),
        },
        time(*least / together),
        time(*most / together),
    );
    if *lives > 0.0 {
        let _ =
            write!(text, "; the random lives {lives:.0} for each thread, {}", time(*lives / side_by_side));
    }
    let _ = match table {
        Some(table) => write!(
            text,
            ".\n--coupling table takes {table:.0} measurements, {}, for any number of lives: wear per revolution is looked up by \
             the wear of the joint, with its error in the budget.",
            time(*table)
        ),
        None => write!(
            text,
            ".\nA worn profile that is fed back has no table. Without `profile = true` in [wear], but with measure = \"maximum\" \
             or \"mean\", wear opens the clearance all round and a table of 17 measurements, {}, does: the shape of the worn \
             bearing then changes no force.",
            time(17.0)
        ),
    };
    if let Some(pace) = too_long {
        let _ = write!(text, "\nwarning: no life is lived for so many: {}", pace.cure());
    }
    text
}

/// A time in the unit that people would say it in.
fn about(seconds: f64) -> String {
    let units =
        [(YEAR, "years"), (24.0 * HOUR, "days"), (HOUR, "h"), (60.0, "min"), (1.0, "s"), (1e-3, "ms")];
    let (size, unit) = units.into_iter().find(|(size, _)| seconds >= *size).unwrap_or((1e-3, "ms"));
    format!("{:.1} {unit}", seconds / size)
}

fn to_text(facts: &LifeFacts, life: &LifeResult, statistics: Option<&LifeStatistics>) -> String {
    let names = life.names();
    let joint = life.failed_joint();
    let mut text = format!(
        "{}: on its mean path {} fails after {} cycles ({} whole), {} revolutions; {}\n",
        facts.name,
        joint.joint,
        decimals(life.end.cycles, 3),
        life.end.whole_cycles,
        number(life.end.cycles * joint.revolutions_per_cycle),
        facts.backend,
    );
    if let Some(seconds) = life.seconds_per_cycle() {
        let (path, turn) = (life.end.cycles * seconds, seconds / joint.revolutions_per_cycle);
        let (hours, years) = (hours(path), number(path / YEAR));
        let _ = writeln!(
            text,
            "at {} s a revolution{} that is {hours} hours, {years} years without a pause",
            number(turn),
            if life.mission.is_some() { " on average" } else { "" },
        );
    }
    text.push_str(&mission_text(life));
    text.push_str(&paragraph(&facts.wear_measures));
    let joints = life.process.as_deref().unwrap_or_default();
    if joints.iter().any(|joint| joint.from.is_some() || joint.cycle_variation.is_some()) {
        joints.iter().for_each(|joint| text.push_str(&process_line(joint)));
    }
    text.push_str(&statistics.map_or_else(String::new, |lives| scatter(facts, life, lives)));
    let _ = write!(text, "\n{}", cycles_table(&names, &life.cycles));
    if let Some(error) = life.table_error() {
        let _ = writeln!(
            text,
            "\nwear per revolution from a table of {} measurements, good to {error:.1e} of itself",
            life.measurements
        );
    }
    if statistics.is_none() {
        let _ = writeln!(text, "\nerror of the mean path, half-widths at 95 % [cycles]\n{}", life.budget());
    }
    if life.random_lives() == 0 {
        text.push_str(if life.process.is_some() {
            "\nno random lives were drawn; --trajectories 16 draws some\n"
        } else {
            "\nno random lives: [wear] gives no alpha and beta of the Gamma process\n"
        });
    }
    for warning in &life.warnings {
        let _ = writeln!(text, "\nwarning: {warning}");
    }
    text
}

fn scatter(facts: &LifeFacts, life: &LifeResult, lives: &LifeStatistics) -> String {
    let (mean, std, cov) = (lives.mean(), lives.std(), lives.cov());
    let seconds = life.seconds_per_cycle();
    let time = |cycles: f64| seconds.map_or_else(String::new, |seconds| hours(cycles * seconds));
    let row = |name: &str, digits: usize, found: WithError, [low, high]: [Option<f64>; 2]| {
        let end = |end: Option<f64>| end.map_or_else(|| "?".to_owned(), |end| decimals(end, digits));
        let value = format!("{} +- {}", decimals(found.value, digits), end(known(found.error)));
        vec![name.to_owned(), value, format!("{} to {}", end(low), end(high)), time(found.value)]
    };
    let quantile =
        |name: &str, p: f64| Some(row(name, 3, lives.quantile(p).ok()?, lives.quantile_interval(p).ok()?));
    let (whole, (low, high)) = (life.mean_whole_cycles(), lives.std_interval());
    let off = known(cov.error).map_or_else(|| "?".to_owned(), |error| format!("{:.3} %", 100.0 * error));
    let percent = format!("{:.3} % +- {off}", 100.0 * cov.value);
    let half = lives.mean_half_width();
    let rows: Vec<Vec<String>> = [
        Some(row("mean", 3, mean, [-half, half].map(|by| Some(mean.value + by)))),
        Some(vec!["mean, whole cycles".to_owned(), decimals(whole, 3), String::new(), time(whole)]),
        Some(row("standard deviation", 4, std, [Some(low), Some(high)])),
        Some(["coefficient of variation", &percent, "", ""].map(str::to_owned).to_vec()),
        quantile("10 % fail before (B10)", 0.1),
        quantile("half fail before (B50)", 0.5),
        quantile("90 % fail before (B90)", 0.9),
    ]
    .into_iter()
    .flatten()
    .collect();
    let head = format!("{} random lives, seed {}", lives.count(), facts.seed);
    let time = if seconds.is_some() { "hours" } else { "" };
    let head = [head.as_str(), "cycles, +- standard error", "95 %", time];
    let mut text = format!("\n{}", table(&head, &rows));
    let _ = writeln!(text, "\nerror of the mean, half-widths at 95 % [cycles]\n{}", life.budget());
    if life.counted.is_some() {
        let _ = writeln!(
            text,
            "\nmore than {} lives are counted in bins: the mean is exact, quantiles and spread are those of lives each off by {:.1e} of \
             itself at most; no lives.csv",
            count(facts.listed),
            CountedLives::ERROR
        );
    }
    let names = life.names();
    if names.len() > 1 {
        let parts = names.iter().zip(life.failed_first());
        let parts: Vec<String> = parts.map(|(name, part)| format!("{name} {:.1} %", 100.0 * part)).collect();
        let _ = writeln!(text, "\nfirst to fail: {}", parts.join(", "));
    }
    if let Some(cov) = facts.shared_factor {
        let _ =
            writeln!(text, "\nin each life all wear runs by one factor, of coefficient of variation {cov}");
    }
    text
}

fn process_line(joint: &JointProcess) -> String {
    let from = match (&joint.from, joint.cycle_variation) {
        (Some(from), _) => format!("from `{from}`"),
        (None, Some(part)) => format!("by which its first cycle scatters by {} %", number(100.0 * part)),
        (None, None) => "from the mechanism's file, taken as known".to_owned(),
    };
    let [alpha, beta] = joint.per_micrometre().map(number);
    format!("{}: alpha {alpha}/um, beta {beta}/um, {from}\n", joint.joint)
}

/// Cycles for people, thinned out: lengths in micrometres, without what hardly changes along a life.
fn cycles_table(names: &[String], cycles: &[CycleRecord]) -> String {
    let shown = |column: &Column| !["wear integral", "mean force"].contains(&column.name);
    let cell = |(column, value): (Column, f64)| match (column.name, column.unit) {
        ("dLambda", _) => format!("{:.4}", 1e6 * value),
        (_, "m") => format!("{:.3}", 1e6 * value),
        _ => number(value),
    };
    let title = |column: Column| column.title().replace("[m]", "[um]");
    let stride = cycles.len().div_ceil(SHOWN).max(1);
    let end = cycles.len().saturating_sub(1);
    let mut rows = Vec::new();
    for (_, cycle) in cycles.iter().enumerate().filter(|(at, _)| at % stride == 0 || *at == end) {
        for (name, joint) in names.iter().zip(&cycle.joints) {
            let columns = CycleJoint::columns().zip(joint.values());
            let cells = columns.filter(|(column, _)| shown(column)).map(cell);
            rows.push([cycle.cycle.to_string(), name.clone()].into_iter().chain(cells).collect());
        }
    }
    let titles = CycleJoint::columns().filter(shown).map(title);
    let head: Vec<String> = ["cycle", "joint"].map(str::to_owned).into_iter().chain(titles).collect();
    table(&head, &rows)
}
