//! `simulate`: choose a back end, integrate, record.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::csv_table::CsvTable;
use crate::inputs::read_inputs;
use crate::mechanism::Mechanism;
use crate::number::{fixed, number};
#[cfg(feature = "page")]
use crate::page::run_picture;
use crate::progress::watched;
use crate::provenance::Provenance;
use crate::remark::remark;
use crate::table::{is_stdout, write_table};
use linkwear_codegen::limits::ROW_NUMBERS;
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{
    Description, Integrator, Run, RunError, SampledSignals, Settings, Span, Statistics, Watch, simulate,
    simulate_with_inputs,
};
use serde_json::{Value, json};

use super::answer::Answer;
use super::answer::simulate::{PeakAnswer, SimulateAnswer, TurnAnswer};
use super::arguments::SimulateArguments;
use super::failure::{Failure, warnings};
use super::input::{check_output, check_replaced, load_mechanism};
use super::options::{IntegratorName, MotionArguments};
#[cfg(feature = "page")]
use super::picture;
use super::summary;
use super::table::{count, duration, plural, table};

/// Steps that differ by less than this part of themselves are the same but for rounding.
const SAME_STEP: f64 = 1e-9;
/// Step of the fixed-step methods unless one is given [s].
const DEFAULT_STEP: f64 = 1e-4;
/// How long runs are of what has no turns, unless it is given [s].
const UNDRIVEN: f64 = 1.0;
/// Spectral radius of generalized-alpha at infinite frequency: damps what the step cannot resolve.
const DEFAULT_RHO: f64 = 0.8;

pub fn run(arguments: &SimulateArguments) -> Result<Answer, Failure> {
    integrator(&arguments.motion)?;
    let (file, out) = (&arguments.input.file, arguments.out.as_deref());
    let read = arguments.motion.read_beside(file);
    let is_stream = check_output(&read, out, arguments.replace)?;
    // What is computed before a run stops goes there: a file that it was meant for is left as it was.
    let kept = out.map(|out| if is_stream { out.to_path_buf() } else { partial_name(out) });
    kept.as_deref().map_or(Ok(true), |kept| check_replaced(kept, arguments.replace))?;
    #[cfg(feature = "page")]
    picture::check_plot_beside(out, &read, arguments.plot.as_deref(), arguments.replace)?;
    let mechanism = load_mechanism(&arguments.input, arguments.equations)?;
    let asked = Simulation::new(file, &arguments.motion, &mechanism)?;
    let start = Instant::now();
    let run = watched("run", |watch| asked.run(watch))?;
    let (settings, wall_seconds) = (asked.settings, start.elapsed().as_secs_f64());
    if let Some(error) = &run.stopped {
        let partial = kept.filter(|_| !run.rows.is_empty());
        partial
            .as_deref()
            .map_or(Ok(()), |partial| write_table(partial, &run.table(), Some(&asked.provenance())))?;
        return Err(Failure::run(file, error, partial));
    }
    #[cfg(feature = "page")]
    picture::write_plot(arguments.plot.as_deref(), || run_picture(&run))?;
    let provenance = asked.provenance();
    out.map_or(Ok(()), |out| write_table(out, &run.table(), Some(&provenance)))?;
    if out.is_some_and(is_stdout) {
        run.warnings.iter().for_each(|warning| remark(&format_args!("warning: {warning}")));
        return Ok(Answer::new(String::new(), Value::Null, None));
    }
    let text = to_text(out, &mechanism, &run, &settings, wall_seconds);
    Ok(Answer::new(text, told_of(out, &mechanism, &run, wall_seconds), Some(&provenance)))
}

/// What is to be simulated, and how.
pub struct Simulation<'a> {
    file: &'a Path,
    mechanism: &'a Mechanism,
    /// Inputs over time.
    pub signals: Option<SampledSignals>,
    inputs_sha256: Option<String>,
    /// How it is made.
    pub settings: Settings,
    samples: usize,
}

impl<'a> Simulation<'a> {
    pub fn new(
        file: &'a Path,
        arguments: &MotionArguments,
        mechanism: &'a Mechanism,
    ) -> Result<Self, Failure> {
        let integrator = integrator(arguments)?;
        let description = &mechanism.description;
        refuse_too_many(arguments.samples as usize, description)?;
        let inputs = arguments.inputs.as_deref().map(CsvTable::read).transpose()?;
        let signals = inputs.as_ref().map(|table| read_inputs(table, description)).transpose()?;
        if let Some(name) = signals.as_ref().and_then(|signals| mechanism.given_over_time(signals)) {
            return Err(Failure::set_over_time(name));
        }
        let inputs_sha256 = inputs.map(|table| table.sha256().to_owned());
        let span = span(arguments, description)?;
        let integrator = integrator.unwrap_or_else(|| Integrator::adaptive(description, arguments.tol));
        let samples = arguments.samples as usize;
        let settings = Settings::new(integrator, span, samples);
        Ok(Self { file, mechanism, signals, inputs_sha256, settings, samples })
    }

    /// What the run is of.
    pub fn provenance(&self) -> Provenance {
        self.mechanism.provenance(None, self.options())
    }

    /// Options that decide its numbers, as results tell them.
    pub fn options(&self) -> Value {
        let Settings { integrator, span, .. } = &self.settings;
        let (turns, time) = match *span {
            Span::Turns(turns) => (Some(turns), None),
            Span::Time(time) => (None, Some(time)),
        };
        json!({
            "integrator": name(*integrator), "step_s": integrator.step(), "tolerance": integrator.tolerance(), "turns": turns, "time_s": time,
            "samples": self.samples, "inputs_sha256": self.inputs_sha256,
        })
    }

    /// The run, perhaps stopped on its way.
    pub fn run(&self, watch: Watch<'_>) -> Result<Run, Failure> {
        self.simulated(watch).map_err(|error| Failure::run(self.file, &error, None))
    }

    #[cfg(feature = "page")]
    /// The run of a picture: of [`UNDRIVEN`] seconds where a driver never gets round and nobody said how long.
    pub fn shown(&mut self, arguments: &MotionArguments, watch: Watch<'_>) -> Result<Run, Failure> {
        let (turns, time) = (arguments.length.turns, arguments.length.time);
        match self.simulated(watch) {
            Err(RunError::TurnsNotReached { .. }) if turns.is_none() && time.is_none() => {
                remark(&format_args!(
                    "warning: the driver does not get round; what is shown are {UNDRIVEN} s"
                ));
                self.settings.span = Span::Time(UNDRIVEN);
                self.run(watch)
            }
            run => run.map_err(|error| Failure::run(self.file, &error, None)),
        }
    }

    fn simulated(&self, watch: Watch<'_>) -> Result<Run, RunError> {
        let Mechanism { description, parameters, .. } = self.mechanism;
        let system = self.mechanism.system();
        match &self.signals {
            Some(signals) => {
                simulate_with_inputs(&*system, description, parameters, signals, &self.settings, watch)
            }
            None => simulate(&*system, description, parameters, &self.settings, watch),
        }
    }
}

fn refuse_too_many(samples: usize, description: &Description) -> Result<(), Failure> {
    let most = ROW_NUMBERS.most / description.channels.len().max(1);
    if samples <= most {
        return Ok(());
    }
    let message = format!("--samples: {samples} rows of {} columns", description.channels.len());
    Err(Failure::usage(message, format!("at most {most} rows stand in memory: {}", ROW_NUMBERS.help)))
}

/// The method that is asked for; nothing: the adaptive one that suits the mechanism.
pub fn integrator(arguments: &MotionArguments) -> Result<Option<Integrator>, Failure> {
    method(arguments.integrator, (arguments.step, arguments.tol))
}

/// The same of its words.
pub fn method(
    name: Option<IntegratorName>,
    (given, tolerance): (Option<f64>, Option<f64>),
) -> Result<Option<Integrator>, Failure> {
    use IntegratorName::{Dopri5, GeneralizedAlpha, Rk4, Rk43, Rodas5P};
    let step = given.unwrap_or(DEFAULT_STEP);
    let Some(name) = name.or(given.map(|_| Rk4)) else { return Ok(None) };
    let or = |default: f64| tolerance.unwrap_or(default);
    match name {
        Dopri5 | Rodas5P | Rk43 if given.is_some() => {
            let help = "the method chooses its steps: give --tol, or --integrator rk4";
            Err(Failure::usage("the integrator has no --step", help))
        }
        Rk4 | GeneralizedAlpha if tolerance.is_some() => {
            let help = "it takes fixed steps: give --step, or leave --integrator out";
            Err(Failure::usage("the integrator has no --tol", help))
        }
        Dopri5 => Ok(Integrator::Dopri5 { tolerance: or(Integrator::SMOOTH_TOLERANCE), max_step: None }),
        Rodas5P => Ok(Integrator::Rodas5P { tolerance: or(Integrator::MODAL_TOLERANCE), max_step: None }),
        Rk43 => Ok(Integrator::Rk43 { tolerance: or(Integrator::CONTACT_TOLERANCE), max_step: None }),
        Rk4 => Ok(Integrator::Rk4 { step }),
        GeneralizedAlpha => Ok(Integrator::GeneralizedAlpha { step, rho: DEFAULT_RHO }),
    }
    .map(Some)
}

fn span(arguments: &MotionArguments, description: &Description) -> Result<Span, Failure> {
    let (turns, time) = (arguments.length.turns, arguments.length.time);
    match (time, description.turn_driver, turns) {
        (Some(time), ..) => Ok(Span::Time(time)),
        (None, Some(_), turns) => Ok(Span::Turns(turns.unwrap_or(1.0))),
        (None, None, None) => Ok(Span::Time(UNDRIVEN)),
        (None, None, Some(_)) => {
            let message = "--turns: this mechanism has no driven revolute joint to count turns of";
            Err(Failure::usage(message, "give --time in seconds"))
        }
    }
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

/// What is told of a run, for machines.
pub fn told_of<'a>(
    out: Option<&Path>,
    mechanism: &'a Mechanism,
    run: &'a Run,
    wall_seconds: f64,
) -> SimulateAnswer<'a> {
    let numbers = &run.statistics;
    let description = &mechanism.description;
    SimulateAnswer {
        name: &description.name,
        backend: mechanism.backend(),
        time_s: run.times.last().copied().unwrap_or_default(),
        samples: run.rows.len(),
        steps: numbers.steps,
        implicit_steps: numbers.implicit_steps,
        rejected: numbers.rejected,
        evaluations: numbers.evaluations,
        projections: numbers.projections,
        rank_revealing_solves: numbers.rank_revealing_solves,
        newton_iterations: numbers.newton_iterations,
        wall_seconds,
        max_loop_error_m: numbers.max_loop_error_m,
        max_loop_error_rad: numbers.max_loop_error_rad,
        energy_error_J: numbers.energy_error_J,
        energy_throughput_J: numbers.energy_throughput_J,
        peaks: run.peaks.iter().map(PeakAnswer::from).collect(),
        out: out.map(|path| path.display().to_string()),
        turns: turns(description, run)
            .map(|(turn, joint, measure)| TurnAnswer::new(turn, joint, measure))
            .collect(),
        warnings: warnings(&mechanism.warnings, "run", &run.warnings),
    }
}

/// Every joint with clearance in every turn: number of the turn, name of the joint.
fn turns<'a>(
    description: &'a Description,
    run: &'a Run,
) -> impl Iterator<Item = (usize, &'a str, &'a ContactMeasure)> {
    run.turns.iter().enumerate().flat_map(|(at, turn)| {
        description
            .contacts
            .iter()
            .zip(turn)
            .map(move |(contact, measure)| (at + 1, &*contact.joint, measure))
    })
}

/// The last turns of every joint with clearance.
fn turns_table(description: &Description, run: &Run) -> String {
    const SHOWN: usize = 12;
    let brief = || ContactMeasure::COLUMNS.iter().filter(|(column, _)| column.brief);
    let row = |(turn, joint, measure): (usize, &str, &ContactMeasure)| -> Vec<String> {
        let cells = brief().map(|(column, value)| match column.unit {
            "J" => fixed(value(measure), 7),
            _ => number(value(measure)),
        });
        [turn.to_string(), joint.to_owned()].into_iter().chain(cells).collect()
    };
    let rows: Vec<_> = turns(description, run).map(row).collect();
    let titles = brief().map(|(column, _)| column.title());
    let head: Vec<String> = ["turn", "joint"].map(str::to_owned).into_iter().chain(titles).collect();
    table(&head, &rows[rows.len().saturating_sub(SHOWN)..])
}

fn to_text(
    out: Option<&Path>,
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
    let method = method_of(settings.integrator, run);
    let mut text = summary::text(description, run, &head, &method);
    if !run.turns.is_empty() {
        text.push('\n');
        text.push_str(&turns_table(description, run));
    }
    for warning in &run.warnings {
        text.push_str(&format!("\nwarning: {}\n", warning));
    }
    if let Some(out) = out {
        let rows = plural(run.rows.len() as u64, "row", "rows");
        text.push_str(&format!("\n{rows} of {} columns in {}", run.channels.len() + 1, out.display()));
    }
    text
}

/// Name of a method, as options have it.
const fn name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Rk4 { .. } => "rk4",
        Integrator::Dopri5 { .. } => "dopri5",
        Integrator::Rodas5P { .. } => "rodas5p",
        Integrator::Switching { .. } => "dopri5/rodas5p",
        Integrator::Rk43 { .. } => "rk43",
        Integrator::GeneralizedAlpha { .. } => "generalized-alpha",
    }
}

/// The method with what it was told; where there are two, which of them took the steps.
fn method_of(integrator: Integrator, run: &Run) -> String {
    let Statistics { steps, implicit_steps, .. } = run.statistics;
    let mut text = match integrator {
        Integrator::Switching { .. } if implicit_steps == 0 => "dopri5".to_owned(),
        Integrator::Switching { .. } if implicit_steps >= steps => "rodas5p".to_owned(),
        Integrator::Switching { .. } => format!("{} by rodas5p, the others by dopri5", count(implicit_steps)),
        _ => name(integrator).to_owned(),
    };
    if let Some(step) = integrator.step() {
        let longest = longest_step(step, &run.times);
        text.push_str(&if longest < step * (1.0 - SAME_STEP) {
            format!(", steps of {} s at most, which end at the samples", number(longest))
        } else {
            format!(", step {step:e} s")
        });
    }
    if let Some(tolerance) = integrator.tolerance() {
        text.push_str(&format!(", tolerance {tolerance:e}"));
    }
    if let Integrator::GeneralizedAlpha { rho, .. } = integrator {
        text.push_str(&format!(", rho {rho}"));
    }
    text
}

/// The longest step: equal ones lead from sample to sample, no longer than asked for.
fn longest_step(asked: f64, samples: &[f64]) -> f64 {
    let step = |pair: &[f64]| {
        let span = pair[1] - pair[0];
        span / (span / asked * (1.0 - SAME_STEP)).ceil().max(1.0)
    };
    samples.windows(2).map(step).reduce(f64::max).unwrap_or(asked)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_told_as_long_as_samples_let_them_be() {
        let samples: Vec<f64> = (0..=200).map(|at| f64::from(at) * 5e-4).collect();
        for (asked, longest) in [(10.0, 5e-4), (3e-4, 2.5e-4), (1e-4, 1e-4)] {
            assert!((longest_step(asked, &samples) - longest).abs() < 1e-12, "{asked}");
        }
        assert_eq!(longest_step(0.1, &[0.0]), 0.1);
    }

    #[test]
    fn rows_of_an_incomplete_run_go_beside_the_file() {
        assert_eq!(partial_name(Path::new("a/rssr.csv")), Path::new("a/rssr.partial.csv"));
        assert_eq!(partial_name(Path::new("rssr")), Path::new("rssr.partial"));
    }
}
