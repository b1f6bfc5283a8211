//! `simulate`: choose a back end, integrate, record.

use std::path::{Path, PathBuf};
use std::time::Instant;

use linkwear::mechanism::Mechanism;
use linkwear::progress::watched;
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{Description, Integrator, Run, RunError, Settings, Span, simulate, write_csv};
use serde_json::{Value, json};

use super::arguments::{Format, IntegratorName, SimulateArguments};
use super::failure::{Failure, entries};
use super::file::{print, refuse_same, write_whole};
use super::input::load_mechanism;
use super::summary;
use super::table::{duration, number, plural, table};

/// Step of the fixed-step methods unless one is given [s].
const DEFAULT_STEP: f64 = 1e-4;
/// Tolerance of the adaptive method unless one is given.
const DEFAULT_TOLERANCE: f64 = 1e-9;
/// Spectral radius of generalized-alpha at infinite frequency: damps what the step cannot resolve.
const DEFAULT_RHO: f64 = 0.8;

/// Answers `simulate`.
pub fn run(arguments: &SimulateArguments, format: Format) -> Result<(), Failure> {
    let integrator = integrator(arguments)?;
    if let Some(out) = &arguments.out {
        refuse_same(&arguments.input.file, out)?;
    }
    let mechanism = load_mechanism(&arguments.input, arguments.rigid, arguments.backend)?;
    let description = &mechanism.description;
    let span = span(arguments, description)?;
    let settings = Settings::new(integrator, span, arguments.samples as usize);

    let start = Instant::now();
    let system = mechanism.system();
    let parameters = &mechanism.parameters;
    let result = watched(|watch| simulate(&*system, description, parameters, &settings, watch));
    let wall_seconds = start.elapsed().as_secs_f64();

    let run = result.map_err(|error| failed(arguments, error, None))?;
    if let Some(error) = &run.stopped {
        return Err(failed(arguments, error.clone(), keep_partial(arguments, &run)?));
    }
    if let Some(out) = &arguments.out {
        write_whole(out, |file| write_csv(file, &run))?;
    }
    match format {
        Format::Json => print(&to_json(arguments, &mechanism, &run, wall_seconds)),
        Format::Text => print(&to_text(arguments, &mechanism, &run, &settings, wall_seconds)),
    }
}

fn integrator(arguments: &SimulateArguments) -> Result<Integrator, Failure> {
    let step = arguments.step.unwrap_or(DEFAULT_STEP);
    let default = if arguments.step.is_some() { IntegratorName::Rk4 } else { IntegratorName::Dopri5 };
    let name = arguments.integrator.unwrap_or(default);
    let misfit = |option: &str, help: &str| Failure::Usage {
        message: format!("the integrator has no {option}"),
        help: help.to_owned(),
    };
    match name {
        IntegratorName::Dopri5 if arguments.step.is_some() => {
            Err(misfit("--step", "dopri5 chooses its steps: give --tol, or --integrator rk4"))
        }
        IntegratorName::Rk4 | IntegratorName::GeneralizedAlpha if arguments.tol.is_some() => {
            Err(misfit("--tol", "it takes fixed steps: give --step, or --integrator dopri5"))
        }
        IntegratorName::Dopri5 => {
            Ok(Integrator::Dopri5 { tolerance: arguments.tol.unwrap_or(DEFAULT_TOLERANCE), max_step: None })
        }
        IntegratorName::Rk4 => Ok(Integrator::Rk4 { step }),
        IntegratorName::GeneralizedAlpha => Ok(Integrator::GeneralizedAlpha { step, rho: DEFAULT_RHO }),
    }
}

fn span(arguments: &SimulateArguments, description: &Description) -> Result<Span, Failure> {
    match (arguments.length.turns, arguments.length.time, description.turn_driver) {
        (_, Some(time), _) => Ok(Span::Time(time)),
        (Some(turns), _, Some(_)) => Ok(Span::Turns(turns)),
        (Some(_), _, None) => Err(Failure::Usage {
            message: "--turns: this mechanism has no driven revolute joint to count turns of".to_owned(),
            help: "give --time in seconds".to_owned(),
        }),
        (None, None, Some(_)) => Ok(Span::Turns(1.0)),
        (None, None, None) => Ok(Span::Time(1.0)),
    }
}

fn failed(arguments: &SimulateArguments, error: RunError, kept: Option<PathBuf>) -> Failure {
    let file = arguments.input.file.clone();
    match error {
        RunError::Interrupted { t } => Failure::Interrupted { file, time: t, kept },
        error => Failure::Run { file, error, kept },
    }
}

/// Saves the rows of an incomplete run beside the file they were meant for, which is left as it was.
fn keep_partial(arguments: &SimulateArguments, run: &Run) -> Result<Option<PathBuf>, Failure> {
    let Some(out) = arguments.out.as_deref().filter(|_| !run.rows.is_empty()) else { return Ok(None) };
    let partial = partial_name(out);
    write_whole(&partial, |file| write_csv(file, run))?;
    Ok(Some(partial))
}

/// `rssr.csv` -> `rssr.partial.csv`.
fn partial_name(out: &Path) -> PathBuf {
    let mut name = out.file_stem().unwrap_or_default().to_os_string();
    name.push(".partial");
    if let Some(extension) = out.extension() {
        name.push(".");
        name.push(extension);
    }
    out.with_file_name(name)
}

fn to_json(arguments: &SimulateArguments, mechanism: &Mechanism, run: &Run, wall_seconds: f64) -> Value {
    let numbers = &run.statistics;
    let description = &mechanism.description;
    json!({
        "name": description.name,
        "backend": mechanism.backend(),
        "time_s": run.times.last().copied().unwrap_or_default(),
        "samples": run.rows.len(),
        "steps": numbers.steps,
        "rejected": numbers.rejected,
        "evaluations": numbers.evaluations,
        "projections": numbers.projections,
        "rank_revealing_solves": numbers.rank_revealing_solves,
        "newton_iterations": numbers.newton_iterations,
        "wall_seconds": wall_seconds,
        "max_loop_error_m": numbers.max_loop_error_m,
        "max_loop_error_rad": numbers.max_loop_error_rad,
        "energy_error_J": numbers.energy_error_J,
        "energy_throughput_J": numbers.energy_throughput_J,
        "peaks": summary::peaks(run).iter().map(summary::Peak::to_json).collect::<Vec<_>>(),
        "out": arguments.out.as_ref().map(|path| path.display().to_string()),
        "turns": turn_entries(description, run),
        "warnings": all_warnings(mechanism, run),
    })
}

/// Every joint with clearance in every turn.
fn turn_entries(description: &Description, run: &Run) -> Vec<Value> {
    let joints = description.contacts.iter().map(|contact| contact.joint.as_ref());
    let turns = run.turns.iter().enumerate();
    turns.flat_map(|(at, turn)| joints.clone().zip(turn).map(move |of| turn_entry(at + 1, of))).collect()
}

fn turn_entry(turn: usize, (joint, measure): (&str, &ContactMeasure)) -> Value {
    let mut entry = json!({ "turn": turn, "joint": joint });
    for (column, value) in &ContactMeasure::COLUMNS {
        // Within a turn losses are counted, and forces have their long name.
        let key = column.key().replace("_force", "_normal_force");
        let value = value(measure);
        entry[key] = if column.name == "contact losses" { json!(value as u64) } else { json!(value) };
    }
    entry
}

/// Those of the file, then those of the run.
fn all_warnings(mechanism: &Mechanism, run: &Run) -> Vec<Value> {
    let of_run = run.warnings.iter().map(|warning| json!({ "code": "run", "message": warning.to_string() }));
    entries(&mechanism.warnings).into_iter().chain(of_run).collect()
}

/// The last turns of every joint with clearance.
fn turns_table(description: &Description, run: &Run) -> String {
    const SHOWN: usize = 12;
    let brief = || ContactMeasure::COLUMNS.iter().filter(|(column, _)| column.brief);
    let mut rows = Vec::new();
    for (at, turn) in run.turns.iter().enumerate() {
        for (contact, measure) in description.contacts.iter().zip(turn) {
            let cells = brief().map(|(column, value)| match column.unit {
                "J" => format!("{:.7}", value(measure)),
                _ => number(value(measure)),
            });
            rows.push([(at + 1).to_string(), contact.joint.to_string()].into_iter().chain(cells).collect());
        }
    }
    let rows = rows.split_off(rows.len().saturating_sub(SHOWN));
    let head: Vec<String> = ["turn", "joint"]
        .map(str::to_owned)
        .into_iter()
        .chain(brief().map(|(column, _)| column.title()))
        .collect();
    table(&head, &rows)
}

fn to_text(
    arguments: &SimulateArguments,
    mechanism: &Mechanism,
    run: &Run,
    settings: &Settings,
    wall_seconds: f64,
) -> String {
    let description = &mechanism.description;
    let end = number(run.times.last().copied().unwrap_or_default());
    let length = match settings.span {
        Span::Turns(turns) => {
            let word = if turns == 1.0 { "turn" } else { "turns" };
            format!("{turns} {word} ({end} s)")
        }
        Span::Time(_) => format!("{end} s"),
    };
    let head =
        format!("{}: {length} in {}, {}", description.name, duration(wall_seconds), mechanism.backend());
    let method = match settings.integrator {
        Integrator::Rk4 { step } => format!("rk4, step {step:e} s"),
        Integrator::Dopri5 { tolerance, .. } => format!("dopri5, tolerance {tolerance:e}"),
        Integrator::GeneralizedAlpha { step, rho } => {
            format!("generalized-alpha, step {step:e} s, rho {rho}")
        }
    };
    let mut text = summary::text(description, run, &head, &method);
    if !run.turns.is_empty() {
        text.push('\n');
        text.push_str(&turns_table(description, run));
    }
    for warning in &run.warnings {
        text.push_str(&format!("\nwarning: {}\n", warning));
    }
    if let Some(out) = &arguments.out {
        let rows = plural(run.rows.len() as u64, "row", "rows");
        text.push_str(&format!("\n{rows} of {} columns in {}", run.channels.len() + 1, out.display()));
    }
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_an_incomplete_run_go_beside_the_file() {
        assert_eq!(partial_name(Path::new("a/rssr.csv")), Path::new("a/rssr.partial.csv"));
        assert_eq!(partial_name(Path::new("rssr")), Path::new("rssr.partial"));
    }
}
