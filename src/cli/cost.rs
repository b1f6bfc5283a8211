//! `cost`: what the equations cost here, by operations and by the clock, and what a turn of the mechanism takes.

use std::time::Instant;

use crate::backend::{Backend, Equations};
use crate::cost::{EntryCost, Nanoseconds, entry_costs};
use crate::progress::watched;
use linkwear_codegen::tape::Operations;
use linkwear_codegen::{Compiled, Options};
use linkwear_runtime::{Integrator, Settings, Span, simulate};
use serde_json::{Map, Value, json};

use super::answer::Answer;
use super::equations::operations;
use super::failure::Failure;
use super::input::{load, options};
use super::options::Input;
use super::table::{count, duration, plural, short_table, table};

/// A turn of the first driven revolute joint, else a second, by the adaptive method.
struct Turn {
    backend: &'static str,
    time_s: f64,
    steps: u64,
    evaluations: u64,
    wall_seconds: f64,
}

pub fn run(input: &Input) -> Result<Answer, Failure> {
    let (compiled, warnings) = load(input)?;
    let options = options(input, false);
    let entries = entry_costs(&compiled, &options);
    let turn = turn(input, &compiled, &options)?;
    let points = entries.iter().map(|cost| (cost.entry.name().to_owned(), entry(cost)));
    let json = json!({
        "name": compiled.mechanism.name,
        "entry_points": points.collect::<Map<String, Value>>(),
        "turn": {
            "backend": turn.backend, "time_s": turn.time_s, "steps": turn.steps, "evaluations": turn.evaluations,
            "milliseconds": 1e3 * turn.wall_seconds,
        },
        "warnings": warnings,
    });
    Ok(Answer::new(text(&compiled.mechanism.name, &entries, &turn), json, None))
}

fn turn(input: &Input, compiled: &Compiled, options: &Options) -> Result<Turn, Failure> {
    let description = compiled.description();
    let equations = Equations::choose(compiled, options, Backend::Auto)?;
    let span = if description.turn_driver.is_some() { Span::Turns(1.0) } else { Span::Time(1.0) };
    let integrator = Integrator::adaptive(description, None);
    // Only the two rows at the ends: more would be paid for.
    let settings = Settings::new(integrator, span, 2);
    let (system, parameters) = (equations.system(), compiled.parameters());
    let start = Instant::now();
    let run = watched(|watch| simulate(&*system, description, &parameters, &settings, watch));
    let wall_seconds = start.elapsed().as_secs_f64();
    let run = run.map_err(|error| Failure::run(&input.file, &error, None))?;
    if let Some(error) = &run.stopped {
        return Err(Failure::run(&input.file, error, None));
    }
    Ok(Turn {
        backend: equations.name(),
        time_s: run.times.last().copied().unwrap_or_default(),
        steps: run.statistics.steps,
        evaluations: run.statistics.evaluations,
        wall_seconds,
    })
}

fn entry(cost: &EntryCost) -> Value {
    let section =
        |(name, count): &(String, Operations)| json!({ "name": name, "operations": operations(count) });
    let Nanoseconds { interpreter, native, compiled, lanes4, lanes8 } = cost.ns;
    json!({
        "operations": operations(&cost.operations),
        "sections": cost.sections.iter().map(section).collect::<Vec<_>>(),
        "ns": {
            "interpreter": interpreter, "native": native, "compiled": compiled, "lanes4": lanes4, "lanes8": lanes8,
        },
    })
}

fn text(name: &str, entries: &[EntryCost], turn: &Turn) -> String {
    let head = format!(
        "{name}: {:.3} s in {}, {}, {}",
        turn.time_s,
        duration(turn.wall_seconds),
        plural(turn.steps, "step", "steps"),
        turn.backend
    );
    let columns = [
        "entry",
        "operations",
        "interpreter [ns]",
        "native [ns]",
        "compiled [ns]",
        "4 lanes [ns]",
        "8 lanes [ns]",
    ];
    let rows: Vec<_> = entries.iter().map(row).collect();
    let sections = entries.iter().flat_map(|cost| {
        let entry = cost.entry.name();
        cost.sections.iter().map(move |(section, operations)| {
            vec![entry.to_owned(), section.clone(), count(operations.total)]
        })
    });
    format!(
        "{head}\n\n{}\n{}",
        table(&columns, &rows),
        short_table(&["entry", "section", "operations"], sections.collect())
    )
}

fn row(cost: &EntryCost) -> Vec<String> {
    let Nanoseconds { interpreter, native, compiled, lanes4, lanes8 } = cost.ns;
    let times = [interpreter, native, compiled, lanes4, lanes8];
    let times = times.map(|time| time.map_or_else(String::new, |time| format!("{time:.1}")));
    [cost.entry.name().to_owned(), count(cost.operations.total)].into_iter().chain(times).collect()
}
