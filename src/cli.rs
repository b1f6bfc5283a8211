//! The command line: who answers what was asked.
//! In: arguments. Out: text or one JSON object on stdout, everything else on stderr, an exit code
//! (0 done, 1 the input or the run failed, 2 wrong usage). Never knows how a stage works.

mod answer;
mod arguments;
pub mod ask;
mod calendar;
mod check;
mod colour;
mod cost;
mod diff;
mod equations;
mod explain;
pub mod failure;
mod fit;
#[cfg(feature = "fmu")]
mod fmu;
mod generate;
mod identify;
mod import;
mod input;
mod life;
mod merge;
mod new;
mod options;
mod own_file;
mod packaging;
#[cfg(feature = "page")]
mod page;
#[cfg(feature = "page")]
mod picture;
mod plan;
mod plot;
mod predict;
mod sensitivity;
mod shard_command;
mod shipped_schemas;
mod simulate;
mod starters;
mod study;
mod summary;
mod table;
mod value;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;

use crate::table::is_stdout;
use answer::Answer;
use arguments::{Arguments, Command, Format};
use failure::Failure;

/// Reads the arguments of this process, answers, and says how it ended.
pub fn run() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let format = if wants_json(&arguments) { Format::Json } else { Format::Text };
    let parsed = match Arguments::try_parse_from(&arguments) {
        Ok(parsed) => parsed,
        Err(error) => return failure::wrong_arguments(&error, format),
    };
    let format = if format == Format::Json { format } else { parsed.format };
    if format == Format::Json && rows(&parsed.command).is_some_and(is_stdout) {
        let (message, help) = ("--out -: stdout has one JSON object and nothing else", "give --out a file");
        return Failure::usage(message, help).report(format);
    }
    let printed = |answer: Answer| answer.print(format).map(|()| answer.disagrees);
    match answer(&parsed.command).and_then(|answer| Ok(printed(answer)?)) {
        Ok(disagrees) => ExitCode::from(u8::from(disagrees)),
        Err(failure) => failure.report(format),
    }
}

fn answer(command: &Command) -> Result<Answer, Failure> {
    match command {
        Command::Check(input) => check::run(input),
        Command::Equations(arguments) => equations::run(arguments),
        Command::Cost(input) => cost::run(input),
        Command::Generate(arguments) => generate::run(arguments),
        #[cfg(feature = "fmu")]
        Command::Fmu(arguments) => fmu::run(arguments),
        Command::Simulate(arguments) => simulate::run(arguments),
        Command::Life(arguments) => life::run(arguments),
        Command::Merge(arguments) => merge::run(arguments),
        #[cfg(feature = "page")]
        Command::Report(arguments) => page::report(arguments),
        #[cfg(feature = "page")]
        Command::View(arguments) => page::view(arguments),
        #[cfg(feature = "page")]
        Command::Draw(arguments) => page::draw(arguments),
        Command::Study(arguments) => study::run(arguments),
        Command::Identify(arguments) => identify::run(arguments),
        Command::Sensitivity(arguments) => sensitivity::run(arguments),
        Command::CaseStudy { arguments } => Err(moved_case_study(arguments)),
        Command::Predict(arguments) => predict::run(arguments),
        Command::Plan(arguments) => plan::run(arguments),
        Command::Fit(arguments) => fit::run(arguments),
        Command::New(arguments) => new::run(arguments),
        Command::Import(arguments) => import::run(arguments),
        Command::Diff(arguments) => diff::run(arguments),
        Command::Explain { code } => explain::run(code),
        Command::Schema { output } => Ok(packaging::schema(*output)),
        Command::Completions { shell } => Ok(packaging::completions(*shell)),
        Command::Man { subcommand, out } => packaging::manual(subcommand.as_deref(), out.as_deref()),
    }
}

/// Where rows go.
fn rows(command: &Command) -> Option<&Path> {
    match command {
        Command::Simulate(arguments) => arguments.out.as_deref(),
        Command::Study(arguments) => arguments.out.as_deref(),
        _ => None,
    }
}

fn moved_case_study(arguments: &[String]) -> Failure {
    let arguments = if arguments.is_empty() { "--out study".to_owned() } else { arguments.join(" ") };
    let help = format!("cargo run --release -p linkwear-case-study -- {arguments}");
    Failure::usage("the case study is a program of its own", help)
}

/// Whether JSON was asked for, on a command line that clap could not read, or that belongs to another program.
fn wants_json(arguments: &[OsString]) -> bool {
    let is = |argument: &OsString, text: &str| argument.to_str() == Some(text);
    arguments.iter().any(|argument| is(argument, "--format=json"))
        || arguments.windows(2).any(|pair| is(&pair[0], "--format") && is(&pair[1], "json"))
}
