//! `cost`: what the equations cost here, by operations and by the clock, and what a turn of the mechanism takes.

use std::time::Instant;

use crate::backend::{Backend, Equations};
use crate::cost::{EntryCost, Nanoseconds, entry_costs};
use crate::progress::watched;
use linkwear_codegen::{Compiled, Options};
use linkwear_runtime::{Integrator, RunError, Settings, Span, simulate};
use serde_json::json;

use super::answer::Answer;
use super::answer::equations::{CostAnswer, EntryAnswer, TurnCost};
use super::failure::Failure;
use super::input::{load, options};
use super::options::Input;
use super::table::{count, duration, plural, short_table, table};

pub fn run(input: &Input) -> Result<Answer, Failure> {
    let (compiled, warnings) = load(input)?;
    let options = options(input, false);
    let entries = entry_costs(&compiled, &options);
    let turn = turn(input, &compiled, &options)?;
    let point = |cost: &EntryCost| (cost.entry.name().to_owned(), json!(EntryAnswer::from(cost)));
    let text = text(&compiled.mechanism.name, &entries, &turn);
    let entry_points = entries.iter().map(point).collect();
    Ok(Answer::new(text, CostAnswer { name: &compiled.mechanism.name, entry_points, turn, warnings }, None))
}

fn turn(input: &Input, compiled: &Compiled, options: &Options) -> Result<TurnCost, Failure> {
    let description = compiled.description();
    let equations = Equations::choose(compiled, options, Backend::Auto)?;
    let integrator = Integrator::adaptive(description, None);
    let (system, parameters) = (equations.system(), compiled.parameters());
    let timed = |span: Span| {
        // Only the two rows at the ends: more would be paid for.
        let settings = Settings::new(integrator, span, 2);
        let start = Instant::now();
        let run = watched("run", |watch| simulate(&*system, description, &parameters, &settings, watch));
        (run, start.elapsed().as_secs_f64())
    };
    let (run, wall_seconds) = match description.turn_driver.map(|_| timed(Span::Turns(1.0))) {
        // A driver that swings makes no turn.
        None | Some((Err(RunError::TurnsNotReached { .. }), _)) => timed(Span::Time(1.0)),
        Some(turn) => turn,
    };
    let run = run.map_err(|error| Failure::run(&input.file, &error, None))?;
    if let Some(error) = &run.stopped {
        return Err(Failure::run(&input.file, error, None));
    }
    Ok(TurnCost {
        backend: equations.name(),
        time_s: run.times.last().copied().unwrap_or_default(),
        steps: run.statistics.steps,
        evaluations: run.statistics.evaluations,
        milliseconds: 1e3 * wall_seconds,
    })
}

fn text(name: &str, entries: &[EntryCost], turn: &TurnCost) -> String {
    let head = format!(
        "{name}: {:.3} s in {}, {}, {}",
        turn.time_s,
        duration(1e-3 * turn.milliseconds),
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
